/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Vendor specific messages over EtherCAT: their header (ETG.1000.6, mailbox type 15). */
#ifndef EC_WIRE_VOE_H
#define EC_WIRE_VOE_H

#include "mbox.h"

#define EC_VOE_HDR	6

/**
 * struct ec_voe_hdr - VoE header, decoded
 * @vendor: vendor id
 * @type: of the message, the vendor's own
 */
struct ec_voe_hdr {
	u32 vendor;
	u16 type;
};

int ec_voe_hdr_decode(struct ec_rbuf *r, struct ec_voe_hdr *h);
void ec_voe_hdr_encode(struct ec_wbuf *w, const struct ec_voe_hdr *h);

#endif
