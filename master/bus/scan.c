// SPDX-License-Identifier: GPL-2.0-only
/* Finding the slaves: addresses, identity, EEPROM, topology; all in lockstep. */
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "../link/links.h"
#include "../base/once64.h"
#include "../carry/xfer.h"
#include "known.h"
#include "scan_int.h"

#define LOST_LINES	16	/* in the log, per scan */

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

/*
 * Read @len bytes at @ado of all slaves into regs + @ofs: by station address, so that they are
 * of this slave even when a contact opens or closes meanwhile.
 */
static int scan_read_all(struct scan *sc, u16 ado, size_t ofs, u16 len)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		sc->dg[i] = EC_FPRD(sc->slaves[i]->station, ado, len, (u8 *)&sc->regs[i] + ofs);
	return ec_xfer(sc->bus->links, sc->dg, sc->n);
}

/**
 * ec_scan_limit() - how many slaves a scan accepts
 *
 * A broken or hostile slave can change a frame, but the master allocates at most a part
 * of the memory of the computer.
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

/* What every slave has: one that does not answer now has lost the contact for a moment. */
static int read_each(struct scan *sc, u16 ado, size_t ofs, u16 len)
{
	unsigned int i;
	int ret = scan_read_all(sc, ado, ofs, len);
	bool missing = false;

	for (i = 0; i < sc->n && !ret; i++) {
		sc->regs[i].partial |= sc->regs[i].there && sc->dg[i].wkc != 1;
		missing |= sc->regs[i].partial;
	}
	return missing && !ec_scan_same_count(sc->bus, sc->n) ? -EAGAIN : ret;
}

/* Known slaves that reply again, or not any more. */
static void note_replies(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];

		if (!ec_scan_is_known(sc, s))
			continue;
		if (sc->regs[i].there)
			sc->changed |= ec_slave_set_replies(s);
		else
			sc->changed |= ec_slave_set_silent(s,
				"no reply from the slave, frames pass; waiting for a reply");
	}
}

static void fail_partial(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		if (sc->regs[i].partial && !ec_scan_is_known(sc, sc->slaves[i]))
			ec_slave_fail(sc->slaves[i], EC_SLAVE_SCAN_FAILED, EC_CAUSE(REGISTERS),
				      "no reply to a register read, frames pass; check the cables");
}

/* Registers of the new slaves, or of the @known ones: others see those. */
static void take_regs(struct scan *sc, bool known)
{
	unsigned int i, p;

	lockdep_assert(!known || lockdep_is_held(&sc->bus->topo));
	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];
		struct regs *r = &sc->regs[i];

		if (ec_scan_is_known(sc, s) != known)
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
			s->retry_ms = 0;	/* the next part soon */
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
	ec_scan_sii(sc->bus, fresh, n, sc->n, sc->fresh);
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

static int scan_look(struct scan *sc)
{
	static const u8 latch[4];
	unsigned int i;
	int ret;

	if (sc->fresh)
		reset_bus(sc->bus);
	ret = ec_scan_stations(sc) ?:
	      read_each(sc, EC_REG_TYPE, offsetof(struct regs, info), EC_INFO_SIZE) ?:
	      read_each(sc, EC_REG_DL_STATUS, offsetof(struct regs, dl), 2) ?:
	      read_each(sc, EC_REG_AL_STATUS, offsetof(struct regs, al), 6);
	if (ret)
		return ret;
	bwr(sc->bus, EC_REG_DC_RECV(0), latch, 4);
	ret = scan_read_all(sc, EC_REG_DC_RECV(0), offsetof(struct regs, recv), 16);
	for (i = 0; i < sc->n && !ret; i++)
		sc->regs[i].delay_only = sc->dg[i].wkc == 1;
	ret = ret ?: scan_read_all(sc, EC_REG_DC_DELAY, offsetof(struct regs, delay), 4);
	for (i = 0; i < sc->n && !ret; i++)
		sc->regs[i].delay_only &= !sc->dg[i].err && !sc->dg[i].wkc;
	if (ret)
		return ret;
	fail_partial(sc);
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
		    !(ec_scan_unreadable(sc->bus, i) &&
		      READ_ONCE(sc->slaves[i]->error) == EC_SLAVE_SCAN_FAILED))
			return true;
	return false;
}

