// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "config.h"
#include "cycle.h"
#include "device.h"
#include "domain.h"
#include "master.h"
#include "session.h"
#include "slave.h"
#include "xfer.h"

/* owner of the links -------------------------------------------------------*/

static void own_devices(struct ec_master *m, bool cycle)
{
	unsigned int i;

	for (i = 0; i < EC_MAX_LINKS; i++) {
		struct ecdev *dev = m->link[i].dev;

		if (dev && dev->ops->cycle)
			dev->ops->cycle(dev->priv, cycle);
	}
}

/* A frame left for the cyclic caller; its waiter may give up at any time. */
static int xq_push(struct ec_master *m, struct ec_slot *slot)
{
	unsigned long flags;
	int ret = -EBUSY;

	raw_spin_lock_irqsave(&m->xq_lock, flags);
	if (m->xq_head - m->xq_tail < EC_SLOTS) {
		m->xq[m->xq_head++ % EC_SLOTS] =
			(struct ec_queued){ .slot = slot, .seq = slot->seq };
		ret = 0;
	}
	raw_spin_unlock_irqrestore(&m->xq_lock, flags);
	return ret;
}

/* The oldest frame somebody still waits for, or NULL; stays in the queue. */
static struct ec_slot *xq_peek(struct ec_master *m)
{
	struct ec_slot *slot = NULL;
	unsigned long flags;

	raw_spin_lock_irqsave(&m->xq_lock, flags);
	for (; m->xq_head != m->xq_tail; m->xq_tail++) {
		const struct ec_queued *q = &m->xq[m->xq_tail % EC_SLOTS];

		if (atomic_read_acquire(&q->slot->state) == EC_SLOT_SENT &&
		    q->slot->seq == q->seq) {
			slot = q->slot;
			break;
		}
	}
	raw_spin_unlock_irqrestore(&m->xq_lock, flags);
	return slot;
}

static void xq_drop(struct ec_master *m)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&m->xq_lock, flags);
	if (m->xq_head != m->xq_tail)
		m->xq_tail++;
	raw_spin_unlock_irqrestore(&m->xq_lock, flags);
}

/* Nobody shall wait for a frame that was not sent. */
static void disarm(struct ec_slot *slot, u64 now)
{
	if (ec_slot_cancel(slot, now))
		atomic_set_release(&slot->state, EC_SLOT_BUILD);
}

/* Send a built frame; the slot is back in BUILD on failure. */
static int transmit(struct ec_master *m, struct ec_slot *slot)
{
	struct ec_link *link = &m->link[0];
	u64 now = ktime_get_ns();
	int ret;

	ec_slot_arm(&m->slots, slot, link->side, now);
	ret = ec_link_send(link, slot);
	if (ret)
		disarm(slot, now);
	return ret;
}

/*
 * What was left in the queue goes out now. When a send fails the waiter runs
 * into its time limit: the slot is his, not ours.
 */
static void flush(struct ec_master *m)
{
	struct ec_slot *slot;

	while ((slot = xq_peek(m))) {
		ec_link_send(&m->link[0], slot);
		xq_drop(m);
	}
}

/**
 * ec_cycle_own() - hand the links to the cyclic caller or back to everybody
 * @m: master
 * @owner: new owner
 *
 * Waits until the cyclic caller has left the links.
 *
 * Context: Process. May sleep.
 */
void ec_cycle_own(struct ec_master *m, enum ec_owner owner)
{
	rt_mutex_lock(&m->io_lock);
	if (m->owner != owner) {
		WRITE_ONCE(m->last_send_ns, ktime_get_ns());
		WRITE_ONCE(m->owner, owner);
		smp_mb();	/* owner before cycle_busy; pairs with enter() */
		while (owner == EC_OWNER_IDLE && atomic_read(&m->cycle_busy))
			usleep_range(20, 50);
		own_devices(m, owner == EC_OWNER_CYCLE);
		if (owner == EC_OWNER_IDLE)
			flush(m);
	}
	rt_mutex_unlock(&m->io_lock);
}

/* The cyclic caller takes the links for one call; reclaims them after a stall. */
static void enter(struct ec_master *m)
{
	for (;;) {
		atomic_set(&m->cycle_busy, 1);
		smp_mb();	/* cycle_busy before owner; pairs with ec_cycle_own() */
		if (READ_ONCE(m->owner) == EC_OWNER_CYCLE)
			return;
		atomic_set(&m->cycle_busy, 0);
		ec_cycle_own(m, EC_OWNER_CYCLE);
	}
}

static void leave(struct ec_master *m)
{
	atomic_set_release(&m->cycle_busy, 0);
}

