// SPDX-License-Identifier: GPL-2.0-only
/*
 * The kernel runs the cycle: a real-time thread on an absolute timer is the
 * master's cyclic caller. Application and thread exchange whole images through
 * three buffers each way (struct ec_exchange), so neither ever waits for the
 * other. The application can write all of that memory: nothing that is read
 * there is more than data or a number of a buffer, and that is cut to 0..2.
 *
 * Once it runs, the thread allocates nothing, prints nothing and takes no lock
 * but those of ec_cycle_receive() and ec_cycle_send(), and the one of the wait
 * queue of the file that owns the cycle, when a caller waits there.
 */
#include <linux/hrtimer.h>
#include <linux/kthread.h>
#include <linux/ktime.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include <linux/rcupdate.h>
#include <linux/wait.h>
#include "../base/bytes.h"
#include "cycle.h"
#include "pll.h"
#include "cycle_thread.h"
#include "../config/domain.h"
#include "../base/once64.h"
#include "waiters.h"

#define EPOCH_2000_NS	(946684800ULL * NSEC_PER_SEC)
#define INDEX_MASK	3
#define ADOPT_MS	1000	/* for a takeover, besides two periods */
#define STEADY		1000	/* cycles in which all take part, before that is relied on */

/* outputs side by side in the image */
struct area {
	u32 offset;
	u32 len;
};

/* a domain that is not sent in each cycle */
struct slow {
	u32 domain;
	s32 left;	/* cycles until its turn */
	s32 division;
};

/**
 * struct ec_cycle_thread - @cycle, @outputs and sizes are immutable, the
 *	rest is the thread's
 * @cycle: active cycle; its session ends the thread before it goes away
 * @ops: reports to higher layers
 * @task: thread
 * @outputs: areas that are taken from the application
 * @n_outputs: entries in @outputs
 * @always: domains of each cycle, bit n: domain n
 * @slow: the others
 * @n_slow: entries in @slow
 * @bytes: of the image of all domains
 * @stride: distance of two buffers in the exchange
 * @next_ns: schedule of the next cycle (ktime)
 * @epoch_ns: what makes ktime an application time
 * @lock: application time; lets the cycle follow the reference clock
 * @front: output buffer it holds
 * @given: the application has given that buffer, and its outputs are still valid
 * @ahead: outputs of that buffer are not in the image
 * @steady: cycles in which all slaves took part in a row, up to STEADY
 * @back: input buffer it holds
 * @fed: there were outputs at least once
 * @unfed: cycles without new outputs in a row, up to the limit
 * @adopt: another application shall get the buffers; cleared when it has them
 * @adopted: that has happened
 */
struct ec_cycle_thread {
	struct ec_cycle *cycle;
	const struct ec_cycle_ops *ops;
	struct task_struct *task;
	struct area *outputs;
	unsigned int n_outputs;
	u64 always;
	struct slow slow[EC_MAX_DOMAINS];
	unsigned int n_slow;
	u32 bytes;
	u32 stride;
	u64 next_ns;
	u64 epoch_ns;
	struct ec_pll lock;
	u8 front;
	bool given;
	bool ahead;
	u32 steady;
	u8 back;
	bool fed;
	u32 unfed;
	bool adopt;
	struct completion adopted;
};

static struct ec_status_cycle *status(const struct ec_cycle_thread *t)
{
	return &t->cycle->shared->status->kernel;
}

static struct ec_exchange *exchange(const struct ec_cycle_thread *t)
{
	return t->cycle->shared->exchange;
}

static struct ec_exchange_buffer *buffer(const struct ec_cycle_thread *t, unsigned int n)
{
	return t->cycle->shared->exchange + EC_EXCHANGE_FIRST + n * t->stride;
}

/* A number from memory of the application. */
static u8 buffer_index(u32 word)
{
	return min_t(u32, word & INDEX_MASK, EC_EXCHANGE_BUFFERS - 1);
}

/* Takes the newest outputs, or returns false when there are none since the last time. */
static bool take_outputs(struct ec_cycle_thread *t)
{
	struct ec_exchange *x = exchange(t);

	if (!(READ_ONCE(x->outputs) & EC_EXCHANGE_NEW))
		return false;
	t->front = buffer_index(xchg(&x->outputs, t->front));
	t->given = true;
	t->ahead = true;
	return true;
}

