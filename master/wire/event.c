// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/* Names and texts of events. What the kernel log reports as well has the same words there. */
#include "event.h"
#include "al.h"
#include "coe.h"
#include "emergency.h"

#ifndef __KERNEL__
#include <stdio.h>
#endif

#define U(n)	{ n, EC_ARG_U }
#define I(n)	{ n, EC_ARG_I }
#define S(n)	{ n, EC_ARG_SLAVE }
#define AL(n)	{ n, EC_ARG_AL }
#define L(n)	{ n, EC_ARG_LOCK }
#define P(n)	{ n, EC_ARG_STALL }
#define KIND(k, n, ...)	{ EC_EVENT_##k, n, { __VA_ARGS__ } }

static const struct ec_event_kind kinds[] = {
	KIND(MISSED, "missed", U("count"), U("count_high")),
	KIND(DEVICE_ON, "device_attached", U("device")),
	KIND(DEVICE_OFF, "device_detached", U("device")),
	KIND(LINK_UP, "link_up", U("device")),
	KIND(LINK_DOWN, "link_down", U("device")),
	KIND(RESPONDING, "slaves_responding", U("slaves"), U("before")),
	KIND(SCAN_START, "scan_start", U("slaves")),
	KIND(SCAN_END, "scan_end", U("slaves"), U("duration_us"), U("frames")),
	KIND(SLAVE_LOST, "slave_lost", S("upstream"), U("port"), U("alias"), U("vendor_id"),
	     U("product_code"), U("age_ms"), U("slaves")),
	KIND(ALL_LOST, "all_slaves_lost", U("slaves"), U("age_ms")),
	KIND(SLAVE_FOUND, "slave_found", S("upstream"), U("port"), U("alias"), U("vendor_id"),
	     U("product_code"), U("slaves")),
	KIND(SLAVE_SILENT, "slave_silent"),
	KIND(SLAVE_REPLIES, "slave_replies"),
	KIND(SLAVE_BACK, "slave_back", U("absent_ms"), U("slaves")),
	KIND(NO_ANSWER, "no_answer", U("polls")),
	KIND(AL_STATE, "al_state", AL("state"), AL("before"), U("slaves"), AL("lowest")),
	KIND(AL_LEFT, "al_state_left", AL("state"), AL("before")),
	KIND(AL_ERROR, "al_error", AL("state"), U("al_status_code")),
	KIND(EMERGENCY, "emergency", U("code"), U("error_register"), U("data"), U("data_4"),
	     U("profile")),
	KIND(SLAVE_FAILED, "slave_failed", U("error"), U("al_status_code"), U("cause"), U("code"),
	     U("object"), U("subindex"), U("sync_manager"), AL("state")),
	KIND(EEPROM, "eeprom", U("flaw"), U("checksum"), U("expected")),
	KIND(NO_CLOCK, "no_clock"),
	KIND(REVISION, "revision", U("expected"), U("found")),
	KIND(WKC, "working_counter", U("domain"), U("working_counter"), U("before"),
	     U("expected"), U("more_changes"), U("slaves_down"), U("incomplete"),
	     U("incomplete_before")),
	KIND(OVERRUN, "overruns", U("cycles")),
	KIND(FRAMES_LOST, "frames_lost", U("frames")),
	KIND(FRAMES_LATE, "frames_late", U("frames")),
	KIND(TIMEOUT, "cycle_timeout", U("duration_ms"), U("timeouts")),
	KIND(RESUMED, "cycle_resumed", U("duration_ms")),
	KIND(STALE, "stale_data", U("domain"), U("age_sends"), U("limit_sends")),
	KIND(STALL, "output_stall", P("policy"), U("cycles"), U("more_stalls")),
	KIND(OUTPUTS, "outputs_again", U("cycles")),
	KIND(WIRE_TIME, "wire_time", U("cyclic_ns"), U("cycle_ns"), U("free_ns"), U("needed_ns")),
	KIND(REF_CLOCK, "reference_clock", S("reference"), U("lost")),
	KIND(DC_SET, "clocks_synchronized", U("duration_us"), S("reference")),
	KIND(DC_FAILED, "clocks_not_synchronized", U("errno"), U("retry")),
	KIND(DC_WINDOW, "sync_window", U("outside"), U("clocks"), S("worst"), U("difference_ns")),
	KIND(LOCK, "cycle_lock", L("cycle_lock"), I("phase_error_ns"), I("rate_ppb")),
	KIND(RESERVED, "reserved", U("pid")),
	KIND(ACTIVATED, "activated", U("pid"), U("domains"), U("bytes"), U("datagrams")),
	KIND(DEACTIVATED, "deactivated", U("pid")),
	KIND(RELEASED, "released", U("pid")),
	KIND(DETACHED, "detached", U("pid")),
	KIND(TAKEN_OVER, "taken_over", U("pid")),
	KIND(DEBUG, "debug_level", U("level")),
	KIND(CONFIG, "configuration", U("alias"), U("position"), U("cause"), U("vendor_id"),
	     U("product_code"), U("found_vendor_id"), U("found_product_code")),
	KIND(CONFIGS, "configurations", U("more")),
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

static const char *event_device(u32 side)
{
	return side ? "backup" : "main";
}

static void about_link(struct text *t, const struct ec_event *e)
{
	const char *what = e->kind == EC_EVENT_DEVICE_ON ? "device attached" :
			   e->kind == EC_EVENT_DEVICE_OFF ? "device detached" :
			   e->kind == EC_EVENT_LINK_UP ? "link up" : "link down";

	format(t, "%s %s", event_device(e->arg[0]), what);
}

/* "slave 5", or "slaves 5 to 9": @n of them */
static const char *neighbours(const struct ec_event *e, u32 n, char *buf, size_t size)
{
	struct text t = { .buf = buf, .size = size };

	if (n < 2)
		format(&t, "slave %u", e->slave);
	else
		format(&t, "slaves %u to %u", e->slave, e->slave + n - 1);
	return buf;
}

/* where slaves are, or were; @n of them */
static void event_place(struct text *t, const struct ec_event *e, const char *what, u32 n)
{
	char alias[24] = "", at[40] = "the main device", who[32];
	struct text a = { .buf = alias, .size = sizeof(alias) };
	struct text p = { .buf = at, .size = sizeof(at) };

	if (e->arg[2])
		format(&a, ", alias %u", e->arg[2]);
	if (e->arg[0] != EC_EVENT_NONE)
		format(&p, "port %u of slave %u", e->arg[1], e->arg[0]);
	neighbours(e, n, who, sizeof(who));
	if (e->kind == EC_EVENT_SLAVE_LOST)
		format(t, "%s (%s0x%08x/0x%08x%s) %s %s, last seen %u ms ago", who,
		       n < 2 ? "" : "the first: ", e->arg[3], e->arg[4], alias, what, at,
		       e->arg[5]);
	else
		format(t, "%s (%s0x%08x/0x%08x%s) %s %s", who, n < 2 ? "" : "the first: ",
		       e->arg[3], e->arg[4], alias, what, at);
}

static void about_bus(struct text *t, const struct ec_event *e)
{
	const u32 *a = e->arg;
	char who[32];

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
		event_place(t, e, "disconnected from", a[6]);
		break;
	case EC_EVENT_ALL_LOST:
		format(t, "all %u slave(s) disconnected, last seen %u ms ago", a[0], a[1]);
		break;
	case EC_EVENT_SLAVE_FOUND:
		event_place(t, e, "connected to", a[5]);
		break;
	case EC_EVENT_SLAVE_SILENT:
		format(t, "no reply from slave %u, frames pass; waiting for a reply", e->slave);
		break;
	case EC_EVENT_SLAVE_REPLIES:
		format(t, "slave %u replies again", e->slave);
		break;
	case EC_EVENT_SLAVE_BACK:
		format(t, "%s back in OP, %u ms after %s last seen",
		       neighbours(e, a[1], who, sizeof(who)), a[0],
		       a[1] < 2 ? "it was" : "they were");
		break;
	case EC_EVENT_NO_ANSWER:
		format(t, "a slave did not answer at its station address in %u polls; rescanning",
		       a[0]);
		break;
	}
}

