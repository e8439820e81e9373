// SPDX-License-Identifier: GPL-2.0-only
/* The memory of requests: what an application maps, and where each request has its part. */
#include <linux/slab.h>
#include "request_int.h"
#include "request_layout.h"
#include "session.h"
#include "../bus/slave.h"

/* Mapped bytes of the data of a request; the name of a file precedes it. */
static size_t data_bytes(u32 kind, u32 size)
{
	return ALIGN(size, 8) + (kind == EC_REQUEST_FOE ? EC_FOE_NAME : 0);
}

static size_t buf_bytes(const struct ec_request_spec *spec)
{
	return spec->kind == EC_REQUEST_FOE ? EC_FOE_NAME : data_bytes(spec->kind, spec->size);
}

/**
 * ec_requests_add() - one more request
 * @s: session, not active
 * @config: configuration in it; %EC_UAPI_NONE32 for a datagram
 * @kind: EC_REQUEST_*
 * @size: bytes of its data at most
 * @index: result: its number
 *
 * Context: Process, session lock held. May sleep.
 * Return: 0, -ENOSPC, -ENOMEM.
 */
int ec_requests_add(struct ec_session *s, u32 config, u32 kind, u32 size, u32 *index)
{
	size_t bytes = s->request_bytes + data_bytes(kind, size);

	lockdep_assert_held(s->wanted.lock);
	if (s->n_specs >= EC_MAX_REQUESTS || bytes > EC_MAX_REQUEST_BYTES)
		return -ENOSPC;
	if (!s->specs)
		s->specs = kvcalloc(EC_MAX_REQUESTS, sizeof(*s->specs), GFP_KERNEL_ACCOUNT);
	if (!s->specs)
		return -ENOMEM;
	*index = s->n_specs;
	s->specs[s->n_specs++] = (struct ec_request_spec){
		.config = config, .kind = kind, .size = size,
	};
	s->request_bytes = bytes;
	return 0;
}

static size_t rings_offset(const struct ec_session *s)
{
	return sizeof(struct ec_request_area) + s->n_specs * sizeof(struct ec_request_record);
}

static size_t data_offset(const struct ec_session *s)
{
	return ALIGN(rings_offset(s) + s->wanted.n_configs * sizeof(struct ec_emerg_ring), 8);
}

/**
 * ec_requests_bytes() - size of the memory to map
 * @s: session
 *
 * Context: Process, session lock held.
 * Return: bytes; 0 without configuration and request.
 */
size_t ec_requests_bytes(const struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	return s->wanted.n_configs || s->n_specs ? data_offset(s) + s->request_bytes : 0;
}

static void init(struct ec_requests *rq, struct ec_lane *lane, u32 config)
{
	lane->rq = rq;
	lane->config = config;
	INIT_LIST_HEAD(&lane->requests);
}

static size_t lay_out_rings(struct ec_session *s, struct ec_requests *rq)
{
	u8 *base = rq->shared->requests;
	struct ec_emerg_ring *ring = (void *)(base + rings_offset(s));
	size_t at = data_offset(s);
	unsigned int i;

	for (i = 0; i < s->wanted.n_configs; i++, ring++) {
		init(rq, &rq->lanes[i], i);
		rq->lanes[i].emerg = (struct ec_emerg){
			.ring = ring, .data = base + at, .count = s->wanted.configs[i]->emergencies,
		};
		at += rq->lanes[i].emerg.count * EC_EMERG_BYTES;
	}
	return at;
}

