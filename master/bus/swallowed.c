// SPDX-License-Identifier: GPL-2.0-only
/*
 * No frame returns although the link is up: maybe a PC or a switch was connected where slaves were
 * until now. Their port closes itself without link, and opens by the first frame from outside;
 * every frame of the bus ends there from then on. Slaves before it still execute what they get, so
 * it is found by closing ports for the time of one frame, and its port is closed for good.
 */
#include <linux/mm.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../carry/xfer.h"
#include "graph.h"
#include "ports.h"
#include "slave.h"
#include "swallowed.h"

#define PROBES	2	/* pairs of frames: some may be lost for another reason */
#define CLOSES	3	/* writes that close the port: each may be lost */

/**
 * struct search - for the port behind which frames end
 * @bus: bus
 * @top: it is the port to which this slave was connected, or behind that; NULL: nothing known
 * @in: slaves behind @top that are not excluded, by position
 * @size: how many of @in are behind the port of each, with it
 */
struct search {
	struct ec_bus *bus;
	struct ec_slave *top;
	bool *in;
	u16 *size;
};

/* Can the port to which @s is connected be closed? Port 0 never is. */
static bool is_closable(const struct ec_slave *s)
{
	const struct ec_slave *up = ec_graph_parent(s);

	return up && s->graph.parent_port && !up->ports.fixed;
}

static unsigned int weigh(struct search *f)
{
	unsigned int n = 0;

	memset(f->size, 0, f->bus->n_slaves * sizeof(*f->size));
	ec_for_each_slave(s, f->bus) {
		if (!f->in[s->position])
			continue;
		n++;
		for (struct ec_slave *up = s; up && up != f->top; up = ec_graph_parent(up))
			f->size[up->position]++;
	}
	return n;
}

/* The one whose port divides the slaves that are left into halves; NULL: none is left. */
static struct ec_slave *middle(struct search *f)
{
	unsigned int n = weigh(f), best = UINT_MAX;
	struct ec_slave *found = NULL;

	ec_for_each_slave(s, f->bus) {
		unsigned int from_half = abs((int)(2 * f->size[s->position]) - (int)n);

		if (!f->in[s->position] || !is_closable(s) || from_half >= best)
			continue;
		best = from_half;
		found = s;
	}
	return found;
}

/* Does a frame return while the port to which @s is connected is closed? */
static bool returns_without(struct search *f, const struct ec_slave *s)
{
	struct ec_slave *up = ec_graph_parent(s);
	u8 closed = ec_loops_with(up->ports.loops, s->graph.parent_port, EC_LOOP_CLOSED);
	u8 open = up->ports.loops, any;
	struct ec_dg dg[] = {
		EC_FPWR(up->station, EC_REG_DL_LOOPS, 1, &closed),
		EC_FPWR(up->station, EC_REG_DL_LOOPS, 1, &closed),
		EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, &any),
		EC_FPWR(up->station, EC_REG_DL_LOOPS, 1, &open),
		EC_FPWR(up->station, EC_REG_DL_LOOPS, 1, &open),
	};
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(dg); i++)
		dg[i].last = true;
	ec_xfer_train(f->bus->links, dg, ARRAY_SIZE(dg));
	/* the replies to those that open it return only if frames do */
	up->ports.unsure |= dg[4].err || dg[4].wkc != 1;
	return !dg[2].err;
}

/* Have frames begun to return by themselves? Then it was no port. */
static bool returns_anyway(const struct search *f)
{
	struct ec_dg dg[2];
	unsigned int i;
	u8 any;

	for (i = 0; i < PROBES; i++) {
		dg[0] = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, &any);
		dg[0].last = true;
		dg[1] = dg[0];
		ec_xfer_train(f->bus->links, dg, 2);
		if (!dg[0].err || !dg[1].err)
			return true;
	}
	return false;
}

/* Keep those behind @s, without it; or all but them. */
static void restrict_to(struct search *f, struct ec_slave *s, bool behind)
{
	ec_for_each_slave(x, f->bus) {
		const struct ec_slave *up = x;

		if (!f->in[x->position])
			continue;
		while (up && up != s && up != f->top)
			up = ec_graph_parent(up);
		f->in[x->position] = (up == s) == behind && x != s;
	}
	if (behind)
		f->top = s;
}

static void find_top(struct search *f)
{
	struct ec_slave *s;

	memset(f->in, true, f->bus->n_slaves);
	while ((s = middle(f)) && !READ_ONCE(f->bus->base->stopping))
		restrict_to(f, s, returns_without(f, s));
}

static bool close_top(const struct search *f)
{
	struct ec_slave *up = ec_graph_parent(f->top);
	u8 closed = ec_loops_with(up->ports.loops, f->top->graph.parent_port, EC_LOOP_CLOSED);
	unsigned int i;
	int ret = -EIO;

	for (i = 0; i < CLOSES && ret; i++)
		ret = ec_xfer_fpwr(f->bus->links, up->station, EC_REG_DL_LOOPS, &closed, 1);
	up->ports.unsure |= ret;
	if (ret)
		return false;
	up->ports.loops = closed;
	WRITE_ONCE(up->ports.door[f->top->graph.parent_port].kept, EC_PORT_SWALLOWS);
	ec_slave_report(up, EC_EVENT_PORT_KEPT, f->top->graph.parent_port, EC_PORT_SWALLOWS);
	return true;
}

/**
 * ec_swallowed() - no frame returns: find the port behind which they end, and close it
 * @bus: bus whose ports are guarded
 *
 * Takes one train of frames per halving of the slaves.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: whether a port was closed, and frames return.
 */
bool ec_swallowed(struct ec_bus *bus)
{
	struct search f = { .bus = bus };
	bool found = false;

	f.in = kvcalloc(bus->n_slaves + 1, sizeof(*f.in), GFP_KERNEL);
	f.size = kvcalloc(bus->n_slaves + 1, sizeof(*f.size), GFP_KERNEL);
	if (f.in && f.size) {
		find_top(&f);
		found = f.top && !returns_anyway(&f) && close_top(&f);
	}
	kvfree(f.in);
	kvfree(f.size);
	return found;
}
