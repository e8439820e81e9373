// SPDX-License-Identifier: GPL-2.0-only
/*
 * What is behind a closed port is made harmless before process data reach it: slave by slave, in
 * trials for which the port is open.
 */
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "graph.h"
#include "known.h"
#include "owed.h"
#include "ports.h"
#include "ports_lost.h"
#include "slave.h"
#include "trial.h"
#include "trial_int.h"

#define PASS_NS	2500	/* through a slave and 100 m of cable, both ways */
#define BRANCH	256	/* slaves that are let in together; the others after the next scan */
#define DEPTH	64	/* slaves one behind the other at which a branch begins */

/* Is it an address that a try before has given to the guest? */
static bool was_fresh(const struct ec_guest *g, u16 station)
{
	return (u16)(station - g->first) <= (u16)(g->station - g->first);
}

/* Take address and alias that the guest had. One of an earlier try, or trial, is not its own. */
static void take_address(const struct ec_trials *t, struct ec_guest *g, const u8 *read)
{
	u16 station = get_unaligned_le16(read);

	if (t->door && station && station == t->door->fresh)
		station = t->door->was;
	if (!was_fresh(g, station))
		put_unaligned_le16(station, g->station_was);
	memcpy(g->station_was + 2, read + 2, 2);
	if (!t->door)
		return;
	t->door->fresh = g->station;
	t->door->was = get_unaligned_le16(g->station_was);
}

/* If a slave of the bus had the address of the guest, it must reply there: else it is the guest. */
static int prove_other(const struct ec_trials *t, const struct ec_guest *g, u16 was)
{
	u8 station[2];

	if (!ec_known_is_present(t->bus, was) ||
	    !ec_xfer_fprd(t->bus->links, was, EC_REG_STATION, station, 2))
		return 0;
	ec_owed_note(t->bus, g->station, was);
	return -EAGAIN;
}

/* The first slave behind the port gets an address; -ENXIO: none replies; or as ec_trial_run(). */
static int greet(struct ec_trials *t, struct ec_guest *g)
{
	/* 0x0100 as after a reset; for a second */
	static const u8 all_closed[2] = { BIT(0) | EC_DL_TEMPORARY, 0xfc };
	const struct ec_dg *was;
	u16 adp = -t->position;
	u8 fresh[2], read[4] = { 0 };
	int ret;

	t->n = 0;
	if (!(t->dl & EC_DLS_LINK(t->port)))
		return -ENOLINK;
	/*
	 * A device behind the guest may let no frame return, but the guest executes what it gets.
	 * That no slave of the bus has its address is certain if all have replied.
	 */
	if (g->mute && t->count == t->bus->n_slaves) {
		g->mute = false;
		ec_trial_add(t, EC_FPWR(g->station, EC_REG_DL_CONTROL, 2, all_closed));
		ret = ec_trial_run(t, g->station);
		return ret == -ENOLINK ? ret : -EAGAIN;
	}
	/* each time another one: when frames are lost, any slave may have got it */
	g->station = ec_known_fresh_station(t->bus, NULL, NULL);
	if (!g->station)
		return -ENOSPC;
	put_unaligned_le16(g->station, fresh);
	was = ec_trial_add(t, EC_DG(EC_CMD_APRD, adp, EC_REG_STATION, 4, read));
	ec_trial_add(t, EC_DG(EC_CMD_APWR, adp, EC_REG_STATION, 2, fresh));
	t->was = read;
	ret = ec_trial_run(t, g->station);
	t->was = NULL;
	if (ret == -ENOBUFS)
		return ret;
	if (!was->err && was->wkc == 1)
		take_address(t, g, read);
	g->mute = was->err;
	if (!was->err && !was->wkc && ret != -ENOLINK)
		return -ENXIO;
	return ret ?: prove_other(t, g, get_unaligned_le16(g->station_was));
}

