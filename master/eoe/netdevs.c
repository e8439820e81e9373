// SPDX-License-Identifier: GPL-2.0-only
/*
 * The network devices follow the list of slaves, in a work behind the monitor. A network device
 * belongs to a device number, so it finds its slave again wherever that is connected. While it is
 * up it stays when its slave is lost, without a carrier: addresses, bridges and rules remain.
 *
 * Only the work changes the table, and ec_eoe_stop() behind it, so no lock is held while a device
 * is registered or removed, which waits for its users.
 */
#include <linux/etherdevice.h>
#include <linux/slab.h>
#include "../bus/known.h"
#include "../bus/slave.h"
#include "../link/device.h"
#include "../link/links.h"
#include "ids.h"
#include "netdev.h"
#include "netdevs.h"

#define FOLLOW		(HZ / 10)	/* distance of the looks at slaves of devices that are up */

static bool wanted(struct ec_eoe *eoe, u64 device)
{
	void *wish = xa_load(&eoe->wishes, device);

	return wish ? xa_to_value(wish) == EC_EOE_WISH_ON : eoe->automatic;
}

static bool has_same_name(const struct ec_eoe_id *a, const struct ec_eoe_id *b)
{
	return ec_eoe_ids_same(a, b) && a->alias_shared == b->alias_shared &&
	       a->serial_shared == b->serial_shared;
}

/* The only slave without a device that is the same; NULL: none, or there are several. */
static const struct ec_eoe_id *find_only(struct ec_eoe *eoe, const struct ec_eoe_id *lost,
					 const struct ec_eoe_id *ids, unsigned int n)
{
	const struct ec_eoe_id *found = NULL;
	unsigned int i;

	for (i = ec_eoe_ids_first(ids, n, lost); i < n && ec_eoe_ids_same(&ids[i], lost); i++) {
		if (xa_load(&eoe->table, ids[i].device))
			continue;
		if (found)
			return NULL;
		found = &ids[i];
	}
	/* an index may have 32 bits */
	return found && found->device == (unsigned long)found->device ? found : NULL;
}

/* The slave of a device has come back under another device number; so has the wish for it. */
static void adopt_one(struct ec_eoe *eoe, struct ec_eoe_netdev *d, const struct ec_eoe_id *ids,
		      unsigned int n)
{
	const struct ec_eoe_id *id = find_only(eoe, &d->id, ids, n);
	unsigned long old = d->id.device;
	void *wish;

	if (!id || xa_err(xa_store(&eoe->table, id->device, d, GFP_KERNEL)))
		return;
	xa_erase(&eoe->table, old);
	d->id.device = id->device;
	mutex_lock(&eoe->lock);
	wish = xa_erase(&eoe->wishes, old);
	if (wish)
		xa_store(&eoe->wishes, id->device, wish, GFP_KERNEL);
	mutex_unlock(&eoe->lock);
}

static void adopt_lost(struct ec_eoe *eoe, struct ec_eoe_id *ids, unsigned int n)
{
	struct ec_eoe_netdev *d;
	unsigned long device;

	xa_for_each(&eoe->table, device, d)
		WRITE_ONCE(d->connected, ec_eoe_ids_find(ids, n, device));
	ec_eoe_ids_by_unit(ids, n);
	xa_for_each(&eoe->table, device, d)
		if (!d->connected)
			adopt_one(eoe, d, ids, n);
	ec_eoe_ids_by_device(ids, n);
}

/*
 * Remove devices that are not wished, and those that are down and whose slave is lost or would have
 * another name.
 */
static void remove_old(struct ec_eoe *eoe, const struct ec_eoe_id *ids, unsigned int n)
{
	const struct ec_eoe_id *id;
	struct ec_eoe_netdev *d;
	unsigned long device;
	LIST_HEAD(old);

	xa_for_each(&eoe->table, device, d) {
		id = ec_eoe_ids_find(ids, n, device);
		if (wanted(eoe, device) &&
		    (READ_ONCE(d->nd->flags) & IFF_UP ||
		     (id && has_same_name(id, &d->id))))
			continue;
		xa_erase(&eoe->table, device);
		list_add_tail(&d->old, &old);
	}
	ec_eoe_netdev_destroy(&old);
}

/* Which slaves are connected, and what they are called now. */
static void note_slaves(struct ec_eoe *eoe, const struct ec_eoe_id *ids, unsigned int n)
{
	const struct ec_eoe_id *id;
	struct ec_eoe_netdev *d;
	unsigned long device;

	xa_for_each(&eoe->table, device, d) {
		id = ec_eoe_ids_find(ids, n, device);
		WRITE_ONCE(d->connected, id);
		if (id)
			d->id = *id;
	}
}

