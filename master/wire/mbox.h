/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Mailbox header and error reply (ETG.1000.4 clause 5.6, ETG.1000.6 clause 5.5). */
#ifndef EC_WIRE_MBOX_H
#define EC_WIRE_MBOX_H

#include "buf.h"

#define EC_MBOX_HDR		6
#define EC_MBOX_DATA_MAX	(1486 - EC_MBOX_HDR)
#define EC_MBOX_ERR_BODY	4

/*
 * What the receiving side of a mailbox exchange (ec_..._rx()) says, besides 0
 * for done and -errno.
 */
#define EC_MORE		1	/* send the next message */
#define EC_STALE	2	/* not the answer: keep waiting, the time limit runs on */
#define EC_WAIT		3	/* a part of the answer: wait for the next, restart the limit */

enum ec_mbox_type {
	EC_MBOX_ERR = 0,
	EC_MBOX_AOE = 1,
	EC_MBOX_EOE = 2,
	EC_MBOX_COE = 3,
	EC_MBOX_FOE = 4,
	EC_MBOX_SOE = 5,
	EC_MBOX_VOE = 15,
};

enum ec_mbox_error {
	EC_MBOX_ERR_SYNTAX = 1,
	EC_MBOX_ERR_PROTOCOL = 2,
	EC_MBOX_ERR_CHANNEL = 3,
	EC_MBOX_ERR_SERVICE = 4,
	EC_MBOX_ERR_HEADER = 5,
	EC_MBOX_ERR_TOO_SHORT = 6,
	EC_MBOX_ERR_NO_MEMORY = 7,
	EC_MBOX_ERR_SIZE = 8,
	EC_MBOX_ERR_IN_WORK = 9,
};

/**
 * struct ec_mbox_hdr - mailbox header, decoded
 * @len: bytes behind the header
 * @address: station address of the source (master to slave) or destination
 * @channel: 0
 * @prio: 0 lowest to 3
 * @type: enum ec_mbox_type
 * @counter: 1 to 7, 0: not used
 */
struct ec_mbox_hdr {
	u16 len;
	u16 address;
	u8 channel;
	u8 prio;
	u8 type;
	u8 counter;
};

int ec_mbox_hdr_decode(struct ec_rbuf *r, struct ec_mbox_hdr *h);
void ec_mbox_hdr_encode(struct ec_wbuf *w, const struct ec_mbox_hdr *h);
u8 ec_mbox_next_counter(u8 counter);

int ec_mbox_error_decode(struct ec_rbuf *r, u16 *detail);
const char *ec_mbox_error_text(u16 detail);
int ec_mbox_error_errno(u16 detail);
u16 ec_mbox_errno_detail(int err);

#endif
