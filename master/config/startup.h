/* SPDX-License-Identifier: GPL-2.0-only */
/* Startup commands: written to a slave before a state is requested, beside PDOs and FMMUs. */
#ifndef EC_STARTUP_H
#define EC_STARTUP_H

#include <linux/list.h>
#include <linux/types.h>
#include "../wire/al.h"

struct ec_config;
struct ec_result;
struct ec_slave;

/* protocols, in the order in which a transition runs their commands */
enum ec_startup_type {
	EC_STARTUP_SDO,
	EC_STARTUP_IDN,
	EC_STARTUP_COMMAND,	/* of the application, for any transition and protocol */
	EC_STARTUP_IP,
	EC_STARTUP_REG,
	EC_STARTUP_TYPES
};

/* a step between two AL states, such as PS: a command is run before @to is requested */
#define EC_TRANSITION(from, to)		((from) << 4 | (to))
#define EC_TRANSITION_FROM(t)		((t) >> 4)
#define EC_TRANSITION_TO(t)		((t) & 0xf)
#define EC_TRANSITION_IP		EC_TRANSITION(EC_AL_INIT, EC_AL_PREOP)
#define EC_TRANSITION_PS		EC_TRANSITION(EC_AL_PREOP, EC_AL_SAFEOP)
#define EC_TRANSITION_SO		EC_TRANSITION(EC_AL_SAFEOP, EC_AL_OP)

/* @how: a command writes, reads and compares, or both */
#define EC_STARTUP_WRITES		1
#define EC_STARTUP_CHECKS		2

/* @write: a write of the application, recorded to be replayed, and: */
#define EC_WRITE_RECORDED	1
#define EC_WRITE_EARLY		2	/* before the startup commands were run */
#define EC_WRITE_OWN		4	/* to the slave that is held */
#define EC_WRITE_DROPPED	8	/* its value was not kept */

/**
 * struct ec_startup - one command
 * @list: by type; of one type in the order of the calls
 * @type: enum ec_startup_type
 * @transition: EC_TRANSITION()
 * @index: object, IDN, or register
 * @sub: subindex, or drive
 * @complete: SDO with complete access
 * @write: 0, or EC_WRITE_*: it is no startup command, see replay.h
 * @kind: of a command: EC_STARTUP_SDO, EC_STARTUP_IDN or EC_STARTUP_REG
 * @how: of a command: EC_STARTUP_WRITES, EC_STARTUP_CHECKS
 * @timeout_ms: of a command: until it must be as expected
 * @size: bytes of @data
 * @device: number of the slave while that has no configuration; of a write
 * @data: value, little endian; struct ec_eoe_ip; of a command the value to write, then the value
 *	expected and its mask, as @how says
 */
struct ec_startup {
	struct list_head list;
	u8 type;
	u8 transition;
	u16 index;
	u8 sub;
	bool complete;
	u8 write;
	u8 kind;
	u8 how;
	u32 timeout_ms;
	u32 size;
	u32 device;
	u8 data[] __aligned(4);
};

/* Bytes of the value of a command. */
static inline u32 ec_startup_bytes(const struct ec_startup *u)
{
	return u->size / ((u->how & EC_STARTUP_WRITES ? 1 : 0) +
			  (u->how & EC_STARTUP_CHECKS ? 2 : 0));
}

struct ec_startup *ec_startup_add(struct ec_config *c, const struct ec_startup *what,
				  const void *data);
struct ec_startup *ec_startup_find(const struct ec_config *c, u8 type, u16 index);
void ec_startup_del(struct ec_config *c, struct ec_startup *u);
const struct ec_startup *ec_startup_changes(const struct ec_config *c, const struct ec_slave *s,
					    unsigned int sm);
struct ec_result ec_startup_write(struct ec_slave *s, const struct ec_startup *u);
bool ec_startup_has(const struct ec_slave *s, const struct ec_config *c, u8 transition);
bool ec_startup_leaves(const struct ec_slave *s, const struct ec_config *c, u8 from, u8 to);
struct ec_result ec_startup_run(struct ec_slave *s, const struct ec_config *c, u8 transition);

#endif
