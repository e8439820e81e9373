// SPDX-License-Identifier: GPL-2.0-only
/* The way to the kernel; tests/tool links a replacement. */
#include "sys.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

int sys_open(const char *path, int flags)
{
	return open(path, flags | O_CLOEXEC);
}

int sys_ioctl(int fd, unsigned long request, void *arg)
{
	return ioctl(fd, request, arg);
}

long sys_read(int fd, void *buf, unsigned long size)
{
	return read(fd, buf, size);
}

int sys_poll(struct pollfd *p, unsigned int n)
{
	return poll(p, n, -1);
}

void sys_close(int fd)
{
	close(fd);
}

const char *sys_fs(void)
{
	return "/sys";
}

const char *sys_proc(void)
{
	return "/proc";
}

const char *sys_etc(void)
{
	return "/etc";
}

int sys_ethtool(const char *interface, void *question)
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
