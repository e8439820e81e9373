// SPDX-License-Identifier: GPL-2.0-only
/* Metrics of masters, links, cycles, domains and sync units. */
#include <string.h>

#include "metrics.h"

#define MEMBER(type, member)	.at = offsetof(struct type, member)
#define S_PER_NS		1e-9

static u32 u32_at(const void *p, size_t at)
{
	u32 v;

	memcpy(&v, (const char *)p + at, sizeof(v));
	return v;
}

static u64 u64_at(const void *p, size_t at)
{
	u64 v;

	memcpy(&v, (const char *)p + at, sizeof(v));
	return v;
}

static const char *suffix_of(const struct metric_family *m)
{
	return strcmp(m->type, "counter") ? "" : "_total";
}

/* --- master ------------------------------------------------------------------ */

static void info(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	metric_begin(f, m, "_info", facts);
	metric_label(f, "module", facts->release);
	metric_label(f, "owner", facts_session(&facts->m));
	metric_count(f, 1);
}

static void session(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	static const char *const names[] = { "none", "reserved", "active", "detached" };

	metric_states(f, m, facts, names, ARRAY_SIZE(names), facts->m.session, NULL, 0);
}

static void master_u32(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	metric_begin(f, m, suffix_of(m), facts);
	metric_count(f, u32_at(&facts->m, m->at));
}

/* --- links ------------------------------------------------------------------- */

static void link_begin(FILE *f, const struct metric_family *m, const struct facts *facts,
		       const struct ect_device *d)
{
	metric_begin(f, m, suffix_of(m), facts);
	metric_label(f, "link", d->index ? "backup" : "main");
	metric_label(f, "interface", d->name);
}

static void link_up(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	const struct ect_device *d;

	for (size_t i = 0; (d = facts_device(facts, i)); i++) {
		link_begin(f, m, facts, d);
		metric_count(f, d->link_up);
	}
}

static void link_u64(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	const struct ect_device *d;

	for (size_t i = 0; (d = facts_device(facts, i)); i++) {
		link_begin(f, m, facts, d);
		metric_count(f, u64_at(d, m->at));
	}
}

/* --- cycle ------------------------------------------------------------------- */

static bool has_cycle(const struct facts *facts)
{
	return facts->c.kind != ECT_CYCLE_BY_NOBODY;
}

static void one(FILE *f, const struct metric_family *m, const struct facts *facts, double v)
{
	metric_begin(f, m, suffix_of(m), facts);
	metric_value(f, v);
}

static void active(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	one(f, m, facts, has_cycle(facts) && facts->c.active);
}

/* u32 members of the cycle that are ns */
static void cycle_ns(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	if (has_cycle(facts))
		one(f, m, facts, u32_at(&facts->c, m->at) * S_PER_NS);
}

static void cycle_u64(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	if (!has_cycle(facts))
		return;
	metric_begin(f, m, suffix_of(m), facts);
	metric_count(f, u64_at(&facts->c, m->at));
}

static void wire(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	if (facts->m.active)
		one(f, m, facts, facts->m.cycle_wire_ns * S_PER_NS);
}

/* Each bucket is a power of two, and each is present at any time, so that series compare. */
static void deviation(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	u64 sends = 0;

	if (!has_cycle(facts))
		return;
	for (unsigned int i = 0; i < ECT_BUCKETS; i++) {
		sends += facts->c.late[i];
		if (i % 8 != 7)
			continue;
		metric_begin(f, m, "_bucket", facts);
		fprintf(f, ",le=\"%.12g\"", (double)(ect_bucket_ns(i + 1) - 1) * S_PER_NS);
		metric_count(f, sends);
	}
	metric_begin(f, m, "_bucket", facts);
	metric_label(f, "le", "+Inf");
	metric_count(f, sends);
	metric_begin(f, m, "_count", facts);
	metric_count(f, sends);
	metric_begin(f, m, "_sum", facts);
	metric_value(f, (double)facts->c.late_sum * S_PER_NS);
}

static void execution(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	if (facts->c.kind != ECT_CYCLE_BY_KERNEL)
		return;
	metric_begin(f, m, "_count", facts);
	metric_count(f, facts->c.work_count);
	metric_begin(f, m, "_sum", facts);
	metric_value(f, (double)facts->c.work_sum * S_PER_NS);
}

static void lock(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	static const char *const names[] = { "off", "seeking", "locked", "holdover" };

	metric_states(f, m, facts, names, ARRAY_SIZE(names), facts->m.cycle_lock, NULL, 0);
}

static void phase_error(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	if (facts->m.cycle_lock != ECT_LOCK_OFF)
		one(f, m, facts, facts->m.phase_error * S_PER_NS);
}

/* --- domains, sync units ------------------------------------------------------ */

static void domain_u32(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->domain_count; i++) {
		metric_begin(f, m, "", facts);
		metric_number(f, "domain", i);
		metric_count(f, u32_at(&facts->domains[i], m->at));
	}
}

static void domain_complete(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->domain_count; i++) {
		metric_begin(f, m, "", facts);
		metric_number(f, "domain", i);
		metric_count(f, facts->domains[i].wc_state == ECT_WC_COMPLETE);
	}
}

static void unit_info(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->unit_count; i++) {
		metric_begin(f, m, "_info", facts);
		metric_number(f, "unit", i);
		metric_label(f, "name", facts->units[i].name);
		metric_count(f, 1);
	}
}

static void unit_state(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	static const char *const names[] = { "starting", "complete", "failed" };

	for (size_t i = 0; i < facts->unit_count; i++)
		if (facts->units[i].active)
			metric_states(f, m, facts, names, ARRAY_SIZE(names), facts->units[i].run,
				      "unit", i);
}

