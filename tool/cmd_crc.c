// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "errors.h"
#include "out.h"

static void cell(const struct ec_ioc_slave *s, const u8 *regs, unsigned int i)
{
	const struct ec_ioc_port *p = &s->ports[i];
	char next[8] = "   ";

	out_object(NULL);
	out_bool("loop_closed", p->loop_closed, NULL);
	out_u("crc_errors", err_rx(regs, i), NULL);
	out_u("phy_errors", err_phy(regs, i), NULL);
	out_u("forwarded_errors", err_fwd(regs, i), NULL);
	out_u("lost_links", err_lost(regs, i), NULL);
	if (p->next_slave == EC_UAPI_NONE16)
		out_null("next_slave", NULL);
	else
		out_u("next_slave", p->next_slave, NULL);
	out_end();
	if (p->next_slave + 1u == s->position)
		strcpy(next, "  \u2191");
	else if (p->next_slave == s->position + 1u)
		strcpy(next, "  \u2193");
	else if (p->next_slave != EC_UAPI_NONE16)
		snprintf(next, sizeof(next), "%3u", p->next_slave);
	if (p->loop_closed)
		out_text("%15s|", "");
	else
		out_text("%3u %3u %3u %s|", err_rx(regs, i), err_phy(regs, i), err_fwd(regs, i),
			 next);
}

static void details(const u8 *regs)
{
	out_text("    lost links: %u %u %u %u, processing unit errors: %u, PDI errors: %u\n",
		 err_lost(regs, 0), err_lost(regs, 1), err_lost(regs, 2), err_lost(regs, 3),
		 regs[EC_REG_ERR_PU - EC_REG_ERRORS], regs[EC_REG_ERR_PDI - EC_REG_ERRORS]);
}

static int row(const struct tool *t, struct dev *d, const struct ec_ioc_slave *s)
{
	u8 regs[EC_ERRORS_SIZE];
	char name[EC_UAPI_STRING];

	if (reg_read(d, s->position, EC_REG_ERRORS, regs, sizeof(regs)))
		return 1;
	slave_name(s, name, sizeof(name));
	out_object(NULL);
	out_u("position", s->position, "%3u|", s->position);
	out_str("name", name, NULL);
	out_array("ports");
	for (unsigned int i = 0; i < EC_UAPI_PORTS; i++)
		cell(s, regs, i);
	out_end();
	out_text("%.11s\n", name);
	out_u("processing_unit_errors", regs[EC_REG_ERR_PU - EC_REG_ERRORS], NULL);
	out_u("pdi_errors", regs[EC_REG_ERR_PDI - EC_REG_ERRORS], NULL);
	if (t->verbosity > 0)
		details(regs);
	out_end();
	return 0;
}

static int clear(struct dev *d, const struct ec_ioc_slave *s)
{
	static const u8 zero[EC_ERRORS_SIZE];

	return reg_write(d, s->position, EC_REG_ERRORS, zero, sizeof(zero), false);
}

static int all(const struct tool *t, struct dev *d, bool reset)
{
	struct slaves sel;
	int ret = 0;

	if (dev_select(d, t, &sel, NULL))
		return 1;
	if (reset && !sel.n && list_all(&t->aliases) && list_all(&t->positions)) {
		slaves_free(&sel);
		return dev_none_present(d);
	}
	out_u("master", d->master, NULL);
	if (!reset) {
		out_text("   |Port 0         |Port 1         |Port 2         |Port 3         |\n");
		out_text("   |CRC PHY FWD NXT|CRC PHY FWD NXT|CRC PHY FWD NXT|CRC PHY FWD NXT|\n");
		out_array("slaves");
	}
	for (size_t i = 0; i < sel.n; i++)
		ret |= reset ? clear(d, &sel.v[i]) : row(t, d, &sel.v[i]);
	if (!reset)
		out_end();
	slaves_free(&sel);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct dev d;
	int ret;

	if (argc && strcasecmp(argv[0], "reset"))
		return usage_error("invalid argument '%s': expected reset or nothing", argv[0]);
	if (dev_open_single(&d, t, true))
		return 1;
	ret = all(t, &d, argc);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_crc = {
	.name = "crc",
	.run = run,
	.args = "[reset]",
	.opts = "mapv",
	.summary = "Show or clear the error counters of the slaves' ports",
	.help = "For each port: CRC: invalid frames; PHY: errors of the receiver; FWD: errors that\n"
		"another slave has detected before; NXT: slave connected to the port (arrows:\n"
		"previous and next slave in the ring). Counters stop at 255. Ports without a link\n"
		"are blank. --verbose adds lost links (ports 0 to 3), processing unit and PDI errors.\n",
	.json = "master, slaves[]: position, name, ports[] (loop_closed, crc_errors, phy_errors,\n"
		"forwarded_errors, lost_links, next_slave), processing_unit_errors, pdi_errors",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.max_args = 1,
};
