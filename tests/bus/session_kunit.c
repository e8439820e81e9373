// SPDX-License-Identifier: GPL-2.0-only
/* What a reservation takes over from those before it, and what it leaves behind. */
#include <linux/delay.h>
#include "kapp.h"
#include "kcyc.h"
#include "master/cycle/cycle_thread.h"
#include "master/session/reserve.h"
#include "master/cycle/cycle_sched.h"

static const char one[] = "segment seed=8\nslave a drive in=8 out=8 mbox=128 serial=11\n";

static const struct ec_ioc_cycle hold = { .flags = EC_CYCLE_FLAG_DETACH, .stall_cycles = 10 };

static struct bus *one_up(struct kunit *test)
{
	struct bus *b = bus_up(test, one, 1);

	bus_idle(b);
	return b;
}

static void expect_nothing_told(struct bus *b)
{
	KUNIT_EXPECT_FALSE(b->test, bus_dc_has_phase(b));
	KUNIT_EXPECT_EQ(b->test, bus_app_time(b), 0ull);
	KUNIT_EXPECT_EQ(b->test, bus_interval_us(b), (u32)EC_INTERVAL_US);
	KUNIT_EXPECT_FALSE(b->test, bus_interval_told(b));
}

/* Time and interval of an application that was never active are its own. */
static void session_forgets(struct kunit *test)
{
	struct ec_ioc_app_time t = { .app_time = 12345 };
	struct ec_ioc_interval i = { .interval_us = 50 };
	struct bus *b = one_up(test);
	ec_master_t *m;

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_APP_TIME, &t), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_INTERVAL, &i), 0);
	KUNIT_EXPECT_TRUE(test, bus_dc_has_phase(b));
	bus_end(b);
	expect_nothing_told(b);

	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(m, 777), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_set_send_interval(m, 70), 0);
	KUNIT_EXPECT_EQ(test, bus_dc_phase(b), 777ull);
	ecrt_release_master(m);
	expect_nothing_told(b);
}

/* A candidate that goes leaves the cycle of the detached session what it has. */
static void session_candidate_is_freed(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){
		.flags = EC_CYCLE_FLAG_DETACH, .stall_cycles = 10, .dc = EC_SEND_FLAG_SYNC_SLAVES });
	struct bus *b = a->c->b;
	struct ec_ioc_app_time t = { .app_time = 12345 };
	struct ec_ioc_interval i = { .interval_us = 50 };
	u64 phase = bus_dc_phase(b);

	KUNIT_ASSERT_TRUE(test, bus_dc_has_phase(b));
	bus_end(b);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_APP_TIME, &t), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_INTERVAL, &i), 0);
	bus_end(b);
	KUNIT_EXPECT_NULL(test, bus_candidate(b));
	KUNIT_EXPECT_TRUE(test, bus_dc_has_phase(b) && ec_dc_begun(bus_dc(b)));
	KUNIT_EXPECT_EQ(test, bus_dc_phase(b), phase);
	KUNIT_EXPECT_EQ(test, bus_interval_us(b), 1000u);
	/* nor does the next one get what it has set */
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_session_end_detached(bus_sessions(b)), 0);
	expect_nothing_told(b);
	bus_end(b);
}

static void uploads(struct bus *b)
{
	u8 data[4];
	struct ec_ioc_sdo sdo = {
		.index = 0x1018, .subindex = 1, .size = 4, .data = (uintptr_t)data,
	};

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(b->test, bus_esc(b, 0)->mem[EC_REG_AL_STATUS], EC_AL_PREOP);
	KUNIT_EXPECT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_SDO_UPLOAD, &sdo), 0, "%s",
			    b->app.reason);
	bus_end(b);
}

static void kernel_uploads(struct bus *b)
{
	ec_master_t *m = ecrt_request_master(0);
	u32 abort, value;
	size_t size;

	KUNIT_ASSERT_NOT_NULL(b->test, m);
	KUNIT_EXPECT_EQ(b->test, bus_esc(b, 0)->mem[EC_REG_AL_STATUS], EC_AL_PREOP);
	KUNIT_EXPECT_EQ(b->test, ecrt_master_sdo_upload(m, 0, 0x1018, 1, (u8 *)&value, 4, &size,
							&abort), 0);
	ecrt_release_master(m);
}

