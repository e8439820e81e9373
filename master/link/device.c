// SPDX-License-Identifier: GPL-2.0-only
#include <linux/etherdevice.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/notifier.h>
#include <linux/rcupdate.h>
#include <linux/rtnetlink.h>
#include <linux/slab.h>
#include "../base/report.h"
#include "capture.h"
#include "device.h"
#include "links.h"
#include "spec.h"

/*
 * Protects the lists and the master of each device; taken before any lock of a master.
 * Taken with RTNL held when the device is a netdev, so code that holds it must not take RTNL.
 */
static DEFINE_MUTEX(devices_lock);
static LIST_HEAD(devices);
static LIST_HEAD(masters);	/* &struct ec_links, in the order of their numbers */
static BLOCKING_NOTIFIER_HEAD(changes);

/* The device that a link waits for or has. */
static const char *name_of(const struct ec_links *l, unsigned int side)
{
	lockdep_assert_held(&devices_lock);
	if (ec_links_named(l, side))
		return l->backup;
	return l->closed ? NULL : l->main;
}

/**
 * ecdev_wanted() - is a master configured for this device?
 * @name: device name
 * @mac: its address
 * @any: a master configured for the broadcast address, which means any device, counts as well
 *
 * Context: Process. May sleep.
 * Return: true when one is.
 */
bool ecdev_wanted(const char *name, const u8 *mac, bool any)
{
	const struct ec_links *l;
	bool wanted = false;
	unsigned int side;

	mutex_lock(&devices_lock);
	list_for_each_entry(l, &masters, list) {
		if (ec_capture_is(l->capture, name)) {
			wanted = false;
			break;
		}
		for (side = 0; side < EC_MAX_LINKS; side++) {
			const char *spec = name_of(l, side);

			wanted |= (any || !spec || !ec_spec_is_any(spec)) &&
				  ec_spec_matches(spec, name, mac);
		}
	}
	mutex_unlock(&devices_lock);
	return wanted;
}
EXPORT_SYMBOL_GPL(ecdev_wanted);

/**
 * ecdev_waiting() - find a master that waits for a device
 * @index: where to start, initially 0; result: where to continue
 * @master: result: number of the master
 * @name: result: name or MAC address of the device
 * @size: of @name
 * @backup: result: it is its backup device
 *
 * Context: Process. May sleep.
 * Return: whether one waits.
 */
bool ecdev_waiting(unsigned int *index, unsigned int *master, char *name, size_t size,
		   bool *backup)
{
	const struct ec_links *l;
	unsigned int side, at;
	bool found = false;

	mutex_lock(&devices_lock);
	list_for_each_entry(l, &masters, list)
		for (side = 0; side < EC_MAX_LINKS && !found; side++) {
			at = l->base->index * EC_MAX_LINKS + side;
			if (at < *index || l->link[side].dev || !name_of(l, side))
				continue;
			strscpy(name, name_of(l, side), size);
			*master = l->base->index;
			*backup = ec_links_named(l, side) == EC_BACKUP;
			*index = at + 1;
			found = true;
		}
	mutex_unlock(&devices_lock);
	return found;
}
EXPORT_SYMBOL_GPL(ecdev_waiting);

static void report(struct ec_link *link, bool attached)
{
	struct ec_links *l = link->links;

	if (l->ops && l->ops->device)
		l->ops->device(l, link, attached);
}

/* Does no other thread deliver frames while the cycle owner polls the devices? */
static void note_threads(struct ec_links *l)
{
	const struct ec_link *link;
	bool one = true;

	ec_links_for_each(l, link)
		one &= !link->dev || link->dev->ops->keeps;
	WRITE_ONCE(l->slots.one_thread, one);
}

/* The device changes between two calls of the cycle owner: each of them uses one device. */
static void device_publish(struct ecdev *dev, struct ec_link *link)
{
	struct ec_links *l = link->links;
	bool cyclic;

	lockdep_assert_held(&devices_lock);
	rt_mutex_lock(&l->access.lock);
	cyclic = ec_access_is_cyclic(&l->access);
	if (cyclic && dev->ops->cycle)
		dev->ops->cycle(dev->priv, true);
	ec_access_shut(l);
	WRITE_ONCE(link->dev, dev);
	note_threads(l);
	if (l->ops && l->ops->changed)
		l->ops->changed(l);
	ec_access_reopen(l);
	rt_mutex_unlock(&l->access.lock);
}

