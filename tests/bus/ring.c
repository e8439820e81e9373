// SPDX-License-Identifier: GPL-2.0-only
#include "ring.h"
#include "devices/sim/esc_int.h"

const char ring_eight[] =
	"segment seed=8 response=100us transition=1ms\n"
	"repeat 8 slave d drive in=8 out=8 cable=50\n"
	"wire d8.1 -> master.1 cable=50\n";

/* The drive copies outputs to inputs: LRW reads before it writes. */
static void ring_look(struct cyc *c)
{
	struct ring *r = c->ctx;
	bool missing = false;
	u32 i, k;

	ec_sim_advance(r->b->sim, ktime_get_ns());
	r->late = r->b->sim->disturbed == r->disturbed ? r->late + 1 : 0;
	r->disturbed = r->b->sim->disturbed;
	r->met += r->late < 2;
	for (i = 0; i < r->n; i++) {
		u8 is = *r->in[i];

		if (r->absent & BIT_ULL(i))
			continue;
		for (k = 0; k < RING_HISTORY && is != r->value[k]; k++)
			;
		r->wrong += k == RING_HISTORY;
		missing |= is != r->value[1];
		r->left += bus_esc(r->b, i)->mem[EC_REG_AL_STATUS] != EC_AL_OP;
	}
	missing |= cyc_state(c, 0)->wc_state != EC_STATUS_WC_COMPLETE;
	r->lost += missing && r->late >= 2;
	r->flown += missing && r->late < 2;
	memmove(r->value + 1, r->value, RING_HISTORY - 1);
	r->value[0] = r->value[0] % 255 + 1;
	for (i = 0; i < r->n; i++)
		*r->out[i] = r->value[0];
}

struct ring *ring_new(struct kunit *test, struct bus *b)
{
	struct ring *r = kunit_kzalloc(test, sizeof(*r), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, r);
	r->b = b;
	return r;
}

/* All @n slaves in OP, and the values are as expected for a while. */
void ring_run(struct ring *r, u32 n)
{
	u32 i;

	r->c = cyc_in_op(r->b, 0, n);
	r->n = n;
	for (i = 0; i < n; i++) {
		r->in[i] = cyc_pd(r->c, i, 3) + RING_ECHO;
		r->out[i] = cyc_pd(r->c, i, 2) + RING_ECHO;
	}
	r->c->ctx = r;
	r->c->each = ring_look;
	cyc_run(r->c, 20);
	r->wrong = r->lost = r->flown = r->left = r->met = 0;
	cyc_run(r->c, 50);
	KUNIT_EXPECT_EQ(r->b->test, r->lost, 0u);
	KUNIT_EXPECT_EQ(r->b->test, r->wrong, 0u);
}

void ring_expect(struct ring *r, const char *after)
{
	KUNIT_EXPECT_EQ_MSG(r->b->test, r->wrong, 0u, "after %s", after);
	KUNIT_EXPECT_EQ_MSG(r->b->test, r->lost, 0u, "after %s", after);
	KUNIT_EXPECT_EQ_MSG(r->b->test, r->left, 0u, "after %s", after);
}

/* No value was wrong meanwhile; none is lost any more. */
void ring_is_whole(struct ring *r, const char *after)
{
	ring_closed(r->b, r->n);
	r->lost = r->left = 0;
	cyc_run(r->c, 100);
	ring_expect(r, after);
}

/* Cable number @i of @n slaves: 0 at the main device, @n at the backup device. */
void ring_cable_of(struct bus *b, bool cut, u32 i, u32 n, u32 after_ns)
{
	bus_fault_later(b, cut ? EC_SIM_FAULT_CUT : EC_SIM_FAULT_HEAL, min(i, n - 1), i == n,
			after_ns);
}

void ring_cable(struct bus *b, bool cut, u32 i)
{
	ring_cable_of(b, cut, i, SLAVES, 0);
}

/*
 * The cable of the next random event: @at again if it is cut, or if the ring is still open there,
 * since two breaks cut slaves off; else @other.
 */
u32 ring_next_cut(struct bus *b, u32 at, bool is_cut, u32 other)
{
	return is_cut || bus_links(b)->ring.state != EC_RING_CLOSED ? at : other;
}

void ring_state(struct bus *b, u8 state, u32 front, u32 n)
{
	KUNIT_EXPECT_EQ(b->test, bus_links(b)->ring.state, state);
	KUNIT_EXPECT_EQ(b->test, bus_links(b)->ring.front, front);
	KUNIT_EXPECT_EQ(b->test, bus_n_slaves(b), n);
}

void ring_closed(struct bus *b, u32 n)
{
	ring_state(b, EC_RING_CLOSED, n, n);
}

void ring_open(struct bus *b, u32 front)
{
	ring_state(b, EC_RING_OPEN, front, SLAVES);
}

/* Process data as @like has them, in domain 0: the slave of @config may be absent. */
void ring_map_like(struct cyc *c, u32 config, const struct ec_slave *like)
{
	struct ec_ioc_sc_sync sync = { .config = config };
	u32 sm, i, k;

	for (sm = 0; sm < like->n_sms; sm++) {
		const struct ec_pdo_list *l = &like->pdos.sm[sm];

		if (!ec_pdo_list_bytes(l))
			continue;
		sync.sm = sm;
		sync.dir = sm ? EC_CFG_DIR_INPUT : EC_CFG_DIR_OUTPUT;
		KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_SYNC, &sync), 0);
		cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, sm, 0, 0);
		for (i = 0; i < l->n; i++) {
			cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, sm, l->pdos[i].index, 0);
			cyc_pdo(c, config, EC_SC_PDO_MAP_CLEAR, sm, l->pdos[i].index, 0);
			for (k = 0; k < l->pdos[i].n_entries; k++)
				cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, sm, l->pdos[i].index,
					ec_pdo_entry_value(&l->pdos[i].entries[k]));
		}
		cyc_map(c, config, sm, 0);
	}
}
