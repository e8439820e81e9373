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

int ect_datagram(struct ect_handle *h, uint8_t command, uint32_t address, void *data, size_t size,
		 uint16_t *working_counter)
{
	struct ec_ioc_datagram d = {
		.address = address,
		.command = command,
		.size = size > UINT32_MAX ? UINT32_MAX : (u32)size,
		.data = (uintptr_t)data,
	};
	int ret = ect_command(h, EC_IOC_DATAGRAM, &d);

	if (!ret)
		*working_counter = d.working_counter;
	return ret;
}

#define ERRORS_TRIES	4	/* attempts of a read that changes nothing */

/* counts of each port that the registers do not contain any more: the master has cleared them */
struct cleared {
	u32 port[ECT_PORTS][3];
};

static int get_cleared(struct ect_handle *h, u64 device, struct cleared *to)
{
	int ret = 0;

	for (u32 p = 0; p < ECT_PORTS && !ret; p++) {
		struct ec_ioc_port from = { .slave = ect_address(device), .port = p };

		ret = ect_command(h, EC_IOC_PORT, &from);
		memcpy(to->port[p], from.cleared, sizeof(to->port[p]));
	}
	return ret;
}

/* as if the counter had not been cleared: it stops at 255 */
static u8 counted(const u8 *regs, unsigned int reg, u32 cleared)
{
	u32 n = regs[reg - EC_REG_ERRORS];

	return (u8)(cleared < UINT8_MAX - n ? n + cleared : UINT8_MAX);
}

/* both of the same time: the master may clear them in between */
static int read_counters(struct ect_handle *h, u64 device, u8 *regs, struct cleared *cleared)
{
	int ret = get_cleared(h, device, cleared);

	for (int i = 0; i < ERRORS_TRIES && !ret; i++) {
		struct cleared before = *cleared;

		ret = ect_reg_read(h, device, EC_REG_ERRORS, regs, EC_ERRORS_SIZE);
		ret = ret ? ret : get_cleared(h, device, cleared);
		if (!memcmp(&before, cleared, sizeof(before)))
			break;
	}
	return ret;
}

int ect_get_errors(struct ect_handle *h, u64 device, struct ect_errors *to)
{
	struct cleared c = { 0 };
	u8 regs[EC_ERRORS_SIZE];
	int ret = -ETIMEDOUT;

	*to = (struct ect_errors){ .struct_size = sizeof(*to) };
	for (int i = 0; i < ERRORS_TRIES && ret == -ETIMEDOUT; i++)
		ret = read_counters(h, device, regs, &c);
	if (ret)
		return ret;
	to->unit = regs[EC_REG_ERR_PU - EC_REG_ERRORS];
	to->pdi = regs[EC_REG_ERR_PDI - EC_REG_ERRORS];
	for (unsigned int p = 0; p < ECT_PORTS; p++)
		to->ports[p] = (struct ect_port_errors){
			.invalid = counted(regs, EC_REG_ERR_RX(p), c.port[p][0]),
			.receiver = counted(regs, EC_REG_ERR_PHY(p), c.port[p][1]),
			.forwarded = counted(regs, EC_REG_ERR_FWD(p), c.port[p][2]),
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
