// SPDX-License-Identifier: GPL-2.0-only
/* Requests that wait for a mailbox protocol which another caller uses. */
#include "req.h"
#include "devices/sim/app.h"
#include "master/boundary/ioctl.h"

static const char text[] =
	"segment seed=8 response=100us transition=200us\n"
	"slave a drive mbox=128 serial=11 soe=2 foe=64\n";

#define USED	(BIT(EC_MBOX_COE) | BIT(EC_MBOX_SOE) | BIT(EC_MBOX_FOE))
#define LIMIT_MS	100
#define SPEED	91	/* S-0-0091 */

/* one request of each kind that waits for a protocol */
static const struct {
	u32 kind;
	u16 index;
	u8 sub;
	u32 flags;
} kinds[] = {
	{ EC_REQUEST_SDO, 0x1018, 4, 0 },
	{ EC_REQUEST_SOE, SPEED, 0, 0 },
	{ EC_REQUEST_FOE, 0, 0, 0 },
	{ EC_REQUEST_SDO_INFO, 0x1018, 0, EC_SDO_INFO_OBJECT },
};

static struct cyc *prepare(struct bus *b, u32 r[])
{
	struct cyc *c;
	u32 i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	for (i = 0; i < ARRAY_SIZE(kinds); i++)
		r[i] = req_add(c, 0, kinds[i].kind, 128);
	return c;
}

static void go(struct cyc *c)
{
	u32 i;

	cyc_activate(c);
	for (i = 0; i < 5000 && bus_slave(c->b, 0)->al.status != EC_AL_OP; i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_EQ(c->b->test, bus_slave(c->b, 0)->al.status, EC_AL_OP);
}

static void begin(struct cyc *c, u32 r, u32 i)
{
	if (kinds[i].kind == EC_REQUEST_FOE)
		strscpy((char *)req_data(c, r) - EC_FOE_NAME, "data", EC_FOE_NAME);
	req_rec(c, r)->flags = kinds[i].flags;
	req_begin(c, r, kinds[i].index, kinds[i].sub, false, 0);
}

/* The other caller keeps all protocols; registers need none. */
static void turn_of_request_is_waited_for_in_time(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 1);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct ec_claim claim = { 0 };
	u32 r[ARRAY_SIZE(kinds)], reg, i;
	struct cyc *c = prepare(b, r);
	u64 t0, ms;

	reg = req_add(c, 0, EC_REQUEST_REG, 2);
	go(c);
	for (i = 0; i < ARRAY_SIZE(kinds); i++) {
		KUNIT_ASSERT_EQ(test, ec_mbox_claim(mb, &claim, USED, 1000), 0);
		t0 = ktime_get_ns();
		req_rec(c, r[i])->timeout_ms = LIMIT_MS;
		begin(c, r[i], i);
		KUNIT_EXPECT_EQ(test, req_end(c, r[i], 1000), -ETIMEDOUT);
		ms = div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
		KUNIT_EXPECT_GE(test, ms, (u64)LIMIT_MS);
		KUNIT_EXPECT_LE(test, ms, LIMIT_MS + 30ull);
		KUNIT_EXPECT_EQ(test, req_do(c, reg, EC_REG_STATION, 0, false, 2), 0);
		ec_mbox_unclaim(mb, &claim);
	}
	begin(c, r[0], 0);
	KUNIT_EXPECT_EQ(test, req_end(c, r[0], 1000), 0);
}

static void turn_of_request_ends_when_cancelled(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 1);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct ec_claim claim = { 0 };
	u32 r[ARRAY_SIZE(kinds)], i;
	struct cyc *c = prepare(b, r);

	go(c);
	KUNIT_ASSERT_EQ(test, ec_mbox_claim(mb, &claim, USED, 1000), 0);
	for (i = 0; i < ARRAY_SIZE(kinds); i++) {
		begin(c, r[i], i);
		KUNIT_EXPECT_EQ(test, req_end(c, r[i], 300), 1);
		req_rec(c, r[i])->cancel = req_rec(c, r[i])->start;
		c->flags = EC_SEND_FLAG_REQUESTS;
		KUNIT_EXPECT_EQ(test, req_end(c, r[i], 50), -ECANCELED);
		c->flags = 0;
	}
	KUNIT_EXPECT_TRUE(test, list_empty(&mb->desk.claims));
	ec_mbox_unclaim(mb, &claim);
}

/* What has waited does not claim a protocol later, in the middle of another session. */
static void turn_of_request_ends_with_session(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 1);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct ec_claim claim = { 0 };
	u32 r[ARRAY_SIZE(kinds)], i;
	struct cyc *c = prepare(b, r);

	go(c);
	KUNIT_ASSERT_EQ(test, ec_mbox_claim(mb, &claim, USED, 1000), 0);
	/* files have a queue of their own */
	begin(c, r[0], 0);
	begin(c, r[2], 2);
	cyc_run(c, 10);
	KUNIT_ASSERT_FALSE(test, list_empty(&mb->desk.claims));
	bus_end(b);
	/* the slave's worker waits as well, until the protocols are free */
	for (i = 0; i < 50 && mb->desk.claims.next != mb->desk.claims.prev; i++)
		usleep_range(1000, 1001);
	KUNIT_EXPECT_PTR_EQ(test, mb->desk.claims.next, mb->desk.claims.prev);
	ec_mbox_unclaim(mb, &claim);
	KUNIT_EXPECT_NE(test, bus_wait(b, 1, EC_AL_PREOP, 5000), ~0ull);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(turn_of_request_is_waited_for_in_time),
	KUNIT_CASE(turn_of_request_ends_when_cancelled),
	KUNIT_CASE(turn_of_request_ends_with_session),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_request_turn",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
