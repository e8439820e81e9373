// SPDX-License-Identifier: GPL-2.0-only
/* The object dictionary of slaves, as an application in the kernel reads it. */
#include "kapp.h"
#include "devices/sim/app.h"
#include "master/wire/coe.h"

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive in=8 out=8 mbox=64 serial=11\nslave b EL2008\n"
	"slave c drive in=8 out=8 mbox=256 serial=12\n";

#define OBJECTS		200
#define WITHOUT		1	/* slave without mailbox */

/* at once --------------------------------------------------------------------*/

static void kapi_dict_lists_and_descriptions(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	ec_master_t *m = ecrt_request_master(0);
	u16 *list = kunit_kcalloc(test, OBJECTS, sizeof(*list), GFP_KERNEL), counts[5];
	ec_sdo_object_info_t object;
	ec_sdo_entry_info_t entry;
	u32 abort = 1, i;
	size_t n = 0, c;

	KUNIT_ASSERT_NOT_NULL(test, m);
	KUNIT_ASSERT_NOT_NULL(test, list);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_list(m, 0, 1, list, OBJECTS, &n, &abort), 0);
	KUNIT_EXPECT_EQ(test, abort, 0u);
	KUNIT_EXPECT_GT(test, n, (size_t)10);
	KUNIT_EXPECT_EQ(test, list[0], 0x1000);
	for (i = 0; i < n && list[i] != 0x1018; i++)
		;
	KUNIT_EXPECT_LT(test, i, (u32)n);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_list(m, 0, 0, counts, 5, &c, NULL), 0);
	KUNIT_EXPECT_EQ(test, c, (size_t)5);
	KUNIT_EXPECT_EQ(test, counts[0], (u16)n);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_object(m, 0, 0x1018, &object, &abort), 0);
	KUNIT_EXPECT_EQ(test, object.index, 0x1018);
	KUNIT_EXPECT_EQ(test, object.max_subindex, 4);
	KUNIT_EXPECT_EQ(test, object.object_code, 9);
	KUNIT_EXPECT_NE(test, object.name[0], 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_entry(m, 0, 0x1018, 4, &entry, &abort), 0);
	KUNIT_EXPECT_EQ(test, entry.index, 0x1018);
	KUNIT_EXPECT_EQ(test, entry.subindex, 4);
	KUNIT_EXPECT_EQ(test, entry.data_type, 7);
	KUNIT_EXPECT_EQ(test, entry.bit_length, 32);
	KUNIT_EXPECT_EQ(test, entry.access & 0x3f, 0x07);	/* read in all states */
	KUNIT_EXPECT_NE(test, entry.name[0], 0);
	ecrt_release_master(m);
	KUNIT_EXPECT_NOT_NULL(test, b->m);
}

static void kapi_dict_refusals(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 3);
	ec_master_t *m = ecrt_request_master(0);
	ec_sdo_object_info_t object;
	ec_sdo_entry_info_t entry;
	u16 list[4] = { 0 };
	u32 abort = 0;
	size_t n = 99;

	KUNIT_ASSERT_NOT_NULL(test, m);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_list(m, 0, 1, list, 4, &n, &abort), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, n, (size_t)0);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_list(m, 0, 6, list, 4, &n, &abort), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_list(m, 0, 1, NULL, 4, &n, &abort), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_list(m, 0, 1, list, 4, NULL, &abort), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_list(NULL, 0, 1, list, 4, &n, NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_object(m, 0, 0x3fff, &object, &abort), -EIO);
	KUNIT_EXPECT_EQ(test, abort, (u32)EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_object(m, 0, 0x1018, NULL, &abort), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_entry(m, 0, 0x1018, 77, &entry, &abort), -EIO);
	KUNIT_EXPECT_NE(test, abort, 0u);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_entry(m, WITHOUT, 0x1018, 1, &entry, NULL),
			-EPROTONOSUPPORT);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_entry(m, 9, 0x1018, 1, &entry, NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_info_entry(NULL, 0, 0x1018, 1, &entry, NULL),
			-EINVAL);
	ecrt_release_master(m);
	KUNIT_EXPECT_NOT_NULL(test, b->m);
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

static ec_request_state_t ends(struct kapp *k, ec_sdo_info_request_t *r)
{
	u32 n;

	for (n = 0; n < 5000 && ecrt_sdo_info_request_state(r) == EC_REQUEST_BUSY; n++)
		kapp_run(k, 1);
	return ecrt_sdo_info_request_state(r);
}

