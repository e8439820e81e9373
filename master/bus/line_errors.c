// SPDX-License-Identifier: GPL-2.0-only
/*
 * Cables that begin to fail. Each controller counts the frames that come damaged to its ports: the
 * first one behind the damage as invalid, those after it as forwarded errors (0x0300 to 0x030B).
 * The monitor reads the counters of some slaves once a second, one slave after the other, and
 * reports a cable when the counts of one of its ends grow too fast.
 *
 * What a link that comes or goes adds to the counters is not counted. One that has fallen was
 * cleared by another program or by power and counts from 0. The master clears full ones: by a
 * datagram that reads and writes, so no error is lost between the two.
 */
#include <linux/ktime.h>
#include <linux/module.h>
#include <linux/slab.h>
#include "../carry/xfer.h"
#include "graph.h"
#include "line_errors.h"
#include "slave.h"

#define TURN_NS		(900 * NSEC_PER_MSEC)	/* the monitor comes once a second at least */
#define PERIOD_NS	(10ULL * NSEC_PER_SEC)	/* for which the limit is */
#define SHORTEST_NS	(8ULL * NSEC_PER_SEC)	/* after it the end of a round ends a period */
#define ROUND_TURNS	5	/* turns to read all slaves of a small bus */
#define TURN_SLAVES	10	/* most slaves of a turn, but */
#define LONGEST_TURNS	60	/* a round has no more turns than that */
#define CALM		6	/* periods without an error, then a cable is reported again */
#define AFTER		3	/* periods in which damaged frames may show further on */
#define FULL		0xff
#define MAX_LIMIT	250	/* above, a full counter would hide it */

unsigned int ec_line_errors_limit = 10;

static int set_limit(const char *value, const struct kernel_param *kp)
{
	return param_set_uint_minmax(value, kp, 0, MAX_LIMIT);
}

static const struct kernel_param_ops limit_ops = {
	.set = set_limit,
	.get = param_get_uint,
};

module_param_cb(line_errors, &limit_ops, &ec_line_errors_limit, 0644);
MODULE_PARM_DESC(line_errors,
		 "Errors of a cable in 10 s from which on it is reported, up to 250; 0: error counters are not read (10)");

#define AT(reg)		EC_LINE_AT(reg)

static u16 links_of(const struct ec_slave *s)
{
	return s->dl_seen ?: s->dl_status;
}

/* The neighbor at a port, and the port there. */
static struct ec_slave *far_end(const struct ec_slave *s, unsigned int port, unsigned int *far)
{
	struct ec_slave *next = s->graph.at[port];

	if (next)
		*far = port == s->graph.upstream ? s->graph.parent_port : next->graph.upstream;
	return next;
}

static void line_forget(struct ec_line_errors *e)
{
	unsigned int p;

	memset(e->port, 0, sizeof(e->port));
	for (p = 0; p < EC_MAX_PORT; p++)
		e->port[p].calm = CALM;
}

static struct ec_line_errors *make(struct ec_slave *s)
{
	struct ec_line_errors *e = s->lines;

	if (e)
		return e;
	e = kzalloc(sizeof(*e), GFP_KERNEL);
	if (e)
		e->bytes = EC_ERRORS_SIZE;
	/* zeros in it before the pointer is seen */
	smp_store_release(&s->lines, e);
	return e;
}

static bool has_fallen(const struct ec_line_errors *e, const u8 *now)
{
	unsigned int i;

	for (i = 0; i < EC_LINE_RX_BYTES; i++)
		if (now[i] < e->regs[i])
			return true;
	return false;
}

/* A full counter hides what comes. */
static bool is_full(const u8 *regs)
{
	return memchr(regs, FULL, EC_LINE_RX_BYTES);
}

/* Did the link of a port come or go since the last read? */
static bool link_has_changed(const struct ec_slave *s, const u8 *now, unsigned int port)
{
	const struct ec_line_errors *e = s->lines;
	u16 bits = EC_DLS_LINK(port) | EC_DLS_COMM(port) | EC_DLS_LOOP(port);

	return e->links != s->bus->line_watch.links || (e->dl ^ links_of(s)) & bits ||
	       now[AT(EC_REG_ERR_LOST(port))] != e->regs[AT(EC_REG_ERR_LOST(port))];
}

