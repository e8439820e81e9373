/* SPDX-License-Identifier: GPL-2.0-only */
/* The EEPROM of one slave, word by word through registers 0x0500 to 0x050F. */
#ifndef EC_EEPROM_ACCESS_H
#define EC_EEPROM_ACCESS_H

#include <linux/types.h>

struct ec_slave;

/**
 * struct ec_eeprom_access - access to the EEPROM of a slave
 * @slave: slave, its @lock held
 * @control: register 0x0502 as read last
 * @owner: register 0x0500 before, which is restored at the end
 * @taken: ec_eeprom_take() has succeeded
 */
struct ec_eeprom_access {
	struct ec_slave *slave;
	u16 control;
	u8 owner;
	bool taken;
};

int ec_eeprom_take(struct ec_eeprom_access *a, bool force);
int ec_eeprom_give_back(struct ec_eeprom_access *a);
size_t ec_eeprom_capacity(const struct ec_eeprom_access *a);
int ec_eeprom_read(struct ec_eeprom_access *a, u32 word, u8 *data, size_t size);
int ec_eeprom_write_word(struct ec_eeprom_access *a, u32 word, const u8 *value);
int ec_eeprom_reload(struct ec_eeprom_access *a, u16 *alias);

#endif
