// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/* Names and texts of events. What the kernel log reports as well has the same words there. */
#include "event.h"
#include "al.h"
#include "coe.h"

#ifndef __KERNEL__
#include <stdio.h>
#endif

#define U(n)	{ n, EC_ARG_U }
#define I(n)	{ n, EC_ARG_I }
#define S(n)	{ n, EC_ARG_SLAVE }
#define KIND(k, n, ...)	{ EC_EVENT_##k, n, { __VA_ARGS__ } }

static const struct ec_event_kind kinds[] = {
	KIND(MISSED, "missed", U("count"), U("count_high")),
	KIND(DEVICE_ON, "device_attached", U("device")),
	KIND(DEVICE_OFF, "device_detached", U("device")),
	KIND(LINK_UP, "link_up", U("device")),
	KIND(LINK_DOWN, "link_down", U("device")),
	KIND(RESPONDING, "slaves_responding", U("slaves"), U("before")),
	KIND(SCAN_START, "scan_start", U("slaves")),
	KIND(SCAN_END, "scan_end", U("slaves"), U("us"), U("frames")),
	KIND(SLAVE_LOST, "slave_lost", S("upstream"), U("port"), U("alias"), U("vendor_id"),
	     U("product_code"), U("ms")),
	KIND(ALL_LOST, "all_slaves_lost", U("slaves"), U("ms")),
	KIND(SLAVE_FOUND, "slave_found", S("upstream"), U("port"), U("alias"), U("vendor_id"),
	     U("product_code")),
	KIND(SLAVE_SILENT, "slave_silent"),
	KIND(SLAVE_REPLIES, "slave_replies"),
	KIND(SLAVE_BACK, "slave_back", U("ms")),
	KIND(NO_ANSWER, "no_answer", U("polls")),
	KIND(AL_STATE, "al_state", U("state"), U("before")),
	KIND(AL_LEFT, "al_state_left", U("state"), U("before")),
	KIND(AL_ERROR, "al_error", U("state"), U("al_code")),
	KIND(EMERGENCY, "emergency", U("code"), U("error_register"), U("data"), U("data_4")),
	KIND(SLAVE_FAILED, "slave_failed", U("error"), U("al_code")),
	KIND(WKC, "working_counter", U("domain"), U("working_counter"), U("before"),
	     U("expected"), U("more_changes")),
	KIND(OVERRUN, "overruns", U("cycles")),
	KIND(FRAMES_LOST, "frames_lost", U("frames")),
	KIND(FRAMES_LATE, "frames_late", U("frames")),
	KIND(TIMEOUT, "cycle_timeout", U("ms"), U("timeouts")),
	KIND(RESUMED, "cycle_resumed", U("ms")),
	KIND(STALE, "stale_data", U("domain"), U("age"), U("limit")),
	KIND(REF_CLOCK, "reference_clock", S("reference"), U("lost")),
	KIND(DC_SET, "clocks_synchronized", U("us"), S("reference")),
	KIND(DC_FAILED, "clocks_not_synchronized", U("errno"), U("retry")),
	KIND(DC_WINDOW, "sync_window", U("outside"), U("clocks"), S("worst"), U("ns")),
	KIND(LOCK, "cycle_lock", U("lock"), I("phase_error"), I("rate_ppb")),
	KIND(RESERVED, "reserved", U("pid")),
	KIND(ACTIVATED, "activated", U("pid"), U("domains"), U("bytes"), U("datagrams")),
	KIND(DEACTIVATED, "deactivated", U("pid")),
	KIND(RELEASED, "released", U("pid")),
	KIND(DETACHED, "detached", U("pid")),
	KIND(TAKEN_OVER, "taken_over", U("pid")),
	KIND(DEBUG, "debug_level", U("level")),
};

/**
 * ec_event_kind() - name and arguments of an event
 * @kind: EC_EVENT_*
 *
 * Return: what it is, or NULL: a newer module has it.
 */
const struct ec_event_kind *ec_event_kind(u32 kind)
{
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(kinds); i++)
		if (kinds[i].kind == kind)
			return &kinds[i];
	return NULL;
}

/* the text, as far as there is room */
struct text {
	char *buf;
	size_t size;
	int len;
};

#ifdef __KERNEL__
#define format(t, ...)	((t)->len = scnprintf((t)->buf, (t)->size, __VA_ARGS__))
#else
#define format(t, ...)	((t)->len = snprintf((t)->buf, (t)->size, __VA_ARGS__))
#endif

static const char *device(u32 side)
{
	return side ? "backup" : "main";
}

