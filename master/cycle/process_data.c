// SPDX-License-Identifier: GPL-2.0-only
/*
 * Receive and send of the cyclic caller. Nothing here allocates, prints or
 * takes a lock that is contended while the cycle runs.
 */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include "../base/bytes.h"
#include "cycle.h"
#include "../base/once64.h"

/* Parts of inputs that are larger than a datagram; the last one completes them. */
static void take_cuts(struct ec_cycle *c, const struct ec_cyc_dgram *d, u32 send,
		      const u8 *data)
{
	u8 *image = c->domains[d->domain].image;
	unsigned int i;

	for (i = d->n_whole; i < d->n_inputs; i++) {
		const struct ec_cyc_area *in = &c->areas[d->first_input + i];
		struct ec_cyc_cut *cut = &c->cuts[in->cut];

		if (cut->send != send) {
			cut->send = send;
			cut->have = 0;
		}
		memcpy(c->stage + in->offset, data + in->pos, in->len);
		if (++cut->have == cut->parts)
			memcpy(image + cut->offset, c->stage + cut->offset, cut->len);
	}
}

/* It has inputs only, and their last values are in the image. */
static bool from_image(const struct ec_cyc_dgram *d)
{
	return d->cmd == EC_CMD_LRD;
}

/*
 * May an incomplete reply give its inputs? One that was sent before they were last written
 * would bring back what a missing slave had before. An incomplete one of the same receive has
 * left that as it was.
 */
static bool holds_last(const struct ec_cycle *c, const struct ec_cyc_dgram *d,
		       const struct ec_cyc_flight *f)
{
	u16 wrote = d->wrote == (u16)c->send ? d->before : d->wrote;

	return (u16)(c->send - f->send) < (u16)(c->send - wrote);
}

/* Inputs of a datagram in which at least one slave has taken part. */
static void take_inputs(struct ec_cycle *c, struct ec_cyc_dgram *d,
			const struct ec_cyc_flight *f, const u8 *data, bool complete)
{
	const struct ec_cyc_area *in = &c->areas[d->first_input];
	u8 *image = c->domains[d->domain].image;
	bool direct = f->direct && !from_image(d);
	unsigned int i, n;

	/*
	 * A missing slave's part comes back as sent: the last value, if it was sent
	 * from the image. Where outputs were sent, or a part may be of another cycle,
	 * all must have taken part.
	 */
	if (unlikely(!complete) && (direct || !holds_last(c, d, f)))
		return;
	if (complete)
		d->before = c->send;
	else if (d->wrote != (u16)c->send)
		d->before = d->wrote;
	d->wrote = c->send;
	/* the outputs come back as well: those of the image are not needed now */
	if (complete && d->solid && direct && c->direct) {
		memcpy(image + c->areas[d->first_copy].offset, data, d->len);
		return;
	}
	n = complete ? d->n_whole : d->n_plain;
	for (i = 0; i < n; i++, in++)
		ec_bytes_run(image + in->offset, in->offset_stride, data + in->pos,
			     in->pos_stride, in->len, in->count);
	if (unlikely(d->n_inputs != d->n_whole) && complete)
		take_cuts(c, d, f->send, data);
}

/*
 * Inputs and working counter of one datagram. A reply to an older send must not overwrite the
 * data of a newer one.
 */
static void take_dgram(struct ec_cycle *c, struct ec_cyc_dgram *d,
		       const struct ec_cyc_flight *f, const u8 *data)
{
	struct ec_cyc_domain *dom = &c->domains[d->domain];
	u16 wkc = get_unaligned_le16(data + d->len);

	/* by their ages: the numbers may be any distance apart after a pause */
	if (c->send - f->send > c->send - dom->send)
		return;
	if (f->send != dom->send) {
		dom->send = f->send;
		dom->wkc = 0;
		dom->partial = false;
	}
	dom->wkc += wkc;
	c->back |= BIT_ULL(d->domain);
	if (unlikely(wkc != d->expected))
		dom->partial = true;
	if (wkc)
		take_inputs(c, d, f, data, wkc == d->expected);
}

