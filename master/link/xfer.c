// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include "links.h"
#include "submit.h"
#include "watch.h"
#include "xfer.h"

#define TRIES	4	/* of a repeatable datagram */
#define WAITS	8	/* for one frame, as long as it had no fair chance */
#define PLACE_WAIT_MS	30000	/* many hundred callers may be at work at once */
#define RING_WAIT_MS	1000	/* a device that sends nothing for so long hangs */

/* one frame of a batch: the slot and the datagrams it carries */
struct batch_frame {
	struct ec_slot *slot;
	unsigned int first;
	unsigned int count;
	u32 wire_ns;
	bool placed;	/* has a place at the link's gate */
	bool cancelled;
	int err;
};

/*
 * Half of the frames a batch has in flight. While one half is waited for and
 * taken in, the other one keeps the wire busy.
 */
struct half {
	struct ec_xfer x;
	struct ec_submit_wait wait;
	bool urgent;
	bool clock;
	bool alone;	/* frames share none with those of other callers */
	int err;	/* why not all frames were sent */
	bool stop;	/* no sense in sending the others */
	unsigned int frames;
	struct batch_frame f[EC_CLOCK_WINDOW / 2];
};

/**
 * ec_xfer_done() - one frame of a waiting caller is accounted for
 * @x: the caller's
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_xfer_done(struct ec_xfer *x)
{
	if (!atomic_dec_and_test(&x->pending))
		return;
	if (x->notify)
		x->notify(x);
	else
		complete(&x->done);
}

/* pack datagrams from @first on; datagrams already answered are left out */
static void build(struct ec_links *l, const struct half *h, struct batch_frame *bf,
		  struct ec_dg *dg, unsigned int first, unsigned int n)
{
	struct ec_slot *slot = bf->slot;
	unsigned int most = slot->clock ? EC_CLOCK_DATAGRAMS : l->max_datagrams, i;
	/* a frame that fits before the next cycle, but at least the first datagram */
	u16 room = EC_DGRAM_OVERHEAD + max(ec_access_room(l), dg[first].len);
	struct ec_frame_buf fb;

	/* clock frames are as long as their share, so that as many may leave as shall */
	if (slot->clock)
		room = clamp_t(u16, ec_share_clock_bytes(l), EC_DGRAM_OVERHEAD + dg[first].len,
			       room);
	ec_frame_begin(&fb, ec_slot_body(slot), EC_FRAME_HDR + room);
	for (i = first; i < n && fb.count < most; i++) {
		u8 *p;

		if (dg[i].err != -EINPROGRESS)
			continue;
		p = ec_frame_add(&fb, dg[i].cmd, slot->index, dg[i].adp, dg[i].ado, dg[i].len);
		if (!p)
			break;
		ec_dg_fill(&dg[i], p);
	}
	bf->first = first;
	bf->count = i - first;
	slot->dgrams = h->alone ? 0 : fb.count;
	slot->last = fb.last - (fb.buf + EC_FRAME_HDR);
	slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
}

static void collect(struct batch_frame *bf, struct ec_dg *dg)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	unsigned int i;

	if (bf->err) {
		for (i = bf->first; i < bf->first + bf->count; i++)
			if (dg[i].err == -EINPROGRESS)
				dg[i].err = bf->err;
		return;
	}
	/* checked against what was sent when it was matched */
	ec_frame_iter_init(&it, ec_slot_body(bf->slot), bf->slot->eth_len - EC_ETH_HDR);
	for (i = bf->first; i < bf->first + bf->count; i++) {
		if (dg[i].err != -EINPROGRESS)
			continue;
		if (ec_frame_iter_next(&it, &d) != 1) {
			dg[i].err = -EIO;
			continue;
		}
		ec_dg_take(&dg[i], &d, bf->slot->sent_ns);
	}
}

/* Tools must not hold up the monitor, which looks after the application and the link. */
static bool is_monitor(const struct ec_links *l)
{
	return current == READ_ONCE(l->monitor);
}

/*
 * A place among the acyclic frames of the link; with @wait it is waited for. A link that
 * goes down gives all places back soon. The monitor may have one frame without a place.
 */
static int take_place(struct ec_links *l, bool wait, bool *placed)
{
	struct ec_gate *gate = &l->link[0].acyclic;
	int ret;

	*placed = ec_gate_try(gate);
	if (*placed || (wait && is_monitor(l)))
		return 0;
	ret = wait ? ec_gate_enter(gate, PLACE_WAIT_MS) : -EBUSY;
	*placed = !ret;
	return ret;
}

