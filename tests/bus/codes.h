/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * What the functions of ecrt.h return that are written once for userspace and kernel: one list,
 * which tests/apps/api runs through /dev/EtherCAT0 and bus_kapi_codes with the exported
 * functions. CODE(have, want), MISSING(pointer) and CODES_NO_SLAVE, the one code that differs,
 * come from there. So do the codes of a running cycle, which need a configured application
 * (codes_cycle_runs()).
 */
#ifndef EC_CODES_H
#define EC_CODES_H

#define CODES_NOWHERE	77	/* a ring position without slave */

static void codes_slaves(ec_master_t *m, uint16_t coe, uint16_t plain)
{
	uint8_t buf[8];
	uint32_t abort = 1;
	uint16_t error = 1;
	ec_pdo_entry_info_t entry;
	ec_slave_info_t slave;
	ec_sync_info_t sync;
	ec_pdo_info_t pdo;
	size_t size;

	CODE(ecrt_master_get_slave(m, CODES_NOWHERE, &slave), CODES_NO_SLAVE);
	CODE(ecrt_master_get_slave(m, coe, NULL), -EINVAL);
	CODE(ecrt_master_get_sync_manager(m, coe, 2, &sync), 0);
	CODE(ecrt_master_get_sync_manager(m, coe, 16, &sync), -ENOENT);
	CODE(ecrt_master_get_sync_manager(m, coe, 15, &sync), -EINVAL);
	CODE(ecrt_master_get_sync_manager(m, CODES_NOWHERE, 2, &sync), -EINVAL);
	CODE(ecrt_master_get_pdo(m, coe, 16, 0, &pdo), -ENOENT);
	CODE(ecrt_master_get_pdo(m, coe, 2, 99, &pdo), -EINVAL);
	CODE(ecrt_master_get_pdo_entry(m, coe, 2, 0, 99, &entry), -EINVAL);
	CODE(ecrt_master_sdo_upload(m, CODES_NOWHERE, 0x1018, 1, buf, 4, &size, &abort), -EINVAL);
	CODE(abort, 0);
	CODE(ecrt_master_sdo_upload(m, plain, 0x1018, 1, buf, 4, &size, &abort), -EPROTONOSUPPORT);
	CODE(ecrt_master_sdo_upload(m, coe, 0x1018, 1, buf, 3, &size, &abort), -ENOBUFS);
	CODE(ecrt_master_sdo_upload(m, coe, 0x1018, 1, NULL, 4, &size, &abort), -EINVAL);
	CODE(ecrt_master_sdo_upload(m, coe, 0x3fff, 1, buf, 4, &size, &abort), -EIO);
	CODE(abort, 0x06020000);
	CODE(ecrt_master_sdo_download(m, coe, 0x1018, 1, buf, 0, &abort), -EINVAL);
	CODE(ecrt_master_sdo_download(m, coe, 0x1018, 1, buf, 65537, &abort), -EINVAL);
	CODE(ecrt_master_sdo_download(m, CODES_NOWHERE, 0x1018, 1, buf, 4, &abort), -EINVAL);
	CODE(ecrt_master_read_idn(m, coe, 8, 91, buf, 4, &size, &error), -EINVAL);
	CODE(error, 0);
	CODE(ecrt_master_read_idn(m, CODES_NOWHERE, 0, 91, buf, 4, &size, &error), -EINVAL);
	CODE(ecrt_master_read_idn(m, plain, 0, 91, buf, 4, &size, &error), -EPROTONOSUPPORT);
	CODE(ecrt_master_write_idn(m, coe, 0, 91, NULL, 4, &error), -EINVAL);
	CODE(ecrt_master_write_idn(m, coe, 0, 91, buf, 0, &error), -EINVAL);
}

