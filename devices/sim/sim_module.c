// SPDX-License-Identifier: GPL-2.0-only
/*
 * ec_sim.ko: segment=<built-in name or path of a description>[,<another>], as the
 * virtual devices sim0, sim1... (the other end of a ring: sim0b...), or one segment with
 * netdev=<name>[,<name>] answering at network devices.
 */
#include <linux/err.h>
#include <linux/file.h>
#include <linux/fs.h>
#include <linux/module.h>
#include <linux/string.h>
#include <linux/vmalloc.h>
#include "devices/ecdev.h"
#include "describe.h"
#include "sim_control.h"
#include "sim_link.h"
#include "sim_port.h"
#include "sim_responder.h"
#include "sim_wire.h"

#define SEGMENTS	8
#define TEXT_MAX	(1 << 20)	/* of a description */

static char *segment[SEGMENTS] = { "bench" };
static unsigned int n_segment;
module_param_array(segment, charp, &n_segment, 0444);
MODULE_PARM_DESC(segment, "built-in segments (thin, three, bench, eoe, line100, line1000) or paths of descriptions: sim0, sim1...");

static char *netdev[EC_SIM_PORTS];
static unsigned int n_netdev;
module_param_array(netdev, charp, &n_netdev, 0444);
MODULE_PARM_DESC(netdev, "network device to answer at instead of offering sim0; a second one for the other end of a ring");

static struct ec_sim_link *sim_link[SEGMENTS];
static struct ec_sim_responder *responder;

/*
 * kernel_read_file() would want to know which of its own purposes this is for; security
 * modules warn when it is none of them.
 */
static int load(void *ctx, const char *name, u8 *buf, size_t cap)
{
	struct file *f = filp_open(name, O_RDONLY, 0);
	ssize_t n = 0, got = 0;
	loff_t pos = 0;
	u8 more;

	if (IS_ERR(f))
		return PTR_ERR(f);
	if (!S_ISREG(file_inode(f)->i_mode)) {
		n = -EINVAL;
		goto out;
	}
	for (; got < cap; got += n) {
		n = kernel_read(f, buf + got, cap - got, &pos);
		if (n <= 0)
			goto out;
	}
	n = kernel_read(f, &more, 1, &pos);
	if (n > 0)
		n = -EFBIG;
out:
	fput(f);
	return n < 0 ? n : got;
}

static struct ec_sim *describe(const char *name, const char *text, size_t len)
{
	static const struct ec_sim_loader loader = { .load = load };
	struct ec_sim_error err = { 0 };
	struct ec_sim *sim;
	int ret = ec_sim_describe(&sim, &ec_sim_kernel_ops, text, len, &loader, &err);

	if (ret) {
		pr_err("ec_sim: %s:%u: %s\n", name, err.line, err.text);
		return ERR_PTR(ret);
	}
	return sim;
}

static struct ec_sim *build(const char *name)
{
	const char *text = ec_sim_builtin(name);
	struct ec_sim *sim;
	void *buf;
	int n;

	if (text)
		return describe(name, text, strlen(text));
	buf = vmalloc(TEXT_MAX);
	if (!buf)
		return ERR_PTR(-ENOMEM);
	n = load(NULL, name, buf, TEXT_MAX);
	if (n < 0) {
		pr_err("ec_sim: segment=%s: neither a built-in segment (thin, three, bench, eoe, line100, line1000) nor a readable file (%pe)\n",
		       name, ERR_PTR(n));
		/* insmod calls ENOENT an unknown symbol */
		sim = ERR_PTR(n == -ENOENT ? -EINVAL : n);
	} else {
		sim = describe(name, buf, n);
	}
	vfree(buf);
	return sim;
}

