/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * libethercat-bus: what a bus file says, apart from its syntax.
 *
 * The library allocates all of these structures; they grow at their end only. @line is the line of
 * the file, 0: not from a file. A text that is not given is NULL; a number that is not given has
 * the value that its comment names.
 */
#ifndef ETHERCAT_BUS_BUS_H
#define ETHERCAT_BUS_BUS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ECB_NONE8	0xffU
#define ECB_NONE32	0xffffffffU

#define ECB_INDEX(object)	((uint16_t)((object) >> 8))
#define ECB_SUBINDEX(object)	((uint8_t)(object))

/* struct ecb_slave.revision_rule */
#define ECB_REVISION_EQUAL	0
#define ECB_REVISION_AT_LEAST	1
#define ECB_REVISION_ANY	2

/* struct ecb_entry.type and struct ecb_command.type */
enum ecb_type {
	ECB_TYPE_NONE = 0,	/* unsigned, of the entry's size; for tools: as in the EEPROM */
	ECB_TYPE_BOOL,
	ECB_TYPE_INT8,
	ECB_TYPE_INT16,
	ECB_TYPE_INT32,
	ECB_TYPE_INT64,
	ECB_TYPE_UINT8,
	ECB_TYPE_UINT16,
	ECB_TYPE_UINT32,
	ECB_TYPE_UINT64,
	ECB_TYPE_REAL32,
	ECB_TYPE_REAL64,
};

/* struct ecb_unit.policy, as EC_UNIT_* of ecrt.h */
#define ECB_POLICY_CONTINUE	0
#define ECB_POLICY_ZERO		1
#define ECB_POLICY_HOLD		2
#define ECB_POLICY_SAFEOP	3
#define ECB_POLICY_STOP		4

/* struct ecb_command.at */
#define ECB_AT_PREOP	0	/* INIT to PREOP */
#define ECB_AT_SAFEOP	1	/* PREOP to SAFEOP */
#define ECB_AT_OP	2	/* SAFEOP to OP */

struct ecb_bytes {
	const uint8_t *data;
	size_t size;
};

/* an entry of a PDO, and the value in it: raw number * @scale + @offset, in @unit */
struct ecb_entry {
	uint32_t line;
	uint32_t object;	/* index << 8 | subindex; 0: a gap */
	uint8_t bits;
	uint8_t type;		/* enum ecb_type */
	const char *name;	/* of the value: ENTRY or PDO.ENTRY */
	const char *unit;
	double scale;		/* 1: not given */
	double offset;
};

struct ecb_pdo {
	uint32_t line;
	uint16_t index;
	uint8_t sm;
	const char *name;
	struct ecb_entry **entries;
	size_t entry_count;
};

/* a startup command: to a register, an SDO or an IDN */
struct ecb_command {
	uint32_t line;
	uint32_t at;		/* ECB_AT_* */
	uint32_t reg;		/* ECB_NONE32: none */
	uint32_t sdo;		/* as an object; ECB_NONE32: none */
	uint32_t idn;		/* ECB_NONE32: none */
	uint8_t complete;	/* SDO: all subindexes */
	uint8_t drive;		/* IDN: 0 to 7 */
	uint8_t type;		/* enum ecb_type: of @value */
	int64_t value;
	struct ecb_bytes data;	/* instead of @value, little endian */
};

/* ns; 0: default of the master */
struct ecb_timeouts {
	uint32_t line;
	int64_t init_preop;
	int64_t preop_safeop;
	int64_t safeop_op;
	int64_t mailbox;
};

struct ecb_clock {
	uint32_t line;
	uint16_t assign_activate;
	int64_t sync0;		/* ns */
	int64_t sync0_shift;
	int64_t sync1;
};

/* of a modular slave */
struct ecb_module {
	uint32_t line;
	uint8_t slot;		/* subindex of 0xF050 and 0xF030: 1 to 255 */
	uint32_t ident;		/* not 0 */
	const char *name;	/* for readers */
};

