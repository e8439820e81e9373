// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "../master/wire/al.h"
#include "dev.h"
#include "out.h"
#include "sys.h"

static void name_or_null(const char *key, const char *name)
{
	if (name)
		out_str(key, name, NULL);
	else
		out_null(key, NULL);
}

/* as EC_CYCLE_* of ecrt.h */
static const char *stall_key(u32 policy)
{
	static const char *const key[] = { "hold", "zero", "stop" };

	return policy < ARRAY_SIZE(key) ? key[policy] : NULL;
}

/* by the names that the other commands have */
static void argument(const char *key, u32 type, u32 v)
{
	switch (type) {
	case ECT_ARG_SIGNED:
		out_i(key, (s32)v, NULL);
		break;
	case ECT_ARG_AL_STATE:
		name_or_null(key, v ? ec_al_state_name((u8)v) : NULL);
		break;
	case ECT_ARG_STALL:
		name_or_null(key, stall_key(v));
		break;
	case ECT_ARG_LOCK:
		name_or_null(key, cycle_lock_key(v));
		break;
	case ECT_ARG_SLAVE:
		if (v == ECT_NONE32) {
			out_null(key, NULL);
			break;
		}
		/* fall through */
	default:
		out_u(key, v, NULL);
	}
}

static void arguments(const struct ect_event *e)
{
	const char *name;
	u32 type = 0;

	if (e->kind == ECT_EVENT_MISSED) {
		out_u("count", e->missed, NULL);
		return;
	}
	for (unsigned int i = 0; (name = ect_event_arg(e->kind, i, &type)); i++)
		argument(name, type, e->arg[i]);
}

static void event(const struct dev *d, bool with_master, const struct ect_event *e)
{
	const time_t s = (time_t)(e->wall_ns / 1000000000);
	char when[32] = "?";
	struct tm tm;

	if (gmtime_r(&s, &tm))
		strftime(when, sizeof(when), "%Y-%m-%d %H:%M:%S", &tm);
	out_object(NULL);
	if (with_master)
		out_u("master", d->master, NULL);
	out_u("number", e->number, NULL);
	out_text("%s.%06u UTC", when, (unsigned int)(e->wall_ns / 1000 % 1000000));
	out_u("time_ns", e->wall_ns, NULL);
	out_u("monotonic_ns", e->time_ns, "  [%6llu.%06llu]",
	      (unsigned long long)(e->time_ns / 1000000000),
	      (unsigned long long)(e->time_ns / 1000 % 1000000));
	out_str("event", e->name, NULL);
	if (e->slave != ECT_NONE32)
		out_u("slave", e->slave, NULL);
	arguments(e);
	out_str("text", e->text, "  %s\n", e->text);
	out_end();
}

/* Wait for an event; false: stdout was closed, which no write shows while nothing happens. */
static bool wait_event(const struct dev *d)
{
	struct pollfd p[] = { { .fd = ect_fd(d->h), .events = POLLIN }, { .fd = STDOUT_FILENO } };
	int n;

	do
		n = sys_poll(p, 2);
	while (n < 0 && errno == EINTR);
	return n < 0 || !(p[1].revents & POLLERR);
}

/* one event up to number @end; false: it is the last */
static bool shown(const struct dev *d, bool follow, u64 *at, u64 end, const struct ect_event *e)
{
	if (!follow && *at >= end)
		return false;
	event(d, follow, e);
	*at = e->number + 1;
	if (e->kind == ECT_EVENT_MISSED)
		*at += e->missed - 1;
	return true;
}

/* events up to number @end, or without end */
static int print(struct dev *d, u64 at, u64 end, bool follow)
{
	while (follow || at < end) {
		struct ect_list *list;
		size_t n;
		int err;

		if (follow && !wait_event(d))
			return 0;
		err = ect_events_read(d->h, &list);
		if (err)
			return dev_fail(d, err, "Master%u: cannot read events", d->master);
		n = ect_list_count(list);
		for (size_t i = 0; i < n && shown(d, follow, &at, end, ect_list_get(list, i)); i++)
			;
		ect_list_free(list);
		/* the end of the command reports why stdout takes no more */
		if (!n || (follow && fflush(stdout)))
			return 0;
	}
	return 0;
}

static int begin(struct dev *d, u64 *first, u64 *next)
{
	int err = ect_events_begin(d->h, 0, first, next);

	return err ? dev_fail(d, err, "Master%u: cannot read events", d->master) : 0;
}

