// SPDX-License-Identifier: GPL-2.0-only
/* Dispatch of /dev/EtherCAT<n>: permissions, sizes and copies in one place. */
#include <linux/mm.h>
#include <linux/nospec.h>
#include <linux/uaccess.h>
#include "ioctl.h"
#include "../base/limits.h"
#include "../master.h"

#define MAX_ARG	896	/* on the stack, where a kernel of 32 bits wants at most 1024 in all */

#define F_WRITE	1	/* needs a descriptor opened for writing */

/* bytes of an argument that must be zero */
struct ec_reserved {
	u16 offset;
	u16 size;
};

/**
 * struct ec_ioctl - one command
 * @cmd: number; its size is what this module knows
 * @fn: handler
 * @flags: F_*
 * @min: bytes the oldest program sends; less is no such argument
 * @reserved: fields that must be zero; size 0 ends them
 */
struct ec_ioctl {
	unsigned int cmd;
	int (*fn)(struct ec_file *f, void *arg);
	unsigned int flags;
	unsigned int min;
	struct ec_reserved reserved[2];
};

#define RSV(type, field) { offsetof(struct type, field), sizeof_field(struct type, field) }
#define IOC_MIN(c, f, fl, size, ...) [_IOC_NR(c)] = { .cmd = (c), .fn = (f), .flags = (fl) + \
	BUILD_BUG_ON_ZERO(_IOC_SIZE(c) > MAX_ARG), .min = (size), \
	.reserved = { __VA_ARGS__ } }
#define IOC(c, f, fl, ...) IOC_MIN(c, f, fl, _IOC_SIZE(c), ##__VA_ARGS__)