struct ecb_slave {
	uint32_t line;
	const char *name;
	const char *type;	/* order number */
	uint32_t vendor;
	uint32_t product;
	uint32_t revision;
	uint32_t revision_rule;	/* ECB_REVISION_* */
	uint32_t serial;	/* 0: any */
	uint16_t alias;		/* 0: any */
	uint16_t identification;	/* 0: any */
	const char *parent;	/* slave upstream; NULL: the master, or not given without @port */
	uint8_t port;		/* of @parent; ECB_NONE8: not given */
	const char *group;	/* hot connect group */
	const char *sync_unit;
	struct ecb_timeouts *timeouts;
	struct ecb_clock *clock;
	struct ecb_pdo **pdos;
	size_t pdo_count;
	struct ecb_command **startup;
	size_t startup_count;
	struct ecb_module **modules;	/* slots that are not in it are empty; none: any modules */
	size_t module_count;
	uint8_t write_modules;	/* write @modules into 0xF030, gaps as 0 */
	uint32_t known;		/* ECB_KNOWN_*; of a file 0 */
	uint8_t state;		/* AL state, of a slave of a running session; otherwise 0 */
};

/* struct ecb_slave.known: what was read of a machine, for ecb_compare() */
#define ECB_KNOWN_PDOS		0x01U
#define ECB_KNOWN_MODULES	0x02U
#define ECB_KNOWN_CLOCK		0x04U
#define ECB_KNOWN_SHIFT		0x08U	/* of SYNC0 */
#define ECB_KNOWN_STARTUP	0x10U	/* present values of objects */
#define ECB_KNOWN_UNIT		0x20U
#define ECB_KNOWN_GROUP		0x40U

struct ecb_unit {
	uint32_t line;
	const char *name;
	uint32_t policy;	/* ECB_POLICY_* */
	uint32_t limit;		/* incomplete receives in a row */
	int64_t lease;		/* ns; 0: none */
	uint8_t lease_holds;
	uint8_t repeats;
	uint8_t needs_authority;
	uint8_t offered;
};

/* its slaves name it; exactly one of @alias, @identification and @parent says what its head is */
struct ecb_group {
	uint32_t line;
	const char *name;
	uint16_t alias;
	uint16_t identification;
	const char *parent;
	uint8_t port;		/* ECB_NONE8: not given */
	uint8_t mandatory;
	uint8_t fast;
};

struct ecb_master {
	uint32_t line;
	uint32_t index;
	const char *main_device;	/* MAC address, interface or simulator */
	const char *backup_device;
	int64_t cycle;		/* ns; 0: not given */
	const char *reference_clock;	/* slave */
	struct ecb_unit **sync_units;
	size_t sync_unit_count;
	struct ecb_group **groups;
	size_t group_count;
	struct ecb_slave **slaves;
	size_t slave_count;
	uint32_t known;		/* ECB_KNOWN_UNIT and _GROUP: those of the running session */
};

struct ecb_bus {
	uint32_t line;
	uint32_t ethercat;	/* version of the format, 1 */
	struct ecb_master **masters;
	size_t master_count;
};

#define ECB_VERSION	1

struct ecb_error {
	uint32_t line;		/* 0: not at a place of the file */
	uint32_t column;
	char text[512];		/* with file, line and column, and what was expected */
};

/**
 * ecb_bus_new() - make an empty bus
 *
 * Context: Any thread; a bus belongs to one thread at a time.
 * Return: bus, to be freed with ecb_bus_free(); NULL without memory.
 */
struct ecb_bus *ecb_bus_new(void);

/**
 * ecb_bus_free() - free a bus with all that belongs to it
 * @bus: bus, or NULL
 *
 * Context: The thread of the bus.
 */
void ecb_bus_free(struct ecb_bus *bus);

/**
 * ecb_bus_text() - copy a text into the memory of a bus
 * @bus: bus
 * @text: text; what is not UTF-8 or controls a terminal becomes '?'
 *
 * Context: The thread of the bus.
 * Return: copy, freed with the bus; NULL: @text is NULL or "", or no memory (errno is ENOMEM).
 */
