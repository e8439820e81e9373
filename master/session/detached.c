// SPDX-License-Identifier: GPL-2.0-only
/*
 * A session that its application has left to the master (EC_IOC_DETACH): the cycle of the kernel
 * continues, and the master itself gives the outputs, which commands set one by one. A value with a
 * lease becomes zero when that ends, whether the process that has set it exists or not.
 */
#include <linux/jiffies.h>
#include <linux/ktime.h>
#include <linux/list.h>
#include <linux/nospec.h>
#include <linux/slab.h>
#include <linux/workqueue.h>
#include "../base/report.h"
#include "../bus/slave.h"
#include "../config/unit.h"
#include "../cycle/cycle_thread.h"
#include "detached.h"

#define MAX_LEASES	1024

/* outputs that become zero; bits count in the image of all domains */
struct lease {
	struct list_head list;
	u64 bit;
	u32 bits;
	u64 until_ns;	/* ktime */
};

/** struct ec_detached - outputs that the master gives */
struct ec_detached {
	/** @lock: protects all but @cycle and @queue */
	struct mutex lock;
	/** @cycle: active cycle, which outlives this structure */
	struct ec_cycle *cycle;
	/** @queue: of @work */
	struct workqueue_struct *queue;
	/** @work: ends leases */
	struct delayed_work work;
	/** @leases: struct lease, in no order */
	struct list_head leases;
	/** @n_leases: entries in @leases */
	unsigned int n_leases;
	/** @buffer: number of the buffer of the exchange that the next outputs are written to */
	u32 buffer;
	/** @bytes: of @image */
	u32 bytes;
	/** @image: outputs as set, of all domains */
	u8 image[];
};

static void put_bits(u8 *image, u64 bit, u32 bits, u64 value)
{
	for (; bits--; bit++, value >>= 1) {
		u8 mask = 1 << (bit & 7);

		if (value & 1)
			image[bit >> 3] |= mask;
		else
			image[bit >> 3] &= ~mask;
	}
}

static void lease_drop(struct ec_detached *d, struct lease *l)
{
	lockdep_assert_held(&d->lock);
	list_del(&l->list);
	d->n_leases--;
	kfree(l);
}

/* Zeros for what has ended, and the next time for the work. */
static void end_leases(struct work_struct *work)
{
	struct ec_detached *d = container_of(to_delayed_work(work), struct ec_detached, work);
	u64 now = ktime_get_ns(), next = U64_MAX;
	struct lease *l, *tmp;
	bool changed = false;

	mutex_lock(&d->lock);
	list_for_each_entry_safe(l, tmp, &d->leases, list) {
		if (l->until_ns > now) {
			next = min(next, l->until_ns);
			continue;
		}
		put_bits(d->image, l->bit, l->bits, 0);
		lease_drop(d, l);
		changed = true;
	}
	if (changed)
		ec_cycle_run_give(d->cycle, &d->buffer, d->image);
	if (next != U64_MAX)
		mod_delayed_work(d->queue, &d->work, nsecs_to_jiffies(next - now) + 1);
	mutex_unlock(&d->lock);
}

/* Could a sync unit send other outputs than those that are set? */
static bool has_units_that_replace(const struct ec_session *s)
{
	ec_for_each_unit(u, &s->wanted)
		if (u->what.lease_cycles || u->what.flags & EC_UNIT_FLAG_AUTHORITY ||
		    u->what.policy != EC_UNIT_POLICY_CONTINUE)
			return true;
	return false;
}

/**
 * ec_detached_begin() - the application leaves its session to the master
 * @s: session of the caller
 *
 * From now on it has no application, and none gets it: it ends with ec_session_end_detached().
 *
 * Context: Process, session lock held. Sleeps until the next cycle has begun.
 * Return: 0; -EINVAL the kernel runs no cycle of it; -EDOM it has an output stall, or a sync
 * unit with a lease, authority or a policy, which would replace outputs that are set; -EBUSY a
 * process has its memory mapped; -ETIMEDOUT the cycle does not run; -ENOMEM.
 */
