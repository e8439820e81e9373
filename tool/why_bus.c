// SPDX-License-Identifier: GPL-2.0-only
/* Causes that concern the whole bus: device, link, scan, cycle. */
#include <stdio.h>
#include <string.h>

#include "why.h"

#define OVERRUN_SHARE	100	/* skipped cycles: one in so many is worth a warning */

static void explain_all(struct why *w)
{
	for (size_t i = 0; i < w->n_configs; i++)
		if (!why_in_op(&w->configs[i]))
			why_explain(w, &w->configs[i]);
}

static bool link_up(const struct master *m)
{
	for (u32 i = 0; i < m->device_count; i++)
		if (m->devices[i].link_up)
			return true;
	return false;
}

/**
 * why_scan() - a bus scan is due or in progress
 * @w: what is known
 *
 * Return: its only finding, a warning.
 */
struct why_finding *why_scan(struct why *w)
{
	const struct master *m = &w->m;
	struct why_finding *f;

	for (size_t i = 0; i < w->n; i++)
		if (!strcmp(w->f[i].cause, "scan"))
			return &w->f[i];
	f = why_add(w, "scan", WHY_SCAN_REMEDY,
		    "bus scan in progress: %u of %u slaves read", m->scan_index, m->scan_slaves);
	f->warning = true;
	return f;
}

static const char *no_device_remedy(const char *name)
{
	if (!strncmp(name, "sim", 3))
		return "load the simulated segment: 'modprobe ec_sim segment=bench'; for a network card give ec_master its address, see 'ethercat devices'";
	return "load the driver of the network card and ec_generic, or bind its native driver: 'ethercat device bind'; or select another card: 'ethercat devices', 'ethercat device use'";
}

/* A slave that cannot be read is tried again by scans: its own finding says enough. */
static bool tries_again(const struct why *w)
{
	for (size_t i = 0; i < w->bus.n; i++)
		if (w->bus.v[i].error == EC_SLAVE_SCAN_FAILED)
			return w->m.slaves_responding == w->bus.n;
	return false;
}

/**
 * why_bus() - no device, no link, no slaves
 * @w: what is known
 *
 * Return: true: nothing else can be known of the bus.
 */
bool why_bus(struct why *w)
{
	const struct master *m = &w->m;

	if (m->phase == EC_PHASE_WAITING)
		why_add(w, "no_device", no_device_remedy(m->devices[0].name),
			"no network device: master %u waits for %s", w->d->master,
			m->devices[0].name);
	else if (!link_up(m))
		why_add(w, "link_down",
			"check the cable from this port to the input of the first slave, and the power of this slave",
			"no link at the main device %s", m->devices[0].name);
	else if (!m->slaves_responding && !m->slave_count && !m->scan_busy)
		why_add(w, "no_slaves",
			"check that the cable leads to the input (port 0) of an EtherCAT slave, without a switch in between",
			"link up at the main device %s, but no slave replies", m->devices[0].name);
	else if (m->scan_busy && !tries_again(w))
		return why_scan(w), false;
	else
		return false;
	explain_all(w);
	return true;
}

/* slaves that cannot be in OP without a cycle follow from the newest finding */
static void explain_cycle(struct why *w)
{
	for (size_t i = 0; i < w->n_configs; i++) {
		const struct why_config *c = &w->configs[i];

		if (c->cause.kind == EC_CAUSE_NO_CYCLE || c->cause.kind == EC_CAUSE_UNDER_WAY ||
		    (c->cause.kind == EC_CAUSE_REFUSED && c->cause.state == 8))
			why_explain(w, &w->configs[i]);
	}
}

static void no_cycle(struct why *w)
{
	why_add(w, "no_cycle",
		"let the application call ecrt_master_receive() and ecrt_master_send() in each cycle, or let the kernel run the cycle: ecrt_master_set_cycle()",
		"the application is active but sends no cyclic frames");
	explain_cycle(w);
}

/* Then cycles are skipped in any case. */
static bool too_short(struct why *w)
{
	const struct master *m = &w->m;
	bool yes = m->cycle_interval_us && m->cycle_wire_ns > m->cycle_interval_us * 1000ull;

	if (yes)
		why_add(w, "cycle_too_short",
			"lengthen the cycle, or give domains of slow data a division",
			"the frames of a cycle need %u us on the wire, the cycle is %u us",
			m->cycle_wire_ns / 1000 + 1, m->cycle_interval_us);
	return yes;
}

/* The kernel runs the cycle, and has done with the outputs what the application has chosen. */
static void stalled(struct why *w, u32 stall, u32 state)
{
	if (state == EC_CYCLE_STATE_STOPPED) {
		why_add(w, "output_stall",
			"find out why the application gave no outputs, then restart it",
			"output stall: the application gave no outputs, and the kernel has stopped the cycle (EC_CYCLE_STOP)");
		explain_cycle(w);
	} else if (state == EC_CYCLE_STATE_STALLED) {
		why_add(w, "output_stall",
			"find out why the application gives no outputs: does it still run, does it wait for something?",
			"output stall: the application gives no outputs; %s",
			stall == EC_STALL_ZERO ?
			"the kernel sends zeros (EC_CYCLE_ZERO)" :
			"the kernel holds the last ones (EC_CYCLE_HOLD)");
	}
}

static void thread(struct why *w, const struct ec_ioc_cycle_stats *i,
		   const struct ec_status_cycle *st, bool short_cycle)
{
	u64 cycles = st->late_count + st->overruns;

	if (i->kind == EC_CYCLE_BY_KERNEL && w->m.session != EC_SESSION_DETACHED)
		stalled(w, i->stall, st->state);
	if (!short_cycle && st->overruns * OVERRUN_SHARE > cycles)
		why_add(w, "overruns",
			"check the settings for real time: 'ethercat rtcheck'; see 'ethercat cycle -v'",
			"%llu of %llu cycles skipped: the cycle owner was late by a period or more",
			(unsigned long long)st->overruns, (unsigned long long)cycles)
			->warning = true;
}

/**
 * why_cycle() - what is wrong with the cycle of an active application
 * @w: what is known
 */
void why_cycle(struct why *w)
{
	struct ec_status_cycle st = { 0 };
	struct ec_ioc_cycle_stats i = { .size = sizeof(st), .data = (uintptr_t)&st };
	bool short_cycle;

	if (!w->m.active)
		return;
	short_cycle = too_short(w);
	if (!dev_ioctl(w->d, EC_IOC_CYCLE_STATS, &i))
		thread(w, &i, &st, short_cycle);
	if (w->m.no_cycle && !(i.kind == EC_CYCLE_BY_KERNEL && st.state == EC_CYCLE_STATE_STOPPED))
		no_cycle(w);
	/* that of the kernel sends a domain in its turn */
	if (i.kind == EC_CYCLE_BY_APP)
		why_unsent(w);
}
