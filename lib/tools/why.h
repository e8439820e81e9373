/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Causes of what is wrong with a master, its bus and its configurations. why.c reads what the
 * master knows; each rule adds findings, root causes first. What a finding explains is not
 * reported again.
 */
#ifndef EC_LIB_TOOLS_WHY_H
#define EC_LIB_TOOLS_WHY_H

#include "internal.h"
#include "why_texts.h"

/**
 * struct why - all that is known of a master
 * @h: master
 * @m: its state
 * @devices: struct ect_device
 * @bus: struct ect_slave by ring position
 * @absent: struct ect_absent
 * @configs: struct ect_explained
 * @findings: struct ect_finding
 * @quiet: error counters are those that the master has read
 * @counters: the user may read the error counters of the ports
 * @silent: slaves whose error counters could not be read
 * @unasked: slaves whose drives were not asked for their errors
 * @late: there are late frames, so working counters show nothing about slaves
 * @failed: no memory for a finding
 * @lost: finding that a rule writes to instead
 */
struct why {
	struct ect_handle *h;
	struct ect_master m;
	struct ect_list *devices;
	struct ect_list *bus;
	struct ect_list *absent;
	struct ect_list *configs;
	struct ect_list *findings;
	bool quiet;
	bool counters;
	u32 silent;
	u32 unasked;
	bool late;
	bool failed;
	struct ect_finding lost;
};

/* which row of the table */
enum why_text {
#define WHY_ENUM(id, ...)	WHY_##id,
	WHY_TEXTS(WHY_ENUM)
#undef WHY_ENUM
};

/* their formats, which the compiler compares with the arguments */
#define WHY_WHAT(id, cause, level, evidence, remedy, what)	why_what_##id[] = what,
#define WHY_REMEDY(id, text)	why_remedy_##id[] = text,
static const char WHY_TEXTS(WHY_WHAT) WHY_REMEDIES(WHY_REMEDY) why_end[] = "";

/* a finding of that row, without place; valid until the next one */
#define why_add(w, id, ...)	why_add_finding(w, WHY_##id, why_what_##id, ##__VA_ARGS__)
/* another row for a finding, which keeps its place */
#define why_change(f, id, ...)	why_set_finding(f, WHY_##id, why_what_##id, ##__VA_ARGS__)
/* a remedy with more in it */
#define why_remedy(f, id, ...)	why_set_remedy(f, why_remedy_##id, ##__VA_ARGS__)

/* why.c */
struct ect_finding *why_add_finding(struct why *w, enum why_text id, const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));
void why_set_finding(struct ect_finding *f, enum why_text id, const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));
void why_set_remedy(struct ect_finding *f, const char *fmt, ...)
	__attribute__((format(printf, 2, 3)));
void why_explain(struct why *w, struct ect_explained *c);
bool why_in_op(const struct ect_explained *c);
const char *why_slave_name(const struct why *w, unsigned int position, char *buf, size_t size);
struct ect_handle *why_open(struct why *w);
/* does a finding have this cause? */
bool why_has(const struct why *w, const char *cause);

static inline struct ect_slave *why_slave(const struct why *w, size_t position)
{
	return ect_list_at(w->bus, position);
}

static inline struct ect_explained *why_config(const struct why *w, size_t i)
{
	return ect_list_at(w->configs, i);
}

static inline struct ect_finding *why_finding(const struct why *w, size_t i)
{
	return ect_list_at(w->findings, i);
}

static inline struct ect_device *why_device(const struct why *w, size_t i)
{
	return ect_list_at(w->devices, i);
}

/* why_bus.c */
struct ect_finding *why_scan(struct why *w);

/* rules: each adds what it finds; true: nothing else can be known */
bool why_bus(struct why *w);
void why_ring(struct why *w);
void why_cycle(struct why *w);
void why_unsent(struct why *w);
void why_absent(struct why *w);
void why_ports(struct why *w);
void why_slaves(struct why *w);
void why_domains(struct why *w);

/* why_units.c */
void why_units(struct why *w);
void why_clocks(struct why *w);
void why_counters(struct why *w);
void why_emergencies(struct why *w);
void why_drives(struct why *w);
void why_late_frames(struct why *w);
void why_lost_frames(struct why *w);

/* why_pdo.c: " configured 0x1600: ...; slave has ..." behind a text */
void why_pdo_lists(struct why *w, const struct ect_explained *c, unsigned int sm, char *buf,
		   size_t size);

/* why_codes.c */
const char *why_al_remedy(u32 code);
const char *why_sdo_remedy(u32 code);

#endif
