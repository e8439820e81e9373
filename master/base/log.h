/* SPDX-License-Identifier: GPL-2.0-only */
/* The kernel log: a line that repeats appears at most a few times in ten seconds. */
#ifndef EC_LOG_H
#define EC_LOG_H

#include <linux/printk.h>
#include <linux/spinlock.h>
#include <linux/types.h>

#define EC_LOG_WINDOW_NS	(10ULL * NSEC_PER_SEC)
#define EC_LOG_TEXT		224	/* a line has 200 characters, a reason of 160 fits */
#define EC_LOG_REPEATED		1	/* lines of equal text in a window */
#define EC_LOG_VARIED		3	/* lines of one event with different texts */
#define EC_LOG_CHANGES		5	/* lines of a change of state (KERN_INFO) */
#define EC_LOG_OF_MASTER	48	/* events of a window that belong to no slave */
#define EC_LOG_OF_SLAVES	256
#define EC_LOG_ANY		-1	/* "slave" of an event of the master */

/**
 * struct ec_log_event - one event of one subject: a call site, and what it is about
 * @key: format of the call site, or name of the kind of event, which identify it; NULL: free
 * @slave: ring position or EC_LOG_ANY
 * @id: what else the event belongs to, see ec_warn_each()
 * @level: KERN_*
 * @since: start of its window, ktime
 * @lines: logged in this window
 * @missed: counted only; the last of them is @text
 * @text: last text
 * @last: when that was, ktime
 */
struct ec_log_event {
	const char *key;
	int slave;
	u32 id;
	const char *level;
	u64 since;
	u32 lines;
	u32 missed;
	char text[EC_LOG_TEXT];
	u64 last;
};

/**
 * struct ec_log - what a master has logged lately
 * @lock: of all below
 * @events: those of the master, then those of slaves
 * @pending: an event has been counted only
 * @lost: lines without a place in @events
 * @lost_since: when the first of them came
 * @lines: logged in all
 */
struct ec_log {
	raw_spinlock_t lock;
	struct ec_log_event events[EC_LOG_OF_MASTER + EC_LOG_OF_SLAVES];
	bool pending;
	u32 lost;
	u64 lost_since;
	u64 lines;
};

struct ec_base;

void ec_log_init(struct ec_log *l);
__printf(5, 6) void ec_log_event(struct ec_base *b, int slave, u32 id, const char *level,
				 const char *fmt, ...);
void ec_log_text(struct ec_base *b, int slave, u32 id, const char *level, const char *key,
		 const char *text);
void ec_log_flush(struct ec_base *b, bool all);
bool ec_log_debug(void);

#endif
