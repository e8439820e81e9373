// SPDX-License-Identifier: GPL-2.0-only
#include <linux/etherdevice.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/rcupdate.h>
#include <linux/slab.h>
#include "capture.h"
#include "device.h"
#include "links.h"
#include "receive.h"
#include "spec.h"

/*
 * Devices and who uses them; taken before any lock of a master.
 * Taken with RTNL held when the device is a netdev, so nothing below may take
 * RTNL.
 */
static DEFINE_MUTEX(devices_lock);
static LIST_HEAD(devices);
static LIST_HEAD(masters);	/* &struct ec_links, in the order of their numbers */

/**
 * ecdev_wanted() - is there a master configured for this device?
 * @name: device name
 * @mac: its address
 *
 * Context: Process. May sleep.
 * Return: true when main_devices= or backup_devices= name it.
 */
bool ecdev_wanted(const char *name, const u8 *mac)
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
		for (side = 0; side < EC_MAX_LINKS; side++)
			wanted |= ec_spec_matches(l->spec[side], name, mac);
	}
	mutex_unlock(&devices_lock);
	return wanted;
}
EXPORT_SYMBOL_GPL(ecdev_wanted);

/**
 * ecdev_waiting() - what masters still wait for
 * @index: start, 0 at first; set behind the one that is returned
 * @master: result: number of the master
 *
 * Context: Process. May sleep.
 * Return: a name or MAC address of main_devices=, or NULL.
 */
const char *ecdev_waiting(unsigned int *index, unsigned int *master)
{
	const struct ec_links *l;
	const char *spec = NULL;

	mutex_lock(&devices_lock);
	list_for_each_entry(l, &masters, list) {
		if (l->base->index < *index || l->link[0].dev)
			continue;
		spec = l->spec[0];
		*master = l->base->index;
		*index = l->base->index + 1;
		break;
	}
	mutex_unlock(&devices_lock);
	return spec;
}
EXPORT_SYMBOL_GPL(ecdev_waiting);

static const char *side_name(const struct ec_link *link)
{
	return link->side ? "backup" : "main";
}

static void report(struct ec_link *link, bool attached)
{
	struct ec_links *l = link->links;

	if (l->ops && l->ops->device)
		l->ops->device(l, link, attached);
}

static void attach(struct ecdev *dev, struct ec_link *link)
{
	struct ec_links *l = link->links;
	int ret;

	lockdep_assert_held(&devices_lock);
	rcu_assign_pointer(dev->link, link);
	ret = dev->ops->start(dev->priv, dev);
	if (ret) {
		ec_warn(l, "cannot start device %s (%pe)\n", dev->name, ERR_PTR(ret));
		rcu_assign_pointer(dev->link, NULL);
		synchronize_rcu();
		return;
	}
	memset(&link->stats, 0, sizeof(link->stats));
	memset(&link->rates, 0, sizeof(link->rates));
	rt_mutex_lock(&l->access.lock);
	WRITE_ONCE(link->dev, dev);
	ec_link_set_places(link, ec_access_is_cyclic(&l->access));
	rt_mutex_unlock(&l->access.lock);
	ec_info(l, "%s device %s attached (%s, %pM)\n", side_name(link), dev->name,
		dev->ops->kind, dev->mac);
	report(link, true);
}

/* First no caller finds the device any more, then callers that have found it leave. */
static void withdraw(struct ec_link *link, struct ecdev *dev)
{
	struct ec_links *l = link->links;

	lockdep_assert_held(&devices_lock);
	rt_mutex_lock(&l->access.lock);
	WRITE_ONCE(link->dev, NULL);
	WRITE_ONCE(link->up, false);
	rt_mutex_unlock(&l->access.lock);
	ec_access_change(l, EC_ACCESS_DIRECT);
	if (dev->ops->cycle)
		dev->ops->cycle(dev->priv, false);
	report(link, false);
	ec_info(l, "%s device %s detached\n", side_name(link), dev->name);
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

/* Give @dev to the first master that waits for it. */
static void match_locked(struct ecdev *dev)
{
	struct ec_links *l;
	unsigned int side;

	lockdep_assert_held(&devices_lock);
	list_for_each_entry(l, &masters, list)
		for (side = 0; side < EC_MAX_LINKS; side++)
			if (!l->link[side].dev && !READ_ONCE(l->base->stopping) &&
			    ec_spec_matches(l->spec[side], dev->name, dev->mac)) {
				attach(dev, &l->link[side]);
				return;
			}
}

/**
 * ec_device_register() - let a master have devices that are offered from now on
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

/**
 * ec_device_detach() - a master gives its device back
 * @link: link, may be without device
 *
 * Context: Process. May sleep.
 */
void ec_device_detach(struct ec_link *link)
{
	mutex_lock(&devices_lock);
	if (link->dev)
		detach(link->dev);
	mutex_unlock(&devices_lock);
}

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
 * ecdev_withdraw() - the device goes away
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
 * ecdev_receive() - deliver a received EtherCAT frame
 * @dev: device
 * @src: source MAC address
 * @data: what follows the EtherType; not changed
 * @len: bytes there
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ecdev_receive(struct ecdev *dev, const u8 *src, const u8 *data, size_t len)
{
	struct ec_link *link;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	if (link)
		ec_receive(link, src, data, len);
	rcu_read_unlock();
}
EXPORT_SYMBOL_GPL(ecdev_receive);

/**
 * ecdev_foreign() - count a received frame that is not EtherCAT
 * @dev: device
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ecdev_foreign(struct ecdev *dev)
{
	struct ec_link *link;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	if (link)
		atomic64_inc(&link->stats.foreign);
	rcu_read_unlock();
}
EXPORT_SYMBOL_GPL(ecdev_foreign);

/**
 * ecdev_not_captured() - count a frame that capture programs did not see
 * @dev: device
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ecdev_not_captured(struct ecdev *dev)
{
	struct ec_link *link;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	if (link)
		atomic64_inc(&link->stats.not_captured);
	rcu_read_unlock();
}
EXPORT_SYMBOL_GPL(ecdev_not_captured);
