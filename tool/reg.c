// SPDX-License-Identifier: GPL-2.0-only
#include "errors.h"

#include <errno.h>

#define CHUNK	1024
#define TRIES	4	/* of a read that changes nothing */

static int transfer(struct dev *d, unsigned long request, u32 flags, u16 position, u16 address,
		    u8 *data, size_t size)
{
	for (size_t done = 0; done < size; done += CHUNK) {
		struct ec_ioc_reg r = {
			.flags = flags,
			.position = position,
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

int reg_read(struct dev *d, u16 position, u16 address, u8 *data, size_t size)
{
	return transfer(d, EC_IOC_REG_READ, 0, position, address, data, size);
}

int reg_write(struct dev *d, u16 position, u16 address, const u8 *data, size_t size,
	      bool emergency)
{
	return transfer(d, EC_IOC_REG_WRITE, emergency ? EC_REG_FLAG_EMERGENCY : 0, position,
			address, (u8 *)(uintptr_t)data, size);
}

/* one datagram: @data is written, and what was there before is in it afterwards */
int reg_rdwr(struct dev *d, u16 position, u16 address, u8 *data, size_t size)
{
	if (size > CHUNK)
		return usage_error("invalid size %zu: one datagram takes 1 to %u bytes", size,
				   CHUNK);
	return transfer(d, EC_IOC_REG_RDWR, 0, position, address, data, size);
}

/**
 * errors_try() - read the error counters of a slave
 * @d: master, open for writing
 * @position: of the slave
 * @regs: result, EC_ERRORS_SIZE bytes
 *
 * They are of use where frames are lost: the read is repeated then, as it changes nothing.
 *
 * Return: 0 or the errno.
 */
int errors_try(struct dev *d, u16 position, u8 *regs)
{
	struct ec_ioc_reg r = {
		.position = position, .address = EC_REG_ERRORS, .size = EC_ERRORS_SIZE,
		.data = (uintptr_t)regs,
	};
	int err = ETIMEDOUT;

	for (int i = 0; i < TRIES && err == ETIMEDOUT; i++)
		err = dev_ioctl(d, EC_IOC_REG_READ, &r);
	return err;
}

/* the same; 0, or 1 after printing the error */
int errors_read(struct dev *d, u16 position, u8 *regs)
{
	int err = errors_try(d, position, regs);

	return err ? dev_fail(d, err, "Master%u slave %u: cannot read register 0x%04x", d->master,
			      position, EC_REG_ERRORS) : 0;
}
