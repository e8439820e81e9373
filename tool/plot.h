/* SPDX-License-Identifier: GPL-2.0-only */
/* Drawings of a recording. */
#ifndef EC_TOOL_PLOT_H
#define EC_TOOL_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "plot_data.h"

/* one column of a drawing: what a value was in a part of the time */
struct plot_bin {
	bool any;	/* it has a record, or the value before it is still valid */
	bool gap;	/* records are missing in it, or between it and the one before */
	double min;
	double max;
	double last;
	double lost;	/* records that are missing before those in it */
};

/**
 * struct plot_view - the part of a recording that is drawn
 * @data: recording
 * @time: its times, in seconds; NULL: the number of the row is used
 * @lost: records missing before each row, NULL: it has none
 * @from: begin of the drawing
 * @to: its end, after @from
 */
struct plot_view {
	const struct plot_data *data;
	const double *time;
	const double *lost;
	double from;
	double to;
};

/* the range of an axis, a little more than the values, and the distance of its labels */
struct plot_axis {
	double min;
	double max;
	double step;
};

void plot_view(const struct plot_data *p, struct plot_view *v);
void plot_bins(const struct plot_view *v, const struct plot_column *c, struct plot_bin *bins,
	       size_t n);
/* where a value is: 0 at the begin of the axis, 1 at its end, and for one that is outside */
double plot_part(const struct plot_axis *a, double value);
/* at most @labels labels and one more; both ends are at most DBL_MAX / 4 */
struct plot_axis plot_axis(double min, double max, unsigned int labels);
struct plot_axis plot_range(const struct plot_column *c, size_t rows, unsigned int labels);
/* label @i of an axis; false: it has no more */
bool plot_label(const struct plot_axis *a, unsigned int i, double *at);

/* 0, or 1 after printing what is wrong */
int plot_text(FILE *to, const struct plot_view *v, const struct plot_column *const *c, size_t n,
	      unsigned int columns, bool unicode);
void plot_svg(FILE *to, const struct plot_view *v, const struct plot_column *const *c, size_t n);

#endif
