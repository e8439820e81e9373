// SPDX-License-Identifier: GPL-2.0-only
/*
 * Segment: wiring, the way of frames, time.
 *
 * The way of a frame depends on the topology only, so it is computed once per
 * change: a list of processing units with the time since the master sent the
 * first bit. A frame is then worked through datagram by datagram. That gives
 * the same result as slave by slave, since slaves meet only in the datagram,
 * and it allows to leave out slaves which a datagram does not concern
 * (ec_sim_set_slow() switches that off, to compare).
 */
#include "esc_int.h"

#define LEN_CIRCULATING	0x40	/* in the high byte of the length word */

u64 ec_sim_hash(u64 x)
{
	x += 0x9e3779b97f4a7c15ULL;
	x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ULL;
	x = (x ^ x >> 27) * 0x94d049bb133111ebULL;
	return x ^ x >> 31;
}

/**
 * ec_sim_random() - next number of the segment's own sequence
 * @sim: segment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 32 random bits.
 */
u32 ec_sim_random(struct ec_sim *sim)
{
	return (u32)(ec_sim_hash(sim->seed ^ ++sim->rng * 0x2545f4914f6cdd1dULL) >> 32);
}

/* ---- time of the next event per slave: a binary heap of lower bounds */

static u64 heap_key(const struct ec_sim *sim, u32 pos)
{
	return sim->esc[sim->heap[pos]]->key;
}

static void heap_swap(struct ec_sim *sim, u32 a, u32 b)
{
	u32 t = sim->heap[a];

	sim->heap[a] = sim->heap[b];
	sim->heap[b] = t;
	sim->esc[sim->heap[a]]->heap_pos = a;
	sim->esc[sim->heap[b]]->heap_pos = b;
}

static void heap_up(struct ec_sim *sim, u32 pos)
{
	while (pos && heap_key(sim, pos) < heap_key(sim, (pos - 1) / 2)) {
		heap_swap(sim, pos, (pos - 1) / 2);
		pos = (pos - 1) / 2;
	}
}

static void heap_down(struct ec_sim *sim, u32 pos)
{
	for (;;) {
		u32 c = 2 * pos + 1;

		if (c >= sim->count)
			return;
		if (c + 1 < sim->count &&
		    heap_key(sim, c + 1) < heap_key(sim, c))
			c++;
		if (heap_key(sim, c) >= heap_key(sim, pos))
			return;
		heap_swap(sim, c, pos);
		pos = c;
	}
}

/* a slave's next event may have come nearer */
void ec_sim_touch(struct ec_esc *esc)
{
	u64 t = ec_esc_next(esc);

	if (t < esc->key) {
		esc->key = t;
		heap_up(esc->sim, esc->heap_pos);
	}
}

static u64 slaves_next(struct ec_sim *sim)
{
	while (sim->count) {
		struct ec_esc *esc = sim->esc[sim->heap[0]];
		u64 t = ec_esc_next(esc);

		if (t <= esc->key)
			return t;
		esc->key = t;
		heap_down(sim, 0);
	}
	return EC_ESC_NEVER;
}

/**
 * ec_sim_next_event() - when the segment does something by itself
 * @sim: segment
 *
 * Context: Any. RT-safe: bounded by the slaves, no sleep, no allocation.
 * Return: simulation time, ns; ~0 when nothing is planned.
 */
u64 ec_sim_next_event(struct ec_sim *sim)
{
	u64 a = slaves_next(sim), b = ec_sim_faults_next(sim);

	return min(a, b);
}

/**
 * ec_sim_advance() - let time pass
 * @sim: segment
 * @now_ns: until when; going back does nothing
 *
 * Faults, watchdogs, pulses and applications due until then act, in the
 * order of their times.
 *
 * Context: Any. RT-safe: bounded by what is due, no sleep, no allocation.
 */