static int trial_ask(struct ec_trials *t, struct ec_guest *g)
{
	static const u8 latch[4];
	unsigned int i;
	u8 type = 0;
	int ret;

	t->n = 0;
	ec_trial_add(t, EC_FPWR(g->station, EC_REG_DC_RECV(0), 4, latch))->last = true;
	ec_trial_add(t, EC_FPRD(g->station, EC_REG_TYPE, EC_INFO_SIZE, g->info));
	ec_trial_add(t, EC_FPRD(g->station, EC_REG_DL_CONTROL, 2, g->control));
	ec_trial_add(t, EC_FPRD(g->station, EC_REG_DL_STATUS, 2, g->dl));
	ec_trial_add(t, EC_FPRD(g->station, EC_REG_DC_RECV(0), 16, g->times));
	ec_trial_add(t, EC_FPRD(g->station, EC_REG_AL_STATUS, 2, g->al));
	ec_trial_add(t, EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, &type));
	ret = ec_trial_run(t, g->station);
	g->behind = t->work[6].wkc > t->bus->n_slaves ? t->work[6].wkc - t->bus->n_slaves : 1;
	/* not every controller has receive times */
	for (i = 1; i < 4 && !ret; i++)
		ret = t->work[i].wkc == 1 ? 0 : -EAGAIN;
	if (!ret && t->work[4].wkc != 1)
		memset(g->times, 0, sizeof(g->times));
	return ret;
}

/*
 * The port by which frames come in: the open one that latched first; without receive times as in
 * graph.c.
 */
static u8 guest_entry(const struct ec_guest *g)
{
	bool has_times = memchr_inv(g->times, 0, sizeof(g->times));
	u8 open = ec_graph_open_ports(get_unaligned_le16(g->dl));
	int best = -1;
	unsigned int i;

	for (i = 0; i < EC_MAX_PORT; i++) {
		u8 p = ec_graph_order[i];

		if (open & BIT(p) &&
		    (best < 0 || (has_times ? (s32)(get_unaligned_le32(g->times + 4 * p) -
						    get_unaligned_le32(g->times + 4 * best)) < 0 :
				  best != 0)))
			best = p;
	}
	return max(best, 0);
}

/* All ports of the guest but port 0 and its entry closed */
static u8 guest_loops(const struct ec_guest *g)
{
	u8 loops = 0;
	unsigned int p;

	for (p = 1; p < EC_MAX_PORT; p++)
		if (p != g->entry)
			loops = ec_loops_with(loops, p, EC_LOOP_CLOSED);
	return loops;
}

static bool is_last(const struct ec_guest *g)
{
	return hweight8(ec_graph_open_ports(get_unaligned_le16(g->dl))) <= 1;
}

/*
 * Nothing of an earlier configuration is left that process data or a cycle could reach. And the
 * guest is alone: a frame passes a slave that is connected the wrong way round when it returns,
 * behind those at its port 0, so it is not the first one at its position.
 */
