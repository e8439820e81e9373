// SPDX-License-Identifier: GPL-2.0-only
/* Metrics of slaves and their ports. */
#include "../master/wire/regs.h"
#include "metrics.h"

#define S_PER_NS	1e-9

/* a function for each slave; its ring position is the label "slave" */
static void begin(FILE *f, const struct metric_family *m, const char *suffix,
		  const struct facts *facts, const struct ect_slave *s)
{
	metric_begin(f, m, suffix, facts);
	metric_number(f, "slave", s->position);
}

static void hex(FILE *f, const char *name, u32 value)
{
	fprintf(f, ",%s=\"0x%08x\"", name, value);
}

static void info(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->slaves.n; i++) {
		const struct ect_slave *s = &facts->slaves.v[i];
		char name[ECT_STRING];

		slave_name(s, name, sizeof(name));
		begin(f, m, "_info", facts, s);
		metric_number(f, "device", s->device);
		metric_label(f, "order", s->order);
		metric_label(f, "name", name);
		metric_number(f, "alias", s->alias);
		hex(f, "vendor_id", s->vendor_id);
		hex(f, "product_code", s->product_code);
		hex(f, "revision", s->revision_number);
		hex(f, "serial", s->serial_number);
		metric_count(f, 1);
	}
}

/* A slave that does not reply is in none of them. */
static void al_state(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	static const char *const names[] = { "INIT", "PREOP", "BOOT", "SAFEOP", "OP" };
	static const u8 states[] = { 1, 2, 3, 4, 8 };

	for (size_t i = 0; i < facts->slaves.n; i++) {
		const struct ect_slave *s = &facts->slaves.v[i];
		size_t is = 0;

		while (is < ARRAY_SIZE(states) && (s->cause.kind == ECT_CAUSE_SILENT ||
						   states[is] != (s->al_status & 0xf)))
			is++;
		metric_states(f, m, facts, names, ARRAY_SIZE(names), is, "slave", s->position);
	}
}

static void al_error(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->slaves.n; i++) {
		const struct ect_slave *s = &facts->slaves.v[i];

		begin(f, m, "", facts, s);
		metric_count(f, !!(s->al_status & EC_AL_ERROR));
	}
}

static void fault(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->slaves.n; i++) {
		begin(f, m, "", facts, &facts->slaves.v[i]);
		metric_count(f, facts->slaves.v[i].error != ECT_SLAVE_OK);
	}
}

static void emergencies(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->slaves.n; i++) {
		if (facts->emergencies[i] == NO_COUNT)
			continue;
		begin(f, m, "_total", facts, &facts->slaves.v[i]);
		metric_count(f, facts->emergencies[i]);
	}
}

static void dc_difference(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->slaves.n; i++) {
		const struct ect_slave *s = &facts->slaves.v[i];

		if (!s->dc_set)
			continue;
		begin(f, m, "", facts, s);
		metric_value(f, s->dc_diff * S_PER_NS);
	}
}

static void port_begin(FILE *f, const struct metric_family *m, const char *suffix,
		       const struct facts *facts, size_t slave, unsigned int port)
{
	begin(f, m, suffix, facts, &facts->slaves.v[slave]);
	metric_number(f, "port", port);
}

static void port_up(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->slaves.n; i++)
		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			if (facts->slaves.v[i].ports[p].type < 2)
				continue;
			port_begin(f, m, "", facts, i, p);
			metric_count(f, facts->slaves.v[i].ports[p].link_up);
		}
}

/* @at: index of the count, in the order of struct ect_port */
static void port_errors(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->slaves.n; i++)
		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			u32 counts[FACTS_ERRORS];

			if (facts_errors(&facts->slaves.v[i].ports[p], counts) <= m->at)
				continue;
			port_begin(f, m, "_total", facts, i, p);
			metric_count(f, counts[m->at]);
		}
}

const struct metric_family metrics_of_slaves[] = {
	METRIC("ethercat_slave", "info", NULL, "Identity of the slave at a ring position", info),
	METRIC("ethercat_slave_al_state", "stateset", NULL, "AL state", al_state),
	METRIC("ethercat_slave_al_error", "gauge", NULL,
	       "Whether the slave reports an error", al_error),
	METRIC("ethercat_slave_fault", "gauge", NULL,
	       "Whether its scan or its configuration has failed",
	  fault),
	METRIC("ethercat_slave_emergencies", "counter", NULL,
	       "CoE emergencies since the slave was found",
	  emergencies),
	METRIC("ethercat_slave_dc_difference_seconds", "gauge", "seconds",
	  "Difference to the reference clock at the last read", dc_difference),
	METRIC("ethercat_port_up", "gauge", NULL, "Whether the port has a link", port_up),
	METRIC("ethercat_port_invalid_frames", "counter", NULL,
	  "Frames that were damaged on the way to the port", port_errors, .at = 0),
	METRIC("ethercat_port_receiver_errors", "counter", NULL,
	  "Errors of the receiver, also between frames", port_errors, .at = 1),
	METRIC("ethercat_port_forwarded_errors", "counter", NULL,
	  "Frames that an upstream slave has found damaged", port_errors, .at = 2),
	METRIC("ethercat_port_lost_links", "counter", NULL, "Times the port has lost its link",
	  port_errors, .at = 3),
	{ 0 },
};
