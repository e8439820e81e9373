/* SPDX-License-Identifier: GPL-2.0-only */
/* What 'ethercat top' calls slaves: as a bus file or the application of the session does. */
#ifndef EC_TOOL_TOP_NAMES_H
#define EC_TOOL_TOP_NAMES_H

#include "bus_machine.h"

/**
 * struct top_names - names of slaves
 * @paired: of a bus file
 * @devices: slaves that @paired was made for, in the order of the ring
 * @n: of them
 * @text: of the application; NULL: none
 * @size: of @text in bytes
 * @bus: what @text says; NULL: it is not valid
 */
struct top_names {
	struct bus_paired paired;
	u64 *devices;
	size_t n;
	char *text;
	size_t size;
	struct ecb_bus *bus;
};

/*
 * Before each look, with the slaves of now: names of --file, else of the application. @x begins
 * with zeros. 0, or 1 after printing the error; to be freed in any case.
 */
int top_names_read(const struct tool *t, struct dev *d, const struct slaves *all,
		   struct top_names *x);
/* NULL: it has none */
const char *top_name(const struct top_names *x, const struct ect_slave *s);
void top_names_free(struct top_names *x);

#endif
