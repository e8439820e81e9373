// SPDX-License-Identifier: GPL-2.0-only
/* Bus files: write one, compare, show. */
#include "tool.h"

#ifdef EC_TOOL_NO_BUS
static int run(struct tool *t, int argc, char **argv)
{
	(void)t;
	(void)argc;
	(void)argv;
	return fail("this 'ethercat' was built without libyaml: install libyaml-dev and build it again"), 2;
}
#else
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "bus_int.h"
#include "out.h"

#define DEPTH_MAX	40	/* columns: branches behind that are not shifted any more */

static int read_file(const char *path, struct ecb_bus **bus)
{
	struct ecb_error e;

	if (!ecb_file_read(bus, path, &e))
		return 0;
	fail("%s", e.text);
	return 2;
}

static size_t slaves_of(const struct ecb_bus *bus)
{
	size_t n = 0;

	for (size_t i = 0; i < bus->master_count; i++)
		n += bus->masters[i]->slave_count;
	return n;
}

int bus_save_begin(const struct tool *t, struct save *s, const char *path)
{
	struct stat st;

	if (!t->force && !stat(path, &st) && S_ISREG(st.st_mode) && st.st_size)
		return fail("%s exists; -f overwrites it", path);
	return save_begin(s, path);
}

static int save_to(const struct tool *t, const char *path, const struct ecb_bus *bus)
{
	struct save s;

	if (bus_save_begin(t, &s, path))
		return 1;
	fprintf(s.f, "# EtherCAT bus; made by 'ethercat bus save'\n");
	ecb_file_write(bus, s.f);
	if (save_end(&s))
		return 1;
	out_str("file", path, "%s: ", path);
	out_u("slaves", slaves_of(bus), "%zu slave(s)\n", slaves_of(bus));
	return 0;
}

/* on stdout; in JSON as one text */
static int print_text(int (*write)(const struct ecb_bus *bus, FILE *to), const struct ecb_bus *bus)
{
	char *text = NULL;
	size_t size = 0;
	FILE *f = open_memstream(&text, &size);
	int err;

	if (!f)
		return fail("out of memory");
	err = write(bus, f);
	if (fclose(f) || err) {
		free(text);
		return fail("out of memory");
	}
	out_str("text", text, "%s", text);
	free(text);
	return 0;
}

static int save(struct tool *t, int argc, char **argv)
{
	struct bus_wish wish = { .whole = t->whole };
	struct ecb_bus *bus;
	int ret = bus_of_machine(t, &wish, &bus);

	if (ret)
		return ret;
	ret = argc ? save_to(t, argv[0], bus) : print_text(ecb_file_write, bus);
	ecb_bus_free(bus);
	return ret;
}

static const char *const kinds[] = {
	[ECB_MISSING] = "missing", [ECB_EXTRA] = "extra", [ECB_EXCHANGED] = "exchanged",
	[ECB_MOVED] = "moved", [ECB_VALUE_DIFFERS] = "value",
	[ECB_PENDING] = "pending",
};

void bus_show_difference(void *ctx, const struct ecb_difference *d)
{
	const struct bus_names *n = ctx;

	out_object(NULL);
	out_str("kind", kinds[d->kind], NULL);
	out_u("master", d->master, NULL);
	out_u("line", d->line, NULL);
	if (d->line)
		out_text("%s:%u: ", n->expected, d->line);
	else if (d->found_line)
		out_text("%s:%u: ", n->found, d->found_line);
	if (n->several || !*d->slave)
		out_text("master %u: ", d->master);
	out_str("slave", d->slave, NULL);
	out_str("key", d->key, NULL);
	if (*d->slave)
		out_text("slave '%s' ", d->slave);
	if (*d->key && d->kind != ECB_MOVED)
		out_text("%s ", d->key);
	out_text("%s: ", d->kind == ECB_VALUE_DIFFERS ? "differs" : kinds[d->kind]);
	out_str("expected", d->expected, NULL);
	out_str("found", d->found, NULL);
	if (*d->expected && *d->found)
		out_text("expected %s, found %s", d->expected, d->found);
	else
		out_text("%s", *d->expected ? d->expected : d->found);
	out_str("remedy", d->remedy, *d->remedy ? "; %s" : "%s", d->remedy);
	out_text("\n");
	out_end();
}

static int compare(const struct ecb_bus *a, const char *a_name, const struct ecb_bus *b,
		   const char *b_name, unsigned int flags)
{
	struct bus_names names = { a_name, b_name, a->master_count > 1 || b->master_count > 1 };
	long n;

	out_array("differences");
	n = ecb_compare(a, b, flags, bus_show_difference, &names);
	out_end();
	if (n < 0)
		return fail("out of memory"), 2;
	if (!n)
		out_text("no difference, %zu slave(s)\n", slaves_of(b));
	else
		out_text("%ld difference(s)\n", n);
	return n ? 1 : 0;
}

