/* SPDX-License-Identifier: GPL-2.0-only */
/* What slaves with EoE are called as network devices. */
#ifndef EC_EOE_IDS_H
#define EC_EOE_IDS_H

#include <linux/types.h>

struct ec_bus;

/**
 * struct ec_eoe_id - what a slave is called as a network device
 * @device: device number
 * @alias: alias, 0: none
 * @serial: serial number, 0: none
 * @position: ring position
 * @vendor: vendor ID
 * @product: product code
 * @alias_shared: another slave with EoE has this alias too
 * @serial_shared: the same for the serial number
 */
struct ec_eoe_id {
	u64 device;
	u16 alias;
	u32 serial;
	u16 position;
	u32 vendor;
	u32 product;
	bool alias_shared;
	bool serial_shared;
};

struct ec_eoe_id *ec_eoe_ids_read(struct ec_bus *bus, u32 lists, unsigned int *n);
void ec_eoe_ids_by_device(struct ec_eoe_id *ids, unsigned int n);
void ec_eoe_ids_by_unit(struct ec_eoe_id *ids, unsigned int n);
const struct ec_eoe_id *ec_eoe_ids_find(const struct ec_eoe_id *ids, unsigned int n, u64 device);
unsigned int ec_eoe_ids_first(const struct ec_eoe_id *ids, unsigned int n,
			      const struct ec_eoe_id *id);
bool ec_eoe_ids_same(const struct ec_eoe_id *a, const struct ec_eoe_id *b);

#endif