/* A place and a slot for it. */
static struct ec_slot *get_slot(struct ec_links *l, struct half *h, struct batch_frame *f,
				bool wait)
{
	struct ec_slot *slot;

	f->placed = false;
	h->err = h->urgent ? 0 : take_place(l, wait, &f->placed);
	h->stop = wait;
	if (h->err)
		return NULL;
	if (wait && !h->urgent)
		slot = ec_slot_wait(&l->slots);
	else
		slot = ec_slot_get(&l->slots, h->urgent, ktime_get_ns());
	if (slot) {
		h->stop = false;
		return slot;
	}
	h->err = -EBUSY;
	h->stop |= h->urgent;
	if (f->placed)
		ec_gate_leave(&l->link[0].acyclic);
	return NULL;
}

static void put_slot(struct ec_links *l, const struct batch_frame *f)
{
	/* the slot of a cancelled frame may be in use by another already */
	if (!f->cancelled)
		ec_slot_put(f->slot);
	if (f->placed)
		ec_gate_leave(&l->link[0].acyclic);
	if (f->wire_ns)
		atomic_sub(f->wire_ns, &l->link[0].acyclic_ns);
}

/* Try until there is room in the transmit ring, or @until. */
static int submit_until(struct ec_links *l, struct ec_slot *slot, bool urgent, u64 until)
{
	int ret;

	while ((ret = ec_submit(l, slot, urgent)) == -EBUSY) {
		if (fatal_signal_pending(current))
			return -EINTR;
		if (ktime_get_ns() > until) {
			atomic64_inc(&l->link[0].stats.tx_errors);
			break;
		}
		/* no driver reports room in its ring */
		usleep_range(100, 200);
	}
	return ret;
}

/* A full transmit ring is no error: the frame waits; one caller tries for all others. */
static int submit_later(struct ec_links *l, struct ec_slot *slot, bool urgent)
{
	u64 until = ktime_get_ns() + (u64)RING_WAIT_MS * NSEC_PER_MSEC;
	struct ec_gate *gate = &l->link[0].ring_full;
	int ret;

	if (urgent || is_monitor(l))
		return submit_until(l, slot, urgent, until);
	ret = ec_gate_enter(gate, RING_WAIT_MS);
	if (ret == -EBUSY)
		atomic64_inc(&l->link[0].stats.tx_errors);
	if (ret)
		return ret;
	ret = submit_until(l, slot, urgent, until);
	ec_gate_leave(gate);
	return ret;
}

static void submit(struct ec_links *l, const struct half *h, struct batch_frame *f)
{
	f->cancelled = false;
	f->wire_ns = ec_frame_wire_ns(f->slot->eth_len);
	/* before it leaves, see ecdev_awaits() */
	atomic_add(f->wire_ns, &l->link[0].acyclic_ns);
	f->err = ec_submit(l, f->slot, h->urgent);
	if (f->err == -EBUSY)
		f->err = submit_later(l, f->slot, h->urgent);
}

/*
 * Send half a window of frames from datagram @first on; with @wait a slot is
 * waited for. Returns the first datagram that is left.
 */
static unsigned int send_half(struct ec_links *l, struct half *h, struct ec_dg *dg,
			      unsigned int first, unsigned int n, bool wait)
{
	unsigned int window = h->clock ? EC_CLOCK_WINDOW : EC_XFER_WINDOW;

	init_completion(&h->x.done);
	h->x.notify = NULL;
	atomic_set(&h->x.pending, 1);
	h->wait.polls = READ_ONCE(l->access.polls);
	h->stop = false;
	for (h->frames = 0; h->frames < window / 2; h->frames++) {
		struct batch_frame *f = &h->f[h->frames];

		while (first < n && dg[first].err != -EINPROGRESS)
			first++;
		if (first >= n)
			break;
		f->slot = get_slot(l, h, f, wait && !h->frames);
		if (!f->slot)
			break;
		f->slot->clock = h->clock;
		build(l, h, f, dg, first, n);
		first += f->count;
		f->slot->xfer = &h->x;
		atomic_inc(&h->x.pending);
		submit(l, h, f);
		if (!f->err)
			continue;
		ec_xfer_done(&h->x);
		h->err = f->err;
		h->stop = true;
		h->frames++;
		break;
	}
	ec_xfer_done(&h->x);
	return first;
}

