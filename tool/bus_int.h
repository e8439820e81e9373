/* SPDX-License-Identifier: GPL-2.0-only */
/* What makes a bus of a machine. Functions print their error and return 0 or 1. */
#ifndef EC_TOOL_BUS_INT_H
#define EC_TOOL_BUS_INT_H

#include "bus_machine.h"
#include "present.h"
#include "save.h"

/* bus_pdos.c: PDOs of the slave itself, the others as in the EEPROM */
int bus_pdos(struct dev *d, struct ecb_bus *bus, const struct present *l, struct ecb_slave *to);

/* bus_present.c */
/* what is to be read of @s: objects of startup commands included */
int bus_present_wish(const struct bus_wish *wish, unsigned int master, const struct ect_slave *s,
		  struct present *l);
/* what was read, without PDOs */
int bus_present_take(struct ecb_bus *bus, const struct present *l, struct ecb_slave *to);

/* bus_session.c; needs the names of the slaves */
int bus_session(struct dev *d, struct ecb_bus *bus, const struct ect_list *list,
		struct ecb_master *m);

/* cmd_bus.c: an existing file only with --force */
int bus_save_begin(const struct tool *t, struct save *s, const char *path);

/* bus_compile.c: of the selected master, if there are several; 0, or 1 or 2 after its error */
int bus_compile(const struct tool *t, const char *path, const struct ecb_bus *bus);

#endif
