// SPDX-License-Identifier: GPL-2.0-only
/* The scan: who is on the bus, and what their EEPROMs say. */
#include <linux/completion.h>
#include <linux/kthread.h>
#include <linux/slab.h>
#include "bus.h"
#include "master/boundary/ioctl.h"
#include "master/boundary/cdev.h"
#include "master/bus/bus_list.h"

/* the built-in bench, in ring order */
static const struct {
	const char *name;
	const char *order;
	u16 alias;
	u8 in_bytes;
	u8 out_bytes;
	u16 parent;
} bench[] = {
	{ "coupler1", "EK1100", 1, 0, 0, EC_UAPI_NONE16 },
	{ "dio", "EL1859", 0, 1, 1, 0 },
	{ "ai", "EL3062", 0, 8, 0, 1 },
	{ "ao", "EL4002", 0, 0, 4, 2 },
	{ "axis1", "EL7201", 0, 6, 6, 3 },
	{ "axis2", "EL7201", 0, 6, 6, 4 },
	{ "switch", "EL6614", 0, 0, 0, 5 },
	{ "extension", "EK1110", 0, 0, 0, 6 },
	{ "coupler2", "EK1100", 2, 0, 0, 7 },
	{ "di1", "EL1008", 0, 1, 0, 8 },
	{ "di2", "EL1004", 0, 1, 0, 9 },
	{ "do1", "EL2008", 1001, 0, 1, 10 },
	{ "do2", "EL2004", 0, 0, 1, 11 },
	{ "ai2", "EL3062", 0, 8, 0, 12 },
	{ "ao2", "EL4002", 0, 0, 4, 13 },
	{ "wago", "750-354", 3, 9, 9, 0 },
	{ "drive1", "drive", 0, 22, 22, 15 },
	{ "drive2", "drive", 0, 22, 22, 16 },
	{ "io", "io", 0, 8, 8, 17 },
	{ "coupler3", "EK1100", 4, 0, 0, 18 },
	{ "do3", "EL2008", 0, 0, 1, 19 },
	{ "di3", "EL1008", 0, 1, 0, 20 },
};

static u32 pd_bytes(const struct ec_slave *s, bool out)
{
	u32 bytes = 0;
	unsigned int sm;

	for (sm = 0; sm < s->n_sms; sm++)
		if (!!(s->sms[sm].control & EC_SM_DIR_WRITE) == out)
			bytes += ec_pdo_list_bytes(&s->pdos.sm[sm]);
	return bytes;
}

static void scan_bench_identity(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", ARRAY_SIZE(bench));
	u32 i;

	for (i = 0; i < ARRAY_SIZE(bench); i++) {
		struct ec_slave *s = bus_slave(b, i);
		const struct ec_app *app = bus_app(b, bench[i].name);
		const struct ec_app_dev *d = &app->model->dev;

		KUNIT_EXPECT_EQ(test, s->position, i);
		KUNIT_EXPECT_STREQ(test, s->order, bench[i].order);
		KUNIT_EXPECT_STREQ(test, s->order, d->name);
		KUNIT_EXPECT_STREQ(test, s->name, d->title);
		KUNIT_EXPECT_STREQ(test, s->group, d->group);
		KUNIT_EXPECT_EQ(test, s->info.vendor, d->vendor);
		KUNIT_EXPECT_EQ(test, s->info.product, d->product);
		KUNIT_EXPECT_EQ(test, s->info.revision, d->revision);
		KUNIT_EXPECT_EQ(test, s->alias, bench[i].alias);
		KUNIT_EXPECT_EQ(test, s->info.protocols, d->protocols);
		KUNIT_EXPECT_EQ(test, s->info.std.rx_size, d->std.rx_len);
		KUNIT_EXPECT_EQ(test, ec_slave_features(s), d->features | EC_FEAT_FCS_SEPARATE);
		KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
		/* the image is the one in the slave, up to its end mark */
		KUNIT_ASSERT_LE(test, s->eeprom.bytes, app->esc->eep.len);
		KUNIT_EXPECT_GT(test, s->eeprom.bytes, 128ul);
		KUNIT_EXPECT_MEMEQ(test, s->eeprom.data, app->esc->eep.data, s->eeprom.bytes);
	}
}

static void scan_bench_pdos(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", ARRAY_SIZE(bench));
	const struct ec_pdo_list *l = &bus_slave(b, 4)->pdos.sm[2];
	u32 i;

	for (i = 0; i < ARRAY_SIZE(bench); i++) {
		struct ec_slave *s = bus_slave(b, i);

		KUNIT_EXPECT_EQ_MSG(test, pd_bytes(s, false), bench[i].in_bytes, "inputs of %s",
				    bench[i].name);
		KUNIT_EXPECT_EQ_MSG(test, pd_bytes(s, true), bench[i].out_bytes, "outputs of %s",
				    bench[i].name);
	}
	/* outputs of the servo terminal: controlword and velocity */
	KUNIT_ASSERT_EQ(test, l->n, 2);
	KUNIT_EXPECT_EQ(test, l->pdos[0].index, 0x1600);
	KUNIT_EXPECT_EQ(test, l->pdos[0].entries[0].index, 0x7010);
	KUNIT_EXPECT_EQ(test, l->pdos[0].entries[0].bits, 16);
}

