/* SPDX-License-Identifier: GPL-2.0-only */
/* Several slaves at once, since each of them takes its time. */
#ifndef EC_TOOL_PRESENT_ALL_H
#define EC_TOOL_PRESENT_ALL_H

#include "dev.h"
#include "present.h"

/* 0, or 1 after printing the error; @known and @why of a slave show what it did not answer */
int present_read_all(const struct tool *t, struct dev *d, struct present *v, size_t n);

#endif