/* From now on the image is what is sent: its outputs are the newest ones. */
static void use_image(struct ec_cycle_thread *t)
{
	u8 *image = t->cycle->shared->image;
	const u8 *data = (const u8 *)(buffer(t, t->front) + 1);
	unsigned int i;

	for (i = 0; t->ahead && i < t->n_outputs; i++)
		ec_bytes_copy(image + t->outputs[i].offset, data + t->outputs[i].offset,
			t->outputs[i].len);
	t->ahead = false;
	/* a reader that sees NULL finds these in the image */
	smp_store_release(&t->cycle->direct, NULL);
}

/* Did all slaves take part when their domain was sent last? */
static bool all_take_part(const struct ec_cycle *c)
{
	const struct ec_status_domain *st = c->shared->status->domains;

	ec_for_each_domain(d, c->wanted)
		if (d->expected && READ_ONCE(st[d->index].wc_state) != EC_STATUS_WC_COMPLETE)
			return false;
	return true;
}

/*
 * The buffer of the application is sent as it is, which spares a copy of each
 * slave's outputs, and of its inputs when they are back. The inputs in it are no
 * last values that a missing slave could leave: then and for a while after it, and
 * where the kernel itself writes outputs, the image is sent.
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
	c->direct = (const u8 *)(buffer(t, t->front) + 1);
}

/* The callers of the file that owns the cycle: no other file adds work to it. */
static void wake_owner(struct ec_cycle *c)
{
	struct ec_waiters *w;

	rcu_read_lock();
	w = rcu_dereference(c->waiters);
	if (w)
		ec_waiters_wake(w);
	rcu_read_unlock();
}

/* No more cycles; waiting callers return. */
static void end_run(struct ec_cycle *c)
{
	/* pairs with ec_cycle_thread_ended() */
	smp_store_release(&c->cycles->run, c->cycles->run + 1);
	wake_owner(c);
}

