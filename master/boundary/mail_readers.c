// SPDX-License-Identifier: GPL-2.0-only
/*
 * Readers of mailbox messages. The first one of a master allocates the ring of its messages, the
 * end of the last one frees it. A work wakes them every 20 ms while there is one.
 */
#include <linux/capability.h>
#include <linux/jiffies.h>
#include <linux/mm.h>
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
	u64 head;

	mutex_lock(&rs->readers.lock);
	if (rs->tap) {
		head = ec_mail_tap_head(rs->tap);
		if (head != rs->woken)
			ec_readers_wake(&rs->readers);
		rs->woken = head;
		queue_delayed_work(system_unbound_wq, &rs->work, msecs_to_jiffies(WAKE_MS));
	}
	mutex_unlock(&rs->readers.lock);
}

/**
 * ec_mail_readers_init() - prepare the list of readers, which is empty
 * @m: master
 *
 * Context: Any.
 */
void ec_mail_readers_init(struct ec_master *m)
{
	ec_readers_init(&m->mail_readers.readers);
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

static struct ec_master *master_of(const struct ec_reader *r)
{
	return container_of(r->readers, struct ec_master, mail_readers.readers);
}

static u64 mail_head(const struct ec_reader *r)
{
	return ec_mail_tap_head(r->source);
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

static int mail_copy(struct ec_reader *r, u64 *at, void __user *to)
{
	struct ec_mail m;

	if (!ec_mail_tap_get(r->source, at, &m))
		return 0;
	if (mail_position(master_of(r), m.station, &m.position))
		return -ERESTARTSYS;
	return copy_to_user(to, &m, sizeof(m)) ? -EFAULT : 1;
}

/* The ring goes with its last reader. */
static void mail_free(struct ec_reader *r)
{
	struct ec_master *m = master_of(r);
	struct ec_mail_readers *rs = &m->mail_readers;
	struct ec_mail_tap *last = rs->tap;

	lockdep_assert_held(&rs->readers.lock);
	if (rs->readers.count)
		return;
	RCU_INIT_POINTER(m->base->mail_tap, NULL);
	cancel_delayed_work(&rs->work);
	/* numbers are not reused; a writer may still add some without a reader */
	rs->woken = ec_mail_tap_head(last);
	rs->tap = NULL;
	kvfree_rcu(last, rcu);
}

static const struct ec_reader_kind mail_kind = {
	.size = sizeof(struct ec_mail),
	.kept = EC_MAILS_KEPT,
	.head = mail_head,
	.copy = mail_copy,
	.free = mail_free,
};

/* The ring exists from now on. */
static int mail_readers_tap(struct ec_master *m)
{
	struct ec_mail_readers *rs = &m->mail_readers;

	lockdep_assert_held(&rs->readers.lock);
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
	struct ec_reader *r = ec_reader_new(&mail_kind, NULL);
	int ret;

	if (!r)
		return -ENOMEM;
	mutex_lock(&rs->readers.lock);
	ret = mail_readers_tap(f->master);
	if (!ret) {
		r->source = rs->tap;
		r->at = ec_mail_tap_head(rs->tap);
		*next = r->at;
		ret = ec_reader_enter(r, &rs->readers, f);
		if (ret)
			mail_free(r);
	}
	mutex_unlock(&rs->readers.lock);
	if (ret)
		kfree(r);
	return ret;
}

/* Command: the file becomes a reader of mailbox messages. */
int ec_ioc_mail(struct ec_call *call)
{
	struct ec_ioc_mail *arg = call->arg;
	int ret;

	if (arg->size != sizeof(struct ec_mail))
		return ec_refuse(call, -EINVAL,
				 "a record has %zu bytes, not %u; build the program with the header of this module",
				 sizeof(struct ec_mail), arg->size);
	if (!capable(CAP_NET_RAW))
		return ec_refuse(call, -EPERM,
				 "mailbox messages may contain passwords; run the command as root or with CAP_NET_RAW, as for tcpdump");
	ret = mail_readers_add(call->file, &arg->next);
	if (ret == -EBUSY)
		return ec_refuse(call, ret,
				 "this open file reads something already; open the device file again");
	return ret;
}
