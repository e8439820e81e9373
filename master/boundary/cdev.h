/* SPDX-License-Identifier: GPL-2.0-only */
/* The character device /dev/EtherCAT<n>. */
#ifndef EC_CDEV_H
#define EC_CDEV_H

#include <linux/fs.h>
#include <linux/spinlock.h>
#include <linux/poll.h>
#include <linux/rcupdate.h>
#include "ethercat.h"
#include "../cycle/waiters.h"

struct ec_master;
struct ec_reader;
struct ec_session;

/** struct ec_file - one open file */
struct ec_file {
	/** @master: stays while a file is open, as the module does */
	struct ec_master *master;
	/** @writable: opened for writing */
	bool writable;
	/** @lock: protects @reason */
	raw_spinlock_t lock;
	/** @reason: text of the last failure, under @lock */
	char reason[EC_UAPI_REASON];
	/** @waiters: callers that wait for a cycle */
	struct ec_waiters waiters;
	/** @reader: NULL, or it reads records; set once */
	struct ec_reader *reader;
	/** @holds: it has held a sync unit of another application */
	bool holds;
	/**
	 * @admitted: bits EC_ADMITTED_*: commands of the cycle that ioctl() has let through on this
	 * file
	 */
	unsigned long admitted;
	/** @rcu: frees it after the cycle has finished with @waiters */
	struct rcu_head rcu;
};

/* bits of @admitted */
enum { EC_ADMITTED_RECEIVE, EC_ADMITTED_SEND };

void ec_file_init(struct ec_file *f, struct ec_master *m, bool writable);
__poll_t ec_file_poll(struct ec_file *f, struct file *filp, poll_table *wait);

int ec_cdev_init(void);
void ec_cdev_exit(void);
unsigned int ec_cdev_count(void);
struct ec_master *ec_cdev_master(unsigned int index);
void ec_cdev_add(struct ec_master *m);
struct ec_master *ec_cdev_remove(void);
int ec_cdev_publish(bool eoe);
void ec_cdev_unpublish(void);

long ec_ioctl(struct file *filp, unsigned int cmd, unsigned long arg);
int ec_ioctl_advise(struct file *filp, loff_t offset, loff_t len, int advice);

#endif
