// SPDX-License-Identifier: GPL-2.0-only
/* What this master offers beyond the field's interface. */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"
#include "master/config/why.h"
#include "master/session/activate.h"

#define TWO	"slave a drive in=8 out=8 drift=40ppm clock=3s\n" \
		"slave b drive in=8 out=8 drift=-70ppm clock=9s\n"

static void tell_time(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_REF_TIME | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns() + 0x500000000ull;
}

static const struct ec_status *status(const struct cyc *c)
{
	return bus_status(c->b);
}

/* The whole time is the true one, of when the frame passed. */
static void ext_whole_time(struct kunit *test)
{
	struct bus *b = bus_up(test, TWO, 2);
	struct cyc *c;
	u32 i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	c->each = tell_time;
	cyc_activate(c);
	KUNIT_EXPECT_EQ(test, status(c)->dc_time64_valid, 0u);
	for (i = 0; i < 2000 && bus_dc_state(b) != EC_DC_READY; i++)
		cyc_run(c, 1);
	cyc_run(c, 3);
	for (i = 0; i < 20; i++) {
		u64 before = ktime_get_ns(), truth;
		s64 off;

		cyc_run(c, 1);
		KUNIT_ASSERT_EQ(test, status(c)->dc_time64_valid, 1u);
		/* read by the frame of the cycle before this one */
		ec_sim_advance(b->sim, ktime_get_ns());
		truth = ec_esc_system_time(bus_esc(b, 0), before);
		off = status(c)->dc_time64 - truth;
		KUNIT_EXPECT_LT(test, abs(off), 20000ll);
		KUNIT_EXPECT_GT(test, status(c)->dc_time64, 0x500000000ull);
		KUNIT_EXPECT_EQ(test, (u32)status(c)->dc_time64, (u32)status(c)->dc_time);
	}
	/* a lost frame is told */
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 0, 0, 0, 0);
	cyc_run(c, 3);
	KUNIT_EXPECT_EQ(test, status(c)->dc_time64_valid, 0u);
}

/* What the image begins with reaches the slaves before anybody wrote outputs. */
static void preset(struct kunit *test, bool kernel)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\nslave b drive in=8 out=8\n", 2);
	struct cyc *c = cyc_new(b, 1000);
	struct ec_ioc_cycle k = { .period_ns = 1000000, .cpu = -1 };
	static u8 image[32];
	u32 i, k1;

	k1 = cyc_domain(c);
	for (i = 0; i < 2; i++) {
		u32 sc = cyc_config(c, i);

		cyc_map(c, sc, 2, k1);
		cyc_map(c, sc, 3, k1);
	}
	/* outputs of a, inputs of a, outputs of b, inputs of b */
	put_unaligned_le16(0x1234, image);
	put_unaligned_le16(0x5678, image + 16);
	if (kernel)
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &k), 0);
	mutex_lock(bus_mutex(b));
	KUNIT_EXPECT_EQ(test, ec_session_place(bus_session(b)), 32u);
	bus_session(b)->preset = image;
	KUNIT_ASSERT_EQ(test, ec_session_activate(bus_session(b)), 0);
	bus_session(b)->preset = NULL;
	mutex_unlock(bus_mutex(b));
	c->next = ktime_get();
	for (i = 0; i < 5000 && !cyc_all_op(c); i++) {
		if (kernel)
			usleep_range(1000, 1001);
		else
			cyc_run(c, 1);
	}
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "a"), EC_APP_OUT, 0), 0x1234);
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "b"), EC_APP_OUT, 0), 0x5678);
}

static void ext_preset(struct kunit *test)
{
	preset(test, false);
}

static void ext_preset_kernel_cycle(struct kunit *test)
{
	preset(test, true);
}

/* Places are told before activation; a wrong size is refused. */
static void ext_places(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=3 out=5\nslave b drive in=8 out=8\n", 2);
	struct cyc *c = cyc_new(b, 1000);
	struct ec_ioc_domain_offset at = { .domain = 1 };
	struct ec_ioc_activate a = { 0 };

	cyc_domain(c);
	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_map_all(c, 1, 1, 1);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN_OFFSET, &at), 0);
	KUNIT_EXPECT_EQ(test, at.offset, 8u);
	KUNIT_EXPECT_EQ(test, at.size, 16u);
	a.preset_size = EC_MAX_IMAGE + 1;	/* not even looked at */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &a), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, ", domains need 24"));
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_DOMAIN_OFFSET, &at), 0);
	KUNIT_EXPECT_EQ(test, at.offset, 8u);
}

static bool all_in(struct bus *b, u8 state)
{
	u32 i;

	for (i = 0; i < bus_n_slaves(b); i++)
		if (ec_app_state(ec_app_of(bus_esc(b, i))) != state)
			return false;
	return true;
}

/* A drive in OP with SYNC0. */
static struct cyc *with_sync(struct bus *b)
{
	struct ec_ioc_sc_dc dc = { .assign_activate = 0x0300, .cycle0 = 1000000 };
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_DC, &dc), 0);
	dc.config = 1;
	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_DC, &dc), 0);
	c->each = tell_time;
	cyc_activate(c);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(c, 5000), ~0ull);
	return c;
}

