// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>

#include <string.h>

#include "domain.h"
#include "current.h"
#include "out.h"

static int show(const struct tool *t, struct dev *d, const struct ect_domain *dom)
{
	size_t size;
	u8 *data;

	(void)t;
	if (domain_data(d, dom, &data, &size))
		return 1;
	out_object(NULL);
	out_u("index", dom->index, NULL);
	out_u("size_bytes", size, NULL);
	out_binary("data_hex", data, size);
	out_end();
	free(data);
	return 0;
}

static int each(const struct tool *t, struct dev *d)
{
	int ret;

	out_object(NULL);
	out_u("master", d->master, NULL);
	out_array("domains");
	ret = domain_each(d, t, show);
	out_end();
	out_end();
	return ret;
}

static bool has(const struct list *l, unsigned int number)
{
	for (unsigned int i = 0; i < l->n; i++)
		if (number >= l->item[i].from && number <= l->item[i].to)
			return true;
	return list_all(l);
}

/* one of the values; bytes that are longer than 64 bits have no value in JSON */
static void show_value(const struct current *l, const struct ect_value *v, int width)
{
	struct ec_type type = current_type(v);
	char text[CURRENT_TEXT];

	current_format(l, v, text, sizeof(text));
	out_object(NULL);
	out_str("name", v->name, "%-*s", width, v->name);
	out_str("direction", v->dir == ECT_DIR_OUTPUT ? "output" : "input", "  %-3s",
		v->dir == ECT_DIR_OUTPUT ? "out" : "in");
	out_str("type", type.name, "  %-8s", type.name);
	out_str("value", text, "  %s", text);
	if (*current_unit_text(l, v))
		out_str("unit", current_unit_text(l, v), " %s", current_unit_text(l, v));
	out_text("\n");
	out_u("domain", v->domain, NULL);
	out_u("bit", v->bit, NULL);
	out_u("bits", v->bits, NULL);
	out_u("index", v->index, NULL);
	out_u("subindex", v->subindex, NULL);
	out_end();
}

static int names_of(const struct tool *t, struct dev *d)
{
	const struct ect_value *v;
	struct current l;
	int ret = current_read_as(t, d, t->file, &l), width = 0;

	for (size_t i = 0; !ret && (v = current_at(&l, i)); i++)
		width = max(width, (int)strlen(v->name));
	out_object(NULL);
	out_u("master", d->master, NULL);
	if (d->selected > 1)
		out_text("Master%u\n", d->master);
	out_array("values");
	for (size_t i = 0; !ret && (v = current_at(&l, i)); i++)
		if (has(&t->domains, v->domain))
			show_value(&l, v, width);
	out_end();
	out_end();
	current_free(&l);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	if (t->file && !t->names)
		return usage_error("--file needs --names");
	if (t->names) {
		out_array("masters");
		ret = dev_each(t, false, names_of);
		out_end();
		return ret;
	}
	if (out_binary_allowed("use --json, or a pipe: ethercat data | hexdump -C"))
		return 1;
	out_array("masters");
	ret = dev_each(t, false, each);
	out_end();
	return ret;
}

const struct cmd cmd_data = {
	.name = "data",
	.run = run,
	.args = "",
	.opts = "mdgi",
	.summary = "Write the process data of domains to stdout",
	.help = "Binary, all domains in a row; refused if stdout is a terminal:\n"
		"ethercat data -d0 | hexdump -C\n"
		"\n"
		"With --names one line for each value instead: name, direction, type, value. A name is\n"
		"SLAVE.ENTRY, of the order number of the slave and of its PDO entry, or SLAVE.PDO.ENTRY\n"
		"where a slave has two of the same name. Types are those of the EEPROM.\n"
		"An application that was configured by a bus file names, scales and types its values; so\n"
		"does the bus file of --file. No slave is asked.\n",
	.json = "masters[]: master, domains[]: index, size_bytes, data_hex; with --names values[]\n"
		"instead: name, direction (input, output), type, value (text), unit, domain, bit (in the\n"
		"domain), bits, index, subindex",
	.flags = CMD_HISTORIC,
};
