/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Before every source of master/ and of the devices in the UML kernel: a test lets allocations
 * fail. The kernel's failslab spares those that may sleep.
 */
#ifndef EC_OOM_H
#define EC_OOM_H

#include <linux/err.h>
#include <linux/kthread.h>
#include <linux/netdevice.h>
#include <linux/slab.h>
#include <linux/vmalloc.h>
#include <linux/workqueue.h>

bool oom_fails(void);

#define kmalloc(...)		(oom_fails() ? NULL : kmalloc(__VA_ARGS__))
#define kmalloc_array(...)	(oom_fails() ? NULL : kmalloc_array(__VA_ARGS__))
#define kzalloc(...)		(oom_fails() ? NULL : kzalloc(__VA_ARGS__))
#define kvmalloc(...)		(oom_fails() ? NULL : kvmalloc(__VA_ARGS__))
#define kvmalloc_array(...)	(oom_fails() ? NULL : kvmalloc_array(__VA_ARGS__))
#define kvzalloc(...)		(oom_fails() ? NULL : kvzalloc(__VA_ARGS__))
#define kvcalloc(...)		(oom_fails() ? NULL : kvcalloc(__VA_ARGS__))
#define kmem_cache_zalloc(...)	(oom_fails() ? NULL : kmem_cache_zalloc(__VA_ARGS__))
#define __vmalloc(...)		(oom_fails() ? NULL : __vmalloc(__VA_ARGS__))
#define vmalloc(...)		(oom_fails() ? NULL : vmalloc(__VA_ARGS__))
#define vmalloc_user(...)	(oom_fails() ? NULL : vmalloc_user(__VA_ARGS__))
#define vzalloc(...)		(oom_fails() ? NULL : vzalloc(__VA_ARGS__))
#define alloc_workqueue(...)	(oom_fails() ? NULL : alloc_workqueue(__VA_ARGS__))
#define alloc_netdev_mqs(...)	(oom_fails() ? NULL : alloc_netdev_mqs(__VA_ARGS__))
#define alloc_skb_fclone(...)	(oom_fails() ? NULL : alloc_skb_fclone(__VA_ARGS__))
#define netdev_alloc_skb(...)	(oom_fails() ? NULL : netdev_alloc_skb(__VA_ARGS__))
#define skb_clone(...)		(oom_fails() ? NULL : skb_clone(__VA_ARGS__))
#define kthread_create_on_node(...) \
	(oom_fails() ? ERR_PTR(-ENOMEM) : kthread_create_on_node(__VA_ARGS__))

#endif
