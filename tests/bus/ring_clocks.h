/* SPDX-License-Identifier: GPL-2.0-only */
/* An application with SYNC0 at a ring of clocks. */
#ifndef EC_TEST_RING_CLOCKS_H
#define EC_TEST_RING_CLOCKS_H

#include "ring.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"

#define GOAL_NS	1000	/* of every running clock from the line of the reference clock */
#define LOST_NS	2000	/* from that line, while the reference clock is lost */
#define LATE_NS	20000	/* cycles, on average */
#define VERY_LATE_NS	200000	/* more, one of 1,000 */
#define HOST_PPB	50000	/* by which the computer's clock is faster than their mean */
#define WANDER_PPB	1000	/* how far its rate wanders from that at most */

/**
 * struct clocks - an application with SYNC0 at a ring of clocks of up to 100 ppm
 * @b: bus
 * @c: its cycle
 * @kernel: the kernel runs it, phase-locked to the reference clock
 * @still: the clock of the computer does not wander
 * @unlocked: cycles in which it was not, in the last run
 * @leads: the reference clock is synchronized to its time
 * @off: how far it was ahead of that, ns, 0: not known yet
 * @ref: index of the reference clock
 * @configured: so many slaves, the first ones
 * @op: mask of slaves in OP
 * @left: how often a slave left it that is not of @absent
 * @absent: mask of slaves that no frame reaches
 * @none: mask of slaves without a clock
 * @deaf: mask of slaves that ignore FRMW
 * @wander_ppb: how much faster the clock of the computer is than at first
 * @wander_ns: when that has begun (ktime)
 * @wandered: how far it was ahead then, 1e-9 ns
 * @random: of that
 * @lost: the reference clock is one of them: its line is continued
 * @then_ns: when its line was noted (ktime)
 * @then: its time then
 * @then_ahead: how far the clock of the computer was ahead then, 1e-9 ns
 * @ppb: how much faster the reference clock is than that without wander, 1e-9
 * @most: largest difference from that line, ns
 * @was: difference of each clock in the last cycle, ns
 * @jump: largest change of one in a cycle, ns
 * @open: the ring is open
 * @opened: how often it was opened
 * @empty: cycles without a reply of a slave
 * @map: configures the slaves, in their order; NULL: by ring position
 */
struct clocks {
	struct bus *b;
	struct cyc *c;
	bool kernel;
	bool still;
	u32 unlocked;
	bool leads;
	s64 off;
	u32 ref;
	u32 configured;
	u32 op;
	u32 left;
	u32 absent;
	u32 none;
	u32 deaf;
	s32 wander_ppb;
	u64 wander_ns;
	s64 wandered;
	struct rnd_state random;
	bool lost;
	u64 then_ns;
	u64 then;
	s64 then_ahead;
	s64 ppb;
	s64 most;
	s64 was[SLAVES];
	s64 jump;
	bool open;
	u32 opened;
	u32 empty;
	void (*map)(struct clocks *k);
};

/* masks of slaves whose clock has 32 bits, without one, and that ignore FRMW */
struct kinds {
	u32 narrow;
	u32 none;
	u32 deaf;
};

u64 clock_of(const struct clocks *k, u32 i, u64 now);
u64 clocks_line(const struct clocks *k, u64 now);
s64 clocks_run(struct clocks *k, u32 cycles);
struct bus *clocks_bus_of(struct kunit *test, u32 back_ns, struct kinds kinds);
struct bus *clocks_bus(struct kunit *test);
struct bus *clocks_bus_line(struct kunit *test);
void clocks_configure(struct clocks *k, u32 ref, u32 n);
void clocks_begin(struct clocks *k);
void clocks_activate(struct clocks *k, u32 ref);
struct clocks *clocks_new(struct bus *b);
struct clocks *clocks_start(struct bus *b, u32 ref);
void clocks_note_line(struct clocks *k);
u32 clocks_ref(struct clocks *k);
void clocks_on_grid(struct clocks *k);
void clocks_power(struct clocks *k, u32 i, bool on);

#endif
