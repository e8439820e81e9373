/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Loop control of ports. While process data run, ports behind which nothing is known are closed, so
 * that no slave gets process data before the master has made it harmless.
 */
#ifndef EC_PORTS_H
#define EC_PORTS_H

#include <linux/types.h>

struct ec_behind;
struct ec_bus;
struct ec_slave;

enum ec_ports_result {
	EC_PORTS_QUIET,
	EC_PORTS_DOOR,		/* a closed port has a link */
	EC_PORTS_FOUND,		/* slaves were let in, which a scan finds */
};

void ec_ports_guard(struct ec_bus *bus, bool on);
bool ec_ports_are_guarded(const struct ec_bus *bus);
enum ec_ports_result ec_ports_work(struct ec_bus *bus, bool scanned, bool event);
void ec_ports_note_loss(struct ec_slave *s, unsigned int port, bool open);
void ec_ports_retry(struct ec_bus *bus);
int ec_ports_let_in(struct ec_slave *s, unsigned int port, const struct ec_behind *what);
void ec_ports_set_fast(struct ec_slave *s, u8 ports);
u32 ec_ports_kept(const struct ec_slave *s, unsigned int port, u32 *wait_s);
void ec_ports_open_all(struct ec_bus *bus);

#endif
