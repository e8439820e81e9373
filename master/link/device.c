// SPDX-License-Identifier: GPL-2.0-only
#include <linux/etherdevice.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/rcupdate.h>
#include <linux/slab.h>
#include "capture.h"
#include "device.h"
#include "../master.h"

/*
 * Devices and who uses them; taken before any lock of a master.
 * Taken with RTNL held when the device is a netdev, so nothing below may take
 * RTNL.
 */
static DEFINE_MUTEX(devices_lock);
static LIST_HEAD(devices);

/* Does @spec (from the module parameters) mean this device? */
static bool spec_matches(const char *spec, const char *name, const u8 *mac)
{
	u8 want[ETH_ALEN];

	if (!spec || !*spec)
		return false;
	if (mac_pton(spec, want))
		return is_broadcast_ether_addr(want) || ether_addr_equal(want, mac);
	return !strcmp(spec, name);
}

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
	unsigned int i, side;

	for (i = 0; i < ec_master_count(); i++)
		if (ec_capture_is(ec_master_get(i)->capture, name))
			return false;
	for (i = 0; i < ec_master_count(); i++)
		for (side = 0; side < EC_MAX_LINKS; side++)
			if (spec_matches(ec_master_get(i)->spec[side], name, mac))
				return true;
	return false;
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
	const char *spec = NULL;

	mutex_lock(&devices_lock);
	for (; *index < ec_master_count() && !spec; (*index)++) {
		struct ec_master *m = ec_master_get(*index);

		if (m->link[0].dev)
			continue;
		spec = m->spec[0];
		*master = *index;
	}
	mutex_unlock(&devices_lock);
	return spec;
}
EXPORT_SYMBOL_GPL(ecdev_waiting);

static void attach(struct ecdev *dev, struct ec_link *link)
{
	int ret;

	rcu_assign_pointer(dev->link, link);
	ret = dev->ops->start(dev->priv, dev);
	if (ret) {
		ec_warn(link->master, "cannot start device %s (%pe)\n", dev->name, ERR_PTR(ret));
		rcu_assign_pointer(dev->link, NULL);
		synchronize_rcu();
		return;
	}
	memset(&link->stats, 0, sizeof(link->stats));
	memset(&link->rates, 0, sizeof(link->rates));
	ec_master_link_attach(link, dev);
}

static void detach(struct ecdev *dev)
{
	struct ec_link *link = rcu_dereference_protected(dev->link,
							 lockdep_is_held(&devices_lock));

	if (!link)
		return;
	ec_master_link_detach(link);
	dev->ops->stop(dev->priv);
	rcu_assign_pointer(dev->link, NULL);
	synchronize_rcu();
}

/* Give @dev to the first master that waits for it. */
static void match_locked(struct ecdev *dev)
{
	unsigned int i, side;

	lockdep_assert_held(&devices_lock);
	for (i = 0; i < ec_master_count(); i++) {
		struct ec_master *m = ec_master_get(i);

		for (side = 0; side < EC_MAX_LINKS; side++)
			if (!m->link[side].dev && !m->base->stopping &&
			    spec_matches(m->spec[side], dev->name, dev->mac)) {
				attach(dev, &m->link[side]);
				return;
			}
	}
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
		ec_master_frame(link, src, data, len);
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
