// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "coe.h"
#include "config.h"
#include "emerg.h"
#include "master.h"
#include "request.h"
#include "session.h"
#include "slave.h"
#include "xfer.h"

#define WATCH_US	10000	/* between looks while anything waits */

enum state {
	IDLE,
	PENDING,
	RUNNING,
};

/**
 * struct ec_request - the kernel's side of one request
 * @list: in its lane
 * @rec: mapped by the application; read once, when a start is seen
 * @kind: EC_REQUEST_*
 * @cap: room for data
 * @data: that, mapped
 * @seq: number of the last start seen
 * @state: enum state
 * @since_ns: when that start was seen (ktime)
 * @timeout_ms: to begin with it, 0: unlimited
 * @index: object or register address
 * @sub: subindex
 * @write: write, not read
 * @size: bytes of @buf
 * @buf: private copy of the data, while not IDLE
 */
struct ec_request {
	struct list_head list;
	struct ec_request_record *rec;
	u32 kind;
	u32 cap;
	u8 *data;
	u32 seq;
	enum state state;
	u64 since_ns;
	u32 timeout_ms;
	u16 index;
	u8 sub;
	bool write;
	u32 size;
	u8 *buf;
};

/**
 * struct ec_lane - requests and emergencies of one configuration
 * @work: does them
 * @rq: all lanes
 * @config: number of the configuration
 * @requests: of this lane
 * @emerg: ring of emergencies
 */
struct ec_lane {
	struct work_struct work;
	struct ec_requests *rq;
	u32 config;
	struct list_head requests;
	struct ec_emerg emerg;
};

/**
 * struct ec_requests - all requests of an activation
 * @kref: the session and each work that is queued or runs
 * @master: master
 * @shared: mapped memory, with a reference
 * @lock: protects the requests; inside session_lock
 * @kick: looks once
 * @watch: looks again and again while anything waits
 * @reqs: requests
 * @n_reqs: entries in @reqs
 * @lanes: by configuration
 * @n_lanes: entries in @lanes
 */
struct ec_requests {
	struct kref kref;
	struct ec_master *master;
	struct ec_shared *shared;
	struct mutex lock;
	struct work_struct kick;
	struct work_struct watch;
	struct ec_request *reqs;
	unsigned int n_reqs;
	struct ec_lane *lanes;
	unsigned int n_lanes;
};

/* works ---------------------------------------------------------------------*/

static void release(struct kref *kref)
{
	struct ec_requests *rq = container_of(kref, struct ec_requests, kref);
	unsigned int i;

	for (i = 0; i < rq->n_reqs; i++)
		kvfree(rq->reqs[i].buf);
	ec_shared_put(rq->shared);
	kvfree(rq->reqs);
	kvfree(rq->lanes);
	kfree(rq);
}

static void put(struct ec_requests *rq)
{
	kref_put(&rq->kref, release);
}

/* The work has a reference while it is queued or runs. */
static void queue(struct ec_requests *rq, struct work_struct *work)
{
	kref_get(&rq->kref);
	if (!queue_work(rq->master->work, work))
		put(rq);
}

/* The session these requests belong to, or NULL: it has ended. */
static struct ec_session *session_of(const struct ec_requests *rq)
{
	struct ec_session *s = rq->master->session;

	return s && s->requests == rq && !rq->master->stopping ? s : NULL;
}

/* begin and end of a request ------------------------------------------------*/

static void finish(struct ec_request *r, int result, u32 got, u32 abort)
{
	if (!result && !r->write)
		memcpy(r->data, r->buf, got);
	kvfree(r->buf);
	r->buf = NULL;
	r->state = IDLE;
	WRITE_ONCE(r->rec->result, result);
	WRITE_ONCE(r->rec->got, got);
	WRITE_ONCE(r->rec->abort_code, abort);
	smp_store_release(&r->rec->done, r->seq);
}

/* Nothing in a record can be trusted: each field is read once, then checked. */
static void pick_up(struct ec_request *r, u64 now)
{
	u32 start = smp_load_acquire(&r->rec->start), size = READ_ONCE(r->rec->size);

	if (r->state != IDLE || start == r->seq)
		return;
	r->seq = start;
	r->state = PENDING;
	r->since_ns = now;
	r->timeout_ms = READ_ONCE(r->rec->timeout_ms);
	r->index = READ_ONCE(r->rec->index);
	r->sub = READ_ONCE(r->rec->subindex);
	r->write = READ_ONCE(r->rec->write);
	if (!r->write && r->kind == EC_REQUEST_SDO)
		size = r->cap;
	else if (!size || size > r->cap) {
		finish(r, -EINVAL, 0, 0);
		return;
	}
	r->size = size;
	r->buf = kvzalloc(max(size, 1u), GFP_KERNEL);
	if (!r->buf)
		finish(r, -ENOMEM, 0, 0);
	else if (r->write)
		memcpy(r->buf, r->data, size);
}

