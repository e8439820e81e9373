/* SPDX-License-Identifier: GPL-2.0-only */
/* One master: links, slaves, the session that uses it. */
#ifndef EC_MASTER_H
#define EC_MASTER_H

#include <linux/cdev.h>
#include <linux/device.h>
#include <linux/mutex.h>
#include <linux/rwsem.h>
#include <linux/spinlock.h>
#include <linux/wait.h>
#include <linux/workqueue.h>
#include "ethercat.h"
#include "cycle/cycle.h"
#include "bus/bus.h"
#include "clock/dc.h"
#include "cycle/late.h"
#include "base/base.h"
#include "link/links.h"

struct ec_api;
struct ec_session;
struct ec_slave;
struct task_struct;

/**
 * struct ec_master - everything below one /dev/EtherCAT<n>
 * @base: number, log, immutable
 * @dev: device below the class
 * @cdev: character device
 * @links: devices, frames and bus access
 * @bus: slaves
 *
 * @monitor: thread
 * @rider: its datagram in frames of the cycle
 * @lanes: workers of requests; they wait for slaves
 * @service: what others wait for, never many at once: clocks, looks at requests,
 *	calls of an application in the kernel
 *
 * @session_lock: protects @session, @heir and everything they own but the
 *	cyclic part
 * @session: what an application has configured, NULL: nobody
 * @api: for applications in the kernel, immutable
 * @memory: bytes of all sessions, and of what they have mapped, which may outlive them
 * @heir: what another one configures to take over @session, which is detached
 * @dc: distributed clocks
 * @cycles: cycles of applications
 */
struct ec_master {
	struct ec_base base[1];	/* one; used as in the layers, which have a pointer */
	struct device dev;
	struct cdev cdev;
	struct ec_links links;
	struct ec_bus bus;

	struct task_struct *monitor;
	struct ec_rider rider;
	struct workqueue_struct *lanes;
	struct workqueue_struct *service;

	struct mutex session_lock;
	struct ec_session *session;
	struct ec_api *api;
	atomic_long_t memory;
	struct ec_session *heir;
	struct ec_dc dc;
	struct ec_cycles cycles;
};

int ec_masters_create(char **main, unsigned int n_main, char **backup, unsigned int n_backup,
		      unsigned int debug);
void ec_masters_destroy(void);

/* monitor.c */
int ec_monitor_start(struct ec_master *m);
void ec_monitor_stop(struct ec_master *m);
void ec_monitor_kick(struct ec_master *m);

#endif
