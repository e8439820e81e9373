/* SPDX-License-Identifier: GPL-2.0-only */
/* The interrupt of a timer looks for the monitor while all is well. */
#ifndef EC_MASTER_QUIET_H
#define EC_MASTER_QUIET_H

#include <linux/hrtimer.h>
#include "bus/survey.h"

struct ec_master;

/**
 * struct ec_quiet - what the timer of the monitor's sleep compares
 *
 * The monitor writes it while the timer does not run.
 */
struct ec_quiet {
	/** @m: master */
	struct ec_master *m;
	/** @timer: of the next look; expires in hard interrupt */
	struct hrtimer timer;
	/** @task: the monitor */
	struct task_struct *task;
	/** @looks: that the timer still makes before it wakes the monitor */
	unsigned int looks;
	/** @count: slaves that reply */
	unsigned int count;
	/** @survey: of all slaves; all are in their requested state */
	const struct ec_survey *survey;
	/** @changes: of the slaves before it */
	u32 changes;
	/** @event: number of the next event for the kernel log */
	u64 event;
	/** @missed: frames lost and late */
	u64 missed;
	/** @events: of the IRQ field that wake the monitor */
	u16 events;
	/** @until_ns: then the monitor has to look itself (ktime) */
	u64 until_ns;
	/** @after_ns: time between two looks */
	u64 after_ns;
	/** @slack_ns: by which it may be longer */
	u64 slack_ns;
	/** @ride_ns: when the rider in flight began (ktime) */
	u64 ride_ns;
};

void ec_quiet_init(struct ec_quiet *q, struct ec_master *m);
void ec_quiet_exit(struct ec_quiet *q);
void ec_quiet_allow(struct ec_quiet *q);
void ec_quiet_sleep(struct ec_quiet *q, ktime_t after, u64 slack_ns);

#endif
