/* SPDX-License-Identifier: GPL-2.0-only */
/* Facts as OpenMetrics text. */
#ifndef EC_TOOL_METRICS_H
#define EC_TOOL_METRICS_H

#include <stdio.h>

#include "facts.h"

/**
 * struct metric_family - metrics of one name
 * @name: without the suffix of a sample; ends with the unit, if it has one
 * @type: of OpenMetrics
 * @unit: of OpenMetrics, or NULL
 * @help: a sentence without end
 * @samples: writes those of a master
 * @at: offset of the member that @samples writes, where several share a function
 */
struct metric_family {
	const char *name;
	const char *type;
	const char *unit;
	const char *help;
	void (*samples)(FILE *f, const struct metric_family *m, const struct facts *facts);
	size_t at;
};

#define METRIC(_name, _type, _unit, _help, _samples, ...) { \
	.name = (_name), .type = (_type), .unit = (_unit), .help = (_help), \
	.samples = (_samples), __VA_ARGS__ }

extern const struct metric_family metrics_of_master[];	/* ends without name */
extern const struct metric_family metrics_of_slaves[];	/* likewise */

/* name, suffix and labels of a sample; the caller writes the value */
void metric_begin(FILE *f, const struct metric_family *m, const char *suffix,
		  const struct facts *facts);
void metric_label(FILE *f, const char *name, const char *value);
void metric_number(FILE *f, const char *name, u64 value);
void metric_count(FILE *f, u64 value);
void metric_value(FILE *f, double value);
/* a state of several, each with a sample */
void metric_states(FILE *f, const struct metric_family *m, const struct facts *facts,
		   const char *const *names, size_t n, size_t is, const char *label, u64 value);

void metrics_write(FILE *f, const struct facts *all, size_t n);

#endif
