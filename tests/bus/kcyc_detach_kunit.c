// SPDX-License-Identifier: GPL-2.0-only
/* The cycle goes on without its application, and another one takes it over. */
#include "kcyc.h"
#include "master/mailbox/emerg.h"
#include "master/base/limits.h"
#include "master/session/request.h"

static const struct ec_ioc_cycle hold = { .flags = EC_CYCLE_FLAG_DETACH, .stall_cycles = 10 };
static const struct ec_ioc_cycle zero = {
	.flags = EC_CYCLE_FLAG_DETACH, .stall = EC_STALL_ZERO, .stall_cycles = 10,
};

/* What the kernel does when the process has gone. */
static void die(struct kcyc *a)
{
	bus_end(a->c->b);
}

static u32 session_state(struct bus *b)
{
	struct ec_ioc_master i = { 0 };

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_MASTER, &i), 0);
	return i.session;
}

static bool plant_in_op(struct bus *b)
{
	u32 i;

	for (i = 0; i < bus_n_slaves(b); i++)
		if (bus_esc(b, i)->mem[EC_REG_AL_STATUS] != EC_AL_OP)
			return false;
	return true;
}

/* Frames go on, outputs are held, slaves stay in OP. */
static void detach_holds(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	u64 cycle, frames;

	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_ACTIVE);
	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 3);
	cycle = kcyc_status(a)->cycle;
	frames = bus_frames(b);
	die(a);
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_DETACHED);
	KUNIT_EXPECT_EQ(test, kcyc_wait(a, 1000), -EPERM);
	msleep(2000);
	KUNIT_EXPECT_GE(test, kcyc_status(a)->cycle - cycle, 1999ull);
	KUNIT_EXPECT_GE(test, bus_frames(b) - frames, 1999ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_STALLED);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 42ll);
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	/* what is left is freed with the master */
}

static void detach_zeroes(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, zero);

	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	die(a);
	msleep(100);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 0ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 0ll);
	KUNIT_EXPECT_TRUE(test, plant_in_op(a->c->b));
}

/* Without the flag, or when the application says so, nothing stays. */
static void detach_only_when_asked(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct bus *b = a->c->b;

	die(a);
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_NONE);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	a = kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	kcyc_until_op(a);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
	die(a);
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_NONE);
	/* one that was never active, or whose application runs the cycle, likewise */
	a = kcyc_configure(b, hold);
	die(a);
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_NONE);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
}

/* The next one goes on where the other has stopped; no slave notices. */
static void takeover_continues_session(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	u64 cycle, missed, frames = 0, sent;
	const struct ec_exchange_buffer *in;
	struct kcyc *n;
	u32 i;

	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 5);
	die(a);
	msleep(100);
	cycle = kcyc_status(a)->cycle;
	frames = bus_frames(b);
	n = kcyc_configure(b, hold);
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_DETACHED);
	msleep(200);
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(n), 0, "%s", b->app.reason);
	KUNIT_EXPECT_TRUE(test, n->taken_over);
	KUNIT_EXPECT_NULL(test, bus_candidate(b));
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_ACTIVE);
	/* outputs and inputs as they are, before anything is given */
	for (i = 0; i < 2; i++) {
		u32 sm;

		for (sm = 0; sm < 2; sm++)
			KUNIT_EXPECT_EQ(test, get_unaligned_le32(kcyc_outputs(n) +
				kcyc_place(n, i, sm, KCYC_CHANNELS)), 42u);
	}
	missed = kcyc_status(n)->missed;
	for (i = 0; i < 200; i++) {
		KUNIT_ASSERT_EQ(test, kcyc_wait(n, 0), 0);
		in = kcyc_take(n);
		KUNIT_ASSERT_NOT_NULL(test, in);
		KUNIT_EXPECT_EQ(test, in->cycle, n->seen);
		KUNIT_EXPECT_EQ(test, in->domains[0].wc_state, 2u);
		KUNIT_EXPECT_EQ(test, kcyc_output(n, "s1", 1), i ? 43ll : 42ll);
		kcyc_write(n, 43);
		kcyc_give(n);
	}
	sent = bus_frames(b) - frames;
	KUNIT_EXPECT_GE(test, sent, kcyc_status(n)->cycle - cycle);
	KUNIT_EXPECT_EQ(test, kcyc_status(n)->overruns, 0ull);
	KUNIT_EXPECT_LE(test, kcyc_status(n)->missed, missed + 2);
	KUNIT_EXPECT_EQ(test, kcyc_status(n)->takeovers, 1u);
	KUNIT_EXPECT_EQ(test, kcyc_status(n)->late_count, kcyc_status(n)->cycle);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
	KUNIT_EXPECT_EQ(test, kcyc_status(n)->state, EC_CYCLE_STATE_RUNNING);
}

