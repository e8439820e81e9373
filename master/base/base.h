/* SPDX-License-Identifier: GPL-2.0-only */
/* What all layers of one master use. */
#ifndef EC_BASE_H
#define EC_BASE_H

#include <linux/err.h>
#include "events.h"
#include "log.h"
#include "show.h"

struct ec_mail_tap;

/** struct ec_base - what all layers of one master use; they have it as @base */
struct ec_base {
	/** @index: number of the master, immutable */
	unsigned int index;
	/** @debug: log level 0..2 */
	u32 debug;
	/** @stopping: the master is being removed: callers that wait are cancelled */
	bool stopping;
	/** @log: what was logged lately */
	struct ec_log log;
	/** @events: what has happened, for readers of the device file */
	struct ec_events events;
	/** @mail_tap: copies of mailbox messages, NULL: they have no reader */
	struct ec_mail_tap __rcu *mail_tap;
	/** @show: readers of sessions and slaves, which take no lock, and changes of these */
	struct ec_show show;
};

static inline void ec_base_init(struct ec_base *b, unsigned int index, u32 debug)
{
	b->index = index;
	b->debug = debug;
	ec_log_init(&b->log);
	ec_events_init(&b->events);
	ec_show_init(&b->show);
}

/*
 * @x: structure of a layer. @fmt is a constant: it identifies what may repeat, see
 * ec_log_event().
 */
#define ec_info(x, fmt, ...) \
	ec_log_event((x)->base, EC_LOG_ANY, 0, KERN_INFO, fmt, ##__VA_ARGS__)
#define ec_warn(x, fmt, ...) \
	ec_log_event((x)->base, EC_LOG_ANY, 0, KERN_WARNING, fmt, ##__VA_ARGS__)
/* each @id (index + 1 of a configuration, say) repeats for itself */
#define ec_warn_each(x, id, fmt, ...) \
	ec_log_event((x)->base, EC_LOG_ANY, id, KERN_WARNING, fmt, ##__VA_ARGS__)
#define ec_err(x, fmt, ...) \
	ec_log_event((x)->base, EC_LOG_ANY, 0, KERN_ERR, fmt, ##__VA_ARGS__)

/* a line of "ethercat debug @lvl" about the slave at ring position @pos; @base: struct ec_base */
#define ec_dbg_slave(base, pos, lvl, fmt, ...) \
	do { \
		if (unlikely(READ_ONCE((base)->debug) >= (lvl)) && ec_log_debug()) \
			printk(KERN_DEBUG "EtherCAT %u-%u: " fmt, (base)->index, (pos), \
			       ##__VA_ARGS__); \
	} while (0)
/* level 1, without line end: ": done" or the name of the error follows; @ret is 0 or -errno */
#define ec_dbg_slave_result(base, pos, ret, fmt, ...) \
	do { \
		if (ret) \
			ec_dbg_slave(base, pos, 1, fmt ": %pe\n", ##__VA_ARGS__, ERR_PTR(ret)); \
		else \
			ec_dbg_slave(base, pos, 1, fmt ": done\n", ##__VA_ARGS__); \
	} while (0)

#endif
