// SPDX-License-Identifier: GPL-2.0-only
#include <linux/cdev.h>
#include <linux/device.h>
#include <linux/mm.h>
#include <linux/module.h>
#include <linux/poll.h>
#include <linux/slab.h>
#include "cdev.h"
#include "../kernel/compat.h"
#include "../cycle/cycle_wait.h"
#include "master.h"
#include "../session/reserve.h"
#include "../session/session.h"
#include "../session/session_units.h"
#include "slave_device.h"

static struct class *ec_class;
static dev_t first_dev;
static struct cdev *cdev;	/* of all masters */
static unsigned int n_published;

/* changed while the module is loaded or removed only, and never while a file can be opened */
static struct ec_master *masters[EC_MAX_MASTERS];
static unsigned int n_masters;

/**
 * ec_cdev_count() - number of masters
 *
 * Context: Any.
 * Return: masters that applications can request.
 */
unsigned int ec_cdev_count(void)
{
	return n_masters;
}

/**
 * ec_cdev_master() - a master by its number
 * @index: less than ec_cdev_count()
 *
 * Context: Any.
 * Return: the master.
 */
struct ec_master *ec_cdev_master(unsigned int index)
{
	return masters[index];
}

/**
 * ec_cdev_add() - give a master its number
 * @m: master that is complete; its number is the next one
 *
 * Context: Process, while the module is loaded.
 */
void ec_cdev_add(struct ec_master *m)
{
	masters[n_masters++] = m;
}

/**
 * ec_cdev_remove() - remove the last master from the table
 *
 * Context: Process, without open files.
 * Return: that master, or NULL: there is none left.
 */
struct ec_master *ec_cdev_remove(void)
{
	return n_masters ? masters[--n_masters] : NULL;
}

/**
 * ec_file_init() - prepare an open file
 * @f: file, zeroed
 * @m: its master
 * @writable: opened for writing
 *
 * Context: Any.
 */
void ec_file_init(struct ec_file *f, struct ec_master *m, bool writable)
{
	f->master = m;
	f->writable = writable;
	raw_spin_lock_init(&f->lock);
	ec_waiters_init(&f->waiters);
}

static int ec_open(struct inode *inode, struct file *filp)
{
	unsigned int index = iminor(inode) - MINOR(first_dev);
	struct ec_file *f;

	if (index >= n_masters)
		return -ENXIO;
	f = kzalloc(sizeof(*f), GFP_KERNEL_ACCOUNT);
	if (!f)
		return -ENOMEM;
	ec_file_init(f, masters[index], filp->f_mode & FMODE_WRITE);
	filp->private_data = f;
	return nonseekable_open(inode, filp);
}

/* The kernel calls this for a killed process as well. */
static int ec_release(struct inode *inode, struct file *filp)
{
	struct ec_file *f = filp->private_data;
	struct ec_master *m = f->master;

	/* a read-only file has reserved nothing: no lock is needed */
	if (f->holds)
		ec_session_leave_units(&m->sessions, f);
	if (f->writable)
		ec_session_end(&m->sessions, f);
	ec_reader_end(f);
	kfree_rcu(f, rcu);
	return 0;
}

static void vma_open(struct vm_area_struct *vma)
{
	ec_shared_get(vma->vm_private_data);
}

static void vma_close(struct vm_area_struct *vma)
{
	ec_shared_put(vma->vm_private_data);
}

static const struct vm_operations_struct vm_ops = {
	.open = vma_open,
	.close = vma_close,
};

static int map_shared(struct ec_shared *sh, struct vm_area_struct *vma)
{
	const struct {
		u64 offset;
		void *memory;
		size_t size;
	} parts[] = {
		/* the image of a cycle the kernel runs is the kernel's */
		{ EC_MMAP_IMAGE, sh->exchange ? NULL : sh->image, sh->image_size },
		{ EC_MMAP_EXCHANGE, sh->exchange, sh->exchange_size },
		{ EC_MMAP_STATUS, sh->status, EC_STATUS_BYTES },
		{ EC_MMAP_REQUESTS, sh->requests, sh->request_size },
	};
	u64 offset = (u64)vma->vm_pgoff << PAGE_SHIFT;
	bool status = offset == EC_MMAP_STATUS;
	unsigned int i = 0;
	int ret;

	while (i < ARRAY_SIZE(parts) && parts[i].offset != offset)
		i++;
	if (i == ARRAY_SIZE(parts) || !parts[i].memory)
		return -EINVAL;
	if (status && vma->vm_flags & VM_WRITE)
		return -EPERM;
	if (vma->vm_end - vma->vm_start > parts[i].size)
		return -EINVAL;
	ret = ec_shared_map(vma, parts[i].memory);
	if (ret)
		return ret;
	ec_vma_flags(vma, VM_DONTEXPAND | VM_DONTDUMP, VM_MAYEXEC | (status ? VM_MAYWRITE : 0));
	ec_shared_get(sh);
	vma->vm_private_data = sh;
	vma->vm_ops = &vm_ops;
	return 0;
}

static int ec_mmap(struct file *filp, struct vm_area_struct *vma)
{
	struct ec_file *f = filp->private_data;
	struct ec_master *m = f->master;
	int ret = -EPERM;

	if (!(vma->vm_flags & VM_MAYSHARE))
		return -EINVAL;
	if (vma->vm_flags & VM_EXEC || !f->writable)
		return -EPERM;
	/* other threads of the process wait for this one: it must be possible to kill them */
	if (mutex_lock_killable(&m->sessions.lock))
		return -EINTR;
	if (m->sessions.session && m->sessions.session->cycle.owner == f &&
	    m->sessions.session->wanted.active)
		ret = map_shared(m->sessions.session->cycle.shared, vma);
	mutex_unlock(&m->sessions.lock);
	return ret;
}

