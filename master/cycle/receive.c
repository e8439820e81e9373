// SPDX-License-Identifier: GPL-2.0-only
/*
 * Receive of the cycle owner. Nothing here allocates, prints or takes a lock that is
 * contended while the cycle runs.
 */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include <linux/rcupdate.h>
#include "../base/bytes.h"
#include "../base/once64.h"
#include "../base/report.h"
#include "receive.h"
#include "ring_join.h"
#include "units_run.h"

/* Parts of inputs that are larger than a datagram; the last one completes them. */
static noinline void take_cuts(struct ec_cycle *c, const struct ec_cyc_dgram *d, u32 send,
			       const u8 *data)
{
	u8 *image = c->domains[d->domain].image;
	unsigned int i;

	for (i = d->n_whole; i < d->n_inputs; i++) {
		const struct ec_cyc_area *in = &c->layout.areas[d->first_input + i];
		struct ec_cyc_cut *cut = &c->layout.cuts[in->cut];

		if (cut->send != send) {
			cut->send = send;
			cut->have = 0;
		}
		memcpy(c->layout.stage + in->offset, data + in->pos, in->len);
		if (++cut->have == cut->parts)
			memcpy(image + cut->offset, c->layout.stage + cut->offset, cut->len);
	}
}

/*
 * Are the inputs of an incomplete reply valid? If its frame was sent before they were last
 * written, it would restore older inputs of a missing slave. Another incomplete reply in the same
 * receive has not changed the inputs of that slave.
 */
static bool holds_last(const struct ec_cycle *c, const struct ec_cyc_dgram *d,
		       const struct ec_cyc_flight *f)
{
	u16 wrote = d->wrote == (u16)c->send ? d->before : d->wrote;

	return (u16)(c->send - f->send) < (u16)(c->send - wrote);
}

/* Inputs of a datagram that at least one slave has processed. */
static __always_inline void take_inputs(struct ec_cycle *c, struct ec_cyc_dgram *d,
			const struct ec_cyc_flight *f, const u8 *data, bool complete)
{
	const struct ec_cyc_area *in = &c->layout.areas[d->first_input];
	u8 *image = c->domains[d->domain].image;
	bool direct = f->direct >> d->domain & 1 && !ec_cyc_from_image(d);
	const struct ec_cyc_area *end;

	/*
	 * The part of a missing slave returns as sent: the last value, if it was sent
	 * from the image. Where outputs were sent, or a part may be of another cycle,
	 * the reply must be complete.
	 */
	if (unlikely(!complete) && (direct || !holds_last(c, d, f)))
		return;
	if (complete)
		d->before = c->send;
	else if (d->wrote != (u16)c->send)
		d->before = d->wrote;
	d->wrote = c->send;
	/* this overwrites outputs of the image, which are not needed now */
	if (complete && d->solid && direct && c->direct) {
		memcpy(image + c->layout.areas[d->first_copy].offset, data, d->len);
		return;
	}
	end = in + (complete ? d->n_whole : d->n_plain);
	for (; in != end; in++)
		ec_bytes_run(image + in->offset, in->offset_stride, data + in->pos,
			     in->pos_stride, in->len, in->count);
	if (unlikely(d->n_inputs != d->n_whole) && complete)
		take_cuts(c, d, f->send, data);
}

/* Of several copies in a cycle the best one counts; what an earlier one has added is taken back. */
static noinline bool is_better(struct ec_cyc_dgram *d, struct ec_cyc_domain *dom, u32 send,
			       u16 wkc, bool complete)
{
	if (d->best_send == send) {
		if (d->best_ok || (!complete && wkc <= d->best))
			return false;
		dom->wkc -= d->best;
		dom->partial--;
	}
	d->best_send = send;
	d->best = wkc;
	d->best_ok = complete;
	return true;
}

/*
 * Inputs and working counter of one datagram. A reply to an older send must not overwrite the
 * data of a newer one.
 */