/* Called before the device delivers frames, and between two calls of the cycle owner. */
static void clear_counters(struct ec_link *link)
{
	struct ec_links *l = link->links;

	rt_mutex_lock(&l->access.lock);
	ec_access_shut(l);
	ec_link_clear_counters(link);
	ec_access_reopen(l);
	rt_mutex_unlock(&l->access.lock);
}

static void attach(struct ecdev *dev, struct ec_link *link)
{
	char text[64];
	const struct ec_event_more more = { .detail = text };
	struct ec_links *l = link->links;
	int ret;

	lockdep_assert_held(&devices_lock);
	clear_counters(link);
	rcu_assign_pointer(dev->link, link);
	ret = dev->ops->start(dev->priv, dev);
	if (ret) {
		ec_warn(l, "cannot start device %s (%pe)\n", dev->name, ERR_PTR(ret));
		rcu_assign_pointer(dev->link, NULL);
		synchronize_rcu();
		return;
	}
	device_publish(dev, link);
	scnprintf(text, sizeof(text), "%s (%s, %pM)", dev->name, dev->ops->kind, dev->mac);
	ec_report_more(l->base, EC_EVENT_DEVICE_ON, EC_EVENT_NO_SLAVE, &more, link->side);
	report(link, true);
}

/*
 * Removes the device from the link between two calls of the cycle owner. The access stays cyclic
 * while another link has a device.
 */
static void withdraw(struct ec_link *link, struct ecdev *dev)
{
	const struct ec_event_more more = { .detail = dev->name };
	struct ec_links *l = link->links;

	lockdep_assert_held(&devices_lock);
	rt_mutex_lock(&l->access.lock);
	ec_access_shut(l);
	WRITE_ONCE(link->dev, NULL);
	WRITE_ONCE(link->up, false);
	note_threads(l);
	ec_slots_forget_sent(&l->slots);
	/* the way of all frames of a ring changes */
	WRITE_ONCE(l->ring.news, !l->only);
	if (l->ops && l->ops->changed)
		l->ops->changed(l);
	ec_access_reopen(l);
	rt_mutex_unlock(&l->access.lock);
	if (!ec_links_attached(l))
		ec_access_change(l, EC_ACCESS_DIRECT);
	if (dev->ops->cycle)
		dev->ops->cycle(dev->priv, false);
	report(link, false);
	ec_report_more(l->base, EC_EVENT_DEVICE_OFF, EC_EVENT_NO_SLAVE, &more, link->side);
}

static void detach(struct ecdev *dev)
{
	struct ec_link *link = rcu_dereference_protected(dev->link,
							 lockdep_is_held(&devices_lock));

	lockdep_assert_held(&devices_lock);
	if (!link)
		return;
	withdraw(link, dev);
	dev->ops->stop(dev->priv);
	rcu_assign_pointer(dev->link, NULL);
	synchronize_rcu();
}

static bool waits_for(const struct ec_links *l, unsigned int side, const struct ecdev *dev,
		      bool any)
{
	const char *spec = name_of(l, side);

	lockdep_assert_held(&devices_lock);
	if (l->held && !ec_links_named(l, side))
		return false;
	return spec && ec_spec_is_any(spec) == any && !l->link[side].dev &&
	       !READ_ONCE(l->base->stopping) && ec_spec_matches(spec, dev->name, dev->mac);
}

/* Does a master get this device in a moment, and no other one? */
static bool is_held(const struct ecdev *dev)
{
	const struct ec_links *l;

	lockdep_assert_held(&devices_lock);
	list_for_each_entry(l, &masters, list)
		if (l->held && ec_spec_matches(l->main, dev->name, dev->mac))
			return true;
	return false;
}

/* Give @dev to the first master that waits for it. */
static void match_locked(struct ecdev *dev)
{
	struct ec_links *l;
	unsigned int side;
	int any;

	lockdep_assert_held(&devices_lock);
	if (is_held(dev))
		return;
	/* a master that names the device comes before one that takes any device */
	for (any = 0; any < 2; any++)
		list_for_each_entry(l, &masters, list)
			for (side = 0; side < EC_MAX_LINKS; side++)
				if (waits_for(l, side, dev, any)) {
					attach(dev, &l->link[side]);
					return;
				}
}

