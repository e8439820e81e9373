// SPDX-License-Identifier: GPL-2.0-only
/* EoE of a simulated slave: IP parameters; Ethernet frames go to eoe_queue.c. */
#include "app.h"

static void take(struct ec_app_ip *ip, const struct ec_eoe_ip *p)
{
	struct ec_eoe_ip *now = &ip->now;

	if (p->which & EC_EOE_MAC)
		memcpy(now->mac, p->mac, sizeof(now->mac));
	if (p->which & EC_EOE_IP)
		memcpy(now->ip, p->ip, sizeof(now->ip));
	if (p->which & EC_EOE_MASK)
		memcpy(now->mask, p->mask, sizeof(now->mask));
	if (p->which & EC_EOE_GATEWAY)
		memcpy(now->gateway, p->gateway, sizeof(now->gateway));
	if (p->which & EC_EOE_DNS)
		memcpy(now->dns, p->dns, sizeof(now->dns));
	if (p->which & EC_EOE_HOSTNAME)
		memcpy(now->name, p->name, sizeof(now->name));
	now->which |= p->which;
	ip->sets++;
}

/**
 * ec_app_eoe() - answer an EoE message
 * @app: slave
 * @rx: message behind the mailbox header
 * @len: bytes at @rx
 * @tx: room for the answer
 * @cap: bytes at @tx
 *
 * IP parameters can be set and read; other services are answered as
 * unsupported. Fragments of frames vanish in a slave without Ethernet.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes at @tx; 0: no answer; -EINVAL: a fragment is refused;
 * -EMSGSIZE: the message is too short, or the answer too long.
 */
int ec_app_eoe(struct ec_app *app, const u8 *rx, size_t len, u8 *tx, size_t cap)
{
	int type = ec_eoe_type_decode(rx, len);
	u16 result = app->ip.refuse ? EC_EOE_NO_IP : EC_EOE_OK;
	struct ec_eoe_ip p;

	switch (type) {
	case EC_EOE_SET_IP_REQ:
		if (app->ip.packed ? ec_eoe_ip_decode_packed(rx, len, &p) :
				     ec_eoe_ip_decode(rx, len, &p))
			return -EMSGSIZE;
		if (!result)
			take(&app->ip, &p);
		return ec_eoe_result_encode(tx, cap, EC_EOE_SET_IP_RESP, result);
	case EC_EOE_GET_IP_REQ:
		if (app->ip.mute)
			return 0;
		if (!result)
			return app->ip.packed ?
			       ec_eoe_ip_encode_packed(tx, cap, EC_EOE_GET_IP_RESP, &app->ip.now) :
			       ec_eoe_ip_encode(tx, cap, EC_EOE_GET_IP_RESP, &app->ip.now);
		return ec_eoe_result_encode(tx, cap, EC_EOE_GET_IP_RESP, result);
	case EC_EOE_SET_FILTER_REQ:
		return ec_eoe_result_encode(tx, cap, EC_EOE_SET_FILTER_RESP,
					    EC_EOE_NO_FILTER);
	case EC_EOE_FRAGMENT:
		return ec_app_eoe_fragment(app, rx, len);
	default:
		return type < 0 ? type : 0;
	}
}
