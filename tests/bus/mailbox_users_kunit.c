// SPDX-License-Identifier: GPL-2.0-only
/* Users of a mailbox that are no thread, and claims that belong to an owner. */
#include <linux/kthread.h>
#include "bus.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/mailbox.h"

#define MESSAGES	20
#define ANSWER		10	/* bytes of an expedited SDO upload response */

static const char text[] =
	"segment seed=52 response=100us transition=200us\n"
	"slave a drive in=8 out=8 mbox=128 serial=11\n";

/* CoE header, upload request of 0x1018:04 */
static const u8 upload[ANSWER] = { 0x00, 0x20, 0x40, 0x18, 0x10, 0x04 };

/* it acts in done() alone, as a network device would */
struct actor {
	struct ec_mbox_user user;
	u8 rx[EC_MBOX_MAX];
	u32 done;
	u32 wrong;
	bool refused;
	int err;
};

static void actor_done(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	struct actor *d = container_of(u, struct actor, user);

	lockdep_assert_held(&mb->box.lock);
	d->done++;
	d->wrong += !irqs_disabled();
	d->err = u->err;
	if (u->err)
		d->refused = !ec_desk_again(mb, u);
	else if (u->got != ANSWER || get_unaligned_le32(d->rx + 6) != 11)
		d->wrong++;
	else if (d->done < MESSAGES)
		ec_desk_again(mb, u);
}

static struct actor *actor_new(struct bus *b)
{
	struct actor *d = kunit_kzalloc(b->test, sizeof(*d), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, d);
	KUNIT_ASSERT_EQ(b->test, ec_box_get_memory(&bus_mbox(b, 0)->box), 0);
	d->user = (struct ec_mbox_user){
		.done = actor_done, .type = EC_MBOX_COE, .answer = true, .tx = upload,
		.len = sizeof(upload), .rx = d->rx,
	};
	return d;
}

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 1);

	bus_idle(b);
	return b;
}

static int serial(struct bus *b, u32 *value)
{
	const struct ec_mbox_limit limit = { .timeout_ms = 300 };
	size_t got;
	u32 abort;
	u8 v[4] = { 0 };
	int ret = ec_coe_upload(bus_mbox(b, 0), 0x1018, 4, false, v, sizeof(v), &got, &abort,
				&limit);

	*value = get_unaligned_le32(v);
	return ret;
}

/* Each message is sent from the end of the one before. */
static void users_go_on_without_thread(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct ec_claim claim = { 0 };
	struct actor *d = actor_new(b);
	u32 i, value;

	KUNIT_ASSERT_EQ(test, ec_mbox_claim(mb, &claim, BIT(EC_MBOX_COE), 1000), 0);
	ec_desk_enter(mb, &d->user);
	for (i = 0; i < 1000 && READ_ONCE(d->done) < MESSAGES; i++)
		usleep_range(1000, 1001);
	ec_desk_leave(mb, &d->user, true);
	ec_mbox_unclaim(mb, &claim);
	KUNIT_EXPECT_EQ(test, d->done, (u32)MESSAGES);
	KUNIT_EXPECT_EQ(test, d->wrong, 0u);
	KUNIT_EXPECT_FALSE(test, ec_mbox_in_use(mb));
	KUNIT_EXPECT_EQ(test, serial(b, &value), 0);
	KUNIT_EXPECT_EQ(test, value, 11u);
}

/* done() is not called any more, wherever the message was. */
static void users_leave_at_any_time(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct ec_claim claim = { 0 };
	struct actor *d = actor_new(b);
	u32 us, done, value, early = 0;

	for (us = 0; us < 400; us += 7) {
		KUNIT_ASSERT_EQ(test, ec_mbox_claim(mb, &claim, BIT(EC_MBOX_COE), 1000), 0);
		d->done = MESSAGES;
		d->user.first = true;
		ec_desk_enter(mb, &d->user);
		usleep_range(us, us + 1);
		ec_desk_leave(mb, &d->user, false);
		done = d->done;
		early += done == MESSAGES;
		d->user.rx = NULL;
		msleep(1);
		KUNIT_EXPECT_EQ(test, d->done, done);
		d->user.rx = d->rx;
		ec_mbox_unclaim(mb, &claim);
		KUNIT_ASSERT_EQ(test, serial(b, &value), 0);
		KUNIT_ASSERT_EQ(test, value, 11u);
	}
	KUNIT_EXPECT_GT(test, early, 0u);
	KUNIT_EXPECT_EQ(test, d->wrong, 0u);
}

static void users_with_error_have_to_leave(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct ec_claim claim = { 0 };
	struct actor *d = actor_new(b);

	KUNIT_ASSERT_EQ(test, ec_mbox_claim(mb, &claim, BIT(EC_MBOX_COE), 1000), 0);
	d->user.len = EC_MBOX_MAX;
	ec_desk_enter(mb, &d->user);
	msleep(10);
	ec_desk_leave(mb, &d->user, false);
	ec_mbox_unclaim(mb, &claim);
	KUNIT_EXPECT_EQ(test, d->done, 1u);
	KUNIT_EXPECT_EQ(test, d->err, -EMSGSIZE);
	KUNIT_EXPECT_TRUE(test, d->refused);
}