/* To PREOP while the cycle runs: no error, no watchdog, SYNC off, and again. */
static void ext_slaves_down(struct kunit *test)
{
	struct bus *b = bus_up(test, TWO, 2);
	u32 round, i;

	bus_idle(b);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVES_DOWN, NULL), -EPERM);
	for (round = 0; round < 2; round++) {
		struct cyc *c = with_sync(b);
		u8 expired;

		KUNIT_EXPECT_EQ(test, bus_esc(b, 0)->mem[EC_REG_DC_ACTIVATION], 3);
		expired = bus_esc(b, 0)->mem[EC_REG_WD_SM_COUNT];
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVES_DOWN, NULL), 0);
		for (i = 0; i < 1000 && !all_in(b, EC_AL_PREOP); i++)
			cyc_run(c, 1);
		KUNIT_EXPECT_LT(test, i, 1000u);
		KUNIT_EXPECT_EQ(test, bus_esc(b, 0)->mem[EC_REG_WD_SM_COUNT], expired);
		cyc_run(c, 300);	/* and they stay there */
		KUNIT_EXPECT_TRUE(test, all_in(b, EC_AL_PREOP));
		for (i = 0; i < 2; i++) {
			const u8 *mem = bus_esc(b, i)->mem;

			KUNIT_EXPECT_EQ(test, get_unaligned_le16(mem + EC_REG_AL_CODE), 0);
			KUNIT_EXPECT_EQ(test, mem[EC_REG_AL_STATUS], EC_AL_PREOP);
			KUNIT_EXPECT_EQ(test, mem[EC_REG_DC_ACTIVATION], 0);
			KUNIT_EXPECT_EQ(test, bus_slave(b, i)->note.error, EC_SLAVE_OK);
		}
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEACTIVATE, NULL), 0);
		KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVES_DOWN, NULL), -EINVAL);
		cyc_release(c);
		bus_idle(b);
	}
}

static const char *why(struct bus *b, u32 config)
{
	static struct ec_ioc_config_why w;

	memset(&w, 0, sizeof(w));
	w.index = config;
	KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &w), 0);
	KUNIT_EXPECT_EQ(b->test, w.len, (u32)strlen(w.text));
	return w.text;
}

/* The cause, from "not there" to "in OP". */
static void ext_why(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8 alias=7\nslave b drive in=8 out=8\n"
			       "slave c EL2008\nfault refuse b OP code=0x0027\n", 3);
	struct ec_ioc_config_why none = { .index = 9 };
	struct ec_ioc_reg_entry reg = { .entry_index = 0x6040 };
	struct ec_ioc_slave_config sc = { 0 };
	struct cyc *c = cyc_new(b, 1000);
	static const struct {
		u16 alias, position;
		u32 vendor, product;
		const char *text;
	} absent[] = {
		{ 99, 0, 1, 2, "none of the 3 slave(s) on the bus has alias 99" },
		{ 7, 5, 1, 2, "no slave at ring position 5: 3 slave(s) connected" },
		{ 0, 2, 1, 2, "slave 2 is 0x00000002/0x07d83052, configured is 0x00000001/0x00000002" },
	};
	u32 i, second;

	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	for (i = 0; i < ARRAY_SIZE(absent); i++) {
		sc = (struct ec_ioc_slave_config){
			.alias = absent[i].alias, .position = absent[i].position,
			.vendor_id = absent[i].vendor, .product_code = absent[i].product,
		};
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
		KUNIT_EXPECT_STREQ(test, why(b, sc.index), absent[i].text);
	}
	sc = (struct ec_ioc_slave_config){
		.alias = 7, .vendor_id = bus_slave(b, 0)->info.vendor,
		.product_code = bus_slave(b, 0)->info.product,
	};
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	KUNIT_EXPECT_STREQ(test, why(b, sc.index),
			   "slave 0 has another configuration, 0:0; use one of the two");
	second = sc.index;
	reg.config = second;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &reg), -ENOENT);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "entry 0x6040:00 is not known, no slave is attached to 7:0 (slave 0 has another configuration, 0:0; use one of the two); name its PDOs with ecrt_slave_config_pdos()");
	reg.config = 0;
	reg.entry_index = 0x5555;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_ENTRY, &reg), -ENOENT);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "0x5555:00 is not mapped in slave 0:0"));
	KUNIT_EXPECT_STREQ(test, why(b, 0), "AL state PREOP; the master is not active");
	cyc_activate(c);
	cyc_run(c, 2);
	KUNIT_EXPECT_NOT_NULL(test, strstr(why(b, 0), " way to OP"));
	cyc_run(c, 1000);
	KUNIT_EXPECT_STREQ(test, why(b, 0), "");
	/* nobody is missing */
	KUNIT_EXPECT_STREQ(test, why(b, second),
			   "slave 0 has another configuration, 0:0; use one of the two");
	KUNIT_EXPECT_NOT_NULL(test, strstr(why(b, 1), "OP refused: AL status code 0x0027"));
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &none), -ENOENT);
	cyc_release(c);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CONFIG_WHY, &none), -ENOENT);
}

/* A stalled application is a cause, too. */
static void ext_why_stalled(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8\n", 1);
	struct cyc *c = cyc_new(b, 1000);

	cyc_domain(c);
	cyc_map_all(c, 0, 1, 0);
	cyc_activate(c);
	msleep(500);
	KUNIT_EXPECT_NOT_NULL(test,
			      strstr(why(b, 0),
				     "; cycle timeout: the application sends no cyclic frames"));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(ext_whole_time),
	KUNIT_CASE(ext_preset),
	KUNIT_CASE(ext_preset_kernel_cycle),
	KUNIT_CASE(ext_places),
	KUNIT_CASE(ext_slaves_down),
	KUNIT_CASE(ext_why),
	KUNIT_CASE(ext_why_stalled),
	{ }
};

static struct kunit_suite suite = { .name = "bus_ext", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
