// SPDX-License-Identifier: GPL-2.0-only
/* Applications in the kernel whose cycle the kernel runs. */
#include <linux/completion.h>
#include <linux/kthread.h>
#include "kapp.h"
#include "master/boundary/api.h"
#include "master/link/device.h"

/* Inputs are the outputs of before. */
static const char text[] = "segment seed=32\nrepeat 2 slave s io in=6400 out=6400\n"
			   "slave d drive in=8 out=8 mbox=128\n"
			   "connect s1.1 -> s1.1\nconnect s2.2 -> s2.2\n";

#define MEMORY	4096	/* more than the domain needs */

static struct kapp *start(struct kunit *test, ec_cycle_config_t cycle)
{
	struct bus *b = bus_up(test, text, 3);
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_kernel_cycle(k, cycle);
	kapp_map(k, 0);
	kapp_map(k, 1);
	kapp_map(k, 2);
	return k;
}

static u8 *output(struct kapp *k, u32 slave)
{
	return ecrt_domain_data(k->d) + k->out[slave] + 4 * slave;
}

static u32 input(struct kapp *k, u32 slave)
{
	return get_unaligned_le32(ecrt_domain_data(k->d) + k->in[slave] + 4 * slave);
}

static u32 sent(struct kapp *k, u32 slave)
{
	return ec_app_channel(bus_app(k->b, slave ? "s2" : "s1"), EC_APP_OUT, slave);
}

/* Each cycle has inputs of its own; outputs are inputs two cycles later, those of one image. */
static void kcycle_exchange(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ .phase_ns = 250000 });
	u64 cycle, last, time, lost = bus_lost(k->b);
	ec_cycle_state_t state;
	u32 i, fresh = 0, torn = 0;
	u8 *data;

	KUNIT_EXPECT_NULL(test, ecrt_domain_data(k->d));
	kapp_op(k);
	k->incomplete = 0;
	data = ecrt_domain_data(k->d);
	KUNIT_ASSERT_NOT_NULL(test, data);
	KUNIT_ASSERT_EQ(test, ecrt_master_cycle_inputs(k->m, &last, NULL), 0);
	for (i = 1; i <= 500; i++) {
		put_unaligned_le32(i, output(k, 0));
		put_unaligned_le32(i, output(k, 1));
		kapp_run(k, 1);
		KUNIT_ASSERT_EQ(test, ecrt_master_cycle_inputs(k->m, &cycle, &time), 0);
		KUNIT_EXPECT_EQ(test, cycle, last + 1);
		KUNIT_EXPECT_EQ(test, cycle, ecrt_master_cycle_count(k->m));
		KUNIT_EXPECT_EQ(test, time % 1000000, 250000ull);
		last = cycle;
		torn += input(k, 0) != input(k, 1);
		fresh += i > 2 && input(k, 0) == i - 2;
	}
	KUNIT_EXPECT_EQ(test, torn, 0u);
	KUNIT_EXPECT_EQ(test, fresh, 498u);
	KUNIT_EXPECT_EQ(test, k->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(k->b), lost);
	KUNIT_EXPECT_PTR_EQ(test, ecrt_domain_data(k->d), data);
	KUNIT_EXPECT_EQ(test, ecrt_master_cycle_state(k->m, &state), 0);
	KUNIT_EXPECT_EQ(test, state.run, EC_CYCLE_RUNNING);
	KUNIT_EXPECT_EQ(test, state.overruns, 0ull);
	KUNIT_EXPECT_LE(test, state.missed, 2ull);
	ecrt_release_master(k->m);
}

/* A domain that is not queued keeps its outputs, one without new inputs its inputs. */
static void kcycle_queued_only(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	u32 i;

	kapp_op(k);
	put_unaligned_le32(7, output(k, 0));
	kapp_run(k, 4);
	KUNIT_EXPECT_EQ(test, input(k, 0), 7u);
	put_unaligned_le32(8, output(k, 0));
	for (i = 0; i < 5; i++) {
		kapp_wait(k);
		KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), 0);
		KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), 0);
	}
	KUNIT_EXPECT_EQ(test, sent(k, 0), 7u);
	/* what the application writes there is its own until it is processed */
	put_unaligned_le32(99, ecrt_domain_data(k->d) + k->in[0]);
	KUNIT_EXPECT_EQ(test, input(k, 0), 99u);
	KUNIT_EXPECT_EQ(test, ecrt_domain_process(k->d), 0);
	KUNIT_EXPECT_EQ(test, input(k, 0), 7u);
	ecrt_release_master(k->m);
}

