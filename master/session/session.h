/* SPDX-License-Identifier: GPL-2.0-only */
/* What an application has configured, and the memory it shares. */
#ifndef EC_SESSION_H
#define EC_SESSION_H

#include <linux/kref.h>
#include <linux/mm.h>
#include "../config/config.h"
#include "../config/domain.h"
#include "../cycle/cycle.h"

struct ec_sessions;
struct ec_request_spec;
struct ec_requests;

#define EC_TIMEOUT_LOG_NS	(10ULL * NSEC_PER_SEC)

/**
 * struct ec_timeout_log - cycle timeouts in the log; under sessions->lock
 * @logged: cycle timeouts that the log has counted, as sessions->links->access.timeouts counts them
 * @since_ns: last send before the logged timeout
 * @next_ns: no other timeout is logged before
 * @open: the timeout is logged, its end is not
 */
struct ec_timeout_log {
	u32 logged;
	u64 since_ns;
	u64 next_ns;
	bool open;
};

/* What stands behind a number of timeouts without a message of their own. */
static inline const char *ec_timeouts_text(const struct ec_timeout_log *l)
{
	return l->next_ns ? " more cycle timeout(s) since the last message" :
			    " cycle timeout(s) since activation";
}

/**
 * struct ec_count_notes - what the events have of counters; under sessions->lock
 * @count: counters at the last look: cycles skipped, frames lost, frames late
 * @more: since the last event, of each
 * @next_ns: no other event before, of each
 * @timeouts: cycle timeouts, as struct ec_timeout_log @logged
 * @since_ns: last send before the timeout that is noted, 0: none is
 */
struct ec_count_notes {
	u64 count[3];
	u32 more[3];
	u64 next_ns[3];
	u32 timeouts;
	u64 since_ns;
};

/**
 * struct ec_next - what a candidate has set, for the time when the master is its own
 * @interval_us: of its cycle, 0: not set
 * @phase: its first application time other than 0
 * @time: its last one
 * @at_ns: when it was that time (ktime), 0: no time
 */
struct ec_next {
	u32 interval_us;
	aligned_u64 phase;
	aligned_u64 time;
	aligned_u64 at_ns;
};

/** struct ec_sessions - applications of a master: one that uses it, one that waits */
struct ec_sessions {
	/** @base: name and log; immutable, as are the next four */
	struct ec_base *base;
	/** @links: way to the slaves */
	struct ec_links *links;
	/** @bus: slaves */
	struct ec_bus *bus;
	/** @dc: distributed clocks */
	struct ec_dc *dc;
	/** @cycles: cycles, one for each session */
	struct ec_cycles *cycles;
	/** @lanes: workers of requests; they wait for slaves; immutable */
	struct workqueue_struct *lanes;
	/**
	 * @service: what others wait for, never many at once: clocks, looks at requests,
	 * calls of an application in the kernel; immutable
	 */
	struct workqueue_struct *service;
	/** @again: tries slaves again that have failed */
	struct work_struct again;
	/**
	 * @lock: protects @session, @candidate and everything they own except the part of the
	 * cyclic caller
	 */
	struct mutex lock;
	/** @session: of the application that has reserved the master, or NULL */
	struct ec_session *session;
	/** @candidate: of another one that is to take over @session, which is detached */
	struct ec_session *candidate;
	/**
	 * @paused: no application may reserve the master, in words: the master "sleeps with the
	 * computer"; NULL: one may. Under @lock
	 */
	const char *paused;
	/** @next: of @candidate; its times have no lock */
	struct ec_next next;
	/**
	 * @memory: bytes of all sessions, and of what they have mapped, which may outlive
	 * them
	 */
	atomic_long_t memory;
};

