/* SPDX-License-Identifier: GPL-2.0-only */
/* The selected masters as a bus of libethercat-bus. */
#ifndef EC_TOOL_BUS_MACHINE_H
#define EC_TOOL_BUS_MACHINE_H

#include "../include/ethercat-bus.h"
#include "dev.h"

/**
 * struct bus_wish - what is read of a machine
 * @pdos: PDOs and their entries
 * @serial: serial numbers
 */
struct bus_wish {
	bool pdos;
	bool serial;
};

/* 0 with @bus, to be freed with ecb_bus_free(), or 1 after printing the error */
int bus_of_machine(const struct tool *t, const struct bus_wish *wish, struct ecb_bus **bus);

/* cmd_bus.c: names of the two sides of a comparison, and whether they have several masters */
struct bus_names {
	const char *expected;
	const char *found;
	bool several;
};

/* prints a difference; @ctx: struct bus_names */
void bus_show_difference(void *ctx, const struct ecb_difference *d);

#endif
