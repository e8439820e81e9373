/* SPDX-License-Identifier: GPL-2.0-only */
/* AL states: read, request, poll until they are reached. */
#ifndef EC_BUS_AL_H
#define EC_BUS_AL_H

#include <linux/types.h>

struct ec_dg;
struct ec_slave;

extern unsigned int ec_al_timeout;	/* ms, 0: by transition: state_timeout_ms of the module */

/**
 * struct ec_al_poll - one of the slaves that are polled together
 * @slave: slave
 * @ret: result; -EINPROGRESS before
 * @al: reply, registers 0x0130 to 0x0135
 */
struct ec_al_poll {
	struct ec_slave *slave;
	int ret;
	u8 al[6];
};

/**
 * struct ec_al_goal - what they are polled for
 * @mask: bits of the AL status
 * @value: of these bits
 * @first_us: until the first poll
 * @until_ns: time limit (ktime)
 */
struct ec_al_goal {
	u16 mask;
	u16 value;
	unsigned int first_us;
	u64 until_ns;
};

int ec_al_read(struct ec_slave *slave);
int ec_al_ack(struct ec_slave *slave);
int ec_al_set(struct ec_slave *slave, u8 state, u32 timeout_ms);
void ec_al_poll(struct ec_al_poll *polls, unsigned int n, struct ec_dg *dg,
		const struct ec_al_goal *goal);

#endif
