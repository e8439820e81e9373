// SPDX-License-Identifier: GPL-2.0-only
/*
 * Error counters at two times, and the segments where they have grown. A slave counts a damaged
 * frame as invalid where the damage is noticed first, and as forwarded error further on.
 */
#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "crc_table.h"
#include "out.h"
#include "topology.h"

#define FULL	255	/* a counter stops there */

/**
 * struct span - two readings of the counters
 * @all: slaves of the master
 * @shown: whether a slave is selected and replies, by ring position
 * @mute: whether its counters could not be read
 * @begin: counters of each slave
 * @end: likewise, later
 * @seconds: between them
 * @frames: sent by the master between them
 */
struct span {
	struct slaves all;
	bool *shown;
	bool *mute;
	struct ect_errors *begin;
	struct ect_errors *end;
	double seconds;
	u64 frames;
};

struct growth {
	unsigned int crc, phy, fwd, lost;
};

static volatile sig_atomic_t interrupted;

static void interrupt(int signal)
{
	(void)signal;
	interrupted = 1;
}

/* counters are cleared together, so one that has fallen counts from 0 */
static unsigned int grown(u8 begin, u8 end)
{
	return end >= begin ? end - begin : end;
}

static struct growth growth(const struct span *w, u32 slave, unsigned int port)
{
	const struct ect_errors *b = &w->begin[slave], *e = &w->end[slave];

	if (w->mute[slave])
		return (struct growth){ 0 };
	return (struct growth){
		.crc = grown(err_rx(b, port), err_rx(e, port)),
		.phy = grown(err_phy(b, port), err_phy(e, port)),
		.fwd = grown(err_fwd(b, port), err_fwd(e, port)),
		.lost = grown(err_lost(b, port), err_lost(e, port)),
	};
}

static void end_of_segment(const char *slave_key, const char *port_key, u32 slave,
			   unsigned int port)
{
	if (slave == ECT_NONE32) {
		out_null(slave_key, "the master");
		out_null(port_key, NULL);
		return;
	}
	out_u(slave_key, slave, "slave %u", slave);
	out_u(port_key, port, " port %u", port);
}

static void counts(const struct growth *g)
{
	out_u("invalid_frames", g->crc, ": %u invalid frame(s)", g->crc);
	out_u("receiver_errors", g->phy, ", %u receiver error(s)", g->phy);
	out_u("lost_links", g->lost, ", %u lost link(s)\n", g->lost);
}

/* between a slave and what is upstream of it; the counters of both ends are about one cable */
static bool segment(const struct span *w, const struct ect_node *n, u32 slave)
{
	struct growth g = growth(w, slave, n->port);

	if (n->parent != ECT_NONE32) {
		struct growth up = growth(w, n->parent, n->parent_port);

		g.crc += up.crc;
		g.phy += up.phy;
		g.lost += up.lost;
	}
	if (!g.crc && !g.phy && !g.lost)
		return false;
	out_object(NULL);
	out_text("Errors grow between ");
	end_of_segment("slave", "port", n->parent, n->parent_port);
	out_text(" and ");
	end_of_segment("to_slave", "to_port", slave, n->port);
	counts(&g);
	out_end();
	return true;
}

/* whether @port of a slave has a cable to another one or to the master */
static bool connected(const struct span *w, const struct topo *t, u32 slave, unsigned int port)
{
	u32 peer, peer_port;

	return port == t->node[slave]->port ||
	       ect_peer(w->all.list, slave, port, &peer, &peer_port);
}

static bool open_end(const struct span *w, u32 slave, unsigned int port)
{
	struct growth g = growth(w, slave, port);

	if (!g.crc && !g.phy && !g.lost)
		return false;
	out_object(NULL);
	out_text("Errors grow at ");
	end_of_segment("slave", "port", slave, port);
	out_text(", where no slave is connected");
	out_null("to_slave", NULL);
	out_null("to_port", NULL);
	counts(&g);
	out_end();
	return true;
}