static int tame(struct ec_trials *t, struct ec_guest *g)
{
	static const u8 zero[EC_MAX_FMMU * EC_FMMU_PAGE];
	/* no acknowledge: a slave with device emulation would show it as an error; INIT ends one */
	static const u8 init[2] = { EC_AL_INIT };
	u16 fmmus = min_t(u16, g->info[EC_REG_FMMUS], EC_MAX_FMMU) * EC_FMMU_PAGE;
	const u8 tried[2] = { g->control[0] | EC_DL_TEMPORARY, guest_loops(g) };
	const u8 closed[2] = { g->control[0] & ~EC_DL_TEMPORARY, guest_loops(g) };
	u8 is[1] = { 0 }, kept[2], any[1];
	const struct ec_dg *count;
	u8 left[EC_MAX_FMMU * EC_FMMU_PAGE] = { 0 };
	unsigned int last;
	int ret;

	put_unaligned_le16(g->kept ?: g->station, kept);
	t->n = 0;
	/*
	 * In a frame of its own: its ports close behind that. For good only if it replies then:
	 * frames may have come in by another port than it seemed.
	 */
	ec_trial_add(t, EC_FPWR(g->station, EC_REG_DL_CONTROL, 2, tried))->last = true;
	ec_trial_add(t, EC_FPWR(g->station, EC_REG_DL_CONTROL, 2, closed));
	if (fmmus)
		ec_trial_add(t, EC_FPWR(g->station, EC_REG_FMMU(0), fmmus, zero));
	ec_trial_add(t, EC_FPWR(g->station, EC_REG_DC_ACTIVATION, 1, zero));
	ec_trial_add(t, EC_FPWR(g->station, EC_REG_AL_CONTROL, 2, init));
	ec_trial_add(t, EC_FPRD(g->station, EC_REG_DL_LOOPS, 1, is));
	if (fmmus)
		ec_trial_add(t, EC_FPRD(g->station, EC_REG_FMMU(0), fmmus, left));
	count = ec_trial_add(t, EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, any));
	last = t->n;
	ec_trial_add(t, EC_FPWR(g->station, EC_REG_STATION, 2, kept));
	ret = ec_trial_run(t, g->station);
	if (t->work[last].wkc == 1)
		g->station = get_unaligned_le16(kept);
	if (ret)
		return ret;
	if (t->work[last - 2].wkc != 1 || memchr_inv(left, 0, sizeof(left)))
		return -EAGAIN;
	if (is[0] == closed[1] && count->wkc > t->count + 1)
		return -EXDEV;
	/* one that does not keep its loops lets in what is behind it */
	return is[0] == closed[1] ? 0 : -EOPNOTSUPP;
}

static int try_often(struct ec_trials *t, struct ec_guest *g,
		     int (*step)(struct ec_trials *, struct ec_guest *))
{
	int ret = -EAGAIN;
	unsigned int i;

	for (i = 0; i < EC_TRIAL_TRIES && (ret == -EAGAIN || ret == -EXDEV); i++)
		ret = step(t, g);
	return ret;
}

/* The address that a slave may have again: of this bus, and of no other slave now */
static u16 kept_station(struct ec_bus *bus, const struct ec_guest *g)
{
	u16 station = get_unaligned_le16(g->station_was);

	return station && ec_known_was_there(bus, station) ? station : 0;
}

/* Let the guest in: its port is open from now on. */
static int let_in(struct ec_trials *t)
{
	const u8 open[2] = { t->host.control & ~EC_DL_TEMPORARY,
			     ec_loops_with(t->host.loops, t->port, EC_LOOP_AUTO_CLOSE) };

	t->host.loops = open[1];
	return ec_xfer_fpwr(t->bus->links, t->host.station, EC_REG_DL_CONTROL, open, 2);
}

/*
 * How long is a frame in the branches of the host that it passes before the port? The host has
 * latched when it came in, and when it returned from the last one of them.
 */
static u32 measure_branch(const struct ec_trials *t)
{
	static const u8 latch[4];
	u32 passed = t->position > t->host.position ? t->position - t->host.position - 1 : 0;
	u32 guess = min_t(u32, passed, EC_MAX_SLAVES) * PASS_NS;
	u8 times[4 * EC_MAX_PORT];
	unsigned int last, k;
	s32 ns;

	if (!passed ||
	    ec_xfer_fpwr(t->bus->links, t->host.station, EC_REG_DC_RECV(0), latch, 4) ||
	    ec_xfer_fprd(t->bus->links, t->host.station, EC_REG_DC_RECV(0), times, sizeof(times)))
		return guess;
	for (last = k = 0; ec_graph_order[k] != t->port; k++)
		if (ec_graph_open_ports(t->dl) & BIT(ec_graph_order[k]))
			last = ec_graph_order[k];
	ns = get_unaligned_le32(times + 4 * last) - get_unaligned_le32(times);
	/* not every controller has receive times */
	return ns > 0 ? ns : guess;
}

