// SPDX-License-Identifier: GPL-2.0-only
/*
 * Both ends of a break close by themselves, and stay closed when their cable has a link again: a
 * contact that bounces costs no more frames. The master opens both in one frame, of which each end
 * gets the copy of its side, once the link has been there without loss for a while.
 */
#include <linux/ktime.h>
#include <linux/string.h>
#include "../carry/xfer.h"
#include "../link/links.h"
#include "graph.h"
#include "known.h"
#include "ring_heal.h"
#include "scan_int.h"
#include "slave.h"

#define STABLE_NS	(100 * NSEC_PER_MSEC)	/* of link without loss at both ends */
#define ALONE_NS	(2 * STABLE_NS)	/* at one end: the other one may still get it */
#define UNASKED_NS	NSEC_PER_SEC	/* between reads if no event says that a port has changed */
#define FULL		0xff	/* of a counter, which hides what comes */

static bool may_hold(const struct ec_slave *s, unsigned int port)
{
	return !s->ports.fixed && ec_slave_port_type(s, port) >= 2 && !READ_ONCE(s->reply.silent) &&
	       READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED;
}

/* The only port at which a slave may have been, or 0. */
static u32 free_port(const struct ec_slave *s)
{
	u32 p, found = 0, n = 0;

	for (p = 1; p < EC_MAX_PORT; p++) {
		if (s->graph.at[p] || ec_slave_port_type(s, p) < 2)
			continue;
		found = p;
		n++;
	}
	return n == 1 ? found : 0;
}

/* The ports of two slaves between which the ring is open. One towards a device is none. */
static bool find_ends(const struct ec_bus *bus, struct ec_ring_end *end)
{
	u32 front = bus->links->ring.front, up = bus->break_at[0], port = bus->break_at[1];
	struct ec_slave *next, *before;

	if (!front || front >= bus->n_slaves)
		return false;
	next = bus->slaves[front];
	before = ec_graph_parent(next);
	if (before) {
		port = next->graph.parent_port;
	} else {
		/* the list is that of the open ring */
		if (front != bus->front || up >= front)
			return false;
		before = bus->slaves[up];
		/* the ring was not closed so far */
		port = port < EC_MAX_PORT ? port : free_port(before);
	}
	end[0] = (struct ec_ring_end){ .device = before->device, .port = port };
	end[1] = (struct ec_ring_end){ .device = next->device, .port = next->graph.upstream };
	return port && may_hold(before, port) && may_hold(next, end[1].port);
}

static bool are_same(const struct ec_ring_end *a, const struct ec_ring_end *b)
{
	return a->device == b->device && a->port == b->port;
}

static void set_ends(struct ec_bus *bus)
{
	struct ec_ring_end end[2], *is = bus->heal.end;

	if (find_ends(bus, end)) {
		if (!are_same(&end[0], &is[0]) || !are_same(&end[1], &is[1]))
			memcpy(is, end, sizeof(end));
	} else if (bus->links->ring.front == bus->front) {
		ec_ring_heal_forget(bus);
	}
}

static struct ec_slave *slave_of(const struct ec_bus *bus, const struct ec_ring_end *e)
{
	return ec_known_connected(bus, e->device);
}

/* as read last */
static bool has_link(const struct ec_bus *bus, const struct ec_ring_end *e)
{
	const struct ec_slave *s = slave_of(bus, e);

	return s && (s->dl_seen ?: s->dl_status) & EC_DLS_LINK(e->port);
}

/* Also by a read of another part, which has cleared the event. */
static u8 forget_lost(struct ec_bus *bus)
{
	struct ec_ring_heal *h = &bus->heal;
	u8 lost = 0;
	unsigned int i;

	for (i = 0; i < 2; i++) {
		if (has_link(bus, &h->end[i]))
			continue;
		h->end[i].link_ns = 0;
		lost |= BIT(i);
	}
	return lost;
}

/* The read has cleared the event: another port may have changed as well. */
static void note_end_dl(struct ec_slave *s, const struct ec_ring_end *e, u16 dl)
{
	u16 own = EC_DLS_LINK(e->port) | EC_DLS_LOOP(e->port) | EC_DLS_COMM(e->port);

	s->dl_seen = dl;
	if ((dl ^ s->dl_status) & EC_SCAN_PORTS & ~own)
		WRITE_ONCE(s->bus->renew, true);
}

static void note_link(struct ec_bus *bus, struct ec_ring_end *e, u8 lost, u64 now)
{
	bool stays = e->cleared && lost == FULL;

	if (!e->link_ns || (lost != e->lost && !stays))
		e->link_ns = now;
	e->lost = lost;
	e->cleared = stays;
	if (lost != FULL || stays)
		return;
	/* full counters do not show the next loss */
	e->cleared = !ec_xfer_fpwr(bus->links, slave_of(bus, e)->station, EC_REG_ERR_LOST(0), &lost,
				   1);
	e->lost = e->cleared ? 0 : FULL;
}

static void read_links(struct ec_bus *bus)
{
	struct ec_ring_end *e = bus->heal.end, *at[2];
	u8 v[2][2 + EC_MAX_PORT];
	struct ec_slave *s;
	struct ec_dg dg[4];
	unsigned int i, n = 0;
	u64 now;

	for (i = 0; i < 2; i++) {
		s = slave_of(bus, &e[i]);
		if (!s)
			continue;
		dg[2 * n] = EC_FPRD(s->station, EC_REG_DL_STATUS, 2, v[n]);
		dg[2 * n + 1] = EC_FPRD(s->station, EC_REG_ERR_LOST(0), EC_MAX_PORT, v[n] + 2);
		at[n++] = &e[i];
	}
	ec_xfer(bus->links, dg, 2 * n);
	now = bus->heal.read_ns = ktime_get_ns();
	for (i = 0; i < n; i++) {
		if (dg[2 * i].err || dg[2 * i + 1].err)
			continue;
		if (dg[2 * i].wkc != 1 || dg[2 * i + 1].wkc != 1) {
			at[i]->link_ns = 0;
			continue;
		}
		note_end_dl(slave_of(bus, at[i]), at[i], get_unaligned_le16(v[i]));
		note_link(bus, at[i], v[i][2 + at[i]->port], now);
	}
}

