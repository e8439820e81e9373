// SPDX-License-Identifier: GPL-2.0-only
/* Arguments that name what is not there, or carry impossible values. */
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>
#include "fault.h"

static unsigned char data[1 << 17];

/* Positions of slaves that "three" does not have. */
static void no_such_slave(int fd, __u16 pos)
{
	__u64 p = (__u64)(unsigned long)data;
	struct ec_ioc_slave slave = { .position = pos };
	struct ec_ioc_sm sm = { .position = pos };
	struct ec_ioc_pdo pdo = { .position = pos };
	struct ec_ioc_pdo_entry entry = { .position = pos };
	struct ec_ioc_sii sii = { .position = pos, .size = 4, .data = p };
	struct ec_ioc_sdo sdo = { .position = pos, .size = 4, .data = p };
	struct ec_ioc_reg reg = { .position = pos, .size = 4, .data = p };
	struct ec_ioc_state state = { .position = pos, .state = 1 };
	const struct {
		const char *name;
		unsigned long nr;
		void *arg;
	} all[] = {
		{ "SLAVE", EC_IOC_SLAVE, &slave }, { "SM", EC_IOC_SM, &sm },
		{ "PDO", EC_IOC_PDO, &pdo }, { "PDO_ENTRY", EC_IOC_PDO_ENTRY, &entry },
		{ "SII", EC_IOC_SII, &sii }, { "SDO_UPLOAD", EC_IOC_SDO_UPLOAD, &sdo },
		{ "SDO_DOWNLOAD", EC_IOC_SDO_DOWNLOAD, &sdo },
		{ "REG_READ", EC_IOC_REG_READ, &reg }, { "REG_WRITE", EC_IOC_REG_WRITE, &reg },
		{ "REG_RDWR", EC_IOC_REG_RDWR, &reg },
		{ "STATE", EC_IOC_STATE, &state },
	};

	for (unsigned int i = 0; i < sizeof(all) / sizeof(all[0]); i++)
		expect_errno(call(fd, all[i].nr, all[i].arg), ENOENT, "%s of slave %u",
			     all[i].name, pos);
}

void check_positions(void)
{
	static const unsigned int wrong[] = { 8, 16, 127, 255 };
	int fd = open_master(O_RDWR);

	no_such_slave(fd, 3);
	no_such_slave(fd, 255);
	no_such_slave(fd, 65535);
	for (unsigned int i = 0; i < 4; i++) {
		struct ec_ioc_sm sm = { .position = 1, .sm = wrong[i] };
		struct ec_ioc_pdo pdo = { .position = 1, .sm = wrong[i] };
		struct ec_ioc_pdo_entry entry = { .position = 1, .sm = wrong[i] };

		expect_errno(call(fd, EC_IOC_SM, &sm), EINVAL, "SM%u", wrong[i]);
		expect_errno(call(fd, EC_IOC_PDO, &pdo), EINVAL, "PDO at SM%u", wrong[i]);
		expect_errno(call(fd, EC_IOC_PDO_ENTRY, &entry), EINVAL, "entry at SM%u",
			     wrong[i]);
		pdo = (struct ec_ioc_pdo){ .position = 1, .pdo_pos = 0xff00 + wrong[i] };
		expect_errno(call(fd, EC_IOC_PDO, &pdo), EINVAL, "PDO %u", pdo.pdo_pos);
		entry = (struct ec_ioc_pdo_entry){ .position = 1, .pdo_pos = 0xff00 + wrong[i] };
		expect_errno(call(fd, EC_IOC_PDO_ENTRY, &entry), EINVAL, "entry of PDO %u",
			     entry.pdo_pos);
		entry = (struct ec_ioc_pdo_entry){ .position = 1, .entry_pos = 0xff00 + wrong[i] };
		expect_errno(call(fd, EC_IOC_PDO_ENTRY, &entry), EINVAL, "entry %u",
			     entry.entry_pos);
	}
	close(fd);
}

