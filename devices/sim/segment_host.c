// SPDX-License-Identifier: GPL-2.0-only
/*
 * Hosts: a PC or a switch at a port of a slave, and the frames it sends into the segment.
 * They go on from there as frames of a master do: out of the next open port, and so on. What
 * reaches a master is kept until the caller fetches it.
 */
#include "esc_int.h"

static const u8 arp[] = {
	0x08, 0x06, 0, 1, 0x08, 0, 6, 4, 0, 1,
};

/* a slot for a frame; the oldest that nobody has fetched, if there is no other */
static struct ec_sim_host_frame *slot(struct ec_sim *sim)
{
	struct ec_sim_host_frame *oldest = NULL;

	for (u32 i = 0; i < EC_SIM_HOST_FRAMES; i++) {
		struct ec_sim_host_frame *h = &sim->host[i];

		if (h->state == EC_SIM_HOST_FREE)
			return h;
		if (h->state == EC_SIM_HOST_ARRIVED &&
		    (!oldest || h->fl.due_ns < oldest->fl.due_ns))
			oldest = h;
	}
	if (oldest)
		sim->host_arrived--;
	return oldest;
}

/* a broadcast that asks who has an address, or another master that looks for slaves */
static void compose(struct ec_sim_host_frame *h, const struct ec_sim_fault *f, u64 number)
{
	struct ec_frame_buf b;
	u8 *eth = h->eth;

	memset(eth, 0, sizeof(h->eth));
	memset(eth, 0xff, 6);
	eth[6] = 0x02;
	eth[7] = 0x0c;
	eth[8] = (u8)(f->slave >> 16);
	eth[9] = (u8)(f->slave >> 8);
	eth[10] = (u8)f->slave;
	eth[11] = (u8)f->port;
	ec_sim_flight_init(&h->fl, eth, NULL, 0, sizeof(h->eth));
	h->fl.number = number;
	h->fl.mport = -1;
	if (f->arg == EC_SIM_HOST_BROADCAST) {
		memcpy(eth + 12, arp, sizeof(arp));
		memcpy(eth + 22, eth + 6, 6);
		return;
	}
	eth[12] = EC_ETHERTYPE >> 8;
	eth[13] = EC_ETHERTYPE & 0xff;
	h->fl.frame = eth + EC_ETH_HDR;
	h->fl.len = sizeof(h->eth) - EC_ETH_HDR;
	ec_frame_begin(&b, h->fl.frame, h->fl.len);
	ec_frame_add(&b, EC_CMD_BRD, (u8)number, 0, EC_REG_AL_STATUS, 2);
	ec_frame_end(&b);
}

static void send(struct ec_sim *sim, const struct ec_sim_fault *f, u64 now)
{
	struct ec_sim_host_frame *h = slot(sim);

	if (!h)
		return;
	compose(h, f, ++sim->frames);
	h->state = EC_SIM_HOST_IN_FLIGHT;
	h->fl.start_ns = now;
	h->fl.wire_ns = ec_frame_wire_ns(sizeof(h->eth)) - 12 * 80;
	ec_sim_fly_from_host(sim, &h->fl, f->slave, f->port);
}

/* First a host comes, then each time one of its frames. Returns whether there is a next one. */
bool ec_sim_host(struct ec_sim *sim, struct ec_sim_fault *f, u64 now)
{
	struct ec_esc_port *port = &sim->esc[f->slave]->port[f->port];

	if (!f->arg2) {
		ec_sim_plug_host(sim, f->slave, f->port, now);
		port->host = ++sim->hosts;
		f->arg2 = port->host;
	} else if (port->peer != EC_ESC_PEER_HOST || port->host != f->arg2) {
		return false;		/* it is gone, or another one is there */
	} else if (port->link) {
		send(sim, f, now);
	}
	f->at_ns = now + f->value;
	return f->value;
}

/* a frame of a host is at a master, or is lost */
void ec_sim_host_done(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	struct ec_sim_host_frame *h = (struct ec_sim_host_frame *)fl;

	h->state = fl->res.copies ? EC_SIM_HOST_ARRIVED : EC_SIM_HOST_FREE;
	sim->host_arrived += h->state == EC_SIM_HOST_ARRIVED;
}

/**
 * ec_sim_foreign() - fetch a frame of a host that has arrived at a master port
 * @sim: segment
 * @f: result
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether there was one; the one that arrived first.
 */
bool ec_sim_foreign(struct ec_sim *sim, struct ec_sim_foreign *f)
{
	struct ec_sim_host_frame *first = NULL;

	if (!sim->host_arrived)
		return false;
	for (u32 i = 0; i < EC_SIM_HOST_FRAMES; i++) {
		struct ec_sim_host_frame *h = &sim->host[i];

		if (h->state == EC_SIM_HOST_ARRIVED &&
		    (!first || h->fl.due_ns < first->fl.due_ns))
			first = h;
	}
	f->port = first->fl.res.out_port;
	f->due_ns = first->fl.due_ns;
	memcpy(f->eth, first->eth, sizeof(f->eth));
	first->state = EC_SIM_HOST_FREE;
	sim->host_arrived--;
	return true;
}
