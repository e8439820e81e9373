// SPDX-License-Identifier: GPL-2.0-only
/*
 * OpenMetrics 1.0: all samples of a name follow each other, so the outer loop goes over the names
 * and the inner one over the masters.
 */
#include "metrics.h"

#include "escape.h"

void metric_begin(FILE *f, const struct metric_family *m, const char *suffix,
		  const struct facts *facts)
{
	fprintf(f, "%s%s{master=\"%u\"", m->name, suffix, facts->master);
}

void metric_label(FILE *f, const char *name, const char *value)
{
	fprintf(f, ",%s=\"", name);
	escape_label(f, value);
	fputc('"', f);
}

void metric_number(FILE *f, const char *name, u64 value)
{
	fprintf(f, ",%s=\"%llu\"", name, (unsigned long long)value);
}

void metric_count(FILE *f, u64 value)
{
	fprintf(f, "} %llu\n", (unsigned long long)value);
}

void metric_value(FILE *f, double value)
{
	fprintf(f, "} %.12g\n", value);
}

void metric_states(FILE *f, const struct metric_family *m, const struct facts *facts,
		   const char *const *names, size_t n, size_t is, const char *label, u64 value)
{
	for (size_t i = 0; i < n; i++) {
		metric_begin(f, m, "", facts);
		if (label)
			metric_number(f, label, value);
		metric_label(f, m->name, names[i]);
		metric_count(f, i == is);
	}
}

static void families(FILE *f, const struct metric_family *m, const struct facts *all, size_t n)
{
	for (; m->name; m++) {
		fprintf(f, "# TYPE %s %s\n", m->name, m->type);
		if (m->unit)
			fprintf(f, "# UNIT %s %s\n", m->name, m->unit);
		fprintf(f, "# HELP %s %s.\n", m->name, m->help);
		for (size_t i = 0; i < n; i++)
			m->samples(f, m, &all[i]);
	}
}

/**
 * metrics_write() - write what is known of masters as OpenMetrics text
 * @f: file
 * @all: of each master
 * @n: how many
 */
void metrics_write(FILE *f, const struct facts *all, size_t n)
{
	families(f, metrics_of_master, all, n);
	families(f, metrics_of_slaves, all, n);
	fputs("# EOF\n", f);
}
