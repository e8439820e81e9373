// SPDX-License-Identifier: GPL-2.0-only
/* Finding the slaves: addresses, identity, EEPROM, topology; all in lockstep. */
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "../link/links.h"
#include "../base/once64.h"
#include "slave.h"
#include "../link/xfer.h"
#include "scan.h"

#define LOST_LINES	16	/* in the log, per scan */

/* registers read from every slave in each scan */
struct regs {
	u8 info[EC_INFO_SIZE];
	u8 station[4];		/* 0x0010 station, 0x0012 alias */
	u8 dl[2];
	u8 al[6];
	u8 recv[16];
	u8 delay[4];
	bool delay_only;
	bool there;		/* it answered when its address was read */
	bool partial;		/* and not to each read after that */
};

struct scan {
	struct ec_bus *bus;
	unsigned int n;
	struct ec_slave **slaves;
	struct regs *regs;
	struct ec_dg *dg;
	struct ec_slave **known;	/* slaves of the last scan by station address */
	u8 *claims;			/* slaves that have the address now, up to 2 */
	bool changed;	/* other slaves than before */
	bool fresh;	/* no slave was known before: broadcasts are allowed */
};

static void bwr(struct ec_bus *bus, u16 ado, const void *data, u16 len)
{
	ec_xfer_one(bus->links, EC_CMD_BWR, 0, ado, (void *)data, len);
}

/* ETG.1500 start-up sequence; only when no slave is in operation */
static void reset_bus(struct ec_bus *bus)
{
	static const u8 zero[256];
	static const u8 init[2] = { EC_AL_INIT, 0 };

	bwr(bus, EC_REG_DL_LOOPS, zero, 1);
	bwr(bus, EC_REG_AL_CONTROL, init, 2);
	bwr(bus, EC_REG_ECAT_MASK, zero, 2);
	bwr(bus, EC_REG_FMMU(0), zero, 256);
	bwr(bus, EC_REG_SM(0), zero, 128);
	bwr(bus, EC_REG_DC_ACTIVATION, zero, 1);
	bwr(bus, EC_REG_DL_ALIAS, zero, 1);
}

/* Read @len bytes at @ado of all slaves by position into regs + @ofs. */
static int read_all(struct scan *sc, u16 ado, size_t ofs, u16 len)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		sc->dg[i] = EC_DG(EC_CMD_APRD, (u16)-i, ado, len, (u8 *)&sc->regs[i] + ofs);
	return ec_xfer(sc->bus->links, sc->dg, sc->n);
}

/* Addresses of all; a slave that does not answer may be a known one that fell silent. */
static int read_stations(struct scan *sc)
{
	unsigned int i;
	int ret = read_all(sc, EC_REG_STATION, offsetof(struct regs, station), 4);

	for (i = 0; i < sc->n && !ret; i++)
		sc->regs[i].there = sc->dg[i].wkc == 1;
	return ret;
}

static int index_known(struct scan *sc)
{
	sc->known = kvcalloc(EC_MAX_SLAVES + 1, sizeof(*sc->known), GFP_KERNEL);
	sc->claims = kvzalloc(EC_MAX_SLAVES + 1, GFP_KERNEL);
	if (!sc->known || !sc->claims)
		return -ENOMEM;
	ec_for_each_slave(s, sc->bus)
		sc->known[s->station] = s;
	return 0;
}

/**
 * ec_scan_station() - find a station address that no slave has
 * @last: address found last
 * @known: slaves of the last scan by address
 * @claims: for each address, how many slaves have it now
 *
 * Context: Any.
 * Return: the address, or 0 when all are in use.
 */
u16 ec_scan_station(u16 last, struct ec_slave *const *known, const u8 *claims)
{
	u32 i;

	for (i = 0; i <= EC_MAX_SLAVES; i++)
		/* the clocks use 0xffff for "no slave" */
		if (++last && last != 0xffff && !known[last] && !claims[last])
			return last;
	return 0;
}

/**
 * ec_scan_limit() - how many slaves a scan takes on
 *
 * Whatever a broken or hostile slave does to a frame, it makes the master allocate no
 * more than a part of the memory of the machine.
 *
 * Context: Any.
 * Return: slaves.
 */
