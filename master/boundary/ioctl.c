// SPDX-License-Identifier: GPL-2.0-only
/* Dispatch of /dev/EtherCAT<n>: permissions, sizes and copies in one place. */
#include <linux/fs.h>
#include <linux/mm.h>
#include <linux/nospec.h>
#include <linux/uaccess.h>
#include "call.h"
#include "../base/limits.h"

#define MAX_ARG	896	/* on the stack: a 32-bit kernel warns above 1024 in all */

#define OLD_VERSION	_IOR(EC_IOC_TYPE, _IOC_NR(EC_IOC_VERSION), struct ec_ioc_version)

#define FIELD(type, field) { offsetof(struct type, field), sizeof_field(struct type, field) }
#define RSV(...) .reserved = { __VA_ARGS__ }
#define RSV1(type) RSV(FIELD(type, reserved))
#define RSV2(type) RSV(FIELD(type, reserved), FIELD(type, reserved2))
#define ADDRESS(c, type) .class = (c), .at = offsetof(struct type, slave) + \
	BUILD_BUG_ON_ZERO(sizeof_field(struct type, slave) != sizeof(struct ec_ioc_address))
#define SLAVE(type) ADDRESS(EC_CLASS_SLAVE, type)
#define SHOW_SLAVE(type) ADDRESS(EC_CLASS_SHOW_SLAVE, type)
#define INDEX(c, type, field) .class = (c), .at = offsetof(struct type, field) + \
	BUILD_BUG_ON_ZERO(sizeof_field(struct type, field) != sizeof(u32))
#define CONFIG(type) INDEX(EC_CLASS_CONFIG, type, config)
#define DOMAIN(type) INDEX(EC_CLASS_DOMAIN, type, domain)
#define SHOW_CONFIG(type) INDEX(EC_CLASS_SHOW_CONFIG, type, index)
#define SHOW_DOMAIN(type) INDEX(EC_CLASS_SHOW_DOMAIN, type, index)
#define SHOW .class = EC_CLASS_SHOW
#define SESSION .class = EC_CLASS_SESSION
#define IDLE .class = EC_CLASS_IDLE
#define BUFFER(type, d, s, m, i, o) .buffer = { .address = offsetof(struct type, d), \
	.size = offsetof(struct type, s), .most = (m), .in = (i), .out = (o) }
#define IN(type, most) BUFFER(type, data, size, most, true, false)
#define OUT(type, most) BUFFER(type, data, size, most, false, true)
#define INOUT(type, most) BUFFER(type, data, size, most, true, true)
#define FLAGS(f) .known = (f)
#define OLDEST(type, last) .min = offsetofend(struct type, last)
#define CMD(c, f, fl, ...) [_IOC_NR(c)] = { .cmd = (c), .fn = (f), .flags = (fl) + \
	BUILD_BUG_ON_ZERO(_IOC_SIZE(c) > MAX_ARG), ##__VA_ARGS__ },

static const struct ec_ioctl table[] = {
#include "commands.h"
};

/* Version request of the IgH EtherCAT Master: programs built for it fail cleanly. */
static long foreign_version(unsigned long arg)
{
	u32 v[2] = { 0xec000001, 0 };

	return copy_to_user((void __user *)arg, v, sizeof(v)) ? -EFAULT : 0;
}

/* May the caller give the command, and is the size of the argument valid? */
static int check(struct ec_call *call, const struct ec_ioctl *op, unsigned int cmd)
{
	unsigned int size = _IOC_SIZE(cmd), min = op->min ?: _IOC_SIZE(op->cmd);

	/* the argument of a newer program is longer: fetch_arg() checks the rest */
	if (size < min || (size && !_IOC_DIR(cmd)))
		return ec_refuse(call, -EINVAL,
				 "command 0x%08x has an argument of %u bytes, needs %u; build the program with the header of this module",
				 cmd, size, min);
	if (op->flags & F_WRITE && !call->file->writable)
		return ec_refuse(call, -EPERM,
				 "the command needs /dev/EtherCAT opened for writing; get write permission (group ethercat)");
	return 0;
}

/* A command must not use flags or fields that this module does not know. */
static int check_unknown(struct ec_call *call, const struct ec_ioctl *op, const void *karg)
{
	/* each argument begins with its flags */
	u32 flags = *(const u32 *)karg & ~op->known;
	unsigned int i;

	if (flags)
		return ec_refuse(call, -EOPNOTSUPP, "command 0x%08x: unknown flags 0x%x", op->cmd,
				 flags);
	for (i = 0; i < ARRAY_SIZE(op->reserved); i++) {
		const struct ec_reserved *r = &op->reserved[i];

		if (memchr_inv(karg + r->offset, 0, r->size))
			return ec_refuse(call, -EOPNOTSUPP,
					 "command 0x%08x: reserved bytes at %u are not zero; a newer module may know them",
					 op->cmd, r->offset);
	}
	return 0;
}