/* a startup command with its code; without one the mailbox itself failed */
static void startup(struct text *t, const u32 *a)
{
	if (a[2] == EC_CAUSE_IDN)
		format(t, "startup IDN 0x%04x of drive %u, SoE error 0x%04x", a[4], a[5], a[3]);
	else if (a[2] == EC_CAUSE_IP)
		format(t, "IP parameters, EoE result 0x%04x", a[3]);
	else if (a[2] == EC_CAUSE_REGISTER)
		format(t, "startup register 0x%04x", a[4]);
	else if (a[3])
		format(t, "startup SDO 0x%04x:%02x, abort 0x%08x (%s)", a[4], a[5], a[3],
		       ec_coe_abort_text(a[3]));
	else
		format(t, "startup SDO 0x%04x:%02x, mailbox failed", a[4], a[5]);
}

static void pdos(struct text *t, const u32 *a)
{
	if (a[3])
		format(t, "PDOs of SM%u: 0x%04x refused, abort 0x%08x (%s)", a[6], a[4], a[3],
		       ec_coe_abort_text(a[3]));
	else
		format(t, "PDOs of SM%u are not those of the slave", a[6]);
}

/* why a slave failed; nothing: only the AL status code says it */
static void cause(struct text *t, const u32 *a)
{
	const char *state = ec_al_state_name((u8)a[7]);

	switch (a[2]) {
	case EC_CAUSE_SILENT:
		format(t, "no reply, frames pass");
		break;
	case EC_CAUSE_REGISTERS:
		format(t, "no reply at its registers or station address, frames pass");
		break;
	case EC_CAUSE_EEPROM:
		format(t, "EEPROM not readable or invalid");
		break;
	case EC_CAUSE_SDO:
	case EC_CAUSE_IDN:
	case EC_CAUSE_REGISTER:
	case EC_CAUSE_IP:
		startup(t, a);
		break;
	case EC_CAUSE_PDO:
		pdos(t, a);
		break;
	case EC_CAUSE_LAYOUT:
		format(t, "it cannot serve the layout of the process data");
		break;
	case EC_CAUSE_SYNC:
		format(t, "SYNC signals refused, not started or not running");
		break;
	case EC_CAUSE_SLOW:
		format(t, "%s not reached in time", state);
		break;
	case EC_CAUSE_FRAMES:
		format(t, "frames lost before %s", state);
		break;
	case EC_CAUSE_MEMORY:
		format(t, "no memory before %s", state);
		break;
	case EC_CAUSE_REFUSED:
		format(t, "%s refused, AL status code 0x%04x (%s)", state, a[3],
		       ec_al_code_text((u16)a[3]));
		break;
	default:
		format(t, "AL status code 0x%04x (%s)", a[1], ec_al_code_text((u16)a[1]));
	}
}

