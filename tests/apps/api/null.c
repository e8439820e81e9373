// SPDX-License-Identifier: GPL-2.0-only
/*
 * A handle of NULL, as from a call that failed and was not checked, is answered
 * and does no harm. These calls do not count as tests of the functions.
 */
#include <stdlib.h>

#include "api.h"

static void master(void)
{
	union {
		ec_master_info_t info;
		ec_master_scan_progress_t progress;
		ec_master_state_t state;
		ec_master_link_state_t link;
		ec_slave_info_t slave;
		ec_sync_info_t sync;
		ec_pdo_info_t pdo;
		ec_pdo_entry_info_t entry;
		ec_cycle_config_t cycle;
		ec_cycle_state_t cycle_state;
		ec_sdo_object_info_t object;
		ec_sdo_entry_info_t described;
		uint16_t list[2];
	} u;
	uint8_t data[4] = { 0 };
	uint64_t time64;
	uint32_t time;
	size_t size;

	api_lines();
	ecrt_release_master(NULL);
	IS(ecrt_master_reserve(NULL), -EINVAL);
	YES(!ecrt_master_create_domain(NULL));
	YES(!ecrt_master_slave_config(NULL, 0, 0, 1, 1));
	IS(ecrt_master_select_reference_clock(NULL, NULL), -EINVAL);
	IS(ecrt_master(NULL, &u.info), -EINVAL);
	IS(ecrt_master_scan_progress(NULL, &u.progress), -EINVAL);
	IS(ecrt_master_read_eeprom(NULL, 0, 0, data, 4, &size), -EINVAL);
	IS(ecrt_master_write_eeprom(NULL, 0, 0, data, 4, 0, NULL), -EINVAL);
	IS(ecrt_master_write_alias(NULL, 0, 1, 0, NULL), -EINVAL);
	IS(ecrt_master_get_slave(NULL, 0, &u.slave), -EINVAL);
	IS(ecrt_master_get_sync_manager(NULL, 0, 0, &u.sync), -EINVAL);
	IS(ecrt_master_get_pdo(NULL, 0, 0, 0, &u.pdo), -EINVAL);
	IS(ecrt_master_get_pdo_entry(NULL, 0, 0, 0, 0, &u.entry), -EINVAL);
	IS(ecrt_master_sdo_download(NULL, 0, 1, 1, data, 4, &time), -EINVAL);
	IS(ecrt_master_sdo_download_complete(NULL, 0, 1, data, 4, &time), -EINVAL);
	IS(ecrt_master_sdo_upload(NULL, 0, 1, 1, data, 4, &size, &time), -EINVAL);
	IS(ecrt_master_activate(NULL), -EINVAL);
	IS(ecrt_master_deactivate(NULL), -EINVAL);
	IS(ecrt_master_leave(NULL), -EINVAL);
	IS(ecrt_master_set_names(NULL, "", 0), -EINVAL);
	IS(ecrt_master_set_data(NULL, data, free), -EINVAL);
	YES(!ecrt_master_data(NULL, free));
	IS(ecrt_master_set_late_cycles(NULL, 1), -EINVAL);
	IS(ecrt_master_group(NULL, NULL), -EINVAL);
	YES(!ecrt_master_group_config(NULL, 0, 0, 1, 1));
	IS(ecrt_master_set_send_interval(NULL, 1000), -EINVAL);
	IS(ecrt_master_send(NULL), -EINVAL);
	IS(ecrt_master_receive(NULL), -EINVAL);
	IS(ecrt_master_state(NULL, &u.state), -EINVAL);
	IS(ecrt_master_link_state(NULL, 0, &u.link), -EINVAL);
	IS(ecrt_master_application_time(NULL, 1), -EINVAL);
	IS(ecrt_master_sync_reference_clock(NULL), -EINVAL);
	IS(ecrt_master_sync_reference_clock_to(NULL, 1), -EINVAL);
	IS(ecrt_master_sync_slave_clocks(NULL), -EINVAL);
	IS(ecrt_master_reference_clock_time(NULL, &time), -EINVAL);
	IS(ecrt_master_sync_monitor_queue(NULL), -EINVAL);
	IS(ecrt_master_sync_monitor_process(NULL), 0xffffffff);
	IS(ecrt_master_reset(NULL), -EINVAL);
	IS(ecrt_master_setup_domain_memory(NULL), -EINVAL);
	ecrt_master_deactivate_slaves(NULL);
	IS(ecrt_master_rt_slave_requests(NULL, 1), -EINVAL);
	ecrt_master_exec_slave_requests(NULL);
	IS(ecrt_master_eoe_addif(NULL, 0, 0), -EINVAL);
	IS(ecrt_master_eoe_delif(NULL, 0, 0), -EINVAL);
	IS(ecrt_master_eoe_is_open(NULL), -EINVAL);
	IS(ecrt_master_eoe_process(NULL), -EINVAL);
	IS(ecrt_master_sdo_upload_complete(NULL, 0, 1, data, 4, &size, &time), -EINVAL);
	IS(ecrt_master_foe_read(NULL, 0, "a", 0, data, 4, &size, &time, 0), -EINVAL);
	IS(ecrt_master_sdo_info_list(NULL, 0, 1, u.list, 2, &size, &time), -EINVAL);
	IS(ecrt_master_sdo_info_forget(NULL, 0), -EINVAL);
	IS(ecrt_master_sdo_info_object(NULL, 0, 1, &u.object, &time), -EINVAL);
	IS(ecrt_master_sdo_info_entry(NULL, 0, 1, 1, &u.described, &time), -EINVAL);
	IS(ecrt_master_foe_write(NULL, 0, "a", 0, data, 4, &time, 0), -EINVAL);
	ecrt_master_64bit_reference_clock_time_queue(NULL);
	IS(ecrt_master_64bit_reference_clock_time(NULL, &time64), -EINVAL);
	IS(ecrt_master_reason(NULL, (char *)data, 4), -EINVAL);
	IS(ecrt_master_set_cycle(NULL, &u.cycle), -EINVAL);
	IS(ecrt_master_wait_cycle(NULL, 1), -EINVAL);
	IS(ecrt_master_cycle_count(NULL), 0);
	IS(ecrt_master_cycle_fd(NULL), -EINVAL);
	IS(ecrt_master_cycle_inputs(NULL, NULL, NULL), -EINVAL);
	IS(ecrt_master_cycle_state(NULL, &u.cycle_state), -EINVAL);
	IS(ecrt_master_end_detached(NULL), -EINVAL);
	IS(api_lines(), 0);
}