/* slaves are asked for what the file says of their kind only */
static int check(struct tool *t, int argc, char **argv)
{
	struct bus_wish wish = { 0 };
	struct ecb_bus *file, *machine;
	int ret;

	(void)argc;
	ret = read_file(argv[0], &file);
	if (ret)
		return ret;
	wish.file = file;
	ret = bus_of_machine(t, &wish, &machine) ? 2 : 0;
	if (!ret) {
		ret = compare(file, argv[0], machine, "machine", ECB_COMPARE_MACHINE);
		/* equal, and not all was compared */
		if (!ret && wish.unread)
			ret = 2;
		ecb_bus_free(machine);
	}
	ecb_bus_free(file);
	return ret;
}

static int diff(struct tool *t, int argc, char **argv)
{
	struct ecb_bus *a, *b;
	int ret = read_file(argv[0], &a);

	(void)t;
	(void)argc;
	if (ret)
		return ret;
	ret = read_file(argv[1], &b);
	if (!ret) {
		ret = compare(a, argv[0], b, argv[1], 0);
		ecb_bus_free(b);
	}
	ecb_bus_free(a);
	return ret;
}

static void show_values(const struct ecb_slave *s, int depth)
{
	char name[ECB_VALUE];

	out_array("values");
	for (size_t p = 0; p < s->pdo_count; p++)
		for (size_t i = 0; i < s->pdos[p]->entry_count; i++) {
			const struct ecb_entry *e = s->pdos[p]->entries[i];

			if (!e->object || !ecb_name_value(name, s->name, e->name))
				continue;
			out_object(NULL);
			out_str("name", name, "%*s%s", depth, "", name);
			out_u("index", ECB_INDEX(e->object), "  0x%04x", ECB_INDEX(e->object));
			out_u("subindex", ECB_SUBINDEX(e->object), ":%02x",
			      ECB_SUBINDEX(e->object));
			out_u("bits", e->bits, ", %u bit(s)", e->bits);
			if (e->unit)
				out_str("unit", e->unit, ", %s", e->unit);
			out_text("\n");
			out_end();
		}
	out_end();
}

static void show_modules(const struct ecb_slave *s, int depth)
{
	out_array("modules");
	for (size_t i = 0; i < s->module_count; i++) {
		const struct ecb_module *m = s->modules[i];

		out_object(NULL);
		out_u("slot", m->slot, "%*sslot %u", depth, "", m->slot);
		out_u("ident", m->ident, "  module 0x%08x", m->ident);
		if (m->name)
			out_str("name", m->name, "  %s", m->name);
		out_text("\n");
		out_end();
	}
	out_end();
}

/* a slave by its name */
struct named {
	const char *name;
	size_t at;
};

static int by_name(const void *a, const void *b)
{
	return strcmp(((const struct named *)a)->name, ((const struct named *)b)->name);
}

/* @to: index of each slave's parent, or the number of slaves */
static void find_parents(const struct ecb_master *m, struct named *names, size_t *to)
{
	size_t n = m->slave_count;

	for (size_t i = 0; i < n; i++)
		names[i] = (struct named){ m->slaves[i]->name, i };
	qsort(names, n, sizeof(*names), by_name);
	for (size_t i = 0; i < n; i++) {
		const struct named key = { m->slaves[i]->parent, 0 };
		const struct named *parent = key.name ? bsearch(&key, names, n, sizeof(key),
								by_name) : NULL;

		to[i] = parent ? parent->at : n;
	}
}

/* the first line stays at the margin, branches go in; a parent may stand behind its branches */
static void find_depths(const struct ecb_master *m, const size_t *parents, size_t *path,
			int *depths)
{
	for (size_t i = 0; i < m->slave_count; i++) {
		size_t n = 0, at = i;

		for (; at < m->slave_count && !depths[at] && n < m->slave_count; at = parents[at])
			path[n++] = at;
		while (n--) {
			size_t p = parents[path[n]];
			int in = p < m->slave_count ? depths[p] : 2;

			if (p < m->slave_count && m->slaves[path[n]]->port > 1 && in < DEPTH_MAX)
				in += 2;
			depths[path[n]] = in;
		}
	}
}

/* columns of each slave, to be freed; NULL without memory */
static int *depths_of(const struct ecb_master *m)
{
	struct named *names = calloc(m->slave_count + 1, sizeof(*names));
	size_t *parents = calloc(m->slave_count + 1, sizeof(*parents));
	size_t *path = calloc(m->slave_count + 1, sizeof(*path));
	int *depths = calloc(m->slave_count + 1, sizeof(*depths));

	if (names && parents && path && depths) {
		find_parents(m, names, parents);
		find_depths(m, parents, path, depths);
	} else {
		free(depths);
		depths = NULL;
	}
	free(names);
	free(parents);
	free(path);
	return depths;
}

/* in the order of the bus */
static void show_slave(const struct ecb_master *m, size_t i, const int *depths)
{
	const struct ecb_slave *s = m->slaves[i];

	out_object(NULL);
	out_str("name", s->name, "%*s%s", depths[i], "", s->name);
	if (s->type)
		out_str("type", s->type, "  %s", s->type);
	out_u("vendor", s->vendor, "  0x%08x", s->vendor);
	out_u("product", s->product, ":0x%08x", s->product);
	if (s->alias)
		out_u("alias", s->alias, ", alias %u", s->alias);
	if (s->parent) {
		out_str("parent", s->parent, ", at %s", s->parent);
		out_u("port", s->port, " port %u", s->port);
	}
	out_text("\n");
	show_modules(s, depths[i] + 4);
	show_values(s, depths[i] + 4);
	out_end();
}