static __always_inline void take_dgram(struct ec_cycle *c, struct ec_cyc_dgram *d,
				       const struct ec_cyc_flight *f, const u8 *data)
{
	struct ec_cyc_domain *dom = &c->domains[d->domain];
	u16 wkc = get_unaligned_le16(data + d->len);
	bool complete = ec_cyc_is_complete(d, wkc);

	if (f->send != dom->send) {
		/* by their ages: the numbers may be any distance apart after a pause */
		if (c->send - f->send > c->send - dom->send)
			return;
		dom->send = f->send;
		dom->wkc = 0;
		dom->partial = 0;
	}
	if (ec_units_of(c) && d->repeats > 1 && !is_better(d, dom, f->send, wkc, complete))
		return;
	dom->wkc += wkc;
	c->back |= BIT_ULL(d->domain);
	if (unlikely(!complete))
		dom->partial++;
	/* more in a ring: a slave was reached from both ends, perhaps with two values */
	if (wkc && (complete || c->links->only || wkc <= d->expected))
		take_inputs(c, d, f, data, complete);
}

/*
 * Take the data of a reply, or of the two of an open ring. Return: ECAT events of the slaves in its
 * IRQ fields.
 */
static __always_inline u16 take_frame(struct ec_cycle *c, const struct ec_cyc_flight *f, bool two)
{
	struct ec_cyc_dgram *d = &c->layout.dgrams[f->first];
	const u8 *data = f->slot->reply + EC_FRAME_HDR + EC_DGRAM_HDR;
	unsigned int i;
	u16 irq = 0;

	if (unlikely(f->clocks.dgrams & EC_DC_BEHIND)) {
		ec_dc_datagrams_take_behind(&c->clock, &f->clocks, f->slot->sent_ns, data);
		return get_unaligned_le16(data - 2);
	}
	if (f->clocks.dgrams)
		data = ec_dc_datagrams_take(&c->clock, &f->clocks, f->slot->sent_ns, data);
	for (i = 0; i < f->count; i++, d++) {
		if (!(f->queued & BIT_ULL(d->domain)))
			continue;
		irq |= get_unaligned_le16(data - 2);
		take_dgram(c, d, f, likely(!two) ? data : ec_ring_data(c, f, d, data, &irq));
		data += d->len + EC_DGRAM_OVERHEAD;
	}
	if (unlikely(f->riding.mask)) {
		const u8 *end = f->slot->reply + f->slot->eth_len - EC_ETH_HDR;

		if (two)
			ec_ring_riders(c, f, data - EC_DGRAM_HDR, end);
		else
			ec_riders_take(c->riders, &f->riding, data - EC_DGRAM_HDR, end);
	}
	return irq;
}

/* How often a domain was sent after send number @send. */
static u32 sends_since(const struct ec_cycle *c, unsigned int domain, u32 send)
{
	u32 n = min_t(u32, c->send - send, EC_CYC_SENDS), sends = 0;

	while (n--)
		sends += c->queued[(c->send - n) % EC_CYC_SENDS] >> domain & 1;
	return sends;
}

/* Old data with a full working counter are no fault of a slave: they are judged apart. */
static u32 judge_age(const struct ec_cycle *c, struct ec_cyc_domain *d, unsigned int i)
{
	if (c->back & BIT_ULL(i)) {
		d->age = sends_since(c, i, d->send);
		if (unlikely(d->max_age && d->age > d->max_age && d->age > d->stale))
			WRITE_ONCE(d->stale, d->age);
	} else {
		d->age = min_t(u32, d->age + sends_since(c, i, c->judged), EC_CYC_SENDS);
	}
	return d->age;
}

/* A change of the working counter is an event; of many in a second the first and the last. */
static noinline void tell_wkc(struct ec_cycle *c, struct ec_cyc_domain *d, unsigned int i, u32 wkc,
			      u32 state)
{
	if (!ec_events_admit(&d->rate, ktime_get_ns()))
		return;
	ec_event(c->base, EC_EVENT_WKC, i, wkc, d->noted, d->expected, d->rate.more - 1,
		 READ_ONCE(c->slaves_down), state != EC_STATUS_WC_COMPLETE,
		 d->noted_state != EC_STATUS_WC_COMPLETE);
	d->noted = wkc;
	d->noted_state = state;
	d->rate.more = 0;
}

static void note_wkc(struct ec_cycle *c, struct ec_cyc_domain *d, unsigned int i, u32 wkc,
		     u32 state)
{
	u32 seen = wkc << 2 | state;

	if (seen != d->seen) {
		d->seen = seen;
		d->rate.more++;
	}
	if (unlikely(d->rate.more))
		tell_wkc(c, d, i, wkc, state);
}