void ec_sim_advance(struct ec_sim *sim, u64 now_ns)
{
	for (;;) {
		u64 a = slaves_next(sim), b = ec_sim_faults_next(sim);
		u64 t = min(a, b);

		if (t > now_ns || t == EC_ESC_NEVER)
			break;
		sim->now = max(sim->now, t);
		if (b <= a)
			ec_sim_faults_run(sim, sim->now);
		else
			ec_esc_run(sim->esc[sim->heap[0]], sim->now);
	}
	sim->now = max(sim->now, now_ns);
}

/* tell the application at the end of the frame */
void ec_esc_pend(struct ec_esc *esc, u64 at_ns)
{
	struct ec_sim *sim = esc->sim;

	esc->pend_ns = at_ns;
	if (esc->pend_next != -2)
		return;
	esc->pend_next = -1;
	if (sim->pend_head < 0)
		sim->pend_head = esc->index;
	else
		sim->esc[sim->pend_tail]->pend_next = esc->index;
	sim->pend_tail = esc->index;
}

static void deliver(struct ec_sim *sim)
{
	while (sim->pend_head >= 0) {
		struct ec_esc *esc = sim->esc[sim->pend_head];

		sim->pend_head = esc->pend_next;
		esc->pend_next = -2;
		ec_esc_deliver(esc);
	}
}

/* ---- station addresses */

static void unhash(struct ec_sim *sim, s32 node)
{
	s32 prev = sim->node_prev[node], next = sim->node_next[node];

	if (prev == -2)
		return;
	if (prev == -1)
		sim->bucket[sim->node_addr[node] & (sim->buckets - 1)] = next;
	else
		sim->node_next[prev] = next;
	if (next >= 0)
		sim->node_prev[next] = prev;
	sim->node_prev[node] = -2;
}

static void hash(struct ec_sim *sim, s32 node, u16 addr)
{
	s32 *head = &sim->bucket[addr & (sim->buckets - 1)];

	unhash(sim, node);
	if (!addr)		/* shared by all new slaves: not worth it */
		return;
	sim->node_addr[node] = addr;
	sim->node_prev[node] = -1;
	sim->node_next[node] = *head;
	if (*head >= 0)
		sim->node_prev[*head] = node;
	*head = node;
}

/* station address, alias or alias enable changed */
void ec_sim_rehash(struct ec_esc *esc)
{
	bool alias = esc->mem[EC_REG_DL_ALIAS] & 1;

	hash(esc->sim, 2 * esc->index, ec_esc_get16(esc, EC_REG_STATION));
	hash(esc->sim, 2 * esc->index + 1,
	     alias ? ec_esc_get16(esc, EC_REG_ALIAS) : 0);
}

/* ---- building */

/**
 * ec_sim_new() - an empty segment
 * @ops: where memory comes from
 * @max_slaves: how many slaves may be added, 1..65535
 * @seed: of all randomness
 *
 * Context: Process. May sleep.
 * Return: the segment, NULL on no memory or a bad @max_slaves.
 */
struct ec_sim *ec_sim_new(const struct ec_sim_ops *ops, u32 max_slaves,
			  u64 seed)
{
	struct ec_sim *sim;
	u32 i;

	if (!max_slaves || max_slaves > 65535)
		return NULL;
	sim = ops->alloc(sizeof(*sim));
	if (!sim)
		return NULL;
	sim->ops = *ops;
	sim->max = max_slaves;
	sim->seed = ec_sim_hash(seed);
	sim->pend_head = -1;
	sim->dirty = true;
	sim->buckets = 16;
	while (sim->buckets < max_slaves)
		sim->buckets *= 2;

	sim->esc = ops->alloc(max_slaves * sizeof(*sim->esc));
	sim->heap = ops->alloc(max_slaves * sizeof(*sim->heap));
	sim->bucket = ops->alloc(sim->buckets * sizeof(*sim->bucket));
	sim->node_next = ops->alloc(2 * max_slaves * sizeof(s32));
	sim->node_prev = ops->alloc(2 * max_slaves * sizeof(s32));
	sim->node_addr = ops->alloc(2 * max_slaves * sizeof(u16));
	for (i = 0; i < EC_SIM_PORTS; i++) {
		sim->mport[i].peer = -1;
		sim->route[i].step =
			ops->alloc(max_slaves * sizeof(struct ec_sim_step));
	}
	if (!sim->esc || !sim->heap || !sim->bucket || !sim->node_next ||
	    !sim->node_prev || !sim->node_addr || !sim->route[0].step ||
	    !sim->route[1].step || ec_sim_faults_init(sim)) {
		ec_sim_free(sim);
		return NULL;
	}
	for (i = 0; i < sim->buckets; i++)
		sim->bucket[i] = -1;
	for (i = 0; i < 2 * max_slaves; i++)
		sim->node_prev[i] = -2;
	return sim;
}

