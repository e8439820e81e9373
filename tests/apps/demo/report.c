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
	if (d->n_di && d->n_do)
		v[n++] = (struct verdict){ !d->do_mismatches,
					   "digital outputs follow" };
	if (d->ai.bits)
		v[n++] = (struct verdict){ d->ai_max > d->ai_min,
					   "analog input moves" };
	if (d->ai.bits && d->ao.bits)
		v[n++] = (struct verdict){ !d->ao_mismatches,
					   "analog output follows" };
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

static void histogram(const struct demo *d)
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
		printf("  %18s %8u |%.*s\n", name, d->buckets[i],
		       (int)((unsigned long long)d->buckets[i] * BAR / max),
		       "##################################################");
	}
}

/* Samples that hold about two turns of the input. */
static unsigned int plot_width(const struct demo *d)
{
	int mean = (d->ai_min + d->ai_max) / 2;
	unsigned int i, crossings = 0, width;

	for (i = 1; i < d->done; i++)
		crossings += (d->in[i - 1] < mean) != (d->in[i] < mean);
	if (crossings < 4)
		return d->done;
	width = (unsigned int)(4ULL * d->done / crossings);
	return width < d->done ? width : d->done;
}

static int row_of(const struct demo *d, int value)
{
	int row = (value - d->ai_min) * (ROWS - 1) / (d->ai_max - d->ai_min);

	return row < 0 ? 0 : row >= ROWS ? ROWS - 1 : row;
}

static void plot(const struct demo *d)
{
	char grid[ROWS][COLUMNS + 1];
	unsigned int width = plot_width(d), x, i;
	char *cell;
	int y;

	if (d->ai_max <= d->ai_min || !width)
		return;
	memset(grid, ' ', sizeof(grid));
	for (x = 0; x < COLUMNS; x++) {
		i = (unsigned int)((unsigned long long)x * width / COLUMNS);
		grid[row_of(d, d->in[i])][x] = 'i';
		cell = &grid[row_of(d, d->out[i])][x];
		*cell = *cell == 'i' ? '*' : 'o';
	}
	printf("\nAnalog input (i) and output (o), * where they meet, %u cycles:\n",
	       width);
	for (y = ROWS - 1; y >= 0; y--)
		printf("  %7d |%.*s\n", d->ai_min + (d->ai_max - d->ai_min) *
		       y / (ROWS - 1), COLUMNS, grid[y]);
}

static void axes(const struct demo *d)
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
	printf("Working counter errors: %u, lost frames: %llu, periods left out: %u, failed calls: %u\n",
	       d->wc_errors, d->lost, d->overruns, d->call_errors);
	histogram(d);
	plot(d);
	printf("\nDigital: %u inputs, %u outputs, %u changes, %u mismatches\n",
	       d->n_di, d->n_do, d->di_changes, d->do_mismatches);
	if (d->ai.bits)
		printf("Analog: %d..%d, %u mismatches, asked of the slave: %u same, %u other%s\n",
		       d->ai_min, d->ai_max, d->ao_mismatches, d->rb.same,
		       d->rb.other, d->rb.unavailable ? ", then no answer" : "");
	axes(d);
	printf("\n");
	for (i = 0; i < n; i++)
		printf("%s %s\n", v[i].ok ? "ok    " : "FAILED", v[i].what);
}

void report_json(const struct demo *d)
{
	const struct axis *a;
	const char *comma = "";
	struct verdict v[16];
	unsigned int i, n = verdicts(d, v);

	printf("{\"slaves\": %u, \"operational\": %u, \"startup_s\": %.3f, ",
	       d->slaves, d->operational, d->startup_s);
	printf("\"cycles\": %u, \"period_us\": %u, \"fifo\": %s, \"locked\": %s, ",
	       d->done, d->period_us, d->fifo ? "true" : "false",
	       d->locked ? "true" : "false");
	printf("\"wc_errors\": %u, \"frames_lost\": %llu, \"overruns\": %u, \"call_errors\": %u, ",
	       d->wc_errors, d->lost, d->overruns, d->call_errors);
	printf("\"late_mean_us\": %.3f, \"late_max_us\": %.3f, \"late_log2_us\": [",
	       d->done ? d->late_sum_us / d->done : 0, d->late_max_us);
	for (i = 0; i < BUCKETS; i++)
		printf("%s%u", i ? ", " : "", d->buckets[i]);
	printf("], \"digital\": {\"inputs\": %u, \"outputs\": %u, \"changes\": %u, \"mismatches\": %u}, ",
	       d->n_di, d->n_do, d->di_changes, d->do_mismatches);
	printf("\"analog\": {\"present\": %s, \"min\": %d, \"max\": %d, \"mismatches\": %u, \"readback_same\": %u, \"readback_other\": %u}, ",
	       d->ai.bits ? "true" : "false", d->ai.bits ? d->ai_min : 0,
	       d->ai.bits ? d->ai_max : 0, d->ao_mismatches, d->rb.same,
	       d->rb.other);
	printf("\"axes\": [");
	for (i = 0; i < d->n_axes; i++) {
		a = &d->axes[i];
		printf("%s{\"slave\": %u, \"mode\": \"%s\", \"enabled\": %s, \"min\": %d, \"max\": %d, \"position\": %d, \"expected\": %.0f, \"correlation\": %.4f, \"fault_cycles\": %u}",
		       i ? ", " : "", a->position,
		       a->target_pos.bits ? "csp" : "csv",
		       a->c.n > 0 ? "true" : "false", a->min, a->max, a->last,
		       a->expected, axis_correlation(a), a->faults);
	}
	printf("], \"failed\": [");
	for (i = 0; i < n; i++) {
		if (v[i].ok)
			continue;
		printf("%s\"%s\"", comma, v[i].what);
		comma = ", ";
	}
	printf("], \"passed\": %s}\n", demo_passed(d) ? "true" : "false");
}
