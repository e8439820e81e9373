// SPDX-License-Identifier: GPL-2.0-only
/*
 * ec_sim.ko: segment=<built-in name or path of a description>, as the virtual
 * device sim0, or with netdev=<name>[,<name>] answering at network devices.
 */
#include <linux/err.h>
#include <linux/kernel_read_file.h>
#include <linux/module.h>
#include <linux/string.h>
#include <linux/vmalloc.h>
#include "describe.h"
#include "sim_link.h"
#include "sim_responder.h"
#include "sim_wire.h"

static char *segment = "bench";
module_param(segment, charp, 0444);
MODULE_PARM_DESC(segment, "built-in segment (thin, three, bench, line100, line1000) or path of a description");

static char *netdev[EC_SIM_PORTS];
static unsigned int n_netdev;
module_param_array(netdev, charp, &n_netdev, 0444);
MODULE_PARM_DESC(netdev, "network device to answer at instead of offering sim0; a second one for the other end of a ring");

static struct ec_sim_link *sim_link;
static struct ec_sim_responder *responder;

static int load(void *ctx, const char *name, u8 *buf, size_t cap)
{
	void *p = buf;
	ssize_t n = kernel_read_file_from_path(name, 0, &p, cap, NULL, READING_UNKNOWN);

	return (int)n;
}

static struct ec_sim *describe(const char *text, size_t len)
{
	static const struct ec_sim_loader loader = { .load = load };
	struct ec_sim_error err = { 0 };
	struct ec_sim *sim;
	int ret = ec_sim_describe(&sim, &ec_sim_kernel_ops, text, len, &loader, &err);

	if (ret) {
		pr_err("ec_sim: %s:%u: %s\n", segment, err.line, err.text);
		return ERR_PTR(ret);
	}
	return sim;
}

static struct ec_sim *build(void)
{
	const char *text = ec_sim_builtin(segment);
	struct ec_sim *sim;
	void *buf = NULL;
	ssize_t n;

	if (text)
		return describe(text, strlen(text));
	n = kernel_read_file_from_path(segment, 0, &buf, 1 << 20, NULL, READING_UNKNOWN);
	if (n < 0) {
		pr_err("ec_sim: segment=%s is no built-in segment and cannot be read (error %zd)\n",
		       segment, n);
		return ERR_PTR(n);
	}
	sim = describe(buf, n);
	vfree(buf);
	return sim;
}

static int __init sim_init(void)
{
	static const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x51, 0x00 };
	struct ec_sim *sim = build();
	int ret;

	if (IS_ERR(sim))
		return PTR_ERR(sim);
	if (n_netdev) {
		responder = ec_sim_responder_create(netdev, n_netdev, sim);
		ret = PTR_ERR_OR_ZERO(responder);
	} else {
		sim_link = ec_sim_link_create("sim0", mac, sim, ktime_get_ns());
		ret = PTR_ERR_OR_ZERO(sim_link);
	}
	if (ret)
		ec_sim_free(sim);
	return ret;
}

static void __exit sim_exit(void)
{
	if (n_netdev)
		ec_sim_responder_destroy(responder);
	else
		ec_sim_link_destroy(sim_link);
}

module_init(sim_init);
module_exit(sim_exit);

MODULE_DESCRIPTION("EtherCAT master: simulated segment");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
