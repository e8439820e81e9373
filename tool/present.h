/* SPDX-License-Identifier: GPL-2.0-only */
/* Values that slaves have at present, by mailbox and registers. Nothing is written. */
#ifndef EC_TOOL_PRESENT_H
#define EC_TOOL_PRESENT_H

#include "../include/ethercat-tools.h"
#include "tool.h"

#define PRESENT_SM_ASSIGN	0x1c10	/* PDO assignment of SyncManager 0 */
#define PRESENT_FIRST_SM	2	/* those below are of the mailbox */

/* struct present.wish */
#define PRESENT_PDOS	1u	/* assignment and mapping */
#define PRESENT_NAMES	2u	/* names and types in the object dictionary */
#define PRESENT_MODULES	4u	/* 0xF050 */
#define PRESENT_CLOCK	8u	/* registers of SYNC signals */
#define PRESENT_VALUES	16u	/* @values */

struct present_entry {
	u32 map;		/* object 31-16, subindex 15-8, bits 7-0 */
	u16 type;		/* data type, 0: not known */
	char name[ECT_TEXT];
};

struct present_pdo {
	u16 index;
	u8 sm;
	u8 n;
	char name[ECT_TEXT];
	struct present_entry *entries;
};

struct present_value {
	u32 object;		/* index << 8 | subindex */
	bool complete;
	u8 *data;		/* NULL: not read */
	size_t size;
};

/**
 * struct present - a slave
 * @s: slave
 * @wish: PRESENT_* to read
 * @known: of them, those that were read
 * @sms: bit for each SyncManager whose assignment the slave has
 * @pdos: of them
 * @n: how many
 * @idents: modules by slot, from 1
 * @slots: how many slots the slave has; 0: it is not modular
 * @assign_activate: register 0x0980, 0: no SYNC signals now
 * @sync: periods of SYNC0 and SYNC1 in ns
 * @values: present values of objects; the caller sets their object
 * @value_count: how many
 * @why: what could not be read, or ""
 */
struct present {
	const struct ect_slave *s;
	unsigned int wish;
	unsigned int known;
	u32 sms;
	struct present_pdo *pdos;
	size_t n;
	u32 idents[256];
	unsigned int slots;
	u16 assign_activate;
	u32 sync[2];
	struct present_value *values;
	size_t value_count;
	char why[ECT_TEXT + 64];
};

bool present_has_coe(const struct ect_slave *s);
/* a number of up to 4 bytes, or the entries of a list: 0 or negative; ect_reason() says why */
int present_number(struct ect_handle *h, const struct ect_slave *s, u16 index, u8 sub, u32 *v);
int present_count(struct ect_handle *h, const struct ect_slave *s, u16 index, unsigned int *n);

void present_read(struct ect_handle *h, struct present *l);
void present_free(struct present *l);

#endif
