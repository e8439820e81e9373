// SPDX-License-Identifier: GPL-2.0-only
/* Files of slaves, as an application in the kernel reads and writes them. */
#include "kapp.h"
#include "devices/sim/app.h"

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive in=8 out=8 mbox=128 serial=11 foe=256 foe_busy=2\n"
	"slave b EL2008\nslave c drive in=8 out=8 mbox=128 serial=12 foe=256\n";

#define FILE_BYTES	40000
#define SMALLEST	10	/* request */
#define WITHOUT		1	/* slave without mailbox */

static u8 *content(struct kunit *test)
{
	u8 *data = kunit_kzalloc(test, FILE_BYTES, GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, data);
	for (i = 0; i < FILE_BYTES; i++)
		data[i] = (u8)(i * 31 + (i >> 8));
	return data;
}

/* at once --------------------------------------------------------------------*/

static void kapi_foe_file_written_and_read(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	ec_master_t *m = ecrt_request_master(0);
	u8 *out = content(test), *in = kunit_kzalloc(test, FILE_BYTES, GFP_KERNEL);
	u32 error = 1;
	size_t got = 99;

	KUNIT_ASSERT_NOT_NULL(test, m);
	KUNIT_ASSERT_NOT_NULL(test, in);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(m, 0, "data", 77, out, FILE_BYTES, &error, 0),
			0);
	KUNIT_EXPECT_EQ(test, error, 0u);
	KUNIT_EXPECT_EQ(test, bus_app(b, "a")->foe.password, 77u);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_read(m, 0, "data", 0, in, FILE_BYTES, &got, NULL, 0),
			0);
	KUNIT_EXPECT_EQ(test, got, (size_t)FILE_BYTES);
	KUNIT_EXPECT_MEMEQ(test, in, out, FILE_BYTES);
	ecrt_release_master(m);
}

static void kapi_foe_refusal_has_code(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	ec_master_t *m = ecrt_request_master(0);
	size_t got = 99;
	u32 error = 1;
	u8 data[16] = { 0 };
	char why[256];

	KUNIT_ASSERT_NOT_NULL(test, m);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_read(m, 0, "none", 0, data, 16, &got, &error, 0),
			-EIO);
	KUNIT_EXPECT_EQ(test, error, (u32)EC_FOE_ERR_NOT_FOUND);
	KUNIT_EXPECT_EQ(test, got, (size_t)0);
	KUNIT_EXPECT_GT(test, ecrt_master_reason(m, why, sizeof(why)), 0);
	KUNIT_EXPECT_NOT_NULL(test, strstr(why, "file not found"));
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(m, 0, "data", 0, data, 16, &error, 0), 0);
	KUNIT_EXPECT_EQ(test, error, 0u);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_read(m, 0, "data", 0, data, 15, &got, &error, 0),
			-ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(m, WITHOUT, "a", 0, data, 1, &error, 0),
			-EPROTONOSUPPORT);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(m, 7, "a", 0, data, 1, &error, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(m, 0, "a\t", 0, data, 1, &error, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(m, 0, "", 0, data, 1, &error, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_read(m, 0, "a", 0, NULL, 1, &got, &error, 0),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_read(NULL, 0, "a", 0, data, 1, &got, &error, 0),
			-EINVAL);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(m, 0, "a", 0, data, 1, &error, 200),
			-ETIMEDOUT);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	ecrt_release_master(m);
}

/* requests -----------------------------------------------------------------*/

static struct kapp *start(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_map(k, 0);
	kapp_map(k, 2);
	return k;
}

static ec_foe_request_t *file(struct kapp *k, u32 slave, const char *name, size_t size)
{
	ec_foe_request_t *r = ecrt_slave_config_create_foe_request(k->sc[slave], size);

	KUNIT_ASSERT_NOT_NULL(k->b->test, r);
	KUNIT_EXPECT_EQ(k->b->test, ecrt_foe_request_file(r, name, 77), 0);
	return r;
}