/**
 * ec_cycle_stalled() - has the cyclic caller stopped sending?
 * @m: master in cycle mode
 *
 * Context: Process.
 * Return: true after max(10 periods, 20 ms) without a send.
 */
bool ec_cycle_stalled(struct ec_master *m)
{
	u64 limit = max_t(u64, 10ULL * m->interval_us * NSEC_PER_USEC, 20 * NSEC_PER_MSEC);

	return ktime_get_ns() - READ_ONCE(m->last_send_ns) > limit;
}

/**
 * ec_cycle_timeout_us() - how long ec_xfer() waits for its frames
 * @m: master
 *
 * In cycle mode frames first wait for their turn.
 *
 * Context: Any.
 * Return: microseconds.
 */
u32 ec_cycle_timeout_us(const struct ec_master *m)
{
	if (READ_ONCE(m->owner) == EC_OWNER_IDLE)
		return m->io_timeout_us;
	return m->io_timeout_us + 100 * max(m->interval_us, 1000u);
}

/**
 * ec_cycle_submit() - send an acyclic frame, now or with the next cycle
 * @m: master
 * @slot: built frame
 *
 * Context: Process. May sleep on the link's lock.
 * Return: 0, -ENODEV, -ENETDOWN, -EBUSY; the slot is in BUILD on failure.
 */
int ec_cycle_submit(struct ec_master *m, struct ec_slot *slot)
{
	u64 now = ktime_get_ns();
	int ret;

	rt_mutex_lock(&m->io_lock);
	if (READ_ONCE(m->owner) == EC_OWNER_IDLE) {
		ret = transmit(m, slot);
	} else {
		/* the waiter may give up from now on */
		ec_slot_arm(&m->slots, slot, 0, now);
		ret = xq_push(m, slot);
		if (ret)
			disarm(slot, now);
	}
	rt_mutex_unlock(&m->io_lock);
	return ret;
}

/* layout ---------------------------------------------------------------------*/

/* one stretch of a domain that becomes one datagram, or LRD plus LWR */
struct stretch {
	u32 start;
	u32 end;
	unsigned int first;	/* FMMU reference in the domain */
	unsigned int last;	/* behind the last one */
};

static bool no_lrw(const struct ec_config *c)
{
	const struct ec_slave *s = c->slave;

	return s && (ec_slave_features(s) & EC_FEAT_NO_LRW ||
		     (s->has_general && s->general.flags & EC_SII_FLAG_NO_LRW));
}

static const struct ec_config_fmmu *fmmu(const struct ec_domain *d, unsigned int i)
{
	return &d->fmmus[i].config->fmmus[d->fmmus[i].fmmu];
}

/* Slaves with data of @dir in the stretch; each counts once. */
static u16 count_slaves(const struct ec_domain *d, const struct stretch *st, u8 dir)
{
	unsigned int i, j;
	u16 n = 0;

	for (i = st->first; i < st->last; i++) {
		if (fmmu(d, i)->dir != dir || !fmmu(d, i)->size)
			continue;
		for (j = st->first; j < i; j++)
			if (d->fmmus[j].config == d->fmmus[i].config && fmmu(d, j)->dir == dir &&
			    fmmu(d, j)->size)
				break;
		n += j == i;
	}
	return n;
}

static int add_dgram(struct ec_cycle *c, const struct ec_domain *d, const struct stretch *st,
		     u8 cmd, u16 expected)
{
	struct ec_cyc_dgram *g;

	if (c->n_dgrams >= EC_MAX_CYCLE_DGRAMS)
		return -EOVERFLOW;
	g = krealloc_array(c->dgrams, c->n_dgrams + 1, sizeof(*g), GFP_KERNEL);
	if (!g)
		return -ENOMEM;
	c->dgrams = g;
	g += c->n_dgrams++;
	*g = (struct ec_cyc_dgram){
		.domain = d->index, .cmd = cmd, .logical = d->logical + st->start,
		.offset = d->offset + st->start, .len = st->end - st->start,
		.expected = expected,
	};
	return 0;
}

static int add_inputs(struct ec_cycle *c, const struct ec_domain *d, const struct stretch *st)
{
	unsigned int i;

	for (i = st->first; i < st->last; i++) {
		const struct ec_config_fmmu *f = fmmu(d, i);
		u32 from = max(f->offset, st->start), to = min(f->offset + f->size, st->end);
		struct ec_cyc_input *in;

		if (f->dir != EC_CFG_DIR_INPUT || from >= to)
			continue;
		in = krealloc_array(c->inputs, c->n_inputs + 1, sizeof(*in), GFP_KERNEL);
		if (!in)
			return -ENOMEM;
		c->inputs = in;
		in[c->n_inputs++] = (struct ec_cyc_input){
			.dgram = c->n_dgrams - 1, .offset = d->offset + from, .len = to - from,
		};
	}
	return 0;
}

