// SPDX-License-Identifier: GPL-2.0-only
/* Causes beyond AL states: working counters, clocks, error counters of the ports. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>

#include "errors.h"
#include "sys.h"
#include "topology.h"
#include "why.h"

#define LOOKS		3	/* at a working counter before it counts as incomplete */
#define LOOK_MS		20

static const struct why_config *config_at(const struct why *w, u16 alias, u16 position)
{
	for (size_t i = 0; i < w->n_configs; i++)
		if (w->configs[i].c.alias == alias && w->configs[i].c.position == position)
			return &w->configs[i];
	return NULL;
}

/* A slave that is not in OP has its own cause, and the working counter follows from it. */
static bool all_in_op(struct why *w, const struct ec_ioc_domain *dom)
{
	for (u32 i = 0; i < dom->fmmu_count; i++) {
		struct ec_ioc_domain_fmmu f = { .index = dom->index, .fmmu = i };
		const struct why_config *c;

		if (dev_ioctl(w->d, EC_IOC_DOMAIN_FMMU, &f))
			return false;
		c = config_at(w, f.alias, f.position);
		if (!c || !why_in_op(c))
			return false;
	}
	return true;
}

/* of some looks each is incomplete: one lost frame is no fault of a slave */
static bool incomplete(struct why *w, struct ec_ioc_domain *dom)
{
	for (int i = 0; i < LOOKS; i++) {
		*dom = (struct ec_ioc_domain){ .index = dom->index };
		/* an older module does not know the state */
		if (dev_ioctl(w->d, EC_IOC_DOMAIN, dom) ||
		    (dom->working_counter == dom->expected &&
		     dom->wc_state != EC_STATUS_WC_INCOMPLETE))
			return false;
		sleep_ms(i + 1 < LOOKS ? LOOK_MS : 0);
	}
	return true;
}

/**
 * why_domains() - process data that are not exchanged although all slaves are in OP
 * @w: what is known
 */
void why_domains(struct why *w)
{
	if (!w->m.active || w->m.no_cycle)
		return;
	for (u32 i = 0; i < w->m.domain_count; i++) {
		struct ec_ioc_domain dom = { .index = i };

		if (!incomplete(w, &dom) || !all_in_op(w, &dom))
			continue;
		why_add(w, "working_counter",
			"compare the slaves of the domain: 'ethercat domains -v'; power-cycle the one whose data do not change",
			"domain %u: working counter %u, expected %u%s, although all its slaves are in OP",
			i, dom.working_counter, dom.expected,
			dom.working_counter == dom.expected ?
				" in sum, but not of each datagram" : "")->domain = (int)i;
	}
}

static void clock_of(struct why *w, const struct why_config *c, const struct ec_ioc_slave *s)
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
			    "queue drift compensation in each cycle: ecrt_master_sync_slave_clocks()",
			    "the clock differs by %d ns from the reference clock, limit %d ns",
			    s->dc_diff, EC_UAPI_DC_WINDOW_NS);
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
	char name[96], other[96] = "the main device or nothing";
	unsigned int peer_port;
	struct why_finding *f;
	u32 peer;

	if (is_cable(w, at, port) || !any(&e))
		return;
	if (topo_peer(&w->bus, at, port, &peer, &peer_port)) {
		why_slave_name(w, peer, other, sizeof(other));
		if (peer_port < EC_UAPI_PORTS)
			far = errors_at(regs[peer], peer_port);
		if (peer < at && any(&far))
			return;
	}
	f = why_add(w, "link_errors",
		    "check this cable and its plugs; then 'ethercat crc reset' and look again",
		    "between port %u of %s and %s: %u invalid frames, %u receive errors, link lost %u times",
		    port, why_slave_name(w, at, name, sizeof(name)), other, e.rx + far.rx,
		    e.phy + far.phy, e.lost + far.lost);
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
		w->silent += !!errors_try(d, w->bus.v[i].position, regs[i]);
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
