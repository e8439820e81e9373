/* SPDX-License-Identifier: GPL-2.0-only */
/* Send of the cycle owner. */
#ifndef EC_SEND_H
#define EC_SEND_H

#include "cycle.h"

void ec_cycle_app_time(struct ec_cycle *c, const struct ec_ioc_send *what);
int ec_cycle_do_send(struct ec_cycle *c, const struct ec_ioc_send *what);

/**
 * ec_cycle_take_request() - take the application time of a send, check its domains
 * @c: active cycle
 * @what: its flags are known ones
 *
 * Context: The cycle owner. RT-safe.
 * Return: 0; -ENOENT a domain is queued that does not exist.
 */
static inline int ec_cycle_take_request(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	unsigned int n = c->wanted->n_domains;

	if (what->flags & (EC_SEND_FLAG_APP_TIME | EC_SEND_FLAG_SYNC_REF))
		ec_cycle_app_time(c, what);
	return n < 64 && what->queued >> n ? -ENOENT : 0;
}

/**
 * ec_cycle_send() - ec_cycle_do_send(), with the links entered and left
 * @c: active cycle
 * @what: as there
 *
 * Context: The cycle owner. RT-safe; sleeps after a cycle timeout only.
 * Return: 0 or -ENODEV.
 */
static inline int ec_cycle_send(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	int ret = ec_links_enter(c->links);

	if (ret)
		return ret;
	ret = ec_cycle_do_send(c, what);
	ec_links_leave(c->links);
	return ret;
}

#endif
