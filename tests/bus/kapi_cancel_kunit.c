// SPDX-License-Identifier: GPL-2.0-only
/* Requests that the application cancels: waiting, in transfer, over already. */
#include "kapp.h"
#include "devices/sim/app.h"

static const char text[] =
	"segment seed=8 response=500us\nslave a drive in=8 out=8 mbox=64 serial=11 soe=2\n"
	"slave b drive in=8 out=8 mbox=128 serial=12\n";

#define SCRATCH		0x2000	/* 1000 bytes */
#define SPEED		91	/* S-0-0091 */

static struct kapp *start(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_map(k, 0);
	kapp_map(k, 1);
	return k;
}

/* Cycles until a request has ended. */
static u32 ends(struct kapp *k, ec_sdo_request_t *r)
{
	u32 n;

	for (n = 0; n < 10000 && ecrt_sdo_request_state(r) == EC_REQUEST_BUSY; n++) {
		ecrt_master_exec_slave_requests(k->m);
		kapp_run(k, 1);
	}
	return n;
}

/* The absent slave is waited for without limit. */
static void cancel_of_waiting_request(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_slave_config_t *absent = ecrt_master_slave_config(k->m, 0, 7, 1, 2);
	ec_sdo_request_t *r = ecrt_slave_config_create_sdo_request(absent, 0x1018, 4, 4);

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_EQ(test, ecrt_master_rt_slave_requests(NULL, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_rt_slave_requests(k->m, 1), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(r), -EINVAL);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(r), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_UNUSED);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	kapp_run(k, 1000);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_BUSY);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(r), 0);
	KUNIT_EXPECT_LE(test, ends(k, r), 12u);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_ERROR);
	/* both in the same cycle */
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(r), 0);
	KUNIT_EXPECT_LE(test, ends(k, r), 12u);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_ERROR);
	ecrt_release_master(k->m);
}

/* A download of 18 segments with 100 ms each; the next request need not wait for it. */
static void cancel_of_transfer_ends_it_at_slave(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_sdo_request_t *r = ecrt_slave_config_create_sdo_request(k->sc[0], SCRATCH, 0, 1000);
	ec_sdo_request_t *next = ecrt_slave_config_create_sdo_request(k->sc[0], 0x1018, 4, 4);
	struct ec_app *app = bus_app(k->b, "a");
	u32 n;

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_ASSERT_NOT_NULL(test, next);
	kapp_op(k);
	app->response_ns = 100 * NSEC_PER_MSEC;
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_write(r), 0);
	kapp_run(k, 250);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_BUSY);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(r), 0);
	KUNIT_EXPECT_LE(test, ends(k, r), 50u);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_ERROR);
	app->response_ns = 500 * NSEC_PER_USEC;
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(next), 0);
	n = ends(k, next);
	KUNIT_EXPECT_LE(test, n, 200u);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(next), EC_REQUEST_SUCCESS);
	/* one that is cancelled can be started again */
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	ends(k, r);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(r), 0);
	kapp_run(k, 20);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_SUCCESS);
	ecrt_release_master(k->m);
}

static void cancel_of_idn(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_soe_request_t *r = ecrt_slave_config_create_soe_request(k->sc[0], 0, SPEED, 4);
	u32 n;

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_cancel(NULL), -EINVAL);
	kapp_op(k);
	bus_fault(k->b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_read(r), 0);
	kapp_run(k, 50);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_state(r), EC_REQUEST_BUSY);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_cancel(r), 0);
	for (n = 0; n < 50 && ecrt_soe_request_state(r) == EC_REQUEST_BUSY; n++)
		kapp_run(k, 1);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_state(r), EC_REQUEST_ERROR);
	bus_fault(k->b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	ecrt_release_master(k->m);
}

/* The kernel's cycle has no send of the application: the counter notifies it. */
static void cancel_in_cycle_of_kernel(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_slave_config_t *absent = ecrt_master_slave_config(k->m, 0, 7, 1, 2);
	ec_sdo_request_t *r = ecrt_slave_config_create_sdo_request(absent, 0x1018, 4, 4);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	kapp_kernel_cycle(k, (ec_cycle_config_t){ .period_ns = NSEC_PER_MSEC });
	kapp_activate(k);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	msleep(100);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_BUSY);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(r), 0);
	for (i = 0; i < 15 && ecrt_sdo_request_state(r) == EC_REQUEST_BUSY; i++)
		usleep_range(1000, 1001);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_ERROR);
	ecrt_release_master(k->m);
}

/* No cycle looks at the counter any more: the monitor does. */
static void cancel_and_start_after_end_of_cycle(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_slave_config_t *absent = ecrt_master_slave_config(k->m, 0, 7, 1, 2);
	ec_sdo_request_t *waits = ecrt_slave_config_create_sdo_request(absent, 0x1018, 4, 4);
	ec_sdo_request_t *r = ecrt_slave_config_create_sdo_request(k->sc[0], 0x1018, 4, 4);
	ec_cycle_state_t state;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, waits);
	KUNIT_ASSERT_NOT_NULL(test, r);
	kapp_kernel_cycle(k, (ec_cycle_config_t){ .period_ns = NSEC_PER_MSEC,
						  .stall = EC_CYCLE_STOP, .stall_cycles = 10 });
	kapp_op(k);
	msleep(50);
	KUNIT_EXPECT_EQ(test, ecrt_master_cycle_state(k->m, &state), 0);
	KUNIT_ASSERT_EQ(test, state.run, EC_CYCLE_STOPPED);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	for (i = 0; i < 1000 && ecrt_sdo_request_state(r) == EC_REQUEST_BUSY; i++)
		usleep_range(1000, 1001);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(waits), 0);
	msleep(100);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(waits), EC_REQUEST_BUSY);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_cancel(waits), 0);
	for (i = 0; i < 50 && ecrt_sdo_request_state(waits) == EC_REQUEST_BUSY; i++)
		usleep_range(1000, 1001);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(waits), EC_REQUEST_ERROR);
	ecrt_release_master(k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(cancel_of_waiting_request),
	KUNIT_CASE(cancel_of_transfer_ends_it_at_slave),
	KUNIT_CASE(cancel_of_idn),
	KUNIT_CASE(cancel_in_cycle_of_kernel),
	KUNIT_CASE(cancel_and_start_after_end_of_cycle),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_cancel",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
