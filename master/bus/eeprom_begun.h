/* SPDX-License-Identifier: GPL-2.0-only */
/* Changes of an alias that were interrupted between the alias and the checksum. */
#ifndef EC_EEPROM_BEGUN_H
#define EC_EEPROM_BEGUN_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

void ec_eeprom_note_begun(struct ec_bus *bus, const u8 *image, bool begun);
bool ec_eeprom_was_begun(struct ec_slave *s, const u8 *now);

#endif
