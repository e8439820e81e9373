/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of libethercat share. */
#ifndef EC_LIB_INTERNAL_H
#define EC_LIB_INTERNAL_H

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "../include/ecrt.h"
#include "../include/uapi/ethercat.h"
#include "ecrt/cycle.h"

/*
 * @image: with a cycle that the kernel runs, memory of our own.
 *
 * @frozen: ecrt_master_setup_domain_memory() was called; @preset_size: bytes of
 * all domains then.
 */
struct ec_master {
	int fd;
	unsigned int index;
	bool reserved;
	bool active;
	struct ec_app_cycle cycle;
	bool no_advice;	/* the module does not admit EC_ADVICE_* */

	/* mapped by activation */
	const struct ec_status *status;
	size_t status_size;
	__u8 *image;
	size_t image_size;
	bool frozen;
	size_t preset_size;
	struct ec_request_area *area;
	__u8 *area_base;	/* the same as bytes */
	size_t area_size;

	struct ec_app_request *requests;

	size_t exchange_size;

	struct ec_domain *domains;
	struct ec_slave_config *configs;
	struct ec_master_data *data;
};

/*
 * @snap: status as of the last ecrt_domain_process(); @offset: in the image;
 * @inputs, @n_inputs: to copy, when the kernel runs the cycle
 */
struct ec_domain {
	struct ec_master *master;
	struct ec_domain *next;
	unsigned int index;
	__u8 *data;
	size_t offset;
	size_t size;
	struct ec_status_domain snap;
	unsigned int max_age;
	struct ec_input *inputs;
	unsigned int n_inputs;
};

/* @group: hot connect group + 1, whose member @position is; @overruns: see emerg.c */
struct ec_slave_config {
	struct ec_master *master;
	struct ec_slave_config *next;
	unsigned int index;
	__u16 alias;
	__u16 position;
	__u32 group;
	__u32 overruns;
};

/* status fields are written by the kernel at any time: one load each */
#define ec_status_read(field) ({					\
	_Static_assert(sizeof(field) <= 4, "ec_status_read64()");	\
	__atomic_load_n(&(field), __ATOMIC_RELAXED); })

/*
 * A program of 32 bits reads a field of 64 bits by two loads. They belong together when the
 * kernel has written nothing in between. Fields that are read later are not older.
 */
static inline __u64 ec_status_read64(const struct ec_status *st, const __u64 *field)
{
#if __SIZEOF_LONG__ == 8
	(void)st;
	return __atomic_load_n(field, __ATOMIC_ACQUIRE);
#else
	__u32 sequence;
	__u64 value;

	do {
		sequence = __atomic_load_n(&st->sequence, __ATOMIC_ACQUIRE);
		value = *(const volatile __u64 *)field;
		__atomic_thread_fence(__ATOMIC_ACQUIRE);
	} while (sequence & 1 || ec_status_read(st->sequence) != sequence);
	return value;
#endif
}

/* Values of 64 bits that threads share; a program of 32 bits takes two loads or stores. */
static inline __u64 ec_read64(const __u64 *v)
{
	return *(const volatile __u64 *)v;
}

static inline void ec_write64(__u64 *v, __u64 to)
{
	*(volatile __u64 *)v = to;
}

/* ioctl.c: what the sources in ecrt/ need of a process */
int ec_command(const struct ec_master *m, unsigned int cmd, void *arg);
int ec_cannot_open(const char *path);
int ec_complain(const struct ec_master *m, const struct ec_slave_config *sc, int err,
		bool with_reason, const char *fmt, ...)
	__attribute__((format(printf, 5, 6)));

/* why a call that needs an active master fails */
static inline int ec_inactive(const struct ec_master *m)
{
	return m && !m->reserved ? -EPERM : -EINVAL;
}

void ec_master_free_session(struct ec_master *m);
void ec_master_free_data(struct ec_master *m);
void ec_master_unmap(struct ec_master *m);
void *ec_master_map(struct ec_master *m, void *at, size_t size, int prot, __u64 offset);

/* memory.c: process data before activation */
int ec_memory_frozen(const struct ec_master *m, const char *what);
int ec_memory_map_image(struct ec_master *m, size_t size);