/* Is it complete and of the last send, as in the status page, without a pending event? */
static bool is_steady(const struct ec_cycle *c, const struct ec_cyc_domain *d,
		      const struct ec_status_domain *st, u32 wkc)
{
	return ec_cyc_domain_is_complete(d, wkc) && d->send == c->send && !d->partial &&
	       READ_ONCE(st->working_counter) == wkc &&
	       READ_ONCE(st->wc_state) == EC_STATUS_WC_COMPLETE && !d->age && !d->rate.more;
}

/* Does the backup link contribute to the domains that were received? */
static noinline void show_backup(struct ec_cycle *c, struct ec_status *page)
{
	u64 left = (c->from_backup ^ c->shown_backup) & c->back;

	c->shown_backup ^= left;
	for (; left; left &= left - 1) {
		unsigned int i = __ffs64(left);

		WRITE_ONCE(page->domains[i].redundancy_active, c->from_backup >> i & 1);
	}
	c->from_backup = 0;
}

/* Judge domains that were sent or received since the last receive. */
static void receive_judge(struct ec_cycle *c, struct ec_status *page)
{
	u64 left = c->sent | c->back;
	bool steady = true;

	for (; left; left &= left - 1) {
		unsigned int i = __ffs64(left);
		struct ec_status_domain *st = &page->domains[i];
		struct ec_cyc_domain *d = &c->domains[i];
		u32 wkc = c->back & BIT_ULL(i) ? d->wkc : 0;
		u32 state;

		if (likely(is_steady(c, d, st, wkc)))
			continue;
		steady = false;
		state = !wkc ? EC_STATUS_WC_ZERO :
			ec_cyc_domain_is_complete(d, wkc) && !d->partial ? EC_STATUS_WC_COMPLETE :
							    EC_STATUS_WC_INCOMPLETE;
		WRITE_ONCE(st->working_counter, wkc);
		WRITE_ONCE(st->wc_state, state);
		WRITE_ONCE(st->age, judge_age(c, d, i));
		note_wkc(c, d, i, wkc, state);
	}
	if (unlikely(c->from_backup | c->shown_backup))
		show_backup(c, page);
	if (ec_units_of(c) && !ec_units_are_calm(c->units, steady))
		ec_units_judge(c, c->sent | c->back);
	c->judged = c->send;
	c->sent = 0;
	c->back = 0;
}

/**
 * ec_cycle_log_stale() - log domains with stale data, once each
 * @c: active cycle
 *
 * The cycle itself prints nothing.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_cycle_log_stale(struct ec_cycle *c)
{
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; i < c->wanted->n_domains; i++) {
		struct ec_cyc_domain *d = &c->domains[i];
		u32 age = READ_ONCE(d->stale);

		if (!age || d->stale_logged)
			continue;
		d->stale_logged = true;
		ec_report(c->base, EC_EVENT_STALE, i, age, d->max_age);
	}
}

/* Not at the first receive without reply: the machine may have stood still. */
static bool is_overdue(const struct ec_cycle *c, const struct ec_cyc_flight *f, u64 *now)
{
	if (!f->missed)
		return false;
	/* read once in a receive, and mostly not at all */
	if (!*now)
		*now = ktime_get_ns();
	return *now - f->slot->sent_ns > (u64)c->links->io_timeout_us * NSEC_PER_USEC;
}

/*
 * Of several copies the last one is awaited until the first receive after the next send, which
 * takes the data of the others. One of a link that was missing the last time is not awaited, nor
 * that of the backup link while delays are measured, but not if only that copy has come that passes
 * a closed ring the other way.
 */
static noinline bool has_copies(const struct ec_cycle *c, const struct ec_cyc_flight *f,
				struct ec_slot *slot, u64 *now)
{
	u8 mute = c->mute | (READ_ONCE(c->links->ring.measured) ? BIT(EC_BACKUP) : 0);
	u8 back = READ_ONCE(slot->back);

	return back &&
	       (f->send != c->send || is_overdue(c, f, now) ||
		(!(slot->sides & ~back & ~mute) && back & ~READ_ONCE(slot->blank))) &&
	       ec_slot_settle(slot);
}

