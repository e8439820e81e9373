// SPDX-License-Identifier: GPL-2.0-only
/* Commands at the wrong time. */
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <stddef.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#include "fault.h"

#define VENDOR	0x00000002
#define EL2008	0x07d83052

static unsigned char arg[4096];

static void *zeroed(void)
{
	memset(arg, 0, sizeof(arg));
	return arg;
}

/* A session with one domain that holds the outputs of slave 1. */
void session(int fd)
{
	struct ec_ioc_create_domain d = { 0 };
	struct ec_ioc_slave_config sc = { .position = 1, .vendor_id = VENDOR,
					  .product_code = EL2008 };
	struct ec_ioc_reg_entry e = { .entry_index = 0x7000, .subindex = 1 };

	expect_errno(call(fd, EC_IOC_RESERVE, NULL), 0, "reserve");
	expect_errno(call(fd, EC_IOC_CREATE_DOMAIN, &d), 0, "domain");
	expect_errno(call(fd, EC_IOC_SLAVE_CONFIG, &sc), 0, "configuration of slave 1");
	expect_errno(call(fd, EC_IOC_REG_ENTRY, &e), 0, "output 1");
}

/* the commands of the cycle on their short way */
static int advise(int fd, off_t queued, int advice)
{
	return posix_fadvise(fd, 0, queued, advice);
}

/* None that ioctl() has not let through before, on the same file. */
static void first_advice(void)
{
	int fd = open_master(O_RDWR), other = open_master(O_RDWR);

	expect_errno(advise(fd, 0, EC_ADVICE_RECEIVE), EINVAL, "first advice to receive");
	expect_errno(advise(fd, 0, EC_ADVICE_SEND), EINVAL, "first advice to send");
	expect_errno(call(fd, EC_IOC_RECEIVE, NULL), EPERM, "receive");
	expect_errno(advise(fd, 0, EC_ADVICE_RECEIVE), EPERM, "advice to receive");
	expect_errno(advise(fd, 0, EC_ADVICE_SEND), EINVAL, "advice to send, after a receive");
	expect_errno(call(fd, EC_IOC_SEND, zeroed()), EPERM, "send");
	expect_errno(advise(fd, 0, EC_ADVICE_SEND), EPERM, "advice to send");
	expect_errno(advise(other, 0, EC_ADVICE_RECEIVE), EINVAL, "advice on another file");
	expect_errno(advise(other, 0, EC_ADVICE_SEND), EINVAL, "advice on another file");
	close(fd);
	close(other);
}

static void no_owner(int fd)
{
	for (unsigned int i = 0; i < n_cmds; i++) {
		struct ec_ioc_interval interval = { .interval_us = 1000 };
		struct ec_ioc_sc_flag flag = { .key = "x" };
		struct ec_ioc_sc_timeout timeout = { .from = 1, .to = 2 };
		struct ec_ioc_sc_sdo sdo = { .size = 4, .data = (__u64)(unsigned long)arg };
		struct ec_ioc_sc_idn idn = { .state = 2, .size = 4,
					     .data = (__u64)(unsigned long)arg };
		void *a = zeroed();

		if (!cmds[i].owner)
			continue;
		if (cmds[i].nr == EC_IOC_INTERVAL)
			a = &interval;
		else if (cmds[i].nr == EC_IOC_SC_FLAG)
			a = &flag;
		else if (cmds[i].nr == EC_IOC_SC_TIMEOUT)
			a = &timeout;
		else if (cmds[i].nr == EC_IOC_SC_SDO)
			a = &sdo;
		else if (cmds[i].nr == EC_IOC_SC_IDN)
			a = &idn;
		expect_errno(call(fd, cmds[i].nr, a), EPERM, "%s without reservation",
			     cmds[i].name);
	}
	/* by ioctl() they have come above */
	expect_errno(advise(fd, 0, EC_ADVICE_RECEIVE), EPERM, "advice to receive");
	expect_errno(advise(fd, 0, EC_ADVICE_SEND), EPERM, "advice to send");
}

