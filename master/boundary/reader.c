// SPDX-License-Identifier: GPL-2.0-only
/*
 * read() and poll() of records that writers number: a reader has a position among them. Writers do
 * not know readers; a work that looks for new records wakes them.
 */
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include "../base/once64.h"
#include "cdev.h"
#include "reader.h"

/**
 * ec_readers_init() - prepare a list of readers
 * @rs: list, empty
 *
 * Context: Any.
 */
void ec_readers_init(struct ec_readers *rs)
{
	mutex_init(&rs->lock);
	INIT_LIST_HEAD(&rs->list);
}

/**
 * ec_readers_wake() - wake those that wait
 * @rs: readers, their lock held
 *
 * Context: Process. May sleep.
 */
void ec_readers_wake(struct ec_readers *rs)
{
	struct ec_reader *r;

	lockdep_assert_held(&rs->lock);
	list_for_each_entry(r, &rs->list, list) {
		ec_waiters_wake(&r->waiters);
		cond_resched();
	}
}

/**
 * ec_reader_init() - prepare a reader that is in no list
 * @r: zeroed; kfree() frees it
 * @kind: what it reads
 * @source: of the records
 *
 * Context: Any.
 */
void ec_reader_init(struct ec_reader *r, const struct ec_reader_kind *kind, const void *source)
{
	r->kind = kind;
	r->source = source;
	mutex_init(&r->lock);
	ec_waiters_init(&r->waiters);
}

/**
 * ec_reader_new() - a reader that is in no list
 * @kind: what it reads
 * @source: of the records
 *
 * Context: Process. May sleep.
 * Return: reader, for ec_reader_enter(), else kfree(); NULL: no memory.
 */
struct ec_reader *ec_reader_new(const struct ec_reader_kind *kind, const void *source)
{
	struct ec_reader *r = kzalloc(sizeof(*r), GFP_KERNEL_ACCOUNT);

	if (r)
		ec_reader_init(r, kind, source);
	return r;
}

/**
 * ec_reader_enter() - a file becomes a reader
 * @r: that of ec_reader_new(), with its position; it belongs to the file if this returns 0
 * @rs: list, its lock held
 * @f: open file
 *
 * Context: Process.
 * Return: 0; -EBUSY: it is one already.
 */
int ec_reader_enter(struct ec_reader *r, struct ec_readers *rs, struct ec_file *f)
{
	lockdep_assert_held(&rs->lock);
	r->readers = rs;
	/* complete before poll() and read() find it; another thread may enter another list */
	if (cmpxchg_release(&f->reader, NULL, r))
		return -EBUSY;
	list_add_tail(&r->list, &rs->list);
	WRITE_ONCE(rs->count, rs->count + 1);
	return 0;
}

/**
 * ec_reader_end() - the file is closed
 * @f: open file, perhaps a reader
 *
 * Context: Process. May sleep.
 */
void ec_reader_end(struct ec_file *f)
{
	struct ec_reader *r = f->reader;

	if (!r)
		return;
	mutex_lock(&r->readers->lock);
	list_del(&r->list);
	WRITE_ONCE(r->readers->count, r->readers->count - 1);
	if (r->kind->free)
		r->kind->free(r);
	mutex_unlock(&r->readers->lock);
	/* no work finds it any more, and entries of poll() end with the file */
	kfree(r);
}

static bool is_behind(const struct ec_reader *r)
{
	return r->kind->head(r) != ec_read64(&r->at);
}

/* Copy as many records as there are and fit; their bytes. */
static ssize_t reader_copy(struct ec_reader *r, char __user *to, size_t size)
{
	size_t done = 0;
	int ret = 0;
	u64 at;

	if (mutex_lock_interruptible(&r->lock))
		return -ERESTARTSYS;
	while (size - done >= r->kind->size) {
		at = r->at;
		ret = r->kind->copy(r, &at, to + done);
		if (ret <= 0)
			break;
		/* records that were not copied are read next time */
		ec_write64(&r->at, at);
		done += r->kind->size;
		cond_resched();
		if (signal_pending(current))
			break;
	}
	mutex_unlock(&r->lock);
	return done ?: min(ret, 0);
}

/**
 * ec_reader_read() - read() of the device file
 * @f: open file
 * @to: buffer of the caller
 * @size: of it
 * @wait: for a record if there is none
 *
 * Context: Process. May sleep.
 * Return: bytes of whole records; -EINVAL the file is no reader, or the buffer is too small for
 * a record; -EAGAIN no record and no @wait; -EBUSY too many callers wait; -EFAULT; -ERESTARTSYS.
 */
ssize_t ec_reader_read(struct ec_file *f, char __user *to, size_t size, bool wait)
{
	/* pairs with ec_reader_enter() */
	struct ec_reader *r = smp_load_acquire(&f->reader);
	ssize_t n = 0;
	int ret;

	if (!r || size < r->kind->size)
		return -EINVAL;
	/* more is never kept; a limited size cannot overflow */
	size = min(size, r->kind->kept * r->kind->size);
	while (!n) {
		n = reader_copy(r, to, size);
		if (n)
			break;
		if (!wait)
			return -EAGAIN;
		if (!ec_waiters_enter(&r->waiters))
			return -EBUSY;
		ret = wait_event_interruptible(r->waiters.wq, is_behind(r));
		ec_waiters_leave(&r->waiters);
		if (ret)
			return ret;
	}
	return n;
}

/**
 * ec_reader_poll() - poll() of a file that is a reader
 * @r: reader
 * @filp: its file
 * @wait: argument of poll()
 *
 * Context: Process. May sleep to add an entry to the wait queue.
 * Return: EPOLLIN when there are records; EPOLLERR when too many wait already.
 */
__poll_t ec_reader_poll(struct ec_reader *r, struct file *filp, poll_table *wait)
{
	if (!ec_waiters_poll(&r->waiters, filp, wait))
		return EPOLLERR;
	/* the entry in the queue before the records: one of both is seen */
	smp_mb();
	return is_behind(r) ? EPOLLIN | EPOLLRDNORM : 0;
}
