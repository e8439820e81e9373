// SPDX-License-Identifier: GPL-2.0-only
/* Threads of slaves: as many as are needed at once, few when nothing is to be done. */
#include <linux/sched/signal.h>
#include "cyc.h"
#include "oom_case.h"

#define SLAVES	100
#define KEPT	7	/* one for 16 of them */
#define JOBS	600
#define MS	10

/* All threads there are, of any master. */
static u32 threads(void)
{
	struct task_struct *p;
	u32 n = 0;

	rcu_read_lock();
	for_each_process(p)
		n += !strncmp(p->comm, "EtherCAT", 8) && strstr(p->comm, "-slv");
	rcu_read_unlock();
	return n;
}

static struct bus *line(struct kunit *test, u32 slaves)
{
	char text[160];
	struct bus *b;

	snprintf(text, sizeof(text), "segment seed=4 response=100us transition=1ms\n"
		 "repeat %u slave d drive in=8 out=8\n", slaves);
	KUNIT_EXPECT_EQ(test, threads(), 0u);
	b = bus_up(test, text, slaves);
	bus_idle(b);
	return b;
}

static void ends(struct kunit *test)
{
	bus_exit(test);
	KUNIT_EXPECT_EQ(test, threads(), 0u);
}

static void all_to(struct bus *b, u8 state)
{
	u32 i;

	for (i = 0; i < SLAVES; i++)
		ec_slave_request(bus_slave(b, i), state);
	while (!bus_settled(b))
		usleep_range(100, 101);
	for (i = 0; i < SLAVES; i++)
		KUNIT_EXPECT_EQ_MSG(b->test, bus_slave(b, i)->al.status, state, "slave %u", i);
}

/* Through INIT to PREOP; us. */
static u64 again(struct bus *b)
{
	u64 t0 = ktime_get_ns();

	all_to(b, EC_AL_INIT);
	all_to(b, EC_AL_PREOP);
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

static void workers_few_remain(struct kunit *test)
{
	struct bus *b = line(test, SLAVES);
	u32 busy = threads(), early, idle;
	u64 many, few;

	many = again(b);
	busy = max(busy, threads());
	msleep(49000);
	early = threads();
	msleep(11000);
	idle = threads();
	few = again(b);
	bus_figure("%u slaves: %u workers after the start, %u of them there 49 s later, %u after 60 s; %u slaves through INIT with all of them %llu us, with these %llu us",
		   SLAVES, busy, early, idle, SLAVES, many, few);
	KUNIT_EXPECT_GT(test, busy, (u32)SLAVES / 4);
	KUNIT_EXPECT_EQ(test, early, busy);
	KUNIT_EXPECT_EQ(test, idle, (u32)KEPT);
	KUNIT_EXPECT_LE(test, 10 * few, 11 * many);
	/* it needs one for two seconds each: the others end all the same */
	for (busy = 0; busy < 40; busy++) {
		ec_slave_kick(bus_slave(b, busy));
		msleep(2000);
	}
	KUNIT_EXPECT_EQ(test, threads(), (u32)KEPT);
	/* one for each 16 of those that are there */
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 20, 0, 0, 0);
	msleep(61000);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), 20u);
	KUNIT_EXPECT_EQ(test, threads(), 2u);
	ends(test);
}

struct jobs {
	struct job {
		struct ec_job job;
		struct jobs *all;
		atomic_t inside;
		atomic_t runs;
		atomic_t ends;
	} job[JOBS];
	atomic_t most;
	atomic_t now;
	atomic_t clashes;
	atomic_t left;
};

static void stay(struct ec_job *job)
{
	struct job *j = container_of(job, struct job, job);
	int now = atomic_inc_return(&j->all->now);

	if (now > atomic_read(&j->all->most))
		atomic_set(&j->all->most, now);
	if (atomic_inc_return(&j->inside) > 1)
		atomic_inc(&j->all->clashes);
	usleep_range(MS * 1000, MS * 1000 + 1);
	atomic_inc(&j->runs);
	atomic_dec(&j->inside);
	atomic_dec(&j->all->now);
}

