// SPDX-License-Identifier: GPL-2.0-only
/*
 * Reading the EEPROMs of many slaves in lockstep. One command starts the same
 * read everywhere, packed reads collect the results. A slave that is slow,
 * refuses, misses the command or has come to its end leaves the lockstep.
 *
 * A large EEPROM, or one full of garbage, takes a minute. It is read in parts, each by a
 * scan of its own: the other slaves and the monitor do not wait for it.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "../link/links.h"
#include "../carry/xfer.h"
#include "known.h"
#include "scan_count.h"
#include "scan_int.h"
#include "scan_sii.h"

#define STEP_TIMEOUT_NS	(20 * NSEC_PER_MSEC)	/* of one access to the EEPROM */
#define STRAGGLER_NS	(4 * NSEC_PER_MSEC)	/* when the slowest tenth is left behind */
#define PROBE_NS	(2 * NSEC_PER_MSEC)	/* while no slave is ready, few are asked */
#define PROBE		8
#define WAIT_MAX_NS	(2 * NSEC_PER_MSEC)
#define POLL_US		40
#define RETRIES		5
#define TAKE_OVER	3	/* datagrams to take over one EEPROM */
#define FIRST_BYTES	EC_SII_FIXED_SIZE
#define FIRST_CAP	2048
#define HEAD_BYTES	EC_SII_HEAD	/* checksum, identity, serial number */
#define SIZE_WORD	0x3c	/* the access with size and version of the EEPROM */
#define PART_BYTES	16384	/* a part has so many at least */
#define PART_NS		(2ULL * NSEC_PER_SEC)	/* and may take so long */
#define PART_MAX_NS	(10ULL * NSEC_PER_SEC)	/* beside a slow cycle it has fewer */

/* one slave being read, into its @part */
struct reader {
	struct ec_slave *slave;
	size_t need;
	size_t began;	/* bytes of the parts before */
	struct ec_image *kept;	/* of a disconnected device with the same head */
	u32 check;	/* word at which the two are compared */
	bool looked;	/* for @kept */
	u8 tries;
	u8 len;		/* bytes of @reg that are of interest */
	bool alone;	/* left the lockstep */
	bool unheard;	/* no reply to the last read */
	bool done;
	u8 reg[14];	/* 0x0502-0x050F */
};

struct job {
	struct ec_bus *bus;
	struct reader *rd;
	unsigned int n;
	unsigned int count;	/* slaves on the bus */
	struct ec_dg *dg;
	u8 (*cmd)[6];
	struct reader **rds;
	bool broadcast;
	u64 wait_ns;	/* from the command to the first look, 0: not known */
	u64 good_ns;	/* @wait_ns that was long enough */
	bool settled;	/* a shorter wait was too short */
	u64 began_ns;
};

static void is_done(struct reader *r)
{
	struct ec_bus *bus = r->slave->bus;

	r->done = true;
	WRITE_ONCE(bus->scan_index, bus->scan_index + 1);
}

static void scan_sii_finish(struct reader *r)
{
	struct ec_slave *s = r->slave;

	is_done(r);
	swap(s->sii, s->part);
	swap(s->sii_bytes, s->part_bytes);
}

/* @remedy: what the user can do; it is tried again in any case */
static void scan_sii_fail(struct reader *r, const char *what, const char *remedy)
{
	struct ec_slave *s = r->slave;

	is_done(r);
	ec_slave_fail(s, EC_SLAVE_SCAN_FAILED, EC_CAUSE(EEPROM),
		      "SII read failed at word 0x%04zx: %s; %s", s->part_bytes / 2, what, remedy);
	kvfree(s->part);
	s->part = NULL;
	s->part_bytes = 0;
	atomic_long_sub(s->sii_counted, &s->bus->sii_bytes);
	s->sii_counted = 0;
}

/* The slave keeps what was read; the next scan continues from there. */
static void interrupt(struct reader *r)
{
	struct ec_slave *s = r->slave;

	is_done(r);
	s->error = EC_SLAVE_SCAN_FAILED;
	s->cause = *EC_CAUSE(EEPROM_PART);
	snprintf(s->why, sizeof(s->why),
		 "large EEPROM, 0x%04zx words read up to now, the rest follows",
		 s->part_bytes / 2);
	if (!r->began)
		ec_slave_info(s, "%s\n", s->why);
}

