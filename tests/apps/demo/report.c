// SPDX-License-Identifier: LGPL-2.1-or-later
/* Results, as text and as JSON. */
#include "demo.h"

#include <stdio.h>
#include <string.h>

#define COLUMNS	72
#define ROWS	13
#define BAR	50

#define IN_FLIGHT	16	/* frames that one standstill can lose */

/* @still: not ok, and a machine that stood still explains all of it */
struct verdict {
	bool ok;
	bool still;
	const char *what;
};

static void add(struct verdict *v, unsigned int *n, bool ok, bool still, const char *what)
{
	v[(*n)++] = (struct verdict){ ok, !ok && still, what };
}

static void add_frames(const struct demo *d, struct verdict *v, unsigned int *n)
{
	add(v, n, d->lost_known && !d->lost && !d->call_errors,
	    d->lost_known && d->lost <= (unsigned long long)IN_FLIGHT * still_count() &&
	    d->call_errors == d->call_still, "no frame lost, no call failed");
	add(v, n, !d->wc_errors, d->wc_errors == d->wc_still, "no working counter error");
}

static unsigned int verdicts(const struct demo *d, struct verdict *v)
{
	const bool still = d->excuse && still_count();
	bool followed = true;
	unsigned int i, n = 0;

	for (i = 0; i < d->n_axes; i++)
		followed &= axis_followed(&d->axes[i]);
	add(v, &n, d->all_op, d->end_still, "all slaves in OP");
	add(v, &n, d->done == d->cycles && d->done, false, "all cycles done");
	add_frames(d, v, &n);
	if (d->n_di && d->n_do)
		add(v, &n, !d->do_mismatches, false, "digital outputs hold what was written");
	if (d->wired)
		add(v, &n, trace_followed(&d->digital, false), trace_followed(&d->digital, true),
		    "digital input comes back from the output");
	if (d->ai.bits && d->ao.bits)
		add(v, &n, !d->ao_mismatches, false, "analog output holds what was written");
	if (d->wired)
		add(v, &n, trace_followed(&d->analog, false), trace_followed(&d->analog, true),
		    "analog input comes back from the output");
	if (d->rb.same + d->rb.other)
		add(v, &n, !d->rb.other, false, "analog output is what the slave says");
	if (d->n_axes) {
		add(v, &n, d->axes_enabled, d->end_still, "axes enabled");
		add(v, &n, followed, true, "axes follow");
	}
	for (i = 0; i < n; i++)
		v[i].still &= still;
	return n;
}

bool demo_passed(const struct demo *d)
{
	struct verdict v[16];
	unsigned int n = verdicts(d, v);

	while (n--)
		if (!v[n].ok && !v[n].still)
			return false;
	return true;
}

static void bucket_name(char *s, size_t size, unsigned int i)
{
	if (i)
		snprintf(s, size, "%u..%u us", 1u << (i - 1), 1u << i);
	else
		snprintf(s, size, "below 1 us");
}

static void bar(const char *name, unsigned int n, unsigned int max)
{
	printf("  %18s %8u |%.*s\n", name, n,
	       (int)((unsigned long long)n * BAR / max),
	       "##################################################");
}

static void period_name(const struct demo *d, char *s, size_t size,
			unsigned int i)
{
	double us = d->period_us / 100.0;

	if (!i)
		snprintf(s, size, "below %.0f us", period_edges[0] * us);
	else if (i == PERIODS - 1)
		snprintf(s, size, "%.0f us and more", period_edges[i - 1] * us);
	else
		snprintf(s, size, "%.0f..%.0f us", period_edges[i - 1] * us,
			 period_edges[i] * us);
}

static void cycle_time(const struct demo *d)
{
	unsigned int i, max = 1;
	char name[40];

	for (i = 0; i < PERIODS; i++)
		max = d->periods[i] > max ? d->periods[i] : max;
	printf("\nCycle time (set %u us, min %.1f, max %.1f):\n", d->period_us,
	       d->period_min_us, d->period_max_us);
	for (i = 0; i < PERIODS; i++) {
		period_name(d, name, sizeof(name), i);
		bar(name, d->periods[i], max);
	}
}

