// SPDX-License-Identifier: GPL-2.0-only
/* Commands of an application that runs the cycle: each of its calls is one of them. */
#include <linux/err.h>
#include <linux/fs.h>
#include <linux/moduleparam.h>
#include <linux/uaccess.h>
#include "ioctl.h"
#include "master.h"
#include "../cycle/receive.h"
#include "../cycle/send.h"
#include "../session/request.h"
#include "../session/reserve.h"
#include "../session/session.h"

/**
 * enter() - the cycle owner begins receive or send
 * @f: open file
 *
 * A mutex is safe here in real time: besides the cycle owner only deactivation takes
 * it, for the time of one assignment, so it is free and costs one atomic operation. If
 * both want it, deactivation inherits the priority of the cycle owner under PREEMPT_RT,
 * where a mutex is an rt_mutex.
 *
 * Context: Process. The lock is held when a cycle is returned.
 * Return: the active cycle of this file, ERR_PTR(-EPERM), or ERR_PTR(-EBUSY) when the kernel
 * runs the cycle.
 */
static __always_inline struct ec_cycle *enter(struct ec_file *f)
{
	struct ec_cycles *cycles = &f->master->cycles;
	struct ec_cycle *c;
	int ret;

	/* a file that does not own the cycle does not reach its lock */
	if (READ_ONCE(cycles->owner) != f)
		return ERR_PTR(-EPERM);
	mutex_lock(&cycles->lock);
	c = cycles->active;
	if (likely(c && c->owner == f && !c->thread))
		return c;
	ret = c && c->owner == f ? -EBUSY : -EPERM;
	mutex_unlock(&cycles->lock);
	return ERR_PTR(ret);
}

static void ioctl_cyclic_leave(struct ec_file *f)
{
	mutex_unlock(&f->master->cycles.lock);
}

int ec_ioc_app_time(struct ec_call *call)
{
	struct ec_ioc_app_time *i = call->arg;
	struct ec_ioc_send send = { .flags = EC_SEND_FLAG_APP_TIME, .app_time = i->app_time };
	struct ec_cycle *c = enter(call->file);
	int ret;

	if (!IS_ERR(c)) {
		ec_cycle_app_time(c, &send);
		ioctl_cyclic_leave(call->file);
		return 0;
	}
	if (PTR_ERR(c) == -EBUSY)
		return ec_refuse(call, -EBUSY,
				 "the kernel runs the cycle and sets the application time");
	ret = ec_ioc_lock_session(call);
	if (ret)
		return ret;
	ec_session_app_time(&call->master->sessions, i->app_time);
	ec_sessions_unlock(&call->master->sessions);
	return 0;
}

/* Inlined twice, so that the shorter entry of ec_ioctl_advise() costs no call. */
static __always_inline int ioctl_cyclic_receive(struct ec_file *f)
{
	struct ec_cycle *c = enter(f);
	int ret;

	if (IS_ERR(c))
		return PTR_ERR(c);
	ret = ec_cycle_receive(c);
	ioctl_cyclic_leave(f);
	return ret;
}

static __always_inline int ioctl_cyclic_send(struct ec_file *f, const struct ec_ioc_send *what)
{
	struct ec_cycle *c = enter(f);
	int ret;

	if (IS_ERR(c))
		return PTR_ERR(c);
	if (what->flags & EC_SEND_FLAG_REQUESTS)
		ec_requests_kick(ec_cycle_session(c));
	ret = ec_cycle_take_request(c, what) ?: ec_cycle_send(c, what);
	ioctl_cyclic_leave(f);
	return ret;
}

/**
 * ec_ioc_receive() - EC_IOC_RECEIVE
 * @f: open file
 *
 * Context: Process. RT-safe.
 * Return: 0, -EPERM, -EBUSY when the kernel runs the cycle, -ENODEV.
 */
int ec_ioc_receive(struct ec_file *f)
{
	return ioctl_cyclic_receive(f);
}

/**
 * ec_ioc_send() - EC_IOC_SEND
 * @f: open file
 * @what: its argument, flags are known ones
 *
 * Context: Process. RT-safe.
 * Return: as ec_ioc_receive(); -ENOENT a domain is queued that does not exist.
 */
