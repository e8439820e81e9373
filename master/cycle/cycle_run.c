// SPDX-License-Identifier: GPL-2.0-only
/*
 * One cycle that the kernel runs. Application and cycle exchange whole images through
 * three buffers each way (struct ec_exchange), so neither ever waits for the
 * other. The application can write all of that memory: nothing that is read
 * there is more than data or a number of a buffer, and that is cut to 0..2.
 *
 * Nothing here allocates, prints or takes a lock but those of ec_cycle_receive() and
 * ec_cycle_send(), and those of the callers of the file that owns the cycle, when some wait.
 */
#include <linux/ktime.h>
#include <linux/rcupdate.h>
#include <linux/sched.h>
#include "../base/bytes.h"
#include "../base/once64.h"
#include "../config/domain.h"
#include "cycle_run.h"
#include "receive.h"
#include "send.h"
#include "units_hold.h"
#include "units_run.h"
#include "waiters.h"

#define INDEX_MASK	3
#define STEADY		1000	/* complete cycles before no missing slave is expected */

/* A number from memory of the application. */
static u8 buffer_index(u32 word)
{
	return min_t(u32, word & INDEX_MASK, EC_EXCHANGE_BUFFERS - 1);
}

/* Takes the newest outputs, or returns false when there are none since the last time. */
static bool take_outputs(struct ec_cycle_thread *t)
{
	struct ec_exchange *x = ec_cycle_run_exchange(t);

	if (!(READ_ONCE(x->outputs) & EC_EXCHANGE_NEW))
		return false;
	t->front = buffer_index(xchg(&x->outputs, t->front));
	t->given = true;
	if (ec_units_of(t->cycle))
		ec_units_fed(t->cycle->units, READ_ONCE(ec_cycle_run_buffer(t, t->front)->fed));
	t->ahead = true;
	return true;
}

/* Send the image from now on, with the newest outputs in it. */
static void use_image(struct ec_cycle_thread *t)
{
	u8 *image = t->cycle->shared->image;
	const u8 *data = (const u8 *)(ec_cycle_run_buffer(t, t->front) + 1);
	unsigned int i;

	for (i = 0; t->ahead && i < t->n_outputs; i++)
		ec_bytes_copy(image + t->outputs[i].offset, data + t->outputs[i].offset,
			t->outputs[i].len);
	t->ahead = false;
	/* a reader that sees NULL finds these in the image */
	smp_store_release(&t->cycle->direct, NULL);
}

/* Was the working counter of each domain complete when it was last received? */
static bool all_take_part(const struct ec_cycle *c)
{
	const struct ec_status_domain *st = c->shared->status->domains;

	ec_for_each_domain(d, c->wanted)
		if (d->expected && READ_ONCE(st[d->index].wc_state) != EC_STATUS_WC_COMPLETE)
			return false;
	return true;
}

/*
 * The buffer of the application is sent directly, which saves a copy of each slave's
 * outputs, and of its inputs when they are received. But its inputs are not the last
 * values, which have to stay when a slave is missing. So the image is sent while a
 * slave is missing and for STEADY cycles after it, and if the kernel copies to outputs.
 */
static void choose_source(struct ec_cycle_thread *t)
{
	struct ec_cycle *c = t->cycle;

	t->steady = all_take_part(c) ? min(t->steady + 1, STEADY) : 0;
	if (!t->given || c->copying || t->steady < STEADY) {
		use_image(t);
		return;
	}
	t->ahead = true;
	c->direct = (const u8 *)(ec_cycle_run_buffer(t, t->front) + 1);
}

/**
 * ec_cycle_run_wake() - wake the callers of the file that owns a cycle
 * @c: cycle that the kernel runs
 * @atomic: in a hard interrupt: the thread of the cycle wakes callers of poll() instead
 *
 * Callers of other files add no work to a cycle.
 *
 * Context: Process; with @atomic any. RT-safe: bounded by %EC_MAX_WAITERS.
 */
void ec_cycle_run_wake(struct ec_cycle *c, bool atomic)
{
	struct ec_waiters *w;
	bool polled = false;

	rcu_read_lock();
	w = rcu_dereference(c->waiters);
	if (w && atomic) {
		ec_waiters_wake_sleepers(w);
		polled = ec_waiters_polled(w);
	} else if (w) {
		ec_waiters_wake(w);
	}
	rcu_read_unlock();
	if (polled) {
		WRITE_ONCE(c->thread->polled, true);
		wake_up_process(c->thread->task);
	}
}

/**
 * ec_cycle_run_end() - no more cycles; waiting callers return
 * @c: cycle that the kernel runs
 *
 * Context: Process. RT-safe: bounded by %EC_MAX_WAITERS.
 */
