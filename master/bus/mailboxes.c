// SPDX-License-Identifier: GPL-2.0-only
/*
 * Messages that slaves send without a request, emergencies above all, are fetched soon and in
 * every state, without an application, and at no cost while there are none: a full mailbox
 * shows as an event in the IRQ field of each datagram (register 0x0200).
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../base/once64.h"
#include "../link/links.h"
#include "../carry/xfer.h"
#include "../wire/regs.h"
#include "mailboxes.h"
#include "slave.h"

#define ALL_NS		NSEC_PER_SEC		/* between polls of all mailboxes */
#define SOME_NS		(60 * NSEC_PER_MSEC)	/* of those of slaves that show no event */
#define VAIN		5			/* polls without message, then one each SOME_NS */
#define UNSHOWN		3			/* messages without event, then it is one of them */

/**
 * ec_mailboxes_polled() - does a full mailbox of the slave show as no event?
 * @s: slave
 *
 * Context: The monitor thread.
 * Return: true, then ec_mailboxes_look() has to be called often.
 */
bool ec_mailboxes_polled(const struct ec_slave *s)
{
	return s->unshown == UNSHOWN || s->mbox.strict;
}

/* Is its mailbox worth a look? A caller that uses it fetches all there is. */
static bool is_candidate(struct ec_slave *s, bool all)
{
	return (all || ec_mailboxes_polled(s)) && ec_mbox_present(&s->mbox) &&
	       READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED && !ec_slave_busy(s) &&
	       (READ_ONCE(s->al.status) & EC_AL_STATE_MASK) >= EC_AL_PREOP &&
	       !ec_mbox_is_read(&s->mbox);
}

static bool any_in_use(const struct ec_bus *bus)
{
	ec_for_each_slave(s, bus)
		if (ec_mbox_in_use(&s->mbox))
			return true;
	return false;
}

/* Poll the mailboxes of the candidates; @shown: the event of one was seen. True: one is full. */
static bool mailboxes_look(struct ec_bus *bus, bool all, bool shown)
{
	bool found = false;
	struct ec_slave **of;
	unsigned int i, n = 0, most = 0;
	struct ec_dg *dg;
	u8 *status;

	ec_for_each_slave(s, bus)
		most += is_candidate(s, all);
	if (!most)
		return false;
	dg = kvcalloc(most, sizeof(*dg), GFP_KERNEL);
	of = kvcalloc(most, sizeof(*of), GFP_KERNEL);
	status = kvzalloc(most, GFP_KERNEL);
	if (!dg || !of || !status)
		goto out;
	ec_for_each_slave(s, bus) {
		if (n == most || !is_candidate(s, all))
			continue;
		dg[n] = EC_FPRD(s->station, EC_REG_SM(1) + EC_SM_OFS_STATUS, 1, &status[n]);
		of[n++] = s;
	}
	if (n)
		ec_xfer(bus->links, dg, n);
	for (i = 0; i < n; i++) {
		if (dg[i].err || dg[i].wkc != 1 || !(status[i] & EC_SM_ST_FULL))
			continue;
		/* a message may have come after @irq */
		if (of[i]->unshown < UNSHOWN)
			of[i]->unshown = shown ? 0 : of[i]->unshown + 1;
		found = true;
		ec_mbox_fetch(&of[i]->mbox);
	}
out:
	kvfree(dg);
	kvfree(of);
	kvfree(status);
	return found;
}

/**
 * ec_mailboxes_mask() - the ECAT events that a slave has to show
 * @mailbox: its SM1 is a mailbox
 *
 * Context: Any.
 * Return: two bytes for register 0x0200: ports, AL status, and SM1 if that is a mailbox.
 */
const u8 *ec_mailboxes_mask(bool mailbox)
{
	static const u8 mask[][2] = {
		{ EC_ECAT_EVENT_DL | EC_ECAT_EVENT_AL },
		{ EC_ECAT_EVENT_DL | EC_ECAT_EVENT_AL | EC_ECAT_EVENT_SM(1) },
	};

	return mask[mailbox];
}

/**
 * ec_mailboxes_watch() - which event in a cyclic frame is worth an immediate poll
 * @bus: bus, scanned
 * @exchange: callers wait for answers
 *
 * Context: The monitor thread.
 * Return: that of SM1; 0 for @exchange, or when %VAIN polls found no message.
 */
u16 ec_mailboxes_watch(const struct ec_bus *bus, bool exchange)
{
	return bus->vain_looks >= VAIN || exchange ? 0 : EC_ECAT_EVENT_SM(1);
}

/**
 * ec_mailboxes_look() - fetch messages that slaves have sent without a request
 * @bus: bus, scanned
 * @irq: IRQ field of a datagram that has passed all slaves just now
 *
 * Context: The monitor thread. Waits for bus traffic when there is a message, and once a
 * second.
 * Return: whether there was one, which is being fetched.
 */
bool ec_mailboxes_look(struct ec_bus *bus, u16 irq)
{
	bool shown = irq & EC_ECAT_EVENT_SM(1);
	u64 now = ktime_get_ns();
	bool all = now - bus->mailboxes_ns >= ALL_NS, found;

	/* the event may be that of an answer, or of a slave that shows it without end */
	if (!all && (!shown || bus->vain_looks >= VAIN || any_in_use(bus)) &&
	    now - bus->some_mailboxes_ns < SOME_NS)
		return false;
	bus->some_mailboxes_ns = now;
	if (all)
		bus->mailboxes_ns = now;
	/* a rider's reply is old: the message may have been fetched already */
	found = mailboxes_look(bus, shown || all, shown);
	bus->vain_looks = found || !shown ? 0 : bus->vain_looks + 1;
	return found;
}
