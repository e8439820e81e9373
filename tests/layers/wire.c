// SPDX-License-Identifier: GPL-2.0-only
/* The codecs, which need nothing but themselves; tests/unit has all of their cases. */
#include "alone.h"
#include "master/wire/frame.h"

static void frame_is_read_as_it_was_built(void)
{
	u8 frame[64], *p;
	struct ec_frame_buf fb;
	struct ec_frame_iter it;
	struct ec_dgram d;
	size_t len;

	ec_frame_begin(&fb, frame, sizeof(frame));
	p = ec_frame_add(&fb, EC_CMD_FPWR, 7, 1001, 0x120, 2);
	if (!CHECK(p))
		return;
	p[0] = 0x12;
	p[1] = 0x34;
	if (!CHECK(ec_frame_add(&fb, EC_CMD_LRW, 7, 0, 1, 8)))
		return;
	/* no room for a third one */
	CHECK(!ec_frame_add(&fb, EC_CMD_BRD, 7, 0, 0, 20));
	len = ec_frame_end(&fb);
	CHECK_EQ(len, 2 + 14 + 20);
	CHECK_EQ(ec_frame_iter_init(&it, frame, len), 0);
	if (!CHECK_EQ(ec_frame_iter_next(&it, &d), 1))
		return;
	CHECK_EQ(d.cmd, EC_CMD_FPWR);
	CHECK_EQ(d.adp, 1001);
	CHECK_EQ(d.data[1], 0x34);
	CHECK_EQ(d.more, true);
	if (!CHECK_EQ(ec_frame_iter_next(&it, &d), 1))
		return;
	CHECK_EQ(ec_dgram_logical(&d), 0x10000);
	CHECK_EQ(d.more, false);
	CHECK_EQ(ec_frame_iter_next(&it, &d), 0);
}

static void truncated_frame_is_refused(void)
{
	u8 frame[32];
	struct ec_frame_buf fb;
	struct ec_frame_iter it;
	struct ec_dgram d;
	size_t len;

	ec_frame_begin(&fb, frame, sizeof(frame));
	if (!CHECK(ec_frame_add(&fb, EC_CMD_BRD, 0, 0, 0, 4)))
		return;
	len = ec_frame_end(&fb);
	CHECK(ec_frame_iter_init(&it, frame, len - 1) || ec_frame_iter_next(&it, &d) < 0);
}

const struct alone_test alone_tests[] = {
	TEST(frame_is_read_as_it_was_built),
	TEST(truncated_frame_is_refused),
	{ }
};
