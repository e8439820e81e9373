// SPDX-License-Identifier: GPL-2.0-only
/* Finding the slaves: addresses, identity, EEPROM, ports; all in lockstep. */
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "../link/links.h"
#include "../base/once64.h"
#include "../base/report.h"
#include "../carry/xfer.h"
#include "identify.h"
#include "leave_init.h"
#include "ports_lost.h"
#include "ring_exit.h"
#include "ring_place.h"
#include "scan.h"
#include "scan_count.h"
#include "scan_int.h"
#include "scan_proof.h"
#include "scan_publish.h"
#include "scan_sii.h"
#include "scan_station.h"
#include "scan_stretch.h"

static void bwr(struct ec_bus *bus, u16 ado, const void *data, u16 len)
{
	ec_xfer_one(bus->links, EC_CMD_BWR, 0, ado, (void *)data, len);
}

/* ETG.1500 start-up sequence; only when no slave is in operation */
static void reset_bus(struct ec_bus *bus)
{
	static const u8 zero[256];
	static const u8 init[2] = { EC_AL_INIT, 0 };

	/* no frame would return by a port that is closed for this reason */
	if (!ec_ring_exit_is_closed(bus))
		bwr(bus, EC_REG_DL_LOOPS, zero, 1);
	bwr(bus, EC_REG_AL_CONTROL, init, 2);
	bwr(bus, EC_REG_ECAT_MASK, zero, 2);
	bwr(bus, EC_REG_FMMU(0), zero, 256);
	bwr(bus, EC_REG_SM(0), zero, 128);
	bwr(bus, EC_REG_DC_ACTIVATION, zero, 1);
	bwr(bus, EC_REG_DL_ALIAS, zero, 1);
}

/* which slaves a read is for */
static bool each(const struct scan *sc, unsigned int i)
{
	return sc->regs[i].there && !sc->regs[i].gone;
}

static bool each_new(const struct scan *sc, unsigned int i)
{
	return !ec_scan_is_known(sc, sc->slaves[i]) && !sc->regs[i].gone;
}

/* Receive times of slaves with another neighbor show where that is. */
static bool each_changed(const struct scan *sc, unsigned int i)
{
	return each_new(sc, i) || sc->regs[i].ports;
}

/*
 * Read @len bytes at @ado of some slaves into regs + @ofs: by station address, so that they are
 * of this slave even when a contact opens or closes meanwhile.
 * Returns the number of datagrams, @who says for which slave each is; or -errno.
 */
static int scan_read(struct scan *sc, bool (*which)(const struct scan *sc, unsigned int i),
		     u16 ado, size_t ofs, u16 len)
{
	unsigned int i, n = 0;
	int ret;

	for (i = 0; i < sc->n; i++) {
		if (!which(sc, i))
			continue;
		sc->who[n] = i;
		sc->dg[n++] = EC_FPRD(sc->slaves[i]->station, ado, len, (u8 *)&sc->regs[i] + ofs);
	}
	ret = ec_xfer(sc->bus->links, sc->dg, n);
	return ret ?: n;
}

/* What every slave has: one that does not answer now may have lost the contact. */
static int read_each(struct scan *sc, bool (*which)(const struct scan *sc, unsigned int i),
		     u16 ado, size_t ofs, u16 len)
{
	int n = scan_read(sc, which, ado, ofs, len), k;
	bool missing = false, same;

	for (k = 0; k < n; k++) {
		struct regs *r = &sc->regs[sc->who[k]];

		r->partial |= r->there && sc->dg[k].wkc != 1;
		missing |= r->partial;
	}
	if (n < 0 || !missing)
		return min(n, 0);
	same = ec_scan_count_again(sc) == 1;
	for (k = 0; k < n; k++)
		sc->regs[sc->who[k]].gone |= !same && sc->regs[sc->who[k]].partial;
	return 0;
}

static void fail_partial(struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		if (sc->regs[i].partial && each_new(sc, i))
			ec_slave_fail(sc->slaves[i], EC_SLAVE_SCAN_FAILED, EC_CAUSE(REGISTERS),
				      "no reply to a register read, frames pass; check the cables");
}