/**
 * struct ec_session - under sessions->lock
 * @sessions: of the master
 * @owner_pid: process that reserved the master, in the initial namespace
 * @owner_comm: its command, printable
 * @wanted: slave configurations and domains
 * @timeout_log: cycle timeouts of the application in the log
 * @notes: its counters in the events
 * @configs_seen: changes of the slaves before the status of the configurations was written
 * @configs_ns: when that was (ktime)
 * @cycle: its cycle, and whose it is
 * @ref_config: configuration whose slave is the reference clock, or
 *	EC_UAPI_NONE32
 * @specs: requests to be made by activation; a deactivation sets it and all that follows to zero
 * @n_specs: entries in @specs
 * @request_bytes: room for their data and for emergencies
 * @requests: what works on them while active, or NULL
 * @ending: slaves shall go to PREOP while the application still cycles
 * @raised: reference clock without configuration that was taken to OP, or NULL
 * @preset: what the image begins with, for the time of an activation; NULL: zeros
 * @handles: session in which an application in the kernel has configured what it has taken
 *	over, or NULL: its handles are there
 */
struct ec_session {
	struct ec_sessions *sessions;
	pid_t owner_pid;
	char owner_comm[TASK_COMM_LEN];
	struct ec_wanted wanted;
	struct ec_timeout_log timeout_log;
	struct ec_count_notes notes;
	u32 configs_seen;
	u64 configs_ns;
	struct ec_cycle cycle;
	u32 ref_config;
	struct ec_request_spec *specs;
	unsigned int n_specs;
	size_t request_bytes;
	struct ec_requests *requests;
	bool ending;
	struct ec_slave *raised;
	const void *preset;
	struct ec_session *handles;
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

size_t ec_session_process(const struct ec_session *s, char *buf, size_t size);
size_t ec_session_owner_text(struct ec_sessions *ss, char *buf, size_t size);
int ec_session_begin(struct ec_sessions *ss, const void *owner, struct ec_waiters *waiters);
void ec_session_end(struct ec_sessions *ss, const void *owner);
u32 ec_session_place(struct ec_session *s);
int ec_session_end_detached(struct ec_sessions *ss);
void ec_session_interval(struct ec_sessions *ss, u32 interval_us);
void ec_session_app_time(struct ec_sessions *ss, u64 app_time);
struct ec_session *ec_session_of(const struct ec_sessions *ss, const void *owner);
int ec_session_activate(struct ec_session *s);
int ec_session_slaves_down(struct ec_session *s);
void ec_ref_clock_raise(struct ec_session *s);
void ec_ref_clock_lower(struct ec_session *s);
int ec_session_deactivate(struct ec_session *s);
int ec_session_stop(struct ec_sessions *ss, const void *owner);

void ec_session_clocks(struct ec_sessions *ss);

/* session_attach.c */
bool ec_session_owns(const struct ec_config *c);
void ec_session_detach(struct ec_config *c);
struct ec_slave *ec_session_find(struct ec_sessions *ss, u16 alias, u16 position, u32 vendor,
				 u32 product);
void ec_session_begin_active(struct ec_session *s);
void ec_session_attach_one(struct ec_session *s, struct ec_config *c);
void ec_session_attach(struct ec_sessions *ss);
struct ec_config *ec_session_configure(struct ec_session *s, u16 alias, u16 position, u32 vendor,
				       u32 product);
void ec_session_again(struct work_struct *work);
void ec_session_try_again(struct ec_sessions *ss);

/* session_status.c */
void ec_session_note_counts(struct ec_session *s, bool first, bool all);
void ec_session_fill_status(struct ec_session *s);
void ec_session_status(struct ec_sessions *ss, bool scanned);

/* takeover.c */
int ec_session_take_over(struct ec_sessions *ss, char *why, size_t size, bool keep);

void ec_session_free(struct ec_session *s);

u8 *ec_session_domain_data(const struct ec_domain *d);

/* sessions.c */
int ec_sessions_init(struct ec_sessions *ss);
void ec_sessions_exit(struct ec_sessions *ss);
void ec_sessions_lock(struct ec_sessions *ss);
int ec_sessions_pause(struct ec_sessions *ss, const char *why);
void ec_sessions_resume(struct ec_sessions *ss);
bool ec_sessions_trylock(struct ec_sessions *ss);
void ec_sessions_unlock(struct ec_sessions *ss);

#endif