static void leave(struct ec_job *job)
{
	struct job *j = container_of(job, struct job, job);

	atomic_inc(&j->ends);
	atomic_dec(&j->all->left);
}

static struct jobs *jobs_queue(struct bus *b, u32 n)
{
	struct jobs *js = kunit_kzalloc(b->test, sizeof(*js), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, js);
	for (i = 0; i < n; i++) {
		js->job[i].job = (struct ec_job){ .run = stay, .end = leave };
		js->job[i].all = js;
		atomic_inc(&js->left);
		KUNIT_EXPECT_TRUE(b->test,
				  ec_workers_queue(bus_workers(b), &js->job[i].job));
	}
	return js;
}

/* Until all have ended; ms. */
static u32 jobs_wait(struct bus *b, struct jobs *js, u32 n, int runs)
{
	u64 t0 = ktime_get_ns();
	u32 i;

	for (i = 0; i < 20000 && atomic_read(&js->left); i++)
		usleep_range(1000, 1001);
	for (i = 0; i < n; i++) {
		KUNIT_EXPECT_EQ_MSG(b->test, atomic_read(&js->job[i].runs), runs, "job %u", i);
		KUNIT_EXPECT_EQ_MSG(b->test, atomic_read(&js->job[i].ends), runs, "job %u", i);
	}
	KUNIT_EXPECT_EQ(b->test, atomic_read(&js->clashes), 0);
	return div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
}

/* As many at once as there may be; the others wait for these. */
static void workers_most(struct kunit *test)
{
	struct bus *b = line(test, 1);
	struct jobs *js;
	u32 ms;

	ec_bus_need_workers(bus_table(b), 10000);
	js = jobs_queue(b, JOBS);
	ms = jobs_wait(b, js, JOBS, 1);
	KUNIT_EXPECT_EQ(test, atomic_read(&js->most), EC_MAX_WORKERS);
	KUNIT_EXPECT_LE(test, ms, 2u * MS + 2);
	msleep(60000);
	KUNIT_EXPECT_EQ(test, threads(), 1u);
	ends(test);
}

/* No thread can be created: one does all. Then one can, without another job. */
static void workers_without_memory(struct kunit *test)
{
	struct bus *b = line(test, 1);
	struct jobs *js;
	u32 ms;

	msleep(60000);
	KUNIT_EXPECT_EQ(test, threads(), 1u);
	oom_fail_from(1);
	js = jobs_queue(b, 50);
	msleep(10 * MS + 1);
	KUNIT_EXPECT_EQ(test, atomic_read(&js->most), 1);
	KUNIT_EXPECT_TRUE(test, oom_has_failed());
	ms = jobs_wait(b, js, 50, 1);
	KUNIT_EXPECT_GT(test, atomic_read(&js->most), 20);
	KUNIT_EXPECT_LE(test, ms, 11u * MS + 1);
	ends(test);
}

/* A job that is queued while it runs is run once more, not at the same time. */
static void workers_again(struct kunit *test)
{
	struct bus *b = line(test, 1);
	struct jobs *js = jobs_queue(b, 1);
	u32 ms;

	usleep_range(1000, 1001);
	atomic_inc(&js->left);
	KUNIT_EXPECT_TRUE(test, ec_workers_queue(bus_workers(b), &js->job[0].job));
	KUNIT_EXPECT_FALSE(test, ec_workers_queue(bus_workers(b), &js->job[0].job));
	ms = jobs_wait(b, js, 1, 2);
	KUNIT_EXPECT_GE(test, ms, 2u * MS - 2);
	ends(test);
}

/* The master is removed: what is queued is done before. */
static void workers_removed(struct kunit *test)
{
	struct bus *b = line(test, 1);
	struct jobs *js = jobs_queue(b, JOBS);

	bus_exit(test);
	KUNIT_EXPECT_EQ(test, atomic_read(&js->left), 0);
	KUNIT_EXPECT_EQ(test, threads(), 0u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(workers_few_remain),
	KUNIT_CASE(workers_most),
	KUNIT_CASE(workers_without_memory),
	KUNIT_CASE(workers_again),
	KUNIT_CASE(workers_removed),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_workers", .exit = oom_exit, .test_cases = cases,
};
kunit_test_suite(suite);
