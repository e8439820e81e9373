// SPDX-License-Identifier: GPL-2.0-only
/* The figures of a cycle for its readers. */
#include "../base/once64.h"
#include "cycle.h"
#include "cycle_stats.h"

/* Facts of a cycle beside its figures. */
static void describe(const struct ec_cycle *c, struct ec_ioc_cycle_stats *info)
{
	const struct ec_cycle_setup *s = &c->setup;
	bool kernel = s->kernel.period_ns;

	info->active = 1;
	info->kind = kernel ? EC_CYCLE_BY_KERNEL : EC_CYCLE_BY_APP;
	info->interval_set = kernel || c->links->access.interval_set;
	info->interval_ns = kernel ? s->kernel.period_ns :
				     READ_ONCE(c->late.schedule.interval_ns);
	info->cpu = kernel ? s->kernel.cpu : -1;
	info->place = kernel ? READ_ONCE(c->place) : EC_CYCLE_PLACE_THREAD;
	info->cpu_losses = c->watch.cpu_losses;
	info->priority = kernel ? s->priority : 0;
	info->stall = kernel ? s->kernel.stall : 0;
	info->priority_wanted = kernel ? s->kernel.priority ?: EC_CYCLE_PRIORITY : 0;
}

static void cycle_stats_copy(struct ec_cycle *c, struct ec_ioc_cycle_stats *info,
			     struct ec_status_cycle *st)
{
	/* figures about to be reset count as zero already */
	bool forgotten = smp_load_acquire(&c->late.reset);

	describe(c, info);
	ec_status_copy(c->shared->status, st, &c->shared->status->kernel, sizeof(*st));
	if (forgotten)
		ec_late_forget(st);
}

/**
 * ec_cycle_stats_end() - keep the figures of a cycle that ends
 * @c: cycle, active until now; its layout is not freed yet
 *
 * Context: Process, lock of the configuration held; the cycle does not run any more.
 */
void ec_cycle_stats_end(struct ec_cycle *c)
{
	struct ec_cycle_report *r = &c->cycles->report;

	lockdep_assert_held(c->wanted->lock);
	cycle_stats_copy(c, &r->info, &r->status);
	r->info.active = 0;
}

/**
 * ec_cycle_stats_get() - figures of the cycle that runs, else of the last one
 * @cycles: of the master
 * @info: filled but for @size and @data
 * @st: filled
 *
 * While the cycle runs it may be one send ahead in some of the figures.
 *
 * Context: Process, after ec_show_begin().
 */
void ec_cycle_stats_get(struct ec_cycles *cycles, struct ec_ioc_cycle_stats *info,
			struct ec_status_cycle *st)
{
	u64 data;

	if (cycles->active) {
		cycle_stats_copy(cycles->active, info, st);
		return;
	}
	data = info->data;
	*info = cycles->report.info;
	info->data = data;
	*st = cycles->report.status;
}

/**
 * ec_cycle_stats_reset() - set the figures to zero
 * @cycles: of the master
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_cycle_stats_reset(struct ec_cycles *cycles)
{
	ec_cycle_assert_held(cycles->active);
	if (cycles->active)
		WRITE_ONCE(cycles->active->late.reset, true);
	else
		ec_late_forget(&cycles->report.status);
}