static void codes_pdos(ec_slave_config_t *sc, ec_domain_t *d)
{
	static const ec_sync_info_t beyond[] = { { 16, EC_DIR_OUTPUT, 0, NULL, EC_WD_DEFAULT } };
	static const ec_pdo_entry_reg_t no_place[] = { { .index = 0x6000 }, { .index = 0 } };

	CODE(ecrt_slave_config_sync_manager(sc, 16, EC_DIR_OUTPUT, EC_WD_DEFAULT), -ENOENT);
	CODE(ecrt_slave_config_sync_manager(sc, 2, EC_DIR_INVALID, EC_WD_DEFAULT), -EINVAL);
	CODE(ecrt_slave_config_sync_manager(sc, 2, EC_DIR_COUNT, EC_WD_DEFAULT), -EINVAL);
	CODE(ecrt_slave_config_sync_manager(sc, 2, EC_DIR_OUTPUT, (ec_watchdog_mode_t)3), -EINVAL);
	CODE(ecrt_slave_config_pdo_assign_add(sc, 16, 0x1600), -EINVAL);
	CODE(ecrt_slave_config_pdo_assign_clear(sc, 16), -EINVAL);
	CODE(ecrt_slave_config_pdo_mapping_add(sc, 0x16f0, 0x7000, 1, 8), -ENOENT);
	CODE(ecrt_slave_config_pdo_mapping_clear(sc, 0x16f0), 0);
	CODE(ecrt_slave_config_pdos(sc, 1, beyond), -ENOENT);
	CODE(ecrt_slave_config_pdos(sc, 1, NULL), 0);
	CODE(ecrt_slave_config_reg_pdo_entry(sc, 0x7fff, 1, d, NULL), -ENOENT);
	CODE(ecrt_slave_config_reg_pdo_entry(sc, 0x7fff, 1, NULL, NULL), -EINVAL);
	CODE(ecrt_slave_config_reg_pdo_entry_pos(sc, 16, 0, 0, d, NULL), -EINVAL);
	CODE(ecrt_slave_config_reg_pdo_entry_pos(sc, 2, 99, 0, d, NULL), -ENOENT);
	CODE(ecrt_domain_reg_pdo_entry_list(d, no_place), -EINVAL);
	CODE(ecrt_domain_set_options(d, 1 << 30), -EOPNOTSUPP);
	CODE(ecrt_domain_set_options(d, EC_DOMAIN_OVERLAP | EC_DOMAIN_SEPARATE), -EINVAL);
}

static void codes_config(ec_slave_config_t *sc)
{
	static const char key[] = "a name of 64 characters is one more than there is a place for it";
	uint8_t buf[8] = { 0 };

	CODE(sizeof(key), 65);
	CODE(ecrt_slave_config_flag(sc, key, 1), -EINVAL);
	CODE(ecrt_slave_config_flag(sc, key + 1, 1), 0);
	CODE(ecrt_slave_config_flag(sc, "", 1), -EINVAL);
	CODE(ecrt_slave_config_flag(sc, NULL, 1), -EINVAL);
	CODE(ecrt_slave_config_sdo(sc, 0x2000, 1, NULL, 4), -EINVAL);
	CODE(ecrt_slave_config_sdo(sc, 0x2000, 1, buf, 0), -EINVAL);
	CODE(ecrt_slave_config_sdo(sc, 0x2000, 1, buf, 65537), -EINVAL);
	CODE(ecrt_slave_config_complete_sdo(sc, 0x2000, buf, 0), -EINVAL);
	CODE(ecrt_slave_config_idn(sc, 8, 91, EC_AL_STATE_PREOP, buf, 4), -EINVAL);
	CODE(ecrt_slave_config_idn(sc, 0, 91, EC_AL_STATE_OP, buf, 4), -EINVAL);
	CODE(ecrt_slave_config_idn(sc, 0, 91, EC_AL_STATE_PREOP, NULL, 4), -EINVAL);
	CODE(ecrt_slave_config_state_timeout(sc, (ec_al_state_t)3, EC_AL_STATE_OP, 1), -EINVAL);
	CODE(ecrt_slave_config_state_timeout(sc, (ec_al_state_t)(256 + 2), EC_AL_STATE_OP, 1),
	     -EINVAL);
	CODE(ecrt_slave_config_eoe_mac_address(sc, NULL), -EINVAL);
	CODE(ecrt_slave_config_eoe_hostname(sc, NULL), -EINVAL);
	CODE(ecrt_slave_config_emerg_size(sc, 1 << 20), -ENOMEM);
	CODE(ecrt_slave_config_sdo_timeout(sc, 60001), -EINVAL);
	CODE(ecrt_slave_config_sdo_timeout(sc, 60000), 0);
	CODE(ecrt_slave_config_sdo_timeout(sc, 0), 0);
	CODE(ecrt_slave_config_replay(sc, (ec_replay_t)3), -EINVAL);
	CODE(ecrt_slave_config_replay(sc, EC_REPLAY_ALL), 0);
	CODE(ecrt_slave_config_replay(sc, EC_REPLAY_DEFAULT), 0);
	CODE(ecrt_slave_config_replay_idn(sc, 8, 91), -EINVAL);
	CODE(ecrt_slave_config_held(sc), 0);
	CODE(ecrt_slave_config_resume(sc, 0), -EINVAL);
	CODE(ecrt_slave_config_resume(sc, 1), -ESTALE);
	CODE(ecrt_slave_config_overlapping_pdos(sc, 7), 0);
	CODE(ecrt_slave_config_overlapping_pdos(sc, 0), 0);
}

