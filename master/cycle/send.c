// SPDX-License-Identifier: GPL-2.0-only
/* Send of the cycle owner; as in receive.c nothing allocates, prints or waits. */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include <linux/rcupdate.h>
#include "../base/bytes.h"
#include "../base/once64.h"
#include "../carry/flight.h"
#include "../kernel/trace.h"
#include "recorder.h"
#include "send.h"
#include "units_run.h"
#include "../clock/dc_app.h"

/*
 * An entry for one more frame. If there is none, the oldest frame in flight is
 * cancelled, since the new one is more useful.
 */
static bool make_room(struct ec_cycle *c, u64 now)
{
	struct ec_slot *oldest;

	if (c->n_flight < EC_CYC_FRAMES)
		return true;
	oldest = c->flight[0].slot;
	if (ec_slot_cancel(oldest, now))
		ec_links_lost(c->links, oldest, oldest->sides & ~oldest->back);
	else if (atomic_read_acquire(&oldest->state) == EC_SLOT_DONE)
		ec_slot_put(oldest);
	else
		return false;	/* being copied at this moment */
	c->n_flight--;
	memmove(c->flight, c->flight + 1, c->n_flight * sizeof(c->flight[0]));
	return true;
}

/* one send */
struct send {
	u64 queued;	/* domains */
	u64 now;
	u32 dc;		/* clock datagrams still to be sent */
	bool both;	/* frames of a ring are built in a buffer of the main device */
	struct ec_riding riding;	/* of the last frame */
	struct ec_cyc_wire wire;
};

/* Outputs, and the last value of inputs. */
static void send_fill_dgram(const struct ec_cycle *c, const struct ec_cyc_dgram *d, u8 *data)
{
	const struct ec_cyc_area *a = &c->layout.areas[d->first_copy];
	const u8 *image = c->domains[d->domain].image;
	unsigned int i;

	if (c->direct && !ec_cyc_from_image(d))
		image = c->direct;
	if (ec_units_of(c) && c->units->replaced >> d->domain & 1)
		image = c->units->image;
	if (d->solid) {
		memcpy(data, image + a->offset, d->len);
		return;
	}
	if (d->holes)
		memset(data, 0, d->len);
	for (i = 0; i < d->n_copies; i++, a++)
		ec_bytes_run(data + a->pos, a->pos_stride, image + a->offset,
			     a->offset_stride, a->len, a->count);
}

/* Queued datagrams from @g on, as many as fit; returns how many were added or not queued. */
static unsigned int fill(struct ec_cycle *c, struct ec_slot *slot, u8 *frame, unsigned int g,
			 struct send *send, bool alone)
{
	const struct ec_cyc_dgram *d = &c->layout.dgrams[g], *last = NULL;
	unsigned int room, dc, first = g;
	u64 queued = send->queued;
	struct ec_frame_buf fb;
	u8 *p;

