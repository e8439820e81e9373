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
#include "clock/dc.h"
#include "cycle/late.h"
#include "base/base.h"
#include "boundary/show.h"
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
 *
 *
 * @topo: protects @slaves, @n_slaves, @scan_busy (written by the monitor only)
 *	and the PDO lists of the slaves
 * @slaves: by ring position
 * @n_slaves: entries in @slaves
 * @scan_busy: slaves are being scanned
 * @scan_slaves: how many the scan has to do with
 * @scan_index: how many of them have been read
 * @scan_wq: woken when a scan ends or a slave has settled
 * @scan_count: scans finished so far
 * @scan_us: duration of the last scan
 * @scan_frames: frames of the last scan
 * @next_station: next unused station address
 * @complete_ns: when all slaves replied last (ktime)
 * @rescan: a scan is asked for
 * @looked: the bus was scanned, or there is no link, since the device came
 * @freeze: no scan while reserved and not active
 *
 * @monitor: thread
 * @monitor_wq: wakes it
 * @work: workers that bring slaves to their state; they wait for clocks and cycles
 * @lanes: workers of requests; they wait for slaves
 * @service: what others wait for, never many at once: clocks, looks at requests,
 *	calls of an application in the kernel
 *
 * @show: readers of what @session_lock and @topo protect take neither
 * @session_lock: protects @session, @heir and everything they own but the
 *	cyclic part
 * @session: what an application has configured, NULL: nobody
 * @api: for applications in the kernel, immutable
 * @mapped: bytes of memory for applications to map, also of sessions that have ended
 * @heir: what another one configures to take over @session, which is detached
 * @cyclic_lock: held by the cyclic caller in receive and send; protects @active
 * @active: @session while it is active
 * @active_owner: owner of @active, to be compared without a lock; NULL: none
 *
 * @late: figures of the last cycle, under @session_lock
 * @late_reset: the cyclic caller shall forget its figures
 *
 * @kernel_cycle: cycles of the thread that runs the cycle
 * @kernel_run: odd while it sends; another number than before: another run
 * @kernel_session: @session while the kernel runs its cycle; changed under
 *	@session_lock, read under RCU
 *
 * @slaves_responding: slaves that answered the last broadcast
 * @al_states: OR of AL states, as in struct ec_ioc_master
 * @dc: distributed clocks
 */
struct ec_master {
	struct ec_base base[1];	/* one; used as in the layers, which have a pointer */
	struct device dev;
	struct cdev cdev;
	struct ec_links links;

	struct rw_semaphore topo;
	struct ec_slave **slaves;
	unsigned int n_slaves;
	bool scan_busy;
	u32 scan_slaves;
	u32 scan_index;
	wait_queue_head_t scan_wq;
	u32 scan_count;
	u32 scan_us;
	u64 scan_frames;
	u16 next_station;
	u64 complete_ns;
	bool rescan;
	bool looked;
	bool freeze;

	struct task_struct *monitor;
	wait_queue_head_t monitor_wq;
	struct workqueue_struct *work;
	struct workqueue_struct *lanes;
	struct workqueue_struct *service;

	struct ec_show show;
	struct mutex session_lock;
	struct ec_session *session;
	struct ec_api *api;
	atomic_long_t mapped;
	atomic_long_t sii_bytes;
	struct ec_session *heir;
	struct mutex cyclic_lock;
	struct ec_session *active;
	const void *active_owner;

	struct ec_late_report late;
	bool late_reset;

	aligned_u64 kernel_cycle;
	u32 kernel_run;
	struct ec_session __rcu *kernel_session;

	u32 slaves_responding;
	u32 al_states;
	struct ec_dc dc;
};

unsigned int ec_master_count(void);
struct ec_master *ec_master_get(unsigned int index);
int ec_masters_create(char **main, unsigned int n_main, char **backup, unsigned int n_backup,
		      unsigned int debug);
void ec_masters_destroy(void);

int ec_master_wait_scan(struct ec_master *m);
int ec_master_wait_slaves(struct ec_master *m);
void ec_master_wait_slave(struct ec_slave *slave);
bool ec_master_scan_busy(const struct ec_master *m);
void ec_master_scan_progress(const struct ec_master *m, u32 *index, u32 *count);
void ec_master_rescan(struct ec_master *m);

struct ec_slave *ec_master_slave(struct ec_master *m, unsigned int position);

/* monitor.c */
int ec_monitor_start(struct ec_master *m);
void ec_monitor_stop(struct ec_master *m);
void ec_monitor_kick(struct ec_master *m);

#endif
