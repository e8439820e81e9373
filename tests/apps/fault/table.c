// SPDX-License-Identifier: GPL-2.0-only
/* Every command of uapi/ethercat.h, with what is special about its argument. */
#include "fault.h"

void *const bad_pointers[BAD_POINTERS] = {
	NULL, (void *)0x10000000000UL, (void *)0xffff888000001000UL,
};

#define AT(type, field)	{ offsetof(struct type, field), sizeof(((struct type *)0)->field) }
#define DATA(type)	.data = offsetof(struct type, data), .size = offsetof(struct type, size)
#define CMD(n, ...)	{ .name = #n, .nr = EC_IOC_##n, __VA_ARGS__ }
#define RSV1(type)	.reserved = { AT(type, reserved) }
#define RSV2(type)	.reserved = { AT(type, reserved), AT(type, reserved2) }
#define BUS		.write = true
#define APP		.write = true, .owner = true

const struct cmd cmds[] = {
	CMD(VERSION),
	CMD(REASON),
	CMD(MASTER),
	CMD(DEVICE),
	CMD(SLAVE),
	CMD(SLAVE_NAMES, RSV1(ec_ioc_slave_names)),
	CMD(SLAVE_WHY, RSV1(ec_ioc_slave_why)),
	CMD(PORT, RSV1(ec_ioc_port)),
	CMD(SM, RSV1(ec_ioc_sm)),
	CMD(PDO, RSV2(ec_ioc_pdo)),
	CMD(PDO_ENTRY, RSV2(ec_ioc_pdo_entry)),
	CMD(SII, RSV1(ec_ioc_sii), DATA(ec_ioc_sii)),
	CMD(CONFIG, RSV1(ec_ioc_config)),
	CMD(CONFIG_SM, RSV1(ec_ioc_config_sm)),
	CMD(CONFIG_PDO, RSV1(ec_ioc_config_pdo)),
	CMD(CONFIG_ENTRY, RSV1(ec_ioc_config_entry)),
	CMD(CONFIG_SDO, RSV2(ec_ioc_config_sdo), DATA(ec_ioc_config_sdo),
	    .flags = EC_SDO_FLAG_COMPLETE),
	CMD(CONFIG_IDN, RSV1(ec_ioc_config_idn), DATA(ec_ioc_config_idn)),
	CMD(DOMAIN),
	CMD(DOMAIN_FMMU, RSV1(ec_ioc_domain_fmmu)),
	CMD(DOMAIN_DATA, RSV1(ec_ioc_domain_data), DATA(ec_ioc_domain_data)),
	CMD(CONFIG_FLAG),
	CMD(CYCLE_STATS, DATA(ec_ioc_cycle_stats)),
	CMD(CONFIG_IP, .reserved = { AT(ec_ioc_sc_ip, params.reserved) }),
	CMD(CONFIG_WHY, RSV1(ec_ioc_config_why)),
	CMD(EMERGENCIES, DATA(ec_ioc_emergencies)),
	CMD(EVENTS, .flags = EC_EVENTS_FLAG_NEW),
	CMD(SLAVES_DOWN, APP),
	CMD(IP_GET, BUS, .reserved = { AT(ec_ioc_ip, params.reserved), AT(ec_ioc_ip, reserved) }),
	CMD(IP_SET, BUS, .reserved = { AT(ec_ioc_ip, params.reserved), AT(ec_ioc_ip, reserved) }),
	CMD(SC_IP, APP, .reserved = { AT(ec_ioc_sc_ip, params.reserved) }),
	CMD(SDO_UPLOAD, BUS, RSV2(ec_ioc_sdo), DATA(ec_ioc_sdo), .flags = EC_SDO_FLAG_COMPLETE),
	CMD(SDO_DOWNLOAD, BUS, RSV2(ec_ioc_sdo), DATA(ec_ioc_sdo), .flags = EC_SDO_FLAG_COMPLETE),
	CMD(SDO_INFO, BUS, RSV1(ec_ioc_sdo_info), DATA(ec_ioc_sdo_info)),
	CMD(REG_READ, BUS, RSV2(ec_ioc_reg), DATA(ec_ioc_reg), .flags = EC_REG_FLAG_EMERGENCY),
	CMD(REG_WRITE, BUS, RSV2(ec_ioc_reg), DATA(ec_ioc_reg), .flags = EC_REG_FLAG_EMERGENCY),
	CMD(REG_RDWR, BUS, RSV2(ec_ioc_reg), DATA(ec_ioc_reg)),
	CMD(SOE_READ, BUS, RSV2(ec_ioc_soe), DATA(ec_ioc_soe)),
	CMD(SOE_WRITE, BUS, RSV2(ec_ioc_soe), DATA(ec_ioc_soe)),
	/* their data are not copied before the slave has been asked: check_foe() */
	CMD(FOE_READ, BUS, RSV1(ec_ioc_foe)),
	CMD(FOE_WRITE, BUS, RSV1(ec_ioc_foe)),
	CMD(STATE, BUS, RSV1(ec_ioc_state)),
	CMD(RESCAN, BUS),
	CMD(DEBUG, BUS),
	CMD(RESET, BUS),
	CMD(CYCLE_RESET, BUS),
	CMD(END_DETACHED, BUS),
	CMD(DEVICE_USE, BUS, RSV1(ec_ioc_device_use)),
	CMD(RESERVE, BUS),
	CMD(RELEASE, APP),
	CMD(CREATE_DOMAIN, APP),
	CMD(SLAVE_CONFIG, APP),
	CMD(SC_SYNC, APP, RSV1(ec_ioc_sc_sync)),
	CMD(SC_WATCHDOG, APP),
	CMD(SC_PDO, APP),
	CMD(SC_SDO, APP, RSV1(ec_ioc_sc_sdo), DATA(ec_ioc_sc_sdo), .flags = EC_SDO_FLAG_COMPLETE),
	CMD(SC_IDN, APP, DATA(ec_ioc_sc_idn)),
	CMD(REG_ENTRY, APP, .flags = EC_REG_ENTRY_BY_POS | EC_REG_ENTRY_ALIGNED),
	CMD(SC_DC, APP, RSV2(ec_ioc_sc_dc)),
	CMD(SC_FLAG, APP, RSV1(ec_ioc_sc_flag)),
	CMD(SC_TIMEOUT, APP, RSV1(ec_ioc_sc_timeout), .flags = EC_SC_TIMEOUT_REPLY),
	CMD(ACTIVATE, APP, .data = offsetof(struct ec_ioc_activate, preset),
	    .size = offsetof(struct ec_ioc_activate, preset_size)),
	CMD(DEACTIVATE, APP),
	CMD(DOMAIN_OFFSET, APP),
	CMD(INTERVAL, APP),
	CMD(APP_TIME, APP, RSV1(ec_ioc_app_time)),
	CMD(REF_CLOCK, APP),
	CMD(CYCLE, APP, .flags = EC_CYCLE_FLAG_ALL),
	CMD(WAIT, APP),
	CMD(DIVISION, APP),
	CMD(COPY, APP),
	CMD(RECEIVE, APP, .cyclic = true),
	CMD(SEND, APP, RSV1(ec_ioc_send), .cyclic = true, .flags = EC_SEND_FLAG_ALL),
	CMD(SC_REQUEST, APP, RSV1(ec_ioc_sc_request)),
	CMD(SC_EMERG, APP, RSV1(ec_ioc_sc_emerg)),
	CMD(SC_OVERLAP, APP, RSV1(ec_ioc_sc_overlap)),
	CMD(LATE, APP),
	CMD(DOMAIN_AGE, APP, RSV1(ec_ioc_domain_age)),
	CMD(DOMAIN_OPTIONS, APP, RSV1(ec_ioc_domain_options)),
};

const unsigned int n_cmds = sizeof(cmds) / sizeof(cmds[0]);
