// SPDX-License-Identifier: GPL-2.0-only
/* Latch inputs of a slave's clock: the times of edges (ETG.1000.4 clause 6.8.6). */
#include <string.h>

#include "io.h"
#include "out.h"
#include "reg.h"
#include "slave_info.h"

#include "../master/wire/regs.h"

#define INPUTS	2
#define BOTH	3	/* rising and falling edge */

/* registers of both inputs */
struct latches {
	u8 owner;		/* 0x0980 bits 4, 5: the slave's own CPU has it */
	u8 control[INPUTS];	/* 0x09A8: bit per edge, 0: each edge, 1: the first */
	u8 status[INPUTS];	/* 0x09AE: bit per edge; bit 2: the pin */
	u8 times[INPUTS][16];	/* 0x09B0: rising, falling */
};

static int read_all(struct dev *d, const struct ect_slave *s, struct latches *l)
{
	if (reg_read(d, s, EC_REG_DC_CUC, &l->owner, 1) ||
	    reg_read(d, s, EC_REG_DC_LATCH0_CTRL, l->control, INPUTS) ||
	    reg_read(d, s, EC_REG_DC_LATCH0_STATUS, l->status, INPUTS))
		return 1;
	/* reading a time re-arms the latch, so only where an edge has occurred */
	for (u16 i = 0; i < INPUTS; i++)
		if (l->status[i] & BOTH &&
		    reg_read(d, s, (u16)(EC_REG_DC_LATCH0_POS + 16 * i), l->times[i], 16))
			return 1;
	return 0;
}

static void edge(const struct latches *l, unsigned int i, unsigned int which)
{
	static const char *const key[] = { "rising_ns", "falling_ns" };
	static const char *const text[] = { "rising", "falling" };
	unsigned long long t = get_unaligned_le64(l->times[i] + 8 * which);

	if (l->status[i] >> which & 1)
		out_u(key[which], t, ", %s %llu ns", text[which], t);
	else
		out_null(key[which], ", %s none", text[which]);
}

static bool slave_owns(u8 owner, unsigned int i)
{
	return owner >> (4 + i) & 1;
}

static void input(const struct latches *l, unsigned int i)
{
	bool high = l->status[i] & 4, slave = slave_owns(l->owner, i);

	out_object(NULL);
	out_u("input", i, "Latch %u: ", i);
	out_bool("high", high, "%s", high ? "high" : "low");
	edge(l, i, 0);
	edge(l, i, 1);
	out_bool("single", (l->control[i] & BOTH) == BOTH, NULL);
	out_str("owner", slave ? "slave" : "master", "%s\n",
		slave ? "; controlled by the slave" :
		(l->control[i] & BOTH) == BOTH ? "; first edge counts" : "; last edge counts");
	out_end();
}

/* Not for an input that the slave's own CPU controls. */
static int set_mode(struct dev *d, const struct ect_slave *s, const char *mode)
{
	const u8 v = !strcmp(mode, "single") ? BOTH : 0;
	u8 owner;
	int ret = 0;

	if (reg_read(d, s, EC_REG_DC_CUC, &owner, 1))
		return 1;
	if (slave_owns(owner, 0) && slave_owns(owner, 1))
		return fail("slave %u controls both latch inputs itself; use its objects",
			    s->position);
	for (unsigned int i = 0; i < INPUTS && !ret; i++) {
		if (slave_owns(owner, i))
			note("slave %u: latch %u is controlled by the slave; mode unchanged",
			     s->position, i);
		else
			ret = reg_write(d, s, (u16)(EC_REG_DC_LATCH0_CTRL + i), &v, 1,
					false);
	}
	return ret;
}

static int show(const struct tool *t, struct dev *d, const char *mode)
{
	struct latches l = { 0 };
	struct ect_slave s;

	if (dev_select_single(d, t, &s))
		return 1;
	if (!slave_has_dc(&s))
		return fail("slave %u has no distributed clock, so no latch inputs", s.position);
	if (mode)
		return set_mode(d, &s, mode);
	if (read_all(d, &s, &l))
		return 1;
	out_u("master", d->master, NULL);
	out_u("position", s.position, NULL);
	out_array("latches");
	for (unsigned int i = 0; i < INPUTS; i++)
		input(&l, i);
	out_end();
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	const char *mode = argc ? argv[0] : NULL;
	struct dev d;
	int ret;

	if (mode && strcmp(mode, "single") && strcmp(mode, "continuous"))
		return usage_error("invalid mode '%s': expected single or continuous", mode);
	if (dev_open_single(&d, t, true))
		return 1;
	ret = show(t, &d, mode);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_latch = {
	.name = "latch",
	.run = run,
	.args = "[MODE]",
	.opts = "map",
	.summary = "Show the times of edges at the latch inputs of a slave's clock",
	.help = "MODE := { single: the latch stores the first edge until its time is read;\n"
		"          continuous: the latch stores the last edge }\n"
		"MODE is set for the inputs that the master controls. Inputs that the slave's own CPU\n"
		"controls are named and do not change; if it controls both, the command fails.\n"
		"Times are system times of the distributed clocks, ns. Reading a time re-arms the\n"
		"latch.\n",
	.json = "master, position, latches[] (input, high, rising_ns, falling_ns (null: none), single,\n"
		"owner (master, slave: the CPU of the slave reads the times))",
	.flags = CMD_ONE_MASTER,
	.max_args = 1,
};
