// SPDX-License-Identifier: GPL-2.0-only
/* Answers about the object dictionary that the master keeps. */
#include "bus.h"
#include "devices/sim/app.h"
#include "master/base/limits.h"
#include "master/boundary/ioctl.h"
#include "master/wire/sdoinfo.h"

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive in=8 out=8 mbox=128 serial=11\nslave b drive in=8 out=8 mbox=128 serial=12\n";

#define ROOM	4096

/* One question as the tool asks it: 0, or -errno; the sum of the answer is added to @sum. */
static int ask(struct bus *b, u8 what, u16 index, u8 sub, u8 *buf, size_t *size, u64 *sum)
{
	struct ec_ioc_sdo_info i = {
		.slave.position = 0, .what = what, .index = index, .subindex = sub, .size = ROOM,
		.data = (uintptr_t)buf,
	};
	int ret = ec_ioc(&b->app, EC_IOC_SDO_INFO, &i);
	u32 n;

	*size = ret ? 0 : i.size;
	for (n = 0; n < *size; n++)
		*sum = *sum * 31 + buf[n];
	*sum = *sum * 31 + i.abort_code + (u32)ret;
	return ret;
}

/* All of it, with a question behind the last subindex of each object, as gaps give. */
static u64 read_all(struct bus *b)
{
	u8 *list = kunit_kzalloc(b->test, ROOM, GFP_KERNEL);
	u8 *buf = kunit_kzalloc(b->test, ROOM, GFP_KERNEL);
	size_t bytes, size, i;
	u64 sum = 0;
	u32 sub;

	KUNIT_ASSERT_NOT_NULL(b->test, list);
	KUNIT_ASSERT_NOT_NULL(b->test, buf);
	KUNIT_EXPECT_EQ(b->test, ask(b, EC_SDO_INFO_LIST, 1, 0, list, &bytes, &sum), 0);
	KUNIT_EXPECT_GT(b->test, bytes, (size_t)20);
	for (i = 0; i + 1 < bytes; i += 2) {
		u16 index = get_unaligned_le16(list + i);
		u8 max;

		KUNIT_EXPECT_EQ(b->test, ask(b, EC_SDO_INFO_OBJECT, index, 0, buf, &size, &sum), 0);
		max = buf[4];
		for (sub = 0; sub <= max + 1u; sub++)
			ask(b, EC_SDO_INFO_ENTRY, index, (u8)sub, buf, &size, &sum);
	}
	return sum;
}

static void dict_second_reading_has_no_frame(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);
	struct ec_slave *s = bus_slave(b, 0);
	u64 frames, first, second;

	bus_idle(b);
	KUNIT_EXPECT_NULL(test, s->dict.answers);
	frames = bus_frames(b);
	first = read_all(b);
	KUNIT_EXPECT_GT(test, bus_frames(b), frames + 100);
	KUNIT_EXPECT_GT(test, s->dict.used, (size_t)1000);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	frames = bus_frames(b);
	second = read_all(b);
	KUNIT_EXPECT_EQ(test, bus_frames(b), frames);
	KUNIT_EXPECT_EQ(test, second, first);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	/* slaves that nobody asks have nothing */
	KUNIT_EXPECT_NULL(test, bus_slave(b, 1)->dict.answers);
}

static void dict_forget_reads_again(struct kunit *test)
{
	struct ec_ioc_sdo_info forget = { .what = EC_SDO_INFO_FORGET };
	struct bus *b = bus_up(test, text, 2);
	struct ec_slave *s = bus_slave(b, 0);
	u64 frames, first, sum = 0;
	u8 buf[64];
	size_t size;

	bus_idle(b);
	first = read_all(b);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SDO_INFO, &forget), 0);
	KUNIT_EXPECT_NULL(test, s->dict.answers);
	frames = bus_frames(b);
	KUNIT_EXPECT_EQ(test, read_all(b), first);
	KUNIT_EXPECT_GT(test, bus_frames(b), frames + 100);
	/* what was not answered is not kept */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SDO_INFO, &forget), 0);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ask(b, EC_SDO_INFO_OBJECT, 0x1018, 0, buf, &size, &sum), -ETIMEDOUT);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 0, 0);
	usleep_range(10000, 10001);
	KUNIT_EXPECT_EQ(test, ask(b, EC_SDO_INFO_OBJECT, 0x1018, 0, buf, &size, &sum), 0);
}

