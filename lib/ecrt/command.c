// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Commands of the functions for applications. */
#include "ecrt_int.h"

/**
 * ec_give() - execute a command for ec_do()
 * @m: master, or NULL
 * @cmd: EC_IOC_*
 * @arg: its argument
 *
 * Return: as the command; -EINVAL without a master, or when the slave is absent: a
 * command returns -ENOENT then, as EC_IOC_SLAVE does in the kernel.
 */
int ec_give(const ec_master_t *m, unsigned int cmd, void *arg)
{
	int ret = m ? ec_command(m, cmd, arg) : -EINVAL;

	if (ret != -ENOENT)
		return ret;
	switch (cmd) {
	case EC_IOC_SLAVE:
		return EC_NO_SLAVE;
	case EC_IOC_DEVICE:
	case EC_IOC_SM:
	case EC_IOC_PDO:
	case EC_IOC_PDO_ENTRY:
	case EC_IOC_SDO_UPLOAD:
	case EC_IOC_SDO_DOWNLOAD:
	case EC_IOC_SDO_INFO:
	case EC_IOC_SOE_READ:
	case EC_IOC_SOE_WRITE:
	case EC_IOC_FOE_READ:
	case EC_IOC_FOE_WRITE:
	case EC_IOC_SII:
	case EC_IOC_SII_WRITE:
	case EC_IOC_ALIAS:
		return -EINVAL;
	default:
		return ret;
	}
}
