/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Random events at the ports of a segment, and what the model says of paths and neighbors.
 *
 * A test calls port_events_plan() at least every ahead_ns, best once a cycle: events become
 * faults of the segment before frames are sent that may meet them. Frames must be sent, as some
 * events wait for one. The events depend on the seed, on the times of the calls and on the segment
 * only, so the same test gives the same run.
 */
#ifndef PORT_EVENTS_H
#define PORT_EVENTS_H

#include "../../devices/sim/esc_int.h"

#define PORT_EVENTS_SLAVES	256	/* at most */
#define PORT_EVENTS_BURST_NS	1000000
#define PORT_EVENTS_REST_NS	600000000	/* then what an event began has ended */

/**
 * enum port_event - what happens
 * @PORT_EVENT_OPEN: a contact opens
 * @PORT_EVENT_CLOSE: one that is open closes
 * @PORT_EVENT_FLAP: one bounces, 2 to 16 steps of 1 us to 4 ms; mostly it is closed then
 * @PORT_EVENT_PLUG: a branch is unplugged, plugged in again, or moves to another free port
 * @PORT_EVENT_SWAP: two slaves or two branches change places
 * @PORT_EVENT_POWER: a slave has no power for 1 to 500 ms
 * @PORT_EVENT_FOREIGN: a host, or a slave that was not connected in the beginning, comes to a
 *                      free port or goes; the slave often with old registers, in OP
 * @PORT_EVENTS: number of kinds
 */
enum port_event {
	PORT_EVENT_OPEN,
	PORT_EVENT_CLOSE,
	PORT_EVENT_FLAP,
	PORT_EVENT_PLUG,
	PORT_EVENT_SWAP,
	PORT_EVENT_POWER,
	PORT_EVENT_FOREIGN,
	PORT_EVENTS
};

/**
 * struct port_end - a port of a slave or of the master
 * @slave: slave; EC_SIM_MASTER0, EC_SIM_MASTER1, PORT_END_HOST, PORT_END_NONE
 * @port: its port, 0 if it is no slave
 */
struct port_end {
	int slave;
	int port;
};

#define PORT_END_NONE	(-3)
#define PORT_END_HOST	(-4)

/**
 * struct port_events - random events at the ports of a segment
 * @sim: segment
 * @mean_ns: mean distance of events, bursts counted as one
 * @burst_percent: of all events, those in bursts of 2 to 20 within a millisecond
 * @ahead_ns: how long before they happen events are planned
 * @in_frame_percent: of the events at cables, those that wait for one of the next frames and
 *                    happen when it is sent, up to 20 us later, or while it is on the cable
 * @kinds: bits of enum port_event that happen
 * @no_hosts: no PC or switch comes
 * @root: also to slaves at a port of the master
 * @wrong_way: one of ten slaves that were not connected is plugged in by its port 1; two of
 *             them in the bus let no frame return
 * @events: planned so far
 * @bursts: of these, bursts
 * @kind: events of each kind
 * @next_ns: time of the next one
 * @rng: state of the random numbers
 * @slaves: of the segment
 * @foreign: those that were not connected in the beginning
 * @mark: slaves that are reached, between two steps
 * @first: the other end of the cable at each port in the beginning
 * @first_ns: and its delay
 */
struct port_events {
	struct ec_sim *sim;
	u64 mean_ns;
	u32 burst_percent;
	u64 ahead_ns;
	u32 in_frame_percent;
	u32 kinds;
	bool no_hosts;
	bool root;
	bool wrong_way;
	u64 events;
	u64 bursts;
	u32 kind[PORT_EVENTS];
	u64 next_ns;
	u64 rng;
	int slaves;
	bool foreign[PORT_EVENTS_SLAVES];
	u8 mark[PORT_EVENTS_SLAVES];
	struct port_end first[PORT_EVENTS_SLAVES][EC_MAX_PORT];
	u32 first_ns[PORT_EVENTS_SLAVES][EC_MAX_PORT];
};

/* ---- what the model says */

/* the other end of the cable at a port, whether it is whole or not */
static inline struct port_end port_events_cable(const struct ec_sim *sim, int slave, int port)
{
	const struct ec_esc_port *p = &sim->esc[slave]->port[port];

	if (p->peer == -1)
		return (struct port_end){ PORT_END_NONE, 0 };
	if (p->peer == EC_ESC_PEER_HOST)
		return (struct port_end){ PORT_END_HOST, 0 };
	if (p->peer < 0)
		return (struct port_end){ p->peer + 1, 0 };
	return (struct port_end){ p->peer, p->peer_port };
}

