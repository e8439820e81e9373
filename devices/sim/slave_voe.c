// SPDX-License-Identifier: GPL-2.0-only
/* VoE of a simulated slave: an echo, and messages the script asks for. */
#include "app.h"

/**
 * ec_app_voe() - answer a VoE message
 * @app: slave
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @tx: room for the answer
 * @cap: bytes at @tx
 *
 * The data come back with the same vendor id and the type of the description.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes at @tx; -EMSGSIZE: the message is too short, or the answer too
 * long.
 */
int ec_app_voe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap)
{
	struct ec_rbuf r = ec_rbuf(rx, len);
	struct ec_wbuf w = ec_wbuf(tx, cap);
	struct ec_voe_hdr h;

	if (ec_voe_hdr_decode(&r, &h))
		return -EMSGSIZE;
	h.type = app->model->params.voe;
	ec_voe_hdr_encode(&w, &h);
	ec_wbuf_bytes(&w, r.p, ec_rbuf_left(&r));
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}

/**
 * ec_app_voe_unasked() - an unrequested message
 * @m: what to send: bytes 0, 1, 2...
 * @tx: room for it
 * @cap: bytes at @tx
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes at @tx, -EMSGSIZE when it does not fit.
 */
int ec_app_voe_unasked(const struct ec_app_voe *m, u8 *tx, size_t cap)
{
	struct ec_wbuf w = ec_wbuf(tx, cap);

	ec_voe_hdr_encode(&w, &m->hdr);
	for (u16 i = 0; i < m->size; i++)
		ec_wbuf_u8(&w, (u8)i);
	return w.bad ? -EMSGSIZE : (int)(w.p - tx);
}
