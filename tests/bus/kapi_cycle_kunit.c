// SPDX-License-Identifier: GPL-2.0-only
/* The cycle of applications in the kernel: where it may run, and what runs beside it. */
#include <linux/completion.h>
#include <linux/hrtimer.h>
#include <linux/kthread.h>
#include "kapp.h"
#include "devices/ecdev.h"
#include "devices/sim/app.h"
#include "master/config/config.h"
#include "master/link/device.h"
#include "master/wire/coe.h"

static const char two[] = "segment seed=8 response=500us\nslave a drive in=8 out=8 mbox=128 serial=11 soe=2 voe=0x4321\n"
			  "slave b drive in=8 out=8 mbox=512 serial=12\n";

static struct kapp *start(struct kunit *test, u32 period_us)
{
	struct bus *b = bus_up(test, two, 2);
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, period_us);
	kapp_map(k, 0);
	kapp_map(k, 1);
	return k;
}

/* objects at once ------------------------------------------------------------*/

static void kapi_sdo(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	u8 value[8] = { 0x11, 0x22, 0x33, 0x44 }, back[8];
	size_t got = 99;
	u32 abort = 1;
	char text[256];

	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_download(k->m, 0, 0x2001, 8, value, 4, &abort), 0);
	KUNIT_EXPECT_EQ(test, abort, 0u);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 0, 0x2001, 8, back, 8, &got, &abort), 0);
	KUNIT_EXPECT_EQ(test, got, (size_t)4);
	KUNIT_EXPECT_MEMEQ(test, back, value, 4);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 1, 0x1018, 4, back, 8, &got, NULL), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(back), 12u);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 0, 0x3fff, 0, back, 8, &got, &abort),
			-EIO);
	KUNIT_EXPECT_EQ(test, abort, (u32)EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_EQ(test, got, (size_t)0);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_download(k->m, 0, 0x1018, 1, value, 4, &abort), -EIO);
	KUNIT_EXPECT_EQ(test, abort, (u32)EC_ABORT_READ_ONLY);
	KUNIT_EXPECT_GT(test, ecrt_master_reason(k->m, text, sizeof(text)), 0);
	KUNIT_EXPECT_NOT_NULL(test, strstr(text, "0x06010002"));
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_download(k->m, 0, 0x2001, 8, value, 4, &abort), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_reason(k->m, text, sizeof(text)), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_reason(NULL, text, sizeof(text)), -EINVAL);
	/* too small a buffer stays as it is */
	memset(back, 0x5a, 8);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 0, 0x2001, 8, back, 2, &got, &abort),
			-ENOBUFS);
	KUNIT_EXPECT_EQ(test, back[0], 0x5a);
	KUNIT_EXPECT_EQ(test, abort, 0u);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 0, 0x2001, 8, back, 0, &got, &abort),
			-ENOBUFS);
	/* more room than any object needs */
	KUNIT_EXPECT_EQ(test,
			ecrt_master_sdo_upload(k->m, 0, 0x2001, 8, back, U32_MAX, &got, &abort), 0);
	KUNIT_EXPECT_EQ(test, got, (size_t)4);
	abort = 1;
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 0, 0x2001, 8, NULL, 4, &got, &abort),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, abort, 0u);
	KUNIT_EXPECT_EQ(test, got, (size_t)0);
	abort = 1;
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 7, 0x1018, 4, back, 8, &got, &abort),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, abort, 0u);
	abort = 1;
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_download(k->m, 7, 0x1018, 4, value, 4, &abort),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_download(k->m, 0, 0x2001, 8, NULL, 4, &abort),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, abort, 0u);
	ecrt_release_master(k->m);
}