/* what hangs at a port now; PORT_END_NONE without a link */
static inline struct port_end port_events_peer(const struct ec_sim *sim, int slave, int port)
{
	if (!sim->esc[slave]->port[port].link)
		return (struct port_end){ PORT_END_NONE, 0 };
	return port_events_cable(sim, slave, port);
}

/*
 * Marks the slaves that have a path of links to a master, each of which is there since @since:
 * now, if that is not before now. Slave @without counts as none; -1: all count. Loops that are
 * closed do not count. Returns how many.
 */
static inline u32 port_events_reached(const struct ec_sim *sim, u64 since, int without, u8 *mark)
{
	bool more = true;
	u32 n = 0;

	memset(mark, 0, sim->count);
	while (more) {
		more = false;
		for (int i = 0; i < (int)sim->count; i++) {
			bool near = false;

			for (int p = 0; p < EC_MAX_PORT && !mark[i] && i != without; p++) {
				struct port_end e = port_events_peer(sim, i, p);

				if (e.slave > PORT_END_NONE &&
				    sim->esc[i]->port[p].linked_ns <= since)
					near |= e.slave < 0 || mark[e.slave];
			}
			if (!near)
				continue;
			mark[i] = 1;
			more = true;
			n++;
		}
	}
	return n;
}

/* ---- random numbers */

static inline u32 port_events_rnd(struct port_events *e, u32 n)
{
	e->rng = e->rng * 6364136223846793005ULL + 1442695040888963407ULL;
	return (u32)((e->rng >> 32) * n >> 32);
}

/* exponential, in integers: log2(1 + x) is about x (1.3465 - 0.3465 x) */
static inline u64 port_events_exponential(struct port_events *e, u64 mean)
{
	u32 r = port_events_rnd(e, ~0u) | 1, n = 1;
	u64 x;

	for (; !(r >> 31); r <<= 1)
		n++;
	x = r >> 15 & 0xffff;
	x = ((u64)n << 16) - (x * (88244 - (22708 * x >> 16)) >> 16);
	return (mean * 45426 >> 16) * x >> 16;
}

/* ---- choosing */

static inline bool port_events_free(const struct port_events *e, int slave, int port)
{
	return e->mark[slave] && ec_sim_has_port(e->sim, slave, port) &&
	       e->sim->esc[slave]->port[port].peer == -1;
}

/* directly at the master */
static inline bool port_events_is_root(const struct port_events *e, int slave)
{
	for (int p = 0; p < EC_MAX_PORT; p++) {
		int peer = port_events_cable(e->sim, slave, p).slave;

		if (peer == EC_SIM_MASTER0 || peer == EC_SIM_MASTER1)
			return true;
	}
	return false;
}

/* a port without a cable, with a whole one, a broken one, one to a branch, with a host */
enum port_events_want {
	PORT_EVENTS_FREE,
	PORT_EVENTS_WHOLE,
	PORT_EVENTS_CUT,
	PORT_EVENTS_BRANCH,
	PORT_EVENTS_A_HOST
};

static inline bool port_events_fits(const struct port_events *e, int slave, int port,
				    enum port_events_want want)
{
	struct port_end other = port_events_cable(e->sim, slave, port);
	bool cut = e->sim->esc[slave]->port[port].cut;

	switch (want) {
	case PORT_EVENTS_FREE:
		return port_events_free(e, slave, port);
	case PORT_EVENTS_WHOLE:
		return other.slave > PORT_END_NONE && !cut && (e->root || other.slave >= 0);
	case PORT_EVENTS_CUT:
		return other.slave != PORT_END_NONE && cut;
	case PORT_EVENTS_BRANCH:
		return port && other.slave >= 0 && !other.port;
	default:
		return other.slave == PORT_END_HOST;
	}
}

/* one of the ports that are as wanted; PORT_END_NONE: there is none */
static inline struct port_end port_events_port(struct port_events *e, enum port_events_want want)
{
	struct port_end found = { PORT_END_NONE, 0 };
	u32 n = 0;

	for (int i = 0; i < e->slaves; i++)
		for (int p = 0; p < EC_MAX_PORT; p++)
			if (port_events_fits(e, i, p, want) && !port_events_rnd(e, ++n))
				found = (struct port_end){ i, p };
	return found;
}

