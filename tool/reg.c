// SPDX-License-Identifier: GPL-2.0-only
#include "reg.h"

#define CHUNK	1024

static int transfer(struct dev *d, unsigned long request, u32 flags, unsigned int position,
		    struct ec_ioc_address slave, u16 address, u8 *data, size_t size)
{
	for (size_t done = 0; done < size; done += CHUNK) {
		struct ec_ioc_reg r = {
			.flags = flags,
			.slave = slave,
			.address = (u16)(address + done),
			.size = (u32)min(size - done, (size_t)CHUNK),
			.data = (uintptr_t)(data + done),
		};
		int err = dev_ioctl(d, request, &r);

		if (err)
			return dev_fail(d, err, "Master%u slave %u: cannot %s register 0x%04x",
					d->master, position,
					request == EC_IOC_REG_READ ? "read" :
					request == EC_IOC_REG_WRITE ? "write" : "exchange",
					r.address);
	}
	return 0;
}

int reg_read(struct dev *d, const struct slave *s, u16 address, u8 *data, size_t size)
{
	return transfer(d, EC_IOC_REG_READ, 0, s->position, s->slave, address, data, size);
}

int reg_write(struct dev *d, const struct slave *s, u16 address, const u8 *data, size_t size)
{
	return transfer(d, EC_IOC_REG_WRITE, 0, s->position, s->slave, address,
			(u8 *)(uintptr_t)data, size);
}

/* by ring position, also while the bus is not scanned */
int reg_write_emergency(struct dev *d, u16 position, u16 address, const u8 *data, size_t size)
{
	return transfer(d, EC_IOC_REG_WRITE, EC_REG_FLAG_EMERGENCY, position,
			(struct ec_ioc_address){ .position = position }, address,
			(u8 *)(uintptr_t)data, size);
}

/* one datagram: @data is written, and what was there before is in it afterwards */
int reg_rdwr(struct dev *d, const struct slave *s, u16 address, u8 *data, size_t size)
{
	if (size > CHUNK)
		return usage_error("invalid size %zu: one datagram takes 1 to %u bytes", size,
				   CHUNK);
	return transfer(d, EC_IOC_REG_RDWR, 0, s->position, s->slave, address, data, size);
}