static void void_cleared(struct ec_line_errors *e)
{
	if (READ_ONCE(e->void_cleared)) {
		memset(e->cleared, 0, sizeof(e->cleared));
		/* zeros before they are shown */
		smp_store_release(&e->void_cleared, false);
	}
}

/* By other than this master: the counters contain all there is since then. */
static void note_cleared(struct ec_slave *s)
{
	struct ec_line_errors *e = s->lines;
	unsigned int i;

	if (e->emptying) {
		for (i = 0; i < EC_LINE_RX_BYTES; i++)
			e->cleared[i] += e->regs[i];
	} else {
		ec_slave_dbg(s, 1, "error counters cleared by another program, or by power\n");
		memset(e->cleared, 0, sizeof(e->cleared));
	}
	e->kept = false;
	memset(e->regs, 0, EC_LINE_RX_BYTES);
}

/* @link: its link has changed, which makes errors before and after it counts as lost */
static void count_port(struct ec_line_errors *e, const u8 *now, unsigned int p, bool link)
{
	unsigned int rx = AT(EC_REG_ERR_RX(p)), phy = AT(EC_REG_ERR_PHY(p));
	unsigned int fwd = AT(EC_REG_ERR_FWD(p));
	struct ec_line_port *port = &e->port[p];

	port->noise |= now[rx] != e->regs[rx] || now[phy] != e->regs[phy] ||
		       now[fwd] != e->regs[fwd] || now[rx] == FULL || now[fwd] == FULL;
	if (!link) {
		port->crc += port->crc_new;
		port->phy += port->phy_new;
	}
	port->crc_new = link ? 0 : now[rx] - e->regs[rx];
	port->phy_new = link ? 0 : now[phy] - e->regs[phy];
}

static void count(struct ec_slave *s, const u8 *now)
{
	struct ec_line_errors *e = s->lines;
	bool link[EC_MAX_PORT];
	unsigned int p;

	for (p = 0; p < EC_MAX_PORT; p++)
		link[p] = link_has_changed(s, now, p);
	if (has_fallen(e, now))
		note_cleared(s);
	for (p = 0; p < EC_MAX_PORT; p++)
		count_port(e, now, p, link[p]);
	memcpy(e->regs, now, sizeof(e->regs));
}

/*
 * Clear the full counters of a slave, as one write clears those of all ports. The reply has the
 * counts before the write, unless the controller cannot read and write at once.
 */
static void empty(struct ec_slave *s)
{
	struct ec_line_errors *e = s->lines;
	bool both = !(ec_slave_features(s) & EC_FEAT_NO_RW);
	u16 n = min_t(u16, e->bytes, EC_LINE_RX_BYTES);
	u8 old[EC_LINE_RX_BYTES] = { 0 }, after[EC_LINE_RX_BYTES] = { 0 };
	struct ec_dg dg[] = {
		EC_DG(both ? EC_CMD_FPRW : EC_CMD_FPWR, s->station, EC_REG_ERRORS, n, old),
		EC_FPRD(s->station, EC_REG_ERRORS, n, after),
	};
	unsigned int i;

	dg[0].repeat = false;
	dg[1].repeat = false;
	e->emptying = true;
	if (ec_xfer_urgent(s->bus->links, dg, ARRAY_SIZE(dg)) || !dg[0].wkc || dg[1].wkc != 1)
		return;
	e->emptying = false;
	e->kept = is_full(after);
	if (e->kept)
		return;
	void_cleared(e);
	for (i = 0; i < n; i++) {
		unsigned int p = i < AT(EC_REG_ERR_FWD(0)) ? i / 2 : i - AT(EC_REG_ERR_FWD(0));
		u8 more = both && old[i] > e->regs[i] ? old[i] - e->regs[i] : 0;

		if (i < AT(EC_REG_ERR_FWD(0)) && i & 1)
			e->port[p].phy_new += more;
		else if (i < AT(EC_REG_ERR_FWD(0)))
			e->port[p].crc_new += more;
		/* another one may have cleared them just before */
		WRITE_ONCE(e->cleared[i], e->cleared[i] + (both ? old[i] : e->regs[i]));
		e->regs[i] = 0;
	}
}

