// SPDX-License-Identifier: LGPL-2.1-or-later
/* Bus files: what is read is written, each error has its place, hostile files are refused. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../../include/ethercat-bus.h"

static int bad;

#define HEAD	"ethercat: 1\nmasters:\n- slaves:\n"
#define SLAVE	HEAD "  - vendor: 2\n    product: 3\n"
#define PDO	SLAVE "    pdos:\n    - index: 0x1a00\n      sm: 3\n      entries:\n"
#define MODULE	SLAVE "    modules:\n    - slot: 1\n"
#define SDO	SLAVE "    startup:\n    - at: safeop\n"
#define MASTER	"ethercat: 1\nmasters:\n- "

static const struct {
	const char *text;
	const char *error;	/* NULL: valid */
} rows[] = {
	{ "", "t:1:1: an empty file; expected 'ethercat: 1'" },
	{ "# only a comment\n", "t:1:1: an empty file; expected 'ethercat: 1'" },
	{ "5", "t:1:1: found '5', expected keys of a bus file" },
	{ "[]", "t:1:1: found a list, expected keys of a bus file" },
	{ "ethercat: 1", "t:1:1: a bus file without 'masters'" },
	{ "ethercat: 2", "t:1:11: ethercat: found '2', expected a number from 1 to 1" },
	{ "ethercat: 1\nmasters: 5", "t:2:10: masters: found '5', expected a list" },
	{ "ethercat: 1\nmasters:\n", "t:2:9: masters: found nothing, expected a list" },
	{ "ethercat: 1\nmasters: []\n", NULL },
	{ "{\"ethercat\": 1, \"masters\": [{\"cycle\": \"250 us\", \"slaves\": []}]}", NULL },
	{ "ethercat: 1\nmasters: []\n---\nethercat: 1\n",
	  "t:3:1: a second document; expected the end of the file" },
	{ "ethercat: 1\nmaster: []\n",
	  "t:2:1: unknown key 'master' of a bus file; did you mean 'masters'?" },
	{ "ethercat: 1\nx: []\n",
	  "t:2:1: unknown key 'x' of a bus file; expected one of ethercat, masters" },
	{ "ethercat: 1\nethercat: 1\n", "t:2:1: key 'ethercat' of a bus file twice" },
	{ "? [a]\n: 1\n", "t:1:3: expected a key of a bus file" },
	{ MASTER "ring: true\n", "t:3:3: 'ring' (cable redundancy) is not supported yet; remove it" },
	{ MASTER "cycle: 1 min\n", "t:3:10: cycle: found '1 min', expected a time from 10 us to 1 s "
	  "with ns, us, ms or s" },
	{ MASTER "cycle: 2 s\n", "cycle: found '2 s'" },
	{ MASTER "cycle: 99999999999999999999 s\n", "cycle: found '9" },
	{ MASTER "index: 1\n- index: 0x1\n", "t:4: master 1 twice" },
	{ MASTER "reference_clock: x\n", "t:3: no slave 'x' in this master" },
	{ MASTER "groups: [{name: a, alias: 1, identification: 2}]\n", "needs exactly one of alias" },
	{ MASTER "groups: [{name: a, alias: 1}, {name: a, alias: 2}]\n", "group 'a' twice" },
	{ MASTER "groups: [{name: a, alias: 1, fast: true}]\n", "'fast' of a hot connect group" },
	{ MASTER "sync_units: [{name: a}, {name: a}]\n", "sync unit 'a' twice" },
	{ MASTER "sync_units: [{name: a, policy: of}]\n",
	  "policy: found 'of', expected one of continue, zero, hold, safeop, stop" },
	{ HEAD "  - 5\n", "t:4:5: found '5', expected keys of a slave" },
	{ HEAD "  - vendor: 2\n", "t:4:5: a slave without 'product'" },
	{ HEAD "  - vender: 2\n", "t:4:5: unknown key 'vender' of a slave; did you mean 'vendor'?" },
	{ HEAD "  - vendor: 0x100000000\n", "t:4:13: vendor: found '0x100000000', expected a number "
	  "from 0x0 to 0xffffffff" },
	{ HEAD "  - vendor: -1\n", "found '-1'" }, { HEAD "  - vendor: 2k\n", "found '2k'" },
	{ HEAD "  - vendor:\n", "vendor: found nothing" },
	{ HEAD "  - vendor: [2]\n", "vendor: found a list" },
	{ HEAD "  - aoe: {}\n", "'aoe' (AoE) is not supported yet" },
	{ SLAVE, NULL },
	{ SLAVE "    name: a b\n", "name: found 'a b', expected 1 to 63 letters" },
	{ SLAVE "    name: a.b\n", "name: found 'a.b'" },
	{ SLAVE "    name: a\n  - name: a\n    vendor: 2\n    product: 2\n",
	  "t:7: slave 'a' twice, first in line 4; expected different names" },
	{ SLAVE "    type: \"a\\x1b[31m\"\n", "type: found 'a?[31m', expected 1 to 127 bytes" },
	{ SLAVE "    type: \"a\\0b\"\n", "type: found 'a'" },
	{ SLAVE "    type: \"\\u202eb\"\n", "type: found" },
	{ SLAVE "    parent: x\n    port: 1\n", "t:4: no slave 'x' in this master" },
	{ SLAVE "    name: axis\n  - {vendor: 2, product: 3, parent: axes, port: 1}\n",
	  "t:7: no slave 'axes'; did you mean 'axis'?" },
	{ SLAVE "    name: a\n    parent: a\n    port: 1\n", "slave 'a' is upstream of itself" },
	{ HEAD "  - {vendor: 2, product: 3, name: a, parent: b, port: 1}\n"
	  "  - {vendor: 2, product: 3, name: b}\n", NULL },
	{ HEAD "  - {vendor: 2, product: 3, name: a, parent: b, port: 1}\n"
	  "  - {vendor: 2, product: 3, name: b, parent: c, port: 1}\n"
	  "  - {vendor: 2, product: 3, name: c, parent: b, port: 1}\n",
	  "t:5: slave 'b' is upstream of itself" },
	{ SLAVE "    name: a\n  - {vendor: 2, product: 3, parent: a}\n", "'parent' and 'port'" },
	{ SLAVE "    port: 1\n", "needs both 'parent' and 'port'" },
	{ SLAVE "    alias: 5\n  - {vendor: 2, product: 3, alias: 5}\n",
	  "t:7: alias 5 of 'slave_2' is that of 'slave'" },
	{ SLAVE "    identification: 5\n  - {vendor: 2, product: 3, identification: 5}\n",
	  "identification 5 of 'slave_2'" },
	{ SLAVE "    group: x\n", "no hot connect group 'x'" },
	{ SLAVE "    sync_unit: x\n", "no sync unit 'x'" },
	{ SLAVE "    timeouts: 5\n", "timeouts: found '5', expected keys with values" },
	{ SLAVE "    clock: {assign_activate: 0x300, sync0_shift: -1 s}\n", NULL },
	{ SLAVE "    clock: {assign_activate: 0x300, sync0_shift: -3 s}\n", "found '-3 s', expected a "
	  "time from -2147483647 ns to 2147483647 ns" },
	{ PDO "      - {bits: 1, name: a}\n", "t:10: a PDO entry without object is a gap" },
	{ PDO "      - {bits: 0}\n", "bits: found '0', expected a number from 1 to 255" },
	{ PDO "      - {bits: 8, object: 0x6000}\n", "expected an object such as 0x6000:01" },
	{ PDO "      - {bits: 8, object: 0x0000:01}\n", "expected an object" },
	{ PDO "      - {bits: 8, object: 0x6000:01, type: int16}\n", "type of 16 bits for an entry of 8" },
	{ PDO "      - {bits: 8, object: 0x6000:01, name: a.b.c}\n", "name: found 'a.b.c'" },
	{ PDO "      - {bits: 8, object: 0x6000:01, scale: 1e999}\n", "scale: found '1e999'" },
	{ PDO "      - {bits: 8, object: 0x6000:01, scale: .inf}\n", "scale: found '.inf'" },
	{ PDO "      - {bits: 8, object: 0x6000:01, name: a}\n"
	  "      - {bits: 8, object: 0x6000:02, name: a}\n", "two values of the same name" },
	{ PDO "      - {bits: 8, object: 0x6000:01, unit: furlong}\n", NULL },
	{ PDO "      - {bits: 8}\n    - {index: 0x1a00, sm: 3}\n", "t:11: PDO 0x1a00 twice" },
	{ MODULE "      ident: 7\n    write_modules: true\n", NULL },
	{ MODULE, "t:7:7: a module without 'ident'" },
	{ MODULE "      ident: 0\n", "ident: found '0', expected a number from 0x1 to 0xffffffff" },
	{ MODULE "      ident: 7\n    - {slot: 256, ident: 7}\n", "slot: found '256'" },
	{ MODULE "      ident: 7\n    - {slot: 1, ident: 8}\n", "t:9: slot 1 twice" },
	{ SLAVE "    write_modules: true\n", "t:4: 'write_modules' of slave 'slave' without" },
	{ SDO "      value: 1\n", "with 0 targets; expected one of register, sdo and idn" },
	{ SDO "      sdo: 0x8000:01\n", "needs either 'data', or 'type' and 'value'" },
	{ SDO "      sdo: 0x8000:01\n      value: 1\n", "needs either 'data'" },
	{ SDO "      sdo: 0x8000:01\n      value: 256\n      type: uint8\n", "256 does not fit" },
	{ SDO "      sdo: 0x8000:01\n      value: -129\n      type: int8\n", "-129 does not fit" },
	{ SDO "      sdo: 0x8000:01\n      type: int64\n      value: -9223372036854775808", NULL },
	{ SDO "      sdo: 0x8000:01\n      value: -9223372036854775809\n", "expected a number with" },
	{ SDO "      sdo: 0x8000:01\n      data: 0\n", "data: found '0', expected 1 to 4096 bytes" },
	{ SDO "      register: 0x10000\n", "register: found '0x10000'" },
	{ SDO "      idn: S-8-0000\n", "idn: found 'S-8-0000', expected an IDN such as S-0-0032" },
	{ SDO "      idn: P-0-4096\n", "idn: found" },
	{ SDO "      register: 1\n      complete: yes\n", "complete: found 'yes', expected true or false" },
	{ SDO "      register: 1\n      complete: true\n      data: 01\n", "'complete' without 'sdo'" },
	{ SDO "      register: 1\n      drive: 1\n      data: 01\n", "'drive' without 'idn'" },
	/* YAML that a bus file does not use */
	{ "a: &x 1\n", "t:1:1: unknown key 'a'" },
	{ "ethercat: &x 1\n", "t:1:11: anchor 'x'; expected a value without it" },
	{ "ethercat: !!int 1\n", "tag 'tag:yaml.org,2002:int'; expected a value without it" },
	{ "ethercat: 1\nmasters: *x\n", "t:2:10: alias '*x'; expected the value itself" },
	{ "%TAG !a! b\n---\nethercat: 1\nmasters: []\n", "t:1:1: a line that begins with '%'" },
	{ "ethercat: 1\nmasters: []\n...\n%YAML 1.1\n", "t:4:1: a line that begins with '%'" },
	{ "#\r%YAML 1.1\r", "a line that begins with '%'" },
	{ "#\xc2\x85%YAML 1.1\n", "a line that begins with '%'" },
	{ "#\xe2\x80\xa8%YAML 1.1\n", "a line that begins with '%'" },
	{ "ethercat: 1\nmasters: [{slaves: [{vendor: 1, product: 2, type: a 5 %}]}]\n", NULL },
	{ "&a [*a,*a,*a,*a,*a,*a,*a,*a]", "t:1:1: anchor 'a'" },
	{ "ethercat: 1\nmasters: [\n", "expected YAML" },
	{ "ethercat:\t1: 2\n\t- 3", "expected YAML" },
	/* encodings: UTF-16, Latin-1, NUL */
	{ "\xff\xfe" "e", "t:1:1: invalid leading UTF-8 octet; expected YAML in UTF-8" },
	{ "ethercat: 1\n# caf\xe9\n", "t:2:6: incomplete UTF-8" },
	{ "ethercat: \x01\n", "t:1:11: control characters are not allowed; expected YAML in UTF-8" },
	{ "\xef\xbb\xbf" "ethercat: 1\nmasters: []\n", NULL },
};

