// SPDX-License-Identifier: GPL-2.0-only
/*
 * The kernel runs the cycle: the cycle owner is a real-time thread on an absolute
 * timer, or that timer itself (cycle_timer.c).
 */
#include <linux/hrtimer.h>
#include <linux/kthread.h>
#include <linux/ktime.h>
#include <linux/rcupdate.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include "../base/once64.h"
#include "../config/domain.h"
#include "cycle_sched.h"
#include "cycle_thread.h"
#include "cycle_timer.h"

#define EPOCH_2000_NS	(946684800ULL * NSEC_PER_SEC)
#define ADOPT_MS	1000	/* for a takeover, besides two periods */

static void find_turns(struct ec_cycle_thread *t)
{

	ec_for_each_domain(d, t->cycle->wanted) {
		if (d->division == 1)
			t->always |= BIT_ULL(d->index);
		else
			t->slow[t->n_slow++] = (struct ec_cycle_slow){
				.domain = d->index, .left = d->phase, .division = d->division,
			};
	}
}

/* Sleep until the next cycle; false: the thread has to end. */
static bool cycle_thread_sleep(const struct ec_cycle_thread *t)
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

static int cycle_thread_run(void *data)
{
	struct ec_cycle_thread *t = data;
	const struct ec_ioc_cycle *k = &t->cycle->setup.kernel;
	u64 now;

	if (t->cycle->setup.priority)
		ec_cycle_sched_set(t->cycle, current);
	now = ktime_get_ns();
	t->epoch_ns = ktime_get_real_ns() - now - EPOCH_2000_NS;
	ec_pll_init(&t->lock, t->cycle);
	t->next_ns = (div_u64(now, k->period_ns) + 1) * k->period_ns + k->phase_ns;
	while (1) {
		bool more = ec_cycle_timer_run(t);

		if (more) {
			if (!cycle_thread_sleep(t))
				break;
			more = ec_cycle_run_once(t, false);
		}
		if (!more) {
			ec_cycle_run_end(t->cycle);
			/* no more cycles, until the thread is stopped */
			t->next_ns = KTIME_MAX;
		}
	}
	return 0;
}

/* Output areas of all domains; those side by side are one. */
static int find_outputs(struct ec_cycle_thread *t)
{
	const struct ec_wanted *w = t->cycle->wanted;
	unsigned int n = 0;

	ec_for_each_domain(d, w)
		n += d->n_fmmus;
	t->outputs = kvcalloc(n + 1, sizeof(*t->outputs), GFP_KERNEL_ACCOUNT);
	if (!t->outputs)
		return -ENOMEM;
	ec_for_each_domain(d, w)
		t->n_outputs = ec_domain_areas(d, EC_CFG_DIR_OUTPUT, t->outputs, t->n_outputs);
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
	ec_cycle_timer_exit(t);
	kvfree(t->outputs);
	kfree(t);
}

/**
 * ec_cycle_thread_create() - prepare a cycle run by the kernel
 * @c: cycle with a layout and @kernel.period_ns
 * @image_bytes: of all domains
 * @ops: its callbacks; they stay valid
 *
 * The memory of the exchange with the application is in @c->shared.
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -ENODEV the CPU is not online; -ENOMEM.
 */