/* Before activation: what can be seen of sizes. */
static void codes_requests(ec_slave_config_t *sc)
{
	ec_reg_request_t *reg = ecrt_slave_config_create_reg_request(sc, 4);
	ec_sdo_request_t *sdo = ecrt_slave_config_create_sdo_request_complete(sc, 0x1018, 4);
	ec_soe_request_t *soe = ecrt_slave_config_create_soe_request(sc, 7, 91, 4);

	MISSING(ecrt_slave_config_create_sdo_request(sc, 0x1018, 1, 1 << 20));
	MISSING(ecrt_slave_config_create_reg_request(sc, 1025));
	MISSING(ecrt_slave_config_create_soe_request(sc, 8, 91, 4));
	MISSING(ecrt_slave_config_create_voe_handler(sc, 1 << 20));
	CODE(ecrt_reg_request_read(reg, 0x0120, 5), -ENOBUFS);
	CODE(ecrt_reg_request_write(reg, 0x0120, 5), -ENOBUFS);
	CODE(ecrt_reg_request_readwrite(reg, 0x0120, 5), -ENOBUFS);
	CODE(ecrt_reg_request_read(reg, 0x0120, 0), -EINVAL);
	CODE(ecrt_reg_request_read(reg, 0x0120, 4), -EINVAL);
	CODE(ecrt_sdo_request_write_with_size(sdo, 0), -EINVAL);
	CODE(ecrt_sdo_request_write_with_size(sdo, 5), -ENOBUFS);
	CODE(ecrt_sdo_request_write_with_size(sdo, 4), -EINVAL);
	CODE(ecrt_sdo_request_state(sdo), EC_REQUEST_UNUSED);
	CODE(ecrt_soe_request_idn(soe, 8, 91), -EINVAL);
	CODE(ecrt_soe_request_idn(soe, 0, 91), 0);
	CODE(ecrt_soe_request_write(soe), -EINVAL);
}

static void codes_cycle(ec_master_t *m, ec_domain_t *d)
{
	const ec_cycle_config_t good = { .period_ns = 1000000 };
	const struct {
		ec_cycle_config_t config;
		int code;
	} t[] = {
		{ { .period_ns = 0 }, -EINVAL },
		{ { .period_ns = 9999 }, -EINVAL },
		{ { .period_ns = 10000 }, 0 },
		{ { .period_ns = 1000000000 }, 0 },
		{ { .period_ns = 1000000001 }, -EINVAL },
		{ { .period_ns = 1000000, .phase_ns = 999999 }, 0 },
		{ { .period_ns = 1000000, .phase_ns = 1000000 }, -EINVAL },
		{ { .period_ns = 1000000, .priority = 98 }, 0 },
		{ { .period_ns = 1000000, .priority = 99 }, -EINVAL },
		{ { .period_ns = 1000000, .cpu = -1 }, 0 },
		{ { .period_ns = 1000000, .cpu = 1 }, -EINVAL },
		{ { .period_ns = 1000000, .cpu = -1, .flags = EC_CYCLE_BIND_CPU }, -EINVAL },
		{ { .period_ns = 1000000, .cpu = 100000, .flags = EC_CYCLE_BIND_CPU }, -EINVAL },
		{ { .period_ns = 1000000, .stall = (ec_cycle_stall_t)3 }, -EINVAL },
		{ { .period_ns = 1000000, .dc = 1 }, -EOPNOTSUPP },
		{ { .period_ns = 1000000, .dc = EC_CYCLE_FOLLOW_REFERENCE }, -EINVAL },
		{ { .period_ns = 1000000, .flags = 1U << 30 }, -EOPNOTSUPP },
		{ { .period_ns = 1000000, .flags = EC_CYCLE_DETACH }, 0 },
		{ { .period_ns = 1000000, .flags = EC_CYCLE_DETACH, .stall = EC_CYCLE_STOP },
		  -EINVAL },
	};
	ec_cycle_state_t state;
	size_t i;

	for (i = 0; i < sizeof(t) / sizeof(t[0]); i++)
		CODE(ecrt_master_set_cycle(m, &t[i].config), t[i].code);
	CODE(ecrt_master_set_cycle(m, NULL), 0);
	CODE(ecrt_master_set_cycle(NULL, &good), -EINVAL);
	CODE(ecrt_domain_set_division(d, 0, 0), -EINVAL);
	CODE(ecrt_domain_set_division(d, 1001, 0), -EINVAL);
	CODE(ecrt_domain_set_division(d, 4, 4), -EINVAL);
	CODE(ecrt_domain_set_division(d, 4, 3), 0);
	CODE(ecrt_domain_set_division(NULL, 1, 0), -EINVAL);
	/* a division needs a cycle that the kernel runs */
	CODE(ecrt_master_activate(m), -EOPNOTSUPP);
	CODE(ecrt_domain_set_division(d, 1, 0), 0);
	CODE(ecrt_domain_copy(d, 0, 0, NULL, 0, 0, 1), -EINVAL);
	CODE(ecrt_domain_copy(d, 0, 0, d, 0, 0, 0), -EINVAL);
	CODE(ecrt_domain_copy(d, 1U << 30, 0, d, 0, 0, 1), -EINVAL);
	CODE(ecrt_domain_copy(d, 0, 0, d, 100, 0, 8), -EINVAL);
	CODE(ecrt_master_end_detached(m), -EBUSY);
	CODE(ecrt_master_end_detached(NULL), -EINVAL);
	CODE(ecrt_master_wait_cycle(m, 0), -EINVAL);
	CODE(ecrt_master_wait_cycle(NULL, 0), -EINVAL);
	CODE(ecrt_master_cycle_count(m), 0);
	CODE(ecrt_master_cycle_inputs(m, NULL, NULL), -EINVAL);
	CODE(ecrt_master_cycle_state(m, &state), -EINVAL);
}