	ec_frame_begin(&fb, frame + EC_ETH_HDR, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	if (send->dc)
		ec_dc_datagrams_fill(&c->clock, &fb, slot->index, send->dc, send->now);
	dc = fb.count;
	room = unlikely(alone) ? 0 : max(c->links->max_datagrams, dc) - dc;
	for (; g < c->layout.n_dgrams && room; g++, d++) {
		if (!(queued & BIT_ULL(d->domain)))
			continue;
		if (ec_cyc_is_apart(d, last))
			break;
		p = ec_frame_add(&fb, d->cmd, slot->index, d->logical & 0xffff,
				 d->logical >> 16, d->len);
		if (!p)
			break;
		send_fill_dgram(c, d, p);
		last = d;
		room--;
	}
	send->riding.mask = 0;
	if (unlikely(atomic_read(&c->riders->queued)) && !alone)
		ec_riders_add(c->riders, &fb, slot->index, &send->riding);
	slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
	return g - first;
}

static void note_flight(struct ec_cycle *c, struct ec_slot *slot, unsigned int g,
			unsigned int count, const struct send *send)
{
	struct ec_cyc_flight *f = &c->flight[c->n_flight++];

	f->slot = slot;
	f->send = c->send;
	f->first = g;
	f->count = count;
	f->queued = send->queued;
	f->missed = false;
	f->in_time = 0;
	f->direct = c->direct ? ~0ULL : 0;
	if (ec_units_of(c))
		f->direct &= ~c->units->replaced;
	f->clocks.dgrams = send->dc;
	f->clocks.time = c->clock.sent;
	f->riding = send->riding;
}

/* In a ring clock datagrams go one way, process data both ways. */
static noinline u8 *ring_buffer(struct ec_links *l, const struct send *send, bool alone,
				struct ec_tx *tx)
{
	if (alone)
		return ec_links_tx_get(l, BIT(EC_MAIN), tx);
	tx->sides = l->sides;
	tx->link = NULL;
	return send->both ? ec_links_tx_get_both(l, tx) : NULL;
}

/* One frame from datagram @g on; returns the first datagram of the next. */
static unsigned int send_frame(struct ec_cycle *c, unsigned int g, struct send *send)
{
	struct ec_links *l = c->links;
	struct ec_link *only = l->only;
	bool alone = unlikely(!only) && send->dc;
	struct ec_slot *slot = NULL;
	struct ec_tx tx;
	unsigned int count;
	u8 *frame;
	int ret;

	if (make_room(c, send->now))
		slot = ec_slot_get(&l->slots, true, send->now);
	if (!slot) {
		ec_links_count(l, l->sides, tx_errors);
		send->dc = 0;
		return c->layout.n_dgrams;
	}
	/* one copy less than through the slot */
	if (likely(only)) {
		tx.link = only;
		tx.sides = l->sides;
		frame = ec_link_tx_get(only, &tx.dev);
	} else {
		frame = ring_buffer(l, send, alone, &tx);
	}
	frame = frame ?: slot->frame;
	count = fill(c, slot, frame, g, send, alone);
	send->wire.ns += ec_frame_wire_ns(slot->eth_len);
	send->wire.frames++;
	if (likely(only) || !send->both || alone || frame == slot->frame)
		ret = ec_links_transmit(l, slot, frame, &tx, send->now);
	else
		ret = ec_links_transmit_both(l, slot, frame, &tx, send->now);
	/* unlike an acyclic frame it cannot wait */
	if (ret == -EBUSY)
		ec_links_count(l, tx.sides, tx_errors);
	if (!ret) {
		note_flight(c, slot, g, count, send);
	} else {
		ec_slot_put(slot);
		if (send->riding.mask)
			ec_riders_return(c->riders, &send->riding);
	}
	send->dc = 0;
	return g + count;
}

/* Clock datagrams behind the break of a ring. */
static noinline void send_behind(struct ec_cycle *c, struct send *send)
{
	struct ec_links *l = c->links;
	u32 there = ec_dc_datagrams_behind(&c->clock, send->dc), dc;
	struct ec_ring_clock_flight behind = { 0 };
	struct ec_slot *slot = NULL;
	struct ec_frame_buf fb;
	struct ec_tx tx;
	u8 *frame;
	int ret;

	/* those of the main link would be refused, each an error */
	if (!READ_ONCE(l->link[EC_MAIN].up) && !ec_link_is_up(&l->link[EC_MAIN]))
		send->dc = 0;
	if (there && make_room(c, send->now))
		slot = ec_slot_get(&l->slots, true, send->now);
	if (!slot)
		return;
	dc = send->dc;
	frame = ec_links_tx_get(l, BIT(EC_BACKUP), &tx) ?: slot->frame;
	ec_frame_begin(&fb, frame + EC_ETH_HDR, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	ec_dc_datagrams_fill_behind(&c->clock, &fb, slot->index, there, send->now, &behind);
	slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
	send->wire.ns += ec_frame_wire_ns(slot->eth_len);
	ret = ec_links_transmit(l, slot, frame, &tx, send->now);
	if (ret) {
		ec_slot_put(slot);
		return;
	}
	send->dc = there;
	send->riding.mask = 0;
	note_flight(c, slot, c->layout.n_dgrams, 0, send);
	c->flight[c->n_flight - 1].clocks.behind = behind;
	send->dc = dc;
}

/* Wire time of a send of all domains and clock datagrams at most, ns. */
static u32 wire_ns(const struct ec_cycle *c)
{
	if (!ec_dc_begun(c->dc))
		return c->layout.plain.ns;
	return c->layout.clocked.ns + ec_dc_datagrams_reserve_ns(&c->clock);
}

/**
 * ec_cycle_app_time() - take the application time, or the time for the reference clock
 * @c: active cycle
 * @what: its flags, one of APP_TIME and SYNC_REF among them, @app_time and @sync_time
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_cycle_app_time(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	c->clock.hold = ec_dc_update_app_time(c->dc, what, &c->clock.lead);
}

/* apart from the send, which needs its registers */
static noinline void trace_send(const struct ec_cycle *c)
{
	trace_ec_cycle(c->base->index, c->sends, c->queued[c->send % EC_CYC_SENDS], c->last.frames,
		       c->last.ns, c->n_flight);
}

/**
 * ec_cycle_do_send() - send the queued domains, then acyclic frames that fit
 * @c: active cycle; the links of its master are entered
 * @what: domains and clock datagrams; its flags are known ones
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_do_send(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	struct send send = { .queued = what->queued, .now = ktime_get_ns() };
	struct ec_carry *carry = c->carry;
	struct ec_links *l = c->links;
	unsigned int g = 0, copies = 0;

	if (!ec_links_attached(l))
		return -ENODEV;
	if (!c->thread)
		ec_late_send(&c->late, send.now);
	ec_write64(&l->access.last_send_ns, send.now);
	if (unlikely(READ_ONCE(l->access.stopped)))
		WRITE_ONCE(l->access.stopped, false);
	if (c->copying)
		ec_copy_run(c->copying, c->shared->status, c->domains);
	if (ec_units_of(c) && ec_units_act(c->units, what->queued))
		ec_units_fill(c, what->queued);
	c->send++;
	c->queued[c->send % EC_CYC_SENDS] = what->queued;
	c->sent |= what->queued;
	if (unlikely(what->queued & ~c->sent_once))
		ec_write64(&c->sent_once, c->sent_once | what->queued);
	if (what->flags & EC_CYC_CLOCKS)
		send.dc = ec_dc_datagrams_wanted(&c->clock, what->flags);
	rcu_read_lock();
	if (unlikely(!l->only)) {
		send.both = ec_links_keep_sent(l);
		/* first, so that its delay after the send is constant */
		if (send.dc)
			send_behind(c, &send);
	}
	/* frames that are repeated go behind all others: a disturbance may last a while */
	do {
		while (g < c->layout.n_dgrams || send.dc) {
			if (send.dc || send.queued & BIT_ULL(c->layout.dgrams[g].domain))
				g = send_frame(c, g, &send);
			else
				g++;
		}
		g = 0;
		send.queued = ec_units_of(c) ? what->queued & c->units->repeated[copies++] : 0;
	} while (send.queued);
	WRITE_ONCE(c->last.frames, send.wire.frames);
	WRITE_ONCE(c->last.ns, send.wire.ns);
	WRITE_ONCE(l->access.wire_ns, max(send.wire.ns, wire_ns(c)));
	ec_share_begin(&carry->share, ec_access_interval_us(&l->access));
	if (unlikely(ec_carry_has_landed(carry))) {
		/* what they lead to takes time, which the process data do not wait for */
		ec_links_flush(l);
		ec_flight_land(carry);
	}
	if (unlikely(ec_carry_has_left(carry)))
		ec_share_send_left(carry, send.wire.ns);
	ec_links_flush(l);
	rcu_read_unlock();
	ec_write64(&c->sends, c->sends + 1);
	if (ec_recorder_wanted(c))
		ec_recorder_put(c, what->queued, send.now);
	if (trace_ec_cycle_enabled())
		trace_send(c);
	return 0;
}
