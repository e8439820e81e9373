/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_SYS_H
#define EC_TOOL_SYS_H

#include <poll.h>

int sys_poll(struct pollfd *p, unsigned int n);	/* without a time limit */
const char *sys_fs(void);	/* where sysfs is */
const char *sys_proc(void);	/* where procfs is */
const char *sys_etc(void);	/* where the configuration of the system is */

#endif
