// SPDX-License-Identifier: GPL-2.0-only
/*
 * Segment: its slaves, their station addresses, and time.
 */
#include "esc_int.h"

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

/* a slave's next event has come nearer */
void ec_sim_key(struct ec_esc *esc, u64 t)
{
	esc->key = t;
	heap_up(esc->sim, esc->heap_pos);
}

/*
 * When the next process data watchdog expires. They are started by every frame
 * and hardly ever expire, so they are not in the heap: a lower bound is kept, and
 * all are looked through when the bound is reached.
 */
static u64 watchdogs_next(struct ec_sim *sim, u64 limit)
{
	u32 i;

	if (sim->wd_next > limit)
		return EC_ESC_NEVER;
	sim->wd_next = EC_ESC_NEVER;
	for (i = 0; i < sim->count; i++) {
		if (sim->esc[i]->wd_due >= sim->wd_next)
			continue;
		sim->wd_next = sim->esc[i]->wd_due;
		sim->wd_slave = i;
	}
	return sim->wd_next;
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

	a = min(a, b);
	b = ec_sim_next_step(sim);
	a = min(a, b);
	b = watchdogs_next(sim, a);
	return min(a, b);
}

/**
 * ec_sim_advance() - let time pass
 * @sim: segment
 * @now_ns: until when; going back does nothing
 *
 * Faults, watchdogs, pulses, applications and frames on their way that are due
 * until then act, in the order of their times.
 *
 * Context: Any. RT-safe: bounded by what is due, no sleep, no allocation.
 */
void ec_sim_advance(struct ec_sim *sim, u64 now_ns)
{
	for (;;) {
		u64 a = slaves_next(sim), b = ec_sim_faults_next(sim);
		u64 c = sim->flights ? sim->flights->at_ns : EC_ESC_NEVER;
		u64 t = min(a, b), wd;

		t = min(t, c);
		wd = watchdogs_next(sim, min(t, now_ns));
		t = min(t, wd);
		if (t > now_ns || t == EC_ESC_NEVER)
			break;
		sim->now = max(sim->now, t);
		if (b <= t)
			ec_sim_faults_run(sim, sim->now);
		else if (wd <= t)
			ec_esc_run(sim->esc[sim->wd_slave], sim->now);
		else if (a <= t)
			ec_esc_run(sim->esc[sim->heap[0]], sim->now);
		else
			ec_sim_step(sim);
	}
	sim->now = max(sim->now, now_ns);
}

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
	sim->wd_next = EC_ESC_NEVER;
	sim->port_next = EC_ESC_NEVER;
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
	    !sim->route[1].step || ec_sim_spans_init(sim) ||
	    ec_sim_faults_init(sim)) {
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
	ec_sim_spans_exit(sim);
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
	if (!esc->mem || !esc->eep.data || ec_sim_spans_room(sim, cfg->fmmus)) {
		free_slave(sim, esc);
		return NULL;
	}
	memset(esc->eep.data, 0xff, esc->eep.len);
	if (cfg->eeprom)
		memcpy(esc->eep.data, cfg->eeprom, cfg->eeprom_len);
	esc->cfg.eeprom = NULL;

	for (p = 0; p < EC_MAX_PORT; p++) {
		esc->port[p].peer = -1;
		esc->port[p].link_at = EC_ESC_NEVER;
	}
	esc->link_wake = EC_ESC_NEVER;
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
	if (index >= sim->count)
		return NULL;
	ec_esc_settle(sim->esc[index]);		/* a caller looks */
	return sim->esc[index];
}

/**
 * ec_sim_at() - slave by number, to read what does not change while it runs
 * @sim: segment
 * @index: in the order of ec_sim_add()
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the slave, NULL when there is none.
 */
struct ec_esc *ec_sim_at(const struct ec_sim *sim, u32 index)
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
