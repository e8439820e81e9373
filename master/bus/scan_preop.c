// SPDX-License-Identifier: GPL-2.0-only
/*
 * New slaves from INIT to PREOP, all at once: packed writes, packed reads of
 * the AL status. A slave that is slow or shows an error is left to its worker,
 * which waits longer and reports the cause.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "mailboxes.h"
#include "slave.h"
#include "../carry/xfer.h"
#include "scan.h"

#define WAIT_NS		(20 * NSEC_PER_MSEC)
#define WRITES		4	/* datagrams per slave */

/* one slave between INIT and PREOP */
struct climber {
	struct ec_slave *slave;
	unsigned int first;	/* of its datagrams */
	unsigned int writes;
	u8 page[2 * EC_SM_PAGE];
	u8 al[6];
};

struct job {
	struct ec_bus *bus;
	struct climber *c;
	unsigned int n;
	bool clean;
	struct ec_dg *dg;
};

/* Has each of the @n datagrams reached its slave? */
static bool all_taken(const struct ec_dg *dg, unsigned int n)
{
	while (n--)
		if (dg[n].err || dg[n].wkc != 1)
			return false;
	return true;
}

/* INIT to PREOP: SyncManagers of the mailbox, EEPROM to the PDI, then the request. */
static void scan_preop_start(struct job *j)
{
	static const u8 preop[2] = { EC_AL_PREOP, 0 }, pdi[1] = { EC_EEP_OWNER_PDI };
	unsigned int i, n = 0;

	for (i = 0; i < j->n; i++) {
		struct climber *c = &j->c[i];
		u16 station = c->slave->station;
		unsigned int len = ec_mbox_present(&c->slave->mbox) ?
				   ec_mbox_sms(&c->slave->mbox, false, c->page) : 0;

		c->first = n;
		if (len)
			j->dg[n++] = EC_FPWR(station, EC_REG_SM(0), len, c->page);
		j->dg[n++] = EC_FPWR(station, EC_REG_ECAT_MASK, 2, ec_mailboxes_mask(len));
		j->dg[n++] = EC_FPWR(station, EC_REG_EEP_OWNER, 1, pdi);
		j->dg[n++] = EC_FPWR(station, EC_REG_AL_CONTROL, 2, preop);
		c->writes = n - c->first;
	}
	ec_xfer(j->bus->links, j->dg, n);
	for (i = 0; i < j->n; i++) {
		struct climber *c = &j->c[i];

		c->slave->clean = j->clean;
		/* it may come late, then its worker takes it */
		if (all_taken(&j->dg[c->first], c->writes))
			WRITE_ONCE(c->slave->awaited, EC_AL_PREOP);
	}
}

/* Poll the AL status; slaves in PREOP, or with an error, are done. */
static void scan_preop_look(struct job *j)
{
	unsigned int i, left = 0;

	for (i = 0; i < j->n; i++)
		j->dg[i] = EC_FPRD(j->c[i].slave->station, EC_REG_AL_STATUS, 6, j->c[i].al);
	ec_xfer(j->bus->links, j->dg, j->n);
	for (i = 0; i < j->n; i++) {
		struct climber *c = &j->c[i];

		if (!j->dg[i].err && j->dg[i].wkc == 1) {
			c->slave->al_status = get_unaligned_le16(c->al);
			c->slave->al_code = get_unaligned_le16(c->al + 4);
			if (READ_ONCE(c->slave->al_status) == EC_AL_PREOP) {
				c->slave->ours = true;
				WRITE_ONCE(c->slave->awaited, 0);
				continue;
			}
			/* its worker tries again, without the event */
			if (READ_ONCE(c->slave->al_status) & EC_AL_ERROR) {
				c->slave->mbox.strict = true;
				WRITE_ONCE(c->slave->awaited, 0);
				continue;
			}
		}
		j->c[left++].slave = c->slave;
	}
	j->n = left;
}

/**
 * ec_scan_preop() - bring new slaves from INIT to PREOP in lockstep
 * @bus: bus
 * @slaves: slaves that are not in the list of the bus yet
 * @n: how many
 * @clean: their SyncManagers, FMMUs and SYNC units have been reset
 *
 * Context: The monitor thread. Waits for bus traffic, and then at most some 20 ms for
 * slaves that are slow.
 */
void ec_scan_preop(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n, bool clean)
{
	struct job j = { .bus = bus, .clean = clean };
	unsigned int i, us = 100;
	u64 until;

	j.c = kvcalloc(n, sizeof(*j.c), GFP_KERNEL);
	j.dg = kvcalloc(n, WRITES * sizeof(*j.dg), GFP_KERNEL);
	if (!j.c || !j.dg)
		goto out;
	for (i = 0; i < n; i++)
		if (slaves[i]->sii && !READ_ONCE(slaves[i]->error) &&
		    READ_ONCE(slaves[i]->al_status) == EC_AL_INIT)
			j.c[j.n++].slave = slaves[i];
	if (j.n)
		scan_preop_start(&j);
	/* the frames of a thousand slaves may take as long: none would be polled */
	until = ktime_get_ns() + WAIT_NS;
	while (j.n && !READ_ONCE(bus->base->stopping) && ktime_get_ns() < until) {
		usleep_range(us, us + us / 4);
		us = min(us * 2, 2000u);
		scan_preop_look(&j);
	}
out:
	kvfree(j.c);
	kvfree(j.dg);
}
