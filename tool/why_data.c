// SPDX-License-Identifier: GPL-2.0-only
/* Causes beyond AL states: clocks, error counters of the ports. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>

#include "../master/wire/dc.h"
#include "errors.h"
#include "sys.h"
#include "topology.h"
#include "why.h"

#define COUNTERS	"%u invalid frame(s), %u receive error(s), link lost %u time(s)"

static void clock_of(struct why *w, const struct why_config *c, const struct slave *s)
{
	struct why_finding *f;

	if (!s->dc_supported || s->dc_delay_only)
		f = why_add(w, "no_clock",
			    "remove ecrt_slave_config_dc() for this slave, or connect one with a clock",
			    "SYNC signals configured, but the slave has no distributed clock");
	else if (!s->dc_set && why_in_op(c))
		f = why_add(w, "clock_not_set",
			    "let the application give its time: ecrt_master_application_time(); see 'ethercat master'",
			    "the clock is not synchronized, SYNC signals have no common time");
	else if (s->dc_set && (s->dc_diff > EC_UAPI_DC_WINDOW_NS ||
			       s->dc_diff < -EC_UAPI_DC_WINDOW_NS))
		f = why_add(w, "clock_off",
			    "queue drift compensation in each cycle: ecrt_master_sync_slave_clocks(); if the application does, give it an even cycle: 'ethercat cycle'",
			    "the clock differs by %d ns from the reference clock, limit %d ns",
			    s->dc_diff, EC_UAPI_DC_WINDOW_NS);
	else if (c->c.dc_cycle[0] &&
		 !ec_dc_sync_fits(c->c.dc_cycle[0], w->m.cycle_interval_us * 1000))
		f = why_add(w, "sync_cycle",
			    "set the SYNC0 time of ecrt_slave_config_dc() to the cycle time, a whole part or a multiple of it; see 'ethercat cycle'",
			    "SYNC0 time %u ns and cycle of %u us: neither divides the other, so outputs and SYNC0 drift through each other",
			    c->c.dc_cycle[0], w->m.cycle_interval_us);
	else
		return;
	f->warning = true;
	f->slave = s->position;
	f->config = (int)(c - w->configs);
}

/**
 * why_clocks() - clocks that SYNC signals need
 * @w: what is known
 */
void why_clocks(struct why *w)
{
	if (!w->m.active)
		return;
	for (size_t i = 0; i < w->n_configs; i++) {
		const struct why_config *c = &w->configs[i];
		int position = c->c.slave_position;

		if (c->c.dc_assign_activate && position >= 0 && (size_t)position < w->bus.n)
			clock_of(w, c, &w->bus.v[position]);
	}
	if (w->m.cycle_lock == EC_CYCLE_LOCK_HOLD)
		why_add(w, "cycle_lock", "find out why the reference clock does not reply",
			"kernel cycle in holdover: the reference clock does not reply")
			->warning = true;
}

/* the port where a cable was cut, or a slave lost, has its own finding */
static bool is_cable(const struct why *w, unsigned int position, unsigned int port)
{
	for (size_t i = 0; i < w->n; i++)
		if (w->f[i].slave == (int)position && w->f[i].port == (int)port)
			return true;
	return false;
}

struct errors {
	unsigned int rx, phy, lost;
};

static struct errors errors_at(const u8 *regs, unsigned int port)
{
	return (struct errors){ err_rx(regs, port), err_phy(regs, port), err_lost(regs, port) };
}

static bool any(const struct errors *e)
{
	return e->rx || e->phy || e->lost;
}

/* Both ends of a cable may count its errors: it is reported once, at the upstream end. */
static void port_errors(struct why *w, u8 (*regs)[EC_ERRORS_SIZE], unsigned int at,
			unsigned int port)
{
	struct errors e = errors_at(regs[at], port), far = { 0 };
	char name[96], other[96] = "the main device";
	unsigned int peer_port;
	struct why_finding *f;
	bool connected;
	u32 peer;

	if (is_cable(w, at, port) || !any(&e))
		return;
	/* without a slave behind it, it leads to the main device */
	connected = w->bus.v[at].ports[port].link_up;
	if (topo_peer(&w->bus, at, port, &peer, &peer_port)) {
		connected = true;
		why_slave_name(w, peer, other, sizeof(other));
		if (peer_port < EC_UAPI_PORTS)
			far = errors_at(regs[peer], peer_port);
		if (peer < at && any(&far))
			return;
	}
	why_slave_name(w, at, name, sizeof(name));
	if (connected)
		f = why_add(w, "link_errors",
			    "check this cable and its plugs; then 'ethercat crc reset' and look again",
			    "between port %u of %s and %s: " COUNTERS, port, name, other,
			    e.rx + far.rx, e.phy + far.phy, e.lost + far.lost);
	else
		f = why_add(w, "link_errors",
			    "find out what was connected there, then 'ethercat crc reset' and look again",
			    "at port %u of %s, where nothing is connected now: " COUNTERS, port,
			    name, e.rx, e.phy, e.lost);
	f->warning = true;
	f->slave = (int)at;
	f->port = (int)port;
}

/* 0, or 1 after an error that was printed */
static int read_errors(struct why *w, struct dev *d, u8 (*regs)[EC_ERRORS_SIZE])
{
	if (!regs)
		return fail("out of memory");
	/* one that does not reply for long has its own finding */
	for (size_t i = 0; i < w->bus.n; i++)
		w->silent += !!errors_try(d, &w->bus.v[i], regs[i]);
	return 0;
}

/**
 * why_counters() - error counters of the ports, if the user may read registers
 * @w: what is known; @counters and @silent say what was read
 */
void why_counters(struct why *w)
{
	u8 (*regs)[EC_ERRORS_SIZE] = calloc(w->bus.n + 1, sizeof(*regs));
	struct dev d = *w->d;

	d.fd = sys_open(d.path, O_RDWR);
	if (d.fd >= 0) {
		w->counters = true;
		w->failed |= read_errors(w, &d, regs);
		dev_close(&d);
	}
	for (unsigned int i = 0; regs && i < w->bus.n; i++)
		for (unsigned int p = 0; p < EC_UAPI_PORTS; p++)
			port_errors(w, regs, i, p);
	free(regs);
}
