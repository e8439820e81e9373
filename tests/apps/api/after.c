// SPDX-License-Identifier: GPL-2.0-only
/* Configuration belongs before activation: each call is refused after it. */
#include "api.h"

static struct bench b;

static void begin(void) { NEED(bench_up(&b)); }
static void end(void) { bench_down(&b); }

static void master(void)
{
	ec_cycle_config_t cycle = { .period_ns = 1000000 };

	NEED(b.m);
	errno = 0;
	YES(!CALL(ecrt_master_create_domain)(b.m));
	IS(errno, EBUSY);
	errno = 0;
	/* an existing configuration is found again, a new one is refused */
	YES(CALL(ecrt_master_slave_config)(b.m, 0, OUT, BECKHOFF, EL2008) == b.out);
	YES(!CALL(ecrt_master_slave_config)(b.m, 0, OUT, BECKHOFF, EL7201));
	IS(errno, ENOENT);
	errno = 0;
	YES(!CALL(ecrt_master_slave_config)(b.m, 0, SERVO, BECKHOFF, EL7201));
	IS(errno, EBUSY);
	SAYS(CALL(ecrt_master_activate)(b.m), 0);
	SAYS(CALL(ecrt_master_select_reference_clock)(b.m, b.motor), -EBUSY);
	SILENT(CALL(ecrt_master_set_send_interval)(b.m, 500), -EBUSY);
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &cycle), -EBUSY);
}

static void slave(void)
{
	const ec_sync_info_t sync = { 2, EC_DIR_OUTPUT, 0, NULL, EC_WD_DEFAULT };
	unsigned int byte, bit;
	const ec_pdo_entry_reg_t regs[] = {
		{ 0, OUT, BECKHOFF, EL2008, 0x7010, 1, &byte, &bit },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};
	const uint8_t data[2] = { 0, 0 };

	NEED(b.m);
	SAYS(CALL(ecrt_slave_config_sync_manager)(b.motor, 2, EC_DIR_OUTPUT, EC_WD_DEFAULT), -EBUSY);
	SAYS(CALL(ecrt_slave_config_watchdog)(b.motor, 1, 1), -EBUSY);
	SAYS(CALL(ecrt_slave_config_pdo_assign_add)(b.motor, 2, 0x1601), -EBUSY);
	SAYS(CALL(ecrt_slave_config_pdo_assign_clear)(b.motor, 2), -EBUSY);
	SAYS(CALL(ecrt_slave_config_pdo_mapping_add)(b.motor, 0x1600, 0x6060, 0, 8), -EBUSY);
	SAYS(CALL(ecrt_slave_config_pdo_mapping_clear)(b.motor, 0x1600), -EBUSY);
	SAYS(CALL(ecrt_slave_config_pdos)(b.motor, 1, &sync), -EBUSY);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry)(b.out, 0x7010, 1, b.d, &bit), -EBUSY);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry_pos)(b.out, 0, 1, 0, b.d, &bit), -EBUSY);
	YES(CALL(ecrt_domain_reg_pdo_entry_list)(b.d, regs) < 0);
	SILENT(CALL(ecrt_slave_config_dc)(b.motor, 0x300, 1000000, 0, 0, 0), -EBUSY);
	SAYS(CALL(ecrt_slave_config_sdo)(b.motor, 0x2000, 0, data, 2), -EBUSY);
	SAYS(CALL(ecrt_slave_config_sdo8)(b.motor, 0x2001, 6, 1), -EBUSY);
	SAYS(CALL(ecrt_slave_config_sdo16)(b.motor, 0x2001, 7, 1), -EBUSY);
	SAYS(CALL(ecrt_slave_config_sdo32)(b.motor, 0x2001, 8, 1), -EBUSY);
	SAYS(CALL(ecrt_slave_config_complete_sdo)(b.motor, 0x2001, data, 2), -EBUSY);
	SAYS(CALL(ecrt_slave_config_command)(b.motor, EC_STEP_PS,
		&(ec_command_t){ .kind = EC_COMMAND_SDO, .index = 0x2001, .subindex = 6,
				 .size = 1, .data = data }), -EBUSY);
	SAYS(CALL(ecrt_slave_config_emerg_size)(b.motor, 4), -EBUSY);
	SAYS(CALL(ecrt_slave_config_flag)(b.motor, "AssignToPdi", 1), -EBUSY);
	SAYS(CALL(ecrt_slave_config_state_timeout)(b.motor, EC_AL_STATE_PREOP, EC_AL_STATE_SAFEOP, 1),
	     -EBUSY);
	SAYS(CALL(ecrt_slave_config_sdo_timeout)(b.motor, 1), -EBUSY);
	SAYS(CALL(ecrt_slave_config_replay)(b.motor, EC_REPLAY_ALL), -EBUSY);
	SAYS(CALL(ecrt_slave_config_replay_sdo)(b.motor, 0x6060, 0), -EBUSY);
	IS(CALL(ecrt_slave_config_held)(b.motor), 0);
	errno = 0;
	SAYS(CALL(ecrt_slave_config_idn)(b.motor, 0, 15, EC_AL_STATE_PREOP, data, 2), -EBUSY);
	YES(!CALL(ecrt_slave_config_create_sdo_request)(b.motor, 0x2001, 8, 4));
	YES(!CALL(ecrt_slave_config_create_sdo_request_complete)(b.motor, 0x2001, 4));
	YES(!CALL(ecrt_slave_config_create_soe_request)(b.motor, 0, 15, 4));
	YES(!CALL(ecrt_slave_config_create_voe_handler)(b.motor, 4));
	IS(errno, EBUSY);
	errno = 0;
	YES(!CALL(ecrt_slave_config_create_reg_request)(b.motor, 4));
	YES(!CALL(ecrt_master_create_datagram_request)(b.m, 4));
	IS(errno, EBUSY);
}

/* All that was refused has changed nothing. */
static void still_runs(void)
{
	ec_domain_state_t ds;

	NEED(b.m);
	bench_cycle(&b, 50);
	IS(CALL(ecrt_domain_state)(b.d, &ds), 0);
	IS(ds.wc_state, EC_WC_COMPLETE);
	IS(CALL(ecrt_domain_size)(b.d), 20);
}

const struct api_case after_cases[] = {
	{ "up", begin },
	{ "of the master", master },
	{ "of slaves", slave },
	{ "the cycle goes on", still_runs },
	{ "release", end },
	{ NULL, NULL },
};