static int each(const struct tool *t, struct dev *d)
{
	u64 first, next;
	int ret = begin(d, &first, &next);

	(void)t;
	if (ret)
		return ret;
	if (d->selected > 1)
		out_text("Master%u\n", d->master);
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_array("events");
	ret = print(d, first, next, false);
	out_end();
	out_end();
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	u64 first, next;
	struct dev d;
	int ret;

	(void)argc, (void)argv;
	if (!t->follow) {
		out_array("masters");
		ret = dev_each(t, false, each);
		out_end();
		return ret;
	}
	ret = dev_open_single(&d, t, false);
	if (ret)
		return ret;
	ret = begin(&d, &first, &next) ?: print(&d, first, 0, true);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_log = {
	.name = "log",
	.run = run,
	.args = "",
	.opts = "mF",
	.summary = "Show what has happened on the bus",
	.help = "Links, slaves that connect or disconnect, AL states and errors, emergencies, working\n"
		"counters, clocks, cycles, applications. The master keeps the last 2047 events since the\n"
		"module was loaded; reading takes none away. Columns: time, time since the start of the\n"
		"computer, event. With --follow the command also shows each event that comes later; with\n"
		"several masters, -m selects one. A reader that is too slow gets the number of events\n"
		"missed.\n",
	.json = "masters[]: master, events[]: number, time_ns (since 1970), monotonic_ns, event, slave,\n"
		"values of the event, text. With --follow each line is an object: master, and the\n"
		"same. AL states are names, cycle_lock is as of 'ethercat master', policy is hold, zero\n"
		"or stop; null: none. Values\n"
		"by event: missed (count), device_attached, device_detached, link_up, link_down\n"
		"(device), slaves_responding (slaves, before), scan_start (slaves), scan_end (slaves,\n"
		"duration_us, frames, changed), slave_lost (upstream, port, alias, vendor_id, product_code,\n"
		"age_ms, slaves), all_slaves_lost (slaves, age_ms), slave_found (upstream, port, alias,\n"
		"vendor_id, product_code, slaves), slave_silent, slave_replies (none), slave_back\n"
		"(absent_ms, slaves), no_answer (polls),\n"
		"port_kept (port, reason, losses, period_s, longest_wait_s, vendor_id, product_code,\n"
		"slaves), line_errors (port, invalid_frames, receiver_errors, duration_s, to_slave, to_port,\n"
		"to_master), ring_open (slave, port, next), ring_closed (slaves),\n"
		"ring_exchanged (exchanged), ring_turned (none),\n"
		"al_state (state, before, slaves, lowest),\n"
		"al_state_left (state, before), al_error (state, al_status_code), emergency\n"
		"(code, error_register, data, data_4, profile), slave_failed (error, al_status_code, cause,\n"
		"code, object, subindex, sync_manager, state), eeprom (flaw, checksum, expected), no_clock (none), revision (expected, found),\n"
		"soe_notification, soe_emergency (drive, idn, elements, size_bytes, data, data_4),\n"
		"working_counter (domain,\n"
		"working_counter, before, expected, more_changes, slaves_down, incomplete,\n"
		"incomplete_before), overruns (cycles), frames_lost, frames_late (frames),\n"
		"cycle_timeout (duration_ms, timeouts),\n"
		"cycle_resumed (duration_ms), stale_data (domain, age_sends, limit_sends),\n"
		"output_stall (policy, cycles, more_stalls), outputs_again (cycles),\n"
		"unit (unit, state, reason, domain, working_counter, expected, more_changes,\n"
		"state_before),\n"
		"wire_time (cyclic_ns, cycle_ns, free_ns, needed_ns), reference_clock (reference, lost,\n"
		"substitute),\n"
		"clocks_synchronized (duration_us, reference), clocks_not_synchronized (errno,\n"
		"retry), sync_window (outside, clocks, worst, difference_ns), cycle_lock (cycle_lock,\n"
		"phase_error_ns, rate_ppb, losses), reserved (pid), activated (pid, domains, bytes,\n"
		"datagrams), deactivated, released, detached, taken_over (pid), debug_level (level),\n"
		"configuration (alias, position, cause, vendor_id, product_code, found_vendor_id,\n"
		"found_product_code), configurations (more), group (group, cause, mandatory, members)",
};
