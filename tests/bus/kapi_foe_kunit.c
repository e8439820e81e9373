// SPDX-License-Identifier: GPL-2.0-only
/* Files of slaves, as an application in the kernel reads and writes them. */
#include "kapp.h"
#include "devices/sim/app.h"

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive in=8 out=8 mbox=128 serial=11 foe=256 foe_busy=2\n"
	"slave b EL2008\nslave c drive in=8 out=8 mbox=128 serial=12 foe=256\n";

#define FILE_BYTES	40000
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

static struct kunit_case cases[] = {
	KUNIT_CASE(kapi_foe_file_written_and_read),
	KUNIT_CASE(kapi_foe_refusal_has_code),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_foe",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