static u64 parent_of(const struct ec_slave *s)
{
	const struct ec_slave *parent = ec_graph_parent(s);

	return parent ? parent->device : 0;
}

/* Take the counters as read; those of the first read count for nothing. */
static void line_take(struct ec_slave *s, const struct ec_dg *dg, const u8 *now)
{
	struct ec_line_errors *e = s->lines;
	u64 t = ktime_get_ns();

	if (dg->err)
		return;
	void_cleared(e);
	if (dg->wkc != 1) {
		/* not all of these registers exist, or it is away: all of them are next then */
		e->bytes = e->bytes == EC_ERRORS_SIZE ? EC_LINE_RX_BYTES :
			   e->bytes == EC_LINE_RX_BYTES ? AT(EC_REG_ERR_FWD(0)) : EC_ERRORS_SIZE;
		e->known = false;
		return;
	}
	if (e->known && e->parent == parent_of(s)) {
		count(s, now);
		e->to_ns = e->read_ns;
	} else {
		line_forget(e);
		memcpy(e->regs, now, sizeof(e->regs));
		e->from_ns = t;
		e->to_ns = t;
		e->known = true;
	}
	e->read_ns = t;
	e->links = s->bus->line_watch.links;
	e->dl = links_of(s);
	e->parent = parent_of(s);
	e->emptying = false;
	if (is_full(now) && !e->kept)
		empty(s);
	ec_line_errors_show(e);
}

/* Are the counts of a period above the limit? */
static bool is_above(u32 n, u64 ns)
{
	u32 limit = READ_ONCE(ec_line_errors_limit);

	return limit && n * PERIOD_NS >= limit * max(ns, PERIOD_NS);
}

/*
 * Invalid frames that a cable has damaged. A controller without counters of forwarded errors
 * counts those that came damaged as well: then no port may have counted any before it in the ring,
 * also not in the periods around, since the counters are read one after the other.
 */
static u16 own_crc(const struct ec_slave *s, unsigned int port, bool noise, u64 *ns)
{
	const struct ec_line_errors *e = s->lines;

	*ns = e->to_ns - e->from_ns;
	if (ec_slave_features(s) & EC_FEAT_FCS_SEPARATE)
		return e->port[port].crc;
	*ns = e->before_ns;
	return noise ? 0 : e->port[port].crc_before;
}

static const char *label(const struct ec_slave *s)
{
	const char *l = ec_slave_label(s);

	return *l ? l : NULL;
}

static void line_report(const struct ec_slave *s, unsigned int port, u16 crc, u16 phy, u64 ns)
{
	unsigned int far = 0;
	const struct ec_slave *next = far_end(s, port, &far);
	struct ec_event_more more = { .name = label(s), .last = next ? label(next) : NULL };
	bool main = !next && port == s->graph.upstream;

	ec_report_more(s->bus->base, EC_EVENT_LINE_ERRORS, s->position, &more, port, crc, phy,
		       (u32)div64_u64(ns + NSEC_PER_SEC / 2, NSEC_PER_SEC),
		       next ? next->position : EC_EVENT_NONE, far, main);
}

/* A port at which frames arrive, or none do; @noise: a port before it in the ring has counted. */
static void judge_port(struct ec_slave *s, unsigned int port, bool noise)
{
	struct ec_line_port *p = &s->lines->port[port], *other = NULL;
	u64 crc_ns, phy_ns = s->lines->to_ns - s->lines->from_ns;
	u16 crc = own_crc(s, port, noise, &crc_ns);
	unsigned int far;
	struct ec_slave *next = far_end(s, port, &far);

	if (next && next->lines)
		other = &next->lines->port[far];
	if (!is_above(crc, crc_ns) && !is_above(p->phy, phy_ns))
		return;
	if (!p->reported && !(other && other->reported))
		line_report(s, port, crc, p->phy, is_above(crc, crc_ns) ? crc_ns : phy_ns);
	p->reported = true;
}

