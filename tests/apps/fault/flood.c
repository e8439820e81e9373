// SPDX-License-Identifier: GPL-2.0-only
/* Commands that leave a line in the kernel log, as often as one can. */
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#include "fault.h"

#define SECONDS	3.0

static double seconds(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec + t.tv_nsec / 1e9;
}

/* Entries of a PDO that nobody has assigned: succeeds with a warning. */
static void clear_unassigned(int fd, unsigned int i)
{
	struct ec_ioc_sc_pdo pdo = { .op = EC_SC_PDO_MAP_CLEAR, .pdo = 0x1700 + i % 256 };

	expect_errno(call(fd, EC_IOC_SC_PDO, &pdo), 0, "mapping of an unassigned PDO");
}

static void refused(int fd, unsigned int i)
{
	struct ec_ioc_sc_pdo pdo = { .op = EC_SC_PDO_MAP_ADD, .pdo = 0x1700 + i % 256,
				     .entry_index = 0x7000, .bits = 8 };

	expect(call(fd, EC_IOC_SC_PDO, &pdo), "entry in an unassigned PDO");
}

/* a session from its beginning to its end, with flags that have no effect */
static void whole_session(int fd, unsigned int i)
{
	struct ec_ioc_activate activate = { 0 };
	struct ec_ioc_sc_flag flag = { .value = 1 };

	snprintf((char *)flag.key, sizeof(flag.key), "flag%u", i);
	session(fd);
	expect_errno(call(fd, EC_IOC_SC_FLAG, &flag), 0, "flag");
	expect_errno(call(fd, EC_IOC_ACTIVATE, &activate), 0, "activation");
	expect_errno(call(fd, EC_IOC_RELEASE, NULL), 0, "release");
}

static void repeat(const char *name, int fd, void (*once)(int fd, unsigned int i))
{
	double end = seconds() + SECONDS;
	unsigned int i = 0;

	while (seconds() < end)
		once(fd, i++);
	printf("%s: %u times\n", name, i);
}

void check_flood(void)
{
	int fd = open_master(O_RDWR);

	session(fd);
	repeat("unassigned", fd, clear_unassigned);
	repeat("refused", fd, refused);
	expect_errno(call(fd, EC_IOC_RELEASE, NULL), 0, "release");
	repeat("session", fd, whole_session);
	close(fd);
}