static void row(const char *text, size_t size, const char *error)
{
	struct ecb_error e;
	struct ecb_bus *bus;
	int ret = ecb_file_parse(&bus, "t", text, size, &e);

	if (error ? ret != -EINVAL || bus || !strstr(e.text, error) : ret != 0) {
		printf("%.300s\n: %d '%s', expected '%s'\n", text, ret, e.text, error ? error : "");
		bad++;
	}
	ecb_bus_free(bus);
}

/* @n times @piece behind the beginning of a file */
static void many(const char *head, const char *piece, size_t n, const char *error)
{
	size_t len = strlen(piece), at = strlen(head);
	char *text = malloc(at + n * len + 1);

	memcpy(text, head, at);
	for (size_t i = 0; i < n; i++, at += len)
		memcpy(text + at, piece, len);
	text[at] = 0;
	row(text, at, error);
	free(text);
}

static void hostile(void)
{
	many("", "#\n", 50 << 20, "t: larger than 64 MiB");
	many("", "#\n", (64 << 20) / 2 - 1, "an empty file");
	many("", "[", 1000000, "found a list, expected keys of a bus file");
	many("", "{", 1000000, "t:1:2: expected a key of a bus file");
	many("", "- ", 1000000, "found a list");
	many("ethercat: 1\nmasters: ", "[", 1000000, "found a list, expected keys of a master");
	many("ethercat: ", "1", 1000000, "expected a number from 1 to 1");
	many(SLAVE "    name: ", "a", 1000000, "expected 1 to 63 letters");
	many(SLAVE "    type: ", "a", 1000000, "expected 1 to 127 bytes");
	many("", "a", 1000000, "expected keys of a bus file");
	many(HEAD, "  - {vendor: 1, product: 2}\n", 65536, "slaves: expected at most 65535");
	many(HEAD, "  - {vendor: 1, product: 2}\n", 65535, NULL);
	many(SLAVE "    pdos:\n", "    - {index: 1, sm: 1}\n", 1025, "pdos: expected at most 1024");
	many("ethercat: 1\nmasters:\n", "- {}\n", 33, "masters: expected at most 32");
	many(SDO "      sdo: 0x8000:01\n      data: ", "01 ", 5000, "expected 1 to 4096 bytes");
	many("", "%TAG !a! b\n", 1000000, "t:1:1: a line that begins with '%'");
	row("ethercat: 1\0x", 13, "t:1:12: control characters are not allowed");
}

