// SPDX-License-Identifier: GPL-2.0-only
/* The same questions to every command of the table. */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#include "fault.h"

static unsigned char arg[1 << _IOC_SIZEBITS];

static void *zeroed(void)
{
	memset(arg, 0, sizeof(arg));
	return arg;
}

static unsigned long with_size(unsigned long nr, size_t size)
{
	return _IOC(_IOC_DIR(nr), _IOC_TYPE(nr), _IOC_NR(nr), size);
}

static bool known(unsigned int nr)
{
	for (unsigned int i = 0; i < n_cmds; i++)
		if (_IOC_NR(cmds[i].nr) == nr)
			return true;
	return false;
}

/* What an owner is told who is not one comes before what is in the argument. */
static int reserved_fd(void)
{
	int fd = open_master(O_RDWR);

	expect_errno(call(fd, EC_IOC_RESERVE, NULL), 0, "reserve");
	return fd;
}

static bool reason_has(int fd, const char *words)
{
	struct ec_ioc_reason r = { 0 };

	return !call(fd, EC_IOC_REASON, &r) && strstr(r.text, words);
}

static bool has_reason(int fd)
{
	struct ec_ioc_reason r = { 0 };

	expect_errno(call(fd, EC_IOC_REASON, &r), 0, "REASON");
	expect(r.len == strlen(r.text), "length of the reason: %u", r.len);
	return r.len > 0;
}

void check_numbers(void)
{
	static const unsigned int dirs[] = { _IOC_NONE, _IOC_READ, _IOC_WRITE,
					     _IOC_READ | _IOC_WRITE };
	int fd = reserved_fd();

	for (unsigned int nr = 0; nr < 256; nr++)
		for (unsigned int d = 0; d < 4 && !known(nr); d++)
			for (unsigned int size = 0; size <= 1024; size += 256)
				expect_errno(call(fd, _IOC(dirs[d], EC_IOC_TYPE, nr, size), zeroed()),
					     ENOTTY, "number 0x%02x, direction %u, size %u", nr,
					     dirs[d], size);
	for (unsigned int i = 0; i < n_cmds; i++) {
		const struct cmd *c = &cmds[i];

		for (unsigned int d = 0; d < 4; d++)
			if (dirs[d] != _IOC_DIR(c->nr) &&
			    !(c->nr == EC_IOC_VERSION && dirs[d] == _IOC_READ))
				expect_errno(call(fd, _IOC(dirs[d], EC_IOC_TYPE, _IOC_NR(c->nr),
							   _IOC_SIZE(c->nr)), zeroed()),
					     ENOTTY, "%s with direction %u", c->name, dirs[d]);
		expect_errno(call(fd, _IOC(_IOC_DIR(c->nr), EC_IOC_TYPE + 1,
					   _IOC_NR(c->nr),
					   _IOC_SIZE(c->nr)), zeroed()),
			     ENOTTY, "%s of another type", c->name);
	}
	expect_errno(call(fd, 0, NULL), ENOTTY, "command 0");
	expect_errno(call(fd, ~0U, NULL), ENOTTY, "command ~0");
	close(fd);
}

/*
 * A program of a later header: with a tail of zeros it gets the answer to the argument as it is
 * here, whatever that is; with another tail the module says that it does not know it.
 */
static void check_longer(int fd, const struct cmd *c, unsigned int size)
{
	static const unsigned int more[] = { 1, 8, 897, 4096 };
	unsigned int most = (1 << _IOC_SIZEBITS) - 1;
	int known = call(fd, c->nr, zeroed());

	/* it does something, also without a field that is set */
	if (c->nr == EC_IOC_ACTIVATE || c->nr == EC_IOC_CREATE_DOMAIN)
		return;
	for (unsigned int m = 0; m < sizeof(more) / sizeof(more[0]); m++)
		expect_errno(call(fd, with_size(c->nr, size + more[m]), zeroed()), known,
			     "%s with %u zeros behind its argument", c->name, more[m]);
	expect_errno(call(fd, with_size(c->nr, most), zeroed()), known, "%s with %u bytes", c->name,
		     most);
	if (!(_IOC_DIR(c->nr) & _IOC_WRITE))
		return;
	for (unsigned int s = size; s < size + 8; s++) {
		zeroed();
		arg[s] = 1;
		expect_errno(call(fd, with_size(c->nr, size + 8), arg), E2BIG,
			     "%s with byte %u behind its argument", c->name, s);
		expect(c->cyclic || has_reason(fd), "%s: E2BIG without a reason", c->name);
	}
	zeroed();
	arg[most - 1] = 1;
	expect_errno(call(fd, with_size(c->nr, most), arg), E2BIG, "%s with its last of %u bytes",
		     c->name, most);
}