static unsigned int segments(const struct span *w, const struct topo *t)
{
	unsigned int n = 0;

	out_array("segments");
	for (size_t i = 0; i < t->n; i++) {
		const struct ect_node *node = ect_list_get(t->order, i);
		u32 at = node->slave;

		n += segment(w, node, at);
		for (unsigned int p = 0; p < ECT_PORTS; p++)
			if (!connected(w, t, at, p))
				n += open_end(w, at, p);
	}
	out_end();
	return n;
}

/* the port at which a frame arrives first of those with new forwarded errors */
static const struct ect_arrival *first_forwarded(const struct span *w, const struct topo *t)
{
	const struct ect_arrival *a;

	for (size_t i = 0; (a = ect_list_get(t->way, i)); i++)
		if (growth(w, a->slave, a->port).fwd)
			return a;
	return NULL;
}

static void verdict(const struct span *w, const struct topo *t)
{
	unsigned int n = segments(w, t);
	const struct ect_arrival *rx = first_forwarded(w, t);

	if (n > 1)
		out_text("Repair the first of these %u segments first: a frame passes it first.\n", n);
	if (n || !rx) {
		out_null("forwarded_at", NULL);
	} else {
		out_object("forwarded_at");
		out_text("Only forwarded errors grow, first at ");
		end_of_segment("slave", "port", rx->slave, rx->port);
		out_text(": frames are damaged upstream of this port, where no counter grows\n");
		out_end();
	}
	if (!n && !rx)
		out_text("No error counter of a port has grown in %.1f s (%llu frames).\n",
			 w->seconds, (unsigned long long)w->frames);
}

/* what a difference of two readings cannot show */
static void doubts(const struct dev *d, const struct span *w)
{
	for (size_t i = 0; i < w->all.n; i++) {
		const struct ect_errors *b = &w->begin[i], *e = &w->end[i];
		bool full = false, cleared = false;

		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			full |= err_rx(b, p) == FULL || err_phy(b, p) == FULL ||
				err_fwd(b, p) == FULL || err_lost(b, p) == FULL;
			cleared |= err_rx(e, p) < err_rx(b, p) || err_phy(e, p) < err_phy(b, p) ||
				   err_fwd(e, p) < err_fwd(b, p);
		}
		if (w->mute[i])
			continue;
		if (cleared)
			note("Master%u slave %zu: counters were cleared meanwhile and count from 0",
			     d->master, i);
		else if (full)
			note("Master%u slave %zu: a counter is at its limit of 255, clear it first",
			     d->master, i);
	}
}

/* One that does not reply may be what is wrong: the others count nevertheless. */
static int read_all(struct dev *d, struct span *w, struct ect_errors *regs)
{
	bool any = false;

	for (size_t i = 0; i < w->all.n; i++) {
		if (!w->mute[i] && errors_read(d, &w->all.v[i], &regs[i])) {
			w->mute[i] = true;
			w->shown[i] = false;
		}
		any |= !w->mute[i];
	}
	return any ? 0 : 1;
}

static int any_mute(const struct span *w)
{
	for (size_t i = 0; i < w->all.n; i++)
		if (w->mute[i])
			return 1;
	return 0;
}

static void table(const struct tool *t, const struct span *w, const char *key,
		  struct ect_errors *regs)
{
	if (t->verbosity < 0 && !out_is_json())
		return;
	crc_table_head();
	out_array(key);
	for (size_t i = 0; i < w->all.n; i++)
		if (w->shown[i])
			crc_table_row(t, &w->all.v[i], &regs[i]);
	out_end();
}