/* what is written is read as the same */
static void whole(const char *path)
{
	char *text[2] = { NULL, NULL };
	size_t size[2] = { 0, 0 };
	struct ecb_bus *bus;
	struct ecb_error e;

	if (ecb_file_read(&bus, path, &e)) {
		printf("%s\n", e.text);
		bad++;
		return;
	}
	for (int i = 0; i < 2; i++) {
		FILE *f = open_memstream(&text[i], &size[i]);

		if (ecb_file_write(bus, f))
			bad++;
		fclose(f);
		ecb_bus_free(bus);
		if (ecb_file_parse(&bus, "again", text[i], size[i], &e)) {
			printf("%s\n", e.text);
			bad++;
		}
	}
	if (!bus || strcmp(text[0], text[1]) || !strstr(text[0], "offset: -10}\n") ||
	    !strstr(text[0], "register: 0x0120, data: \"02 00\"}\n") ||
	    strcmp(bus->masters[0]->slaves[2]->name, "el1008") ||
	    strcmp(bus->masters[0]->slaves[1]->pdos[0]->entries[0]->name, "control")) {
		printf("written: %s\nagain: %s\n", text[0], text[1]);
		bad++;
	}
	ecb_bus_free(bus);
	free(text[0]);
	free(text[1]);
}

