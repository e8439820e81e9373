/* SPDX-License-Identifier: GPL-2.0-only */
/* The network device of a slave with EoE. */
#ifndef EC_EOE_NETDEV_H
#define EC_EOE_NETDEV_H

#include <linux/if.h>
#include <linux/mutex.h>
#include <linux/netdevice.h>
#include "ids.h"
#include "port.h"

struct ec_eoe;
struct ec_ioc_eoe;
struct ec_slave;

/**
 * struct ec_eoe_netdev - private part of a network device
 * @nd: network device
 * @old: in a list of those that are removed
 * @eoe: those of the master; immutable
 * @id: its slave
 * @lock: protects @slave and @open, and attaching; inside rtnl
 * @slave: slave that @port is attached to, with a reference; NULL: none
 * @open: the device is up
 * @again_ns: not attached again before that time (ktime); of the work of the master, as what
 *	follows
 * @again_ms: distance of the last two tries, 0: the port works
 * @seen: fragments of @port both ways when it was looked at last
 * @refused: fragments that slaves had refused before @slave was attached
 * @refusing: it was said that the slave refuses frames
 * @stands: looks in a row at which the slave had taken no frame
 * @connected: the list has the slave
 * @port: way of the frames
 * @rx_packets: frames of the slave that were delivered; by the work of @port, as the next two
 * @rx_bytes: bytes of them
 * @rx_refused: those that were not
 * @tx_unsent: frames that are not allowed to go to a slave, or came without one; by eoe_xmit()
 * @rx_rate: bytes/s before @measured_ns; these four by the work of the master
 * @tx_rate: the same of those to the slave
 * @measured_ns: when they were measured last (ktime)
 * @measured: bytes at that time, of the slave and to it
 */
struct ec_eoe_netdev {
	struct net_device *nd;
	struct list_head old;
	struct ec_eoe *eoe;
	struct ec_eoe_id id;
	struct mutex lock;
	struct ec_slave *slave;
	bool open;
	u64 again_ns;
	u32 again_ms;
	u64 seen;
	u64 refused;
	bool refusing;
	u8 stands;
	bool connected;
	struct ec_eoe_port port;
	aligned_u64 rx_packets;
	aligned_u64 rx_bytes;
	aligned_u64 rx_refused;
	aligned_u64 tx_unsent;
	u32 rx_rate;
	u32 tx_rate;
	u64 measured_ns;
	u64 measured[2];
};

#define EC_EOE_CHOICES	3	/* of names */

struct ec_eoe_netdev *ec_eoe_netdev_create(struct ec_eoe *eoe, const struct ec_eoe_id *id,
					   unsigned int choice);
void ec_eoe_netdev_destroy(struct list_head *old);
void ec_eoe_netdev_room(struct ec_eoe_port *p);
void ec_eoe_netdev_deliver(struct ec_eoe_port *p, struct sk_buff *skb);
void ec_eoe_netdev_failed(struct ec_eoe_port *p);
void ec_eoe_netdev_measure(struct ec_eoe_netdev *d);
void ec_eoe_netdev_show(struct ec_eoe_netdev *d, struct ec_ioc_eoe *info);
void ec_eoe_netdev_follow(struct ec_eoe_netdev *d, struct ec_slave *s);

#endif
