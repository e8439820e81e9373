// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include "../bus/graph.h"
#include "../bus/slave.h"
#include "../link/links.h"
#include "dc_armw.h"
#include "dc_state.h"

#define LOG_NS	NSEC_PER_SEC	/* without a certain position, then the log says why */

/**
 * ec_dc_armw_want() - a session begins to use the clocks
 * @dc: clocks
 * @wanted: one of its slaves ignores FRMW
 *
 * Context: Process.
 */
void ec_dc_armw_want(struct ec_dc *dc, bool wanted)
{
	dc->armw_since_ns = 0;
	dc->armw_logged = false;
	ec_write64(&dc->armw.at, 0);
	WRITE_ONCE(dc->armw.wanted, wanted);
}

/* Has it a port at which a slave may join the ring before the master knows of it? */
static bool lets_in(const struct ec_slave *s)
{
	unsigned int p;

	for (p = 0; p < EC_MAX_PORT; p++) {
		u8 loop = READ_ONCE(s->ports.loops) >> 2 * p & 3;

		if (p != s->graph.upstream && ec_slave_port_type(s, p) >= 2 &&
		    loop != EC_LOOP_CLOSED && loop != EC_LOOP_AUTO_CLOSE)
			return true;
	}
	return READ_ONCE(s->ports.fixed);
}

/* The first slave before the reference clock that lets others in, or NULL */
static struct ec_slave *find_open(const struct ec_dc *dc)
{
	unsigned int i;

	for (i = 0; i < dc->ref->position; i++)
		if (lets_in(dc->bus->slaves[i]))
			return dc->bus->slaves[i];
	return NULL;
}

/* Is the reference clock in the list, and do frames of the main device reach it? */
static bool is_listed(const struct ec_dc *dc)
{
	const struct ec_slave *ref = dc->ref;

	return ref && !READ_ONCE(ref->stop.gone) && !READ_ONCE(ref->reply.silent) &&
	       !ec_graph_is_reversed(ref) && ref->position < dc->bus->n_slaves &&
	       dc->bus->slaves[ref->position] == ref;
}

static void log_open(struct ec_dc *dc, struct ec_slave *s)
{
	u64 now = ktime_get_ns();

	dc->armw_since_ns = dc->armw_since_ns ?: now;
	if (dc->armw_logged || now - dc->armw_since_ns < LOG_NS)
		return;
	dc->armw_logged = true;
	ec_slave_warn(s, "slaves may be connected here, before the reference clock: no ARMW is sent, clocks drift; use the first slave as reference clock\n");
}

/**
 * ec_dc_armw_locate() - note where in the ring the reference clock is
 * @dc: clocks
 * @known: the list of slaves is that of the ring
 * @path: after these changes of ports, ec_dc_path()
 *
 * The position is certain if no slave before that clock has a port at which others may join the
 * ring without the master, and until the next change of a port. Ports between the slaves of a ring
 * with two devices are such ports.
 *
 * Context: The monitor thread.
 */
void ec_dc_armw_locate(struct ec_dc *dc, bool known, u32 path)
{
	struct ec_slave *open = NULL;
	u64 at = 0;

	if (!READ_ONCE(dc->armw.wanted))
		return;
	/* of the monitor itself: the list does not change meanwhile */
	down_read(&dc->bus->topo);
	if (known && is_listed(dc)) {
		open = find_open(dc);
		if (!open)
			at = ec_armw_at(dc->ref->station, dc->ref->position, path);
	}
	ec_write64(&dc->armw.at, at);
	if (open)
		log_open(dc, open);
	else
		dc->armw_since_ns = 0;
	up_read(&dc->bus->topo);
}
