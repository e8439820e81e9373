// SPDX-License-Identifier: GPL-2.0-only
/* Slaves, clocks, error counters and emergencies. */
#include "report.h"
#include "slave_info.h"

static void slaves(const struct report *r)
{
	html_heading(r->f, "Slaves");
	html_table(r->f, "Position|Name|Order number|Alias|State|Vendor|Product|Revision|Serial number|Cause");
	for (size_t i = 0; i < r->facts.slaves.n; i++) {
		const struct ect_slave *s = &r->facts.slaves.v[i];
		char name[ECT_STRING], state[16];

		slave_name(s, name, sizeof(name));
		slave_state_text(s, state, sizeof(state));
		html_row(r->f);
		html_cell(r->f, "%u", s->position);
		html_cell(r->f, "%s", name);
		html_cell(r->f, "%s", s->order);
		html_cell(r->f, "%u", s->alias);
		html_cell(r->f, "%s", state);
		html_cell(r->f, "0x%08x", s->vendor_id);
		html_cell(r->f, "0x%08x", s->product_code);
		html_cell(r->f, "0x%08x", s->revision_number);
		html_cell(r->f, "0x%08x", s->serial_number);
		html_cell(r->f, "%s%s%s", s->why, *s->why && *s->warning ? "; " : "", s->warning);
	}
	html_table_end(r->f);
}

static void clocks(const struct report *r)
{
	html_heading(r->f, "Clocks");
	if (r->facts.m.ref_clock < 0)
		html_text(r->f, "p", NULL, "No reference clock.");
	else
		html_text(r->f, "p", NULL, "Reference clock: slave %d.", r->facts.m.ref_clock);
	html_table(r->f, "Position|Difference [ns]|Delay [ns]|Remark");
	for (size_t i = 0; i < r->facts.slaves.n; i++) {
		const struct ect_slave *s = &r->facts.slaves.v[i];

		if (!slave_has_dc(s))
			continue;
		html_row(r->f);
		html_cell(r->f, "%u", s->position);
		if (s->dc_set)
			html_cell(r->f, "%d", s->dc_diff);
		else
			html_cell(r->f, "not synchronized");
		html_cell(r->f, "%u", s->transmission_delay);
		html_cell(r->f, "%s", s->dc_odd ? "delay unreliable, receive times contradict the topology" :
			  s->dc_set && (s->dc_diff > ECT_DC_WINDOW || s->dc_diff < -ECT_DC_WINDOW) ?
			  "outside window (1000 ns)" : "");
	}
	html_table_end(r->f);
}

static bool any_error(const u32 *counts, size_t n)
{
	for (size_t i = 0; i < n; i++)
		if (counts[i])
			return true;
	return false;
}

static void error_counters(const struct report *r)
{
	size_t unread = 0;

	html_heading(r->f, "Error counters of the ports");
	html_table(r->f, "Position|Port|Invalid frames|Receiver errors|Forwarded errors|Lost links");
	for (size_t i = 0; i < r->facts.slaves.n; i++) {
		const struct ect_slave *s = &r->facts.slaves.v[i];
		bool known = false;

		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			u32 counts[FACTS_ERRORS];
			size_t n = facts_errors(&s->ports[p], counts);

			known |= n;
			if (!any_error(counts, n))
				continue;
			html_row(r->f);
			html_cell(r->f, "%u", s->position);
			html_cell(r->f, "%u", p);
			for (size_t k = 0; k < FACTS_ERRORS; k++)
				if (k < n)
					html_cell(r->f, "%u", counts[k]);
				else
					html_cell(r->f, "-");
		}
		unread += !known;
	}
	html_table_end(r->f);
	html_text(r->f, "p", "note", "All others are 0. Slaves whose counters were not read: %zu.",
		  unread);
}

static void emergency(const struct report *r, unsigned int position,
		      const struct ect_emergency *e)
{
	char when[HTML_TIME];

	html_row(r->f);
	html_cell(r->f, "%u", position);
	html_cell(r->f, "%s", html_time(e->time_ns, when));
	html_cell(r->f, "0x%04x", e->code);
	html_cell(r->f, "0x%02x", e->error_register);
	html_cell(r->f, "%s", e->text);
}

static void emergencies(const struct report *r)
{
	html_heading(r->f, "CoE emergencies");
	html_table(r->f, "Position|Time (UTC)|Code|Error register|Text");
	for (size_t i = 0; i < r->facts.slaves.n; i++) {
		const struct ect_slave *s = &r->facts.slaves.v[i];
		const struct ect_emergency *e;
		struct ect_list *list = NULL;

		if (r->facts.emergencies[i] == NO_COUNT ||
		    ect_emergencies_read(r->d->h, s->device, NULL, &list))
			continue;
		for (size_t k = 0; (e = ect_list_get(list, k)); k++)
			emergency(r, s->position, e);
		ect_list_free(list);
	}
	html_table_end(r->f);
}

int report_slaves(const struct report *r)
{
	slaves(r);
	clocks(r);
	error_counters(r);
	emergencies(r);
	return 0;
}