int ec_ioc_send(struct ec_file *f, const struct ec_ioc_send *what)
{
	return ioctl_cyclic_send(f, what);
}

static bool short_entry = true;
module_param(short_entry, bool, 0444);
MODULE_PARM_DESC(short_entry,
		 "0: receive and send of a cycle by ioctl() only, not by posix_fadvise()");

/**
 * ec_ioctl_admit() - note that a command of the cycle was executed by ioctl()
 * @f: open file
 * @which: EC_ADMITTED_*
 *
 * Security modules and filters of system calls have admitted it, so from now on it may use the
 * shorter entry.
 *
 * Context: Process. RT-safe.
 */
void ec_ioctl_admit(struct ec_file *f, unsigned int which)
{
	if (short_entry && !test_bit(which, &f->admitted))
		set_bit(which, &f->admitted);
}

static bool is_admitted(const struct ec_file *f, unsigned int which)
{
	return likely(test_bit(which, &f->admitted));
}

/* For a program that was built with a later header; not inline, so it costs others nothing. */
static noinline int fetch_longer(struct ec_ioc_send *what, size_t size, const void __user *arg)
{
	return size < sizeof(*what) ? -EINVAL :
	       copy_struct_from_user(what, sizeof(*what), arg, size);
}

/**
 * ec_ioctl_send() - EC_IOC_SEND of a program
 * @f: open file
 * @cmd: the command, of this number
 * @arg: user pointer
 *
 * Context: Process. RT-safe.
 * Return: as ec_ioc_send(); -ENOTTY, -EINVAL, -E2BIG, -EFAULT, -EOPNOTSUPP as ec_ioctl().
 */
long ec_ioctl_send(struct ec_file *f, unsigned int cmd, unsigned long arg)
{
	struct ec_ioc_send what;
	int ret;

	if (_IOC_DIR(cmd) != _IOC_DIR(EC_IOC_SEND))
		return -ENOTTY;
	ec_ioctl_admit(f, EC_ADMITTED_SEND);
	if (unlikely(_IOC_SIZE(cmd) != sizeof(what))) {
		ret = fetch_longer(&what, _IOC_SIZE(cmd), (void __user *)arg);
		if (ret)
			return ret;
	} else if (copy_from_user(&what, (void __user *)arg, sizeof(what))) {
		return -EFAULT;
	}
	if (what.flags & ~EC_SEND_FLAG_ALL || what.reserved)
		return -EOPNOTSUPP;
	return ec_ioc_send(f, &what);
}

/**
 * ec_ioctl_advise() - .fadvise of the character device: the commands of the cycle
 * @filp: open file
 * @offset: application time in ns, for EC_ADVICE_SEND
 * @len: domains to send, bit n queues domain n
 * @advice: EC_ADVICE_RECEIVE, or EC_ADVICE_SEND with EC_SEND_FLAG_*
 *
 * Security modules examine each ioctl(), and that costs more than the rest of the entry. They
 * are not bypassed: a command is accepted here only after they have admitted it by ioctl() on
 * this file.
 *
 * Context: Process. RT-safe.
 * Return: as EC_IOC_RECEIVE and EC_IOC_SEND; for other advice as for any file: -EINVAL.
 */
int ec_ioctl_advise(struct file *filp, loff_t offset, loff_t len, int advice)
{
	struct ec_file *f = filp->private_data;
	struct ec_ioc_send what;

	if (advice == EC_ADVICE_RECEIVE && is_admitted(f, EC_ADMITTED_RECEIVE))
		return ioctl_cyclic_receive(f);
	if ((advice & ~EC_SEND_FLAG_ALL) == EC_ADVICE_SEND && is_admitted(f, EC_ADMITTED_SEND)) {
		what = (struct ec_ioc_send){
			.flags = advice & EC_SEND_FLAG_ALL, .queued = len,
			.app_time = offset, .sync_time = offset,
		};
		return ioctl_cyclic_send(f, &what);
	}
	return generic_fadvise(filp, offset, len, advice);
}
