/* SPDX-License-Identifier: GPL-2.0-only */
/* Messages that slaves send without a request. */
#ifndef EC_MAILBOXES_H
#define EC_MAILBOXES_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

const u8 *ec_mailboxes_mask(bool mailbox);
bool ec_mailboxes_polled(const struct ec_slave *s);
u16 ec_mailboxes_watch(const struct ec_bus *bus, bool exchange);
bool ec_mailboxes_look(struct ec_bus *bus, u16 irq);

#endif
