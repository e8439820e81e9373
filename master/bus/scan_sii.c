// SPDX-License-Identifier: GPL-2.0-only
/*
 * Reading the EEPROMs of many slaves in lockstep. One command starts the same
 * read everywhere, packed reads collect the results. A slave that is slow,
 * refuses, misses the command or has come to its end leaves the lockstep.
 * Beside a cycle each slave is read by itself, see scan_chain.c.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "ports_lost.h"
#include "scan_count.h"
#include "scan_sii.h"
#include "scan_sii_int.h"

#define CHAINS		16	/* slaves that are read in the context of the cycle, at most */
#define STEP_TIMEOUT_NS	(20 * NSEC_PER_MSEC)	/* of one access to the EEPROM */
#define STRAGGLER_NS	(4 * NSEC_PER_MSEC)	/* when the slowest tenth is left behind */
#define PROBE_NS	(2 * NSEC_PER_MSEC)	/* while no slave is ready, few are asked */
#define PROBE		8
#define WAIT_MAX_NS	(2 * NSEC_PER_MSEC)
#define POLL_US		40
#define RETRIES		5
#define TAKE_OVER	3	/* datagrams to take over one EEPROM, or to begin once more */

/* Take a result; true when the slave has answered what was asked. */
static bool scan_sii_take(struct reader *r)
{
	u16 ctl = get_unaligned_le16(r->reg);
	size_t got = min_t(size_t, ctl & EC_EEP_READ8 ? 8 : 4, r->len - 6);

	if (!ec_scan_has_word(r->reg, ec_scan_image_word(r)))
		return false;
	r->len = 6 + got;
	r->tries = 0;
	ec_scan_image_take(r, r->reg + 6, got);
	return true;
}

/*
 * Take the EEPROM interface away from the PDI (0x0500). The address is set to one that is never
 * read, so that the data of a slave that misses the first command are not taken for word 0.
 */
static int scan_sii_take_over(struct job *j, struct reader **rds, unsigned int n)
{
	static const u8 force[1] = { EC_EEP_OWNER_FORCE }, zero[1];
	static const u8 nowhere[4] = { 0xff, 0xff, 0xff, 0xff };
	unsigned int i;
	struct ec_dg *dg = j->dg;

	for (i = 0; i < n; i++) {
		u16 station = rds[i]->slave->station;

		*dg++ = EC_FPWR(station, EC_REG_EEP_OWNER, 1, force);
		*dg++ = EC_FPWR(station, EC_REG_EEP_OWNER, 1, zero);
		*dg++ = EC_FPWR(station, EC_REG_EEP_ADDRESS, 4, nowhere);
	}
	return ec_xfer(j->bus->links, j->dg, dg - j->dg);
}

/* FPRD 0x0502 of @n readers */
static void scan_sii_collect(struct job *j, struct reader **rds, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++)
		j->dg[i] = EC_FPRD(rds[i]->slave->station, EC_REG_EEP_CONTROL, rds[i]->len,
				   rds[i]->reg);
	ec_xfer(j->bus->links, j->dg, n);
	for (i = 0; i < n; i++) {
		rds[i]->unheard = j->dg[i].err || j->dg[i].wkc != 1;
		if (rds[i]->unheard)
			put_unaligned_le16(EC_EEP_BUSY, rds[i]->reg);
	}
}

/*
 * A slave that does not reply may have been disconnected: it is neither read nor marked. Returns
 * the number of those that remain.
 */
static unsigned int drop_gone(struct job *j, struct reader **rds, unsigned int n)
{
	unsigned int i, k = 0;
	int count;

	for (i = 0; i < n && !rds[i]->unheard; i++)
		;
	if (i == n)
		return n;
	count = ec_scan_count(j->bus);
	if (count == j->count)
		return n;
	for (i = 0; i < n; i++)
		if (rds[i]->unheard)
			ec_scan_image_done(rds[i]);
		else
			rds[k++] = rds[i];
	if (count >= 0)
		j->count = count;
	return k;
}

/* Start the same read in all of @rds; broadcast where all slaves are meant. */
static void scan_sii_start(struct job *j, struct reader **rds, unsigned int n, u32 word)
{
	unsigned int i;

	ec_scan_command(j->cmd[0], word);
	if (j->broadcast) {
		ec_xfer_one(j->bus->links, EC_CMD_BWR, 0, EC_REG_EEP_CONTROL, j->cmd[0], 6);
		return;
	}
	for (i = 0; i < n; i++)
		j->dg[i] = EC_FPWR(rds[i]->slave->station, EC_REG_EEP_CONTROL, 6, j->cmd[0]);
	ec_xfer(j->bus->links, j->dg, n);
}

