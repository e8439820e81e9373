// SPDX-License-Identifier: LGPL-2.1-or-later
/* Results, as text and as JSON. */
#include "demo.h"

#include <stdio.h>
#include <string.h>

#define COLUMNS	72
#define ROWS	13
#define BAR	50

struct verdict {
	bool ok;
	const char *what;
};

static unsigned int verdicts(const struct demo *d, struct verdict *v)
{
	bool followed = true;
	unsigned int i, n = 0;

	for (i = 0; i < d->n_axes; i++)
		followed &= axis_followed(&d->axes[i]);
	v[n++] = (struct verdict){ d->all_op, "all slaves in OP" };
	v[n++] = (struct verdict){ d->done == d->cycles && d->done,
				   "all cycles done" };
	v[n++] = (struct verdict){ d->lost_known && !d->lost && !d->call_errors,
				   "no frame lost, no call failed" };
	v[n++] = (struct verdict){ !d->wc_errors, "no working counter error" };
	if (d->n_di && d->n_do)
		v[n++] = (struct verdict){ !d->do_mismatches,
					   "digital outputs hold what was written" };
	if (d->wired)
		v[n++] = (struct verdict){ trace_followed(&d->digital),
					   "digital input comes back from the output" };
	if (d->ai.bits && d->ao.bits)
		v[n++] = (struct verdict){ !d->ao_mismatches,
					   "analog output holds what was written" };
	if (d->wired)
		v[n++] = (struct verdict){ trace_followed(&d->analog),
					   "analog input comes back from the output" };
	if (d->rb.same + d->rb.other)
		v[n++] = (struct verdict){ !d->rb.other,
					   "analog output is what the slave says" };
	if (d->n_axes) {
		v[n++] = (struct verdict){ d->axes_enabled, "axes enabled" };
		v[n++] = (struct verdict){ followed, "axes follow" };
	}
	return n;
}

bool demo_passed(const struct demo *d)
{
	struct verdict v[16];
	unsigned int n = verdicts(d, v);

	while (n--)
		if (!v[n].ok)
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

void report_text(const struct demo *d)
{
	struct verdict v[16];
	unsigned int i, n = verdicts(d, v);

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
	printf("\n");
	for (i = 0; i < n; i++)
		printf("%s %s\n", v[i].ok ? "ok    " : "FAILED", v[i].what);
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
	printf("\"failed\": [");
	for (i = 0; i < n; i++) {
		if (v[i].ok)
			continue;
		printf("%s\"%s\"", comma, v[i].what);
		comma = ", ";
	}
	printf("], \"passed\": %s}\n", demo_passed(d) ? "true" : "false");
}