static void free_slave(struct ec_sim *sim, struct ec_esc *esc)
{
	if (!esc)
		return;
	if (esc->app_ops && esc->app_ops->free)
		esc->app_ops->free(esc);
	sim->ops.free(esc->eep.data);
	sim->ops.free(esc->mem);
	sim->ops.free(esc);
}

/**
 * ec_sim_free() - give everything back, applications included
 * @sim: segment, may be NULL
 *
 * Context: Process. May sleep.
 */
void ec_sim_free(struct ec_sim *sim)
{
	struct ec_sim_ops ops;
	u32 i;

	if (!sim)
		return;
	ops = sim->ops;
	for (i = 0; i < sim->count; i++)
		free_slave(sim, sim->esc[i]);
	for (i = 0; i < EC_SIM_PORTS; i++)
		ops.free(sim->route[i].step);
	ops.free(sim->fault);
	ops.free(sim->node_addr);
	ops.free(sim->node_prev);
	ops.free(sim->node_next);
	ops.free(sim->bucket);
	ops.free(sim->heap);
	ops.free(sim->esc);
	ops.free(sim);
}

/**
 * ec_sim_alloc() - memory from the segment's ops
 * @sim: segment
 * @bytes: how much
 *
 * Context: Process. May sleep.
 * Return: zeroed memory or NULL.
 */
void *ec_sim_alloc(struct ec_sim *sim, size_t bytes)
{
	return sim->ops.alloc(bytes);
}

/**
 * ec_sim_release() - give memory of ec_sim_alloc() back
 * @sim: segment
 * @p: memory or NULL
 *
 * Context: Process. May sleep.
 */
void ec_sim_release(struct ec_sim *sim, void *p)
{
	sim->ops.free(p);
}

/**
 * ec_sim_add() - add a powered slave, not wired yet
 * @sim: segment
 * @cfg: what it is built with; copied
 *
 * Context: Process. May sleep.
 * Return: the slave, NULL on no memory, a full segment or a bad @cfg.
 */
struct ec_esc *ec_sim_add(struct ec_sim *sim, const struct ec_esc_config *cfg)
{
	struct ec_esc *esc;
	int p;

	if (sim->count == sim->max || !ec_esc_config_valid(cfg))
		return NULL;
	esc = sim->ops.alloc(sizeof(*esc));
	if (!esc)
		return NULL;
	esc->sim = sim;
	esc->index = (int)sim->count;
	esc->cfg = *cfg;
	esc->mem_len = EC_REG_RAM + cfg->ram_kib * 1024u;
	esc->mem = sim->ops.alloc(esc->mem_len);
	esc->eep.len = max(cfg->eeprom_len, cfg->eeprom_size);
	esc->eep.data = sim->ops.alloc(esc->eep.len + 1);
	if (!esc->mem || !esc->eep.data) {
		free_slave(sim, esc);
		return NULL;
	}
	memset(esc->eep.data, 0xff, esc->eep.len);
	if (cfg->eeprom)
		memcpy(esc->eep.data, cfg->eeprom, cfg->eeprom_len);
	esc->cfg.eeprom = NULL;