static ec_request_state_t ends(struct kapp *k, ec_foe_request_t *r)
{
	u32 n;

	for (n = 0; n < 60000 && ecrt_foe_request_state(r) == EC_REQUEST_BUSY; n++)
		kapp_run(k, 1);
	return ecrt_foe_request_state(r);
}

static int writes(struct kapp *k, ec_foe_request_t *r, const u8 *data, size_t size)
{
	memcpy(ecrt_foe_request_data(r), data, size);
	KUNIT_EXPECT_EQ(k->b->test, ecrt_foe_request_write(r, size), 0);
	ends(k, r);
	return ecrt_foe_request_result(r);
}

static int reads(struct kapp *k, ec_foe_request_t *r)
{
	memset(ecrt_foe_request_data(r), 0, SMALLEST);
	KUNIT_EXPECT_EQ(k->b->test, ecrt_foe_request_read(r), 0);
	ends(k, r);
	return ecrt_foe_request_result(r);
}

static void kapi_foe_request_writes_and_reads(struct kunit *test)
{
	static const u32 sizes[] = { 0, 1, 116, 16384, 16385, FILE_BYTES };
	struct kapp *k = start(test);
	ec_foe_request_t *r = ecrt_slave_config_create_foe_request(k->sc[0], FILE_BYTES);
	u8 *data = content(test);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_state(r), EC_REQUEST_UNUSED);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_read(r), -EINVAL);	/* no name */
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_file(r, "data", 77), 0);
	k->incomplete = 0;
	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		KUNIT_EXPECT_EQ(test, writes(k, r, data, sizes[i]), 0);
		KUNIT_EXPECT_EQ(test, ecrt_foe_request_progress(r), (size_t)sizes[i]);
		KUNIT_EXPECT_EQ(test, reads(k, r), 0);
		KUNIT_EXPECT_EQ(test, ecrt_foe_request_state(r), EC_REQUEST_SUCCESS);
		KUNIT_EXPECT_EQ(test, ecrt_foe_request_data_size(r), (size_t)sizes[i]);
		KUNIT_EXPECT_EQ(test, ecrt_foe_request_progress(r), (size_t)sizes[i]);
		KUNIT_EXPECT_MEMEQ(test, ecrt_foe_request_data(r), data, sizes[i]);
	}
	KUNIT_EXPECT_EQ(test, bus_app(k->b, "a")->foe.password, 77u);
	KUNIT_EXPECT_EQ(test, k->incomplete, 0ull);
	ecrt_release_master(k->m);
}

static void kapi_foe_request_errors(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_foe_request_t *r = file(k, 0, "data", 1000), *small = file(k, 0, "data", 999);
	ec_foe_request_t *without, *absent;
	ec_slave_config_t *sc = ecrt_master_slave_config(k->m, 0, 7, 1, 2);
	struct ec_slave *b = bus_slave(k->b, WITHOUT);
	u8 *data = content(test);

	absent = ecrt_slave_config_create_foe_request(sc, SMALLEST);
	sc = ecrt_master_slave_config(k->m, 0, WITHOUT, b->info.vendor, b->info.product);
	without = ecrt_slave_config_create_foe_request(sc, SMALLEST);
	KUNIT_ASSERT_NOT_NULL(test, absent);
	KUNIT_ASSERT_NOT_NULL(test, without);
	KUNIT_EXPECT_NULL(test, ecrt_slave_config_create_foe_request(k->sc[0], 16 << 20));
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_file(absent, "x", 0), 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_file(without, "x", 0), 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_timeout(absent, 50), 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_read(r), -EINVAL);	/* not active */
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(r, 1001), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, writes(k, r, data, 1000), 0);
	KUNIT_EXPECT_EQ(test, reads(k, small), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_state(small), EC_REQUEST_ERROR);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_file(r, "none", 0), 0);
	KUNIT_EXPECT_EQ(test, reads(k, r), -EIO);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_error_code(r), (u32)EC_FOE_ERR_NOT_FOUND);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_file(r, "a\nb", 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, reads(k, without), -EPROTONOSUPPORT);
	KUNIT_EXPECT_EQ(test, reads(k, absent), -ETIMEDOUT);
	/* what has failed can be started again */
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_file(r, "data", 0), 0);
	KUNIT_EXPECT_EQ(test, reads(k, r), 0);
	KUNIT_EXPECT_MEMEQ(test, ecrt_foe_request_data(r), data, 1000);
	ecrt_release_master(k->m);
}

