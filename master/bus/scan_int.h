/* SPDX-License-Identifier: GPL-2.0-only */
/* What the files of the scan share. */
#ifndef EC_SCAN_INT_H
#define EC_SCAN_INT_H

#include "../wire/regs.h"
#include "slave.h"

struct ec_dg;

/* registers read from every slave in each scan */
struct regs {
	u8 info[EC_INFO_SIZE];
	u8 station[4];		/* 0x0010 station, 0x0012 alias */
	u16 was;		/* 0x0010 before it got another one */
	u16 own;		/* likewise, if no other slave has that; else 0 */
	u8 before[2];		/* 0x0010 of the slave that got the address of this one */
	u8 control[2];		/* 0x0100, 0x0101 */
	u8 dl[2];
	u8 al[6];
	u8 recv[16];
	u8 delay[4];
	bool delay_only;
	bool there;		/* it answered when its address was read */
	bool partial;		/* and not to each read after that */
	bool gone;		/* when the number of slaves had changed */
	bool ports;		/* a known slave whose ports or place have changed */
};

/*
 * A piece of the ring between two slaves that are where they were: the slaves of the list, and
 * those found. Each is a step of its own: what contradicts one says nothing about another.
 */
struct stretch {
	unsigned int old;	/* the first slave of it in the list of the bus */
	unsigned int n_old;
	unsigned int new;	/* in @slaves of the scan */
	unsigned int n_new;
	bool thrown;		/* the bus contradicts it: the slaves of the list stay */
};

struct scan {
	struct ec_bus *bus;
	unsigned int n;
	struct ec_slave **slaves;
	struct regs *regs;
	struct ec_dg *dg;		/* two for each slave */
	u16 *who;			/* the slave that a datagram is for */
	struct stretch *stretch;	/* in ring order */
	unsigned int n_stretches;
	unsigned int n_thrown;		/* of these */
	bool moving;			/* the ring has changed since its addresses were read */
	bool calm;			/* no slave has come or gone since then */
	struct ec_slave **known;	/* slaves of the last scan by station address */
	u8 *claims;			/* slaves that have the address now, up to 2 */
	u16 *aliases;			/* first slave with each alias, ring position + 1 */
	bool changed;	/* other slaves than before */
	bool fresh;	/* no slave was known before: broadcasts are allowed */
	u32 front;	/* struct ec_ring.front when it began */
	const struct ec_slave *turned;	/* in a ring, the wrong way round */
	u32 turned_before;	/* where the scan before has found one */
};

static inline u16 ec_scan_address(const struct scan *sc, unsigned int i)
{
	return get_unaligned_le16(sc->regs[i].station);
}

/* Is the result not that of the whole bus? Then another scan follows. */
static inline bool ec_scan_is_partial(const struct scan *sc)
{
	return sc->n_thrown || sc->moving;
}

/* DL status: link, loop and communication of all ports */
#define EC_SCAN_PORTS	0xfff0

static inline bool ec_scan_is_known(const struct scan *sc, const struct ec_slave *s)
{
	return sc->known[s->station] == s;
}

#endif