static void about_link(struct text *t, const struct ec_event *e)
{
	const char *what = e->kind == EC_EVENT_DEVICE_ON ? "device attached" :
			   e->kind == EC_EVENT_DEVICE_OFF ? "device detached" :
			   e->kind == EC_EVENT_LINK_UP ? "link up" : "link down";

	format(t, "%s %s", device(e->arg[0]), what);
}

/* where a slave is, or was */
static void place(struct text *t, const struct ec_event *e, const char *what, const char *of)
{
	char alias[24] = "", at[40] = "the main device";
	struct text a = { .buf = alias, .size = sizeof(alias) };
	struct text p = { .buf = at, .size = sizeof(at) };

	if (e->arg[2])
		format(&a, ", alias %u", e->arg[2]);
	if (e->arg[0] != EC_EVENT_NONE)
		format(&p, "port %u of slave %u", e->arg[1], e->arg[0]);
	if (e->kind == EC_EVENT_SLAVE_LOST)
		format(t, "slave %u (0x%08x/0x%08x%s) %s %s %s, last seen %u ms ago", e->slave,
		       e->arg[3], e->arg[4], alias, what, of, at, e->arg[5]);
	else
		format(t, "slave %u (0x%08x/0x%08x%s) %s %s %s", e->slave, e->arg[3], e->arg[4],
		       alias, what, of, at);
}

static void about_bus(struct text *t, const struct ec_event *e)
{
	const u32 *a = e->arg;

	switch (e->kind) {
	case EC_EVENT_RESPONDING:
		format(t, "slaves responding: %u, before: %u", a[0], a[1]);
		break;
	case EC_EVENT_SCAN_START:
		format(t, "scan of %u slave(s) begins", a[0]);
		break;
	case EC_EVENT_SCAN_END:
		format(t, "scan complete: %u slave(s) in %u us, %u frames", a[0], a[1], a[2]);
		break;
	case EC_EVENT_SLAVE_LOST:
		place(t, e, "disconnected", "from");
		break;
	case EC_EVENT_ALL_LOST:
		format(t, "all %u slave(s) disconnected, last seen %u ms ago", a[0], a[1]);
		break;
	case EC_EVENT_SLAVE_FOUND:
		place(t, e, "connected", "to");
		break;
	case EC_EVENT_SLAVE_SILENT:
		format(t, "no reply from slave %u, frames pass; waiting for a reply", e->slave);
		break;
	case EC_EVENT_SLAVE_REPLIES:
		format(t, "slave %u replies again", e->slave);
		break;
	case EC_EVENT_SLAVE_BACK:
		format(t, "slave %u back in OP, %u ms after it was last seen", e->slave, a[0]);
		break;
	case EC_EVENT_NO_ANSWER:
		format(t, "a slave did not answer at its station address in %u polls; rescanning",
		       a[0]);
		break;
	}
}

static void about_slave(struct text *t, const struct ec_event *e)
{
	const char *state = ec_al_state_name((u8)e->arg[0]);

	switch (e->kind) {
	case EC_EVENT_SLAVE_FAILED:
		format(t, "%s of slave %u failed, AL status code 0x%04x (%s); see 'ethercat slaves -v'",
		       e->arg[0] == 1 ? "scan" : "configuration", e->slave, e->arg[1],
		       ec_al_code_text((u16)e->arg[1]));
		break;
	case EC_EVENT_AL_STATE:
		format(t, "slave %u: AL state %s, before %s", e->slave, state,
		       ec_al_state_name((u8)e->arg[1]));
		break;
	case EC_EVENT_AL_LEFT:
		format(t, "slave %u: AL state %s left without request, now %s", e->slave,
		       ec_al_state_name((u8)e->arg[1]), state);
		break;
	case EC_EVENT_AL_ERROR:
		format(t, "slave %u: AL state %s with error, AL status code 0x%04x (%s)", e->slave,
		       state, e->arg[1], ec_al_code_text((u16)e->arg[1]));
		break;
	case EC_EVENT_EMERGENCY:
		format(t, "slave %u: CoE emergency: code 0x%04x, error register 0x%02x (%s)",
		       e->slave, e->arg[0], e->arg[1], ec_coe_emergency_text((u16)e->arg[0]));
		break;
	}
}

static void about_wkc(struct text *t, const u32 *a)
{
	if (a[4])
		format(t, "domain %u: working counter %u of %u, before %u; %u more change(s)",
		       a[0], a[1], a[3], a[2], a[4]);
	else
		format(t, "domain %u: working counter %u of %u, before %u", a[0], a[1], a[3], a[2]);
}

