// SPDX-License-Identifier: GPL-2.0-only
/* Ethernet port of a simulated slave that is a switch: frames pass unchanged. */
#include "eoe.h"

/**
 * ec_app_eoe_has_port() - has a slave an Ethernet port
 * @app: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true with eoe=switch.
 */
bool ec_app_eoe_has_port(const struct ec_app *app)
{
	return app->eoe && app->eoe->port;
}

/**
 * ec_app_eoe_out() - a whole frame from the master
 * @app: slave with a port
 * @frame: the frame
 * @len: bytes of it
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_out(struct ec_app *app, const u8 *frame, u16 len)
{
	struct ec_app_eoe_port *p = app->eoe->port;
	u32 i = (p->first + p->n) % EC_APP_EOE_QUEUE;

	if (p->n == EC_APP_EOE_QUEUE) {
		app->eoe->dropped++;
		return;
	}
	p->len[i] = len;
	memcpy(p->data[i], frame, len);
	p->n++;
}

/**
 * ec_app_eoe_leave() - the next frame that leaves by the port
 * @app: slave with a port
 * @frame: room for EC_EOE_FRAME_MAX bytes
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of it, 0: there is none.
 */
u16 ec_app_eoe_leave(struct ec_app *app, u8 *frame)
{
	struct ec_app_eoe_port *p = app->eoe->port;
	u16 len;

	if (!p->n)
		return 0;
	len = p->len[p->first];
	memcpy(frame, p->data[p->first], len);
	p->first = (u8)((p->first + 1) % EC_APP_EOE_QUEUE);
	p->n--;
	return len;
}

/**
 * ec_app_eoe_takes() - is there a place for a frame that comes to the port
 * @app: slave with a port
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false: too many wait for the mailbox.
 */
bool ec_app_eoe_takes(const struct ec_app *app)
{
	return app->eoe->n < EC_APP_EOE_QUEUE;
}

/**
 * ec_app_eoe_enter() - a frame comes to the port
 * @app: slave with a port
 * @frame: the frame
 * @len: bytes of it
 * @now: time, ns
 *
 * It is dropped when its length is wrong, in INIT and BOOT, and when too many
 * frames wait.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_enter(struct ec_app *app, const u8 *frame, u16 len, u64 now)
{
	struct ec_app_eoe_frame *f;

	if (len < EC_APP_ETH_HDR || len > EC_EOE_FRAME_MAX || !ec_app_eoe_runs(app))
		return;
	f = ec_app_eoe_place(app);
	if (!f)
		return;
	memcpy(f->data, frame, len);
	ec_app_eoe_send(app, f, len, now + app->response_ns);
	ec_app_rewake(app, now);
}
