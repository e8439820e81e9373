// SPDX-License-Identifier: GPL-2.0-only
/*
 * Station addresses are the only thing that is written by ring position, and another slave is at
 * that position when a contact has opened or closed. So none is written unless the addresses still
 * are what the scan has read, and the frame that writes one reads the one before: a slave that got
 * an address by mistake gets its own back. Such a frame is never repeated.
 */
#include "../link/links.h"
#include "../carry/xfer.h"
#include "owed.h"
#include "scan_address.h"
#include "scan_count.h"
#include "scan_int.h"

#define TORN_MAX	20u	/* scans in a row that end as a slave contradicts itself */

/* datagrams for a slave, the last one of which writes */
enum {
	NO_WRITE,	/* it has not replied: another one could be in its place by now */
	WRITE_ONLY,	/* at its own address, or there is no known slave that could be hit */
	READ_WRITE,
};

static unsigned int datagrams(const struct scan *sc, unsigned int i)
{
	const struct regs *r = &sc->regs[i];

	return !sc->bus->n_slaves || r->own ? WRITE_ONLY : r->there ? READ_WRITE : NO_WRITE;
}

/* Was the address of the slave at @i read at another position as well? */
static bool is_read_twice(const struct scan *sc, unsigned int i)
{
	return sc->regs[i].was && sc->claims[sc->regs[i].was] > 1;
}

/* Reads that say whether this is so now. Returns how many. */
static unsigned int prove_add(struct scan *sc, struct ec_dg *dg, unsigned int i)
{
	struct regs *r = &sc->regs[i];

	dg[0] = EC_DG(EC_CMD_APRD, (u16)-i, EC_REG_STATION, 2, r->before);
	if (!is_read_twice(sc, i))
		return 1;
	dg[1] = EC_FPRD(r->was, EC_REG_STATION, 2, r->al);
	return 2;
}

/* It still has its address, and of two that have the same both reply. */
static bool is_as_read(const struct scan *sc, unsigned int i, const struct ec_dg *dg)
{
	const struct regs *r = &sc->regs[i];

	return dg[0].wkc == 1 && get_unaligned_le16(r->before) == r->was &&
	       (!is_read_twice(sc, i) || dg[1].wkc > 1);
}

/*
 * When slaves come between two frames that read addresses, those behind them are read at two
 * positions: at the second one is a slave that is known and runs. -EAGAIN: so it may be.
 */
static int prove_read(struct scan *sc, const u16 *at, unsigned int n)
{
	struct ec_bus *bus = sc->bus;
	struct ec_dg *dg = sc->dg;
	bool torn = false;
	unsigned int i;
	int ret;

	for (i = 0; i < n; i++)
		if (datagrams(sc, at[i]) == READ_WRITE)
			dg += prove_add(sc, dg, at[i]);
	ret = ec_xfer(bus->links, sc->dg, dg - sc->dg);
	if (ret)
		return ret;
	dg = sc->dg;
	for (i = 0; i < n; i++) {
		if (datagrams(sc, at[i]) != READ_WRITE)
			continue;
		torn |= !is_as_read(sc, at[i], dg);
		dg += is_read_twice(sc, at[i]) ? 2 : 1;
	}
	/* no slave contradicts itself while others come and go */
	if (torn && ec_scan_count_again(sc) != 1)
		return -EAGAIN;
	bus->torn = torn ? min(bus->torn + 1, TORN_MAX + 1) : 0;
	return torn && bus->torn <= TORN_MAX ? -EAGAIN : 0;
}

static void address_add(struct scan *sc, struct ec_dg *dg, unsigned int i)
{
	struct regs *r = &sc->regs[i];
	u16 adp = -i;

	switch (datagrams(sc, i)) {
	case WRITE_ONLY:
		*dg = r->own ? EC_FPWR(r->own, EC_REG_STATION, 2, r->station) :
			       EC_DG(EC_CMD_APWR, adp, EC_REG_STATION, 2, r->station);
		break;
	case READ_WRITE:
		dg[0] = EC_DG(EC_CMD_APRD, adp, EC_REG_STATION, 2, r->before);
		dg[0].pair = true;
		dg[1] = EC_DG(EC_CMD_APWR, adp, EC_REG_STATION, 2, r->station);
		dg[0].repeat = dg[1].repeat = false;
		break;
	}
}

/* Slaves that got the address of another one get their own back. Returns how many. */
static unsigned int address_give_back(struct scan *sc, const u16 *at, unsigned int n)
{
	const struct ec_dg *dg = sc->dg;
	unsigned int i, k = 0;

	for (i = 0; i < n; i++) {
		struct regs *r = &sc->regs[at[i]];
		u16 before = get_unaligned_le16(r->before);

		dg += datagrams(sc, at[i]);
		if (datagrams(sc, at[i]) != READ_WRITE || dg[-1].err || dg[-1].wkc != 1 ||
		    !before || before == r->was)
			continue;
		r->gone = true;
		ec_owed_note(sc->bus, ec_scan_address(sc, at[i]), before);
		k++;
	}
	if (!k)
		return 0;
	ec_warn(sc->bus, "scan: slaves left the ring while station addresses were written, those of %u others %s\n",
		k, ec_owed_pay(sc->bus) ? "restored" : "are restored when these reply");
	return k;
}

