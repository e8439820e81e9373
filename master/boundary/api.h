/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Applications in the kernel: include/ecrt.h as exported functions. They use
 * the same commands as a process does through ioctl(), by the same sources in lib/ecrt/.
 * States, and a cycle that the application runs, have functions of their own, which never
 * sleep.
 */
#ifndef EC_API_H
#define EC_API_H

#include <linux/mm.h>
#include <linux/module.h>
#include <linux/slab.h>
#include <linux/string.h>
#include <linux/workqueue.h>
#include "../include/ecrt.h"
#include "../lib/ecrt/cycle.h"
#include "../base/once64.h"
#include "cdev.h"
#include "../config/config.h"
#include "../config/domain.h"
#include "ioctl.h"
#include "../mailbox/emerg.h"
#include "master.h"
#include "../session/request.h"
#include "../session/session.h"

struct ec_app_request;
struct ec_loaded;
struct task_struct;

/** struct ec_api - the application in the kernel that may have reserved a master */
struct ec_api {
	/** @file: stands for the open file of a process */
	struct ec_file file;
	/** @reserved: it has reserved the master, and holds this module */
	bool reserved;
	/** @active: its session while that is active */
	struct ec_session *active;
	/** @wanted: the domains and slave configurations of its session */
	struct ec_wanted *wanted;
	/** @cycle: its cycle */
	struct ec_app_cycle cycle;
	/** @image: data of its domains while the kernel runs the cycle */
	u8 *image;
	/** @busy: 1: a call exchanges process data with the cycle that the kernel runs */
	atomic_t busy;
	/** @requests: list of its requests */
	struct ec_app_request *requests;
	/** @loaded: values of a compiled bus file, or NULL */
	struct ec_loaded *loaded;
	/** @work: work of a cyclic call that has to sleep */
	struct work_struct work;
	/** @atomic: a cyclic call was made outside of a thread, though the device needs one */
	bool atomic;
	/** @warned: @atomic has been logged */
	bool warned;
	/** @send_cb: sends between two cycles, or NULL; see ecrt_master_callbacks() */
	void (*send_cb)(void *cb_data);
	/** @receive_cb: receives there, or NULL */
	void (*receive_cb)(void *cb_data);
	/** @cb_data: for both */
	void *cb_data;
	/** @between: thread that calls them while active */
	struct task_struct *between;
	/** @between_wq: wakes it */
	wait_queue_head_t between_wq;
};

/* The handle of a slave configuration is the configuration. */
static inline struct ec_config *ec_api_config(const ec_slave_config_t *sc)
{
	return (struct ec_config *)sc;
}

/* The active session, or NULL. */
static inline struct ec_session *ec_api_session(const struct ec_api *api)
{
	/* pairs with ecrt_master_activate(): the session is complete */
	return smp_load_acquire(&api->active);
}

/* api.c */
int ec_api_create(struct ec_master *m);
void ec_api_destroy(struct ec_master *m);
int ec_command(const struct ec_master *m, unsigned int cmd, void *arg);
int ec_complain(const struct ec_master *m, const ec_slave_config_t *sc, int err,
		bool with_reason, const char *fmt, ...) __printf(5, 6);

/* api_between.c */
int ec_api_between_start(struct ec_master *m);
void ec_api_between_stop(struct ec_master *m);
bool ec_api_is_between(const struct ec_api *api);
void ec_api_left(struct ec_master *m);

/* what the sources in lib/ecrt/ need; see ecrt_int.h there ---------------------*/

#define ec_exchange_word(p, value) xchg(p, value)
#define ec_div64(a, b) div64_u64(a, b)
/* their users say what they pair with */
#define ec_load_acquire(p) smp_load_acquire(p)
#define ec_store_release(p, value) smp_store_release(p, value)

static inline struct ec_master *ec_sc_master(const ec_slave_config_t *sc)
{
	return sc ? ec_master_of(ec_config_session(ec_api_config(sc))) : NULL;
}

/* of the handle that an argument names; the call checks for NULL */
static inline u32 ec_sc_index(const ec_slave_config_t *sc)
{
	return sc ? ec_api_config(sc)->index : 0;
}

static inline struct ec_app_cycle *ec_app_cycle(const struct ec_master *m)
{
	return &m->api->cycle;
}

#define ec_for_each_app_domain(m, d) \
	for (u32 i_ = 0; i_ < (m)->api->wanted->n_domains && \
			 ((d) = (m)->api->wanted->domains[i_]); i_++)

static inline struct ec_master *ec_domain_master(const struct ec_domain *d)
{
	return ec_master_of(ec_domain_session(d));
}

static inline int ec_inactive(const struct ec_master *m)
{
	return -EINVAL;
}

static inline const struct ec_status *ec_active_status(const struct ec_master *m)
{
	const struct ec_session *s = m ? ec_api_session(m->api) : NULL;

	return s ? s->cycle.shared->status : NULL;
}

/*
 * Does the kernel run the cycle of an active session? Deactivation does not wait for a caller
 * that asks this, so nothing of the session is read.
 */
static inline bool ec_run_by_kernel(const struct ec_master *m)
{
	return m && ec_api_session(m->api) && READ_ONCE(m->api->cycle.exchange);
}

static inline size_t ec_status_configs(const struct ec_master *m)
{
	return EC_STATUS_CONFIGS;
}

static inline bool ec_status_has_units(const struct ec_master *m)
{
	return true;
}

static inline struct ec_ioc_send *ec_next_send(struct ec_master *m)
{
	return &m->api->cycle.next;
}

#define ec_status_read(field) READ_ONCE(field)

static inline u64 ec_status_read64(const struct ec_status *st, const __u64 *field)
{
	u64 value;

	if (BITS_PER_LONG == 64)
		return READ_ONCE(*field);
	ec_status_copy(st, &value, field, sizeof(value));
	return value;
}

/* false before activation */
static inline bool ec_emerg_get(const ec_slave_config_t *sc, struct ec_emerg *e)
{
	struct ec_session *s = ec_api_session(ec_sc_master(sc)->api);
	const struct ec_emerg *from;

	if (!s)
		return false;
	from = ec_requests_emerg(s, ec_api_config(sc)->index);
	e->ring = from->ring;
	e->data = from->data;
	e->count = from->count;
	return true;
}

static inline u32 *ec_emerg_cleared(const ec_slave_config_t *sc)
{
	return &ec_api_config(sc)->emerg_cleared;
}

#define ec_zalloc(size) kvzalloc(size, GFP_KERNEL)
#define ec_free(p) kvfree(p)

/* the return value of a function that creates a handle, on failure */
static inline void *ec_no_handle(int err)
{
	return NULL;
}

/* process data of applications in the kernel get their memory at activation only */
static inline int ec_memory_frozen(const struct ec_master *m, const char *what)
{
	return 0;
}

static inline struct ec_app_request **ec_request_list(struct ec_master *m)
{
	return &m->api->requests;
}

static inline struct ec_request_record *ec_request_record(const struct ec_master *m, u32 index,
							  u8 **shared)
{
	return ec_requests_record(m->sessions.session, index, shared);
}

/* the next send notifies the master; a cycle that the kernel runs sees the counter */
static inline void ec_request_started(struct ec_master *m)
{
	struct ec_request_area *area = (void *)m->sessions.session->cycle.shared->requests;

	/* the request before the number that announces it; see ec_requests_notice() */
	smp_mb__before_atomic();
	atomic_inc((atomic_t *)&area->starts);
	/* pairs with xchg() of ecrt_master_send() */
	smp_store_release(&m->api->cycle.started, 1);
}

#endif
