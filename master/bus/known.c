// SPDX-License-Identifier: GPL-2.0-only
#include <linux/hash.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "known.h"
#include "slave.h"

#define IMAGES		256
#define IMAGE_BYTES	65536
#define MORE_LOST	256	/* disconnected devices beside as many as the longest list had */

static struct hlist_head *head_of(struct hlist_head *heads, u64 key)
{
	return &heads[hash_64(key, EC_KNOWN_BITS)];
}

static bool is_image_of(const struct ec_image *image, const struct ec_slave *s)
{
	return image->bytes == s->eeprom.bytes &&
	       !memcmp(&image->flaw, &s->eeprom.flaw, sizeof(image->flaw)) &&
	       !memcmp(image->sii, s->eeprom.data, s->eeprom.bytes);
}

/* Identical devices, and one that was disconnected often, share an image. */
static struct ec_image *share_image(const struct ec_known *k, const struct ec_slave *s)
{
	unsigned int n = IMAGES;
	struct ec_lost *l;

	list_for_each_entry_reverse(l, &k->oldest, age) {
		if (l->image && is_image_of(l->image, s)) {
			kref_get(&l->image->kref);
			return l->image;
		}
		if (!--n)
			break;
	}
	return NULL;
}

/* Images only save time: without memory there is none. */
static struct ec_image *keep_image(const struct ec_known *k, const struct ec_slave *s)
{
	struct ec_image *image;

	if (!s->eeprom.data || s->eeprom.bytes < EC_SII_FIXED_SIZE || s->eeprom.bytes > IMAGE_BYTES)
		return NULL;
	image = share_image(k, s);
	if (image)
		return image;
	image = kvmalloc(sizeof(*image) + s->eeprom.bytes, GFP_KERNEL | __GFP_NOWARN);
	if (!image)
		return NULL;
	kref_init(&image->kref);
	image->bytes = s->eeprom.bytes;
	image->flaw = s->eeprom.flaw;
	memcpy(image->sii, s->eeprom.data, s->eeprom.bytes);
	return image;
}

static void forget_image(struct ec_lost *l)
{
	ec_image_put(l->image);
	l->image = NULL;
}

/* So many disconnected devices have an image at most. */
static void limit_images(struct ec_known *k)
{
	struct ec_lost *l;
	unsigned int n = 0;

	list_for_each_entry_reverse(l, &k->oldest, age)
		if (l->image && ++n > IMAGES)
			forget_image(l);
}

/* Without memory the number is forgotten: the device gets another one when it reconnects. */
static void known_note_lost(struct ec_known *k, struct ec_slave *s, unsigned int limit)
{
	struct ec_lost *l = kzalloc(sizeof(*l), GFP_KERNEL | __GFP_NOWARN);

	hlist_del_init(&s->by_device);
	if (!l)
		return;
	l->number = s->device;
	l->since_ns = ktime_get_ns();
	l->vendor = s->info.vendor;
	l->product = s->info.product;
	l->serial = s->info.serial;
	l->station = s->station;
	l->position = s->position;
	l->up = s->lost.at.up < s->bus->n_slaves ? s->bus->slaves[s->lost.at.up]->device : 0;
	l->up_port = s->lost.at.up_port;
	l->seen_ns = s->lost.seen_ns;
	strscpy(l->label, ec_slave_label(s), sizeof(l->label));
	l->image = keep_image(k, s);
	hlist_add_head(&l->by_number, head_of(k->lost, l->number));
	hlist_add_head(&l->by_station, head_of(k->by_station, l->station));
	if (l->serial)
		hlist_add_head(&l->by_serial, head_of(k->by_serial, l->serial));
	list_add_tail(&l->age, &k->oldest);
	if (++k->n_lost > limit)
		ec_known_drop(k, list_first_entry(&k->oldest, struct ec_lost, age));
}

static bool was_read(u32 vendor, u32 product)
{
	return vendor || product;
}

static bool same_device(const struct ec_lost *l, const struct ec_slave *s)
{
	return was_read(l->vendor, l->product) && l->vendor == s->info.vendor &&
	       l->product == s->info.product && l->serial == s->info.serial;
}

/* It has kept the station address: it had power all the time. */
static struct ec_lost *by_station(struct ec_known *k, const struct ec_slave *s, bool unread)
{
	struct ec_lost *l;

	if (!s->kept_station)
		return NULL;
	hlist_for_each_entry(l, head_of(k->by_station, s->kept_station), by_station)
		if (l->station == s->kept_station &&
		    (same_device(l, s) ||
		     (unread && (!was_read(l->vendor, l->product) ||
				 !was_read(s->info.vendor, s->info.product)))))
			return l;
	return NULL;
}