unsigned int ec_scan_limit(void)
{
	u64 bytes = (u64)totalram_pages() << PAGE_SHIFT;

	return clamp_t(u64, div_u64(bytes, EC_SLAVES_RAM * EC_SLAVE_BYTES), EC_MIN_SLAVES,
		       EC_MAX_SLAVES);
}

/* Is the number of slaves still the one the scan began with? */
static bool same_count(struct scan *sc)
{
	u8 type[1] = { 0 };
	struct ec_dg dg = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, type);

	return !ec_xfer(sc->bus->links, &dg, 1) && dg.back == (u16)sc->n;
}

/* New slaves get their address; one that does not accept it is marked as failed. */
static int write_stations(struct scan *sc, unsigned int n)
{
	unsigned int i;
	int ret = ec_xfer(sc->bus->links, sc->dg, n);

	for (i = 0; i < n && !ret; i++) {
		unsigned int pos = (u16)-sc->dg[i].adp;

		if (sc->dg[i].wkc == 1)
			continue;
		if (!same_count(sc))
			return -EAGAIN;
		ec_slave_fail(sc->slaves[pos], EC_SLAVE_SCAN_FAILED, EC_CAUSE(REGISTERS),
			      "station address not accepted, frames pass; power-cycle or replace the slave, then rescan");
	}
	return ret;
}

/* What every slave has: one that does not answer now has lost the contact for a moment. */
static int read_each(struct scan *sc, u16 ado, size_t ofs, u16 len)
{
	unsigned int i;
	int ret = read_all(sc, ado, ofs, len);
	bool missing = false;

	for (i = 0; i < sc->n && !ret; i++) {
		sc->regs[i].partial |= sc->regs[i].there && sc->dg[i].wkc != 1;
		missing |= sc->regs[i].partial;
	}
	return missing && !same_count(sc) ? -EAGAIN : ret;
}

/* How many slaves have each address now, up to 2. */
static void count_claims(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		u8 *c = &sc->claims[get_unaligned_le16(sc->regs[i].station)];

		if (sc->regs[i].there)
			*c = min(*c + 1, 2);
	}
}

/* One that failed in the scan is read anew; one that refused a state is the same. */
static bool is_usable(const struct ec_slave *s)
{
	u8 error = READ_ONCE(s->error);

	return s->sii && (!error || READ_ONCE(s->silent) ||
			  (error == EC_SLAVE_CONFIG_FAILED && s->bus->ops &&
			   s->bus->ops->attached && s->bus->ops->attached(s)));
}

/*
 * The known slave that is at @i without an answer: what is in front of it is what was
 * there before, and its address is nowhere else.
 */
static struct ec_slave *fell_silent(const struct scan *sc, unsigned int i, bool same_before)
{
	struct ec_slave *s = i < sc->bus->n_slaves ? sc->bus->slaves[i] : NULL;

	if (!s || sc->regs[i].there || !same_before || sc->claims[s->station])
		return NULL;
	return READ_ONCE(s->silent) ||
	       (s->sii && READ_ONCE(s->error) != EC_SLAVE_SCAN_FAILED) ? s : NULL;
}

/* The slave that could not be read when it was at @i, or NULL. */
static const struct ec_slave *unreadable(const struct ec_bus *bus, unsigned int i)
{
	const struct ec_slave *s = i < bus->n_slaves ? bus->slaves[i] : NULL;

	return s && READ_ONCE(s->error) == EC_SLAVE_SCAN_FAILED && !READ_ONCE(s->silent) ? s : NULL;
}

/* What was read of the EEPROM by the scan before. */
static void take_part(struct ec_slave *s, struct ec_slave *old)
{
	swap(s->part, old->part);
	swap(s->part_bytes, old->part_bytes);
	if (s->part)
		swap(s->sii_counted, old->sii_counted);
}

