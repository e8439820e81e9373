// SPDX-License-Identifier: GPL-2.0-only
#include "dev.h"
#include "ip.h"
#include "out.h"

static int ip(const struct tool *t, struct dev *d, struct ect_ip *p)
{
	bool set = p->which;
	struct ect_slave s;
	int err;

	if (dev_select_single(d, t, &s))
		return 1;
	err = set ? ect_ip_set(d->h, s.device, p) : ect_ip_get(d->h, s.device, p);
	if (err)
		return dev_fail(d, err, "Master%u slave %u: cannot %s IP parameters", d->master,
				s.position, set ? "set" : "read");
	out_u("master", d->master, NULL);
	out_u("position", s.position, NULL);
	if (!p->which)
		out_text("None.\n");
	if (!set || out_is_json())
		ip_out(p, "", true);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct ect_ip p = { .struct_size = sizeof(p) };
	struct dev d;
	int ret;

	if (argc % 2)
		return usage_error("'%s' has no value: expected pairs of keyword and value",
				   argv[argc - 1]);
	for (int i = 0; i < argc; i += 2)
		if (ip_parse(&p, argv[i], argv[i + 1]))
			return 1;
	ret = dev_open_single(&d, t, true);
	if (!ret) {
		ret = ip(t, &d, &p);
		dev_close(&d);
	}
	return ret;
}

const struct cmd cmd_ip = {
	.name = "ip",
	.run = run,
	.args = "[KEYWORD VALUE]...",
	.opts = "map",
	.summary = "Set the IP parameters of a slave with EoE, or show them",
	.help = "KEYWORD VALUE, in any case:\n"
		"  mac_address, link          6 bytes, as 02:00:00:ec:01:07\n"
		"  ip_address, addr           IPv4 address or host name; with /PREFIX also the mask\n"
		"  subnet_mask, mask          as 255.255.255.0\n"
		"  default_gateway, default   IPv4 address or host name\n"
		"  dns_address, dns           IPv4 address or host name\n"
		"  hostname, name             at most 31 bytes\n"
		"Without arguments the command reads the parameters of the slave. The slave decides how\n"
		"long it keeps new parameters. An application uses ecrt_slave_config_eoe_...().\n",
	.json = "master, position, mac_address, ip_address, subnet_mask, default_gateway,\n"
		"dns_address, hostname (null: not set, or not reported)",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.max_args = 12,
};
