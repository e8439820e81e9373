// SPDX-License-Identifier: GPL-2.0-only
/* The cycle with its histogram; domains and sync units. */
#include "cycle_text.h"
#include "report.h"
#include "unit.h"

#define OCTAVE	8	/* buckets of a power of two */
#define BAR	500	/* width of the longest */
#define ROW	20

static u64 sends_of(const struct ect_cycle *c, unsigned int octave)
{
	u64 sum = 0;

	for (unsigned int i = 0; i < OCTAVE; i++)
		sum += c->late[octave * OCTAVE + i];
	return sum;
}

static void bar(FILE *f, const struct ect_cycle *c, unsigned int octave, unsigned int y, u64 most)
{
	u64 n = sends_of(c, octave);
	/* one send of a million is visible as well */
	u64 width = (n * BAR + most - 1) / most;

	fprintf(f, "<text x=\"150\" y=\"%u\" text-anchor=\"end\">%.3f to %.3f</text><rect class=\"bar\" x=\"160\" y=\"%u\" width=\"%llu\" height=\"%u\"/><text x=\"%llu\" y=\"%u\">%llu</text>\n", y + 15,
		(double)ect_bucket_ns(octave * OCTAVE) / 1000,
		(double)(ect_bucket_ns((octave + 1) * OCTAVE) - 1) / 1000, y + 3,
		(unsigned long long)width, ROW - 4, 166 + (unsigned long long)width, y + 15,
		(unsigned long long)n);
}

static void histogram(FILE *f, const struct ect_cycle *c)
{
	unsigned int first = ECT_BUCKETS / OCTAVE, last = 0;
	u64 most = 0;

	for (unsigned int i = 0; i < ECT_BUCKETS / OCTAVE; i++) {
		u64 n = sends_of(c, i);

		if (!n)
			continue;
		first = min(first, i);
		last = i;
		most = max(most, n);
	}
	if (!most)
		return;
	html_text(f, "p", NULL, "Send deviation [us], sends:");
	fprintf(f, "<svg role=\"img\" viewBox=\"0 0 %u %u\" width=\"%u\">\n", BAR + 280,
		(last - first + 1) * ROW, BAR + 280);
	for (unsigned int i = first; i <= last; i++)
		bar(f, c, i, (i - first) * ROW, most);
	fputs("</svg>\n", f);
}

static void figures(const struct report *r)
{
	const struct ect_cycle *c = &r->facts.c;
	double sends = (double)c->late_count;

	html_table(r->f, "By|State|Cycle time [us]|Wire [us]|Sends|Overruns|Without new outputs|Deviation mean [us]|99.9 % [us]|Max [us]|Execution mean [us]|Max [us]");
	html_row(r->f);
	html_cell(r->f, "%s", cycle_by(c));
	html_cell(r->f, "%s", cycle_state(c));
	html_cell(r->f, "%.3f", c->interval_ns / 1000.0);
	html_cell(r->f, "%.2f", r->facts.m.cycle_wire_ns / 1000.0);
	html_cell(r->f, "%llu", (unsigned long long)c->late_count);
	html_cell(r->f, "%llu", (unsigned long long)c->overruns);
	html_cell(r->f, "%llu", (unsigned long long)c->missed);
	html_cell(r->f, "%.3f", sends > 0 ? (double)c->late_sum / sends / 1000 : 0);
	html_cell(r->f, "%.3f", (double)ect_cycle_quantile(c, 999) / 1000);
	html_cell(r->f, "%.3f", c->late_max / 1000.0);
	html_cell(r->f, "%.3f", c->work_count ?
		  (double)c->work_sum / (double)c->work_count / 1000 : 0);
	html_cell(r->f, "%.3f", c->work_max / 1000.0);
	html_table_end(r->f);
}

static void domains(const struct report *r)
{
	if (!r->facts.domain_count)
		return;
	html_heading(r->f, "Domains");
	html_table(r->f, "Domain|Bytes|Working counter|Expected|Complete|Age [sends]");
	for (size_t i = 0; i < r->facts.domain_count; i++) {
		const struct ect_domain *d = &r->facts.domains[i];

		html_row(r->f);
		html_cell(r->f, "%zu", i);
		html_cell(r->f, "%u", d->size);
		html_cell(r->f, "%u", d->working_counter);
		html_cell(r->f, "%u", d->expected);
		html_cell(r->f, "%s", d->wc_state == ECT_WC_COMPLETE ? "yes" : "no");
		html_cell(r->f, "%u", d->age);
	}
	html_table_end(r->f);
}

static void units(const struct report *r)
{
	if (!r->facts.unit_count)
		return;
	html_heading(r->f, "Sync units");
	html_table(r->f, "Unit|Name|Policy|State|Outputs|Faults");
	for (size_t i = 0; i < r->facts.unit_count; i++) {
		const struct ect_unit *u = &r->facts.units[i];

		html_row(r->f);
		html_cell(r->f, "%zu", i);
		html_cell(r->f, "%s", u->name);
		html_cell(r->f, "%s", unit_policy(u));
		html_cell(r->f, "%s", u->active ? unit_run(u) : "not active");
		html_cell(r->f, "%s", u->active ? unit_outputs(u) : "");
		html_cell(r->f, "%u", u->faults);
	}
	html_table_end(r->f);
}

int report_cycle(const struct report *r)
{
	html_heading(r->f, "Cycle");
	if (r->facts.c.kind == ECT_CYCLE_BY_NOBODY) {
		html_text(r->f, "p", NULL, "No cycle has run yet.");
	} else {
		figures(r);
		histogram(r->f, &r->facts.c);
	}
	domains(r);
	units(r);
	return 0;
}