/* The one that could not be read here before: its cause is logged once, its tries go on. */
static void take_failure(struct scan *sc, struct ec_slave *s)
{
	const struct ec_slave *old = unreadable(sc->bus, s->position);

	if (!old)
		return;
	strscpy(s->why, old->why, sizeof(s->why));
	s->cause = old->cause;
	s->retry_ms = old->retry_ms;
}

static void set_silent(struct scan *sc, struct ec_slave *s)
{
	if (READ_ONCE(s->silent))
		return;
	sc->changed = true;
	WRITE_ONCE(s->silent, true);
	s->seen_ns = sc->bus->complete_ns;
	WRITE_ONCE(s->al_status, 0);
	ec_slave_event(s, EC_EVENT_SLAVE_SILENT);
	ec_slave_fail(s, EC_SLAVE_SCAN_FAILED, EC_CAUSE(SILENT),
		      "no reply from the slave, frames pass; waiting for a reply");
	ec_slave_retry(s, EC_PROBE_MAX_MS);
}

static void set_answers(struct scan *sc, struct ec_slave *s)
{
	if (!READ_ONCE(s->silent))
		return;
	sc->changed = true;
	WRITE_ONCE(s->silent, false);
	ec_slave_set_ok(s, true);
	s->retry_ms = 0;
	ec_write64(&s->retry_ns, 0);
	ec_slave_info(s, "slave replies again\n");
	ec_slave_event(s, EC_EVENT_SLAVE_REPLIES);
}

/*
 * A slave that has kept the address of this master is a known one; others get an address. Of two
 * slaves with one address, one was at another master, and it is unknown which: both are new.
 */
static int assign(struct scan *sc)
{
	unsigned int i, n = 0;
	bool same_before = true;

	count_claims(sc);
	for (i = 0; i < sc->n; i++) {
		u16 station = get_unaligned_le16(sc->regs[i].station);
		struct ec_slave *s = sc->known[station], *silent = fell_silent(sc, i, same_before);

		if (silent) {
			sc->slaves[i] = ec_slave_ref(silent);
			continue;
		}
		if (s && is_usable(s) && sc->regs[i].there && sc->claims[station] == 1) {
			sc->slaves[i] = ec_slave_ref(s);
			same_before &= i < sc->bus->n_slaves && sc->bus->slaves[i] == s;
			continue;
		}
		same_before &= unreadable(sc->bus, i) != NULL;
		station = ec_scan_station(sc->bus->next_station, sc->known, sc->claims);
		if (!station)
			return -ENOSPC;
		sc->bus->next_station = station;
		sc->slaves[i] = ec_slave_alloc(sc->bus, station);
		if (!sc->slaves[i])
			return -ENOMEM;
		sc->slaves[i]->position = i;
		take_failure(sc, sc->slaves[i]);
		/* by its address it is the same */
		if (s && sc->regs[i].there && sc->claims[s->station] == 1)
			take_part(sc->slaves[i], s);
		put_unaligned_le16(sc->slaves[i]->station, sc->regs[i].station);
		sc->dg[n++] = EC_DG(EC_CMD_APWR, (u16)-i, EC_REG_STATION, 2, sc->regs[i].station);
	}
	return write_stations(sc, n);
}

static bool is_known(const struct scan *sc, const struct ec_slave *s)
{
	return sc->known[s->station] == s;
}

static void take_replies(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];

		if (!is_known(sc, s)) {
			if (sc->regs[i].partial)
				ec_slave_fail(s, EC_SLAVE_SCAN_FAILED, EC_CAUSE(REGISTERS),
					      "no reply to a register read, frames pass; check the cables");
		} else if (sc->regs[i].there) {
			set_answers(sc, s);
		} else {
			set_silent(sc, s);
		}
	}
}

