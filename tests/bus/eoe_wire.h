/* SPDX-License-Identifier: GPL-2.0-only */
/* The host's end of the network device of a slave with EoE: ARP and ping, frame by frame. */
#ifndef EC_EOE_WIRE_H
#define EC_EOE_WIRE_H

#include <linux/netdevice.h>
#include "bus.h"
#include "master/eoe/netdev.h"

/**
 * struct eoe_wire - a device that is up, and the frames that came from it
 * @b: the bus
 * @type: takes the frames
 * @nd: the device
 * @last: the last frame to the host
 * @len: bytes of it
 * @frames: to the host alone
 * @others: to others as well
 * @ethercat: frames of the fieldbus
 */
struct eoe_wire {
	struct bus *b;
	struct packet_type type;
	struct net_device *nd;
	u8 last[EC_EOE_FRAME_MAX];
	u32 len;
	u32 frames;
	u32 others;
	u32 ethercat;
};

extern const u8 eoe_slave_ip[4], eoe_host_ip[4], eoe_all[ETH_ALEN];

struct net_device *eoe_find(const char *name);
struct net_device *eoe_await(struct kunit *test, const char *name, bool there);
void eoe_set_up(struct net_device *nd, bool up);
bool eoe_await_carrier(struct net_device *nd, bool on);
struct eoe_wire *eoe_wire_new(struct bus *b, u32 position, const char *name);
void eoe_wire_end(struct eoe_wire *w);
struct eoe_wire *eoe_up(struct kunit *test, const char *text, u32 slaves, const char *name);
void eoe_down(struct eoe_wire *w);

u32 eoe_header(struct eoe_wire *w, u8 *f, const u8 *to, u16 type);
void eoe_send(struct eoe_wire *w, const u8 *frame, u32 len);
bool eoe_ask_address(struct eoe_wire *w, u8 *mac);
void eoe_send_ping(struct eoe_wire *w, const u8 *mac, u32 len);
bool eoe_await_frames(struct eoe_wire *w, u32 n);
u64 eoe_ping(struct eoe_wire *w, const u8 *mac, u32 len);

#endif
