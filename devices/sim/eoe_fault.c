// SPDX-License-Identifier: GPL-2.0-only
/* What a script makes wrong with Ethernet frames of a simulated slave. */
#include "eoe.h"

#define FLOOD		(EC_APP_EOE_QUEUE / 2)	/* frames: answers need places too */
#define FLOOD_LEN	1514
#define FLOOD_TYPE	0x88b5	/* for experiments */
#define ETHERCAT_TYPE	0x88a4
#define UDP_PROTO	17
#define IP_HDR_LEN	20
#define UDP_HDR_LEN	8
#define COMPANION	300	/* bytes of a frame beside an answer: several fragments */

/* Noise to all stations. */
static void flood(struct ec_app *app, u64 now)
{
	struct ec_app_eoe *e = app->eoe;

	while (e->n < FLOOD) {
		struct ec_app_eoe_frame *f = ec_app_eoe_place(app);

		if (!f)
			return;
		memset(ec_app_eoe_eth(app, f, NULL, FLOOD_TYPE), 0x55,
		       FLOOD_LEN - EC_APP_ETH_HDR);
		ec_app_eoe_send(app, f, FLOOD_LEN, now);
	}
}

/* All slaves of a bus that it gets into go to INIT. */
static const u8 datagram[] = {
	0x0e, 0x10, EC_CMD_BWR, 0, 0, 0, EC_REG_AL_CONTROL & 0xff, EC_REG_AL_CONTROL >> 8,
	2, 0, 0, 0, EC_AL_INIT, 0, 0, 0,
};

/* An EtherCAT frame. */
static void ethercat(struct ec_app *app, u64 now)
{
	struct ec_app_eoe_frame *f = ec_app_eoe_place(app);

	if (!f)
		return;
	memcpy(ec_app_eoe_eth(app, f, NULL, ETHERCAT_TYPE), datagram, sizeof(datagram));
	ec_app_eoe_send(app, f, EC_APP_ETH_HDR + sizeof(datagram), now);
}

/* The same in UDP, to all stations. */
static void udp(struct ec_app *app, u64 now)
{
	static const u8 all[4] = { 255, 255, 255, 255 };
	struct ec_app_eoe_frame *f = ec_app_eoe_place(app);
	u8 *ip;

	if (!f)
		return;
	ip = ec_app_eoe_eth(app, f, NULL, EC_APP_ETH_IP);
	ec_app_eoe_ip(app, ip, all, UDP_PROTO, UDP_HDR_LEN + sizeof(datagram));
	ip += IP_HDR_LEN;
	ec_app_put_be16(ip, ETHERCAT_TYPE);
	ec_app_put_be16(ip + 2, ETHERCAT_TYPE);
	ec_app_put_be16(ip + 4, UDP_HDR_LEN + sizeof(datagram));
	ec_app_put_be16(ip + 6, 0);	/* no checksum */
	memcpy(ip + UDP_HDR_LEN, datagram, sizeof(datagram));
	ec_app_eoe_send(app, f, EC_APP_ETH_HDR + IP_HDR_LEN + UDP_HDR_LEN + sizeof(datagram), now);
}

/**
 * ec_app_eoe_fault() - a fault of the Ethernet begins
 * @app: slave
 * @now: time, ns
 *
 * The slave sends a frame, so that the fault shows without a request too.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_fault(struct ec_app *app, u64 now)
{
	u8 fault = app->esc->fault.eoe;

	if (!app->eoe)
		return;
	app->eoe->begun = 0;
	app->eoe->asked = 0;
	if (fault == EC_SIM_EOE_FLOOD)
		flood(app, now);
	else if (fault == EC_SIM_EOE_ETHERCAT)
		ethercat(app, now);
	else if (fault == EC_SIM_EOE_UDP)
		udp(app, now);
	else if (fault != EC_SIM_EOE_GOOD)
		ec_app_eoe_announce(app, COMPANION, now);
}

/**
 * ec_app_eoe_fill() - add frames to those that wait, as the fault requires
 * @app: slave
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_eoe_fill(struct ec_app *app, u64 now)
{
	const struct ec_app_eoe *e = app->eoe;
	u8 fault = app->esc->fault.eoe;
	const struct ec_app_eoe_frame *first = &e->frames[e->order[0]];
	/* one that has no companion yet, and is none */
	bool answers = e->n == 1 && !first->begun && !(first->data[0] & 1);

	if (fault == EC_SIM_EOE_FLOOD)
		flood(app, now);
	else if (fault == EC_SIM_EOE_ETHERCAT && answers)
		ethercat(app, now);
	else if (fault == EC_SIM_EOE_UDP && answers)
		udp(app, now);
	else if (fault == EC_SIM_EOE_INTERLEAVE && answers)
		ec_app_eoe_announce(app, COMPANION, now);
}

/**
 * ec_app_eoe_refuses() - is a fragment from the master refused?
 * @app: slave
 * @part: the fragment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: it is. The others of its frame come to nothing without it.
 */
bool ec_app_eoe_refuses(struct ec_app *app, const struct ec_eoe_fragment *part)
{
	const struct ec_esc_fault *fault = &app->esc->fault;

	return fault->eoe == EC_SIM_EOE_REFUSE && !part->number &&
	       !(++app->eoe->asked % max(fault->eoe_every, 1u));
}

/**
 * ec_app_eoe_spoil() - what is wrong with a fragment
 * @app: slave
 * @f: frame that it is of
 * @part: the fragment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false: it is not sent.
 */
bool ec_app_eoe_spoil(struct ec_app *app, struct ec_app_eoe_frame *f,
		      struct ec_eoe_fragment *part)
{
	static const u8 sizes[] = { 0, 1, 63 };

	switch (f->fault) {
	case EC_SIM_EOE_LOST:
		return part->number != 1 && !(!part->number && part->last);
	case EC_SIM_EOE_OFFSET:
		if (part->number)
			part->units++;
		break;
	case EC_SIM_EOE_NUMBER:
		if (part->last)
			part->number++;
		break;
	case EC_SIM_EOE_SIZE:
		if (!part->number)
			part->units = sizes[f->number % ARRAY_SIZE(sizes)];
		break;
	default:
		break;
	}
	return true;
}

/**
 * ec_app_eoe_endless() - a fragment of a frame without end
 * @app: slave
 * @f: frame that it is of
 * @part: out: the fragment, a unit of it again and again
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false: the frame has an end.
 */
bool ec_app_eoe_endless(struct ec_app *app, struct ec_app_eoe_frame *f,
			struct ec_eoe_fragment *part)
{
	if (f->fault != EC_SIM_EOE_ENDLESS || app->esc->fault.eoe != EC_SIM_EOE_ENDLESS)
		return false;
	part->number = f->fragments;
	part->units = f->fragments ? f->at / EC_EOE_UNIT : 63;
	part->data = f->data;
	part->len = EC_EOE_UNIT;
	part->last = false;
	return true;
}