static void scan_sii_sleep_until(u64 ns)
{
	u64 now = ktime_get_ns();

	if (ns > now + NSEC_PER_USEC)
		usleep_range(div_u64(ns - now, NSEC_PER_USEC),
			     div_u64(ns - now, NSEC_PER_USEC) + 5);
}

/*
 * When to poll first next time: a little sooner, until that was too soon once.
 * @first: the first poll found all slaves ready.
 */
static void scan_sii_learn(struct job *j, u64 ready_ns, bool first)
{
	if (!j->wait_ns) {
		j->wait_ns = min_t(u64, ready_ns, WAIT_MAX_NS);
	} else if (first) {
		j->good_ns = j->wait_ns;
		if (!j->settled)
			j->wait_ns -= j->wait_ns / 16;
	} else {
		j->wait_ns = j->wait_ns < j->good_ns ? j->good_ns :
			     min_t(u64, j->wait_ns + j->wait_ns / 8, WAIT_MAX_NS);
		j->settled = true;
	}
}

/* Ask the first @ask of @left readers; the ones without a result yet remain. */
static unsigned int scan_sii_look(struct job *j, struct reader **rds, unsigned int ask,
				  unsigned int left)
{
	unsigned int i, k = 0;

	scan_sii_collect(j, rds, ask);
	for (i = 0; i < ask; i++) {
		if (scan_sii_take(rds[i]))
			continue;
		if (ec_scan_is_refused(rds[i]->reg))
			rds[i]->alone = true;
		else
			rds[k++] = rds[i];
	}
	memmove(&rds[k], &rds[ask], (left - ask) * sizeof(*rds));
	return left - ask + k;
}

/* One access for all slaves at word @word. */
static void scan_sii_step(struct job *j, struct reader **rds, unsigned int n, u32 word)
{
	u64 t0 = ktime_get_ns(), looked, ready = 0;
	unsigned int i, left = n, ask, before;
	bool first = true, probe = !j->wait_ns;

	scan_sii_start(j, rds, n, word);
	scan_sii_sleep_until(t0 + j->wait_ns);
	for (;;) {
		looked = ktime_get_ns() - t0;
		ask = probe ? min_t(unsigned int, left, PROBE) : left;
		before = left;
		left = scan_sii_look(j, rds, ask, left);
		if (left < before && !ready)
			ready = looked;
		if (!left)
			break;
		left = drop_gone(j, rds, left);
		if (!left || !ec_scan_sii_goes_on(j))
			return;
		/* the slowest tenth is handled apart instead of holding the others */
		if (looked > STEP_TIMEOUT_NS || (left * 10 <= n && looked > STRAGGLER_NS)) {
			for (i = 0; i < left; i++)
				rds[i]->alone = true;
			return;
		}
		probe = left == before && looked < PROBE_NS;
		if (left < before && ask < before)
			continue;	/* some are ready: ask all of them */
		first = false;
		ready = 0;
		usleep_range(POLL_US, POLL_US + 5);
	}
	scan_sii_learn(j, ready, first);
}

/*
 * Each of @rds reads at its own word. Errors are acknowledged first, and the PDI loses the EEPROM:
 * a contact may have been open when that was done for all.
 */
static void start_apart(struct job *j, struct reader **rds, unsigned int n)
{
	static const u8 force[1] = { EC_EEP_OWNER_FORCE }, zero[2];
	unsigned int i, k = 0;

	for (i = 0; i < n; i++) {
		u16 station = rds[i]->slave->station;

		j->dg[k++] = EC_FPWR(station, EC_REG_EEP_OWNER, 1, force);
		j->dg[k++] = EC_FPWR(station, EC_REG_EEP_OWNER, 1, zero);
		if (get_unaligned_le16(rds[i]->reg) & EC_EEP_ERR_MASK)
			j->dg[k++] = EC_FPWR(station, EC_REG_EEP_CONTROL, 2, zero);
	}
	ec_xfer(j->bus->links, j->dg, k);
	for (i = 0; i < n; i++) {
		ec_scan_command(j->cmd[i], ec_scan_image_word(rds[i]));
		j->dg[i] = EC_FPWR(rds[i]->slave->station, EC_REG_EEP_CONTROL, 6, j->cmd[i]);
	}
	ec_xfer(j->bus->links, j->dg, n);
}