static const struct ec_ioctl table[] = {
	IOC(EC_IOC_VERSION, ec_ioc_version, 0),
	IOC(EC_IOC_REASON, ec_ioc_reason, 0),
	IOC_MIN(EC_IOC_MASTER, ec_ioc_master, 0, offsetofend(struct ec_ioc_master, not_captured)),
	IOC_MIN(EC_IOC_SLAVE, ec_ioc_slave, 0, offsetofend(struct ec_ioc_slave, dc_odd)),
	IOC(EC_IOC_SM, ec_ioc_sm, 0, RSV(ec_ioc_sm, reserved)),
	IOC(EC_IOC_PDO, ec_ioc_pdo, 0, RSV(ec_ioc_pdo, reserved), RSV(ec_ioc_pdo, reserved2)),
	IOC(EC_IOC_PDO_ENTRY, ec_ioc_pdo_entry, 0, RSV(ec_ioc_pdo_entry, reserved)),
	IOC(EC_IOC_SII, ec_ioc_sii, 0, RSV(ec_ioc_sii, reserved)),
	IOC(EC_IOC_CONFIG, ec_ioc_config, 0),
	IOC(EC_IOC_CONFIG_SM, ec_ioc_config_sm, 0, RSV(ec_ioc_config_sm, reserved)),
	IOC(EC_IOC_CONFIG_PDO, ec_ioc_config_pdo, 0, RSV(ec_ioc_config_pdo, reserved)),
	IOC(EC_IOC_CONFIG_ENTRY, ec_ioc_config_entry, 0, RSV(ec_ioc_config_entry, reserved)),
	IOC(EC_IOC_CONFIG_SDO, ec_ioc_config_sdo, 0,
	    RSV(ec_ioc_config_sdo, reserved), RSV(ec_ioc_config_sdo, reserved2)),
	IOC(EC_IOC_CONFIG_IDN, ec_ioc_config_idn, 0, RSV(ec_ioc_config_idn, reserved)),
	IOC(EC_IOC_CONFIG_FLAG, ec_ioc_config_flag, 0),
	IOC(EC_IOC_DOMAIN, ec_ioc_domain, 0),
	IOC(EC_IOC_DOMAIN_FMMU, ec_ioc_domain_fmmu, 0, RSV(ec_ioc_domain_fmmu, reserved)),
	IOC(EC_IOC_DOMAIN_DATA, ec_ioc_domain_data, 0, RSV(ec_ioc_domain_data, reserved)),
	IOC(EC_IOC_CYCLE_STATS, ec_ioc_cycle_stats, 0),
	IOC(EC_IOC_SDO_UPLOAD, ec_ioc_sdo_upload, F_WRITE, RSV(ec_ioc_sdo, reserved)),
	IOC(EC_IOC_SDO_DOWNLOAD, ec_ioc_sdo_download, F_WRITE, RSV(ec_ioc_sdo, reserved)),
	IOC(EC_IOC_REG_READ, ec_ioc_reg_read, F_WRITE, RSV(ec_ioc_reg, reserved)),
	IOC(EC_IOC_REG_WRITE, ec_ioc_reg_write, F_WRITE, RSV(ec_ioc_reg, reserved)),
	IOC(EC_IOC_SOE_READ, ec_ioc_soe_read, F_WRITE, RSV(ec_ioc_soe, reserved)),
	IOC(EC_IOC_SOE_WRITE, ec_ioc_soe_write, F_WRITE, RSV(ec_ioc_soe, reserved)),
	IOC(EC_IOC_STATE, ec_ioc_state, F_WRITE, RSV(ec_ioc_state, reserved)),
	IOC(EC_IOC_RESCAN, ec_ioc_rescan, F_WRITE),
	IOC(EC_IOC_DEBUG, ec_ioc_debug, F_WRITE),
	IOC(EC_IOC_RESET, ec_ioc_reset, F_WRITE),
	IOC(EC_IOC_CYCLE_RESET, ec_ioc_cycle_reset, F_WRITE),
	IOC(EC_IOC_END_DETACHED, ec_ioc_end_detached, F_WRITE),
	IOC(EC_IOC_RESERVE, ec_ioc_reserve, F_WRITE),
	IOC(EC_IOC_RELEASE, ec_ioc_release, F_WRITE),
	IOC(EC_IOC_CREATE_DOMAIN, ec_ioc_create_domain, F_WRITE),
	IOC(EC_IOC_SLAVE_CONFIG, ec_ioc_slave_config, F_WRITE),
	IOC(EC_IOC_SC_SYNC, ec_ioc_sc_sync, F_WRITE, RSV(ec_ioc_sc_sync, reserved)),
	IOC(EC_IOC_SC_WATCHDOG, ec_ioc_sc_watchdog, F_WRITE),
	IOC(EC_IOC_SC_PDO, ec_ioc_sc_pdo, F_WRITE),
	IOC(EC_IOC_SC_SDO, ec_ioc_sc_sdo, F_WRITE, RSV(ec_ioc_sc_sdo, reserved)),
	IOC(EC_IOC_SC_IDN, ec_ioc_sc_idn, F_WRITE),
	IOC(EC_IOC_REG_ENTRY, ec_ioc_reg_entry, F_WRITE),
	IOC(EC_IOC_SC_DC, ec_ioc_sc_dc, F_WRITE,
	    RSV(ec_ioc_sc_dc, reserved), RSV(ec_ioc_sc_dc, reserved2)),
	IOC(EC_IOC_SC_FLAG, ec_ioc_sc_flag, F_WRITE, RSV(ec_ioc_sc_flag, reserved)),
	IOC(EC_IOC_SC_TIMEOUT, ec_ioc_sc_timeout, F_WRITE, RSV(ec_ioc_sc_timeout, reserved)),
	IOC(EC_IOC_ACTIVATE, ec_ioc_activate, F_WRITE),
	IOC(EC_IOC_DEACTIVATE, ec_ioc_deactivate, F_WRITE),
	IOC(EC_IOC_DOMAIN_OFFSET, ec_ioc_domain_offset, F_WRITE),
	IOC(EC_IOC_INTERVAL, ec_ioc_interval, F_WRITE),
	IOC(EC_IOC_APP_TIME, ec_ioc_app_time, F_WRITE, RSV(ec_ioc_app_time, reserved)),
	IOC(EC_IOC_REF_CLOCK, ec_ioc_ref_clock, F_WRITE),
	IOC(EC_IOC_SC_REQUEST, ec_ioc_sc_request, F_WRITE, RSV(ec_ioc_sc_request, reserved)),
	IOC(EC_IOC_SC_EMERG, ec_ioc_sc_emerg, F_WRITE, RSV(ec_ioc_sc_emerg, reserved)),
	IOC(EC_IOC_CONFIG_IP, ec_ioc_config_ip, 0, RSV(ec_ioc_sc_ip, params.reserved)),
	IOC(EC_IOC_CONFIG_WHY, ec_ioc_config_why, 0, RSV(ec_ioc_config_why, reserved)),
	IOC(EC_IOC_SLAVES_DOWN, ec_ioc_slaves_down, F_WRITE),
	IOC(EC_IOC_IP_GET, ec_ioc_ip_get, F_WRITE, RSV(ec_ioc_ip, params.reserved)),
	IOC(EC_IOC_IP_SET, ec_ioc_ip_set, F_WRITE, RSV(ec_ioc_ip, params.reserved)),
	IOC(EC_IOC_SC_IP, ec_ioc_sc_ip, F_WRITE, RSV(ec_ioc_sc_ip, params.reserved)),
	IOC(EC_IOC_CYCLE, ec_ioc_cycle, F_WRITE),
	IOC(EC_IOC_WAIT, ec_ioc_wait, F_WRITE),
	IOC(EC_IOC_SC_OVERLAP, ec_ioc_sc_overlap, F_WRITE, RSV(ec_ioc_sc_overlap, reserved)),
	IOC(EC_IOC_LATE, ec_ioc_late, F_WRITE),
	IOC(EC_IOC_DOMAIN_AGE, ec_ioc_domain_age, F_WRITE, RSV(ec_ioc_domain_age, reserved)),
	IOC(EC_IOC_DOMAIN_OPTIONS, ec_ioc_domain_options, F_WRITE,
	    RSV(ec_ioc_domain_options, reserved)),
	IOC(EC_IOC_DIVISION, ec_ioc_division, F_WRITE),
	IOC(EC_IOC_COPY, ec_ioc_copy, F_WRITE),
};

