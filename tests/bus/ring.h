/* SPDX-License-Identifier: GPL-2.0-only */
/* An application at a ring of drives whose cables are cut and healed. */
#ifndef EC_TEST_RING_H
#define EC_TEST_RING_H

#include "cyc.h"

#define RING_MANY	50
#define RING_HISTORY	4
#define RING_ECHO	6	/* byte of the outputs of a drive that comes back in its inputs */

#define SLAVES		8	/* of ring_eight */
#define CUTS		(SLAVES + 1)	/* its cables */
extern const char ring_eight[];

/**
 * struct ring - an application at a ring
 * @b: bus
 * @c: its cycle
 * @n: slaves
 * @in: where the value of each is in the image
 * @out: likewise
 * @value: outputs of all slaves in the last sends, the newest first
 * @disturbed: frames of the model that met an event, up to the last cycle
 * @late: cycles since then
 * @met: cycles whose frame, or the one before, met an event
 * @wrong: values that a slave never had
 * @lost: cycles in which a slave's value, or a working counter, was missing, without such a frame
 * @flown: likewise, with one
 * @left: cycles in which a slave was not in OP
 * @absent: mask of slaves that no frame reaches: their last inputs hold
 */
struct ring {
	struct bus *b;
	struct cyc *c;
	u32 n;
	u8 *in[RING_MANY];
	u8 *out[RING_MANY];
	u8 value[RING_HISTORY];
	u64 disturbed;
	u32 late;
	u32 met;
	u32 wrong;
	u32 lost;
	u32 flown;
	u32 left;
	u64 absent;
};

struct ring *ring_new(struct kunit *test, struct bus *b);
void ring_run(struct ring *r, u32 n);
void ring_expect(struct ring *r, const char *after);
void ring_is_whole(struct ring *r, const char *after);
void ring_cable_of(struct bus *b, bool cut, u32 i, u32 n, u32 after_ns);
void ring_cable(struct bus *b, bool cut, u32 i);
u32 ring_next_cut(struct bus *b, u32 at, bool is_cut, u32 other);
void ring_state(struct bus *b, u8 state, u32 front, u32 n);
void ring_closed(struct bus *b, u32 n);
void ring_open(struct bus *b, u32 front);
void ring_map_like(struct cyc *c, u32 config, const struct ec_slave *like);

#endif
