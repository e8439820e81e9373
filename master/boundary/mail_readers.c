// SPDX-License-Identifier: GPL-2.0-only
/*
 * read() and poll() of mailbox messages. The first reader of a master allocates the ring of its
 * messages, the end of the last one frees it. Writers do not know readers: a work wakes them every
 * 20 ms while there is one.
 */
#include <linux/capability.h>
#include <linux/jiffies.h>
#include <linux/mm.h>
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "../base/once64.h"
#include "../bus/find.h"
#include "../bus/slave.h"
#include "../mailbox/mail_tap.h"
#include "ioctl.h"
#include "master.h"

#define WAKE_MS	20

static void wake_mail_readers(struct work_struct *work)
{
	struct ec_mail_readers *rs = container_of(work, struct ec_mail_readers, work.work);
	struct ec_mail_reader *r;
	u64 head;

	mutex_lock(&rs->lock);
	if (rs->tap) {
		head = ec_mail_tap_head(rs->tap);
		list_for_each_entry(r, &rs->list, list) {
			if (head == rs->woken)
				break;
			ec_waiters_wake(&r->waiters);
			cond_resched();
		}
		rs->woken = head;
		queue_delayed_work(system_unbound_wq, &rs->work, msecs_to_jiffies(WAKE_MS));
	}
	mutex_unlock(&rs->lock);
}

/**
 * ec_mail_readers_init() - prepare the list of readers, which is empty
 * @m: master
 *
 * Context: Any.
 */
void ec_mail_readers_init(struct ec_master *m)
{
	mutex_init(&m->mail_readers.lock);
	INIT_LIST_HEAD(&m->mail_readers.list);
	INIT_DELAYED_WORK(&m->mail_readers.work, wake_mail_readers);
}

/**
 * ec_mail_readers_exit() - wake no reader from now on
 * @m: master; no file of it is open
 *
 * Context: Process. May sleep.
 */
void ec_mail_readers_exit(struct ec_master *m)
{
	cancel_delayed_work_sync(&m->mail_readers.work);
}

/* The ring exists from now on. */
static int mail_readers_tap(struct ec_master *m)
{
	struct ec_mail_readers *rs = &m->mail_readers;

	lockdep_assert_held(&rs->lock);
	if (rs->tap)
		return 0;
	rs->tap = ec_mail_tap_new(rs->woken);
	if (!rs->tap)
		return -ENOMEM;
	rcu_assign_pointer(m->base->mail_tap, rs->tap);
	queue_delayed_work(system_unbound_wq, &rs->work, msecs_to_jiffies(WAKE_MS));
	return 0;
}

/* The file, which is no reader, becomes one. */
static int mail_readers_add(struct ec_file *f, u64 *next)
{
	struct ec_mail_readers *rs = &f->master->mail_readers;
	struct ec_mail_reader *r = kzalloc(sizeof(*r), GFP_KERNEL_ACCOUNT);
	int ret;

	if (!r)
		return -ENOMEM;
	mutex_init(&r->lock);
	ec_waiters_init(&r->waiters);
	mutex_lock(&rs->lock);
	ret = f->mail ? -EBUSY : mail_readers_tap(f->master);
	if (!ret) {
		r->master = f->master;
		r->tap = rs->tap;
		r->at = ec_mail_tap_head(r->tap);
		*next = r->at;
		list_add_tail(&r->list, &rs->list);
		/* complete before poll() and read() find it */
		smp_store_release(&f->mail, r);
	}
	mutex_unlock(&rs->lock);
	if (ret)
		kfree(r);
	return ret;
}

/* Command: the file becomes a reader of mailbox messages. */
int ec_ioc_mail(struct ec_call *call)
{
	struct ec_ioc_mail *arg = call->arg;
	struct ec_file *f = call->file;
	int ret;

	if (arg->size != sizeof(struct ec_mail))
		return ec_refuse(call, -EINVAL,
				 "a record has %zu bytes, not %u; build the program with the header of this module",
				 sizeof(struct ec_mail), arg->size);
	if (!capable(CAP_NET_RAW))
		return ec_refuse(call, -EPERM,
				 "mailbox messages may contain passwords; run the command as root or with CAP_NET_RAW, as for tcpdump");
	/* pairs with the store of a reader that is complete */
	ret = smp_load_acquire(&f->reader) ? -EBUSY : mail_readers_add(f, &arg->next);
	if (ret == -EBUSY)
		return ec_refuse(call, ret,
				 "this open file reads something already; open the device file again");
	return ret;
}

/**
 * ec_mail_reader_end() - the file is closed
 * @f: open file, perhaps a reader
 *
 * Context: Process. May sleep.
 */
