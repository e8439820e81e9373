// SPDX-License-Identifier: GPL-2.0-only
/*
 * Reading the EEPROMs of many slaves in lockstep. One command starts the same
 * read everywhere, packed reads collect the results. A slave that is slow,
 * refuses, misses the command or has come to its end leaves the lockstep.
 */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "master.h"
#include "slave.h"
#include "wire/sii.h"
#include "xfer.h"

#define STEP_TIMEOUT_NS	(20 * NSEC_PER_MSEC)	/* one access, esc-registers 11 */
#define RETRIES		5
#define FIRST_BYTES	EC_SII_FIXED_SIZE

/* one slave being read */
struct reader {
	struct ec_slave *slave;
	u8 *buf;
	size_t cap;
	size_t have;
	size_t need;
	u8 tries;
	bool alone;	/* left the lockstep */
	bool done;
	u8 reg[14];	/* 0x0502-0x050F */
};

struct job {
	struct ec_master *m;
	struct reader *rd;
	unsigned int n;
	struct ec_dg *dg;
	u8 (*cmd)[6];
	struct reader **who;
	bool broadcast;
};

static void finish(struct reader *r)
{
	struct ec_slave *s = r->slave;

	r->done = true;
	s->sii = r->buf;
	s->sii_bytes = r->have;
	r->buf = NULL;
}

static void fail(struct reader *r, const char *what)
{
	r->done = true;
	ec_slave_fail(r->slave, EC_SLAVE_SCAN_FAILED,
		      "EEPROM: %s at word 0x%04zx; check the slave, then rescan", what, r->have / 2);
}

/* Room for the next access, and whether there is a next one. */
static void plan(struct reader *r)
{
	int need;
	u8 *p;

	if (r->have < r->need)
		return;
	need = ec_sii_needed(r->buf, r->have);
	if (need <= 0 || r->have >= EC_MAX_SII_BYTES) {
		if (!need && ec_sii_used(r->buf, r->have))
			r->have = ec_sii_used(r->buf, r->have);
		finish(r);
		return;
	}
	r->need = min_t(size_t, need, EC_MAX_SII_BYTES);
	if (r->need + 8 > r->cap) {
		size_t cap = max_t(size_t, r->need + 8, r->cap * 2);

		p = kvzalloc(cap, GFP_KERNEL);
		if (!p) {
			fail(r, "no memory");
			return;
		}
		memcpy(p, r->buf, r->have);
		kvfree(r->buf);
		r->buf = p;
		r->cap = cap;
	}
}

/* Take a result; true when the slave has answered what was asked. */
static bool take(struct reader *r, u16 word)
{
	u16 ctl = get_unaligned_le16(r->reg);
	size_t got = ctl & EC_EEP_READ8 ? 8 : 4;

	if (ctl & (EC_EEP_BUSY | EC_EEP_CMD_MASK) || ctl & EC_EEP_ERR_ACK ||
	    get_unaligned_le16(r->reg + 2) != word)
		return false;
	memcpy(r->buf + r->have, r->reg + 6, got);
	r->have += got;
	r->tries = 0;
	plan(r);
	return true;
}

static void command(u8 *c, u16 word)
{
	put_unaligned_le16(EC_EEP_CMD_READ, c);
	put_unaligned_le32(word, c + 2);
}

/* FPRD 0x0502 of @n readers */
static void collect(struct job *j, struct reader **who, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++)
		j->dg[i] = (struct ec_dg)EC_DG(EC_CMD_FPRD, who[i]->slave->station,
					       EC_REG_EEP_CONTROL, sizeof(who[i]->reg),
					       who[i]->reg);
	ec_xfer(j->m, j->dg, n);
	for (i = 0; i < n; i++)
		if (j->dg[i].err || j->dg[i].wkc != 1)
			put_unaligned_le16(EC_EEP_BUSY, who[i]->reg);
}

/* Start the same read in all of @who; broadcast where all slaves are meant. */
static void start(struct job *j, struct reader **who, unsigned int n, u16 word)
{
	unsigned int i;

	command(j->cmd[0], word);
	if (j->broadcast) {
		ec_xfer_one(j->m, EC_CMD_BWR, 0, EC_REG_EEP_CONTROL, j->cmd[0], 6);
		return;
	}
	for (i = 0; i < n; i++)
		j->dg[i] = (struct ec_dg)EC_DG(EC_CMD_FPWR, who[i]->slave->station,
					       EC_REG_EEP_CONTROL, 6, j->cmd[0]);
	ec_xfer(j->m, j->dg, n);
}

