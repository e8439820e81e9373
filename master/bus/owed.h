/* SPDX-License-Identifier: GPL-2.0-only */
/* Station addresses that slaves have to get back. */
#ifndef EC_BUS_OWED_H
#define EC_BUS_OWED_H

#include <linux/types.h>

struct ec_bus;
struct ec_dg;
struct ec_slave;

/**
 * struct ec_owed - a slave that got the address of another one
 * @since_ns: (ktime)
 * @has: address that it has, and no other slave has had
 * @own: its own
 * @tried: it was written, without a reply
 */
struct ec_owed {
	u64 since_ns;
	u16 has;
	u16 own;
	bool tried;
};

bool ec_owed_has_lost(const struct ec_slave *s, const struct ec_dg *own, const struct ec_dg *up,
		      const u8 *dl);
unsigned int ec_owed_find(struct ec_bus *bus, const struct ec_slave **found, unsigned int max);
void ec_owed_by_fmmu(struct ec_bus *bus, const u16 *station, unsigned int n,
		     const struct ec_slave **owner);
bool ec_owed_runs_as(struct ec_bus *bus, u16 station, const struct ec_slave *s);
void ec_owed_note(struct ec_bus *bus, u16 has, u16 own);
bool ec_owed_pay(struct ec_bus *bus);
void ec_owed_exit(struct ec_bus *bus);

#endif
