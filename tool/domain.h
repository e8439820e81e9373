/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_DOMAIN_H
#define EC_TOOL_DOMAIN_H

#include "dev.h"

/* calls @fn for each domain that -d selects; its value is the largest returned */
int domain_each(struct dev *d, const struct tool *t,
		int (*fn)(const struct tool *t, struct dev *d, const struct ect_domain *dom));
/* the process image, to be freed */
int domain_data(struct dev *d, const struct ect_domain *dom, u8 **data, size_t *size);

#endif
