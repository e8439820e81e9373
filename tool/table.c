// SPDX-License-Identifier: GPL-2.0-only
/* Every command. */
#include "tool.h"

#define ALIAS(n, of) \
	static const struct cmd cmd_##n = { .name = #n, .alias_of = of, .opts = "" }

extern const struct cmd cmd_alias, cmd_bus, cmd_config, cmd_crc, cmd_cstruct, cmd_cycle, cmd_data,
	cmd_datagram, cmd_dc, cmd_debug, cmd_device, cmd_devices, cmd_diag, cmd_domains,
	cmd_download, cmd_emergencies, cmd_eoe, cmd_eoe_addif, cmd_eoe_delif, cmd_firmware,
	cmd_foe_read, cmd_foe_write, cmd_graph, cmd_help, cmd_ip, cmd_latch, cmd_log, cmd_mailbox,
	cmd_master, cmd_pdos, cmd_plot, cmd_record, cmd_reg_rdwr, cmd_reg_read, cmd_reg_write,
	cmd_release, cmd_rescan, cmd_rtcheck, cmd_run, cmd_sdos, cmd_set, cmd_sii_read,
	cmd_sii_write, cmd_slaves, cmd_soe_command, cmd_soe_list, cmd_soe_read, cmd_soe_write,
	cmd_states, cmd_stop, cmd_top, cmd_units, cmd_upload, cmd_version, cmd_watch, cmd_why,
	cmd_xml;
	cmd_master, cmd_metrics, cmd_pdos, cmd_reg_rdwr, cmd_reg_read, cmd_reg_write, cmd_release,
	cmd_rescan, cmd_rtcheck, cmd_run, cmd_sdos, cmd_set, cmd_sii_read, cmd_sii_write,
	cmd_slaves, cmd_soe_command, cmd_soe_list, cmd_soe_read, cmd_soe_write, cmd_states,
	cmd_stop, cmd_top, cmd_units, cmd_upload, cmd_version, cmd_watch, cmd_why, cmd_xml;


ALIAS(sdo_download, "download");
ALIAS(sdo_read, "upload");
ALIAS(sdo_upload, "upload");
ALIAS(sdo_write, "download");

const struct cmd *const cmds[] = {
	&cmd_alias,
	&cmd_bus,
	&cmd_config,
	&cmd_crc,
	&cmd_cstruct,
	&cmd_cycle,
	&cmd_data,
	&cmd_datagram,
	&cmd_dc,
	&cmd_debug,
	&cmd_device,
	&cmd_devices,
	&cmd_diag,
	&cmd_domains,
	&cmd_download,
	&cmd_emergencies,
	&cmd_eoe,
	&cmd_eoe_addif,
	&cmd_eoe_delif,
	&cmd_firmware,
	&cmd_foe_read,
	&cmd_foe_write,
	&cmd_graph,
	&cmd_help,
	&cmd_ip,
	&cmd_latch,
	&cmd_log,
	&cmd_mailbox,
	&cmd_master,
	&cmd_metrics,
	&cmd_pdos,
	&cmd_plot,
	&cmd_record,
	&cmd_reg_rdwr,
	&cmd_reg_read,
	&cmd_reg_write,
	&cmd_release,
	&cmd_rescan,
	&cmd_rtcheck,
	&cmd_run,
	&cmd_sdo_download,
	&cmd_sdo_read,
	&cmd_sdo_upload,
	&cmd_sdo_write,
	&cmd_sdos,
	&cmd_set,
	&cmd_sii_read,
	&cmd_sii_write,
	&cmd_slaves,
	&cmd_soe_command,
	&cmd_soe_list,
	&cmd_soe_read,
	&cmd_soe_write,
	&cmd_states,
	&cmd_stop,
	&cmd_top,
	&cmd_units,
	&cmd_upload,
	&cmd_version,
	&cmd_watch,
	&cmd_why,
	&cmd_xml,
	NULL,
};