/* The first cycle sends what external memory has; the kernel's thread never uses that memory. */
static void kcycle_external_memory(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	u8 *mem = kunit_kzalloc(test, MEMORY, GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, mem);
	KUNIT_ASSERT_LE(test, ecrt_domain_size(k->d), (size_t)MEMORY);
	ecrt_domain_external_memory(k->d, mem);
	KUNIT_EXPECT_PTR_EQ(test, ecrt_domain_data(k->d), mem);
	put_unaligned_le32(41, output(k, 0));
	kapp_activate(k);
	KUNIT_EXPECT_PTR_EQ(test, ecrt_domain_data(k->d), mem);
	put_unaligned_le32(99, output(k, 0));
	while (!kapp_all_op(k))
		kapp_wait(k);
	msleep(20);
	KUNIT_EXPECT_EQ(test, sent(k, 0), 41u);
	KUNIT_EXPECT_EQ(test, input(k, 0), 0u);
	kapp_run(k, 4);
	KUNIT_EXPECT_EQ(test, sent(k, 0), 99u);
	KUNIT_EXPECT_EQ(test, input(k, 0), 99u);
	ecrt_release_master(k->m);
}

static void kcycle_stops(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ .stall = EC_CYCLE_STOP,
							  .stall_cycles = 10 });
	ec_cycle_state_t state;
	ec_domain_state_t d;

	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_domain_state(k->d, &d), 0);
	KUNIT_EXPECT_EQ(test, d.wc_state, EC_WC_COMPLETE);
	msleep(20);
	KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -ECANCELED);
	KUNIT_EXPECT_EQ(test, ecrt_domain_process(k->d), 0);
	KUNIT_EXPECT_EQ(test, ecrt_domain_state(k->d, &d), 0);
	KUNIT_EXPECT_EQ(test, d.working_counter, 0u);
	KUNIT_EXPECT_EQ(test, d.wc_state, EC_WC_ZERO);
	KUNIT_EXPECT_EQ(test, ecrt_domain_queue(k->d), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -ECANCELED);
	KUNIT_EXPECT_EQ(test, ecrt_master_wait_cycle(k->m, 0), -ECANCELED);
	KUNIT_EXPECT_EQ(test, ecrt_master_cycle_state(k->m, &state), 0);
	KUNIT_EXPECT_EQ(test, state.run, EC_CYCLE_STOPPED);
	ecrt_release_master(k->m);
}

/* Without the device the cycle counts on, and calls say why there are no inputs. */
static void kcycle_device_goes(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	ec_domain_state_t state;
	u64 count;

	kapp_op(k);
	bus_no_device(k->b);
	kapp_wait(k);
	kapp_wait(k);
	count = ecrt_master_cycle_count(k->m);
	KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -ENODEV);
	KUNIT_EXPECT_EQ(test, ecrt_domain_process(k->d), 0);
	KUNIT_EXPECT_EQ(test, ecrt_domain_state(k->d, &state), 0);
	KUNIT_EXPECT_EQ(test, state.working_counter, 0u);
	KUNIT_EXPECT_EQ(test, ecrt_domain_queue(k->d), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -ENODEV);
	kapp_wait(k);
	KUNIT_EXPECT_GT(test, ecrt_master_cycle_count(k->m), count);
	ecrt_release_master(k->m);
}

/* Configured by the same calls as in a process: divisions, and copies of inputs to outputs. */
static void kcycle_divisions_and_copies(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	ec_cycle_state_t state;

	KUNIT_EXPECT_EQ(test, ecrt_domain_set_division(k->d, 5, 2), 0);
	KUNIT_EXPECT_EQ(test, ecrt_domain_copy(k->d, k->out[0] + 4, 0, k->d, k->in[1] + 4, 0, 32),
			0);
	kapp_op(k);
	put_unaligned_le32(1234, output(k, 1));
	kapp_run(k, 30);
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(k->b, "s1"), EC_APP_OUT, 1), 1234);
	KUNIT_EXPECT_EQ(test, ecrt_master_cycle_state(k->m, &state), 0);
	KUNIT_EXPECT_LE(test, bus_sends(k->b), state.cycles);
	KUNIT_EXPECT_EQ(test, bus_domain(k->b, 0)->division, 5u);
	ecrt_release_master(k->m);
}

