/* SPDX-License-Identifier: GPL-2.0-only */
/* Differences of the kinds of requests: which starts are valid, and the transfer. */
#ifndef EC_REQUEST_RUN_H
#define EC_REQUEST_RUN_H

#include <linux/types.h>

struct ec_links;
struct ec_request;
struct ec_slave;

int ec_request_accept(struct ec_request *r, u32 flags, u32 size);
void ec_request_run(struct ec_request *r, struct ec_slave *s, struct ec_links *l);

#endif