/* The same slaves at the same places, or a counter may be another one. */
static int unchanged(struct dev *d, const struct slaves *before)
{
	struct slaves now;
	int ret = 0;

	if (dev_slaves(d, &now))
		return 1;
	if (now.n != before->n)
		ret = fail("Master%u: %zu slave(s) before, %zu after; repeat the command",
			   d->master, before->n, now.n);
	for (size_t i = 0; i < now.n && !ret; i++) {
		const struct ect_slave *a = &before->v[i], *b = &now.v[i];

		if (a->station != b->station || a->vendor_id != b->vendor_id ||
		    a->product_code != b->product_code || a->serial_number != b->serial_number)
			ret = fail("Master%u slave %zu: replaced meanwhile; repeat the command",
				   d->master, i);
	}
	slaves_free(&now);
	return ret;
}

/* frames that the master has sent */
static int sent(struct dev *d, u64 *n)
{
	const struct ect_device *i;
	struct ect_list *devices;

	if (dev_devices(d, &devices))
		return 1;
	*n = 0;
	for (size_t k = 0; (i = ect_list_get(devices, k)); k++)
		*n += i->tx_frames;
	ect_list_free(devices);
	return 0;
}

/* until the time is over or the user ends it */
static int pass(struct dev *d, double seconds, struct span *w)
{
	double from = now_s();
	u64 before, after;

	if (sent(d, &before))
		return 1;
	while (!interrupted && now_s() < from + seconds)
		sleep_ms(20);
	if (sent(d, &after))
		return 1;
	w->seconds = now_s() - from;
	w->frames = after - before;
	return 0;
}

static int measure(const struct tool *t, struct dev *d, struct span *w)
{
	const struct sigaction act = { .sa_handler = interrupt };
	struct topo topo;
	int ret;

	sigaction(SIGINT, &act, NULL);
	if (read_all(d, w, w->begin))
		return 1;
	out_u("master", d->master, NULL);
	table(t, w, "begin", w->begin);
	fflush(stdout);
	if (pass(d, t->watch_s, w) || unchanged(d, &w->all) || read_all(d, w, w->end))
		return 1;
	out_f("seconds", w->seconds, NULL);
	out_u("frames", w->frames, NULL);
	if (t->verbosity >= 0)
		out_text("\nAfter %.1f s and %llu frames:\n", w->seconds,
			 (unsigned long long)w->frames);
	table(t, w, "slaves", w->end);
	if (t->verbosity >= 0)
		out_text("\n");
	ret = topo_build(&topo, &w->all);
	if (!ret) {
		verdict(w, &topo);
		doubts(d, w);
		ret = any_mute(w);
	}
	topo_free(&topo);
	return ret;
}

/**
 * crc_watch() - show where error counters grow
 * @t: command line with the time
 * @d: master, open for writing
 *
 * All slaves are read; those selected are in the tables.
 *
 * Return: exit code.
 */
int crc_watch(const struct tool *t, struct dev *d)
{
	struct span w = { 0 };
	struct slaves sel;
	int ret;

	if (dev_select(d, t, &sel, NULL))
		return 1;
	if (dev_slaves(d, &w.all)) {
		slaves_free(&sel);
		return 1;
	}
	w.shown = calloc(w.all.n + 1, sizeof(*w.shown));
	w.mute = calloc(w.all.n + 1, sizeof(*w.mute));
	w.begin = calloc(w.all.n + 1, sizeof(*w.begin));
	w.end = calloc(w.all.n + 1, sizeof(*w.end));
	for (size_t i = 0; w.shown && i < sel.n; i++)
		if (sel.v[i].position < w.all.n)
			w.shown[sel.v[i].position] = true;
	if (!w.shown || !w.mute || !w.begin || !w.end)
		ret = fail("out of memory");
	else if (!w.all.n)
		ret = dev_none_present(d);
	else if (!sel.n)
		ret = 0;	/* main() reports a selection without a slave */
	else
		ret = measure(t, d, &w);
	free(w.shown);
	free(w.mute);
	free(w.begin);
	free(w.end);
	slaves_free(&sel);
	slaves_free(&w.all);
	return ret;
}
