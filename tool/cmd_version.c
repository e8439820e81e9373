// SPDX-License-Identifier: GPL-2.0-only
#include <string.h>

#include "../include/ethercat-tools.h"
#include "out.h"
#include "tool.h"

#ifndef EC_TOOL_REVISION
#define EC_TOOL_REVISION	"unknown"
#endif

static int run(struct tool *t, int argc, char **argv)
{
	/* that of a package begins with the version */
	bool both = strncmp(EC_TOOL_REVISION, EC_TOOL_VERSION, strlen(EC_TOOL_VERSION));

	(void)t, (void)argc, (void)argv;
	out_str("name", "EtherCAT master", "EtherCAT master ");
	out_str("version", EC_TOOL_VERSION, both ? "%s " : NULL, EC_TOOL_VERSION);
	out_str("revision", EC_TOOL_REVISION, "%s\n", EC_TOOL_REVISION);
	out_u("abi", ect_interface(), NULL);
	return 0;
}

const struct cmd cmd_version = {
	.name = "version",
	.run = run,
	.args = "",
	.opts = "",
	.summary = "Show the version of the tool",
	.help = "One line; the first word with a dot is the version. Needs no master.\n",
	.json = "name, version, revision, abi (interface version)",
	.flags = CMD_HISTORIC,
};
