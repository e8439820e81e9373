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

/* Does @s not reply at its address, although the port at which it hangs is open? */
static bool has_lost_address(const struct ec_slave *s, const struct ec_dg *own,
			     const struct ec_dg *up, const u8 *dl)
{
	if (own->err || own->wkc)
		return false;
	return !ec_graph_parent(s) ||
	       (!up->err && up->wkc == 1 &&
		ec_graph_open_ports(get_unaligned_le16(dl)) & BIT(s->graph.parent_port));
}

/* The only slave of the list that has lost its address; 0: there is none, or more */
static u16 find_owner(struct ec_bus *bus)
{
	struct ec_dg *dg = kvcalloc(bus->n_slaves, sizeof(*dg), GFP_KERNEL);
	u8 (*dl)[2] = kvcalloc(bus->n_slaves, sizeof(*dl), GFP_KERNEL);
	unsigned int n = 0;
	u16 station = 0;

	if (!dg || !dl)
		goto out;
	ec_for_each_slave(s, bus) {
		dg[n] = EC_FPRD(s->station, EC_REG_DL_STATUS, 2, dl[n]);
		n++;
	}
	ec_xfer(bus->links, dg, n);
	n = 0;
	ec_for_each_slave(s, bus) {
		unsigned int up = ec_graph_parent(s) ? ec_graph_parent(s)->position : 0;

		if (dg[s->position].wkc == 1)
			s->dl_seen = get_unaligned_le16(dl[s->position]);
		if (!has_lost_address(s, &dg[s->position], &dg[up], dl[up]))
			continue;
		n++;
		station = s->station;
	}
out:
	kvfree(dg);
	kvfree(dl);
	return n == 1 ? station : 0;
}

/*
 * A slave of the bus has the address of the guest, although the port is closed: the contact broke
 * before the address was written. The frame that wrote it has read its own; if that was lost, it is
 * the next one of the ring, unless others were disconnected as well.
 */
static void trial_give_back(const struct ec_trials *t, u16 station, bool next)
{
	u16 owner = t->was ? get_unaligned_le16(t->was) : 0;

	if (!ec_known_is_present(t->bus, owner))
		owner = next ? t->next->station : find_owner(t->bus);
	if (owner) {
		ec_owed_note(t->bus, station, owner);
		ec_owed_pay(t->bus);
	}
	if (owner)
		ec_warn(t->bus, "trial at station address 0x%04x, port %u: contact lost, station address 0x%04x restored\n",
			t->host.station, t->port, owner);
	else
		ec_warn(t->bus, "trial at station address 0x%04x, port %u: contact lost, another slave has station address 0x%04x now and is scanned again\n",
			t->host.station, t->port, station);
}

static bool fits(const struct ec_trials *t)
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
 * little wire time.
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

	if (!fits(t))
		return -ENOBUFS;
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
				has_lost_address(next, &check[2], &check[3], up_dl));
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
