// SPDX-License-Identifier: GPL-2.0-only
/*
 * What was read of the EEPROM of one slave, and how far it is to be read.
 *
 * A large EEPROM, or one full of garbage, takes a minute. It is read in parts, each by a
 * scan of its own: the other slaves and the monitor do not wait for it.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "known.h"
#include "scan_sii_int.h"

#define FIRST_BYTES	EC_SII_FIXED_SIZE
#define FIRST_CAP	2048
#define SIZE_WORD	0x3e	/* size and version of the EEPROM, also in an access of 4 bytes */
#define PART_BYTES	16384	/* a part has so many at least */
#define PART_NS		(2ULL * NSEC_PER_SEC)	/* and may take so long */
#define PART_MAX_NS	(10ULL * NSEC_PER_SEC)	/* beside a slow cycle it has fewer */

/**
 * ec_scan_image_done() - the scan reads no more of an EEPROM
 * @r: reader
 *
 * Context: The monitor thread.
 */
void ec_scan_image_done(struct reader *r)
{
	struct ec_bus *bus = r->slave->bus;

	r->done = true;
	WRITE_ONCE(bus->scan_index, bus->scan_index + 1);
}

static void image_finish(struct reader *r)
{
	struct ec_slave *s = r->slave;

	ec_scan_image_done(r);
	swap(s->eeprom.data, s->eeprom.part);
	swap(s->eeprom.bytes, s->eeprom.part_bytes);
	s->work.renew = false;
}

/**
 * ec_scan_image_fail() - an EEPROM cannot be read
 * @r: reader
 * @what: cause
 * @remedy: what the user can do; it is tried again in any case
 *
 * Context: The monitor thread.
 */
void ec_scan_image_fail(struct reader *r, const char *what, const char *remedy)
{
	struct ec_slave *s = r->slave;

	ec_scan_image_done(r);
	ec_slave_fail(s, EC_SLAVE_SCAN_FAILED, EC_CAUSE(EEPROM),
		      "SII read failed at word 0x%04zx: %s; %s", s->eeprom.part_bytes / 2, what,
		      remedy);
	kvfree(s->eeprom.part);
	s->eeprom.part = NULL;
	s->eeprom.part_bytes = 0;
	atomic_long_sub(s->eeprom.counted, &s->bus->sii_bytes);
	s->eeprom.counted = 0;
}

/* The slave keeps what was read; the next scan continues from there. */
static void image_end_part(struct reader *r)
{
	struct ec_slave *s = r->slave;

	ec_scan_image_done(r);
	s->note.error = EC_SLAVE_SCAN_FAILED;
	s->note.cause = *EC_CAUSE(EEPROM_PART);
	snprintf(s->note.why, sizeof(s->note.why),
		 "large EEPROM, 0x%04zx words read up to now, the rest follows",
		 s->eeprom.part_bytes / 2);
	if (!r->began)
		ec_slave_info(s, "%s\n", s->note.why);
}

static bool takes_long(const struct job *j, const struct reader *r)
{
	u64 ns = ktime_get_ns() - j->began_ns;

	return ns > PART_MAX_NS ||
	       (ns > PART_NS && r->slave->eeprom.part_bytes - r->began >= PART_BYTES);
}

/**
 * ec_scan_image_interrupt() - end the parts of EEPROMs that take long
 * @j: job
 *
 * Context: The monitor thread.
 */
void ec_scan_image_interrupt(struct job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++) {
		struct reader *r = &j->rd[i];

		if (!r->done && r->slave->eeprom.part_bytes > r->began && takes_long(j, r))
			image_end_part(r);
	}
}

/* The images of all slaves have a limit together. */
static bool image_count(struct ec_bus *bus, size_t bytes)
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
	return image_count(bus, bytes);
}

/**
 * ec_scan_image_enlarge() - enlarge the memory of an image
 * @r: reader, which has failed afterwards if there is no memory
 * @bytes: of the memory
 *
 * Context: The monitor thread. May sleep.
 */
void ec_scan_image_enlarge(struct reader *r, size_t bytes)
{
	struct ec_slave *s = r->slave;
	size_t more = bytes - s->eeprom.counted;
	u8 *p;

	if (!image_count(s->bus, more) && !count_without_kept(s->bus, more)) {
		ec_scan_image_fail(r, "the EEPROMs of all slaves exceed 64 MiB",
			      "disconnect slaves with large EEPROMs");
		return;
	}
	p = kvzalloc(bytes, GFP_KERNEL);
	if (!p) {
		atomic_long_sub(more, &s->bus->sii_bytes);
		ec_scan_image_fail(r, "no memory", "free memory of this computer");
		return;
	}
	if (s->eeprom.part)
		memcpy(p, s->eeprom.part, s->eeprom.part_bytes);
	kvfree(s->eeprom.part);
	s->eeprom.part = p;
	s->eeprom.counted = bytes;
}

/**
 * ec_scan_image_plan() - enlarge the memory for the next access
 * @r: reader; it is done after the last access
 *
 * Context: The monitor thread. May sleep.
 */
