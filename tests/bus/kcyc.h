/* SPDX-License-Identifier: GPL-2.0-only */
/* An application whose cycle the kernel runs; a case is the library and it. */
#ifndef EC_KCYC_H
#define EC_KCYC_H

#include "cyc.h"
#include "master/cycle/cycle_thread.h"
#include "master/boundary/ioctl.h"

#define KCYC_PERIOD_NS	1000000
#define KCYC_CHANNELS	200	/* of 32 bits, each output wired to an input */

/**
 * struct kcyc - what the library has of an exchange
 * @c: configured application
 * @back: output buffer it holds
 * @front: input buffer it holds
 * @seen: last cycle
 * @taken_over: activation has found a detached session
 */
struct kcyc {
	struct cyc *c;
	u32 back;
	u32 front;
	u64 seen;
	bool taken_over;
};

struct bus *kcyc_bus(struct kunit *test);
struct kcyc *kcyc_configure(struct bus *b, struct ec_ioc_cycle cfg);
int kcyc_activate(struct kcyc *a);
void kcyc_until_op(struct kcyc *a);
struct kcyc *kcyc_start(struct kunit *test, struct ec_ioc_cycle cfg);

struct ec_shared *kcyc_shared(const struct kcyc *a);
struct ec_status_cycle *kcyc_status(const struct kcyc *a);
u8 *kcyc_outputs(const struct kcyc *a);
void kcyc_give(struct kcyc *a);
void kcyc_give_domains(struct kcyc *a, u64 domains);
struct ec_exchange_buffer *kcyc_take(struct kcyc *a);
int kcyc_wait(struct kcyc *a, u32 timeout_us);
void kcyc_wait_cycles(struct kcyc *a, u32 n);

u32 kcyc_place(struct kcyc *a, u32 slave, u32 sm, u32 channel);
s64 kcyc_output(struct kcyc *a, const char *slave, u32 channel);
void kcyc_write(struct kcyc *a, u32 number);

#endif
