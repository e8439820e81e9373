/* SPDX-License-Identifier: GPL-2.0-only */
/* Device numbers: a device keeps its number through loss and return. */
#ifndef EC_KNOWN_H
#define EC_KNOWN_H

#include <linux/types.h>

struct ec_bus;
struct ec_image;
struct ec_lost;
struct ec_slave;

void ec_known_update(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n,
		     unsigned int limit);
bool ec_known_is_present(const struct ec_bus *bus, u16 station);
bool ec_known_was_there(const struct ec_bus *bus, u16 station);
u64 ec_known_by_station(const struct ec_bus *bus, u16 station);
bool ec_known_is(const struct ec_bus *bus, u16 station, u32 vendor, u32 product, u32 serial);
u16 ec_known_fresh_station(struct ec_bus *bus, struct ec_slave *const *known, const u8 *claims);
struct ec_image *ec_known_image(const struct ec_bus *bus, u16 station, const u8 *head);
void ec_known_forget_images(struct ec_bus *bus);
struct ec_lost *ec_known_lost(const struct ec_bus *bus, u64 number);
struct ec_slave *ec_known_connected(const struct ec_bus *bus, u64 number);
struct ec_slave *ec_known_slave(const struct ec_bus *bus, u64 number);
size_t ec_known_text(const struct ec_bus *bus, u64 number, char *buf, size_t size);

#endif