/* @m: reserved, not active; @coe, @plain: slaves with and without a mailbox */
static void codes_all(ec_master_t *m, uint16_t coe, uint16_t plain)
{
	ec_domain_t *d = ecrt_master_create_domain(m);
	ec_slave_config_t *sc;
	ec_slave_info_t slave;

	CODE(ecrt_master_get_slave(m, coe, &slave), 0);
	sc = ecrt_master_slave_config(m, 0, coe, slave.vendor_id, slave.product_code);
	MISSING(ecrt_master_slave_config(m, 0, coe, slave.vendor_id, slave.product_code + 1));
	codes_slaves(m, coe, plain);
	codes_pdos(sc, d);
	codes_config(sc);
	codes_requests(sc);
	CODE(ecrt_master_set_send_interval(m, 0), -EINVAL);
	CODE(ecrt_master_set_send_interval(m, 1000), 0);
	CODE(ecrt_master_set_late_cycles(m, 100001), -EINVAL);
	CODE(ecrt_master_select_reference_clock(m, sc), 0);
	CODE(ecrt_master_select_reference_clock(m, NULL), 0);
	CODE(ecrt_master_deactivate(m), -EINVAL);
	codes_cycle(m, d);
}

/* @m: active, the kernel runs its cycle of 1 s; @d: domain with process data */
static void codes_cycle_runs(ec_master_t *m, ec_domain_t *d)
{
	const ec_cycle_config_t good = { .period_ns = 1000000 };
	uint64_t cycle = 0, time = 1;
	ec_cycle_state_t state;

	CODE(ecrt_master_set_cycle(m, &good), -EBUSY);
	CODE(ecrt_domain_set_division(d, 1, 0), -EBUSY);
	CODE(ecrt_domain_copy(d, 0, 0, d, 0, 0, 1), -EBUSY);
	CODE(ecrt_master_end_detached(m), -EBUSY);
	CODE(ecrt_master_cycle_inputs(m, &cycle, &time), -ENODATA);
	CODE(ecrt_master_wait_cycle(m, 0), 1);
	CODE(ecrt_master_wait_cycle(m, 10), -ETIMEDOUT);
	CODE(ecrt_master_receive(m), 0);
	CODE(ecrt_master_cycle_inputs(m, &cycle, &time), 0);
	CODE(ecrt_master_cycle_inputs(m, NULL, NULL), 0);
	CODE(cycle, ecrt_master_cycle_count(m));
	CODE(time % 1000000000, 0);
	CODE(ecrt_domain_process(d), 0);
	CODE(ecrt_domain_queue(d), 0);
	CODE(ecrt_master_send(m), 0);
	CODE(ecrt_master_application_time(m, 1), 0);
	CODE(ecrt_master_cycle_state(m, NULL), -EINVAL);
	CODE(ecrt_master_cycle_state(m, &state), 0);
	CODE(state.run, EC_CYCLE_RUNNING);
	CODE(state.cycles, cycle);
	CODE(ecrt_master_deactivate(m), 0);
	CODE(ecrt_master_wait_cycle(m, 0), -EINVAL);
	CODE(ecrt_master_receive(m), -EINVAL);
	CODE(ecrt_master_send(m), -EINVAL);
	CODE(ecrt_master_cycle_count(m), 0);
}

#endif
