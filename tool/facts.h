/* SPDX-License-Identifier: GPL-2.0-only */
/* All that is known of a master at one time, for the commands that show it as a whole. */
#ifndef EC_TOOL_FACTS_H
#define EC_TOOL_FACTS_H

#include "dev.h"

#define NO_COUNT	ECT_NONE32

/**
 * struct facts - what is known of a master
 * @master: its index
 * @release: version of the module
 * @m: state
 * @c: cycle
 * @devices: main, backup
 * @slaves: in the order of the ring
 * @domains: of the application
 * @domain_count: of @domains
 * @units: sync units of the application
 * @unit_count: of @units
 * @emergencies: of each slave since it was found, NO_COUNT: it has none, or is disconnected
 */
struct facts {
	unsigned int master;
	char release[ECT_STRING];
	struct ect_master m;
	struct ect_cycle c;
	struct ect_list *devices;
	struct slaves slaves;
	struct ect_domain *domains;
	size_t domain_count;
	struct ect_unit *units;
	size_t unit_count;
	u32 *emergencies;
};

int facts_read(struct dev *d, struct facts *f);
/* what facts_read() leaves out: sync units and emergencies */
int facts_read_more(struct dev *d, struct facts *f);
void facts_free(struct facts *f);

#define FACTS_ERRORS	4	/* invalid frames, receiver errors, forwarded errors, lost links */

/* returns how many of @counts are known, from the first on */
size_t facts_errors(const struct ect_port *p, u32 counts[FACTS_ERRORS]);
const char *facts_session(const struct ect_master *m);
/* NULL behind the last one */
const struct ect_device *facts_device(const struct facts *f, size_t i);

#endif
