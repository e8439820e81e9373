// SPDX-License-Identifier: GPL-2.0-only
/* Somebody who reads objects, and somebody who writes and reads files, beside random events. */
#include <linux/kthread.h>
#include "random.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/foe.h"
#include "master/mailbox/mailbox.h"

#define FILE_BYTES	2000u

static int fill(void *ctx, u64 at, u8 *buf, size_t n)
{
	memset(buf, 0x5a, n);
	return 0;
}

static int take(void *ctx, u64 at, u8 *buf, size_t n)
{
	return memchr_inv(buf, 0x5a, n) ? -EBADMSG : 0;
}

static int one_file(struct ec_slave *s, bool write)
{
	struct ec_foe_file file = {
		.size = FILE_BYTES, .copy = write ? fill : take,
	};
	struct ec_foe f = { .write = write, .name = "data", .name_len = 4 };

	return ec_foe_transfer(&s->mbox, &f, &file, NULL);
}

static int one_object(struct ec_slave *s)
{
	size_t got;
	u32 abort;
	u8 v[4];

	return ec_coe_upload(&s->mbox, 0x1018, 1, false, v, sizeof(v), &got, &abort, NULL);
}

static int work(void *arg)
{
	struct random_user *u = arg;

	for (;;) {
		wait_for_completion(&u->go);
		if (!u->slave)
			break;
		if (!u->file)
			u->ret = one_object(u->slave);
		else
			u->ret = one_file(u->slave, true) ?: one_file(u->slave, false);
		WRITE_ONCE(u->idle, true);
	}
	while (!kthread_should_stop())
		msleep(20);
	return 0;
}

/* A transfer may take so long that the slave is well again at its end. */
static void notice(struct random_run *r, struct random_user *u)
{
	const struct random_slave *s = &r->s[u->index];

	u->was_cut |= s->slave != u->slave || s->well < u->since;
	u->since = s->well;
}

static void count(struct random_run *r, struct random_user *u)
{
	if (!u->ret)
		u->good++;
	else if (u->was_cut)
		u->cut++;
	else if (u->bad++ < 5)
		pr_info("# bad: %s of slave %u: %d, %llu ns\n", u->file ? "file" : "object",
			u->index, u->ret, ktime_get_ns());
	ec_slave_unref(u->slave);
	u->slave = NULL;
}

static void begin(struct random_run *r, struct random_user *u, u64 now)
{
	u32 i = random_below(r, r->n), n;

	for (n = 0; n < r->n && !(r->s[i].mailbox && random_entitled(&r->s[i])); n++)
		i = (i + 1) % r->n;
	u->next_ns = now + 1000000ull * random_below(r, u->file ? 400 : 50);
	if (n == r->n)
		return;
	u->index = i;
	u->since = r->s[i].well;
	u->was_cut = false;
	u->slave = ec_slave_ref(r->s[i].slave);
	u->idle = false;
	complete(&u->go);
}

/**
 * random_users_turn() - count what has ended, and begin anew
 * @r: run
 * @now: time
 */
void random_users_turn(struct random_run *r, u64 now)
{
	u32 k;

	for (k = 0; k < ARRAY_SIZE(r->user); k++) {
		struct random_user *u = &r->user[k];

		if (u->slave)
			notice(r, u);
		if (!u->task || !READ_ONCE(u->idle))
			continue;
		if (u->slave)
			count(r, u);
		if (now >= u->next_ns)
			begin(r, u, now);
	}
}

void random_users_begin(struct random_run *r)
{
	u32 k;

	for (k = 0; k < ARRAY_SIZE(r->user); k++) {
		struct random_user *u = &r->user[k];

		init_completion(&u->go);
		u->idle = true;
		u->next_ns = 0;	/* of a run that has ended before: never */
		u->file = k;
		u->task = kthread_run(work, u, "ec_user%u", k);
		KUNIT_ASSERT_FALSE(r->b->test, IS_ERR(u->task));
	}
}

/**
 * random_users_end() - what is going on ends, and the threads
 * @r: run, whose application runs its cycle
 */
void random_users_end(struct random_run *r)
{
	u32 k;

	for (k = 0; k < ARRAY_SIZE(r->user); k++) {
		struct random_user *u = &r->user[k];

		u->next_ns = ~0ull;
		while (!READ_ONCE(u->idle) || u->slave)
			cyc_run(r->c, 1);
		complete(&u->go);
		kthread_stop(u->task);
		u->task = NULL;
	}
}