void check_sizes(void)
{
	int fd = reserved_fd();

	for (unsigned int i = 0; i < n_cmds; i++) {
		const struct cmd *c = &cmds[i];
		unsigned int size = _IOC_SIZE(c->nr);

		for (unsigned int s = 0; s < (c->min ?: size); s++)
			expect_errno(call(fd, with_size(c->nr, s), zeroed()), EINVAL,
				     "%s with %u of %u bytes", c->name, s, size);
		/* without an argument any other size is another command */
		for (unsigned int s = 1; s < 64 && !size; s++)
			expect(call(fd, with_size(c->nr, s), zeroed()) != 0,
			       "%s without argument took %u bytes", c->name, s);
		if (size)
			check_longer(fd, c, size);
	}
	/* the answer's rest is zero */
	memset(arg, 0xff, sizeof(struct ec_ioc_master) + 8);
	expect_errno(call(fd, with_size(EC_IOC_MASTER, sizeof(struct ec_ioc_master) + 8), arg), 0,
		     "MASTER of a newer program");
	for (unsigned int i = 0; i < 8; i++)
		expect(!arg[sizeof(struct ec_ioc_master) + i], "MASTER left byte %u behind it", i);
	close(fd);
}

/* Each program says at first for which version it was built. */
void check_version(void)
{
	struct ec_ioc_version v = { .abi = EC_UAPI_VERSION };
	int fd = open_master(O_RDONLY);

	expect_errno(call(fd, EC_IOC_VERSION, &v), 0, "VERSION");
	expect(v.abi == EC_UAPI_VERSION && v.master_count, "version %u, %u masters", v.abi,
	       v.master_count);
	v.abi = EC_UAPI_VERSION + 1;
	expect_errno(call(fd, EC_IOC_VERSION, &v), 0, "VERSION of a newer program");
	expect(v.abi == EC_UAPI_VERSION, "version %u", v.abi);
	for (__u32 abi = 0; abi < EC_UAPI_FIRST; abi++) {
		v.abi = abi;
		expect_errno(call(fd, EC_IOC_VERSION, &v), EPROTO, "version %u", abi);
		expect(reason_has(fd, "rebuild"), "no remedy for version %u", abi);
	}
	/* as in the headers of 1 and 2 */
	expect_errno(call(fd, _IOR(EC_IOC_TYPE, 0x00, struct ec_ioc_version), &v), EPROTO,
		     "VERSION of an old program");
	expect(reason_has(fd, "rebuild"), "no remedy for an old program");
	close(fd);
}

