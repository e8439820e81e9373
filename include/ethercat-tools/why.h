/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: why slaves are not in OP. */
#ifndef ETHERCAT_TOOLS_WHY_H
#define ETHERCAT_TOOLS_WHY_H

#include "app.h"

#ifdef __cplusplus
extern "C" {
#endif

/* struct ect_finding.level */
#define ECT_FAULT	0	/* something stands still because of it */
#define ECT_UNDER_WAY	1	/* nothing has failed so far */
#define ECT_WARNING	2	/* nothing stands still because of it */

#define ECT_NONE	(-1)	/* no place */
#define ECT_EVIDENCE	4

/* one cause; what it explains has no finding of its own */
struct ect_finding {
	uint32_t struct_size;
	uint32_t level;		/* ECT_FAULT... */
	int32_t slave;		/* ring position, or ECT_NONE */
	int32_t port;		/* of @slave, or ECT_NONE */
	int32_t config;		/* index in ect_why_configs(), or ECT_NONE */
	int32_t domain;		/* index, or ECT_NONE */
	uint32_t code;		/* SDO abort code, AL status code...; 0: none */
	uint32_t evidence_count;	/* valid ones of @evidence, see ect_evidence() */
	int64_t evidence[ECT_EVIDENCE];
	uint64_t device;	/* number of @slave */
	char cause[32];		/* its name, which never changes its meaning */
	char text[2048];	/* what was found, and expected */
	char remedy[400];	/* what to do */
};

/* a slave configuration, and what explains that its slave is not in OP */
struct ect_explained {
	uint32_t struct_size;
	uint32_t finding;	/* 1 + index in ect_why_findings(); 0: none */
	struct ect_cause cause;
	char text[ECT_TEXT];	/* as of ect_config_why() */
	struct ect_config config;	/* last, as it grows */
};

/* what was checked: no finding means that it is in order */
struct ect_checked {
	uint32_t struct_size;
	uint32_t unreachable;	/* no slave can be reached: only the link was checked */
	uint32_t session;	/* ECT_SESSION_* */
	uint32_t slaves;
	uint32_t configs;
	uint32_t in_op;		/* configurations whose slave is in OP */
	uint32_t domains;
	uint32_t counters;	/* error counters of the ports: the user may read registers */
	uint32_t silent;	/* slaves whose error counters could not be read */
	uint32_t unasked;	/* slaves whose drives (SoE) were not asked: the user may not */
};

struct ect_why;

/**
 * ect_why() - find out why slaves are not in OP
 * @h: master
 * @w: result, to be freed with ect_why_free()
 *
 * Goes from the symptoms to the causes: device, link, cycle, missing and different slaves, PDOs,
 * SDOs, AL status codes, clocks, working counters, EEPROMs, error counters, emergencies, errors of
 * drives (SoE). Reads what the master knows; only the error counters of the ports are read from
 * the slaves, and drives are asked for their errors, if the user may. May wait half a second to see
 * whether a counter still grows.
 *
 * Context: The thread of the handle.
 * Return: 0, also when there are faults; or a negative errno.
 */
int ect_why(struct ect_handle *h, struct ect_why **w);

/**
 * ect_why_quiet() - as ect_why(), without traffic
 * @h: master
 * @w: result, to be freed with ect_why_free()
 *
 * Error counters are as the master has read them last; a slave whose counters were not read yet
 * counts as @silent in struct ect_checked. No drive is asked: slaves with SoE count as @unasked.
 *
 * Context: The thread of the handle; no traffic.
 * Return: As ect_why().
 */
int ect_why_quiet(struct ect_handle *h, struct ect_why **w);

/**
 * ect_why_free() - free a result and all that was got from it
 * @w: result, or NULL
 *
 * Context: Any thread; the handle may be freed already.
 */
void ect_why_free(struct ect_why *w);

/**
 * ect_why_findings() - the causes
 * @w: result
 *
 * Context: Any thread, while no other one frees the result.
 * Return: list of struct ect_finding, root causes first; it belongs to the result.
 */
const struct ect_list *ect_why_findings(const struct ect_why *w);

/**
 * ect_why_configs() - the slave configurations, with what explains each
 * @w: result
 *
 * Context: Any thread, while no other one frees the result.
 * Return: list of struct ect_explained; it belongs to the result.
 */
const struct ect_list *ect_why_configs(const struct ect_why *w);

/**
 * ect_why_slaves() - the slaves at the time of ect_why()
 * @w: result
 *
 * Context: Any thread, while no other one frees the result.
 * Return: list of struct ect_slave; it belongs to the result.
 */
const struct ect_list *ect_why_slaves(const struct ect_why *w);

/**
 * ect_why_checked() - what was checked
 * @w: result
 *
 * Context: Any thread, while no other one frees the result.
 * Return: it belongs to the result.
 */
const struct ect_checked *ect_why_checked(const struct ect_why *w);

/**
 * ect_evidence() - the name of a number of a finding
 * @f: finding
 * @i: index in its @evidence
 * @name: for the name: one word, with the unit
 * @size: bytes at @name
 *
 * Context: Any.
 * Return: 0, or -ENOENT behind the last one.
 */
int ect_evidence(const struct ect_finding *f, unsigned int i, char *name, size_t size);

#ifdef __cplusplus
}
#endif

#endif
