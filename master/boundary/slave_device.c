// SPDX-License-Identifier: GPL-2.0-only
/*
 * The kernel may keep a device for a moment after its removal, so its memory is apart from that of
 * the slave, and the module is removed only when all of them are freed.
 */
#include <linux/module.h>
#include <linux/rcupdate.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include <linux/wait_bit.h>
#include "../bus/graph.h"
#include "../bus/known.h"
#include "../bus/slave.h"
#include "../kernel/compat.h"
#include "slave_device.h"

static struct kmem_cache *cache;	/* kmalloc() would round up to 1 KiB */
static atomic_t n_devices;	/* whose memory is not freed */
static bool released_elsewhere;	/* some were freed by another thread than that which removed them */

static struct ec_slave_device *to_slave_device(EC_UEVENT_DEVICE *dev)
{
	return container_of((struct device *)dev, struct ec_slave_device, dev);
}

/* attributes ----------------------------------------------------------------*/

#define IDENTITY(name)									\
static ssize_t name##_show(struct device *dev, struct device_attribute *attr, char *buf)	\
{											\
	return sysfs_emit(buf, "0x%08x\n", to_slave_device(dev)->at.id.name);		\
}											\
static DEVICE_ATTR_RO(name)

IDENTITY(vendor);
IDENTITY(product);
IDENTITY(revision);
IDENTITY(serial);

static ssize_t device_number_show(struct device *dev, struct device_attribute *attr, char *buf)
{
	return sysfs_emit(buf, "%llu\n", to_slave_device(dev)->at.number);
}
static DEVICE_ATTR_RO(device_number);

/* what may change while the slave is connected */
struct present {
	u16 position;
	u16 alias;
	u16 al_status;
};

/* Return: 0; -ENODEV while the list does not have the slave; -ERESTARTSYS. */
static int read_present(struct device *dev, struct present *p)
{
	const struct ec_slave_device *d = to_slave_device(dev);
	struct ec_show *show = &d->bus->base->show;
	const struct ec_slave *s;
	int ret = ec_show_begin(show);

	if (ret)
		return ret;
	s = ec_known_slave(d->bus, d->at.number);
	if (s)
		*p = (struct present){
			.position = s->position, .alias = s->alias,
			.al_status = READ_ONCE(s->al.status),
		};
	ec_show_end(show);
	return s ? 0 : -ENODEV;
}

static ssize_t position_show(struct device *dev, struct device_attribute *attr, char *buf)
{
	struct present p;
	int ret = read_present(dev, &p);

	return ret ?: sysfs_emit(buf, "%u\n", p.position);
}
static DEVICE_ATTR_RO(position);

static ssize_t alias_show(struct device *dev, struct device_attribute *attr, char *buf)
{
	struct present p;
	int ret = read_present(dev, &p);

	return ret ?: sysfs_emit(buf, "%u\n", p.alias);
}
static DEVICE_ATTR_RO(alias);

static ssize_t al_state_show(struct device *dev, struct device_attribute *attr, char *buf)
{
	struct present p;
	int ret = read_present(dev, &p);

	return ret ?: sysfs_emit(buf, "%s%s\n", ec_al_state_name(p.al_status),
				 p.al_status & EC_AL_ERROR ? " error" : "");
}
static DEVICE_ATTR_RO(al_state);

static struct attribute *slave_attrs[] = {
	&dev_attr_vendor.attr,
	&dev_attr_product.attr,
	&dev_attr_revision.attr,
	&dev_attr_serial.attr,
	&dev_attr_device_number.attr,
	&dev_attr_position.attr,
	&dev_attr_alias.attr,
	&dev_attr_al_state.attr,
	NULL,
};
ATTRIBUTE_GROUPS(slave);

/* bus type ------------------------------------------------------------------*/

static int slave_uevent(EC_UEVENT_DEVICE *dev, struct kobj_uevent_env *env)
{
	const struct ec_slave_id *id = &to_slave_device(dev)->at.id;

	return add_uevent_var(env, "MODALIAS=ethercat:v%08Xp%08X", id->vendor, id->product);
}

static struct bus_type slave_bus = {
	.name = "ethercat",
	.dev_groups = slave_groups,
	.uevent = slave_uevent,
};

