// SPDX-License-Identifier: GPL-2.0-only
/* Each cycle of a tree with random events: is all well with those that were not cut off? */
#include "random.h"
#include "master/bus/graph.h"
#include "master/boundary/ioctl.h"

/*
 * Cycles with another station address: that of a trial, or one from a frame whose reply was lost,
 * which is known after 20 ms and mended 10 ms later.
 */
#define READDRESSED	40u
#define COUNTER		3u	/* added to a working counter by a slave with both directions */

static struct ec_slave *by_station(struct bus *b, u16 station)
{
	u32 i;

	for (i = 0; i < bus_n_slaves(b); i++)
		if (bus_slave(b, i)->station == station)
			return bus_slave(b, i);
	return NULL;
}

static bool is_well(const struct ec_esc *esc, const struct ec_slave *s)
{
	return esc->mem[EC_REG_AL_STATUS] == EC_AL_OP && !READ_ONCE(s->stop.gone) &&
	       !READ_ONCE(s->reply.silent) && !READ_ONCE(s->work.reconfigure) &&
	       READ_ONCE(s->al.status) == EC_AL_OP;
}

/* A port that has closed itself at a loss of link stays closed when the link is back. */
static bool is_passed(struct bus *b, const struct ec_esc *esc)
{
	const struct ec_sim_route *r = &b->sim->route[0];
	u32 at = (u32)esc->route_pos[0];

	return at < r->steps && r->step[at].esc == esc;
}

static void report(struct random_run *r, u32 i)
{
	const struct ec_slave *s = r->s[i].slave;
	const struct ec_esc *esc = bus_esc(r->b, i);

	if (r->broken++ < 10)
		pr_info("# broken: slave %u of the segment, AL 0x%02x, gone %d silent %d, reconfigure %d, AL of the list 0x%02x, passed %d, station 0x%04x instead of 0x%04x, well for %llu cycles, %llu ns\n",
			i, esc->mem[EC_REG_AL_STATUS], s->stop.gone, s->reply.silent,
			s->work.reconfigure,
			s->al.status, is_passed(r->b, esc),
			get_unaligned_le16(esc->mem + EC_REG_STATION), s->station, r->s[i].well,
			ktime_get_ns());
}

/* A trial that meets an event may address one that is known already: not for long. */
static bool is_addressed(struct random_run *r, struct random_slave *x, const struct ec_esc *esc)
{
	if (get_unaligned_le16(esc->mem + EC_REG_STATION) == x->slave->station) {
		x->readdressed = 0;
		return true;
	}
	r->readdressed++;
	r->longest = max(r->longest, ++x->readdressed);
	return x->readdressed <= READDRESSED;
}

/*
 * One that hangs elsewhere now, in OP and with its station address, is known where it was until the
 * change is listed; then it is configured as one that has returned.
 */
static bool is_listed_here(struct bus *b, const struct ec_esc *esc, const struct ec_slave *s)
{
	const struct ec_slave *up = ec_graph_parent(s);
	unsigned int p;

	if (!up)
		return !esc->route_pos[0];
	for (p = 0; p < EC_MAX_PORT; p++)
		if (esc->port[p].peer >= 0 &&
		    get_unaligned_le16(b->sim->esc[esc->port[p].peer]->mem + EC_REG_STATION) ==
		    up->station)
			return true;
	return false;
}

static void become(struct random_run *r, struct random_slave *x, const struct ec_esc *esc)
{
	struct ec_slave *s = by_station(r->b, get_unaligned_le16(esc->mem + EC_REG_STATION));

	if (!s || !is_well(esc, s) || ec_slave_busy(s) || !is_listed_here(r->b, esc, s))
		return;
	if (x->slave)
		ec_slave_unref(x->slave);
	x->slave = ec_slave_ref(s);
	x->readdressed = 0;
	x->well = 1;
}

/* Once entitled, a slave remains so until a link on its path is lost. */
static void check_state(struct random_run *r, u32 i)
{
	const struct ec_esc *esc = bus_esc(r->b, i);
	struct random_slave *x = &r->s[i];

	if (!r->mark[i] || !x->configured) {
		x->well = 0;
	} else if (!x->well) {
		if (is_passed(r->b, esc))
			become(r, x, esc);
	} else if (is_well(esc, x->slave) && is_passed(r->b, esc) && is_addressed(r, x, esc)) {
		x->well++;
		r->checked += random_entitled(x);
	} else {
		if (random_entitled(x))
			report(r, i);
		x->well = 0;
	}
}

static void disturbed(struct random_run *r, u32 i, const char *what, u32 is, u32 wanted)
{
	/* what a frame that was lost should have brought comes with the next */
	if (r->late < 2) {
		r->in_flight++;
		return;
	}
	if (r->wrong++ < 10)
		pr_info("# wrong: %s of %u, %u instead of %u, %llu ns\n", what, i, is, wanted,
			ktime_get_ns());
}

/* An LRW reads before it writes: what the slave got with the send before the last. */
static void check_data(struct random_run *r)
{
	u32 least[EC_MAX_DOMAINS] = { 0 };
	u32 i;

	for (i = 0; i < r->n; i++) {
		const struct random_slave *x = &r->s[i];
		u8 is;

		if (!random_entitled(x) || !x->data)
			continue;
		least[x->domain] += COUNTER;
		is = cyc_data(r->c, x->domain)[x->in];
		if (is != r->value[1])
			disturbed(r, i, "value", is, r->value[1]);
	}
	for (i = 0; i < EC_MAX_DOMAINS && r->c->queued >> i; i++)
		if (cyc_state(r->c, i)->working_counter < least[i])
			disturbed(r, i, "working counter", cyc_state(r->c, i)->working_counter,
				  least[i]);
}

static void next_outputs(struct random_run *r)
{
	u32 i;

	memmove(r->value + 1, r->value, RANDOM_HISTORY - 1);
	r->value[0] = r->value[0] % 255 + 1;
	for (i = 0; i < r->n; i++)
		if (r->s[i].data)
			cyc_data(r->c, r->s[i].domain)[r->s[i].out] = r->value[0];
	if (!r->clocks)
		return;
	r->c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	r->c->app_time = ktime_to_ns(r->c->next) + 123456789;
}

/**
 * random_look() - between receive and send
 * @c: application; its context is the run
 */
void random_look(struct cyc *c)
{
	struct random_run *r = c->ctx;
	u64 now = ktime_get_ns();
	u32 i;

	ec_sim_advance(r->b->sim, now);
	r->late = r->b->sim->disturbed == r->disturbed ? r->late + 1 : 0;
	r->disturbed = r->b->sim->disturbed;
	r->met += !r->late;
	if (r->e.sim)
		port_events_plan(&r->e, now);
	port_events_reached(r->b->sim, r->last_ns, -1, r->mark);
	for (i = 0; i < r->n; i++)
		check_state(r, i);
	check_data(r);
	next_outputs(r);
	random_users_turn(r, now);
	if (now >= r->rescan_ns) {
		r->rescan_ns = now + 1000000ull * (2000 + random_below(r, 20000));
		KUNIT_EXPECT_EQ(r->b->test, ec_ioc(&r->b->app, EC_IOC_RESCAN, NULL), 0);
	}
	r->last_ns = now;
}