/* The other requests of the slave do not wait for a file; a second file does. */
static void kapi_foe_request_beside_others(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_foe_request_t *r = file(k, 0, "one", FILE_BYTES), *second = file(k, 0, "two", 100);
	ec_foe_request_t *other = file(k, 2, "three", 100);
	ec_sdo_request_t *sdo = ecrt_slave_config_create_sdo_request(k->sc[0], 0x1018, 4, 4);
	u32 good = 0, last = 0, n;

	KUNIT_ASSERT_NOT_NULL(test, sdo);
	memcpy(ecrt_foe_request_data(r), content(test), FILE_BYTES);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(r, FILE_BYTES), 0);
	for (n = 0; n < 60000 && ecrt_foe_request_state(r) == EC_REQUEST_BUSY; n++) {
		if (n == 50)
			KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(second, 100), 0);
		if (n == 50)
			KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(other, 100), 0);
		if (n == 200)
			KUNIT_EXPECT_EQ(test, ecrt_foe_request_state(other), EC_REQUEST_SUCCESS);
		if (ecrt_sdo_request_state(sdo) != EC_REQUEST_BUSY) {
			good += ecrt_sdo_request_state(sdo) == EC_REQUEST_SUCCESS;
			ecrt_sdo_request_read(sdo);
		}
		KUNIT_EXPECT_GE(test, ecrt_foe_request_progress(r), (size_t)last);
		last = ecrt_foe_request_progress(r);
		kapp_run(k, 1);
	}
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_result(r), 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_progress(r), (size_t)FILE_BYTES);
	KUNIT_EXPECT_GT(test, last, (u32)FILE_BYTES / 2);
	KUNIT_EXPECT_GT(test, good, 20u);
	KUNIT_EXPECT_EQ(test, ends(k, second), EC_REQUEST_SUCCESS);
	ecrt_release_master(k->m);
}

static void kapi_foe_request_cancelled(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_foe_request_t *r = file(k, 0, "data", FILE_BYTES);
	struct ec_app *app = bus_app(k->b, "a");
	u32 n;

	memcpy(ecrt_foe_request_data(r), content(test), FILE_BYTES);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_cancel(r), -EINVAL);
	kapp_op(k);
	/* before all of it is in shared memory: the slave sees nothing of it */
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(r, FILE_BYTES), 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_cancel(r), 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_state(r), EC_REQUEST_ERROR);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_result(r), -ECANCELED);
	kapp_run(k, 50);
	KUNIT_EXPECT_EQ(test, app->foe.opcode, 0);
	/* in the middle: it is ended at the slave, which keeps no half of a file */
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(r, FILE_BYTES), 0);
	for (n = 0; n < 10000 && ecrt_foe_request_progress(r) < FILE_BYTES / 2; n++) {
		ecrt_foe_request_state(r);
		kapp_run(k, 1);
	}
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_state(r), EC_REQUEST_BUSY);
	KUNIT_EXPECT_NE(test, app->foe.opcode, 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_cancel(r), 0);
	for (n = 0; n < 50 && ecrt_foe_request_state(r) == EC_REQUEST_BUSY; n++)
		kapp_run(k, 1);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_result(r), -ECANCELED);
	KUNIT_EXPECT_EQ(test, app->foe.opcode, 0);
	KUNIT_EXPECT_FALSE(test, app->foe.valid);
	KUNIT_EXPECT_EQ(test, writes(k, r, content(test), FILE_BYTES), 0);
	KUNIT_EXPECT_TRUE(test, app->foe.valid);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_cancel(r), 0);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_state(r), EC_REQUEST_SUCCESS);
	ecrt_release_master(k->m);
}