/* One access for all slaves at word @word; returns how many advanced. */
static void step(struct job *j, struct reader **who, unsigned int n, u16 word, u32 *busy_us)
{
	u64 t0 = ktime_get_ns();
	unsigned int i, left = n;

	start(j, who, n, word);
	if (*busy_us > 20)
		usleep_range(*busy_us, *busy_us + 10);
	for (;;) {
		unsigned int k = 0;

		collect(j, who, left);
		for (i = 0; i < left; i++)
			if (!take(who[i], word))
				who[k++] = who[i];
		left = k;
		if (!left)
			break;
		/* the slowest tenth is handled apart instead of holding the others */
		if (ktime_get_ns() - t0 > STEP_TIMEOUT_NS ||
		    (left * 10 <= n && ktime_get_ns() - t0 > 4 * NSEC_PER_MSEC)) {
			for (i = 0; i < left; i++)
				who[i]->alone = true;
			return;
		}
		usleep_range(20, 30);
	}
	/* learn how long it takes, so that the first look usually succeeds */
	*busy_us = (3 * *busy_us + (u32)div_u64(ktime_get_ns() - t0, 1000) * 7 / 8) / 4;
	*busy_us = min_t(u32, *busy_us, 2000);
}

/* A slave that could not keep up: by itself, with retries. */
static void read_alone(struct job *j, struct reader *r)
{
	u8 zero[2] = { 0, 0 };
	u64 t0;

	while (!r->done) {
		u16 word = r->have / 2;

		if (r->tries++ >= RETRIES) {
			fail(r, get_unaligned_le16(r->reg) & EC_EEP_ERR_ACK ?
			     "no acknowledge" : "busy too long");
			return;
		}
		if (get_unaligned_le16(r->reg) & EC_EEP_ERR_MASK)
			ec_xfer_fpwr(j->m, r->slave->station, EC_REG_EEP_CONTROL, zero, 2);
		command(j->cmd[0], word);
		if (ec_xfer_fpwr(j->m, r->slave->station, EC_REG_EEP_CONTROL, j->cmd[0], 6))
			continue;
		t0 = ktime_get_ns();
		do {
			usleep_range(300, 400);
			collect(j, &r, 1);
			if (take(r, word))
				break;
		} while (get_unaligned_le16(r->reg) & EC_EEP_BUSY &&
			 ktime_get_ns() - t0 < STEP_TIMEOUT_NS && !j->m->stopping);
	}
}

/* The smallest word somebody in the lockstep waits for, and who waits for it. */
static unsigned int waiting(struct job *j, u16 *word)
{
	unsigned int i, n = 0;
	size_t low = SIZE_MAX;

	for (i = 0; i < j->n; i++)
		if (!j->rd[i].done && !j->rd[i].alone && j->rd[i].have < low)
			low = j->rd[i].have;
	if (low == SIZE_MAX)
		return 0;
	for (i = 0; i < j->n; i++)
		if (!j->rd[i].done && !j->rd[i].alone && j->rd[i].have == low)
			j->who[n++] = &j->rd[i];
	*word = low / 2;
	return n;
}

static void run(struct job *j)
{
	u32 busy_us = 0;
	unsigned int i, n;
	u16 word;

	while ((n = waiting(j, &word)) && !j->m->stopping)
		step(j, j->who, n, word, &busy_us);
	for (i = 0; i < j->n && !j->m->stopping; i++)
		if (!j->rd[i].done)
			read_alone(j, &j->rd[i]);
}

/**
 * ec_scan_sii() - read the EEPROMs of @slaves
 * @m: master
 * @slaves: slaves with station addresses; @sii is set where it worked, the
 *	others are marked as failed
 * @n: how many
 * @all: these are all slaves of the segment and no process data run, so
 *	broadcasts are allowed
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_scan_sii(struct ec_master *m, struct ec_slave **slaves, unsigned int n, bool all)
{
	struct job j = { .m = m, .n = n, .broadcast = all };
	unsigned int i;

	j.rd = kvcalloc(n, sizeof(*j.rd), GFP_KERNEL);
	j.dg = kvcalloc(n, sizeof(*j.dg), GFP_KERNEL);
	j.cmd = kvcalloc(n, sizeof(*j.cmd), GFP_KERNEL);
	j.who = kvcalloc(n, sizeof(*j.who), GFP_KERNEL);
	if (!j.rd || !j.dg || !j.cmd || !j.who)
		goto out;
	for (i = 0; i < n; i++) {
		struct reader *r = &j.rd[i];

		r->slave = slaves[i];
		r->need = FIRST_BYTES;
		r->cap = 2048;
		r->buf = kvzalloc(r->cap, GFP_KERNEL);
		if (!r->buf)
			fail(r, "no memory");
	}
	run(&j);
	for (i = 0; i < n; i++)
		kvfree(j.rd[i].buf);
out:
	kvfree(j.rd);
	kvfree(j.dg);
	kvfree(j.cmd);
	kvfree(j.who);
}