static void about_cycle(struct text *t, const struct ec_event *e)
{
	const u32 *a = e->arg;

	switch (e->kind) {
	case EC_EVENT_WKC:
		about_wkc(t, a);
		break;
	case EC_EVENT_OVERRUN:
		format(t, "%u cycle(s) skipped", a[0]);
		break;
	case EC_EVENT_FRAMES_LOST:
		format(t, "%u frame(s) lost", a[0]);
		break;
	case EC_EVENT_FRAMES_LATE:
		format(t, "%u frame(s) late", a[0]);
		break;
	case EC_EVENT_TIMEOUT:
		format(t, "cycle timeout: no cyclic frame for %u ms; process data stopped", a[0]);
		break;
	case EC_EVENT_RESUMED:
		format(t, "cycle resumed after %u ms", a[0]);
		break;
	case EC_EVENT_STALE:
		format(t, "domain %u receives stale process data: %u sends old, limit %u", a[0],
		       a[1], a[2]);
		break;
	}
}

static void about_ref_clock(struct text *t, const u32 *a)
{
	const char *lost = a[1] ? "reference clock lost: " : "";

	if (a[0] == EC_EVENT_NONE)
		format(t, "%sclocks run free", lost);
	else
		format(t, "%sslave %u is the new reference clock", lost, a[0]);
}

static void about_window(struct text *t, const u32 *a)
{
	if (a[0])
		format(t, "%u of %u clocks outside the sync window, worst: slave %u by %u ns",
		       a[0], a[1], a[2], a[3]);
	else
		format(t, "all %u clocks inside the sync window", a[1]);
}

static void about_clocks(struct text *t, const struct ec_event *e)
{
	static const char *const locks[] = { "off", "seeking", "locked", "in holdover" };
	const u32 *a = e->arg;

	switch (e->kind) {
	case EC_EVENT_REF_CLOCK:
		about_ref_clock(t, a);
		break;
	case EC_EVENT_DC_SET:
		format(t, "distributed clocks synchronized in %u us, reference clock: slave %u",
		       a[0], a[1]);
		break;
	case EC_EVENT_DC_FAILED:
		format(t, "distributed clocks not synchronized (errno %u)%s", a[0],
		       a[1] ? "; retrying" : "");
		break;
	case EC_EVENT_DC_WINDOW:
		about_window(t, a);
		break;
	case EC_EVENT_LOCK:
		format(t, "kernel cycle %s: phase error %d ns, rate %+d ppb",
		       a[0] < ARRAY_SIZE(locks) ? locks[a[0]] : "?", (s32)a[1], (s32)a[2]);
		break;
	}
}

static void about_session(struct text *t, const struct ec_event *e)
{
	const u32 *a = e->arg;

	switch (e->kind) {
	case EC_EVENT_RESERVED:
		format(t, "application reserved the master, process %u", a[0]);
		break;
	case EC_EVENT_ACTIVATED:
		format(t, "session activated: %u domain(s), %u bytes, %u datagram(s) per cycle, process %u",
		       a[1], a[2], a[3], a[0]);
		break;
	case EC_EVENT_DEACTIVATED:
		format(t, "session deactivated, process %u", a[0]);
		break;
	case EC_EVENT_RELEASED:
		format(t, "application exited or released the master, process %u", a[0]);
		break;
	case EC_EVENT_DETACHED:
		format(t, "application exited or released the master, process %u; session detached, kernel cycle continues",
		       a[0]);
		break;
	case EC_EVENT_TAKEN_OVER:
		format(t, "detached session taken over by a new application, process %u", a[0]);
		break;
	case EC_EVENT_DEBUG:
		format(t, "debug level %u", a[0]);
		break;
	}
}

/**
 * ec_event_text() - one line about an event
 * @e: event; nothing in it is trusted
 * @buf: result, without line end
 * @size: bytes of it; 200 are enough
 *
 * Return: length of the text, at most @size - 1; 0 without a buffer.
 */
int ec_event_text(const struct ec_event *e, char *buf, size_t size)
{
	static void (*const about[])(struct text *t, const struct ec_event *e) = {
		about_link, about_bus, about_slave, about_cycle, about_clocks, about_session,
	};
	struct text t = { .buf = buf, .size = size };

	if (!size)
		return 0;
	buf[0] = '\0';
	if (e->kind == EC_EVENT_MISSED)
		format(&t, "%llu event(s) missed: the reader was too slow",
		       (unsigned long long)((u64)e->arg[1] << 32 | e->arg[0]));
	else if (e->kind >> 4 < ARRAY_SIZE(about) && ec_event_kind(e->kind))
		about[e->kind >> 4](&t, e);
	else
		format(&t, "unknown event 0x%x; a newer module has it", e->kind);
	return min(t.len, (int)size - 1);
}