static void about_failure(struct text *t, const struct ec_event *e)
{
	char why[140] = "";
	struct text w = { .buf = why, .size = sizeof(why) };

	cause(&w, e->arg);
	format(t, "%s of slave %u failed: %s", e->arg[0] == 1 ? "scan" : "configuration", e->slave,
	       why);
}

static void about_slave(struct text *t, const struct ec_event *e)
{
	const char *state = ec_al_state_name((u8)e->arg[0]);
	char who[32];

	switch (e->kind) {
	case EC_EVENT_SLAVE_FAILED:
		about_failure(t, e);
		break;
	case EC_EVENT_EEPROM:
		if (e->arg[0])
			format(t, "slave %u: EEPROM blank or malformed (flaw %u), the valid part is used",
			       e->slave, e->arg[0]);
		else
			format(t, "slave %u: EEPROM checksum 0x%02x, expected 0x%02x; content used anyway",
			       e->slave, e->arg[1], e->arg[2]);
		break;
	case EC_EVENT_NO_CLOCK:
		format(t, "slave %u has no distributed clock; SYNC signals ignored", e->slave);
		break;
	case EC_EVENT_REVISION:
		format(t, "slave %u has revision 0x%08x, expected 0x%08x", e->slave, e->arg[1],
		       e->arg[0]);
		break;
	case EC_EVENT_AL_STATE:
		format(t, "%s: AL state %s, before %s%s%s",
		       neighbours(e, e->arg[2], who, sizeof(who)), state,
		       ec_al_state_name((u8)e->arg[1]), e->arg[3] ? ", in between " : "",
		       e->arg[3] ? ec_al_state_name((u8)e->arg[3]) : "");
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
		format(t, "slave %u: CoE emergency: code 0x%04x (%s), error register 0x%02x",
		       e->slave, e->arg[0], ec_emergency_text((u16)e->arg[0], e->arg[4]),
		       e->arg[1]);
		break;
	}
}