/**
 * ec_ioc() - execute a command from within the kernel
 * @f: file that stands for the application
 * @cmd: EC_IOC_*
 * @arg: its argument; addresses in it are the kernel's
 *
 * Context: Process. As the command.
 * Return: as the command.
 */
int ec_ioc(struct ec_file *f, unsigned int cmd, void *arg)
{
	const struct ec_ioctl *op = &table[_IOC_NR(cmd)];
	struct ec_call call = { .file = f };
	int ret = 0;

	/* reading the reason must not clear it */
	if (cmd != EC_IOC_REASON)
		ec_call_forget_reason(f);
	if (_IOC_DIR(cmd) & _IOC_WRITE)
		ret = check_unknown(&call, op, arg);
	return ret ?: ec_call_run(f, op, arg, false);
}

/* Refuse programs of interface versions 1 and 2, which do not name their version. */
static long refuse_old(struct ec_file *f)
{
	struct ec_call call = { .file = f };

	return ec_refuse(&call, -EPROTO,
			 "the program was built for interface version 1 or 2, this module has version %u: rebuild the program, or install its library of the same release",
			 EC_UAPI_VERSION);
}

static int fetch_arg(struct ec_call *call, const struct ec_ioctl *op, unsigned int cmd, void *karg,
		     void __user *uarg)
{
	int ret = copy_struct_from_user(karg, _IOC_SIZE(op->cmd), uarg, _IOC_SIZE(cmd));

	if (ret == -E2BIG)
		return ec_refuse(call, ret,
				 "command 0x%08x: this module knows %u bytes of the argument, the rest must be zero",
				 cmd, _IOC_SIZE(op->cmd));
	return ret ?: check_unknown(call, op, karg);
}

/* An argument larger than this module knows ends with zeros. */
static int return_arg(unsigned int ksize, unsigned int usize, const void *karg, void __user *uarg)
{
	if (copy_to_user(uarg, karg, min(usize, ksize)))
		return -EFAULT;
	return usize > ksize && clear_user(uarg + ksize, usize - ksize) ? -EFAULT : 0;
}

/* Apart from the cyclic commands, which must not pay for the large buffer. */
static noinline long dispatch(struct ec_file *f, unsigned int cmd, unsigned long arg)
{
	unsigned int nr = _IOC_NR(cmd);
	void __user *uarg = (void __user *)arg;
	u64 karg[MAX_ARG / sizeof(u64)];
	struct ec_call call = { .file = f };
	const struct ec_ioctl *op;
	int ret;

	if (cmd == _IOR(0xa4, 0, u64))
		return foreign_version(arg);
	if (cmd == OLD_VERSION)
		return refuse_old(f);
	if (_IOC_TYPE(cmd) != EC_IOC_TYPE || nr >= ARRAY_SIZE(table))
		return -ENOTTY;
	op = &table[array_index_nospec(nr, ARRAY_SIZE(table))];
	if (!op->fn || _IOC_DIR(cmd) != _IOC_DIR(op->cmd))
		return -ENOTTY;
	/* a failure without text must not show the previous text */
	if (op->fn != ec_ioc_reason)
		ec_call_forget_reason(f);
	ret = check(&call, op, cmd);
	if (ret)
		return ret;

	memset(karg, 0, _IOC_SIZE(op->cmd));
	if (_IOC_DIR(cmd) & _IOC_WRITE) {
		ret = fetch_arg(&call, op, cmd, karg, uarg);
		if (ret)
			return ret;
	}
	ret = ec_call_run(f, op, karg, true);
	/* on -EIO the abort code is in the structure */
	if ((!ret || ret == -EIO) && _IOC_DIR(cmd) & _IOC_READ &&
	    return_arg(_IOC_SIZE(op->cmd), _IOC_SIZE(cmd), karg, uarg))
		ret = -EFAULT;
	return ret;
}

/**
 * ec_ioctl() - .unlocked_ioctl of the character device
 * @filp: open file
 * @cmd: EC_IOC_*
 * @arg: user pointer
 *
 * Context: Process. May sleep; RECEIVE, SEND and APP_TIME are RT-safe.
 * Return: 0 or -errno; -ENOTTY for an unknown command, -EOPNOTSUPP for unknown
 * flags and reserved bytes, -EINVAL for an invalid size, -E2BIG for a
 * non-zero tail, -EPERM, -EFAULT.
 */
long ec_ioctl(struct file *filp, unsigned int cmd, unsigned long arg)
{
	struct ec_file *f = filp->private_data;

	if (cmd == EC_IOC_RECEIVE) {
		ec_ioctl_admit(f, EC_ADMITTED_RECEIVE);
		return ec_ioc_receive(f);
	}
	if (_IOC_TYPE(cmd) == EC_IOC_TYPE && _IOC_NR(cmd) == _IOC_NR(EC_IOC_SEND))
		return ec_ioctl_send(f, cmd, arg);
	return dispatch(f, cmd, arg);
}
