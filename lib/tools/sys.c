// SPDX-License-Identifier: LGPL-2.1-or-later
#include "sys.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

int ect_sys_open(const char *path, int flags)
{
	return open(path, flags | O_CLOEXEC);
}

int ect_sys_ioctl(int fd, unsigned long request, void *arg)
{
	return ioctl(fd, request, arg);
}

long ect_sys_read(int fd, void *buf, unsigned long size)
{
	return read(fd, buf, size);
}

void ect_sys_close(int fd)
{
	close(fd);
}

const char *ect_sys_fs(void)
{
	return "/sys";
}

int ect_sys_ethtool(const char *interface, void *question)
{
	struct ifreq r = { .ifr_data = question };
	int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), ret;

	if (fd < 0)
		return -errno;
	snprintf(r.ifr_name, sizeof(r.ifr_name), "%s", interface);
	ret = ioctl(fd, SIOCETHTOOL, &r) ? -errno : 0;
	close(fd);
	return ret;
}
