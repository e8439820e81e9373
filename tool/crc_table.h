/* SPDX-License-Identifier: GPL-2.0-only */
/* Error counters of slaves as a table, and of a span of time. */
#ifndef EC_TOOL_CRC_TABLE_H
#define EC_TOOL_CRC_TABLE_H

#include "dev.h"
#include "errors.h"

void crc_table_head(void);
void crc_table_row(const struct tool *t, const struct ect_slave *s, const struct ect_errors *e);

/* crc_watch.c */
int crc_watch(const struct tool *t, struct dev *d);

#endif
