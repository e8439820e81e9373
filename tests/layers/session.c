// SPDX-License-Identifier: GPL-2.0-only
/* An application has the master; no device file and no function for the kernel gave it one. */
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/slab.h>
#include "master/config/apply.h"
#include "master/cycle/receive.h"
#include "master/cycle/send.h"
#include "master/link/device.h"
#include "master/session/activate.h"
#include "master/session/reserve.h"
#include "master/session/session.h"
#include "master/session/session_attach.h"
#include "master/session/session_units.h"
#include "scanned.h"
#include "master/clock/dc.h"

static const char text[] =
	"segment seed=6\n"
	"slave coupler EK1100\n"
	"slave axis drive in=8 out=8\n";

enum { AXIS = 1, SLAVES };

struct bench {
	struct scanned s;
	struct ec_dc dc;
	struct ec_cycles cycles;
	struct ec_sessions ss;
};

/* what is an open file in the layer above */
static const char owner[2];

static bool attached(const struct ec_slave *s)
{
	return ec_config_of(s);
}

/* of layers below: slaves are brought to their state; no one is woken */
static const struct ec_bus_ops bus_ops = {
	.configure = ec_apply,
	.attached = attached,
};

static void bench_free(struct bench *b)
{
	ec_session_end(&b->ss, NULL);
	ec_dc_exit(&b->dc);
	ec_sessions_exit(&b->ss);
	scanned_end(&b->s);
	CHECK_EQ(atomic_long_read(&b->ss.memory), 0);
	kvfree(b);
}

static struct bench *bench_new(void)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	if (!scanned_begin(&b->s, text)) {
		kvfree(b);
		return NULL;
	}
	b->s.bus.ops = &bus_ops;
	b->ss.base = &b->s.seg.base;
	b->ss.links = &b->s.seg.links;
	b->ss.bus = &b->s.bus;
	b->ss.dc = &b->dc;
	b->ss.cycles = &b->cycles;
	ec_cycles_init(&b->cycles, &b->s.seg.base, &b->s.seg.carry, &b->s.seg.riders, &b->dc);
	ec_setup_init(&b->s.bus);
	if (CHECK_EQ(ec_sessions_init(&b->ss, ec_session_again, ec_session_units), 0)) {
		ec_dc_init(&b->dc, &b->s.seg.base, &b->s.seg.links, &b->s.bus, b->ss.service);
		if (scanned_scan(&b->s, SLAVES)) {
			b->s.bus.slaves[AXIS]->pdos.wanted = true;
			ec_slave_kick(b->s.bus.slaves[AXIS]);
			scanned_wait(b->s.bus.slaves[AXIS]);
			return b;
		}
	}
	bench_free(b);
	return NULL;
}

static void master_has_one_application_at_a_time(void)
{
	struct bench *b = bench_new();

	if (!b)
		return;
	CHECK_EQ(ec_session_begin(&b->ss, &owner[0], NULL), 0);
	CHECK_EQ(b->s.bus.held, true);
	CHECK_EQ(ec_session_begin(&b->ss, &owner[1], NULL), -EBUSY);
	/* it is not that one's to end */
	ec_session_end(&b->ss, &owner[1]);
	CHECK(b->ss.session);
	ec_session_end(&b->ss, &owner[0]);
	CHECK(!b->ss.session);
	CHECK_EQ(b->s.bus.held, false);
	ec_device_release(&b->s.seg.links, EC_MAIN, "none", NULL);
	CHECK_EQ(ec_session_begin(&b->ss, &owner[0], NULL), -ENODEV);
	bench_free(b);
}

static bool in_op(void *slave)
{
	return READ_ONCE(((struct ec_slave *)slave)->al.status) == EC_AL_OP;
}

static bool in_preop(void *slave)
{
	return READ_ONCE(((struct ec_slave *)slave)->al.status) == EC_AL_PREOP;
}

static int cycle_owner(void *arg)
{
	static const struct ec_ioc_send all = { .queued = 1 };
	struct ec_cycle *c = arg;

	while (!kthread_should_stop()) {
		ec_cycle_receive(c);
		ec_cycle_send(c, &all);
		usleep_range(1000, 1001);
	}
	return 0;
}

/* with the session lock */
static bool configure(struct bench *b)
{
	struct ec_slave *axis = b->s.bus.slaves[AXIS];
	struct ec_session *s = ec_session_of(&b->ss, &owner[0]);
	struct ec_domain *d = ec_domain_create(&s->wanted);
	struct ec_config *c = ec_session_configure(s, 0, AXIS, axis->info.vendor,
						   axis->info.product);
	u32 offset, bit;

	return CHECK(!IS_ERR(d)) && CHECK(!IS_ERR(c)) && CHECK(c->slave == axis) &&
	       CHECK_EQ(ec_config_reg_entry_pos(c, 2, 0, 0, d, &offset, &bit), 0) &&
	       CHECK_EQ(ec_config_reg_entry_pos(c, 3, 0, 0, d, &offset, &bit), 0) &&
	       CHECK_EQ(ec_session_activate(s), 0);
}

static void slaves_follow_their_session(void)
{
	struct bench *b = bench_new();
	struct ec_slave *axis;
	struct task_struct *t;
	bool ok;

	if (!b)
		return;
	axis = b->s.bus.slaves[AXIS];
	CHECK_EQ(ec_session_begin(&b->ss, &owner[0], NULL), 0);
	ec_sessions_lock(&b->ss);
	ok = configure(b);
	ec_sessions_unlock(&b->ss);
	t = ok ? kthread_run(cycle_owner, &b->ss.session->cycle, "ec_alone") : ERR_PTR(-EINVAL);
	if (CHECK(!IS_ERR(t))) {
		CHECK(alone_wait(in_op, axis, 5000));
		ec_sessions_lock(&b->ss);
		CHECK_EQ(ec_session_slaves_down(b->ss.session), 0);
		ec_sessions_unlock(&b->ss);
		CHECK(alone_wait(in_preop, axis, 5000));
		kthread_stop(t);
	}
	ec_session_end(&b->ss, &owner[0]);
	CHECK(!ec_config_of(axis));
	CHECK_EQ(ec_access_is_cyclic(&b->s.seg.links.access), false);
	bench_free(b);
}

static void slave_of_another_kind_is_not_attached(void)
{
	struct bench *b = bench_new();
	struct ec_config *c;

	if (!b)
		return;
	CHECK_EQ(ec_session_begin(&b->ss, &owner[0], NULL), 0);
	ec_sessions_lock(&b->ss);
	c = ec_session_configure(b->ss.session, 0, AXIS, 1, 2);
	CHECK(!IS_ERR(c) && !c->slave);
	CHECK_EQ(PTR_ERR_OR_ZERO(ec_session_configure(b->ss.session, 0, AXIS, 1, 3)), -ENOENT);
	ec_sessions_unlock(&b->ss);
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(master_has_one_application_at_a_time),
	TEST(slaves_follow_their_session),
	TEST(slave_of_another_kind_is_not_attached),
	{ }
};
