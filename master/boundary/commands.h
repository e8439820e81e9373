/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * All commands but the cyclic ones, one in each row: handler, permission, the object that the
 * command names, buffer, fields that must be zero, known flags. Included twice: ioctl.h
 * declares the handlers, ioctl.c makes the table.
 */
CMD(EC_IOC_VERSION, ec_ioc_version, 0)
CMD(EC_IOC_REASON, ec_ioc_reason, 0)
CMD(EC_IOC_MASTER, ec_ioc_master, 0, OLDEST(ec_ioc_master, owner))
CMD(EC_IOC_DEVICE, ec_ioc_device, 0)
CMD(EC_IOC_SLAVE, ec_ioc_slave, 0, SHOW_SLAVE(ec_ioc_slave), RSV2(ec_ioc_slave),
	OLDEST(ec_ioc_slave, dc_odd))
CMD(EC_IOC_SLAVE_NAMES, ec_ioc_slave_names, 0, SLAVE(ec_ioc_slave_names), RSV1(ec_ioc_slave_names))
CMD(EC_IOC_SLAVE_WHY, ec_ioc_slave_why, 0, SHOW_SLAVE(ec_ioc_slave_why), RSV1(ec_ioc_slave_why))
CMD(EC_IOC_PORT, ec_ioc_port, 0, SHOW_SLAVE(ec_ioc_port), RSV2(ec_ioc_port),
	OLDEST(ec_ioc_port, reserved))
CMD(EC_IOC_ABSENT, ec_ioc_absent, 0, RSV1(ec_ioc_absent))
CMD(EC_IOC_SM, ec_ioc_sm, 0, SLAVE(ec_ioc_sm), RSV1(ec_ioc_sm))
CMD(EC_IOC_PDO, ec_ioc_pdo, 0, SLAVE(ec_ioc_pdo), RSV2(ec_ioc_pdo))
CMD(EC_IOC_PDO_ENTRY, ec_ioc_pdo_entry, 0, SLAVE(ec_ioc_pdo_entry), RSV2(ec_ioc_pdo_entry))
CMD(EC_IOC_SII, ec_ioc_sii, 0, SLAVE(ec_ioc_sii), OUT(ec_ioc_sii, EC_MAX_SII_BYTES),
	RSV1(ec_ioc_sii))
CMD(EC_IOC_CONFIG, ec_ioc_config, 0, SHOW_CONFIG(ec_ioc_config), RSV2(ec_ioc_config),
	OLDEST(ec_ioc_config, device))
CMD(EC_IOC_CONFIG_SM, ec_ioc_config_sm, 0, SHOW_CONFIG(ec_ioc_config_sm), RSV1(ec_ioc_config_sm))
CMD(EC_IOC_CONFIG_PDO, ec_ioc_config_pdo, 0, SHOW_CONFIG(ec_ioc_config_pdo),
	RSV1(ec_ioc_config_pdo))
CMD(EC_IOC_CONFIG_ENTRY, ec_ioc_config_entry, 0, SHOW_CONFIG(ec_ioc_config_entry),
	RSV1(ec_ioc_config_entry))
CMD(EC_IOC_CONFIG_SDO, ec_ioc_config_sdo, 0, SHOW_CONFIG(ec_ioc_config_sdo),
	OUT(ec_ioc_config_sdo, EC_MAX_SDO_SIZE), RSV2(ec_ioc_config_sdo),
	FLAGS(EC_SDO_FLAG_COMPLETE))
CMD(EC_IOC_CONFIG_IDN, ec_ioc_config_idn, 0, SHOW_CONFIG(ec_ioc_config_idn),
	OUT(ec_ioc_config_idn, EC_MAX_SOE_SIZE), RSV1(ec_ioc_config_idn))
CMD(EC_IOC_CONFIG_FLAG, ec_ioc_config_flag, 0, SHOW_CONFIG(ec_ioc_config_flag))
CMD(EC_IOC_CONFIG_WRITE, ec_ioc_config_write, 0, SHOW_CONFIG(ec_ioc_config_write),
	OUT(ec_ioc_config_write, EC_MAX_SDO_SIZE), FLAGS(EC_SDO_FLAG_COMPLETE))
