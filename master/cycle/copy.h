/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Slave-to-slave communication through the master: input bits of one slave
 * become output bits of another, in the same cycle, without the application.
 */
#ifndef EC_COPY_H
#define EC_COPY_H

#include <linux/types.h>

struct ec_cycle;

/**
 * struct ec_copy - one copy, as configured
 * @from_domain: domain with the inputs
 * @from_bit: bit in it
 * @to_domain: domain with the outputs
 * @to_bit: bit in it
 * @bits: how many
 */
struct ec_copy {
	u32 from_domain;
	u32 from_bit;
	u32 to_domain;
	u32 to_bit;
	u32 bits;
};

int ec_copy_add(struct ec_cycle *c, const struct ec_copy *copy);
int ec_copies_begin(struct ec_cycle *c);
void ec_copies_end(struct ec_cycle *c);
void ec_copies_run(struct ec_cycle *c);

#endif