static bool expired(const struct ec_request *r, u64 now)
{
	return r->timeout_ms && now - r->since_ns > (u64)r->timeout_ms * NSEC_PER_MSEC;
}

/*
 * New starts, those that have waited too long, and work for the lanes. False
 * when nothing has to be looked after any more.
 */
static bool look(struct ec_requests *rq)
{
	u64 now = ktime_get_ns();
	struct ec_session *s;
	bool more = false;
	unsigned int i;

	mutex_lock(&rq->master->session_lock);
	s = session_of(rq);
	if (!s)
		goto out;
	mutex_lock(&rq->lock);
	for (i = 0; i < rq->n_lanes; i++) {
		struct ec_lane *lane = &rq->lanes[i];
		bool todo = lane->emerg.count;
		struct ec_request *r;

		list_for_each_entry(r, &lane->requests, list) {
			pick_up(r, now);
			if (r->state == PENDING && expired(r, now))
				finish(r, -ETIMEDOUT, 0, 0);
			todo |= r->state == PENDING;
		}
		more |= todo;
		if (todo && s->configs[i]->slave)
			queue(rq, &lane->work);
	}
	mutex_unlock(&rq->lock);
out:
	mutex_unlock(&rq->master->session_lock);
	return more;
}

static void kick_work(struct work_struct *work)
{
	struct ec_requests *rq = container_of(work, struct ec_requests, kick);

	if (look(rq))
		queue(rq, &rq->watch);
	put(rq);
}

static void watch_work(struct work_struct *work)
{
	struct ec_requests *rq = container_of(work, struct ec_requests, watch);

	do
		usleep_range(WATCH_US, WATCH_US + WATCH_US / 10);
	while (look(rq));
	put(rq);
}

/* lanes ---------------------------------------------------------------------*/

/*
 * May the slave be asked now? On its way through INIT, which is our own doing,
 * it may soon. One that is to stay in INIT gives an error.
 */
static bool ready(const struct ec_slave *s, const struct ec_request *r)
{
	if (r->kind == EC_REQUEST_REG || s->error != EC_SLAVE_OK)
		return true;
	if (s->requested > EC_AL_PREOP && s->reconfigure)
		return false;
	return (READ_ONCE(s->al_status) & EC_AL_STATE_MASK) >= EC_AL_PREOP ||
	       s->requested == EC_AL_INIT;
}

/* The oldest request that can begin, and its slave with a reference. */
static struct ec_request *take(struct ec_lane *lane, struct ec_slave **slave)
{
	struct ec_requests *rq = lane->rq;
	struct ec_request *r, *oldest = NULL;
	u64 now = ktime_get_ns();
	struct ec_session *s;

	mutex_lock(&rq->master->session_lock);
	s = session_of(rq);
	*slave = s ? s->configs[lane->config]->slave : NULL;
	if (!*slave || (*slave)->gone) {
		*slave = NULL;
		goto out;
	}
	ec_slave_ref(*slave);
	mutex_lock(&rq->lock);
	list_for_each_entry(r, &lane->requests, list) {
		if (r->state != PENDING || !ready(*slave, r))
			continue;
		if (expired(r, now))
			finish(r, -ETIMEDOUT, 0, 0);
		else if (!oldest || r->since_ns < oldest->since_ns)
			oldest = r;
	}
	if (oldest)
		oldest->state = RUNNING;
	mutex_unlock(&rq->lock);
out:
	mutex_unlock(&rq->master->session_lock);
	return oldest;
}

static void run(struct ec_requests *rq, struct ec_request *r, struct ec_slave *s)
{
	size_t got = r->write ? 0 : r->size;
	u32 abort = 0;
	int ret;

	if (r->kind == EC_REQUEST_REG) {
		ret = s->error != EC_SLAVE_OK ? -EIO : r->write ?
		      ec_xfer_fpwr(s->master, s->station, r->index, r->buf, r->size) :
		      ec_xfer_fprd(s->master, s->station, r->index, r->buf, r->size);
	} else if (r->write) {
		ret = ec_coe_download(s, r->index, r->sub, false, r->buf, r->size, &abort, 0);
	} else {
		ret = ec_coe_upload(s, r->index, r->sub, false, r->buf, r->size, &got, &abort, 0);
	}
	mutex_lock(&rq->lock);
	finish(r, ret, got, abort);
	mutex_unlock(&rq->lock);
}

static void lane_work(struct work_struct *work)
{
	struct ec_lane *lane = container_of(work, struct ec_lane, work);
	struct ec_requests *rq = lane->rq;
	struct ec_request *r;
	struct ec_slave *slave;

	do {
		r = take(lane, &slave);
		if (r)
			run(rq, r, slave);
		else if (slave && lane->emerg.count)
			ec_emerg_poll(slave);
		if (slave)
			ec_slave_unref(slave);
	} while (r);
	put(rq);
}

/* session -------------------------------------------------------------------*/

/**
 * ec_requests_add() - one more request
 * @s: session, not active
 * @config: configuration in it
 * @kind: EC_REQUEST_*
 * @size: room for data, bytes
 * @index: result: its number
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0, -ENOSPC, -ENOMEM.
 */