CMD(EC_IOC_CONFIG_COMMAND, ec_ioc_config_command, 0, SHOW_CONFIG(ec_ioc_config_command),
	OUT(ec_ioc_config_command, 3 * EC_MAX_SDO_SIZE), RSV2(ec_ioc_config_command),
	FLAGS(EC_COMMAND_FLAG_WRITE | EC_COMMAND_FLAG_CHECK | EC_COMMAND_FLAG_COMPLETE))
CMD(EC_IOC_CONFIG_WHY, ec_ioc_config_why, 0, SHOW_CONFIG(ec_ioc_config_why),
	RSV1(ec_ioc_config_why))
CMD(EC_IOC_CONFIG_IP, ec_ioc_config_ip, 0, INDEX(EC_CLASS_SHOW_CONFIG, ec_ioc_sc_ip, config),
	RSV(FIELD(ec_ioc_sc_ip, params.reserved)))
CMD(EC_IOC_CONFIG_GROUP, ec_ioc_config_group, 0, SHOW_CONFIG(ec_ioc_config_group),
	RSV1(ec_ioc_config_group))
CMD(EC_IOC_EMERGENCIES, ec_ioc_emergencies, 0, SLAVE(ec_ioc_emergencies),
	OUT(ec_ioc_emergencies, EC_EMERGENCIES * sizeof(struct ec_emergency)))
CMD(EC_IOC_EVENTS, ec_ioc_events, 0, FLAGS(EC_EVENTS_FLAG_NEW))
CMD(EC_IOC_MAIL, ec_ioc_mail, 0, FLAGS(0))
CMD(EC_IOC_RECORDER, ec_ioc_recorder, 0, IN(ec_ioc_recorder, EC_MAX_IMAGE / 4), FLAGS(0))
CMD(EC_IOC_DOMAIN, ec_ioc_domain, 0, SHOW_DOMAIN(ec_ioc_domain))
CMD(EC_IOC_DOMAIN_FMMU, ec_ioc_domain_fmmu, 0, SHOW_DOMAIN(ec_ioc_domain_fmmu),
	RSV1(ec_ioc_domain_fmmu), OLDEST(ec_ioc_domain_fmmu, offset))
CMD(EC_IOC_DOMAIN_DATA, ec_ioc_domain_data, 0, SHOW_DOMAIN(ec_ioc_domain_data),
	OUT(ec_ioc_domain_data, EC_MAX_IMAGE), RSV1(ec_ioc_domain_data))
CMD(EC_IOC_UNIT_INFO, ec_ioc_unit_info, 0, SHOW)
CMD(EC_IOC_NAMES, ec_ioc_names, 0, SHOW, OUT(ec_ioc_names, EC_UAPI_NAMES_MAX))
CMD(EC_IOC_EOE, ec_ioc_eoe, 0, RSV1(ec_ioc_eoe))
CMD(EC_IOC_CYCLE_STATS, ec_ioc_cycle_stats, 0,
	OUT(ec_ioc_cycle_stats, sizeof(struct ec_status_cycle)))
CMD(EC_IOC_SDO_UPLOAD, ec_ioc_sdo_upload, F_WRITE, SLAVE(ec_ioc_sdo),
	OUT(ec_ioc_sdo, EC_MAX_SDO_SIZE), RSV2(ec_ioc_sdo), FLAGS(EC_SDO_FLAG_COMPLETE))
CMD(EC_IOC_SDO_DOWNLOAD, ec_ioc_sdo_download, F_WRITE, SLAVE(ec_ioc_sdo),
	IN(ec_ioc_sdo, EC_MAX_SDO_SIZE), RSV2(ec_ioc_sdo), FLAGS(EC_SDO_FLAG_COMPLETE))
CMD(EC_IOC_SDO_INFO, ec_ioc_sdo_info, F_WRITE, SLAVE(ec_ioc_sdo_info),
	OUT(ec_ioc_sdo_info, EC_MAX_SDO_SIZE), RSV1(ec_ioc_sdo_info))
CMD(EC_IOC_REG_READ, ec_ioc_reg_read, F_WRITE, OUT(ec_ioc_reg, EC_MAX_REG_SIZE), RSV2(ec_ioc_reg),
	FLAGS(EC_REG_FLAG_EMERGENCY))