/* Segment @i as a virtual device. */
static int offer(unsigned int i)
{
	const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x51, i };
	const u8 second[6] = { 0x02, 0x00, 0x00, 0xec, 0x52, i };
	struct ec_sim *sim = build(segment[i]);
	struct ec_sim_link *l;
	char name[8];

	if (IS_ERR(sim))
		return PTR_ERR(sim);
	snprintf(name, sizeof(name), "sim%u", i);
	l = ec_sim_link_create(name, mac, sim, ktime_get_ns());
	if (IS_ERR(l)) {
		ec_sim_free(sim);
		return PTR_ERR(l);
	}
	sim_link[i] = l;
	if (!ec_sim_is_ring(sim))
		return 0;
	snprintf(name, sizeof(name), "sim%ub", i);
	return ec_sim_link_second(l, name, second);
}

static int respond(void)
{
	struct ec_sim *sim;

	if (n_segment > 1) {
		pr_err("ec_sim: netdev= needs one segment, segment= has %u\n", n_segment);
		return -EINVAL;
	}
	sim = build(segment[0]);
	if (IS_ERR(sim))
		return PTR_ERR(sim);
	responder = ec_sim_responder_create(netdev, n_netdev, sim);
	if (!IS_ERR(responder))
		return 0;
	ec_sim_free(sim);
	return PTR_ERR(responder);
}

static void withdraw(void)
{
	unsigned int i;

	for (i = 0; i < SEGMENTS; i++)
		if (sim_link[i])
			ec_sim_link_destroy(sim_link[i]);
}

/* Ethernet ports of switches. Without a network device their frames are lost. */
static void __init add_ports(const char *name, struct ec_sim_wire *w)
{
	u32 n = ec_sim_count(w->sim), i;
	int ret;

	for (i = 0; i < n; i++) {
		ret = ec_sim_port_add(name, w, i);
		if (ret)
			pr_warn("ec_sim: %s: no network device for the Ethernet port of slave %u (%pe)\n",
				name, i, ERR_PTR(ret));
	}
}

/*
 * Last: an open file of a module whose load fails would outlive it, as debugfs keeps the pointer
 * to its functions.
 */
static void __init add_controls(void)
{
	char name[8];
	unsigned int i;

	ec_sim_control_init();
	if (n_netdev) {
		ec_sim_control_add(netdev[0], ec_sim_responder_wire(responder));
		add_ports(netdev[0], ec_sim_responder_wire(responder));
	}
	for (i = 0; i < SEGMENTS && sim_link[i]; i++) {
		snprintf(name, sizeof(name), "sim%u", i);
		ec_sim_control_add(name, ec_sim_link_wire(sim_link[i]));
		add_ports(name, ec_sim_link_wire(sim_link[i]));
	}
}

/* sim7 is never offered when there is one segment, and sim0b when this is no ring. */
static void __init report_waiting(unsigned int n)
{
	const char *list;
	unsigned int i = 0, master, k;
	char spec[32], b = '\0';
	bool backup;

	while (ecdev_waiting(&i, &master, spec, sizeof(spec), &backup)) {
		list = backup ? "backup_devices" : "main_devices";
		if (sscanf(spec, "sim%u%c", &k, &b) < 1)
			continue;
		if (k >= n)
			pr_warn("ec_sim: %s: \"%s\" is not offered, segment= names %u segment(s); master %u waits for it\n",
				list, spec, n, master);
		else if (b == 'b')
			pr_warn("ec_sim: %s: \"%s\" is not offered, that segment has no wire to master.1; master %u waits for it\n",
				list, spec, master);
	}
}

static int __init sim_init(void)
{
	unsigned int i, n = max(n_segment, 1u);
	int ret = 0;

	if (n_netdev)
		ret = respond();
	for (i = 0; i < n && !n_netdev && !ret; i++)
		ret = offer(i);
	if (ret) {
		withdraw();
		return ret;
	}
	add_controls();
	if (!n_netdev)
		report_waiting(n);
	return 0;
}

static void __exit sim_exit(void)
{
	ec_sim_port_exit();
	ec_sim_control_exit();
	if (n_netdev)
		ec_sim_responder_destroy(responder);
	else
		withdraw();
}

module_init(sim_init);
module_exit(sim_exit);

MODULE_DESCRIPTION("EtherCAT master: simulated segment");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