/**
 * ec_slave_device_register() - make the bus type
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno.
 */
int ec_slave_device_register(void)
{
	int ret;

	cache = KMEM_CACHE(ec_slave_device, 0);
	if (!cache)
		return -ENOMEM;
	ret = bus_register(&slave_bus);
	if (ret)
		kmem_cache_destroy(cache);
	return ret;
}

/**
 * ec_slave_device_unregister() - wait until no thread uses a device, and remove the bus type
 *
 * Context: Process, at the end of the module; all devices are removed. May sleep.
 */
void ec_slave_device_unregister(void)
{
	wait_var_event(&n_devices, !atomic_read(&n_devices));
	/* another thread may be at the end of slave_device_release() still */
	if (READ_ONCE(released_elsewhere))
		synchronize_rcu_tasks();
	bus_unregister(&slave_bus);
	kmem_cache_destroy(cache);
}

/* devices -------------------------------------------------------------------*/

/**
 * ec_slave_device_locate() - where a slave is, and which one
 * @s: slave of the list
 * @at: result
 *
 * Context: Topo held, or after ec_show_begin().
 */
void ec_slave_device_locate(const struct ec_slave *s, struct ec_slave_at *at)
{
	const struct ec_slave *up = ec_graph_parent(s);

	ec_bus_assert_stays(s->bus);
	at->number = s->device;
	at->up = up ? up->device : 0;
	at->port = up ? s->graph.parent_port : 0;
	at->id = (struct ec_slave_id){
		.vendor = s->info.vendor, .product = s->info.product,
		.revision = s->info.revision, .serial = s->info.serial,
	};
}

static void slave_device_release(struct device *dev)
{
	struct ec_slave_device *d = to_slave_device(dev);

	if (current != d->remover)
		WRITE_ONCE(released_elsewhere, true);
	kmem_cache_free(cache, d);
	if (atomic_dec_and_test(&n_devices))
		wake_up_var(&n_devices);
}

/**
 * ec_slave_device_free() - free a device that is not in sysfs
 * @d: of ec_slave_device_alloc()
 *
 * Context: Process.
 */
void ec_slave_device_free(struct ec_slave_device *d)
{
	d->remover = current;
	put_device(&d->dev);
}

/**
 * ec_slave_device_alloc() - a device that is not in sysfs so far
 * @bus: where its slave is
 * @parent: device of the master
 * @at: of its slave
 *
 * Context: Process. May sleep.
 * Return: device for ec_slave_device_add(), or NULL: no memory.
 */
struct ec_slave_device *ec_slave_device_alloc(const struct ec_bus *bus, struct device *parent,
					      const struct ec_slave_at *at)
{
	struct ec_slave_device *d = kmem_cache_zalloc(cache, GFP_KERNEL);

	if (!d)
		return NULL;
	d->bus = bus;
	d->at = *at;
	atomic_inc(&n_devices);
	device_initialize(&d->dev);
	d->dev.parent = parent;
	d->dev.bus = &slave_bus;
	d->dev.release = slave_device_release;
	/* its folder "power" would take a quarter of the memory */
	device_set_pm_not_required(&d->dev);
	if (!dev_set_name(&d->dev, "%s-d%llu", dev_name(parent), at->number))
		return d;
	ec_slave_device_free(d);
	return NULL;
}

/**
 * ec_slave_device_add() - show a device in sysfs
 * @d: device
 * @uevent: with a uevent
 *
 * Context: Process. May sleep.
 * Return: 0; -errno: the device is still not in sysfs.
 */
int ec_slave_device_add(struct ec_slave_device *d, bool uevent)
{
	int ret;

	dev_set_uevent_suppress(&d->dev, !uevent);
	ret = device_add(&d->dev);
	/* "udevadm trigger" asks for one later */
	dev_set_uevent_suppress(&d->dev, false);
	return ret;
}

/**
 * ec_slave_device_remove() - remove a device; its attributes cannot be read any more
 * @d: device; freed
 * @uevent: with a uevent
 *
 * Context: Process. Waits for readers of its attributes.
 */
void ec_slave_device_remove(struct ec_slave_device *d, bool uevent)
{
	d->remover = current;
	dev_set_uevent_suppress(&d->dev, !uevent);
	device_unregister(&d->dev);
}