CMD(EC_IOC_REG_WRITE, ec_ioc_reg_write, F_WRITE, IN(ec_ioc_reg, EC_MAX_REG_SIZE), RSV2(ec_ioc_reg),
	FLAGS(EC_REG_FLAG_EMERGENCY))
CMD(EC_IOC_REG_RDWR, ec_ioc_reg_rdwr, F_WRITE, INOUT(ec_ioc_reg, EC_MAX_REG_SIZE),
	RSV2(ec_ioc_reg))
CMD(EC_IOC_DATAGRAM, ec_ioc_datagram, F_WRITE, INOUT(ec_ioc_datagram, EC_MAX_DATAGRAM_SIZE),
	RSV1(ec_ioc_datagram))
CMD(EC_IOC_SOE_READ, ec_ioc_soe_read, F_WRITE, SLAVE(ec_ioc_soe), OUT(ec_ioc_soe, EC_MAX_SOE_SIZE),
	RSV2(ec_ioc_soe), FLAGS(EC_SOE_ELEMENT_ALL))
CMD(EC_IOC_SOE_WRITE, ec_ioc_soe_write, F_WRITE, SLAVE(ec_ioc_soe),
	IN(ec_ioc_soe, EC_MAX_SOE_SIZE), RSV2(ec_ioc_soe), FLAGS(EC_SOE_ELEMENT_ALL))
CMD(EC_IOC_FOE_READ, ec_ioc_foe_read, F_WRITE, SLAVE(ec_ioc_foe), RSV1(ec_ioc_foe))
CMD(EC_IOC_FOE_WRITE, ec_ioc_foe_write, F_WRITE, SLAVE(ec_ioc_foe), RSV1(ec_ioc_foe))
CMD(EC_IOC_SII_WRITE, ec_ioc_sii_write, F_WRITE, SLAVE(ec_ioc_sii_write),
	IN(ec_ioc_sii_write, EC_MAX_SII_BYTES), RSV1(ec_ioc_sii_write),
	FLAGS(EC_SII_FLAG_FORCE | EC_SII_FLAG_UNSAFE | EC_SII_FLAG_DRY_RUN))
CMD(EC_IOC_ALIAS, ec_ioc_alias, F_WRITE, SLAVE(ec_ioc_alias), RSV1(ec_ioc_alias),
	FLAGS(EC_SII_FLAG_FORCE | EC_SII_FLAG_REPAIR))
CMD(EC_IOC_STATE, ec_ioc_state, F_WRITE, SLAVE(ec_ioc_state), RSV1(ec_ioc_state))
CMD(EC_IOC_EOE_WISH, ec_ioc_eoe_wish, F_WRITE, SLAVE(ec_ioc_eoe_wish), RSV2(ec_ioc_eoe_wish))
CMD(EC_IOC_IP_GET, ec_ioc_ip_get, F_WRITE, SLAVE(ec_ioc_ip),
	RSV(FIELD(ec_ioc_ip, params.reserved), FIELD(ec_ioc_ip, reserved)))
CMD(EC_IOC_IP_SET, ec_ioc_ip_set, F_WRITE, SLAVE(ec_ioc_ip),
	RSV(FIELD(ec_ioc_ip, params.reserved), FIELD(ec_ioc_ip, reserved)))
CMD(EC_IOC_RESCAN, ec_ioc_rescan, F_WRITE)
CMD(EC_IOC_LET_IN, ec_ioc_let_in, F_WRITE, SLAVE(ec_ioc_let_in))
CMD(EC_IOC_DEBUG, ec_ioc_debug, F_WRITE)
CMD(EC_IOC_RESET, ec_ioc_reset, F_WRITE)
CMD(EC_IOC_CYCLE_RESET, ec_ioc_cycle_reset, F_WRITE)
CMD(EC_IOC_END_DETACHED, ec_ioc_end_detached, F_WRITE)
CMD(EC_IOC_OUTPUT, ec_ioc_output, F_WRITE, RSV1(ec_ioc_output), FLAGS(EC_OUTPUT_FLAG_HOLD))
CMD(EC_IOC_DEVICE_USE, ec_ioc_device_use, F_WRITE, RSV1(ec_ioc_device_use),
	FLAGS(EC_DEVICE_FLAG_BACKUP))