static bool has_reply(const struct ec_cycle *c, const struct ec_cyc_flight *f,
		      struct ec_slot *slot, u64 *now)
{
	if (likely(atomic_read_acquire(&slot->state) == EC_SLOT_DONE))
		return true;
	return unlikely(!c->links->only) && has_copies(c, f, slot, now);
}

/* In a ring: are both copies of a frame needed? The reply is chosen. */
static bool has_two(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_slot *slot)
{
	bool two;

	if (likely(f->count && !f->riding.mask && ec_ring_is_steady(c, slot, &two)))
		return two;
	return ec_ring_join(c, f, slot);
}

/* a branch of its own, so that a master with one device needs nothing of it */
static __always_inline u16 take_ring(struct ec_cycle *c, const struct ec_cyc_flight *f,
				     struct ec_slot *slot)
{
	return take_frame(c, f, has_two(c, f, slot));
}

static bool is_lost(const struct ec_cycle *c, const struct ec_cyc_flight *f, u64 *now)
{
	return is_overdue(c, f, now) && ec_slot_cancel(f->slot, *now);
}

static noinline void note_lost(struct ec_cycle *c, const struct ec_slot *slot)
{
	/* a copy may have been received just before */
	ec_links_lost(c->links, slot, slot->sides & ~slot->back);
	WRITE_ONCE(c->moves, c->moves + 1);
}

/* The copy of a link is missing, and may still be received: the slot goes into quarantine. */
static noinline void put_partial(struct ec_links *l, struct ec_slot *slot)
{
	ec_links_lost(l, slot, slot->sides & ~slot->back);
	ec_slot_put(slot);
}

/**
 * ec_cycle_do_receive() - take the replies to the last sends
 * @c: active cycle; the links of its master are entered
 *
 * Inputs go to the image, working counters to the status page. A frame without a
 * reply within the time limit is lost. A reply received only after the next send
 * has data that are a cycle old, and counts as late.
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_do_receive(struct ec_cycle *c)
{
	struct ec_status *st = c->shared->status;
	struct ec_links *l = c->links;
	const struct ec_link *only = l->only;
	unsigned int i, left = 0;
	unsigned long flags;
	u64 now = 0;
	u16 irq = 0;

	if (!ec_links_attached(l)) {
		if (c->units)
			ec_units_outage(c);
		return -ENODEV;
	}
	/* replies may stay in the device until they are taken below */
	rcu_read_lock();
	WRITE_ONCE(c->carry->polled, true);
	ec_links_poll_cycle(l);
	WRITE_ONCE(c->carry->polled, false);
	WRITE_ONCE(l->access.polls, l->access.polls + 1);
	for (i = 0; i < c->n_flight; i++) {
		struct ec_cyc_flight *f = &c->flight[i];
		struct ec_slot *slot = f->slot;

		if (has_reply(c, f, slot, &now)) {
			if (unlikely(f->missed) && f->send != c->send)
				ec_links_count(l, slot->back & ~f->in_time, late);
			irq |= likely(only) ? take_frame(c, f, false) : take_ring(c, f, slot);
			if (likely(slot->back == slot->sides))
				ec_slot_release(slot, EC_SLOT_FREE);
			else
				put_partial(l, slot);
		} else if (is_lost(c, f, &now)) {
			note_lost(c, slot);
		} else {
			f->missed = true;
			if (f->send == c->send)
				f->in_time = READ_ONCE(slot->back);
			if (unlikely(slot->kept))
				ec_slot_unkeep(&l->slots, slot);
			if (left++ != i)
				c->flight[left - 1] = *f;
		}
	}
	rcu_read_unlock();
	c->n_flight = left;
	ec_dc_datagrams_events(&c->clock, irq);
	ec_links_events(l, irq);
	receive_judge(c, st);
	flags = ec_status_begin(st);
	WRITE_ONCE(st->dc_ref, READ_ONCE(c->dc->ref_station) != 0);
	if (c->clock.asked | c->clock.back)
		ec_dc_datagrams_judge(&c->clock, st);
	WRITE_ONCE(st->cycle, c->sends);
	ec_status_end(st, flags);
	return 0;
}