/* What the next one may use: it is root here, so its right is set in its session. */
static struct kcyc *taken_with(struct bus *b, u32 priority)
{
	struct kcyc *n = kcyc_configure(b, hold);

	bus_candidate(b)->cycle.setup.priority = priority;
	KUNIT_ASSERT_EQ_MSG(b->test, kcyc_activate(n), 0, "%s", b->app.reason);
	KUNIT_ASSERT_TRUE(b->test, n->taken_over);
	return n;
}

/* The priority of the cycle follows the right of its owner, both ways, and the log has it. */
static void takeover_priority_follows_rights(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	struct task_struct *task;

	bus_lock(b);
	task = ec_cycle_thread_task(bus_cycle(b));
	bus_unlock(b);
	KUNIT_EXPECT_EQ(test, task->policy, (unsigned int)SCHED_FIFO);
	KUNIT_EXPECT_EQ(test, task->rt_priority, 50u);
	die(a);
	a = taken_with(b, 0);
	KUNIT_EXPECT_EQ(test, task->policy, (unsigned int)SCHED_NORMAL);
	KUNIT_EXPECT_EQ(test, task->rt_priority, 0u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("cycle thread runs SCHED_OTHER: SCHED_FIFO 50 needs"),
			1u);
	die(a);
	a = taken_with(b, 30);
	KUNIT_EXPECT_EQ(test, task->policy, (unsigned int)SCHED_FIFO);
	KUNIT_EXPECT_EQ(test, task->rt_priority, 30u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("cycle thread runs SCHED_FIFO 30: 50 exceeds"), 1u);
	die(a);
	a = taken_with(b, 50);
	KUNIT_EXPECT_EQ(test, task->rt_priority, 50u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("cycle thread runs SCHED_FIFO 50, as the new"), 1u);
	/* an equal right is no event */
	die(a);
	a = taken_with(b, 50);
	KUNIT_EXPECT_EQ(test, bus_log_lines("cycle thread runs SCHED_FIFO 50, as the new"), 1u);
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
}

/* Killed and taken over again and again. */
static void takeover_often(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	u32 i;

	for (i = 1; i <= 20; i++) {
		kcyc_write(a, i);
		if (i % 3)
			kcyc_give(a);
		kcyc_wait_cycles(a, i % 4);
		die(a);
		a = kcyc_configure(b, hold);
		KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
		KUNIT_EXPECT_TRUE(test, a->taken_over);
	}
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->takeovers, 20u);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 20ll);
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
}

#define MESS_EMERG	4	/* kept of each slave */

/* With emergencies and a request of the second slave. */
static struct kcyc *configure_area(struct bus *b)
{
	struct ec_ioc_sc_request rq = { .config = 1, .kind = EC_REQUEST_REG, .size = 4 };
	struct ec_ioc_sc_emerg em = { .config = 1, .count = MESS_EMERG };
	struct kcyc *a = kcyc_configure(b, hold);

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_REQUEST, &rq), 0);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_EMERG, &em), 0);
	KUNIT_ASSERT_EQ_MSG(b->test, kcyc_activate(a), 0, "%s", b->app.reason);
	return a;
}

static struct ec_emerg_ring *ring_of(const struct kcyc *a, u32 config)
{
	u8 *area = kcyc_shared(a)->requests;

	return (struct ec_emerg_ring *)(area + ((struct ec_request_area *)area)->rings) + config;
}