CMD(EC_IOC_RESERVE, ec_ioc_reserve, F_WRITE)
CMD(EC_IOC_RELEASE, ec_ioc_release, F_WRITE)
CMD(EC_IOC_CREATE_DOMAIN, ec_ioc_create_domain, F_WRITE, IDLE)
CMD(EC_IOC_SLAVE_CONFIG, ec_ioc_slave_config, F_WRITE)
CMD(EC_IOC_GROUP, ec_ioc_group, F_WRITE, IDLE, RSV2(ec_ioc_group),
	FLAGS(EC_GROUP_FLAG_MANDATORY | EC_GROUP_FLAG_FAST))
CMD(EC_IOC_GROUP_CONFIG, ec_ioc_group_config, F_WRITE, RSV1(ec_ioc_group_config))
CMD(EC_IOC_UNIT, ec_ioc_unit, F_WRITE, IDLE, RSV2(ec_ioc_unit),
	FLAGS(EC_UNIT_FLAG_AUTHORITY | EC_UNIT_FLAG_LEASE_HOLD | EC_UNIT_FLAG_OFFERED))
CMD(EC_IOC_DOMAIN_UNIT, ec_ioc_domain_unit, F_WRITE, DOMAIN(ec_ioc_domain_unit),
	RSV1(ec_ioc_domain_unit))
CMD(EC_IOC_UNIT_AUTHORITY, ec_ioc_unit_authority, F_WRITE, RSV1(ec_ioc_unit_authority))
CMD(EC_IOC_UNIT_HOLD, ec_ioc_unit_hold, F_WRITE, RSV1(ec_ioc_unit_hold), FLAGS(EC_UNIT_HOLD_END))
CMD(EC_IOC_UNIT_WRITE, ec_ioc_unit_write, F_WRITE, IN(ec_ioc_unit_data, EC_MAX_IMAGE))
CMD(EC_IOC_UNIT_READ, ec_ioc_unit_read, F_WRITE, OUT(ec_ioc_unit_data, EC_MAX_IMAGE))
CMD(EC_IOC_SC_SYNC, ec_ioc_sc_sync, F_WRITE, CONFIG(ec_ioc_sc_sync), RSV1(ec_ioc_sc_sync))
CMD(EC_IOC_SC_WATCHDOG, ec_ioc_sc_watchdog, F_WRITE, CONFIG(ec_ioc_sc_watchdog))
CMD(EC_IOC_SC_PDO, ec_ioc_sc_pdo, F_WRITE, CONFIG(ec_ioc_sc_pdo))
CMD(EC_IOC_SC_SDO, ec_ioc_sc_sdo, F_WRITE, CONFIG(ec_ioc_sc_sdo),
	IN(ec_ioc_sc_sdo, EC_MAX_SDO_SIZE), RSV1(ec_ioc_sc_sdo), FLAGS(EC_SDO_FLAG_COMPLETE))
CMD(EC_IOC_SC_IDN, ec_ioc_sc_idn, F_WRITE, CONFIG(ec_ioc_sc_idn),
	IN(ec_ioc_sc_idn, EC_MAX_SOE_SIZE))
CMD(EC_IOC_REG_ENTRY, ec_ioc_reg_entry, F_WRITE, CONFIG(ec_ioc_reg_entry),
	FLAGS(EC_REG_ENTRY_BY_POS | EC_REG_ENTRY_ALIGNED))
CMD(EC_IOC_SC_DC, ec_ioc_sc_dc, F_WRITE, CONFIG(ec_ioc_sc_dc), RSV2(ec_ioc_sc_dc))
CMD(EC_IOC_SC_FLAG, ec_ioc_sc_flag, F_WRITE, CONFIG(ec_ioc_sc_flag), RSV1(ec_ioc_sc_flag))
CMD(EC_IOC_SC_TIMEOUT, ec_ioc_sc_timeout, F_WRITE, CONFIG(ec_ioc_sc_timeout),
	RSV1(ec_ioc_sc_timeout), FLAGS(EC_SC_TIMEOUT_REPLY))
