// SPDX-License-Identifier: GPL-2.0-only
/* Arguments that name what is not there, or carry impossible values. */
#include <errno.h>
#include <fcntl.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>
#include "fault.h"

static unsigned char data[1 << 17];

/* Every command for a slave with this address. */
static void all_refuse(int fd, const struct ec_ioc_address *a, int err, const char *what)
{
	static const unsigned long for_a_slave[] = {
		EC_IOC_SLAVE, EC_IOC_SLAVE_NAMES, EC_IOC_SLAVE_WHY, EC_IOC_PORT, EC_IOC_SM,
		EC_IOC_PDO, EC_IOC_PDO_ENTRY, EC_IOC_SII, EC_IOC_REG_READ, EC_IOC_REG_WRITE,
		EC_IOC_REG_RDWR, EC_IOC_STATE, EC_IOC_SDO_UPLOAD, EC_IOC_SDO_DOWNLOAD,
		EC_IOC_SDO_INFO, EC_IOC_SOE_READ, EC_IOC_SOE_WRITE, EC_IOC_FOE_READ,
		EC_IOC_FOE_WRITE, EC_IOC_IP_GET, EC_IOC_IP_SET, EC_IOC_EMERGENCIES,
		EC_IOC_LET_IN, EC_IOC_EOE_WISH,
	};
	union {
		struct ec_ioc_reg reg;
		struct ec_ioc_slave_why largest;
	} arg;

	_Static_assert(offsetof(struct ec_ioc_reg, slave) == offsetof(struct ec_ioc_foe, slave),
		       "at the same place in all");
	for (unsigned int i = 0; i < sizeof(for_a_slave) / sizeof(for_a_slave[0]); i++) {
		struct ec_ioc_reason r = { 0 };

		memset(&arg, 0, sizeof(arg));
		if (_IOC_SIZE(for_a_slave[i]) == sizeof(arg.reg)) {
			arg.reg.size = 4;
			arg.reg.data = (__u64)(unsigned long)data;
		}
		arg.reg.slave = *a;
		expect_errno(call(fd, for_a_slave[i], &arg), err, "command 0x%02x, %s",
			     (unsigned int)_IOC_NR(for_a_slave[i]), what);
		expect(!call(fd, EC_IOC_REASON, &r) && r.len, "command 0x%02x, %s: no reason",
		       (unsigned int)_IOC_NR(for_a_slave[i]), what);
	}
}

static void no_such_slave(int fd, __u16 position)
{
	const struct ec_ioc_address a = { .position = position };

	all_refuse(fd, &a, ENOENT, "no such position");
}

/* "three" has no alias, and device numbers from 1 on. */
void check_addresses(void)
{
	static const struct {
		struct ec_ioc_address a;
		int err;
		const char *what;
	} wrong[] = {
		{ { .kind = EC_ADDRESS_DEVICE + 1 }, EOPNOTSUPP, "unknown kind" },
		{ { .kind = ~0U }, EOPNOTSUPP, "unknown kind" },
		{ { .identification = 1 }, EOPNOTSUPP, "identification" },
		{ { .port = 1 }, EOPNOTSUPP, "port" },
		{ { .reserved = { 0, 0, 1 } }, EOPNOTSUPP, "reserved byte" },
		{ { .alias = 1 }, EINVAL, "position with alias" },
		{ { .station = 0x1001 }, EINVAL, "position with station address" },
		{ { .device = 1 }, EINVAL, "position with device number" },
		{ { .kind = EC_ADDRESS_ALIAS }, EINVAL, "alias 0" },
		{ { .kind = EC_ADDRESS_ALIAS, .position = 1 }, EINVAL, "alias 0" },
		{ { .kind = EC_ADDRESS_ALIAS, .alias = 7 }, ENOENT, "no such alias" },
		{ { .kind = EC_ADDRESS_ALIAS, .alias = 7, .device = 1 }, EINVAL, "alias with number" },
		{ { .kind = EC_ADDRESS_STATION }, ENOENT, "station address 0" },
		{ { .kind = EC_ADDRESS_STATION, .station = 0xffff }, ENOENT, "station address" },
		{ { .kind = EC_ADDRESS_STATION, .station = 0x1001, .position = 1 }, EINVAL,
		  "station address with position" },
		{ { .kind = EC_ADDRESS_DEVICE }, ENODEV, "device 0" },
		{ { .kind = EC_ADDRESS_DEVICE, .device = ~0ULL }, ENODEV, "last device number" },
		{ { .kind = EC_ADDRESS_DEVICE, .device = 1ULL << 32 }, ENODEV, "device number" },
		{ { .kind = EC_ADDRESS_DEVICE, .device = 1, .position = 1 }, EINVAL,
		  "device number with position" },
	};
	struct ec_ioc_reg r = { .flags = EC_REG_FLAG_EMERGENCY, .size = 2,
				.data = (__u64)(unsigned long)data };
	struct ec_ioc_slave s = { .slave.position = 1 };
	int fd = open_master(O_RDWR);

	for (unsigned int i = 0; i < sizeof(wrong) / sizeof(wrong[0]); i++)
		all_refuse(fd, &wrong[i].a, wrong[i].err, wrong[i].what);
	expect_errno(call(fd, EC_IOC_SLAVE, &s), 0, "slave 1");
	for (__u32 kind = EC_ADDRESS_STATION; kind <= EC_ADDRESS_DEVICE; kind++) {
		struct ec_ioc_slave same = { .slave.kind = kind };

		if (kind == EC_ADDRESS_STATION)
			same.slave.station = s.station;
		else
			same.slave.device = s.device;
		expect_errno(call(fd, EC_IOC_SLAVE, &same), 0, "slave 1 by kind %u", kind);
		expect(same.position == 1 && same.device == s.device, "kind %u: slave %u", kind,
		       same.position);
		/* by ring position only */
		r.slave = same.slave;
		expect_errno(call(fd, EC_IOC_REG_READ, &r), EINVAL, "emergency by kind %u", kind);
	}
	close(fd);
}

