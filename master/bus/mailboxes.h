/* SPDX-License-Identifier: GPL-2.0-only */
/* Messages that slaves send without a request. */
#ifndef EC_MAILBOXES_H
#define EC_MAILBOXES_H

#include <linux/types.h>

/* masks of the ECAT events that a slave shows: AL status, and SM1 where that is a mailbox */
extern const u8 ec_mailboxes_events[2], ec_mailboxes_no_events[2];

struct ec_bus;

u16 ec_mailboxes_watch(const struct ec_bus *bus);
void ec_mailboxes_look(struct ec_bus *bus, u16 irq);

#endif
