// SPDX-License-Identifier: LGPL-2.1-or-later
/* Registers of slaves. */
#include "../../master/wire/regs.h"
#include "internal.h"

#define REG_SPACE	0x10000u

static int reg_transfer(struct ect_handle *h, unsigned long command, u32 flags,
			struct ec_ioc_address slave, u16 address, u8 *data, size_t size)
{
	if (address + size > REG_SPACE)
		return ect_fail(h, -EINVAL, "registers end at 0xffff: %zu bytes at 0x%04x are too many",
				size, address);
	for (size_t done = 0; done < size; done += ECT_REG_MAX) {
		struct ec_ioc_reg r = {
			.flags = flags,
			.slave = slave,
			.address = (u16)(address + done),
			.size = (u32)min(size - done, (size_t)ECT_REG_MAX),
			.data = (uintptr_t)(data + done),
		};
		int ret = ect_command(h, command, &r);

		if (ret)
			return ret;
	}
	return 0;
}

int ect_reg_read(struct ect_handle *h, uint64_t device, uint16_t address, void *data, size_t size)
{
	return reg_transfer(h, EC_IOC_REG_READ, 0, ect_address(device), address, data, size);
}

int ect_reg_write(struct ect_handle *h, uint64_t device, uint16_t address, const void *data,
		  size_t size)
{
	return reg_transfer(h, EC_IOC_REG_WRITE, 0, ect_address(device), address,
			    (u8 *)(uintptr_t)data, size);
}

int ect_reg_write_emergency(struct ect_handle *h, uint16_t position, uint16_t address,
			    const void *data, size_t size)
{
	return reg_transfer(h, EC_IOC_REG_WRITE, EC_REG_FLAG_EMERGENCY, ect_ring(position), address,
			    (u8 *)(uintptr_t)data, size);
}

int ect_reg_exchange(struct ect_handle *h, uint64_t device, uint16_t address, void *data,
		     size_t size)
{
	if (size > ECT_REG_MAX)
		return ect_fail(h, -EINVAL, "one datagram takes 1 to %u bytes", ECT_REG_MAX);
	return reg_transfer(h, EC_IOC_REG_RDWR, 0, ect_address(device), address, data, size);
}

#define ERRORS_TRIES	4	/* attempts of a read that changes nothing */

int ect_get_errors(struct ect_handle *h, u64 device, struct ect_errors *to)
{
	u8 regs[EC_ERRORS_SIZE];
	int ret = -ETIMEDOUT;

	*to = (struct ect_errors){ .struct_size = sizeof(*to) };
	for (int i = 0; i < ERRORS_TRIES && ret == -ETIMEDOUT; i++)
		ret = ect_reg_read(h, device, EC_REG_ERRORS, regs, sizeof(regs));
	if (ret)
		return ret;
	to->unit = regs[EC_REG_ERR_PU - EC_REG_ERRORS];
	to->pdi = regs[EC_REG_ERR_PDI - EC_REG_ERRORS];
	for (unsigned int p = 0; p < ECT_PORTS; p++)
		to->ports[p] = (struct ect_port_errors){
			.invalid = regs[EC_REG_ERR_RX(p) - EC_REG_ERRORS],
			.receiver = regs[EC_REG_ERR_PHY(p) - EC_REG_ERRORS],
			.forwarded = regs[EC_REG_ERR_FWD(p) - EC_REG_ERRORS],
			.lost_link = regs[EC_REG_ERR_LOST(p) - EC_REG_ERRORS],
		};
	return 0;
}

int ect_errors_read(struct ect_handle *h, uint64_t device, struct ect_errors *e)
{
	struct ect_errors own;
	int ret = ect_get_errors(h, device, &own);

	return ret ? ret : ect_give(h, e, &own, sizeof(own));
}