	for (p = 0; p < EC_MAX_PORT; p++)
		esc->port[p].peer = -1;
	esc->pend_next = -2;
	esc->key = EC_ESC_NEVER;
	esc->route_pos[0] = -1;
	esc->route_pos[1] = -1;
	esc->heap_pos = sim->count;
	sim->heap[sim->count] = sim->count;
	sim->esc[sim->count++] = esc;
	esc->powered = true;
	ec_esc_power_on(esc, sim->now);
	return esc;
}

/**
 * ec_sim_wire() - put a cable between two ports
 * @sim: segment
 * @parent: slave, EC_SIM_MASTER0 or EC_SIM_MASTER1
 * @parent_port: its port, ignored for a master
 * @child: slave
 * @child_port: its port
 * @cable_ns: delay, about 5 ns per metre
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EINVAL for a slave or port that is not there, -EBUSY for one
 * that has a cable.
 */
int ec_sim_wire(struct ec_sim *sim, int parent, int parent_port, int child,
		int child_port, u32 cable_ns)
{
	struct ec_esc_port *a, *b;
	struct ec_esc *up = NULL, *down;

	if (parent < EC_SIM_MASTER1 || parent >= (int)sim->count ||
	    child < 0 || child >= (int)sim->count ||
	    child_port < 0 || child_port >= EC_MAX_PORT ||
	    (parent >= 0 && (parent_port < 0 || parent_port >= EC_MAX_PORT)))
		return -EINVAL;
	down = sim->esc[child];
	b = &down->port[child_port];
	if (parent >= 0) {
		up = sim->esc[parent];
		a = &up->port[parent_port];
		if (up->cfg.ports[parent_port] <= EC_PORT_TYPE_UNCONF)
			return -EINVAL;
	} else {
		a = &sim->mport[-1 - parent];
		parent_port = 0;
	}
	if (down->cfg.ports[child_port] <= EC_PORT_TYPE_UNCONF || a == b)
		return -EINVAL;
	if (a->peer != -1 || b->peer != -1)
		return -EBUSY;

	a->peer = child;
	a->peer_port = (u8)child_port;
	a->cable_ns = cable_ns;
	a->cut = false;
	b->peer = parent >= 0 ? parent : parent - 1;
	b->peer_port = (u8)parent_port;
	b->cable_ns = cable_ns;
	b->cut = false;
	ec_sim_ports(down, sim->now);
	if (up)
		ec_sim_ports(up, sim->now);
	return 0;
}

/* ---- links and loops */

/**
 * ec_sim_link() - what the PHY of the master says
 * @sim: segment
 * @port: master port, 0 or 1
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: link is up.
 */
bool ec_sim_link(const struct ec_sim *sim, int port)
{
	const struct ec_esc_port *m = &sim->mport[port];

	return m->peer >= 0 && !m->cut && sim->esc[m->peer]->powered;
}

/* loop settings or links changed; @written: by a write to 0x0101 */
void ec_sim_loops(struct ec_esc *esc, bool written, u64 now)
{
	u8 loops = esc->mem[EC_REG_DL_LOOPS];
	int p;

	(void)now;
	for (p = 0; p < EC_MAX_PORT; p++) {
		struct ec_esc_port *port = &esc->port[p];
		bool open = port->link;

		switch (loops >> 2 * p & 3) {
		case EC_LOOP_AUTO:
			port->auto_closed = false;
			break;
		case EC_LOOP_AUTO_CLOSE:
			if (!port->link)
				port->auto_closed = true;
			else if (written)
				port->auto_closed = false;
			open = !port->auto_closed;
			break;
		case EC_LOOP_OPEN:
			open = true;
			break;
		case EC_LOOP_CLOSED:	/* port 0 must stay reachable */
			open = !p && port->link;
			break;
		}
		if (open == port->open)
			continue;
		port->open = open;
		esc->sim->dirty = true;
		if (esc->powered)
			ec_esc_event(esc, EC_ECAT_EVENT_DL, 0);
	}
}

