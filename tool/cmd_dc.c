// SPDX-License-Identifier: GPL-2.0-only
/* The distributed clocks at a glance: what the master knows, and with -v the slaves' registers. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "../master/wire/dc.h"
#include "out.h"
#include "reg.h"
#include "slave_info.h"

#define ASSIGN_SYNC0	0x0200u
#define ASSIGN_SYNC1	0x0400u

enum { POSITION, CLOCK, DELAY, OFFSET, DIFFERENCE, SYNC0, SYNC1, STATE, CELLS };

/**
 * struct clock - a slave and its row
 * @s: slave
 * @reference: it is the reference clock
 * @configured: @assign, @cycle and @shift are those of a configuration
 * @assign: AssignActivate
 * @cycle: of SYNC0 and SYNC1, ns
 * @shift: likewise
 * @cell: text of the columns
 */
struct clock {
	const struct ect_slave *s;
	bool reference;
	bool configured;
	u16 assign;
	u32 cycle[2];
	s32 shift[2];
	char cell[CELLS][32];
};

static const char *const titles[CELLS] = {
	"Slave", "Clock", "Delay [ns]", "Offset [ns]", "Difference [ns]", "SYNC0 [ns]",
	"SYNC1 [ns]", "State",
};

static bool sync_active(const struct clock *c, int sync)
{
	return c->configured && c->assign & (sync ? ASSIGN_SYNC1 : ASSIGN_SYNC0);
}

static bool outside(s32 diff)
{
	return diff > ECT_DC_WINDOW || diff < -ECT_DC_WINDOW;
}

static const char *state_text(const struct clock *c)
{
	const struct ect_slave *s = c->s;

	if (!s->dc_supported || s->dc_delay_only)
		return "-";
	if (s->dc_odd)
		return "delay unreliable";
	if (c->reference)
		return "reference clock";
	if (!s->dc_set)
		return "not synchronized";
	return outside(s->dc_diff) ? "outside window" : "synchronized";
}

static const char *clock_text(const struct ect_slave *s)
{
	return s->dc_delay_only ? "delay only" : !s->dc_supported ? "none" :
		s->dc_supported == 1 ? "32 bit" : "64 bit";
}

/* What an application has configured; it may have exited meanwhile. */
static int configured(struct dev *d, struct clock *c)
{
	struct ect_config i = { .struct_size = sizeof(i) };
	int err;

	if (!c->s->config || c->s->differs)
		return 0;
	err = ect_config_read(d->h, c->s->config - 1, &i);
	if (err == -ENOENT)
		return 0;
	if (err)
		return dev_fail(d, err, "Master%u: cannot read configuration %u", d->master,
				c->s->config - 1);
	c->configured = i.dc_assign_activate;
	c->assign = i.dc_assign_activate;
	memcpy(c->cycle, i.dc_cycle, sizeof(c->cycle));
	memcpy(c->shift, i.dc_shift, sizeof(c->shift));
	return 0;
}

static int fill(struct dev *d, struct clock *c, const struct ect_slave *s, s32 reference)
{
	*c = (struct clock){ .s = s, .reference = reference == s->position };
	if (configured(d, c))
		return 1;
	for (int i = 0; i < CELLS; i++)
		strcpy(c->cell[i], "-");
	snprintf(c->cell[POSITION], sizeof(c->cell[0]), "%u", s->position);
	snprintf(c->cell[CLOCK], sizeof(c->cell[0]), "%s", clock_text(s));
	if (slave_has_dc(s))
		snprintf(c->cell[DELAY], sizeof(c->cell[0]), "%u", s->transmission_delay);
	if (s->dc_set) {
		snprintf(c->cell[OFFSET], sizeof(c->cell[0]), "%lld", (long long)s->dc_offset);
		snprintf(c->cell[DIFFERENCE], sizeof(c->cell[0]), "%d", s->dc_diff);
	}
	for (int i = 0; i < 2; i++)
		if (sync_active(c, i))
			snprintf(c->cell[SYNC0 + i], sizeof(c->cell[0]), "%u%+d", c->cycle[i],
				 c->shift[i]);
	snprintf(c->cell[STATE], sizeof(c->cell[0]), "%s", state_text(c));
	return 0;
}

static void json(const struct clock *c)
{
	const struct ect_slave *s = c->s;
	char name[ECT_STRING];

	slave_name(s, name, sizeof(name));
	out_u("position", s->position, NULL);
	out_str("name", name, NULL);
	out_str("clock", clock_text(s), NULL);
	out_bool("reference", c->reference, NULL);
	if (slave_has_dc(s))
		out_u("dc_delay_ns", s->transmission_delay, NULL);
	else
		out_null("dc_delay_ns", NULL);
	if (s->dc_set) {
		out_i("dc_offset_ns", (s64)s->dc_offset, NULL);
		out_i("dc_difference_ns", s->dc_diff, NULL);
	} else {
		out_null("dc_offset_ns", NULL);
		out_null("dc_difference_ns", NULL);
	}
	out_u("assign_activate", c->configured ? c->assign : 0, NULL);
	out_array("sync");
	for (int i = 0; i < 2; i++) {
		out_object(NULL);
		out_bool("active", sync_active(c, i), NULL);
		out_u("cycle_ns", c->cycle[i], NULL);
		out_i("shift_ns", c->shift[i], NULL);
		out_end();
	}
	out_end();
	out_str("state", state_text(c), NULL);
}

