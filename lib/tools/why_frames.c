// SPDX-License-Identifier: LGPL-2.1-or-later
/* Frames that return late or not at all, although no cable or slave has failed. */
#include <stdio.h>
#include <time.h>

#include "why.h"

#define LATE_MS		500	/* in which frames must have been late to be so still */

static u64 late_of(const struct ect_list *devices)
{
	const struct ect_device *d;
	u64 sum = 0;

	for (size_t i = 0; (d = ect_list_get(devices, i)); i++)
		sum += d->late;
	return sum;
}

/* The place of the delay: card and driver if the sends were in time, otherwise the CPU. */
static void late_place(struct why *w, struct ect_finding *f)
{
	const char *card = w->devices->n ? why_device(w, 0)->name : "";
	struct ect_cycle c;
	u32 us;

	if (ect_get_cycle(w->h, &c) || !c.late_count)
		return;
	us = c.late_max / 1000;
	if (c.late_max > c.interval_ns / 4)
		why_remedy(f, LATE_CPU, us, card);
	else
		why_remedy(f, LATE_CARD, card, us);
}

static void sleep_late(void)
{
	const struct timespec ts = { 0, LATE_MS * 1000000L };

	nanosleep(&ts, NULL);
}

/**
 * why_late_frames() - frames that return when the next cycle has begun
 * @w: what is known; @late says whether there are any
 *
 * Of a counter that is not 0 it waits a moment, to see whether it still grows.
 */
void why_late_frames(struct why *w)
{
	struct ect_list *now;
	struct ect_finding *f;
	u64 n;

	if (!w->m.active || w->m.no_cycle || !late_of(w->devices))
		return;
	sleep_late();
	if (ect_devices_read(w->h, &now))
		return;
	n = late_of(now) - late_of(w->devices);
	ect_list_free(now);
	if (!n)
		return;
	w->late = true;
	/* frames of a delayed application, or of a cycle that is too short, are late as well */
	if (why_has(w, "overruns") || why_has(w, "cycle_too_short"))
		return;
	f = why_add(w, LATE_FRAMES, (unsigned long long)n, n == 1 ? "frame" : "frames", LATE_MS);
	f->evidence_count = 1;
	f->evidence[0] = (s64)n;
	late_place(w, f);
}

/**
 * why_lost_frames() - frames that do not return
 * @w: what is known, all other findings included
 */
void why_lost_frames(struct why *w)
{
	if (!w->m.active || w->m.no_cycle || why_has(w, "cable") || why_has(w, "no_reply") ||
	    why_has(w, "missing"))
		return;
	for (size_t i = 0; i < w->devices->n; i++) {
		const struct ect_device *d = why_device(w, i);
		u32 rate = d->loss_rate[1];
		struct ect_finding *f;

		/* still now, and for some time */
		if (!d->loss_rate[0] || !rate)
			continue;
		f = why_add(w, LOST_FRAMES, d->name, rate, rate == 1 ? "frame" : "frames");
		f->evidence_count = 1;
		f->evidence[0] = rate;
		if (why_has(w, "link_errors"))
			continue;
		if (w->counters && !w->silent)
			why_remedy(f, LOST_CARD, d->name);
		else
			why_remedy(f, LOST_ANY, d->name);
	}
}
