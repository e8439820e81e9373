// SPDX-License-Identifier: GPL-2.0-only
/* Cycle statistics: send deviations, execution times, the thread of a kernel cycle. */
#include <string.h>

#include "cycle_text.h"
#include "out.h"

#define BAR	40	/* length of the longest */

/* one row of the histogram: buckets that are shown together */
struct row {
	unsigned int first;
	unsigned int count;
};

static u64 row_to(const struct row *r)
{
	return ect_bucket_ns(r->first + r->count) - 1;
}

static u64 sends_of(const struct ect_cycle *st, const struct row *r)
{
	u64 sum = 0;

	for (unsigned int i = 0; i < r->count; i++)
		sum += st->late[r->first + i];
	return sum;
}

/* rows of @step buckets from the first to the last that is not empty */
static void bars(const struct ect_cycle *st, unsigned int step)
{
	struct row r = { .count = step }, first = r, last = r;
	unsigned long long most = 0, n;

	for (r.first = 0; r.first < ECT_BUCKETS; r.first += step) {
		n = sends_of(st, &r);
		if (n && !most)
			first = r;
		if (n)
			last = r;
		most = max(most, n);
	}
	if (!most)
		return;
	out_text("      from [us]         to      sends\n");
	for (r = first; r.first <= last.first; r.first += step) {
		char bar[BAR + 1];
		size_t len;

		n = sends_of(st, &r);
		/* one send of a million is visible as well */
		len = (size_t)((n * BAR + most - 1) / most);
		memset(bar, '#', len);
		bar[len] = 0;
		out_text("    %11.3f %10.3f %10llu%s%s\n", (double)ect_bucket_ns(r.first) / 1000,
			 (double)row_to(&r) / 1000, n, len ? "  " : "", bar);
	}
}

static void histogram(const struct ect_cycle *st, unsigned int step)
{
	struct row r = { .count = 1 };

	out_array("histogram");
	for (; r.first < ECT_BUCKETS; r.first++) {
		if (!st->late[r.first])
			continue;
		out_object(NULL);
		out_u("from_ns", ect_bucket_ns(r.first), NULL);
		out_u("to_ns", row_to(&r), NULL);
		out_u("sends", st->late[r.first], NULL);
		out_end();
	}
	out_end();
	if (!out_is_json())
		bars(st, step);
}

static void figures(const struct ect_cycle *st)
{
	const struct row all = { .count = ECT_BUCKETS };
	unsigned long long sends = sends_of(st, &all), p999 = ect_cycle_quantile(st, 999);
	double mean = st->late_count ? (double)st->late_sum / (double)st->late_count : 0;

	out_u("sends", sends, "  Sends: %llu\n", sends);
	out_u("overruns", st->overruns, "  Overruns: %llu\n",
	      (unsigned long long)st->overruns);
	out_u("missed", st->missed, NULL);
	if (st->missed)
		out_text("  Without new outputs: %llu\n", (unsigned long long)st->missed);
	out_u("late_min_ns", st->late_min, "  Send deviation [us]: min %.3f",
	      st->late_min / 1000.0);
	out_f("late_mean_ns", mean, ", mean %.3f", mean / 1000);
	out_u("late_p999_ns", p999, ", 99.9 %% %.3f", (double)p999 / 1000);
	out_u("late_max_ns", st->late_max, ", max %.3f\n", st->late_max / 1000.0);
}

/* how long a cycle of the kernel takes */
static void work(const struct ect_cycle *st)
{
	double mean;

	if (!st->work_count)
		return;
	mean = (double)st->work_sum / (double)st->work_count;
	out_f("work_mean_ns", mean, "  Cycle execution time [us]: mean %.3f", mean / 1000);
	out_u("work_max_ns", st->work_max, ", max %.3f\n", st->work_max / 1000.0);
}

static void who(const struct ect_cycle *i)
{
	const char *name = cycle_by(i);

	if (i->kind == ECT_CYCLE_BY_NOBODY) {
		out_str("by", name, "  Cycle: none yet\n");
		return;
	}
	out_str("by", name, "  Cycle: run by the %s, ", name);
	out_str("state", cycle_state(i), "%s\n", cycle_state(i));
	out_u("interval_ns", i->interval_ns, "  Interval: %.3f us (", i->interval_ns / 1000.0);
	out_bool("interval_configured", i->interval_set, "%s)\n", i->interval_set ? "configured" : "measured");
}

