// SPDX-License-Identifier: LGPL-2.1-or-later
/* What tools call the values: a bus file of the configurations, in their order. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "load.h"

#define NAMES_MAX	(4U << 20)	/* of ecrt_master_set_names() */

static int write_text(const struct load *l, struct ecb_slave **slaves, char **text, size_t *size)
{
	struct ecb_master m = {
		.index = l->want->index, .slaves = slaves, .slave_count = l->n_configs,
	};
	struct ecb_master *masters = &m;
	const struct ecb_bus bus = {
		.ethercat = ECB_VERSION, .masters = &masters, .master_count = 1,
	};
	FILE *f = open_memstream(text, size);
	int err;

	if (!f)
		return -ENOMEM;
	err = ecb_file_write(&bus, f);
	return fclose(f) || err ? -ENOMEM : 0;
}

/* what a value is called, and its type and unit; not how the slave is found and configured */
static void describe(const struct plan *p, struct ecb_slave *to)
{
	*to = (struct ecb_slave){
		.name = p->s->name, .type = p->s->type, .vendor = p->s->vendor,
		.product = p->s->product, .port = ECB_NONE8,
		.pdos = (struct ecb_pdo **)p->pdos, .pdo_count = p->n_pdos,
	};
}

int load_publish_names(struct load *l)
{
	struct ecb_slave *copies = calloc(l->n_configs + 1, sizeof(*copies));
	struct ecb_slave **slaves = calloc(l->n_configs + 1, sizeof(*slaves));
	char *text = NULL;
	size_t size = 0;
	int ret = copies && slaves ? 0 : -ENOMEM;

	for (size_t i = 0; i < l->want->slave_count && !ret; i++) {
		struct plan *p = &l->plans[i];

		if (p->omitted)
			continue;
		describe(p, &copies[p->config]);
		slaves[p->config] = &copies[p->config];
	}
	if (!ret)
		ret = write_text(l, slaves, &text, &size);
	if (ret)
		load_no_memory(l);
	/* with more of them tools show the names that slaves give */
	else if (size <= NAMES_MAX)
		ret = l->calls->names(l->m, text, size);
	/* nor with an older module, or without memory for them: they are for tools only */
	if (ret == -ENOTTY || ret == -EDQUOT)
		ret = 0;
	if (ret && ret != -ENOMEM)
		load_failed(l, 0, ret, "cannot set the names of values");
	free(text);
	free(copies);
	free(slaves);
	return ret;
}
