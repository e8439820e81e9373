// SPDX-License-Identifier: GPL-2.0-only
/* Opening, reserving, releasing; what a master that is only opened may not do. */
#include "api.h"

static void version(void)
{
	IS(CALL(ecrt_version_magic)(), ECRT_VERSION_MAGIC);
	IS(ECRT_VERSION_MAGIC, 0x0106);
}

static void opening(void)
{
	ec_master_t *a = CALL(ecrt_open_master)(0), *b = CALL(ecrt_open_master)(0);

	YES(a && b && a != b);
	api_lines();
	errno = 0;
	YES(!CALL(ecrt_open_master)(31));
	IS(errno, ENOENT);
	IS(api_lines(), 1);
	CALL(ecrt_release_master)(a);
	CALL(ecrt_release_master)(b);
}

static void reserving(void)
{
	ec_master_t *a = CALL(ecrt_open_master)(0), *b = CALL(ecrt_open_master)(0);

	NEED(a && b);
	IS(CALL(ecrt_master_reserve)(a), 0);
	SAYS(CALL(ecrt_master_reserve)(b), -EBUSY);
	errno = 0;
	YES(!CALL(ecrt_request_master)(0));
	IS(errno, EBUSY);
	CALL(ecrt_release_master)(a);
	IS(CALL(ecrt_master_reserve)(b), 0);
	CALL(ecrt_release_master)(b);
}

/* The scan is over and all slaves can be talked to when the request returns. */
static void requesting(void)
{
	ec_master_scan_progress_t p;
	ec_master_state_t s;
	ec_master_t *m = CALL(ecrt_request_master)(0);
	uint8_t data[4];
	size_t size = 0;

	NEED(m);
	IS(CALL(ecrt_master_scan_progress)(m, &p), 0);
	IS(p.scan_index, SLAVES);
	IS(CALL(ecrt_master_state)(m, &s), 0);
	IS(s.slaves_responding, SLAVES);
	IS(CALL(ecrt_master_sdo_upload)(m, MOTOR, 0x1018, 1, data, 4, &size, NULL), 0);
	IS(size, 4);
	CALL(ecrt_release_master)(m);
}

static void not_reserved(void)
{
	ec_master_t *m = CALL(ecrt_open_master)(0);
	ec_cycle_config_t cycle = { .period_ns = 1000000 };
	uint32_t time;

	NEED(m);
	errno = 0;
	YES(!CALL(ecrt_master_create_domain)(m));
	IS(errno, EPERM);
	errno = 0;
	YES(!CALL(ecrt_master_slave_config)(m, 0, OUT, BECKHOFF, EL2008));
	IS(errno, EPERM);
	SAYS(CALL(ecrt_master_select_reference_clock)(m, NULL), -EPERM);
	SAYS(CALL(ecrt_master_activate)(m), -EPERM);
	SILENT(CALL(ecrt_master_set_send_interval)(m, 1000), -EPERM);
	SILENT(CALL(ecrt_master_application_time)(m, 1), -EPERM);
	SAYS(CALL(ecrt_master_set_cycle)(m, &cycle), -EPERM);
	SILENT(CALL(ecrt_master_deactivate)(m), -EPERM);
	SILENT(CALL(ecrt_master_send)(m), -EPERM);
	SILENT(CALL(ecrt_master_receive)(m), -EPERM);
	SILENT(CALL(ecrt_master_sync_reference_clock)(m), -EPERM);
	SILENT(CALL(ecrt_master_sync_reference_clock_to)(m, 1), -EPERM);
	SILENT(CALL(ecrt_master_sync_slave_clocks)(m), -EPERM);
	SILENT(CALL(ecrt_master_sync_monitor_queue)(m), -EPERM);
	SILENT(CALL(ecrt_master_reference_clock_time)(m, &time), -EPERM);
	SILENT(CALL(ecrt_master_sync_monitor_process)(m), 0xffffffff);
	CALL(ecrt_release_master)(m);
}

const struct api_case open_cases[] = {
	{ "version", version },
	{ "any number of masters may be opened", opening },
	{ "one is reserved", reserving },
	{ "a request ends with slaves that answer", requesting },
	{ "without reservation", not_reserved },
	{ NULL, NULL },
};