CMD(EC_IOC_SC_REQUEST, ec_ioc_sc_request, F_WRITE, CONFIG(ec_ioc_sc_request),
	RSV1(ec_ioc_sc_request))
CMD(EC_IOC_DATAGRAM_REQUEST, ec_ioc_datagram_request, F_WRITE, IDLE, RSV1(ec_ioc_datagram_request))
CMD(EC_IOC_SC_COMMAND, ec_ioc_sc_command, F_WRITE, CONFIG(ec_ioc_sc_command),
	IN(ec_ioc_sc_command, 3 * EC_MAX_SDO_SIZE), RSV1(ec_ioc_sc_command),
	FLAGS(EC_COMMAND_FLAG_WRITE | EC_COMMAND_FLAG_CHECK | EC_COMMAND_FLAG_COMPLETE))
CMD(EC_IOC_SC_EMERG, ec_ioc_sc_emerg, F_WRITE, CONFIG(ec_ioc_sc_emerg), RSV1(ec_ioc_sc_emerg))
CMD(EC_IOC_SC_IP, ec_ioc_sc_ip, F_WRITE, CONFIG(ec_ioc_sc_ip),
	RSV(FIELD(ec_ioc_sc_ip, params.reserved)))
CMD(EC_IOC_SC_OVERLAP, ec_ioc_sc_overlap, F_WRITE, CONFIG(ec_ioc_sc_overlap),
	RSV1(ec_ioc_sc_overlap))
CMD(EC_IOC_SC_REPLAY, ec_ioc_sc_replay, F_WRITE, CONFIG(ec_ioc_sc_replay), RSV1(ec_ioc_sc_replay),
	FLAGS(EC_SC_REPLAY_SDO | EC_SC_REPLAY_IDN))
CMD(EC_IOC_HOLD, ec_ioc_hold, F_WRITE, SESSION, RSV1(ec_ioc_hold), FLAGS(EC_HOLD_FLAG_RESUME))
CMD(EC_IOC_ACTIVATE, ec_ioc_activate, F_WRITE, SESSION,
	BUFFER(ec_ioc_activate, preset, preset_size, EC_MAX_IMAGE, true, false))
CMD(EC_IOC_SET_NAMES, ec_ioc_set_names, F_WRITE, SESSION, IN(ec_ioc_names, EC_UAPI_NAMES_MAX))
CMD(EC_IOC_DETACH, ec_ioc_detach, F_WRITE, SESSION, RSV1(ec_ioc_detach))
CMD(EC_IOC_DEACTIVATE, ec_ioc_deactivate, F_WRITE)
CMD(EC_IOC_SLAVES_DOWN, ec_ioc_slaves_down, F_WRITE, SESSION)
CMD(EC_IOC_DOMAIN_OFFSET, ec_ioc_domain_offset, F_WRITE, SESSION)
CMD(EC_IOC_INTERVAL, ec_ioc_interval, F_WRITE, IDLE)
CMD(EC_IOC_APP_TIME, ec_ioc_app_time, F_WRITE, RSV1(ec_ioc_app_time))
CMD(EC_IOC_REF_CLOCK, ec_ioc_ref_clock, F_WRITE, IDLE)
CMD(EC_IOC_CYCLE, ec_ioc_cycle, F_WRITE, IDLE, FLAGS(EC_CYCLE_FLAG_ALL))
CMD(EC_IOC_WAIT, ec_ioc_wait, F_WRITE)
CMD(EC_IOC_LATE, ec_ioc_late, F_WRITE, IDLE)
CMD(EC_IOC_DOMAIN_AGE, ec_ioc_domain_age, F_WRITE, DOMAIN(ec_ioc_domain_age),
	RSV1(ec_ioc_domain_age))
CMD(EC_IOC_DOMAIN_OPTIONS, ec_ioc_domain_options, F_WRITE, DOMAIN(ec_ioc_domain_options),
	RSV1(ec_ioc_domain_options))
CMD(EC_IOC_DIVISION, ec_ioc_division, F_WRITE, DOMAIN(ec_ioc_division))
CMD(EC_IOC_COPY, ec_ioc_copy, F_WRITE, IDLE)