/* a slave that is connected or not, foreign or not; -1: there is none */
static inline int port_events_slave(struct port_events *e, bool connected, bool foreign)
{
	int found = -1;
	u32 n = 0;

	for (int i = 0; i < e->slaves; i++) {
		if (e->mark[i] != connected || e->foreign[i] != foreign ||
		    (connected && !e->root && port_events_is_root(e, i)))
			continue;
		if (!port_events_rnd(e, ++n))
			found = i;
	}
	return found;
}

/* ---- events; false: there is nothing that it could happen to */

static inline bool port_events_add(struct port_events *e, u64 at, enum ec_sim_fault_type type,
				   struct port_end end, struct port_end other, u64 value)
{
	const struct ec_sim_fault f = {
		.at_ns = at, .type = type, .slave = end.slave, .port = end.port,
		.arg = (u32)other.slave, .arg2 = (u32)other.port, .value = value,
	};

	return !ec_sim_add_fault(e->sim, &f);
}

/* as port_events_add(), sometimes when a frame is there */
static inline bool port_events_cabling(struct port_events *e, u64 at, enum ec_sim_fault_type type,
				       struct port_end end, struct port_end other, u64 value)
{
	struct ec_sim_fault f = {
		.at_ns = at, .type = type, .slave = end.slave, .port = end.port,
		.arg = (u32)other.slave, .arg2 = (u32)other.port, .value = value,
	};

	if (port_events_rnd(e, 100) < e->in_frame_percent) {
		f.frame = 1 + port_events_rnd(e, 3);
		f.when = (enum ec_sim_when)port_events_rnd(e, 3);
		f.after_ns = f.when == EC_SIM_WHEN_SENT ? port_events_rnd(e, 20000) : 0;
	}
	return !ec_sim_add_fault(e->sim, &f);
}

static inline bool port_events_contact(struct port_events *e, u64 at, bool close)
{
	struct port_end end = port_events_port(e, close ? PORT_EVENTS_CUT : PORT_EVENTS_WHOLE);

	return end.slave >= 0 &&
	       port_events_cabling(e, at, close ? EC_SIM_FAULT_HEAL : EC_SIM_FAULT_CUT, end, end,
				   0);
}

static inline bool port_events_flap(struct port_events *e, u64 at)
{
	struct port_end end = port_events_port(e, PORT_EVENTS_WHOLE);
	u32 bits = 2 + port_events_rnd(e, 15), step = 1000u << port_events_rnd(e, 13);
	u64 pattern = port_events_rnd(e, 1u << bits) & ~1u;

	if (port_events_rnd(e, 5))
		pattern |= 1u << (bits - 1);
	return end.slave >= 0 &&
	       port_events_cabling(e, at, EC_SIM_FAULT_BOUNCE, end,
				   (struct port_end){ (int)step, (int)(EC_SIM_BOUNCE_BITS + bits) },
				   pattern);
}

/* slave @x to its first place, or to a free port of a slave that is not behind it */
static inline bool port_events_connect(struct port_events *e, u64 at, int x)
{
	struct port_end own = { x, 0 }, to;

	if (x < 0)
		return false;
	to = e->first[x][0];
	if (e->wrong_way && !e->mark[x] && !port_events_rnd(e, 10) &&
	    ec_sim_has_port(e->sim, x, 1))
		own.port = 1;
	port_events_reached(e->sim, ~0ull, x, e->mark);
	if (to.slave < 0 || !port_events_free(e, to.slave, to.port) || port_events_rnd(e, 2))
		to = port_events_port(e, PORT_EVENTS_FREE);
	return to.slave >= 0 &&
	       port_events_cabling(e, at, EC_SIM_FAULT_PLUG, own, to, port_events_rnd(e, 1000));
}

static inline bool port_events_plug(struct port_events *e, u64 at)
{
	int x = port_events_slave(e, false, false);
	struct port_end end;

	if (x < 0 && !port_events_rnd(e, 2)) {
		end = port_events_port(e, PORT_EVENTS_BRANCH);
		return end.slave >= 0 &&
		       port_events_cabling(e, at, EC_SIM_FAULT_UNPLUG, end, end, 0);
	}
	return port_events_connect(e, at, x >= 0 ? x : port_events_slave(e, true, false));
}