static void dict_init_and_boot_forget(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);
	struct ec_slave *s = bus_slave(b, 0);
	u64 sum = 0;
	u8 buf[64];
	size_t size;

	bus_idle(b);
	KUNIT_EXPECT_EQ(test, ask(b, EC_SDO_INFO_OBJECT, 0x1018, 0, buf, &size, &sum), 0);
	KUNIT_EXPECT_NOT_NULL(test, s->dict.answers);
	bus_request(b, 0, EC_AL_INIT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_INIT, 1000), ~0ull);
	KUNIT_EXPECT_NULL(test, s->dict.answers);
	KUNIT_EXPECT_EQ(test, ask(b, EC_SDO_INFO_OBJECT, 0x1018, 0, buf, &size, &sum), -EAGAIN);
	bus_request(b, 0, EC_AL_PREOP);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, 0, EC_AL_PREOP, 1000), ~0ull);
	KUNIT_EXPECT_EQ(test, ask(b, EC_SDO_INFO_OBJECT, 0x1018, 0, buf, &size, &sum), 0);
}

static void dict_small_buffer_and_unknown_question(struct kunit *test)
{
	struct ec_ioc_sdo_info i = { .what = EC_SDO_INFO_LIST, .index = 1, .size = 4 };
	struct bus *b = bus_up(test, text, 2);
	u64 sum = 0;
	size_t size;
	u8 buf[16];
	u8 *all = kunit_kzalloc(test, ROOM, GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, all);
	bus_idle(b);
	i.data = (uintptr_t)buf;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SDO_INFO, &i), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->dict.used, (size_t)0);
	KUNIT_EXPECT_EQ(test, ask(b, EC_SDO_INFO_LIST, 1, 0, all, &size, &sum), 0);
	i.size = 4;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SDO_INFO, &i), -ENOBUFS);
	i.what = 7;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SDO_INFO, &i), -EINVAL);
}

/* More questions than answers fit: each is answered, the memory has its limit. */
static void dict_memory_is_limited(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);
	struct ec_slave *s = bus_slave(b, 0);
	u64 sum = 0;
	u8 buf[64];
	size_t size;
	u32 i;

	bus_idle(b);
	for (i = 0; i < EC_MAX_DICT_BYTES / 16 + 10; i++)
		if (ask(b, EC_SDO_INFO_OBJECT, 0x8000 + i, 0, buf, &size, &sum) != -EIO)
			break;
	KUNIT_EXPECT_EQ(test, i, (u32)EC_MAX_DICT_BYTES / 16 + 10);
	KUNIT_EXPECT_EQ(test, s->dict.used, (size_t)EC_MAX_DICT_BYTES);
	KUNIT_EXPECT_EQ(test, s->dict.size, (size_t)EC_MAX_DICT_BYTES);
	KUNIT_EXPECT_EQ(test, ask(b, EC_SDO_INFO_OBJECT, 0x1018, 0, buf, &size, &sum), 0);
	KUNIT_EXPECT_EQ(test, s->dict.used, (size_t)EC_MAX_DICT_BYTES);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(dict_second_reading_has_no_frame),
	KUNIT_CASE(dict_forget_reads_again),
	KUNIT_CASE(dict_init_and_boot_forget),
	KUNIT_CASE(dict_small_buffer_and_unknown_question),
	KUNIT_CASE(dict_memory_is_limited),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_dict",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