/*
 * Mailboxes work when the call returns, wherever a tool has left the slave. The
 * first one has no bootstrap mailbox: it stays in INIT with an error.
 */
static void session_reserve_preop(struct kunit *test)
{
	static const char * const texts[] = { one, "segment seed=8\nslave a EL7201 motor=AM8121\n" };
	static const u8 states[] = { EC_AL_INIT, EC_AL_BOOT, EC_AL_SAFEOP, EC_AL_OP };
	u32 t, i;

	for (t = 0; t < ARRAY_SIZE(texts); t++) {
		struct bus *b = bus_up(test, texts[t], 1);

		bus_idle(b);
		for (i = 0; i < 2 * ARRAY_SIZE(states); i++) {
			bus_request(b, 0, states[i / 2]);
			bus_idle(b);
			KUNIT_ASSERT_NE(test, bus_esc(b, 0)->mem[EC_REG_AL_STATUS], EC_AL_PREOP);
			if (i % 2)
				kernel_uploads(b);
			else
				uploads(b);
		}
		bus_exit(test);
	}
}

/* One that does not get there holds nobody up for long, and only once. */
static void session_reserve_refused(struct kunit *test)
{
	struct bus *b = one_up(test);
	u64 t0;

	bus_request(b, 0, EC_AL_INIT);
	bus_idle(b);
	bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
	t0 = ktime_get_ns();
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 10 * NSEC_PER_SEC);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
	bus_end(b);
	bus_idle(b);
	t0 = ktime_get_ns();
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 200 * NSEC_PER_MSEC);
}

/* ms until the slave, which does not move any more, is given up; 0: never */
static u32 given_up_after(struct cyc *c)
{
	struct ec_slave *s = bus_slave(c->b, 0);
	u64 t0 = ktime_get_ns();
	u32 i;

	for (i = 0; i < 20000 && s->note.error == EC_SLAVE_OK; i++) {
		if (bus_wanted(c->b)->active)
			cyc_run(c, 1);
		else
			usleep_range(1000, 1001);
	}
	return s->note.error ? div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC) : 0;
}

/* The limit an application sets holds for each transition. */
static void session_state_timeouts(struct kunit *test)
{
	static const struct ec_ioc_sc_timeout t[] = {
		{ .from = EC_AL_INIT, .to = EC_AL_PREOP, .timeout_ms = 700 },
		{ .from = EC_AL_PREOP, .to = EC_AL_INIT, .timeout_ms = 600 },
		{ .from = EC_AL_PREOP, .to = EC_AL_SAFEOP, .timeout_ms = 500 },
		{ .from = EC_AL_OP, .to = EC_AL_SAFEOP, .timeout_ms = 800 },
		{ .from = EC_AL_OP, .to = EC_AL_PREOP, .timeout_ms = 400 },
		{ .from = EC_AL_OP, .to = EC_AL_INIT, .timeout_ms = 300 },
	};
	u32 i, ms;

	for (i = 0; i < ARRAY_SIZE(t); i++) {
		struct bus *b = one_up(test);
		struct cyc *c = cyc_new(b, 1000);
		struct ec_ioc_sc_timeout v = t[i];

		cyc_domain(c);
		cyc_map_all(c, 0, 1, 0);
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_TIMEOUT, &v), 0);
		if (v.from == EC_AL_OP) {
			cyc_activate(c);
			KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
		} else {
			bus_request(b, 0, EC_AL_INIT);
			bus_idle(b);
			bus_request(b, 0, v.from);
			bus_idle(b);
		}
		KUNIT_ASSERT_EQ(test, bus_slave(b, 0)->al.status, v.from);
		bus_fault(b, EC_SIM_FAULT_MUTE, 0, 0, 1, 0);
		bus_request(b, 0, v.to);
		ms = given_up_after(c);
		KUNIT_EXPECT_GE_MSG(test, ms, v.timeout_ms, "%u to %u", v.from, v.to);
		KUNIT_EXPECT_LE_MSG(test, ms, v.timeout_ms + 50, "%u to %u", v.from, v.to);
		bus_exit(test);
	}
}