/* What is between two breaks may be connected to one of the ends alone. */
static void judge_ends(struct ec_ring_heal *h)
{
	const struct ec_ring_end *e = h->end;
	u64 now = ktime_get_ns(), least = e[0].link_ns && e[1].link_ns ? STABLE_NS : ALONE_NS;
	unsigned int i;

	h->open = 0;
	for (i = 0; i < 2; i++) {
		if (!e[i].link_ns)
			continue;
		if (now - e[i].link_ns < least) {
			h->open = 0;
			return;
		}
		h->open |= BIT(i);
	}
}

/**
 * ec_ring_heal_init() - before frames are sent
 * @bus: bus
 * @riders: of the master
 *
 * Context: Process.
 * Return: 0, or -ENOSPC.
 */
int ec_ring_heal_init(struct ec_bus *bus, struct ec_riders *riders)
{
	bus->heal.riders = riders;
	return ec_rider_register(riders, &bus->heal.rider[0]) ?:
		ec_rider_register(riders, &bus->heal.rider[1]);
}

/**
 * ec_ring_heal_look() - find the ends of a break while process data run, and when they may open
 * @bus: bus
 * @event: a slave has shown the event of its DL status
 *
 * ec_ring_heal_loops() has the result.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: whether another look is due soon: an end has a link.
 */
bool ec_ring_heal_look(struct ec_bus *bus, bool event)
{
	const struct ec_ring *r = &bus->links->ring;
	struct ec_ring_heal *h = &bus->heal;

	if (READ_ONCE(bus->links->only) || !READ_ONCE(bus->guarded) || READ_ONCE(bus->down)) {
		ec_ring_heal_forget(bus);
		return false;
	}
	/* it may look open meanwhile */
	if (READ_ONCE(r->measured))
		return h->end[0].device;
	/* else which slaves there are is not known before the next scan */
	if (r->state == EC_RING_OPEN && READ_ONCE(bus->responding) == bus->n_slaves)
		set_ends(bus);
	if (!h->end[0].device)
		return false;
	/* without an event they have not changed, unless a slave shows none */
	if (event || has_link(bus, &h->end[0]) || has_link(bus, &h->end[1]) ||
	    ktime_get_ns() - h->read_ns >= UNASKED_NS)
		read_links(bus);
	forget_lost(bus);
	judge_ends(h);
	if (h->open == (BIT(0) | BIT(1)) && r->state == EC_RING_CLOSED)
		ec_ring_heal_forget(bus);
	return h->end[0].link_ns || h->end[1].link_ns;
}

static bool end_is_held(const struct ec_slave *s, unsigned int port)
{
	return !s->ports.unsure && (s->ports.loops >> 2 * port & 3) == EC_LOOP_AUTO_CLOSE;
}

/**
 * ec_ring_heal_open() - the ports were read just now: open the ends if they still may
 * @bus: bus
 *
 * By the frame with the process data: one that arrives at an end which is closed while the other
 * one is open would be lost, and so no other one of the cycle follows it. What no cycle carries
 * remains to be written.
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_ring_heal_open(struct ec_bus *bus)
{
	struct ec_ring_heal *h = &bus->heal;
	unsigned int i, n = 0;

	if (h->open & forget_lost(bus))
		h->open = 0;
	for (i = 0; i < 2; i++) {
		const struct ec_slave *s = slave_of(bus, &h->end[i]);
		struct ec_rider *r = &h->rider[n];

		if (!(h->open & BIT(i)) || !s || !end_is_held(s, h->end[i].port))
			continue;
		r->cmd = EC_CMD_FPWR;
		r->adp = s->station;
		r->ado = EC_REG_DL_LOOPS;
		r->len = 1;
		r->data[0] = ec_loops_with(s->ports.loops, h->end[i].port, EC_LOOP_AUTO);
		n++;
	}
	if (n)
		ec_rider_exchange_all(h->riders, h->rider, n);
}

/**
 * ec_ring_heal_forget() - there is no break, or its ends open by themselves
 * @bus: bus
 *
 * Context: The monitor thread, or without it.
 */
void ec_ring_heal_forget(struct ec_bus *bus)
{
	memset(bus->heal.end, 0, sizeof(bus->heal.end));
	bus->heal.open = 0;
}

/**
 * ec_ring_heal_loops() - loop control of a slave, with the end of a break that is not to open
 * @s: slave of the list
 * @loops: without it
 *
 * Context: The monitor thread.
 * Return: value for register 0x0101.
 */
u8 ec_ring_heal_loops(const struct ec_slave *s, u8 loops)
{
	const struct ec_ring_heal *h = &s->bus->heal;
	unsigned int i;

	/* one that does not keep the value is not written, and reported, at each look */
	if (likely(!h->end[0].device) || s->ports.fixed)
		return loops;
	for (i = 0; i < 2; i++)
		if (h->end[i].device == s->device && !(h->open & BIT(i)))
			loops = ec_loops_with(loops, h->end[i].port, EC_LOOP_AUTO_CLOSE);
	return loops;
}