static void check_reg(int fd)
{
	static const struct {
		__u16 address;
		__u32 size;
	} wrong[] = {
		{ 0, 0 }, { 0, 1025 }, { 0, 0x10000 }, { 0, ~0U }, { 0, 1U << 31 },
		{ 0xffff, 2 }, { 0xff00, 0x101 }, { 0xffff, ~0U },
	};

	for (unsigned int i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++) {
		struct ec_ioc_reg r = { .address = wrong[i].address, .size = wrong[i].size,
					.data = (__u64)(unsigned long)data };

		expect_errno(call(fd, EC_IOC_REG_READ, &r), EINVAL, "read %u bytes at 0x%04x",
			     r.size, r.address);
		expect_errno(call(fd, EC_IOC_REG_WRITE, &r), EINVAL, "write %u bytes at 0x%04x",
			     r.size, r.address);
		expect_errno(call(fd, EC_IOC_REG_RDWR, &r), EINVAL, "exchange %u bytes at 0x%04x",
			     r.size, r.address);
	}
}

static void check_sdo(int fd)
{
	static const __u32 large[] = { 64 * 1024 + 1, 1U << 20, 1U << 31, ~0U };
	struct ec_ioc_sdo s = { .position = 2, .index = 0x1018, .subindex = 1,
				.data = (__u64)(unsigned long)data };

	expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), ENOBUFS, "upload into 0 bytes");
	for (unsigned int i = 0; i < 4; i++) {
		s.size = large[i];
		expect_errno(call(fd, EC_IOC_SDO_DOWNLOAD, &s), EINVAL, "download of %u bytes",
			     large[i]);
		/* room may be larger than any object; there is no memory of that size */
		s.size = large[i];
		expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), 0, "upload into %u bytes", large[i]);
		expect(s.size == 4, "upload into %u bytes: %u", large[i], s.size);
	}
	s.size = 1;
	expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), ENOBUFS, "4 bytes into 1");
	s.size = 4;
	s.index = 0x5fff;
	expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), EIO, "object that does not exist");
	expect(s.abort_code == 0x06020000, "abort code 0x%08x", s.abort_code);
	s.position = 0;
	s.size = 4;
	expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), EPROTONOSUPPORT, "SDO of a coupler");
	s = (struct ec_ioc_sdo){ .position = 2, .index = 0x1018, .subindex = 1, .size = 4,
				 .data = (__u64)(unsigned long)data };
	expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), 0, "vendor id");
	expect(s.size == 4 && data[0] == 2, "vendor id: %u bytes, %u", s.size, data[0]);
}

static void check_foe(int fd)
{
	struct ec_ioc_foe f = { .position = 2, .name = "file", .size = 3,
				.data = (__u64)(unsigned long)"abc" };

	expect_errno(call(fd, EC_IOC_FOE_WRITE, &f), 0, "a file");
	f.done = (__u64)(unsigned long)bad_pointers[1];
	expect_errno(call(fd, EC_IOC_FOE_WRITE, &f), 0, "a file, progress to nowhere");
	f.data = (__u64)(unsigned long)data;
	for (f.size = 0; f.size < 3; f.size++)
		expect_errno(call(fd, EC_IOC_FOE_READ, &f), ENOBUFS, "a file into %u bytes",
			     f.size);
	f.size = ~0U;
	expect_errno(call(fd, EC_IOC_FOE_READ, &f), 0, "a file");
	expect(f.size == 3 && !memcmp(data, "abc", 3), "a file of %u bytes", f.size);
	for (unsigned int i = 0; i < BAD_POINTERS; i++) {
		f.size = 3;
		f.data = (__u64)(unsigned long)bad_pointers[i];
		expect_errno(call(fd, EC_IOC_FOE_READ, &f), EFAULT, "a file to %p",
			     bad_pointers[i]);
		expect_errno(call(fd, EC_IOC_FOE_WRITE, &f), EFAULT, "a file from %p",
			     bad_pointers[i]);
		/* no file is left, and the slave takes the next one */
		f.data = (__u64)(unsigned long)"abc";
		expect_errno(call(fd, EC_IOC_FOE_READ, &f), EIO, "a file that was not written");
		expect(f.error_code == 0x8001, "error code 0x%x", f.error_code);
		f.size = 3;
		expect_errno(call(fd, EC_IOC_FOE_WRITE, &f), 0, "a file");
	}
	f.position = 0;
	expect_errno(call(fd, EC_IOC_FOE_READ, &f), EPROTONOSUPPORT, "file of a coupler");
	f.position = 2;
	memset(f.name, 'x', sizeof(f.name));
	expect_errno(call(fd, EC_IOC_FOE_READ, &f), EIO, "a name without end");
	f.name[9] = '\n';
	expect_errno(call(fd, EC_IOC_FOE_READ, &f), EINVAL, "a name of two lines");
	f.name[0] = 0;
	expect_errno(call(fd, EC_IOC_FOE_READ, &f), EINVAL, "no name");
}

