// SPDX-License-Identifier: GPL-2.0-only
/* Indexes of what the application has made itself, and too much of it. */
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>
#include "fault.h"

static unsigned char arg[4096];

static void *zeroed(void)
{
	memset(arg, 0, sizeof(arg));
	return arg;
}

/* indexes of what the application has made itself */
static void wrong_indexes(int fd)
{
	static const __u32 wrong[] = { 1, 64, 65536, 1U << 31, ~0U };

	for (unsigned int i = 0; i < 5; i++) {
		__u32 w = wrong[i];
		struct ec_ioc_reg_entry e = { .config = w };
		struct ec_ioc_reg_entry d = { .domain = w, .entry_index = 0x7000, .subindex = 1 };
		struct ec_ioc_domain_offset o = { .domain = w };
		struct ec_ioc_config c = { .index = w };
		struct ec_ioc_domain dom = { .index = w };
		struct ec_ioc_domain_fmmu f = { .fmmu = w };
		struct ec_ioc_config_pdo p = { .pdo_pos = w + 15 };
		struct ec_ioc_config_entry ce = { .entry_pos = w + 7 };
		struct ec_ioc_config_sdo s = { .sdo_pos = w };
		struct ec_ioc_config_idn ci = { .idn_pos = w };
		struct ec_ioc_sc_watchdog wd = { .config = w };
		struct ec_ioc_sc_request req = { .config = w };
		struct ec_ioc_sc_emerg emerg = { .config = w };
		struct ec_ioc_sc_idn idn = { .config = w, .state = 2, .size = 2,
					     .data = (__u64)(unsigned long)arg };

		expect_errno(call(fd, EC_IOC_REG_ENTRY, &e), ENOENT, "entry of config %u", w);
		expect_errno(call(fd, EC_IOC_REG_ENTRY, &d), ENOENT, "entry in domain %u", w);
		expect_errno(call(fd, EC_IOC_DOMAIN_OFFSET, &o), ENOENT, "offset of domain %u", w);
		expect_errno(call(fd, EC_IOC_CONFIG, &c), ENOENT, "config %u", w);
		expect_errno(call(fd, EC_IOC_DOMAIN, &dom), ENOENT, "domain %u", w);
		expect_errno(call(fd, EC_IOC_DOMAIN_FMMU, &f), ENOENT, "FMMU %u", w);
		expect_errno(call(fd, EC_IOC_CONFIG_PDO, &p), ENOENT, "PDO %u", w + 15);
		expect_errno(call(fd, EC_IOC_CONFIG_ENTRY, &ce), ENOENT, "mapped entry %u", w);
		expect_errno(call(fd, EC_IOC_CONFIG_SDO, &s), ENOENT, "startup SDO %u", w);
		expect_errno(call(fd, EC_IOC_CONFIG_IDN, &ci), ENOENT, "startup IDN %u", w);
		expect_errno(call(fd, EC_IOC_SC_WATCHDOG, &wd), ENOENT, "watchdog of %u", w);
		expect_errno(call(fd, EC_IOC_SC_REQUEST, &req), ENOENT, "request of %u", w);
		expect_errno(call(fd, EC_IOC_SC_EMERG, &emerg), ENOENT, "emergencies of %u", w);
		expect_errno(call(fd, EC_IOC_SC_IDN, &idn), ENOENT, "startup IDN of %u", w);
	}
	for (unsigned int sm = 16; sm < 256; sm++) {
		struct ec_ioc_sc_sync s = { .sm = sm, .dir = 1 };
		struct ec_ioc_sc_pdo p = { .sm = sm, .op = sm & 1 };
		struct ec_ioc_config_sm c = { .sm = sm };

		expect_errno(call(fd, EC_IOC_SC_SYNC, &s), ENOENT, "SM%u", sm);
		expect_errno(call(fd, EC_IOC_SC_PDO, &p), EINVAL, "PDO at SM%u", sm);
		expect_errno(call(fd, EC_IOC_CONFIG_SM, &c), ENOENT, "configured SM%u", sm);
	}
	for (unsigned int v = 0; v < 256; v++) {
		struct ec_ioc_sc_idn state = { .state = v, .size = 2,
					       .data = (__u64)(unsigned long)arg };
		struct ec_ioc_sc_idn drive = { .drive = v, .state = 4, .size = 2,
					       .data = (__u64)(unsigned long)arg };
		struct ec_ioc_soe soe = { .drive = v, .size = 2,
					  .data = (__u64)(unsigned long)arg };
		struct ec_ioc_sdo_info info = { .slave.position = 2, .index = 0x1018, .subindex = 1,
						.what = EC_SDO_INFO_ENTRY, .value_info = v };
		struct ec_ioc_sdo_info list = { .slave.position = 2, .index = 1,
						.what = EC_SDO_INFO_LIST, .value_info = v };
		struct ec_ioc_sc_request kind = { .kind = v };
		struct ec_ioc_sc_sync dir = { .dir = v }, wd = { .dir = 1, .watchdog = v };
		struct ec_ioc_sc_pdo op = { .op = v };

		if (v & ~EC_SDO_VALUE_ALL)
			expect_errno(call(fd, EC_IOC_SDO_INFO, &info), EINVAL, "value info %u", v);
		if (v)
			expect_errno(call(fd, EC_IOC_SDO_INFO, &list), EINVAL, "list, info %u", v);
		if (v != 1 && v != 2)
			expect_errno(call(fd, EC_IOC_SC_SYNC, &dir), EINVAL, "direction %u", v);
		if (v > 2)
			expect_errno(call(fd, EC_IOC_SC_SYNC, &wd), EINVAL, "watchdog %u", v);
		if (v > 3)
			expect_errno(call(fd, EC_IOC_SC_PDO, &op), EINVAL, "operation %u", v);
		if (v > EC_REQUEST_SDO_INFO)
			expect_errno(call(fd, EC_IOC_SC_REQUEST, &kind), EINVAL, "kind %u", v);
		if (v != 2 && v != 4)
			expect_errno(call(fd, EC_IOC_SC_IDN, &state), EINVAL, "IDN in state %u", v);
		if (v > 7) {
			expect_errno(call(fd, EC_IOC_SC_IDN, &drive), EINVAL, "IDN of drive %u", v);
			expect_errno(call(fd, EC_IOC_SOE_READ, &soe), EINVAL, "read drive %u", v);
			expect_errno(call(fd, EC_IOC_SOE_WRITE, &soe), EINVAL, "write drive %u", v);
		}
	}
}

