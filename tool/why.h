/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Causes of what is wrong with a master, its bus and its configurations. why.c reads what the
 * master knows; each rule adds findings, root causes first. What a finding explains is not
 * reported again.
 */
#ifndef EC_TOOL_WHY_H
#define EC_TOOL_WHY_H

#include "dev.h"

#define WHY_NONE	(-1)
#define WHY_REMEDY	400
#define WHY_SCAN_REMEDY	"repeat the command when the scan is complete"
#define WHY_TEXT	2048	/* two lists of some 60 PDO entries each fit */

/**
 * struct why_config - a slave configuration
 * @c: of the application
 * @cause: why its slave is not in OP
 * @text: the same in words, empty: it is in OP
 * @finding: 1 + index of the finding that explains it, 0: none so far
 */
struct why_config {
	struct ec_ioc_config c;
	struct ec_cause cause;
	char text[EC_UAPI_REASON];
	size_t finding;
};

/**
 * struct why_finding - one cause
 * @cause: its name, for programs
 * @warning: nothing stands still because of it
 * @wait: nothing has failed so far
 * @slave: ring position, or %WHY_NONE
 * @port: of @slave, or %WHY_NONE
 * @config: the configuration it is about, or %WHY_NONE
 * @domain: the domain it is about, or %WHY_NONE
 * @code: SDO abort code, AL status code...; 0: none
 * @what: what was found, and expected
 * @remedy: what to do
 */
struct why_finding {
	const char *cause;
	bool warning;
	bool wait;
	int slave;
	int port;
	int config;
	int domain;
	u32 code;
	char what[WHY_TEXT];
	char remedy[WHY_REMEDY];
};

/**
 * struct why - all that is known of a master
 * @d: device file, for reading
 * @m: master
 * @bus: slaves by ring position
 * @configs: slave configurations
 * @n_configs: entries in @configs
 * @f: findings
 * @n: entries in @f
 * @counters: the user may read the error counters of the ports
 * @silent: slaves whose error counters could not be read
 * @unreachable: no slave can be reached, so that only the link was checked
 * @late: frames return too late, so that working counters say nothing of slaves
 * @failed: no memory, or an error that was printed
 */
struct why {
	struct dev *d;
	struct master m;
	struct slaves bus;
	struct why_config *configs;
	size_t n_configs;
	struct why_finding *f;
	size_t n;
	bool counters;
	size_t silent;
	bool unreachable;
	bool late;
	bool failed;
};

/* why.c */
int why_read(struct why *w, struct dev *d);
void why_free(struct why *w);
struct why_finding *why_add(struct why *w, const char *cause, const char *remedy,
			    const char *fmt, ...) __attribute__((format(printf, 4, 5)));
void why_remedy(struct why_finding *f, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
void why_explain(struct why *w, struct why_config *c);
bool why_in_op(const struct why_config *c);
const char *why_slave_name(const struct why *w, unsigned int position, char *buf, size_t size);

/* why_bus.c */
struct why_finding *why_scan(struct why *w);

/* rules: each adds what it finds; true: nothing else can be known */
bool why_bus(struct why *w);
void why_cycle(struct why *w);
void why_unsent(struct why *w);
void why_absent(struct why *w);
void why_slaves(struct why *w);
void why_domains(struct why *w);
void why_clocks(struct why *w);
void why_counters(struct why *w);
void why_emergencies(struct why *w);
void why_late_frames(struct why *w);
void why_lost_frames(struct why *w);

/* why_pdo.c: " configured 0x1600: ...; slave has ..." behind a text */
void why_pdo_lists(struct why *w, const struct why_config *c, unsigned int sm, char *buf,
		   size_t size);

#endif
