// SPDX-License-Identifier: GPL-2.0-only
/*
 * Between the words of the alias and of the checksum, the checksum is wrong. When a change of the
 * alias is interrupted there, the words that it covers are those of before, and the next attempt
 * may write the checksum. Any other wrong checksum may be that of words that are not right.
 */
#include "eeprom_begun.h"
#include "slave.h"

#define AFTER_ALIAS	(2 * (EC_SII_W_ALIAS + 1))
#define IDENTITY	(2 * EC_SII_W_VENDOR)

/* All but the alias and the checksum; an image without identity is none. */
static bool same_but_alias(const u8 *a, const u8 *b)
{
	return !memcmp(a, b, 2 * EC_SII_W_ALIAS) &&
	       !memcmp(a + AFTER_ALIAS, b + AFTER_ALIAS, 2 * EC_SII_W_CHECKSUM - AFTER_ALIAS) &&
	       !memcmp(a + IDENTITY, b + IDENTITY, EC_BEGUN_BYTES - IDENTITY) &&
	       memchr_inv(a + IDENTITY, 0, EC_BEGUN_BYTES - IDENTITY);
}

/**
 * ec_eeprom_note_begun() - remember that a change of an alias has begun, or forget it
 * @bus: bus
 * @image: the EEPROM after it, %EC_BEGUN_BYTES
 * @begun: it has begun; else it has ended well
 *
 * Context: Process. May sleep.
 */
void ec_eeprom_note_begun(struct ec_bus *bus, const u8 *image, bool begun)
{
	unsigned int i;

	mutex_lock(&bus->begun_lock);
	for (i = 0; i < EC_MAX_BEGUN; i++)
		if (same_but_alias(bus->begun[i], image))
			memset(bus->begun[i], 0, EC_BEGUN_BYTES);
	if (begun)
		memcpy(bus->begun[bus->next_begun++ % EC_MAX_BEGUN], image, EC_BEGUN_BYTES);
	mutex_unlock(&bus->begun_lock);
}

/**
 * ec_eeprom_was_begun() - is a checksum wrong because a change of the alias was interrupted?
 * @s: slave
 * @now: what its EEPROM has, %EC_BEGUN_BYTES
 *
 * Context: Process. May sleep.
 * Return: whether it is, as far as the master knows.
 */
bool ec_eeprom_was_begun(struct ec_slave *s, const u8 *now)
{
	struct ec_bus *bus = s->bus;
	unsigned int i;
	bool found;

	found = s->eeprom.data && s->eeprom.bytes >= EC_BEGUN_BYTES && s->info.checksum_ok &&
		same_but_alias(s->eeprom.data, now);
	mutex_lock(&bus->begun_lock);
	for (i = 0; i < EC_MAX_BEGUN; i++)
		found |= same_but_alias(bus->begun[i], now);
	mutex_unlock(&bus->begun_lock);
	return found;
}