static inline bool port_events_swap(struct port_events *e, u64 at)
{
	bool slaves = port_events_rnd(e, 2);
	struct port_end a, b;

	if (slaves) {
		a = (struct port_end){ port_events_slave(e, true, false), EC_SIM_ALL_PORTS };
		b = (struct port_end){ port_events_slave(e, true, false), 0 };
	} else {
		a = port_events_port(e, PORT_EVENTS_BRANCH);
		b = port_events_port(e, PORT_EVENTS_BRANCH);
	}
	return a.slave >= 0 && b.slave >= 0 &&
	       port_events_cabling(e, at, EC_SIM_FAULT_SWAP, a, b, 0);
}

static inline bool port_events_power(struct port_events *e, u64 at)
{
	struct port_end end = { port_events_slave(e, true, false), 0 };
	u64 ns = 1000000 + (u64)port_events_rnd(e, 500) * 1000000;

	return end.slave >= 0 &&
	       port_events_add(e, at, EC_SIM_FAULT_POWER_OFF, end, end, 0) &&
	       port_events_add(e, at + ns, EC_SIM_FAULT_POWER_ON, end, end, 0);
}

/* as a slave that was in another bus: somebody's address, and process data where others are */
static inline void port_events_old(struct port_events *e, u64 at, int x)
{
	const struct ec_esc *other = e->sim->esc[port_events_rnd(e, (u32)e->slaves)];
	const struct ec_sim_fault f = {
		.at_ns = at, .type = EC_SIM_FAULT_OLD, .slave = x, .arg = other->fmmu[0].logical,
		.arg2 = EC_AL_OP,
		.value = ec_esc_get16(other, EC_REG_STATION) | EC_SIM_OLD_STATION |
			 EC_SIM_OLD_STATE | EC_SIM_OLD_LOGICAL,
	};

	ec_sim_add_fault(e->sim, &f);
}

static inline bool port_events_foreign(struct port_events *e, u64 at)
{
	struct port_end end = port_events_port(e, PORT_EVENTS_A_HOST);
	int there = port_events_slave(e, true, true), x = port_events_slave(e, false, true);
	u64 every = (u64)port_events_rnd(e, 20) * 1000000;

	if (end.slave < 0 && there >= 0)
		end = (struct port_end){ there, 0 };
	if (end.slave >= 0 && port_events_rnd(e, 4))
		return port_events_cabling(e, at, EC_SIM_FAULT_UNPLUG, end, end, 0);
	if (x >= 0 && port_events_rnd(e, 2)) {
		if (port_events_rnd(e, 2))
			port_events_old(e, at, x);
		return port_events_connect(e, at, x);
	}
	end = port_events_port(e, PORT_EVENTS_FREE);
	return end.slave >= 0 && !e->no_hosts &&
	       port_events_add(e, at, EC_SIM_FAULT_HOST, end,
			       (struct port_end){ (int)port_events_rnd(e, 2), 0 }, every);
}

/* ---- planning */

static inline bool port_events_one(struct port_events *e, u64 at, enum port_event kind)
{
	switch (kind) {
	case PORT_EVENT_OPEN:
	case PORT_EVENT_CLOSE:
		return port_events_contact(e, at, kind == PORT_EVENT_CLOSE);
	case PORT_EVENT_FLAP:
		return port_events_flap(e, at);
	case PORT_EVENT_PLUG:
		return port_events_plug(e, at);
	case PORT_EVENT_SWAP:
		return port_events_swap(e, at);
	case PORT_EVENT_POWER:
		return port_events_power(e, at);
	default:
		return port_events_foreign(e, at);
	}
}

/* the more slaves are missing, the more often one of them comes back: most are there */
static inline enum port_event port_events_choose(struct port_events *e)
{
	u32 own = 0, missing = 0;

	for (int i = 0; i < e->slaves; i++) {
		own += !e->foreign[i];
		missing += !e->foreign[i] && !e->mark[i];
	}
	if (!port_events_rnd(e, 4) || port_events_rnd(e, own) >= 3 * missing)
		return (enum port_event)port_events_rnd(e, PORT_EVENTS);
	return port_events_rnd(e, 2) ? PORT_EVENT_CLOSE : PORT_EVENT_PLUG;
}