/**
 * ec_file_poll() - new inputs of a cycle that the kernel runs, new events or messages
 * @f: open file
 * @filp: the same as the kernel knows it
 * @wait: argument of poll()
 *
 * Takes no lock of the master: a caller that is preempted here delays no other caller.
 *
 * Context: Process. May sleep to add an entry to the wait queue.
 * Return: as ec_reader_poll() for a reader; as ec_cycle_thread_poll() for the owner of the cycle;
 * EPOLLERR for every other file, and when too many wait already.
 */
__poll_t ec_file_poll(struct ec_file *f, struct file *filp, poll_table *wait)
{
	/* pairs with ec_reader_enter() */
	struct ec_reader *r = smp_load_acquire(&f->reader);

	if (r)
		return ec_reader_poll(r, filp, wait);
	return ec_waiters_poll(&f->waiters, filp, wait) ?
	       ec_cycle_thread_poll(&f->master->cycles, f) : EPOLLERR;
}

static __poll_t ec_poll(struct file *filp, poll_table *wait)
{
	return ec_file_poll(filp->private_data, filp, wait);
}

static ssize_t ec_read(struct file *filp, char __user *to, size_t size, loff_t *at)
{
	return ec_reader_read(filp->private_data, to, size, !(filp->f_flags & O_NONBLOCK));
}

static const struct file_operations ec_fops = {
	.owner = THIS_MODULE,
	.read = ec_read,
	.open = ec_open,
	.release = ec_release,
	.mmap = ec_mmap,
	.poll = ec_poll,
	.unlocked_ioctl = ec_ioctl,
	.fadvise = ec_ioctl_advise,
	.compat_ioctl = compat_ptr_ioctl,
};

/* Every user may read: a read-only file causes no bus traffic and changes nothing. */
static char *devnode(EC_DEVNODE_DEVICE *dev, umode_t *mode)
{
	if (mode)
		*mode = 0664;
	return NULL;
}

/* Udev makes nodes of them; a program that knows the numbers needs none. */
static void make_nodes(bool eoe)
{
	struct device *dev;
	unsigned int i;

	for (i = 0; i < n_published; i++) {
		dev = device_create(ec_class, NULL, first_dev + i, NULL, "EtherCAT%u", i);
		ec_eoe_start(&masters[i]->eoe, &masters[i]->bus, IS_ERR(dev) ? NULL : dev, eoe);
		if (IS_ERR(dev))
			pr_err("EtherCAT %u: cannot make its device node (%pe); make it with \"mknod /dev/EtherCAT%u c %u %u\"\n",
			       i, dev, i, MAJOR(first_dev), MINOR(first_dev) + i);
		else
			ec_slave_devices_start(&masters[i]->slave_devices, &masters[i]->bus, dev);
	}
}

/**
 * ec_cdev_publish() - let programs open the devices of all masters
 * @eoe: each slave with EoE has a network device
 *
 * The last step of the load. The memory of a module whose load fails is freed while a program
 * has its device open, so nothing that can fail may come after it.
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno; on failure no program has been able to open anything.
 */
int ec_cdev_publish(bool eoe)
{
	int ret = n_masters ? cdev_add(cdev, first_dev, n_masters) : 0;

	if (ret)
		return ret;
	n_published = n_masters;
	make_nodes(eoe);
	return 0;
}

/**
 * ec_cdev_unpublish() - no program opens a device any more
 *
 * Context: Process, at module exit, so no file is open. May sleep.
 */
void ec_cdev_unpublish(void)
{
	unsigned int i;

	if (!n_published)
		return;
	for (i = 0; i < n_published; i++) {
		ec_slave_devices_stop(&masters[i]->slave_devices);
		ec_eoe_stop(&masters[i]->eoe);
		device_destroy(ec_class, first_dev + i);
	}
	n_published = 0;
	cdev_del(cdev);
	cdev = NULL;
}

/**
 * ec_cdev_init() - prepare the devices of masters
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno.
 */
int ec_cdev_init(void)
{
	int ret = alloc_chrdev_region(&first_dev, 0, EC_MAX_MASTERS, "EtherCAT");

	if (ret)
		return ret;
	ret = ec_slave_device_register();
	if (ret)
		goto err_region;
	ec_class = ec_class_create("EtherCAT");
	ret = PTR_ERR_OR_ZERO(ec_class);
	if (ret)
		goto err_bus;
	ec_class->devnode = devnode;
	/* not in the memory of this module: the kernel may use it after the module was removed */
	cdev = cdev_alloc();
	if (!cdev) {
		ret = -ENOMEM;
		goto err_class;
	}
	cdev->ops = &ec_fops;
	cdev->owner = THIS_MODULE;
	return 0;

err_class:
	class_destroy(ec_class);
err_bus:
	ec_slave_device_unregister();
err_region:
	unregister_chrdev_region(first_dev, EC_MAX_MASTERS);
	return ret;
}

/**
 * ec_cdev_exit() - free what ec_cdev_init() has allocated
 *
 * Context: Process. May sleep.
 */
void ec_cdev_exit(void)
{
	if (cdev)
		kobject_put(&cdev->kobj);
	cdev = NULL;
	class_destroy(ec_class);
	ec_slave_device_unregister();
	unregister_chrdev_region(first_dev, EC_MAX_MASTERS);
}
