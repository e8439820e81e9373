// SPDX-License-Identifier: GPL-2.0-only
#include <linux/hrtimer.h>
#include <linux/prandom.h>
#include "cyc.h"
#include "master/boundary/ioctl.h"
#include "master/config/why.h"

/**
 * cyc_new() - an application reserves the master
 * @b: bus, scanned
 * @period_us: of its cycle
 *
 * Return: application.
 */
struct cyc *cyc_new(struct bus *b, u32 period_us)
{
	struct cyc *c = kunit_kzalloc(b->test, sizeof(*c), GFP_KERNEL);
	struct ec_ioc_interval i = { .interval_us = period_us };

	KUNIT_ASSERT_NOT_NULL(b->test, c);
	c->b = b;
	c->period_ns = (u64)period_us * NSEC_PER_USEC;
	KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0, "%s", b->app.reason);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_INTERVAL, &i), 0);
	return c;
}

u32 cyc_domain(struct cyc *c)
{
	struct ec_ioc_create_domain d = { 0 };

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_CREATE_DOMAIN, &d), 0);
	c->queued |= BIT_ULL(d.index);
	return d.index;
}

/**
 * cyc_config() - configure the slave at a ring position as what it is
 * @c: application
 * @position: ring position
 *
 * Return: number of the configuration.
 */
u32 cyc_config(struct cyc *c, u32 position)
{
	struct ec_slave *s = bus_slave(c->b, position);
	struct ec_ioc_slave_config sc = {
		.position = position, .vendor_id = s->info.vendor,
		.product_code = s->info.product,
	};

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_SLAVE_CONFIG, &sc), 0, "%s",
			    c->b->app.reason);
	return sc.index;
}

/**
 * cyc_pdo() - change assignment or mapping
 * @c: application
 * @config: configuration
 * @op: EC_SC_PDO_*
 * @sm: SyncManager
 * @pdo: PDO
 * @entry: index << 16 | subindex << 8 | bits
 */
void cyc_pdo(struct cyc *c, u32 config, u8 op, u8 sm, u16 pdo, u32 entry)
{
	struct ec_ioc_sc_pdo p = {
		.config = config, .op = op, .sm = sm, .pdo = pdo, .entry_index = entry >> 16,
		.subindex = entry >> 8, .bits = entry,
	};

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_PDO, &p), 0, "%s",
			    c->b->app.reason);
}

/**
 * cyc_map() - put the process data of a SyncManager into a domain
 * @c: application
 * @config: configuration
 * @sm: SyncManager with at least one entry
 * @domain: domain
 *
 * Return: offset in the domain.
 */
u32 cyc_map(struct cyc *c, u32 config, u8 sm, u32 domain)
{
	struct ec_ioc_reg_entry r = {
		.flags = EC_REG_ENTRY_BY_POS, .config = config, .domain = domain, .sm = sm,
	};

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_REG_ENTRY, &r), 0, "%s",
			    c->b->app.reason);
	return r.offset;
}

/**
 * cyc_map_all() - all process data of @n slaves into a domain
 * @c: application
 * @first: ring position of the first
 * @n: how many; those without process data are configured too
 * @domain: domain
 */
void cyc_map_all(struct cyc *c, u32 first, u32 n, u32 domain)
{
	u32 i, sm;

	for (i = first; i < first + n; i++) {
		struct ec_slave *s = bus_slave(c->b, i);
		u32 config = cyc_config(c, i);

		for (sm = 0; sm < s->n_sms; sm++)
			if (ec_pdo_list_bytes(&s->pdos.sm[sm]))
				cyc_map(c, config, sm, domain);
	}
}

const u32 cyc_new_out[3] = { 0x60400010, 0x60FF0020, 0x60710010 };
const u32 cyc_new_in[4] = { 0x60410010, 0x60640020, 0x606C0020, 0x60770010 };

/**
 * cyc_remap() - give a drive another mapping than the one it has
 * @c: application
 * @config: its configuration
 */
