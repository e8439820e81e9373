/* SPDX-License-Identifier: GPL-2.0-only */
/* What an application has configured, and the memory it shares. */
#ifndef EC_SESSION_H
#define EC_SESSION_H

#include <linux/sched.h>
#include <linux/kref.h>
#include <linux/mm.h>
#include <linux/types.h>
#include "../config/config.h"
#include "../config/domain.h"
#include "../cycle/cycle.h"
#include "ethercat.h"
#include "../base/limits.h"

struct ec_copy;
struct ec_copying;
struct ec_cycle_thread;
struct ec_master;
struct ec_request_spec;
struct ec_requests;
struct ec_waiters;

/**
 * struct ec_shared - memory mapped by the application; outlives the session
 *	as long as it is mapped
 * @kref: session and mappings
 * @image: process image of all domains
 * @image_size: bytes, multiple of the page size
 * @status: status pages
 * @requests: struct ec_request_area and what it names, or NULL
 * @request_size: bytes, likewise
 * @exchange: struct ec_exchange and its buffers; NULL: the application runs the
 *	cycle and maps the image
 * @exchange_size: bytes, multiple of the page size
 * @bytes: of all of them
 * @mapped: of the master, where @bytes are counted
 */
struct ec_shared {
	struct kref kref;
	u8 *image;
	size_t image_size;
	void *exchange;
	size_t exchange_size;
	struct ec_status *status;
	u8 *requests;
	size_t request_size;
	size_t bytes;
	atomic_long_t *mapped;
};

#define EC_STATUS_BYTES	PAGE_ALIGN(sizeof(struct ec_status))

#define EC_STALL_LOG_NS	(10ULL * NSEC_PER_SEC)

/**
 * struct ec_stall_log - what the log says of stalls; under master->session_lock
 * @told: stalls the log knows of, as master->links.access.timeouts counts them
 * @since_ns: last send before the stall the log shows
 * @next_ns: no new stall is logged before
 * @open: the log says it stalled, not yet that it goes on
 */
struct ec_stall_log {
	u32 told;
	u64 since_ns;
	u64 next_ns;
	bool open;
};

/**
 * struct ec_session - under master->session_lock; @cycle and @shared are the
 *	cyclic caller's while active
 * @master: master
 * @owner: open file that reserved the master; NULL: detached, its cycle goes on
 *	without an application
 * @owner_pid: process that reserved the master, in the initial namespace
 * @owner_comm: its command, printable
 * @waiters: callers of @owner that wait for a cycle, or NULL; the cycle thread
 *	reads it under RCU
 * @wanted: slave configurations and domains
 * @ref_config: configuration whose slave is the reference clock, or
 *	EC_UAPI_NONE32
 * @specs: requests to be made by activation
 * @n_specs: entries in @specs
 * @request_bytes: room for their data and for emergencies
 * @requests: what works on them while @active, or NULL
 * @ending: slaves shall go to PREOP while the application still cycles
 * @raised: reference clock without configuration that was taken to OP, or NULL
 * @preset: what the image begins with, for the time of an activation; NULL: zeros
 * @shared: memory of the activation
 * @stall_log: stalls of the application in the log
 * @lock_told: EC_CYCLE_LOCK_* as the log knows it
 * @kernel: how the kernel shall run the cycle; period 0: it shall not
 * @priority: SCHED_FIFO priority that the process which set @kernel may use; 0:
 *	none
 * @cpu_lost: the CPU of the cycle is offline
 * @cpu_losses: how often it went offline
 * @thread: runs the cycle while @active; NULL: the application does
 * @late_per_s: how many cycles a second acyclic frames may make late
 * @room_told: the log says that they do not fit
 * @cycle: cyclic layout
 * @copies: from inputs to outputs, before each send
 * @n_copies: entries in @copies
 * @copying: what they need while @active, or NULL
 */
struct ec_session {
	struct ec_master *master;
	const void *owner;
	struct ec_waiters __rcu *waiters;
	pid_t owner_pid;
	char owner_comm[TASK_COMM_LEN];
	struct ec_wanted wanted;
	u32 ref_config;
	struct ec_request_spec *specs;
	unsigned int n_specs;
	size_t request_bytes;
	struct ec_requests *requests;
	bool ending;
	struct ec_slave *raised;
	const void *preset;
	struct ec_shared *shared;
	struct ec_stall_log stall_log;
	u32 lock_told;
	struct ec_ioc_cycle kernel;
	u32 priority;
	bool cpu_lost;
	u32 cpu_losses;
	struct ec_cycle_thread *thread;
	u32 late_per_s;
	bool room_told;
	struct ec_cycle cycle;
	struct ec_copy *copies;
	unsigned int n_copies;
	struct ec_copying *copying;
};

static inline struct ec_session *ec_config_session(const struct ec_config *c)
{
	return container_of(c->wanted, struct ec_session, wanted);
}

static inline struct ec_session *ec_domain_session(const struct ec_domain *d)
{
	return container_of(d->wanted, struct ec_session, wanted);
}

size_t ec_session_owner_text(struct ec_master *m, char *buf, size_t size);
int ec_session_begin(struct ec_master *m, const void *owner, struct ec_waiters *waiters);
void ec_session_end(struct ec_master *m, const void *owner);
u32 ec_session_place(struct ec_session *s);
int ec_session_end_detached(struct ec_master *m);
struct ec_session *ec_session_of(const struct ec_master *m, const void *owner);
int ec_session_activate(struct ec_session *s);
int ec_session_slaves_down(struct ec_session *s);
void ec_session_raise_ref(struct ec_session *s);
void ec_session_lower_ref(struct ec_session *s);
int ec_session_deactivate(struct ec_session *s);

void ec_session_clocks(struct ec_master *m);

/* session_attach.c */
bool ec_session_owns(const struct ec_config *c);
void ec_session_detach(struct ec_config *c);
struct ec_slave *ec_session_find(struct ec_master *m, u16 alias, u16 position, u32 vendor,
				 u32 product);
void ec_session_attach_one(struct ec_session *s, struct ec_config *c);
void ec_session_attach(struct ec_master *m);
struct ec_config *ec_session_configure(struct ec_session *s, u16 alias, u16 position, u32 vendor,
				       u32 product);

/* session_status.c */
void ec_session_fill_status(struct ec_session *s);
void ec_session_status(struct ec_master *m);

/* takeover.c */
int ec_session_take_over(struct ec_master *m, char *why, size_t size);

void ec_session_set_owner(struct ec_session *s, const void *owner, struct ec_waiters *waiters);
void ec_session_free(struct ec_session *s);

/* memory.c */
struct ec_shared *ec_shared_create(struct ec_master *m, size_t image_size, size_t request_size);
void *ec_shared_alloc(struct ec_shared *sh, size_t size);
int ec_shared_map(struct vm_area_struct *vma, void *memory);
void ec_shared_get(struct ec_shared *sh);
void ec_shared_put(struct ec_shared *sh);
u8 *ec_domain_data(const struct ec_domain *d);
int ec_session_fits(const struct ec_session *s, size_t image_size);

/* session_lock.c */
void ec_session_lock(struct ec_master *m);
bool ec_session_trylock(struct ec_master *m);
void ec_session_unlock(struct ec_master *m);

#endif