/* one that is possible; some kinds are not, now and then */
static inline void port_events_any(struct port_events *e, u64 at)
{
	for (u32 i = 0; i < 100; i++) {
		enum port_event kind;

		port_events_reached(e->sim, ~0ull, -1, e->mark);
		kind = port_events_choose(e);
		if (!(e->kinds >> kind & 1) || !port_events_one(e, at, kind))
			continue;
		e->events++;
		e->kind[kind]++;
		return;
	}
}

/**
 * port_events_plan() - let the events of the next time happen
 * @e: random events
 * @now: time of the segment
 */
static inline void port_events_plan(struct port_events *e, u64 now)
{
	u32 s = e->burst_percent, n, i;

	while (e->next_ns <= now + e->ahead_ns) {
		u64 t = e->next_ns;

		/* a burst has 11 events on the average */
		n = port_events_rnd(e, 11 * (100 - s) + s) < s ? 2 + port_events_rnd(e, 19) : 1;
		e->bursts += n > 1;
		for (i = 0; i < n; i++) {
			port_events_any(e, t);
			t += port_events_rnd(e, PORT_EVENTS_BURST_NS / n);
		}
		e->next_ns += port_events_exponential(e, e->mean_ns);
	}
}

/**
 * port_events_init() - begin with random events
 * @e: result; the caller may change the settings before the first call of port_events_plan()
 * @sim: segment, wired as a test begins with it; at most PORT_EVENTS_SLAVES slaves
 * @seed: of the random numbers
 * @now: time of the segment
 */
static inline void port_events_init(struct port_events *e, struct ec_sim *sim, u64 seed, u64 now)
{
	memset(e, 0, sizeof(*e));
	e->sim = sim;
	e->mean_ns = 200000000;
	e->burst_percent = 10;
	e->ahead_ns = 5000000;
	e->in_frame_percent = 20;
	e->kinds = BIT(PORT_EVENTS) - 1;
	e->rng = seed * 2 + 1;
	e->slaves = (int)min_t(u32, ec_sim_count(sim), PORT_EVENTS_SLAVES);
	for (u32 i = 0; i < 8; i++)
		port_events_rnd(e, 2);
	e->next_ns = now + port_events_exponential(e, e->mean_ns);
	port_events_reached(sim, ~0ull, -1, e->mark);
	for (int i = 0; i < e->slaves; i++) {
		e->foreign[i] = !e->mark[i];
		for (int p = 0; p < EC_MAX_PORT; p++) {
			e->first[i][p] = port_events_cable(sim, i, p);
			e->first_ns[i][p] = sim->esc[i]->port[p].cable_ns;
		}
	}
}

/* what is at port @p of slave @i becomes what was there in the beginning */
static inline void port_events_undo(struct port_events *e, u64 at, int i, int p)
{
	struct port_end own = { i, p }, was = e->first[i][p];
	struct port_end is = port_events_cable(e->sim, i, p);

	if (was.slave == PORT_END_NONE && is.slave != PORT_END_NONE)
		port_events_add(e, at, EC_SIM_FAULT_UNPLUG, own, own, 0);
	/* each cable once */
	if (was.slave == PORT_END_NONE || was.slave > i)
		return;
	if (is.slave != was.slave || is.port != was.port)
		port_events_add(e, at, EC_SIM_FAULT_PLUG, own, was, e->first_ns[i][p]);
	else if (e->sim->esc[i]->port[p].cut)
		port_events_add(e, at, EC_SIM_FAULT_HEAL, own, own, 0);
}

/**
 * port_events_stop() - plan no more events
 * @e: random events
 */
static inline void port_events_stop(struct port_events *e)
{
	e->next_ns = ~0ull >> 1;
}

/**
 * port_events_restore() - let all be as in the beginning, foreign devices gone
 * @e: random events, stopped PORT_EVENTS_REST_NS and ahead_ns ago, frames sent since then
 * @at: time of the segment
 */
static inline void port_events_restore(struct port_events *e, u64 at)
{
	for (int i = 0; i < e->slaves; i++)
		port_events_add(e, at, EC_SIM_FAULT_POWER_ON, (struct port_end){ i, 0 },
				(struct port_end){ 0, 0 }, 0);
	for (int i = 0; i < e->slaves; i++)
		for (int p = 0; p < EC_MAX_PORT; p++)
			port_events_undo(e, at, i, p);
}

#endif
