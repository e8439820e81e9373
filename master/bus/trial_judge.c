// SPDX-License-Identifier: GPL-2.0-only
/*
 * Which device is behind a port at which not every one is let in? Each access to its EEPROM is a
 * trial: one reads the result of the access before, and begins the next one. The device is in INIT.
 */
#include <linux/ctype.h>
#include <linux/delay.h>
#include <linux/ktime.h>
#include "../wire/sii.h"
#include "border.h"
#include "graph.h"
#include "known.h"
#include "trial_int.h"

#define ACCESS_NS	(20 * NSEC_PER_MSEC)	/* of one access to the EEPROM */
#define POLLS		4	/* of it at least, beside a slow cycle */
#define ALL_NS		(NSEC_PER_SEC)		/* of a device */
#define STATE_NS	(300 * NSEC_PER_MSEC)	/* until it is in INIT, and has answered */
#define STATE_POLLS	10
#define CATEGORIES	16
#define STRINGS		128	/* bytes in which its name is looked for */
#define POLL_US		100

/**
 * struct eeprom - access to the EEPROM of a guest
 * @t: trials
 * @g: guest
 * @until: end of all (ktime)
 * @command: registers 0x0502 to 0x0507
 * @reg: 0x0502 to 0x050f
 */
struct eeprom {
	struct ec_trials *t;
	struct ec_guest *g;
	u64 until;
	u8 command[6];
	u8 reg[14];
};

/* Frames that are lost are sent again; -ENOLINK: the contact broke. */
static int judge_run(struct ec_trials *t, const struct ec_guest *g)
{
	unsigned int i, n = t->n;
	int ret = -EAGAIN;

	for (i = 0; i < EC_TRIAL_TRIES && ret == -EAGAIN; i++) {
		t->n = n;
		ret = ec_trial_run(t, g->station);
		ret = ret ?: t->work[n - 1].wkc == 1 ? 0 : -EAGAIN;
	}
	return ret;
}

static int eeprom_start(struct eeprom *e, u32 word)
{
	static const u8 force[1] = { EC_EEP_OWNER_FORCE }, zero[1];
	u16 station = e->g->station;

	put_unaligned_le16(EC_EEP_CMD_READ, e->command);
	put_unaligned_le32(word, e->command + 2);
	e->t->n = 0;
	ec_trial_add(e->t, EC_FPWR(station, EC_REG_EEP_OWNER, 1, force))->last = true;
	ec_trial_add(e->t, EC_FPWR(station, EC_REG_EEP_OWNER, 1, zero))->last = true;
	ec_trial_add(e->t, EC_FPWR(station, EC_REG_EEP_CONTROL, 6, e->command));
	return judge_run(e->t, e->g);
}

/* 4 or 8 bytes from @word on, into e->reg + 6. Returns how many; -EIO: they cannot be read. */
static int eeprom_read(struct eeprom *e, u32 word)
{
	u64 begin = ktime_get_ns();
	unsigned int polls;
	int ret = eeprom_start(e, word);

	for (polls = 0; !ret; polls++) {
		u64 now = ktime_get_ns();
		u16 ctl;

		if (now > e->until || (now - begin > ACCESS_NS && polls >= POLLS))
			return -EIO;
		usleep_range(POLL_US, 2 * POLL_US);
		ec_trial_look_for_lost(e->t);
		e->t->n = 0;
		ec_trial_add(e->t, EC_FPRD(e->g->station, EC_REG_EEP_CONTROL, 14, e->reg));
		ret = judge_run(e->t, e->g);
		ctl = get_unaligned_le16(e->reg);
		if (ret || ctl & (EC_EEP_BUSY | EC_EEP_CMD_MASK))
			continue;
		if (ctl & EC_EEP_ERR_ACK || get_unaligned_le16(e->reg + 2) != (u16)word)
			return -EIO;
		return ctl & EC_EEP_READ8 ? 8 : 4;
	}
	return ret;
}

static int read_bytes(struct eeprom *e, u32 word, u8 *buf, unsigned int bytes)
{
	unsigned int have = 0;

	while (have < bytes) {
		int got = eeprom_read(e, word + have / 2);

		if (got < 0)
			return got;
		memcpy(buf + have, e->reg + 6, min_t(unsigned int, got, bytes - have));
		have += got;
	}
	return 0;
}

/* where the categories with name and identification are, in words; 0: there is none */
struct places {
	u32 strings;
	u32 string_bytes;
	u32 general;
};

