/* SPDX-License-Identifier: GPL-2.0-only */
/* Why a transfer through a mailbox failed. */
#ifndef EC_MBOX_TEXT_H
#define EC_MBOX_TEXT_H

#include <linux/types.h>

const char *ec_mbox_fail_text(int ret, const char *protocol, char *buf, size_t size);

#endif