/* With short_entry=0 of the module. */
void check_ioctl_only(void)
{
	int fd = open_master(O_RDWR);

	expect_errno(call(fd, EC_IOC_RECEIVE, NULL), EPERM, "receive");
	expect_errno(call(fd, EC_IOC_SEND, zeroed()), EPERM, "send");
	expect_errno(advise(fd, 0, EC_ADVICE_RECEIVE), EINVAL, "advice to receive");
	expect_errno(advise(fd, 0, EC_ADVICE_SEND), EINVAL, "advice to send");
	close(fd);
}

/* What a filter of system calls refuses by ioctl() does not come by the shorter entry. */
void check_policy(void)
{
	struct sock_filter code[] = {
		BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr)),
		BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, __NR_ioctl, 0, 3),
		BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, args[1])),
		BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned int)EC_IOC_SEND, 0, 1),
		BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EACCES),
		BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
	};
	struct sock_fprog filter = { .len = sizeof(code) / sizeof(code[0]), .filter = code };
	int fd = open_master(O_RDWR);

	expect(!prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) &&
	       !prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter), "no filter: %s",
	       strerror(errno));
	session(fd);
	expect_errno(call(fd, EC_IOC_ACTIVATE, zeroed()), 0, "activate");
	expect_errno(call(fd, EC_IOC_RECEIVE, NULL), 0, "receive");
	expect_errno(call(fd, EC_IOC_SEND, zeroed()), EACCES, "send, which the filter refuses");
	expect_errno(advise(fd, 0, EC_ADVICE_RECEIVE), 0, "advice to receive");
	expect_errno(advise(fd, 0, EC_ADVICE_SEND), EINVAL, "advice to send");
	close(fd);
}

/* What must not change while process data run. */
static void while_active(int fd)
{
	struct ec_ioc_sc_sync sync = { .dir = 1 };
	struct ec_ioc_sc_flag flag = { .key = "x" };
	struct ec_ioc_sc_timeout timeout = { .from = 1, .to = 2 };
	struct ec_ioc_sc_sdo sdo = { .size = 4, .data = (__u64)(unsigned long)arg };
	struct ec_ioc_interval interval = { .interval_us = 1000 };
	struct ec_ioc_send send = { .queued = 2 };

	expect_errno(call(fd, EC_IOC_RESERVE, NULL), EBUSY, "second reservation");
	expect_errno(call(fd, EC_IOC_ACTIVATE, zeroed()), EBUSY, "second activation");
	expect_errno(call(fd, EC_IOC_CREATE_DOMAIN, zeroed()), EBUSY, "domain while active");
	expect_errno(call(fd, EC_IOC_INTERVAL, &interval), EBUSY, "interval while active");
	expect_errno(call(fd, EC_IOC_SLAVE_CONFIG, zeroed()), EBUSY, "configuration while active");
	expect_errno(call(fd, EC_IOC_SC_SYNC, &sync), EBUSY, "SyncManager while active");
	expect_errno(call(fd, EC_IOC_SC_WATCHDOG, zeroed()), EBUSY, "watchdog while active");
	expect_errno(call(fd, EC_IOC_SC_PDO, zeroed()), EBUSY, "PDO while active");
	expect_errno(call(fd, EC_IOC_SC_SDO, &sdo), EBUSY, "startup SDO while active");
	expect_errno(call(fd, EC_IOC_REG_ENTRY, zeroed()), EBUSY, "entry while active");
	expect_errno(call(fd, EC_IOC_SC_DC, zeroed()), EBUSY, "clock while active");
	expect_errno(call(fd, EC_IOC_SC_FLAG, &flag), EBUSY, "flag while active");
	expect_errno(call(fd, EC_IOC_SC_TIMEOUT, &timeout), EBUSY, "timeout while active");
	expect_errno(call(fd, EC_IOC_SC_IP, zeroed()), EBUSY, "IP parameters while active");
	expect_errno(call(fd, EC_IOC_SEND, &send), ENOENT, "domain 1 of 1");
	send.queued = 1;
	expect_errno(call(fd, EC_IOC_SEND, &send), 0, "send");
	expect_errno(call(fd, EC_IOC_RECEIVE, NULL), 0, "receive");
	expect_errno(call(fd, EC_IOC_APP_TIME, zeroed()), 0, "time");
	expect_errno(advise(fd, 2, EC_ADVICE_SEND), ENOENT, "advice to send domain 1 of 1");
	expect_errno(advise(fd, 1, EC_ADVICE_SEND | EC_SEND_FLAG_APP_TIME), 0, "advice to send");
	expect_errno(advise(fd, 0, EC_ADVICE_RECEIVE), 0, "advice to receive");
	expect_errno(advise(fd, 0, EC_ADVICE_SEND | (EC_SEND_FLAG_ALL + 1)), EINVAL,
		     "advice with an unknown flag");
	expect_errno(advise(fd, 0, POSIX_FADV_NORMAL), 0, "advice as for any file");
}

