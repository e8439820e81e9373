// SPDX-License-Identifier: GPL-2.0-only
/*
 * A program of interface version 3, built from the headers beside it: it reads all that there is
 * to read, uses the mailbox of a slave, and runs a cycle. Like these headers it never changes.
 *
 * usage: abi_v3 DEVICE      its segment: "three", EK1100, EL2008 with an alias, EL7201
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>
#include "ethercat.h"

#define COUPLER	0
#define OUTPUTS	1
#define AXIS	2
#define N	3

#define CHECK(c) check(c, __LINE__, #c)
#define DONE(cmd, arg) check(!ioctl(fd, cmd, arg), __LINE__, #cmd)
#define FAILS(cmd, arg, err) \
	check(ioctl(fd, cmd, arg) < 0 && errno == (err), __LINE__, #cmd " " #err)

static int fd;
static unsigned int checks, wrong;

static void check(int good, int line, const char *what)
{
	struct ec_ioc_reason r = { 0 };
	int err = errno;

	checks++;
	if (good)
		return;
	wrong++;
	ioctl(fd, EC_IOC_REASON, &r);
	printf("line %d: %s: %s: %s\n", line, what, strerror(err), r.text);
}

static void master(void)
{
	struct ec_ioc_version v = { .abi = EC_UAPI_VERSION };
	struct ec_ioc_device d = { 0 };
	struct ec_ioc_master m = { 0 };

	DONE(EC_IOC_VERSION, &v);
	CHECK(v.abi >= 3 && v.master_count && v.release[0]);
	CHECK(v.features & EC_FEATURE_APP_CYCLE && v.features & EC_FEATURE_COE);
	DONE(EC_IOC_MASTER, &m);
	CHECK(m.slave_count == N && m.slaves_responding == N && m.device_count >= 1);
	CHECK(m.links_up & 1 && m.phase == EC_PHASE_IDLE && m.scan_count);
	DONE(EC_IOC_DEVICE, &d);
	CHECK(d.link_up && d.slaves == N && d.state == EC_DEVICE_ATTACHED && d.tx_frames);
	d.index = 7;
	FAILS(EC_IOC_DEVICE, &d, ENOENT);
}

static struct ec_ioc_address device(uint16_t position)
{
	struct ec_ioc_slave s = { .slave.position = position };

	DONE(EC_IOC_SLAVE, &s);
	CHECK(s.position == position && s.device && s.vendor_id == 2 && s.al_status);
	return (struct ec_ioc_address){ .kind = EC_ADDRESS_DEVICE, .device = s.device };
}

static void slaves(void)
{
	struct ec_ioc_slave s = { .slave = { .kind = EC_ADDRESS_ALIAS, .alias = 1001 } };
	struct ec_ioc_slave_names n = { .slave.position = AXIS };
	struct ec_ioc_slave_why w = { .slave.position = AXIS };
	struct ec_ioc_port p = { .slave.position = AXIS };
	struct ec_ioc_sm sm = { .slave.position = AXIS, .sm = 2 };
	struct ec_ioc_pdo pdo = { .slave.position = AXIS, .sm = 2 };
	struct ec_ioc_pdo_entry e = { .slave.position = AXIS, .sm = 2 };
	uint8_t bytes[128];
	struct ec_ioc_sii sii = { .slave.position = AXIS, .size = sizeof(bytes),
				  .data = (uintptr_t)bytes };
	struct ec_ioc_emergencies em = { .slave.position = AXIS, .size = sizeof(bytes),
					 .data = (uintptr_t)bytes };

	DONE(EC_IOC_SLAVE, &s);
	CHECK(s.position == OUTPUTS && s.alias == 1001 && s.alias_group == 1001 && !s.alias_pos);
	DONE(EC_IOC_SLAVE_NAMES, &n);
	CHECK(!strcmp(n.order, "EL7201") && n.name[0]);
	DONE(EC_IOC_SLAVE_WHY, &w);
	CHECK(!w.why[0] && w.cause.kind == EC_CAUSE_NONE);
	DONE(EC_IOC_PORT, &p);
	CHECK(p.link_up && p.next_slave == OUTPUTS);
	DONE(EC_IOC_SM, &sm);
	CHECK(sm.start && sm.pdo_count);
	DONE(EC_IOC_PDO, &pdo);
	CHECK(pdo.index >= 0x1600 && pdo.index < 0x1800 && pdo.entry_count);
	DONE(EC_IOC_PDO_ENTRY, &e);
	CHECK(e.index && e.bits);
	DONE(EC_IOC_SII, &sii);
	CHECK(sii.size == sizeof(bytes) && bytes[0x10] == 2);
	DONE(EC_IOC_EMERGENCIES, &em);
	CHECK(!em.size && !em.total);
	s.slave = (struct ec_ioc_address){ .kind = EC_ADDRESS_DEVICE, .device = ~0ULL };
	FAILS(EC_IOC_SLAVE, &s, ENODEV);
	s.slave = (struct ec_ioc_address){ .position = N };
	FAILS(EC_IOC_SLAVE, &s, ENOENT);
}

static void traffic(void)
{
	const struct ec_ioc_address axis = device(AXIS);
	uint32_t vendor = 0;
	uint16_t al = 0;
	struct ec_ioc_sdo sdo = { .slave = axis, .index = 0x1018, .subindex = 1, .size = 4,
				  .data = (uintptr_t)&vendor };
	struct ec_ioc_reg reg = { .slave = axis, .address = 0x0130, .size = 2,
				  .data = (uintptr_t)&al };
	struct ec_ioc_state state = { .slave = axis, .state = 2 };
	uint8_t answer[64];
	struct ec_ioc_sdo_info info = { .slave = axis, .index = 0x1018, .what = EC_SDO_INFO_OBJECT,
					.size = sizeof(answer), .data = (uintptr_t)answer };

	DONE(EC_IOC_SDO_UPLOAD, &sdo);
	CHECK(vendor == 2 && sdo.size == 4);
	FAILS(EC_IOC_SDO_DOWNLOAD, &sdo, EIO);
	CHECK(sdo.abort_code);
	DONE(EC_IOC_SDO_INFO, &info);
	CHECK(info.size > 6);
	DONE(EC_IOC_REG_READ, &reg);
	CHECK((al & 0xf) == 2);
	DONE(EC_IOC_STATE, &state);
}

static void events(const char *path)
{
	struct ec_ioc_events arg = { .size = sizeof(struct ec_event) };
	int own = open(path, O_RDONLY), was = fd;
	struct ec_event e;

	fd = own;
	DONE(EC_IOC_EVENTS, &arg);
	CHECK(read(own, &e, sizeof(e)) == sizeof(e) && e.kind && e.number == arg.first);
	close(own);
	fd = was;
}

/* Eight outputs of slave OUTPUTS, some cycles, and what the status page has of them. */
static void cycle(void)
{
	struct ec_ioc_create_domain d = { 0 };
	struct ec_ioc_slave_config sc = { .alias = 1001, .vendor_id = 2, .product_code = 0x07d83052 };
	struct ec_ioc_reg_entry e = { .entry_index = 0x7000, .subindex = 1 };
	struct ec_ioc_interval interval = { .interval_us = 2000 };
	struct ec_ioc_config_why why = { 0 };
	struct ec_ioc_domain dom = { 0 };
	struct ec_ioc_config c = { 0 };
	struct ec_ioc_activate a = { 0 };
	struct ec_ioc_send send = { .queued = 1 };
	const struct ec_status *st;
	unsigned int i;
	uint8_t *image;

	DONE(EC_IOC_RESERVE, NULL);
	DONE(EC_IOC_INTERVAL, &interval);
	DONE(EC_IOC_CREATE_DOMAIN, &d);
	DONE(EC_IOC_SLAVE_CONFIG, &sc);
	DONE(EC_IOC_REG_ENTRY, &e);
	DONE(EC_IOC_ACTIVATE, &a);
	CHECK(a.image_size && a.status_size >= sizeof(*st) && !a.exchange_size);
	st = mmap(NULL, a.status_size, PROT_READ, MAP_SHARED, fd, (off_t)EC_MMAP_STATUS);
	image = mmap(NULL, a.image_size, PROT_READ | PROT_WRITE, MAP_SHARED, fd,
		     (off_t)EC_MMAP_IMAGE);
	CHECK(st != MAP_FAILED && image != MAP_FAILED && st->magic == EC_STATUS_MAGIC);
	image[e.offset] |= 1;
	for (i = 0; i < 2500 && !(st->configs[0] & EC_STATUS_SC_OP); i++) {
		CHECK(!(i & 1 ? posix_fadvise(fd, 0, 0, EC_ADVICE_RECEIVE) :
				ioctl(fd, EC_IOC_RECEIVE)));
		DONE(EC_IOC_SEND, &send);
		usleep(2000);
	}
	DONE(EC_IOC_RECEIVE, NULL);
	CHECK(st->configs[0] == (EC_STATUS_SC_OP | EC_STATUS_SC_ONLINE | 8));
	CHECK(st->cycle && st->link_up && st->slaves_responding == N);
	DONE(EC_IOC_CONFIG, &c);
	CHECK(c.slave_position == OUTPUTS && c.device && c.vendor_id == 2);
	DONE(EC_IOC_CONFIG_WHY, &why);
	CHECK(!why.len);
	DONE(EC_IOC_DOMAIN, &dom);
	CHECK(dom.size && dom.expected && dom.fmmu_count);
	DONE(EC_IOC_DEACTIVATE, NULL);
	DONE(EC_IOC_RELEASE, NULL);
}

int main(int argc, char **argv)
{
	const char *path = argc > 1 ? argv[1] : "/dev/EtherCAT0";

	fd = open(path, O_RDWR);
	if (fd < 0) {
		perror(path);
		return 1;
	}
	master();
	slaves();
	traffic();
	events(path);
	cycle();
	printf("%u checks, %u wrong\n", checks, wrong);
	return wrong || !checks;
}