/* power or cables around @esc changed */
void ec_sim_ports(struct ec_esc *esc, u64 now)
{
	struct ec_sim *sim = esc->sim;
	int p;

	sim->dirty = true;
	for (p = 0; p < EC_MAX_PORT; p++) {
		struct ec_esc_port *port = &esc->port[p];
		bool link = esc->powered && port->peer != -1 && !port->cut &&
			    (port->peer < 0 || sim->esc[port->peer]->powered);
		u8 *lost = esc->mem + EC_REG_ERR_LOST(p);

		if (link == port->link)
			continue;
		port->link = link;
		if (!esc->powered)
			continue;
		if (!link && *lost != 0xff)
			++*lost;
		ec_esc_event(esc, EC_ECAT_EVENT_DL, 0);
	}
	ec_sim_loops(esc, false, now);
}

void ec_sim_power(struct ec_esc *esc, bool on, u64 now)
{
	struct ec_sim *sim = esc->sim;
	int p;

	if (on == esc->powered)
		return;
	esc->powered = on;
	if (on) {
		ec_esc_power_on(esc, now);
	} else {
		esc->ecat_event = 0;
		ec_esc_event(esc, 0, 0);
		esc->wd_due = EC_ESC_NEVER;
		esc->loop_restore = EC_ESC_NEVER;
		esc->app_wake_ns = EC_ESC_NEVER;
		esc->dc.sync_wake = EC_ESC_NEVER;
		memset(&esc->pend, 0, sizeof(esc->pend));
	}
	ec_sim_ports(esc, now);
	for (p = 0; p < EC_MAX_PORT; p++)
		if (esc->port[p].peer >= 0)
			ec_sim_ports(sim->esc[esc->port[p].peer], now);
	if (on && esc->app_ops && esc->app_ops->power_on)
		esc->app_ops->power_on(esc, now);
}

/* cut or heal the cable at one of its ends; @slave below 0: master port */
void ec_sim_cut(struct ec_sim *sim, int slave, int port, bool cut, u64 now)
{
	struct ec_esc_port *a = slave < 0 ? &sim->mport[-1 - slave] :
					    &sim->esc[slave]->port[port];

	if (a->peer == -1)
		return;
	a->cut = cut;
	if (a->peer < 0)
		sim->mport[-2 - a->peer].cut = cut;
	else
		sim->esc[a->peer]->port[a->peer_port].cut = cut;
	sim->dirty = true;
	if (slave >= 0)
		ec_sim_ports(sim->esc[slave], now);
	if (a->peer >= 0)
		ec_sim_ports(sim->esc[a->peer], now);
}

/* ---- routes */

/* FMMUs of a slave changed */
void ec_sim_fmmus(struct ec_esc *esc)
{
	int i;

	for (i = 0; i < EC_SIM_PORTS && !esc->sim->dirty; i++) {
		struct ec_sim_step *st;

		if (esc->route_pos[i] < 0)
			continue;
		st = &esc->sim->route[i].step[esc->route_pos[i]];
		st->log_first = esc->log_first;
		st->log_last = esc->log_last;
	}
}

/* false: the frame ends here */
static bool add_step(struct ec_sim *sim, struct ec_sim_route *r, int mport,
		     struct ec_esc *esc, u32 t)
{
	struct ec_sim_step *st;
	bool circ = !esc->port[0].open;

	/* it carries the circulating bit by now: destroyed */
	if (circ && r->circ >= 0)
		return false;
	if (esc->route_pos[mport] >= 0)
		r->repeats = true;
	if (r->steps == sim->max)
		return false;
	st = &r->step[r->steps];
	st->esc = esc;
	st->pu_ns = t;
	st->log_first = esc->log_first;
	st->log_last = esc->log_last;
	esc->route_pos[mport] = (s32)r->steps;
	if (circ)
		r->circ = (int)r->steps;
	r->steps++;
	return true;
}