static int add_stretch(struct ec_cycle *c, struct ec_domain *d, const struct stretch *st)
{
	u16 out = count_slaves(d, st, EC_CFG_DIR_OUTPUT);
	u16 in = count_slaves(d, st, EC_CFG_DIR_INPUT);
	bool split = false;
	unsigned int i;
	int ret = 0;

	for (i = st->first; i < st->last; i++)
		split |= no_lrw(d->fmmus[i].config);
	if (out && in && !split) {
		d->expected += 2 * out + in;
		return add_dgram(c, d, st, EC_CMD_LRW, 2 * out + in) ?: add_inputs(c, d, st);
	}
	d->expected += out + in;
	if (out)
		ret = add_dgram(c, d, st, EC_CMD_LWR, out);
	if (in && !ret)
		ret = add_dgram(c, d, st, EC_CMD_LRD, in) ?: add_inputs(c, d, st);
	return ret;
}

/* Cut a domain into stretches that fit a datagram, between FMMUs where possible. */
static int layout_domain(struct ec_cycle *c, struct ec_domain *d)
{
	struct stretch st = { 0 };
	unsigned int i;
	int ret = 0;

	d->expected = 0;
	for (i = 0; i < d->n_fmmus && !ret; i++) {
		u32 end = fmmu(d, i)->offset + fmmu(d, i)->size;

		if (end - st.start > EC_DGRAM_DATA_MAX && st.end > st.start) {
			ret = add_stretch(c, d, &st);
			st.start = st.end;
			st.first = i;
		}
		st.last = i + 1;
		while (!ret && end - st.start > EC_DGRAM_DATA_MAX) {
			st.end = st.start + EC_DGRAM_DATA_MAX;
			ret = add_stretch(c, d, &st);
			st.start = st.end;
		}
		st.end = end;
	}
	if (!ret && st.end > st.start)
		ret = add_stretch(c, d, &st);
	return ret;
}

/**
 * ec_cycle_layout() - lay out the datagrams of a cycle, once
 * @s: session whose domains have offsets
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0, -EOVERFLOW beyond EC_MAX_CYCLE_DGRAMS, -ENOMEM.
 */
int ec_cycle_layout(struct ec_session *s)
{
	unsigned int i;
	int ret = 0;

	memset(&s->cycle, 0, sizeof(s->cycle));
	for (i = 0; i < s->n_domains && !ret; i++)
		ret = layout_domain(&s->cycle, s->domains[i]);
	if (ret)
		ec_cycle_free(s->master, &s->cycle);
	return ret;
}

/* Nobody will receive what is still on its way. */
static void forget_flights(struct ec_master *m, struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->n_flight; i++) {
		struct ec_slot *slot = c->flight[i].slot;

		while (!ec_slot_cancel(slot, ktime_get_ns())) {
			if (atomic_read_acquire(&slot->state) == EC_SLOT_DONE) {
				ec_slot_put(&m->slots, slot, true);
				break;
			}
			/* being copied at this moment */
			usleep_range(20, 50);
		}
	}
	c->n_flight = 0;
}

/**
 * ec_cycle_free() - give back what a layout and its frames occupy
 * @m: master
 * @c: layout nobody uses any more
 *
 * Context: Process. May sleep.
 */
void ec_cycle_free(struct ec_master *m, struct ec_cycle *c)
{
	forget_flights(m, c);
	kfree(c->dgrams);
	kfree(c->inputs);
	memset(c, 0, sizeof(*c));
}

/* cycle ----------------------------------------------------------------------*/

static void take_dgram(struct ec_session *s, unsigned int g, const u8 *data)
{
	const struct ec_cyc_dgram *d = &s->cycle.dgrams[g];
	u16 wkc = get_unaligned_le16(data + d->len);
	unsigned int i;

	s->shared->status->domains[d->domain].working_counter += wkc;
	if (!wkc)
		return;
	/* a missing slave's part comes back as sent: the last value */
	for (i = 0; i < s->cycle.n_inputs; i++) {
		const struct ec_cyc_input *in = &s->cycle.inputs[i];

		if (in->dgram == g)
			memcpy(s->shared->image + in->offset, data + in->offset - d->offset,
			       in->len);
	}
}

static void judge(struct ec_status_domain *d)
{
	u32 wkc = d->working_counter;

	WRITE_ONCE(d->wc_state, !wkc ? 0 : wkc == d->expected ? 2 : 1);
}

