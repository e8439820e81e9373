// SPDX-License-Identifier: GPL-2.0-only
#include <strings.h>

#include "crc_table.h"
#include "out.h"

static int row(const struct tool *t, struct dev *d, const struct ect_slave *s)
{
	struct ect_errors e;

	if (errors_read(d, s, &e))
		return 1;
	crc_table_row(t, s, &e);
	return 0;
}

static int clear(struct dev *d, const struct ect_slave *s)
{
	static const u8 zero[EC_ERRORS_SIZE];

	return reg_write(d, s, EC_REG_ERRORS, zero, sizeof(zero), false);
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
		crc_table_head();
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
	if (argc && t->watch_s)
		return usage_error("'reset' and --watch exclude each other");
	if (dev_open_single(&d, t, true))
		return 1;
	ret = t->watch_s ? crc_watch(t, &d) : all(t, &d, argc);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_crc = {
	.name = "crc",
	.run = run,
	.args = "[reset]",
	.opts = "mapqvW",
	.summary = "Show or clear the error counters of the slaves' ports",
	.help = "For each port: CRC: invalid frames; PHY: errors of the receiver; FWD: errors that\n"
		"another slave has detected before; NXT: slave connected to the port (arrows:\n"
		"previous and next slave in the ring). Counters stop at 255. Ports without a link\n"
		"are blank. --verbose adds lost links (ports 0 to 3), processing unit and PDI errors.\n"
		"--watch reads the counters of all slaves twice, with this time between (Ctrl-C ends\n"
		"it), and names the segments where invalid frames, receiver errors or lost links grow,\n"
		"in the order in which a frame passes them. --quiet omits the tables. A slave that does\n"
		"not reply is skipped; the exit code is 1 then.\n"
		"  ethercat crc --watch 10\n",
	.json = "master, slaves[]: position, name, ports[] (loop_closed, crc_errors, phy_errors,\n"
		"forwarded_errors, lost_links, next_slave), processing_unit_errors, pdi_errors;\n"
		"--watch: also begin[] (as slaves[], before), seconds, frames (sent meanwhile),\n"
		"segments[] (slave and port (null: the master), to_slave and to_port (null: no slave),\n"
		"invalid_frames, receiver_errors, lost_links), forwarded_at (slave, port; or null)",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.max_args = 1,
};