static void walk(struct ec_sim *sim, int mport)
{
	static const u8 next_port[EC_MAX_PORT] = { 3, 2, 0, 1 };
	struct ec_sim_route *r = &sim->route[mport];
	const struct ec_esc_port *cable = &sim->mport[mport];
	u32 guard = 8 * sim->count + 16;
	u64 t = 0;

	if (!ec_sim_link(sim, mport))
		return;
	while (guard--) {
		struct ec_esc *esc = sim->esc[cable->peer];
		u8 p = cable->peer_port;
		bool processed = false;

		t += cable->cable_ns;
		if (!esc->port[p].open) {	/* nobody listens */
			if (esc->port[p].auto_closed && esc->port[p].link) {
				r->opens = esc->index;
				r->opens_port = p;
			}
			return;
		}
		if (!(esc->route_mask & BIT(p))) {
			esc->route_mask |= (u8)BIT(p);
			esc->route_recv_ns[p] = (u32)t;
		}
		do {
			if (!p) {
				if (!add_step(sim, r, mport, esc, (u32)t))
					return;
				processed = true;
			}
			p = next_port[p];
		} while (!esc->port[p].open);
		t += processed ? esc->cfg.process_ns : esc->cfg.forward_ns;

		cable = &esc->port[p];
		if (!cable->link)		/* loop held open: lost */
			return;
		if (cable->peer < 0) {
			r->out_port = -2 - cable->peer;
			r->delay_ns = t + cable->cable_ns;
			return;
		}
	}
}

static void compute_routes(struct ec_sim *sim)
{
	u32 i, k;

	for (i = 0; i < EC_SIM_PORTS; i++) {
		struct ec_sim_route *r = &sim->route[i];

		r->steps = 0;
		r->delay_ns = 0;
		r->out_port = -1;
		r->circ = -1;
		r->repeats = false;
		r->opens = -1;
		for (k = 0; k < sim->count; k++) {
			sim->esc[k]->route_pos[i] = -1;
			sim->esc[k]->route_mask = 0;
		}
		walk(sim, (int)i);
		for (k = 0; k < r->steps; k++) {
			struct ec_sim_step *st = &r->step[k];

			st->recv_mask = st->esc->route_mask;
			memcpy(st->recv_ns, st->esc->route_recv_ns,
			       sizeof(st->recv_ns));
		}
	}
	sim->dirty = false;
}

/* ---- frames */

/* one frame on its way */
struct pass {
	struct ec_sim *sim;
	struct ec_sim_route *r;
	u32 steps;
	u64 now;
	u32 wire_ns;
	int mport;
};

static void visit(const struct pass *ps, u32 i, struct ec_dgram *d)
{
	const struct ec_sim_step *st = &ps->r->step[i];
	struct ec_frame_ctx ctx;
	int p;

	if (!st->esc->powered)		/* reset itself by this frame */
		return;
	ctx.now = ps->now + st->pu_ns;
	ctx.end = ctx.now + ps->wire_ns;
	ctx.recv_mask = st->recv_mask;
	for (p = 0; p < EC_MAX_PORT; p++)
		ctx.recv[p] = ps->now + st->recv_ns[p];
	ec_esc_dgram(st->esc, d, &ctx);
}

static void visit_all(const struct pass *ps, struct ec_dgram *d)
{
	u32 i;

	for (i = 0; i < ps->steps; i++)
		visit(ps, i, d);
}

/* the IRQ field of every datagram collects the events of all slaves */
static void collect_irq(const struct pass *ps, struct ec_dgram *d)
{
	u32 i;

	if (!ps->sim->irqs)
		return;
	for (i = 0; i < ps->steps; i++) {
		const struct ec_esc *esc = ps->r->step[i].esc;

		if (esc->irq && !esc->fault.dead)
			d->irq |= esc->ecat_event &
				  ec_esc_get16(esc, EC_REG_ECAT_MASK);
	}
	put_unaligned_le16(d->irq, d->hdr + 8);
}

static void by_position(const struct pass *ps, struct ec_dgram *d)
{
	u16 adp = d->adp, pos = (u16)-adp;

	collect_irq(ps, d);
	if (pos < ps->steps) {
		d->adp = 0;
		visit(ps, pos, d);
	}
	d->adp = (u16)(adp + ps->steps);
	put_unaligned_le16(d->adp, d->hdr + 2);
}