int ec_detached_begin(struct ec_session *s)
{
	struct ec_cycle *c = &s->cycle;
	struct ec_detached *d;
	int ret;

	lockdep_assert_held(s->wanted.lock);
	if (!s->wanted.active || !c->thread || s->ending)
		return -EINVAL;
	if (c->setup.kernel.stall_cycles || has_units_that_replace(s))
		return -EDOM;
	/* the session, and its requests */
	if (kref_read(&c->shared->kref) > 1 + !!s->requests)
		return -EBUSY;
	d = kvzalloc(struct_size(d, image, c->thread->bytes), GFP_KERNEL_ACCOUNT);
	if (!d)
		return -ENOMEM;
	mutex_init(&d->lock);
	INIT_LIST_HEAD(&d->leases);
	INIT_DELAYED_WORK(&d->work, end_leases);
	d->cycle = c;
	d->queue = s->sessions->service;
	d->bytes = c->thread->bytes;
	ret = ec_cycle_thread_keep(c, &d->buffer, d->image);
	if (ret) {
		kvfree(d);
		return ret;
	}
	WRITE_ONCE(s->detached, d);
	ec_cycle_set_owner(c, NULL, NULL);
	ec_report(s->sessions->base, EC_EVENT_DETACHED, s->owner_pid);
	return 0;
}

/* Zero for what is set in @bits bits, with its leases. */
static void clear_bits_of(struct ec_detached *d, u64 bit, u64 bits)
{
	struct lease *l, *tmp;

	lockdep_assert_held(&d->lock);
	memset(d->image + bit / 8, 0, bits / 8);
	list_for_each_entry_safe(l, tmp, &d->leases, list)
		if (l->bit < bit + bits && bit < l->bit + l->bits)
			lease_drop(d, l);
}

/**
 * ec_detached_device() - a configuration gets a slave
 * @s: session; nothing is cleared when an application has it
 * @c: its configuration, for whose slave OP is not requested yet
 *
 * Outputs that were set for another device become zero, and stay so: it must not act on them. A
 * device is another one when its number is, even if it only could not be recognized.
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_detached_device(struct ec_session *s, struct ec_config *c)
{
	struct ec_detached *d = s->detached;
	unsigned int i;

	lockdep_assert_held(s->wanted.lock);
	if (c->device == c->slave->device)
		return;
	c->device = c->slave->device;
	if (!d)
		return;
	mutex_lock(&d->lock);
	for (i = 0; i < c->n_fmmus; i++) {
		const struct ec_config_fmmu *f = &c->fmmus[i];
		u64 at = (u64)f->domain->offset + f->offset;

		if (f->dir == EC_CFG_DIR_OUTPUT && !WARN_ON_ONCE(at + f->size > d->bytes))
			clear_bits_of(d, 8 * at, 8 * (u64)f->size);
	}
	ec_cycle_run_give(d->cycle, &d->buffer, d->image);
	mutex_unlock(&d->lock);
}

/* Are these bits outputs of the device, which is connected? */
static bool are_outputs(const struct ec_session *s, const struct ec_ioc_output *o)
{
	ec_for_each_config(c, &s->wanted) {
		unsigned int i;

		if (!c->slave || c->slave->device != o->device ||
		    READ_ONCE(c->slave->stop.gone))
			continue;
		for (i = 0; i < c->n_fmmus; i++) {
			const struct ec_config_fmmu *f = &c->fmmus[i];
			u64 from = (u64)f->offset * 8, to = from + (u64)f->size * 8;

			if (f->dir == EC_CFG_DIR_OUTPUT && f->domain->index == o->domain &&
			    o->bit >= from && (u64)o->bit + o->bits <= to)
				return true;
		}
	}
	return false;
}

/* Does the cycle itself write some of these bits? */
static bool are_copied(const struct ec_session *s, const struct ec_ioc_output *o)
{
	const struct ec_copies *copies = &s->cycle.setup.copies;
	unsigned int i;

	for (i = 0; i < copies->n; i++) {
		const struct ec_ioc_copy *x = &copies->list[i];

		if (x->to_domain == o->domain && x->to_bit < (u64)o->bit + o->bits &&
		    o->bit < (u64)x->to_bit + x->bits)
			return true;
	}
	return false;
}