/* Does a slave of the list not reply, as is known? */
static bool is_mute(const struct ec_slave *s)
{
	return s && (READ_ONCE(s->reply.silent) ||
		     READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED);
}

/* Another port of the host may have been closed. */
static void take_loops(struct ec_trials *t)
{
	if (t->slave)
		t->host.loops = t->slave->ports.loops;
}

/**
 * ec_trial_look_for_lost() - close ports elsewhere that have lost their link, between long steps
 * @t: trials, none in flight
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_trial_look_for_lost(struct ec_trials *t)
{
	ec_ports_look_for_lost(t->bus);
	take_loops(t);
}

/*
 * The port may have lost its link since it was seen, and the ring slaves before it: then another
 * slave than the next one of the list is at the position, or none.
 */
static int look(struct ec_trials *t)
{
	u16 next = t->next ? t->next->station : 0;
	u8 dl[2], station[2] = { 0 };
	struct ec_dg dg[2] = {
		EC_FPRD(t->host.station, EC_REG_DL_STATUS, 2, dl),
		EC_DG(EC_CMD_APRD, -t->position, EC_REG_STATION, 2, station),
	};

	ec_xfer(t->bus->links, dg, 2);
	ec_ports_close_lost(t->bus, dg[0].irq | dg[1].irq);
	take_loops(t);
	t->mute = dg[0].err && dg[1].err;
	t->dl = dg[0].err || dg[0].wkc != 1 ? 0 : get_unaligned_le16(dl);
	if (!(t->dl & EC_DLS_LINK(t->port)))
		return -ENOLINK;
	if (dg[1].err || (get_unaligned_le16(station) != next && !(is_mute(t->next) && !dg[1].wkc)))
		return -ESTALE;
	t->branch_ns = measure_branch(t);
	return 0;
}

/* One slave; -EALREADY: it is let in, but the slaves behind it are not. */
static int trial_one(struct ec_trials *t, struct ec_guest *g)
{
	int ret, judged;

	*g = (struct ec_guest){ .first = t->bus->next_station + 1 };
	ret = look(t) ?: try_often(t, g, greet);
	/* each time: a PC or a switch lets no frame return */
	if (ret == -EAGAIN && t->work[0].err)
		return -ENXIO;
	ret = ret ?: try_often(t, g, trial_ask);
	if (ret)
		return ret;
	g->kept = kept_station(t->bus, g);
	g->entry = guest_entry(g);
	if (ec_trial_in_boot(t, g))
		return -EPERM;
	ret = try_often(t, g, tame);
	if (ret == -EXDEV && look(t))
		return -ESTALE;
	/* what is behind a guest that does not keep its loops would get process data at once */
	if (ret == -EOPNOTSUPP && !is_last(g))
		return ret;
	if (ret && ret != -EOPNOTSUPP)
		return ret;
	judged = ec_trial_judge(t, g);
	if (judged)
		return judged;
	if (let_in(t))
		return -EAGAIN;
	return ret || g->entry ? -EALREADY : 0;
}

/* The port of the guest that the ring passes next, behind which there is a link; 0: none. */
static unsigned int next_link(const struct ec_guest *g, unsigned int after)
{
	unsigned int k = 0;

	while (ec_graph_order[k] != after)
		k++;
	for (k++; k < EC_MAX_PORT; k++)
		if (get_unaligned_le16(g->dl) & EC_DLS_LINK(ec_graph_order[k]))
			return ec_graph_order[k];
	return 0;
}

/* a guest whose other ports are being tried */
struct level {
	struct ec_host host;
	struct ec_guest guest;
	u16 position;
	unsigned int port;
};

static struct ec_host host_of(const struct ec_trials *t, const struct level *l)
{
	const struct ec_guest *g = &l->guest;

