// SPDX-License-Identifier: GPL-2.0-only
/*
 * Ethernet frames through the mailbox of a slave (ETG.1000.6 clause 5.7). Two users of the mailbox
 * queue carry them, so requests of other protocols come in between.
 */
#include <linux/etherdevice.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../base/once64.h"
#include "../mailbox/mailbox.h"
#include "../wire/eoe.h"
#include "netdev.h"
#include "port.h"

#define STALE_NS	NSEC_PER_SEC	/* then an incomplete frame is dropped */

static void port_add(struct ec_eoe_port *p, u64 *count, u64 n)
{
	lockdep_assert_held(&p->lock);
	ec_write64(count, *count + n);
}

static void port_kick(struct ec_eoe_port *p)
{
	lockdep_assert_held(&p->lock);
	/* not on the CPU of the cycle, which may be isolated */
	if (p->attached)
		queue_work(system_unbound_wq, &p->work);
}

static void port_fail(struct ec_eoe_port *p, int err)
{
	lockdep_assert_held(&p->lock);
	p->err = p->err ?: err;
	port_kick(p);
}

/* to the slave --------------------------------------------------------------*/

static u16 mailbox_size(const struct ec_mbox *mb)
{
	return min_t(u16, mb->box.sii->std.rx_size, EC_MBOX_MAX);
}

/* Cut the next fragment of the present frame. */
static void cut(struct ec_eoe_port *p)
{
	const struct sk_buff *skb = p->ways->frames[p->sent % EC_EOE_FRAMES];
	struct ec_eoe_fragment f = { .frame = p->frame & 15 };

	lockdep_assert_held(&p->lock);
	p->cut = ec_eoe_fragment_cut(&f, skb->data, skb->len, p->at, p->number,
				     mailbox_size(p->mb));
	p->tx.len = ec_eoe_fragment_encode(p->ways->tx_data, sizeof(p->ways->tx_data), &f);
}

/* A fragment is in the mailbox, or lost; true: @tx has the next one. */
static bool tx_advance(struct ec_eoe_port *p)
{
	const struct sk_buff *skb = p->ways->frames[p->sent % EC_EOE_FRAMES];

	lockdep_assert_held(&p->lock);
	port_add(p, &p->counts.tx_fragments, 1);
	p->at += p->cut;
	p->number++;
	if (p->at >= skb->len) {
		port_add(p, &p->counts.tx_frames, 1);
		port_add(p, &p->counts.tx_bytes, skb->len);
		p->at = 0;
		p->number = 0;
		p->frame++;
		WRITE_ONCE(p->sent, p->sent + 1);
		port_kick(p);
	}
	p->busy = p->attached && p->sent != p->given;
	if (p->busy)
		cut(p);
	return p->busy;
}

/* A fragment that is lost costs its frame alone: the slave drops it for the gap. */
static void tx_done(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	struct ec_eoe_port *p = container_of(u, struct ec_eoe_port, tx);
	bool next = false;

	raw_spin_lock(&p->lock);
	if (u->err && u->err != -ENOTRECOVERABLE) {
		p->busy = false;
		port_fail(p, u->err);
	} else {
		port_add(p, &p->counts.tx_lost, !!u->err);
		next = tx_advance(p);
		/* it has to leave first */
		if (next && u->err) {
			p->again = true;
			port_kick(p);
			next = false;
		}
	}
	raw_spin_unlock(&p->lock);
	if (next)
		ec_desk_again(mb, u);
}

/* Give the fragment that is cut to the mailbox. */
static void tx_enter(struct ec_eoe_port *p)
{
	if (p->tx.phase != EC_MBOX_USER_IDLE)
		ec_desk_leave(p->mb, &p->tx, false);
	ec_desk_enter(p->mb, &p->tx);
}

/**
 * ec_eoe_port_send() - send a frame to the slave
 * @p: port; one caller at a time, and none after ec_eoe_port_close() and a wait for it
 * @skb: linear frame from the destination address on, without checksum; it belongs to the port
 *	if this returns 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; -EBUSY: too many frames wait; -ENETDOWN.
 */