/* Registers of the new slaves, or of the @known ones: others see those. */
static void take_regs(struct scan *sc, bool known)
{
	unsigned int i, p;

	lockdep_assert(!known || lockdep_is_held(&sc->bus->topo));
	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];
		struct regs *r = &sc->regs[i];

		if (is_known(sc, s) != known)
			continue;
		s->position = i;
		if (known && (!r->there || r->partial))
			continue;	/* its registers are those seen last */
		if (!known && READ_ONCE(s->error) == EC_SLAVE_SCAN_FAILED) {
			/* a guess: the next slave is behind it */
			s->dl_status = EC_DLS_COMM(0) | (i + 1 < sc->n ? EC_DLS_COMM(1) : 0);
			continue;
		}
		memcpy(s->regs, r->info, sizeof(s->regs));
		WRITE_ONCE(s->delay_only,
			   r->delay_only && ec_slave_features(s) & EC_FEAT_DC);
		s->dl_status = get_unaligned_le16(r->dl);
		/* of a known slave its worker may have a newer one */
		if (!known) {
			s->al_status = get_unaligned_le16(r->al);
			s->al_code = get_unaligned_le16(r->al + 4);
		}
		for (p = 0; p < EC_MAX_PORT; p++)
			s->recv[p] = get_unaligned_le32(r->recv + 4 * p);
	}
}

/* What could not be read is tried again, ever less often. */
static void plan_retries(struct scan *sc, struct ec_slave **fresh, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];

		if (READ_ONCE(s->error) != EC_SLAVE_SCAN_FAILED || READ_ONCE(s->silent))
			continue;
		if (s->part)
			s->retry_ms = 0;	/* go on soon */
		ec_slave_retry(s, EC_RETRY_MAX_MS);
	}
	for (i = 0; i < n; i++) {
		if (READ_ONCE(fresh[i]->error))
			continue;
		/* left by the one that could not be read */
		fresh[i]->why[0] = '\0';
		fresh[i]->cause = *EC_CAUSE(NONE);
		fresh[i]->retry_ms = 0;
	}
}

/* EEPROMs of the new ones: all of them at once, then up to PREOP together */
static int read_new(struct scan *sc)
{
	struct ec_slave **fresh = kvcalloc(sc->n, sizeof(*fresh), GFP_KERNEL);
	unsigned int i, n = 0;
	int ret;

	if (!fresh)
		return -ENOMEM;
	for (i = 0; i < sc->n; i++)
		if (!sc->slaves[i]->sii && !READ_ONCE(sc->slaves[i]->error))
			fresh[n++] = sc->slaves[i];
	WRITE_ONCE(sc->bus->scan_index, sc->n - n);
	ec_scan_sii(sc->bus, fresh, n, sc->fresh);
	if (!ec_links_is_up(sc->bus->links)) {
		kvfree(fresh);
		return -ENETDOWN;
	}
	for (i = 0; i < n; i++) {
		struct ec_slave *s = fresh[i];

		/* no memory, the link was down for a moment, or the master is removed */
		if (!s->sii && !READ_ONCE(s->error)) {
			kvfree(fresh);
			return -EAGAIN;
		}
		ret = s->sii ? ec_slave_parse_sii(s) : 0;
		/* it is tried again; a large EEPROM of one slave must not hold up the others */
		if (ret == -ENOMEM)
			ec_slave_fail(s, EC_SLAVE_SCAN_FAILED,
				      EC_CAUSE(MEMORY, .state = EC_AL_PREOP),
				      "no memory for the SII content (%zu bytes); free memory of this computer",
				      s->sii_bytes);
		else if (ret)
			ec_slave_fail(s, EC_SLAVE_SCAN_FAILED, EC_CAUSE(EEPROM),
				      "SII content invalid (%zu bytes); write a valid image",
				      s->sii_bytes);
	}
	ec_scan_preop(sc->bus, fresh, n, sc->fresh);
	plan_retries(sc, fresh, n);
	kvfree(fresh);
	return 0;
}

