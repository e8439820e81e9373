/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: a bus that runs without an application, its values by name. */
#ifndef ETHERCAT_TOOLS_RUN_H
#define ETHERCAT_TOOLS_RUN_H

#include "slave.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECT_WORD	64	/* bytes of the name of a slave, with its end */
#define ECT_VALUE_NAME	192	/* bytes of the name of a value, with its end */

/* struct ect_name.kind: what moves, heats or protects runs only when the user names it */
#define ECT_KIND_IO		0
#define ECT_KIND_DRIVE		1	/* profile 402, or SoE */
#define ECT_KIND_SAFETY		2	/* FSoE */
#define ECT_KIND_UNKNOWN	3	/* it does not say: no answer, or an unclear one */

/* the name of a slave */
struct ect_name {
	uint32_t struct_size;
	uint16_t position;	/* in the ring, now */
	uint16_t reserved;
	uint64_t device;	/* number of the device */
	char name[ECT_WORD];
};

/**
 * ect_names_read() - the names of all slaves
 * @h: master
 * @list: result, elements are struct ect_name in the order of the ring
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_names_read(struct ect_handle *h, struct ect_list **list);

/**
 * ect_kind_read() - what kind of slave one is
 * @h: master, open for writing
 * @s: slave
 * @kind: result: ECT_KIND_*
 *
 * Reads the objects 0x1000, 0xF010 and 0xF980, and the names of its PDOs.
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0 or a negative errno.
 */
int ect_kind_read(struct ect_handle *h, const struct ect_slave *s, unsigned int *kind);

/* the cycle that the kernel runs */
struct ect_run {
	uint32_t struct_size;
	uint32_t period_ns;	/* 10000 to 1000000000 */
	uint32_t priority;	/* SCHED_FIFO 1 to 98, 0: 50; none without the right to it */
	int32_t cpu;		/* -1: any */
};

/**
 * ect_run_reserve() - begin to configure a bus that runs without an application
 * @h: master, open for writing
 *
 * All slaves go to PREOP. If the handle is closed before ect_run_leave(), also by the end of the
 * process, the session ends.
 *
 * Context: The thread of the handle; waits for a bus scan.
 * Return: 0, -EBUSY if an application has the master or the bus runs already, or another negative
 * errno.
 */
int ect_run_reserve(struct ect_handle *h);

/**
 * ect_run_add() - add a slave, with the PDOs that it has
 * @h: master after ect_run_reserve()
 * @s: slave
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0 or a negative errno.
 */
int ect_run_add(struct ect_handle *h, const struct ect_slave *s);

/**
 * ect_run_start() - the kernel begins the cycle, slaves go to OP, outputs are zero
 * @h: master after ect_run_reserve()
 * @how: the cycle
 *
 * Returns at once: struct ect_config shows what is in OP.
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno.
 */
int ect_run_start(struct ect_handle *h, const struct ect_run *how);

/**
 * ect_run_leave() - the master keeps the session, also when the process ends
 * @h: master after ect_run_start()
 *
 * ect_output_set() sets outputs, ect_end_detached() ends the session.
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno.
 */
int ect_run_leave(struct ect_handle *h);

/* a value in the process data of a session */
struct ect_value {
	uint32_t struct_size;
	uint32_t config;	/* index of the configuration */
	uint64_t device;	/* number of its slave, 0: disconnected */
	uint32_t domain;
	uint32_t bit;		/* the first one, in the domain */
	uint16_t index;		/* of the object */
	uint8_t subindex;
	uint8_t bits;
	uint8_t dir;		/* ECT_DIR_OUTPUT: the master writes */
	uint8_t reserved;
	uint16_t type;		/* CoE data type by the EEPROM, 0: not known */
	int32_t position;	/* ring position of its slave, -1: disconnected */
	char name[ECT_VALUE_NAME];
};

/**
 * ect_values_read() - the values of the running session, also that of an application
 * @h: master
 * @list: result, elements are struct ect_value by configuration and in the order of its PDOs
 *
 * Names are SLAVE.ENTRY, or SLAVE.PDO.ENTRY where a slave has two entries of the same name. The
 * texts of a slave that is disconnected are those of another one of its kind, or missing.
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0, -ENOENT without a session, or another negative errno.
 */
int ect_values_read(struct ect_handle *h, struct ect_list **list);

/**
 * ect_session_names() - what the application of the running session calls its values
 * @h: master
 * @text: result: a bus file with one master, whose slaves are in the order of the configurations,
 * with a 0 behind it, to be freed with free(); NULL: it says nothing
 * @size: result: bytes without that 0
 *
 * The text is of another user, and not checked: ecb_file_parse() does.
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0, -ENOENT without a session, or another negative errno.
 */
int ect_session_names(struct ect_handle *h, char **text, size_t *size);

/* outputs that are set */
struct ect_output {
	uint32_t struct_size;
	uint32_t domain;
	uint64_t device;	/* whose outputs they are */
	uint32_t bit;		/* the first one, in the domain */
	uint32_t bits;		/* 1 to 64 */
	uint64_t value;		/* bit 0 is the first one */
	uint32_t lease_ms;	/* then they become zero; 0: they stay */
	uint32_t reserved;
};

/**
 * ect_output_set() - set outputs of a bus that runs without an application
 * @h: master, open for writing
 * @o: outputs
 *
 * The kernel ends the lease, also when the process has ended.
 *
 * Context: The thread of the handle.
 * Return: 0; -EPERM the outputs are those of an application; -ENOENT they are no outputs of this
 * slave; -EBUSY a lease of a part of them; or another negative errno.
 */
int ect_output_set(struct ect_handle *h, const struct ect_output *o);

#ifdef __cplusplus
}
#endif

#endif