/* Watch a scan of @n slaves until it has ended. */
static void watch_scan(struct bus *b, u32 n)
{
	ec_master_scan_progress_t p;
	u32 i, looks = 0, between = 0, last = 0;

	for (i = 0; i < 20000; i++) {
		struct ec_ioc_master mi = { 0 };

		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_MASTER, &mi), 0);
		KUNIT_ASSERT_EQ(b->test, ecrt_master_scan_progress(b->m, &p), 0);
		KUNIT_EXPECT_EQ(b->test, mi.scan_index, p.scan_index);
		KUNIT_EXPECT_EQ(b->test, mi.scan_slaves, p.slave_count);
		if (looks && !mi.scan_busy)
			break;
		if (mi.scan_busy) {
			looks++;
			KUNIT_EXPECT_EQ(b->test, p.slave_count, n);
			KUNIT_EXPECT_LT(b->test, p.scan_index, p.slave_count);
			KUNIT_EXPECT_GE(b->test, p.scan_index, last);
			between += p.scan_index && p.scan_index < n - 1;
			last = p.scan_index;
		}
		usleep_range(1000, 1001);
	}
	KUNIT_EXPECT_GT(b->test, looks, 10u);
	KUNIT_EXPECT_GT(b->test, between, 0u);
	KUNIT_EXPECT_EQ(b->test, p.slave_count, n);
	KUNIT_EXPECT_EQ(b->test, p.scan_index, n);
}

static void session_scan_progress(struct kunit *test)
{
	/* EEPROMs of several sizes */
	struct bus *b = bus_new(test,
				"segment seed=8\nrepeat 20 slave s drive in=8 out=8 mbox=128\n"
				"repeat 20 slave t EL2008\n"
				"repeat 10 slave u io in=64 out=64\n");

	bus_plug(b);
	watch_scan(b, 50);
	bus_idle(b);
	bus_rescan(b);
	watch_scan(b, 50);
}

static struct bus *detached(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, hold);

	bus_end(a->c->b);
	return a->c->b;
}

/* A candidate asks about its own slaves, others about those that run. */
static void session_candidate_makes_other_calls(struct kunit *test)
{
	struct bus *b = detached(test);
	struct ec_file other = { 0 };
	struct ec_ioc_slave_config sc = { .position = 40, .vendor_id = 1, .product_code = 2 };
	struct ec_ioc_config_why why = { 0 }, running = { 0 };
	struct ec_ioc_sc_ip set = { .params = { .which = EC_IP_NAME, .name = "heir" } }, ip = { 0 };

	ec_file_init(&other, b->m, false);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_IP, &set), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &why), 0);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(why.text, "40"), "%s", why.text);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_CONFIG_WHY, &running), 0);
	KUNIT_EXPECT_STRNEQ(test, running.text, why.text);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_IP, &ip), 0);
	KUNIT_EXPECT_EQ(test, ip.params.which, (u32)EC_IP_NAME);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_CONFIG_IP, &ip), 0);
	KUNIT_EXPECT_EQ(test, ip.params.which, 0u);
	/* the running one has two, the candidate one */
	why.index = 1;
	ip.config = 1;
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_CONFIG_WHY, &why), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_CONFIG_IP, &ip), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &why), -ENOENT);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_IP, &ip), -ENOENT);
}