/*
 * The place a lost slave had: @old are the slaves by their position at that time. Slaves that were
 * lost together have the place where the first of them hung.
 */
static void note_parent(struct ec_slave *s, struct ec_slave **old, unsigned int n_old)
{
	u16 up = s->next[s->upstream];
	const struct ec_slave *u = up < n_old ? old[up] : NULL;

	s->seen_ns = s->bus->complete_ns;
	if (u && up < s->position && READ_ONCE(u->stop.gone)) {
		s->lost_at = u->lost_at;
		strscpy(s->parent, u->parent, sizeof(s->parent));
		if (u->first_lost[0])
			strscpy(s->first_lost, u->first_lost, sizeof(s->first_lost));
		else
			snprintf(s->first_lost, sizeof(s->first_lost), "slave %u (%.24s)", up,
				 ec_slave_label(u));
		return;
	}
	s->lost_at = (struct ec_break){ .station = u ? u->station : 0, .port = s->parent_port };
	if (u)
		snprintf(s->parent, sizeof(s->parent), "port %u of slave %u (%.24s)",
			 s->parent_port, up, ec_slave_label(u));
	else
		strscpy(s->parent, "the main device", sizeof(s->parent));
}

/* @n: slaves there were then */
static u32 upstream_of(const struct ec_slave *s, unsigned int n)
{
	u16 up = s->next[s->upstream];

	return up < n ? up : EC_EVENT_NONE;
}

/* Lost together? What hangs behind a cable is one range of the ring, and one event. */
static bool same_break(const struct ec_slave *a, const struct ec_slave *b)
{
	return a->lost_at.station == b->lost_at.station && a->lost_at.port == b->lost_at.port;
}

static bool is_off_list(const struct ec_slave *s)
{
	return READ_ONCE(s->stop.gone) && READ_ONCE(s->error) != EC_SLAVE_SCAN_FAILED;
}

static void log_lost(struct scan *sc, const struct ec_slave *first, const struct ec_slave *last,
		     u64 ms)
{
	char text[128];

	ec_slave_lost_text(first, text, sizeof(text));
	if (first == last)
		ec_warn_each(sc->bus, first->position + 1, "%s, last seen %llu ms ago\n", text, ms);
	else
		ec_warn_each(sc->bus, first->position + 1,
			     "%s, and what is behind it up to slave %u (%s), last seen %llu ms ago\n",
			     text, last->position, ec_slave_label(last), ms);
}

/* One event and one line for each break; without any slave that about the link is enough. */
static void note_lost(struct scan *sc, struct ec_slave **old, unsigned int n_old)
{
	unsigned int i, first, lines = 0;

	for (i = 0; i < n_old && sc->n; ) {
		const struct ec_slave *s = old[i];
		u64 ms = div_u64(ktime_get_ns() - s->seen_ns, NSEC_PER_MSEC);

		first = i++;
		if (!is_off_list(s))
			continue;
		while (i < n_old && is_off_list(old[i]) && same_break(old[i], s))
			i++;
		if (lines++ < LOST_LINES)
			log_lost(sc, s, old[i - 1], ms);
		ec_slave_event(s, EC_EVENT_SLAVE_LOST, upstream_of(s, n_old), s->parent_port,
			       s->alias, s->info.vendor, s->info.product, ms, i - first);
	}
	if (lines > LOST_LINES)
		ec_warn(sc->bus, "slaves disconnected from %u more place(s)\n",
			lines - LOST_LINES);
}

static bool is_found(const struct scan *sc, const struct ec_slave *s)
{
	return !ec_scan_is_known(sc, s) && READ_ONCE(s->error) != EC_SLAVE_SCAN_FAILED;
}