static void made(void)
{
	struct ecb_bus *bus = ecb_bus_new();
	struct ecb_master *m = ecb_master_add(bus);
	struct ecb_slave *s = ecb_slave_add(bus, m);
	struct ecb_pdo *p = ecb_pdo_add(bus, s);
	struct ecb_entry *entry = ecb_entry_add(bus, p);
	struct ecb_error e;

	s->type = ecb_bus_text(bus, "Gr\xfc\xc3\xbc\x1b\xef\xbf\xbe\xef\xbf\xbf\xef\xbb\xbf");
	entry->object = 0x600001;
	entry->bits = 8;
	if (ecb_bus_text(bus, "") || strcmp(s->type, "Gr?\xc3\xbc??????????") ||
	    entry->scale != 1 ||
	    s->port != ECB_NONE8 || ecb_bus_finish(bus, NULL, &e) || strcmp(s->name, "gr") ||
	    strcmp(entry->name, "x6000_01")) {
		printf("made: '%s' '%s' '%s'\n", s->type, s->name, entry->name);
		bad++;
	}
	ecb_bus_free(bus);
	ecb_bus_free(NULL);
	if (ecb_file_read(&bus, "/nonexistent", &e) != -ENOENT ||
	    strcmp(e.text, "/nonexistent: No such file or directory") ||
	    ecb_file_read(&bus, "/", &e) != -EISDIR) {
		printf("%s\n", e.text);
		bad++;
	}
}

