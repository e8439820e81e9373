// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * The tree of the slaves from the ports that the scan has found. A slave passes a frame from its
 * ports 0, 3, 1, 2 to the next of them, so a frame visits the slaves behind a port before those
 * behind the next one. The module may report anything: each slave is visited once.
 */
#include <stdlib.h>

#include "internal.h"

/* a step of the walk: the frame arrives at @slave, from upstream or from a branch */
struct step {
	u32 slave;
	u8 port;
	bool back;
};

struct walk {
	const struct ect_list *all;
	struct ect_node *node;		/* by ring position */
	struct ect_list *nodes;
	struct ect_list *way;
	bool *seen;
	bool failed;
	struct step *stack;
	size_t depth;
};

static const struct ect_slave *slave_of(const struct ect_list *all, size_t i)
{
	return ect_list_at(all, i);
}

int ect_peer(const struct ect_list *slaves, unsigned int slave, unsigned int port, uint32_t *peer,
	     uint32_t *peer_port)
{
	u32 p = 0;

	if (slave >= slaves->n || port >= ECT_PORTS)
		return 0;
	*peer = slave_of(slaves, slave)->ports[port].next_slave;
	if (*peer >= slaves->n || *peer == slave)
		return 0;
	while (p < ECT_PORTS && slave_of(slaves, *peer)->ports[p].next_slave != slave)
		p++;
	*peer_port = p;
	return 1;
}

/* the first open port without a slave; otherwise 0 */
static u8 entry_port(const struct ect_slave *s)
{
	for (u8 p = 0; p < ECT_PORTS; p++)
		if (s->ports[p].signal && !s->ports[p].loop_closed &&
		    s->ports[p].next_slave == ECT_NONE16)
			return p;
	return 0;
}

static void push(struct walk *w, u32 slave, u8 port, bool back)
{
	w->stack[w->depth++] = (struct step){ .slave = slave, .port = port, .back = back };
}

/* The slaves behind the other ports; pushed in reverse, since the last is the first out. */
static void branches(struct walk *w, u32 at)
{
	static const u8 next[ECT_PORTS] = { 3, 2, 0, 1 };
	struct ect_node *n = &w->node[at];
	u8 ports[ECT_PORTS];
	unsigned int count = 0;
	u32 peer, peer_port;

	for (u8 p = next[n->port]; p != n->port; p = next[p]) {
		if (!ect_peer(w->all, at, p, &peer, &peer_port) || w->seen[peer])
			continue;
		w->seen[peer] = true;
		w->node[peer] = (struct ect_node){
			.slave = peer, .parent = at, .parent_port = p, .depth = n->depth + 1,
			.last = true,
			.port = peer_port < ECT_PORTS ? peer_port : 0,
		};
		ports[count++] = p;
	}
	n->last = !count;
	for (unsigned int i = count; i-- > 0;) {
		ect_peer(w->all, at, ports[i], &peer, &peer_port);
		/* the last one continues the line */
		if (i == count - 1)
			w->node[peer].depth = n->depth;
		push(w, at, ports[i], true);
		push(w, peer, (u8)w->node[peer].port, false);
	}
}

/* nodes are added in the order of the walk, a slave once its branches are known */
static void visit(struct walk *w, u32 root)
{
	w->seen[root] = true;
	w->node[root] = (struct ect_node){
		.slave = root, .parent = ECT_NONE32, .port = entry_port(slave_of(w->all, root)),
		.last = true, .device = !!slave_of(w->all, root)->device_index,
	};
	push(w, root, (u8)w->node[root].port, false);
	while (w->depth) {
		struct step s = w->stack[--w->depth];
		struct ect_arrival *a = ect_list_add(w->way);
		struct ect_node *n;

		w->failed |= !a;
		if (a)
			a->slave = s.slave, a->port = s.port;
		if (s.back)
			continue;
		branches(w, s.slave);
		n = ect_list_add(w->nodes);
		w->failed |= !n;
		if (n)
			n->slave = s.slave;
	}
}

/*
 * The slave at the master has an open port behind which no slave is; it is not slave 0 if the
 * master is at a later port than the first. Slave 0 if there is none.
 */
static u32 first_slave(const struct ect_list *all)
{
	for (size_t i = 0; i < all->n; i++) {
		u8 p = entry_port(slave_of(all, i));
		const struct ect_port *x = &slave_of(all, i)->ports[p];

		if (x->signal && !x->loop_closed && x->next_slave == ECT_NONE16)
			return (u32)i;
	}
	return 0;
}

static void walk_all(struct walk *w)
{
	size_t n = w->all->n;

	if (!n)
		return;
	visit(w, first_slave(w->all));
	for (u32 i = 0; i < n; i++)
		if (!w->seen[i])
			visit(w, i);
	/* the depth of the last branch has changed after its slave was placed */
	for (size_t i = 0; i < w->nodes->n; i++) {
		struct ect_node *to = ect_list_at(w->nodes, i);
		u32 size = to->struct_size;

		*to = w->node[to->slave];
		to->struct_size = size;
	}
}

int ect_topology(const struct ect_list *slaves, struct ect_list **nodes, struct ect_list **way)
{
	size_t n = slaves->n;
	struct walk w = {
		.all = slaves, .node = calloc(n + 1, sizeof(*w.node)),
		.nodes = ect_list_new(sizeof(struct ect_node)),
		.way = ect_list_new(sizeof(struct ect_arrival)),
		.seen = calloc(n + 1, sizeof(*w.seen)),
		.stack = calloc(2 * n + 1, sizeof(*w.stack)),
	};

	w.failed = !w.node || !w.nodes || !w.way || !w.seen || !w.stack;
	if (!w.failed)
		walk_all(&w);
	free(w.node);
	free(w.seen);
	free(w.stack);
	if (w.failed || !way)
		ect_list_free(w.way);
	else
		*way = w.way;
	if (w.failed)
		ect_list_free(w.nodes);
	else
		*nodes = w.nodes;
	return w.failed ? -ENOMEM : 0;
}
