// SPDX-License-Identifier: GPL-2.0-only
/*
 * read() and poll() of events. A reader costs the master only the work that wakes it: writers of
 * events do not know readers. The monitor checks for new events at each of its polls, and a worker
 * wakes the readers.
 */
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "../base/once64.h"
#include "ioctl.h"
#include "master.h"

static void wake_readers(struct work_struct *work)
{
	struct ec_event_readers *rs = container_of(work, struct ec_event_readers, work);
	struct ec_event_reader *r;

	mutex_lock(&rs->lock);
	list_for_each_entry(r, &rs->list, list) {
		ec_waiters_wake(&r->waiters);
		cond_resched();
	}
	mutex_unlock(&rs->lock);
}

/**
 * ec_event_readers_init() - prepare the list of readers, which is empty
 * @m: master
 *
 * Context: Any.
 */
void ec_event_readers_init(struct ec_master *m)
{
	mutex_init(&m->readers.lock);
	INIT_LIST_HEAD(&m->readers.list);
	INIT_WORK(&m->readers.work, wake_readers);
}

/**
 * ec_event_readers_exit() - wake no reader from now on
 * @m: master whose monitor has ended; no file of it is open
 *
 * Context: Process. May sleep.
 */
void ec_event_readers_exit(struct ec_master *m)
{
	cancel_work_sync(&m->readers.work);
}

/**
 * ec_event_readers_kick() - wake the readers if there are new events
 * @m: master
 *
 * Context: The monitor.
 */
void ec_event_readers_kick(struct ec_master *m)
{
	struct ec_event_readers *rs = &m->readers;
	u64 head = ec_event_ring_head(&m->base->events.ring);

	if (head == rs->woken)
		return;
	rs->woken = head;
	/* the number of events before that of readers: a new reader reads the events itself */
	smp_rmb();
	if (READ_ONCE(rs->count))
		queue_work(system_unbound_wq, &rs->work);
}

static void begin(struct ec_event_reader *r, struct ec_ioc_events *arg)
{
	const struct ec_event_ring *ring = &r->events->ring;

	mutex_lock(&r->lock);
	arg->next = ec_event_ring_head(ring);
	arg->first = arg->flags & EC_EVENTS_FLAG_NEW ? arg->next : ec_event_ring_oldest(ring);
	ec_write64(&r->at, arg->first);
	mutex_unlock(&r->lock);
}

/* The reader of a file, created at the first call; NULL: no memory. */
static struct ec_event_reader *reader(struct ec_file *f)
{
	struct ec_event_readers *rs = &f->master->readers;
	struct ec_event_reader *r = kzalloc(sizeof(*r), GFP_KERNEL_ACCOUNT);

	if (!r)
		return NULL;
	r->events = &f->master->base->events;
	mutex_init(&r->lock);
	ec_waiters_init(&r->waiters);
	mutex_lock(&rs->lock);
	if (f->reader) {
		kfree(r);
		r = f->reader;
	} else {
		list_add_tail(&r->list, &rs->list);
		WRITE_ONCE(rs->count, rs->count + 1);
		/* complete before poll() and read() find it */
		smp_store_release(&f->reader, r);
	}
	mutex_unlock(&rs->lock);
	return r;
}

/* Command: the file becomes a reader of events, or begins again. */
int ec_ioc_events(struct ec_call *call)
{
	struct ec_ioc_events *arg = call->arg;
	struct ec_event_reader *r;

	if (arg->size != sizeof(struct ec_event))
		return ec_refuse(call, -EINVAL,
				 "an event has %zu bytes, not %u; build the program with the header of this module",
				 sizeof(struct ec_event), arg->size);
	/* pairs with smp_store_release() of it */
	if (smp_load_acquire(&call->file->mail))
		return ec_refuse(call, -EBUSY,
				 "this open file reads mailbox messages; open the device file again");
	r = reader(call->file);
	if (!r)
		return -ENOMEM;
	begin(r, arg);
	return 0;
}

/**
 * ec_event_reader_end() - the file is closed
 * @f: open file, perhaps a reader
 *
 * Context: Process. May sleep.
 */
void ec_event_reader_end(struct ec_file *f)
{
	struct ec_event_readers *rs = &f->master->readers;

	if (!f->reader)
		return;
	mutex_lock(&rs->lock);
	list_del(&f->reader->list);
	WRITE_ONCE(rs->count, rs->count - 1);
	mutex_unlock(&rs->lock);
	/* the work does not find it any more, and entries of poll() end with the file */
	kfree(f->reader);
}

static bool is_behind(const struct ec_event_reader *r)
{
	return ec_event_ring_head(&r->events->ring) != ec_read64(&r->at);
}

/* Copy as many events as there are and fit; their bytes. */
static ssize_t event_readers_copy(struct ec_event_reader *r, char __user *to, size_t size)
{
	struct ec_event e = { 0 };
	size_t done = 0;
	u64 at;

	if (mutex_lock_interruptible(&r->lock))
		return -ERESTARTSYS;
	while (size - done >= sizeof(e)) {
		at = r->at;
		e.time_ns = ktime_get_ns();
		e.wall_ns = ktime_get_real_ns();
		if (!ec_event_ring_get(&r->events->ring, &at, &e))
			break;
		if (copy_to_user(to + done, &e, sizeof(e))) {
			mutex_unlock(&r->lock);
			return done ?: -EFAULT;
		}
		/* events that were not copied are read next time */
		ec_write64(&r->at, at);
		done += sizeof(e);
		cond_resched();
		if (signal_pending(current))
			break;
	}
	mutex_unlock(&r->lock);
	return done;
}

/**
 * ec_event_reader_read() - read() of the device file
 * @f: open file
 * @to: buffer of the caller
 * @size: of it
 * @wait: for an event if there is none
 *
 * Context: Process. May sleep.
 * Return: bytes of whole records; -EINVAL the file is no reader, or the buffer is too small for
 * a record; -EAGAIN no event and no @wait; -EBUSY too many callers wait; -EFAULT; -ERESTARTSYS.
 */
ssize_t ec_event_reader_read(struct ec_file *f, char __user *to, size_t size, bool wait)
{
	/* pairs with reader() */
	struct ec_event_reader *r = smp_load_acquire(&f->reader);
	ssize_t n = 0;
	int ret;

	if (!r || size < sizeof(struct ec_event))
		return -EINVAL;
	/* more is never kept; a limited size cannot overflow */
	size = min_t(size_t, size, EC_EVENTS_KEPT * sizeof(struct ec_event));
	while (!n) {
		n = event_readers_copy(r, to, size);
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
 * ec_event_reader_poll() - poll() of a file that reads events
 * @r: reader
 * @filp: its file
 * @wait: argument of poll()
 *
 * Context: Process. May sleep to add an entry to the wait queue.
 * Return: EPOLLIN when there are events; EPOLLERR when too many wait already.
 */
__poll_t ec_event_reader_poll(struct ec_event_reader *r, struct file *filp, poll_table *wait)
{
	if (!ec_waiters_poll(&r->waiters, filp, wait))
		return EPOLLERR;
	/* the entry in the queue before the events: one of both is seen */
	smp_mb();
	return is_behind(r) ? EPOLLIN | EPOLLRDNORM : 0;
}