void ec_scan_image_plan(struct reader *r)
{
	struct ec_slave *s = r->slave;
	int need;

	if (s->eeprom.part_bytes < r->need)
		return;
	need = ec_sii_needed(s->eeprom.part, s->eeprom.part_bytes);
	if (need <= 0 || s->eeprom.part_bytes >= EC_MAX_SII_BYTES) {
		/* with the header of a category that is too large, which is cut off next */
		ec_sii_check(s->eeprom.part, s->eeprom.part_bytes, &s->eeprom.flaw);
		if (!need)
			s->eeprom.part_bytes = ec_sii_used(s->eeprom.part, s->eeprom.part_bytes) ?:
					       s->eeprom.part_bytes;
		image_finish(r);
		return;
	}
	r->need = min_t(size_t, need, EC_MAX_SII_BYTES);
	if (r->need + 8 > s->eeprom.counted)
		ec_scan_image_enlarge(r, max_t(size_t, r->need + 8, s->eeprom.counted * 2));
}

/**
 * ec_scan_image_word() - the word that the reader needs next
 * @r: reader
 *
 * Context: Any.
 * Return: its address.
 */
u32 ec_scan_image_word(const struct reader *r)
{
	return r->kept ? r->check : r->slave->eeprom.part_bytes / 2;
}

/* Has it read the head, after which it looks for a device that was connected before? */
static bool has_to_look(const struct reader *r)
{
	return !r->looked && !r->began;
}

/**
 * ec_scan_image_room() - how far an EEPROM may be read without a decision
 * @r: reader that is not done
 *
 * Context: The monitor thread.
 * Return: bytes at which no access begins.
 */
u32 ec_scan_image_room(const struct reader *r)
{
	return has_to_look(r) ? EC_SII_HEAD : r->slave->eeprom.counted - 8;
}

/**
 * ec_scan_image_reads_on() - is more to be read, and does it fit into the memory of the image?
 * @r: reader; @need is set if so
 * @bytes: read so far
 *
 * Context: The monitor thread.
 * Return: whether it is so.
 */
bool ec_scan_image_reads_on(struct reader *r, size_t bytes)
{
	int need = ec_sii_needed(r->slave->eeprom.part, bytes);

	if (need <= 0 || bytes >= EC_MAX_SII_BYTES || need + 8 > r->slave->eeprom.counted)
		return false;
	r->need = need;
	return true;
}

/* Is it a device that was connected before? Then few words show whether its image is the same. */
static void look_for_kept(struct reader *r)
{
	struct ec_slave *s = r->slave;

	if (!has_to_look(r) || s->eeprom.part_bytes < EC_SII_HEAD)
		return;
	r->looked = true;
	r->kept = ec_known_image(s->bus, s->kept_station, s->eeprom.part);
	r->check = SIZE_WORD;
}

/* The last access that lies within the image */
static u32 last_word(const struct ec_image *image)
{
	return (image->bytes - 8) / 2 & ~3u;
}

/**
 * ec_scan_image_drop() - compare with no image any more
 * @r: reader
 *
 * Context: The monitor thread. May sleep.
 */
void ec_scan_image_drop(struct reader *r)
{
	ec_image_put(r->kept);
	r->kept = NULL;
}

/* The device is the one that was disconnected: its image is taken, the rest is not read. */
static void take_kept(struct reader *r)
{
	const struct ec_image *kept = r->kept;
	struct ec_slave *s = r->slave;

	if (kept->bytes > s->eeprom.counted)
		ec_scan_image_enlarge(r, kept->bytes);
	if (!r->done) {
		memcpy(s->eeprom.part, kept->sii, kept->bytes);
		s->eeprom.part_bytes = kept->bytes;
		s->eeprom.flaw = kept->flaw;
		image_finish(r);
	}
	ec_scan_image_drop(r);
}

static void compare_kept(struct reader *r, const u8 *data, size_t len)
{
	len = min(len, r->kept->bytes - 2 * r->check);
	if (memcmp(r->kept->sii + 2 * r->check, data, len))
		ec_scan_image_drop(r);
	else if (r->check == SIZE_WORD)
		r->check = last_word(r->kept);
	else
		take_kept(r);
}

/**
 * ec_scan_image_reached() - more of the image is in its memory
 * @r: reader
 * @bytes: read so far
 *
 * Context: The monitor thread. May sleep.
 */
void ec_scan_image_reached(struct reader *r, size_t bytes)
{
	r->slave->eeprom.part_bytes = bytes;
	ec_scan_image_plan(r);
	look_for_kept(r);
}

/**
 * ec_scan_image_take() - take the data of an access
 * @r: reader
 * @data: data at ec_scan_image_word()
 * @len: how many bytes
 *
 * Context: The monitor thread. May sleep.
 */
void ec_scan_image_take(struct reader *r, const u8 *data, size_t len)
{
	struct ec_slave *s = r->slave;

	if (r->kept) {
		compare_kept(r, data, len);
		return;
	}
	memcpy(s->eeprom.part + s->eeprom.part_bytes, data, len);
	ec_scan_image_reached(r, s->eeprom.part_bytes + len);
}

/**
 * ec_scan_image_begin() - read an EEPROM, from where the previous scan was interrupted
 * @r: zeroed reader
 * @s: its slave
 *
 * Context: The monitor thread. May sleep.
 */
void ec_scan_image_begin(struct reader *r, struct ec_slave *s)
{
	r->slave = s;
	r->need = FIRST_BYTES;
	/* the image of an equal device says nothing of what was written */
	r->looked = s->work.renew;
	r->len = sizeof(r->reg);
	r->began = s->eeprom.part_bytes;
	if (s->eeprom.part)
		ec_scan_image_plan(r);
	else
		ec_scan_image_enlarge(r, FIRST_CAP);
}
