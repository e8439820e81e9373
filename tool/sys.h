/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_SYS_H
#define EC_TOOL_SYS_H

#include <poll.h>

int sys_open(const char *path, int flags);
int sys_ioctl(int fd, unsigned long request, void *arg);
long sys_read(int fd, void *buf, unsigned long size);
int sys_poll(struct pollfd *p, unsigned int n);	/* without a time limit */
void sys_close(int fd);
const char *sys_fs(void);	/* where sysfs is */
const char *sys_proc(void);	/* where procfs is */
const char *sys_etc(void);	/* where the configuration of the system is */
/* a question about a network interface, struct ethtool_*; 0 or -errno */
int sys_ethtool(const char *interface, void *question);

#endif