static int show(struct tool *t, int argc, char **argv)
{
	struct ecb_bus *bus;
	int ret = read_file(argv[0], &bus);

	(void)t;
	(void)argc;
	if (ret)
		return ret;
	out_array("masters");
	for (size_t i = 0; i < bus->master_count && !ret; i++) {
		const struct ecb_master *m = bus->masters[i];
		int *depths = depths_of(m);

		if (!depths) {
			ret = fail("out of memory");
			break;
		}
		out_object(NULL);
		out_u("index", m->index, "master %u", m->index);
		if (m->cycle)
			out_i("cycle_ns", m->cycle, ", cycle %lld ns", (long long)m->cycle);
		out_text(", %zu slave(s)\n", m->slave_count);
		out_array("slaves");
		for (size_t k = 0; k < m->slave_count; k++)
			show_slave(m, k, depths);
		out_end();
		out_end();
		free(depths);
	}
	out_end();
	ecb_bus_free(bus);
	return ret;
}

static int compile(struct tool *t, int argc, char **argv)
{
	struct ecb_bus *bus;
	int ret;

	(void)argc;
	if (!t->output_file)
		return usage_error("bus compile needs --output-file"), 2;
	ret = read_file(argv[0], &bus);
	if (ret)
		return ret;
	ret = bus_compile(t, argv[0], bus);
	ecb_bus_free(bus);
	return ret;
}

static int write_schema(const struct ecb_bus *bus, FILE *to)
{
	(void)bus;
	return ecb_file_schema(to);
}

static int schema(struct tool *t, int argc, char **argv)
{
	(void)t;
	(void)argc;
	(void)argv;
	return print_text(write_schema, NULL);
}

static const struct {
	const char *name;
	int (*run)(struct tool *t, int argc, char **argv);
	int min_args;
	int max_args;
} verbs[] = {
	{ "save", save, 0, 1 }, { "check", check, 1, 1 }, { "diff", diff, 2, 2 },
	{ "show", show, 1, 1 }, { "compile", compile, 1, 1 }, { "schema", schema, 0, 0 },
};

static int run(struct tool *t, int argc, char **argv)
{
	for (size_t i = 0; i < sizeof(verbs) / sizeof(verbs[0]); i++)
		if (!strcmp(argv[0], verbs[i].name)) {
			if (argc - 1 < verbs[i].min_args || argc - 1 > verbs[i].max_args)
				return usage_error("bus %s: %d argument(s), expected %d to %d",
						   argv[0], argc - 1, verbs[i].min_args,
						   verbs[i].max_args), 2;
			return verbs[i].run(t, argc - 1, argv + 1);
		}
	return usage_error("'%s': use save, check, diff, show, compile or schema", argv[0]), 2;
}
#endif

const struct cmd cmd_bus = {
	.name = "bus",
	.run = run,
	.args = "save [<FILE>] | check <FILE> | diff <FILE> <FILE> | show <FILE> | compile <FILE> | schema",
	.opts = "mofZ",
	.summary = "Write the bus to a file, compare it with a file, show a file",
	.help = "A bus file is YAML: masters, slaves and what they need, names of values.\n"
		"\n"
		"'save' writes the bus of the selected masters: names, identity and ports of the\n"
		"slaves; with --whole also serial numbers, PDOs and modules as the slaves have them\n"
		"now, active SYNC signals, sync units and groups of the session. It asks slaves by\n"
		"mailbox, and writes nothing to them. Without FILE it writes to stdout. An existing\n"
		"file is overwritten with -f only.\n"
		"\n"
		"'check' compares the bus with a file, line by line: place, cause and remedy of each\n"
		"difference; a startup value that no session has written yet is pending, and no\n"
		"difference. Slaves are found by alias, identification and serial number, the others\n"
		"by identity in the order of the bus: one slave more is one difference.\n"
		"\n"
		"'diff' compares two files. 'show' shows the slaves of a file as a tree, with the\n"
		"names of its values. 'compile' writes what an application in the kernel configures\n"
		"its master by, with ecrt_master_load_compiled(), to --output-file; no bus is asked.\n"
		"'schema' prints the JSON Schema of bus files for editors.\n"
		"\n"
		"Exit code of 'check' and 'diff': 0 equal, 1 differences, 2 not all compared.\n",
	.json = "save: file, slaves, or text; compile: file, size; schema: text;\n"
		"check, diff: differences[]: kind (missing, extra, exchanged, moved, value, pending),\n"
		"master, line, slave, key, expected, found, remedy;\n"
		"show: masters[]: index, cycle_ns, slaves[]: name, type, vendor, product, alias,\n"
		"parent, port, modules[]: slot, ident, name; values[]: name, index, subindex, bits, unit",
	.flags = CMD_COMPARES,
	.min_args = 1,
	.max_args = 3,
};