/* Returns the events that the slaves have shown in the IRQ field. */
static u16 take_frame(struct ec_cycle *c, const struct ec_cyc_flight *f)
{
	struct ec_cyc_dgram *d = &c->dgrams[f->first];
	const u8 *data = ec_slot_body(f->slot) + EC_FRAME_HDR + EC_DGRAM_HDR;
	unsigned int i;
	u16 irq = 0;

	if (f->dc)
		data = ec_dc_datagrams_take(c, f, data);
	for (i = 0; i < f->count; i++, d++) {
		if (!(f->queued & BIT_ULL(d->domain)))
			continue;
		irq |= get_unaligned_le16(data - 2);
		take_dgram(c, d, f, data);
		data += d->len + EC_DGRAM_OVERHEAD;
	}
	if (unlikely(f->riding.mask))
		ec_riders_take(c->links, &f->riding, data - EC_DGRAM_HDR,
			       f->slot->frame + f->slot->eth_len);
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
static void note_wkc(struct ec_cycle *c, struct ec_cyc_domain *d, unsigned int i, u32 wkc, u64 now)
{
	if (wkc != d->seen) {
		d->seen = wkc;
		d->rate.more++;
	}
	if (likely(!d->rate.more) || !ec_events_admit(&d->rate, now))
		return;
	ec_event(c->base, EC_EVENT_WKC, i, wkc, d->noted, d->expected, d->rate.more - 1,
		 READ_ONCE(c->slaves_down));
	d->noted = wkc;
	d->rate.more = 0;
}

/* Domains that were sent or came back since the last receive. */
static void judge(struct ec_cycle *c, u64 now)
{
	u64 left = c->sent | c->back;

	for (; left; left &= left - 1) {
		unsigned int i = __ffs64(left);
		struct ec_status_domain *st = &c->shared->status->domains[i];
		struct ec_cyc_domain *d = &c->domains[i];
		u32 wkc = c->back & BIT_ULL(i) ? d->wkc : 0;

		WRITE_ONCE(st->working_counter, wkc);
		WRITE_ONCE(st->wc_state, !wkc ? 0 : wkc == d->expected && !d->partial ? 2 : 1);
		WRITE_ONCE(st->age, judge_age(c, d, i));
		note_wkc(c, d, i, wkc, now);
	}
	c->judged = c->send;
	c->sent = 0;
	c->back = 0;
}

/**
 * ec_cycle_tell_stale() - log domains whose data came back too old, once each
 * @c: active cycle
 *
 * The cycle itself prints nothing.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_cycle_tell_stale(struct ec_cycle *c)
{
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; i < c->wanted->n_domains; i++) {
		struct ec_cyc_domain *d = &c->domains[i];
		u32 age = READ_ONCE(d->stale);

		if (!age || d->stale_logged)
			continue;
		d->stale_logged = true;
		ec_warn(c,
			"domain %u receives stale process data: %u sends old, limit %u; check the delay of the device\n",
			i, age, d->max_age);
		ec_event(c->base, EC_EVENT_STALE, i, age, d->max_age);
	}
}

/**
 * ec_cycle_do_receive() - take what the last sends have brought back
 * @c: active cycle; the links of its master are entered
 *
 * Inputs go to the image, working counters to the status page. Frames that
 * are not back within the time limit are lost; one that comes only after the
 * next send has brought data that are a cycle old, and is counted as late.
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_do_receive(struct ec_cycle *c)
{
	u64 now, limit = (u64)c->links->io_timeout_us * NSEC_PER_USEC;
	unsigned int i, left = 0;
	u16 irq = 0;

	if (!ec_links_attached(c->links))
		return -ENODEV;
	ec_links_poll(c->links);
	WRITE_ONCE(c->links->access.polls, c->links->access.polls + 1);
	now = ktime_get_ns();
	for (i = 0; i < c->n_flight; i++) {
		struct ec_cyc_flight *f = &c->flight[i];

		if (atomic_read_acquire(&f->slot->state) == EC_SLOT_DONE) {
			if (unlikely(f->missed) && f->send != c->send)
				ec_links_count(c->links, late);
			irq |= take_frame(c, f);
			ec_slot_put(&c->links->slots, f->slot);
		} else if (f->missed && now - f->slot->sent_ns > limit &&
			   ec_slot_cancel(f->slot, now)) {
			ec_links_count(c->links, lost);
		} else {
			/* the machine may have stood still: looked for twice at least */
			f->missed = true;
			if (left++ != i)
				c->flight[left - 1] = *f;
		}
	}
	c->n_flight = left;
	ec_links_events(c->links, irq);
	judge(c, now);
	ec_status_begin(c->shared->status);
	ec_dc_datagrams_judge(c);
	WRITE_ONCE(c->shared->status->cycle, c->sends);
	ec_status_end(c->shared->status);
	return 0;
}