void ec_mail_reader_end(struct ec_file *f)
{
	struct ec_mail_readers *rs = &f->master->mail_readers;
	struct ec_mail_tap *last = NULL;

	if (!f->mail)
		return;
	mutex_lock(&rs->lock);
	list_del(&f->mail->list);
	if (list_empty(&rs->list)) {
		swap(last, rs->tap);
		RCU_INIT_POINTER(f->master->base->mail_tap, NULL);
		cancel_delayed_work(&rs->work);
		/* numbers are not reused; a writer may still add some without a reader */
		rs->woken = ec_mail_tap_head(last);
	}
	mutex_unlock(&rs->lock);
	/* the work does not find it any more, and entries of poll() end with the file */
	kfree(f->mail);
	if (last)
		kvfree_rcu(last, rcu);
}

static bool mail_is_behind(const struct ec_mail_reader *r)
{
	return ec_mail_tap_head(r->tap) != ec_read64(&r->at);
}

/* The ring position of the slave with this station address. */
static int mail_position(struct ec_master *m, u16 station, u16 *position)
{
	struct ec_ioc_address a = { .kind = EC_ADDRESS_STATION, .station = station };
	unsigned int from = 0;
	struct ec_slave *s;
	int ret;

	*position = EC_MAIL_ABSENT;
	do {
		ret = ec_show_begin(&m->base->show);
		if (ret)
			return ret;
		ret = ec_find_slave(&m->bus, &a, &from, &s);
		if (s)
			*position = s->position;
		ec_show_end(&m->base->show);
	} while (ret == -EAGAIN);
	return ret;
}

/* Copy as many messages as there are and fit; their bytes. */
static ssize_t mail_readers_copy(struct ec_mail_reader *r, char __user *to, size_t size)
{
	struct ec_mail m;
	size_t done = 0;
	u64 at;

	if (mutex_lock_interruptible(&r->lock))
		return -ERESTARTSYS;
	while (size - done >= sizeof(m)) {
		at = r->at;
		if (!ec_mail_tap_get(r->tap, &at, &m))
			break;
		if (mail_position(r->master, m.station, &m.position)) {
			mutex_unlock(&r->lock);
			return done ?: -ERESTARTSYS;
		}
		if (copy_to_user(to + done, &m, sizeof(m))) {
			mutex_unlock(&r->lock);
			return done ?: -EFAULT;
		}
		/* messages that were not copied are read next time */
		ec_write64(&r->at, at);
		done += sizeof(m);
		cond_resched();
		if (signal_pending(current))
			break;
	}
	mutex_unlock(&r->lock);
	return done;
}

/**
 * ec_mail_reader_read() - read() of a file that reads mailbox messages
 * @r: reader
 * @to: buffer of the caller
 * @size: of it
 * @wait: for a message if there is none
 *
 * Context: Process. May sleep.
 * Return: bytes of whole records; -EINVAL the buffer is too small for a record; -EAGAIN no message
 * and no @wait; -EBUSY too many callers wait; -EFAULT; -ERESTARTSYS.
 */
ssize_t ec_mail_reader_read(struct ec_mail_reader *r, char __user *to, size_t size, bool wait)
{
	ssize_t n = 0;
	int ret;

	if (size < sizeof(struct ec_mail))
		return -EINVAL;
	/* more is never kept; a limited size cannot overflow */
	size = min_t(size_t, size, EC_MAILS_KEPT * sizeof(struct ec_mail));
	while (!n) {
		n = mail_readers_copy(r, to, size);
		if (n)
			break;
		if (!wait)
			return -EAGAIN;
		if (!ec_waiters_enter(&r->waiters))
			return -EBUSY;
		ret = wait_event_interruptible(r->waiters.wq, mail_is_behind(r));
		ec_waiters_leave(&r->waiters);
		if (ret)
			return ret;
	}
	return n;
}

/**
 * ec_mail_reader_poll() - poll() of a file that reads mailbox messages
 * @r: reader
 * @filp: its file
 * @wait: argument of poll()
 *
 * Context: Process. May sleep to add an entry to the wait queue.
 * Return: EPOLLIN when there are messages; EPOLLERR when too many wait already.
 */
__poll_t ec_mail_reader_poll(struct ec_mail_reader *r, struct file *filp, poll_table *wait)
{
	if (!ec_waiters_poll(&r->waiters, filp, wait))
		return EPOLLERR;
	/* the entry in the queue before the messages: one of both is seen */
	smp_mb();
	return mail_is_behind(r) ? EPOLLIN | EPOLLRDNORM : 0;
}