static void kapi_dict_request_reads(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_sdo_info_request_t *r = ecrt_slave_config_create_sdo_info_request(k->sc[0], 1000);
	ec_sdo_object_info_t object;
	ec_sdo_entry_info_t entry;
	size_t n;

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_state(r), EC_REQUEST_UNUSED);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(r, 1), -EINVAL);	/* not active */
	kapp_op(k);
	k->incomplete = 0;
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(r, 6), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(r, 1), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_object(r, 0x1018), -EBUSY);
	KUNIT_EXPECT_EQ(test, ends(k, r), EC_REQUEST_SUCCESS);
	n = ecrt_sdo_info_request_data_size(r);
	KUNIT_EXPECT_GT(test, n, (size_t)20);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(ecrt_sdo_info_request_data(r)), 0x1000);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_get_object(r, &object), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_object(r, 0x1018), 0);
	KUNIT_EXPECT_EQ(test, ends(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_get_object(r, &object), 0);
	KUNIT_EXPECT_EQ(test, object.max_subindex, 4);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_get_entry(r, &entry), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_entry(r, 0x1018, 4), 0);
	KUNIT_EXPECT_EQ(test, ends(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_get_entry(r, &entry), 0);
	KUNIT_EXPECT_EQ(test, entry.bit_length, 32);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_object(r, 0x3fff), 0);
	KUNIT_EXPECT_EQ(test, ends(k, r), EC_REQUEST_ERROR);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_abort_code(r), (u32)EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_EQ(test, k->incomplete, 0ull);
	ecrt_release_master(k->m);
}

/* Too small, cancelled, a slave that does not answer, absent, disconnected, session over. */
static void kapi_dict_request_ends_early(struct kunit *test)
{
	struct kapp *k = start(test);
	ec_slave_config_t *sc = ecrt_master_slave_config(k->m, 0, 7, 1, 2);
	ec_sdo_info_request_t *r = ecrt_slave_config_create_sdo_info_request(k->sc[2], 1000);
	ec_sdo_info_request_t *small = ecrt_slave_config_create_sdo_info_request(k->sc[0], 10);
	ec_sdo_info_request_t *absent = ecrt_slave_config_create_sdo_info_request(sc, 10);

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_ASSERT_NOT_NULL(test, small);
	KUNIT_ASSERT_NOT_NULL(test, absent);
	KUNIT_EXPECT_NULL(test, ecrt_slave_config_create_sdo_info_request(k->sc[0], 65537));
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_timeout(absent, 50), 0);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(small, 1), 0);
	KUNIT_EXPECT_EQ(test, ends(k, small), EC_REQUEST_ERROR);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_abort_code(small), 0u);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(absent, 1), 0);
	KUNIT_EXPECT_EQ(test, ends(k, absent), EC_REQUEST_ERROR);
	bus_fault(k->b, EC_SIM_FAULT_MUTE, 2, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(r, 1), 0);
	kapp_run(k, 50);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_cancel(r), 0);
	kapp_run(k, 50);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_state(r), EC_REQUEST_ERROR);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(r, 1), 0);
	kapp_run(k, 50);
	bus_fault(k->b, EC_SIM_FAULT_POWER_OFF, 2, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, ends(k, r), EC_REQUEST_ERROR);
	bus_fault(k->b, EC_SIM_FAULT_MUTE, 2, 0, 0, 0);
	bus_fault(k->b, EC_SIM_FAULT_POWER_ON, 2, 0, 0, 0);
	kapp_run(k, 2000);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(r, 1), 0);
	KUNIT_EXPECT_EQ(test, ends(k, r), EC_REQUEST_SUCCESS);
	bus_fault(k->b, EC_SIM_FAULT_MUTE, 2, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_info_request_list(r, 2), 0);
	kapp_run(k, 50);
	ecrt_release_master(k->m);
	bus_fault(k->b, EC_SIM_FAULT_MUTE, 2, 0, 0, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kapi_dict_lists_and_descriptions),
	KUNIT_CASE(kapi_dict_refusals),
	KUNIT_CASE(kapi_dict_request_reads),
	KUNIT_CASE(kapi_dict_request_ends_early),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_dict",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