void ec_cycle_run_end(struct ec_cycle *c)
{
	/* pairs with ec_cycle_thread_ended() */
	smp_store_release(&c->cycles->run, c->cycles->run + 1);
	ec_cycle_run_wake(c, false);
}

/* An output stall is an event, and its end as well; of many in a second the first ones. */
static noinline void tell_stall(struct ec_cycle_thread *t)
{
	t->stall_told = ec_events_admit(&t->stalls, ktime_get_ns());
	if (!t->stall_told)
		return;
	ec_event(t->cycle->base, EC_EVENT_STALL, t->cycle->setup.kernel.stall, t->unfed,
		 t->stalls.more - 1);
	t->stalls.more = 0;
}

/* The application has given no outputs for too long. */
static void stop_outputs(struct ec_cycle_thread *t)
{
	u8 *image = t->cycle->shared->image;
	struct ec_status_cycle *st = ec_cycle_run_status(t);
	unsigned int i;

	switch (t->cycle->setup.kernel.stall) {
	case EC_STALL_STOP:
		WRITE_ONCE(st->state, EC_CYCLE_STATE_STOPPED);
		return;
	case EC_STALL_ZERO:
		t->given = false;
		t->ahead = false;
		for (i = 0; i < t->n_outputs; i++)
			memset(image + t->outputs[i].offset, 0, t->outputs[i].len);
		break;
	}
	WRITE_ONCE(st->state, EC_CYCLE_STATE_STALLED);
}

/* Outputs of this cycle: new ones, or those of the configured policy. */
static void feed(struct ec_cycle_thread *t)
{
	struct ec_status_cycle *st = ec_cycle_run_status(t);
	u32 limit = t->cycle->setup.kernel.stall_cycles;

	if (take_outputs(t)) {
		if (unlikely(t->stall_told))
			ec_event(t->cycle->base, EC_EVENT_OUTPUTS, t->unfed);
		t->stall_told = false;
		t->fed = !READ_ONCE(t->kept);
		t->unfed = 0;
		if (st->state != EC_CYCLE_STATE_RUNNING)
			WRITE_ONCE(st->state, EC_CYCLE_STATE_RUNNING);
		return;
	}
	if (!t->fed)
		return;
	ec_status_add(t->cycle->shared->status, &st->missed, 1);
	if (!limit || t->unfed == ~0u || ++t->unfed < limit)
		return;
	if (t->unfed == limit) {
		stop_outputs(t);
		t->stalls.more++;
	}
	if (unlikely(!t->stall_told))
		tell_stall(t);
}

/**
 * ec_cycle_run_deal() - give an application the buffers that follow those of the cycle
 * @t: cycle
 *
 * Its initial outputs are those that are sent.
 *
 * Context: The cycle thread, or before it starts. RT-safe.
 */
void ec_cycle_run_deal(struct ec_cycle_thread *t)
{
	unsigned int n = (t->front + 1) % EC_EXCHANGE_BUFFERS;
	struct ec_exchange *x = ec_cycle_run_exchange(t);

	x->stride = t->stride;
	x->app_output = n;
	x->app_input = (t->back + 1) % EC_EXCHANGE_BUFFERS;
	WRITE_ONCE(x->outputs, (t->front + 2) % EC_EXCHANGE_BUFFERS);
	WRITE_ONCE(x->inputs, (t->back + 2) % EC_EXCHANGE_BUFFERS);
	if (!t->bytes)
		return;
	memcpy(ec_cycle_run_buffer(t, n) + 1, t->cycle->shared->image, t->bytes);
	if (t->cycle->units)
		ec_units_overlay(t->cycle, (u8 *)(ec_cycle_run_buffer(t, n) + 1));
}

/**
 * ec_cycle_run_give() - give outputs in the place of an application
 * @c: active cycle after ec_cycle_thread_keep()
 * @buffer: number of the output buffer that the caller has, changes
 * @image: of all domains
 *
 * Context: Process. One caller at a time.
 */
void ec_cycle_run_give(struct ec_cycle *c, u32 *buffer, const u8 *image)
{
	struct ec_cycle_thread *t = c->thread;
	struct ec_exchange_buffer *b = ec_cycle_run_buffer(t, *buffer);

	b->fed = ~0ULL;
	memcpy(b + 1, image, t->bytes);
	*buffer = buffer_index(xchg(&ec_cycle_run_exchange(t)->outputs,
				    *buffer | EC_EXCHANGE_NEW));
}

/* The previous application may have exited at any point: the next one gets all buffers again. */
static void adopt(struct ec_cycle_thread *t)
{
	/* it leaves with the outputs that it has given last, and owes none any more */
	if (READ_ONCE(t->kept)) {
		take_outputs(t);
		t->fed = false;
	}
	use_image(t);
	t->given = false;
	ec_cycle_run_deal(t);
	complete(&t->adopted);
}

