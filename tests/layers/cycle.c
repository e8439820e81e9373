// SPDX-License-Identifier: GPL-2.0-only
/* Process data of two terminals, an output wired to an input. There is no session. */
#include <linux/delay.h>
#include <linux/kthread.h>
#include "master/base/once64.h"
#include "master/cycle/cycle.h"
#include "master/cycle/cycle_thread.h"
#include "master/cycle/receive.h"
#include "master/cycle/send.h"
#include "master/link/device.h"
#include "plant.h"

static const char text[] =
	"segment seed=5\n"
	"slave coupler EK1100\n"
	"slave out EL2008\n"
	"slave in EL1008\n"
	"connect out.1 -> in.1\n";

enum { OUT = 1, IN = 2, SLAVES };

struct bench {
	struct plant p;
	struct ec_cycles cycles;
	struct ec_cycle cycle;
	u32 out;
	u32 in;
};

/* the first SyncManager of a terminal that has process data; with the lock */
static bool map(struct ec_config *c, struct ec_domain *d, u32 *offset)
{
	unsigned int sm = 0;
	u32 bit;

	while (sm < EC_MAX_SM - 1 && !c->sm[sm].pdos.n)
		sm++;
	return CHECK_EQ(ec_config_reg_entry_pos(c, sm, 0, 0, d, offset, &bit), 0);
}

/* configurations, a domain and its layout; with the lock */
static bool lay_out(struct bench *b)
{
	struct ec_domain *d = ec_domain_create(&b->p.wanted);
	struct ec_config *out = plant_config(&b->p, OUT), *in = plant_config(&b->p, IN);

	if (!CHECK(!IS_ERR(d)) || !out || !in || !map(out, d, &b->out) || !map(in, d, &b->in))
		return false;
	b->cycle.shared = ec_shared_create(&b->p.memory, d->size, 0);
	return CHECK(b->cycle.shared) && CHECK_EQ(ec_cycle_layout(&b->cycle), 0);
}

static void bench_free(struct bench *b)
{
	mutex_lock(&b->p.lock);
	ec_cycle_set_active(&b->cycles, NULL);
	ec_access_change(&b->p.s.seg.links, EC_ACCESS_DIRECT);
	ec_cycle_free(&b->cycle);
	if (b->cycle.shared)
		ec_shared_put(b->cycle.shared);
	ec_cycle_clear(&b->cycle);
	mutex_unlock(&b->p.lock);
	plant_end(&b->p);
	kvfree(b);
}

static struct bench *bench_new(void)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);
	bool ok;

	if (!CHECK(b))
		return NULL;
	if (!plant_begin(&b->p, text, SLAVES)) {
		kvfree(b);
		return NULL;
	}
	ec_cycles_init(&b->cycles, &b->p.s.seg.base, &b->p.s.seg.carry, &b->p.s.seg.riders,
		       &b->p.dc);
	ec_cycle_init(&b->cycle, &b->cycles, &b->p.wanted);
	b->p.wanted.sends = &b->cycle.sends;
	mutex_lock(&b->p.lock);
	ok = lay_out(b);
	mutex_unlock(&b->p.lock);
	if (ok)
		return b;
	bench_free(b);
	return NULL;
}

static void activate(struct bench *b)
{
	mutex_lock(&b->p.lock);
	/* what was configured before this is what workers find */
	smp_store_release(&b->p.wanted.active, true);
	ec_access_change(&b->p.s.seg.links, EC_ACCESS_CYCLIC);
	ec_cycle_set_active(&b->cycles, &b->cycle);
	mutex_unlock(&b->p.lock);
}

static const struct ec_ioc_send all = { .queued = 1 };

/* the application's cycle, 1 ms */
static int cycle_owner(void *arg)
{
	struct bench *b = arg;

	while (!kthread_should_stop()) {
		ec_cycle_receive(&b->cycle);
		ec_cycle_send(&b->cycle, &all);
		usleep_range(1000, 1001);
	}
	return 0;
}