static void about_wkc(struct text *t, const u32 *a)
{
	/* one datagram has too much, another too little */
	const char *sum = a[6] && a[1] == a[3] ? " in sum, not of each datagram" : "";
	const char *more = a[1] > a[3] ? ": more slaves answer than it has, see 'ethercat why'" : "";

	if (a[4])
		format(t, "domain %u: working counter %u of %u%s, before %u%s; %u more change(s)",
		       a[0], a[1], a[3], sum, a[2], more, a[4]);
	else
		format(t, "domain %u: working counter %u of %u%s, before %u%s", a[0], a[1], a[3],
		       sum, a[2], more);
}

static void about_stall(struct text *t, const u32 *a)
{
	/* EC_STALL_* */
	static const char *const done[] = {
		"the last outputs are held", "outputs are zero", "the cycle is stopped",
	};
	const char *what = a[0] < ARRAY_SIZE(done) ? done[a[0]] : "?";

	if (a[2])
		format(t, "output stall: no new outputs for %u cycle(s); %s; %u more stall(s) before",
		       a[1], what, a[2]);
	else
		format(t, "output stall: no new outputs for %u cycle(s); %s", a[1], what);
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
	case EC_EVENT_STALL:
		about_stall(t, a);
		break;
	case EC_EVENT_OUTPUTS:
		format(t, "new outputs after %u cycle(s) without", a[0]);
		break;
	case EC_EVENT_WIRE_TIME:
		format(t, "cyclic frames use %u ns of %u ns; %u ns free for acyclic frames, minimum %u ns",
		       a[0], a[1], a[2], a[3]);
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

/* why a configuration has no slave */
static void about_config(struct text *t, const struct ec_event *e)
{
	const u32 *a = e->arg;

	if (e->kind == EC_EVENT_CONFIGS)
		format(t, "%u more configuration(s) without slave", a[0]);
	else if (a[2] == EC_CAUSE_NO_ALIAS)
		format(t, "configuration %u:%u: no slave has alias %u", a[0], a[1], a[0]);
	else if (a[2] == EC_CAUSE_DIFFERENT)
		format(t, "configuration %u:%u: slave %u is 0x%08x/0x%08x, configured is 0x%08x/0x%08x",
		       a[0], a[1], e->slave, a[5], a[6], a[3], a[4]);
	else if (a[2] == EC_CAUSE_TAKEN)
		format(t, "configuration %u:%u: slave %u has another configuration", a[0], a[1],
		       e->slave);
	else if (a[2] == EC_CAUSE_UNATTACHED)
		format(t, "configuration %u:%u: slave %u is not attached yet", a[0], a[1],
		       e->slave);
	else if (e->slave != EC_EVENT_NO_SLAVE)
		format(t, "configuration %u:%u: slave %u could not be read", a[0], a[1], e->slave);
	else
		format(t, "configuration %u:%u: no slave (0x%08x/0x%08x) at its position", a[0],
		       a[1], a[3], a[4]);
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
		about_config,
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
	return min_t(size_t, t.len, size - 1);
}
