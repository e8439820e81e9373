// SPDX-License-Identifier: GPL-2.0-only
#include <linux/module.h>
#include "boundary/cdev.h"
#include "base/limits.h"
#include "boundary/master.h"
#include "monitor.h"
#include "power.h"

static char *main_devices[EC_MAX_MASTERS];
static unsigned int n_main;
module_param_array(main_devices, charp, &n_main, 0444);
MODULE_PARM_DESC(main_devices,
		 "main device of each master: MAC address (ff:ff:ff:ff:ff:ff: the first device), interface name or sim0");

static char *backup_devices[EC_MAX_MASTERS];
static unsigned int n_backup;
module_param_array(backup_devices, charp, &n_backup, 0444);
MODULE_PARM_DESC(backup_devices, "backup device of each master, at the other end of a ring; \"\": none");

static unsigned int debug_level;
module_param(debug_level, uint, 0444);
MODULE_PARM_DESC(debug_level, "0 quiet, 1 more, 2 every frame");

static bool eoe = true;
module_param(eoe, bool, 0444);
MODULE_PARM_DESC(eoe, "each slave with EoE has a network device (default: yes)");

static int __init ec_init(void)
{
	int ret = ec_cdev_init();

	if (ret)
		return ret;
	ret = ec_masters_create(main_devices, n_main, backup_devices, n_backup, debug_level);
	if (ret)
		goto err_cdev;
	ret = ec_power_init();
	if (ret)
		goto err_masters;
	/* the last step, see there */
	ret = ec_cdev_publish(eoe);
	if (ret)
		goto err_power;
	if (!n_main)
		pr_warn("EtherCAT: no master: load ec_master with main_devices=MAC, interface or sim0\n");
	return 0;

err_power:
	ec_power_exit();
err_masters:
	ec_masters_destroy();
err_cdev:
	ec_cdev_exit();
	return ret;
}

static void __exit ec_exit(void)
{
	ec_cdev_unpublish();
	ec_power_exit();
	ec_masters_destroy();
	ec_cdev_exit();
}

module_init(ec_init);
module_exit(ec_exit);

MODULE_DESCRIPTION("EtherCAT master");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