void cyc_remap(struct cyc *c, u32 config)
{
	u32 i;

	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, 2, 0, 0);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, 2, 0x1600, 0);
	cyc_pdo(c, config, EC_SC_PDO_MAP_CLEAR, 2, 0x1600, 0);
	for (i = 0; i < ARRAY_SIZE(cyc_new_out); i++)
		cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, 2, 0x1600, cyc_new_out[i]);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_CLEAR, 3, 0, 0);
	cyc_pdo(c, config, EC_SC_PDO_ASSIGN_ADD, 3, 0x1a00, 0);
	cyc_pdo(c, config, EC_SC_PDO_MAP_CLEAR, 3, 0x1a00, 0);
	for (i = 0; i < ARRAY_SIZE(cyc_new_in); i++)
		cyc_pdo(c, config, EC_SC_PDO_MAP_ADD, 3, 0x1a00, cyc_new_in[i]);
}

void cyc_activate(struct cyc *c)
{
	struct ec_ioc_activate a = { 0 };

	KUNIT_ASSERT_EQ_MSG(c->b->test, ec_ioc(&c->b->app, EC_IOC_ACTIVATE, &a), 0, "%s",
			    c->b->app.reason);
	/*
	 * In virtual time each reading of the clock takes some time, and no kernel thread is
	 * preempted: one that is woken together with the application must not come first.
	 */
	sched_set_fifo_low(current);
	c->next = ktime_get();
}

/* How late this cycle wakes up, ns. */
static u64 wake_late(struct cyc *c)
{
	struct cyc_jitter *j = &c->jitter;

	if (!j->ns)
		return 0;
	if (j->late_every && prandom_u32_state(&j->random) % j->late_every == 0)
		return j->late_ns;
	return prandom_u32_state(&j->random) % (2 * j->ns + 1);
}

/**
 * cyc_run() - some cycles: wait, receive, work, send
 * @c: active application
 * @cycles: how many
 */
void cyc_run(struct cyc *c, u32 cycles)
{
	struct ec_ioc_send send = { 0 };
	u32 i, d;

	for (i = 0; i < cycles; i++) {
		bool whole = true;
		ktime_t at;

		c->next = ktime_add_ns(c->next, c->period_ns);
		at = ktime_add_ns(c->next, wake_late(c));
		set_current_state(TASK_UNINTERRUPTIBLE);
		schedule_hrtimeout(&at, HRTIMER_MODE_ABS);
		KUNIT_ASSERT_EQ(c->b->test, ec_ioc_receive(&c->b->app), 0);
		for (d = 0; d < bus_wanted(c->b)->n_domains; d++)
			whole &= bus_domain_status(c->b, d)->wc_state == 2;
		c->incomplete += !whole;
		if (c->each)
			c->each(c);
		send.queued = c->queued;
		send.flags = c->flags;
		send.app_time = c->app_time;
		send.sync_time = c->sync_time;
		KUNIT_ASSERT_EQ(c->b->test, ec_ioc_send(&c->b->app, &send), 0);
		c->cycles++;
	}
}

/**
 * cyc_in_op() - an application with a cycle of 1 ms whose slaves are in OP
 * @b: bus, scanned
 * @first: ring position of the first slave
 * @n: how many; all process data are in one domain
 *
 * Return: application.
 */
struct cyc *cyc_in_op(struct bus *b, u32 first, u32 n)
{
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, first, n, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(c, 5000), ~0ull);
	return c;
}

/* All of @n slaves in OP, the last one in a domain of its own. */
struct cyc *cyc_two_domains(struct bus *b, u32 n)
{
	struct cyc *c;
	u32 d;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	d = cyc_domain(c);
	cyc_map_all(c, 0, n - 1, 0);
	cyc_map_all(c, n - 1, 1, d);
	cyc_activate(c);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(c, 5000), ~0ull);
	return c;
}

/* SYNC0 of the whole cycle at the slaves of the first @n configurations */
void cyc_sync0(struct cyc *c, u32 n)
{
	u32 i;

	for (i = 0; i < n; i++) {
		struct ec_ioc_sc_dc dc = {
			.config = i, .assign_activate = 0x0300, .cycle0 = c->period_ns,
		};

		KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_DC, &dc), 0);
	}
}

/**
 * cyc_shake() - let an application wake up late from now on, as on a computer
 * @c: application
 * @ns: by 0 to twice as much in most cycles
 * @late_every: in one of so many cycles by half a cycle, 0: never
 */