int ec_eoe_port_send(struct ec_eoe_port *p, struct sk_buff *skb)
{
	bool begin = false;
	unsigned long flags;
	int ret = 0;

	raw_spin_lock_irqsave(&p->lock, flags);
	if (!p->attached || p->err) {
		ret = -ENETDOWN;
	} else if (p->given - p->freed == EC_EOE_FRAMES) {
		ret = -EBUSY;
	} else {
		p->ways->frames[p->given % EC_EOE_FRAMES] = skb;
		WRITE_ONCE(p->given, p->given + 1);
		begin = !p->busy;
		p->busy = true;
		if (begin)
			cut(p);
	}
	raw_spin_unlock_irqrestore(&p->lock, flags);
	if (begin)
		tx_enter(p);
	return ret;
}

/**
 * ec_eoe_port_waiting() - how many frames wait for the mailbox
 * @p: port
 *
 * Context: Any. RT-safe.
 * Return: frames, those that are sent but not freed among them.
 */
u32 ec_eoe_port_waiting(const struct ec_eoe_port *p)
{
	u32 freed = READ_ONCE(p->freed);

	return READ_ONCE(p->given) - freed;
}

/**
 * ec_eoe_port_has_room() - may a frame be given?
 * @p: port
 *
 * Context: Any. RT-safe.
 * Return: whether ec_eoe_port_send() would have room for it.
 */
bool ec_eoe_port_has_room(const struct ec_eoe_port *p)
{
	return ec_eoe_port_waiting(p) < EC_EOE_FRAMES;
}

/* Free the frames that are sent. */
static void free_sent(struct ec_eoe_port *p)
{
	u32 freed = p->freed, sent;

	raw_spin_lock_irq(&p->lock);
	sent = p->sent;
	raw_spin_unlock_irq(&p->lock);
	if (sent == freed)
		return;
	for (; freed != sent; freed++)
		consume_skb(p->ways->frames[freed % EC_EOE_FRAMES]);
	raw_spin_lock_irq(&p->lock);
	WRITE_ONCE(p->freed, sent);
	raw_spin_unlock_irq(&p->lock);
	ec_eoe_netdev_room(p);
}

/* of the slave --------------------------------------------------------------*/

static void rx_done(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	struct ec_eoe_port *p = container_of(u, struct ec_eoe_port, rx);

	raw_spin_lock(&p->lock);
	if (u->err == -EBADMSG) {
		port_add(p, &p->counts.rx_errors, 1);
	} else if (u->err) {
		port_fail(p, u->err);
	} else if (u->got_type == EC_MBOX_ERR) {
		/* it costs a frame: the slave drops the others of its fragments */
		port_add(p, &p->counts.refused, 1);
	} else if (u->got_type == EC_MBOX_EOE) {
		/* one entry is where the next message is written */
		if (p->got + 1 - p->taken == EC_EOE_MESSAGES) {
			port_add(p, &p->counts.rx_missed, 1);
		} else {
			p->ways->messages[p->got++ % EC_EOE_MESSAGES].len = u->got;
			u->rx = p->ways->messages[p->got % EC_EOE_MESSAGES].data;
		}
		port_kick(p);
	}
	raw_spin_unlock(&p->lock);
	ec_desk_again(mb, u);
}

static void port_count(struct ec_eoe_port *p, u64 *count)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&p->lock, flags);
	port_add(p, count, 1);
	raw_spin_unlock_irqrestore(&p->lock, flags);
}

/* A frame is lost, which counts once however many of its fragments come. */
static void rx_lost(struct ec_eoe_port *p, u8 frame)
{
	if (!(p->broken & BIT(frame)))
		port_count(p, &p->counts.rx_errors);
	p->broken |= BIT(frame);
}

static void drop_open(struct ec_eoe_port *p, struct ec_eoe_open *o, u8 frame)
{
	rx_lost(p, frame);
	kfree_skb(o->skb);
	o->skb = NULL;
	o->part.open = false;
}

/* The incomplete frame of a number; else a free entry, or that of the oldest. */
static struct ec_eoe_open *find_begun(struct ec_eoe_port *p, u8 frame, u64 now)
{
	struct ec_eoe_open *o, *best = NULL;

