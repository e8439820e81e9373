// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/*
 * Names, texts and levels of events: what the kernel log and 'ethercat log' say about one is the
 * same row of the table.
 */
#include "event.h"
#include "al.h"
#include "event_text.h"

/* the kernel log has its text at once (none, information, warning), or the monitor prints it */
#define NONE	EC_LINE_NONE
#define INFO	EC_LINE_INFO
#define WARNING	EC_LINE_WARN
#define LATER	0x10
/* the text is behind "slave 3: " */
#define SLAVE	0x20

/* the text is that of ec_event_text_add() */
#define SPECIAL	NULL

/**
 * struct row - an event
 * @public: for programs
 * @how: level, LATER, SLAVE
 * @text: with %0 to %7 for its arguments
 */
struct row {
	struct ec_event_kind public;
	u8 how;
	const char *text;
};

#define U(n)	{ n, EC_ARG_U }
#define I(n)	{ n, EC_ARG_I }
#define S(n)	{ n, EC_ARG_SLAVE }
#define AL(n)	{ n, EC_ARG_AL }
#define C(n)	{ n, EC_ARG_AL_CODE }
#define X(n)	{ n, EC_ARG_HEX }
#define D(n)	{ n, EC_ARG_DEVICE }
#define L(n)	{ n, EC_ARG_LOCK }
#define P(n)	{ n, EC_ARG_STALL }
#define KIND(k, n, how, text, ...) \
	{ { EC_EVENT_##k, n, { __VA_ARGS__ } }, how, text }

static const struct row kinds[] = {
	KIND(MISSED, "missed", WARNING | LATER, SPECIAL, U("count"), U("count_high")),
	KIND(DEVICE_ON, "device_attached", INFO, "%0 device attached", D("device")),
	KIND(DEVICE_OFF, "device_detached", INFO, "%0 device detached", D("device")),
	KIND(LINK_UP, "link_up", INFO, "%0 link up", D("device")),
	KIND(LINK_DOWN, "link_down", WARNING, "%0 link down", D("device")),
	KIND(RESPONDING, "slaves_responding", INFO, "slaves responding: %0, before: %1",
	     U("slaves"), U("before")),
	KIND(SCAN_START, "scan_start", NONE, "scan of %0 slave(s) begins", U("slaves")),
	/* without slaves or a change the line about their loss is enough */
	KIND(SCAN_END, "scan_end", INFO, "scan complete: %0 slave(s) in %1 us, %2 frames",
	     U("slaves"), U("duration_us"), U("frames"), U("changed")),
	KIND(SLAVE_LOST, "slave_lost", WARNING, SPECIAL, S("upstream"), U("port"),
	     U("alias"), U("vendor_id"), U("product_code"), U("age_ms"), U("slaves")),
	KIND(ALL_LOST, "all_slaves_lost", WARNING,
	     "all %0 slave(s) disconnected, last seen %1 ms ago", U("slaves"), U("age_ms")),
	KIND(SLAVE_FOUND, "slave_found", INFO, SPECIAL, S("upstream"), U("port"),
	     U("alias"), U("vendor_id"), U("product_code"), U("slaves")),
	/* it is one of the failures of slaves as well */
	KIND(SLAVE_SILENT, "slave_silent", NONE | SLAVE,
	     "no reply, frames pass; waiting for a reply"),
	KIND(SLAVE_REPLIES, "slave_replies", INFO | SLAVE, "replies again"),
	KIND(SLAVE_BACK, "slave_back", INFO | SLAVE, SPECIAL, U("absent_ms"), U("slaves")),
	KIND(NO_ANSWER, "no_answer", WARNING,
	     "a slave did not answer at its station address in %0 polls; rescanning",
	     U("polls")),
	KIND(PORT_KEPT, "port_kept", WARNING | SLAVE, SPECIAL, U("port"), U("reason"), U("losses"),
	     U("period_s"), U("longest_wait_s"), U("vendor_id"), U("product_code"), U("slaves")),
	KIND(LINE_ERRORS, "line_errors", WARNING, SPECIAL, U("port"), U("invalid_frames"),
	     U("receiver_errors"), U("duration_s"), S("to_slave"), U("to_port"), U("to_master")),
	KIND(RING_OPEN, "ring_open", WARNING, SPECIAL, S("slave"), U("port"), S("next")),
	KIND(RING_CLOSED, "ring_closed", INFO, "ring of %0 slave(s) closed", U("slaves")),
	KIND(RING_EXCHANGED, "ring_exchanged", WARNING, SPECIAL, U("exchanged")),
	KIND(RING_TURNED, "ring_turned", WARNING | SLAVE,
	     "connected the wrong way round in the ring, or beside a branch at a wrong port: let port 0 lead towards the main device; until then no application is activated"),
	/* only what fails has a line */
	KIND(AL_STATE, "al_state", NONE | SLAVE, SPECIAL, AL("state"), AL("before"),
	     U("slaves"), AL("lowest")),
	KIND(AL_LEFT, "al_state_left", WARNING | SLAVE,
	     "AL state %1 left without request, now %0", AL("state"), AL("before")),
	KIND(AL_ERROR, "al_error", WARNING | SLAVE,
	     "AL state %0 with error, AL status code %1", AL("state"), C("al_status_code")),
	KIND(EMERGENCY, "emergency", WARNING | SLAVE, SPECIAL, U("code"),
	     U("error_register"), U("data"), U("data_4"), U("profile")),
	KIND(SLAVE_FAILED, "slave_failed", WARNING | SLAVE, SPECIAL, U("error"),
	     C("al_status_code"), U("cause"), U("code"), U("object"), U("subindex"),
	     U("sync_manager"), AL("state")),
	KIND(EEPROM, "eeprom", WARNING | SLAVE, SPECIAL, U("flaw"), U("checksum"),
	     U("expected")),
	KIND(NO_CLOCK, "no_clock", WARNING | SLAVE, "no distributed clock; SYNC signals ignored"),
	KIND(REVISION, "revision", WARNING | SLAVE, "revision %1, expected %0", X("expected"),
	     X("found")),
	KIND(SOE_NOTIFICATION, "soe_notification", INFO | SLAVE, SPECIAL, U("drive"), U("idn"),
	     U("elements"), U("size_bytes"), U("data"), U("data_4")),
	KIND(SOE_EMERGENCY, "soe_emergency", WARNING | SLAVE, SPECIAL, U("drive"), U("idn"),
	     U("elements"), U("size_bytes"), U("data"), U("data_4")),
	KIND(WKC, "working_counter", WARNING | LATER, SPECIAL, U("domain"),
	     U("working_counter"), U("before"), U("expected"), U("more_changes"),
	     U("slaves_down"), U("incomplete"), U("incomplete_before")),
	KIND(OVERRUN, "overruns", WARNING, "%0 cycle(s) skipped", U("cycles")),
	KIND(FRAMES_LOST, "frames_lost", WARNING, "%0 frame(s) lost", U("frames")),
	KIND(FRAMES_LATE, "frames_late", WARNING, "%0 frame(s) late", U("frames")),
	KIND(TIMEOUT, "cycle_timeout", WARNING,
	     "cycle timeout: no cyclic frame for %0 ms; process data stopped",
	     U("duration_ms"), U("timeouts")),
	KIND(RESUMED, "cycle_resumed", INFO, "cycle resumed after %0 ms", U("duration_ms")),
	KIND(STALE, "stale_data", WARNING,
	     "domain %0 receives stale process data: %1 sends old, limit %2; check the delay of the device",
	     U("domain"), U("age_sends"), U("limit_sends")),
	KIND(STALL, "output_stall", WARNING | LATER, SPECIAL, P("policy"), U("cycles"),
	     U("more_stalls")),
	KIND(OUTPUTS, "outputs_again", INFO | LATER, "new outputs after %0 cycle(s) without",
	     U("cycles")),
	KIND(UNIT, "unit", WARNING | LATER, SPECIAL, U("unit"), X("state"), U("reason"),
	     U("domain"), U("working_counter"), U("expected"), U("more_changes"),
	     X("state_before")),
	KIND(WIRE_TIME, "wire_time", WARNING,
	     "cyclic frames use %0 ns of %1 ns; %2 ns free for acyclic frames, minimum %3 ns: lengthen the cycle or overlap PDOs",
	     U("cyclic_ns"), U("cycle_ns"), U("free_ns"), U("needed_ns")),
	KIND(REF_CLOCK, "reference_clock", INFO, SPECIAL, S("reference"), U("lost"),
	     U("substitute")),
	KIND(DC_SET, "clocks_synchronized", INFO,
	     "distributed clocks synchronized in %0 us, reference clock: slave %1",
	     U("duration_us"), S("reference")),
	KIND(DC_FAILED, "clocks_not_synchronized", WARNING, SPECIAL, U("errno"),
	     U("retry")),
	KIND(DC_WINDOW, "sync_window", WARNING, SPECIAL, U("outside"), U("clocks"),
	     S("worst"), U("difference_ns")),
	KIND(LOCK, "cycle_lock", WARNING, SPECIAL, L("cycle_lock"), I("phase_error_ns"),
	     I("rate_ppb"), U("losses")),
	KIND(RESERVED, "reserved", INFO, "application reserved the master, process %0",
	     U("pid")),
	KIND(ACTIVATED, "activated", INFO,
	     "session activated: %1 domain(s), %2 bytes, %3 datagram(s) per cycle, process %0",
	     U("pid"), U("domains"), U("bytes"), U("datagrams")),
	KIND(DEACTIVATED, "deactivated", INFO, "session deactivated, process %0", U("pid")),
	KIND(RELEASED, "released", INFO,
	     "application exited or released the master, process %0", U("pid")),
	KIND(DETACHED, "detached", INFO,
	     "application exited or released the master, process %0; session detached, kernel cycle continues",
	     U("pid")),
	KIND(TAKEN_OVER, "taken_over", INFO,
	     "detached session taken over by a new application, process %0", U("pid")),
	KIND(DEBUG, "debug_level", INFO, "debug level %0", U("level")),
	KIND(CONFIG, "configuration", WARNING, SPECIAL, U("alias"), U("position"),
	     U("cause"), U("vendor_id"), U("product_code"), U("found_vendor_id"),
	     U("found_product_code")),
	KIND(CONFIGS, "configurations", NONE, "%0 more configuration(s) without slave",
	     U("more")),
	KIND(GROUP, "group", WARNING, SPECIAL, U("group"), U("cause"), U("mandatory"),
	     U("members")),
};

static const struct row *row_of(u32 kind)
{
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(kinds); i++)
		if (kinds[i].public.kind == kind)
			return &kinds[i];
	return NULL;
}

/**
 * ec_event_kind() - name and arguments of an event
 * @kind: EC_EVENT_*
 *
 * Return: what it is, or NULL: a newer module has it.
 */
const struct ec_event_kind *ec_event_kind(u32 kind)
{
	const struct row *row = row_of(kind);

	return row ? &row->public : NULL;
}

/* What is expected has no line. */
static u8 wkc_level(const u32 *a)
{
	bool now = !a[6], before = !a[7];

	if (before == now)
		return EC_LINE_NONE;
	/* slaves that come, or are taken to PREOP by their application, change it */
	return now ? EC_LINE_INFO : a[5] ? EC_LINE_NONE : EC_LINE_WARN;
}

/* EC_CYCLE_LOCK_*: 2 is locked, 3 holdover; it seeks at the begin as well */
static u8 lock_level(const u32 *a)
{
	return a[0] == 2 ? EC_LINE_INFO : a[0] == 3 || a[3] ? EC_LINE_WARN : EC_LINE_NONE;
}

static u8 group_level(const u32 *a)
{
	bool expected = a[1] == EC_CAUSE_NONE || (a[1] == EC_CAUSE_NO_GROUP && !a[2]);

	return expected ? EC_LINE_INFO : EC_LINE_WARN;
}

/* A command and what is whole again are no fault. */
static u8 unit_level(const u32 *a)
{
	bool failed = a[2] == 1 ? a[1] & EC_UNIT_LEASE_ENDED :
		      a[2] == 0 ? (a[1] & 0xf) == EC_UNIT_RUN_FAILED : a[2] == 3;

	return failed ? EC_LINE_WARN : EC_LINE_INFO;
}

/**
 * ec_event_level() - what the kernel log has of an event
 * @e: event
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: EC_LINE_*.
 */
enum ec_event_line ec_event_level(const struct ec_event *e)
{
	const struct row *row = row_of(e->kind);
	const u32 *a = e->arg;

	switch (e->kind) {
	case EC_EVENT_SCAN_END:
		return a[0] && a[3] ? EC_LINE_INFO : EC_LINE_NONE;
	case EC_EVENT_WKC:
		return wkc_level(a);
	case EC_EVENT_REF_CLOCK:
		return a[1] ? EC_LINE_WARN : EC_LINE_INFO;
	case EC_EVENT_DC_WINDOW:
		return a[0] ? EC_LINE_WARN : EC_LINE_INFO;
	case EC_EVENT_LOCK:
		return lock_level(a);
	case EC_EVENT_GROUP:
		return group_level(a);
	case EC_EVENT_UNIT:
		return unit_level(a);
	default:
		return row ? row->how & 0xf : EC_LINE_NONE;
	}
}

/**
 * ec_event_is_later() - does the monitor print the line of an event?
 * @kind: EC_EVENT_*
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: the cycle records it, which must not print.
 */
bool ec_event_is_later(u32 kind)
{
	const struct row *row = row_of(kind);

	return row && row->how & LATER;
}

/* slaves of a record: @slave and those after it */
static u32 event_slaves(const struct ec_event *e)
{
	switch (e->kind) {
	case EC_EVENT_SLAVE_BACK:
		return e->arg[1];
	case EC_EVENT_AL_STATE:
		return e->arg[2];
	default:
		return 1;
	}
}

/**
 * ec_event_is_of_slave() - is an event about one slave?
 * @e: event
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: ec_event_line() does not name it.
 */
bool ec_event_is_of_slave(const struct ec_event *e)
{
	const struct row *row = row_of(e->kind);

	return row && row->how & SLAVE && e->slave != EC_EVENT_NO_SLAVE && event_slaves(e) < 2;
}

static void argument(struct ec_event_buf *t, enum ec_event_arg type, u32 v)
{
	switch (type) {
	case EC_ARG_I:
		ec_event_add(t, "%d", (s32)v);
		break;
	case EC_ARG_AL:
		ec_event_add(t, "%s", ec_al_state_name((u8)v));
		break;
	case EC_ARG_AL_CODE:
		ec_event_add(t, "0x%04x (%s)", v, ec_al_code_text((u16)v));
		break;
	case EC_ARG_HEX:
		ec_event_add(t, "0x%08x", v);
		break;
	case EC_ARG_DEVICE:
		ec_event_add(t, "%s", v ? "backup" : "main");
		break;
	default:
		ec_event_add(t, "%u", v);
	}
}

static void fill_in(struct ec_event_buf *t, const struct row *row, const u32 *arg)
{
	const char *s;

	for (s = row->text; *s; s++) {
		if (*s == '%' && s[1] >= '0' && s[1] < '0' + EC_EVENT_ARGS) {
			unsigned int i = (unsigned int)(*++s - '0');

			argument(t, row->public.arg[i].type, arg[i]);
		} else {
			ec_event_add(t, "%c", *s);
		}
	}
}

/* the text without the slave */
static void body(struct ec_event_buf *t, const struct ec_event *e,
		 const struct ec_event_more *more)
{
	const struct row *row = row_of(e->kind);

	if (!row)
		ec_event_add(t, "unknown event 0x%x; a newer module has it", e->kind);
	else if (row->text)
		fill_in(t, row, e->arg);
	else
		ec_event_text_add(t, e, more);
	if (row && row->text && more->detail)
		ec_event_add(t, ": %s", more->detail);
}

static void subject(struct ec_event_buf *t, const struct ec_event *e)
{
	const struct row *row = row_of(e->kind);
	u32 n = event_slaves(e);

	if (!row || !(row->how & SLAVE) || e->slave == EC_EVENT_NO_SLAVE)
		return;
	if (n < 2)
		ec_event_add(t, "slave %u: ", e->slave);
	else
		ec_event_add(t, "slaves %u to %u: ", e->slave, e->slave + n - 1);
}

/**
 * ec_event_line() - the line of the kernel log about an event
 * @e: event
 * @more: what the record does not contain
 * @buf: result, without line end
 * @size: bytes of it, 1 at least; 200 are enough
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_event_line(const struct ec_event *e, const struct ec_event_more *more, char *buf,
		   size_t size)
{
	struct ec_event_buf t = { .at = buf, .size = size };

	buf[0] = '\0';
	if (!ec_event_is_of_slave(e))
		subject(&t, e);
	body(&t, e, more);
}

/**
 * ec_event_text() - one line about an event
 * @e: event; nothing in it is trusted
 * @buf: result, without line end
 * @size: bytes of it; 200 are enough
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: length of the text, at most @size - 1; 0 without a buffer.
 */
int ec_event_text(const struct ec_event *e, char *buf, size_t size)
{
	static const struct ec_event_more none;
	struct ec_event_buf t = { .at = buf, .size = size };

	if (!size)
		return 0;
	buf[0] = '\0';
	subject(&t, e);
	body(&t, e, &none);
	return (int)t.len;
}