/* a claim that counts */
struct file_claim {
	struct ec_claim claim;
	u32 done;
};

static void count_done(struct ec_mbox *mb, struct ec_claim *c)
{
	container_of(c, struct file_claim, claim)->done++;
}

/* Two open files: what one of them holds or waits for is over when it is closed. */
static void claims_end_with_their_owner(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_mbox *mb = bus_mbox(b, 0);
	int file[2];
	struct file_claim held = { .claim = { .owner = &file[0], .done = count_done } };
	struct file_claim other = { .claim = { .owner = &file[1], .done = count_done } };
	struct file_claim again = { .claim = { .owner = &file[0], .done = count_done } };
	u32 value;

	ec_claim_begin(mb, &held.claim, BIT(EC_MBOX_COE), false);
	ec_claim_begin(mb, &other.claim, BIT(EC_MBOX_COE) | BIT(EC_MBOX_FOE), false);
	ec_claim_begin(mb, &again.claim, BIT(EC_MBOX_FOE), false);
	KUNIT_EXPECT_EQ(test, held.claim.state, EC_CLAIM_HELD);
	KUNIT_EXPECT_EQ(test, other.claim.state, EC_CLAIM_WAITING);
	KUNIT_EXPECT_EQ(test, again.claim.state, EC_CLAIM_WAITING);
	ec_mbox_release_owner(mb, &file[0]);
	KUNIT_EXPECT_EQ(test, held.claim.state, EC_CLAIM_IDLE);
	KUNIT_EXPECT_EQ(test, other.claim.state, EC_CLAIM_HELD);
	KUNIT_EXPECT_EQ(test, again.claim.state, EC_CLAIM_IDLE);
	KUNIT_EXPECT_EQ(test, held.done, 1u);
	KUNIT_EXPECT_EQ(test, other.done, 1u);
	KUNIT_EXPECT_EQ(test, again.done, 1u);
	KUNIT_EXPECT_TRUE(test, ec_mbox_is_claimed(mb, BIT(EC_MBOX_FOE)));
	/* what is over takes nothing from the other */
	ec_mbox_unclaim(mb, &held.claim);
	ec_mbox_unclaim(mb, &again.claim);
	KUNIT_EXPECT_TRUE(test, ec_mbox_is_claimed(mb, BIT(EC_MBOX_COE)));
	ec_mbox_release_owner(mb, &file[1]);
	KUNIT_EXPECT_FALSE(test, ec_mbox_is_claimed(mb, EC_MBOX_ALL));
	KUNIT_EXPECT_EQ(test, serial(b, &value), 0);
}

/* a thread that waits for a protocol in the name of a file */
struct sleeper {
	struct ec_mbox *mb;
	struct ec_claim claim;
	struct completion end;
	int ret;
};

static int sleep_for_claim(void *arg)
{
	struct sleeper *s = arg;

	s->ret = ec_mbox_claim(s->mb, &s->claim, BIT(EC_MBOX_COE), 5000);
	complete(&s->end);
	return 0;
}

static void claims_of_sleeping_callers_end_too(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_mbox *mb = bus_mbox(b, 0);
	struct sleeper *s = kunit_kzalloc(test, sizeof(*s), GFP_KERNEL);
	struct ec_claim held = { 0 };
	u64 t0;

	KUNIT_ASSERT_NOT_NULL(test, s);
	s->mb = mb;
	s->claim.owner = s;
	init_completion(&s->end);
	KUNIT_ASSERT_EQ(test, ec_mbox_claim(mb, &held, BIT(EC_MBOX_COE), 1000), 0);
	KUNIT_ASSERT_FALSE(test, IS_ERR(kthread_run(sleep_for_claim, s, "sleeper")));
	msleep(50);
	KUNIT_EXPECT_FALSE(test, completion_done(&s->end));
	t0 = ktime_get_ns();
	ec_mbox_release_owner(mb, s);
	wait_for_completion(&s->end);
	KUNIT_EXPECT_EQ(test, s->ret, -ECANCELED);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, 25 * (u64)NSEC_PER_MSEC);
	KUNIT_EXPECT_TRUE(test, ec_mbox_is_claimed(mb, BIT(EC_MBOX_COE)));
	ec_mbox_unclaim(mb, &held);
	KUNIT_EXPECT_FALSE(test, ec_mbox_is_claimed(mb, EC_MBOX_ALL));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(users_go_on_without_thread),
	KUNIT_CASE(users_leave_at_any_time),
	KUNIT_CASE(users_with_error_have_to_leave),
	KUNIT_CASE(claims_end_with_their_owner),
	KUNIT_CASE(claims_of_sleeping_callers_end_too),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_mailbox_users",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