/**
 * ec_device_register() - let a master get devices that are offered from now on
 * @l: its links
 *
 * Context: Process. May sleep.
 */
void ec_device_register(struct ec_links *l)
{
	mutex_lock(&devices_lock);
	list_add_tail(&l->list, &masters);
	mutex_unlock(&devices_lock);
}

/**
 * ec_device_unregister() - take all devices from a master
 * @l: its links; it gets no more
 *
 * Context: Process. May sleep.
 */
void ec_device_unregister(struct ec_links *l)
{
	unsigned int i;

	mutex_lock(&devices_lock);
	for (i = 0; i < EC_MAX_LINKS; i++)
		if (l->link[i].dev)
			detach(l->link[i].dev);
	list_del_init(&l->list);
	mutex_unlock(&devices_lock);
}

/* Give the devices that are left to the masters that wait for them. */
static void match_all(void)
{
	struct ecdev *dev;

	lockdep_assert_held(&devices_lock);
	list_for_each_entry(dev, &devices, list)
		if (!rcu_access_pointer(dev->link))
			match_locked(dev);
}

static void set_main(struct ec_links *l, const char *name)
{
	lockdep_assert_held(&devices_lock);
	raw_spin_lock(&l->main_lock);
	strscpy(l->main, name, sizeof(l->main));
	raw_spin_unlock(&l->main_lock);
}

/* The master that has this device or waits for it, but for @l as its device @as. */
static const struct ec_links *rival_of(const struct ec_links *l, unsigned int as,
				       const char *name)
{
	const struct ec_links *o;
	unsigned int side;

	lockdep_assert_held(&devices_lock);
	list_for_each_entry(o, &masters, list)
		for (side = 0; side < EC_MAX_LINKS; side++) {
			const char *spec = side ? o->backup : o->main;
			const struct ecdev *dev = o->link[ec_links_named(o, side)].dev;

			if (o == l && side == as)
				continue;
			if (spec && ec_spec_same(name, spec))
				return o;
			if (dev && !ec_spec_is_any(name) &&
			    ec_spec_matches(name, dev->name, dev->mac))
				return o;
		}
	return NULL;
}

static struct ecdev *device_at(const struct ec_links *l, unsigned int as)
{
	lockdep_assert_held(&devices_lock);
	return l->link[ec_links_named(l, as)].dev;
}

static void release_main(struct ec_links *l)
{
	struct ecdev *dev = device_at(l, EC_MAIN);

	lockdep_assert_held(&devices_lock);
	l->closed = true;
	if (!dev)
		return;
	detach(dev);
	match_locked(dev);
}

/* No frame is in flight when a line becomes a ring: the main device is released for a while. */
static void release_backup(struct ec_links *l)
{
	struct ecdev *main = device_at(l, EC_MAIN), *dev = device_at(l, EC_BACKUP);

	lockdep_assert_held(&devices_lock);
	l->held = true;
	raw_spin_lock(&l->main_lock);
	WRITE_ONCE(l->backup, NULL);
	raw_spin_unlock(&l->main_lock);
	if (main)
		detach(main);
	if (!dev)
		return;
	detach(dev);
	match_locked(dev);
}

/* Return: whether the master has the device @name, or is to have none and has none. */
static bool has_already(struct ec_links *l, unsigned int as, const char *name)
{
	const struct ecdev *dev = device_at(l, as);

	lockdep_assert_held(&devices_lock);
	if (!*name)
		return !l->backup;
	if (!dev || !ec_spec_matches(name, dev->name, dev->mac))
		return false;
	if (as == EC_MAIN)
		set_main(l, name);
	return true;
}

static int let_go(struct ec_links *l, unsigned int as, const char *name, unsigned int *rival)
{
	const struct ec_links *other = rival_of(l, as, name);

	lockdep_assert_held(&devices_lock);
	if (other) {
		*rival = other->base->index;
		return -EBUSY;
	}
	/* each end of a ring has the device of its name */
	if (ec_spec_is_any(name) ? as || l->backup : as && *name && ec_spec_is_any(l->main))
		return -EINVAL;
	if (has_already(l, as, name))
		return -EEXIST;
	if (as == EC_BACKUP && *name && ec_slots_reserve(&l->slots))
		return -ENOMEM;
	if (as == EC_MAIN)
		release_main(l);
	else
		release_backup(l);
	return 0;
}

