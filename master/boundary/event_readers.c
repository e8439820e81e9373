// SPDX-License-Identifier: GPL-2.0-only
/*
 * Readers of events. A reader costs the master only the work that wakes it: the monitor checks for
 * new events at each of its polls, and a worker wakes the readers.
 */
#include <linux/ktime.h>
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "../base/once64.h"
#include "ioctl.h"
#include "master.h"

static void wake_readers(struct work_struct *work)
{
	struct ec_event_readers *rs = container_of(work, struct ec_event_readers, work);

	mutex_lock(&rs->readers.lock);
	ec_readers_wake(&rs->readers);
	mutex_unlock(&rs->readers.lock);
}

/**
 * ec_event_readers_init() - prepare the list of readers, which is empty
 * @m: master
 *
 * Context: Any.
 */
void ec_event_readers_init(struct ec_master *m)
{
	ec_readers_init(&m->readers.readers);
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
	if (READ_ONCE(rs->readers.count))
		queue_work(system_unbound_wq, &rs->work);
}

static u64 event_head(const struct ec_reader *r)
{
	const struct ec_events *events = r->source;

	return ec_event_ring_head(&events->ring);
}

static int event_copy(struct ec_reader *r, u64 *at, void __user *to)
{
	struct ec_event e = { .time_ns = ktime_get_ns(), .wall_ns = ktime_get_real_ns() };
	const struct ec_events *events = r->source;

	if (!ec_event_ring_get(&events->ring, at, &e))
		return 0;
	return copy_to_user(to, &e, sizeof(e)) ? -EFAULT : 1;
}

static const struct ec_reader_kind event_kind = {
	.size = sizeof(struct ec_event),
	.kept = EC_EVENTS_KEPT,
	.head = event_head,
	.copy = event_copy,
};

static void begin(struct ec_reader *r, struct ec_ioc_events *arg)
{
	const struct ec_events *events = r->source;

	mutex_lock(&r->lock);
	arg->next = ec_event_ring_head(&events->ring);
	arg->first = arg->flags & EC_EVENTS_FLAG_NEW ? arg->next :
		     ec_event_ring_oldest(&events->ring);
	ec_write64(&r->at, arg->first);
	mutex_unlock(&r->lock);
}

/* The reader of a file, created at the first call; one of something else stays. */
static struct ec_reader *event_reader(struct ec_file *f)
{
	struct ec_readers *rs = &f->master->readers.readers;
	struct ec_reader *r = ec_reader_new(&event_kind, &f->master->base->events);
	int ret;

	if (!r)
		return NULL;
	mutex_lock(&rs->lock);
	ret = ec_reader_enter(r, rs, f);
	mutex_unlock(&rs->lock);
	if (ret)
		kfree(r);
	/* pairs with ec_reader_enter() */
	return smp_load_acquire(&f->reader);
}

/* Command: the file becomes a reader of events, or begins again. */
int ec_ioc_events(struct ec_call *call)
{
	struct ec_ioc_events *arg = call->arg;
	struct ec_reader *r;

	if (arg->size != sizeof(struct ec_event))
		return ec_refuse(call, -EINVAL,
				 "an event has %zu bytes, not %u; build the program with the header of this module",
				 sizeof(struct ec_event), arg->size);
	r = event_reader(call->file);
	if (!r)
		return -ENOMEM;
	if (r->kind != &event_kind)
		return ec_refuse(call, -EBUSY,
				 "this open file reads mailbox messages; open the device file again");
	begin(r, arg);
	return 0;
}