static bool takes_long(const struct job *j, const struct reader *r)
{
	u64 ns = ktime_get_ns() - j->began_ns;

	return ns > PART_MAX_NS ||
	       (ns > PART_NS && r->slave->part_bytes - r->began >= PART_BYTES);
}

static void interrupt_long(struct job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++) {
		struct reader *r = &j->rd[i];

		if (!r->done && r->slave->part_bytes > r->began && takes_long(j, r))
			interrupt(r);
	}
}

/* The images of all slaves have a limit together. */
static bool scan_sii_count(struct ec_bus *bus, size_t bytes)
{
	if (atomic_long_add_return(bytes, &bus->sii_bytes) <= EC_MAX_SII_TOTAL)
		return true;
	atomic_long_sub(bytes, &bus->sii_bytes);
	return false;
}

/* Images of disconnected devices only save time. */
static bool count_without_kept(struct ec_bus *bus, size_t bytes)
{
	ec_known_forget_images(bus);
	return scan_sii_count(bus, bytes);
}

/* Without memory the reader has failed. */
static void enlarge(struct reader *r, size_t bytes)
{
	struct ec_slave *s = r->slave;
	size_t more = bytes - s->sii_counted;
	u8 *p;

	if (!scan_sii_count(s->bus, more) && !count_without_kept(s->bus, more)) {
		scan_sii_fail(r, "the EEPROMs of all slaves exceed 64 MiB",
			      "disconnect slaves with large EEPROMs");
		return;
	}
	p = kvzalloc(bytes, GFP_KERNEL);
	if (!p) {
		atomic_long_sub(more, &s->bus->sii_bytes);
		scan_sii_fail(r, "no memory", "free memory of this computer");
		return;
	}
	if (s->part)
		memcpy(p, s->part, s->part_bytes);
	kvfree(s->part);
	s->part = p;
	s->sii_counted = bytes;
}

/* Enlarge the buffer for the next access, or end the reader after the last one. */
static void scan_sii_plan(struct reader *r)
{
	struct ec_slave *s = r->slave;
	int need;

	if (s->part_bytes < r->need)
		return;
	need = ec_sii_needed(s->part, s->part_bytes);
	if (need <= 0 || s->part_bytes >= EC_MAX_SII_BYTES) {
		/* with the header of a category that is too large, which is cut off next */
		ec_sii_check(s->part, s->part_bytes, &s->flaw);
		if (!need)
			s->part_bytes = ec_sii_used(s->part, s->part_bytes) ?: s->part_bytes;
		scan_sii_finish(r);
		return;
	}
	r->need = min_t(size_t, need, EC_MAX_SII_BYTES);
	if (r->need + 8 > s->sii_counted)
		enlarge(r, max_t(size_t, r->need + 8, s->sii_counted * 2));
}

/* The word that the reader needs next. */
static u32 next_word(const struct reader *r)
{
	return r->kept ? r->check : r->slave->part_bytes / 2;
}

/* Is it a device that was connected before? Then few words show whether its image is the same. */
static void look_for_kept(struct reader *r)
{
	struct ec_slave *s = r->slave;

	if (r->looked || r->began || s->part_bytes < HEAD_BYTES)
		return;
	r->looked = true;
	r->kept = ec_known_image(s->bus, s->kept_station, s->part);
	r->check = SIZE_WORD;
}

/* The last access that lies within the image */
static u32 last_word(const struct ec_image *image)
{
	return (image->bytes - 8) / 2 & ~3u;
}

static void drop_kept(struct reader *r)
{
	ec_image_put(r->kept);
	r->kept = NULL;
}

/* The device is the one that was disconnected: its image is taken, the rest is not read. */
static void take_kept(struct reader *r)
{
	const struct ec_image *kept = r->kept;
	struct ec_slave *s = r->slave;

	if (kept->bytes > s->sii_counted)
		enlarge(r, kept->bytes);
	if (!r->done) {
		memcpy(s->part, kept->sii, kept->bytes);
		s->part_bytes = kept->bytes;
		s->flaw = kept->flaw;
		scan_sii_finish(r);
	}
	drop_kept(r);
}

static void compare_kept(struct reader *r, const u8 *data, size_t len)
{
	if (memcmp(r->kept->sii + 2 * r->check, data, len))
		drop_kept(r);
	else if (r->check == SIZE_WORD && last_word(r->kept) != SIZE_WORD)
		r->check = last_word(r->kept);
	else
		take_kept(r);
}

