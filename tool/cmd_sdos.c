// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>

#include "dict_image.h"
#include "out.h"

/* The value now; what the slave refuses has a code. */
static void value(const struct dict_entry *e)
{
	const struct dict_value *v = &e->value;

	if (v->abort) {
		out_u("abort_code", v->abort, ", abort 0x%08x", v->abort);
	} else if (v->err) {
		out_str("error", strerror(v->err), ", %s", strerror(v->err));
	} else if (v->data) {
		out_text(", ");
		out_object("value");
		dict_value_out(e->d.type, v->data, v->size);
		out_end();
	}
	out_text("\n");
}

static void limit(const char *name, const char **before, const struct dict_entry *e, u32 which,
		  const u8 *from)
{
	u8 data[8 + 1];

	/* larger ones are texts, whose default is not worth a line */
	if (!(e->d.values & which) || e->d.value_size > 8)
		return;
	memcpy(data, from, e->d.value_size);
	out_text("%s%s ", *before, name);
	out_object(name);
	dict_value_out(e->d.type, data, e->d.value_size);
	out_end();
	*before = ", ";
}

/* On a line of its own, which older readers of this listing ignore. */
static void limits(const struct dict_entry *e)
{
	const char *before = "    ";

	limit("default", &before, e, ECT_VALUE_DEFAULT, e->d.initial);
	limit("minimum", &before, e, ECT_VALUE_MIN, e->d.minimum);
	limit("maximum", &before, e, ECT_VALUE_MAX, e->d.maximum);
	if (e->d.values & ECT_VALUE_UNIT) {
		out_u("unit", e->d.unit, "%sunit 0x%0*x", before, 2 * e->d.unit_size,
		      e->d.unit);
		before = ", ";
	}
	if (*before == ',')
		out_text("\n");
}

static void entry(const struct dict_reader *r, const struct dict_entry *e)
{
	char access[7], type[32];

	(void)r;
	dict_access_text(e->d.access, access);
	dict_type_text(e->d.type, type, sizeof(type));
	out_object(NULL);
	out_u("subindex", e->d.subindex, "  0x%04x:%02x, ", e->d.index, e->d.subindex);
	out_str("access", access, "%s, ", access);
	out_str("type", type, "%s, ", type);
	out_u("type_code", e->d.type, NULL);
	out_u("size_bits", e->d.bits, "%u bit, ", e->d.bits);
	out_str("name", e->d.name, "\"%s\"", e->d.name);
	value(e);
	limits(e);
	out_end();
}

static void object(const struct dict_reader *r, const struct ect_object *o)
{
	(void)r;
	out_object(NULL);
	out_u("index", o->index, "SDO 0x%04x, ", o->index);
	out_str("name", o->name, "\"%s\"\n", o->name);
	out_u("object_code", o->code, NULL);
	out_u("type_code", o->type, NULL);
	out_u("max_subindex", o->max_subindex, NULL);
	if (r->entries)
		out_array("entries");
}

static void object_end(const struct dict_reader *r)
{
	if (r->entries)
		out_end();
	out_end();
}

static int slave(const struct slave_walk *w, const struct tool *t, struct dev *d,
		 const struct ect_slave *s, bool several)
{
	const struct dict_reader r = {
		.entries = t->verbosity >= 0, .values = t->verbosity > 0,
		.limits = t->verbosity > 0, .listing = true,
		.object = object, .entry = entry, .object_end = object_end,
	};
	int ret;

	(void)w;
	out_object(NULL);
	out_u("position", s->position, NULL);
	if (several)
		out_text("=== Master %u, Slave %u ===\n", d->master, s->position);
	out_array("objects");
	ret = dict_read(t, d, s, &r);
	out_end();
	out_end();
	return ret;
}

static int end(const struct slave_walk *w, struct dev *d, size_t taken, size_t selected)
{
	(void)w;
	if (!selected || taken)
		return 0;
	return fail("Master%u: no selected slave has an object dictionary that can be read (CoE with SDO information)",
		    d->master);
}

static int run(struct tool *t, int argc, char **argv)
{
	static const struct slave_walk walk = {
		.write = true, .takes = dict_described, .slave = slave, .end = end,
	};

	(void)argc, (void)argv;
	if (!!t->save + !!t->compare + (t->compare_slave >= 0) > 1)
		return usage_error("--save, --compare and --compare-slave exclude each other");
	if (t->save && !strcmp(t->save, "-"))
		return usage_error("--save needs the name of a file; -v --json writes to stdout");
	if (t->save)
		return dict_save(t);
	if (t->compare || t->compare_slave >= 0)
		return dict_compare(t);
	return dev_each_slave(t, &walk);
}

const struct cmd cmd_sdos = {
	.name = "sdos",
	.run = run,
	.args = "",
	.opts = "mapqvSCL",
	.summary = "Show the object dictionary of slaves",
	.help = "The master keeps the descriptions until the slave goes through INIT or is disconnected;\n"
		"values are read at each call. An entry has access in PREOP, SAFEOP and OP (r: read,\n"
		"w: write), data type, size and name. --quiet omits the entries, --verbose reads the\n"
		"values of all that can be read: an entry that the slave does not give has its abort code.\n"
		"A line below it has default, minimum, maximum and unit, as far as the slave has them.\n"
		"Slaves without CoE or without SDO information are skipped.\n"
		"\n"
		"--save writes all entries of one slave with their values to a file (JSON). --compare\n"
		"compares the slave with such a file, --compare-slave with another slave of the master.\n"
		"An entry is printed with both values if they differ, if one side lacks it, or if its value\n"
		"could not be read; the last line has the number of each. Exit status: 0 all values that\n"
		"both sides give are equal, 2 there are differences, 1 failure. A value that only one side\n"
		"gives is a difference; one that both refuse is counted as unreadable.\n"
		"  ethercat sdos -p4 --save axis4.json\n"
		"  ethercat sdos -p4 --compare axis4.json\n"
		"  ethercat sdos -p4 --compare-slave 5\n",
	.json = "masters[]: master, slaves[]: position, objects[]: index, name, object_code,\n"
		"type_code, max_subindex, entries[]: subindex, access, type, type_code, size_bits,\n"
		"name, with --verbose value (type, size_bytes, value, data_hex), abort_code or\n"
		"error, and default, minimum, maximum (as value), unit. --save: master, position,\n"
		"output_file, entry_count, values, unreadable. --compare, --compare-slave: master, position,\n"
		"left, right, entries[]: kind (different, unreadable), index, subindex, access, type,\n"
		"name, left and right (type, size_bytes, value, data_hex; abort_code; error;\n"
		"missing; not_readable); equal, different, unreadable",
	.flags = CMD_HISTORIC,
};
