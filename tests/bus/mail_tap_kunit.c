// SPDX-License-Identifier: GPL-2.0-only
/* Readers of mailbox messages: what they get, and that nothing is kept without one. */
#include "talk.h"
#include "master/boundary/ioctl.h"
#include "master/mailbox/mail_tap.h"

static const char line[] =
	"segment seed=5 response=100us transition=1ms\n"
	"slave coupler EK1100\nslave a drive\n";

#define A	1
#define UPLOAD	0x40

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, line, 2);

	bus_idle(b);
	return b;
}

static struct ec_mail_tap *tap_of(const struct bus *b)
{
	return rcu_access_pointer(bus_base(b)->mail_tap);
}

/* an open file without rights to write */
static struct ec_file *file_new(struct bus *b)
{
	struct ec_file *f = kunit_kzalloc(b->test, sizeof(*f), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, f);
	ec_file_init(f, b->m, false);
	return f;
}

static struct ec_file *reader_new(struct bus *b, u64 *next)
{
	struct ec_ioc_mail arg = { .size = sizeof(struct ec_mail) };
	struct ec_file *f = file_new(b);

	KUNIT_ASSERT_EQ(b->test, ec_ioc(f, EC_IOC_MAIL, &arg), 0);
	KUNIT_ASSERT_NOT_NULL(b->test, f->reader);
	*next = arg.next;
	return f;
}

static bool next_mail(struct ec_file *f, struct ec_mail *m)
{
	u64 at = f->reader->at;
	bool got = ec_mail_tap_get(f->reader->source, &at, m);

	f->reader->at = at;
	return got;
}

static u32 rest_of(struct ec_file *f)
{
	struct ec_mail m;
	u32 n = 0;

	while (next_mail(f, &m))
		n++;
	return n;
}

/* the message at @m is of an SDO service, and has this command and object */
static void expect_sdo(struct kunit *test, const struct ec_mail *m, u8 service, u8 cmd, u16 index)
{
	struct ec_rbuf r = ec_rbuf(m->data, m->kept);
	struct ec_mbox_hdr h;

	KUNIT_EXPECT_EQ(test, m->size, m->kept);
	KUNIT_ASSERT_EQ(test, ec_mbox_hdr_decode(&r, &h), 0);
	KUNIT_EXPECT_EQ(test, h.type, (u8)EC_MBOX_COE);
	KUNIT_EXPECT_EQ(test, h.len, m->size - EC_MBOX_HDR);
	KUNIT_EXPECT_EQ(test, m->data[7] >> 4, service);
	KUNIT_EXPECT_EQ(test, m->data[8] & 0xe0, cmd);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(m->data + 9), index);
}

static void mail_tap_without_reader_is_absent(struct kunit *test)
{
	struct bus *b = ready(test);
	struct talk *t = talk_new(b, A, 1000);

	KUNIT_EXPECT_EQ(test, talk_upload(t, 0x1018, 4, false), 0);
	KUNIT_EXPECT_NULL(test, tap_of(b));
}

static void mail_tap_reader_gets_request_and_response(struct kunit *test)
{
	struct bus *b = ready(test);
	struct talk *t = talk_new(b, A, 1000);
	struct ec_mail q, a, none;
	struct ec_file *f;
	u64 next;

	f = reader_new(b, &next);
	KUNIT_EXPECT_FALSE(test, next_mail(f, &q));
	KUNIT_EXPECT_EQ(test, talk_upload(t, 0x1018, 4, false), 0);
	KUNIT_ASSERT_TRUE(test, next_mail(f, &q));
	KUNIT_ASSERT_TRUE(test, next_mail(f, &a));
	KUNIT_EXPECT_FALSE(test, next_mail(f, &none));
	KUNIT_EXPECT_EQ(test, q.number, next);
	KUNIT_EXPECT_EQ(test, q.flags, (u32)EC_MAIL_TO_SLAVE);
	KUNIT_EXPECT_EQ(test, q.station, bus_slave(b, A)->station);
	KUNIT_EXPECT_EQ(test, q.missed, 0ull);
	expect_sdo(test, &q, EC_COE_SDO_REQ, UPLOAD, 0x1018);
	KUNIT_EXPECT_EQ(test, a.number, next + 1);
	KUNIT_EXPECT_EQ(test, a.flags, 0u);
	KUNIT_EXPECT_EQ(test, a.station, q.station);
	expect_sdo(test, &a, EC_COE_SDO_RESP, UPLOAD, 0x1018);
	/* the slave takes 100 us */
	KUNIT_EXPECT_GE(test, a.time_ns - q.time_ns, 100000ull);
	KUNIT_EXPECT_LT(test, a.time_ns - q.time_ns, 20000000ull);
	ec_reader_end(f);
}