static void scan_bench_topology(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", ARRAY_SIZE(bench));
	u32 i, p;

	for (i = 0; i < ARRAY_SIZE(bench); i++) {
		struct ec_slave *s = bus_slave(b, i);

		KUNIT_EXPECT_EQ_MSG(test, bus_next(s, s->graph.upstream), bench[i].parent,
				    "parent of %s",
				    bench[i].name);
		for (p = 0; p < EC_MAX_PORT; p++)
			if (p != s->graph.upstream && bus_next(s, p) != EC_UAPI_NONE16)
				KUNIT_EXPECT_EQ_MSG(test, bench[bus_next(s, p)].parent, i,
						    "port %u of %s", p, bench[i].name);
	}
	/* the fieldbus coupler hangs at the second way out of the first coupler */
	KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, 0), 1), 1);
	KUNIT_EXPECT_EQ(test, bus_next(bus_slave(b, 0), 2), 15);
}

/*
 * Clock and setup of a slave are in its own memory, aligned, and do not overlap. A slave that no
 * worker uses, as one could crash first.
 */
static void scan_parts_of_layers(struct kunit *test)
{
	struct ec_slave *s = ec_slave_alloc(bus_table(bus_new(test, "bench")), 1001);
	struct ec_setup *setup;
	struct ec_clock *c;

	KUNIT_ASSERT_NOT_NULL(test, s);
	c = ec_clock_of(s);
	setup = ec_setup_of(s);
	KUNIT_EXPECT_GE(test, (uintptr_t)c, (uintptr_t)(s + 1));
	KUNIT_EXPECT_GE(test, (uintptr_t)setup, (uintptr_t)(c + 1));
	KUNIT_EXPECT_LE(test, (uintptr_t)(setup + 1), (uintptr_t)s + ksize(s));
	KUNIT_EXPECT_TRUE(test, IS_ALIGNED((uintptr_t)c, __alignof__(*c)));
	KUNIT_EXPECT_TRUE(test, IS_ALIGNED((uintptr_t)setup, __alignof__(*setup)));
	KUNIT_EXPECT_PTR_EQ(test, setup->config, NULL);
	KUNIT_EXPECT_FALSE(test, ec_clock_is_set(s));
	ec_slave_unref(s);
}

/* Station addresses come from an allocator and are different. */
static void scan_stations(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", ARRAY_SIZE(bench));
	u32 i, k;

	for (i = 0; i < ARRAY_SIZE(bench); i++) {
		struct ec_slave *s = bus_slave(b, i);

		KUNIT_EXPECT_EQ(test, s->station,
				get_unaligned_le16(bus_app(b, bench[i].name)->esc->mem +
						   EC_REG_STATION));
		KUNIT_EXPECT_NE(test, s->station, 0);
		for (k = 0; k < i; k++)
			KUNIT_EXPECT_NE(test, s->station, bus_slave(b, k)->station);
	}
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
}

/* Asked for without device: that is done, and nobody who wants the master has to wait. */
static void scan_nothing(struct kunit *test)
{
	struct bus *b = bus_new(test, "bench");
	u32 scans = bus_scans(b);
	u64 t0;

	msleep(100);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), 0);
	msleep(100);
	KUNIT_EXPECT_FALSE(test, bus_rescan_due(b));
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans + 1);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, ec_bus_wait_scan(bus_table(b)), 0);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 1000000ull);
	bus_plug(b);
	KUNIT_EXPECT_NE(test, bus_wait(b, ARRAY_SIZE(bench), EC_AL_PREOP, 10000), ~0ull);
}

/* A user's program that asks for a scan whenever it may keeps no application waiting. */
static int ask_for_scans(void *arg)
{
	struct bus *b = arg;
	struct ec_file other = { };
	int ret, refused = 0;

	ec_file_init(&other, b->m, true);
	while (!kthread_should_stop()) {
		ret = ec_ioc(&other, EC_IOC_RESCAN, NULL);
		refused += ret == -EBUSY && strstr(other.reason, "waits until scans have ended");
		msleep(1);
	}
	return refused;
}

static void scan_asked_without_pause(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", ARRAY_SIZE(bench));
	struct task_struct *t;
	u64 t0;

	bus_idle(b);
	t = kthread_run(ask_for_scans, b, "asker");
	KUNIT_ASSERT_NOT_ERR_OR_NULL(test, t);
	msleep(50);
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_LT(test, ktime_get_ns() - t0, 1000000000ull);
	KUNIT_EXPECT_GT(test, kthread_stop(t), 0);
}

