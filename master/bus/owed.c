// SPDX-License-Identifier: GPL-2.0-only
/*
 * A slave that got an address meant for another one gets its own back, even if it is cut off before
 * it can: until it has accepted that, or is not in the list of slaves any more.
 */
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "known.h"
#include "owed.h"
#include "slave.h"

/**
 * ec_owed_note() - a slave has to get its station address back
 * @bus: bus
 * @has: address that it has
 * @own: its own
 *
 * Without memory it is found as a new slave.
 *
 * Context: The monitor thread. May sleep.
 */
void ec_owed_note(struct ec_bus *bus, u16 has, u16 own)
{
	struct ec_owed *more = krealloc_array(bus->owed, bus->n_owed + 1, sizeof(*more),
					      GFP_KERNEL | __GFP_NOWARN);

	if (!more)
		return;
	more[bus->n_owed++] = (struct ec_owed){ .has = has, .own = own };
	bus->owed = more;
}

/**
 * ec_owed_pay() - give slaves their station addresses back
 * @bus: bus
 *
 * Context: The monitor thread. May sleep; waits for bus traffic if there are such slaves.
 */
void ec_owed_pay(struct ec_bus *bus)
{
	unsigned int i, n = bus->n_owed;
	struct ec_dg *dg;
	u8 (*own)[2];

	if (!n)
		return;
	dg = kvcalloc(n, sizeof(*dg), GFP_KERNEL);
	own = kvcalloc(n, sizeof(*own), GFP_KERNEL);
	if (!dg || !own)
		goto out;
	for (i = 0; i < n; i++) {
		put_unaligned_le16(bus->owed[i].own, own[i]);
		dg[i] = EC_FPWR(bus->owed[i].has, EC_REG_STATION, 2, own[i]);
	}
	ec_xfer(bus->links, dg, n);
	bus->n_owed = 0;
	for (i = 0; i < n; i++)
		if ((dg[i].err || !dg[i].wkc) && ec_known_is_present(bus, bus->owed[i].own))
			bus->owed[bus->n_owed++] = bus->owed[i];
out:
	kvfree(dg);
	kvfree(own);
}

/**
 * ec_owed_exit() - forget such slaves
 * @bus: bus without a monitor
 *
 * Context: Any.
 */
void ec_owed_exit(struct ec_bus *bus)
{
	kfree(bus->owed);
	bus->owed = NULL;
	bus->n_owed = 0;
}