/* As the library does; -1: there is none. */
static int emerg_pop(const struct kcyc *a, u32 config)
{
	struct ec_emerg_ring *r = ring_of(a, config);
	u32 at;

	if (r->tail == r->head)
		return -1;
	KUNIT_ASSERT_NE(a->c->b->test, r->count, 0u);
	at = r->data + r->tail++ % r->count * EC_EMERG_BYTES;
	KUNIT_ASSERT_LE(a->c->b->test, at + EC_EMERG_BYTES, kcyc_shared(a)->request_size);
	return get_unaligned_le16(kcyc_shared(a)->requests + at);
}

static void emerg_put(const struct kcyc *a, u16 code)
{
	u8 message[EC_EMERG_BYTES] = { code & 0xff, code >> 8 };

	ec_emerg_push(bus_mbox(a->c->b, 1), message);
}

/* What an application that runs wild may do to all it can write. */
static void make_a_mess(struct kcyc *a, u32 i)
{
	struct ec_shared *sh = kcyc_shared(a);
	struct ec_exchange *x = sh->exchange;

	memset(sh->requests, 0xa5 + i, sh->request_size);
	WRITE_ONCE(x->outputs, i * 0x9e3779b9u);
	WRITE_ONCE(x->inputs, i * 0x85ebca6bu);
	x->stride = i * 0xc2b2ae35u;
	x->app_output = 77;
}

/* Whatever the one before has left in the memory, the next one finds its way. */
static void takeover_repairs_corrupted_memory(struct kunit *test)
{
	struct bus *b = kcyc_bus(test);
	struct kcyc *a = configure_area(b);
	struct ec_request_area *area = (void *)kcyc_shared(a)->requests;
	struct ec_exchange *x = kcyc_shared(a)->exchange;
	u32 i, stride = x->stride, rings = area->rings;

	kcyc_until_op(a);
	for (i = 0; i < 20; i++) {
		make_a_mess(a, i);
		msleep(i % 3);
		die(a);
		a = configure_area(b);
		KUNIT_EXPECT_EQ(test, x->stride, stride);
		KUNIT_EXPECT_EQ(test, area->magic, (u32)EC_REQUEST_MAGIC);
		KUNIT_EXPECT_EQ(test, area->rings, rings);
		KUNIT_EXPECT_EQ(test, ring_of(a, 1)->head, i);
		KUNIT_EXPECT_EQ(test, ring_of(a, 1)->overruns, 0u);
		KUNIT_EXPECT_EQ(test, emerg_pop(a, 0), -1);
		KUNIT_EXPECT_EQ(test, emerg_pop(a, 1), -1);
		emerg_put(a, 0x1000 + i);
		KUNIT_EXPECT_EQ(test, emerg_pop(a, 1), 0x1000 + (int)i);
		KUNIT_EXPECT_EQ(test, emerg_pop(a, 1), -1);
		kcyc_write(a, i);
		kcyc_give(a);
		kcyc_wait_cycles(a, 3);
		KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), (s64)i);
		KUNIT_EXPECT_NOT_NULL(test, kcyc_take(a));
	}
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
}

/* Emergencies the one before has not taken are the next one's; no others. */
static void takeover_of_emergencies(struct kunit *test)
{
	struct bus *b = kcyc_bus(test);
	struct kcyc *a = configure_area(b);
	u32 i;

	kcyc_until_op(a);
	/* as many as the ring has, but there never were any */
	ring_of(a, 1)->tail -= MESS_EMERG;
	die(a);
	a = configure_area(b);
	KUNIT_EXPECT_EQ(test, emerg_pop(a, 1), -1);
	for (i = 0; i < MESS_EMERG + 2; i++)
		emerg_put(a, 0x1000 + i);
	KUNIT_EXPECT_EQ(test, emerg_pop(a, 1), 0x1000);
	die(a);
	a = configure_area(b);
	KUNIT_EXPECT_EQ(test, ring_of(a, 1)->overruns, 2u);
	for (i = 1; i < MESS_EMERG; i++)
		KUNIT_EXPECT_EQ(test, emerg_pop(a, 1), 0x1000 + (int)i);
	KUNIT_EXPECT_EQ(test, emerg_pop(a, 1), -1);
}

