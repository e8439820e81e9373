// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config_info.h"
#include "out.h"

static int digits(unsigned int v)
{
	return snprintf(NULL, 0, "%u", v);
}

static int order(const void *a, const void *b)
{
	const struct ect_config *x = a, *y = b;

	if (x->group != y->group)
		return x->group < y->group ? -1 : 1;
	if (x->alias != y->alias)
		return x->alias < y->alias ? -1 : 1;
	return (x->position > y->position) - (x->position < y->position);
}

static int get(const struct tool *t, struct dev *d, struct ect_config **list, size_t *n)
{
	struct ect_master m;
	struct ect_config *c;

	*n = 0;
	if (dev_master(d, &m))
		return 1;
	c = calloc(m.config_count + 1u, sizeof(*c));
	if (!c)
		return fail("out of memory");
	for (unsigned int i = 0; i < m.config_count; i++) {
		int err;

		c[*n].struct_size = sizeof(*c);
		err = ect_config_read(d->h, i, &c[*n]);
		if (err == -ENOENT)
			break;	/* the application has exited */
		if (err) {
			free(c);
			return dev_fail(d, err, "Master%u: cannot read configuration %u", d->master,
					i);
		}
		if (select_config(&t->aliases, &t->positions, &c[*n]))
			(*n)++;
	}
	dev_selected("configuration", !list_all(&t->aliases) || !list_all(&t->positions), *n);
	qsort(c, *n, sizeof(*c), order);
	*list = c;
	return 0;
}

static void cells(const struct ect_config *c, char *slave, char *state)
{
	strcpy(slave, "-");
	strcpy(state, "-");
	if (c->slave_position < 0)
		return;
	snprintf(slave, 12, "%d", c->slave_position);
	al_state_text(c->al_status, state, 16);
}

/* What its position counts from: an alias, or a hot connect group */
static const char *first(const struct ect_config *c, char alias[8])
{
	snprintf(alias, 8, "%u", c->alias);
	return c->group ? c->group_name : alias;
}

static void table(const struct ect_config *c, size_t n, const char *indent)
{
	char slave[12], state[16], alias[8];
	int w[3] = { 0 };

	for (size_t i = 0; i < n; i++) {
		cells(&c[i], slave, state);
		w[0] = max(w[0], (int)strlen(first(&c[i], alias)));
		w[1] = max(w[1], digits(c[i].position));
		w[2] = max(w[2], (int)strlen(slave));
	}
	for (size_t i = 0; i < n; i++) {
		cells(&c[i], slave, state);
		out_text("%s%*s:%-*u  0x%08x/0x%08x  %-*s  %s\n", indent, w[0],
			 first(&c[i], alias), w[1], c[i].position, c[i].vendor_id,
			 c[i].product_code, w[2], slave, state);
	}
}

static int each(const struct tool *t, struct dev *d)
{
	struct ect_config *c = NULL;
	int ret = 0;
	size_t n;

	if (get(t, d, &c, &n))
		return 1;
	out_object(NULL);
	out_u("master", d->master, NULL);
	if (d->selected > 1)
		out_text("Master%u\n", d->master);
	out_array("configs");
	if (t->verbosity <= 0 && !out_is_json())
		table(c, n, d->selected > 1 ? "  " : "");
	for (size_t i = 0; i < n && (t->verbosity > 0 || out_is_json()); i++)
		ret |= config_info(d, &c[i], d->selected > 1 ? "  " : "");
	out_end();
	out_end();
	free(c);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	out_array("masters");
	ret = dev_each(t, false, each);
	out_end();
	return ret;
}

const struct cmd cmd_config = {
	.name = "config",
	.run = run,
	.args = "",
	.opts = "mapv",
	.summary = "Show the slave configurations of the application",
	.help = "Columns: alias:position, or group:member of a hot connect group, expected\n"
		"vendor/product, ring position of the attached slave or '-', AL state of this slave\n"
		"or '-'. -a selects configurations by alias and -p by position; -p alone selects\n"
		"configurations with alias 0.\n",
	.json = "masters[]: master, configs[]: alias, relative_position, vendor_id,\n"
		"product_code, group (name, mandatory, known_by, value, port, at_configuration; or\n"
		"null), position (of the attached slave, or null), state, not_in_op (reason or\n"
		"null), warning (or null), watchdog_divider, watchdog_intervals,\n"
		"sync_managers[] (index, direction, watchdog, pdos[] (index, entries[] (index,\n"
		"subindex, size_bits))), sdos[] (index, subindex, complete_access, size_bytes,\n"
		"data_hex), idns[] (drive, idn, name, state, size_bytes, data_hex; null from an older\n"
		"module), commands[] (step, kind as of writes, size_bytes, timeout_ms, write_hex,\n"
		"expect_hex, mask_hex, each or null; null from an older module), writes[] (kind: SDO\n"
		"(index, subindex, complete_access), IDN (drive, idn) or register (register);\n"
		"size_bytes, not_replayed (reason or null), data_hex; null from an older module),\n"
		"flags[] (key, value), eoe_ip (as of ip, or null),\n"
		"dc (assign_activate, sync[] (cycle_ns, shift_ns))",
	.flags = CMD_HISTORIC,
};