/* Those that left the lockstep and are not done; without tries left they fail. */
static unsigned int apart(struct job *j, struct reader **rds)
{
	unsigned int i, n = 0;

	for (i = 0; i < j->n; i++) {
		struct reader *r = &j->rd[i];

		if (r->done)
			continue;
		if (r->tries++ >= RETRIES)
			ec_scan_image_fail(r, r->unheard ? "no reply" :
				      ec_scan_is_refused(r->reg) ? "no acknowledge" : "busy too long",
				      "check the slave, then rescan");
		else
			rds[n++] = r;
	}
	return n;
}

/*
 * Slaves that could not keep up: by themselves, side by side, with retries.
 * One that never answers costs its tries, however many of them there are.
 */
static void read_apart(struct job *j)
{
	unsigned int n, left;
	u64 t0;

	for (; ec_scan_sii_goes_on(j) && (n = apart(j, j->rds)); ec_scan_image_interrupt(j)) {
		start_apart(j, j->rds, n);
		t0 = ktime_get_ns();
		for (left = n;
		     left && ktime_get_ns() - t0 < STEP_TIMEOUT_NS && ec_scan_sii_goes_on(j);) {
			usleep_range(300, 400);
			left = drop_gone(j, j->rds, scan_sii_look(j, j->rds, left, left));
		}
		ec_ports_look_for_lost(j->bus);
	}
}

static bool in_lockstep(const struct reader *r)
{
	return !r->done && !r->alone;
}

/* The readers in the lockstep that need the smallest word, and that word. */
static unsigned int waiting(struct job *j, u32 *word)
{
	unsigned int i, n = 0;

	*word = U32_MAX;
	for (i = 0; i < j->n; i++)
		if (in_lockstep(&j->rd[i]))
			*word = min(*word, ec_scan_image_word(&j->rd[i]));
	for (i = 0; i < j->n; i++)
		if (in_lockstep(&j->rd[i]) && ec_scan_image_word(&j->rd[i]) == *word)
			j->rds[n++] = &j->rd[i];
	return n;
}

static void scan_sii_run(struct job *j)
{
	unsigned int n;
	u32 word;

	n = waiting(j, &word);
	/* no fault of a slave: the scan begins again */
	if (scan_sii_take_over(j, j->rds, n) == -ENOMEM)
		return;
	/* what the cycle does for each of them takes its time; many share frames in lockstep */
	if (ec_access_is_cyclic(&j->bus->links->access) && n <= CHAINS)
		ec_scan_chain_run(j);
	for (n = waiting(j, &word); n && ec_scan_sii_goes_on(j); n = waiting(j, &word)) {
		scan_sii_step(j, j->rds, n, word);
		ec_scan_image_interrupt(j);
		ec_ports_look_for_lost(j->bus);
	}
	read_apart(j);
}

/**
 * ec_scan_sii() - read the EEPROMs of @slaves
 * @bus: bus
 * @slaves: slaves with station addresses; @sii is set where it worked, @part where more
 *	is to be read, the others are marked as failed unless the link went down meanwhile
 * @n: how many
 * @count: slaves on the bus; when their number changes, one that does not reply is neither read
 *	nor marked
 * @all: these are all slaves of the segment and no process data run, so
 *	broadcasts are allowed
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_scan_sii(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n,
		 unsigned int count, bool all)
{
	struct job j = {
		.bus = bus, .n = n, .count = count, .broadcast = all, .began_ns = ktime_get_ns(),
	};
	unsigned int i;

	j.rd = kvcalloc(n, sizeof(*j.rd), GFP_KERNEL);
	j.dg = kvcalloc(n, TAKE_OVER * sizeof(*j.dg), GFP_KERNEL);
	j.cmd = kvcalloc(n, sizeof(*j.cmd), GFP_KERNEL);
	j.rds = kvcalloc(n, sizeof(*j.rds), GFP_KERNEL);
	if (!j.rd || !j.dg || !j.cmd || !j.rds)
		goto out;
	for (i = 0; i < n; i++)
		ec_scan_image_begin(&j.rd[i], slaves[i]);
	scan_sii_run(&j);
	for (i = 0; i < n; i++)
		ec_scan_image_drop(&j.rd[i]);
out:
	kvfree(j.rd);
	kvfree(j.dg);
	kvfree(j.cmd);
	kvfree(j.rds);
}