/* For receive and send of the application, which make no system call. */
static void tell_device(const struct ec_cycle *c)
{
	u32 *no_device = &c->shared->status->no_device;
	bool gone = !ec_links_attached(c->links);

	if (unlikely(*no_device != gone))
		WRITE_ONCE(*no_device, gone);
}

/* Pass inputs and working counters of this cycle to the application; it is woken after that. */
static void cycle_run_publish(struct ec_cycle_thread *t)
{
	struct ec_cycle *c = t->cycle;
	struct ec_exchange_buffer *b = ec_cycle_run_buffer(t, EC_EXCHANGE_BUFFERS + t->back);
	struct ec_status_cycle *st = ec_cycle_run_status(t);
	u64 cycle = st->cycle + 1;
	unsigned long flags;
	unsigned int i;

	/* a barrier: what was written before the request is seen */
	if (unlikely(READ_ONCE(t->adopt)) && xchg(&t->adopt, 0))
		adopt(t);
	b->cycle = cycle;
	b->time_ns = t->next_ns;
	for (i = 0; i < c->wanted->n_domains; i++)
		b->domains[i] = c->shared->status->domains[i];
	tell_device(c);
	memcpy(b + 1, c->shared->image, t->bytes);
	t->back = buffer_index(xchg(&ec_cycle_run_exchange(t)->inputs, t->back | EC_EXCHANGE_NEW));
	/* the application that sees the number finds the inputs */
	flags = ec_status_begin(c->shared->status);
	WRITE_ONCE(st->cycle, cycle);
	ec_status_end(c->shared->status, flags);
	ec_write64(&c->cycles->number, cycle);
}

/* Skip cycles whose time has passed, so that the phase stays. Return: how many. */
static u64 skip_missed(struct ec_cycle_thread *t, u64 now)
{
	u32 period = t->cycle->setup.kernel.period_ns;
	s64 late = now - t->next_ns;
	u64 skipped;

	if (late < period)
		return 0;
	skipped = div_u64(late, period);
	ec_status_add(t->cycle->shared->status, &ec_cycle_run_status(t)->overruns, skipped);
	t->next_ns += skipped * period;
	return skipped;
}

/* Domains of this cycle. One whose cycle was skipped is sent now, then in its phase again. */
static u64 turn(struct ec_cycle_thread *t, u64 skipped)
{
	u64 domains = t->always;
	unsigned int i;

	for (i = 0; i < t->n_slow; i++) {
		struct ec_cycle_slow *w = &t->slow[i];

		w->left -= min_t(u64, skipped, S32_MAX / 2);
		if (w->left <= 0) {
			domains |= BIT_ULL(w->domain);
			w->left = w->division - -w->left % w->division;
		}
		w->left--;
	}
	return domains;
}

/**
 * ec_cycle_run_once() - one cycle
 * @t: cycle; its schedule is that of the next one afterwards
 * @entered: the links are entered, and nothing may sleep
 *
 * Context: The cycle thread, or with @entered its timer. RT-safe; sleeps after a cycle timeout
 * only.
 * Return: false: it was the last one.
 */
bool ec_cycle_run_once(struct ec_cycle_thread *t, bool entered)
{
	struct ec_cycle *c = t->cycle;
	struct ec_ioc_send send = { .flags = c->setup.kernel.dc };
	u64 due = t->next_ns, now = ktime_get_ns();
	s32 correction;
	int ret;

	send.queued = turn(t, skip_missed(t, now));
	/* before the first send the cycle does not use the links */
	if (entered)
		ec_cycle_do_receive(c);
	else if (ec_cycle_run_status(t)->state != EC_CYCLE_STATE_WAITING)
		ec_cycle_receive(c);
	correction = ec_pll_step(&t->lock, c, t->next_ns, t->epoch_ns);
	c->clock.lead = t->lock.time - t->next_ns;
	if (ec_units_of(c))
		ec_units_lease(c);
	feed(t);
	choose_source(t);
	if (t->ops && t->ops->cycle)
		t->ops->cycle(c);
	if (ec_cycle_run_status(t)->state <= EC_CYCLE_STATE_STALLED) {
		ret = entered ? ec_cycle_do_send(c, &send) : ec_cycle_send(c, &send);
		if (!ret)
			ec_late_count(&c->late, ec_read64(&c->links->access.last_send_ns) - due);
	}
	cycle_run_publish(t);
	ec_cycle_run_wake(c, entered);
	t->end_ns = ktime_get_ns();
	ec_late_work(&c->late, t->end_ns - now);
	t->next_ns += c->setup.kernel.period_ns + correction;
	return ec_cycle_run_status(t)->state != EC_CYCLE_STATE_STOPPED;
}
