/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Numbers, sizes and order of members that programs compiled against the field's
 * header have in them: nothing here may change. Sizes are those of 64-bit
 * machines.
 */
#include <stddef.h>
#include <ecrt.h>

#define GLUE(a, b)	a##b
#define NAME(line)	GLUE(is_, line)
#define IS(what, value)	extern char NAME(__LINE__)[(what) == (value) ? 1 : -1]
#define AT(type, member, offset)	IS(offsetof(type, member), offset)

/* macros */
IS(ECRT_VER_MAJOR, 1);
IS(ECRT_VER_MINOR, 6);
IS(ECRT_VERSION(1, 6), 0x0106);
IS(ECRT_VERSION_MAGIC, 262);
IS(EC_END, 0xffffffffU);
IS(EC_MAX_SYNC_MANAGERS, 16);
IS(EC_MAX_STRING_LENGTH, 64);
IS(EC_MAX_PORTS, 4);
IS(EC_COE_EMERGENCY_MSG_SIZE, 8);

#if !defined(EC_HAVE_EMERGENCY) || \
	!defined(EC_HAVE_REG_ACCESS) || !defined(EC_HAVE_SELECT_REF_CLOCK) || \
	!defined(EC_HAVE_REF_CLOCK_TIME) || !defined(EC_HAVE_REG_BY_POS) || \
	!defined(EC_HAVE_SYNC_TO) || !defined(EC_HAVE_FLAGS) || \
	!defined(EC_HAVE_SOE_REQUESTS) || !defined(EC_HAVE_SCAN_PROGRESS) || \
	!defined(EC_HAVE_SET_IP) || !defined(EC_HAVE_STATE_TIMEOUT) || \
	!defined(EC_HAVE_REDUNDANCY)
#error "a feature flag is missing"
#endif

/* enumerations */
IS(EC_PORT_NOT_IMPLEMENTED, 0);
IS(EC_PORT_NOT_CONFIGURED, 1);
IS(EC_PORT_EBUS, 2);
IS(EC_PORT_MII, 3);
IS(EC_WC_ZERO, 0);
IS(EC_WC_INCOMPLETE, 1);
IS(EC_WC_COMPLETE, 2);
IS(EC_DIR_INVALID, 0);
IS(EC_DIR_OUTPUT, 1);
IS(EC_DIR_INPUT, 2);
IS(EC_DIR_COUNT, 3);
IS(EC_WD_DEFAULT, 0);
IS(EC_WD_ENABLE, 1);
IS(EC_WD_DISABLE, 2);
IS(EC_REQUEST_UNUSED, 0);
IS(EC_REQUEST_BUSY, 1);
IS(EC_REQUEST_SUCCESS, 2);
IS(EC_REQUEST_ERROR, 3);
IS(EC_AL_STATE_INIT, 1);
IS(EC_AL_STATE_PREOP, 2);
IS(EC_AL_STATE_SAFEOP, 4);
IS(EC_AL_STATE_OP, 8);

/* structures */
#ifdef __LP64__
IS(sizeof(ec_master_state_t), 8);
IS(sizeof(ec_master_link_state_t), 8);
IS(sizeof(ec_slave_config_state_t), 4);
IS(sizeof(ec_master_info_t), 16);
IS(sizeof(ec_master_scan_progress_t), 8);
IS(sizeof(ec_slave_port_link_t), 3);
IS(sizeof(ec_slave_info_t), 176);
IS(sizeof(ec_domain_state_t), 12);
IS(sizeof(ec_pdo_entry_info_t), 4);
IS(sizeof(ec_pdo_info_t), 16);
IS(sizeof(ec_sync_info_t), 32);
IS(sizeof(ec_pdo_entry_reg_t), 32);

AT(ec_master_info_t, slave_count, 0);
AT(ec_master_info_t, scan_busy, 5);
AT(ec_master_info_t, app_time, 8);
AT(ec_master_scan_progress_t, slave_count, 0);
AT(ec_master_scan_progress_t, scan_index, 4);
AT(ec_slave_port_link_t, link_up, 0);
AT(ec_slave_port_link_t, loop_closed, 1);
AT(ec_slave_port_link_t, signal_detected, 2);
AT(ec_slave_info_t, position, 0);
AT(ec_slave_info_t, vendor_id, 4);
AT(ec_slave_info_t, product_code, 8);
AT(ec_slave_info_t, revision_number, 12);
AT(ec_slave_info_t, serial_number, 16);
AT(ec_slave_info_t, alias, 20);
AT(ec_slave_info_t, current_on_ebus, 22);
AT(ec_slave_info_t, ports, 24);
AT(ec_slave_info_t, ports[1].desc, 44);
AT(ec_slave_info_t, ports[0].link, 28);
AT(ec_slave_info_t, ports[0].receive_time, 32);
AT(ec_slave_info_t, ports[0].next_slave, 36);
AT(ec_slave_info_t, ports[0].delay_to_next_dc, 40);
AT(ec_slave_info_t, al_state, 104);
AT(ec_slave_info_t, error_flag, 105);
AT(ec_slave_info_t, sync_count, 106);
AT(ec_slave_info_t, sdo_count, 108);
AT(ec_slave_info_t, name, 110);
AT(ec_domain_state_t, working_counter, 0);
AT(ec_domain_state_t, wc_state, 4);
AT(ec_domain_state_t, redundancy_active, 8);
AT(ec_pdo_entry_info_t, index, 0);
AT(ec_pdo_entry_info_t, subindex, 2);
AT(ec_pdo_entry_info_t, bit_length, 3);
AT(ec_pdo_info_t, index, 0);
AT(ec_pdo_info_t, n_entries, 4);
AT(ec_pdo_info_t, entries, 8);
AT(ec_sync_info_t, index, 0);
AT(ec_sync_info_t, dir, 4);
AT(ec_sync_info_t, n_pdos, 8);
AT(ec_sync_info_t, pdos, 16);
AT(ec_sync_info_t, watchdog_mode, 24);
AT(ec_pdo_entry_reg_t, alias, 0);
AT(ec_pdo_entry_reg_t, position, 2);
AT(ec_pdo_entry_reg_t, vendor_id, 4);
AT(ec_pdo_entry_reg_t, product_code, 8);
AT(ec_pdo_entry_reg_t, index, 12);
AT(ec_pdo_entry_reg_t, subindex, 14);
AT(ec_pdo_entry_reg_t, offset, 16);
AT(ec_pdo_entry_reg_t, bit_position, 24);
#endif

/* initialisers by position, as in programs of the field */
extern const ec_pdo_entry_info_t entries[2];
const ec_pdo_entry_info_t entries[2] = { { 0x6040, 0, 16 }, { 0, 0, 8 } };

extern const ec_pdo_info_t pdos[1];
const ec_pdo_info_t pdos[1] = { { 0x1600, 2, entries } };

extern const ec_sync_info_t syncs[2];
const ec_sync_info_t syncs[2] = {
	{ 2, EC_DIR_OUTPUT, 1, pdos, EC_WD_ENABLE },
	{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
};