static void kapi_sdo_complete(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	u8 whole[128], back[128];
	size_t got;
	u32 abort;

	/* what it is, then one value of it changed */
	KUNIT_ASSERT_EQ(test, ecrt_master_sdo_upload(k->m, 1, 0x2001, 8, back, 4, &got, &abort), 0);
	memset(whole, 0, sizeof(whole));
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload_complete(k->m, 1, 0x1018, whole, 128, &got,
							      &abort), 0);
	/* four of 32 bits behind the number of them */
	KUNIT_EXPECT_EQ(test, got, (size_t)18);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(whole), 4u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(whole + 14), 12u);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload_complete(k->m, 1, 0x1018, whole, 17, &got,
							      &abort), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload_complete(k->m, 1, 0x3fff, whole, 128, &got,
							      &abort), -EIO);
	memset(whole, 0, sizeof(whole));
	whole[0] = 12;
	whole[2] = 1;
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_download_complete(k->m, 1, 0x3fff, whole, 4, &abort),
			-EIO);
	KUNIT_EXPECT_EQ(test, abort, (u32)EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_download_complete(k->m, 1, 0x2001, whole, 0, &abort),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_complete_sdo(k->sc[1], 0x3fff, whole, 4), 0);
	KUNIT_EXPECT_EQ(test, bus_config(k->b, 1)->n_startup[EC_STARTUP_SDO], 1u);
	ecrt_release_master(k->m);
}

/* requests beside the cycle --------------------------------------------------*/

static ec_request_state_t finish(struct kapp *k, ec_sdo_request_t *r)
{
	u32 i;

	for (i = 0; i < 3000 && ecrt_sdo_request_state(r) == EC_REQUEST_BUSY; i++)
		kapp_run(k, 1);
	return ecrt_sdo_request_state(r);
}

static void kapi_requests(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_sdo_request_t *r = ecrt_slave_config_create_sdo_request(k->sc[0], 0x1018, 4, 4);
	ec_sdo_request_t *far;
	ec_slave_config_t *absent;
	u8 *data;

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_NULL(test, ecrt_slave_config_create_sdo_request(k->sc[0], 0x1018, 4, 1 << 20));
	absent = ecrt_master_slave_config(k->m, 0, 7, 1, 2);
	far = ecrt_slave_config_create_sdo_request(absent, 0x1018, 4, 4);
	KUNIT_ASSERT_NOT_NULL(test, far);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_timeout(far, 50), 0);
	data = ecrt_sdo_request_data(r);
	KUNIT_ASSERT_NOT_NULL(test, data);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_data_size(r), (size_t)4);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(r), EC_REQUEST_UNUSED);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), -EINVAL);
	kapp_op(k);
	k->incomplete = 0;
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_index(r, 0x2001, 8), -EBUSY);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(data), 11u);
	KUNIT_EXPECT_PTR_EQ(test, ecrt_sdo_request_data(r), data);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_index(r, 0x2001, 8), 0);
	put_unaligned_le32(0x12345678, data);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_write(r), 0);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_SUCCESS);
	put_unaligned_le32(0, data);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(data), 0x12345678u);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_index(r, 0x3fff, 0), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_ERROR);
	/* an absent slave is waited for as long as was said */
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(far), 0);
	kapp_run(k, 40);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(far), EC_REQUEST_BUSY);
	KUNIT_EXPECT_EQ(test, finish(k, far), EC_REQUEST_ERROR);
	/* the slave with process data did not notice; the absent one has none */
	KUNIT_EXPECT_EQ(test, k->incomplete, 0ull);
	ecrt_release_master(k->m);
}

/* An object as a whole, as in userspace; a value shorter than the buffer. */
static void kapi_requests_complete(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_sdo_request_t *r;

	r = ecrt_slave_config_create_sdo_request_complete(k->sc[1], 0x1018, 64);
	KUNIT_ASSERT_NOT_NULL(test, r);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_index_complete(r, 0x1018), -EBUSY);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_data_size(r), (size_t)18);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(ecrt_sdo_request_data(r)), 4u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(ecrt_sdo_request_data(r) + 14), 12u);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_index(r, 0x2001, 8), 0);
	put_unaligned_le32(0x89abcdef, ecrt_sdo_request_data(r));
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_write_with_size(r, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_write_with_size(r, 65), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_write_with_size(r, 4), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_data_size(r), (size_t)4);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(ecrt_sdo_request_data(r)), 0x89abcdefu);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_index_complete(r, 0x1018), 0);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(r), 0);
	KUNIT_EXPECT_EQ(test, finish(k, r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_data_size(r), (size_t)18);
	ecrt_release_master(k->m);
}

