/* SPDX-License-Identifier: GPL-2.0-only */
/* Messages that slaves send without a request. */
#ifndef EC_MAILBOXES_H
#define EC_MAILBOXES_H

#include <linux/types.h>

/* mask of the ECAT events that a slave with mailbox shows: SM1 is full */
extern const u8 ec_mailboxes_event[2];

struct ec_bus;

void ec_mailboxes_look(struct ec_bus *bus, u16 irq);

#endif
