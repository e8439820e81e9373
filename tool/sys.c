// SPDX-License-Identifier: GPL-2.0-only
/* The system; tests/tool links a replacement. */
#include "sys.h"

int sys_poll(struct pollfd *p, unsigned int n)
{
	return poll(p, n, -1);
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