/* The same copy when the application runs the cycle, in memory of its own. */
static void kcycle_copy_in_own_memory(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	u8 *mem = kunit_kzalloc(test, MEMORY, GFP_KERNEL);
	struct kapp *k;

	KUNIT_ASSERT_NOT_NULL(test, mem);
	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_map(k, 0);
	kapp_map(k, 1);
	kapp_map(k, 2);
	ecrt_domain_external_memory(k->d, mem);
	KUNIT_EXPECT_EQ(test, ecrt_domain_copy(k->d, k->out[0] + 4, 0, k->d, k->in[1] + 4, 0, 32),
			0);
	kapp_op(k);
	put_unaligned_le32(1234, output(k, 1));
	kapp_run(k, 10);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(mem + k->out[0] + 4), 1234u);
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(k->b, "s1"), EC_APP_OUT, 1), 1234);
	ecrt_release_master(k->m);
}

/* Requests are started without a send. */
static void kcycle_requests(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	ec_sdo_request_t *r = ecrt_slave_config_create_sdo_request(k->sc[2], 0x1018, 1, 4);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	for (i = 0; i < 100 && ecrt_sdo_request_state(r) == EC_REQUEST_BUSY; i++)
		kapp_wait(k);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_SUCCESS);
	ecrt_release_master(k->m);
}

/* Slaves leave OP without an error while process data still run, with and without set_cycle(). */
static void kcycle_slaves_down(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	u32 i, n;

	for (n = 0; n < 2; n++) {
		kapp_op(k);
		k->incomplete = 0;
		ecrt_master_deactivate_slaves(k->m);
		for (i = 0; i < 1000 && bus_slave(k->b, 0)->al.status != EC_AL_PREOP; i++)
			kapp_run(k, 1);
		KUNIT_EXPECT_EQ(test, bus_slave(k->b, 0)->al.status, EC_AL_PREOP);
		KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
		ecrt_master_deactivate_slaves(k->m);
		ecrt_release_master(k->m);
		if (n)
			break;
		k = kapp_new(k->b, 1000);
		kapp_map(k, 0);
		kapp_map(k, 1);
	}
}

/* callers --------------------------------------------------------------------*/

struct waiter {
	struct kapp *k;
	struct task_struct *task;
	struct completion done;
	u32 timeout_us;
	int ret;
};

static int wait_once(void *data)
{
	struct waiter *w = data;

	w->ret = ecrt_master_wait_cycle(w->k->m, w->timeout_us);
	complete(&w->done);
	while (!kthread_should_stop())
		msleep(1);
	return w->ret;
}

static void begin(struct waiter *w, struct kapp *k, u32 timeout_us)
{
	*w = (struct waiter){ .k = k, .timeout_us = timeout_us };
	init_completion(&w->done);
	w->task = kthread_run(wait_once, w, "kapp-wait");
	KUNIT_ASSERT_FALSE(k->b->test, IS_ERR(w->task));
}

static struct kapp *start_slow(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ .period_ns = 1000000000 });

	kapp_activate(k);
	kapp_wait(k);
	return k;
}

/* A module that goes need not wait for a cycle. */
static void kcycle_wait_ends_with_its_thread(struct kunit *test)
{
	struct kapp *k = start_slow(test);
	ktime_t before = ktime_get();
	struct waiter w;

	begin(&w, k, 0);
	msleep(10);
	KUNIT_EXPECT_FALSE(test, completion_done(&w.done));
	KUNIT_EXPECT_EQ(test, kthread_stop(w.task), -EINTR);
	KUNIT_EXPECT_LT(test, ktime_ms_delta(ktime_get(), before), 100ll);
	ecrt_release_master(k->m);
}

static void kcycle_wait_ends_with_cycle(struct kunit *test)
{
	struct kapp *k = start_slow(test);
	struct waiter w[2];
	ktime_t before = ktime_get();
	u32 i;

	for (i = 0; i < ARRAY_SIZE(w); i++)
		begin(&w[i], k, i ? 900000 : 0);
	msleep(10);
	ecrt_master_deactivate(k->m);
	for (i = 0; i < ARRAY_SIZE(w); i++) {
		wait_for_completion(&w[i].done);
		KUNIT_EXPECT_EQ(test, kthread_stop(w[i].task), -ECANCELED);
	}
	KUNIT_EXPECT_LT(test, ktime_ms_delta(ktime_get(), before), 500ll);
	ecrt_release_master(k->m);
}

/* What another caller has got changes neither the result of this one nor goes back. */
static void kcycle_wait_beside_another(struct kunit *test)
{
	struct kapp *k = start_slow(test);
	__u64 *seen = &bus_api(k->b)->cycle.seen, before;
	struct waiter w;

	begin(&w, k, 0);
	msleep(10);
	before = *seen;
	ec_write64(seen, before + 5);
	wait_for_completion(&w.done);
	KUNIT_EXPECT_EQ(test, kthread_stop(w.task), 1);
	KUNIT_EXPECT_EQ(test, (u64)*seen, (u64)before + 5);
	ecrt_release_master(k->m);
}

