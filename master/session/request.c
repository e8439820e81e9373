// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "request.h"
#include "request_int.h"
#include "request_layout.h"
#include "request_run.h"
#include "session.h"
#include "../config/replay.h"
#include "../bus/slave.h"

#define WATCH_US	10000	/* between two checks while a request waits */

/* works ---------------------------------------------------------------------*/

static void request_release(struct kref *kref)
{
	struct ec_requests *rq = container_of(kref, struct ec_requests, kref);

	ec_shared_put(rq->shared);
	kvfree(rq->bufs);
	kvfree(rq->reqs);
	kvfree(rq->lanes);
	kfree(rq);
}

static void request_put(struct ec_requests *rq)
{
	kref_put(&rq->kref, request_release);
}

/* The work has a reference while it is queued or runs. */
static void request_queue(struct ec_requests *rq, struct workqueue_struct *wq,
			  struct work_struct *work)
{
	kref_get(&rq->kref);
	if (!queue_work(wq, work))
		request_put(rq);
}

/* The session these requests belong to, or NULL: it has ended. */
static struct ec_session *request_session_of(const struct ec_requests *rq)
{
	struct ec_session *s = rq->sessions->session;

	return s && s->requests == rq && !READ_ONCE(rq->sessions->base->stopping) ? s : NULL;
}

/* The slave of a request queue now, or NULL. */
static struct ec_slave *lane_slave(const struct ec_session *s, const struct ec_lane *lane)
{
	lockdep_assert_held(s->wanted.lock);
	return lane->config == EC_UAPI_NONE32 ? NULL : s->wanted.configs[lane->config]->slave;
}

/* begin and end of a request ------------------------------------------------*/

static void request_finish(struct ec_request *r)
{
	const struct ec_request_result *res = &r->res;

	if (!res->err && ec_request_reads(r) && !ec_request_is_file(r))
		memcpy(r->data, r->buf, res->got);
	r->phase = EC_REQUEST_IDLE;
	WRITE_ONCE(r->rec->result, res->err);
	WRITE_ONCE(r->rec->got, res->got);
	WRITE_ONCE(r->rec->abort_code, res->code);
	WRITE_ONCE(r->rec->got_vendor_id, res->vendor);
	WRITE_ONCE(r->rec->got_type, res->type);
	/* the result before the number that announces it */
	smp_store_release(&r->rec->done, r->seq);
}

static void request_fail(struct ec_request *r, int err)
{
	r->res = (struct ec_request_result){ .err = err };
	request_finish(r);
}

/* Nothing in a record can be trusted: each field is read once, then checked. */
static void pick_up(struct ec_request *r, u64 now)
{
	/* the number before the request that it starts */
	u32 start = smp_load_acquire(&r->rec->start);
	int ret;

	if (r->phase != EC_REQUEST_IDLE || start == r->seq)
		return;
	r->seq = start;
	r->phase = EC_REQUEST_PENDING;
	r->stop = false;
	r->since_ns = now;
	r->timeout_ms = READ_ONCE(r->rec->timeout_ms);
	r->index = READ_ONCE(r->rec->index);
	r->sub = READ_ONCE(r->rec->subindex);
	r->op = READ_ONCE(r->rec->op);
	r->vendor = READ_ONCE(r->rec->vendor_id);
	if (ec_request_is_file(r))
		memcpy(r->buf, r->data - EC_FOE_NAME, EC_FOE_NAME);
	ret = ec_request_accept(r, READ_ONCE(r->rec->flags), READ_ONCE(r->rec->size));
	if (ret) {
		request_fail(r, ret);
		return;
	}
	if (ec_request_is_file(r))
		return;
	memset(r->buf, 0, r->size);
	if (ec_request_writes(r))
		memcpy(r->buf, r->data, r->size);
}

