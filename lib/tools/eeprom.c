// SPDX-License-Identifier: LGPL-2.1-or-later
/* Writing EEPROMs of slaves. */
#include "internal.h"

int ect_sii_write(struct ect_handle *h, uint64_t device, const void *data, size_t size,
		  uint32_t flags, struct ect_sii_written *w, uint64_t *done)
{
	struct ec_ioc_sii_write i = {
		.flags = flags, .slave = ect_address(device), .data = (uintptr_t)data,
		.size = (u32)min(size, (size_t)0xffffffff), .done = (uintptr_t)done,
	};
	int ret = ect_command(h, EC_IOC_SII_WRITE, &i);
	struct ect_sii_written own = {
		.struct_size = sizeof(own), .differ = i.differ, .written = i.written,
		.register_alias = i.register_alias, .renewed = i.renewed,
	};
	int given = ret && ret != -EIO ? 0 : ect_give(h, w, &own, sizeof(own));

	return ret ? ret : given;
}

int ect_alias_write(struct ect_handle *h, uint64_t device, uint16_t alias, uint32_t flags,
		    struct ect_sii_written *w)
{
	struct ec_ioc_alias i = { .flags = flags, .slave = ect_address(device), .alias = alias };
	int ret = ect_command(h, EC_IOC_ALIAS, &i);
	struct ect_sii_written own = {
		.struct_size = sizeof(own), .register_alias = i.register_alias,
		.renewed = i.renewed,
	};

	return ret ? ret : ect_give(h, w, &own, sizeof(own));
}
