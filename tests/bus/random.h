/* SPDX-License-Identifier: GPL-2.0-only */
/* A tree of slaves at random, the application that runs it, and who of it must not notice. */
#ifndef EC_RANDOM_H
#define EC_RANDOM_H

#include "cyc.h"
#include "tests/unit/port_events.h"

#define RANDOM_SLAVES	PORT_EVENTS_SLAVES
#define RANDOM_HISTORY	4	/* cycles */
#define RANDOM_SETTLED	5	/* cycles: all values that it sends back were sent to it in OP */

/**
 * struct random_slave - what is known of a slave of the segment
 * @slave: its object when it became entitled, with a reference
 * @well: cycles in OP with a whole path; with RANDOM_SETTLED it is entitled to remain so
 * @readdressed: cycles with another station address
 * @configured: there is a configuration
 * @mailbox: it has CoE and FoE
 * @data: it has process data
 * @domain: these are in this domain
 * @out: offset of the byte there that the slave sends back
 * @in: and of what it sends
 */
struct random_slave {
	struct ec_slave *slave;
	u64 well;
	u32 readdressed;
	bool configured;
	bool mailbox;
	bool data;
	u32 domain;
	u32 out;
	u32 in;
};

/**
 * struct random_user - somebody who reads and writes objects and files
 * @task: its thread
 * @go: @slave is set
 * @idle: it has done so
 * @next_ns: when it begins again
 * @slave: mailbox to use; NULL: the thread ends
 * @index: of that slave in the segment
 * @since: it was well for so many cycles at the last look
 * @was_cut: it was cut off meanwhile
 * @file: FoE, not CoE
 * @ret: result
 * @good: transfers that ended well
 * @cut: others, with slaves that were cut off meanwhile
 * @bad: others
 */
struct random_user {
	struct task_struct *task;
	struct completion go;
	bool idle;
	u64 next_ns;
	struct ec_slave *slave;
	u32 index;
	u64 since;
	bool was_cut;
	bool file;
	int ret;
	u32 good;
	u32 cut;
	u32 bad;
};

/**
 * struct random_run - a run, and what it has to keep
 * @b: bus
 * @c: application, NULL: none so far
 * @e: events
 * @seed: of this run
 * @rng: random numbers of the tree and the users
 * @n: slaves connected at first
 * @clocks: with SYNC0
 * @hosts: PCs and switches come; then a link takes its time
 * @early: events begin with the first scan, or with the activation
 * @s: slaves of the segment
 * @mark: those with a path that was whole since the last look
 * @user: one reads objects, one writes and reads files
 * @last_ns: time of the last look
 * @rescan_ns: when the whole bus is scanned again
 * @disturbed: frames that were on their way at a change of a link, at the last look
 * @late: looks since such a change
 * @value: that was sent in the last cycles, the newest first
 * @checked: slaves and cycles
 * @readdressed: of these, with another station address
 * @longest: most cycles of a slave with one
 * @broken: slaves that were entitled, and were not in OP, or not in the list
 * @wrong: values of entitled slaves that are not what was sent to them, and working counters
 *         that are less than theirs, without an event that met a frame
 * @in_flight: such values and counters with one
 * @met: cycles whose frames may have met an event
 */
struct random_run {
	struct bus *b;
	struct cyc *c;
	struct port_events e;
	u64 seed;
	u64 rng;
	u32 n;
	bool clocks;
	bool hosts;
	u32 early;
	struct random_slave s[RANDOM_SLAVES];
	u8 mark[RANDOM_SLAVES];
	struct random_user user[2];
	u64 last_ns;
	u64 rescan_ns;
	u64 disturbed;
	u32 late;
	u8 value[RANDOM_HISTORY];
	u64 checked;
	u64 readdressed;
	u32 longest;
	u64 broken;
	u64 wrong;
	u64 in_flight;
	u64 met;
};

enum { RANDOM_IN_OP, RANDOM_FROM_START, RANDOM_FROM_SCAN };

/* of a slave whose path is whole */
static inline bool random_entitled(const struct random_slave *x)
{
	return x->well > RANDOM_SETTLED;
}

u32 random_below(struct random_run *r, u32 n);
char *random_tree(struct random_run *r, struct kunit *test);
void random_application(struct random_run *r);
void random_look(struct cyc *c);
void random_users_begin(struct random_run *r);
void random_users_turn(struct random_run *r, u64 now);
void random_users_end(struct random_run *r);

#endif