static void unit_faults(FILE *f, const struct metric_family *m, const struct facts *facts)
{
	for (size_t i = 0; i < facts->unit_count; i++) {
		metric_begin(f, m, "_total", facts);
		metric_number(f, "unit", i);
		metric_count(f, facts->units[i].faults);
	}
}

const struct metric_family metrics_of_master[] = {
	METRIC("ethercat_master", "info", NULL, "Version of the module, owner of the master", info),
	METRIC("ethercat_session", "stateset", NULL, "Session of an application", session),
	METRIC("ethercat_slaves", "gauge", NULL,
	       "Slaves in the list of the last bus scan", master_u32,
	  MEMBER(ect_master, slave_count)),
	METRIC("ethercat_slaves_responding", "gauge", NULL, "Slaves that reply", master_u32,
	  MEMBER(ect_master, slaves_responding)),
	METRIC("ethercat_configurations", "gauge", NULL,
	       "Slaves that the application has configured",
	  master_u32, MEMBER(ect_master, config_count)),
	METRIC("ethercat_scans", "counter", NULL, "Bus scans", master_u32,
	  MEMBER(ect_master, scan_count)),
	METRIC("ethercat_link_up", "gauge", NULL, "Whether the network device has a link", link_up),
	METRIC("ethercat_sent_frames", "counter", NULL, "Frames sent", link_u64,
	  MEMBER(ect_device, tx_frames)),
	METRIC("ethercat_sent_bytes", "counter", "bytes", "Bytes sent", link_u64,
	  MEMBER(ect_device, tx_bytes)),
	METRIC("ethercat_received_frames", "counter", NULL, "Frames received", link_u64,
	  MEMBER(ect_device, rx_frames)),
	METRIC("ethercat_received_bytes", "counter", "bytes", "Bytes received", link_u64,
	  MEMBER(ect_device, rx_bytes)),
	METRIC("ethercat_send_errors", "counter", NULL, "Frames that the device refused", link_u64,
	  MEMBER(ect_device, tx_errors)),
	METRIC("ethercat_lost_frames", "counter", NULL, "Frames without reply", link_u64,
	  MEMBER(ect_device, lost)),
	METRIC("ethercat_late_frames", "counter", NULL,
	       "Frames whose reply came a cycle or more late",
	  link_u64, MEMBER(ect_device, late)),
	METRIC("ethercat_unmatched_frames", "counter", NULL,
	  "EtherCAT frames that are no reply, or damaged", link_u64,
	  MEMBER(ect_device, unmatched)),
	METRIC("ethercat_foreign_frames", "counter", NULL, "Frames of other protocols", link_u64,
	  MEMBER(ect_device, foreign)),
	METRIC("ethercat_cycle_active", "gauge", NULL, "Whether a cycle runs", active),
	METRIC("ethercat_cycle_interval_seconds", "gauge", "seconds", "Cycle time", cycle_ns,
	  MEMBER(ect_cycle, interval_ns)),
	METRIC("ethercat_cycle_wire_seconds", "gauge", "seconds",
	  "Time of the wire that a cycle with all domains takes", wire),
	METRIC("ethercat_cycle_overruns", "counter", NULL, "Skipped cycles", cycle_u64,
	  MEMBER(ect_cycle, overruns)),
	METRIC("ethercat_cycle_without_outputs", "counter", NULL,
	  "Cycles of the kernel without new outputs of the application", cycle_u64,
	  MEMBER(ect_cycle, missed)),
	METRIC("ethercat_cycle_delayed", "counter", NULL, "Cycles that acyclic frames have delayed",
	  master_u32, MEMBER(ect_master, late_cycles)),
	METRIC("ethercat_send_deviation_seconds", "histogram", "seconds",
	  "Time of a send minus its schedule", deviation),
	METRIC("ethercat_send_deviation_max_seconds", "gauge", "seconds", "Largest send deviation",
	  cycle_ns, MEMBER(ect_cycle, late_max)),
	METRIC("ethercat_cycle_execution_seconds", "summary", "seconds",
	  "Execution time of a cycle that the kernel runs", execution),
	METRIC("ethercat_cycle_lock", "stateset", NULL,
	  "Whether a cycle of the kernel is synchronized to the reference clock", lock),
	METRIC("ethercat_cycle_lock_losses", "counter", NULL, "Times this synchronization was lost",
	  master_u32, MEMBER(ect_master, lock_losses)),
	METRIC("ethercat_cycle_phase_error_seconds", "gauge", "seconds",
	  "Phase error of this synchronization, positive: late", phase_error),
	METRIC("ethercat_domain_working_counter", "gauge", NULL,
	       "Working counter of the last cycle",
	  domain_u32, MEMBER(ect_domain, working_counter)),
	METRIC("ethercat_domain_expected_working_counter", "gauge", NULL,
	  "Working counter when all slaves exchange their data", domain_u32,
	  MEMBER(ect_domain, expected)),
	METRIC("ethercat_domain_complete", "gauge", NULL,
	  "Whether each datagram of the last cycle had its working counter", domain_complete),
	METRIC("ethercat_domain_age_cycles", "gauge", "cycles",
	  "Sends since the one that brought the data", domain_u32, MEMBER(ect_domain, age)),
	METRIC("ethercat_unit", "info", NULL, "Sync unit", unit_info),
	METRIC("ethercat_unit_state", "stateset", NULL, "State of an active sync unit", unit_state),
	METRIC("ethercat_unit_faults", "counter", NULL, "Failures of a sync unit since activation",
	  unit_faults),
	{ 0 },
};
