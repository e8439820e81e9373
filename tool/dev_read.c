// SPDX-License-Identifier: GPL-2.0-only
/* What the kernel knows of a master and its slaves, read without bus traffic. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dev.h"
#include "sys.h"
#include "text.h"

#define SCAN_RETRIES	3

/**
 * master_read() - read the state of a master and of its network devices
 * @fd: its open file
 * @m: result
 *
 * Return: 0 or the errno.
 */
int master_read(int fd, struct master *m)
{
	struct ec_ioc_master state = { 0 };

	*m = (struct master){ 0 };
	if (sys_ioctl(fd, EC_IOC_MASTER, &state))
		return errno;
	memcpy(m, &state, sizeof(state));
	m->device_count = min(m->device_count, (u32)EC_UAPI_DEVICES);
	for (u32 i = 0; i < m->device_count; i++) {
		m->devices[i].index = i;
		if (sys_ioctl(fd, EC_IOC_DEVICE, &m->devices[i]))
			return errno;
		string_clean(m->devices[i].name, sizeof(m->devices[i].name));
	}
	return 0;
}

int dev_master(struct dev *d, struct master *m)
{
	int err;

	do
		err = master_read(d->fd, m);
	while (err == EINTR);
	return err ? dev_fail(d, err, "Master%u: cannot read master state", d->master) : 0;
}

static int get_names(struct dev *d, struct slave *s)
{
	struct ec_ioc_slave_names n = { .slave = s->slave };
	int err = dev_ioctl(d, EC_IOC_SLAVE_NAMES, &n);

	memcpy(s->group, n.group, sizeof(s->group));
	memcpy(s->image, n.image, sizeof(s->image));
	memcpy(s->order, n.order, sizeof(s->order));
	memcpy(s->name, n.name, sizeof(s->name));
	string_clean(s->group, sizeof(s->group));
	string_clean(s->image, sizeof(s->image));
	string_clean(s->order, sizeof(s->order));
	string_clean(s->name, sizeof(s->name));
	return err;
}

static int get_why(struct dev *d, struct slave *s)
{
	struct ec_ioc_slave_why w = { .slave = s->slave };
	int err = dev_ioctl(d, EC_IOC_SLAVE_WHY, &w);

	memcpy(s->why, w.why, sizeof(s->why));
	memcpy(s->warning, w.warning, sizeof(s->warning));
	s->cause = w.cause;
	string_clean(s->why, sizeof(s->why));
	string_clean(s->warning, sizeof(s->warning));
	return err;
}

static int get_ports(struct dev *d, struct slave *s)
{
	int err = 0;

	for (u32 i = 0; i < EC_UAPI_PORTS && !err; i++) {
		s->ports[i] = (struct ec_ioc_port){ .slave = s->slave, .port = i };
		err = dev_ioctl(d, EC_IOC_PORT, &s->ports[i]);
	}
	return err;
}

/* By any address; from then on by the device. */
static int get_slave(struct dev *d, const struct ec_ioc_address *address, struct slave *s)
{
	struct ec_ioc_slave state = { .slave = *address };
	int err = dev_ioctl(d, EC_IOC_SLAVE, &state);

	if (err)
		return err;
	*s = (struct slave){ 0 };
	memcpy(s, &state, sizeof(state));
	s->slave = (struct ec_ioc_address){
		.kind = EC_ADDRESS_DEVICE, .device = state.device,
	};
	err = get_names(d, s);
	err = err ? err : get_why(d, s);
	return err ? err : get_ports(d, s);
}

static int get_slave_at(struct dev *d, unsigned int position, struct slave *s)
{
	const struct ec_ioc_address address = { .position = (__u16)position };

	return get_slave(d, &address, s);
}

int dev_slave(struct dev *d, unsigned int position, struct slave *s)
{
	int err = get_slave_at(d, position, s);

	return err ? dev_fail(d, err, "Master%u slave %u: cannot read slave state", d->master,
			position) : 0;
}

int dev_slave_again(struct dev *d, const struct slave *of, struct slave *s)
{
	unsigned int position = of->position;
	int err = get_slave(d, &of->slave, s);

	return err ? dev_fail(d, err, "Master%u slave %u: cannot read slave state", d->master,
			position) : 0;
}

void dev_config_why(struct dev *d, unsigned int config, char *buf, size_t size)
{
	struct ec_ioc_config_why w = { .index = config };

	if (dev_ioctl(d, EC_IOC_CONFIG_WHY, &w))
		w.text[0] = '\0';
	string_clean(w.text, sizeof(w.text));
	snprintf(buf, size, "%s", w.text);
}

void slaves_free(struct slaves *s)
{
	free(s->v);
	*s = (struct slaves){ 0 };
}

/*
 * The bus may change while it is read: when a scan took place meanwhile the
 * list is read again, and a slave that is gone by then ends it.
 */
int dev_slaves(struct dev *d, struct slaves *all)
{
	*all = (struct slaves){ 0 };
	for (int i = 0;; i++) {
		struct master before, after;
		int err = 0;

		if (dev_master(d, &before))
			return 1;
		slaves_free(all);
		all->v = calloc(before.slave_count + 1, sizeof(*all->v));
		if (!all->v)
			return fail("out of memory");
		while (all->n < before.slave_count) {
			err = get_slave_at(d, (unsigned int)all->n, &all->v[all->n]);
			if (err)
				break;
			all->n++;
		}
		if (dev_master(d, &after)) {
			slaves_free(all);
			return 1;
		}
		if (before.scan_count != after.scan_count && i < SCAN_RETRIES)
			continue;
		if (err && before.scan_count == after.scan_count && !after.scan_busy) {
			slaves_free(all);
			return dev_fail(d, err, "Master%u slave %zu: cannot read slave state",
					d->master, all->n);
		}
		return 0;
	}
}
