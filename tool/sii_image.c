// SPDX-License-Identifier: GPL-2.0-only
#include "sii_image.h"

#include <stdlib.h>

#include "../lib/tools/text.h"

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

void sii_text(const u8 *img, size_t size, u8 number, char *name, size_t room)
{
	ec_sii_string(img, size, number, name, room);
	string_clean(name, room);
}

static const u16 categories[] = { EC_SII_CAT_TXPDO, EC_SII_CAT_RXPDO };

bool sii_pdo_find(const u8 *img, size_t size, u16 index, struct ec_sii_pdo *p)
{
	for (unsigned int c = 0; c < ARRAY_SIZE(categories); c++) {
		struct ec_sii_pdo_iter it;

		ec_sii_pdo_iter_init(&it, img, size, categories[c]);
		while (ec_sii_pdo_iter_next(&it, p) == 1)
			if (p->index == index)
				return true;
	}
	return false;
}

static bool entry_of(const struct ec_sii_pdo *p, u16 index, u8 sub, struct ec_sii_pdo_entry *e)
{
	for (unsigned int i = 0; i < p->entries && !ec_sii_pdo_entry(p, i, e); i++)
		if (e->index == index && e->sub == sub)
			return true;
	return false;
}

void sii_entry_text(const u8 *img, size_t size, u16 index, u8 sub, char *name, size_t room,
		    u16 *type)
{
	*name = 0;
	*type = 0;
	for (unsigned int c = 0; index && c < ARRAY_SIZE(categories); c++) {
		struct ec_sii_pdo_iter it;
		struct ec_sii_pdo_entry e;
		struct ec_sii_pdo p;

		ec_sii_pdo_iter_init(&it, img, size, categories[c]);
		while (ec_sii_pdo_iter_next(&it, &p) == 1) {
			if (!entry_of(&p, index, sub, &e))
				continue;
			if (!*name)
				sii_text(img, size, e.name, name, room);
			*type = *type ?: e.type;
		}
	}
}
