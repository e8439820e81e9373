// SPDX-License-Identifier: GPL-2.0-only
/*
 * A trial: a port is open for its frames only, which leave in one send: open twice, work, close
 * twice, as a frame may be lost. The setting is temporary, so that the port closes itself if the
 * master fails.
 *
 * By position nothing is written but a station address that no slave has: when the contact breaks
 * between two frames, the next slave of the ring is at that position, and gets its own back.
 */
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "gap.h"
#include "graph.h"
#include "known.h"
#include "owed.h"
#include "trial_int.h"

/**
 * ec_trial_add() - add a datagram to the work of a trial
 * @t: trials
 * @dg: datagram; there are %EC_TRIAL_WORK at most
 *
 * Context: The monitor thread.
 * Return: the datagram, with its result after ec_trial_run().
 */
struct ec_dg *ec_trial_add(struct ec_trials *t, struct ec_dg dg)
{
	t->work[t->n] = dg;
	return &t->work[t->n++];
}

/* Close the port for good: the frames for that may be lost. */
static void close_surely(const struct ec_trials *t, const u8 *closed)
{
	unsigned int i;

	for (i = 0; i < EC_TRIAL_TRIES; i++)
		if (!ec_xfer_fpwr(t->bus->links, t->host.station, EC_REG_DL_CONTROL, closed, 2))
			return;
}

/*
 * The own address of the slave that has the one meant for the guest. The frame that wrote it has
 * read the one before. If that was lost, it is the next slave of the ring, or the only one that has
 * lost its address, and runs as that did. 0: another device; it may be the guest, connected
 * elsewhere.
 */
static u16 owner_of(const struct ec_trials *t, u16 station, bool next)
{
	const struct ec_slave *s = NULL;
	u16 was;

	if (!t->was)
		return 0;
	was = get_unaligned_le16(t->was);
	if (was)
		return ec_known_is_present(t->bus, was) ? was : 0;
	if (next)
		s = t->next;
	else if (ec_owed_find(t->bus, &s, 1) != 1)
		return 0;
	return s && ec_owed_runs_as(t->bus, station, s) ? s->station : 0;
}

/* A device on the bus has the address of the guest, although the port is closed. */
static void trial_give_back(const struct ec_trials *t, u16 station, bool next)
{
	u16 owner = owner_of(t, station, next);

	if (owner)
		ec_owed_note(t->bus, station, owner);
	if (owner && ec_owed_pay(t->bus))
		ec_warn(t->bus, "trial at station address 0x%04x, port %u: contact lost, station address 0x%04x restored\n",
			t->host.station, t->port, owner);
	else
		ec_warn(t->bus, "trial at station address 0x%04x, port %u: contact lost, another slave has station address 0x%04x now and is scanned again\n",
			t->host.station, t->port, station);
}

/* A port that has closed itself at a loss of link would be opened by the next write as well. */
static bool ports_as_known(const struct ec_trials *t)
{
	u8 open = ec_graph_open_ports(t->dl);
	unsigned int p;

	for (p = 0; p < EC_MAX_PORT; p++)
		if ((t->host.loops >> 2 * p & 3) == EC_LOOP_AUTO_CLOSE && p != t->port &&
		    !(open & BIT(p)))
			return false;
	return true;
}

static bool trial_fits(const struct ec_trials *t)
{
	u32 bytes = 0, i;

	for (i = 0; i < t->n; i++)
		bytes += t->work[i].len;
	return ec_gap_fits(t->bus->links, t->branch_ns, bytes);
}

/**
 * ec_trial_run() - one trial: open, work, close, check
 * @t: trials with the work
 * @station: address that the slave behind the port has or gets
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0; -EAGAIN: frames were lost; -ENOLINK: the contact broke; -ENOBUFS: the cycle leaves too
 * little wire time; -ESTALE: another port of the host has lost its link.
 */
int ec_trial_run(struct ec_trials *t, u16 station)
{
	const u8 opened[2] = { t->host.control | EC_DL_TEMPORARY,
			       ec_loops_with(t->host.loops, t->port, EC_LOOP_AUTO_CLOSE) };
	const u8 closed[2] = { t->host.control & ~EC_DL_TEMPORARY, t->host.loops };
	const struct ec_slave *next = t->next, *up = next ? ec_graph_parent(next) : NULL;
	struct ec_dg *dg = t->train, *work, *close, *check;
	u8 dl[2] = { 0 }, ghost[2], own[2], up_dl[2] = { 0 }, any[1];
	unsigned int n, i;

	if (!trial_fits(t))
		return -ENOBUFS;
	if (t->dl && !ports_as_known(t))
		return -ESTALE;
	n = ec_gap_add(dg, t->branch_ns);
	/* twice: without it the work would be done by the next slave of the ring */
	for (i = 0; i < 2; i++) {
		dg[n] = EC_FPWR(t->host.station, EC_REG_DL_CONTROL, 2, opened);
		dg[n++].last = true;
	}
	work = &dg[n];
	for (i = 0; i < t->n; i++)
		dg[n++] = t->work[i];
	dg[n - 1].last = true;
	n += ec_gap_add(&dg[n], t->branch_ns);
	close = &dg[n];
	for (i = 0; i < 2; i++) {
		dg[n] = EC_FPWR(t->host.station, EC_REG_DL_CONTROL, 2, closed);
		dg[n++].last = true;
	}
	check = &dg[n];
	dg[n++] = EC_FPRD(t->host.station, EC_REG_DL_STATUS, 2, dl);
	dg[n++] = EC_FPRD(station, EC_REG_STATION, 2, ghost);
	dg[n++] = EC_FPRD(next ? next->station : station, EC_REG_STATION, 2, own);
	dg[n++] = EC_FPRD(up ? up->station : station, EC_REG_DL_STATUS, 2, up_dl);
	dg[n++] = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, any);
	ec_xfer_train(t->bus->links, dg, n);
	for (i = 0; i < t->n; i++)
		t->work[i] = work[i];
	if (check[0].err || check[0].wkc != 1 ||
	    !(get_unaligned_le16(dl) & EC_DLS_LOOP(t->port))) {
		close_surely(t, closed);
		for (i = 0; i < 5; i++)
			check[i].repeat = true;
		ec_xfer(t->bus->links, check, 5);
	}
	t->count = check[4].wkc;
	t->dl = check[0].err || check[0].wkc != 1 ? 0 : get_unaligned_le16(dl);
	if (!check[1].err && check[1].wkc) {
		trial_give_back(t, station, next &&
				ec_owed_has_lost(next, &check[2], &check[3], up_dl));
		return -ENOLINK;
	}
	if (!(t->dl & EC_DLS_LINK(t->port)))
		return -ENOLINK;
	for (i = 0; i < t->n; i++)
		if (t->work[i].err)
			return -EAGAIN;
	if (check[4].err)
		return -EAGAIN;
	return close[0].wkc || close[1].wkc ? 0 : -EAGAIN;
}
