// SPDX-License-Identifier: GPL-2.0-only
/* Clocks are measured and set; no application tells a time in a cycle. */
#include <linux/slab.h>
#include "master/base/once64.h"
#include "master/clock/dc.h"
#include "master/clock/dc_app.h"
#include "master/carry/xfer.h"
#include "scanned.h"

#define SLAVES	3

struct bench {
	struct scanned s;
	struct ec_dc dc;
	struct workqueue_struct *service;
};

static void bench_free(struct bench *b)
{
	ec_dc_exit(&b->dc);
	destroy_workqueue(b->service);
	scanned_end(&b->s);
	kvfree(b);
}

static struct bench *bench_new(const char *text)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	b->service = alloc_workqueue("ec_alone", WQ_UNBOUND, 0);
	if (!CHECK(b->service) || !scanned_begin(&b->s, text)) {
		kvfree(b);
		return NULL;
	}
	ec_dc_init(&b->dc, &b->s.seg.base, &b->s.seg.links, &b->s.bus, b->service);
	if (scanned_scan(&b->s, SLAVES))
		return b;
	bench_free(b);
	return NULL;
}

/* 100 m of copper are some 500 ns */
static const char text[] =
	"segment seed=3\n"
	"slave a drive in=8 out=8 drift=10ppm\n"
	"slave b drive in=8 out=8 cable=100 drift=-20ppm\n"
	"slave c drive in=8 out=8 cable=100 drift=30ppm\n";

static void delays_follow_the_cables(void)
{
	struct bench *b = bench_new(text);
	u32 delay[SLAVES];
	unsigned int i;

	if (!b)
		return;
	CHECK_EQ(ec_dc_measure(&b->dc), 0);
	CHECK(b->dc.ref == b->s.bus.slaves[0]);
	CHECK_EQ(b->dc.ref_station, b->s.bus.slaves[0]->station);
	for (i = 0; i < SLAVES; i++)
		delay[i] = ec_clock_of(b->s.bus.slaves[i])->delay;
	CHECK_EQ(delay[0], 0);
	CHECK_OP(delay[1], >, 400);
	CHECK_OP(delay[1], <, 1500);
	/* the same cable once more */
	CHECK_OP(abs((s32)(delay[2] - 2 * delay[1])), <, 50);
	bench_free(b);
}

static void segment_without_clocks_has_no_reference(void)
{
	struct bench *b = bench_new("segment seed=3\n"
				    "repeat 3 slave a drive in=8 out=8 dc=none\n");

	if (!b)
		return;
	CHECK_EQ(ec_dc_measure(&b->dc), -ENXIO);
	CHECK(!b->dc.ref);
	CHECK_EQ(b->dc.ref_station, 0);
	bench_free(b);
}

static bool decided(void *dc)
{
	int state = READ_ONCE(((struct ec_dc *)dc)->state);

	return state == EC_DC_READY || state == EC_DC_FAILED;
}

static void clocks_get_application_time(void)
{
	const u64 at = 1000ull * NSEC_PER_SEC;
	struct bench *b = bench_new(text);
	u64 set_ns, time[SLAVES], now;
	struct ec_dg dg[SLAVES];
	unsigned int i;

	if (!b)
		return;
	CHECK_EQ(ec_dc_measure(&b->dc), 0);
	set_ns = ktime_get_ns();
	ec_dc_app_time(&b->dc, at, set_ns);
	ec_dc_begin(&b->dc, EC_DC_ANY);
	CHECK(alone_wait(decided, &b->dc, 10000));
	CHECK_EQ(b->dc.state, EC_DC_READY);
	for (i = 0; i < SLAVES; i++) {
		dg[i] = (struct ec_dg)EC_DG(EC_CMD_FPRD, b->s.bus.slaves[i]->station,
					    EC_REG_DC_SYSTIME, 8, &time[i]);
		CHECK(ec_clock_is_set(b->s.bus.slaves[i]));
	}
	/* one frame: all at once, but for its way */
	CHECK_EQ(ec_xfer_all(&b->s.seg.links, dg, SLAVES), 0);
	now = at + dg[0].sent_ns - set_ns;
	for (i = 0; i < SLAVES; i++) {
		CHECK_OP(abs((s64)(le64_to_cpu((__force __le64)time[i]) - now)), <,
			 NSEC_PER_MSEC);
		CHECK_OP(abs((s64)(time[i] - time[0])), <, 10000);
	}
	ec_dc_end(&b->dc);
	CHECK_EQ(b->dc.state, EC_DC_OFF);
	CHECK_EQ(b->dc.has_phase, false);
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(delays_follow_the_cables),
	TEST(segment_without_clocks_has_no_reference),
	TEST(clocks_get_application_time),
	{ }
};
