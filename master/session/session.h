/* SPDX-License-Identifier: GPL-2.0-only */
/* What an application has configured, and the memory it shares. */
#ifndef EC_SESSION_H
#define EC_SESSION_H

#include <linux/kref.h>
#include <linux/mm.h>
#include "../config/config.h"
#include "../config/domain.h"
#include "../cycle/cycle.h"
#include "sessions.h"

struct ec_detached;
struct ec_request_spec;
struct ec_requests;

#define EC_TIMEOUT_LOG_NS	(10ULL * NSEC_PER_SEC)

/** struct ec_timeout_log - cycle timeouts in the log; under sessions->lock */
struct ec_timeout_log {
	/**
	 * @logged: cycle timeouts that the log has counted, as sessions->links->access.timeouts
	 * counts them
	 */
	u32 logged;
	/** @since_ns: last send before the logged timeout */
	u64 since_ns;
	/** @next_ns: no other timeout is logged before */
	u64 next_ns;
	/** @open: the timeout is logged, its end is not */
	bool open;
};

/* The text after a number of timeouts that have no message of their own. */
static inline const char *ec_timeouts_text(const struct ec_timeout_log *l)
{
	return l->next_ns ? " more cycle timeout(s) since the last message" :
			    " cycle timeout(s) since activation";
}

/** struct ec_count_notes - counters as reported by events; under sessions->lock */
struct ec_count_notes {
	/** @count: counters at the last check: cycles skipped, frames lost, frames late */
	u64 count[3];
	/** @more: since the last event, of each */
	u32 more[3];
	/** @next_ns: no other event before, of each */
	u64 next_ns[3];
	/** @timeouts: cycle timeouts, as struct ec_timeout_log @logged */
	u32 timeouts;
	/**
	 * @since_ns: last send before the timeout that was reported last, 0: the cycle has resumed
	 */
	u64 since_ns;
};

/** struct ec_session - under sessions->lock */
struct ec_session {
	/** @sessions: of the master */
	struct ec_sessions *sessions;
	/** @owner_pid: process that reserved the master, in the initial namespace */
	pid_t owner_pid;
	/** @owner_comm: its command, printable */
	char owner_comm[TASK_COMM_LEN];
	/** @wanted: slave configurations and domains */
	struct ec_wanted wanted;
	/** @timeout_log: cycle timeouts of the application in the log */
	struct ec_timeout_log timeout_log;
	/** @notes: its counters in the events */
	struct ec_count_notes notes;
	/**
	 * @configs_seen: changes of the slaves before the status of the configurations was written
	 */
	u32 configs_seen;
	/** @configs_ns: when that was (ktime) */
	u64 configs_ns;
	/** @cycle: its cycle, with its owner */
	struct ec_cycle cycle;
	/** @ref_config: configuration whose slave is the reference clock, or EC_UAPI_NONE32 */
	u32 ref_config;
	/**
	 * @specs: requests to be made by activation; a deactivation sets it and all that follows to
	 * zero
	 */
	struct ec_request_spec *specs;
	/** @n_specs: entries in @specs */
	unsigned int n_specs;
	/** @request_bytes: bytes of their data and of emergencies */
	size_t request_bytes;
	/** @requests: executes them while active, or NULL */
	struct ec_requests *requests;
	/** @ending: the slaves go to PREOP while the application still cycles */
	bool ending;
	/** @raised: reference clock without configuration that was taken to OP, or NULL */
	struct ec_slave *raised;
	/** @preset: initial image, for the time of an activation; NULL: zeros */
	const void *preset;
	/**
	 * @handles: after a takeover by an application in the kernel: the candidate session that it
	 * has configured, to which its handles belong; or NULL
	 */
	struct ec_session *handles;
	/** @names: text of the application for tools (EC_IOC_SET_NAMES), or NULL */
	u8 *names;
	/** @names_size: bytes of it */
	u32 names_size;
	/** @detached: the application has left the session to the master; or NULL */
	struct ec_detached *detached;
};

static inline struct ec_session *ec_cycle_session(struct ec_cycle *c)
{
	return container_of(c, struct ec_session, cycle);
}

static inline struct ec_session *ec_config_session(const struct ec_config *c)
{
	return container_of(c->wanted, struct ec_session, wanted);
}

static inline struct ec_session *ec_domain_session(const struct ec_domain *d)
{
	return container_of(d->wanted, struct ec_session, wanted);
}

struct ec_session *ec_session_of(const struct ec_sessions *ss, const void *owner);
size_t ec_session_process(const struct ec_session *s, char *buf, size_t size);
size_t ec_session_owner_text(struct ec_sessions *ss, char *buf, size_t size);
u32 ec_session_place(struct ec_session *s);
u8 *ec_session_domain_data(const struct ec_domain *d);

#endif
