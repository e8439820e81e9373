// SPDX-License-Identifier: GPL-2.0-only
/* Network devices of slaves with EoE: show them, make and remove them, join them by a bridge. */
#include <errno.h>
#include <string.h>

#include "bridge.h"
#include "dev.h"
#include "out.h"

static const char *bridge_name;

static const char *state_of(const struct ect_eoe *e)
{
	if (!e->up)
		return "down";
	return e->running ? "up" : e->connected ? "wait" : "lost";
}

static void show(const struct ect_eoe *e)
{
	out_object(NULL);
	if (*e->name)
		out_str("interface", e->name, "  %9s", e->name);
	else
		out_null("interface", "  %9s", "-");
	out_u("position", e->position, "  %5u", e->position);
	out_u("device", e->device, NULL);
	out_str("state", state_of(e), "  %5s", state_of(e));
	out_u("rx_bytes", e->rx_bytes, "  %7llu", (unsigned long long)e->rx_bytes);
	out_u("rx_bytes_per_s", e->rx_rate, "  %6u", e->rx_rate);
	out_u("tx_bytes", e->tx_bytes, "  %7llu", (unsigned long long)e->tx_bytes);
	out_u("tx_bytes_per_s", e->tx_rate, "  %6u", e->tx_rate);
	out_u("tx_waiting", e->waiting, "  %4u", e->waiting);
	out_u("tx_room", e->room, "/%u\n", e->room);
	out_u("rx_frames", e->rx_frames, NULL);
	out_u("rx_errors", e->rx_errors, NULL);
	out_u("rx_missed", e->rx_missed, NULL);
	out_u("rx_dropped", e->rx_dropped, NULL);
	out_u("tx_frames", e->tx_frames, NULL);
	out_u("tx_lost", e->tx_lost, NULL);
	out_u("tx_dropped", e->tx_dropped, NULL);
	out_end();
}

static void show_more(const struct ect_eoe *e)
{
	const uint8_t *a = e->address;

	out_text("             %02x:%02x:%02x:%02x:%02x:%02x, device %llu\n", a[0], a[1], a[2],
		 a[3], a[4], a[5], (unsigned long long)e->device);
	out_text("             from the slave: %llu frames, %llu errors, %llu missed, %llu dropped\n",
		 (unsigned long long)e->rx_frames, (unsigned long long)e->rx_errors,
		 (unsigned long long)e->rx_missed, (unsigned long long)e->rx_dropped);
	out_text("             to the slave: %llu frames, %llu fragments lost, %llu dropped\n",
		 (unsigned long long)e->tx_frames, (unsigned long long)e->tx_lost,
		 (unsigned long long)e->tx_dropped);
}

/* What is done with each device of a master until there is no more. */
static int each_device(struct dev *d, int (*fn)(const struct ect_eoe *e, void *ctx), void *ctx)
{
	int err;

	for (unsigned int i = 0; ; i++) {
		struct ect_eoe e = { .struct_size = sizeof(e) };

		err = ect_eoe_read(d->h, i, &e);
		if (err == -ENOENT)
			return 0;
		if (err)
			return dev_fail(d, err, "Master%u: cannot read network device %u",
					d->master, i);
		err = fn(&e, ctx);
		if (err)
			return err;
	}
}

static int show_one(const struct ect_eoe *e, void *ctx)
{
	const struct tool *t = ctx;

	show(e);
	if (t->verbosity)
		show_more(e);
	return 0;
}

static int each(const struct tool *t, struct dev *d)
{
	int ret;

	out_object(NULL);
	out_u("master", d->master, "Master%u\n", d->master);
	out_text("  Interface  Slave  State  RxBytes  RxRate  TxBytes  TxRate  TxQueue\n");
	out_array("interfaces");
	ret = each_device(d, show_one, (void *)t);
	out_end();
	out_end();
	return ret;
}

/* bridge --------------------------------------------------------------------*/

/* ports of a bridge */
struct ports {
	const char *bridge;
	unsigned int n;
};

static int add_port(const struct ect_eoe *e, void *ctx)
{
	struct ports *p = ctx;

	/* in another network namespace */
	if (!*e->name)
		return 0;
	if (bridge_add(p->bridge, e->name))
		return 1;
	out_str(NULL, e->name, "%s%s", p->n++ ? ", " : "", e->name);
	return 0;
}