static int look(struct scan *sc)
{
	static const u8 latch[4];
	unsigned int i;
	int ret;

	if (sc->fresh)
		reset_bus(sc->bus);
	ret = read_stations(sc) ?:
	      assign(sc) ?:
	      read_each(sc, EC_REG_TYPE, offsetof(struct regs, info), EC_INFO_SIZE) ?:
	      read_each(sc, EC_REG_DL_STATUS, offsetof(struct regs, dl), 2) ?:
	      read_each(sc, EC_REG_AL_STATUS, offsetof(struct regs, al), 6);
	if (ret)
		return ret;
	bwr(sc->bus, EC_REG_DC_RECV(0), latch, 4);
	ret = read_all(sc, EC_REG_DC_RECV(0), offsetof(struct regs, recv), 16);
	for (i = 0; i < sc->n && !ret; i++)
		sc->regs[i].delay_only = sc->dg[i].wkc == 1;
	ret = ret ?: read_all(sc, EC_REG_DC_DELAY, offsetof(struct regs, delay), 4);
	for (i = 0; i < sc->n && !ret; i++)
		sc->regs[i].delay_only &= !sc->dg[i].err && !sc->dg[i].wkc;
	if (ret)
		return ret;
	take_replies(sc);
	take_regs(sc, false);
	return read_new(sc);
}

/* A try that failed again is no change. */
static bool differs(const struct scan *sc)
{
	unsigned int i;

	if (sc->changed || sc->n != sc->bus->n_slaves)
		return true;
	for (i = 0; i < sc->n; i++)
		if (sc->slaves[i] != sc->bus->slaves[i] &&
		    !(unreadable(sc->bus, i) &&
		      READ_ONCE(sc->slaves[i]->error) == EC_SLAVE_SCAN_FAILED))
			return true;
	return false;
}

/* The place a lost slave had: @old are the slaves by their position at that time. */
static void note_parent(struct ec_slave *s, struct ec_slave **old, unsigned int n_old)
{
	u16 up = s->next[s->upstream];

	if (up >= n_old)
		strscpy(s->parent, "the main device", sizeof(s->parent));
	else
		snprintf(s->parent, sizeof(s->parent), "port %u of slave %u (%.24s)",
			 s->parent_port, up, old[up]->order);
	s->seen_ns = s->bus->complete_ns;
	/* slaves that were lost together have the place where the first of them hung */
	if (up < s->position && READ_ONCE(old[up]->stop.gone))
		s->lost_at = old[up]->lost_at;
	else
		s->lost_at = (struct ec_break){
			.station = up < n_old ? old[up]->station : 0, .port = s->parent_port,
		};
}

/* @n: slaves there were then */
static u32 upstream_of(const struct ec_slave *s, unsigned int n)
{
	u16 up = s->next[s->upstream];

	return up < n ? up : EC_EVENT_NONE;
}

/* One line each; without any slave the message about the link is enough. */
static void log_lost(struct scan *sc, const struct ec_slave *s, unsigned int n_old, unsigned int *n)
{
	u64 ms = div_u64(ktime_get_ns() - s->seen_ns, NSEC_PER_MSEC);
	char text[128];

	if (!sc->n || READ_ONCE(s->error) == EC_SLAVE_SCAN_FAILED)
		return;
	ec_slave_event(s, EC_EVENT_SLAVE_LOST, upstream_of(s, n_old), s->parent_port, s->alias,
		       s->info.vendor, s->info.product, ms);
	if ((*n)++ >= LOST_LINES)
		return;
	ec_slave_lost_text(s, text, sizeof(text));
	ec_warn_each(sc->bus, s->position + 1, "%s, last seen %llu ms ago\n", text, ms);
}

/* Slaves beside known ones; of all of them, the end of the scan says enough. */
static void note_found(struct scan *sc, unsigned int n_old)
{
	struct ec_bus *bus = sc->bus;
	unsigned int i;

	for (i = 0; n_old && i < bus->n_slaves; i++) {
		const struct ec_slave *s = bus->slaves[i];

		if (!is_known(sc, s) && READ_ONCE(s->error) != EC_SLAVE_SCAN_FAILED)
			ec_slave_event(s, EC_EVENT_SLAVE_FOUND, upstream_of(s, bus->n_slaves),
				       s->parent_port, s->alias, s->info.vendor,
				       s->info.product);
	}
}