/* Slaves beside known ones; of all of them, the end of the scan says enough. */
static void note_found(struct scan *sc, unsigned int n_old)
{
	struct ec_bus *bus = sc->bus;
	unsigned int i, first;

	for (i = 0; n_old && i < bus->n_slaves; ) {
		const struct ec_slave *s = bus->slaves[i];

		first = i++;
		if (!is_found(sc, s))
			continue;
		/* and those that hang at one of these */
		for (; i < bus->n_slaves && is_found(sc, bus->slaves[i]); i++) {
			u32 up = upstream_of(bus->slaves[i], bus->n_slaves);

			if (up < first || up == EC_EVENT_NONE)
				break;
		}
		ec_slave_event(s, EC_EVENT_SLAVE_FOUND, upstream_of(s, bus->n_slaves),
			       s->parent_port, s->alias, s->info.vendor, s->info.product,
			       i - first);
	}
}

/* Aliases that more than one slave has. */
static void note_aliases(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];
		u16 *first = &sc->aliases[s->alias];

		WRITE_ONCE(s->alias_first, 0);
		if (s->alias && *first) {
			WRITE_ONCE(s->alias_first, *first);
			WRITE_ONCE(sc->slaves[*first - 1]->alias_first, *first);
		} else {
			*first = i + 1;
		}
	}
}

/* Publish the result, unless the list is held by now; slaves missing in it are disconnected. */
static bool scan_publish(struct scan *sc)
{
	struct ec_bus *bus = sc->bus;
	struct ec_slave **old;
	unsigned int i, n_old;

	ec_pending_flush(bus, true);
	down_write(&bus->topo);
	if (bus->held) {
		up_write(&bus->topo);
		return false;
	}
	note_replies(sc);
	sc->changed = differs(sc);
	ec_show_change_begin(&bus->base->show);
	take_regs(sc, true);
	ec_known_update(bus, sc->slaves, sc->n, ec_scan_limit());
	note_aliases(sc);
	WRITE_ONCE(bus->lists, bus->lists + 1);
	for (i = 0; i < sc->n; i++)
		sc->slaves[i]->found = sc->slaves[i]->found ?: bus->lists;
	ec_topology_build(sc->slaves, sc->n);
	old = bus->slaves;
	n_old = bus->n_slaves;
	bus->slaves = sc->slaves;
	WRITE_ONCE(bus->n_slaves, sc->n);
	ec_show_change_end(&bus->base->show);
	up_write(&bus->topo);
	sc->slaves = NULL;
	ec_bus_need_workers(bus, sc->n / 2);
	ec_for_each_slave(s, bus)
		if (!s->listed)
			ec_slave_list(s);

	for (i = 0; i < n_old; i++) {
		/* at its place in the new list, or not on the bus any more */
		if (old[i]->position >= bus->n_slaves || bus->slaves[old[i]->position] != old[i]) {
			note_parent(old[i], old, n_old);
			ec_stop_gone(&old[i]->stop);
		}
	}
	note_lost(sc, old, n_old);
	if (!sc->n && n_old && READ_ONCE(bus->links->access.mode) != EC_ACCESS_DIRECT) {
		u64 ms = div_u64(ktime_get_ns() - bus->complete_ns, NSEC_PER_MSEC);

		ec_warn(bus, "all %u slave(s) disconnected, last seen %llu ms ago\n", n_old, ms);
		ec_event(bus->base, EC_EVENT_ALL_LOST, n_old, ms);
	}
	note_found(sc, n_old);
	for (i = 0; i < n_old; i++)
		ec_slave_unref(old[i]);
	kvfree(old);
	return true;
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
 * Return: 0; -EAGAIN when the bus changed meanwhile, or the list is held; -ENETDOWN when the
 * link went down; -ENOMEM; -ENOSPC without a free station address; or as ec_xfer().
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
	sc.dg = kvcalloc(2 * count + 1, sizeof(*sc.dg), GFP_KERNEL);
	/* it may be begun again and again while a plug is pulled in */
	if (count && !bus->scan_noted) {
		bus->scan_noted = true;
		ec_event(bus->base, EC_EVENT_SCAN_START, count);
	}
	if (sc.slaves && sc.regs && sc.dg)
		ret = count ? scan_look(&sc) : 0;
	ret = ret ?: ec_scan_proof(&sc);
	if (!ret && !scan_publish(&sc))
		ret = -EAGAIN;
	if (!ret) {
		bus->listed_station = bus->next_station;
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
	kvfree(sc.aliases);
	return ret;
}
