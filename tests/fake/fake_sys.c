// SPDX-License-Identifier: GPL-2.0-only
/*
 * Takes the place of tool/sys.c, with fake_dev.c: folders that look like those of the system, and
 * the settings of a network card.
 */
#include <errno.h>
#include <linux/ethtool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../lib/tools/sys.h"
#include "../../tool/sys.h"

static const char *folder(const char *variable)
{
	const char *dir = getenv(variable);

	return dir ? dir : "/nonexistent";
}

/* in the place of /sys */
const char *sys_fs(void)
{
	return folder("FAKE_SYS");
}

/* in the place of /proc */
const char *sys_proc(void)
{
	return folder("FAKE_PROC");
}

/* in the place of /etc */
const char *sys_etc(void)
{
	return folder("FAKE_ETC");
}

/* FAKE_ETHTOOL: microseconds, EEE, pause; "-" for a driver without settings */
int ect_sys_ethtool(const char *interface, void *question)
{
	const char *text = getenv("FAKE_ETHTOOL");
	unsigned int us = 0, eee = 0, pause = 0;
	__u32 cmd;

	memcpy(&cmd, question, sizeof(cmd));
	if (!text || strcmp(interface, "eth0"))
		return -ENODEV;
	if (sscanf(text, "%u %u %u", &us, &eee, &pause) != 3)
		return -EOPNOTSUPP;
	if (cmd == ETHTOOL_GCOALESCE)
		((struct ethtool_coalesce *)question)->rx_coalesce_usecs = us;
	else if (cmd == ETHTOOL_GEEE)
		((struct ethtool_eee *)question)->eee_enabled = eee;
	else if (cmd == ETHTOOL_GPAUSEPARAM)
		((struct ethtool_pauseparam *)question)->rx_pause = pause;
	else
		return -EINVAL;
	return 0;
}

const char *ect_sys_fs(void)
{
	return sys_fs();
}
