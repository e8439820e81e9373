// SPDX-License-Identifier: GPL-2.0-only
/* The mailbox of a slave that nothing but a station address is known of. */
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/slab.h>
#include "devices/sim/app.h"
#include "master/base/stop.h"
#include "master/carry/xfer.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"
#include "master/wire/al.h"
#include "master/wire/regs.h"
#include "segment.h"

#define STATION	1001

struct bench {
	struct segment seg;
	struct ec_stop stop;
	struct ec_sii_info sii;
	u16 al_status;
	u16 position;
	struct ec_mbox mbox;
};

static bool in_preop(void *arg)
{
	struct bench *b = arg;
	u8 al[2];

	if (ec_xfer_fprd(&b->seg.links, STATION, EC_REG_AL_STATUS, al, 2))
		return false;
	b->al_status = get_unaligned_le16(al);
	return b->al_status == EC_AL_PREOP;
}

/* what a scan would do */
static bool climb(struct bench *b)
{
	const struct ec_esc_eeprom *e = &ec_sim_slave(b->seg.sim, 0)->eep;
	static const u8 preop[2] = { EC_AL_PREOP };
	u8 page[2 * EC_SM_PAGE], station[2];
	unsigned int len;

	if (!CHECK_EQ(ec_sii_decode_info(e->data, e->len, &b->sii), 0))
		return false;
	put_unaligned_le16(STATION, station);
	len = ec_mbox_sms(&b->mbox, false, page);
	return CHECK_EQ(ec_xfer_one(&b->seg.links, EC_CMD_APWR, 0, EC_REG_STATION, station, 2),
			1) &&
	       CHECK_EQ(ec_xfer_fpwr(&b->seg.links, STATION, EC_REG_SM(0), page, len), 0) &&
	       CHECK_EQ(ec_xfer_fpwr(&b->seg.links, STATION, EC_REG_AL_CONTROL, preop, 2), 0) &&
	       CHECK(alone_wait(in_preop, b, 1000));
}

static void bench_free(struct bench *b)
{
	segment_end(&b->seg);
	kvfree(b);
}

static struct bench *bench_new(void)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	if (!segment_begin(&b->seg, "segment seed=1 response=500us\nslave d drive in=8 out=8\n")) {
		kvfree(b);
		return NULL;
	}
	ec_stop_init(&b->stop, &b->seg.base);
	b->mbox.base = &b->seg.base;
	b->mbox.box.links = &b->seg.links;
	b->mbox.stop = &b->stop;
	b->mbox.box.sii = &b->sii;
	b->mbox.box.al_status = &b->al_status;
	b->mbox.position = &b->position;
	b->mbox.box.station = STATION;
	ec_mbox_init(&b->mbox);
	if (climb(b))
		return b;
	bench_free(b);
	return NULL;
}

/* 0x6060: mode of operation of a drive */
static void object_is_written_and_read(void)
{
	struct bench *b = bench_new();
	u8 v = 6, data[16] = { 0 };
	size_t size = 0;
	u32 abort = 0;

	if (!b)
		return;
	CHECK_EQ(ec_coe_download(&b->mbox, 0x6060, 0, false, &v, 1, &abort, NULL), 0);
	CHECK_EQ(ec_coe_upload(&b->mbox, 0x6060, 0, false, data, sizeof(data), &size, &abort,
			       NULL), 0);
	CHECK_EQ(size, 1);
	CHECK_EQ(data[0], 6);
	bench_free(b);
}

static void refusal_has_its_abort_code(void)
{
	struct bench *b = bench_new();
	u8 data[16];
	size_t size;
	u32 abort = 0;

	if (!b)
		return;
	CHECK_EQ(ec_coe_upload(&b->mbox, 0x5fff, 0, false, data, sizeof(data), &size, &abort,
			       NULL), -EIO);
	CHECK_EQ(abort, 0x06020000);
	bench_free(b);
}

struct caller {
	struct bench *b;
	struct completion done;
	int ret;
};

static int read_object(void *arg)
{
	struct caller *c = arg;
	u8 data[16];
	size_t size;
	u32 abort;

	c->ret = ec_coe_upload(&c->b->mbox, 0x1008, 0, false, data, sizeof(data), &size, &abort,
			       NULL);
	complete(&c->done);
	return 0;
}

/* a slave that is silent keeps a caller only until it leaves the bus */
static void lost_slave_ends_transfers(void)
{
	struct bench *b = bench_new();
	struct caller c = { .b = b };
	u64 t0;

	if (!b)
		return;
	init_completion(&c.done);
	segment_fault(&b->seg, "mute d");
	if (CHECK(!IS_ERR(kthread_run(read_object, &c, "ec_alone")))) {
		usleep_range(20000, 21000);
		CHECK(!completion_done(&c.done));
		t0 = ktime_get_ns();
		ec_stop_gone(&b->stop);
		wait_for_completion(&c.done);
		CHECK_OP(c.ret, <, 0);
		CHECK_OP(ktime_get_ns() - t0, <, 100 * NSEC_PER_MSEC);
	}
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(object_is_written_and_read),
	TEST(refusal_has_its_abort_code),
	TEST(lost_slave_ends_transfers),
	{ }
};
