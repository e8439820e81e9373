// SPDX-License-Identifier: GPL-2.0-only
/* Beginning, requests and misfortunes of a cycle the kernel runs. */
#include <linux/completion.h>
#include <linux/kthread.h>
#include <linux/poll.h>
#include "kcyc.h"
#include "devices/sim/app.h"
#include "master/link/device.h"

/* Cycles pass, but no process data are sent before there are outputs. */
static void life_waits_for_outputs(struct kunit *test)
{
	struct bus *b = kcyc_bus(test);
	struct kcyc *a = kcyc_configure(b, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_WAIT });
	u64 sends;

	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	kcyc_wait_cycles(a, 500);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_WAITING);
	sends = bus_sends(b);
	KUNIT_EXPECT_EQ(test, sends, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->missed, 0ull);
	KUNIT_EXPECT_EQ(test, bus_timeouts(b), 0u);
	/* meanwhile everybody may use the bus */
	KUNIT_EXPECT_EQ(test, bus_access_mode(b), (int)EC_ACCESS_DIRECT);
	KUNIT_EXPECT_FALSE(test, cyc_all_op(a->c));
	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 2);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_RUNNING);
	KUNIT_EXPECT_GE(test, bus_sends(b), 1ull);
	kcyc_until_op(a);
	kcyc_wait_cycles(a, 5);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* One that never gives any ends as any other. */
static void kcyc_detach_without_outputs(struct kunit *test)
{
	struct bus *b = kcyc_bus(test);
	struct kcyc *a = kcyc_configure(b, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_ALL });

	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	kcyc_wait_cycles(a, 20);
	bus_end(b);
	a = kcyc_configure(b, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_ALL });
	KUNIT_ASSERT_EQ(test, kcyc_activate(a), 0);
	KUNIT_EXPECT_TRUE(test, a->taken_over);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_WAITING);
	bus_end(b);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
}

/* poll() sees inputs that were not taken, once. */
static void life_poll(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_file *f = &a->c->b->app;
	u32 i;

	for (i = 0; i < 100; i++) {
		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
		KUNIT_EXPECT_EQ(test, ec_file_poll(f, NULL, NULL), EPOLLIN | EPOLLRDNORM);
		KUNIT_EXPECT_NOT_NULL(test, kcyc_take(a));
		KUNIT_EXPECT_EQ(test, ec_file_poll(f, NULL, NULL), 0u);
	}
}

/* more entries of poll() than one file may have */
#define ENTRIES	(EC_MAX_WAITERS + 5)

struct entries {
	poll_table table;
	struct wait_queue_entry entry[ENTRIES];
	wait_queue_head_t *wq[ENTRIES];
	u32 n;
	u32 woken;
};

static struct entries entries;

static int woken(struct wait_queue_entry *entry, unsigned int mode, int flags, void *key)
{
	entries.woken++;
	return 0;
}

/* what epoll does: an entry that stays */
static void add_entry(struct file *filp, wait_queue_head_t *wq, poll_table *table)
{
	struct entries *e = container_of(table, struct entries, table);

	init_waitqueue_func_entry(&e->entry[e->n], woken);
	add_wait_queue(wq, &e->entry[e->n]);
	e->wq[e->n++] = wq;
}

static void remove_entries(void)
{
	while (entries.n--)
		remove_wait_queue(entries.wq[entries.n], &entries.entry[entries.n]);
	memset(&entries, 0, sizeof(entries));
}

/* poll_wait() reads the file only to see that there is one */
#define FILE	((struct file *)&entries)

/* A file that does not own the cycle adds nothing to it. */
static void life_poll_of_others(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_ioc_wait w = { 0 };
	struct ec_file other = { 0 };
	u32 i;

	ec_file_init(&other, a->c->b->m, false);
	init_poll_funcptr(&entries.table, add_entry);
	for (i = 0; i < ENTRIES; i++)
		KUNIT_EXPECT_EQ(test, ec_file_poll(&other, FILE, &entries.table), EPOLLERR);
	kcyc_wait_cycles(a, 100);
	KUNIT_EXPECT_EQ(test, entries.woken, 0u);
	remove_entries();
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_WAIT, &w), -EPERM);
}

/* Its owner adds a bounded number of entries, and each is woken in each cycle. */
static void life_poll_is_bounded(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_file *f = &a->c->b->app;
	u32 i;

	init_poll_funcptr(&entries.table, add_entry);
	for (i = 0; i < ENTRIES; i++)
		KUNIT_EXPECT_EQ(test, !!(ec_file_poll(f, FILE, &entries.table) & EPOLLERR),
				i >= EC_MAX_WAITERS);
	KUNIT_EXPECT_EQ(test, entries.n, (u32)EC_MAX_WAITERS);
	kcyc_wait_cycles(a, 10);
	KUNIT_EXPECT_GE(test, entries.woken, 9u * EC_MAX_WAITERS);
	remove_entries();
	KUNIT_EXPECT_FALSE(test, ec_file_poll(f, NULL, NULL) & EPOLLERR);
}

