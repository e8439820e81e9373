// SPDX-License-Identifier: GPL-2.0-only
#include "errors.h"

/* 0, or 1 after printing the error */
int errors_read(struct dev *d, const struct ect_slave *s, struct ect_errors *e)
{
	int err;

	e->struct_size = sizeof(*e);
	err = ect_errors_read(d->h, s->device, e);
	return err ? dev_fail(d, err, "Master%u slave %u: cannot read register 0x%04x", d->master,
			      s->position, EC_REG_ERRORS) : 0;
}
