// SPDX-License-Identifier: GPL-2.0-only
/*
 * The devices of slaves follow the list of slaves, in a work behind the monitor. A device belongs
 * to a device number and an identity, so it stays when a scan has found its slave once more. The
 * work reads the list as commands do that show something: it delays no scan.
 *
 * A loose contact would fill the queues of all programs that listen: a place, which is the port of
 * a slave that stays, has a limited number of uevents. Of further changes the master has one.
 */
#include <linux/device.h>
#include <linux/ktime.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include "../bus/slave.h"
#include "slave_device.h"
#include "slave_devices.h"

#define STEP	64	/* slaves in a section of a reader */

static struct ec_slave_device *device_of(struct ec_slave_devices *sd, u64 number)
{
	struct ec_slave_device *d = xa_load(&sd->table, number);

	return d && d->at.number == number ? d : NULL;
}

static u32 now_s(void)
{
	return div_u64(ktime_get_ns(), NSEC_PER_SEC);
}

/* May a change have a uevent? If not, the master has one. */
static bool slave_devices_admit(struct ec_slave_devices *sd, struct ec_uevent_rate *rate)
{
	bool ok = ec_uevent_rate_admit(rate, now_s());

	sd->more += !ok;
	return ok;
}

/* Of changes without a uevent: once a second at most, and after the last one as well. */
static void slave_devices_change(struct ec_slave_devices *sd, struct device *parent)
{
	u64 now = ktime_get_ns(), due = sd->change_ns + NSEC_PER_SEC;
	char text[40];
	char *env[2] = { text };

	if (!sd->more)
		return;
	if (sd->change_ns && now < due) {
		queue_delayed_work(system_unbound_wq, &sd->work, nsecs_to_jiffies(due - now) + 1);
		return;
	}
	scnprintf(text, sizeof(text), "ETHERCAT_SLAVES_CHANGED=%u", sd->more);
	sd->more = 0;
	sd->change_ns = now;
	kobject_uevent_env(&parent->kobj, KOBJ_CHANGE, env);
}

/* the list ------------------------------------------------------------------*/

/* Begin to read, unless the list is, or will soon be, another one: the monitor kicks again. */
static bool begin_step(struct ec_slave_devices *sd, u32 lists)
{
	struct ec_bus *bus = sd->bus;

	cond_resched();
	if (ec_show_begin(&bus->base->show))
		return false;
	/* a scan is busy until the list that replaces an empty one is shown */
	if (READ_ONCE(bus->lists) == lists && !ec_bus_scan_busy(bus))
		return true;
	ec_show_end(&bus->base->show);
	return false;
}

/* All slaves; NULL: no memory, or another list. To be freed. */
static struct ec_slave_at *read_list(struct ec_slave_devices *sd, u32 lists, unsigned int *n)
{
	const struct ec_bus *bus = sd->bus;
	unsigned int i = 0, end, size = READ_ONCE(bus->n_slaves);
	struct ec_slave_at *at = kvcalloc(size + 1, sizeof(*at), GFP_KERNEL);

	if (!at)
		return NULL;
	do {
		if (!begin_step(sd, lists))
			break;
		/* @size is that of the list before, if this is the first step of another one */
		*n = bus->n_slaves;
		for (end = min(i + STEP, *n); i < end && *n <= size; i++)
			ec_slave_device_locate(bus->slaves[i], &at[i]);
		ec_show_end(&bus->base->show);
		if (*n <= size && i == *n)
			return at;
	} while (*n <= size);
	kvfree(at);
	return NULL;
}

/* loss ----------------------------------------------------------------------*/

/* Which of the devices are lost, and where are the others? */
static void find_lost(struct ec_slave_devices *sd, const struct ec_slave_at *at, unsigned int n)
{
	struct ec_slave_device *d;
	unsigned long index;
	unsigned int i;

	xa_for_each(&sd->table, index, d) {
		d->lost = true;
		d->rate = NULL;
	}
	for (i = 0; i < n; i++) {
		d = device_of(sd, at[i].number);
		if (!d || memcmp(&at[i].id, &d->at.id, sizeof(d->at.id)))
			continue;
		d->lost = false;
		d->at.up = at[i].up;
		d->at.port = at[i].port;
	}
}

static struct ec_uevent_rate *rate_at(struct ec_slave_devices *sd, const struct ec_slave_at *at)
{
	struct ec_slave_device *up = device_of(sd, at->up);

	return up ? &up->ports[at->port] : &sd->rate;
}

/* What was lost together was lost where the first of them hung. */
static void find_break(struct ec_slave_devices *sd, struct ec_slave_device *d)
{
	struct ec_slave_device *first = d, *up;
	struct ec_uevent_rate *rate;

	/* the places of all lost ones are of one list: there is no loop */
	while (!first->rate && (up = device_of(sd, first->at.up)) && up->lost)
		first = up;
	rate = first->rate ?: rate_at(sd, &first->at);
	for (up = d; up != first; up = device_of(sd, up->at.up))
		up->rate = rate;
	first->rate = rate;
}

