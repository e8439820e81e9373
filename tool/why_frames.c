// SPDX-License-Identifier: GPL-2.0-only
/* Frames that return late or not at all, although no cable or slave has failed. */
#include <stdio.h>
#include <string.h>

#include "sys.h"
#include "why.h"

#define LATE_MS		500	/* in which frames must have been late to be so still */

static u64 late_of(const struct master *m)
{
	u64 sum = 0;

	for (u32 i = 0; i < m->device_count; i++)
		sum += m->devices[i].late;
	return sum;
}

/* Were the sends themselves in time? Then card and driver are the place, otherwise the CPU. */
static void late_place(struct why *w, struct why_finding *f)
{
	struct ec_status_cycle st = { 0 };
	struct ec_ioc_cycle_stats i = { .size = sizeof(st), .data = (uintptr_t)&st };
	const char *card = w->m.devices[0].name;
	u32 us;

	if (dev_ioctl(w->d, EC_IOC_CYCLE_STATS, &i) || !st.late_count)
		return;
	us = st.late_max / 1000;
	if (st.late_max > i.interval_ns / 4)
		why_remedy(f, "check the CPU of the cycle first, which sent up to %u us late: 'ethercat rtcheck', 'ethercat cycle -v'; then the interrupt of the network card %s",
			   us, card);
	else
		why_remedy(f, "check the network card %s: delay of its interrupts (ethtool -C, rx-usecs 0), priority and CPU of its interrupt thread: 'ethercat rtcheck'; the sends were in time, at most %u us late",
			   card, us);
}

static bool any(const struct why *w, const char *cause)
{
	for (size_t i = 0; i < w->n; i++)
		if (!strcmp(w->f[i].cause, cause))
			return true;
	return false;
}

/**
 * why_late_frames() - frames that return when the next cycle has begun
 * @w: what is known; @late says whether there are any
 *
 * Of a counter that is not 0 it waits a moment, to see whether it still grows.
 */
void why_late_frames(struct why *w)
{
	struct master now;
	struct why_finding *f;
	u64 n;

	if (!w->m.active || w->m.no_cycle || !late_of(&w->m))
		return;
	sleep_ms(LATE_MS);
	if (dev_master(w->d, &now))
		return;
	n = late_of(&now) - late_of(&w->m);
	if (!n)
		return;
	w->late = true;
	/* an application that is late fetches them late, and so it is with a short cycle */
	if (any(w, "overruns") || any(w, "cycle_too_short"))
		return;
	f = why_add(w, "late_frames",
		    "check the CPU of the cycle and the interrupt of the network card: 'ethercat rtcheck', 'ethercat cycle -v'",
		    "%llu %s in %u ms returned after the next cycle had begun: working counters are incomplete then, and no slave or cable is at fault",
		    (unsigned long long)n, n == 1 ? "frame" : "frames", LATE_MS);
	f->warning = true;
	late_place(w, f);
}

/**
 * why_lost_frames() - frames that do not return
 * @w: what is known, all other findings included
 */
void why_lost_frames(struct why *w)
{
	if (!w->m.active || w->m.no_cycle || any(w, "cable") || any(w, "no_reply") ||
	    any(w, "missing"))
		return;
	for (u32 i = 0; i < w->m.device_count; i++) {
		const struct ec_ioc_device *d = &w->m.devices[i];
		struct why_finding *f;

		/* still now, and for some time */
		if (!d->loss_rate[0] || !d->loss_rate[1])
			continue;
		f = why_add(w, "lost_frames", "", "%s loses %u %s per second (average over 10 s)",
			    d->name, d->loss_rate[1], d->loss_rate[1] == 1 ? "frame" : "frames");
		f->warning = true;
		if (any(w, "link_errors"))
			why_remedy(f, "repair the cables whose ports count errors, see there");
		else if (w->counters && !w->silent)
			why_remedy(f, "no port of a slave counts an error, so check the network card %s, its driver and the plug there: 'ethtool -S', 'ethercat rtcheck'",
				   d->name);
		else
			why_remedy(f, "see whether the ports of slaves count errors: 'ethercat crc'; if not, check the network card %s and its driver: 'ethercat rtcheck'",
				   d->name);
	}
}
