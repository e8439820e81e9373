/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* The way to the kernel; tests link a replacement. */
#ifndef EC_LIB_TOOLS_SYS_H
#define EC_LIB_TOOLS_SYS_H

int ect_sys_open(const char *path, int flags);
int ect_sys_ioctl(int fd, unsigned long request, void *arg);
long ect_sys_read(int fd, void *buf, unsigned long size);
void ect_sys_close(int fd);
const char *ect_sys_fs(void);	/* where sysfs is */
/* a question about a network interface, struct ethtool_*; 0 or -errno */
int ect_sys_ethtool(const char *interface, void *question);

#endif