/**
 * ec_device_release() - a master releases a device, in order to get another one
 * @l: its links; they get no such device until ec_device_use()
 * @as: EC_MAIN or EC_BACKUP; with the latter they have no main device until ec_device_reopen()
 * @name: of the device that it is to get; for the backup device "": none
 * @rival: result with -EBUSY: number of the other master
 *
 * A master that has the device @name keeps it.
 *
 * Context: Process. May sleep, takes RTNL.
 * Return: 0; -EEXIST when it keeps its device, which is @name now; -EBUSY when another master has
 * the device @name or waits for it, or it is the other one of this master; -EINVAL: a device of a
 * ring would be any one; -ENOMEM.
 */
int ec_device_release(struct ec_links *l, unsigned int as, const char *name, unsigned int *rival)
{
	int ret;

	rtnl_lock();
	mutex_lock(&devices_lock);
	ret = let_go(l, as, name, rival);
	mutex_unlock(&devices_lock);
	rtnl_unlock();
	if (!ret)
		blocking_notifier_call_chain(&changes, 0, NULL);
	return ret;
}

/* A device that has come at this moment leaves again. */
static void use_backup(struct ec_links *l, const char *name)
{
	unsigned int i;

	lockdep_assert_held(&devices_lock);
	for (i = 0; i < EC_MAX_LINKS; i++)
		if (l->link[i].dev)
			detach(l->link[i].dev);
	ec_links_set_backup(l, name);
}

/**
 * ec_device_use() - a master gets a device after ec_device_release()
 * @l: its links
 * @as: EC_MAIN, or EC_BACKUP: then no slave is known, or @name is that of before
 * @name: MAC address, PCI address or name of the device; for the backup device "": none
 *
 * Context: Process. May sleep, takes RTNL.
 * Return: 0, or -ENODEV: it waits for the device.
 */
int ec_device_use(struct ec_links *l, unsigned int as, const char *name)
{
	rtnl_lock();
	mutex_lock(&devices_lock);
	if (as == EC_BACKUP) {
		use_backup(l, name);
	} else {
		set_main(l, name);
		l->closed = false;
	}
	match_all();
	mutex_unlock(&devices_lock);
	rtnl_unlock();
	/* drivers offer only devices that a master wants */
	blocking_notifier_call_chain(&changes, 0, NULL);
	return !*name || READ_ONCE(l->link[ec_links_named(l, as)].dev) ? 0 : -ENODEV;
}

/**
 * ec_device_reopen() - a master has its main device again after it got another backup device
 * @l: its links
 *
 * Context: Process. May sleep, takes RTNL.
 */
void ec_device_reopen(struct ec_links *l)
{
	rtnl_lock();
	mutex_lock(&devices_lock);
	l->held = false;
	match_all();
	mutex_unlock(&devices_lock);
	rtnl_unlock();
	/* a driver may have withdrawn the device meanwhile, since no master had it */
	blocking_notifier_call_chain(&changes, 0, NULL);
}

/* What a link knows of its device, or by it. Frames in flight stay with the link. */
static void exchange_devices(struct ec_link *a, struct ec_link *b)
{
	atomic64_t *x = (atomic64_t *)&a->stats, *y = (atomic64_t *)&b->stats;
	struct ecdev *dev = a->dev;
	bool up = a->up;
	unsigned int i;

	lockdep_assert_held(&devices_lock);
	WRITE_ONCE(a->dev, b->dev);
	WRITE_ONCE(b->dev, dev);
	if (a->dev)
		rcu_assign_pointer(a->dev->link, a);
	if (b->dev)
		rcu_assign_pointer(b->dev->link, b);
	WRITE_ONCE(a->up, b->up);
	WRITE_ONCE(b->up, up);
	ec_link_hears(a);
	ec_link_hears(b);
	for (i = 0; i < sizeof(a->stats) / sizeof(*x); i++)
		atomic64_set(&y[i], atomic64_xchg(&x[i], atomic64_read(&y[i])));
	swap(a->rates, b->rates);
}

/**
 * ec_device_exchange() - the links of a ring exchange their devices
 * @l: links of a master with a backup device
 *
 * Frames in flight may count as received by the other end once. Counters stay with the device.
 *
 * Context: The monitor. May sleep.
 * Return: false: a device comes or goes just now, which may wait for the monitor: try again.
 */