int ec_memory_map_exchange(struct ec_master *m, const struct ec_ioc_activate *arg);
void ec_memory_unmap_exchange(struct ec_master *m);

/* what the sources in ecrt/ need besides; see ecrt/ecrt_int.h --------------------*/

#define EXPORT_SYMBOL_GPL(symbol) _Static_assert(1, "for the kernel")
#define noinline __attribute__((noinline))

#define ec_exchange_word(p, value) __atomic_exchange_n(p, value, __ATOMIC_ACQ_REL)
#define ec_div64(a, b) ((a) / (b))
#define ec_load_acquire(p) __atomic_load_n(p, __ATOMIC_ACQUIRE)
#define ec_store_release(p, value) __atomic_store_n(p, value, __ATOMIC_RELEASE)

static inline struct ec_master *ec_sc_master(const struct ec_slave_config *sc)
{
	return sc ? sc->master : NULL;
}

/* of the handle that an argument names; the call checks for NULL */
static inline unsigned int ec_sc_index(const struct ec_slave_config *sc)
{
	return sc ? sc->index : 0;
}

static inline struct ec_app_cycle *ec_app_cycle(const struct ec_master *m)
{
	return (struct ec_app_cycle *)&m->cycle;
}

/* of an active master, or NULL */
static inline const struct ec_status *ec_active_status(const struct ec_master *m)
{
	return m && m->active ? m->status : NULL;
}

static inline bool ec_run_by_kernel(const struct ec_master *m)
{
	return m && m->active && m->cycle.exchange;
}

/* configurations whose state is in the mapped status page */
static inline size_t ec_status_configs(const struct ec_master *m)
{
	size_t bytes = m->status_size - offsetof(struct ec_status, configs);

	return bytes < EC_STATUS_CONFIGS ? bytes : EC_STATUS_CONFIGS;
}

/* an older module has no states of units */
static inline bool ec_status_has_units(const struct ec_master *m)
{
	return m->status_size >= sizeof(struct ec_status);
}

static inline struct ec_ioc_send *ec_next_send(struct ec_master *m)
{
	return &m->cycle.next;
}

#define ec_for_each_app_domain(m, d) for ((d) = (m)->domains; (d); (d) = (d)->next)

static inline struct ec_master *ec_domain_master(const struct ec_domain *d)
{
	return d->master;
}

#define ec_zalloc(size) calloc(1, size)
#define ec_free(p) free(p)

/* the return value of a function that creates a handle, on failure */
static inline void *ec_no_handle(int err)
{
	errno = -err;
	return NULL;
}

static inline struct ec_app_request **ec_request_list(struct ec_master *m)
{
	return &m->requests;
}

/* NULL before activation */
static inline struct ec_request_record *ec_request_record(const struct ec_master *m,
							  unsigned int index, __u8 **shared)
{
	struct ec_request_record *rec;

	if (!m->area || index >= m->area->request_count)
		return NULL;
	rec = (struct ec_request_record *)(m->area_base + m->area->requests) + index;
	*shared = m->area_base + rec->data;
	return rec;
}

/* emergencies of a configuration in shared memory */
struct ec_emerg {
	struct ec_emerg_ring *ring;
	const __u8 *data;
	__u32 count;
};

/* false before activation */
static inline bool ec_emerg_get(const struct ec_slave_config *sc, struct ec_emerg *e)
{
	const struct ec_request_area *area = sc->master->area;

	if (!area || sc->index >= area->ring_count)
		return false;
	e->ring = (struct ec_emerg_ring *)(sc->master->area_base + area->rings) + sc->index;
	e->data = sc->master->area_base + e->ring->data;
	e->count = e->ring->count;
	return true;
}

static inline __u32 *ec_emerg_cleared(const struct ec_slave_config *sc)
{
	return &((struct ec_slave_config *)sc)->overruns;
}

/*
 * The next send notifies the master; a cycle that the kernel runs sees the counter. The caller
 * need not be the thread that sends.
 */
static inline void ec_request_started(struct ec_master *m)
{
	__atomic_fetch_add(&m->area->starts, 1, __ATOMIC_RELEASE);
	__atomic_store_n(&m->cycle.started, 1, __ATOMIC_RELEASE);
}

#endif