static int create_one(struct ec_eoe *eoe, const struct ec_eoe_id *id)
{
	struct ec_eoe_netdev *d;
	unsigned int choice = 0;
	LIST_HEAD(old);
	int ret;

	/* an index may have 32 bits */
	if (id->device != (unsigned long)id->device)
		return -ENOSPC;
	do {
		d = ec_eoe_netdev_create(eoe, id, choice);
	} while (PTR_ERR_OR_ZERO(d) == -EEXIST && ++choice < EC_EOE_CHOICES);
	if (IS_ERR(d))
		return PTR_ERR(d);
	ret = xa_err(xa_store(&eoe->table, id->device, d, GFP_KERNEL));
	if (ret) {
		list_add(&d->old, &old);
		ec_eoe_netdev_destroy(&old);
	}
	return ret;
}

/* The addresses of the devices depend on it. Return: whether it is known. */
static bool note_main(struct ec_eoe *eoe, struct ec_bus *bus)
{
	const struct ecdev *dev;

	if (!is_zero_ether_addr(eoe->main))
		return true;
	rcu_read_lock();
	dev = READ_ONCE(ec_links_at(bus->links, 0)->dev);
	if (dev)
		ether_addr_copy(eoe->main, dev->mac);
	rcu_read_unlock();
	return !is_zero_ether_addr(eoe->main);
}

/* Return: whether all are devices now. */
static bool create_new(struct ec_eoe *eoe, struct ec_bus *bus, const struct ec_eoe_id *ids,
		       unsigned int n)
{
	bool all = note_main(eoe, bus);
	unsigned int i;
	int ret;

	for (i = 0; i < n && all && READ_ONCE(eoe->bus); i++) {
		if (!wanted(eoe, ids[i].device) || xa_load(&eoe->table, ids[i].device))
			continue;
		ret = create_one(eoe, &ids[i]);
		all = !ret;
		if (ret)
			ec_log_event(bus->base, ids[i].position, 0, KERN_WARNING,
				     "no network device for its EoE (%pe); retrying\n",
				     ERR_PTR(ret));
	}
	return all;
}

/* Compare the devices with the list of slaves. Return: whether they agree. */
static bool compare_devices(struct ec_eoe *eoe, struct ec_bus *bus)
{
	u32 lists = READ_ONCE(bus->lists);
	struct ec_eoe_id *ids;
	unsigned int n;
	bool all;

	if (lists == eoe->synced && !READ_ONCE(eoe->stale))
		return true;
	WRITE_ONCE(eoe->stale, false);
	ids = ec_eoe_ids_read(bus, lists, &n);
	if (ids) {
		adopt_lost(eoe, ids, n);
		remove_old(eoe, ids, n);
		all = create_new(eoe, bus, ids, n);
		note_slaves(eoe, ids, n);
		kvfree(ids);
		eoe->synced = lists;
		if (all)
			return true;
	}
	WRITE_ONCE(eoe->stale, true);
	return false;
}

/* The slave of a device number, with a reference; NULL: it is not connected. */
static struct ec_slave *get_slave(struct ec_bus *bus, u64 device)
{
	struct ec_slave *s;

	if (ec_show_begin(&bus->base->show))
		return NULL;
	s = ec_known_slave(bus, device);
	if (s)
		ec_slave_ref(s);
	ec_show_end(&bus->base->show);
	return s;
}

static void follow_slaves(struct work_struct *work)
{
	struct ec_eoe *eoe = container_of(to_delayed_work(work), struct ec_eoe, work);
	struct ec_bus *bus = READ_ONCE(eoe->bus);
	struct ec_eoe_netdev *d;
	unsigned long device;
	struct ec_slave *s;
	bool again;

	if (!bus)
		return;
	again = !compare_devices(eoe, bus);
	xa_for_each(&eoe->table, device, d) {
		if (!READ_ONCE(d->open))
			continue;
		again = true;
		ec_eoe_netdev_measure(d);
		s = get_slave(bus, device);
		ec_eoe_netdev_follow(d, s);
		if (s)
			ec_slave_unref(s);
	}
	if (again)
		queue_delayed_work(system_unbound_wq, &eoe->work, FOLLOW);
}

/**
 * ec_eoe_init() - prepare the network devices of a master
 * @eoe: zeroed structure
 *
 * Context: Any.
 */