static void slave_config(void)
{
	const ec_sync_info_t syncs = { 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT };
	const struct in_addr ip = { 0 };
	ec_slave_config_dc_state_t dc;
	ec_slave_config_state_t state;
	uint8_t data[8] = { 0 };

	api_lines();
	IS(ecrt_slave_config_sync_manager(NULL, 2, EC_DIR_INPUT, EC_WD_DEFAULT), -EINVAL);
	IS(ecrt_slave_config_watchdog(NULL, 1, 1), -EINVAL);
	IS(ecrt_slave_config_pdo_assign_add(NULL, 2, 1), -EINVAL);
	IS(ecrt_slave_config_pdo_assign_clear(NULL, 2), -EINVAL);
	IS(ecrt_slave_config_pdo_mapping_add(NULL, 1, 1, 1, 1), -EINVAL);
	IS(ecrt_slave_config_pdo_mapping_clear(NULL, 1), -EINVAL);
	IS(ecrt_slave_config_pdos(NULL, EC_END, &syncs), -EINVAL);
	IS(ecrt_slave_config_reg_pdo_entry(NULL, 1, 1, NULL, NULL), -EINVAL);
	IS(ecrt_slave_config_reg_pdo_entry_pos(NULL, 1, 1, 1, NULL, NULL), -EINVAL);
	IS(ecrt_slave_config_dc(NULL, 0x300, 1, 1, 0, 0), -EINVAL);
	IS(ecrt_slave_config_sdo(NULL, 1, 1, data, 1), -EINVAL);
	IS(ecrt_slave_config_sdo8(NULL, 1, 1, 1), -EINVAL);
	IS(ecrt_slave_config_sdo16(NULL, 1, 1, 1), -EINVAL);
	IS(ecrt_slave_config_sdo32(NULL, 1, 1, 1), -EINVAL);
	IS(ecrt_slave_config_complete_sdo(NULL, 1, data, 1), -EINVAL);
	IS(ecrt_slave_config_emerg_size(NULL, 1), -EINVAL);
	IS(ecrt_slave_config_emerg_pop(NULL, data), -EINVAL);
	IS(ecrt_slave_config_emerg_clear(NULL), -EINVAL);
	IS(ecrt_slave_config_emerg_overruns(NULL), -EINVAL);
	YES(!ecrt_slave_config_create_sdo_request(NULL, 1, 1, 4));
	YES(!ecrt_slave_config_create_reg_request(NULL, 4));
	YES(!ecrt_slave_config_create_sdo_request_complete(NULL, 1, 4));
	YES(!ecrt_slave_config_create_soe_request(NULL, 0, 1, 4));
	YES(!ecrt_slave_config_create_voe_handler(NULL, 4));
	YES(!ecrt_slave_config_create_foe_request(NULL, 4));
	YES(!ecrt_slave_config_create_sdo_info_request(NULL, 4));
	IS(ecrt_slave_config_idn(NULL, 0, 1, EC_AL_STATE_PREOP, data, 1), -EINVAL);
	IS(ecrt_slave_config_state(NULL, &state), -EINVAL);
	IS(ecrt_slave_config_flag(NULL, "a", 1), -EINVAL);
	IS(ecrt_slave_config_state_timeout(NULL, EC_AL_STATE_INIT, EC_AL_STATE_PREOP, 1), -EINVAL);
	IS(ecrt_slave_config_eoe_mac_address(NULL, data), -EINVAL);
	IS(ecrt_slave_config_eoe_ip_address(NULL, ip), -EINVAL);
	IS(ecrt_slave_config_eoe_subnet_mask(NULL, ip), -EINVAL);
	IS(ecrt_slave_config_eoe_default_gateway(NULL, ip), -EINVAL);
	IS(ecrt_slave_config_eoe_dns_address(NULL, ip), -EINVAL);
	IS(ecrt_slave_config_eoe_hostname(NULL, "a"), -EINVAL);
	IS(ecrt_slave_config_overlapping_pdos(NULL, 1), -EINVAL);
	IS(ecrt_slave_config_sdo_timeout(NULL, 1), -EINVAL);
	IS(ecrt_slave_config_replay(NULL, EC_REPLAY_ALL), -EINVAL);
	IS(ecrt_slave_config_replay_sdo(NULL, 1, 1), -EINVAL);
	IS(ecrt_slave_config_replay_idn(NULL, 0, 1), -EINVAL);
	IS(ecrt_slave_config_held(NULL), -EINVAL);
	IS(ecrt_slave_config_resume(NULL, 1), -EINVAL);
	IS(ecrt_slave_config_reason(NULL, (char *)data, 8), -EINVAL);
	IS(ecrt_slave_config_dc_state(NULL, &dc), -EINVAL);
	IS(api_lines(), 0);
}