int ec_requests_add(struct ec_session *s, u32 config, u32 kind, u32 size, u32 *index)
{
	size_t bytes = s->request_bytes + ALIGN(size, 8);

	if (s->n_specs >= EC_MAX_REQUESTS || bytes > EC_MAX_REQUEST_BYTES)
		return -ENOSPC;
	if (!s->specs)
		s->specs = kvcalloc(EC_MAX_REQUESTS, sizeof(*s->specs), GFP_KERNEL);
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
	return ALIGN(rings_offset(s) + s->n_configs * sizeof(struct ec_emerg_ring), 8);
}

/**
 * ec_requests_bytes() - size of the memory to map
 * @s: session
 *
 * Context: Process, session_lock held.
 * Return: bytes; 0 without configuration.
 */
size_t ec_requests_bytes(const struct ec_session *s)
{
	return s->n_configs ? data_offset(s) + s->request_bytes : 0;
}

static void lay_out(struct ec_session *s, struct ec_requests *rq)
{
	u8 *base = rq->shared->requests;
	struct ec_request_area *area = (void *)base;
	struct ec_request_record *rec = (void *)(base + sizeof(*area));
	struct ec_emerg_ring *ring = (void *)(base + rings_offset(s));
	size_t at = data_offset(s);
	unsigned int i;

	area->magic = EC_REQUEST_MAGIC;
	area->request_count = s->n_specs;
	area->requests = sizeof(*area);
	area->ring_count = s->n_configs;
	area->rings = rings_offset(s);
	for (i = 0; i < s->n_configs; i++, ring++) {
		struct ec_lane *lane = &rq->lanes[i];

		lane->rq = rq;
		lane->config = i;
		INIT_LIST_HEAD(&lane->requests);
		INIT_WORK(&lane->work, lane_work);
		ring->count = s->configs[i]->emergencies;
		ring->data = at;
		lane->emerg = (struct ec_emerg){
			.ring = ring, .data = base + at, .count = ring->count,
		};
		at += ring->count * EC_EMERG_BYTES;
	}
	for (i = 0; i < s->n_specs; i++, rec++) {
		const struct ec_request_spec *spec = &s->specs[i];
		struct ec_request *r = &rq->reqs[i];

		rec->data = at;
		r->rec = rec;
		r->kind = spec->kind;
		r->cap = spec->size;
		r->data = base + at;
		list_add_tail(&r->list, &rq->lanes[spec->config].requests);
		at += ALIGN(spec->size, 8);
	}
}

/**
 * ec_requests_begin() - requests can be started from now on
 * @s: session with @shared
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_requests_begin(struct ec_session *s)
{
	struct ec_requests *rq;
	unsigned int i;

	if (!s->n_configs)
		return 0;
	rq = kzalloc(sizeof(*rq), GFP_KERNEL);
	if (!rq)
		return -ENOMEM;
	kref_init(&rq->kref);
	mutex_init(&rq->lock);
	INIT_WORK(&rq->kick, kick_work);
	INIT_WORK(&rq->watch, watch_work);
	rq->master = s->master;
	rq->shared = s->shared;
	ec_shared_get(rq->shared);
	rq->reqs = kvcalloc(s->n_specs + 1, sizeof(*rq->reqs), GFP_KERNEL);
	rq->lanes = kvcalloc(s->n_configs, sizeof(*rq->lanes), GFP_KERNEL);
	if (!rq->reqs || !rq->lanes) {
		put(rq);
		return -ENOMEM;
	}
	rq->n_reqs = s->n_specs;
	rq->n_lanes = s->n_configs;
	lay_out(s, rq);
	s->requests = rq;
	for (i = 0; i < s->n_configs; i++)
		if (s->configs[i]->slave)
			ec_emerg_set(s->configs[i]->slave, &rq->lanes[i].emerg);
	return 0;
}

/**
 * ec_requests_end() - nothing is started any more
 * @s: session
 *
 * What is on its way ends by itself, within its limits; nobody waits for it.
 *
 * Context: Process, session_lock held. May sleep.
 */
void ec_requests_end(struct ec_session *s)
{
	struct ec_requests *rq = s->requests;
	unsigned int i;

	if (!rq)
		return;
	s->requests = NULL;
	for (i = 0; i < s->n_configs; i++)
		if (s->configs[i]->slave)
			ec_emerg_set(s->configs[i]->slave, NULL);
	put(rq);
}

/**
 * ec_requests_kick() - the application has started a request
 * @rq: requests of its session
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_requests_kick(struct ec_requests *rq)
{
	queue(rq, &rq->kick);
}

/**
 * ec_requests_emerg() - ring of a configuration
 * @s: session
 * @config: number
 *
 * Context: Process, session_lock held.
 * Return: ring, or NULL while not active.
 */
struct ec_emerg *ec_requests_emerg(const struct ec_session *s, u32 config)
{
	return s->requests ? &s->requests->lanes[config].emerg : NULL;
}