/* Cancel the frames of a half: the time limit is over, or the link is down. */
static void give_up(struct ec_links *l, struct half *h)
{
	bool up = ec_link_is_up(&l->link[0]);
	unsigned int i;

	for (i = 0; i < h->frames; i++) {
		struct batch_frame *f = &h->f[i];

		if (f->err)
			continue;
		/* neither: a frame that need not be the reply is looked at just now, some us */
		while (!(f->cancelled = ec_slot_cancel(f->slot, ktime_get_ns())) &&
		       atomic_read(&f->slot->state) != EC_SLOT_DONE)
			usleep_range(20, 50);
		if (!f->cancelled)
			continue;
		if (ec_slot_leads(f->slot))
			atomic64_inc(&l->link[0].stats.lost);
		f->err = up ? -ETIMEDOUT : -ENETDOWN;
		ec_xfer_done(&h->x);
	}
}

/* Has a frame of a half not left yet? */
static bool in_queue(const struct half *h)
{
	enum ec_slot_state state;
	unsigned int i;

	for (i = 0; i < h->frames; i++) {
		const struct batch_frame *f = &h->f[i];

		if (f->err)
			continue;
		state = atomic_read(&f->slot->state);
		/* FILL: it may be taken from the queue, and left there, just now */
		if (state == EC_SLOT_QUEUED || state == EC_SLOT_FILL)
			return true;
	}
	return false;
}

/* The time limit begins when the last frame has left, or cannot leave any more. */
static bool wait_watched(struct ec_links *l, struct half *h, const struct ec_watcher *me)
{
	struct ec_link *link = &l->link[0];
	unsigned long until;
	long left;

	while (in_queue(h) && ec_submit_wait_turn(l, &h->wait)) {
		if (ec_watch_wait(&link->acyclic, me, &h->x.done, ~0u))
			return true;
		h->wait.began_ns = ktime_get_ns();
		h->wait.polls = READ_ONCE(l->access.polls);
	}
	until = jiffies + usecs_to_jiffies(h->wait.timeout_us) + 1;
	while ((left = until - jiffies) > 0 && ec_link_is_up(link))
		if (ec_watch_wait(&link->acyclic, me, &h->x.done, jiffies_to_usecs(left)))
			return true;
	return try_wait_for_completion(&h->x.done);
}

static bool wait_once(struct ec_links *l, struct half *h)
{
	struct ec_watcher me;
	bool done;

	ec_submit_wait_begin(l, &h->wait);
	ec_watch_begin(&l->link[0].acyclic, &me);
	done = wait_watched(l, h, &me);
	ec_watch_end(&l->link[0].acyclic, &me);
	return done;
}

/*
 * Are all frames of a half back? Only the time in which they could have come
 * back counts.
 */
static bool wait_half(struct ec_links *l, struct half *h)
{
	unsigned int n;

	for (n = 0; n < WAITS; n++) {
		if (wait_once(l, h))
			return true;
		/* it is late: some devices know only by a look that their link is down */
		if (!ec_link_look(&l->link[0]) || !ec_submit_wait_more(l, &h->wait))
			break;
	}
	ec_access_poll(l);
	return try_wait_for_completion(&h->x.done);
}

/* Wait for the frames of a half and take their results. */
static void finish_half(struct ec_links *l, struct half *h, struct ec_dg *dg)
{
	unsigned int i;

	if (!wait_half(l, h)) {
		give_up(l, h);
		wait_for_completion(&h->x.done);
	}
	for (i = 0; i < h->frames; i++) {
		collect(&h->f[i], dg);
		put_slot(l, &h->f[i]);
	}
	h->frames = 0;
}

/* All datagrams that are in progress, once. */
static void exchange(struct ec_links *l, struct half *half, struct ec_dg *dg, unsigned int n)
{
	unsigned int i, first = 0, cur = 0;
	bool stop = false;
	int err = 0;

	half[0].frames = 0;
	half[1].frames = 0;
	for (;;) {
		struct half *h = &half[cur], *other = &half[!cur];

		if (h->frames)
			finish_half(l, h, dg);
		if (first < n && !stop) {
			first = send_half(l, h, dg, first, n, !other->frames);
			err = h->err;
			stop = h->stop;
		}
		if (!h->frames && !other->frames)
			break;
		cur = !cur;
	}
	/* no place became free, or the caller was killed */
	for (i = first; i < n; i++)
		if (dg[i].err == -EINPROGRESS)
			dg[i].err = err;
}