static void domain(void)
{
	const ec_pdo_entry_reg_t regs = { 0, 0, 0, 0, 0, 0, NULL, NULL };
	ec_domain_state_t state;
	ec_domain_age_t age;

	api_lines();
	IS(ecrt_domain_reg_pdo_entry_list(NULL, &regs), -EINVAL);
	IS((ssize_t)ecrt_domain_size(NULL), -EINVAL);
	YES(!ecrt_domain_data(NULL));
	IS(ecrt_domain_process(NULL), -EINVAL);
	IS(ecrt_domain_queue(NULL), -EINVAL);
	IS(ecrt_domain_state(NULL, &state), -EINVAL);
	IS(ecrt_domain_set_options(NULL, 0), -EINVAL);
	IS(ecrt_domain_set_max_age(NULL, 2), -EINVAL);
	IS(ecrt_domain_age(NULL, &age), -EINVAL);
	IS(ecrt_domain_set_division(NULL, 1, 0), -EINVAL);
	IS(ecrt_domain_copy(NULL, 0, 0, NULL, 0, 0, 1), -EINVAL);
	IS(api_lines(), 0);
}

static void requests(void)
{
	api_lines();
	IS(ecrt_sdo_request_index(NULL, 1, 1), -EINVAL);
	IS(ecrt_sdo_request_timeout(NULL, 1), -EINVAL);
	YES(!ecrt_sdo_request_data(NULL));
	IS(ecrt_sdo_request_data_size(NULL), 0);
	IS(ecrt_sdo_request_state(NULL), EC_REQUEST_ERROR);
	IS(ecrt_sdo_request_write(NULL), -EINVAL);
	IS(ecrt_sdo_request_read(NULL), -EINVAL);
	IS(ecrt_sdo_request_cancel(NULL), -EINVAL);
	YES(!ecrt_reg_request_data(NULL));
	IS(ecrt_reg_request_state(NULL), EC_REQUEST_ERROR);
	IS(ecrt_reg_request_write(NULL, 1, 1), -EINVAL);
	IS(ecrt_reg_request_read(NULL, 1, 1), -EINVAL);
	IS(ecrt_reg_request_readwrite(NULL, 1, 1), -EINVAL);
	IS(ecrt_slave_config_command(NULL, EC_STEP_PS, NULL), -EINVAL);
	IS(ecrt_master_unit(NULL, NULL), -EINVAL);
	IS(ecrt_domain_set_unit(NULL, 0), -EINVAL);
	IS(ecrt_master_unit_authority(NULL, 0, 1), -EINVAL);
	IS(ecrt_master_unit_state(NULL, 0, NULL), -EINVAL);
	IS(ecrt_master_unit_hold(NULL, "a", NULL), -EINVAL);
	IS(ecrt_master_unit_write(NULL, 0, NULL, 0, NULL), -EINVAL);
	IS(ecrt_master_unit_read(NULL, 0, NULL, 0, NULL), -EINVAL);
	YES(!ecrt_master_create_datagram_request(NULL, 4));
	YES(!ecrt_datagram_request_data(NULL));
	IS(ecrt_datagram_request_state(NULL), EC_REQUEST_ERROR);
	IS(ecrt_datagram_request_send(NULL, EC_DATAGRAM_BRD, 0, 1), -EINVAL);
	IS(ecrt_datagram_request_working_counter(NULL), 0);
	IS(ecrt_sdo_request_index_complete(NULL, 1), -EINVAL);
	IS(ecrt_sdo_request_write_with_size(NULL, 1), -EINVAL);
	IS(ecrt_soe_request_idn(NULL, 0, 1), -EINVAL);
	IS(ecrt_soe_request_timeout(NULL, 1), -EINVAL);
	YES(!ecrt_soe_request_data(NULL));
	IS(ecrt_soe_request_data_size(NULL), 0);
	IS(ecrt_soe_request_state(NULL), EC_REQUEST_ERROR);
	IS(ecrt_soe_request_write(NULL), -EINVAL);
	IS(ecrt_soe_request_read(NULL), -EINVAL);
	IS(ecrt_soe_request_cancel(NULL), -EINVAL);
	IS(ecrt_sdo_info_request_list(NULL, 1), -EINVAL);
	IS(ecrt_sdo_info_request_object(NULL, 1), -EINVAL);
	IS(ecrt_sdo_info_request_entry(NULL, 1, 1), -EINVAL);
	IS(ecrt_sdo_info_request_timeout(NULL, 1), -EINVAL);
	IS(ecrt_sdo_info_request_cancel(NULL), -EINVAL);
	YES(!ecrt_sdo_info_request_data(NULL));
	IS(ecrt_sdo_info_request_data_size(NULL), 0);
	IS(ecrt_sdo_info_request_state(NULL), EC_REQUEST_ERROR);
	IS(ecrt_sdo_info_request_get_object(NULL, NULL), -EINVAL);
	IS(ecrt_sdo_info_request_get_entry(NULL, NULL), -EINVAL);
	IS(ecrt_sdo_info_request_abort_code(NULL), 0);
	IS(ecrt_foe_request_file(NULL, "a", 0), -EINVAL);
	IS(ecrt_foe_request_timeout(NULL, 1), -EINVAL);
	YES(!ecrt_foe_request_data(NULL));
	IS(ecrt_foe_request_data_size(NULL), 0);
	IS(ecrt_foe_request_state(NULL), EC_REQUEST_ERROR);
	IS(ecrt_foe_request_progress(NULL), 0);
	IS(ecrt_foe_request_result(NULL), -EINVAL);
	IS(ecrt_foe_request_error_code(NULL), 0);
	IS(ecrt_foe_request_write(NULL, 1), -EINVAL);
	IS(ecrt_foe_request_read(NULL), -EINVAL);
	IS(ecrt_foe_request_cancel(NULL), -EINVAL);
	IS(ecrt_voe_handler_send_header(NULL, 1, 1), -EINVAL);
	IS(ecrt_voe_handler_received_header(NULL, NULL, NULL), -EINVAL);
	YES(!ecrt_voe_handler_data(NULL));
	IS(ecrt_voe_handler_data_size(NULL), 0);
	IS(ecrt_voe_handler_write(NULL, 1), -EINVAL);
	IS(ecrt_voe_handler_read(NULL), -EINVAL);
	IS(ecrt_voe_handler_read_nosync(NULL), -EINVAL);
	IS(ecrt_voe_handler_execute(NULL), EC_REQUEST_ERROR);
	IS(api_lines(), 0);
}

/* the other arguments */
static void out(void)
{
	ec_master_t *m = ecrt_open_master(0);
	ec_slave_info_t info;

	NEED(m);
	IS(ecrt_master(m, NULL), -EINVAL);
	IS(ecrt_master_scan_progress(m, NULL), -EINVAL);
	IS(ecrt_master_state(m, NULL), -EINVAL);
	IS(ecrt_master_link_state(m, 0, NULL), -EINVAL);
	IS(ecrt_master_get_slave(m, 0, NULL), -EINVAL);
	IS(ecrt_master_get_sync_manager(m, 0, 0, NULL), -EINVAL);
	IS(ecrt_master_get_pdo(m, 0, 0, 0, NULL), -EINVAL);
	IS(ecrt_master_get_pdo_entry(m, 0, 0, 0, 0, NULL), -EINVAL);
	IS(ecrt_master_get_slave(m, 0, &info), 0);
	ecrt_release_master(m);
}

const struct api_case null_cases[] = {
	{ "master", master },
	{ "slave configuration", slave_config },
	{ "domain", domain },
	{ "requests", requests },
	{ "results", out },
	{ NULL, NULL },
};