/* @stop ends a transfer; a request that has not begun ends at once. */
static void end_cancelled(struct ec_request *r)
{
	if (r->phase == EC_REQUEST_IDLE || READ_ONCE(r->rec->cancel) != r->seq)
		return;
	WRITE_ONCE(r->stop, true);
	if (r->phase == EC_REQUEST_PENDING)
		request_fail(r, -ECANCELED);
}

static bool expired(const struct ec_request *r, u64 now)
{
	u64 until = ec_request_begin_ns(r);

	return until && now > until;
}

/*
 * Pick up new starts, end requests that are cancelled or have waited too long, and queue work for
 * the others. False: no request waits any more.
 */
static bool request_look(struct ec_requests *rq)
{
	u64 now = ktime_get_ns();
	struct ec_session *s;
	bool more = false;
	unsigned int i;

	mutex_lock(&rq->sessions->lock);
	s = request_session_of(rq);
	if (!s)
		goto out;
	mutex_lock(&rq->lock);
	for (i = 0; i < rq->n_lanes; i++) {
		struct ec_lane *lane = &rq->lanes[i];
		bool there = lane->config == EC_UAPI_NONE32 || lane_slave(s, lane), waits = false;
		struct ec_request *r;

		list_for_each_entry(r, &lane->requests, list) {
			pick_up(r, now);
			end_cancelled(r);
			if (r->phase != EC_REQUEST_PENDING)
				continue;
			if (r->kind == EC_REQUEST_VOE && !there)
				request_fail(r, -ENOTCONN);
			else if (expired(r, now))
				request_fail(r, -ETIMEDOUT);
			else
				waits = true;
		}
		more |= waits;
		if (waits && there)
			request_queue(rq, rq->sessions->lanes, &lane->work);
	}
	mutex_unlock(&rq->lock);
out:
	mutex_unlock(&rq->sessions->lock);
	return more;
}

static void kick_work(struct work_struct *work)
{
	struct ec_requests *rq = container_of(work, struct ec_requests, kick);

	if (request_look(rq))
		request_queue(rq, rq->sessions->service, &rq->watch);
	request_put(rq);
}

static void watch_work(struct work_struct *work)
{
	struct ec_requests *rq = container_of(work, struct ec_requests, watch);

	/* a request begins by a write to mapped memory, which wakes no thread */
	do
		usleep_range(WATCH_US, WATCH_US + WATCH_US / 10);
	while (request_look(rq));
	request_put(rq);
}

/* request queues ------------------------------------------------------------*/

/*
 * Can the request begin now? While the master configures the slave, it passes INIT:
 * the request waits. With a slave that is to stay in INIT it fails. A datagram has no slave.
 */
static bool ready(const struct ec_slave *s, const struct ec_request *r)
{
	if (!s || r->kind == EC_REQUEST_REG || READ_ONCE(s->note.error) != EC_SLAVE_OK)
		return true;
	if (READ_ONCE(s->al.requested) > EC_AL_PREOP && READ_ONCE(s->work.reconfigure))
		return false;
	return (READ_ONCE(s->al.status) & EC_AL_STATE_MASK) >= EC_AL_PREOP ||
	       READ_ONCE(s->al.requested) == EC_AL_INIT;
}

/* The oldest request that can begin, and its slave with a reference. */
static struct ec_request *request_take(struct ec_lane *lane, struct ec_slave **slave)
{
	struct ec_requests *rq = lane->rq;
	struct ec_request *r, *oldest = NULL;
	u64 now = ktime_get_ns();
	struct ec_session *s;

