// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fields.h"
#include "internal.h"

#define AT(member)	.at = offsetof(struct S, member), .size = sizeof(((struct S *)0)->member)
#define COUNT(a)	(sizeof(a) / sizeof((a)[0]))
#define TYPE(id, structure, text, limit)						\
	const struct type id = {							\
		.name = text, .size = sizeof(struct structure), .fields = id##_fields,	\
		.count = COUNT(id##_fields), .most = limit,				\
	}

static const char *const revision_rules[] = { "equal", "at_least", "any", NULL };
static const char *const policies[] = { "continue", "zero", "hold", "safeop", "stop", NULL };
static const char *const lease_ends[] = { "zero", "hold", NULL };
static const char *const transitions[] = { "preop", "safeop", "op", NULL };
static const char *const types[] = {
	"none", "bool", "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64",
	"real32", "real64", NULL
};

#define S ecb_entry
static const struct field type_entry_fields[] = {
	{ "object", K_OBJECT, F_MACHINE, AT(object), .max = 0xffffff,
	  .text = "index and subindex; without it the entry is a gap" },
	{ "bits", K_NUMBER, F_REQUIRED | F_MACHINE, AT(bits), 1, 255, .text = "size" },
	{ "name", K_VALUE, 0, AT(name), .text = "name of the value behind that of the slave" },
	{ "type", K_WORD, 0, AT(type), .words = types,
	  .text = "type of the value; none: unsigned, of this size" },
	{ "unit", K_TEXT, 0, AT(unit), .text = "unit of the scaled value" },
	{ "scale", K_REAL, 0, AT(scale), .def = 1, .text = "scaled value per raw number" },
	{ "offset", K_REAL, 0, AT(offset), .text = "scaled value of the raw number 0" },
};
TYPE(type_entry, ecb_entry, "a PDO entry", 255);
#undef S

#define S ecb_pdo
static const struct field type_pdo_fields[] = {
	{ "index", K_NUMBER, F_REQUIRED | F_HEX | F_MACHINE, AT(index), 1, 0xffff,
	  .text = "index of the PDO" },
	{ "sm", K_NUMBER, F_REQUIRED | F_MACHINE, AT(sm), 0, 15, .text = "SyncManager" },
	{ "name", K_TEXT, 0, AT(name), .text = "name of the PDO" },
	{ "entries", K_LIST, F_MACHINE, AT(entries), .type = &type_entry,
	  .text = "mapping; not given: the one that the slave has" },
};
TYPE(type_pdo, ecb_pdo, "a PDO", 1024);
#undef S

#define S ecb_command
static const struct field command_fields[] = {
	{ "at", K_WORD, F_REQUIRED, AT(at), .words = transitions,
	  .text = "state to which the slave is brought" },
	{ "register", K_NUMBER, F_HEX, AT(reg), 0, 0xffff, .def = ECB_NONE32,
	  .text = "address of a register" },
	{ "sdo", K_OBJECT, 0, AT(sdo), .max = 0xffffff, .def = ECB_NONE32,
	  .text = "object of CoE" },
	{ "idn", K_IDN, 0, AT(idn), .max = 0xffff, .def = ECB_NONE32, .text = "IDN of SoE" },
	{ "complete", K_BOOL, 0, AT(complete), .text = "SDO: all subindexes at once" },
	{ "drive", K_NUMBER, 0, AT(drive), 0, 7, .text = "IDN: drive of the slave" },
	{ "type", K_WORD, 0, AT(type), .words = types, .text = "type of value" },
	{ "value", K_SIGNED, 0, AT(value), .text = "number, with type" },
	{ "data", K_BYTES, 0, AT(data), .text = "bytes, instead of type and value" },
};
const struct type type_command = {
	"a startup command", sizeof(struct ecb_command), command_fields, COUNT(command_fields),
	65535
};
#undef S

#define HOUR	3600000000000u
#define S ecb_timeouts
static const struct field timeouts_fields[] = {
	{ "init_preop", K_TIME, 0, AT(init_preop), 0, HOUR, .text = "from INIT to PREOP" },
	{ "preop_safeop", K_TIME, 0, AT(preop_safeop), 0, HOUR, .text = "from PREOP to SAFEOP" },
	{ "safeop_op", K_TIME, 0, AT(safeop_op), 0, HOUR, .text = "from SAFEOP to OP" },
	{ "mailbox", K_TIME, 0, AT(mailbox), 0, 60000000000, .text = "reply to an SDO or IDN" },
};
static const struct type type_timeouts = {
	"time limits", sizeof(struct ecb_timeouts), timeouts_fields, COUNT(timeouts_fields), 1
};
#undef S

#define S ecb_clock
static const struct field clock_fields[] = {
	{ "assign_activate", K_NUMBER, F_REQUIRED | F_HEX | F_MACHINE, AT(assign_activate),
	  0, 0xffff, .text = "register 0x0980, from the device description" },
	{ "sync0", K_TIME, F_MACHINE, AT(sync0), 0, UINT32_MAX, .text = "period of SYNC0" },
	{ "sync0_shift", K_TIME, F_SIGN | F_MACHINE, AT(sync0_shift), 0, INT32_MAX,
	  .known = ECB_KNOWN_SHIFT, .text = "shift of SYNC0" },
	{ "sync1", K_TIME, F_MACHINE, AT(sync1), 0, UINT32_MAX, .text = "register 0x09A4" },
};
static const struct type type_clock = {
	"a clock", sizeof(struct ecb_clock), clock_fields, COUNT(clock_fields), 1
};
#undef S

#define S ecb_module
static const struct field type_module_fields[] = {
	{ "slot", K_NUMBER, F_REQUIRED | F_MACHINE, AT(slot), 1, 255,
	  .text = "subindex of 0xF050 and 0xF030" },
	{ "ident", K_NUMBER, F_REQUIRED | F_HEX | F_MACHINE, AT(ident), 1, UINT32_MAX,
	  .text = "module ident; an empty slot is not in the list" },
	{ "name", K_TEXT, 0, AT(name), .text = "name of the module, for readers" },
};
TYPE(type_module, ecb_module, "a module", 255);
#undef S

#define S ecb_slave
static const struct field type_slave_fields[] = {
	{ "name", K_NAME, 0, AT(name), .text = "unique in the master; not given: made of type" },
	{ "type", K_TEXT, 0, AT(type), .text = "order number, for readers" },
	{ "vendor", K_NUMBER, F_REQUIRED | F_HEX | F_MACHINE, AT(vendor), 0, UINT32_MAX,
	  .text = "vendor ID" },
	{ "product", K_NUMBER, F_REQUIRED | F_HEX | F_MACHINE, AT(product), 0, UINT32_MAX,
	  .text = "product code" },
	{ "revision", K_NUMBER, F_HEX | F_MACHINE, AT(revision), 0, UINT32_MAX,
	  .text = "revision number; 0 or not given: any" },
	{ "revision_rule", K_WORD, 0, AT(revision_rule), .words = revision_rules,
	  .text = "which revisions are right" },
	{ "serial", K_NUMBER, F_MACHINE, AT(serial), 0, UINT32_MAX,
	  .text = "serial number; 0 or not given: any" },
	{ "alias", K_NUMBER, F_MACHINE, AT(alias), 0, 0xffff,
	  .text = "station alias; 0 or not given: any" },
	{ "identification", K_NUMBER, F_MACHINE, AT(identification), 0, 0xffff,
	  .text = "explicit device identification; 0 or not given: any" },
	{ "parent", K_NAME, F_MACHINE, AT(parent), .text = "slave upstream" },
	{ "port", K_NUMBER, F_MACHINE, AT(port), 0, 3, .def = ECB_NONE8, .text = "port of parent" },
	{ "group", K_NAME, F_MACHINE, AT(group), .known = ECB_KNOWN_GROUP,
	  .text = "hot connect group" },
	{ "sync_unit", K_NAME, F_MACHINE, AT(sync_unit), .known = ECB_KNOWN_UNIT,
	  .text = "sync unit" },
	{ "timeouts", K_ITEM, 0, AT(timeouts), .type = &type_timeouts,
	  .text = "time limits; not given: those of the master" },
	{ "clock", K_ITEM, F_MACHINE, AT(clock), .type = &type_clock,
	  .known = ECB_KNOWN_CLOCK, .text = "SYNC signals" },
	{ "modules", K_LIST, F_MACHINE, AT(modules), .type = &type_module,
	  .known = ECB_KNOWN_MODULES,
	  .text = "modules by slot, object 0xF050; not given: any" },
	{ "write_modules", K_BOOL, 0, AT(write_modules),
	  .text = "the master writes the modules into 0xF030 in PREOP, at each connect" },
	{ "pdos", K_LIST, F_MACHINE, AT(pdos), .type = &type_pdo, .known = ECB_KNOWN_PDOS,
	  .text = "assigned PDOs; not given: those that the slave has" },
	{ "startup", K_LIST, F_MACHINE, AT(startup), .type = &type_command,
	  .known = ECB_KNOWN_STARTUP, .text = "startup commands" },
	{ "aoe", K_LATER, .text = "AoE" },
};
TYPE(type_slave, ecb_slave, "a slave", 65535);
#undef S

#define S ecb_unit
static const struct field unit_fields[] = {
	{ "name", K_NAME, F_REQUIRED | F_MACHINE, AT(name), .text = "unique in the master" },
	{ "policy", K_WORD, F_MACHINE, AT(policy), .words = policies,
	  .text = "what is done when its working counters are incomplete" },
	{ "limit", K_NUMBER, F_MACHINE, AT(limit), 1, 65535, .def = 3,
	  .text = "incomplete receives in a row" },
	{ "lease", K_TIME, F_MACHINE, AT(lease), 0, HOUR,
	  .text = "time without new outputs; 0 or not given: no lease" },
	{ "lease_end", K_WORD, F_MACHINE, AT(lease_holds), .words = lease_ends,
	  .text = "outputs after the lease" },
	{ "repeats", K_NUMBER, F_MACHINE, AT(repeats), 1, 3, .def = 1, .text = "frames in a cycle" },
	{ "needs_authority", K_BOOL, F_MACHINE, AT(needs_authority),
	  .text = "it begins without authority, and a failure takes it" },
	{ "offered", K_BOOL, F_MACHINE, AT(offered), .text = "another application may hold it" },
};
const struct type type_unit = {
	"a sync unit", sizeof(struct ecb_unit), unit_fields, COUNT(unit_fields), 64
};
#undef S

#define S ecb_group
static const struct field group_fields[] = {
	{ "name", K_NAME, F_REQUIRED | F_MACHINE, AT(name), .text = "unique in the master" },
	{ "alias", K_NUMBER, F_MACHINE, AT(alias), 0, 0xffff, .text = "station alias of its first slave" },
	{ "identification", K_NUMBER, F_MACHINE, AT(identification), 0, 0xffff,
	  .text = "explicit device identification of its first slave" },
	{ "parent", K_NAME, 0, AT(parent), .text = "slave at which it has to be connected" },
	{ "port", K_NUMBER, F_MACHINE, AT(port), 1, 3, .def = ECB_NONE8, .text = "port of parent" },
	{ "mandatory", K_BOOL, F_MACHINE, AT(mandatory), .text = "without it the bus is not complete" },
	{ "fast", K_BOOL, 0, AT(fast), .text = "its port is opened as soon as it has a link" },
};
const struct type type_group = {
	"a hot connect group", sizeof(struct ecb_group), group_fields, COUNT(group_fields), 128
};
#undef S

#define S ecb_master
static const struct field type_master_fields[] = {
	{ "index", K_NUMBER, 0, AT(index), 0, 31, .text = "of the master" },
	{ "main_device", K_TEXT, 0, AT(main_device),
	  .text = "MAC address, interface or simulator; not given: any" },
	{ "backup_device", K_TEXT, 0, AT(backup_device), .text = "likewise" },
	{ "cycle", K_TIME, 0, AT(cycle), 10000, 1000000000, .text = "cycle time" },
	{ "reference_clock", K_NAME, 0, AT(reference_clock),
	  .text = "slave; not given: the first one with a clock" },
	{ "sync_units", K_LIST, F_MACHINE, AT(sync_units), .type = &type_unit,
	  .known = ECB_KNOWN_UNIT,
	  .text = "slaves that are judged together" },
	{ "groups", K_LIST, F_MACHINE, AT(groups), .type = &type_group,
	  .known = ECB_KNOWN_GROUP, .text = "hot connect groups" },
	{ "slaves", K_LIST, F_MACHINE, AT(slaves), .type = &type_slave,
	  .text = "slaves in the order of the bus" },
	{ "ring", K_LATER, .text = "cable redundancy" },
};
TYPE(type_master, ecb_master, "a master", 32);
#undef S

#define S ecb_bus
static const struct field type_bus_fields[] = {
	{ "ethercat", K_NUMBER, F_REQUIRED, AT(ethercat), 1, ECB_VERSION,
	  .text = "version of this format" },
	{ "masters", K_LIST, F_REQUIRED | F_MACHINE, AT(masters), .type = &type_master,
	  .text = "masters of the computer" },
};
TYPE(type_bus, ecb_bus, "a bus file", 1);
#undef S
