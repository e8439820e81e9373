/* SPDX-License-Identifier: GPL-2.0-only */
/* Mailbox transport of a slave: requests and their answers, messages without a request. */
#ifndef EC_MAILBOX_H
#define EC_MAILBOX_H

#include "claim.h"
#include "desk.h"
#include "desk_enter.h"
#include "late.h"
#include "mbox.h"
#include "mbox_text.h"
#include "unasked.h"

void ec_mbox_init(struct ec_mbox *mb);
unsigned int ec_mbox_sms(const struct ec_mbox *mb, bool boot, u8 *page);
void ec_mbox_exit(struct ec_mbox *mb);
int ec_mbox_check(const struct ec_mbox *mb, u16 protocol, size_t message);
struct ec_mbox_buf *ec_mbox_alloc(const struct ec_mbox *mb, u16 protocol, size_t message);
int ec_mbox_request(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		    size_t len);
int ec_mbox_send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit);
int ec_mbox_send_part(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		      size_t len);
void ec_mbox_send_last(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len);
int ec_mbox_forget(struct ec_mbox *mb);
int ec_mbox_wait_voe(struct ec_mbox *mb, struct ec_mbox_buf *b, bool blind,
		     const struct ec_mbox_limit *limit);

#endif
