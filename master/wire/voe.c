// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "voe.h"

/**
 * ec_voe_hdr_decode() - read a VoE header
 * @r: cursor behind the mailbox header; then it stands on the vendor's data
 * @h: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EMSGSIZE when it is not complete.
 */
int ec_voe_hdr_decode(struct ec_rbuf *r, struct ec_voe_hdr *h)
{
	h->vendor = ec_rbuf_le32(r);
	h->type = ec_rbuf_le16(r);
	return r->bad ? -EMSGSIZE : 0;
}

/**
 * ec_voe_hdr_encode() - write a VoE header
 * @w: cursor
 * @h: what to write
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_voe_hdr_encode(struct ec_wbuf *w, const struct ec_voe_hdr *h)
{
	ec_wbuf_le32(w, h->vendor);
	ec_wbuf_le16(w, h->type);
}
