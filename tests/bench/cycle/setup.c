// SPDX-License-Identifier: LGPL-2.1-or-later
/* All process data of all slaves, spread over the domains. */
#include "bench.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <uapi/ethercat.h>

/* One entry brings the whole SyncManager into the domain. */
static int add_sync(struct bench *b, const ec_slave_info_t *slave, uint8_t sm,
		    ec_slave_config_t *sc, ec_domain_t *domain)
{
	ec_sync_info_t sync;
	ec_pdo_info_t pdo;
	unsigned int bit;
	uint16_t i;
	int ret;

	if (ecrt_master_get_sync_manager(b->master, slave->position, sm, &sync))
		return -1;
	for (i = 0; i < sync.n_pdos; i++) {
		if (ecrt_master_get_pdo(b->master, slave->position, sm, i, &pdo))
			return -1;
		if (!pdo.n_entries)
			continue;
		ret = ecrt_slave_config_reg_pdo_entry_pos(sc, sm, i, 0, domain,
							  &bit);
		return ret < 0 ? ret : 0;
	}
	return 0;
}

static int add_slave(struct bench *b, uint16_t position)
{
	ec_domain_t *domain = b->domains[position % b->n_domains];
	ec_slave_config_t *sc;
	ec_slave_info_t slave;
	uint8_t sm;

	if (ecrt_master_get_slave(b->master, position, &slave))
		return -1;
	sc = ecrt_master_slave_config(b->master, 0, position, slave.vendor_id,
				      slave.product_code);
	if (!sc)
		return -1;
	b->sc[b->slaves++] = sc;
	for (sm = 0; sm < slave.sync_count; sm++)
		if (add_sync(b, &slave, sm, sc, domain))
			return -1;
	return 0;
}

/* A unit of its own for each domain */
static int add_units(struct bench *b)
{
	ec_unit_config_t config = { .policy = EC_UNIT_ZERO };
	unsigned int i;
	char name[16];
	int unit;

	config.name = name;
	for (i = 0; i < b->n_domains; i++) {
		snprintf(name, sizeof(name), "unit%u", i);
		unit = ecrt_master_unit(b->master, &config);
		if (unit < 0 || ecrt_domain_set_unit(b->domains[i], unit))
			return -1;
	}
	return 0;
}

static int kernel_cycle(struct bench *b)
{
	ec_cycle_config_t config = {
		.period_ns = b->period_us * 1000, .priority = 90,
		.dc = b->extras ? EC_CYCLE_SYNC_REFERENCE | EC_CYCLE_SYNC_SLAVES |
				  EC_CYCLE_SYNC_MONITOR : 0,
		.flags = (b->interrupt ? EC_CYCLE_INTERRUPT : 0) |
			 (b->cpu >= 0 ? EC_CYCLE_BIND_CPU : 0),
		.cpu = b->cpu,
	};

	return ecrt_master_set_cycle(b->master, &config);
}

int setup(struct bench *b)
{
	ec_master_info_t info;
	unsigned int i;

	for (i = 0; i < b->n_domains; i++) {
		b->domains[i] = ecrt_master_create_domain(b->master);
		if (!b->domains[i])
			return -1;
	}
	if (ecrt_master(b->master, &info))
		return -1;
	if (!info.slave_count || info.slave_count > SLAVES_MAX) {
		fprintf(stderr, "cycle-bench: %u slaves; 1..%u are needed\n",
			info.slave_count, SLAVES_MAX);
		return -1;
	}
	for (i = 0; i < info.slave_count; i++)
		if (add_slave(b, (uint16_t)i))
			return -1;
	for (i = 0; i < b->n_domains; i++)
		b->image_bytes += ecrt_domain_size(b->domains[i]);
	if (b->units && add_units(b))
		return -1;
	if (b->extras && extras_setup(b))
		return -1;
	if (b->mode == MODE_OWN ? ecrt_master_set_send_interval(b->master, b->period_us) :
				  kernel_cycle(b))
		return -1;
	return ecrt_master_activate(b->master);
}

static int open_master(const struct bench *b)
{
	char path[40];

	snprintf(path, sizeof(path), "/dev/EtherCAT%u", b->index);
	return open(path, O_RDONLY | O_CLOEXEC);
}

void frame_counters(const struct bench *b, unsigned long long *lost,
		    unsigned long long *late)
{
	struct ec_ioc_device device;
	unsigned int i;
	int fd = open_master(b);

	*lost = 0;
	*late = 0;
	if (fd < 0)
		return;
	for (i = 0; i < EC_UAPI_DEVICES; i++) {
		memset(&device, 0, sizeof(device));
		device.index = i;
		if (ioctl(fd, EC_IOC_DEVICE, &device))
			break;
		*lost += device.lost;
		*late += device.late;
	}
	close(fd);
}

/* Smallest price of a command that the driver refuses at once. */
uint32_t syscall_entry(const struct bench *b)
{
	uint32_t best = UINT32_MAX;
	int fd = open_master(b), i;

	for (i = 0; fd >= 0 && i < 100; i++) {
		uint64_t from = ticks();
		uint32_t took;

		ioctl(fd, _IO('E', 0));
		took = (uint32_t)(ticks() - from);
		best = took < best ? took : best;
	}
	if (fd >= 0)
		close(fd);
	return best;
}

/* Where the kernel ran the last cycle. */
bool in_interrupt(const struct bench *b)
{
	struct ec_ioc_cycle_stats info;
	int fd = open_master(b);
	bool is = false;

	memset(&info, 0, sizeof(info));
	if (fd >= 0) {
		is = !ioctl(fd, EC_IOC_CYCLE_STATS, &info) &&
		     info.place == EC_CYCLE_PLACE_INTERRUPT;
		close(fd);
	}
	return is;
}