void cyc_shake(struct cyc *c, u32 ns, u32 late_every)
{
	c->jitter = (struct cyc_jitter){
		.ns = ns, .late_every = late_every, .late_ns = c->period_ns / 2,
	};
	prandom_seed_state(&c->jitter.random, 5);
}

/* Drives whose clocks differ in time and rate, always the same ones. */
static char *describe_drives(struct kunit *test, u32 n, s32 host_ppb)
{
	size_t size = 16384, len;
	char *text = kunit_kzalloc(test, size, GFP_KERNEL);
	struct rnd_state r;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, text);
	prandom_seed_state(&r, 33);
	len = scnprintf(text, size, "segment seed=33 response=100us transition=1ms\n");
	for (i = 0; i < n; i++) {
		int ppb = (int)(prandom_u32_state(&r) % 200001) - 100000 - host_ppb;

		len += scnprintf(text + len, size - len,
				 "slave s%u drive in=8 out=8 drift=%dppb clock=%ums\n", i, ppb,
				 prandom_u32_state(&r));
	}
	return text;
}

/**
 * cyc_drives_of() - an application with SYNC0 of its cycle at drives, not active yet
 * @test: case
 * @n: drives, whose clocks differ
 * @period_us: of its cycle
 * @host_ppb: how much faster the computer's clock is than the mean of theirs
 *
 * Return: application.
 */
struct cyc *cyc_drives_of(struct kunit *test, u32 n, u32 period_us, s32 host_ppb)
{
	struct bus *b = bus_up(test, describe_drives(test, n, host_ppb), n);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, period_us);
	cyc_domain(c);
	cyc_map_all(c, 0, n, 0);
	cyc_sync0(c, n);
	return c;
}

bool cyc_all_op(struct cyc *c)
{
	u32 i;

	for (i = 0; i < bus_wanted(c->b)->n_configs; i++) {
		const struct ec_slave *s = bus_config(c->b, i)->slave;

		if (!s || s->al.status != EC_AL_OP || s->work.reconfigure)
			return false;
	}
	return true;
}

/**
 * cyc_wait_op() - cycle until all configured slaves are in OP
 * @c: active application
 * @limit_ms: bus time
 *
 * Return: bus time it took, us; ~0 after the limit.
 */
u64 cyc_wait_op(struct cyc *c, u32 limit_ms)
{
	u64 t0 = ktime_get_ns();

	while (!cyc_all_op(c)) {
		if (ktime_get_ns() - t0 > (u64)limit_ms * NSEC_PER_MSEC)
			return ~0ull;
		cyc_run(c, 1);
	}
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

/**
 * cyc_config_status() - state of a configuration
 * @b: bus with a session
 * @config: its number
 *
 * Return: as ec_config_status().
 */
u8 cyc_config_status(struct bus *b, u32 config)
{
	u8 v;

	mutex_lock(bus_mutex(b));
	v = ec_config_status(bus_config(b, config));
	mutex_unlock(bus_mutex(b));
	return v;
}

/**
 * cyc_pd() - process data of a SyncManager
 * @c: active application
 * @position: ring position of the slave
 * @sm: SyncManager
 *
 * Return: where they lie in the image.
 */
u8 *cyc_pd(struct cyc *c, u32 position, u8 sm)
{
	u32 i, k;

	for (i = 0; i < bus_wanted(c->b)->n_configs; i++) {
		struct ec_config *sc = bus_config(c->b, i);

		for (k = 0; k < sc->n_fmmus; k++)
			if (sc->position == position && sc->fmmus[k].sm == sm)
				return cyc_data(c, sc->fmmus[k].domain->index) +
				       sc->fmmus[k].offset;
	}
	KUNIT_FAIL(c->b->test, "slave %u has no SM%u in a domain", position, sm);
	return cyc_data(c, 0);
}

u8 *cyc_data(struct cyc *c, u32 domain)
{
	return bus_shared(c->b)->image + bus_domain(c->b, domain)->offset;
}

struct ec_status_domain *cyc_state(struct cyc *c, u32 domain)
{
	return bus_domain_status(c->b, domain);
}

void cyc_release(struct cyc *c)
{
	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_RELEASE, NULL), 0);
}