bool ec_device_exchange(struct ec_links *l)
{
	if (!mutex_trylock(&devices_lock))
		return false;
	rt_mutex_lock(&l->access.lock);
	ec_access_shut(l);
	raw_spin_lock(&l->main_lock);
	WRITE_ONCE(l->exchanged, !l->exchanged);
	raw_spin_unlock(&l->main_lock);
	exchange_devices(&l->link[EC_MAIN], &l->link[EC_BACKUP]);
	if (l->ops && l->ops->changed)
		l->ops->changed(l);
	ec_access_reopen(l);
	rt_mutex_unlock(&l->access.lock);
	mutex_unlock(&devices_lock);
	return true;
}

/**
 * ecdev_register_notifier() - register for changes of the devices that masters want
 * @nb: called without locks, may sleep; see ecdev_wanted()
 *
 * Context: Process. May sleep.
 * Return: 0 or -EEXIST.
 */
int ecdev_register_notifier(struct notifier_block *nb)
{
	return blocking_notifier_chain_register(&changes, nb);
}
EXPORT_SYMBOL_GPL(ecdev_register_notifier);

/**
 * ecdev_unregister_notifier() - remove a notifier; it does not run after the return
 * @nb: as registered
 *
 * Context: Process. May sleep. Without locks that the function takes.
 */
void ecdev_unregister_notifier(struct notifier_block *nb)
{
	blocking_notifier_chain_unregister(&changes, nb);
}
EXPORT_SYMBOL_GPL(ecdev_unregister_notifier);

/**
 * ecdev_offer() - offer a device to the masters
 * @name: how users call it
 * @mac: its address
 * @ops: functions, must stay valid until ecdev_withdraw()
 * @priv: passed to @ops
 *
 * A master configured for it takes it at once.
 *
 * Context: Process. May sleep.
 * Return: handle, or ERR_PTR(-ENOMEM).
 */
struct ecdev *ecdev_offer(const char *name, const u8 *mac,
			  const struct ecdev_ops *ops, void *priv)
{
	struct ecdev *dev = kzalloc(sizeof(*dev), GFP_KERNEL);

	if (!dev)
		return ERR_PTR(-ENOMEM);
	strscpy(dev->name, name, sizeof(dev->name));
	ether_addr_copy(dev->mac, mac);
	dev->ops = ops;
	dev->priv = priv;
	mutex_lock(&devices_lock);
	list_add_tail(&dev->list, &devices);
	match_locked(dev);
	mutex_unlock(&devices_lock);
	return dev;
}
EXPORT_SYMBOL_GPL(ecdev_offer);

/**
 * ecdev_withdraw() - end the offer of a device; its master loses it
 * @dev: handle, invalid afterwards
 *
 * Context: Process. May sleep.
 */
void ecdev_withdraw(struct ecdev *dev)
{
	mutex_lock(&devices_lock);
	detach(dev);
	list_del(&dev->list);
	mutex_unlock(&devices_lock);
	kfree(dev);
}
EXPORT_SYMBOL_GPL(ecdev_withdraw);

/**
 * ecdev_rename() - users call a device by another name now
 * @dev: device
 * @name: this name
 *
 * Its master keeps it, even if main_devices= has the previous name.
 *
 * Context: Process. May sleep.
 */
void ecdev_rename(struct ecdev *dev, const char *name)
{
	struct ec_link *link;

	mutex_lock(&devices_lock);
	link = rcu_dereference_protected(dev->link, lockdep_is_held(&devices_lock));
	if (link) {
		raw_spin_lock(&link->links->main_lock);
		strscpy(dev->name, name, sizeof(dev->name));
		raw_spin_unlock(&link->links->main_lock);
	} else {
		strscpy(dev->name, name, sizeof(dev->name));
	}
	mutex_unlock(&devices_lock);
}
EXPORT_SYMBOL_GPL(ecdev_rename);

/**
 * ecdev_numbered() - does each frame have a source address of its own?
 * @dev: device that a master has, or that starts for it
 *
 * Context: Process.
 * Return: false with frame_numbers=N, and without a master.
 */
bool ecdev_numbered(struct ecdev *dev)
{
	struct ec_link *link;
	bool numbered;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	numbered = link && link->links->slots.numbered;
	rcu_read_unlock();
	return numbered;
}
EXPORT_SYMBOL_GPL(ecdev_numbered);
