// SPDX-License-Identifier: GPL-2.0-only
#include "sii_image.h"

#include <stdlib.h>

/**
 * sii_load() - read the SII image that the master has of a slave
 * @d: master
 * @s: slave
 * @img: result, to be freed; with a size of 0 it was not read
 * @size: bytes at @img
 *
 * Whatever size the image has, the kernel may give it in pieces.
 *
 * Return: 0, or 1 after printing what failed.
 */
int sii_load(struct dev *d, const struct slave *s, u8 **img, size_t *size)
{
	size_t want = 2 * (size_t)s->sii_words;
	u8 *buf = calloc(1, want + 1);

	*size = 0;
	if (!buf)
		return fail("out of memory");
	while (*size < want) {
		struct ec_ioc_sii a = {
			.slave = s->slave,
			.offset = (u32)*size,
			.size = (u32)(want - *size),
			.data = (uintptr_t)(buf + *size),
		};
		int err = dev_ioctl(d, EC_IOC_SII, &a);

		if (err) {
			free(buf);
			return dev_fail(d, err, "Master%u slave %u: cannot read the SII", d->master,
					s->position);
		}
		if (!a.size)
			break;
		*size += min((size_t)a.size, want - *size);
	}
	*img = buf;
	return 0;
}