/**
 * ec_requests_describe() - write the layout of the mapped memory for the application
 * @s: session with requests
 *
 * It is written again for an application that takes over: the previous one could write there.
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_requests_describe(const struct ec_session *s)
{
	struct ec_requests *rq = s->requests;
	u8 *base = rq->shared->requests;
	struct ec_request_area *area = (void *)base;
	unsigned int i;

	lockdep_assert_held(s->wanted.lock);
	area->magic = EC_REQUEST_MAGIC;
	area->request_count = s->n_specs;
	area->requests = sizeof(*area);
	area->ring_count = s->wanted.n_configs;
	area->rings = rings_offset(s);
	for (i = 0; i < s->wanted.n_configs; i++) {
		struct ec_emerg *e = &rq->lanes[i].emerg;
		struct ec_slave *slave = s->wanted.configs[i]->slave;

		ec_emerg_describe(slave ? &slave->mbox : NULL, e, e->data - base);
	}
	mutex_lock(&rq->lock);
	for (i = 0; i < s->n_specs; i++) {
		const struct ec_request *r = &rq->reqs[i];

		r->rec->data = r->data - base;
		r->rec->op = r->op;
		WRITE_ONCE(r->rec->start, r->seq);
		WRITE_ONCE(r->rec->done, r->phase == EC_REQUEST_IDLE ? r->seq :
								     r->seq - 1);
	}
	mutex_unlock(&rq->lock);
}

/* Has the request a queue of its own, or one of its kind? */
static bool queue_apart(u32 kind)
{
	return kind == EC_REQUEST_VOE || kind == EC_REQUEST_FOE || kind == EC_REQUEST_DATAGRAM;
}

/* The queue of a request; @own is the next one that is free. */
static struct ec_lane *lane_of(struct ec_requests *rq, const struct ec_request_spec *spec,
			       struct ec_lane **own)
{
	struct ec_lane *lane = spec->config == EC_UAPI_NONE32 ? NULL : &rq->lanes[spec->config];

	if (!queue_apart(spec->kind))
		return lane;
	if (spec->kind == EC_REQUEST_VOE)
		lane->voe = true;
	if (spec->kind == EC_REQUEST_FOE) {
		if (lane->files)
			return lane->files;
		lane->files = *own;
	}
	init(rq, *own, spec->config);
	return (*own)++;
}

/**
 * ec_requests_lay_out() - give each request its memory and its request queue
 * @s: session with @shared
 * @rq: its requests; their works are initialized
 *
 * Context: Process, session lock held.
 */
void ec_requests_lay_out(struct ec_session *s, struct ec_requests *rq)
{
	u8 *base = rq->shared->requests;
	struct ec_request_record *rec = (void *)(base + sizeof(struct ec_request_area));
	struct ec_lane *own = &rq->lanes[s->wanted.n_configs];
	size_t at = lay_out_rings(s, rq);
	u8 *buf = rq->bufs;
	unsigned int i;

	lockdep_assert_held(s->wanted.lock);
	for (i = 0; i < s->n_specs; i++, rec++) {
		const struct ec_request_spec *spec = &s->specs[i];
		struct ec_lane *lane = lane_of(rq, spec, &own);
		struct ec_request *r = &rq->reqs[i];

		r->rec = rec;
		r->kind = spec->kind;
		r->cap = spec->size;
		r->data = base + at + (data_bytes(r->kind, r->cap) - ALIGN(r->cap, 8));
		r->buf = buf;
		list_add_tail(&r->list, &lane->requests);
		at += data_bytes(r->kind, r->cap);
		buf += buf_bytes(spec);
	}
	rq->n_lanes = own - rq->lanes;
}

/**
 * ec_requests_lanes() - how many request queues are needed at most
 * @s: session
 *
 * Context: Process, session lock held.
 * Return: number.
 */
unsigned int ec_requests_lanes(const struct ec_session *s)
{
	unsigned int i, n = s->wanted.n_configs;

	lockdep_assert_held(s->wanted.lock);
	for (i = 0; i < s->n_specs; i++)
		n += queue_apart(s->specs[i].kind);
	return n;
}

/**
 * ec_requests_buf_bytes() - size of the private copies
 * @s: session
 *
 * Context: Process, session lock held.
 * Return: bytes.
 */
size_t ec_requests_buf_bytes(const struct ec_session *s)
{
	unsigned int i;
	size_t n = 0;

	lockdep_assert_held(s->wanted.lock);
	for (i = 0; i < s->n_specs; i++)
		n += buf_bytes(&s->specs[i]);
	return n;
}