	mutex_lock(&rq->sessions->lock);
	s = request_session_of(rq);
	*slave = s ? lane_slave(s, lane) : NULL;
	if (*slave && (*slave)->stop.gone)
		*slave = NULL;
	if (!s || (!*slave && lane->config != EC_UAPI_NONE32))
		goto out;
	if (*slave)
		ec_slave_ref(*slave);
	mutex_lock(&rq->lock);
	list_for_each_entry(r, &lane->requests, list) {
		if (r->phase != EC_REQUEST_PENDING || !ready(*slave, r))
			continue;
		if (expired(r, now))
			request_fail(r, -ETIMEDOUT);
		else if (!oldest || r->since_ns < oldest->since_ns)
			oldest = r;
	}
	if (oldest) {
		oldest->phase = EC_REQUEST_RUNNING;
		oldest->recorded = *slave && ec_request_writes(oldest) &&
				   ec_replay_is_open(&s->wanted, *slave);
	}
	mutex_unlock(&rq->lock);
out:
	mutex_unlock(&rq->sessions->lock);
	return oldest;
}

/* Before the application sees the result. */
static void request_record(struct ec_requests *rq, const struct ec_request *r,
			   struct ec_slave *slave)
{
	struct ec_startup what = {
		.index = r->index, .sub = r->sub, .complete = r->complete, .size = r->size,
	};
	struct ec_session *s;

	if (r->kind == EC_REQUEST_SDO)
		what.type = EC_STARTUP_SDO;
	else if (r->kind == EC_REQUEST_SOE)
		what.type = EC_STARTUP_IDN;
	else if (r->kind == EC_REQUEST_REG)
		what.type = EC_STARTUP_REG;
	else
		return;
	ec_sessions_lock(rq->sessions);
	s = request_session_of(rq);
	if (s)
		ec_replay_record(&s->wanted, slave, &what, r->buf);
	ec_sessions_unlock(rq->sessions);
}

static void lane_work(struct work_struct *work)
{
	struct ec_lane *lane = container_of(work, struct ec_lane, work);
	struct ec_requests *rq = lane->rq;
	struct ec_request *r;
	struct ec_slave *slave;

	do {
		r = request_take(lane, &slave);
		if (r) {
			ec_request_run(r, slave, rq->sessions->links);
			if (r->recorded && !r->res.err)
				request_record(rq, r, slave);
			mutex_lock(&rq->lock);
			request_finish(r);
			mutex_unlock(&rq->lock);
		}
		ec_slave_unref(slave);
	} while (r);
	request_put(rq);
}

/* session -------------------------------------------------------------------*/

/**
 * ec_requests_begin() - requests can be started from now on
 * @s: session with @shared
 *
 * Context: Process, session lock held. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_requests_begin(struct ec_session *s)
{
	struct ec_requests *rq;
	unsigned int i;

	lockdep_assert_held(s->wanted.lock);
	if (!s->wanted.n_configs && !s->n_specs)
		return 0;
	rq = kzalloc(sizeof(*rq), GFP_KERNEL_ACCOUNT);
	if (!rq)
		return -ENOMEM;
	kref_init(&rq->kref);
	mutex_init(&rq->lock);
	INIT_WORK(&rq->kick, kick_work);
	INIT_WORK(&rq->watch, watch_work);
	rq->sessions = s->sessions;
	rq->shared = s->cycle.shared;
	ec_shared_get(rq->shared);
	rq->reqs = kvcalloc(s->n_specs + 1, sizeof(*rq->reqs), GFP_KERNEL_ACCOUNT);
	rq->n_lanes = ec_requests_lanes(s);
	rq->lanes = kvcalloc(rq->n_lanes, sizeof(*rq->lanes), GFP_KERNEL_ACCOUNT);
	rq->bufs = kvzalloc(max_t(size_t, ec_requests_buf_bytes(s), 1), GFP_KERNEL_ACCOUNT);
	if (!rq->reqs || !rq->lanes || !rq->bufs) {
		request_put(rq);
		return -ENOMEM;
	}
	for (i = 0; i < rq->n_lanes; i++)
		INIT_WORK(&rq->lanes[i].work, lane_work);
	ec_requests_lay_out(s, rq);
	s->requests = rq;
	ec_requests_describe(s);
	ec_for_each_config(c, &s->wanted)
		ec_requests_attach(s, c);
	return 0;
}

/**
 * ec_requests_end() - requests cannot be started any more
 * @s: session
 *
 * Transfers in progress are cancelled; this does not wait for them.
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_requests_end(struct ec_session *s)
{
	struct ec_requests *rq = s->requests;
	struct ec_request *r;
	unsigned int i;

	lockdep_assert_held(s->wanted.lock);
	if (!rq)
		return;
	/* none begins any more: request_take() and request_look() find no session */
	for (i = 0; i < rq->n_lanes; i++)
		list_for_each_entry(r, &rq->lanes[i].requests, list)
			WRITE_ONCE(r->stop, true);
	s->requests = NULL;
	ec_for_each_config(c, &s->wanted) {
		ec_requests_attach(s, c);
		/* callers of its mailbox see that they are cancelled */
		if (c->slave)
			wake_up_all(&c->slave->stop.wake);
	}
	request_put(rq);
}