static void remove_lost(struct ec_slave_devices *sd)
{
	struct ec_slave_device *d;
	unsigned long index;

	xa_for_each(&sd->table, index, d)
		if (d->lost && !d->rate)
			find_break(sd, d);
	xa_for_each(&sd->table, index, d) {
		if (!d->lost)
			continue;
		xa_erase(&sd->table, index);
		ec_slave_device_remove(d, slave_devices_admit(sd, d->rate));
		cond_resched();
	}
}

/* new ones ------------------------------------------------------------------*/

static int add(struct ec_slave_devices *sd, struct device *parent, const struct ec_slave_at *at)
{
	struct ec_slave_device *d, *up = device_of(sd, at->up);
	int ret = -ENOSPC;

	d = ec_slave_device_alloc(sd->bus, parent, at);
	if (!d)
		return -ENOMEM;
	/* what hangs at a new one has come with it */
	d->rate = up && up->rate ? up->rate : rate_at(sd, at);
	/* an index may have 32 bits */
	if (at->number == (unsigned long)at->number)
		ret = xa_insert(&sd->table, at->number, d, GFP_KERNEL);
	if (ret)
		goto err;
	ret = ec_slave_device_add(d, slave_devices_admit(sd, d->rate));
	if (!ret)
		return 0;
	xa_erase(&sd->table, at->number);
err:
	ec_slave_device_free(d);
	return ret;
}

/* Return: whether all are devices now. */
static bool add_new(struct ec_slave_devices *sd, struct device *parent,
		    const struct ec_slave_at *at, unsigned int n)
{
	bool all = true;
	unsigned int i;
	int ret;

	for (i = 0; i < n && READ_ONCE(sd->parent); i++) {
		ret = device_of(sd, at[i].number) ? 0 : add(sd, parent, &at[i]);
		all &= !ret;
		if (ret)
			ec_log_event(sd->bus->base, i, 0, KERN_WARNING,
				     "no device in sysfs (%pe); retrying\n",
				     ERR_PTR(ret));
		cond_resched();
	}
	return all;
}

/* work ----------------------------------------------------------------------*/

static void follow_list(struct work_struct *work)
{
	struct ec_slave_devices *sd = container_of(to_delayed_work(work), struct ec_slave_devices,
						   work);
	struct device *parent = READ_ONCE(sd->parent);
	u32 lists = READ_ONCE(sd->bus->lists);
	struct ec_slave_at *at = NULL;
	unsigned int n;

	if (!parent)
		return;
	if (lists != sd->synced || sd->incomplete)
		at = read_list(sd, lists, &n);
	if (at) {
		find_lost(sd, at, n);
		remove_lost(sd);
		sd->incomplete = !add_new(sd, parent, at, n);
		WRITE_ONCE(sd->synced, lists);
		kvfree(at);
	}
	slave_devices_change(sd, parent);
	if (sd->incomplete)
		queue_delayed_work(system_unbound_wq, &sd->work, HZ);
}

/**
 * ec_slave_devices_start() - the slaves of a master become devices from now on
 * @sd: zeroed structure
 * @bus: slaves
 * @parent: device of the master, until ec_slave_devices_stop()
 *
 * Context: Process.
 */
void ec_slave_devices_start(struct ec_slave_devices *sd, struct ec_bus *bus, struct device *parent)
{
	sd->bus = bus;
	INIT_DELAYED_WORK(&sd->work, follow_list);
	xa_init(&sd->table);
	/* all of it before the monitor sees that it has begun */
	smp_store_release(&sd->parent, parent);
}

/**
 * ec_slave_devices_kick() - the list of slaves may have changed
 * @sd: devices of a master
 *
 * Context: The monitor.
 */
void ec_slave_devices_kick(struct ec_slave_devices *sd)
{
	/* pairs with ec_slave_devices_start() */
	if (smp_load_acquire(&sd->parent) && READ_ONCE(sd->synced) != READ_ONCE(sd->bus->lists) &&
	    !ec_bus_scan_busy(sd->bus))
		mod_delayed_work(system_unbound_wq, &sd->work, 0);
}

/**
 * ec_slave_devices_stop() - remove all devices
 * @sd: devices of a master
 *
 * While the monitor runs it may kick once more, without effect: the call is repeated when the
 * monitor has ended.
 *
 * Context: Process. Waits for readers of the attributes.
 */
void ec_slave_devices_stop(struct ec_slave_devices *sd)
{
	struct ec_slave_device *d;
	unsigned long index;

	if (!sd->bus)
		return;
	WRITE_ONCE(sd->parent, NULL);
	cancel_delayed_work_sync(&sd->work);
	xa_for_each(&sd->table, index, d) {
		d->lost = true;
		d->rate = &sd->rate;
	}
	remove_lost(sd);
	xa_destroy(&sd->table);
}
