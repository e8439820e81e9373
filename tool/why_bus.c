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

static bool link_up(const struct ec_ioc_master *m)
{
	for (u32 i = 0; i < m->device_count; i++)
		if (m->devices[i].link_up)
			return true;
	return false;
}

static void scanning(struct why *w)
{
	const struct ec_ioc_master *m = &w->m;

	why_add(w, "scan", "repeat the command when the scan is complete",
		"bus scan in progress: %u of %u slaves read", m->scan_index,
		m->scan_slaves)->warning = true;
}

static const char *no_device_remedy(const char *name)
{
	if (!strncmp(name, "sim", 3))
		return "load the simulated segment: 'modprobe ec_sim segment=bench'; for a network card give ec_master its address, see 'ethercat devices'";
	return "load the driver of the network card and ec_generic, or bind its native driver: 'ethercat device bind'; or select another card: 'ethercat devices', 'ethercat device use'";
}

/**
 * why_bus() - no device, no link, no slaves
 * @w: what is known
 *
 * Return: true: nothing else can be known of the bus.
 */
bool why_bus(struct why *w)
{
	const struct ec_ioc_master *m = &w->m;

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
	else if (m->scan_busy)
		return scanning(w), false;
	else
		return false;
	explain_all(w);
	return true;
}

static void no_cycle(struct why *w)
{
	why_add(w, "no_cycle",
		"let the application call ecrt_master_receive() and ecrt_master_send() in each cycle, or let the kernel run the cycle: ecrt_master_set_cycle()",
		"the application is active but sends no cyclic frames");
	for (size_t i = 0; i < w->n_configs; i++) {
		const struct why_config *c = &w->configs[i];

		if (c->cause.kind == EC_CAUSE_NO_CYCLE || c->cause.kind == EC_CAUSE_UNDER_WAY ||
		    (c->cause.kind == EC_CAUSE_REFUSED && c->cause.state == 8))
			why_explain(w, &w->configs[i]);
	}
}

/* Then cycles are skipped in any case. */
static bool too_short(struct why *w)
{
	const struct ec_ioc_master *m = &w->m;
	bool yes = m->cycle_interval_us && m->cycle_wire_ns > m->cycle_interval_us * 1000ull;

	if (yes)
		why_add(w, "cycle_too_short",
			"lengthen the cycle, or give domains of slow data a division",
			"the frames of a cycle need %u us on the wire, the cycle is %u us",
			m->cycle_wire_ns / 1000 + 1, m->cycle_interval_us);
	return yes;
}

static void thread(struct why *w, const struct ec_ioc_cycle_stats *i,
		   const struct ec_status_cycle *st, bool short_cycle)
{
	u64 cycles = st->late_count + st->overruns;

	if (i->kind == EC_CYCLE_BY_KERNEL && st->state == EC_CYCLE_STATE_STOPPED)
		why_add(w, "output_stall",
			"find out why the application gives no outputs, then restart it",
			"the kernel has stopped the cycle: the application gave no outputs");
	else if (i->kind == EC_CYCLE_BY_KERNEL && st->state == EC_CYCLE_STATE_STALLED &&
		 w->m.session != EC_SESSION_DETACHED)
		why_add(w, "output_stall", "find out why the application gives no outputs",
			"output stall: the application gives no outputs; the kernel holds or zeroes them")
			->warning = true;
	if (!short_cycle && st->overruns * OVERRUN_SHARE > cycles)
		why_add(w, "overruns",
			"check the settings for real time: 'ethercat rtcheck'; see 'ethercat cycle -v'",
			"%llu of %llu cycles skipped: the cycle owner was late by a period or more",
			(unsigned long long)st->overruns, (unsigned long long)cycles)
			->warning = true;
}

/**
 * why_frames() - frames that do not return although no cable or slave has failed
 * @w: what is known, all other findings included
 */
void why_frames(struct why *w)
{
	if (!w->m.active || w->m.no_cycle)
		return;
	for (size_t i = 0; i < w->n; i++)
		if (!strcmp(w->f[i].cause, "cable") || !strcmp(w->f[i].cause, "no_reply") ||
		    !strcmp(w->f[i].cause, "missing"))
			return;
	for (u32 i = 0; i < w->m.device_count; i++) {
		const struct ec_ioc_device *d = &w->m.devices[i];

		/* still now, and for some time */
		if (d->loss_rate[0] && d->loss_rate[1])
			why_add(w, "lost_frames",
				"look for the cable with errors: 'ethercat crc'; check the network card: 'ethercat rtcheck'",
				"%s loses %u frames per second (average over 10 s)", d->name,
				d->loss_rate[1])->warning = true;
	}
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
	if (w->m.no_cycle)
		no_cycle(w);
	short_cycle = too_short(w);
	if (!dev_ioctl(w->d, EC_IOC_CYCLE_STATS, &i))
		thread(w, &i, &st, short_cycle);
}