static void kapi_registers(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_reg_request_t *r = ecrt_slave_config_create_reg_request(k->sc[1], 4);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_state(r), EC_REQUEST_UNUSED);
	kapp_op(k);
	/* more than there is room for is refused, as in userspace */
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_read(r, EC_REG_STATION, 5), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_write(r, EC_REG_STATION, 5), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_state(r), EC_REQUEST_UNUSED);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_read(r, EC_REG_STATION, 4), 0);
	for (i = 0; i < 1000 && ecrt_reg_request_state(r) == EC_REQUEST_BUSY; i++)
		kapp_run(k, 1);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_state(r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(ecrt_reg_request_data(r)),
			bus_slave(k->b, 1)->station);
	put_unaligned_le16(0x0777, ecrt_reg_request_data(r));
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_write(r, 0x0420, 2), 0);
	for (i = 0; i < 1000 && ecrt_reg_request_state(r) == EC_REQUEST_BUSY; i++)
		kapp_run(k, 1);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_state(r), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_read(r, 0x0420, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_read(r, 0x0420, 2), 0);
	for (i = 0; i < 1000 && ecrt_reg_request_state(r) == EC_REQUEST_BUSY; i++)
		kapp_run(k, 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(ecrt_reg_request_data(r)), 0x0777);
	/* written, and the old content comes back */
	put_unaligned_le16(0x0333, ecrt_reg_request_data(r));
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_readwrite(r, 0x0420, 5), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_readwrite(r, 0x0420, 2), 0);
	for (i = 0; i < 1000 && ecrt_reg_request_state(r) == EC_REQUEST_BUSY; i++)
		kapp_run(k, 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(ecrt_reg_request_data(r)), 0x0777);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(bus_esc(k->b, 1)->mem + 0x0420), 0x0333);
	ecrt_release_master(k->m);
}

/* IDNs at once, at startup and as a request; the drive has speed limits at S-0-0091. */
static void kapi_idns(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_soe_request_t *r = ecrt_slave_config_create_soe_request(k->sc[0], 0, 91, 4);
	u8 value[8];
	u16 error = 1;
	size_t got;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, r);
	KUNIT_EXPECT_NULL(test, ecrt_slave_config_create_soe_request(k->sc[0], 8, 91, 4));
	KUNIT_EXPECT_EQ(test, ecrt_master_read_idn(k->m, 0, 0, 91, value, 8, &got, &error), 0);
	KUNIT_EXPECT_EQ(test, got, (size_t)4);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(value), 3000u);
	KUNIT_EXPECT_EQ(test, error, 0);
	put_unaligned_le32(3500, value);
	KUNIT_EXPECT_EQ(test, ecrt_master_write_idn(k->m, 0, 1, 91, value, 4, &error), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_write_idn(k->m, 0, 8, 91, value, 4, &error), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_read_idn(k->m, 0, 0, 0x0fff, value, 8, &got, &error),
			-EIO);
	KUNIT_EXPECT_NE(test, error, 0);
	KUNIT_EXPECT_EQ(test, got, (size_t)0);
	KUNIT_EXPECT_EQ(test, ecrt_master_read_idn(k->m, 7, 0, 91, value, 8, &got, &error),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_read_idn(k->m, 0, 0, 91, value, U32_MAX, &got, &error),
			0);
	KUNIT_EXPECT_EQ(test, got, (size_t)4);
	KUNIT_EXPECT_EQ(test, ecrt_master_read_idn(k->m, 0, 0, 91, value, 0, &got, &error),
			-ENOBUFS);
	error = 1;
	KUNIT_EXPECT_EQ(test, ecrt_master_read_idn(k->m, 0, 0, 91, NULL, 4, &got, &error), -EINVAL);
	KUNIT_EXPECT_EQ(test, error, 0);
	KUNIT_EXPECT_EQ(test, got, (size_t)0);
	put_unaligned_le32(4000, value);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_idn(k->sc[0], 0, 91, EC_AL_STATE_PREOP, value, 4),
			0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_idn(k->sc[0], 0, 91, EC_AL_STATE_OP, value, 4),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_timeout(r, 1000), 0);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_read(r), -EINVAL);
	kapp_op(k);
	for (i = 0; i < 3; i++) {
		u32 n;

		/* what startup wrote, then what the request writes, read back */
		KUNIT_EXPECT_EQ(test, i == 1 ? ecrt_soe_request_write(r) : ecrt_soe_request_read(r),
				0);
		KUNIT_EXPECT_EQ(test, ecrt_soe_request_idn(r, 1, 91), -EBUSY);
		for (n = 0; n < 3000 && ecrt_soe_request_state(r) == EC_REQUEST_BUSY; n++)
			kapp_run(k, 1);
		KUNIT_EXPECT_EQ(test, ecrt_soe_request_state(r), EC_REQUEST_SUCCESS);
		KUNIT_EXPECT_EQ(test, ecrt_soe_request_data_size(r), (size_t)4);
		KUNIT_EXPECT_EQ(test, get_unaligned_le32(ecrt_soe_request_data(r)), i ?
				2000u : 4000u);
		put_unaligned_le32(2000, ecrt_soe_request_data(r));
	}
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_idn(r, 1, 91), 0);
	KUNIT_EXPECT_EQ(test, ecrt_soe_request_idn(r, 8, 91), -EINVAL);
	ecrt_release_master(k->m);
}

