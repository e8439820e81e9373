/* SPDX-License-Identifier: GPL-2.0-only */
/* PDOs and their entries, of a slave or of a configuration. */
#ifndef EC_PDO_H
#define EC_PDO_H

#include <linux/types.h>

/**
 * struct ec_pdo_entry - one mapped object
 * @index: object, 0: gap
 * @sub: subindex
 * @bits: length
 * @name: string index in the slave's EEPROM
 * @registered: of a configuration: the application uses it in a domain
 */
struct ec_pdo_entry {
	u16 index;
	u8 sub;
	u8 bits;
	u8 name;
	bool registered;
};

/**
 * struct ec_pdo - one PDO
 * @index: 0x1600..., 0x1A00...
 * @name: string index in the slave's EEPROM
 * @n_entries: entries in @entries
 * @entries: mapping
 */
struct ec_pdo {
	u16 index;
	u8 name;
	unsigned int n_entries;
	struct ec_pdo_entry *entries;
};

/**
 * struct ec_pdo_list - PDOs assigned to a SyncManager
 * @n: entries in @pdos
 * @pdos: in their order
 */
struct ec_pdo_list {
	unsigned int n;
	struct ec_pdo *pdos;
};

struct ec_pdo *ec_pdo_add(struct ec_pdo_list *l, u16 index, u8 name);
int ec_pdo_add_entry(struct ec_pdo *pdo, const struct ec_pdo_entry *e);
int ec_pdo_copy_entries(struct ec_pdo *dst, const struct ec_pdo *src);
void ec_pdo_clear_entries(struct ec_pdo *pdo);
void ec_pdo_list_clear(struct ec_pdo_list *l);
struct ec_pdo *ec_pdo_find(const struct ec_pdo_list *l, u16 index);
size_t ec_pdo_list_memory(const struct ec_pdo_list *l);
u32 ec_pdo_bits(const struct ec_pdo *pdo);
u32 ec_pdo_list_bytes(const struct ec_pdo_list *l);
int ec_pdo_list_copy(struct ec_pdo_list *dst, const struct ec_pdo_list *src);
const struct ec_pdo_entry *ec_pdo_list_at(const struct ec_pdo_list *l, u32 bit);
bool ec_pdo_list_same(const struct ec_pdo_list *a, const struct ec_pdo_list *b);

#endif