void check_positions(void)
{
	static const unsigned int wrong[] = { 8, 16, 127, 255 };
	int fd = open_master(O_RDWR);

	no_such_slave(fd, 3);
	no_such_slave(fd, 255);
	no_such_slave(fd, 65535);
	for (unsigned int i = 0; i < 4; i++) {
		struct ec_ioc_sm sm = { .slave.position = 1, .sm = wrong[i] };
		struct ec_ioc_pdo pdo = { .slave.position = 1, .sm = wrong[i] };
		struct ec_ioc_pdo_entry entry = { .slave.position = 1, .sm = wrong[i] };

		expect_errno(call(fd, EC_IOC_SM, &sm), EINVAL, "SM%u", wrong[i]);
		expect_errno(call(fd, EC_IOC_PDO, &pdo), EINVAL, "PDO at SM%u", wrong[i]);
		expect_errno(call(fd, EC_IOC_PDO_ENTRY, &entry), EINVAL, "entry at SM%u",
			     wrong[i]);
		pdo = (struct ec_ioc_pdo){ .slave.position = 1, .pdo_pos = 0xff00 + wrong[i] };
		expect_errno(call(fd, EC_IOC_PDO, &pdo), EINVAL, "PDO %u", pdo.pdo_pos);
		entry = (struct ec_ioc_pdo_entry){ .slave.position = 1,
			.pdo_pos = 0xff00 + wrong[i] };
		expect_errno(call(fd, EC_IOC_PDO_ENTRY, &entry), EINVAL, "entry of PDO %u",
			     entry.pdo_pos);
		entry = (struct ec_ioc_pdo_entry){ .slave.position = 1,
			.entry_pos = 0xff00 + wrong[i] };
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
	struct ec_ioc_sdo s = { .slave.position = 2, .index = 0x1018, .subindex = 1,
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
	s.slave.position = 0;
	s.size = 4;
	expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), EPROTONOSUPPORT, "SDO of a coupler");
	s = (struct ec_ioc_sdo){ .slave.position = 2, .index = 0x1018, .subindex = 1, .size = 4,
				 .data = (__u64)(unsigned long)data };
	expect_errno(call(fd, EC_IOC_SDO_UPLOAD, &s), 0, "vendor id");
	expect(s.size == 4 && data[0] == 2, "vendor id: %u bytes, %u", s.size, data[0]);
}

static void check_foe(int fd)
{
	struct ec_ioc_foe f = { .slave.position = 2, .name = "file", .size = 3,
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
	f.slave.position = 0;
	expect_errno(call(fd, EC_IOC_FOE_READ, &f), EPROTONOSUPPORT, "file of a coupler");
	f.slave.position = 2;
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
	struct ec_ioc_soe s = { .slave.position = 2, .idn = 91,
				.data = (__u64)(unsigned long)data };

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
	expect_errno(call(fd, EC_IOC_SOE_WRITE, &s), EIO, "more than a message");
	expect(s.error_code == 0x7003, "error code 0x%08x", s.error_code);
	s.flags = 0x30;
	s.size = 4;
	expect_errno(call(fd, EC_IOC_SOE_WRITE, &s), EINVAL, "two elements at a time");
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), ENOBUFS, "minimum and maximum into 4 bytes");
	s.size = 8;
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), 0, "minimum and maximum");
	expect(s.size == 8 && data[0] == 10 && data[4] == (6000 & 255), "%u bytes", s.size);
	s.flags = 0;
	s.size = 4;
	s.idn = 92;
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), EIO, "IDN that does not exist");
	expect(s.error_code == 0x1001, "error code 0x%08x", s.error_code);
	s.slave.position = 0;
	s.size = 4;
	expect_errno(call(fd, EC_IOC_SOE_READ, &s), EPROTONOSUPPORT, "IDN of a coupler");
	s.slave.position = 3;
	s.size = 4;
	expect(call(fd, EC_IOC_SOE_READ, &s) != 0, "IDN of nobody");
	s = (struct ec_ioc_soe){ .slave.position = 2, .idn = 91, .size = 4,
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
		struct ec_ioc_state s = { .slave.position = 1, .state = i };

		if (i != 1 && i != 2 && i != 3 && i != 4 && i != 8)
			expect_errno(call(fd, EC_IOC_STATE, &s), EINVAL, "AL state %u", i);
	}
	for (unsigned int bit = 0; bit < 32; bit++) {
		struct ec_ioc_debug d = { .level = (1U << bit) + 2 };

		expect_errno(call(fd, EC_IOC_DEBUG, &d), EINVAL, "debug level %u", d.level);
	}
	close(fd);
}