static int registers(struct dev *d, const struct clock *c)
{
	u8 diff[4], sync[8], cycle[8];
	const struct ect_slave *p = c->s;

	if (!c->s->dc_supported || c->s->dc_delay_only)
		return 0;
	if (reg_read(d, p, EC_REG_DC_DIFF, diff, sizeof(diff)) ||
	    reg_read(d, p, EC_REG_DC_CUC, sync, sizeof(sync)) ||
	    reg_read(d, p, EC_REG_DC_CYCLE0, cycle, sizeof(cycle)))
		return 1;
	out_object("registers");
	out_i("dc_difference_ns", ec_dc_diff(get_unaligned_le32(diff)),
	      "    registers: difference %d ns", ec_dc_diff(get_unaligned_le32(diff)));
	out_u("assign_activate", get_unaligned_le16(sync), ", AssignActivate 0x%04x",
	      get_unaligned_le16(sync));
	out_u("activation_status", sync[EC_REG_DC_ACT_STATUS - EC_REG_DC_CUC],
	      ", activation status 0x%02x", sync[EC_REG_DC_ACT_STATUS - EC_REG_DC_CUC]);
	out_u("sync0_cycle_ns", get_unaligned_le32(cycle), ", SYNC0 %u ns",
	      get_unaligned_le32(cycle));
	out_u("sync1_cycle_ns", get_unaligned_le32(cycle + 4), ", SYNC1 %u ns\n",
	      get_unaligned_le32(cycle + 4));
	out_end();
	return 0;
}

static void header(struct dev *d, const struct ect_master *m, const struct clock *c, size_t n)
{
	const struct clock *worst = NULL;

	for (size_t i = 0; i < n; i++)
		if (c[i].s->dc_set && !c[i].s->dc_odd && !c[i].reference &&
		    (!worst || llabs(c[i].s->dc_diff) > llabs(worst->s->dc_diff)))
			worst = &c[i];
	if (m->ref_clock >= 0)
		out_i("reference_clock", m->ref_clock, "Master%u: reference clock slave %d",
		      d->master, m->ref_clock);
	else
		out_null("reference_clock", "Master%u: no reference clock", d->master);
	if (worst) {
		out_u("largest_difference_slave", worst->s->position, NULL);
		out_i("largest_difference_ns", worst->s->dc_diff,
		      ", largest difference %d ns at slave %u", worst->s->dc_diff,
		      worst->s->position);
	} else {
		out_null("largest_difference_slave", NULL);
		out_null("largest_difference_ns", NULL);
	}
	out_text("\n");
}

/* text is on the left, numbers on the right */
static void line(char *const cell[], const int *width, const char *name)
{
	for (int i = 0; i < CELLS; i++)
		out_text(i == CLOCK || i == STATE ? "%s%-*s" : "%s%*s", i ? "  " : "", width[i],
			 cell[i]);
	out_text("  %s\n", name);
}

static int rows(const struct tool *t, struct dev *d, struct clock *c, size_t n)
{
	char name[ECT_STRING];
	int width[CELLS], ret = 0;
	char *cell[CELLS];

	for (int i = 0; i < CELLS; i++) {
		cell[i] = (char *)(uintptr_t)titles[i];
		width[i] = (int)strlen(titles[i]);
		for (size_t k = 0; k < n; k++)
			width[i] = max(width[i], (int)strlen(c[k].cell[i]));
	}
	if (n)
		line(cell, width, "Name");
	out_array("slaves");
	for (size_t k = 0; k < n; k++) {
		out_object(NULL);
		json(&c[k]);
		slave_name(c[k].s, name, sizeof(name));
		for (int i = 0; i < CELLS; i++)
			cell[i] = c[k].cell[i];
		line(cell, width, name);
		if (t->verbosity > 0)
			ret |= registers(d, &c[k]);
		out_end();
	}
	out_end();
	return ret;
}

static int each(const struct tool *t, struct dev *d)
{
	struct ect_master m;
	struct slaves sel;
	struct clock *c;
	int ret = 0;

	if (dev_master(d, &m) || dev_select(d, t, &sel, NULL))
		return 1;
	c = calloc(sel.n + 1, sizeof(*c));
	if (!c)
		ret = fail("out of memory");
	for (size_t i = 0; i < sel.n && !ret; i++)
		ret = fill(d, &c[i], &sel.v[i], m.ref_clock);
	if (!ret) {
		out_object(NULL);
		out_u("master", d->master, NULL);
		header(d, &m, c, sel.n);
		ret = rows(t, d, c, sel.n);
		out_end();
	}
	free(c);
	slaves_free(&sel);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	out_array("masters");
	ret = dev_each(t, t->verbosity > 0, each);
	out_end();
	return ret;
}

const struct cmd cmd_dc = {
	.name = "dc",
	.run = run,
	.args = "",
	.opts = "mapv",
	.summary = "Show the distributed clocks",
	.help = "Columns: capability; propagation delay from the reference clock; offset to its time;\n"
		"difference to its time at the last read; SYNC0 and SYNC1 as configured by the\n"
		"application, cycle time and shift; state. A clock is synchronized for an active\n"
		"application; the window is 1000 ns. Without --verbose there is no bus traffic and\n"
		"read access is enough. --verbose reads registers 0x092c, 0x0980 and 0x09a0 of the\n"
		"slaves.\n",
	.json = "masters[]: master, reference_clock (or null), largest_difference_slave and\n"
		"largest_difference_ns (or null), slaves[]: position, name, clock (none, 32 bit,\n"
		"64 bit, delay only), reference, dc_delay_ns, dc_offset_ns and dc_difference_ns (or\n"
		"null), assign_activate (0: not configured), sync[] (active, cycle_ns, shift_ns), state (-,\n"
		"reference clock, synchronized, outside window, delay unreliable, not synchronized),\n"
		"registers (--verbose: dc_difference_ns, assign_activate, activation_status,\n"
		"sync0_cycle_ns, sync1_cycle_ns)",
};