static void mail_tap_readers_take_nothing_from_others(struct kunit *test)
{
	struct bus *b = ready(test);
	struct talk *t = talk_new(b, A, 1000);
	struct ec_file *one, *two, *three;
	u64 first, second, third;

	one = reader_new(b, &first);
	KUNIT_EXPECT_EQ(test, talk_upload(t, 0x1018, 4, false), 0);
	two = reader_new(b, &second);
	KUNIT_EXPECT_EQ(test, second, first + 2);
	KUNIT_EXPECT_EQ(test, talk_upload(t, 0x1018, 4, false), 0);
	KUNIT_EXPECT_EQ(test, rest_of(one), 4u);
	KUNIT_EXPECT_EQ(test, rest_of(two), 2u);
	ec_reader_end(one);
	KUNIT_EXPECT_NOT_NULL(test, tap_of(b));
	KUNIT_EXPECT_EQ(test, talk_upload(t, 0x1018, 4, false), 0);
	KUNIT_EXPECT_EQ(test, rest_of(two), 2u);
	ec_reader_end(two);
	KUNIT_EXPECT_NULL(test, tap_of(b));
	KUNIT_EXPECT_EQ(test, talk_upload(t, 0x1018, 4, false), 0);
	/* numbers are not reused */
	three = reader_new(b, &third);
	KUNIT_EXPECT_EQ(test, third, first + 6);
	KUNIT_EXPECT_EQ(test, rest_of(three), 0u);
	ec_reader_end(three);
}

static void mail_tap_slow_reader_gets_exact_number(struct kunit *test)
{
	struct bus *b = ready(test);
	u8 bytes[EC_MAIL_DATA + 10] = { 0 };
	struct ec_mail m;
	struct ec_file *f;
	u64 next;
	u32 i;

	f = reader_new(b, &next);
	for (i = 0; i < EC_MAILS_KEPT + 77; i++) {
		bytes[0] = (u8)i;
		ec_mail_tap_put(bus_base(b), 1, 0, bytes, sizeof(bytes));
	}
	KUNIT_ASSERT_TRUE(test, next_mail(f, &m));
	KUNIT_EXPECT_EQ(test, m.missed, 77ull);
	KUNIT_EXPECT_EQ(test, m.number, next + 77);
	KUNIT_EXPECT_EQ(test, m.data[0], (u8)77);
	KUNIT_EXPECT_EQ(test, m.size, (u16)sizeof(bytes));
	KUNIT_EXPECT_EQ(test, m.kept, (u16)EC_MAIL_DATA);
	KUNIT_ASSERT_TRUE(test, next_mail(f, &m));
	KUNIT_EXPECT_EQ(test, m.missed, 0ull);
	KUNIT_EXPECT_EQ(test, rest_of(f), (u32)EC_MAILS_KEPT - 2);
	ec_reader_end(f);
}

static void mail_tap_file_reads_one_thing(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_mail arg = { .size = sizeof(struct ec_mail) };
	struct ec_ioc_mail wrong = { .size = sizeof(struct ec_mail) - 8 };
	struct ec_ioc_mail flag = { .size = sizeof(struct ec_mail), .flags = 1 };
	struct ec_ioc_events events = { .size = sizeof(struct ec_event) };
	struct ec_file *f = file_new(b), *g;
	u64 next;

	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_MAIL, &wrong), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_MAIL, &flag), -EOPNOTSUPP);
	KUNIT_EXPECT_NULL(test, tap_of(b));
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_EVENTS, &events), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(f, EC_IOC_MAIL, &arg), -EBUSY);
	g = reader_new(b, &next);
	KUNIT_EXPECT_EQ(test, ec_ioc(g, EC_IOC_MAIL, &arg), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_ioc(g, EC_IOC_EVENTS, &events), -EBUSY);
	ec_reader_end(g);
	ec_reader_end(f);
	KUNIT_EXPECT_NULL(test, tap_of(b));
}

static struct kunit_case mail_tap_cases[] = {
	KUNIT_CASE(mail_tap_without_reader_is_absent),
	KUNIT_CASE(mail_tap_reader_gets_request_and_response),
	KUNIT_CASE(mail_tap_readers_take_nothing_from_others),
	KUNIT_CASE(mail_tap_slow_reader_gets_exact_number),
	KUNIT_CASE(mail_tap_file_reads_one_thing),
	{}
};

static struct kunit_suite mail_tap_suite = {
	.name = "bus_mail_tap",
	.exit = bus_exit,
	.test_cases = mail_tap_cases,
};

kunit_test_suites(&mail_tap_suite);