int ec_cycle_thread_create(struct ec_cycle *c, u32 image_bytes, const struct ec_cycle_ops *ops)
{
	struct ec_cycle_thread *t = kzalloc(sizeof(*t), GFP_KERNEL_ACCOUNT);
	int ret, cpu = c->setup.kernel.cpu;

	lockdep_assert_held(c->wanted->lock);
	if (!t)
		return -ENOMEM;
	BUILD_BUG_ON(sizeof(struct ec_exchange) > EC_EXCHANGE_FIRST);
	t->cycle = c;
	t->ops = ops;
	init_completion(&t->adopted);
	ec_cycle_timer_init(t);
	t->bytes = image_bytes;
	find_turns(t);
	ret = alloc_exchange(t) ?: find_outputs(t);
	if (ret)
		goto err;
	ec_cycle_run_deal(t);
	t->task = kthread_create(cycle_thread_run, t, "EtherCAT%u-cyc", c->base->index);
	if (IS_ERR(t->task)) {
		ret = PTR_ERR(t->task);
		goto err;
	}
	if (cpu >= 0) {
		/* no lock: ec_cycle_thread_check_cpu() finds a CPU that goes offline now */
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
	WRITE_ONCE(c->place, EC_CYCLE_PLACE_THREAD);
	c->places = 0;
	c->watch.places_logged = 0;
	WRITE_ONCE(c->links->access.interval_us,
		   max(1u, c->setup.kernel.period_ns / (u32)NSEC_PER_USEC));
	c->links->access.interval_set = true;
	WRITE_ONCE(ec_cycle_run_status(c->thread)->state,
		   c->setup.kernel.flags & EC_CYCLE_FLAG_WAIT ? EC_CYCLE_STATE_WAITING :
								EC_CYCLE_STATE_RUNNING);
	ec_write64(&c->cycles->number, 0);
	WRITE_ONCE(c->cycles->run, c->cycles->run + 1);
	rcu_assign_pointer(c->cycles->by_kernel, c);
	wake_up_process(c->thread->task);
}

/**
 * ec_cycle_thread_stop() - end the cycle run by the kernel
 * @c: cycle; nothing happens when the application ran the cycle
 *
 * poll() of the application may still read from the cycle. This function waits for
 * it while cycles continue.
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
		ec_cycle_run_end(c);
	else
		ec_cycle_run_wake(c, false);
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
	/* pairs with ec_cycle_run_end() */
	return c->thread && !(smp_load_acquire(&c->cycles->run) & 1);
}

/* Let the thread deal the buffers again, with the present outputs in that of the application. */
static int redeal(struct ec_cycle *c)
{
	struct ec_cycle_thread *t = c->thread;
	u32 limit_ms = 2 * c->setup.kernel.period_ns / (u32)NSEC_PER_MSEC + ADOPT_MS;

	lockdep_assert_held(c->wanted->lock);
	reinit_completion(&t->adopted);
	/* pairs with cycle_run_publish(), which sees @kept as well */
	smp_store_release(&t->adopt, 1);
	if (wait_for_completion_timeout(&t->adopted, msecs_to_jiffies(limit_ms)))
		return 0;
	if (xchg(&t->adopt, 0))
		return -ETIMEDOUT;
	/* the cycle has just taken it */
	wait_for_completion(&t->adopted);
	return 0;
}

/**
 * ec_cycle_thread_adopt() - another application gets the exchange
 * @c: active cycle without an application
 *
 * Its output buffer gets the present image, outputs and inputs. No buffer that the
 * previous application has given is used any more.
 *
 * Context: Process, lock of the configuration held. Sleeps until the next cycle has begun.
 * Return: 0; -ETIMEDOUT the cycle does not run.
 */
int ec_cycle_thread_adopt(struct ec_cycle *c)
{
	int ret = redeal(c);
	struct ec_status_cycle *st = ec_cycle_run_status(c->thread);

	lockdep_assert_held(c->wanted->lock);
	if (!ret)
		WRITE_ONCE(st->takeovers, st->takeovers + 1);
	return ret;
}

/**
 * ec_cycle_thread_keep() - the master gives the outputs from now on
 * @c: active cycle whose application has no mapped memory
 * @buffer: result: number of its output buffer, for ec_cycle_run_give()
 * @image: result: the outputs that are sent, of all domains
 *
 * Cycles without new outputs are not counted as missed any more.
 *
 * Context: Process, lock of the configuration held. Sleeps until the next cycle has begun.
 * Return: 0; -EINVAL the cycle has ended; -ETIMEDOUT the cycle does not run, nothing has changed.
 */
int ec_cycle_thread_keep(struct ec_cycle *c, u32 *buffer, u8 *image)
{
	struct ec_cycle_thread *t = c->thread;
	int ret;

	lockdep_assert_held(c->wanted->lock);
	if (ec_cycle_thread_ended(c))
		return -EINVAL;
	WRITE_ONCE(t->kept, true);
	ret = redeal(c);
	if (ret) {
		WRITE_ONCE(t->kept, false);
		return ret;
	}
	*buffer = min_t(u32, ec_cycle_run_exchange(t)->app_output, EC_EXCHANGE_BUFFERS - 1);
	memcpy(image, ec_cycle_run_buffer(t, *buffer) + 1, t->bytes);
	return 0;
}

/**
 * ec_cycle_thread_outputs() - copy the outputs that are sent
 * @c: active cycle; nothing happens when the application runs its cycle
 * @image: copy of a part of the image
 * @offset: where in the image that part begins, bytes
 * @size: its bytes
 *
 * The cycle may continue meanwhile: outputs may be of several cycles.
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
