// SPDX-License-Identifier: GPL-2.0-only
/* Dispatch of /dev/EtherCAT<n>: permissions, sizes and copies in one place. */
#include <linux/mm.h>
#include <linux/nospec.h>
#include <linux/uaccess.h>
#include "call.h"
#include "../base/limits.h"

#define MAX_ARG	896	/* on the stack, where a kernel of 32 bits wants at most 1024 in all */

#define F_WRITE	1	/* needs a descriptor opened for writing */

#define FIELD(type, field) { offsetof(struct type, field), sizeof_field(struct type, field) }
#define RSV(...) .reserved = { __VA_ARGS__ }
#define RSV1(type) RSV(FIELD(type, reserved))
#define RSV2(type) RSV(FIELD(type, reserved), FIELD(type, reserved2))
#define SLAVE(type) .class = EC_CLASS_SLAVE, .at = offsetof(struct type, position) + \
	BUILD_BUG_ON_ZERO(sizeof_field(struct type, position) != sizeof(u16))
#define INDEX(c, type, field) .class = (c), .at = offsetof(struct type, field) + \
	BUILD_BUG_ON_ZERO(sizeof_field(struct type, field) != sizeof(u32))
#define CONFIG(type) INDEX(EC_CLASS_CONFIG, type, config)
#define DOMAIN(type) INDEX(EC_CLASS_DOMAIN, type, domain)
#define SHOW_CONFIG(type) INDEX(EC_CLASS_SHOW_CONFIG, type, index)
#define SHOW_DOMAIN(type) INDEX(EC_CLASS_SHOW_DOMAIN, type, index)
#define SESSION .class = EC_CLASS_SESSION
#define IDLE .class = EC_CLASS_IDLE
#define BUFFER(type, d, s, m, o) .buffer = { .address = offsetof(struct type, d), \
	.size = offsetof(struct type, s), .most = (m), .out = (o) }
#define IN(type, most) BUFFER(type, data, size, most, false)
#define OUT(type, most) BUFFER(type, data, size, most, true)
#define IOC_MIN(c, f, fl, m, ...) [_IOC_NR(c)] = { .cmd = (c), .fn = (f), .flags = (fl) + \
	BUILD_BUG_ON_ZERO(_IOC_SIZE(c) > MAX_ARG), .min = (m), ##__VA_ARGS__ }
#define IOC(c, f, fl, ...) IOC_MIN(c, f, fl, _IOC_SIZE(c), ##__VA_ARGS__)

