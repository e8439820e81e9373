// SPDX-License-Identifier: GPL-2.0-only
/* Records of files that an application has written itself: wrong sizes, names and numbers. */
#include "req.h"
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive mbox=128 serial=11 foe=64\nslave b drive mbox=128 serial=12 foe=64\n";

#define SIZE	1000

static struct cyc *prepare(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	return c;
}

static char *name_of(struct cyc *c, u32 i)
{
	return (char *)req_data(c, i) - EC_FOE_NAME;
}

static void req_foe_memory_is_apart(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_FOE, SIZE), b = req_add(c, 0, EC_REQUEST_FOE, SIZE);
	u32 sdo = req_add(c, 0, EC_REQUEST_SDO, 4), i;

	cyc_activate(c);
	cyc_run(c, 200);
	KUNIT_EXPECT_GE(test, req_rec(c, b)->data, req_rec(c, a)->data + SIZE + EC_FOE_NAME);
	KUNIT_EXPECT_GE(test, req_rec(c, sdo)->data, req_rec(c, b)->data + SIZE);
	for (i = 0; i < SIZE; i++)
		req_data(c, a)[i] = (u8)(i * 7);
	strscpy(name_of(c, a), "one", EC_FOE_NAME);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_WRITE, SIZE), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->progress, SIZE);
	strscpy(name_of(c, b), "one", EC_FOE_NAME);
	memset(req_data(c, sdo), 0x55, 4);
	KUNIT_EXPECT_EQ(test, req_do(c, b, 0, 0, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, b)->got, SIZE);
	KUNIT_EXPECT_MEMEQ(test, req_data(c, b), req_data(c, a), SIZE);
	KUNIT_EXPECT_STREQ(test, name_of(c, b), "one");
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(req_data(c, sdo)), 0x55555555u);
}

static void req_foe_record_is_checked(struct kunit *test)
{
	static const u32 sizes[] = { SIZE + 1, 4096, 0x7fffffff, ~0u };
	struct ec_ioc_sc_request big = { .kind = EC_REQUEST_FOE, .size = EC_MAX_FOE_SIZE + 1 };
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_FOE, SIZE), i;

	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &big), -EINVAL);
	big.size = EC_MAX_FOE_SIZE;
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &big), 0);
	/* two have more than all requests together may have */
	KUNIT_EXPECT_EQ(test, ec_ioc(&c->b->app, EC_IOC_SC_REQUEST, &big), -ENOSPC);
	cyc_activate(c);
	cyc_run(c, 200);
	/* no name, a bad one, one that ends with its field: too long for this slave only */
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_WRITE, 10), -EINVAL);
	strscpy(name_of(c, a), "a\x7f", EC_FOE_NAME);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_READ, 0), -EINVAL);
	memset(name_of(c, a), 'n', EC_FOE_NAME);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_WRITE, 10), -EIO);
	KUNIT_EXPECT_NE(test, req_rec(c, a)->abort_code, 0u);
	strscpy(name_of(c, a), "one", EC_FOE_NAME);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_WRITE, 10), 0);
	for (i = 0; i < ARRAY_SIZE(sizes); i++)
		KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_WRITE, sizes[i]), -EINVAL);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_READWRITE, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_READ_NOW, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, 255, 1), -EINVAL);
	req_rec(c, a)->flags = EC_SDO_FLAG_COMPLETE;
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_READ, 0), -EOPNOTSUPP);
	req_rec(c, a)->flags = 0;
	/* the kernel does not read back where the data are */
	req_rec(c, a)->data = 0xfffffff0;
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_READ, 0), 0);
	KUNIT_EXPECT_EQ(test, req_rec(c, a)->got, 10);
}

/* A file of the tool is being transferred: an error, not a wait without end. */
static void req_foe_busy_slave(struct kunit *test)
{
	struct cyc *c = prepare(test);
	u32 a = req_add(c, 0, EC_REQUEST_FOE, SIZE);

	cyc_activate(c);
	cyc_run(c, 200);
	strscpy(name_of(c, a), "one", EC_FOE_NAME);
	set_bit(EC_MBOX_FILE, &bus_mbox(c->b, 0)->flags);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_WRITE, 10), -EBUSY);
	clear_bit(EC_MBOX_FILE, &bus_mbox(c->b, 0)->flags);
	KUNIT_EXPECT_EQ(test, req_do(c, a, 0, 0, EC_REQUEST_OP_WRITE, 10), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(req_foe_memory_is_apart),
	KUNIT_CASE(req_foe_record_is_checked),
	KUNIT_CASE(req_foe_busy_slave),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_request_foe",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