/**
 * ec_cycle_receive() - take what the last sends have brought back
 * @s: active session
 *
 * Inputs go to the image, working counters to the status page. Frames that
 * are not back within the time limit are lost.
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_receive(struct ec_session *s)
{
	struct ec_master *m = s->master;
	struct ec_cycle *c = &s->cycle;
	u64 now, limit = (u64)m->io_timeout_us * NSEC_PER_USEC;
	unsigned int i, k, left = 0;

	if (!READ_ONCE(m->link[0].dev))
		return -ENODEV;
	enter(m);
	ec_link_poll(&m->link[0]);
	now = ktime_get_ns();
	for (i = 0; i < s->n_domains; i++)
		s->shared->status->domains[i].working_counter = 0;
	for (i = 0; i < c->n_flight; i++) {
		struct ec_cyc_flight *f = &c->flight[i];

		if (atomic_read_acquire(&f->slot->state) == EC_SLOT_DONE) {
			for (k = 0; k < f->count; k++)
				take_dgram(s, f->first + k, ec_slot_body(f->slot) + f->pos[k]);
			ec_slot_put(&m->slots, f->slot, true);
		} else if (now - f->slot->sent_ns > limit && ec_slot_cancel(f->slot, now)) {
			atomic64_inc(&m->link[0].stats.lost);
		} else {
			c->flight[left++] = *f;
		}
	}
	c->n_flight = left;
	for (i = 0; i < s->n_domains; i++)
		judge(&s->shared->status->domains[i]);
	WRITE_ONCE(s->shared->status->cycle, c->cycles);
	leave(m);
	return 0;
}

/* One frame from datagram @g on; returns the first datagram of the next. */
static unsigned int send_frame(struct ec_session *s, unsigned int g, u64 queued, u64 now,
			       u32 *wire_ns)
{
	struct ec_master *m = s->master;
	struct ec_cycle *c = &s->cycle;
	struct ec_cyc_flight *f = &c->flight[c->n_flight];
	struct ec_frame_buf fb;
	u8 *p;

	if (c->n_flight >= EC_CYC_FRAMES)
		return c->n_dgrams;
	f->slot = ec_slot_get(&m->slots, true, now);
	if (!f->slot) {
		atomic64_inc(&m->link[0].stats.tx_errors);
		return c->n_dgrams;
	}
	f->first = g;
	f->count = 0;
	ec_frame_begin(&fb, ec_slot_body(f->slot), EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	for (; g < c->n_dgrams && f->count < ARRAY_SIZE(f->pos) - 1; g++) {
		const struct ec_cyc_dgram *d = &c->dgrams[g];

		if (!(queued & BIT_ULL(d->domain)))
			break;
		p = ec_frame_add(&fb, d->cmd, f->slot->index, d->logical & 0xffff,
				 d->logical >> 16, d->len);
		if (!p)
			break;
		memcpy(p, s->shared->image + d->offset, d->len);
		f->pos[f->count++] = p - fb.buf;
	}
	f->slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
	*wire_ns += ec_frame_wire_ns(f->slot->eth_len);
	if (!transmit(m, f->slot))
		c->n_flight++;
	else
		ec_slot_put(&m->slots, f->slot, true);
	return g;
}

/* Frames others have left, as far as they fit before the next cycle. */
static void send_acyclic(struct ec_master *m, u32 wire_ns)
{
	u32 budget = m->interval_us * 900u;
	struct ec_slot *slot;
	bool first = true;

	while ((slot = xq_peek(m))) {
		wire_ns += ec_frame_wire_ns(slot->eth_len);
		if (wire_ns > budget && !first)
			break;
		first = false;
		ec_link_send(&m->link[0], slot);
		xq_drop(m);
	}
}

/**
 * ec_cycle_send() - send the queued domains, then what others have left
 * @s: active session
 * @queued: bit n: domain n
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: 0 or -ENODEV.
 */
int ec_cycle_send(struct ec_session *s, u64 queued)
{
	struct ec_master *m = s->master;
	struct ec_cycle *c = &s->cycle;
	u64 now = ktime_get_ns();
	unsigned int g = 0;
	u32 wire_ns = 0;

	if (!READ_ONCE(m->link[0].dev))
		return -ENODEV;
	enter(m);
	WRITE_ONCE(m->last_send_ns, now);
	while (g < c->n_dgrams) {
		if (queued & BIT_ULL(c->dgrams[g].domain))
			g = send_frame(s, g, queued, now, &wire_ns);
		else
			g++;
	}
	send_acyclic(m, wire_ns);
	c->cycles++;
	leave(m);
	return 0;
}
