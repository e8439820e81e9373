/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The only place that knows kernel versions. Sources are written for the
 * newest supported kernel; this file supplies what older ones lack.
 */
#ifndef EC_COMPAT_H
#define EC_COMPAT_H

#include <linux/version.h>

#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 1, 0)
#error "ec_master needs Linux 6.1 or newer: set KDIR= to the headers of such a kernel"
#endif

/* moved in 6.12; sparse does not know __has_include */
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 12, 0)
#include <asm/unaligned.h>
#else
#include <linux/unaligned.h>
#endif
/* mac_pton(), which is elsewhere in 6.1 */
#if LINUX_VERSION_CODE >= KERNEL_VERSION(6, 12, 0)
#include <linux/hex.h>
#endif
#include <linux/device.h>
#include <linux/hrtimer.h>
#include <linux/mm.h>

/* class_create() lost its owner argument in 6.4 */
static inline struct class *ec_class_create(const char *name)
{
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 4, 0)
	return class_create(THIS_MODULE, name);
#else
	return class_create(name);
#endif
}

/* the device of a class's devnode() became const in 6.2 */
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 2, 0)
#define EC_DEVNODE_DEVICE	struct device
#else
#define EC_DEVNODE_DEVICE	const struct device
#endif

/* and that of a bus type's uevent() in 6.3 */
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 3, 0)
#define EC_UEVENT_DEVICE	struct device
#else
#define EC_UEVENT_DEVICE	const struct device
#endif

/* vm_flags are only writable through helpers since 6.3 */
static inline void ec_vma_flags(struct vm_area_struct *vma, unsigned long set, unsigned long clear)
{
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 3, 0)
	vma->vm_flags = (vma->vm_flags & ~clear) | set;
#else
	vm_flags_mod(vma, set, clear);
#endif
}

/* took the place of hrtimer_init() in 6.13 */
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 13, 0)
static inline void hrtimer_setup(struct hrtimer *timer,
				 enum hrtimer_restart (*function)(struct hrtimer *),
				 clockid_t clock, enum hrtimer_mode mode)
{
	hrtimer_init(timer, clock, mode);
	timer->function = function;
}

static inline void hrtimer_setup_on_stack(struct hrtimer *timer,
					  enum hrtimer_restart (*function)(struct hrtimer *),
					  clockid_t clock, enum hrtimer_mode mode)
{
	hrtimer_init_on_stack(timer, clock, mode);
	timer->function = function;
}
#endif

/* does the driver lock its transmit queue itself? A feature bit before 6.12 */
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 12, 0)
#define ec_netdev_lltx(nd)	((nd)->features & NETIF_F_LLTX)
#else
#define ec_netdev_lltx(nd)	((nd)->lltx)
#endif

#endif