/* slaves as "name parent port alias"; e is a coupler, the others are equal terminals */
static struct ecb_bus *line_of_slaves(const char *slaves)
{
	struct ecb_bus *bus = ecb_bus_new();
	struct ecb_master *m = ecb_master_add(bus);
	char name[8], parent[8];
	unsigned int alias, port;
	struct ecb_error e;
	int n;

	for (; sscanf(slaves, " %7s %7s %u %u%n", name, parent, &port, &alias, &n) == 4;
	     slaves += n) {
		struct ecb_slave *s = ecb_slave_add(bus, m);

		s->vendor = 2;
		s->product = *name == 'e' ? 1 : 2;
		s->alias = (uint16_t)alias;
		s->name = ecb_bus_text(bus, name);
		if (*parent != '-') {
			s->parent = ecb_bus_text(bus, parent);
			s->port = (uint8_t)port;
		}
	}
	if (ecb_bus_finish(bus, NULL, &e)) {
		printf("%s: %s\n", slaves, e.text);
		bad++;
	}
	return bus;
}

static void note(void *ctx, const struct ecb_difference *d)
{
	static const char kinds[] = {
		[ECB_MISSING] = '-', [ECB_EXTRA] = '+', [ECB_EXCHANGED] = 'x', [ECB_MOVED] = 'm',
		[ECB_VALUE_DIFFERS] = 'v', [ECB_PENDING] = 'p',
	};
	char *to = ctx;

	if (strlen(to) < 64)
		sprintf(to + strlen(to), "%c%s ", kinds[d->kind], d->slave);
}

