// SPDX-License-Identifier: GPL-2.0-only
/*
 * INIT to PREOP or BOOT: SyncManagers of the mailbox, ECAT events, EEPROM to the PDI, then the
 * request. New slaves leave INIT together, in packed frames. A slave that is slow or shows an
 * error is left to its worker, which waits longer and reports the cause.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "al.h"
#include "leave_init.h"
#include "mailboxes.h"
#include "slave.h"
#include "../carry/xfer.h"

#define WAIT_NS		(20 * NSEC_PER_MSEC)
#define FIRST_US	100	/* until the first poll of new slaves */
#define WRITES		5	/* at most, before the request */

/* one of the new slaves */
struct leaver {
	unsigned int first;	/* of its datagrams */
	unsigned int n;
	u8 page[2 * EC_SM_PAGE];
};

struct job {
	struct ec_slave **slaves;	/* of the caller */
	struct leaver *leavers;
	struct ec_al_poll *polls;
	struct ec_dg *dg;
	unsigned int n;			/* entries in @leavers and @polls */
};

/*
 * What a slave needs before the request; @page: memory for its SyncManagers. Return: datagrams
 * at @dg.
 */
static unsigned int add_writes(struct ec_slave *s, u8 state, u8 *page, struct ec_dg *dg)
{
	static const u8 off[1], pdi[1] = { EC_EEP_OWNER_PDI };
	unsigned int len = ec_mbox_sms(&s->mbox, state == EC_AL_BOOT, page), sm, n = 0;

	/* a SyncManager that is active keeps its control byte */
	for (sm = 0; len && s->mbox.strict && sm < 2; sm++)
		dg[n++] = EC_FPWR(s->station, EC_REG_SM(sm) + EC_SM_OFS_ACTIVATE, 1, off);
	if (len)
		dg[n++] = EC_FPWR(s->station, EC_REG_SM(0), len, page);
	dg[n++] = EC_FPWR(s->station, EC_REG_ECAT_MASK, 2, ec_mailboxes_mask(len));
	dg[n++] = EC_FPWR(s->station, EC_REG_EEP_OWNER, 1, pdi);
	return n;
}

/**
 * ec_leave_init() - bring a slave from INIT to PREOP or BOOT
 * @s: slave in INIT, with FMMUs and SyncManagers off
 * @state: EC_AL_PREOP or EC_AL_BOOT
 * @timeout_ms: as in ec_al_set()
 *
 * The request follows only when all that it needs was written.
 *
 * Context: The slave's worker. Waits for bus traffic, until the time limit.
 * Return: as ec_al_set(), or as ec_xfer_all().
 */
int ec_leave_init(struct ec_slave *s, u8 state, u32 timeout_ms)
{
	u8 page[2 * EC_SM_PAGE];
	struct ec_dg dg[WRITES];

	return ec_xfer_all(s->bus->links, dg, add_writes(s, state, page, dg)) ?:
	       ec_al_set(s, state, timeout_ms);
}

/* Has each of the @n datagrams reached its slave? */
static bool all_taken(const struct ec_dg *dg, unsigned int n)
{
	while (n--)
		if (dg[n].err || dg[n].wkc != 1)
			return false;
	return true;
}

/* The writes and requests of all. */
static void request_all(struct job *j, struct ec_links *links, bool clean)
{
	static const u8 preop[2] = { EC_AL_PREOP };
	unsigned int i, n = 0;

	for (i = 0; i < j->n; i++) {
		struct ec_slave *s = j->polls[i].slave;
		struct leaver *l = &j->leavers[i];

		l->first = n;
		n += add_writes(s, EC_AL_PREOP, l->page, &j->dg[n]);
		j->dg[n++] = EC_FPWR(s->station, EC_REG_AL_CONTROL, 2, preop);
		l->n = n - l->first;
	}
	ec_xfer(links, j->dg, n);
	for (i = 0; i < j->n; i++) {
		struct ec_slave *s = j->polls[i].slave;

		s->work.clean = clean;
		/* it may come late, then its worker takes it */
		if (all_taken(&j->dg[j->leavers[i].first], j->leavers[i].n))
			WRITE_ONCE(s->al.awaited, EC_AL_PREOP);
	}
}

/* Poll all; a slave in PREOP, or with an error, is done. */
static void poll_all(struct job *j)
{
	struct ec_al_goal goal = {
		.mask = EC_AL_STATE_MASK | EC_AL_ERROR, .value = EC_AL_PREOP,
		.first_us = FIRST_US,
	};
	unsigned int i;

	/* the frames of a thousand slaves may take as long: none would be polled */
	goal.until_ns = ktime_get_ns() + WAIT_NS;
	ec_al_poll(j->polls, j->n, j->dg, &goal);
	for (i = 0; i < j->n; i++) {
		struct ec_slave *s = j->polls[i].slave;

		/* its worker tries again, without the event */
		if (j->polls[i].ret == -EPROTO)
			s->mbox.strict = true;
		else if (j->polls[i].ret)
			continue;
		else
			s->work.ours = true;
		WRITE_ONCE(s->al.awaited, 0);
	}
}

/**
 * ec_leave_init_all() - bring new slaves from INIT to PREOP together
 * @bus: bus
 * @slaves: slaves that are not in the list of the bus yet
 * @n: how many
 * @clean: their SyncManagers, FMMUs and SYNC units have been reset
 *
 * Context: The monitor thread. Waits for bus traffic, and then at most some 20 ms for
 * slaves that are slow.
 */
void ec_leave_init_all(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n, bool clean)
{
	struct job j = { 0 };
	unsigned int i;

	j.leavers = kvcalloc(n, sizeof(*j.leavers), GFP_KERNEL);
	j.polls = kvcalloc(n, sizeof(*j.polls), GFP_KERNEL);
	j.dg = kvcalloc(n, (WRITES + 1) * sizeof(*j.dg), GFP_KERNEL);
	if (!j.leavers || !j.polls || !j.dg)
		goto out;
	for (i = 0; i < n; i++)
		if (slaves[i]->eeprom.data && !READ_ONCE(slaves[i]->note.error) &&
		    READ_ONCE(slaves[i]->al.status) == EC_AL_INIT)
			j.polls[j.n++].slave = slaves[i];
	if (j.n) {
		request_all(&j, bus->links, clean);
		poll_all(&j);
	}
out:
	kvfree(j.leavers);
	kvfree(j.polls);
	kvfree(j.dg);
}