	for (o = p->ways->open; o < p->ways->open + EC_EOE_OPEN; o++) {
		if (o->skb && now - o->since_ns > STALE_NS)
			drop_open(p, o, o->part.frame);
		if (o->skb && o->part.frame == frame)
			return o;
		if (!best || (best->skb && (!o->skb || o->since_ns < best->since_ns)))
			best = o;
	}
	return best;
}

/* One fragment of the slave. */
static void rx_fragment(struct ec_eoe_port *p, const struct ec_eoe_fragment *f)
{
	u64 now = ktime_get_ns();
	struct ec_eoe_open *o = find_begun(p, f->frame, now);
	int ret;

	if (f->number) {
		/* without its begin */
		if (!o->skb || o->part.frame != f->frame)
			return rx_lost(p, f->frame);
	} else {
		/* what was incomplete under its number, or is the oldest, is lost */
		if (o->skb)
			drop_open(p, o, o->part.frame);
		p->broken &= ~BIT(f->frame);
		o->skb = alloc_skb(NET_IP_ALIGN + EC_EOE_FRAME_MAX, GFP_KERNEL);
		if (!o->skb)
			return port_count(p, &p->counts.rx_dropped);
		skb_reserve(o->skb, NET_IP_ALIGN);
	}
	o->since_ns = now;
	ret = ec_eoe_part_add(&o->part, o->skb->data, EC_EOE_FRAME_MAX, f);
	if (ret < 0 || (ret && ret < ETH_HLEN)) {
		drop_open(p, o, f->frame);
	} else if (ret) {
		struct sk_buff *skb = o->skb;

		o->skb = NULL;
		skb_put(skb, ret);
		ec_eoe_netdev_deliver(p, skb);
	}
}

static void rx_message(struct ec_eoe_port *p, const struct ec_eoe_message *m)
{
	struct ec_eoe_fragment f;
	int ret = ec_eoe_fragment_decode(m->data, m->len, &f);

	if (!ret)
		rx_fragment(p, &f);
	else if (ret != -ENOMSG)
		port_count(p, &p->counts.rx_errors);
}

/* Those that come meanwhile queue the work once more. */
static void take_messages(struct ec_eoe_port *p)
{
	u32 got;

	raw_spin_lock_irq(&p->lock);
	got = p->got;
	raw_spin_unlock_irq(&p->lock);
	while (p->taken != got) {
		rx_message(p, &p->ways->messages[p->taken % EC_EOE_MESSAGES]);
		raw_spin_lock_irq(&p->lock);
		p->taken++;
		port_add(p, &p->counts.rx_fragments, 1);
		raw_spin_unlock_irq(&p->lock);
	}
}

/* ---------------------------------------------------------------------------*/

static void port_work(struct work_struct *work)
{
	struct ec_eoe_port *p = container_of(work, struct ec_eoe_port, work);
	bool again;
	int err;

	take_messages(p);
	free_sent(p);
	raw_spin_lock_irq(&p->lock);
	again = p->again;
	p->again = false;
	err = p->err;
	raw_spin_unlock_irq(&p->lock);
	if (err)
		ec_eoe_netdev_failed(p);
	else if (again)
		tx_enter(p);
}

/**
 * ec_eoe_port_stands() - has a frame waited since the last call, and none left?
 * @p: port; one caller
 *
 * Context: Process.
 * Return: whether the slave has not taken any.
 */
bool ec_eoe_port_stands(struct ec_eoe_port *p)
{
	u32 sent = READ_ONCE(p->sent), stood = p->stood;

	p->stood = sent;
	return sent == stood && READ_ONCE(p->given) != sent;
}

/**
 * ec_eoe_runs() - can a slave exchange frames in its state?
 * @mb: its mailbox
 *
 * Context: Any. RT-safe.
 * Return: whether it is in PREOP, SAFEOP or OP.
 */
bool ec_eoe_runs(const struct ec_mbox *mb)
{
	return !ec_box_is_off(&mb->box) && ec_mbox_area(mb) == &mb->box.sii->std;
}