static void lateness(const struct demo *d)
{
	unsigned int i, max = 1, last = 0;
	char name[32];

	for (i = 0; i < BUCKETS; i++) {
		max = d->buckets[i] > max ? d->buckets[i] : max;
		last = d->buckets[i] ? i : last;
	}
	printf("\nCycle begins late by (mean %.1f us, max %.1f us):\n",
	       d->done ? d->late_sum_us / d->done : 0, d->late_max_us);
	for (i = 0; i <= last; i++) {
		bucket_name(name, sizeof(name), i);
		bar(name, d->buckets[i], max);
	}
}

/* Samples that hold about two turns of the input. */
static unsigned int plot_width(const struct trace *t)
{
	int mean = (t->min + t->max) / 2;
	unsigned int i, crossings = 0, width;

	for (i = 1; i < t->count; i++)
		crossings += (t->sent[i - 1] < mean) != (t->sent[i] < mean);
	if (crossings < 4)
		return t->count;
	width = (unsigned int)(4ULL * t->count / crossings);
	return width < t->count ? width : t->count;
}

static int row_of(const struct trace *t, int value)
{
	int row = (value - t->min) * (ROWS - 1) / (t->max - t->min);

	return row < 0 ? 0 : row >= ROWS ? ROWS - 1 : row;
}

static void plot(const struct demo *d)
{
	const struct trace *t = &d->analog;
	char grid[ROWS][COLUMNS + 1];
	unsigned int width = plot_width(t), x, i;
	char *cell;
	int y;

	if (t->max <= t->min || !width)
		return;
	memset(grid, ' ', sizeof(grid));
	for (x = 0; x < COLUMNS; x++) {
		i = (unsigned int)((unsigned long long)x * width / COLUMNS);
		grid[row_of(t, t->sent[i])][x] = 'i';
		cell = &grid[row_of(t, t->seen[i])][x];
		*cell = *cell == 'i' ? '*' : 'o';
	}
	printf("\nAnalog input (i) and output%s (o), * where they meet, %u cycles:\n",
	       d->wired ? " measured at input 2" : "", width);
	for (y = ROWS - 1; y >= 0; y--)
		printf("  %7d |%.*s\n", t->min + (t->max - t->min) *
		       y / (ROWS - 1), COLUMNS, grid[y]);
}

static void way_back(const char *what, const struct trace *t)
{
	printf("%s output measured: %u cycles behind the input, %u of %u values off by more than 2 %%, by %u at most\n",
	       what, t->lag, t->off, t->count, t->worst);
}

static void axes_text(const struct demo *d)
{
	const struct axis *a;

	for (a = d->axes; a < d->axes + d->n_axes; a++)
		printf("Axis at slave %u: %s, %s, reached %d..%d, now %d, expected %.0f, correlation %.3f\n",
		       a->position,
		       a->target_pos.bits ? "position" : "velocity",
		       a->c.n > 0 ? "enabled" : "never enabled", a->min, a->max,
		       a->last, a->expected, axis_correlation(a));
}

/* What the checks say of the master, and what of the machine. */
static void verdicts_text(const struct demo *d)
{
	struct verdict v[16];
	unsigned int i, n = verdicts(d, v), still = 0;

	printf("\n");
	for (i = 0; i < n; i++) {
		printf("%s %s\n", v[i].ok ? "ok    " : v[i].still ? "still " : "FAILED", v[i].what);
		still += v[i].still;
	}
	if (!d->excuse)
		return;
	if (still_count())
		printf("The machine stood still %u time(s), for up to %.0f ms:\n"
		       "a CPU ran no thread, not even of the highest priority.\n",
		       still_count(), still_longest_ms());
	if (still)
		printf("%u check(s), marked 'still', missed at these times only. That is no failure\n"
		       "of the master: a virtual machine whose host is busy stands still. Try again\n"
		       "on an idle host.\n", still);
}