static int find_places(struct eeprom *e, struct places *p)
{
	u32 word = EC_SII_W_CATEGORIES;
	unsigned int i;

	for (i = 0; i < CATEGORIES; i++) {
		u8 header[EC_SII_CAT_HDR];
		int ret = read_bytes(e, word, header, sizeof(header));
		u16 type = get_unaligned_le16(header), words = get_unaligned_le16(header + 2);

		if (ret || type == EC_SII_CAT_END)
			return ret;
		word += 2;
		if (type == EC_SII_CAT_STRINGS) {
			p->strings = word;
			p->string_bytes = 2 * words;
		}
		if (type == EC_SII_CAT_GENERAL && 2 * words >= EC_SII_GENERAL_BYTES) {
			p->general = word;
			return 0;
		}
		word += words;
	}
	return 0;
}

/* Request the identification in INIT; 0: there was no answer. */
static int ask_by_al(struct eeprom *e, u16 *identification)
{
	static const u8 request[2] = { EC_AL_INIT | EC_AL_ID, 0 }, end[2] = { EC_AL_INIT, 0 };
	u8 reply[EC_REG_AL_CODE + 2 - EC_REG_AL_STATUS] = { 0 };
	u16 station = e->g->station, status = 0;
	u64 begin = ktime_get_ns();
	unsigned int i;
	int ret = 0;

	for (i = 0; !ret && (i < STATE_POLLS || ktime_get_ns() - begin < STATE_NS); i++) {
		e->t->n = 0;
		if (status == EC_AL_INIT)
			ec_trial_add(e->t, EC_FPWR(station, EC_REG_AL_CONTROL, 2, request));
		ec_trial_add(e->t, EC_FPRD(station, EC_REG_AL_STATUS, sizeof(reply), reply));
		ret = judge_run(e->t, e->g);
		status = get_unaligned_le16(reply);
		if (!ret && status == (EC_AL_INIT | EC_AL_ID))
			break;
		usleep_range(POLL_US, 2 * POLL_US);
		ec_trial_look_for_lost(e->t);
	}
	if (!ret && status == (EC_AL_INIT | EC_AL_ID))
		*identification = get_unaligned_le16(reply + EC_REG_AL_CODE - EC_REG_AL_STATUS);
	e->t->n = 0;
	ec_trial_add(e->t, EC_FPWR(station, EC_REG_AL_CONTROL, 2, end));
	/* a device whose firmware does not run takes no request, not the end of one either */
	return ret ?: judge_run(e->t, e->g) == -ENOLINK ? -ENOLINK : 0;
}

static int read_identification(struct eeprom *e, const struct places *p, struct ec_behind *is)
{
	u8 general[0x14], value[2] = { 0 };
	u16 address;
	int ret;

	if (!p->general)
		return 0;
	ret = read_bytes(e, p->general, general, sizeof(general));
	if (ret)
		return ret;
	if (general[0x0b] & EC_SII_FLAG_ID_AL)
		return ask_by_al(e, &is->identification);
	address = get_unaligned_le16(general + 0x12);
	/* registers are no memory: the read of some changes them */
	if (!(general[0x0b] & EC_SII_FLAG_ID_MEM) || address < EC_REG_DIGITAL_OUT)
		return 0;
	e->t->n = 0;
	ec_trial_add(e->t, EC_FPRD(e->g->station, address, 2, value));
	ret = judge_run(e->t, e->g);
	is->identification = ret ? 0 : get_unaligned_le16(value);
	return ret;
}

/* String @index of the category at @data, of @len bytes; what is no text becomes '?'. */
static void take_string(const u8 *data, size_t len, unsigned int index, char *name, size_t size)
{
	size_t at = 1, i;

	while (--index && at < len)
		at += 1 + data[at];
	if (at >= len)
		return;
	size = min3(size - 1, (size_t)data[at], len - at - 1);
	for (i = 0; i < size; i++)
		name[i] = isascii(data[at + 1 + i]) && isprint(data[at + 1 + i]) ?
			  data[at + 1 + i] : '?';
	name[i] = '\0';
}

