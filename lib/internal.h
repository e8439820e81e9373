/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of libethercat share. */
#ifndef EC_LIB_INTERNAL_H
#define EC_LIB_INTERNAL_H

#include <errno.h>
#include <stdbool.h>
#include <stddef.h>

#include "../include/ecrt.h"
#include "../include/uapi/ethercat.h"

/*
 * @queued, @sent, @received: bit n is domain n: to be sent, on its way, back
 * but not processed; @app_time: last one, told with the next send when
 * @app_time_new; @send_flags: EC_SEND_FLAG_* of the next send.
 * Only the cyclic caller touches them.
 *
 * @frozen: ecrt_master_setup_domain_memory() was called; @preset_size: bytes of
 * all domains then.
 *
 * @exchange: with a cycle the kernel runs, else NULL; then @image is memory of
 * our own. @out_back, @in_front: buffers we hold; @in_taken: that has inputs; @out_last: the
 * one we gave last;
 * @stride: distance of two; @cycle: last one waited for.
 */
struct ec_master {
	int fd;
	unsigned int index;
	bool reserved;
	bool active;
	__u64 queued;
	__u64 sent;
	__u64 received;
	__u64 app_time;
	bool app_time_new;
	__u32 send_flags;
	__u64 sync_time;

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

	struct ec_request *requests;

	struct ec_exchange *exchange;
	size_t exchange_size;
	unsigned int stride;
	unsigned int out_back;
	unsigned int out_last;
	unsigned int in_front;
	bool in_taken;
	__u64 cycle;

	struct ec_domain *domains;
	struct ec_slave_config *configs;
};

/* inputs of a domain: @count times @size bytes, each @stride behind the one before */
struct ec_input {
	unsigned int offset;
	unsigned int size;
	unsigned int stride;
	unsigned int count;
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

/*
 * @room: bytes at @data, @size: of them used; @index16: object, IDN, register,
 * type of a VoE message; @subindex: or drive; @flags: EC_SDO_FLAG_COMPLETE;
 * @vendor_id: of a VoE message; @op: EC_REQUEST_OP_* of the last start, @start: its
 * number; @got_vendor_id, @got_type: of the VoE message read last; @rec, @shared: record and data in mapped memory, NULL before activation
 */
struct ec_request {
	struct ec_master *master;
	struct ec_request *next;
	unsigned int index;
	__u8 *data;
	size_t room;
	size_t size;
	__u32 timeout_ms;
	__u16 index16;
	__u8 subindex;
	__u8 op;
	__u32 flags;
	__u32 vendor_id;
	__u32 got_vendor_id;
	__u16 got_type;
	__u32 start;
	ec_request_state_t state;
	struct ec_request_record *rec;
	__u8 *shared;
};

/* @overruns: of its emergencies, when they were cleared */
struct ec_slave_config {
	struct ec_master *master;
	struct ec_slave_config *next;
	unsigned int index;
	__u16 alias;
	__u16 position;
	__u32 overruns;
};

/* status fields are written by the kernel at any time: one load each */
#define ec_status_read(field) ({					\
	_Static_assert(sizeof(field) <= 4, "ec_status_read64()");	\
	__atomic_load_n(&(field), __ATOMIC_RELAXED); })

/*
 * Those of 64 bits take a program of 32 bits two loads, which belong together when
 * the kernel has written nothing in between. What is read later is not older.
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

int ec_ioctl(const struct ec_master *m, unsigned long cmd, void *arg);
int ec_fail(int err, const char *fmt, ...)
	__attribute__((format(printf, 2, 3)));
int ec_not_there(int err);
int ec_fail_ioctl(const struct ec_master *m, int err, const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));

/* why a call that needs an active master fails */
static inline int ec_inactive(const struct ec_master *m)
{
	return m && !m->reserved ? -EPERM : -EINVAL;
}

void ec_master_free_session(struct ec_master *m);
void ec_master_unmap(struct ec_master *m);
/* request.c: what all kinds of requests have in common */
void *ec_request_create(struct ec_slave_config *sc, __u32 kind, size_t size);
ec_request_state_t ec_request_state(struct ec_request *r);
int ec_request_start(struct ec_request *r, __u8 op, size_t size);
int ec_requests_place(struct ec_master *m);
void ec_requests_free(struct ec_master *m);
void *ec_master_map(struct ec_master *m, size_t size, int prot, __u64 offset);

void ec_touch_pages(volatile __u8 *p, size_t size);

/* memory.c: process data before activation */
int ec_memory_frozen(const struct ec_master *m, const char *what);
int ec_memory_map_image(struct ec_master *m, size_t size);

/* cycle.c: the kernel runs the cycle */
int ec_cycle_map(struct ec_master *m, const struct ec_ioc_activate *arg);
void ec_cycle_unmap(struct ec_master *m);
int ec_cycle_find_inputs(struct ec_domain *d);
int ec_cycle_receive(struct ec_master *m);
void ec_cycle_process(struct ec_domain *d);
void ec_cycle_queue(struct ec_domain *d);
int ec_cycle_send(struct ec_master *m);

#endif
