/* SPDX-License-Identifier: GPL-2.0-only */
/* A network card as device of a master: rings that run while one uses it. */
#ifndef EC_INTEL_CARD_H
#define EC_INTEL_CARD_H

#include <linux/hrtimer.h>
#include <linux/mutex.h>
#include <linux/pci.h>
#include <linux/ratelimit.h>
#include "devices/ecdev.h"
#include "health.h"
#include "nic.h"
#include "ring.h"

/**
 * struct intel - one network controller
 */
struct intel {
	/** @pdev: PCI function */
	struct pci_dev *pdev;
	/** @chip: what it is */
	const struct intel_chip *chip;
	/** @nic: its registers */
	struct intel_nic nic;
	/** @tx: transmit ring; one sender at a time */
	struct intel_ring tx;
	/** @rx: receive ring; only in a poll */
	struct intel_ring rx;
	/** @dev: receives the frames; set before the first one can arrive */
	struct ecdev *dev;
	/** @lock: while the rings start, run or end they are those of one caller */
	struct mutex lock;
	/** @idle: polls while no cycle does */
	struct hrtimer idle;
	/** @sent_ns: when the last frame was sent without a cycle (ktime) */
	atomic64_t sent_ns;
	/** @busy: bits BUSY_* */
	unsigned long busy;
	/** @cycle: the cycle polls */
	bool cycle;
	/** @started: a master uses it */
	bool started;
	/** @ready: the rings run */
	bool ready;
	/** @failed: they should run, which is tried again */
	bool failed;
	/** @shut: the computer goes down: they never run again */
	bool shut;
	/** @health: with @lock held */
	struct intel_health health;
	/** @negotiate: the PHY was not asked to negotiate after the reset */
	bool negotiate;
	/** @faults: limit of lines about the link */
	struct ratelimit_state faults;
	/** @restarts: limit of lines about starts */
	struct ratelimit_state restarts;
};

extern const struct ecdev_ops ec_card_ops;

void ec_card_init(struct intel *n);
void ec_card_quiesce(struct intel *n);
int ec_card_run_again(struct intel *n);
void ec_card_shut(struct intel *n);

#endif