/* For users only: without it there are the numbers. */
static int judge_read_name(struct eeprom *e, const struct places *p, struct ec_behind *is)
{
	u8 strings[STRINGS], index[4];
	size_t len = min_t(size_t, p->string_bytes, sizeof(strings));
	int ret;

	if (!p->general || !len)
		return 0;
	ret = read_bytes(e, p->general, index, sizeof(index)) ?:
	      read_bytes(e, p->strings, strings, len);
	if (!ret && (index[2] || index[3]))
		take_string(strings, len, index[2] ?: index[3], is->name, sizeof(is->name));
	return ret;
}

/* -EIO: it cannot be read; -EAGAIN, -ENOLINK: it could not now. */
static int read_identity(struct eeprom *e, struct places *p, unsigned int asks,
			 struct ec_behind *is)
{
	u8 id[16];
	int ret = read_bytes(e, EC_SII_W_VENDOR, id, sizeof(id));

	if (ret)
		return ret;
	is->vendor = get_unaligned_le32(id);
	is->product = get_unaligned_le32(id + 4);
	is->revision = get_unaligned_le32(id + 8);
	is->serial = get_unaligned_le32(id + 12);
	if (!(asks & EC_BORDER_ID))
		return 0;
	return find_places(e, p) ?: read_identification(e, p, is);
}

/* Open the ports of a device that stays outside, for the count of the next trial. */
static void judge_leave(struct ec_trials *t, const struct ec_guest *g)
{
	static const u8 open[1];

	t->n = 0;
	ec_trial_add(t, EC_FPWR(g->station, EC_REG_DL_LOOPS, 1, open));
	judge_run(t, g);
}

static bool is_unlisted(struct ec_trials *t, const struct ec_behind *is)
{
	struct ec_behind was;

	return !ec_border_get(t->bus, t->host.device, t->port, &was) ||
	       was.vendor != is->vendor || was.product != is->product || !was.name[0];
}

static void behind_begin(struct ec_trials *t, const struct ec_guest *g, u32 kept)
{
	t->is = (struct ec_behind){
		.kept = kept, .slaves = g->behind, .alias = get_unaligned_le16(g->station_was + 2),
	};
}

/**
 * ec_trial_in_boot() - is a device in BOOT, behind a port at which not every one is let in?
 * @t: trials; @is is set
 * @g: device
 *
 * It is left alone: its firmware may be written.
 *
 * Context: The monitor thread.
 * Return: whether it is, and no user has let it in.
 */
bool ec_trial_in_boot(struct ec_trials *t, const struct ec_guest *g)
{
	if (!ec_border_asks(t->bus, t->host.device, t->port) ||
	    (get_unaligned_le16(g->al) & EC_AL_STATE_MASK) != EC_AL_BOOT)
		return false;
	behind_begin(t, g, EC_PORT_BOOT);
	t->is.kept = ec_border_judge(t->bus, t->host.device, t->port, &t->is);
	return t->is.kept;
}

/**
 * ec_trial_judge() - may a device be let in?
 * @t: trials; @is is set if not
 * @g: device, harmless
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 0: it may; -EPERM: it may not; -EAGAIN: frames were lost; -ENOLINK: the contact broke.
 */
int ec_trial_judge(struct ec_trials *t, struct ec_guest *g)
{
	unsigned int asks = ec_border_asks(t->bus, t->host.device, t->port);
	struct eeprom e = { .t = t, .g = g, .until = ktime_get_ns() + ALL_NS };
	struct places p = { 0 };
	u32 kept;
	int ret;

	/* a user has let it in although it was in BOOT */
	if (!asks || (get_unaligned_le16(g->al) & EC_AL_STATE_MASK) == EC_AL_BOOT)
		return 0;
	behind_begin(t, g, EC_PORT_NOT_KEPT);
	ret = read_identity(&e, &p, asks, &t->is);
	if (ret && ret != -EIO)
		return ret;
	t->is.kept = ret ? EC_PORT_UNREADABLE : g->entry ? EC_PORT_REVERSED : EC_PORT_NOT_KEPT;
	kept = ec_border_judge(t->bus, t->host.device, t->port, &t->is);
	if (kept == EC_PORT_UNKNOWN &&
	    ec_known_is(t->bus, g->kept, t->is.vendor, t->is.product, t->is.serial))
		kept = EC_PORT_NOT_KEPT;
	t->is.kept = kept;
	if (!kept)
		return 0;
	if (kept != EC_PORT_UNREADABLE && is_unlisted(t, &t->is) &&
	    ((asks & EC_BORDER_ID) || !find_places(&e, &p)))
		judge_read_name(&e, &p, &t->is);
	judge_leave(t, g);
	return -EPERM;
}