static void matches(void)
{
#define TWO	"e1 - 0 1  t1 e1 1 0  t2 t1 1 0  e2 e1 2 2  t3 e2 1 0  t4 t3 1 0"
#define BRANCH	"e1 - 0 0  t1 e1 1 0  t2 t1 1 0  t3 e1 2 0"
	static const struct { const char *a, *b, *differences; } cases[] = {
		{ TWO, TWO, "" },
		/* an alias is a border */
		{ TWO, "e1 - 0 1  m1 e1 1 0  e2 e1 2 2  m3 e2 1 0  m4 m3 1 0", "-t2 " },
		{ TWO, "e1 - 0 1  m1 e1 1 0  m2 m1 1 0  mx m2 1 0  e2 e1 2 2  m3 e2 1 0  m4 m3 1 0",
		  "+mx " },
		{ TWO, "e1 - 0 1  m1 e1 1 0  m2 m1 1 0  e2 e1 2 2  m3 e2 1 0", "-t4 " },
		/* twins: ports and parents say which one */
		{ BRANCH, "e1 - 0 0  m1 e1 1 0  m3 e1 2 0", "-t2 " },
		{ BRANCH, "e1 - 0 0  m1 e1 1 0  m2 m1 1 0", "-t3 " },
		{ BRANCH, "e1 - 0 0  m3 e1 2 0", "-t1 -t2 " },
	};

	for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
		struct ecb_bus *a = line_of_slaves(cases[i].a), *b = line_of_slaves(cases[i].b);
		char got[128] = "";

		ecb_compare(a, b, ECB_COMPARE_MACHINE, note, got);
		if (strcmp(got, cases[i].differences)) {
			printf("%s\n%s\n: '%s', expected '%s'\n", cases[i].a, cases[i].b, got,
			       cases[i].differences);
			bad++;
		}
		ecb_bus_free(a);
		ecb_bus_free(b);
	}
}

/* differences of two files, and of the second and the first one: as many */
static void differences(const char *x, const char *y, unsigned int flags, const char *expected)
{
	struct ecb_bus *a, *b;
	struct ecb_error e;
	char got[128] = "", back[128] = "";

	if (ecb_file_parse(&a, "a", x, strlen(x), &e) ||
	    ecb_file_parse(&b, "b", y, strlen(y), &e)) {
		printf("%s\n", e.text);
		exit(1);
	}
	/* as a machine tells it: all */
	for (size_t side = 0; side < 2; side++)
		for (size_t i = 0; i < (side ? b : a)->masters[0]->slave_count; i++)
			(side ? b : a)->masters[0]->slaves[i]->known = ~0U;
	if (ecb_compare(a, b, flags, note, got) != ecb_compare(b, a, flags, note, back) ||
	    strcmp(got, expected)) {
		printf("%s\n%s\n: '%s', back '%s', expected '%s'\n", x, y, got, back, expected);
		bad++;
	}
	ecb_bus_free(a);
	ecb_bus_free(b);
}