/* Registers of the new slaves. */
static void take_regs(struct scan *sc)
{
	unsigned int i, p;

	for (i = 0; i < sc->n; i++) {
		struct ec_slave *s = sc->slaves[i];
		struct regs *r = &sc->regs[i];

		if (!each_new(sc, i))
			continue;
		if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED) {
			/* a guess: the next slave is behind it */
			s->dl_status = EC_DLS_COMM(0) | (i + 1 < sc->n ? EC_DLS_COMM(1) : 0);
			continue;
		}
		memcpy(s->regs, r->info, sizeof(s->regs));
		WRITE_ONCE(s->delay_only,
			   r->delay_only && ec_slave_features(s) & EC_FEAT_DC);
		s->ports.control = r->control[0];
		s->ports.loops = r->control[1];
		s->dl_status = get_unaligned_le16(r->dl);
		s->al.status = get_unaligned_le16(r->al);
		s->al.code = get_unaligned_le16(r->al + 4);
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

		if (READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED || READ_ONCE(s->reply.silent))
			continue;
		if (s->eeprom.part)
			s->reply.retry_ms = 0;	/* the next part soon */
		ec_slave_retry(s, EC_RETRY_MAX_MS);
	}
	for (i = 0; i < n; i++) {
		if (READ_ONCE(fresh[i]->note.error))
			continue;
		/* left by the one that could not be read */
		fresh[i]->note.why[0] = '\0';
		fresh[i]->note.cause = *EC_CAUSE(NONE);
		fresh[i]->reply.retry_ms = 0;
	}
}

/* EEPROMs: all of them at once, then up to PREOP together */
static int read_eeproms(struct scan *sc, struct ec_slave **fresh, unsigned int n)
{
	unsigned int i;
	int ret;

	ec_scan_sii(sc->bus, fresh, n, sc->n, sc->fresh);
	if (!ec_links_is_up(sc->bus->links))
		return -ENETDOWN;
	for (i = 0; i < n; i++) {
		struct ec_slave *s = fresh[i];

		/* no contact, no memory, or the master is removed: not read, and no fault of it */
		if (!s->eeprom.data && !READ_ONCE(s->note.error)) {
			sc->regs[s->position].gone = true;
			continue;
		}
		ret = s->eeprom.data ? ec_slave_parse_sii(s) : 0;
		/* it is tried again; a large EEPROM of one slave must not hold up the others */
		if (ret == -ENOMEM)
			ec_slave_fail(s, EC_SLAVE_SCAN_FAILED,
				      EC_CAUSE(MEMORY, .state = EC_AL_PREOP),
				      "no memory for the SII content (%zu bytes); free memory of this computer",
				      s->eeprom.bytes);
		else if (ret)
			ec_slave_fail(s, EC_SLAVE_SCAN_FAILED, EC_CAUSE(EEPROM),
				      "SII content invalid (%zu bytes); write a valid image",
				      s->eeprom.bytes);
	}
	ec_leave_init_all(sc->bus, fresh, n, sc->fresh);
	ec_identify_all(sc->bus, fresh, n);
	plan_retries(sc, fresh, n);
	return 0;
}

static int read_new(struct scan *sc)
{
	struct ec_slave **fresh = kvcalloc(sc->n, sizeof(*fresh), GFP_KERNEL);
	unsigned int i, n = 0;
	int ret;

	if (!fresh)
		return -ENOMEM;
	for (i = 0; i < sc->n; i++)
		if (each_new(sc, i) && !READ_ONCE(sc->slaves[i]->note.error))
			fresh[n++] = sc->slaves[i];
	WRITE_ONCE(sc->bus->scan_index, sc->n - n);
	ec_ports_watch_found(sc->bus, fresh, n);
	ret = read_eeproms(sc, fresh, n);
	ec_ports_watch_found(sc->bus, NULL, 0);
	kvfree(fresh);
	return ret;
}

/* A known slave hangs where it did if neither its place in the ring nor its ports have changed. */
static void note_ports(struct scan *sc)
{
	unsigned int i, k;

	for (i = 0; i < sc->n; i++) {
		u16 dl = get_unaligned_le16(sc->regs[i].dl);

		sc->regs[i].ports = sc->bus->doubt.look ||
				    (dl ^ sc->slaves[i]->dl_status) & EC_SCAN_PORTS;
		/* the read has cleared the event, also if the scan fails */
		if (each(sc, i) && !sc->regs[i].partial)
			sc->slaves[i]->dl_seen = dl;
	}
	for (k = 0; k < sc->n_stretches; k++)
		for (i = 0; i < sc->stretch[k].n_new; i++)
			sc->regs[sc->stretch[k].new + i].ports = true;
	for (i = 0; i < sc->n; i++)
		sc->regs[i].ports &= each(sc, i) && !sc->regs[i].partial &&
				     ec_scan_is_known(sc, sc->slaves[i]);
}

static int read_times(struct scan *sc)
{
	static const u8 latch[4];
	int n, k;

	bwr(sc->bus, EC_REG_DC_RECV(0), latch, 4);
	n = scan_read(sc, each_changed, EC_REG_DC_RECV(0), offsetof(struct regs, recv), 16);
	for (k = 0; k < n; k++)
		sc->regs[sc->who[k]].delay_only = sc->dg[k].wkc == 1;
	if (n < 0)
		return n;
	n = scan_read(sc, each_new, EC_REG_DC_DELAY, offsetof(struct regs, delay), 4);
	for (k = 0; k < n; k++)
		sc->regs[sc->who[k]].delay_only &= !sc->dg[k].err && !sc->dg[k].wkc;
	return min(n, 0);
}