static void set_late(struct bus *b, u32 per_s)
{
	struct ec_ioc_late late = { .per_s = per_s };

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_LATE, &late), 0);
}

/* How many cycles may be late is the new application's to say. */
static void takeover_late_cycles(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	struct ec_ioc_cycle tight = hold;

	KUNIT_EXPECT_EQ(test, bus_late_per_s(b), (u32)EC_LATE_PER_S);
	die(a);
	a = kcyc_configure(b, hold);
	set_late(b, 7);
	KUNIT_EXPECT_EQ(test, bus_late_per_s(b), (u32)EC_LATE_PER_S);
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	KUNIT_EXPECT_TRUE(test, a->taken_over);
	KUNIT_EXPECT_EQ(test, bus_late_per_s(b), 7u);
	KUNIT_EXPECT_EQ(test, bus_cycle_late_per_s(b), 7u);
	die(a);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	/* without them a cycle that leaves no room is refused, as any is; it takes 273 us */
	tight.period_ns = 290000;
	a = kcyc_configure(b, tight);
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	die(a);
	a = kcyc_configure(b, tight);
	set_late(b, 0);
	KUNIT_EXPECT_EQ(test, kcyc_activate(a), -ENOSPC);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "ecrt_master_set_late_cycles()"));
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_DETACHED);
	set_late(b, 1);
	KUNIT_EXPECT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, bus_late_per_s(b), 1u);
}

/* Everything else than the same is refused, and what is different is told. */
static void refused(struct bus *b, const char *what)
{
	struct ec_ioc_activate act = { 0 };

	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &act), -EEXIST);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(b->app.reason, what), "%s", b->app.reason);
	KUNIT_EXPECT_NOT_NULL(b->test, strstr(b->app.reason, "ethercat release"));
	bus_end(b);
	KUNIT_EXPECT_EQ(b->test, session_state(b), (u32)EC_SESSION_DETACHED);
}

/* Equal settings are equal startup commands, in whatever order an application made them. */
static void takeover_watchdog_order_is_no_difference(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	struct ec_ioc_sc_watchdog wd[] = {
		{ .config = 0, .intervals = 7 }, { .config = 0, .divider = 5, .intervals = 7 },
		{ .config = 1, .divider = 5, .intervals = 7 },
	};
	const struct ec_startup *last[2];
	unsigned int i;

	die(a);
	kcyc_configure(b, hold);
	for (i = 0; i < ARRAY_SIZE(wd); i++)
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_WATCHDOG, &wd[i]), 0);
	for (i = 0; i < 2; i++) {
		const struct ec_config *c = bus_candidate_config(b, i);

		KUNIT_ASSERT_EQ(test, c->n_startup[EC_STARTUP_REG], 2u);
		last[i] = list_last_entry(&c->startup, struct ec_startup, list);
	}
	KUNIT_EXPECT_EQ(test, last[0]->index, 0x0420);
	KUNIT_EXPECT_EQ(test, last[1]->index, 0x0420);
	bus_end(b);
}

