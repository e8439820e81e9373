// SPDX-License-Identifier: GPL-2.0-only
#include "errors.h"

#include <errno.h>

#define TRIES	4	/* of a read that changes nothing */

/**
 * errors_try() - read the error counters of a slave
 * @d: master, open for writing
 * @s: slave
 * @regs: result, EC_ERRORS_SIZE bytes
 *
 * They are of use where frames are lost: the read is repeated then, as it changes nothing.
 *
 * Return: 0 or the errno.
 */
int errors_try(struct dev *d, const struct slave *s, u8 *regs)
{
	struct ec_ioc_reg r = {
		.slave = s->slave, .address = EC_REG_ERRORS, .size = EC_ERRORS_SIZE,
		.data = (uintptr_t)regs,
	};
	int err = ETIMEDOUT;

	for (int i = 0; i < TRIES && err == ETIMEDOUT; i++)
		err = dev_ioctl(d, EC_IOC_REG_READ, &r);
	return err;
}

/* the same; 0, or 1 after printing the error */
int errors_read(struct dev *d, const struct slave *s, u8 *regs)
{
	int err = errors_try(d, s, regs);

	return err ? dev_fail(d, err, "Master%u slave %u: cannot read register 0x%04x", d->master,
			      s->position, EC_REG_ERRORS) : 0;
}