/* All ports at which frames arrive, in the order in which they do. */
static void judge_ring(struct ec_slave *s)
{
	unsigned int port = s->graph.upstream, left = 2 * s->bus->n_slaves;
	bool noise = false;

	do {
		if (!s->lines || !s->lines->known)
			continue;
		judge_port(s, port, noise);
		noise |= s->lines->port[port].noise || s->lines->port[port].calm < AFTER;
	} while (left-- && ec_graph_next_arrival(&s, &port));
}

/* The next period begins. */
static void turn_over(struct ec_slave *s)
{
	struct ec_line_errors *e = s->lines;
	unsigned int p;

	for (p = 0; p < EC_MAX_PORT; p++) {
		struct ec_line_port *port = &e->port[p];

		port->calm = port->noise ? 0 : min(port->calm + 1, CALM);
		port->reported &= port->calm < CALM;
		port->crc_before = port->crc;
		port->crc = 0;
		port->phy = 0;
		port->noise = false;
	}
	e->before_ns = e->to_ns - e->from_ns;
	e->from_ns = e->to_ns;
}

static void judge(struct ec_bus *bus)
{
	unsigned int p;

	ec_for_each_slave(s, bus) {
		if (!ec_graph_parent(s))
			judge_ring(s);
		for (p = 0; s->lines && p < EC_MAX_PORT; p++)
			if (p != s->graph.upstream && !s->graph.at[p])
				judge_port(s, p, true);
	}
	ec_for_each_slave(s, bus)
		if (s->lines)
			turn_over(s);
}

/* The slaves of this turn: from @next on, up to the last one. */
static void read_some(struct ec_bus *bus, unsigned int n)
{
	struct ec_line_watch *w = &bus->line_watch;
	struct ec_dg *dg = kvcalloc(n, sizeof(*dg), GFP_KERNEL);
	u8 (*regs)[EC_ERRORS_SIZE] = kvcalloc(n, sizeof(*regs), GFP_KERNEL);
	struct ec_slave **of = kvcalloc(n, sizeof(*of), GFP_KERNEL);
	unsigned int i, k = 0;

	for (i = 0; dg && regs && of && i < n && w->next < bus->n_slaves; i++, w->next++) {
		struct ec_slave *s = bus->slaves[w->next];

		if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED ||
		    READ_ONCE(s->reply.silent) || !make(s))
			continue;
		of[k] = s;
		dg[k] = EC_FPRD(s->station, EC_REG_ERRORS, s->lines->bytes, regs[k]);
		dg[k++].repeat = false;
	}
	if (k && ec_xfer(bus->links, dg, k) != -ENOMEM)
		for (i = 0; i < k; i++)
			line_take(of[i], &dg[i], regs[i]);
	kvfree(dg);
	kvfree(regs);
	kvfree(of);
}

/**
 * ec_line_errors_look() - read the error counters of some slaves, report cables that damage frames
 * @bus: bus, scanned, while nothing else is to be done
 * @links_changed: a port of some slave has got or lost its link since the last call
 *
 * One frame each second, of 10 slaves at most if they are up to 600. A cable is reported once,
 * until it was without errors for 6 periods of 10 s.
 *
 * Context: The monitor thread. Waits for bus traffic once a second.
 */
void ec_line_errors_look(struct ec_bus *bus, bool links_changed)
{
	struct ec_line_watch *w = &bus->line_watch;
	unsigned int n = bus->n_slaves;
	u64 now = ktime_get_ns();

	w->links += links_changed;
	if (!READ_ONCE(ec_line_errors_limit) || !n || now - w->turn_ns < TURN_NS)
		return;
	w->turn_ns = now;
	read_some(bus, max(min(DIV_ROUND_UP(n, ROUND_TURNS), TURN_SLAVES),
			   DIV_ROUND_UP(n, LONGEST_TURNS)));
	if (w->next < n)
		return;
	w->next = 0;
	if (now - w->period_ns < SHORTEST_NS)
		return;
	w->period_ns = now;
	judge(bus);
}