/* An argument across the end of the last page the process has. */
static void *at_the_edge(size_t inside)
{
	static unsigned char *page;

	if (!page) {
		page = mmap(NULL, 8192, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
		if (page == MAP_FAILED)
			abort();
		munmap(page + 4096, 4096);
	}
	memset(page, 0, 4096);
	return page + 4096 - inside;
}

/* Data of an argument that is right otherwise: slave 2 has CoE and SoE. */
static void check_data_pointer(int fd, const struct cmd *c)
{
	__u64 p;
	__u32 size = 4;

	for (unsigned int b = 0; b < BAD_POINTERS; b++) {
		zeroed();
		if (c->nr == EC_IOC_SDO_UPLOAD || c->nr == EC_IOC_SDO_DOWNLOAD) {
			((struct ec_ioc_sdo *)arg)->slave.position = 2;
			((struct ec_ioc_sdo *)arg)->index = 0x1018;
			((struct ec_ioc_sdo *)arg)->subindex = 1;
		}
		if (c->nr == EC_IOC_SOE_READ || c->nr == EC_IOC_SOE_WRITE) {
			((struct ec_ioc_soe *)arg)->slave.position = 2;
			((struct ec_ioc_soe *)arg)->idn = 91;
		}
		if (c->nr == EC_IOC_SDO_INFO) {
			((struct ec_ioc_sdo_info *)arg)->slave.position = 2;
			((struct ec_ioc_sdo_info *)arg)->what = EC_SDO_INFO_LIST;
			size = 64;
		}
		p = (__u64)(unsigned long)bad_pointers[b];
		memcpy(arg + c->data, &p, sizeof(p));
		memcpy(arg + c->size, &size, sizeof(size));
		expect_errno(call(fd, c->nr, arg), EFAULT, "%s with data at %p", c->name,
			     bad_pointers[b]);
	}
}

void check_pointers(void)
{
	int fd = reserved_fd();

	for (unsigned int i = 0; i < n_cmds; i++) {
		const struct cmd *c = &cmds[i];
		unsigned int size = _IOC_SIZE(c->nr);

		for (unsigned int b = 0; b < BAD_POINTERS && size && !c->cyclic; b++)
			expect_errno(call(fd, c->nr, bad_pointers[b]), EFAULT, "%s at %p", c->name,
				     bad_pointers[b]);
		if (size && !c->cyclic)
			expect_errno(call(fd, c->nr, at_the_edge(size - 1)), EFAULT,
				     "%s with its last byte missing", c->name);
		/* without configuration, domain, emergency, unit or names nothing is copied */
		if (c->data && c->nr != EC_IOC_CONFIG_SDO && c->nr != EC_IOC_CONFIG_IDN &&
		    c->nr != EC_IOC_CONFIG_COMMAND && c->nr != EC_IOC_DOMAIN_DATA &&
		    c->nr != EC_IOC_EMERGENCIES && c->nr != EC_IOC_UNIT_READ &&
		    c->nr != EC_IOC_NAMES)
			check_data_pointer(fd, c);
	}
	for (unsigned int b = 0; b < BAD_POINTERS; b++)
		expect_errno(call(fd, EC_IOC_SEND, bad_pointers[b]), EFAULT, "SEND at %p",
			     bad_pointers[b]);
	close(fd);
}

void check_unknown(void)
{
	int fd = reserved_fd();

	for (unsigned int i = 0; i < n_cmds; i++) {
		const struct cmd *c = &cmds[i];

		if (!(_IOC_DIR(c->nr) & _IOC_WRITE))
			continue;
		for (unsigned int bit = 0; bit < 32; bit++) {
			__u32 flags = 1U << bit;

			if (c->flags & flags)
				continue;
			zeroed();
			memcpy(arg, &flags, sizeof(flags));
			expect_errno(call(fd, c->nr, arg), EOPNOTSUPP, "%s with flag 0x%x", c->name,
				     flags);
			expect(c->cyclic || has_reason(fd), "%s: flag without a reason", c->name);
		}
		for (unsigned int r = 0; r < 2; r++) {
			for (unsigned int k = 0; k < c->reserved[r].size; k++) {
				zeroed();
				arg[c->reserved[r].offset + k] = 0x80;
				expect_errno(call(fd, c->nr, arg), EOPNOTSUPP,
					     "%s with reserved byte %u", c->name,
					     c->reserved[r].offset + k);
			}
		}
	}
	/* the reason belongs to the last command, not to an older one */
	expect_errno(call(fd, EC_IOC_INTERVAL, zeroed()), EINVAL, "interval 0");
	expect(has_reason(fd), "no reason for an interval of 0");
	expect_errno(call(fd, EC_IOC_MASTER, zeroed()), 0, "MASTER");
	expect(!has_reason(fd), "a reason after a success");
	close(fd);
}

void check_readonly(void)
{
	int fd = open_master(O_RDONLY);

	for (unsigned int i = 0; i < n_cmds; i++) {
		const struct cmd *c = &cmds[i];
		int ret = call(fd, c->nr, zeroed());

		if (c->write)
			expect_errno(ret, EPERM, "%s by a reader", c->name);
		else
			expect(ret != EPERM, "%s refused to a reader", c->name);
	}
	close(fd);
}