/* of a kernel cycle that is configured to run in an interrupt: where it runs */
static void place(const struct ect_cycle *i)
{
	static const char *const text[] = {
		[ECT_PLACE_THREAD] = "thread",
		[ECT_PLACE_INTERRUPT] = "interrupt",
		[ECT_PLACE_RIGHT] = "thread; interrupt not permitted",
		[ECT_PLACE_DEVICE] = "thread; the device needs it",
		[ECT_PLACE_LONG] = "thread; the interrupt left too little time to others",
		[ECT_PLACE_CPU] = "thread; the CPU is offline",
		[ECT_PLACE_DEBUG] = "thread; frames are printed",
		[ECT_PLACE_QUIET] = "thread; no frames are sent",
	};
	const char *is = i->place < ARRAY_SIZE(text) ? text[i->place] : "unknown";

	if (!i->active)
		return;
	out_bool("interrupt", i->place == ECT_PLACE_INTERRUPT, NULL);
	out_str("place", is, NULL);
	if (i->place != ECT_PLACE_THREAD)
		out_text("  Runs in: %s\n", is);
}

/* of a cycle run by the kernel */
static void thread(const struct ect_cycle *i)
{
	out_text("  Thread: ");
	if (i->priority)
		out_text("SCHED_FIFO %u", i->priority);
	else
		out_text("SCHED_OTHER");
	if (i->priority < i->priority_wanted)
		out_text(" (SCHED_FIFO %u not permitted)", i->priority_wanted);
	if (i->cpu < 0)
		out_text(", any CPU\n");
	else
		out_text(", CPU %d, offline %u time(s)\n", i->cpu, i->cpu_losses);
	out_u("priority", i->priority, NULL);
	out_u("priority_wanted", i->priority_wanted, NULL);
	out_i("cpu", i->cpu, NULL);
	out_u("cpu_losses", i->cpu_losses, NULL);
}

static int show(const struct tool *t, struct dev *d)
{
	struct ect_cycle c = { .struct_size = sizeof(c) };
	int err = ect_cycle_read(d->h, &c);

	if (err)
		return dev_fail(d, err, "Master%u: cannot read cycle statistics", d->master);
	out_object(NULL);
	out_u("master", d->master, "Master%u\n", d->master);
	who(&c);
	if (c.kind == ECT_CYCLE_BY_KERNEL) {
		thread(&c);
		place(&c);
	}
	if (c.kind != ECT_CYCLE_BY_NOBODY) {
		figures(&c);
		work(&c);
		histogram(&c, t->verbosity > 0 ? 1 : 8);
	}
	out_end();
	err = t->reset ? ect_cycle_reset(d->h) : 0;
	return err ? dev_fail(d, err, "Master%u: cannot reset cycle statistics", d->master) : 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	out_array("masters");
	ret = dev_each(t, t->reset, show);
	out_end();
	return ret;
}

const struct cmd cmd_cycle = {
	.name = "cycle",
	.run = run,
	.args = "",
	.opts = "mrv",
	.summary = "Show cycle statistics: send deviation and overruns",
	.help = "Shows the running cycle, otherwise the last one. Send deviation: time of a send minus\n"
		"its schedule. The schedule of a cycle run by the kernel is its timer; for an\n"
		"application it is a grid of its interval that adapts slowly to the sends, so a send\n"
		"may be early or late. Overruns are skipped cycles: an interval or more passed without\n"
		"a send. 99.9 %: limit that 99.9 % of the send deviations did not exceed, up to 1/8\n"
		"too large. Each bar covers a power of two, with --verbose an eighth of it. --reset\n"
		"clears the statistics; it needs write access.\n",
	.json = "masters[]: master, by (nobody, application, kernel), state (running, stalled,\n"
		"stopped, waiting, ended), interval_ns, interval_configured, sends, overruns,\n"
		"missed (cycles of the kernel without new outputs), late_min_ns, late_mean_ns,\n"
		"late_p999_ns, late_max_ns (send deviation), work_mean_ns, work_max_ns (execution time\n"
		"of a cycle of the kernel), histogram[] (from_ns, to_ns, sends; without empty ranges).\n"
		"Only by kernel: priority (SCHED_FIFO; 0: SCHED_OTHER), priority_wanted (configured),\n"
		"cpu (-1: any), cpu_losses (times the CPU went offline); while it runs, interrupt (it\n"
		"runs in the interrupt of its timer), place (where, and why). By nobody: only master and\n"
		"by",
};
