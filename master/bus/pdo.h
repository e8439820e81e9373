/* SPDX-License-Identifier: GPL-2.0-only */
/* PDOs and their entries, of a slave or of a configuration. */
#ifndef EC_PDO_H
#define EC_PDO_H

#include <linux/types.h>

/* objects (ETG.1000.6 clause 5.6.7.4): PDOs of a SyncManager; configured modules */
#define EC_PDO_ASSIGN		0x1c10
#define EC_PDO_MODULES		0xf030

static inline bool ec_pdo_is_assign(u16 index)
{
	return index >= EC_PDO_ASSIGN && index < EC_PDO_ASSIGN + 32;
}

static inline bool ec_pdo_is_output(u16 index)
{
	return index >= 0x1600 && index < 0x1800;
}

static inline bool ec_pdo_is_mapping(u16 index)
{
	return ec_pdo_is_output(index) || (index >= 0x1a00 && index < 0x1c00);
}

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

/* the value of an entry in a mapping object */
static inline u32 ec_pdo_entry_value(const struct ec_pdo_entry *e)
{
	return (u32)e->index << 16 | e->sub << 8 | e->bits;
}

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
