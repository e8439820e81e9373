// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Commands, and the one line that says why a call failed. */
#include "ecrt_int.h"

/**
 * ec_fail() - say that a call failed without a command
 * @m: master
 * @err: -errno
 * @fmt: what was tried, an infinitive without "to"
 *
 * Return: @err.
 */
int ec_fail(const ec_master_t *m, int err, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	ec_complain(m, NULL, err, false, fmt, ap);
	va_end(ap);
	return err;
}

/* The same for a slave configuration, which the line names at its end. */
int ec_fail_sc(const ec_slave_config_t *sc, int err, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	ec_complain(ec_sc_master(sc), sc, err, false, fmt, ap);
	va_end(ap);
	return err;
}

/* A command says -ENOENT for a slave that is not there, this interface -EINVAL. */
static int give(const ec_master_t *m, unsigned int cmd, void *arg)
{
	int ret = ec_command(m, cmd, arg);

	if (ret != -ENOENT)
		return ret;
	switch (cmd) {
	case EC_IOC_SLAVE:
	case EC_IOC_SM:
	case EC_IOC_PDO:
	case EC_IOC_PDO_ENTRY:
	case EC_IOC_SDO_UPLOAD:
	case EC_IOC_SDO_DOWNLOAD:
	case EC_IOC_SOE_READ:
	case EC_IOC_SOE_WRITE:
		return -EINVAL;
	default:
		return ret;
	}
}

/**
 * ec_do() - give a command; say why it failed, with the reason that it left
 * @m: master
 * @cmd: EC_IOC_*
 * @arg: its argument
 * @fmt: what is tried, an infinitive without "to"
 *
 * Return: as the command; -EINVAL without a master, or when the slave is not there.
 */
int ec_do(const ec_master_t *m, unsigned int cmd, void *arg, const char *fmt, ...)
{
	va_list ap;
	int ret;

	if (!m)
		return -EINVAL;
	ret = give(m, cmd, arg);
	if (!ret)
		return 0;
	va_start(ap, fmt);
	ec_complain(m, NULL, ret, true, fmt, ap);
	va_end(ap);
	return ret;
}

/* The same for a slave configuration, which the line names at its end. */
int ec_do_sc(const ec_slave_config_t *sc, unsigned int cmd, void *arg, const char *fmt, ...)
{
	va_list ap;
	int ret;

	if (!sc)
		return -EINVAL;
	ret = ec_command(ec_sc_master(sc), cmd, arg);
	if (!ret)
		return 0;
	va_start(ap, fmt);
	ec_complain(ec_sc_master(sc), sc, ret, true, fmt, ap);
	va_end(ap);
	return ret;
}

/* Size of a buffer in a command; one that is too large stays too large. */
__u32 ec_u32(size_t size)
{
	return size > EC_U32_MAX ? EC_U32_MAX : (__u32)size;
}