/**
 * ec_cycle_receive() - ec_cycle_do_receive(), links and all
 * @c: active cycle
 *
 * Context: The master's single cyclic caller. RT-safe; sleeps after a cycle timeout only.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_receive(struct ec_cycle *c)
{
	int ret;

	if (!ec_links_attached(c->links))
		return -ENODEV;
	ec_links_enter(c->links);
	ret = ec_cycle_do_receive(c);
	ec_links_leave(c->links);
	return ret;
}

/*
 * Room for one more frame. When none has come back for long, the oldest is
 * given up: a frame of now is worth more.
 */
static bool make_room(struct ec_cycle *c, u64 now)
{
	struct ec_slot *oldest;

	if (c->n_flight < EC_CYC_FRAMES)
		return true;
	oldest = c->flight[0].slot;
	if (ec_slot_cancel(oldest, now))
		ec_links_count(c->links, lost);
	else if (atomic_read_acquire(&oldest->state) == EC_SLOT_DONE)
		ec_slot_put(&c->links->slots, oldest);
	else
		return false;	/* being copied at this moment */
	c->n_flight--;
	memmove(c->flight, c->flight + 1, c->n_flight * sizeof(c->flight[0]));
	return true;
}

/* one send */
struct send {
	const struct ec_ioc_send *what;
	u64 now;
	u32 dc;		/* clock datagrams still to be sent */
	struct ec_riding riding;	/* of the last frame */
	struct ec_cyc_wire wire;
};

/* Outputs, and the last value of inputs. */
static void fill_dgram(const struct ec_cycle *c, const struct ec_cyc_dgram *d, u8 *data)
{
	const struct ec_cyc_area *a = &c->areas[d->first_copy];
	const u8 *image = c->domains[d->domain].image;
	unsigned int i;

	if (c->direct && !from_image(d))
		image = c->direct;
	if (d->holes)
		memset(data, 0, d->len);
	for (i = 0; i < d->n_copies; i++, a++)
		ec_bytes_run(data + a->pos, a->pos_stride, image + a->offset,
			     a->offset_stride, a->len, a->count);
}

/* Queued datagrams from @g on, as many as fit; returns how many were looked at. */
static unsigned int fill(struct ec_cycle *c, struct ec_slot *slot, u8 *frame, unsigned int g,
			 struct send *send)
{
	const struct ec_cyc_dgram *d = &c->dgrams[g];
	unsigned int room, dc, first = g;
	u64 queued = send->what->queued;
	struct ec_frame_buf fb;
	u8 *p;