static ec_request_state_t execute(struct kapp *k, ec_voe_handler_t *voe)
{
	u32 i;

	for (i = 0; i < 3000 && ecrt_voe_handler_execute(voe) == EC_REQUEST_BUSY; i++)
		kapp_run(k, 1);
	return ecrt_voe_handler_execute(voe);
}

/* The slave sends back what it gets. */
static void kapi_voe(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_voe_handler_t *voe = ecrt_slave_config_create_voe_handler(k->sc[0], 16);
	u32 vendor;
	u16 type;

	KUNIT_ASSERT_NOT_NULL(test, voe);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_data_size(voe), (size_t)16);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_send_header(voe, 0xec51, 7), 0);
	memcpy(ecrt_voe_handler_data(voe), "hello", 5);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_write(voe, 17), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_write(voe, 5), 0);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_read(voe), -EBUSY);
	KUNIT_EXPECT_EQ(test, execute(k, voe), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_data_size(voe), (size_t)5);
	memset(ecrt_voe_handler_data(voe), 0, 16);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_read(voe), 0);
	KUNIT_EXPECT_EQ(test, execute(k, voe), EC_REQUEST_SUCCESS);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_received_header(voe, &vendor, &type), 0);
	KUNIT_EXPECT_EQ(test, vendor, 0xec51u);
	KUNIT_EXPECT_EQ(test, type, 0x4321);
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_received_header(voe, NULL, NULL), 0);
	/* nothing more is there */
	KUNIT_EXPECT_EQ(test, ecrt_voe_handler_read_nosync(voe), 0);
	KUNIT_EXPECT_EQ(test, execute(k, voe), EC_REQUEST_ERROR);
	ecrt_release_master(k->m);
}