static void takeover_refused(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	struct ec_ioc_cycle cfg = hold, none = { .cpu = -1 };
	struct ec_ioc_sc_watchdog wd = { .intervals = 7 };
	struct ec_ioc_sc_dc dc = { .assign_activate = 0x300, .cycle0 = 1000000 };
	struct ec_ioc_sc_command command = {
		.flags = EC_COMMAND_FLAG_WRITE, .config = 1, .from = EC_AL_OP, .to = EC_AL_SAFEOP,
		.kind = EC_REQUEST_REG, .index = 0x0f80, .size = 1, .data = (uintptr_t)"",
	};
	struct ec_ioc_datagram_request datagram = { .size = 4 };
	struct ec_ioc_sc_request rq = { .config = 1, .kind = EC_REQUEST_REG, .size = 4 };
	struct ec_ioc_sc_emerg em = { .config = 1, .count = 4 };
	struct ec_ioc_sc_flag flag = { .key = "Key", .value = 1 };
	u64 lost;
	int ret;

	die(a);
	lost = bus_lost(b);
	cfg.period_ns = 2000000;
	kcyc_configure(b, cfg);
	refused(b, "the period is 1000000 ns, not 2000000");
	cfg.period_ns = 0;
	cfg.priority = 9;
	kcyc_configure(b, cfg);
	refused(b, "how the kernel runs");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &none), 0);
	refused(b, "the kernel runs its cycle");
	cyc_new(b, 1000);
	refused(b, "it has 2 slaves, not 0");
	a = kcyc_configure(b, hold);
	cyc_domain(a->c);
	refused(b, "it has 1 domains, not 2");
	a = kcyc_configure(b, hold);
	cyc_pdo(a->c, 1, EC_SC_PDO_ASSIGN_CLEAR, 1, 0, 0);
	refused(b, "slave 0:1, SM1");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_WATCHDOG, &wd), 0);
	refused(b, "slave 0:0, watchdog");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_DC, &dc), 0);
	refused(b, "slave 0:0, distributed clock");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_REQUEST, &rq), 0);
	refused(b, "requests");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_EMERG, &em), 0);
	refused(b, "slave 0:1 keeps 0 emergencies, not 4");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_FLAG, &flag), 0);
	refused(b, "slave 0:0 has 0 flags, not 1");
	kcyc_configure(b, hold);
	bus_lock(b);
	ret = ec_config_sdo_add(bus_candidate_config(b, 1), 0x8000, 1, false, (const u8 *)"\1", 1);
	bus_unlock(b);
	KUNIT_ASSERT_EQ(test, ret, 0);
	refused(b, "slave 0:1, startup SDO 0x8000:01");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_COMMAND, &command), 0);
	refused(b, "slave 0:1, command for a transition, 0x0f80");
	kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DATAGRAM_REQUEST, &datagram), 0);
	refused(b, "requests");
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
	KUNIT_EXPECT_EQ(test, bus_lost(b), lost);
	/* and the same one still may */
	a = kcyc_configure(b, hold);
	KUNIT_EXPECT_EQ(test, kcyc_activate(a), 0);
	KUNIT_EXPECT_TRUE(test, a->taken_over);
}

/* One candidate at a time; it cannot change what runs. */
static void candidate_changes_no_running_session(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	struct ec_file other = { 0 };
	struct ec_ioc_interval interval = { .interval_us = 77 };
	struct ec_ioc_app_time time = { .app_time = 77 };
	struct ec_ioc_domain d = { 0 };
	u64 app_time;

	ec_file_init(&other, b->m, true);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_INTERVAL, &interval), -EBUSY);
	die(a);
	cyc_new(b, 500);
	KUNIT_EXPECT_EQ(test, bus_interval_us(b), 1000u);
	app_time = bus_app_time(b);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_APP_TIME, &time), 0);
	KUNIT_EXPECT_GE(test, bus_app_time(b), app_time);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_RESERVE, NULL), -EBUSY);
	cyc_domain(a->c);
	/* it sees its own domain, the others the one that runs */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN, &d), 0);
	KUNIT_EXPECT_EQ(test, d.size, 0u);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_DOMAIN, &d), 0);
	KUNIT_EXPECT_EQ(test, d.size, 3200u);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_END_DETACHED, NULL), -EBUSY);
}

/* The detached session ends; the one that wanted to take over has the master. */
static void end_detached(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	struct ec_ioc_cycle cfg = hold;

	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), -EBUSY);
	die(a);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), -ENOENT);
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_NONE);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);

	a = kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	kcyc_until_op(a);
	die(a);
	cfg.period_ns = 2000000;
	a = kcyc_configure(b, cfg);
	KUNIT_EXPECT_EQ(test, kcyc_activate(a), -EEXIST);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_EQ(test, session_state(b), (u32)EC_SESSION_RESERVED);
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	KUNIT_EXPECT_FALSE(test, a->taken_over);
	kcyc_until_op(a);
	kcyc_write(a, 5);
	kcyc_give(a);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 5ll);
}