/* The session ends under entries of poll(): they are woken, then all see an error. */
static void life_poll_outlives_session(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct bus *b = a->c->b;

	init_poll_funcptr(&entries.table, add_entry);
	KUNIT_EXPECT_FALSE(test, ec_file_poll(&b->app, FILE, &entries.table) & EPOLLERR);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
	KUNIT_EXPECT_GE(test, entries.woken, 1u);
	KUNIT_EXPECT_EQ(test, ec_file_poll(&b->app, NULL, NULL), EPOLLERR);
	remove_entries();
}

static struct bus *asked;
static __poll_t said[2];
static int received;

static int ask(void *data)
{
	struct ec_file other = { 0 };

	ec_file_init(&other, asked->m, false);
	said[0] = ec_file_poll(&asked->app, NULL, NULL);
	said[1] = ec_file_poll(&other, NULL, NULL);
	received = ec_ioc_receive(&other);
	complete(data);
	return 0;
}

/* poll() and a foreign receive take no lock of the cycle: they end while it is held. */
static void life_poll_without_lock(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	DECLARE_COMPLETION_ONSTACK(over);
	struct task_struct *task = kthread_create(ask, &over, "ask");
	bool ended;

	KUNIT_ASSERT_FALSE(test, IS_ERR(task));
	asked = a->c->b;
	mutex_lock(&bus_cycles(asked)->lock);
	wake_up_process(task);
	ended = wait_for_completion_timeout(&over, msecs_to_jiffies(1000));
	mutex_unlock(&bus_cycles(asked)->lock);
	KUNIT_EXPECT_TRUE(test, ended);
	if (!ended)
		wait_for_completion(&over);
	KUNIT_EXPECT_EQ(test, said[0] & EPOLLERR, 0u);
	KUNIT_EXPECT_EQ(test, said[1], EPOLLERR);
	KUNIT_EXPECT_EQ(test, received, -EPERM);
}

/* The device goes away: cycles go on, with nothing in them; nothing is freed early. */
static void life_without_device(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_DETACH });
	struct bus *b = a->c->b;
	struct ec_exchange_buffer *x;
	u64 cycle;

	kcyc_wait_cycles(a, 10);
	KUNIT_EXPECT_EQ(test, kcyc_shared(a)->status->no_device, 0u);
	bus_no_device(b);
	cycle = kcyc_status(a)->cycle;
	a->seen = cycle;
	kcyc_wait_cycles(a, 500);
	x = kcyc_take(a);
	KUNIT_ASSERT_NOT_NULL(test, x);
	KUNIT_EXPECT_EQ(test, x->domains[0].working_counter, 0u);
	KUNIT_EXPECT_EQ(test, x->domains[0].wc_state, 0u);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_shared(a)->status->no_device, 1u);
	bus_end(b);
	msleep(100);
	/* without a device nobody can reserve it, but end it */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), -ENODEV);
	KUNIT_EXPECT_GE(test, kcyc_status(a)->cycle, cycle + 590);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
}

static const struct ecdev_ops *real_ops;
static struct bus *victim;
static u32 times;

/* What a withdrawal on another CPU does first, while a frame of the cycle is sent. */
static int gone_tx_send(void *priv, u8 *buf, size_t len)
{
	int ret = real_ops->tx_send(priv, buf, len);

	/* somebody's frame is to go after those of the cycle */
	if (!times && bus_access_mode(victim) == EC_ACCESS_CYCLIC && bus_queued(victim)) {
		bus_set_dev(victim, NULL);
		times++;
	}
	return ret;
}

static void life_device_gone_in_send(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_DETACH });
	struct bus *b = a->c->b;
	struct ecdev *dev = bus_dev(b);
	struct ecdev_ops ops = *dev->ops;
	u32 i;

	real_ops = dev->ops;
	victim = b;
	times = 0;
	ops.tx_send = gone_tx_send;
	dev->ops = &ops;
	for (i = 0; i < 1000 && !times; i++) {
		/* its worker reads the AL status */
		ec_slave_kick(bus_slave(b, 0));
		kcyc_wait_cycles(a, 1);
	}
	KUNIT_EXPECT_EQ(test, times, 1u);
	dev->ops = real_ops;
	kcyc_wait_cycles(a, 10);
	KUNIT_EXPECT_EQ(test, kcyc_shared(a)->status->no_device, 1u);
	bus_set_dev(b, dev);
	kcyc_until_op(a);
}

/* requests and emergencies --------------------------------------------------*/

static const char drive[] = "segment seed=8 response=500us transition=200us\n"
			    "slave a drive mbox=64 serial=11\n";