static void check_soe(int fd)
{
	static const __u32 wrong[] = { 0, 64 * 1024 + 1, 1U << 20, 1U << 31, ~0U };
	struct ec_ioc_soe s = { .position = 2, .idn = 91, .data = (__u64)(unsigned long)data };

	for (unsigned int i = 0; i < 5; i++) {
		s.size = wrong[i];
		expect_errno(call(fd, EC_IOC_SOE_WRITE, &s), EINVAL, "write %u bytes", wrong[i]);
		s.size = wrong[i];
		expect_errno(call(fd, EC_IOC_SOE_READ, &s), wrong[i] ? 0 : ENOBUFS,
			     "read into %u bytes", wrong[i]);
		expect(s.size == (wrong[i] ? 4 : 0), "read into %u bytes: %u", wrong[i], s.size);
	}
	s.size = 3;
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), ENOBUFS, "4 bytes into 3");
	s.size = 300;
	expect_errno(call(fd, EC_IOC_SOE_WRITE, &s), EMSGSIZE, "more than a message");
	s.size = 4;
	s.idn = 92;
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), EIO, "IDN that does not exist");
	expect(s.error_code == 0x1001, "error code 0x%08x", s.error_code);
	s.position = 0;
	s.size = 4;
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), EPROTONOSUPPORT, "IDN of a coupler");
	s.position = 3;
	s.size = 4;
	expect(call(fd, EC_IOC_SOE_READ, &s) != 0, "IDN of nobody");
	s = (struct ec_ioc_soe){ .position = 2, .idn = 91, .size = 4,
				 .data = (__u64)(unsigned long)data };
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), 0, "velocity limit");
	expect(s.size == 4 && data[0] == (3000 & 255), "velocity limit: %u bytes, %u", s.size,
	       data[0]);
}

static void check_sii(int fd)
{
	static const __u32 beyond[] = { 1U << 16, 1U << 31, ~0U };
	struct ec_ioc_sii s;

	for (unsigned int i = 0; i < 3; i++) {
		s = (struct ec_ioc_sii){ .offset = beyond[i], .size = ~0U,
					 .data = (__u64)(unsigned long)data };
		expect_errno(call(fd, EC_IOC_SII, &s), 0, "EEPROM from %u", beyond[i]);
		expect(s.size == 0, "EEPROM from %u: %u bytes", beyond[i], s.size);
	}
	s = (struct ec_ioc_sii){ .size = ~0U, .data = (__u64)(unsigned long)data };
	expect_errno(call(fd, EC_IOC_SII, &s), 0, "whole EEPROM");
	expect(s.size && s.size <= 64 * 1024, "whole EEPROM: %u bytes", s.size);
}

void check_values(void)
{
	int fd = open_master(O_RDWR);

	check_reg(fd);
	check_sdo(fd);
	check_soe(fd);
	check_foe(fd);
	check_sii(fd);
	for (unsigned int i = 0; i < 256; i++) {
		struct ec_ioc_state s = { .position = 1, .state = i };

		if (i != 1 && i != 2 && i != 3 && i != 4 && i != 8)
			expect_errno(call(fd, EC_IOC_STATE, &s), EINVAL, "AL state %u", i);
	}
	for (unsigned int bit = 0; bit < 32; bit++) {
		struct ec_ioc_debug d = { .level = (1U << bit) + 2 };

		expect_errno(call(fd, EC_IOC_DEBUG, &d), EINVAL, "debug level %u", d.level);
	}
	close(fd);
}
