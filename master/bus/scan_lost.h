/* SPDX-License-Identifier: GPL-2.0-only */
/* Events of slaves that were disconnected or connected, by place. */
#ifndef EC_SCAN_LOST_H
#define EC_SCAN_LOST_H

struct ec_bus;
struct ec_slave;
struct scan;

void ec_lost_note_place(struct ec_slave *s);
void ec_lost_report(struct ec_bus *bus, struct ec_slave **lost, unsigned int n);
void ec_lost_report_found(struct scan *sc, unsigned int n_old);

#endif