/* The result becomes visible; slaves that are missing are gone. */
static void publish(struct scan *sc)
{
	struct ec_bus *bus = sc->bus;
	struct ec_slave **old;
	unsigned int i, n_old, lost = 0;

	down_write(&bus->topo);
	ec_show_change_begin(&bus->base->show);
	take_regs(sc, true);
	ec_topology_build(sc->slaves, sc->n);
	old = bus->slaves;
	n_old = bus->n_slaves;
	bus->slaves = sc->slaves;
	WRITE_ONCE(bus->n_slaves, sc->n);
	ec_show_change_end(&bus->base->show);
	up_write(&bus->topo);
	sc->slaves = NULL;
	ec_bus_need_workers(bus, sc->n / 2);

	for (i = 0; i < n_old; i++) {
		/* at its place in the new list, or not on the bus any more */
		if (old[i]->position >= bus->n_slaves || bus->slaves[old[i]->position] != old[i]) {
			note_parent(old[i], old, n_old);
			ec_stop_gone(&old[i]->stop);
			log_lost(sc, old[i], n_old, &lost);
		}
	}
	if (lost > LOST_LINES)
		ec_warn(bus, "%u more slave(s) disconnected\n", lost - LOST_LINES);
	if (!sc->n && n_old && READ_ONCE(bus->links->access.mode) != EC_ACCESS_DIRECT) {
		u64 ms = div_u64(ktime_get_ns() - bus->complete_ns, NSEC_PER_MSEC);

		ec_warn(bus, "all %u slave(s) disconnected, last seen %llu ms ago\n", n_old, ms);
		ec_event(bus->base, EC_EVENT_ALL_LOST, n_old, ms);
	}
	note_found(sc, n_old);
	for (i = 0; i < n_old; i++)
		ec_slave_unref(old[i]);
	kvfree(old);
}

/**
 * ec_scan() - find the slaves on the bus
 * @bus: bus
 * @count: slaves that answered the last broadcast, up to ec_scan_limit(); 0 is legal
 * @changed: result: there are other slaves than before, or one fell silent or replies again
 *
 * Slaves that are known already keep their objects; only new ones are read.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0; -EAGAIN when the bus changed meanwhile; -ENETDOWN when the link went down;
 * -ENOMEM; -ENOSPC without a free station address; or as ec_xfer().
 */
int ec_scan(struct ec_bus *bus, unsigned int count, bool *changed)
{
	struct scan sc = {
		.bus = bus, .n = count,
		.fresh = !bus->n_slaves && !ec_access_is_cyclic(&bus->links->access),
	};
	u64 t0 = ktime_get_ns(), frames = ec_links_sent(bus->links);
	unsigned int i;
	int ret = -ENOMEM;

	sc.slaves = kvcalloc(count + 1, sizeof(*sc.slaves), GFP_KERNEL);
	sc.regs = kvcalloc(count + 1, sizeof(*sc.regs), GFP_KERNEL);
	sc.dg = kvcalloc(count + 1, sizeof(*sc.dg), GFP_KERNEL);
	/* it may be begun again and again while a plug is pulled in */
	if (count && !bus->scan_noted) {
		bus->scan_noted = true;
		ec_event(bus->base, EC_EVENT_SCAN_START, count);
	}
	if (sc.slaves && sc.regs && sc.dg && !index_known(&sc))
		ret = count ? look(&sc) : 0;
	if (!ret) {
		sc.changed = differs(&sc);
		publish(&sc);
		*changed = sc.changed;
		WRITE_ONCE(bus->scan_us, (u32)div_u64(ktime_get_ns() - t0, 1000));
		ec_write64(&bus->scan_frames, ec_links_sent(bus->links) - frames);
		if (sc.changed && count)
			ec_info(bus, "scan complete: %u slave(s) in %u us, %llu frames\n", count,
				bus->scan_us, bus->scan_frames);
		if (bus->scan_noted)
			ec_event(bus->base, EC_EVENT_SCAN_END, count, bus->scan_us,
				 bus->scan_frames);
		bus->scan_noted = false;
	}
	for (i = 0; sc.slaves && i < count; i++)
		ec_slave_unref(sc.slaves[i]);
	kvfree(sc.slaves);
	kvfree(sc.regs);
	kvfree(sc.dg);
	kvfree(sc.known);
	kvfree(sc.claims);
	return ret;
}
