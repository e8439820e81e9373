/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: what an application has configured, and its process data. */
#ifndef ETHERCAT_TOOLS_APP_H
#define ETHERCAT_TOOLS_APP_H

#include "mailbox.h"
#include "slave.h"

#ifdef __cplusplus
extern "C" {
#endif

/* a slave configuration */
struct ect_config {
	uint32_t struct_size;
	uint32_t index;
	uint16_t alias;
	uint16_t position;	/* behind the slave with @alias; 0 as alias: in the ring */
	uint32_t vendor_id;
	uint32_t product_code;
	int32_t slave_position;	/* ring position of its slave, -1: none */
	uint16_t al_status;	/* of its slave */
	uint16_t in_op;		/* configured and in OP */
	uint16_t watchdog_divider;
	uint16_t watchdog_intervals;
	uint16_t dc_assign_activate;
	uint16_t reserved;
	uint32_t dc_cycle[2];	/* SYNC0, SYNC1, ns */
	int32_t dc_shift[2];
	uint32_t sdo_count;
	uint32_t flag_count;
	uint64_t device;	/* number of its slave, 0: none */
	uint32_t group;		/* hot connect group, its member @position: number + 1; 0: none */
	uint32_t group_at;	/* configuration at whose slave it is, ECT_NONE32: anywhere */
	uint16_t group_value;	/* alias or identification */
	uint8_t group_by;	/* ECT_GROUP_* */
	uint8_t group_port;	/* with @group_at */
	uint8_t group_mandatory;
	uint8_t reserved2[3];
	char group_name[ECT_STRING];
};

/* struct ect_config.group_by */
#define ECT_GROUP_ALIAS	1
#define ECT_GROUP_ID	2
#define ECT_GROUP_PORT	3

/**
 * ect_config_read() - a slave configuration
 * @h: master
 * @index: below @config_count of struct ect_master
 * @c: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0, -ENOENT if the application has exited, or another negative errno.
 */
int ect_config_read(struct ect_handle *h, unsigned int index, struct ect_config *c);

/* why the slave of a configuration is not in OP */
struct ect_config_why {
	uint32_t struct_size;
	uint32_t reserved;
	struct ect_cause cause;
	char text[ECT_TEXT];	/* the same in words; "": it is in OP */
};

/**
 * ect_config_why() - why the slave of a configuration is not in OP, in the words of the master
 * @h: master
 * @index: of the configuration
 * @w: result, with its @struct_size
 *
 * ect_why() finds the causes behind it.
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_config_why(struct ect_handle *h, unsigned int index, struct ect_config_why *w);

/* struct ect_config_sm.dir */
#define ECT_DIR_OUTPUT	1
#define ECT_DIR_INPUT	2

/* a SyncManager of a configuration */
struct ect_config_sm {
	uint32_t struct_size;
	uint8_t sm;
	uint8_t dir;		/* 0 not configured, ECT_DIR_* */
	uint8_t watchdog;	/* 0 default, 1 enabled, 2 disabled */
	uint8_t reserved;
	uint32_t pdo_count;
};

/**
 * ect_config_sm() - a SyncManager of a configuration
 * @h: master
 * @index: of the configuration
 * @sm: 0 to 15
 * @to: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_config_sm(struct ect_handle *h, unsigned int index, unsigned int sm,
		  struct ect_config_sm *to);

/**
 * ect_config_pdo() - a PDO of a configuration
 * @h: master
 * @index: of the configuration
 * @sm: 0 to 15
 * @pdo: below @pdo_count of struct ect_config_sm
 * @to: result, with its @struct_size; without name
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_config_pdo(struct ect_handle *h, unsigned int index, unsigned int sm, unsigned int pdo,
		   struct ect_pdo *to);

/**
 * ect_config_entry() - an entry of a PDO of a configuration
 * @h: master
 * @index: of the configuration
 * @sm: 0 to 15
 * @pdo: below @pdo_count of struct ect_config_sm
 * @entry: below @entry_count of struct ect_pdo
 * @to: result, with its @struct_size; without name
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_config_entry(struct ect_handle *h, unsigned int index, unsigned int sm, unsigned int pdo,
		     unsigned int entry, struct ect_pdo_entry *to);

/* a startup SDO or IDN of a configuration */
struct ect_startup {
	uint32_t struct_size;
	uint16_t index;		/* of the object, or IDN */
	uint8_t subindex;	/* or drive */
	uint8_t complete;	/* of an SDO: complete access */
	uint8_t state;		/* of an IDN, in which it is written: 2 PREOP, 4 SAFEOP */
	uint8_t reserved[3];
	uint32_t bytes;		/* of the value; may be more than the buffer of the caller has */
};

/**
 * ect_config_sdo() - a startup SDO of a configuration
 * @h: master
 * @index: of the configuration
 * @sdo: below @sdo_count of struct ect_config
 * @to: result, with its @struct_size
 * @data: for the value, @size bytes
 * @size: bytes at @data
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_config_sdo(struct ect_handle *h, unsigned int index, unsigned int sdo,
		   struct ect_startup *to, void *data, size_t size);

/**
 * ect_config_idn() - a startup IDN of a configuration
 * @h: master
 * @index: of the configuration
 * @idn: which, from 0
 * @to: result, with its @struct_size
 * @data: for the value, @size bytes
 * @size: bytes at @data
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0, -ENOENT behind the last one, -ENOTTY if the module does not know it, or another
 * negative errno.
 */
int ect_config_idn(struct ect_handle *h, unsigned int index, unsigned int idn,
		   struct ect_startup *to, void *data, size_t size);

/* kinds of a write, see struct ect_write */
#define ECT_WRITE_SDO	0
#define ECT_WRITE_IDN	1
#define ECT_WRITE_REG	2

/* what the application has written itself before the slave was in OP */
struct ect_write {
	uint32_t struct_size;
	uint16_t index;		/* of the object, IDN, or address of a register */
	uint8_t subindex;	/* or drive */
	uint8_t kind;		/* ECT_WRITE_* */
	uint8_t complete;	/* of an SDO: complete access */
	uint8_t reserved[3];
	uint32_t bytes;		/* of the value, 0: it was not kept; the buffer may be shorter */
	uint32_t forgotten;	/* older writes that are not listed */
	char why[ECT_STRING];	/* it is not written to a slave that returns; empty: it is */
};

/**
 * ect_config_write() - what the application has written, from the oldest write on
 * @h: master
 * @index: of the configuration
 * @pos: which, from 0
 * @to: result, with its @struct_size
 * @data: for the value, @size bytes
 * @size: bytes at @data
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_idn().
 */
int ect_config_write(struct ect_handle *h, unsigned int index, unsigned int pos,
		     struct ect_write *to, void *data, size_t size);

/* a command of the application before a slave makes a step to another AL state */
struct ect_step_command {
	uint32_t struct_size;
	uint16_t index;		/* of the object, IDN, or address of a register */
	uint8_t subindex;	/* or drive */
	uint8_t kind;		/* ECT_WRITE_* */
	uint8_t complete;	/* of an SDO: complete access */
	uint8_t from;		/* AL state */
	uint8_t to;		/* AL state */
	uint8_t writes;		/* a value is written */
	uint8_t checks;		/* a value is read and compared */
	uint8_t reserved[3];
	uint32_t timeout_ms;	/* until it must be as expected */
	uint32_t bytes;		/* of each value; the buffer may be shorter */
};

/**
 * ect_config_command() - a command for a step, in the order in which they are executed
 * @h: master
 * @index: of the configuration
 * @pos: which, from 0
 * @to: result, with its @struct_size
 * @data: for the value to write, then the value expected and its mask, @bytes of struct
 *	ect_step_command each, as far as the command has them
 * @size: bytes at @data
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_idn().
 */
int ect_config_command(struct ect_handle *h, unsigned int index, unsigned int pos,
		       struct ect_step_command *to, void *data, size_t size);

/* a feature flag of a configuration */
struct ect_flag {
	uint32_t struct_size;
	int32_t value;
	char key[ECT_STRING];
};

/**
 * ect_config_flag() - a feature flag of a configuration
 * @h: master
 * @index: of the configuration
 * @flag: below @flag_count of struct ect_config
 * @to: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_config_flag(struct ect_handle *h, unsigned int index, unsigned int flag,
		    struct ect_flag *to);

/**
 * ect_config_ip() - the IP parameters of a configuration
 * @h: master
 * @index: of the configuration
 * @ip: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0, -ENOTTY if the module does not know it, or another negative errno.
 */
int ect_config_ip(struct ect_handle *h, unsigned int index, struct ect_ip *ip);

/* bits of struct ect_domain.options */
#define ECT_DOMAIN_OVERLAP	1U	/* inputs at logical addresses of outputs */
#define ECT_DOMAIN_SEPARATE	2U	/* LRD and LWR instead of LRW */
#define ECT_DOMAIN_OWN_FRAME	4U	/* shares no frame with another domain */

/* struct ect_domain.wc_state */
#define ECT_WC_ZERO		0	/* no slave has exchanged data */
#define ECT_WC_INCOMPLETE	1
#define ECT_WC_COMPLETE		2	/* of each datagram */

/* process data that are exchanged together */
struct ect_domain {
	uint32_t struct_size;
	uint32_t index;
	uint32_t size;		/* bytes */
	uint32_t logical;	/* address */
	uint32_t working_counter;
	uint32_t expected;	/* working counter when all slaves exchange their data */
	uint32_t fmmu_count;
	uint32_t max_age;	/* sends after which the data are stale, 0: none */
	uint32_t options;	/* ECT_DOMAIN_* */
	uint32_t datagram_count;
	uint32_t datagram_bytes;	/* headers and working counters included */
	uint32_t age;		/* sends since the one that brought the data */
	uint32_t wc_state;	/* ECT_WC_* */
	uint32_t unsent;	/* sends since activation if none of them had the domain, else 0 */
};

/* the share of a slave configuration in a domain */
struct ect_fmmu {
	uint32_t struct_size;
	uint16_t alias;		/* of the configuration */
	uint16_t position;
	uint8_t sm;
	uint8_t dir;		/* ECT_DIR_* */
	uint16_t reserved;
	uint32_t logical;	/* address */
	uint32_t size;		/* bytes */
	uint32_t offset;	/* in the domain */
	uint32_t config;	/* index of the configuration + 1; 0: an older module */
};

/**
 * ect_domain_read() - a domain of an application
 * @h: master
 * @index: below @domain_count of struct ect_master
 * @d: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_domain_read(struct ect_handle *h, unsigned int index, struct ect_domain *d);

/**
 * ect_domain_fmmu() - the share of a slave configuration in a domain
 * @h: master
 * @index: of the domain
 * @fmmu: below @fmmu_count of struct ect_domain
 * @f: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_config_read().
 */
int ect_domain_fmmu(struct ect_handle *h, unsigned int index, unsigned int fmmu,
		    struct ect_fmmu *f);

/**
 * ect_domain_data() - the process data of a domain
 * @h: master
 * @index: of the domain
 * @data: for @size bytes
 * @size: bytes; @size of struct ect_domain is all
 *
 * Context: The thread of the handle; no traffic.
 * Return: bytes copied, or a negative errno as ect_config_read().
 */
long ect_domain_data(struct ect_handle *h, unsigned int index, void *data, size_t size);

/* struct ect_unit.policy */
#define ECT_UNIT_CONTINUE		0U
#define ECT_UNIT_ZERO		1U
#define ECT_UNIT_HOLD		2U
#define ECT_UNIT_SAFEOP		3U
#define ECT_UNIT_STOP		4U

/* bits of struct ect_unit.flags */
#define ECT_UNIT_AUTHORITY	1U	/* begins without authority; a failure takes it */
#define ECT_UNIT_LEASE_HOLD	2U	/* after the lease outputs are held, not zero */
#define ECT_UNIT_OFFERED	4U	/* another application may hold it */

/* struct ect_unit.run */
#define ECT_UNIT_STARTING	0
#define ECT_UNIT_COMPLETE	1
#define ECT_UNIT_FAILED		2

/* struct ect_unit.outputs */
#define ECT_UNIT_VALUES		0	/* those of the application */
#define ECT_UNIT_ZEROS		1
#define ECT_UNIT_HELD		2

/* a sync unit: domains that are judged together */
struct ect_unit {
	uint32_t struct_size;
	uint32_t index;
	uint32_t policy;	/* ECT_UNIT_* */
	uint32_t flags;		/* likewise */
	uint32_t limit;		/* receives in a row until it has failed */
	uint32_t lease_cycles;	/* 0: no lease */
	uint32_t repeats;	/* frames with the same data in a cycle */
	uint32_t faults;	/* 65535: at least that */
	uint64_t domains;	/* bit n: domain n */
	uint8_t active;		/* what follows is valid */
	uint8_t run;
	uint8_t outputs;
	uint8_t authority;
	uint8_t lease_ended;
	uint8_t down;		/* its policy has taken its slaves to SAFEOP */
	uint8_t held;		/* another application gives its outputs */
	uint8_t reserved;
	char name[ECT_STRING];
};

/**
 * ect_unit_read() - a sync unit of an application
 * @h: master
 * @index: from 0 on
 * @u: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0; -ENOENT there is no such unit; -ENOTTY an older module; or another negative errno.
 */
int ect_unit_read(struct ect_handle *h, unsigned int index, struct ect_unit *u);

/**
 * ect_unit_take() - take the authority of a sync unit: its outputs are zero
 * @h: master, opened for writing
 * @index: unit
 *
 * Context: The thread of the handle.
 * Return: 0; -ENOENT there is no such unit; -EINVAL the master is not active; or another negative
 * errno.
 */
int ect_unit_take(struct ect_handle *h, unsigned int index);

#ifdef __cplusplus
}
#endif

#endif
