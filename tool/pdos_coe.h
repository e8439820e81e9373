/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_PDOS_COE_H
#define EC_TOOL_PDOS_COE_H

#include "dev.h"

/* a name for text output: entries without object fill up a PDO */
const char *pdo_entry_text(u16 index, const char *name);
bool pdos_coe_has(const struct ect_slave *s);
int pdos_coe(const struct slave_walk *w, const struct tool *t, struct dev *d,
	     const struct ect_slave *s, bool several);

#endif