	return (struct ec_host){
		.station = g->station, .position = l->position,
		.control = g->control[0], .loops = guest_loops(g),
		.device = g->kept ? ec_known_by_station(t->bus, g->kept) : 0,
	};
}

/* What is behind the guests, slave by slave in the order of the ring. Returns their number. */
static int trial_branch(struct ec_trials *t, struct ec_guest *first)
{
	struct level *stack = kvcalloc(DEPTH, sizeof(*stack), GFP_KERNEL);
	struct ec_guest g;
	int depth = 0, n = 1;

	if (!stack)
		return n;
	stack[0].guest = *first;
	stack[0].position = t->position;
	while (n < BRANCH && READ_ONCE(t->bus->guarded)) {
		struct level *l = &stack[depth];
		int ret;

		if (!l->port)
			l->host = host_of(t, l);
		l->port = next_link(&l->guest, l->port);
		if (!l->port || READ_ONCE(t->bus->base->stopping)) {
			if (!depth--)
				break;
			continue;
		}
		if (ec_border_may_be(t->bus, l->host.device, l->port))
			continue;
		t->host = l->host;
		t->port = l->port;
		t->door = NULL;
		t->position++;
		ret = trial_one(t, &g);
		l->host.loops = t->host.loops;
		/* another port than this one may be the cause: the monitor looks for it */
		if (t->mute)
			break;
		if (ret && ret != -EALREADY) {
			t->position--;
			continue;
		}
		n++;
		if (ret)
			continue;
		/* a line of slaves needs no depth */
		if (next_link(&l->guest, l->port) && ++depth == DEPTH)
			break;
		stack[depth] = (struct level){ .guest = g, .position = t->position };
	}
	kvfree(stack);
	return n;
}

/**
 * ec_trial() - make the slaves behind a closed port harmless, and let them in
 * @s: slave
 * @port: its port, closed, with a link
 * @is: result: a device that is not let in
 *
 * Afterwards the port is open, if a slave was found; those behind it are found by the next scan:
 * in INIT, without FMMUs and SYNC signals.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: slaves that were let in; -ENXIO: no slave replies behind the port; -ENOLINK: the contact
 * broke; -EAGAIN: frames were lost; -EOPNOTSUPP: the slave does not keep its loops, and others are
 * behind it; -EXDEV: others are behind its port 0; -ESTALE: the ring is not that of the list;
 * -ENOSPC: no free station address; -EPERM: @is is not let in; -ENOBUFS: the cycle leaves too
 * little wire time; -EDOM: frames pass the port before they are processed; -ENOMEM.
 */
int ec_trial(struct ec_slave *s, unsigned int port, struct ec_behind *is)
{
	struct ec_trials t = {
		.bus = s->bus,
		.host = {
			.station = s->station, .position = s->position,
			.control = s->ports.control, .loops = s->ports.loops,
			.device = s->device,
		},
		.port = port,
		.door = &s->ports.door[port],
		.position = ec_graph_place(s, port),
	};
	struct ec_guest g;
	int ret;

	/* what is written by position would be executed before the port is passed */
	if (t.position <= s->position)
		return -EDOM;
	t.train = kcalloc(EC_TRIAL_TRAIN, sizeof(*t.train), GFP_KERNEL);
	if (!t.train)
		return -ENOMEM;
	WRITE_ONCE(s->bus->trials, s->bus->trials + 1);
	t.next = t.position < s->bus->n_slaves ? s->bus->slaves[t.position] : NULL;
	t.slave = s;
	ret = trial_one(&t, &g);
	t.slave = NULL;
	s->ports.loops = t.host.loops;
	s->ports.unsure |= ret < 0;
	s->dl_seen = t.dl ?: s->dl_seen;
	*is = t.is;
	ret = ret ?: trial_branch(&t, &g);
	kfree(t.train);
	return ret == -EALREADY ? 1 : ret;
}