/**
 * ec_refuse() - fail a command and keep the reason for EC_IOC_REASON
 * @f: open file
 * @err: -errno
 * @fmt: what was wrong and what to do
 *
 * Context: Process. May sleep.
 * Return: @err.
 */
int ec_refuse(struct ec_file *f, int err, const char *fmt, ...)
{
	va_list args;

	va_start(args, fmt);
	raw_spin_lock(&f->lock);
	vscnprintf(f->reason, sizeof(f->reason), fmt, args);
	raw_spin_unlock(&f->lock);
	va_end(args);
	return err;
}

/**
 * ec_ioc_limit() - refuse what is beyond the memory of a master's sessions
 * @f: open file
 * @ret: result so far
 *
 * Context: Process.
 * Return: -ENOMEM for -EDQUOT, with the reason noted; else @ret.
 */
int ec_ioc_limit(struct ec_file *f, int ret)
{
	if (ret != -EDQUOT)
		return ret;
	return ec_refuse(f, -ENOMEM, "limit of %u MiB for the sessions of master %u and their mapped memory reached; configure less, or unmap the memory of earlier activations",
			 EC_MAX_SESSION_BYTES >> 20, f->master->base->index);
}

/**
 * ec_ioc_fetch() - get a value from the process
 * @from: address in the process
 * @size: its bytes, checked
 * @data: out: the value, for kvfree()
 *
 * Context: Process, no lock held.
 * Return: 0, -ENOMEM or -EFAULT.
 */
int ec_ioc_fetch(u64 from, u32 size, u8 **data)
{
	*data = kvmalloc(size, GFP_KERNEL_ACCOUNT);
	if (!*data)
		return -ENOMEM;
	if (!copy_from_user(*data, u64_to_user_ptr(from), size))
		return 0;
	kvfree(*data);
	return -EFAULT;
}

/**
 * ec_ioc_hand_over() - give a result to the process and free it
 * @to: address in the process
 * @data: result, as for kvfree(); NULL when there is none
 * @size: its bytes
 * @ret: -errno when there is nothing to give, else 0
 *
 * Context: Process, session_lock not held: mmap() takes that with the memory of the
 * process locked. May sleep.
 * Return: @ret or -EFAULT.
 */
int ec_ioc_hand_over(u64 to, void *data, u32 size, int ret)
{
	if (!ret && data && copy_to_user(u64_to_user_ptr(to), data, size))
		ret = -EFAULT;
	kvfree(data);
	return ret;
}

/* Version request of the field's other master: old programs fail cleanly. */
static long foreign_version(unsigned long arg)
{
	u32 v[2] = { 0xec000001, 0 };

	return copy_to_user((void __user *)arg, v, sizeof(v)) ? -EFAULT : 0;
}

static long cyclic_send(struct ec_file *f, unsigned int cmd, unsigned long arg)
{
	struct ec_ioc_send send;

	if (_IOC_DIR(cmd) != _IOC_DIR(EC_IOC_SEND))
		return -ENOTTY;
	if (_IOC_SIZE(cmd) != sizeof(send))
		return -EINVAL;
	if (copy_from_user(&send, (void __user *)arg, sizeof(send)))
		return -EFAULT;
	if (send.flags & ~EC_SEND_FLAG_ALL || send.reserved)
		return -EOPNOTSUPP;
	return ec_ioc_send(f, &send);
}

/* Flags a command understands; its argument starts with them. */
static u32 known_flags(unsigned int cmd)
{
	switch (cmd) {
	case EC_IOC_SDO_UPLOAD:
	case EC_IOC_SDO_DOWNLOAD:
	case EC_IOC_SC_SDO:
	case EC_IOC_CONFIG_SDO:	/* an answer may be the next question */
		return EC_SDO_FLAG_COMPLETE;
	case EC_IOC_REG_READ:
	case EC_IOC_REG_WRITE:
		return EC_REG_FLAG_EMERGENCY;
	case EC_IOC_REG_ENTRY:
		return EC_REG_ENTRY_BY_POS | EC_REG_ENTRY_ALIGNED;
	case EC_IOC_CYCLE:
		return EC_CYCLE_FLAG_ALL;
	default:
		return 0;
	}
}