/* A candidate in the kernel cannot take over, and disturbs nothing. */
static void session_candidate_in_kernel(struct kunit *test)
{
	struct bus *b = detached(test);
	struct ec_session *runs = bus_session(b);
	struct kapp *k = kapp_new(b, 500);
	u64 app_time = bus_app_time(b), cycle;
	bool phase = bus_dc_has_phase(b);

	KUNIT_ASSERT_PTR_EQ(test, bus_session(b), runs);
	KUNIT_ASSERT_NOT_NULL(test, bus_candidate(b));
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(k->m, 76), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(k->m, 77), 0);
	KUNIT_EXPECT_GE(test, bus_app_time(b), app_time);
	KUNIT_EXPECT_NE(test, bus_app_time(b), 77ull);
	KUNIT_EXPECT_EQ(test, bus_dc_has_phase(b), phase);
	KUNIT_EXPECT_EQ(test, bus_interval_us(b), 1000u);
	kapp_map(k, 0);
	kapp_map(k, 1);
	cycle = bus_kernel_status(b)->cycle;
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), -EEXIST);
	KUNIT_EXPECT_EQ(test, kapp_exchange(k), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_domain_queue(k->d), -EINVAL);
	KUNIT_EXPECT_NULL(test, ecrt_domain_data(k->d));
	KUNIT_EXPECT_EQ(test, ecrt_master_sync_slave_clocks(k->m), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), -EINVAL);
	msleep(500);
	KUNIT_EXPECT_GE(test, bus_kernel_status(b)->cycle - cycle, 499ull);
	KUNIT_EXPECT_EQ(test, bus_esc(b, 0)->mem[EC_REG_AL_STATUS], EC_AL_OP);
	KUNIT_EXPECT_EQ(test, bus_esc(b, 1)->mem[EC_REG_AL_STATUS], EC_AL_OP);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	/* the way the refusal names; then the bus is its own */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_END_DETACHED, NULL), 0);
	KUNIT_EXPECT_NULL(test, bus_candidate(b));
	/* what it has set meanwhile; its first time is the phase */
	KUNIT_EXPECT_TRUE(test, bus_interval_told(b));
	KUNIT_EXPECT_EQ(test, bus_interval_us(b), 500u);
	KUNIT_EXPECT_EQ(test, bus_app_time(b), 77ull);
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(k->m, 78), 0);
	KUNIT_EXPECT_EQ(test, bus_app_time(b), 78ull);
	KUNIT_EXPECT_EQ(test, bus_dc_phase(b), 76ull);
	kapp_op(k);
	kapp_run(k, 10);
	ecrt_release_master(k->m);
	KUNIT_EXPECT_NULL(test, bus_session(b));
}

/* A configuration is of one master. */
static void session_foreign_config(struct kunit *test)
{
	struct bus *b = one_up(test);
	struct ec_master *other = kunit_kzalloc(test, sizeof(*other), GFP_KERNEL);
	struct ec_session *s = kunit_kzalloc(test, sizeof(*s), GFP_KERNEL);
	struct ec_config *sc = kunit_kzalloc(test, sizeof(*sc), GFP_KERNEL);
	ec_master_t *m = ecrt_request_master(0);
	struct kapp k = { .b = b, .m = m };

	KUNIT_ASSERT_TRUE(test, other && s && sc && m);
	s->sessions = &other->sessions;
	sc->wanted = &s->wanted;
	kapp_config(&k, 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_select_reference_clock(m, (ec_slave_config_t *)sc),
			-EINVAL);
	KUNIT_EXPECT_EQ(test, bus_session(b)->ref_config, EC_UAPI_NONE32);
	KUNIT_EXPECT_EQ(test, ecrt_master_select_reference_clock(m, k.sc[0]), 0);
	KUNIT_EXPECT_EQ(test, bus_session(b)->ref_config, 0u);
	ecrt_release_master(m);
}

/* One that is longer than what the master reckons with is no error; it is measured. */
static void session_interval(struct kunit *test)
{
	static const struct {
		u32 us, is;
		bool told;
	} told[] = {
		{ 1, 1, true }, { 1000000, 1000000, true }, { 1000001, 1000000, false },
		{ ~0u, 1000000, false }, { 70, 70, true },
	};
	struct bus *b = one_up(test);
	struct cyc *c = cyc_new(b, 1000);
	struct ec_ioc_interval none = { 0 };
	u32 i;

	for (i = 0; i < ARRAY_SIZE(told); i++) {
		struct ec_ioc_interval t = { .interval_us = told[i].us };

		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_INTERVAL, &t), 0);
		KUNIT_EXPECT_EQ(test, bus_interval_us(b), told[i].is);
		KUNIT_EXPECT_EQ(test, bus_interval_told(b), told[i].told);
	}
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_INTERVAL, &none), -EINVAL);
	cyc_release(c);
}

static int activate(struct bus *b)
{
	struct ec_ioc_activate act = { 0 };

	return ec_ioc(&b->app, EC_IOC_ACTIVATE, &act);
}

static void expect_limit(struct bus *b)
{
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(b->app.reason, "limit of 64 MiB"), "%s",
				  b->app.reason);
}

