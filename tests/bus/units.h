/* SPDX-License-Identifier: GPL-2.0-only */
/* An application with sync units; each of its outputs counts cycles. */
#ifndef EC_TEST_UNITS_H
#define EC_TEST_UNITS_H

#include "kcyc.h"

#define UNITS_BITS	32	/* outputs and inputs of a slave */

u32 units_new(struct bus *b, const char *name, u32 policy, u32 flags);
u32 units_create(struct bus *b, struct ec_ioc_unit u, const char *name);
void units_put(struct bus *b, u32 domain, u32 unit);
u32 units_state(struct bus *b, u32 unit);
int units_authority(struct bus *b, u32 unit, u32 give);
u32 units_out(struct bus *b, u32 slave);
void units_dead(struct bus *b, u32 slave, bool dead);
struct bus *units_bus(struct kunit *test, u32 slaves);
struct bus *units_ring(struct kunit *test, u32 slaves);
struct cyc *units_app(struct bus *b, u32 domains, u32 each);
u32 units_events(struct bus *b, u64 *from);
struct kcyc *units_kernel(struct bus *b, u32 domains, u32 each, struct ec_ioc_cycle cfg);
void units_begin(struct kcyc *a);
void units_give(struct kcyc *a, u32 value, u64 domains);

#endif
