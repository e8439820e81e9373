/* SPDX-License-Identifier: GPL-2.0-only */
/* What is behind ports and not on the bus: absent slaves, and ports that stay closed. */
#ifndef EC_TOOL_ABSENT_H
#define EC_TOOL_ABSENT_H

#include "dev.h"

/* prints a line of text without its end */
typedef void absent_line(const struct dev *d, const char *text);

/**
 * absent_show() - what is behind ports and not on the bus; JSON absent[] and closed_ports[]
 * @d: open file of the master
 * @all: its slaves, or those that are selected: others have no line
 * @line: for each of them
 *
 * Return: 0, or 1 after printing an error.
 */
int absent_show(struct dev *d, const struct slaves *all, absent_line *line);

/* the same as nodes and edges for Graphviz, without JSON */
int absent_draw(struct dev *d, const struct slaves *all);

#endif