	ec_frame_begin(&fb, frame + EC_ETH_HDR, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	if (send->dc)
		ec_dc_datagrams_fill(c, &fb, slot->index, send->dc, send->what->sync_time,
				     send->now);
	dc = fb.count;
	room = max(c->links->max_datagrams, dc) - dc;
	for (; g < c->n_dgrams && room; g++, d++) {
		if (!(queued & BIT_ULL(d->domain)))
			continue;
		if (d->new_frame && fb.count > dc)
			break;
		p = ec_frame_add(&fb, d->cmd, slot->index, d->logical & 0xffff,
				 d->logical >> 16, d->len);
		if (!p)
			break;
		fill_dgram(c, d, p);
		room--;
	}
	send->riding.mask = 0;
	if (unlikely(atomic_read(&c->links->riders.queued)))
		ec_riders_add(c->links, &fb, slot->index, &send->riding);
	slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
	return g - first;
}

/* One frame from datagram @g on; returns the first datagram of the next. */
static unsigned int send_frame(struct ec_cycle *c, unsigned int g, struct send *send)
{
	struct ec_slot *slot = NULL;
	unsigned int count;
	u8 *frame;
	int ret;

	if (make_room(c, send->now))
		slot = ec_slot_get(&c->links->slots, true, send->now);
	if (!slot) {
		ec_links_count(c->links, tx_errors);
		send->dc = 0;
		return c->n_dgrams;
	}
	/* one copy less than through the slot */
	frame = ec_links_tx_get(c->links) ?: slot->frame;
	count = fill(c, slot, frame, g, send);
	send->wire.ns += ec_frame_wire_ns(slot->eth_len);
	send->wire.frames++;
	ret = ec_access_transmit(c->links, slot, frame, send->now);
	/* unlike an acyclic frame it cannot wait */
	if (ret == -EBUSY)
		ec_links_count(c->links, tx_errors);
	if (!ret) {
		c->flight[c->n_flight++] = (struct ec_cyc_flight){
			.slot = slot, .send = c->send, .first = g, .count = count,
			.queued = send->what->queued, .direct = c->direct, .dc = send->dc,
			.dc_sent = c->dc_sent, .riding = send->riding,
		};
	} else {
		ec_slot_put(&c->links->slots, slot);
		if (send->riding.mask)
			ec_riders_return(c->links, &send->riding);
	}
	send->dc = 0;
	return g + count;
}

/* What a send of all domains and clock datagrams takes at most. */
static u32 wire_ns(const struct ec_cycle *c)
{
	if (!ec_dc_begun(c->dc))
		return c->plain.ns;
	return c->clocked.ns + ec_dc_datagrams_reserve_ns(c);
}

/**
 * ec_cycle_app_time() - the application gives its time, or that of the reference clock
 * @c: active cycle
 * @what: its flags, @app_time and @sync_time
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_cycle_app_time(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	if (what->flags & (EC_SEND_FLAG_APP_TIME | EC_SEND_FLAG_SYNC_REF))
		c->dc_hold = ec_dc_update_app_time(c->dc, what, &c->dc_skip);
}

/**
 * ec_cycle_take_request() - what the application gives with a send, without requests
 * @c: active cycle
 * @what: its flags are known ones
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: 0; -ENOENT a domain is queued that there is not.
 */
int ec_cycle_take_request(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	ec_cycle_app_time(c, what);
	return c->wanted->n_domains < 64 && what->queued >> c->wanted->n_domains ? -ENOENT : 0;
}

/**
 * ec_cycle_do_send() - send the queued domains, then what others have left
 * @c: active cycle; the links of its master are entered
 * @what: domains and clock datagrams; its flags are known ones
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_do_send(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	struct send send = { .what = what, .now = ktime_get_ns() };
	unsigned int g = 0;

	if (!ec_links_attached(c->links))
		return -ENODEV;
	if (!c->thread)
		ec_late_send(c, send.now);
	ec_write64(&c->links->access.last_send_ns, send.now);
	if (c->copying)
		ec_copy_run(c);
	c->send++;
	c->queued[c->send % EC_CYC_SENDS] = what->queued;
	c->sent |= what->queued;
	send.dc = ec_dc_datagrams_wanted(c, what->flags);
	while (g < c->n_dgrams || send.dc) {
		if (send.dc || what->queued & BIT_ULL(c->dgrams[g].domain))
			g = send_frame(c, g, &send);
		else
			g++;
	}
	WRITE_ONCE(c->last.frames, send.wire.frames);
	WRITE_ONCE(c->last.ns, send.wire.ns);
	WRITE_ONCE(c->links->access.wire_ns, max(send.wire.ns, wire_ns(c)));
	ec_share_begin(c->links);
	ec_share_send_left(c->links, send.wire.ns);
	ec_links_flush(c->links);
	ec_write64(&c->sends, c->sends + 1);
	return 0;
}

/**
 * ec_cycle_send() - ec_cycle_do_send(), links and all
 * @c: active cycle
 * @what: as there
 *
 * Context: The master's single cyclic caller. RT-safe; sleeps after a cycle timeout only.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_send(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	int ret;

	if (!ec_links_attached(c->links))
		return -ENODEV;
	ec_links_enter(c->links);
	ret = ec_cycle_do_send(c, what);
	ec_links_leave(c->links);
	return ret;
}