/* The slave is disconnected in the middle; when it is connected again the request works. */
static void kapi_foe_request_slave_disconnected(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_foe_request_t *r = file(k, 2, "data", FILE_BYTES);
	u8 *data = content(test);
	u32 n;

	memcpy(ecrt_foe_request_data(r), data, FILE_BYTES);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(r, FILE_BYTES), 0);
	for (n = 0; n < 10000 && ecrt_foe_request_progress(r) < FILE_BYTES / 4; n++) {
		ecrt_foe_request_state(r);
		kapp_run(k, 1);
	}
	bus_fault(k->b, EC_SIM_FAULT_POWER_OFF, 2, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, ends(k, r), EC_REQUEST_ERROR);
	KUNIT_EXPECT_LT(test, ecrt_foe_request_progress(r), (size_t)FILE_BYTES);
	bus_fault(k->b, EC_SIM_FAULT_POWER_ON, 2, 0, 0, 0);
	kapp_run(k, 2000);
	KUNIT_EXPECT_EQ(test, writes(k, r, data, FILE_BYTES), 0);
	KUNIT_EXPECT_EQ(test, reads(k, r), 0);
	KUNIT_EXPECT_MEMEQ(test, ecrt_foe_request_data(r), data, FILE_BYTES);
	ecrt_release_master(k->m);
}

/* The application releases the master in the middle: nothing waits, the slave is free. */
static void kapi_foe_request_session_ends(struct kunit *test)
{
	struct kapp *k = start(test);
	struct bus *b = k->b;
	ec_foe_request_t *r = file(k, 0, "data", FILE_BYTES);
	u8 *data = content(test);
	u64 t0;
	u32 n;

	memcpy(ecrt_foe_request_data(r), data, FILE_BYTES);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_foe_request_write(r, FILE_BYTES), 0);
	for (n = 0; n < 10000 && ecrt_foe_request_progress(r) < FILE_BYTES / 4; n++) {
		ecrt_foe_request_state(r);
		kapp_run(k, 1);
	}
	t0 = ktime_get_ns();
	ecrt_release_master(k->m);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 100 * NSEC_PER_MSEC);
	KUNIT_ASSERT_NE(test, bus_wait(b, 3, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	KUNIT_EXPECT_FALSE(test, bus_app(b, "a")->foe.valid);
	k = kapp_new(b, 1000);
	kapp_map(k, 0);
	r = file(k, 0, "data", FILE_BYTES);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, writes(k, r, data, FILE_BYTES), 0);
	ecrt_release_master(k->m);
}

/* The slave is at work on another request: no other file of this master. */
static void kapi_foe_slave_at_work_is_no_other_file(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_foe_request_t *r = file(k, 0, "data", SMALLEST);
	u8 data[SMALLEST] = { 0 };
	char why[256];
	u32 error;

	kapp_op(k);
	bus_fault(k->b, EC_SIM_FAULT_MAILBOX, 0, 0, EC_SIM_MAILBOX_ERROR, EC_MBOX_ERR_IN_WORK);
	KUNIT_EXPECT_EQ(test, writes(k, r, data, SMALLEST), -EALREADY);
	ecrt_master_deactivate(k->m);
	KUNIT_EXPECT_EQ(test, ecrt_master_foe_write(k->m, 0, "data", 0, data, 1, &error, 0),
			-EALREADY);
	KUNIT_EXPECT_GT(test, ecrt_master_reason(k->m, why, sizeof(why)), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(why, "mailbox error reply 0x0009"), "%s", why);
	ecrt_release_master(k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kapi_foe_file_written_and_read),
	KUNIT_CASE(kapi_foe_refusal_has_code),
	KUNIT_CASE(kapi_foe_slave_at_work_is_no_other_file),
	KUNIT_CASE(kapi_foe_request_writes_and_reads),
	KUNIT_CASE(kapi_foe_request_errors),
	KUNIT_CASE(kapi_foe_request_beside_others),
	KUNIT_CASE(kapi_foe_request_cancelled),
	KUNIT_CASE(kapi_foe_request_slave_disconnected),
	KUNIT_CASE(kapi_foe_request_session_ends),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_foe",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
