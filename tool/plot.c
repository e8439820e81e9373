// SPDX-License-Identifier: GPL-2.0-only
#include "plot.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "tool.h"

#define LABELS_MAX	32

static double time_at(const struct plot_view *v, size_t row)
{
	return v->time ? v->time[row] : (double)row;
}

/* Of those that are finite, and so that their distance is; false: there is none. */
static bool range(const double *v, size_t n, double *min, double *max)
{
	*min = INFINITY;
	*max = -INFINITY;
	for (size_t i = 0; i < n; i++)
		if (isfinite(v[i])) {
			*min = fmin(*min, v[i]);
			*max = fmax(*max, v[i]);
		}
	if (*min > *max)
		return false;
	*min = fmax(fmin(*min, DBL_MAX / 4), -DBL_MAX / 4);
	*max = fmax(fmin(*max, DBL_MAX / 4), -DBL_MAX / 4);
	return true;
}

double plot_part(const struct plot_axis *a, double value)
{
	double part = (value - a->min) / (a->max - a->min);

	return !(part > 0) ? 0 : fmin(part, 1);
}

void plot_view(const struct plot_data *p, struct plot_view *v)
{
	const struct plot_column *time = plot_find(p, "time_s"), *lost = plot_find(p, "lost");

	*v = (struct plot_view){
		.data = p, .time = time ? time->v : NULL, .lost = lost ? lost->v : NULL,
	};
	if (!p->rows)
		return;
	if (!v->time) {
		v->to = (double)(p->rows - 1);
	} else if (!range(v->time, p->rows, &v->from, &v->to)) {
		v->from = 0;
		v->to = 0;
	}
	if (!(v->to > v->from))
		v->to = v->from + fmax(1, fabs(v->from) / 10);
}

static size_t bin_at(const struct plot_view *v, size_t row, size_t n)
{
	const struct plot_axis a = { .min = v->from, .max = v->to };
	size_t at = (size_t)(plot_part(&a, time_at(v, row)) * (double)n);

	return at < n ? at : n - 1;
}

static void add(struct plot_bin *b, double value)
{
	b->min = b->any ? fmin(b->min, value) : value;
	b->max = b->any ? fmax(b->max, value) : value;
	b->last = value;
	b->any = true;
}

/* A value is valid until the next record, unless some are missing in between. */
void plot_bins(const struct plot_view *v, const struct plot_column *c, struct plot_bin *bins,
	       size_t n)
{
	size_t before = 0;

	for (size_t i = 0; i < n; i++)
		bins[i] = (struct plot_bin){ 0 };
	for (size_t row = 0; row < v->data->rows; row++) {
		size_t at = bin_at(v, row, n);
		bool gap = v->lost && v->lost[row] > 0;

		for (size_t i = before + 1; row && i < at; i++)
			if (gap)
				bins[i].gap = true;
			else
				add(&bins[i], bins[before].last);
		/* a step is drawn where it happens */
		if (row && !gap && at > before)
			add(&bins[at], bins[before].last);
		bins[at].gap |= gap;
		bins[at].lost += gap ? v->lost[row] : 0;
		add(&bins[at], c->v[row]);
		before = at;
	}
}

struct plot_axis plot_axis(double min, double max, unsigned int labels)
{
	double raw, unit;

	if (!(max > min)) {
		double around = fabs(min) > 1 ? fabs(min) / 10 : 1;

		min -= around;
		max += around;
	}
	raw = (max - min) / labels;
	unit = pow(10, floor(log10(raw)));
	for (unsigned int i = 0; i < 4; i++) {
		static const double steps[] = { 1, 2, 5, 10 };

		if (steps[i] * unit >= raw * 0.999)
			return (struct plot_axis){ min, max, steps[i] * unit };
	}
	return (struct plot_axis){ min, max, 10 * unit };
}

/* Values that are no numbers have no place. */
struct plot_axis plot_range(const struct plot_column *c, size_t rows, unsigned int labels)
{
	double min, max;

	if (c->flag || !range(c->v, rows, &min, &max))
		return (struct plot_axis){ 0, 1, 1 };
	return plot_axis(min, max, labels);
}

/* A step may be too small to change the number. */
bool plot_label(const struct plot_axis *a, unsigned int i, double *at)
{
	*at = (ceil(a->min / a->step - 1e-9) + i) * a->step;
	/* -0 is 0 */
	if (fabs(*at) < a->step / 2)
		*at = 0;
	return i < LABELS_MAX && *at <= a->max + a->step * 1e-9;
}
