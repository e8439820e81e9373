// SPDX-License-Identifier: GPL-2.0-only
#include "reg.h"

static int failed(struct dev *d, int err, const char *verb, const struct ect_slave *s,
		  size_t address)
{
	return dev_fail(d, err, "Master%u slave %u: cannot %s register 0x%04x", d->master,
			s->position, verb, (u16)address);
}

/* one datagram after the other, so that the error names the one that failed */
int reg_read(struct dev *d, const struct ect_slave *s, u16 address, u8 *data, size_t size)
{
	for (size_t i = 0; i < size; i += ECT_REG_MAX) {
		int err = ect_reg_read(d->h, s->device, (u16)(address + i), data + i,
				       min(size - i, (size_t)ECT_REG_MAX));

		if (err)
			return failed(d, err, "read", s, address + i);
	}
	return 0;
}

static int put(struct dev *d, const struct ect_slave *s, u16 address, const u8 *data, size_t size,
	       bool emergency)
{
	if (emergency)
		return ect_reg_write_emergency(d->h, s->position, address, data, size);
	return ect_reg_write(d->h, s->device, address, data, size);
}

int reg_write(struct dev *d, const struct ect_slave *s, u16 address, const u8 *data, size_t size,
	      bool emergency)
{
	for (size_t i = 0; i < size; i += ECT_REG_MAX) {
		int err = put(d, s, (u16)(address + i), data + i,
			      min(size - i, (size_t)ECT_REG_MAX), emergency);

		if (err)
			return failed(d, err, "write", s, address + i);
	}
	return 0;
}

/* one datagram: @data is written, and gets the previous content */
int reg_rdwr(struct dev *d, const struct ect_slave *s, u16 address, u8 *data, size_t size)
{
	int err;

	if (size > ECT_REG_MAX)
		return usage_error("invalid size %zu: one datagram takes 1 to %u bytes", size,
				   ECT_REG_MAX);
	err = ect_reg_exchange(d->h, s->device, address, data, size);
	return err ? failed(d, err, "exchange", s, address) : 0;
}
