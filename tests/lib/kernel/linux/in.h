/* SPDX-License-Identifier: LGPL-2.1-or-later */
#include <linux/types.h>

struct in_addr {
	uint32_t s_addr;
};
