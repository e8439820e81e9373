// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>

#include "../master/wire/al.h"
#include "../master/wire/sii.h"
#include "al_request.h"
#include "files.h"
#include "io.h"
#include "out.h"

/* Can this slave be updated, now? */
static int check(const struct tool *t, const struct dev *d, const struct ect_slave *s)
{
	u8 state = s->al_status & EC_AL_STATE_MASK;

	if (!(s->mbox_protocols & EC_SII_PROTO_FOE))
		return fail("Master%u slave %u: no FoE, so no firmware can be written", d->master,
			    s->position);
	if (!s->boot_rx_size || !s->boot_tx_size)
		return fail("Master%u slave %u: no bootstrap mailbox in the SII, so no BOOT; 'ethercat foe_write' writes a file in PREOP",
			    d->master, s->position);
	if ((state == EC_AL_SAFEOP || state == EC_AL_OP) && !t->force)
		return fail("Master%u slave %u is in %s: BOOT ends its process data; stop the application, or use --force",
			    d->master, s->position, ec_al_state_name(state));
	return 0;
}

static int to_state(const struct tool *t, struct dev *d, const struct ect_slave *of, u8 state)
{
	double end = now_s() + (t->wait_s >= 0 ? t->wait_s : AL_WAIT_S);
	struct ect_slave s = *of;

	return dev_slave(d, &s) || al_request(d, of, state, 0) ||
	       al_wait(d, &s, state, end);
}

static int to_boot(const struct tool *t, struct dev *d, const struct ect_slave *s)
{
	if ((s->al_status & (EC_AL_STATE_MASK | EC_AL_ERROR)) == EC_AL_BOOT)
		return 0;
	/* the way through INIT ends what the slave does, and its errors */
	return to_state(t, d, s, EC_AL_INIT) || to_state(t, d, s, EC_AL_BOOT);
}

static int update(const struct tool *t, struct dev *d, struct foe *f)
{
	struct ect_slave s, now;
	u8 back;

	if (dev_select_single(d, t, &s) || check(t, d, &s))
		return 1;
	/* an earlier attempt may have left it in BOOT or INIT: its state before is unknown */
	back = s.al_requested == EC_AL_BOOT || s.al_requested == EC_AL_INIT ? EC_AL_PREOP :
	       s.al_requested;
	if (to_boot(t, d, &s)) {
		if (!to_state(t, d, &s, EC_AL_INIT) && !to_state(t, d, &s, back))
			note("Master%u slave %u is in %s again; nothing was written", d->master,
			     s.position, ec_al_state_name(back));
		return 1;
	}
	now = s;
	if (dev_slave(d, &now))
		return 1;
	if (foe_transfer(d, t, &s, f)) {
		note("Master%u slave %u stays in BOOT; repeat the command", d->master, s.position);
		return 1;
	}
	if (to_state(t, d, &s, EC_AL_INIT) || to_state(t, d, &s, back)) {
		note("Master%u slave %u: the firmware is written; to return to %s the slave may need its power switched off and on",
		     d->master, s.position, ec_al_state_name(back));
		return 1;
	}
	out_str("state", ec_al_state_name(back), NULL);
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct foe f = { .write = true };
	struct dev d;
	size_t size;
	int ret;

	if (foe_password(argc, argv, &f))
		return 1;
	if (!strcmp(argv[0], "-") && !t->output_file)
		return usage_error("stdin has no name; add -o NAME, the file name on the slave");
	f.name = t->output_file ? t->output_file : base_name(argv[0]);
	if (foe_check_name(f.name) || io_read(argv[0], &f.data, &size))
		return 1;
	f.size = (u32)size;
	ret = dev_open_single(&d, t, true);
	if (!ret) {
		ret = update(t, &d, &f);
		dev_close(&d);
	}
	free(f.data);
	return ret;
}

const struct cmd cmd_firmware = {
	.name = "firmware",
	.run = run,
	.args = "FILE [PASSWORD]",
	.opts = "mapofqvw",
	.summary = "Write firmware to a slave, in BOOT",
	.help = "FILE := firmware\n"
		"PASSWORD := 32-bit number, default 0\n"
		"Brings the slave to BOOT, writes the file (FoE) by the bootstrap mailbox, and brings the\n"
		"slave back to the state it had. The file on the slave has the base name of FILE, or the\n"
		"name after --output-file. A slave in SAFEOP or OP is refused, unless with --force. After\n"
		"an error, or when the command was killed, the slave stays in BOOT: repeat the command.\n"
		"Each change of state may take 10 s, or as --wait says.\n",
	.json = "master, position, name, size_bytes, state",
	.flags = CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 2,
};