/* The address that @i got meanwhile, or 0: a slave of the list could have it by mistake. */
static u16 doubtful(const struct scan *sc, unsigned int i, const struct ec_dg *write)
{
	u16 before = get_unaligned_le16(sc->regs[i].before);

	if (datagrams(sc, i) != READ_WRITE)
		return 0;
	if (write->err)
		return ec_scan_address(sc, i);
	/* it got two of them, in the frame before by mistake as well */
	return write->wkc == 1 && before != sc->regs[i].was && !sc->known[before] ? before : 0;
}

/* Such addresses, of which a slave beyond PREOP has each. */
static unsigned int find_doubtful(struct scan *sc, const u16 *at, unsigned int n, u16 *used)
{
	const struct ec_dg *dg = sc->dg;
	unsigned int i, k = 0, found = 0;

	for (i = 0; i < n; i++) {
		dg += datagrams(sc, at[i]);
		used[k] = doubtful(sc, at[i], &dg[-1]);
		k += used[k] != 0;
	}
	for (i = 0; i < k; i++)
		sc->dg[i] = EC_FPRD(used[i], EC_REG_AL_STATUS, 2, sc->regs[i].al);
	ec_xfer(sc->bus->links, sc->dg, k);
	for (i = 0; i < k; i++)
		if (!sc->dg[i].err && sc->dg[i].wkc == 1 &&
		    get_unaligned_le16(sc->regs[i].al) & EC_AL_BEYOND_PREOP)
			used[found++] = used[i];
	return found;
}

/* Those with process data: their FMMUs say which they are. Returns how many others are left. */
static unsigned int give_back_mapped(struct ec_bus *bus, u16 *used, unsigned int n,
				     const struct ec_slave **owner)
{
	unsigned int i, left = 0;

	ec_owed_by_fmmu(bus, used, n, owner);
	for (i = 0; i < n; i++) {
		if (owner[i])
			ec_owed_note(bus, used[i], owner[i]->station);
		else
			used[left++] = used[i];
	}
	if (left < n)
		ec_owed_pay(bus);
	return left;
}

/*
 * The frame that wrote an address is lost, and a running slave has it: no new one runs. If as many
 * slaves without process data have lost theirs, it is one of these, in the order of the ring.
 */
static void give_back_lost(struct scan *sc, const u16 *at, unsigned int n)
{
	const struct ec_slave **lost = kvcalloc(n, sizeof(*lost), GFP_KERNEL);
	u16 *used = kvcalloc(n, sizeof(*used), GFP_KERNEL);
	unsigned int i = 0, k = lost && used ? find_doubtful(sc, at, n, used) : 0;

	k = k ? give_back_mapped(sc->bus, used, k, lost) : 0;
	if (k && ec_owed_find(sc->bus, lost, k) == k)
		while (i < k && ec_owed_runs_as(sc->bus, used[i], lost[i]))
			i++;
	if (k && i == k) {
		for (i = 0; i < k; i++)
			ec_owed_note(sc->bus, used[i], lost[i]->station);
		ec_owed_pay(sc->bus);
	}
	kvfree(lost);
	kvfree(used);
}

/* Does one reply there that has not when addresses were read? */
static bool replies(const struct scan *sc, unsigned int i)
{
	u8 station[2];
	struct ec_dg dg = EC_DG(EC_CMD_APRD, (u16)-i, EC_REG_STATION, 2, station);

	return ec_xfer(sc->bus->links, &dg, 1) || dg.wkc;
}

/**
 * ec_scan_address_all() - write the station addresses of slaves that need one
 * @sc: scan
 * @at: ring positions of these slaves
 * @n: how many
 *
 * A slave that does not accept it is marked as failed.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0; -EAGAIN: the ring has changed meanwhile; or as ec_xfer().
 */
int ec_scan_address_all(struct scan *sc, const u16 *at, unsigned int n)
{
	struct ec_dg *dg = sc->dg;
	int same = -1, ret = prove_read(sc, at, n);
	unsigned int i, k;

	if (ret)
		return ret;
	for (i = 0; i < n; i++) {
		address_add(sc, dg, at[i]);
		dg += datagrams(sc, at[i]);
	}
	ret = ec_xfer(sc->bus->links, sc->dg, dg - sc->dg);
	dg = sc->dg;
	for (i = 0; i < n && !ret; i++) {
		dg += datagrams(sc, at[i]);
		if (datagrams(sc, at[i]) && dg[-1].wkc == 1)
			continue;
		same = same < 0 ? ec_scan_count_again(sc) : same;
		sc->regs[at[i]].gone = same != 1 ||
				       (!datagrams(sc, at[i]) && replies(sc, at[i]));
		if (sc->regs[at[i]].gone)
			continue;
		ec_slave_fail(sc->slaves[at[i]], EC_SLAVE_SCAN_FAILED, EC_CAUSE(REGISTERS), "%s",
			      datagrams(sc, at[i]) ?
			      "station address not accepted, frames pass; power-cycle or replace the slave, then rescan" :
			      "no reply at its ring position, frames pass; power-cycle or replace the slave, then rescan");
	}
	k = address_give_back(sc, at, n);
	/* some frames may have returned, and others not */
	if ((k || ret == -ETIMEDOUT) && sc->bus->n_slaves)
		give_back_lost(sc, at, n);
	return k ? -EAGAIN : ret;
}