static void by_station(const struct pass *ps, struct ec_dgram *d)
{
	const struct ec_sim *sim = ps->sim;
	s32 node, pos = -1;

	if (!d->adp) {
		visit_all(ps, d);
		return;
	}
	node = sim->bucket[d->adp & (sim->buckets - 1)];
	for (; node >= 0; node = sim->node_next[node]) {
		s32 p = sim->esc[node / 2]->route_pos[ps->mport];

		if (sim->node_addr[node] != d->adp || p < 0 ||
		    p >= (s32)ps->steps || p == pos)
			continue;
		if (pos >= 0) {		/* two of them */
			visit_all(ps, d);
			return;
		}
		pos = p;
	}
	collect_irq(ps, d);
	if (pos >= 0)
		visit(ps, (u32)pos, d);
}

static void by_logical(const struct pass *ps, struct ec_dgram *d)
{
	u32 first = ec_dgram_logical(d), i;
	u64 last = (u64)first + d->len;

	collect_irq(ps, d);
	for (i = 0; i < ps->steps; i++) {
		const struct ec_sim_step *st = &ps->r->step[i];

		if (first <= st->log_last && last > st->log_first)
			visit(ps, i, d);
	}
}

static void datagram(const struct pass *ps, struct ec_dgram *d)
{
	if (ps->sim->slow || ps->r->repeats) {
		visit_all(ps, d);
		return;
	}
	switch (d->cmd) {
	case EC_CMD_NOP:
		collect_irq(ps, d);
		break;
	case EC_CMD_APRD:
	case EC_CMD_APWR:
	case EC_CMD_APRW:
		if (ps->sim->bug == EC_SIM_BUG_AP_NO_INC)
			visit_all(ps, d);
		else
			by_position(ps, d);
		break;
	case EC_CMD_FPRD:
	case EC_CMD_FPWR:
	case EC_CMD_FPRW:
		by_station(ps, d);
		break;
	case EC_CMD_LRD:
	case EC_CMD_LWR:
	case EC_CMD_LRW:
		by_logical(ps, d);
		break;
	default:
		visit_all(ps, d);
	}
}

/*
 * Circulating bit: an ESC without upstream link sets it, and destroys a frame
 * that has it. Returns false if this frame ends there.
 */
static bool circulating(struct pass *ps, u8 *frame, size_t len)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	bool had = false;

	if (ps->r->circ < 0 || ps->sim->bug == EC_SIM_BUG_CIRCULATING ||
	    ec_frame_iter_init(&it, frame, len))
		return true;
	while (ec_frame_iter_next(&it, &d) > 0) {
		had |= d.circulating;
		d.hdr[7] |= LEN_CIRCULATING;
	}
	if (had)
		ps->steps = (u32)ps->r->circ;
	return !had;
}

static void process(struct pass *ps, u8 *frame, size_t len)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	int ret;

	if (ec_frame_iter_init(&it, frame, len))
		return;				/* forwarded as it is */
	while ((ret = ec_frame_iter_next(&it, &d)) > 0)
		datagram(ps, &d);
	if (ret < 0 && ps->steps) {
		u8 *count = ps->r->step[0].esc->mem + EC_REG_ERR_PU;

		if (*count != 0xff)
			++*count;
	}
}

/**
 * ec_sim_frame_result() - pass one frame through the segment and back
 * @sim: segment
 * @port: master port at which it is sent, 0 or 1
 * @frame: EtherCAT header and datagrams, modified in place
 * @len: bytes in @frame, padding included
 * @now_ns: when the first bit is sent
 * @res: what became of it
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 * Return: delay in ns until the last bit is back, or -ENOLINK if it was lost.
 */