/* One that is too late for a reservation waits for its end; the bus is watched as ever. */
static void scan_while_reserved(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", ARRAY_SIZE(bench));
	const u8 *al = bus_esc(b, 2)->mem + EC_REG_AL_STATUS;
	u32 scans = bus_scans(b), i;
	u64 frames;

	bus_idle(b);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), -EBUSY);
	bus_rescan(b);
	msleep(100);
	frames = bus_frames(b);
	msleep(1000);
	/* looks every 20 ms, some of them in two frames */
	KUNIT_EXPECT_GE(test, bus_frames(b) - frames, 40ull);
	KUNIT_EXPECT_LE(test, bus_frames(b) - frames, 100ull);
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans);
	ec_app_al_fail(bus_app(b, "ai"), EC_AL_INIT, 0x001b, ktime_get_ns());
	/* the master's copy may have that value for less than 100 us: look at the slave's */
	KUNIT_EXPECT_EQ(test, al[0], EC_AL_INIT | EC_AL_ERROR);
	for (i = 0; i < 1200 && al[0] != EC_AL_PREOP; i++)
		msleep(1);
	KUNIT_EXPECT_EQ(test, al[0], EC_AL_PREOP);
	KUNIT_EXPECT_NE(test, bus_wait_al(b, 2, EC_AL_PREOP, 100), ~0ull);
	bus_end(b);
	bus_idle(b);
	KUNIT_EXPECT_EQ(test, bus_scans(b), scans + 1);
}

/* an application that reserves the master, and what it finds then */
struct reservation {
	struct bus *b;
	struct completion done;
	int ret;
	bool busy;
	u32 slaves;
};

static int reserve(void *arg)
{
	struct reservation *r = arg;

	r->ret = ec_ioc(&r->b->app, EC_IOC_RESERVE, NULL);
	r->busy = bus_scan_busy(r->b);
	r->slaves = bus_n_slaves(r->b);
	complete(&r->done);
	return 0;
}

/* A scan that begins between the wait for scans and the reservation is waited for as well. */
static void scan_before_reservation_is_waited_for(struct kunit *test)
{
	struct bus *b = bus_up(test, "bench", ARRAY_SIZE(bench));
	struct reservation r = { .b = b };
	u32 i;

	bus_idle(b);
	init_completion(&r.done);
	down_write(&bus_table(b)->topo);
	KUNIT_EXPECT_FALSE(test, IS_ERR(kthread_run(reserve, &r, "reserve")));
	/* it is in its wait, whose result it gets without the session lock */
	msleep(5);
	KUNIT_EXPECT_TRUE(test, mutex_trylock(bus_mutex(b)));
	up_write(&bus_table(b)->topo);
	msleep(5);
	KUNIT_EXPECT_NULL(test, bus_session(b));
	bus_rescan(b);
	for (i = 0; i < 1000 && !bus_scan_busy(b); i++)
		usleep_range(100, 101);
	KUNIT_EXPECT_TRUE(test, bus_scan_busy(b));
	mutex_unlock(bus_mutex(b));
	wait_for_completion(&r.done);
	KUNIT_EXPECT_EQ(test, r.ret, 0);
	KUNIT_EXPECT_FALSE(test, r.busy);
	KUNIT_EXPECT_EQ(test, r.slaves, (u32)ARRAY_SIZE(bench));
	bus_end(b);
}

/* Module parameters that cannot be meant: no master at all, and no leak. */
static void scan_device_names(struct kunit *test)
{
	char *empty[] = { "bus0", "" }, *twice[] = { "bus0", "bus0" };
	char *macs[] = { "02:00:00:ec:51:0a", "02:00:00:EC:51:0A" };
	char *any[] = { "ff:ff:ff:ff:ff:ff", "FF:FF:FF:FF:FF:FF" }, *none[] = { "" };

	KUNIT_EXPECT_EQ(test, ec_masters_create(empty, 2, NULL, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_masters_create(twice, 2, NULL, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_masters_create(twice, 1, &twice[1], 1, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_masters_create(macs, 2, NULL, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_masters_create(twice, 1, macs, 2, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_cdev_count(), 0u);
	KUNIT_EXPECT_EQ(test, ec_masters_create(any, 2, none, 1, 0), 0);
	KUNIT_EXPECT_EQ(test, ec_cdev_count(), 2u);
	ec_masters_destroy();
}

static struct kunit_case scan_cases[] = {
	KUNIT_CASE(scan_device_names),
	KUNIT_CASE(scan_nothing),
	KUNIT_CASE(scan_asked_without_pause),
	KUNIT_CASE(scan_while_reserved),
	KUNIT_CASE(scan_before_reservation_is_waited_for),
	KUNIT_CASE(scan_bench_identity),
	KUNIT_CASE(scan_bench_pdos),
	KUNIT_CASE(scan_bench_topology),
	KUNIT_CASE(scan_parts_of_layers),
	KUNIT_CASE(scan_stations),
	{}
};

static struct kunit_suite scan_suite = {
	.name = "bus_scan",
	.exit = bus_exit,
	.test_cases = scan_cases,
};

kunit_test_suite(scan_suite);

MODULE_LICENSE("GPL");
