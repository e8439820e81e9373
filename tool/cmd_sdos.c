// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../master/wire/sdoinfo.h"
#include "../master/wire/sii.h"
#include "io.h"
#include "out.h"
#include "sdo.h"
#include "text.h"

#define ROOM		(64u << 10)	/* the largest answer the kernel passes on */
#define PROGRESS_S	1.0		/* what is done sooner needs no progress */

/* reading the dictionary of one slave */
struct dict {
	const struct tool *t;
	struct dev *d;
	u16 position;
	double begin;
	bool shown;	/* progress */
	u8 *buf;
};

#define REFUSED	(-1)

/* 0, or errno; REFUSED with @quiet: no error is printed */
static int ask(struct dict *x, u8 what, u16 index, u8 sub, size_t *size, bool quiet)
{
	struct ec_ioc_sdo_info i = {
		.position = x->position, .index = index, .subindex = sub, .what = what,
		.size = ROOM, .data = (uintptr_t)x->buf,
	};
	int err = dev_ioctl(x->d, EC_IOC_SDO_INFO, &i);

	*size = min(i.size, ROOM);
	if (!err)
		return 0;
	if (quiet && i.abort_code)
		return REFUSED;
	if (i.abort_code)
		fail_full(err, NULL, i.abort_code,
			  "Master%u slave %u: cannot read the object dictionary", x->d->master,
			  x->position);
	else
		dev_fail(x->d, err, "Master%u slave %u: cannot read the object dictionary",
			 x->d->master, x->position);
	return err;
}

static void progress(struct dict *x, size_t done, size_t all)
{
	if (x->t->json || x->t->verbosity < 0 || !isatty(STDERR_FILENO) ||
	    isatty(STDOUT_FILENO) || now_s() - x->begin < PROGRESS_S)
		return;
	x->shown = true;
	fprintf(stderr, "\rslave %u: %zu of %zu objects", x->position, done, all);
	if (done == all)
		fputc('\n', stderr);
}

static void name_of(char *to, size_t size, const char *name, size_t len)
{
	snprintf(to, size, "%.*s", (int)min(len, size - 1), name);
	string_clean(to, size);
}

static void access_text(u16 access, char to[7])
{
	for (unsigned int i = 0; i < 3; i++) {
		to[2 * i] = access & EC_OD_READ_PREOP << i ? 'r' : '-';
		to[2 * i + 1] = access & EC_OD_WRITE_PREOP << i ? 'w' : '-';
	}
	to[6] = 0;
}

static const struct ec_type *type_for(u16 code, size_t size)
{
	const struct ec_type *t = ec_type_by_code(code);

	return t && (!value_bytes(t) || value_bytes(t) == size) ? t :
	       ec_type_by_code(EC_TYPE_RAW);
}

/* One line of the table; io_print() would give the bytes of a text as they are. */
static void print_value(const struct ec_type *t, u8 *data, size_t size)
{
	if (out_is_json() || !value_is_text(t)) {
		io_print(t, data, size);
	} else if (t->kind == EC_KIND_STRING) {
		data[size] = 0;
		string_clean((char *)data, size + 1);
		out_text("\"%s\"\n", (char *)data);
	} else {
		io_print(ec_type_by_code(EC_TYPE_RAW), data, size);
	}
}

/* The value now; what the slave refuses has a code. */
static void value(struct dict *x, const struct ec_od_entry *e)
{
	struct ec_ioc_sdo s = {
		.position = x->position, .index = e->index, .subindex = e->sub, .size = ROOM,
		.data = (uintptr_t)x->buf,
	};
	u16 code = e->type;
	int err = dev_ioctl(x->d, EC_IOC_SDO_UPLOAD, &s);

	if (err && s.abort_code) {
		out_u("abort_code", s.abort_code, ", abort 0x%08x\n", s.abort_code);
		return;
	}
	if (err) {
		out_str("error", strerror(err), ", %s\n", strerror(err));
		return;
	}
	out_text(", ");
	out_object("value");
	print_value(type_for(code, s.size), x->buf, min(s.size, ROOM));
	out_end();
}

static void entry(struct dict *x, const struct ec_od_entry *e)
{
	const struct ec_type *t = ec_type_by_code(e->type);
	char access[7], type[32], name[256];

	access_text(e->access, access);
	if (t)
		snprintf(type, sizeof(type), "%s", t->name);
	else
		snprintf(type, sizeof(type), "type %04x", e->type);
	name_of(name, sizeof(name), e->name, e->name_len);
	out_object(NULL);
	out_u("subindex", e->sub, "  0x%04x:%02x, ", e->index, e->sub);
	out_str("access", access, "%s, ", access);
	out_str("type", type, "%s, ", type);
	out_u("type_code", e->type, NULL);
	out_u("size_bits", e->bits, "%u bit, ", e->bits);
	out_str("name", name, "\"%s\"", name);
	/* only what can be read in some state */
	if (x->t->verbosity > 0 && e->access & EC_OD_READ)
		value(x, e);
	else
		out_text("\n");
	out_end();
}

