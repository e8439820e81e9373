// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "mbox_encode.h"

/**
 * ec_mbox_error_encode() - write an error reply
 * @w: cursor behind the mailbox header
 * @detail: enum ec_mbox_error
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_error_encode(struct ec_wbuf *w, u16 detail)
{
	ec_wbuf_le16(w, 1);
	ec_wbuf_le16(w, detail);
}

/**
 * ec_coe_emergency_encode() - write an emergency
 * @tx: message behind the mailbox header
 * @cap: bytes at @tx
 * @e: what to write
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, -EMSGSIZE when it does not fit.
 */
int ec_coe_emergency_encode(u8 *tx, size_t cap, const struct ec_coe_emergency *e)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_coe_hdr_encode(&w, EC_COE_EMERGENCY);
	ec_wbuf_le16(&w, e->code);
	ec_wbuf_u8(&w, e->reg);
	ec_wbuf_bytes(&w, e->data, sizeof(e->data));
	return w.bad ? -EMSGSIZE : EC_COE_EMERGENCY_SIZE;
}
