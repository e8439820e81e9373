/* SPDX-License-Identifier: GPL-2.0-only */
/* Commands of the application for transitions of the drive of replay.h. */
#ifndef EC_TEST_STEP_COMMAND_H
#define EC_TEST_STEP_COMMAND_H

#include "replay.h"
#include "master/boundary/ioctl.h"

#define RAM	0x0f80	/* registers that the chip does not use */
#define STEP(from, to)	EC_TRANSITION(EC_AL_##from, EC_AL_##to)
#define PUT	EC_COMMAND_FLAG_WRITE
#define CHECK	EC_COMMAND_FLAG_CHECK

struct command {
	u8 step, kind;
	u16 index;
	u8 sub;
	u32 flags, bytes, timeout_ms;
	u64 data, expect, mask;
};

static inline int add_command(struct cyc *c, struct command x)
{
	u8 values[24];
	struct ec_ioc_sc_command i = {
		.flags = x.flags, .from = EC_TRANSITION_FROM(x.step), .to = x.step & 0xf,
		.kind = x.kind, .index = x.index, .subindex = x.sub, .timeout_ms = x.timeout_ms,
		.data = (uintptr_t)values,
	};

	if (x.flags & PUT) {
		memcpy(values, &x.data, x.bytes);
		i.size += x.bytes;
	}
	if (x.flags & CHECK) {
		memcpy(values + i.size, &x.expect, x.bytes);
		memcpy(values + i.size + x.bytes, &x.mask, x.bytes);
		i.size += 2 * x.bytes;
	}
	return ec_ioc(&c->b->app, EC_IOC_SC_COMMAND, &i);
}

static inline void must_add(struct cyc *c, struct command x)
{
	KUNIT_ASSERT_EQ_MSG(c->b->test, add_command(c, x), 0, "%s", c->b->app.reason);
}

static inline u8 *ram(struct bus *b)
{
	return &bus_esc(b, DRIVE)->mem[RAM];
}

/* A session in OP whose slave has a register for each of @steps, up to one that is 0. */
static inline struct cyc *in_op_with(struct cyc *c, const u8 *steps)
{
	u32 i;

	for (i = 0; steps[i]; i++)
		must_add(c, (struct command){ .step = steps[i], .kind = EC_REQUEST_REG,
					      .index = RAM + i, .flags = PUT, .bytes = 1,
					      .data = 0xa0 + i });
	replay_into_op(c);
	return c;
}

#endif