/* A serial number that two devices have says nothing. */
static struct ec_lost *by_serial(struct ec_known *k, const struct ec_slave *s,
			      struct ec_slave **slaves, unsigned int n)
{
	struct ec_lost *l, *found = NULL;
	unsigned int i;

	if (!s->info.serial)
		return NULL;
	hlist_for_each_entry(l, head_of(k->by_serial, s->info.serial), by_serial) {
		if (!same_device(l, s))
			continue;
		if (found)
			return NULL;
		found = l;
	}
	for (i = 0; found && i < n; i++)
		if (slaves[i] != s && same_device(found, slaves[i]))
			return NULL;
	return found;
}

/**
 * ec_known_lost() - the disconnected device with a device number
 * @bus: bus
 * @number: device number
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: the device, or NULL.
 */
struct ec_lost *ec_known_lost(const struct ec_bus *bus, u64 number)
{
	struct ec_lost *l;

	ec_bus_assert_stays(bus);
	hlist_for_each_entry(l, head_of((struct hlist_head *)bus->known.lost, number), by_number)
		if (l->number == number)
			return l;
	return NULL;
}

/**
 * ec_known_is_present() - has a slave of the list a station address?
 * @bus: bus
 * @station: station address
 *
 * Context: The monitor thread.
 * Return: whether one has it.
 */
bool ec_known_is_present(const struct ec_bus *bus, u16 station)
{
	ec_for_each_slave(s, bus)
		if (s->station == station)
			return true;
	return false;
}

static bool was_present(const struct ec_known *k, u16 station)
{
	struct ec_lost *l;

	hlist_for_each_entry(l, head_of((struct hlist_head *)k->by_station, station), by_station)
		if (l->station == station)
			return true;
	return false;
}

/**
 * ec_known_was_there() - has a disconnected device a station address, and no other one has it?
 * @bus: bus
 * @station: station address
 *
 * Context: The monitor thread.
 * Return: whether it is so.
 */
bool ec_known_was_there(const struct ec_bus *bus, u16 station)
{
	return was_present(&bus->known, station) && !ec_known_is_present(bus, station);
}

/**
 * ec_known_by_station() - the disconnected device that had a station address
 * @bus: bus
 * @station: station address
 *
 * Context: The monitor thread.
 * Return: its number, or 0.
 */
u64 ec_known_by_station(const struct ec_bus *bus, u16 station)
{
	const struct ec_lost *l;

	list_for_each_entry(l, &bus->known.oldest, age)
		if (l->station == station)
			return l->number;
	return 0;
}

/**
 * ec_known_is() - was a device connected before?
 * @bus: bus
 * @station: station address that it has kept, 0: none
 * @vendor: vendor id
 * @product: product code
 * @serial: serial number, 0: none
 *
 * Context: The monitor thread.
 * Return: whether a disconnected device is equal, and has the station address or serial number.
 */
bool ec_known_is(const struct ec_bus *bus, u16 station, u32 vendor, u32 product, u32 serial)
{
	const struct ec_lost *l;

	list_for_each_entry(l, &bus->known.oldest, age)
		if (l->vendor == vendor && l->product == product && l->serial == serial &&
		    (serial || (station && l->station == station)))
			return true;
	return false;
}

static bool is_claimed(const struct ec_bus *bus, struct ec_slave *const *known, const u8 *claims,
		     u16 station)
{
	return !station || station == U16_MAX ||
	       (known ? known[station] != NULL : ec_known_is_present(bus, station)) ||
	       (claims && claims[station]);
}

/**
 * ec_known_fresh_station() - find a station address that no device has
 * @bus: bus
 * @known: slaves of the list by address; NULL: the list is searched
 * @claims: for each address, how many slaves of the ring have it; NULL: those of the list do
 *
 * One that no disconnected device had either, as long as there are such: it may return with it.
 * U16_MAX is not given, the clocks use it for "no slave".
 *
 * Context: The monitor thread.
 * Return: the address, or 0 when all are in use.
 */
u16 ec_known_fresh_station(struct ec_bus *bus, struct ec_slave *const *known, const u8 *claims)
{
	u16 last = bus->next_station, second = 0;
	u32 i;

	for (i = 0; i <= EC_MAX_SLAVES; i++) {
		if (is_claimed(bus, known, claims, ++last))
			continue;
		if (!was_present(&bus->known, last)) {
			bus->next_station = last;
			return last;
		}
		second = second ?: last;
	}
	if (second)
		bus->next_station = second;
	return second;
}

