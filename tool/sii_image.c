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
 * Return: 0, or 1 after printing what failed.
 */
int sii_load(struct dev *d, const struct ect_slave *s, u8 **img, size_t *size)
{
	size_t want = 2 * (size_t)s->sii_words;
	u8 *buf = calloc(1, want + 1);
	long n;

	*size = 0;
	if (!buf)
		return fail("out of memory");
	n = ect_sii_read(d->h, s->device, 0, buf, want);
	if (n < 0) {
		free(buf);
		return dev_fail(d, (int)n, "Master%u slave %u: cannot read the SII", d->master,
				s->position);
	}
	*size = (size_t)n;
	*img = buf;
	return 0;
}