static const struct ec_ioctl table[] = {
	IOC(EC_IOC_VERSION, ec_ioc_version, 0),
	IOC(EC_IOC_REASON, ec_ioc_reason, 0),
	IOC_MIN(EC_IOC_MASTER, ec_ioc_master, 0, offsetofend(struct ec_ioc_master, not_captured)),
	IOC_MIN(EC_IOC_SLAVE, ec_ioc_slave, 0, offsetofend(struct ec_ioc_slave, dc_odd),
		SLAVE(ec_ioc_slave)),
	IOC(EC_IOC_SM, ec_ioc_sm, 0, SLAVE(ec_ioc_sm), RSV1(ec_ioc_sm)),
	IOC(EC_IOC_PDO, ec_ioc_pdo, 0, SLAVE(ec_ioc_pdo), RSV2(ec_ioc_pdo)),
	IOC(EC_IOC_PDO_ENTRY, ec_ioc_pdo_entry, 0, SLAVE(ec_ioc_pdo_entry),
	    RSV1(ec_ioc_pdo_entry)),
	IOC(EC_IOC_SII, ec_ioc_sii, 0, SLAVE(ec_ioc_sii), OUT(ec_ioc_sii, EC_MAX_SII_BYTES),
	    RSV1(ec_ioc_sii)),
	IOC(EC_IOC_CONFIG, ec_ioc_config, 0, SHOW_CONFIG(ec_ioc_config)),
	IOC(EC_IOC_CONFIG_SM, ec_ioc_config_sm, 0, SHOW_CONFIG(ec_ioc_config_sm),
	    RSV1(ec_ioc_config_sm)),
	IOC(EC_IOC_CONFIG_PDO, ec_ioc_config_pdo, 0, SHOW_CONFIG(ec_ioc_config_pdo),
	    RSV1(ec_ioc_config_pdo)),
	IOC(EC_IOC_CONFIG_ENTRY, ec_ioc_config_entry, 0, SHOW_CONFIG(ec_ioc_config_entry),
	    RSV1(ec_ioc_config_entry)),
	IOC(EC_IOC_CONFIG_SDO, ec_ioc_config_sdo, 0, SHOW_CONFIG(ec_ioc_config_sdo),
	    OUT(ec_ioc_config_sdo, EC_MAX_SDO_SIZE), RSV2(ec_ioc_config_sdo)),
	IOC(EC_IOC_CONFIG_IDN, ec_ioc_config_idn, 0, SHOW_CONFIG(ec_ioc_config_idn),
	    OUT(ec_ioc_config_idn, EC_MAX_SOE_SIZE), RSV1(ec_ioc_config_idn)),
	IOC(EC_IOC_CONFIG_FLAG, ec_ioc_config_flag, 0, SHOW_CONFIG(ec_ioc_config_flag)),
	IOC(EC_IOC_CONFIG_WHY, ec_ioc_config_why, 0, SHOW_CONFIG(ec_ioc_config_why),
	    RSV1(ec_ioc_config_why)),
	IOC(EC_IOC_CONFIG_IP, ec_ioc_config_ip, 0,
	    INDEX(EC_CLASS_SHOW_CONFIG, ec_ioc_sc_ip, config),
	    RSV(FIELD(ec_ioc_sc_ip, params.reserved))),
	IOC(EC_IOC_DOMAIN, ec_ioc_domain, 0, SHOW_DOMAIN(ec_ioc_domain)),
	IOC(EC_IOC_DOMAIN_FMMU, ec_ioc_domain_fmmu, 0, SHOW_DOMAIN(ec_ioc_domain_fmmu),
	    RSV1(ec_ioc_domain_fmmu)),
	IOC(EC_IOC_DOMAIN_DATA, ec_ioc_domain_data, 0, SHOW_DOMAIN(ec_ioc_domain_data),
	    OUT(ec_ioc_domain_data, EC_MAX_IMAGE), RSV1(ec_ioc_domain_data)),
	IOC(EC_IOC_CYCLE_STATS, ec_ioc_cycle_stats, 0,
	    OUT(ec_ioc_cycle_stats, sizeof(struct ec_status_cycle))),
	IOC(EC_IOC_SDO_UPLOAD, ec_ioc_sdo_upload, F_WRITE, SLAVE(ec_ioc_sdo),
	    OUT(ec_ioc_sdo, EC_MAX_SDO_SIZE), RSV1(ec_ioc_sdo)),
	IOC(EC_IOC_SDO_DOWNLOAD, ec_ioc_sdo_download, F_WRITE, SLAVE(ec_ioc_sdo),
	    IN(ec_ioc_sdo, EC_MAX_SDO_SIZE), RSV1(ec_ioc_sdo)),
	IOC(EC_IOC_REG_READ, ec_ioc_reg_read, F_WRITE, OUT(ec_ioc_reg, EC_MAX_REG_SIZE),
	    RSV1(ec_ioc_reg)),
	IOC(EC_IOC_REG_WRITE, ec_ioc_reg_write, F_WRITE, IN(ec_ioc_reg, EC_MAX_REG_SIZE),
	    RSV1(ec_ioc_reg)),
	IOC(EC_IOC_SOE_READ, ec_ioc_soe_read, F_WRITE, SLAVE(ec_ioc_soe),
	    OUT(ec_ioc_soe, EC_MAX_SOE_SIZE), RSV1(ec_ioc_soe)),
	IOC(EC_IOC_SOE_WRITE, ec_ioc_soe_write, F_WRITE, SLAVE(ec_ioc_soe),
	    IN(ec_ioc_soe, EC_MAX_SOE_SIZE), RSV1(ec_ioc_soe)),
	IOC(EC_IOC_STATE, ec_ioc_state, F_WRITE, SLAVE(ec_ioc_state), RSV1(ec_ioc_state)),
	IOC(EC_IOC_IP_GET, ec_ioc_ip_get, F_WRITE, SLAVE(ec_ioc_ip),
	    RSV(FIELD(ec_ioc_ip, params.reserved))),
	IOC(EC_IOC_IP_SET, ec_ioc_ip_set, F_WRITE, SLAVE(ec_ioc_ip),
	    RSV(FIELD(ec_ioc_ip, params.reserved))),
	IOC(EC_IOC_RESCAN, ec_ioc_rescan, F_WRITE),
	IOC(EC_IOC_DEBUG, ec_ioc_debug, F_WRITE),
	IOC(EC_IOC_RESET, ec_ioc_reset, F_WRITE),
	IOC(EC_IOC_CYCLE_RESET, ec_ioc_cycle_reset, F_WRITE),
	IOC(EC_IOC_END_DETACHED, ec_ioc_end_detached, F_WRITE),
	IOC(EC_IOC_RESERVE, ec_ioc_reserve, F_WRITE),
	IOC(EC_IOC_RELEASE, ec_ioc_release, F_WRITE),
	IOC(EC_IOC_CREATE_DOMAIN, ec_ioc_create_domain, F_WRITE, IDLE),
	IOC(EC_IOC_SLAVE_CONFIG, ec_ioc_slave_config, F_WRITE),
	IOC(EC_IOC_SC_SYNC, ec_ioc_sc_sync, F_WRITE, CONFIG(ec_ioc_sc_sync),
	    RSV1(ec_ioc_sc_sync)),
	IOC(EC_IOC_SC_WATCHDOG, ec_ioc_sc_watchdog, F_WRITE, CONFIG(ec_ioc_sc_watchdog)),
	IOC(EC_IOC_SC_PDO, ec_ioc_sc_pdo, F_WRITE, CONFIG(ec_ioc_sc_pdo)),
	IOC(EC_IOC_SC_SDO, ec_ioc_sc_sdo, F_WRITE, CONFIG(ec_ioc_sc_sdo),
	    IN(ec_ioc_sc_sdo, EC_MAX_SDO_SIZE), RSV1(ec_ioc_sc_sdo)),
	IOC(EC_IOC_SC_IDN, ec_ioc_sc_idn, F_WRITE, CONFIG(ec_ioc_sc_idn),
	    IN(ec_ioc_sc_idn, EC_MAX_SOE_SIZE)),
	IOC(EC_IOC_REG_ENTRY, ec_ioc_reg_entry, F_WRITE, CONFIG(ec_ioc_reg_entry)),
	IOC(EC_IOC_SC_DC, ec_ioc_sc_dc, F_WRITE, CONFIG(ec_ioc_sc_dc), RSV2(ec_ioc_sc_dc)),
	IOC(EC_IOC_SC_FLAG, ec_ioc_sc_flag, F_WRITE, CONFIG(ec_ioc_sc_flag),
	    RSV1(ec_ioc_sc_flag)),
	IOC(EC_IOC_SC_TIMEOUT, ec_ioc_sc_timeout, F_WRITE, CONFIG(ec_ioc_sc_timeout),
	    RSV1(ec_ioc_sc_timeout)),
	IOC(EC_IOC_SC_REQUEST, ec_ioc_sc_request, F_WRITE, CONFIG(ec_ioc_sc_request),
	    RSV1(ec_ioc_sc_request)),
	IOC(EC_IOC_SC_EMERG, ec_ioc_sc_emerg, F_WRITE, CONFIG(ec_ioc_sc_emerg),
	    RSV1(ec_ioc_sc_emerg)),
	IOC(EC_IOC_SC_IP, ec_ioc_sc_ip, F_WRITE, CONFIG(ec_ioc_sc_ip),
	    RSV(FIELD(ec_ioc_sc_ip, params.reserved))),
	IOC(EC_IOC_SC_OVERLAP, ec_ioc_sc_overlap, F_WRITE, CONFIG(ec_ioc_sc_overlap),
	    RSV1(ec_ioc_sc_overlap)),
	IOC(EC_IOC_ACTIVATE, ec_ioc_activate, F_WRITE, SESSION,
	    BUFFER(ec_ioc_activate, preset, preset_size, EC_MAX_IMAGE, false)),
	IOC(EC_IOC_DEACTIVATE, ec_ioc_deactivate, F_WRITE, SESSION),
	IOC(EC_IOC_SLAVES_DOWN, ec_ioc_slaves_down, F_WRITE, SESSION),
	IOC(EC_IOC_DOMAIN_OFFSET, ec_ioc_domain_offset, F_WRITE, SESSION),
	IOC(EC_IOC_INTERVAL, ec_ioc_interval, F_WRITE, IDLE),
	IOC(EC_IOC_APP_TIME, ec_ioc_app_time, F_WRITE, RSV1(ec_ioc_app_time)),
	IOC(EC_IOC_REF_CLOCK, ec_ioc_ref_clock, F_WRITE, IDLE),
	IOC(EC_IOC_CYCLE, ec_ioc_cycle, F_WRITE, IDLE),
	IOC(EC_IOC_WAIT, ec_ioc_wait, F_WRITE),
	IOC(EC_IOC_LATE, ec_ioc_late, F_WRITE, IDLE),
	IOC(EC_IOC_DOMAIN_AGE, ec_ioc_domain_age, F_WRITE, DOMAIN(ec_ioc_domain_age),
	    RSV1(ec_ioc_domain_age)),
	IOC(EC_IOC_DOMAIN_OPTIONS, ec_ioc_domain_options, F_WRITE,
	    DOMAIN(ec_ioc_domain_options), RSV1(ec_ioc_domain_options)),
	IOC(EC_IOC_DIVISION, ec_ioc_division, F_WRITE, DOMAIN(ec_ioc_division)),
	IOC(EC_IOC_COPY, ec_ioc_copy, F_WRITE, IDLE),
};