/* Both callers get the same cycle; more than 16 are refused. */
static void kcycle_many_wait(struct kunit *test)
{
	struct kapp *k = start_slow(test);
	struct waiter *w = kunit_kzalloc(test, 16 * sizeof(*w), GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, w);
	for (i = 0; i < 16; i++)
		begin(&w[i], k, i ? 0 : 100000);
	msleep(2);
	KUNIT_EXPECT_EQ(test, ecrt_master_wait_cycle(k->m, 0), -EBUSY);
	for (i = 0; i < 16; i++) {
		wait_for_completion(&w[i].done);
		if (i)
			KUNIT_EXPECT_GE(test, kthread_stop(w[i].task), 0);
		else
			KUNIT_EXPECT_EQ(test, kthread_stop(w[i].task), -ETIMEDOUT);
	}
	ecrt_release_master(k->m);
}

static int deactivate(void *data)
{
	struct waiter *w = data;

	w->ret = ecrt_master_deactivate(w->k->m);
	complete(&w->done);
	while (!kthread_should_stop())
		msleep(1);
	return w->ret;
}

/* One caller at a time; deactivation waits for the caller that is inside. */
static void kcycle_two_callers(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	struct waiter w = { .k = k };

	kapp_op(k);
	init_completion(&w.done);
	atomic_set(&bus_api(k->b)->busy, 1);	/* a call that is preempted inside */
	KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -EBUSY);
	w.task = kthread_run(deactivate, &w, "kapp-deact");
	msleep(20);
	KUNIT_EXPECT_FALSE(test, completion_done(&w.done));
	KUNIT_EXPECT_NOT_NULL(test, bus_api(k->b)->cycle.exchange);
	atomic_set(&bus_api(k->b)->busy, 0);
	wait_for_completion(&w.done);
	KUNIT_EXPECT_EQ(test, kthread_stop(w.task), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -EINVAL);
	ecrt_release_master(k->m);
}

/* Calls that deactivation does not wait for yet do not look at the session. */
static void kcycle_calls_beside_deactivation(struct kunit *test)
{
	struct kapp *k = start_slow(test);
	struct ec_shared *shared;

	bus_lock(k->b);
	shared = bus_shared(k->b);
	bus_cycle(k->b)->shared = NULL;	/* the thread sleeps for a second */
	atomic_set(&bus_api(k->b)->busy, 1);
	KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_master_wait_cycle(k->m, 1000), -ETIMEDOUT);
	atomic_set(&bus_api(k->b)->busy, 0);
	bus_cycle(k->b)->shared = shared;
	bus_unlock(k->b);
	ecrt_release_master(k->m);
}

static void hook(void *data)
{
	(*(u32 *)data)++;
}

/* The kernel's thread sends acyclic frames itself: hooks and links are not for the application. */
static void kcycle_links_belong_to_kernel(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ });
	u32 calls = 0, serial;
	size_t size;

	ecrt_master_callbacks(k->m, hook, hook, &calls);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_master_send_ext(k->m), -EAGAIN);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 2, 0x1018, 1, (u8 *)&serial, 4, &size,
						     NULL), 0);
	KUNIT_EXPECT_EQ(test, calls, 0u);
	ecrt_release_master(k->m);
}

/* Nothing is sent before the first outputs, not even after a reset. */
static void kcycle_waits_for_outputs(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ .flags = EC_CYCLE_WAIT_OUTPUTS });
	u32 i;

	kapp_activate(k);
	kapp_wait(k);
	KUNIT_EXPECT_EQ(test, ecrt_master_reset(k->m), 0);
	for (i = 0; i < 10; i++)
		kapp_wait(k);
	KUNIT_EXPECT_EQ(test, (u32)bus_access_mode(k->b), (u32)EC_ACCESS_DIRECT);
	KUNIT_EXPECT_EQ(test, (u64)bus_sends(k->b), 0ull);
	kapp_run(k, 3);
	KUNIT_EXPECT_EQ(test, (u32)bus_access_mode(k->b), (u32)EC_ACCESS_CYCLIC);
	ecrt_release_master(k->m);
}

/* detached ---------------------------------------------------------------------*/

static struct kapp *again(struct kapp *before)
{
	struct kapp *k = kapp_new(before->b, 1000);