/* A drive with an SDO request and room for emergencies. */
static struct kcyc *with_request(struct bus *b)
{
	struct kcyc *a = kunit_kzalloc(b->test, sizeof(*a), GFP_KERNEL);
	struct ec_ioc_cycle cfg = {
		.flags = EC_CYCLE_FLAG_DETACH, .period_ns = KCYC_PERIOD_NS, .cpu = -1,
	};
	struct ec_ioc_sc_request r = { .kind = EC_REQUEST_SDO, .size = 4 };
	struct ec_ioc_sc_emerg e = { .count = 8 };

	KUNIT_ASSERT_NOT_NULL(b->test, a);
	a->c = cyc_new(b, 1000);
	cyc_domain(a->c);
	cyc_map_all(a->c, 0, 1, 0);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_REQUEST, &r), 0);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_EMERG, &e), 0);
	KUNIT_ASSERT_EQ_MSG(b->test, kcyc_activate(a), 0, "%s", b->app.reason);
	return a;
}

static struct ec_request_area *area(struct kcyc *a)
{
	return (void *)kcyc_shared(a)->requests;
}

static struct ec_request_record *record(struct kcyc *a)
{
	return (struct ec_request_record *)((u8 *)area(a) + area(a)->requests);
}

/* what the library does: no system call */
static void begin(struct kcyc *a, u16 index, u8 sub)
{
	struct ec_request_record *r = record(a);

	r->index = index;
	r->subindex = sub;
	r->op = EC_REQUEST_OP_READ;
	smp_store_release(&r->start, r->start + 1);
	smp_store_release(&area(a)->starts, area(a)->starts + 1);
}

static bool over(struct kcyc *a)
{
	u32 i;

	for (i = 0; i < 2000 && smp_load_acquire(&record(a)->done) != record(a)->start; i++)
		KUNIT_ASSERT_EQ(a->c->b->test, kcyc_wait(a, 0), 0);
	return i < 2000;
}

static u32 value(struct kcyc *a)
{
	return get_unaligned_le32((u8 *)area(a) + record(a)->data);
}

static void life_requests(struct kunit *test)
{
	struct bus *b = bus_up(test, drive, 1);
	const u8 five[5] = { 0 };
	struct ec_emerg_ring *ring;
	struct kcyc *a;
	u32 i;

	bus_idle(b);
	a = with_request(b);
	kcyc_until_op(a);
	for (i = 1; i <= 3; i++) {
		begin(a, 0x1018, 4);
		KUNIT_ASSERT_TRUE(test, over(a));
		KUNIT_EXPECT_EQ(test, record(a)->result, 0);
		KUNIT_EXPECT_EQ(test, value(a), 11u);
	}
	ring = (struct ec_emerg_ring *)((u8 *)area(a) + area(a)->rings);
	KUNIT_EXPECT_EQ(test, ring->count, 8u);
	ec_app_emergency(bus_app(b, "a"), 0x8110, 0x11, five, ktime_get_ns());
	for (i = 0; i < 200 && ring->head == ring->tail; i++)
		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
	KUNIT_EXPECT_EQ(test, ring->head, 1u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16((u8 *)area(a) + ring->data), 0x8110u);
}

/* What the dead one has begun ends; the next one sees that, and begins its own. */
static void life_requests_taken_over(struct kunit *test)
{
	struct bus *b = bus_up(test, drive, 1);
	struct kcyc *a;

	bus_idle(b);
	a = with_request(b);
	kcyc_until_op(a);
	begin(a, 0x1018, 4);
	KUNIT_ASSERT_TRUE(test, over(a));
	begin(a, 0x1018, 4);
	kcyc_wait_cycles(a, 2);
	bus_end(b);
	a = with_request(b);
	KUNIT_EXPECT_TRUE(test, a->taken_over);
	KUNIT_EXPECT_EQ(test, record(a)->start, 2u);
	KUNIT_ASSERT_TRUE(test, over(a));
	KUNIT_EXPECT_EQ(test, value(a), 11u);
	/* one that was put there, but not told: never happened */
	record(a)->start = 77;
	record(a)->done = 5;
	bus_end(b);
	a = with_request(b);
	KUNIT_EXPECT_EQ(test, record(a)->start, record(a)->done);
	begin(a, 0x1018, 1);
	KUNIT_ASSERT_TRUE(test, over(a));
	KUNIT_EXPECT_EQ(test, record(a)->result, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(life_waits_for_outputs),
	KUNIT_CASE(kcyc_detach_without_outputs),
	KUNIT_CASE(life_poll),
	KUNIT_CASE(life_poll_of_others),
	KUNIT_CASE(life_poll_is_bounded),
	KUNIT_CASE(life_poll_outlives_session),
	KUNIT_CASE(life_poll_without_lock),
	KUNIT_CASE(life_without_device),
	KUNIT_CASE(life_device_gone_in_send),
	KUNIT_CASE(life_requests),
	KUNIT_CASE(life_requests_taken_over),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_kcyc_life", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