/**
 * ec_known_image() - look for a disconnected device with the same head of its EEPROM
 * @bus: bus
 * @station: station address that the slave has kept, 0: none
 * @head: %EC_SII_HEAD bytes: checksum, identity, serial number
 *
 * Context: The monitor thread, which alone changes the numbers.
 * Return: its image, which is as long as the fixed area at least, with a reference for the caller;
 * the one with the station address before others; NULL: there is none.
 */
struct ec_image *ec_known_image(const struct ec_bus *bus, u16 station, const u8 *head)
{
	struct ec_image *found = NULL;
	const struct ec_lost *l;
	bool kept = false;

	list_for_each_entry(l, &bus->known.oldest, age) {
		if (!l->image || memcmp(l->image->sii, head, EC_SII_HEAD))
			continue;
		/* the one that was disconnected last, as its EEPROM may have been written */
		if (!kept || l->station == station)
			found = l->image;
		kept |= l->station == station;
	}
	if (found)
		kref_get(&found->kref);
	return found;
}

/**
 * ec_known_forget_images() - forget the EEPROM images of disconnected devices
 * @bus: bus
 *
 * All are to be read again, or their memory is needed.
 *
 * Context: The monitor thread. May sleep.
 */
void ec_known_forget_images(struct ec_bus *bus)
{
	struct ec_lost *l;

	list_for_each_entry(l, &bus->known.oldest, age)
		forget_image(l);
}

/**
 * ec_known_update() - give the slaves of a new list their device numbers
 * @bus: bus, still with the list before
 * @slaves: new list; @position of each slave is that in it
 * @n: entries in @slaves
 * @limit: of the disconnected devices whose numbers are kept
 *
 * Context: The monitor thread, topo held for writing, after ec_show_change_begin(). May sleep.
 */
void ec_known_update(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n,
		     unsigned int limit)
{
	struct ec_known *k = &bus->known;
	unsigned int i;

	lockdep_assert_held_write(&bus->topo);
	k->most = max3(k->most, n, bus->n_slaves);
	limit = min(limit, k->most + MORE_LOST);
	ec_for_each_slave(s, bus)
		if (s->position >= n || slaves[s->position] != s)
			known_note_lost(k, s, limit);
	limit_images(k);
	for (i = 0; i < n; i++) {
		struct ec_slave *s = slaves[i];
		struct ec_lost *l;

		if (!hlist_unhashed(&s->by_device))
			continue;
		l = by_station(k, s, false) ?: by_serial(k, s, slaves, n) ?:
		    by_station(k, s, true) ?: ec_known_lost(bus, s->device);
		if (l) {
			s->device = l->number;
			ec_known_drop(k, l);
		} else {
			s->device = ++k->last;
		}
		hlist_add_head(&s->by_device, head_of(k->present, s->device));
	}
}

static struct ec_slave *known_find(const struct ec_bus *bus, u64 number)
{
	struct ec_slave *s;

	hlist_for_each_entry(s, head_of((struct hlist_head *)bus->known.present, number), by_device)
		if (s->device == number)
			return s;
	return NULL;
}

/**
 * ec_known_connected() - the slave of the list with a device number
 * @bus: bus
 * @number: device number
 *
 * Context: The monitor thread, which alone changes the numbers.
 * Return: the slave, or NULL.
 */
struct ec_slave *ec_known_connected(const struct ec_bus *bus, u64 number)
{
	return known_find(bus, number);
}

/**
 * ec_known_slave() - the slave with a device number
 * @bus: bus
 * @number: device number
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: the slave, or NULL.
 */
struct ec_slave *ec_known_slave(const struct ec_bus *bus, u64 number)
{
	ec_bus_assert_stays(bus);
	return known_find(bus, number);
}

/**
 * ec_known_text() - why no slave has a device number
 * @bus: bus
 * @number: device number that ec_known_slave() has not found
 * @buf: result
 * @size: of @buf
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: length of the text.
 */
size_t ec_known_text(const struct ec_bus *bus, u64 number, char *buf, size_t size)
{
	const struct ec_lost *l = ec_known_lost(bus, number);

	ec_bus_assert_stays(bus);
	if (!number || number > bus->known.last)
		return scnprintf(buf, size,
				 "no device has had number %llu; 'ethercat slaves --json' lists the numbers",
				 number);
	if (!l)
		return scnprintf(buf, size,
				 "device %llu disconnected long ago; 'ethercat slaves' lists the connected slaves",
				 number);
	return scnprintf(buf, size,
			 "device %llu, which was slave %u (%s), disconnected %llu s ago; 'ethercat slaves' lists the connected slaves",
			 number, l->position, l->label,
			 div_u64(ktime_get_ns() - l->since_ns, NSEC_PER_SEC));
}