static int scan_look(struct scan *sc)
{
	int ret;

	if (sc->fresh)
		reset_bus(sc->bus);
	ret = ec_scan_stations(sc) ?: ec_scan_stretches(sc) ?:
	      read_each(sc, each_new, EC_REG_TYPE, offsetof(struct regs, info), EC_INFO_SIZE) ?:
	      read_each(sc, each_new, EC_REG_DL_CONTROL, offsetof(struct regs, control), 2) ?:
	      read_each(sc, each, EC_REG_DL_STATUS, offsetof(struct regs, dl), 2) ?:
	      read_each(sc, each_new, EC_REG_AL_STATUS, offsetof(struct regs, al), 6);
	if (ret)
		return ret;
	note_ports(sc);
	ret = read_times(sc);
	if (ret)
		return ret;
	fail_partial(sc);
	take_regs(sc);
	return read_new(sc);
}

static int scan_alloc(struct scan *sc)
{
	sc->slaves = kvcalloc(sc->n + 1, sizeof(*sc->slaves), GFP_KERNEL);
	sc->regs = kvcalloc(sc->n + 1, sizeof(*sc->regs), GFP_KERNEL);
	sc->dg = kvcalloc(2 * sc->n + 1, sizeof(*sc->dg), GFP_KERNEL);
	sc->who = kvcalloc(sc->n + 1, sizeof(*sc->who), GFP_KERNEL);
	sc->stretch = kvcalloc(sc->n + 1, sizeof(*sc->stretch), GFP_KERNEL);
	return sc->slaves && sc->regs && sc->dg && sc->who && sc->stretch ? 0 : -ENOMEM;
}

static void scan_free(struct scan *sc)
{
	unsigned int i;

	for (i = 0; sc->slaves && i < sc->n; i++)
		ec_slave_unref(sc->slaves[i]);
	kvfree(sc->slaves);
	kvfree(sc->regs);
	kvfree(sc->dg);
	kvfree(sc->who);
	kvfree(sc->stretch);
	kvfree(sc->known);
	kvfree(sc->claims);
	kvfree(sc->aliases);
}

/* Shown once the list is. */
static void note_end(struct scan *sc, u64 began_ns, u64 frames)
{
	struct ec_bus *bus = sc->bus;

	WRITE_ONCE(bus->scan_us, (u32)div_u64(ktime_get_ns() - began_ns, 1000));
	ec_write64(&bus->scan_frames, ec_links_sent(bus->links) - frames);
	if (sc->changed || (bus->scan_noted && !ec_scan_is_partial(sc)))
		ec_report(bus->base, EC_EVENT_SCAN_END, bus->n_slaves, bus->scan_us,
			  bus->scan_frames, sc->changed);
	if (ec_scan_is_partial(sc))
		return;
	bus->listed_station = bus->next_station;
	bus->scan_noted = false;
}

/**
 * ec_scan() - find the slaves on the bus
 * @bus: bus
 * @count: slaves that answered the last broadcast, up to ec_scan_limit(); 0 is legal
 * @result: result
 *
 * A slave that replies to its station address is present: it keeps its object, and nothing but its
 * ports is read. Where slaves were connected or disconnected, the list changes by a step for each
 * place; where the bus changes meanwhile it does not.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0; -EAGAIN when the bus changed meanwhile at each such place, or the list is held;
 * -ENETDOWN when the link went down; -ENOMEM; -ENOSPC without a free station address; or as
 * ec_xfer().
 */
int ec_scan(struct ec_bus *bus, unsigned int count, struct ec_scan_result *result)
{
	struct scan sc = {
		.bus = bus, .n = count,
		.fresh = !bus->n_slaves && !ec_access_is_cyclic(&bus->links->access),
		.front = bus->links->ring.front,
		.turned_before = bus->turned_seen,
	};
	u64 t0 = ktime_get_ns(), frames = ec_links_sent(bus->links);
	int ret = scan_alloc(&sc);

	if (!count)
		ec_ring_exit_note(bus);
	/* unless this scan finds it again */
	bus->turned_seen = U32_MAX;
	/* it may be begun again and again while a plug is pulled in, or for a port alone */
	if (count && count != bus->n_slaves && !bus->scan_noted) {
		bus->scan_noted = true;
		ec_event(bus->base, EC_EVENT_SCAN_START, count);
	}
	if (!ret)
		ret = count ? scan_look(&sc) : ec_scan_stretches(&sc);
	ret = ret ?: ec_scan_proof(&sc) ?: ec_scan_publish(&sc);
	if (!ret) {
		result->changed = sc.changed;
		result->again = ec_scan_is_partial(&sc);
		result->unsure = !result->again && ec_ring_places_are_unsure(bus);
		note_end(&sc, t0, frames);
	}
	scan_free(&sc);
	return ret;
}
