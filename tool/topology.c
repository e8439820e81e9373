// SPDX-License-Identifier: GPL-2.0-only
/* The tree of the library, by ring position. */
#include "topology.h"

#include <stdlib.h>

/**
 * topo_build() - find the tree of the slaves
 * @t: to fill, ended by topo_free() also after a failure
 * @all: slaves of the master, by ring position
 *
 * Return: 0, or 1 after printing that there is no memory.
 */
int topo_build(struct topo *t, const struct slaves *all)
{
	const struct ect_node *n;

	*t = (struct topo){ .n = all->n };
	t->node = calloc(all->n + 1, sizeof(*t->node));
	if (!t->node || ect_topology(all->list, &t->order, &t->way))
		return fail("out of memory");
	for (size_t i = 0; (n = ect_list_get(t->order, i)); i++)
		t->node[n->slave] = n;
	return 0;
}

void topo_free(struct topo *t)
{
	free(t->node);
	ect_list_free(t->order);
	ect_list_free(t->way);
}