/* The only domain becomes the unit "u". */
static void put_into_unit(int fd)
{
	struct ec_ioc_unit u = { .flags = EC_UNIT_FLAG_AUTHORITY | EC_UNIT_FLAG_OFFERED };
	struct ec_ioc_domain_unit d = { .unit = 0 };

	memset(u.name, 'u', sizeof(u.name));
	expect_errno(call(fd, EC_IOC_UNIT, &u), EINVAL, "name of a unit without end");
	memset(u.name + 1, 0, sizeof(u.name) - 1);
	expect_errno(call(fd, EC_IOC_DOMAIN_UNIT, &d), ENOENT, "unit 0 of 0");
	expect_errno(call(fd, EC_IOC_UNIT, &u), 0, "unit");
	d.domain = 1;
	expect_errno(call(fd, EC_IOC_DOMAIN_UNIT, &d), ENOENT, "unit of domain 1 of 1");
	d.domain = 0;
	expect_errno(call(fd, EC_IOC_DOMAIN_UNIT, &d), 0, "unit of domain 0");
}

/* Data and authority are those of its holder, in the size of the unit. */
static void hold_unit(int fd, int other)
{
	struct ec_ioc_unit_hold h = { .name = "u" };
	struct ec_ioc_unit_authority a = { .authority = 1 };
	struct ec_ioc_unit_data d = { .size = 4, .data = (__u64)(unsigned long)arg };
	unsigned int i;

	expect_errno(call(other, EC_IOC_UNIT_READ, &d), EPERM, "read of a unit not held");
	expect_errno(call(other, EC_IOC_UNIT_WRITE, &d), EPERM, "write of a unit not held");
	expect_errno(call(fd, EC_IOC_UNIT_HOLD, &h), EPERM, "own unit");
	h.name[0] = 'v';
	expect_errno(call(other, EC_IOC_UNIT_HOLD, &h), ENOENT, "unit v");
	memset(h.name, 'u', sizeof(h.name));
	expect_errno(call(other, EC_IOC_UNIT_HOLD, &h), EINVAL, "name of a unit without end");
	memset(h.name + 1, 0, sizeof(h.name) - 1);
	expect_errno(call(other, EC_IOC_UNIT_HOLD, &h), 0, "hold");
	expect_errno(call(fd, EC_IOC_UNIT_AUTHORITY, &a), EBUSY, "authority of a held unit");
	a.unit = ~0U;
	expect_errno(call(other, EC_IOC_UNIT_AUTHORITY, &a), ENOENT, "authority of unit ~0");
	d.size = h.size + 1;
	expect_errno(call(other, EC_IOC_UNIT_WRITE, &d), EINVAL, "write of a byte too much");
	expect_errno(call(other, EC_IOC_UNIT_READ, &d), EINVAL, "read of a byte too much");
	d.size = h.size;
	expect_errno(call(other, EC_IOC_UNIT_WRITE, &d), 0, "write of a unit");
	expect_errno(call(other, EC_IOC_UNIT_READ, &d), 0, "read of a unit");
	d.unit = ~0U;
	expect_errno(call(other, EC_IOC_UNIT_READ, &d), EPERM, "read of unit ~0");
	d.unit = 0;
	for (i = 0; i < BAD_POINTERS; i++) {
		d.data = (__u64)(unsigned long)bad_pointers[i];
		expect_errno(call(other, EC_IOC_UNIT_READ, &d), EFAULT, "unit to %p",
			     bad_pointers[i]);
	}
	h.flags = EC_UNIT_HOLD_END;
	expect_errno(call(other, EC_IOC_UNIT_HOLD, &h), 0, "end of holding");
	expect_errno(call(other, EC_IOC_UNIT_READ, &d), EPERM, "read of a unit not held any more");
}