static int each_bridge(const struct tool *t, struct dev *d)
{
	struct ports p = { .bridge = bridge_name };
	int ret;

	out_object(NULL);
	out_u("master", d->master, NULL);
	if (d->selected > 1)
		out_text("Master%u: ", d->master);
	out_array("interfaces");
	(void)t;
	ret = each_device(d, add_port, &p);
	out_end();
	out_end();
	out_text("%s\n", p.n ? "" : "no slave with EoE");
	return ret;
}

static int bridge(struct tool *t, const char *name)
{
	int ret;

	if (bridge_make(name))
		return 1;
	bridge_name = name;
	out_array("masters");
	ret = dev_each(t, false, each_bridge);
	out_end();
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	if (argc == 2 && !strcmp(argv[0], "bridge"))
		return bridge(t, argv[1]);
	if (argc)
		return usage_error("'%s': use no argument, or bridge and a name", argv[0]);
	out_array("masters");
	ret = dev_each(t, false, each);
	out_end();
	return ret;
}

const struct cmd cmd_eoe = {
	.name = "eoe",
	.run = run,
	.args = "[bridge <NAME>]",
	.opts = "mv",
	.summary = "Show the network devices of slaves with EoE, or join them by a bridge",
	.help = "Each slave with EoE has a network device. It is named by the alias of the slave\n"
		"(eoe0a1001: master 0, alias 1001), else by its serial number (eoe0n1f3c, hexadecimal),\n"
		"else by its ring position (eoe0s3). State: down; up; wait: it is up, but the mailbox of\n"
		"the slave does not run (INIT, BOOT); lost: the slave is not connected.\n"
		"\n"
		"'bridge' makes a bridge of Linux, if there is none of that name, with the network devices\n"
		"of all slaves as its ports, and sets all of them up.\n",
	.json = "masters[]: master, interfaces[]: interface (null: in another network\n"
		"namespace), position, device, state, rx_bytes, rx_bytes_per_s, tx_bytes,\n"
		"tx_bytes_per_s, tx_waiting, tx_room, rx_frames, rx_errors, rx_missed, rx_dropped,\n"
		"tx_frames, tx_lost, tx_dropped; with 'bridge': interfaces[] has the names of the ports",
	.flags = CMD_HISTORIC,
	.max_args = 2,
};

/* make and remove -----------------------------------------------------------*/

static int wish(const struct tool *t, unsigned int what)
{
	struct ect_slave s;
	struct dev d;
	int ret, err;

	ret = dev_open_single(&d, t, true);
	if (ret)
		return ret;
	ret = dev_select_single(&d, t, &s);
	err = ret ? 0 : ect_eoe_wish(d.h, s.device, what);
	if (err)
		ret = dev_fail(&d, err, "Master%u slave %u: cannot %s the network device", d.master,
			       s.position, what == ECT_EOE_ON ? "make" : "remove");
	if (!ret) {
		out_u("master", d.master, NULL);
		out_u("position", s.position, NULL);
	}
	dev_close(&d);
	return ret;
}

static int add(struct tool *t, int argc, char **argv)
{
	(void)argc;
	(void)argv;
	return wish(t, ECT_EOE_ON);
}

static int delete(struct tool *t, int argc, char **argv)
{
	(void)argc;
	(void)argv;
	return wish(t, ECT_EOE_OFF);
}

const struct cmd cmd_eoe_addif = {
	.name = "eoe_addif",
	.run = add,
	.args = "",
	.opts = "map",
	.summary = "Make the network device of a slave with EoE",
	.help = "It is made also if ec_master was loaded with eoe=0. It remains until 'eoe_delif', or\n"
		"ec_master is unloaded; also while the slave is lost, if it is up.\n",
	.json = "master, position",
	.flags = CMD_ONE_MASTER,
};

const struct cmd cmd_eoe_delif = {
	.name = "eoe_delif",
	.run = delete,
	.args = "",
	.opts = "map",
	.summary = "Remove the network device of a slave with EoE",
	.help = "The slave has none until 'eoe_addif', or until ec_master is loaded again. Its EoE costs\n"
		"nothing then.\n",
	.json = "master, position",
	.flags = CMD_ONE_MASTER,
};
