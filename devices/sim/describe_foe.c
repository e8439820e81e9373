// SPDX-License-Identifier: GPL-2.0-only
/* Options of the FoE server in segment descriptions. */
#include "describe_int.h"

#define PAGE_NS_MAX	60000000000ULL

/**
 * ec_desc_foe() - how the FoE server of a slave behaves
 * @d: description, a slave statement
 * @c: result
 *
 * Context: Process. May sleep.
 * Return: 0, -EINVAL.
 */
int ec_desc_foe(struct ec_desc *d, struct ec_app_config *c)
{
	struct ec_desc_word w;
	s64 busy = 0;
	int ret;

	ret = ec_desc_number(d, "foe_busy", 0, 255, &busy);
	if (!ret)
		ret = ec_desc_time(d, "foe_page", PAGE_NS_MAX, &c->foe_page_ns);
	if (ret)
		return ret;
	c->foe_busy = (u8)busy;
	w = ec_desc_value(d, "foe_header");
	if (w.s && (!w.n || w.n > EC_APP_FOE_HEADER))
		return ec_desc_fail(d, "invalid foe_header '", &w,
				    "': expected 1 to 16 characters");
	c->foe_header = w.s;
	c->foe_header_len = (u8)(w.s ? w.n : 0);
	return ec_desc_yes(d, "foe_boot", &c->foe_boot);
}
