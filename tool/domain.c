// SPDX-License-Identifier: GPL-2.0-only
#include "domain.h"

#include <errno.h>
#include <stdlib.h>

int domain_each(struct dev *d, const struct tool *t,
		int (*fn)(const struct tool *t, struct dev *d, const struct ect_domain *dom))
{
	struct ect_master m;
	struct numbers sel;
	int ret = 0;

	if (dev_master(d, &m))
		return 1;
	if (list_expand(&t->domains, m.domain_count, &sel))
		return fail("out of memory");
	dev_selected("domain", !list_all(&t->domains), sel.n);
	for (size_t i = 0; i < sel.n && !ret; i++) {
		struct ect_domain dom = { .struct_size = sizeof(dom) };
		int err = ect_domain_read(d->h, sel.v[i], &dom);

		if (err == -ENOENT)
			break;	/* the application has exited */
		if (err)
			ret = dev_fail(d, err, "Master%u: cannot read the state of domain %u",
				       d->master, sel.v[i]);
		else
			ret = fn(t, d, &dom);
	}
	numbers_free(&sel);
	return ret;
}

int domain_data(struct dev *d, const struct ect_domain *dom, u8 **data, size_t *size)
{
	u8 *buf = calloc(1, dom->size + 1u);
	long n;

	if (!buf)
		return fail("out of memory");
	n = ect_domain_data(d->h, dom->index, buf, dom->size);
	if (n < 0) {
		free(buf);
		return dev_fail(d, (int)n, "Master%u: cannot read the data of domain %u", d->master,
				dom->index);
	}
	*data = buf;
	*size = (size_t)n;
	return 0;
}