void report_text(const struct demo *d)
{

	printf("Slaves: %u, in OP: %u, after %.2f s\n", d->slaves,
	       d->operational, d->startup_s);
	printf("Cycles: %u of %u, every %u us, %s, memory %s\n", d->done,
	       d->cycles, d->period_us, d->fifo ? "SCHED_FIFO" :
	       "normal priority (SCHED_FIFO not permitted)",
	       d->locked ? "locked" : "not locked");
	printf("Working counter errors: %u, lost frames: %llu, skipped cycles: %u, failed calls: %u\n",
	       d->wc_errors, d->lost, d->overruns, d->call_errors);
	cycle_time(d);
	lateness(d);
	plot(d);
	printf("\nDigital: %u inputs, %u outputs, %u changes, %u mismatches\n",
	       d->n_di, d->n_do, d->di_changes, d->do_mismatches);
	if (d->ai.bits)
		printf("Analog: %d..%d, %u mismatches, asked of the slave: %u same, %u other%s\n",
		       d->analog.min, d->analog.max, d->ao_mismatches,
		       d->rb.same, d->rb.other,
		       d->rb.unavailable ? ", then no answer" : "");
	if (d->wired) {
		way_back("Digital", &d->digital);
		way_back("Analog", &d->analog);
	}
	axes_text(d);
	verdicts_text(d);
}

static void json_trace(const char *name, const struct trace *t)
{
	printf("\"%s_back\": {\"min\": %d, \"max\": %d, \"lag\": %u, \"off\": %u, \"worst\": %u}, ",
	       name, t->count ? t->min : 0, t->count ? t->max : 0, t->lag,
	       t->off, t->worst);
}

static void json_cycle(const struct demo *d)
{
	unsigned int i;

	printf("\"cycles\": %u, \"period_us\": %u, \"fifo\": %s, \"locked\": %s, ",
	       d->done, d->period_us, d->fifo ? "true" : "false",
	       d->locked ? "true" : "false");
	printf("\"wc_errors\": %u, \"frames_lost\": %llu, \"overruns\": %u, \"call_errors\": %u, ",
	       d->wc_errors, d->lost, d->overruns, d->call_errors);
	printf("\"cycle_min_us\": %.3f, \"cycle_max_us\": %.3f, \"cycle_percent\": [",
	       d->period_min_us, d->period_max_us);
	for (i = 0; i < PERIODS; i++)
		printf("%s%u", i ? ", " : "", d->periods[i]);
	printf("], \"late_mean_us\": %.3f, \"late_max_us\": %.3f, \"late_log2_us\": [",
	       d->done ? d->late_sum_us / d->done : 0, d->late_max_us);
	for (i = 0; i < BUCKETS; i++)
		printf("%s%u", i ? ", " : "", d->buckets[i]);
	printf("], ");
}

static void json_axes(const struct demo *d)
{
	const struct axis *a;

	printf("\"axes\": [");
	for (a = d->axes; a < d->axes + d->n_axes; a++)
		printf("%s{\"slave\": %u, \"mode\": \"%s\", \"enabled\": %s, \"min\": %d, \"max\": %d, \"position\": %d, \"expected\": %.0f, \"correlation\": %.4f, \"fault_cycles\": %u}",
		       a > d->axes ? ", " : "", a->position,
		       a->target_pos.bits ? "csp" : "csv",
		       a->c.n > 0 ? "true" : "false", a->min, a->max, a->last,
		       a->expected, axis_correlation(a), a->faults);
	printf("], ");
}

void report_json(const struct demo *d)
{
	const char *comma = "";
	struct verdict v[16];
	unsigned int i, n = verdicts(d, v);

	printf("{\"slaves\": %u, \"operational\": %u, \"startup_s\": %.3f, ",
	       d->slaves, d->operational, d->startup_s);
	json_cycle(d);
	printf("\"digital\": {\"inputs\": %u, \"outputs\": %u, \"changes\": %u, \"mismatches\": %u}, ",
	       d->n_di, d->n_do, d->di_changes, d->do_mismatches);
	printf("\"analog\": {\"present\": %s, \"mismatches\": %u, \"readback_same\": %u, \"readback_other\": %u}, ",
	       d->ai.bits ? "true" : "false", d->ao_mismatches, d->rb.same,
	       d->rb.other);
	if (d->wired) {
		json_trace("digital", &d->digital);
		json_trace("analog", &d->analog);
	}
	json_axes(d);
	if (d->excuse)
		printf("\"standstills\": %u, \"standstill_max_ms\": %.1f, ", still_count(),
		       still_longest_ms());
	printf("\"failed\": [");
	for (i = 0; i < n; i++) {
		if (v[i].ok || v[i].still)
			continue;
		printf("%s\"%s\"", comma, v[i].what);
		comma = ", ";
	}
	printf("], \"passed\": %s}\n", demo_passed(d) ? "true" : "false");
}
