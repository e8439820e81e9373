/* SPDX-License-Identifier: GPL-2.0-only */
/* A received frame finds its slot and its callers. */
#ifndef EC_RECEIVE_H
#define EC_RECEIVE_H

#include <linux/types.h>

struct ec_link;

void ec_receive(struct ec_link *link, const u8 *src, const u8 *data, size_t len);

#endif