/* Is the caller allowed to, and is the size of the argument possible? */
static int check(struct ec_file *f, const struct ec_ioctl *op, unsigned int cmd)
{
	unsigned int size = _IOC_SIZE(cmd);

	if (size < op->min || size > (_IOC_DIR(cmd) ? MAX_ARG : 0))
		return ec_refuse(f, -EINVAL, "command 0x%08x has an argument of %u bytes, needs %u; build the program with the header of this module",
				 cmd, size, op->min);
	if (op->flags & F_WRITE && !f->writable)
		return ec_refuse(f, -EPERM, "the command needs /dev/EtherCAT opened for writing; get write permission (group ethercat)");
	return 0;
}

/* What this module does not know must not be asked for. */
static int check_unknown(struct ec_file *f, const struct ec_ioctl *op, const void *karg)
{
	u32 flags = *(const u32 *)karg & ~known_flags(op->cmd);
	unsigned int i;

	if (flags)
		return ec_refuse(f, -EOPNOTSUPP, "command 0x%08x: unknown flags 0x%x", op->cmd,
				 flags);
	for (i = 0; i < ARRAY_SIZE(op->reserved); i++) {
		const struct ec_reserved *r = &op->reserved[i];

		if (memchr_inv(karg + r->offset, 0, r->size))
			return ec_refuse(f, -EOPNOTSUPP, "command 0x%08x: reserved bytes at %u are not zero; a newer module may know them",
					 op->cmd, r->offset);
	}
	return 0;
}

static int fetch_arg(struct ec_file *f, const struct ec_ioctl *op, unsigned int cmd, void *karg,
		     void __user *uarg)
{
	int ret = copy_struct_from_user(karg, _IOC_SIZE(op->cmd), uarg, _IOC_SIZE(cmd));

	if (ret == -E2BIG)
		return ec_refuse(f, ret, "command 0x%08x: this module knows %u bytes of the argument, the rest must be zero",
				 cmd, _IOC_SIZE(op->cmd));
	return ret ?: check_unknown(f, op, karg);
}

/* An argument larger than this module knows ends with zeros. */
static int return_arg(unsigned int ksize, unsigned int usize, const void *karg, void __user *uarg)
{
	if (copy_to_user(uarg, karg, min(usize, ksize)))
		return -EFAULT;
	return usize > ksize && clear_user(uarg + ksize, usize - ksize) ? -EFAULT : 0;
}

static void forget_reason(struct ec_file *f)
{
	raw_spin_lock(&f->lock);
	f->reason[0] = '\0';
	raw_spin_unlock(&f->lock);
}

/* Apart from the cyclic commands, which must not pay for the large buffer. */
static noinline long dispatch(struct ec_file *f, unsigned int cmd, unsigned long arg)
{
	unsigned int nr = _IOC_NR(cmd);
	void __user *uarg = (void __user *)arg;
	u64 karg[MAX_ARG / sizeof(u64)];
	const struct ec_ioctl *op;
	int ret;

	if (cmd == _IOR(0xa4, 0, u64))
		return foreign_version(arg);
	if (_IOC_TYPE(cmd) != EC_IOC_TYPE || nr >= ARRAY_SIZE(table))
		return -ENOTTY;
	op = &table[array_index_nospec(nr, ARRAY_SIZE(table))];
	if (!op->fn || _IOC_DIR(cmd) != _IOC_DIR(op->cmd))
		return -ENOTTY;
	/* a failure without text must not show the one before */
	if (op->fn != ec_ioc_reason)
		forget_reason(f);
	ret = check(f, op, cmd);
	if (ret)
		return ret;

	memset(karg, 0, _IOC_SIZE(op->cmd));
	if (_IOC_DIR(cmd) & _IOC_WRITE) {
		ret = fetch_arg(f, op, cmd, karg, uarg);
		if (ret)
			return ret;
	}
	ret = op->fn(f, karg);
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
 * flags and reserved bytes, -EINVAL for a size that cannot be, -E2BIG for a
 * non-zero tail, -EPERM, -EFAULT.
 */
long ec_ioctl(struct file *filp, unsigned int cmd, unsigned long arg)
{
	struct ec_file *f = filp->private_data;

	if (cmd == EC_IOC_RECEIVE)
		return ec_ioc_receive(f);
	if (_IOC_TYPE(cmd) == EC_IOC_TYPE && _IOC_NR(cmd) == _IOC_NR(EC_IOC_SEND))
		return cyclic_send(f, cmd, arg);
	return dispatch(f, cmd, arg);
}