const char *ecb_bus_text(struct ecb_bus *bus, const char *text);

/**
 * ecb_master_add() - append a master with the values of what is not given
 * @bus: bus
 *
 * Context: The thread of the bus.
 * Return: master, or NULL without memory.
 */
struct ecb_master *ecb_master_add(struct ecb_bus *bus);

/**
 * ecb_slave_add() - append a slave to a master
 * @bus: bus
 * @master: master of this bus
 *
 * Context: The thread of the bus.
 * Return: slave, or NULL without memory.
 */
struct ecb_slave *ecb_slave_add(struct ecb_bus *bus, struct ecb_master *master);

/**
 * ecb_pdo_add() - append a PDO to a slave
 * @bus: bus
 * @slave: slave of this bus
 *
 * Context: The thread of the bus.
 * Return: PDO, or NULL without memory.
 */
struct ecb_pdo *ecb_pdo_add(struct ecb_bus *bus, struct ecb_slave *slave);

/**
 * ecb_entry_add() - append an entry to a PDO
 * @bus: bus
 * @pdo: PDO of this bus
 *
 * Context: The thread of the bus.
 * Return: entry, or NULL without memory.
 */
struct ecb_entry *ecb_entry_add(struct ecb_bus *bus, struct ecb_pdo *pdo);

/**
 * ecb_module_add() - append a module to a slave
 * @bus: bus
 * @slave: slave of this bus
 *
 * Context: The thread of the bus.
 * Return: module, or NULL without memory.
 */
struct ecb_module *ecb_module_add(struct ecb_bus *bus, struct ecb_slave *slave);

/**
 * ecb_clock_add() - give a slave a clock
 * @bus: bus
 * @slave: slave of this bus, without clock
 *
 * Context: The thread of the bus.
 * Return: clock, or NULL without memory.
 */
struct ecb_clock *ecb_clock_add(struct ecb_bus *bus, struct ecb_slave *slave);

/**
 * ecb_startup_add() - append a startup command to a slave
 * @bus: bus
 * @slave: slave of this bus
 * @data: value, or NULL: the caller sets @type and @value
 * @size: bytes at @data
 *
 * Context: The thread of the bus.
 * Return: command with a copy of @data, or NULL without memory.
 */
struct ecb_command *ecb_startup_add(struct ecb_bus *bus, struct ecb_slave *slave,
				    const void *data, size_t size);

/**
 * ecb_unit_add() - append a sync unit to a master
 * @bus: bus
 * @master: master of this bus
 *
 * Context: The thread of the bus.
 * Return: sync unit, or NULL without memory.
 */
struct ecb_unit *ecb_unit_add(struct ecb_bus *bus, struct ecb_master *master);

/**
 * ecb_group_add() - append a hot connect group to a master
 * @bus: bus
 * @master: master of this bus
 *
 * Context: The thread of the bus.
 * Return: hot connect group, or NULL without memory.
 */
struct ecb_group *ecb_group_add(struct ecb_bus *bus, struct ecb_master *master);

/**
 * ecb_command_data() - the bytes that a startup command writes
 * @command: startup command
 * @number: for its @value, which becomes little endian
 *
 * Context: Any thread, while no other one changes the bus.
 * Return: bytes, of @data or in @number.
 */
struct ecb_bytes ecb_command_data(const struct ecb_command *command, uint8_t number[8]);

/**
 * ecb_bus_finish() - check what belongs together, and name what has no name
 * @bus: bus
 * @file: name of its file for messages, or NULL
 * @error: result of a failure
 *
 * For a bus that was made by the functions above; ecb_file_read() calls it itself.
 *
 * Context: The thread of the bus.
 * Return: 0, -EINVAL with @error, or -ENOMEM.
 */
int ecb_bus_finish(struct ecb_bus *bus, const char *file, struct ecb_error *error);

#ifdef __cplusplus
}
#endif

#endif