void check_states(void)
{
	int fd = open_master(O_RDWR), other = open_master(O_RDWR);
	struct ec_ioc_domain_data dd = { .size = 4 };
	struct ec_ioc_config_sdo cs = { .size = 4 };
	struct ec_ioc_sc_sdo sdo = { .index = 0x8000, .size = 4,
				     .data = (__u64)(unsigned long)arg };
	unsigned int i;

	expect_errno(call(fd, EC_IOC_CONFIG, zeroed()), ENOENT, "configuration of nobody");
	expect_errno(call(fd, EC_IOC_DOMAIN, zeroed()), ENOENT, "domain of nobody");
	first_advice();
	no_owner(fd);
	session(fd);
	put_into_unit(fd);
	no_owner(other);
	expect_errno(call(other, EC_IOC_RESERVE, NULL), EBUSY, "second application");
	expect_errno(call(other, EC_IOC_RESCAN, NULL), EBUSY, "rescan while reserved");
	expect_errno(call(fd, EC_IOC_RECEIVE, NULL), EPERM, "receive before activation");
	expect_errno(call(fd, EC_IOC_SEND, zeroed()), EPERM, "send before activation");
	expect_errno(call(fd, EC_IOC_DEACTIVATE, NULL), EINVAL, "deactivate before activation");
	expect_errno(call(fd, EC_IOC_DOMAIN_DATA, &dd), ENOENT, "data before activation");
	expect_errno(call(fd, EC_IOC_SC_SDO, &sdo), 0, "startup SDO");
	for (i = 0; i < BAD_POINTERS; i++) {
		cs.data = (__u64)(unsigned long)bad_pointers[i];
		expect_errno(call(fd, EC_IOC_CONFIG_SDO, &cs), EFAULT, "startup SDO to %p",
			     bad_pointers[i]);
	}
	expect_errno(call(fd, EC_IOC_ACTIVATE, zeroed()), 0, "activate");
	while_active(fd);
	hold_unit(fd, other);
	for (i = 0; i < BAD_POINTERS; i++) {
		dd = (struct ec_ioc_domain_data){ .size = 1,
			.data = (__u64)(unsigned long)bad_pointers[i] };
		expect_errno(call(fd, EC_IOC_DOMAIN_DATA, &dd), EFAULT, "domain data to %p",
			     bad_pointers[i]);
	}
	no_owner(other);
	expect_errno(call(fd, EC_IOC_DEACTIVATE, NULL), 0, "deactivate");
	expect_errno(call(fd, EC_IOC_SEND, zeroed()), EPERM, "send after deactivation");
	expect_errno(call(fd, EC_IOC_RELEASE, NULL), 0, "release");
	expect_errno(call(fd, EC_IOC_RELEASE, NULL), EPERM, "second release");
	expect_errno(call(other, EC_IOC_RESERVE, NULL), 0, "the other one");
	close(other);
	close(fd);
}
