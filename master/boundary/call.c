// SPDX-License-Identifier: GPL-2.0-only
/* Commands: lookup, locks and buffers by the table, in one place for all handlers. */
#include <linux/mm.h>
#include <linux/nospec.h>
#include <linux/sched/signal.h>
#include <linux/uaccess.h>
#include "call.h"
#include "../base/limits.h"
#include "../bus/find.h"
#include "../bus/slave.h"
#include "master.h"
#include "../session/session.h"

/**
 * ec_refuse() - fail a command and keep the reason for EC_IOC_REASON
 * @call: command
 * @err: -errno
 * @fmt: what was wrong and what to do
 *
 * Context: Process. May sleep.
 * Return: @err.
 */
int ec_refuse(struct ec_call *call, int err, const char *fmt, ...)
{
	struct ec_file *f = call->file;
	va_list args;

	va_start(args, fmt);
	raw_spin_lock(&f->lock);
	vscnprintf(f->reason, sizeof(f->reason), fmt, args);
	raw_spin_unlock(&f->lock);
	va_end(args);
	return err;
}

/**
 * ec_call_forget_reason() - clear the reason, at the begin of a command
 * @f: open file
 *
 * Context: Process.
 */
void ec_call_forget_reason(struct ec_file *f)
{
	raw_spin_lock(&f->lock);
	f->reason[0] = '\0';
	raw_spin_unlock(&f->lock);
}

/**
 * ec_ioc_limit() - give the reason when the memory of a master's sessions is exceeded
 * @call: command
 * @ret: result so far
 *
 * Context: Process.
 * Return: -ENOMEM for -EDQUOT, with the reason noted; else @ret.
 */
int ec_ioc_limit(struct ec_call *call, int ret)
{
	if (ret != -EDQUOT)
		return ret;
	return ec_refuse(call, -ENOMEM,
			 "limit of %u MiB for the sessions of master %u and their mapped memory reached; configure less, or unmap the memory of earlier activations",
			 EC_MAX_SESSION_BYTES >> 20, call->master->base->index);
}

/* what a command needs -------------------------------------------------------*/

/**
 * ec_ioc_lock_session() - lock the session of a command's file
 * @call: command; its @session is set
 *
 * Context: Process. May sleep. session lock is held when 0 is returned.
 * Return: 0 or -EPERM with the reason noted.
 */
int ec_ioc_lock_session(struct ec_call *call)
{
	ec_sessions_lock(&call->master->sessions);
	call->session = ec_session_of(&call->master->sessions, call->file);
	if (call->session)
		return 0;
	ec_sessions_unlock(&call->master->sessions);
	return ec_refuse(call, -EPERM, "reserve the master first (ecrt_request_master)");
}

static int find_config(struct ec_call *call, u32 index)
{
	if (index >= call->session->wanted.n_configs)
		return ec_refuse(call, -ENOENT, "there are %u slave configurations, no %u",
				 call->session->wanted.n_configs, index);
	index = array_index_nospec(index, call->session->wanted.n_configs);
	call->config = call->session->wanted.configs[index];
	return 0;
}

static int find_domain(struct ec_call *call, u32 index)
{
	if (index >= call->session->wanted.n_domains)
		return ec_refuse(call, -ENOENT, "there are %u domains, no %u",
				 call->session->wanted.n_domains, index);
	index = array_index_nospec(index, call->session->wanted.n_domains);
	call->domain = call->session->wanted.domains[index];
	return 0;
}

static int with_session(struct ec_call *call, const struct ec_ioctl *op)
{
	int ret = ec_ioc_lock_session(call);

	if (ret)
		return ret;
	if (op->class != EC_CLASS_SESSION && call->session->wanted.active)
		ret = ec_refuse(call, -EBUSY,
				"the master is active; configure before ecrt_master_activate()");
	else if (op->class == EC_CLASS_CONFIG)
		ret = find_config(call, *(u32 *)(call->arg + op->at));
	else if (op->class == EC_CLASS_DOMAIN)
		ret = find_domain(call, *(u32 *)(call->arg + op->at));
	ret = ret ?: op->fn(call);
	ec_sessions_unlock(&call->master->sessions);
	return ret;
}

/* An application sees its own session, every other caller the one that runs. */
static int show_session(struct ec_call *call, const struct ec_ioctl *op)
{
	struct ec_sessions *s = &call->master->sessions;

	call->session = ec_session_of(s, call->file) ?: s->session;
	if (!call->session)
		return ec_refuse(call, -ENOENT, "no application has reserved master %u",
				 call->master->base->index);
	if (op->class == EC_CLASS_SHOW_CONFIG)
		return find_config(call, *(u32 *)(call->arg + op->at));
	return op->class == EC_CLASS_SHOW ? 0 :
	       find_domain(call, *(u32 *)(call->arg + op->at));
}

/**
 * ec_ioc_pause() - leave the show section of a command for a moment
 * @call: command whose class has one
 *
 * Context: Process. May sleep.
 * Return: as ec_show_pause(); the handler returns what is not 0, and is called again
 * after -EAGAIN.
 */
int ec_ioc_pause(struct ec_call *call)
{
	int ret = ec_show_pause(&call->master->base->show);

	call->showing = !ret;
	return ret;
}

/* In a show section; a long search pauses. With an error other than -ENOENT it has ended. */
static int find_slave(struct ec_call *call, const struct ec_ioc_address *a, char *why, size_t size)
{
	const struct ec_bus *bus = &call->master->bus;
	unsigned int from = 0;
	struct ec_slave *s;
	int ret;

	while (ec_find_slave(bus, a, &from, &s) == -EAGAIN) {
		ret = ec_show_pause(&call->master->base->show);
		if (ret)
			return ret;
	}
	if (s)
		call->slave = ec_slave_ref(s);
	else
		ec_find_text(bus, a, why, size);
	ec_show_end(&call->master->base->show);
	return s ? 0 : a->kind == EC_ADDRESS_DEVICE ? -ENODEV : -ENOENT;
}