static bool has_input(void *arg)
{
	const struct bench *b = arg;

	return READ_ONCE(b->cycle.shared->image[b->in]) & 1;
}

static bool is_complete(void *arg)
{
	const struct bench *b = arg;
	const struct ec_status_domain *d = &b->cycle.shared->status->domains[0];

	return READ_ONCE(d->working_counter) == b->p.wanted.domains[0]->expected;
}

static void layout_counts_each_slave_once(void)
{
	struct bench *b = bench_new();

	if (!b)
		return;
	CHECK_EQ(b->cycle.layout.n_dgrams, 1);
	CHECK_EQ(b->cycle.layout.dgrams[0].cmd, EC_CMD_LRW);
	CHECK_EQ(b->cycle.layout.dgrams[0].len, 2);
	/* LRW: 2 for outputs, 1 for inputs */
	CHECK_EQ(b->p.wanted.domains[0]->expected, 3);
	CHECK_EQ(b->cycle.layout.plain.frames, 1);
	bench_free(b);
}

static void outputs_reach_slaves_and_inputs_come_back(void)
{
	struct bench *b = bench_new();
	struct task_struct *t;

	if (!b)
		return;
	activate(b);
	t = kthread_run(cycle_owner, b, "ec_alone");
	if (CHECK(!IS_ERR(t))) {
		plant_state(&b->p, OUT, EC_AL_OP);
		plant_state(&b->p, IN, EC_AL_OP);
		CHECK_EQ(b->p.s.bus.slaves[OUT]->al.status, EC_AL_OP);
		CHECK_EQ(b->p.s.bus.slaves[IN]->al.status, EC_AL_OP);
		CHECK(alone_wait(is_complete, b, 100));
		CHECK(!has_input(b));
		WRITE_ONCE(b->cycle.shared->image[b->out], 1);
		CHECK(alone_wait(has_input, b, 100));
		kthread_stop(t);
	}
	bench_free(b);
}

/* ops NULL: it has no requests of an application to notice */
static void kernel_runs_cycles_for_no_one(void)
{
	struct bench *b = bench_new();
	struct ec_shared *sh;

	if (!b)
		return;
	mutex_lock(&b->p.lock);
	sh = b->cycle.shared;
	b->cycle.setup.kernel.period_ns = 500000;
	b->cycle.setup.kernel.cpu = -1;
	CHECK_EQ(ec_cycle_thread_create(&b->cycle, sh->image_size, NULL), 0);
	mutex_unlock(&b->p.lock);
	activate(b);
	mutex_lock(&b->p.lock);
	ec_cycle_thread_start(&b->cycle);
	msleep(50);
	/* 100 in that time */
	CHECK_OP(ec_read64(&b->cycles.number), >, 20);
	CHECK_OP(ec_read64(&b->cycle.sends), >, 20);
	ec_cycle_thread_stop(&b->cycle);
	CHECK(!b->cycle.thread);
	mutex_unlock(&b->p.lock);
	bench_free(b);
}

/* the device has left: the next send reports it to the owner of the cycle */
static void cycle_ends_without_device(void)
{
	struct bench *b = bench_new();

	if (!b)
		return;
	activate(b);
	CHECK_EQ(ec_cycle_receive(&b->cycle), 0);
	CHECK_EQ(ec_cycle_send(&b->cycle, &all), 0);
	usleep_range(1000, 1100);
	CHECK_EQ(ec_cycle_receive(&b->cycle), 0);
	b->cycle.shared->status->domains[0].working_counter = 3;
	ec_device_release(&b->p.s.seg.links, EC_MAIN, "none", NULL);
	CHECK_EQ(ec_cycle_send(&b->cycle, &all), -ENODEV);
	ec_cycles_nothing_back(&b->cycles);
	CHECK_EQ(b->cycle.shared->status->domains[0].working_counter, 0);
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(layout_counts_each_slave_once),
	TEST(outputs_reach_slaves_and_inputs_come_back),
	TEST(kernel_runs_cycles_for_no_one),
	TEST(cycle_ends_without_device),
	{ }
};