/**
 * ec_eoe_port_init() - prepare a port
 * @p: zeroed structure
 *
 * Context: Any.
 */
void ec_eoe_port_init(struct ec_eoe_port *p)
{
	raw_spin_lock_init(&p->lock);
	INIT_WORK(&p->work, port_work);
	p->tx = (struct ec_mbox_user){ .done = tx_done, .type = EC_MBOX_EOE };
	p->rx = (struct ec_mbox_user){ .done = rx_done, .type = EC_MBOX_EOE };
}

/**
 * ec_eoe_port_attach() - frames go to a slave from now on, and come from it
 * @p: port that is not attached
 * @mb: mailbox of the slave, until ec_eoe_port_detach() has returned
 *
 * Context: Process. May sleep.
 * Return: 0; -EPROTONOSUPPORT: no EoE; -EMSGSIZE: its mailbox is too small; -EAGAIN: it is in
 * INIT or BOOT; -ENOMEM.
 */
int ec_eoe_port_attach(struct ec_eoe_port *p, struct ec_mbox *mb)
{
	int ret = ec_mbox_check(mb, EC_SII_PROTO_EOE, EC_EOE_HDR + EC_EOE_UNIT);

	if (!ret && !ec_eoe_runs(mb))
		ret = -EAGAIN;
	ret = ret ?: ec_box_get_memory(&mb->box);
	if (ret)
		return ret;
	p->ways = kvzalloc(sizeof(*p->ways), GFP_KERNEL);
	if (!p->ways)
		return -ENOMEM;
	p->mb = mb;
	p->err = 0;
	p->again = false;
	p->busy = false;
	p->given = 0;
	p->sent = 0;
	p->freed = 0;
	p->at = 0;
	p->number = 0;
	p->got = 0;
	p->taken = 0;
	p->broken = 0;
	p->tx.tx = p->ways->tx_data;
	p->rx.rx = p->ways->messages[0].data;
	raw_spin_lock_irq(&p->lock);
	p->attached = true;
	raw_spin_unlock_irq(&p->lock);
	ec_desk_enter(mb, &p->rx);
	return 0;
}

/**
 * ec_eoe_port_close() - take no frame any more
 * @p: port
 *
 * Context: Any. RT-safe.
 */
void ec_eoe_port_close(struct ec_eoe_port *p)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&p->lock, flags);
	p->attached = false;
	raw_spin_unlock_irqrestore(&p->lock, flags);
}

/**
 * ec_eoe_port_detach() - leave the slave
 * @p: port after ec_eoe_port_close(), ec_eoe_port_send() does not run
 *
 * Frames that wait are dropped.
 *
 * Context: Process, but not the work of the port, for which it waits.
 */
void ec_eoe_port_detach(struct ec_eoe_port *p)
{
	unsigned int i;
	u32 n;

	if (!p->mb)
		return;
	cancel_work_sync(&p->work);
	if (p->tx.phase != EC_MBOX_USER_IDLE)
		ec_desk_leave(p->mb, &p->tx, false);
	ec_desk_leave(p->mb, &p->rx, false);
	raw_spin_lock_irq(&p->lock);
	port_add(p, &p->counts.tx_dropped, p->given - p->sent);
	raw_spin_unlock_irq(&p->lock);
	for (n = p->freed; n != p->given; n++)
		kfree_skb(p->ways->frames[n % EC_EOE_FRAMES]);
	WRITE_ONCE(p->freed, n);
	for (i = 0; i < EC_EOE_OPEN; i++)
		kfree_skb(p->ways->open[i].skb);
	p->mb = NULL;
	kvfree(p->ways);
	p->ways = NULL;
}

/**
 * ec_eoe_port_counts() - statistics
 * @p: port
 * @counts: result
 *
 * Context: Any. RT-safe.
 */
void ec_eoe_port_counts(const struct ec_eoe_port *p, struct ec_eoe_counts *counts)
{
	const u64 *from = (const u64 *)&p->counts;
	u64 *to = (u64 *)counts;
	unsigned int i;

	for (i = 0; i < sizeof(*counts) / sizeof(u64); i++)
		to[i] = ec_read64(&from[i]);
}
