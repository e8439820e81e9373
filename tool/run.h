/* SPDX-License-Identifier: GPL-2.0-only */
/* What the ways to run a bus without an application share. */
#ifndef EC_TOOL_RUN_H
#define EC_TOOL_RUN_H

#include "dev.h"

#define RUN_PERIOD_NS	1000000

/*
 * cmd_run.c: until all configurations are in OP; @n: how many are. 0, or 1 after printing why some
 * are not; with --force 0.
 */
int run_wait_op(struct dev *d, const struct tool *t, size_t configs, size_t *n);
/* that it runs, and how */
void run_show(struct dev *d, size_t n);
/* 0, or 1 after printing that the output cannot be written */
int run_finish_output(void);

/* run_file.c: by a bus file, on the master of -m or of the file */
int run_file(const struct tool *t, const char *path);

#endif