/* Each call succeeds; what is cleared does not count. */
static void clear_pdos(struct bus *b)
{
	static const u8 ops[] = { EC_SC_PDO_ASSIGN_ADD, EC_SC_PDO_MAP_ADD, EC_SC_PDO_ASSIGN_CLEAR };
	struct ec_ioc_sc_pdo pdo = { .sm = 2, .pdo = 0x1600, .bits = 8 };
	size_t bytes = bus_wanted(b)->budget.bytes;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(ops); i++) {
		pdo.op = ops[i];
		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_PDO, &pdo), 0);
		KUNIT_EXPECT_EQ(b->test, bus_wanted(b)->budget.bytes > bytes,
				ops[i] != EC_SC_PDO_ASSIGN_CLEAR);
	}
	KUNIT_EXPECT_EQ(b->test, bus_wanted(b)->budget.bytes, bytes);
}

/* All sessions and what is mapped have a limit together. */
static void session_memory(struct kunit *test)
{
	struct bus *b = one_up(test);
	struct ec_ioc_slave_config sc = { .position = 40, .vendor_id = 1, .product_code = 2 };
	struct ec_ioc_sc_sdo sdo = { .index = 0x2000, .size = 4096 };
	u8 *value = kunit_kzalloc(test, sdo.size, GFP_KERNEL);
	long mapped;
	u32 i;

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_EXPECT_GE(test, bus_wanted(b)->budget.bytes, sizeof(struct ec_config));
	sdo.data = (uintptr_t)value;
	clear_pdos(b);
	/* as if something else was mapped: there is room for three values */
	mapped = EC_MAX_SESSION_BYTES - bus_memory(b) - 4 * sdo.size;
	bus_add_memory(b, mapped);
	for (i = 0; i < 3; i++)
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), -ENOMEM);
	expect_limit(b);
	KUNIT_EXPECT_EQ(test, activate(b), -ENOMEM);
	expect_limit(b);
	bus_add_memory(b, -mapped);
	KUNIT_EXPECT_EQ(test, activate(b), 0);
	bus_end(b);
}

/* A mapping that outlives its session counts until it goes. */
static void session_mapping_outlives(struct kunit *test)
{
	struct bus *b = kcyc_start(test, (struct ec_ioc_cycle){ 0 })->c->b;
	struct ec_shared *sh = bus_shared(b);
	size_t bytes = sh->bytes;

	KUNIT_EXPECT_GE(test, bytes, sh->image_size + sh->exchange_size + EC_STATUS_BYTES);
	KUNIT_EXPECT_EQ(test, (size_t)bus_memory(b), bytes + bus_wanted(b)->budget.bytes);
	ec_shared_get(sh);
	bus_end(b);
	/* work on requests may end a moment later */
	msleep(50);
	KUNIT_EXPECT_EQ(test, (size_t)bus_memory(b), bytes);
	ec_shared_put(sh);
	KUNIT_EXPECT_EQ(test, bus_memory(b), 0L);
}

/* A session without a cycle thread has none whose priority could change. */
static void session_without_thread_inherits(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a io in=8 out=8\n", 1);
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	bus_lock(b);
	ec_cycle_thread_inherit(bus_cycle(b), 7, true);
	bus_unlock(b);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 3000), ~0ull);
}

static struct kunit_case session_cases[] = {
	KUNIT_CASE(session_memory),
	KUNIT_CASE(session_mapping_outlives),
	KUNIT_CASE(session_forgets),
	KUNIT_CASE(session_candidate_is_freed),
	KUNIT_CASE(session_reserve_preop),
	KUNIT_CASE(session_reserve_refused),
	KUNIT_CASE(session_state_timeouts),
	KUNIT_CASE(session_scan_progress),
	KUNIT_CASE(session_candidate_makes_other_calls),
	KUNIT_CASE(session_candidate_in_kernel),
	KUNIT_CASE(session_foreign_config),
	KUNIT_CASE(session_interval),
	KUNIT_CASE(session_without_thread_inherits),
	{}
};

static struct kunit_suite session_suite = {
	.name = "bus_session",
	.exit = bus_exit,
	.test_cases = session_cases,
};

kunit_test_suite(session_suite);