static int transfer(struct ec_links *l, struct ec_dg *dg, unsigned int n, bool urgent,
		    bool clock)
{
	struct half *half;
	unsigned int i, try, again;
	int ret = 0;

	for (i = 0; i < n; i++) {
		if (dg[i].len > EC_DGRAM_DATA_MAX)
			return -EMSGSIZE;
		dg[i].err = -EINPROGRESS;
	}
	half = kmalloc_array(2, sizeof(*half), GFP_KERNEL);
	if (!half)
		return -ENOMEM;
	for (i = 0; i < 2; i++) {
		half[i].urgent = urgent;
		half[i].clock = clock;
		half[i].wait.clock = clock;
	}
	for (try = 0; try < TRIES; try++) {
		/* a datagram that a slave never forwards must not take others with it twice */
		half[0].alone = try;
		half[1].alone = try;
		exchange(l, half, dg, n);
		for (i = 0, again = 0; i < n; i++) {
			if (dg[i].err == -ETIMEDOUT && dg[i].repeat && try < TRIES - 1) {
				dg[i].err = -EINPROGRESS;
				again++;
			}
		}
		if (!again)
			break;
	}
	kfree(half);
	for (i = 0; i < n && !ret; i++)
		ret = dg[i].err;
	return ret;
}

/**
 * ec_xfer() - exchange a batch of datagrams
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many; they are packed into as few frames as fit
 *
 * Repeatable datagrams are sent again when their frame is lost, others never.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 when every datagram came back (whatever its working counter), or
 * the error of the first that did not; -EMSGSIZE when one fits no frame, then
 * nothing was sent.
 */
int ec_xfer(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	return transfer(l, dg, n, false, false);
}

/**
 * ec_xfer_all() - exchange datagrams in each of which one slave must take part
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EIO when a working counter is not 1; or as ec_xfer().
 */
int ec_xfer_all(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	int ret = ec_xfer(l, dg, n);
	unsigned int i;

	for (i = 0; i < n && !ret; i++)
		if (dg[i].wkc != 1)
			ret = -EIO;
	return ret;
}

/**
 * ec_xfer_urgent() - exchange a few datagrams before all others
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many
 *
 * For the monitor: it must see the bus while many others are at work.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_xfer().
 */
int ec_xfer_urgent(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	return transfer(l, dg, n, true, false);
}

/**
 * ec_xfer_clock() - exchange datagrams that set or compensate clocks
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many
 *
 * They may be many: a cyclic send carries fewer of them than of other frames, and
 * others do not wait behind them.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_xfer().
 */
int ec_xfer_clock(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	return transfer(l, dg, n, false, true);
}

/**
 * ec_xfer_one() - exchange one repeatable datagram
 * @l: links
 * @cmd: enum ec_cmd
 * @adp: low half of the address
 * @ado: high half of the address
 * @data: data, sent or filled by @cmd
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: working counter, or -errno as in struct ec_dg.
 */
int ec_xfer_one(struct ec_links *l, u8 cmd, u16 adp, u16 ado, void *data, u16 len)
{
	struct ec_dg dg = EC_DG(cmd, adp, ado, len, data);
	int ret = ec_xfer(l, &dg, 1);

	return ret ? ret : dg.wkc;
}

/**
 * ec_xfer_fprd() - read registers of one slave
 * @l: links
 * @station: station address
 * @ado: register
 * @data: result
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EIO when the slave did not take part, or as ec_xfer().
 */
int ec_xfer_fprd(struct ec_links *l, u16 station, u16 ado, void *data, u16 len)
{
	int ret = ec_xfer_one(l, EC_CMD_FPRD, station, ado, data, len);

	return ret < 0 ? ret : ret == 1 ? 0 : -EIO;
}

/**
 * ec_xfer_fpwr() - write registers of one slave; may be executed twice
 * @l: links
 * @station: station address
 * @ado: register
 * @data: value
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EIO when the slave did not take part, or as ec_xfer().
 */
int ec_xfer_fpwr(struct ec_links *l, u16 station, u16 ado, const void *data, u16 len)
{
	int ret = ec_xfer_one(l, EC_CMD_FPWR, station, ado, (void *)data, len);

	return ret < 0 ? ret : ret == 1 ? 0 : -EIO;
}