/*
 * Replace the lease of exactly these bits by one of @o, or by none. Return: 0; -EBUSY there is one
 * of some of these bits; -ENOSPC, -ENOMEM.
 */
static int lease_renew(struct ec_detached *d, u64 bit, const struct ec_ioc_output *o)
{
	struct lease *l, *same = NULL;

	lockdep_assert_held(&d->lock);
	list_for_each_entry(l, &d->leases, list) {
		if (l->bit == bit && l->bits == o->bits)
			same = l;
		else if (l->bit < bit + o->bits && bit < l->bit + l->bits)
			return -EBUSY;
	}
	if (o->flags & EC_OUTPUT_FLAG_HOLD) {
		if (same)
			lease_drop(d, same);
		return 0;
	}
	if (!same) {
		if (d->n_leases >= MAX_LEASES)
			return -ENOSPC;
		same = kzalloc(sizeof(*same), GFP_KERNEL_ACCOUNT);
		if (!same)
			return -ENOMEM;
		same->bit = bit;
		same->bits = o->bits;
		list_add(&same->list, &d->leases);
		d->n_leases++;
	}
	same->until_ns = ktime_get_ns() + o->lease_ms * (u64)NSEC_PER_MSEC;
	return 0;
}

/**
 * ec_detached_set() - set outputs of a session that the master has
 * @s: session
 * @o: which, and for how long
 *
 * Context: Process, session lock held. May sleep.
 * Return: 0; -EPERM it is the session of an application; -EINVAL number of bits or lease;
 * -ENOENT they are not outputs of this device; -EEXIST a copy of the cycle writes some of them;
 * -EBUSY a lease of some of these bits, but of others as well, has not ended; -ENOSPC too many
 * leases; -ENOMEM.
 */
int ec_detached_set(struct ec_session *s, const struct ec_ioc_output *o)
{
	struct ec_detached *d = s->detached;
	u32 domain;
	u64 bit;
	int ret;

	lockdep_assert_held(s->wanted.lock);
	if (!d)
		return -EPERM;
	if (!o->bits || o->bits > 64 || (o->bits < 64 && o->value >> o->bits) ||
	    !(o->flags & EC_OUTPUT_FLAG_HOLD) != !!o->lease_ms ||
	    o->lease_ms > EC_OUTPUT_LEASE_MAX_MS)
		return -EINVAL;
	if (o->domain >= s->wanted.n_domains || !are_outputs(s, o))
		return -ENOENT;
	if (are_copied(s, o))
		return -EEXIST;
	domain = array_index_nospec(o->domain, s->wanted.n_domains);
	bit = (u64)s->wanted.domains[domain]->offset * 8 + o->bit;
	mutex_lock(&d->lock);
	ret = lease_renew(d, bit, o);
	if (!ret) {
		put_bits(d->image, bit, o->bits, o->value);
		ec_cycle_run_give(d->cycle, &d->buffer, d->image);
		if (d->n_leases)
			mod_delayed_work(d->queue, &d->work, 0);
	}
	mutex_unlock(&d->lock);
	return ret;
}

/**
 * ec_detached_end() - the session ends, or is deactivated
 * @s: session; nothing happens when an application has it
 *
 * Context: Process, session lock held. Sleeps until no lease is being ended.
 */
void ec_detached_end(struct ec_session *s)
{
	struct ec_detached *d = s->detached;
	struct lease *l, *tmp;

	lockdep_assert_held(s->wanted.lock);
	if (!d)
		return;
	cancel_delayed_work_sync(&d->work);
	WRITE_ONCE(s->detached, NULL);
	mutex_lock(&d->lock);
	list_for_each_entry_safe(l, tmp, &d->leases, list)
		lease_drop(d, l);
	mutex_unlock(&d->lock);
	kvfree(d);
}

/**
 * ec_detached_runs() - has an application left its session to the master?
 * @ss: sessions of a master
 *
 * Context: Process. May sleep.
 * Return: whether there is such a session.
 */
bool ec_detached_runs(struct ec_sessions *ss)
{
	bool runs;

	mutex_lock(&ss->lock);
	runs = ss->session && ss->session->detached;
	mutex_unlock(&ss->lock);
	return runs;
}
