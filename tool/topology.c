// SPDX-License-Identifier: GPL-2.0-only
/*
 * The tree of the slaves from the ports that the scan has found. A slave passes a frame from its
 * ports 0, 3, 1, 2 to the next of them, so a frame visits the slaves behind a port before those
 * behind the next one. The module may report anything: each slave is visited once.
 */
#include "topology.h"

#include <stdlib.h>

/* a step of the walk: the frame arrives at @slave, from upstream or from a branch */
struct step {
	u32 slave;
	u8 port;
	bool back;
};

struct walk {
	const struct slaves *all;
	struct topo *t;
	bool *seen;
	struct step *stack;
	size_t depth;
};

/**
 * topo_peer() - find the other end of a cable
 * @all: slaves of the master
 * @slave: one of them
 * @port: its port
 * @peer: slave at the other end
 * @peer_port: its port, EC_UAPI_PORTS: not known
 *
 * Return: false if no slave is there.
 */
bool topo_peer(const struct slaves *all, unsigned int slave, unsigned int port, u32 *peer,
	       unsigned int *peer_port)
{
	unsigned int p = 0;

	*peer = all->v[slave].ports[port].next_slave;
	if (*peer >= all->n || *peer == slave)
		return false;
	while (p < EC_UAPI_PORTS && all->v[*peer].ports[p].next_slave != slave)
		p++;
	*peer_port = p;
	return true;
}

/* the first open port without a slave; otherwise 0 */
static u8 entry_port(const struct slave *s)
{
	for (u8 p = 0; p < EC_UAPI_PORTS; p++)
		if (s->ports[p].signal && !s->ports[p].loop_closed &&
		    s->ports[p].next_slave == EC_UAPI_NONE16)
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
	static const u8 next[EC_UAPI_PORTS] = { 3, 2, 0, 1 };
	struct topo_node *n = &w->t->node[at];
	u8 ports[EC_UAPI_PORTS];
	unsigned int count = 0, peer_port;
	u32 peer;

	for (u8 p = next[n->port]; p != n->port; p = next[p]) {
		if (!topo_peer(w->all, at, p, &peer, &peer_port) || w->seen[peer])
			continue;
		w->seen[peer] = true;
		w->t->node[peer] = (struct topo_node){
			.parent = at, .parent_port = p, .depth = n->depth + 1, .last = true,
			.port = (u8)(peer_port < EC_UAPI_PORTS ? peer_port : 0),
		};
		ports[count++] = p;
	}
	n->last = !count;
	for (unsigned int i = count; i-- > 0;) {
		topo_peer(w->all, at, ports[i], &peer, &peer_port);
		/* the last one continues the line */
		if (i == count - 1)
			w->t->node[peer].depth = n->depth;
		push(w, at, ports[i], true);
		push(w, peer, w->t->node[peer].port, false);
	}
}

static void visit(struct walk *w, u32 root, size_t *placed)
{
	struct topo *t = w->t;

	w->seen[root] = true;
	t->node[root] = (struct topo_node){
		.parent = TOPO_MASTER, .port = entry_port(&w->all->v[root]), .last = true,
		.device = !!w->all->v[root].device_index,
	};
	push(w, root, t->node[root].port, false);
	while (w->depth) {
		struct step s = w->stack[--w->depth];

		t->rx[t->rx_n++] = (struct topo_rx){ s.slave, s.port };
		if (s.back)
			continue;
		t->order[(*placed)++] = s.slave;
		branches(w, s.slave);
	}
}

/*
 * The slave at the master has an open port behind which no slave is; it is not slave 0 if the
 * master is at a later port than the first. Slave 0 if there is none.
 */
static u32 first_slave(const struct slaves *all)
{
	for (size_t i = 0; i < all->n; i++) {
		u8 p = entry_port(&all->v[i]);
		const struct ec_ioc_port *x = &all->v[i].ports[p];

		if (x->signal && !x->loop_closed && x->next_slave == EC_UAPI_NONE16)
			return (u32)i;
	}
	return 0;
}

/**
 * topo_build() - find the tree of the slaves
 * @t: to fill, ended by topo_free() also after a failure
 * @all: slaves of the master, by ring position
 *
 * Slaves without connection to the first one are further trees at the master: those at its
 * backup device, for example.
 *
 * Return: 0, or 1 after printing that there is no memory.
 */
int topo_build(struct topo *t, const struct slaves *all)
{
	struct walk w = { .all = all, .t = t };
	size_t placed = 0;
	int ret = 0;

	*t = (struct topo){ .n = all->n };
	t->node = calloc(all->n + 1, sizeof(*t->node));
	t->order = calloc(all->n + 1, sizeof(*t->order));
	t->rx = calloc(2 * all->n + 1, sizeof(*t->rx));
	w.seen = calloc(all->n + 1, sizeof(*w.seen));
	w.stack = calloc(2 * all->n + 1, sizeof(*w.stack));
	if (!t->node || !t->order || !t->rx || !w.seen || !w.stack) {
		ret = fail("out of memory");
	} else if (all->n) {
		visit(&w, first_slave(all), &placed);
		for (u32 i = 0; i < all->n; i++)
			if (!w.seen[i])
				visit(&w, i, &placed);
	}
	free(w.seen);
	free(w.stack);
	return ret;
}

void topo_free(struct topo *t)
{
	free(t->node);
	free(t->order);
	free(t->rx);
}