/* The same with a hot connect group, which the session that ends does not have. */
static void end_detached_for_group(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	struct ec_ioc_group g = {
		.by = EC_GROUP_BY_PORT, .port = 1, .flags = EC_GROUP_FLAG_FAST, .name = "second",
	};
	const struct ec_sii_info *info = &bus_slave(b, 1)->info;
	struct ec_ioc_group_config m = {
		.vendor_id = info->vendor, .product_code = info->product,
	};
	struct ec_ioc_activate activate = { 0 };
	struct cyc *c;

	die(a);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	g.at = cyc_config(c, 0);
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_GROUP, &g), 0, "%s", b->app.reason);
	KUNIT_ASSERT_EQ_MSG(test, ec_ioc(&b->app, EC_IOC_GROUP_CONFIG, &m), 0, "%s", b->app.reason);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->ports.fast, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &activate), -EEXIST);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	cyc_activate(c);
	KUNIT_EXPECT_PTR_EQ(test, bus_config(b, g.at)->slave, bus_slave(b, 0));
	KUNIT_EXPECT_PTR_EQ(test, bus_config(b, m.index)->slave, bus_slave(b, 1));
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->ports.fast, BIT(1));
	cyc_release(c);
}

/* Configures the second slave as the first one: it is not there to be asked. */
static u32 absent(struct kcyc *a, u32 position)
{
	const struct ec_slave *s = bus_slave(a->c->b, 0);
	struct ec_ioc_slave_config sc = {
		.position = position, .vendor_id = s->info.vendor,
		.product_code = s->info.product,
	};

	KUNIT_ASSERT_EQ(a->c->b->test, ec_ioc(&a->c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	return sc.index;
}

/* A slave is away, with the PDOs that were found in it: still the same configuration. */
static void slave_is_away(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	u32 i, config;

	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 3);
	die(a);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	for (i = 0; i < 3000 && bus_n_slaves(b) != 1; i++)
		msleep(1);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), 1u);
	a = kunit_kzalloc(test, sizeof(*a), GFP_KERNEL);
	a->c = cyc_new(b, 1000);
	cyc_domain(a->c);
	cyc_map_all(a->c, 0, 1, 0);
	config = absent(a, 1);
	cyc_map(a->c, config, 0, 0);
	cyc_map(a->c, config, 1, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &(struct ec_ioc_cycle){
		.flags = hold.flags, .stall_cycles = hold.stall_cycles,
		.period_ns = KCYC_PERIOD_NS, .cpu = -1 }), 0);
	KUNIT_ASSERT_EQ_MSG(test, kcyc_activate(a), 0, "%s", b->app.reason);
	KUNIT_EXPECT_TRUE(test, a->taken_over);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	for (i = 0; i < 5000 && !(bus_n_slaves(b) == 2 && plant_in_op(b)); i++)
		msleep(1);
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
	msleep(100);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 42ll);
}

/* A slave that loses its state meanwhile is brought back to OP. */
static void slave_returns(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);
	struct bus *b = a->c->b;
	u32 i;

	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 3);
	die(a);
	bus_request(b, 1, EC_AL_INIT);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, 1, EC_AL_INIT, 2000), ~0ull);
	a = kcyc_configure(b, hold);
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	bus_request(b, 1, EC_AL_OP);
	for (i = 0; i < 3000 && !plant_in_op(b); i++)
		msleep(1);
	KUNIT_EXPECT_TRUE(test, plant_in_op(b));
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", 1), 42ll);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(slave_is_away),
	KUNIT_CASE(detach_holds),
	KUNIT_CASE(detach_zeroes),
	KUNIT_CASE(detach_only_when_asked),
	KUNIT_CASE(takeover_continues_session),
	KUNIT_CASE(takeover_priority_follows_rights),
	KUNIT_CASE(takeover_often),
	KUNIT_CASE(takeover_repairs_corrupted_memory),
	KUNIT_CASE(takeover_of_emergencies),
	KUNIT_CASE(takeover_late_cycles),
	KUNIT_CASE(takeover_watchdog_order_is_no_difference),
	KUNIT_CASE(takeover_refused),
	KUNIT_CASE(candidate_changes_no_running_session),
	KUNIT_CASE(end_detached),
	KUNIT_CASE(end_detached_for_group),
	KUNIT_CASE(slave_returns),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_kcyc_detach", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