/**
 * ec_ioc_get_slave() - the slave a command names
 * @call: command; its @slave is set, with a reference for the time of the command
 * @address: which one
 *
 * Context: Process. May sleep.
 * Return: 0, or with the reason noted: -ENOENT, -ENODEV no slave has the device number;
 * -EOPNOTSUPP, -EINVAL as ec_find_check().
 */
int ec_ioc_get_slave(struct ec_call *call, const struct ec_ioc_address *address)
{
	char text[EC_UAPI_REASON];
	const char *why;
	int ret = ec_find_check(address, &why);

	if (ret)
		return ec_refuse(call, ret, "%s", why);
	do {
		ret = ec_show_begin(&call->master->base->show) ?:
		      find_slave(call, address, text, sizeof(text));
		/* as in with_show() */
		if (ret == -EAGAIN && signal_pending(current))
			ret = -ERESTARTSYS;
	} while (ret == -EAGAIN);
	return ret == -ENOENT || ret == -ENODEV ? ec_refuse(call, ret, "%s", text) : ret;
}

/* A command that only shows what is known of a slave also works for one that was lost. */
static int refuse_lost(struct ec_call *call, const struct ec_ioctl *op, int ret)
{
	char why[EC_UAPI_REASON];

	if (!(op->flags & F_WRITE) || !READ_ONCE(call->slave->reply.silent))
		return ret;
	return ec_refuse(call, ret ?: -EIO, "slave %u: %.200s", call->slave->position,
			 ec_slave_why(call->slave, why, sizeof(why)));
}

static int with_slave(struct ec_call *call, const struct ec_ioctl *op)
{
	int ret = ec_ioc_get_slave(call, call->arg + op->at);

	ret = ret ?: refuse_lost(call, op, 0);
	if (ret)
		return ret;
	ret = op->fn(call);
	/* the slave was lost meanwhile: report that as the cause */
	return ret == -EAGAIN || ret == -ETIMEDOUT ? refuse_lost(call, op, ret) : ret;
}

static int with_show(struct ec_call *call, const struct ec_ioctl *op)
{
	int ret;

	do {
		ret = ec_show_begin(&call->master->base->show);
		if (ret)
			return ret;
		call->showing = true;
		ret = (call->slave ? 0 : show_session(call, op)) ?: op->fn(call);
		if (call->showing)
			ec_show_end(&call->master->base->show);
		/* with one change after the other no wait would notice a signal */
		if (ret == -EAGAIN && signal_pending(current))
			ret = -ERESTARTSYS;
	} while (ret == -EAGAIN);
	return ret;
}

static int execute(struct ec_call *call, const struct ec_ioctl *op)
{
	switch (op->class) {
	case EC_CLASS_MASTER:
		return op->fn(call);
	case EC_CLASS_SLAVE:
		return with_slave(call, op);
	case EC_CLASS_SHOW_SLAVE:
		return ec_ioc_get_slave(call, call->arg + op->at) ?: with_show(call, op);
	case EC_CLASS_SHOW_CONFIG:
	case EC_CLASS_SHOW_DOMAIN:
	case EC_CLASS_SHOW:
		return with_show(call, op);
	default:
		return with_session(call, op);
	}
}

/* A buffer for a result may be larger than needed; a handler refuses a value that is too large. */
static int get_buffer(struct ec_call *call, const struct ec_ioctl *op)
{
	const struct ec_ioc_buffer *b = &op->buffer;
	u64 address = *(u64 *)(call->arg + b->address);
	u32 size = *(u32 *)(call->arg + b->size);

	call->size = b->in ? size : min(size, b->most);
	if (!call->size || call->size > b->most)
		return 0;
	call->data = kvzalloc(call->size, GFP_KERNEL_ACCOUNT);
	if (!call->data)
		return -ENOMEM;
	if (!b->in)
		return 0;
	if (!call->user)
		memcpy(call->data, (void *)(uintptr_t)address, call->size);
	else if (copy_from_user(call->data, u64_to_user_ptr(address), call->size))
		return -EFAULT;
	return 0;
}

/* No lock is held: mmap() takes session lock with the memory of the process locked. */
static int put_buffer(struct ec_call *call, const struct ec_ioctl *op)
{
	const struct ec_ioc_buffer *b = &op->buffer;
	u64 address = *(u64 *)(call->arg + b->address);
	u32 size = min(*(u32 *)(call->arg + b->size), call->size);

	if (!call->user)
		memcpy((void *)(uintptr_t)address, call->data, size);
	else if (copy_to_user(u64_to_user_ptr(address), call->data, size))
		return -EFAULT;
	return 0;
}

/**
 * ec_call_run() - carry out a command
 * @f: open file of the caller
 * @op: its entry in the table
 * @arg: its argument, in kernel memory
 * @user: a buffer that @arg names is in the process' memory
 *
 * Context: Process. As the command.
 * Return: as the command.
 */
int ec_call_run(struct ec_file *f, const struct ec_ioctl *op, void *arg, bool user)
{
	struct ec_call call = { .file = f, .master = f->master, .arg = arg, .user = user };
	int ret = op->buffer.most ? get_buffer(&call, op) : 0;

	if (!ret)
		ret = execute(&call, op);
	if (!ret && op->buffer.out)
		ret = put_buffer(&call, op);
	kvfree(call.data);
	ec_slave_unref(call.slave);
	return ret;
}
