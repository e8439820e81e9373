/* SPDX-License-Identifier: GPL-2.0-only */
/* The selected masters as a bus of libethercat-bus. */
#ifndef EC_TOOL_BUS_MACHINE_H
#define EC_TOOL_BUS_MACHINE_H

#include "../include/ethercat-bus.h"
#include "dev.h"

/**
 * struct bus_wish - what is read of a machine
 * @whole: all that is known, also of slaves themselves and of a running session
 * @file: without @whole: only what this file says; NULL: what finds a slave again
 * @serials: serial numbers, by which slaves are found as well
 * @pdos: with @file: PDOs also of its slaves that keep their own
 * @unread: set to the number of slaves of which something was not read
 */
struct bus_wish {
	bool whole;
	const struct ecb_bus *file;
	bool serials;
	bool pdos;
	size_t unread;
};

/* 0 with @bus, to be freed with ecb_bus_free(), or 1 after printing the error */
int bus_of_machine(const struct tool *t, struct bus_wish *wish, struct ecb_bus **bus);

/* likewise of one master that is open */
int bus_of_master(const struct tool *t, struct dev *d, struct bus_wish *wish,
		  struct ecb_bus **bus);

/**
 * struct bus_paired - which slave of a file is which of a machine
 * @file: bus file
 * @machine: what is connected
 * @of: slave of @file of each ring position, NULL: it has none
 * @n: ring positions
 * @named: of them with a slave of @file
 */
struct bus_paired {
	struct ecb_bus *file;
	struct ecb_bus *machine;
	const struct ecb_slave **of;
	size_t n;
	size_t named;
};

/* bus_values.c: of a file that has a slave of the machine; 0, or 1 after printing the error */
int bus_pair(const struct tool *t, struct dev *d, const char *path, struct bus_paired *x);
/* also after a failure */
void bus_pair_free(struct bus_paired *x);

struct current;
/* names, types, units and scaling of @path; 0, or 1 after printing the error */
int bus_values(const struct tool *t, struct dev *d, const char *path, struct current *l);

/* cmd_bus.c: names of the two sides that are compared, and whether they have several masters */
struct bus_names {
	const char *expected;
	const char *found;
	bool several;
};

/* prints a difference; @ctx: struct bus_names */
void bus_show_difference(void *ctx, const struct ecb_difference *d);

#endif
