/* SPDX-License-Identifier: GPL-2.0-only */
/* A recording that was read from a file. */
#ifndef EC_TOOL_PLOT_DATA_H
#define EC_TOOL_PLOT_DATA_H

#include <stdbool.h>
#include <stddef.h>

#define PLOT_COLUMNS	4096	/* at most */
#define PLOT_TEXT	256	/* bytes of a name, with its end */
#define PLOT_FILE_MAX	(1ULL << 30)

/* a column: values of all rows */
struct plot_column {
	char name[PLOT_TEXT];
	char unit[PLOT_TEXT];	/* "": none */
	bool flag;		/* false and true only */
	double *v;
};

/**
 * struct plot_data - a recording
 * @columns: all of them
 * @n: how many
 * @rows: of each
 * @room: rows that fit
 * @since: what time 0 is, "": the file does not say
 */
struct plot_data {
	struct plot_column *columns;
	size_t n;
	size_t rows;
	size_t room;
	char since[PLOT_TEXT];
};

/* both need plot_free() in any case; 0, or 1 after printing what is wrong */
int plot_read(const char *path, struct plot_data *p);
/* @name: in messages */
int plot_read_memory(const char *name, const char *data, size_t size, struct plot_data *p);
void plot_free(struct plot_data *p);

/* NULL: there is no such column */
const struct plot_column *plot_find(const struct plot_data *p, const char *name);

/* for the readers of the formats */
/* a text into PLOT_TEXT bytes, without what could change a terminal */
void plot_copy_text(char *to, const char *from, size_t len);
int plot_npy(const char *name, const char *data, size_t size, struct plot_data *p);
/* a column named "NAME [UNIT]" or "NAME" */
int plot_add_column(const char *name, struct plot_data *p, const char *text, size_t len);
int plot_add_row(struct plot_data *p);

#endif