static void kapi_emergencies(struct kunit *test)
{
	static const u8 five[5] = { 1, 2, 3, 4, 5 };
	struct kapp *k = start(test, 1000);
	u8 msg[8];
	u32 i;

	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_size(k->sc[0], 1 << 20), -ENOMEM);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_size(k->sc[0], 2), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_pop(k->sc[0], msg), -ENOENT);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_pop(k->sc[0], msg), -ENOENT);
	for (i = 0; i < 3; i++) {
		ec_app_emergency(bus_app(k->b, "a"), 0x8110 + i, 0x11, five, ktime_get_ns());
		kapp_run(k, 40);
	}
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_overruns(k->sc[0]), 1);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_pop(k->sc[0], msg), 0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(msg), 0x8110);
	KUNIT_EXPECT_EQ(test, msg[2], 0x11);
	KUNIT_EXPECT_MEMEQ(test, msg + 3, five, 5);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_clear(k->sc[0]), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_pop(k->sc[0], msg), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_overruns(k->sc[0]), 0);
	ecrt_release_master(k->m);
}

/* clocks ---------------------------------------------------------------------*/

/* A frame that only a second receive finds counts with the next look at its domain. */
static void kapi_late_frame(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_domain_state_t state;

	kapp_op(k);
	kapp_wait(k);
	KUNIT_ASSERT_EQ(test, ecrt_master_receive(k->m), 0);
	KUNIT_ASSERT_EQ(test, ecrt_domain_queue(k->d), 0);
	KUNIT_ASSERT_EQ(test, ecrt_master_send(k->m), 0);
	KUNIT_ASSERT_EQ(test, ecrt_master_receive(k->m), 0);
	KUNIT_ASSERT_EQ(test, ecrt_domain_process(k->d), 0);
	KUNIT_ASSERT_EQ(test, ecrt_domain_state(k->d, &state), 0);
	KUNIT_ASSERT_EQ(test, (int)state.wc_state, (int)EC_WC_ZERO);
	kapp_wait(k);
	KUNIT_ASSERT_EQ(test, ecrt_master_receive(k->m), 0);
	KUNIT_ASSERT_EQ(test, ecrt_domain_process(k->d), 0);
	KUNIT_ASSERT_EQ(test, ecrt_domain_state(k->d, &state), 0);
	KUNIT_EXPECT_EQ(test, (int)state.wc_state, (int)EC_WC_COMPLETE);
	/* one that was not sent stays as it is */
	KUNIT_ASSERT_EQ(test, ecrt_master_send(k->m), 0);
	kapp_wait(k);
	KUNIT_ASSERT_EQ(test, ecrt_master_receive(k->m), 0);
	KUNIT_ASSERT_EQ(test, ecrt_domain_process(k->d), 0);
	KUNIT_ASSERT_EQ(test, ecrt_domain_state(k->d, &state), 0);
	KUNIT_EXPECT_EQ(test, (int)state.wc_state, (int)EC_WC_COMPLETE);
	ecrt_release_master(k->m);
}

static void clocks_each(struct kapp *k)
{
	ecrt_master_application_time(k->m, ktime_get_ns());
	ecrt_master_sync_slave_clocks(k->m);
	ecrt_master_sync_monitor_queue(k->m);
	ecrt_master_64bit_reference_clock_time_queue(k->m);
}

