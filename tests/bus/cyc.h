/* SPDX-License-Identifier: GPL-2.0-only */
/* An application with a cycle: what a program does through libethercat. */
#ifndef EC_CYC_H
#define EC_CYC_H

#include <linux/prandom.h>
#include "bus.h"
#include "master/config/config.h"
#include "master/config/domain.h"

/**
 * struct cyc_jitter - how late its cycles wake up, see cyc_shake()
 * @ns: half of the most, 0: never
 * @late_every: one of so many cycles wakes up at @late_ns, 0: none
 * @late_ns: after its time
 * @random: state
 */
struct cyc_jitter {
	u32 ns;
	u32 late_every;
	u64 late_ns;
	struct rnd_state random;
};

/**
 * struct cyc - an application
 * @b: bus
 * @period_ns: of its cycle
 * @next: when the next cycle begins (ktime)
 * @queued: domains sent in a cycle, bit n: domain n
 * @each: called between receive and send, may be NULL
 * @ctx: for @each
 * @flags: EC_SEND_FLAG_* of the next send
 * @app_time: for it, ns
 * @sync_time: for it, ns
 * @incomplete: cycles in which a domain was not complete
 * @cycles: cycles so far
 * @jitter: of its wake-ups
 */
struct cyc {
	struct bus *b;
	u64 period_ns;
	ktime_t next;
	u64 queued;
	void (*each)(struct cyc *c);
	void *ctx;
	u32 flags;
	u64 app_time;
	u64 sync_time;
	u64 incomplete;
	u64 cycles;
	struct cyc_jitter jitter;
};

/* mapping of a drive after cyc_remap() */
extern const u32 cyc_new_out[3];
extern const u32 cyc_new_in[4];

struct cyc *cyc_new(struct bus *b, u32 period_us);
u32 cyc_domain(struct cyc *c);
u32 cyc_config(struct cyc *c, u32 position);
void cyc_pdo(struct cyc *c, u32 config, u8 op, u8 sm, u16 pdo, u32 entry);
u32 cyc_map(struct cyc *c, u32 config, u8 sm, u32 domain);
void cyc_map_all(struct cyc *c, u32 first, u32 n, u32 domain);
void cyc_remap(struct cyc *c, u32 config);
void cyc_activate(struct cyc *c);
void cyc_run(struct cyc *c, u32 cycles);
struct cyc *cyc_in_op(struct bus *b, u32 first, u32 n);
struct cyc *cyc_two_domains(struct bus *b, u32 n);
void cyc_sync0(struct cyc *c, u32 n);
void cyc_shake(struct cyc *c, u32 ns, u32 late_every);
struct cyc *cyc_drives_of(struct kunit *test, u32 n, u32 period_us, s32 host_ppb);

static inline struct cyc *cyc_drives(struct kunit *test, u32 n, u32 period_us)
{
	return cyc_drives_of(test, n, period_us, 0);
}

u64 cyc_wait_op(struct cyc *c, u32 limit_ms);
bool cyc_all_op(struct cyc *c);
u8 cyc_config_status(struct bus *b, u32 config);
u8 *cyc_pd(struct cyc *c, u32 position, u8 sm);
u8 *cyc_data(struct cyc *c, u32 domain);
struct ec_status_domain *cyc_state(struct cyc *c, u32 domain);
void cyc_release(struct cyc *c);

#endif