/**
 * ec_requests_kick() - the application has started or cancelled a request
 * @s: active session
 *
 * Context: Cycle owner. RT-safe.
 */
void ec_requests_kick(struct ec_session *s)
{
	struct ec_requests *rq = s->requests;
	const struct ec_request_area *area;

	if (!rq)
		return;
	area = (void *)rq->shared->requests;
	/* ec_requests_notice() need not report these again; pairs with ec_request_started() */
	WRITE_ONCE(rq->starts, smp_load_acquire(&area->starts));
	request_queue(rq, rq->sessions->service, &rq->kick);
}

/**
 * ec_requests_notice() - has the application started or cancelled a request?
 * @c: cycle of an active session
 *
 * They are counted in mapped memory, also those without %EC_SEND_FLAG_REQUESTS.
 *
 * Context: Cycle owner, also in hard interrupt; without a kernel cycle the monitor. RT-safe.
 */
void ec_requests_notice(struct ec_cycle *c)
{
	struct ec_requests *rq = ec_cycle_session(c)->requests;
	const struct ec_request_area *area;
	u32 starts;

	if (!rq)
		return;
	area = (void *)rq->shared->requests;
	/* pairs with ec_request_started() */
	starts = smp_load_acquire(&area->starts);
	if (starts == READ_ONCE(rq->starts))
		return;
	WRITE_ONCE(rq->starts, starts);
	request_queue(rq, rq->sessions->service, &rq->kick);
}

/**
 * ec_requests_attach() - set where emergencies and VoE messages of a slave go
 * @s: session
 * @c: configuration that has got its slave, or whose session has begun or ended
 *
 * Context: Process, session lock held.
 */
void ec_requests_attach(const struct ec_session *s, const struct ec_config *c)
{
	struct ec_lane *lane = s->requests ? &s->requests->lanes[c->index] : NULL;

	lockdep_assert_held(s->wanted.lock);
	if (!c->slave)
		return;
	ec_emerg_set(&c->slave->mbox, lane ? &lane->emerg : NULL);
	ec_mbox_keep_voe(&c->slave->mbox, lane && lane->voe);
}

/**
 * ec_requests_record() - the record of a request of an active session
 * @s: session
 * @index: number from ec_requests_add()
 * @data: result: its data
 *
 * Context: Process, session lock held or the session kept active.
 * Return: record.
 */
struct ec_request_record *ec_requests_record(const struct ec_session *s, u32 index, u8 **data)
{
	const struct ec_request *r = &s->requests->reqs[index];

	lockdep_assert(lockdep_is_held(s->wanted.lock) || READ_ONCE(s->wanted.active));
	*data = r->data;
	return r->rec;
}

/**
 * ec_requests_emerg() - emergencies of a configuration of an active session
 * @s: session
 * @config: number
 *
 * Context: Any, while the session is kept active.
 * Return: ring.
 */
struct ec_emerg *ec_requests_emerg(const struct ec_session *s, u32 config)
{
	return &s->requests->lanes[config].emerg;
}