static void kapi_clocks(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_slave_config_dc_state_t state;
	u64 ref, now, time64;
	char text[256];
	u32 time;
	int ret;

	KUNIT_EXPECT_EQ(test, ecrt_slave_config_dc(k->sc[1], 0x0300, 1000000, 100, 0, 0), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_select_reference_clock(k->m, k->sc[0]), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(k->m, ktime_get_ns()), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_sync_slave_clocks(k->m), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_64bit_reference_clock_time(k->m, &time64), -EINVAL);
	KUNIT_EXPECT_GT(test, ecrt_slave_config_reason(k->sc[1], text, sizeof(text)), 0);
	k->each = clocks_each;
	kapp_op(k);
	kapp_run(k, 500);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reason(k->sc[1], text, sizeof(text)), 0);
	kapp_wait(k);
	KUNIT_ASSERT_EQ(test, ecrt_master_receive(k->m), 0);
	ret = ecrt_master_reference_clock_time(k->m, &time);
	now = ktime_get_ns();
	ec_sim_advance(k->b->sim, now);
	ref = now - NSEC_PER_MSEC;
	KUNIT_EXPECT_EQ(test, ret, 0);
	/* of the last cycle, in the application's time */
	KUNIT_EXPECT_LT(test, abs((s32)(time - (u32)ref)), 200000);
	KUNIT_EXPECT_EQ(test, ecrt_master_64bit_reference_clock_time(k->m, &time64), 0);
	KUNIT_EXPECT_LT(test, abs((s64)(time64 - ref)), 200000ll);
	KUNIT_EXPECT_EQ(test, ecrt_master_64bit_reference_clock_time(k->m, NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_dc_state(k->sc[0], &state), 0);
	KUNIT_EXPECT_TRUE(test, state.reference && state.set && state.bits);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_dc_state(k->sc[1], &state), 0);
	KUNIT_EXPECT_TRUE(test, !state.reference && state.set && state.in_window);
	KUNIT_EXPECT_GT(test, state.delay_ns, 0u);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_dc_state(k->sc[1], NULL), -EINVAL);
	KUNIT_EXPECT_LT(test, ecrt_master_sync_monitor_process(k->m), 1000u);
	KUNIT_EXPECT_EQ(test, ecrt_master_sync_reference_clock(k->m), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_sync_reference_clock_to(k->m, now), 0);
	KUNIT_EXPECT_EQ(test, bus_config(k->b, 1)->sync.shift[0], 100);
	KUNIT_EXPECT_EQ(test, bus_session(k->b)->ref_config, 0u);
	ecrt_release_master(k->m);
}

/* where the cycle may run ----------------------------------------------------*/

/* the cycle in a hard interrupt */
struct timer_cycle {
	struct hrtimer timer;
	struct kapp *k;
	u32 left;
	int error;
	bool hard;
};

static enum hrtimer_restart timer_cycle(struct hrtimer *timer)
{
	struct timer_cycle *c = container_of(timer, struct timer_cycle, timer);
	int ret = kapp_exchange(c->k);

	c->hard |= in_hardirq() && irqs_disabled();
	if (ret && !c->error)
		c->error = ret;
	if (!--c->left)
		return HRTIMER_NORESTART;
	hrtimer_forward_now(timer, ns_to_ktime(c->k->period_ns));
	return HRTIMER_RESTART;
}

static void kapi_hardirq(struct kunit *test)
{
	struct timer_cycle c = { .left = 3000 };
	u8 *pd;

	c.k = start(test, 1000);
	kapp_activate(c.k);
	pd = ecrt_domain_data(c.k->d);
	EC_WRITE_U16(pd + c.k->out[0], 0x0f0f);
	hrtimer_init_on_stack(&c.timer, CLOCK_MONOTONIC, HRTIMER_MODE_REL_HARD);
	c.timer.function = timer_cycle;
	hrtimer_start(&c.timer, ms_to_ktime(1), HRTIMER_MODE_REL_HARD);
	while (READ_ONCE(c.left) > 1000)
		msleep(10);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(c.k));
	c.k->incomplete = 0;
	while (READ_ONCE(c.left))
		msleep(10);
	hrtimer_cancel(&c.timer);
	destroy_hrtimer_on_stack(&c.timer);
	KUNIT_EXPECT_TRUE(test, c.hard);
	KUNIT_EXPECT_EQ(test, c.error, 0);
	KUNIT_EXPECT_EQ(test, c.k->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(c.k->b, "a"), EC_APP_OUT, 0), 0x0f0f);
	KUNIT_EXPECT_EQ(test, bus_lost(c.k->b), 0ull);
	ecrt_release_master(c.k->m);
}

/* A device that needs a thread says so; the application may go on from one. */
static void kapi_needs_thread(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	struct ecdev *dev = bus_dev(k->b);
	const struct ecdev_ops *ops = dev->ops;
	struct ecdev_ops thread = *ops;
	int ret[3];

	thread.atomic = false;
	kapp_op(k);
	dev->ops = &thread;
	kapp_run(k, 3);
	local_irq_disable();
	ret[0] = ecrt_master_receive(k->m);
	ret[1] = ecrt_master_send(k->m);
	ret[2] = ecrt_master_send_ext(k->m);
	local_irq_enable();
	KUNIT_EXPECT_EQ(test, ret[0], -EWOULDBLOCK);
	KUNIT_EXPECT_EQ(test, ret[1], -EWOULDBLOCK);
	KUNIT_EXPECT_EQ(test, ret[2], -EWOULDBLOCK);
	kapp_run(k, 3);
	dev->ops = ops;
	ecrt_release_master(k->m);
}

