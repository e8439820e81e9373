// SPDX-License-Identifier: GPL-2.0-only
/* IP parameters of a slave with EoE. */
#include <linux/etherdevice.h>
#include <linux/jhash.h>
#include "../link/links.h"
#include "../mailbox/eoe.h"
#include "slave.h"
#include "slave_ip.h"

/*
 * Locally administered, and the same after each restart while the slave has its place, or an alias
 * or serial number: from the address of the main device, so that two hosts differ, and the slave.
 * No network device of the host has it: these are made with their name.
 */
static void own_mac(const struct ec_slave *s, u8 mac[ETH_ALEN])
{
	bool named = s->alias || s->info.serial;
	u32 what[] = { s->info.vendor, s->info.product, s->info.serial, s->alias,
		       named ? ~0u : s->position };
	u32 a, b = jhash2(what, ARRAY_SIZE(what), 0);
	const struct ecdev *dev;

	rcu_read_lock();
	dev = READ_ONCE(ec_links_at(s->bus->links, 0)->dev);
	a = dev ? jhash(dev->mac, ETH_ALEN, b) : b;
	rcu_read_unlock();
	put_unaligned_be16(b, mac);
	put_unaligned_be32(a, mac + 2);
	mac[0] = (mac[0] & ~1) | 2;
}

/**
 * ec_slave_give_ip() - give a slave IP parameters, in a form that each slave understands
 * @s: slave
 * @p: parameters; those not in @which do not change, except that a slave
 *	without a MAC address may get one
 * @result: EC_EOE_OK... of the slave
 *
 * See ec_eoe_give_ip().
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_eoe_set_ip().
 */
int ec_slave_give_ip(struct ec_slave *s, const struct ec_eoe_ip *p, u16 *result)
{
	u8 mac[ETH_ALEN];

	own_mac(s, mac);
	return ec_eoe_give_ip(&s->mbox, p, mac, result);
}