void ec_eoe_init(struct ec_eoe *eoe)
{
	mutex_init(&eoe->lock);
	xa_init(&eoe->table);
	xa_init(&eoe->wishes);
	INIT_DELAYED_WORK(&eoe->work, follow_slaves);
	eoe->stale = true;
}

/**
 * ec_eoe_start() - slaves with EoE are network devices from now on
 * @eoe: after ec_eoe_init()
 * @bus: slaves
 * @parent: device of the master, until ec_eoe_stop(); or NULL
 * @automatic: all of them, unless ec_eoe_wish() says otherwise; false: none unless it does
 *
 * Context: Process.
 */
void ec_eoe_start(struct ec_eoe *eoe, struct ec_bus *bus, struct device *parent, bool automatic)
{
	eoe->parent = parent;
	eoe->automatic = automatic;
	/* all of it before the monitor sees that it has begun */
	smp_store_release(&eoe->bus, bus);
}

/**
 * ec_eoe_stop() - remove all network devices
 * @eoe: of a master
 *
 * While the monitor runs it may queue the work once more, without effect: the call is repeated when
 * the monitor has ended.
 *
 * Context: Process. Takes rtnl.
 */
void ec_eoe_stop(struct ec_eoe *eoe)
{
	struct ec_eoe_netdev *d;
	unsigned long device;
	LIST_HEAD(old);

	WRITE_ONCE(eoe->bus, NULL);
	cancel_delayed_work_sync(&eoe->work);
	xa_for_each(&eoe->table, device, d) {
		xa_erase(&eoe->table, device);
		list_add_tail(&d->old, &old);
	}
	ec_eoe_netdev_destroy(&old);
	/* a device that was closed just now has queued it */
	cancel_delayed_work_sync(&eoe->work);
	xa_destroy(&eoe->table);
	xa_destroy(&eoe->wishes);
}

/**
 * ec_eoe_kick() - a network device was set up or down, or another one is wished
 * @eoe: of a master
 *
 * Context: Any.
 */
void ec_eoe_kick(struct ec_eoe *eoe)
{
	WRITE_ONCE(eoe->stale, true);
	mod_delayed_work(system_unbound_wq, &eoe->work, 0);
}

/**
 * ec_eoe_look() - the list of slaves may have changed
 * @eoe: of a master
 *
 * Context: The monitor.
 */
void ec_eoe_look(struct ec_eoe *eoe)
{
	/* pairs with ec_eoe_start() */
	const struct ec_bus *bus = smp_load_acquire(&eoe->bus);

	if (bus && !ec_bus_scan_busy(bus) &&
	    (READ_ONCE(eoe->synced) != READ_ONCE(bus->lists) || READ_ONCE(eoe->stale)))
		mod_delayed_work(system_unbound_wq, &eoe->work, 0);
}

/**
 * ec_eoe_wish() - does a slave have a network device?
 * @eoe: of a master
 * @device: device number of the slave
 * @wish: EC_EOE_WISH_ON; EC_EOE_WISH_OFF: also if it is up; EC_EOE_WISH_AUTO: as all others
 *
 * Context: Process. May sleep.
 * Return: 0; -ENODEV: not at present; -ENOSPC; -ENOMEM.
 */
int ec_eoe_wish(struct ec_eoe *eoe, u64 device, unsigned int wish)
{
	int ret;

	if (!smp_load_acquire(&eoe->bus))	/* pairs with ec_eoe_start() */
		return -ENODEV;
	if (device != (unsigned long)device)
		return -ENOSPC;
	mutex_lock(&eoe->lock);
	ret = xa_err(xa_store(&eoe->wishes, device,
			      wish == EC_EOE_WISH_AUTO ? NULL : xa_mk_value(wish), GFP_KERNEL));
	mutex_unlock(&eoe->lock);
	if (!ret)
		ec_eoe_kick(eoe);
	return ret;
}

/**
 * ec_eoe_show() - a network device and its statistics
 * @eoe: of a master
 * @info: @index is that of the device, in the order of device numbers; result
 *
 * Context: Process. It takes no lock: any user may call it.
 * Return: 0; -ENOENT: there are fewer.
 */
int ec_eoe_show(struct ec_eoe *eoe, struct ec_ioc_eoe *info)
{
	struct ec_eoe_netdev *d;
	unsigned long device;
	u32 i = 0;

	/* a device is freed a grace period after it has left the table */
	rcu_read_lock();
	xa_for_each(&eoe->table, device, d)
		if (i++ == info->index)
			break;
	if (d)
		ec_eoe_netdev_show(d, info);
	rcu_read_unlock();
	return d ? 0 : -ENOENT;
}