/* what happens to the links --------------------------------------------------*/

/* After a pause the links come back by themselves, the caller never sleeps for it. */
static void kapi_stall(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	int ret = 0;
	u32 i;

	kapp_op(k);
	msleep(500);
	KUNIT_EXPECT_EQ(test, bus_timeouts(k->b), 1);
	KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -EAGAIN);
	KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -EAGAIN);
	k->next = ktime_get();
	for (i = 0; i < 5; i++) {
		kapp_wait(k);
		ret = kapp_exchange(k);
		if (!ret)
			break;
		KUNIT_EXPECT_EQ(test, ret, -EAGAIN);
	}
	KUNIT_EXPECT_EQ(test, ret, 0);
	kapp_run(k, 1);
	for (i = 0; i < 5000 && !kapp_all_op(k); i++)
		kapp_run(k, 1);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
	ecrt_release_master(k->m);
}

/* Without its device calls say so, and who does not look finds it in the state. */
static void kapi_device_gone(struct kunit *test)
{
	struct kapp *k = start(test, 1000);
	ec_domain_state_t state;
	u32 i;

	kapp_op(k);
	bus_no_device(k->b);
	for (i = 0; i < 3; i++) {
		kapp_wait(k);
		KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -ENODEV);
		KUNIT_EXPECT_EQ(test, ecrt_domain_process(k->d), 0);
		KUNIT_EXPECT_EQ(test, ecrt_domain_state(k->d, &state), 0);
		KUNIT_EXPECT_EQ(test, state.working_counter, 0u);
		KUNIT_EXPECT_EQ(test, (int)state.wc_state, (int)EC_WC_ZERO);
		KUNIT_EXPECT_EQ(test, ecrt_domain_queue(k->d), 0);
		KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -ENODEV);
	}
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
	for (i = 0; i < 2; i++)
		KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -EINVAL);
	ecrt_release_master(k->m);
}

/* hooks ----------------------------------------------------------------------*/

/* an upload by somebody else, and hooks that share a lock with the cycle */
struct beside {
	struct kapp *k;
	struct completion done;
	struct mutex lock;
	u64 took_us;
	int ret;
	u32 sends;
	u32 receives;
	bool decline;
	bool ended;
	bool late;
};

static int upload(void *data)
{
	struct beside *s = data;
	u64 t0 = ktime_get_ns();
	size_t got;
	u8 value[4];
	u32 abort;

	s->ret = ecrt_master_sdo_upload(s->k->m, 1, 0x1018, 4, value, 4, &got, &abort);
	s->took_us = div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
	complete(&s->done);
	return 0;
}

static void send_cb(void *data)
{
	struct beside *s = data;

	s->late |= s->ended;
	s->sends++;
	if (s->decline)
		return;
	mutex_lock(&s->lock);
	ecrt_master_send_ext(s->k->m);
	mutex_unlock(&s->lock);
}

static void receive_cb(void *data)
{
	struct beside *s = data;

	s->late |= s->ended;
	s->receives++;
	mutex_lock(&s->lock);
	ecrt_master_receive(s->k->m);
	mutex_unlock(&s->lock);
}

