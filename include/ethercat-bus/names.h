/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-bus: the names of slaves and of their values. */
#ifndef ETHERCAT_BUS_NAMES_H
#define ETHERCAT_BUS_NAMES_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ECB_WORD	64	/* bytes of a name without dots, with its end */
#define ECB_VALUE	(3 * ECB_WORD)	/* bytes of SLAVE.PDO.ENTRY, with its end */

/** struct ecb_slave_name - texts of a slave, of which its name is made */
struct ecb_slave_name {
	const char *order;	/* order number or type; NULL or without letters: the next one */
	const char *text;	/* name in its EEPROM */
	const char *group;	/* group in its EEPROM */
	char name[ECB_WORD];	/* result; a name that is here already is kept */
};

/** struct ecb_entry_name - texts of a PDO entry, of which the name of its value is made */
struct ecb_entry_name {
	const char *text;	/* name in the dictionary or EEPROM; NULL: none */
	const char *pdo;	/* name of its PDO; NULL: none */
	uint16_t pdo_index;
	uint16_t index;		/* 0: a gap, which has no name */
	uint8_t subindex;
	char name[2 * ECB_WORD];	/* result: ENTRY or PDO.ENTRY; kept if it is here already */
};

/**
 * ecb_name_word() - make a word of a name out of a text
 * @to: result, for %ECB_WORD bytes
 * @text: any bytes up to a 0, or NULL
 *
 * Letters become lower case, anything else than a-z and 0-9 becomes one "_" between words. A word
 * has at most 56 characters, so that a number fits behind it.
 *
 * Context: Any thread.
 * Return: length; 0: @text has neither letters nor digits, and @to is "".
 */
size_t ecb_name_word(char *to, const char *text);

/**
 * ecb_name_slaves() - give each slave of a bus its name
 * @slaves: slaves in the order of the bus
 * @count: how many
 *
 * The name is the word of the order number, otherwise of the name, otherwise of the group,
 * otherwise "slave". The second one of the same name gets "_2", and so on.
 * A name that @name has already is kept.
 *
 * Context: Any thread. The memory that it needs is freed before it returns.
 * Return: 0, -EEXIST: two of the kept names are equal, or -ENOMEM.
 */
int ecb_name_slaves(struct ecb_slave_name *slaves, size_t count);

/**
 * ecb_name_entries() - give each PDO entry of one slave the name of its value
 * @entries: entries of all PDOs of the slave in their order
 * @count: how many
 *
 * The name is the word of the text; without text it is x6000_01, index and subindex. Entries of the
 * same name are called PDO.ENTRY with the word of their PDO; a PDO without name is x1a00. If they
 * are equal even then, the second one gets "_2", and so on.
 * The name of a gap is "". A name that @name has already is kept.
 *
 * Context: Any thread. The memory that it needs is freed before it returns.
 * Return: 0, -EEXIST: two of the kept names are equal, or -ENOMEM.
 */
int ecb_name_entries(struct ecb_entry_name *entries, size_t count);

/**
 * ecb_name_value() - the whole name of a value
 * @to: result, for %ECB_VALUE bytes
 * @slave: name of the slave
 * @entry: name of the entry, as ecb_name_entries() makes it
 *
 * Context: Any thread.
 * Return: length, or 0 with "" in @to: @entry is a gap, or the names are too long.
 */
size_t ecb_name_value(char *to, const char *slave, const char *entry);

#ifdef __cplusplus
}
#endif

#endif
