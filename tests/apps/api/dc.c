// SPDX-License-Identifier: GPL-2.0-only
/* Distributed clocks. */
#include "api.h"

static uint32_t last, steps;
static int worst;
static bool lead;	/* the reference clock follows this application */

/* what an application with clocks does in a cycle */
static void clocks(struct bench *b)
{
	uint32_t now;
	int ret;

	ret = CALL(ecrt_master_reference_clock_time)(b->m, &now);
	if (!ret) {
		int d = (int)(now - last) - 1000000;

		if (last && steps++ > 1000)
			worst = d > worst ? d : -d > worst ? -d : worst;
		last = now;
	}
	IS(CALL(ecrt_master_application_time)(b->m, b->cycles * 1000000ULL), 0);
	if (lead)
		IS(CALL(ecrt_master_sync_reference_clock)(b->m), 0);
	IS(CALL(ecrt_master_sync_slave_clocks)(b->m), 0);
	IS(CALL(ecrt_master_sync_monitor_queue)(b->m), 0);
}

static void in_step(void)
{
	struct bench b;
	uint32_t now;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_application_time)(b.m, 1000), 0);
	IS(CALL(ecrt_slave_config_dc)(b.motor, 0x0300, 1000000, 0, 0, 0), 0);
	NEED(bench_activate(&b));
	/* before anything was queued */
	SILENT(CALL(ecrt_master_sync_monitor_process)(b.m), 0xffffffff);
	SILENT(CALL(ecrt_master_reference_clock_time)(b.m, &now), -EIO);
	SILENT(CALL(ecrt_master_reference_clock_time)(b.m, NULL), -EINVAL);
	b.each = clocks;
	last = steps = 0;
	worst = 0;
	lead = false;
	NEED(bench_op(&b));
	bench_cycle(&b, 2000);
	/* an OR of magnitudes: below the next power of two */
	IS(CALL(ecrt_master_sync_monitor_process)(b.m) & ~1023u, 0);
	YES(steps > 1500);
	/* one cycle of reference time goes by in each cycle */
	YES(worst < 500000);
	bench_down(&b);
}

/* The reference clock of a drive that is 100 ppm slow follows the application. */
static void leads(void)
{
	uint32_t now = 0;
	struct bench b;
	int off = 0;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_application_time)(b.m, 1000), 0);
	IS(CALL(ecrt_slave_config_dc)(b.motor, 0x0300, 1000000, 0, 0, 0), 0);
	IS(CALL(ecrt_master_select_reference_clock)(b.m, b.motor), 0);
	NEED(bench_activate(&b));
	b.each = clocks;
	lead = true;
	NEED(bench_op(&b));
	bench_cycle(&b, 5000);
	SILENT(CALL(ecrt_master_sync_reference_clock_to)(b.m, b.cycles * 1000000ULL), 0);
	bench_cycle(&b, 1);
	CALL(ecrt_master_receive)(b.m);
	IS(CALL(ecrt_master_reference_clock_time)(b.m, &now), 0);
	/* the time told with that frame; on its own it would be 500 us behind */
	off = (int)(now - (uint32_t)((b.cycles - 1) * 1000000ULL));
	YES(off > -200000 && off < 200000);
	bench_down(&b);
}

/* The chosen reference is not there: all clock calls say so, without a word. */
static void no_clock(void)
{
	ec_slave_config_t *nobody;
	ec_domain_state_t ds;
	struct bench b;
	uint32_t now;

	NEED(bench_request(&b) && bench_configure(&b));
	nobody = CALL(ecrt_master_slave_config)(b.m, 0, NOWHERE, BECKHOFF, EL2008);
	IS(CALL(ecrt_master_select_reference_clock)(b.m, nobody), 0);
	/* what makes the master set clocks at all */
	IS(CALL(ecrt_slave_config_dc)(b.motor, 0x0300, 1000000, 0, 0, 0), 0);
	NEED(bench_activate(&b));
	/* the clock of the application before is none of this one, not for one cycle */
	for (int i = 0; i < 100; i++) {
		IS(CALL(ecrt_master_sync_slave_clocks)(b.m), -ENXIO);
		bench_cycle(&b, 1);
	}
	SILENT(CALL(ecrt_master_sync_reference_clock)(b.m), -ENXIO);
	SILENT(CALL(ecrt_master_sync_reference_clock_to)(b.m, 5), -ENXIO);
	SILENT(CALL(ecrt_master_sync_slave_clocks)(b.m), -ENXIO);
	SILENT(CALL(ecrt_master_reference_clock_time)(b.m, &now), -ENXIO);
	SILENT(CALL(ecrt_master_sync_monitor_queue)(b.m), 0);
	IS(CALL(ecrt_domain_state)(b.d, &ds), 0);
	bench_down(&b);
}

/* Another reference than the first clock of the line. */
static void chosen(void)
{
	struct bench b;
	uint32_t now;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_select_reference_clock)(b.m, b.motor), 0);
	IS(CALL(ecrt_slave_config_dc)(b.motor, 0x0300, 1000000, 0, 0, 0), 0);
	NEED(bench_activate(&b));
	b.each = NULL;
	for (int i = 0; i < 3000; i++) {
		CALL(ecrt_master_application_time)(b.m, b.cycles * 1000000ULL);
		CALL(ecrt_master_sync_slave_clocks)(b.m);
		bench_cycle(&b, 1);
	}
	NEED(bench_op(&b));
	IS(CALL(ecrt_master_sync_slave_clocks)(b.m), 0);
	bench_cycle(&b, 1);
	/* the frame is back in the next cycle */
	bench_sleep();
	CALL(ecrt_master_receive)(b.m);
	IS(CALL(ecrt_master_reference_clock_time)(b.m, &now), 0);
	bench_down(&b);
}

const struct api_case dc_cases[] = {
	{ "clocks in step", in_step },
	{ "a reference clock that follows", leads },
	{ "without reference clock", no_clock },
	{ "with a chosen one", chosen },
	{ NULL, NULL },
};