/* Cycles until the upload has ended. */
static void run_beside(struct beside *s)
{
	struct task_struct *t;
	u32 i;

	init_completion(&s->done);
	t = kthread_run(upload, s, "upload");
	KUNIT_ASSERT_FALSE(s->k->b->test, IS_ERR(t));
	for (i = 0; i < 1000 && !try_wait_for_completion(&s->done); i++) {
		int ret;

		kapp_wait(s->k);
		mutex_lock(&s->lock);
		ret = kapp_exchange(s->k);
		mutex_unlock(&s->lock);
		KUNIT_ASSERT_EQ(s->k->b->test, ret, 0);
	}
	KUNIT_EXPECT_LT(s->k->b->test, i, 1000u);
	KUNIT_EXPECT_EQ(s->k->b->test, s->ret, 0);
}

static void hooks(struct kunit *test, struct beside *s, bool use)
{
	s->k = start(test, 20000);
	mutex_init(&s->lock);
	if (use)
		ecrt_master_callbacks(s->k->m, send_cb, receive_cb, s);
	kapp_op(s->k);
	s->k->incomplete = 0;
	run_beside(s);
	KUNIT_EXPECT_EQ(test, s->k->incomplete, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(s->k->b), 0ull);
	ecrt_release_master(s->k->m);
	s->ended = true;
	msleep(100);
	KUNIT_EXPECT_FALSE(test, s->late);
}

/* A cycle of 20 ms: with it a mailbox exchange takes cycles, between them 1 ms. */
static void kapi_callbacks(struct kunit *test)
{
	struct beside s = { 0 };

	hooks(test, &s, true);
	KUNIT_EXPECT_LT(test, s.took_us, 5000ull);
	KUNIT_EXPECT_GT(test, s.sends, 1u);
	KUNIT_EXPECT_GT(test, s.receives, 1u);
	bus_figure("SDO beside a cycle of 20 ms, with callbacks %llu us", s.took_us);
}

static void kapi_no_callbacks(struct kunit *test)
{
	struct beside s = { 0 };

	hooks(test, &s, false);
	KUNIT_EXPECT_GT(test, s.took_us, 20000ull);
	KUNIT_EXPECT_EQ(test, s.sends, 0u);
	bus_figure("SDO beside a cycle of 20 ms, without callbacks %llu us", s.took_us);
}

/* Hooks may decline: then it goes with the cycle. */
static void kapi_callbacks_decline(struct kunit *test)
{
	struct beside s = { .decline = true };

	hooks(test, &s, true);
	KUNIT_EXPECT_GT(test, s.took_us, 20000ull);
	KUNIT_EXPECT_GT(test, s.sends, 1u);
}

/* They are for the next activation only, and not while it lasts. */
static void kapi_callbacks_when(struct kunit *test)
{
	struct beside s = { 0 };

	s.k = start(test, 20000);
	mutex_init(&s.lock);
	ecrt_master_callbacks(s.k->m, send_cb, receive_cb, &s);
	ecrt_release_master(s.k->m);
	bus_idle(s.k->b);
	s.k = kapp_new(s.k->b, 20000);
	kapp_map(s.k, 0);
	kapp_map(s.k, 1);
	kapp_op(s.k);
	ecrt_master_callbacks(s.k->m, send_cb, receive_cb, &s);
	run_beside(&s);
	KUNIT_EXPECT_EQ(test, s.sends + s.receives, 0u);
	ecrt_release_master(s.k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kapi_sdo),
	KUNIT_CASE(kapi_sdo_complete),
	KUNIT_CASE(kapi_requests),
	KUNIT_CASE(kapi_requests_complete),
	KUNIT_CASE(kapi_registers),
	KUNIT_CASE(kapi_idns),
	KUNIT_CASE(kapi_voe),
	KUNIT_CASE(kapi_emergencies),
	KUNIT_CASE(kapi_late_frame),
	KUNIT_CASE(kapi_clocks),
	KUNIT_CASE(kapi_hardirq),
	KUNIT_CASE(kapi_needs_thread),
	KUNIT_CASE(kapi_stall),
	KUNIT_CASE(kapi_device_gone),
	KUNIT_CASE(kapi_callbacks),
	KUNIT_CASE(kapi_no_callbacks),
	KUNIT_CASE(kapi_callbacks_decline),
	KUNIT_CASE(kapi_callbacks_when),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_cycle",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
