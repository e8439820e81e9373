/* SPDX-License-Identifier: GPL-2.0-only */
/* The masters of this module, and the thread that watches the bus of each. */
#ifndef EC_MONITOR_H
#define EC_MONITOR_H

struct ec_master;

int ec_masters_create(char **main, unsigned int n_main, char **backup, unsigned int n_backup,
		      unsigned int debug);
void ec_masters_destroy(void);

/* monitor.c */
int ec_monitor_start(struct ec_master *m);
void ec_monitor_stop(struct ec_master *m);
void ec_monitor_kick(struct ec_master *m);

#endif
