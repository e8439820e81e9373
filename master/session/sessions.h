/* SPDX-License-Identifier: GPL-2.0-only */
/* Applications of a master. */
#ifndef EC_SESSIONS_H
#define EC_SESSIONS_H

#include <linux/mutex.h>
#include <linux/types.h>
#include <linux/workqueue.h>
#include "../bus/bus.h"
#include "../clock/dc_state.h"
#include "../link/links.h"

struct ec_cycles;
struct ec_session;

/** struct ec_next - settings of a candidate that become valid when it gets the master */
struct ec_next {
	/** @interval_us: of its cycle, 0: not set */
	u32 interval_us;
	/** @phase: its first application time other than 0 */
	aligned_u64 phase;
	/** @time: its last application time */
	aligned_u64 time;
	/** @at_ns: when it has set @time (ktime), 0: never */
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
	/** @lanes: workers of request queues; they wait for slaves; immutable */
	struct workqueue_struct *lanes;
	/**
	 * @service: short works, never many at once: clocks, checks of requests, calls of an
	 * application in the kernel; immutable
	 */
	struct workqueue_struct *service;
	/** @again: tries slaves again that have failed */
	struct work_struct again;
	/** @units: takes slaves where the policies of sync units want them */
	struct work_struct units;
	/**
	 * @lock: protects @session, @candidate and everything they own except the part of the
	 * cycle owner
	 */
	struct mutex lock;
	/** @session: of the application that has reserved the master, or NULL */
	struct ec_session *session;
	/** @candidate: of an application that is to take over @session, which is detached */
	struct ec_session *candidate;
	/**
	 * @paused: no application may reserve the master, in words: the master "sleeps with the
	 * computer"; NULL: one may. Under @lock
	 */
	const char *paused;
	/** @next: of @candidate; its times have no lock */
	struct ec_next next;
	/**
	 * @memory: bytes of all sessions, and of what they have mapped, which may exist longer
	 * than they do
	 */
	atomic_long_t memory;
};

int ec_sessions_init(struct ec_sessions *ss, work_func_t again, work_func_t units);
void ec_sessions_exit(struct ec_sessions *ss);
void ec_sessions_lock(struct ec_sessions *ss);
bool ec_sessions_trylock(struct ec_sessions *ss);
void ec_sessions_unlock(struct ec_sessions *ss);
int ec_sessions_pause(struct ec_sessions *ss, const char *why);
void ec_sessions_resume(struct ec_sessions *ss);
void ec_sessions_forget_times(struct ec_sessions *ss);

#endif
