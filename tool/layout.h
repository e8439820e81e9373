/* SPDX-License-Identifier: GPL-2.0-only */
/* SyncManagers, PDOs and entries of one slave. */
#ifndef EC_TOOL_LAYOUT_H
#define EC_TOOL_LAYOUT_H

#include "dev.h"

struct layout_pdo {
	struct ect_pdo pdo;
	struct ect_pdo_entry *entries;	/* pdo.entry_count */
};

struct layout_sm {
	struct ect_sm sm;
	struct layout_pdo *pdos;		/* sm.pdo_count */
};

struct layout {
	unsigned int n;
	struct layout_sm *sms;
};

int layout_read(struct dev *d, const struct ect_slave *s, struct layout *l);
void layout_free(struct layout *l);
/* written by the master: an RxPDO of the slave */
bool layout_is_output(const struct layout_sm *sm);

#endif