	kapp_kernel_cycle(k, (ec_cycle_config_t){ .flags = EC_CYCLE_DETACH });
	kapp_map(k, 0);
	kapp_map(k, 1);
	kapp_map(k, 2);
	return k;
}

/* A module is replaced by another one while its slaves stay in OP; its handles stay valid. */
static void kcycle_taken_over(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ .flags = EC_CYCLE_DETACH });
	ec_slave_config_state_t state;
	ec_cycle_state_t cycle;
	u8 *data;
	u32 i;

	kapp_op(k);
	put_unaligned_le32(5, output(k, 0));
	kapp_run(k, 4);
	for (i = 1; i <= 3; i++) {
		ecrt_release_master(k->m);
		msleep(50);
		k = again(k);
		KUNIT_EXPECT_NULL(test, ecrt_domain_data(k->d));
		kapp_activate(k);
		/* memory comes too late */
		data = ecrt_domain_data(k->d);
		ecrt_domain_external_memory(k->d, NULL);
		KUNIT_ASSERT_PTR_EQ(test, ecrt_domain_data(k->d), data);
		/* outputs and inputs are those of the cycle that runs */
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(output(k, 0)), 4 + i);
		KUNIT_EXPECT_EQ(test, input(k, 0), 4 + i);
		KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
		KUNIT_EXPECT_EQ(test, ecrt_slave_config_state(k->sc[1], &state), 0);
		KUNIT_EXPECT_TRUE(test, state.al_state == EC_AL_STATE_OP);
		put_unaligned_le32(5 + i, output(k, 0));
		kapp_run(k, 4);
		KUNIT_EXPECT_EQ(test, input(k, 0), 5 + i);
		KUNIT_EXPECT_EQ(test, k->incomplete, 0ull);
		KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_overruns(k->sc[0]), 0);
		KUNIT_EXPECT_EQ(test, ecrt_master_cycle_state(k->m, &cycle), 0);
		KUNIT_EXPECT_EQ(test, cycle.takeovers, i);
	}
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
	bus_wait(k->b, 3, EC_AL_PREOP, 3000);
	ecrt_release_master(k->m);
	KUNIT_EXPECT_NULL(test, bus_session(k->b));
	/* work on requests may end a moment later */
	msleep(50);
	KUNIT_EXPECT_EQ(test, bus_memory(k->b), 0L);
	/* only the table of slaves has one */
	KUNIT_EXPECT_EQ(test, kref_read(&bus_slave(k->b, 2)->kref), 1u);
}

/* Another configuration is refused until the detached session ends. */
static void kcycle_ends_detached(struct kunit *test)
{
	struct kapp *k = start(test, (ec_cycle_config_t){ .flags = EC_CYCLE_DETACH });

	kapp_op(k);
	ecrt_release_master(k->m);
	k = kapp_new(k->b, 2000);
	kapp_kernel_cycle(k, (ec_cycle_config_t){ });
	kapp_map(k, 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), -EEXIST);
	KUNIT_EXPECT_NULL(test, ecrt_domain_data(k->d));
	KUNIT_EXPECT_EQ(test, ecrt_master_end_detached(k->m), 0);
	kapp_op(k);
	put_unaligned_le32(77, output(k, 0));
	kapp_run(k, 4);
	KUNIT_EXPECT_EQ(test, input(k, 0), 77u);
	ecrt_release_master(k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kcycle_exchange),
	KUNIT_CASE(kcycle_queued_only),
	KUNIT_CASE(kcycle_external_memory),
	KUNIT_CASE(kcycle_stops),
	KUNIT_CASE(kcycle_device_goes),
	KUNIT_CASE(kcycle_divisions_and_copies),
	KUNIT_CASE(kcycle_copy_in_own_memory),
	KUNIT_CASE(kcycle_requests),
	KUNIT_CASE(kcycle_slaves_down),
	KUNIT_CASE(kcycle_wait_ends_with_its_thread),
	KUNIT_CASE(kcycle_wait_ends_with_cycle),
	KUNIT_CASE(kcycle_wait_beside_another),
	KUNIT_CASE(kcycle_many_wait),
	KUNIT_CASE(kcycle_two_callers),
	KUNIT_CASE(kcycle_calls_beside_deactivation),
	KUNIT_CASE(kcycle_links_belong_to_kernel),
	KUNIT_CASE(kcycle_waits_for_outputs),
	KUNIT_CASE(kcycle_taken_over),
	KUNIT_CASE(kcycle_ends_detached),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_kcycle", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
