// SPDX-License-Identifier: GPL-2.0-only
/* The way to the kernel; tests/tool links a replacement. */
#include "sys.h"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

int sys_open(const char *path, int flags)
{
	return open(path, flags | O_CLOEXEC);
}

int sys_ioctl(int fd, unsigned long request, void *arg)
{
	return ioctl(fd, request, arg);
}

void sys_close(int fd)
{
	close(fd);
}

const char *sys_fs(void)
{
	return "/sys";
}