/* Calls until it is refused; returns how often it was taken. */
static unsigned int until_refused(int fd, unsigned long nr, void *a, unsigned int most, int *err)
{
	unsigned int n = 0;

	while (n < most && !(*err = call(fd, nr, a)))
		n++;
	return n;
}

/* One output SyncManager with @pdos PDOs of 255 entries of 255 bits: 8128 bytes each. */
static int large(int fd, __u16 position, unsigned int pdos, __u32 domain)
{
	struct ec_ioc_slave_config sc = { .position = position, .vendor_id = 1 };
	struct ec_ioc_sc_pdo p = { .sm = 2 };
	struct ec_ioc_sc_sync sync = { .sm = 2, .dir = 1 };
	struct ec_ioc_reg_entry e = { .domain = domain, .entry_index = 0x7000, .subindex = 1 };

	expect_errno(call(fd, EC_IOC_SLAVE_CONFIG, &sc), 0, "configuration %u", position);
	p.config = sync.config = e.config = sc.index;
	expect_errno(call(fd, EC_IOC_SC_SYNC, &sync), 0, "SyncManager 2");
	for (unsigned int i = 0; i < pdos; i++) {
		p.op = EC_SC_PDO_ASSIGN_ADD;
		p.pdo = 0x1600 + i;
		expect_errno(call(fd, EC_IOC_SC_PDO, &p), 0, "PDO %u", i);
		p.op = EC_SC_PDO_MAP_ADD;
		for (unsigned int k = 1; k <= 255; k++) {
			p.entry_index = 0x7000 + i;
			p.subindex = k;
			p.bits = 255;
			expect_errno(call(fd, EC_IOC_SC_PDO, &p), 0, "entry %u", k);
		}
		expect_errno(call(fd, EC_IOC_SC_PDO, &p), ENOSPC, "entry 256");
	}
	return call(fd, EC_IOC_REG_ENTRY, &e);
}

/* More process data than an ESC, a domain, a session can have. */
static void too_much_data(int fd)
{
	struct ec_ioc_create_domain d = { 0 };

	expect_errno(call(fd, EC_IOC_CREATE_DOMAIN, &d), 0, "domain");
	expect_errno(large(fd, 10, 8, 0), EOVERFLOW, "65 KB in one SyncManager");
	for (unsigned int i = 0; i < 5; i++)
		expect_errno(large(fd, 11 + i, 6, 0), 0, "48 KB of slave %u", 11 + i);
	expect_errno(large(fd, 20, 6, 0), EOVERFLOW, "292 KB in one domain");
	expect_errno(large(fd, 21, 6, d.index), 0, "48 KB in domain 1");
	expect_errno(call(fd, EC_IOC_ACTIVATE, zeroed()), EOVERFLOW, "292 KB in two domains");
	expect_errno(call(fd, EC_IOC_DEACTIVATE, NULL), EINVAL, "nothing was activated");
}

void check_limits(void)
{
	struct ec_ioc_sc_sdo sdo = { .index = 0x8000, .size = 1,
				     .data = (__u64)(unsigned long)arg };
	struct ec_ioc_sc_idn idn = { .idn = 15, .state = 2, .size = 2,
				     .data = (__u64)(unsigned long)arg };
	struct ec_ioc_sc_pdo pdo = { .sm = 3, .pdo = 0x1a00 };
	int fd = open_master(O_RDWR), err = 0;
	unsigned int n;

	session(fd);
	wrong_indexes(fd);
	n = until_refused(fd, EC_IOC_SC_SDO, &sdo, 100000, &err);
	expect(n == 1024 && err == ENOSPC, "%u startup SDOs, then error %d", n, err);
	n = until_refused(fd, EC_IOC_SC_IDN, &idn, 100000, &err);
	expect(n == 1024 && err == ENOSPC, "%u startup IDNs, then error %d", n, err);
	n = until_refused(fd, EC_IOC_SC_PDO, &pdo, 100000, &err);
	expect(n == 1024 && err == ENOSPC, "%u PDOs, then error %d", n, err);
	n = until_refused(fd, EC_IOC_CREATE_DOMAIN, zeroed(), 1000, &err);
	expect(n == EC_STATUS_DOMAINS - 1 && err == ENOSPC, "%u more domains, then error %d", n,
	       err);
	for (n = 1, err = 0; n < 10000 && !err; n++) {
		struct ec_ioc_slave_config sc = { .alias = n, .vendor_id = 1 };

		err = call(fd, EC_IOC_SLAVE_CONFIG, &sc);
	}
	expect(n - 1 == EC_STATUS_CONFIGS && err == ENOSPC, "%u configurations, then error %d",
	       n - 1, err);
	close(fd);
	fd = open_master(O_RDWR);
	session(fd);
	too_much_data(fd);
	close(fd);
}