static int entries(struct dict *x, u16 index, u8 max_sub)
{
	int err = 0;

	out_array("entries");
	for (unsigned int sub = 0; sub <= max_sub && !err; sub++) {
		struct ec_od_entry e;
		size_t size;

		err = ask(x, EC_SDO_INFO_ENTRY, index, (u8)sub, &size, true);
		/* the buffer takes the value next */
		if (!err && !ec_od_entry_decode(x->buf, size, &e)) {
			char name[256];

			e.name_len = min(e.name_len, sizeof(name));
			memcpy(name, e.name, e.name_len);
			e.name = name;
			entry(x, &e);
		} else if (err == REFUSED) {
			err = 0;
		}
	}
	out_end();
	return err;
}

static int object(struct dict *x, u16 index)
{
	struct ec_od_object o;
	char name[256];
	size_t size;
	int err = ask(x, EC_SDO_INFO_OBJECT, index, 0, &size, true);

	if (err)
		return err == REFUSED ? 0 : err;
	if (ec_od_object_decode(x->buf, size, &o))
		return 0;
	name_of(name, sizeof(name), o.name, o.name_len);
	out_object(NULL);
	out_u("index", index, "SDO 0x%04x, ", index);
	out_str("name", name, "\"%s\"\n", name);
	out_u("object_code", o.code, NULL);
	out_u("type_code", o.type, NULL);
	out_u("max_subindex", o.max_sub, NULL);
	if (x->t->verbosity >= 0)
		err = entries(x, index, o.max_sub);
	out_end();
	return err;
}

static int dictionary(struct dict *x)
{
	size_t size, n;
	int err = ask(x, EC_SDO_INFO_LIST, 1, 0, &size, false);
	u8 *list;

	if (err)
		return 1;
	list = malloc(size + 1);
	if (!list)
		return fail("out of memory");
	memcpy(list, x->buf, size);
	n = size / 2;
	for (size_t i = 0; i < n && !err; i++) {
		err = object(x, get_unaligned_le16(list + 2 * i));
		progress(x, i + 1, n);
	}
	if (err && x->shown)
		fputc('\n', stderr);
	free(list);
	return err ? 1 : 0;
}

/* Does the slave describe its objects, as far as its EEPROM says? */
static bool describes(const struct ec_ioc_slave *s)
{
	return s->mbox_protocols & EC_SII_PROTO_COE &&
	       (!s->coe_details || s->coe_details & EC_SII_COE_SDO_INFO);
}

static int slave(const struct slave_walk *w, const struct tool *t, struct dev *d,
		 const struct ec_ioc_slave *s, bool several)
{
	struct dict x = {
		.t = t, .d = d, .position = s->position, .begin = now_s(), .buf = malloc(ROOM + 1),
	};
	int ret;

	(void)w;
	if (!x.buf)
		return fail("out of memory");
	out_object(NULL);
	out_u("position", s->position, NULL);
	if (several)
		out_text("=== Master %u, Slave %u ===\n", d->master, s->position);
	out_array("objects");
	ret = dictionary(&x);
	out_end();
	out_end();
	free(x.buf);
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
		.write = true, .takes = describes, .slave = slave, .end = end,
	};

	(void)argc, (void)argv;
	return dev_each_slave(t, &walk);
}

const struct cmd cmd_sdos = {
	.name = "sdos",
	.run = run,
	.args = "",
	.opts = "mapqv",
	.summary = "Show the object dictionary of slaves",
	.help = "Read from the slave at each call. An entry has access in PREOP, SAFEOP and OP (r: read,\n"
		"w: write), data type, size and name. --quiet omits the entries, --verbose reads the\n"
		"values of all that can be read: an entry that the slave does not give has its abort code.\n"
		"Slaves without CoE or without SDO information are skipped.\n"
		"  ethercat sdos -p4 -v > before.txt     compare with diff\n",
	.json = "masters[]: master, slaves[]: position, objects[]: index, name, object_code,\n"
		"type_code, max_subindex, entries[]: subindex, access, type, type_code, size_bits,\n"
		"name, with --verbose value (type, size_bytes, value, data_hex), abort_code or\n"
		"error",
	.flags = CMD_HISTORIC,
};