static void compared(void)
{
#define FIRST	HEAD "  - {name: a, vendor: 2, product: 3}\n"
#define PDOS(x)	SLAVE "    name: a\n    pdos: [" x "]\n"
	differences(FIRST "  - {name: b, vendor: 2, product: 4, parent: a, port: 1}\n",
		    FIRST "  - {name: b, vendor: 2, product: 4}\n", 0, "mb ");
	differences(PDOS("{index: 1, sm: 3, entries: [{bits: 8}]}"),
		    PDOS("{index: 1, sm: 3, entries: [{bits: 8, object: 0x6000:01}]}"),
		    ECB_COMPARE_MACHINE, "va ");
	differences(PDOS("{index: 1, sm: 3}, {index: 2, sm: 3}"),
		    PDOS("{index: 2, sm: 3}, {index: 1, sm: 3}"), ECB_COMPARE_MACHINE, "va ");
	differences(PDOS("{index: 1, sm: 2}, {index: 2, sm: 3}"),
		    PDOS("{index: 2, sm: 3}, {index: 1, sm: 2}"), ECB_COMPARE_MACHINE, "");
#define MODULES(x)	SLAVE "    name: a\n    modules: [" x "]\n"
	differences(MODULES("{slot: 1, ident: 7}, {slot: 3, ident: 8}"),
		    MODULES("{slot: 3, ident: 9, name: x}, {slot: 2, ident: 7}"), 0, "va va va ");
	differences(MODULES("{slot: 1, ident: 7}, {slot: 3, ident: 8}"),
		    MODULES("{slot: 3, ident: 8}, {slot: 1, ident: 7}"), ECB_COMPARE_MACHINE, "");
#define CLOCK(x)	SLAVE "    name: a\n    clock: {assign_activate: 0x300" x "}\n"
	differences(CLOCK(", sync0: 1 ms, sync0_shift: 5 us"),
		    CLOCK(", sync0: 2 ms, sync0_shift: 6 us"), ECB_COMPARE_MACHINE, "va va ");
#define START(x)	SLAVE "    name: a\n    startup: [" x "]\n"
	/* the last one of an object counts; as bytes */
	differences(START("{at: op, sdo: 0x8000:01, type: int16, value: -2}, "
			  "{at: op, sdo: 0x8000:01, type: int16, value: 5}"),
		    START("{at: preop, sdo: 0x8000:01, data: \"05 00\"}"), ECB_COMPARE_MACHINE, "");
	differences(START("{at: op, sdo: 0x8000:01, type: int16, value: 5}"),
		    START("{at: preop, sdo: 0x8000:01, data: \"05 01\"}"), ECB_COMPARE_MACHINE, "pa ");
}

static struct ecb_bus *largest(int reversed)
{
	struct ecb_bus *bus = ecb_bus_new();
	struct ecb_master *m = ecb_master_add(bus);
	struct ecb_error e;
	char name[16];

	for (unsigned int i = 0; i < 65535; i++) {
		struct ecb_slave *s = ecb_slave_add(bus, m);

		snprintf(name, sizeof(name), "s%u", reversed ? 65534 - i : i);
		s->name = ecb_bus_text(bus, name);
		s->vendor = s->product = 1;
		if (i && !reversed) {
			s->parent = m->slaves[i - 1]->name;
			s->port = 1;
		}
		for (unsigned int k = 0; i < 200 && k < 1024; k++)
			ecb_pdo_add(bus, s)->index = (uint16_t)(reversed ? 0x2000 - k : 0x1c00 + k);
	}
	if (ecb_bus_finish(bus, NULL, &e))
		bad++;
	return bus;
}

static void count(void *ctx, const struct ecb_difference *d)
{
	(void)d;
	++*(long *)ctx;
}

/* a hostile file: the largest lists, nothing where it was, in a time that does not grow as n^2 */
static void large(void)
{
	struct ecb_bus *a = largest(0), *b = largest(1);
	clock_t from = clock();
	long n = 0, got;

	got = ecb_compare(a, b, 0, count, &n) + ecb_compare(a, b, ECB_COMPARE_MACHINE, count, &n);
	if (got <= 65535 || n != got || clock() - from > 15 * CLOCKS_PER_SEC) {
		printf("65,535 slaves: %ld differences in %.1f s\n", got,
		       (double)(clock() - from) / CLOCKS_PER_SEC);
		bad++;
	}
	ecb_bus_free(a);
	ecb_bus_free(b);
}

int main(int argc, char **argv)
{
	for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++)
		row(rows[i].text, strlen(rows[i].text), rows[i].error);
	hostile();
	for (int i = 1; i < argc; i++)
		whole(argv[i]);
	made();
	matches();
	compared();
	large();
	return bad != 0;
}