/* The application has given no outputs for too long. */
static void stop_outputs(struct ec_cycle_thread *t)
{
	u8 *image = t->cycle->shared->image;
	struct ec_status_cycle *st = status(t);
	unsigned int i;

	switch (t->cycle->kernel.stall) {
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

/* Outputs of this cycle, new ones or what the policy says. */
static void feed(struct ec_cycle_thread *t)
{
	struct ec_status_cycle *st = status(t);
	u32 limit = t->cycle->kernel.stall_cycles;

	if (take_outputs(t)) {
		t->fed = true;
		t->unfed = 0;
		if (st->state != EC_CYCLE_STATE_RUNNING)
			WRITE_ONCE(st->state, EC_CYCLE_STATE_RUNNING);
		return;
	}
	if (!t->fed)
		return;
	ec_status_add(t->cycle->shared->status, &st->missed, 1);
	if (!limit || t->unfed == limit)
		return;
	if (++t->unfed == limit)
		stop_outputs(t);
}

/* An application gets the buffers after the thread's; its outputs begin with the image. */
static void deal(struct ec_cycle_thread *t)
{
	unsigned int n = (t->front + 1) % EC_EXCHANGE_BUFFERS;
	struct ec_exchange *x = exchange(t);

	x->stride = t->stride;
	x->app_output = n;
	x->app_input = (t->back + 1) % EC_EXCHANGE_BUFFERS;
	WRITE_ONCE(x->outputs, (t->front + 2) % EC_EXCHANGE_BUFFERS);
	WRITE_ONCE(x->inputs, (t->back + 2) % EC_EXCHANGE_BUFFERS);
	if (t->bytes)
		memcpy(buffer(t, n) + 1, t->cycle->shared->image, t->bytes);
}

/* The previous application may have exited at any point: the next one begins anew. */
static void adopt(struct ec_cycle_thread *t)
{
	use_image(t);
	t->given = false;
	deal(t);
	/* the buffers are dealt before the application sees it */
	smp_store_release(&t->adopt, false);
	complete(&t->adopted);
}

/* Receive and send of the application answer without a system call. */
static void tell_device(const struct ec_cycle *c)
{
	u32 *no_device = &c->shared->status->no_device;
	bool gone = !ec_links_attached(c->links);

	if (unlikely(*no_device != gone))
		WRITE_ONCE(*no_device, gone);
}

/* Inputs and working counters of this cycle for the application. */
static void publish(struct ec_cycle_thread *t)
{
	struct ec_cycle *c = t->cycle;
	struct ec_exchange_buffer *b = buffer(t, EC_EXCHANGE_BUFFERS + t->back);
	struct ec_status_cycle *st = status(t);
	u64 cycle = st->cycle + 1;
	unsigned int i;

	if (unlikely(READ_ONCE(t->adopt)))
		adopt(t);
	b->cycle = cycle;
	b->time_ns = t->next_ns;
	for (i = 0; i < c->wanted->n_domains; i++)
		b->domains[i] = c->shared->status->domains[i];
	tell_device(c);
	memcpy(b + 1, c->shared->image, t->bytes);
	t->back = buffer_index(xchg(&exchange(t)->inputs, t->back | EC_EXCHANGE_NEW));
	/* the application that sees the number finds the inputs */
	ec_status_begin(c->shared->status);
	WRITE_ONCE(st->cycle, cycle);
	ec_status_end(c->shared->status);
	ec_write64(&c->cycles->number, cycle);
	wake_owner(c);
}

/* Cycles whose time has passed are left out, so that the phase stays; how many. */
static u64 skip_missed(struct ec_cycle_thread *t, u64 now)
{
	u32 period = t->cycle->kernel.period_ns;
	s64 late = now - t->next_ns;
	u64 skipped;

	if (late < period)
		return 0;
	skipped = div_u64(late, period);
	ec_status_add(t->cycle->shared->status, &status(t)->overruns, skipped);
	t->next_ns += skipped * period;
	return skipped;
}

/* Domains of this cycle; those whose turn was left out go now, then as before. */
static u64 turn(struct ec_cycle_thread *t, u64 skipped)
{
	u64 domains = t->always;
	unsigned int i;

	for (i = 0; i < t->n_slow; i++) {
		struct slow *w = &t->slow[i];

		w->left -= min_t(u64, skipped, S32_MAX / 2);
		if (w->left <= 0) {
			domains |= BIT_ULL(w->domain);
			w->left = w->division - -w->left % w->division;
		}
		w->left--;
	}
	return domains;
}

static void find_turns(struct ec_cycle_thread *t)
{

	ec_for_each_domain(d, t->cycle->wanted) {
		if (d->division == 1)
			t->always |= BIT_ULL(d->index);
		else
			t->slow[t->n_slow++] = (struct slow){
				.domain = d->index, .left = d->phase, .division = d->division,
			};
	}
}

/* One cycle; false: the last one. */
static bool cycle(struct ec_cycle_thread *t)
{
	struct ec_cycle *c = t->cycle;
	struct ec_ioc_send send = { .flags = c->kernel.dc };
	u64 due = t->next_ns, now = ktime_get_ns();
	s32 correction;

	send.queued = turn(t, skip_missed(t, now));
	/* before the first frame the links are not ours */
	if (status(t)->state != EC_CYCLE_STATE_WAITING)
		ec_cycle_receive(c);
	correction = ec_pll_step(&t->lock, c, t->next_ns, t->epoch_ns);
	send.sync_time = t->lock.time;
	feed(t);
	choose_source(t);
	if (t->ops && t->ops->cycle)
		t->ops->cycle(c);
	if (status(t)->state <= EC_CYCLE_STATE_STALLED) {
		if (!ec_cycle_send(c, &send))
			ec_late_count(c, ec_read64(&c->links->access.last_send_ns) - due);
	}
	publish(t);
	ec_late_work(c, ktime_get_ns() - now);
	t->next_ns += c->kernel.period_ns + correction;
	return status(t)->state != EC_CYCLE_STATE_STOPPED;
}

/* Until the next cycle; false: the thread shall end. */
static bool sleep(const struct ec_cycle_thread *t)
{
	ktime_t at = ns_to_ktime(t->next_ns);
	bool due = false;

	while (!due) {
		set_current_state(TASK_IDLE);
		if (kthread_should_stop())
			break;
		due = !schedule_hrtimeout(&at, HRTIMER_MODE_ABS);
	}
	__set_current_state(TASK_RUNNING);
	return due;
}

static int run(void *data)
{
	struct ec_cycle_thread *t = data;
	const struct ec_ioc_cycle *k = &t->cycle->kernel;
	u64 now;

	if (t->cycle->priority)
		ec_cycle_sched_set(t->cycle, current);
	now = ktime_get_ns();
	t->epoch_ns = ktime_get_real_ns() - now - EPOCH_2000_NS;
	ec_pll_init(&t->lock, t->cycle);
	t->next_ns = (div_u64(now, k->period_ns) + 1) * k->period_ns + k->phase_ns;
	while (sleep(t))
		if (!cycle(t)) {
			end_run(t->cycle);
			/* no more cycles, until the thread is stopped */
			t->next_ns = KTIME_MAX;
		}
	return 0;
}

/* Output areas of all domains; those side by side are one. */
static int find_outputs(struct ec_cycle_thread *t)
{
	const struct ec_wanted *w = t->cycle->wanted;
	struct area *a = NULL;
	unsigned int i, n = 0;

	ec_for_each_domain(d, w)
		n += d->n_fmmus;
	t->outputs = kvcalloc(n + 1, sizeof(*t->outputs), GFP_KERNEL_ACCOUNT);
	if (!t->outputs)
		return -ENOMEM;
	ec_for_each_domain(d, w)
		for (i = 0; i < d->n_fmmus; i++) {
			const struct ec_config_fmmu *f = d->fmmus[i].fmmu;
			u32 offset = d->offset + f->offset;

			if (f->dir != EC_CFG_DIR_OUTPUT || !f->size)
				continue;
			if (a && a->offset + a->len == offset) {
				a->len += f->size;
				continue;
			}
			a = &t->outputs[t->n_outputs++];
			*a = (struct area){ .offset = offset, .len = f->size };
		}
	return 0;
}

static int alloc_exchange(struct ec_cycle_thread *t)
{
	struct ec_shared *sh = t->cycle->shared;

	t->stride = sizeof(struct ec_exchange_buffer) + ALIGN(t->bytes, 64);
	sh->exchange_size = PAGE_ALIGN(EC_EXCHANGE_FIRST + 2 * EC_EXCHANGE_BUFFERS * t->stride);
	sh->exchange = ec_shared_alloc(sh, sh->exchange_size);
	return sh->exchange ? 0 : -ENOMEM;
}

static void free_thread(struct ec_cycle_thread *t)
{
	kvfree(t->outputs);
	kfree(t);
}

/**
 * ec_cycle_thread_create() - prepare a cycle run by the kernel
 * @c: cycle with a layout and @kernel.period_ns
 * @image_bytes: of all domains
 * @ops: what it reports; stays
 *
 * The memory of the exchange with the application is in @c->shared.
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -ENODEV the CPU is not online; -ENOMEM.
 */
int ec_cycle_thread_create(struct ec_cycle *c, u32 image_bytes, const struct ec_cycle_ops *ops)
{
	struct ec_cycle_thread *t = kzalloc(sizeof(*t), GFP_KERNEL_ACCOUNT);
	int ret, cpu = c->kernel.cpu;

	lockdep_assert_held(c->wanted->lock);
	if (!t)
		return -ENOMEM;
	BUILD_BUG_ON(sizeof(struct ec_exchange) > EC_EXCHANGE_FIRST);
	t->cycle = c;
	t->ops = ops;
	init_completion(&t->adopted);
	t->bytes = image_bytes;
	find_turns(t);
	ret = alloc_exchange(t) ?: find_outputs(t);
	if (ret)
		goto err;
	deal(t);
	t->task = kthread_create(run, t, "EtherCAT%u-cyc", c->base->index);
	if (IS_ERR(t->task)) {
		ret = PTR_ERR(t->task);
		goto err;
	}
	if (cpu >= 0) {
		/* no lock: one that goes offline now is found as one that goes later */
		ret = cpu < nr_cpu_ids && cpu_online(cpu) ? 0 : -ENODEV;
		if (!ret)
			kthread_bind(t->task, cpu);
	}
	if (ret) {
		kthread_stop(t->task);
		goto err;
	}
	c->thread = t;
	return 0;
err:
	free_thread(t);
	return ret;
}

/**
 * ec_cycle_thread_task() - the thread that runs the cycle
 * @c: cycle
 *
 * Context: lock of the configuration held.
 * Return: thread; NULL when the application runs the cycle.
 */
struct task_struct *ec_cycle_thread_task(const struct ec_cycle *c)
{
	lockdep_assert_held(c->wanted->lock);
	return c->thread ? c->thread->task : NULL;
}

/**
 * ec_cycle_thread_start() - the kernel begins to run the cycle
 * @c: active cycle; nothing happens when the application runs the cycle
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_cycle_thread_start(struct ec_cycle *c)
{
	lockdep_assert_held(c->wanted->lock);
	if (!c->thread)
		return;
	ec_cycle_sched_log(c);
	WRITE_ONCE(c->links->access.interval_us, max(1u, c->kernel.period_ns / (u32)NSEC_PER_USEC));
	c->links->access.interval_set = true;
	WRITE_ONCE(status(c->thread)->state, c->kernel.flags & EC_CYCLE_FLAG_WAIT ?
		   EC_CYCLE_STATE_WAITING : EC_CYCLE_STATE_RUNNING);
	ec_write64(&c->cycles->number, 0);
	WRITE_ONCE(c->cycles->run, c->cycles->run + 1);
	rcu_assign_pointer(c->cycles->by_kernel, c);
	wake_up_process(c->thread->task);
}

/**
 * ec_cycle_thread_stop() - end the cycle run by the kernel
 * @c: cycle; nothing happens when the application ran the cycle
 *
 * poll() of the application may still look at the cycle meanwhile: that is
 * waited for while cycles go on.
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_cycle_thread_stop(struct ec_cycle *c)
{
	lockdep_assert_held(c->wanted->lock);
	if (!c->thread)
		return;
	if (rcu_access_pointer(c->cycles->by_kernel)) {
		RCU_INIT_POINTER(c->cycles->by_kernel, NULL);
		synchronize_rcu();
	}
	kthread_stop(c->thread->task);
	if (c->cycles->run & 1)
		end_run(c);
	else
		wake_owner(c);
	free_thread(c->thread);
	c->thread = NULL;
}

/**
 * ec_cycle_thread_ended() - has a cycle run by the kernel stopped before its session?
 * @c: active cycle
 *
 * The thread does nothing any more then.
 *
 * Context: Process, lock of the configuration held.
 * Return: whether it has; false when the application runs the cycle.
 */
bool ec_cycle_thread_ended(const struct ec_cycle *c)
{
	lockdep_assert_held(c->wanted->lock);
	/* pairs with end_run() */
	return c->thread && !(smp_load_acquire(&c->cycles->run) & 1);
}

/**
 * ec_cycle_thread_adopt() - another application gets the exchange
 * @c: active cycle without an application
 *
 * Its output buffer has the image as it is, outputs and inputs; none of the
 * buffers that the application before has given is used any more.
 *
 * Context: Process, lock of the configuration held. Sleeps until the next cycle has begun.
 * Return: 0; -ETIMEDOUT the cycle does not run.
 */
int ec_cycle_thread_adopt(struct ec_cycle *c)
{
	struct ec_cycle_thread *t = c->thread;
	u32 limit_ms = 2 * c->kernel.period_ns / (u32)NSEC_PER_MSEC + ADOPT_MS;

	lockdep_assert_held(c->wanted->lock);
	reinit_completion(&t->adopted);
	WRITE_ONCE(t->adopt, true);
	if (!wait_for_completion_timeout(&t->adopted, msecs_to_jiffies(limit_ms)))
		return -ETIMEDOUT;
	WRITE_ONCE(status(t)->takeovers, status(t)->takeovers + 1);
	return 0;
}

/**
 * ec_cycle_thread_outputs() - outputs as they are sent
 * @c: active cycle; nothing happens when the application runs its cycle
 * @image: copy of a part of the image
 * @offset: where in the image that part begins, bytes
 * @size: its bytes
 *
 * The cycle may go on meanwhile: outputs may be of several cycles.
 *
 * Context: Process, lock of the configuration held or after ec_show_begin().
 */
void ec_cycle_thread_outputs(const struct ec_cycle *c, u8 *image, u32 offset, u32 size)
{
	const struct ec_cycle_thread *t = c->thread;
	/* NULL: the image is complete, see use_image() */
	const u8 *source = smp_load_acquire(&c->direct) ?: c->shared->image;
	unsigned int i;

	ec_wanted_assert_stays(c->wanted);
	for (i = 0; t && i < t->n_outputs; i++) {
		u32 from = max(offset, t->outputs[i].offset);
		u32 to = min(offset + size, t->outputs[i].offset + t->outputs[i].len);

		if (from < to)
			memcpy(image + (from - offset), source + from, to - from);
	}
}

/* The cycle that the kernel runs for @owner, or NULL. RCU read side. */
static const struct ec_cycle *owned_by(const struct ec_cycles *cycles, const void *owner)
{
	const struct ec_cycle *c = rcu_dereference(cycles->by_kernel);

	return c && READ_ONCE(c->owner) == owner ? c : NULL;
}

/**
 * ec_cycle_thread_poll() - are there new inputs for the application?
 * @cycles: of the master
 * @owner: open file that asks
 *
 * Context: Any. Takes no lock.
 * Return: EPOLLIN: inputs that the application has not taken; EPOLLHUP: the cycle has
 * stopped; EPOLLERR: the kernel runs no cycle for @owner.
 */
__poll_t ec_cycle_thread_poll(const struct ec_cycles *cycles, const void *owner)
{
	const struct ec_cycle *c;
	__poll_t mask = EPOLLERR;

	rcu_read_lock();
	c = owned_by(cycles, owner);
	if (c) {
		mask = 0;
		if (READ_ONCE(exchange(c->thread)->inputs) & EC_EXCHANGE_NEW)
			mask |= EPOLLIN | EPOLLRDNORM;
		if (READ_ONCE(status(c->thread)->state) == EC_CYCLE_STATE_STOPPED)
			mask |= EPOLLHUP;
	}
	rcu_read_unlock();
	return mask;
}

/**
 * ec_cycle_thread_wait() - wait for the next cycle
 * @cycles: of the master
 * @owner: open file that asks
 * @w: its wait queue
 * @cycle: in: the last cycle the caller has seen; out: a newer one
 * @timeout_us: limit, 0: none
 *
 * Context: Process. Sleeps; nothing of the cycle is touched, so it may end.
 * Return: 0; -EPERM the kernel runs no cycle for @owner; -ETIMEDOUT; -ERESTARTNOHAND a
 * signal or kthread_stop(); -ECANCELED the cycle has stopped or changed its owner; -EBUSY too
 * many callers wait.
 */
int ec_cycle_thread_wait(struct ec_cycles *cycles, const void *owner, struct ec_waiters *w,
			 u64 *cycle, u32 timeout_us)
{
	ktime_t limit = timeout_us ? ns_to_ktime((u64)timeout_us * NSEC_PER_USEC) : KTIME_MAX;
	bool ours;
	u32 run;
	int ret;

	rcu_read_lock();
	ours = owned_by(cycles, owner);
	run = READ_ONCE(cycles->run);
	rcu_read_unlock();
	if (!ours)
		return -EPERM;
	if (!ec_waiters_enter(w))
		return -EBUSY;
	ret = wait_event_interruptible_hrtimeout(w->wq,
						 READ_ONCE(cycles->run) != run || !(run & 1) ||
						 READ_ONCE(cycles->owner) != owner ||
						 ec_read64(&cycles->number) > *cycle, limit);
	ec_waiters_leave(w);
	if (ret == -ETIME)
		return -ETIMEDOUT;
	/* a signal handler runs first, and ends it; kthread_stop() ends the wait in the same way */
	if (ret)
		return -ERESTARTNOHAND;
	if (!(run & 1) || READ_ONCE(cycles->run) != run || READ_ONCE(cycles->owner) != owner)
		return -ECANCELED;
	if (ec_read64(&cycles->number) <= *cycle)
		return -ERESTARTNOHAND;
	*cycle = ec_read64(&cycles->number);
	return 0;
}