s64 ec_sim_frame_result(struct ec_sim *sim, int port, u8 *frame, size_t len,
			u64 now_ns, struct ec_sim_result *res)
{
	struct pass ps = { .sim = sim, .now = now_ns, .mport = port };
	bool lose_out = false, lose_back = false, lost;
	u64 extra_ns = 0;

	memset(res, 0, sizeof(*res));
	res->out_port = -1;
	res->delay_ns = -ENOLINK;
	ec_sim_advance(sim, now_ns);
	ec_sim_faults_frame(sim, port, &lose_out, &lose_back, res, &extra_ns);
	if (sim->dirty)
		compute_routes(sim);
	ps.r = &sim->route[port];
	if (lose_out || !ec_sim_link(sim, port)) {
		res->copies = 0;
		res->mangled = false;
		return -ENOLINK;
	}

	ps.steps = ps.r->steps;
	ps.wire_ns = ec_frame_wire_ns(EC_ETH_HDR + len) - 12 * 80;
	lost = !circulating(&ps, frame, len);
	process(&ps, frame, len);
	if (ps.r->opens >= 0) {		/* heard at an auto-closed port */
		struct ec_esc *esc = sim->esc[ps.r->opens];

		esc->port[ps.r->opens_port].auto_closed = false;
		ec_sim_loops(esc, false, now_ns);
	}
	deliver(sim);

	if (lost || lose_back || ps.r->out_port < 0) {
		res->copies = 0;
		res->mangled = false;
		return -ENOLINK;
	}
	if (res->mangled)
		ec_sim_faults_mangle(sim, frame, len);
	res->copies++;
	res->out_port = ps.r->out_port;
	res->delay_ns = (s64)(ps.r->delay_ns + ps.wire_ns + extra_ns);
	return res->delay_ns;
}

/**
 * ec_sim_frame2() - as ec_sim_frame(), for a ring
 * @sim: segment
 * @port: master port at which it is sent
 * @frame: EtherCAT header and datagrams, modified in place
 * @len: bytes in @frame
 * @now_ns: when the first bit is sent
 * @out_port: gets the master port at which it comes back, -1 if lost
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 * Return: delay in ns until the last bit is back, or -ENOLINK if it was lost.
 */
s64 ec_sim_frame2(struct ec_sim *sim, int port, u8 *frame, size_t len,
		  u64 now_ns, int *out_port)
{
	struct ec_sim_result res;

	ec_sim_frame_result(sim, port, frame, len, now_ns, &res);
	*out_port = res.out_port;
	return res.delay_ns;
}

/**
 * ec_sim_frame() - pass one frame through the segment and back
 * @sim: segment
 * @port: master port at which it is sent, 0 or 1
 * @frame: EtherCAT header and datagrams, modified in place
 * @len: bytes in @frame
 * @now_ns: when the first bit is sent
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 * Return: delay in ns until the last bit is back, or -ENOLINK if it was lost.
 */
s64 ec_sim_frame(struct ec_sim *sim, int port, u8 *frame, size_t len,
		 u64 now_ns)
{
	struct ec_sim_result res;

	return ec_sim_frame_result(sim, port, frame, len, now_ns, &res);
}

/* ---- looking */

/**
 * ec_sim_count() - slaves in the segment
 * @sim: segment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: how many were added.
 */
u32 ec_sim_count(const struct ec_sim *sim)
{
	return sim->count;
}

/**
 * ec_sim_slave() - slave by number
 * @sim: segment
 * @index: in the order of ec_sim_add()
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the slave, NULL when there is none.
 */
struct ec_esc *ec_sim_slave(struct ec_sim *sim, u32 index)
{
	return index < sim->count ? sim->esc[index] : NULL;
}

/**
 * ec_sim_now() - how far time has advanced
 * @sim: segment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: simulation time, ns.
 */
u64 ec_sim_now(const struct ec_sim *sim)
{
	return sim->now;
}

/**
 * ec_sim_set_slow() - let every datagram visit every slave
 * @sim: segment
 * @slow: without shortcuts; results must not differ
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sim_set_slow(struct ec_sim *sim, bool slow)
{
	sim->slow = slow;
}
