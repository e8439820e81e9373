/* SPDX-License-Identifier: GPL-2.0-only */
/* An application in the kernel: all it does goes through the exported functions. */
#ifndef EC_KAPP_H
#define EC_KAPP_H

#include "bus.h"
#include "include/ecrt.h"

/**
 * struct kapp - an application
 * @b: bus
 * @m: master it has requested
 * @d: domain
 * @sc: configurations by ring position
 * @out: of each configuration: offset of its outputs in @d, ~0: none
 * @in: the same for inputs
 * @period_ns: of its cycle
 * @kernel: the kernel runs the cycle
 * @next: when the next cycle begins (ktime)
 * @each: called between receive and send, may be NULL
 * @incomplete: cycles in which not all slaves took part
 */
struct kapp {
	struct bus *b;
	ec_master_t *m;
	ec_domain_t *d;
	ec_slave_config_t *sc[8];
	u32 out[8];
	u32 in[8];
	u64 period_ns;
	bool kernel;
	ktime_t next;
	void (*each)(struct kapp *k);
	u64 incomplete;
};

struct kapp *kapp_new(struct bus *b, u32 period_us);
void kapp_kernel_cycle(struct kapp *k, ec_cycle_config_t cycle);
ec_slave_config_t *kapp_config(struct kapp *k, u32 position);
void kapp_map(struct kapp *k, u32 position);
void kapp_activate(struct kapp *k);
void kapp_wait(struct kapp *k);
int kapp_exchange(struct kapp *k);
void kapp_run(struct kapp *k, u32 cycles);
bool kapp_all_op(struct kapp *k);
void kapp_op(struct kapp *k);

#endif