/**
 * ec_ioc() - give a command from within the kernel
 * @f: file that stands for the application
 * @cmd: EC_IOC_*
 * @arg: its argument; addresses in it are the kernel's
 *
 * Context: Process. As the command.
 * Return: as the command.
 */
int ec_ioc(struct ec_file *f, unsigned int cmd, void *arg)
{
	/* reading the reason must not clear it */
	if (cmd != EC_IOC_REASON)
		ec_call_forget_reason(f);
	return ec_call_run(f, &table[_IOC_NR(cmd)], arg, false);
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
static int check(struct ec_call *call, const struct ec_ioctl *op, unsigned int cmd)
{
	unsigned int size = _IOC_SIZE(cmd);

	if (size < op->min || size > (_IOC_DIR(cmd) ? MAX_ARG : 0))
		return ec_refuse(call, -EINVAL,
				 "command 0x%08x has an argument of %u bytes, needs %u; build the program with the header of this module",
				 cmd, size, op->min);
	if (op->flags & F_WRITE && !call->file->writable)
		return ec_refuse(call, -EPERM,
				 "the command needs /dev/EtherCAT opened for writing; get write permission (group ethercat)");
	return 0;
}

/* What this module does not know must not be asked for. */
static int check_unknown(struct ec_call *call, const struct ec_ioctl *op, const void *karg)
{
	u32 flags = *(const u32 *)karg & ~known_flags(op->cmd);
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
	if (_IOC_TYPE(cmd) != EC_IOC_TYPE || nr >= ARRAY_SIZE(table))
		return -ENOTTY;
	op = &table[array_index_nospec(nr, ARRAY_SIZE(table))];
	if (!op->fn || _IOC_DIR(cmd) != _IOC_DIR(op->cmd))
		return -ENOTTY;
	/* a failure without text must not show the one before */
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