/* An access that ended without data; asking again does not help. */
static bool scan_sii_refused(const struct reader *r)
{
	u16 ctl = get_unaligned_le16(r->reg);

	return !(ctl & EC_EEP_BUSY) && ctl & EC_EEP_ERR_ACK;
}

/* Take a result; true when the slave has answered what was asked. */
static bool scan_sii_take(struct reader *r)
{
	struct ec_slave *s = r->slave;
	u32 word = next_word(r);
	u16 ctl = get_unaligned_le16(r->reg);
	/* controllers for small EEPROMs have 16 bits */
	u32 mask = word > 0xffff ? ~0u : 0xffff;
	size_t got = min_t(size_t, ctl & EC_EEP_READ8 ? 8 : 4, r->len - 6);

	if (ctl & (EC_EEP_BUSY | EC_EEP_CMD_MASK) || ctl & EC_EEP_ERR_ACK ||
	    (get_unaligned_le32(r->reg + 2) & mask) != word)
		return false;
	r->len = 6 + got;
	r->tries = 0;
	if (r->kept) {
		compare_kept(r, r->reg + 6, got);
		return true;
	}
	memcpy(s->part + s->part_bytes, r->reg + 6, got);
	s->part_bytes += got;
	scan_sii_plan(r);
	look_for_kept(r);
	return true;
}

/* Without link, or with other slaves, none is to blame: the scan ends and fails as a whole. */
static bool scan_sii_go_on(const struct job *j)
{
	return !READ_ONCE(j->bus->base->stopping) && ec_links_is_up(j->bus->links);
}

static void command(u8 *c, u32 word)
{
	put_unaligned_le16(EC_EEP_CMD_READ, c);
	put_unaligned_le32(word, c + 2);
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
			is_done(rds[i]);
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

	command(j->cmd[0], word);
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
		if (scan_sii_refused(rds[i]))
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
		if (!left || !scan_sii_go_on(j))
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

/* Each of @rds reads at its own word; errors are acknowledged first. */
static void start_apart(struct job *j, struct reader **rds, unsigned int n)
{
	static const u8 zero[2];
	unsigned int i, k = 0;

	for (i = 0; i < n; i++)
		if (get_unaligned_le16(rds[i]->reg) & EC_EEP_ERR_MASK)
			j->dg[k++] = EC_FPWR(rds[i]->slave->station, EC_REG_EEP_CONTROL, 2, zero);
	ec_xfer(j->bus->links, j->dg, k);
	for (i = 0; i < n; i++) {
		command(j->cmd[i], next_word(rds[i]));
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
			scan_sii_fail(r, r->unheard ? "no reply" :
				      scan_sii_refused(r) ? "no acknowledge" : "busy too long",
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

	for (; scan_sii_go_on(j) && (n = apart(j, j->rds)); interrupt_long(j)) {
		start_apart(j, j->rds, n);
		t0 = ktime_get_ns();
		for (left = n;
		     left && ktime_get_ns() - t0 < STEP_TIMEOUT_NS && scan_sii_go_on(j);) {
			usleep_range(300, 400);
			left = drop_gone(j, j->rds, scan_sii_look(j, j->rds, left, left));
		}
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
			*word = min(*word, next_word(&j->rd[i]));
	for (i = 0; i < j->n; i++)
		if (in_lockstep(&j->rd[i]) && next_word(&j->rd[i]) == *word)
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
	for (; n && scan_sii_go_on(j); n = waiting(j, &word)) {
		scan_sii_step(j, j->rds, n, word);
		interrupt_long(j);
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
	for (i = 0; i < n; i++) {
		struct reader *r = &j.rd[i];

		r->slave = slaves[i];
		r->need = FIRST_BYTES;
		r->len = sizeof(r->reg);
		r->began = slaves[i]->part_bytes;
		/* continue where the previous scan was interrupted */
		if (slaves[i]->part)
			scan_sii_plan(r);
		else
			enlarge(r, FIRST_CAP);
	}
	scan_sii_run(&j);
	for (i = 0; i < n; i++)
		drop_kept(&j.rd[i]);
out:
	kvfree(j.rd);
	kvfree(j.dg);
	kvfree(j.cmd);
	kvfree(j.rds);
}
