// SPDX-License-Identifier: LGPL-2.1-or-later
/* Bus files become compiled ones: which records, numbers of values, what is refused. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../include/ethercat-bus.h"
#include "../../include/ethercat-bus/load.h"
#include "../../master/wire/compiled.h"

static int bad;

#define CHECK(c) do {						\
		if (!(c)) {					\
			printf("%s:%d: %s\n", __FILE__, __LINE__, #c);	\
			bad++;					\
		}						\
	} while (0)

static int compile(const char *text, uint8_t **image, size_t *size, struct ecb_error *e)
{
	struct ecb_load how = { .struct_size = sizeof(how), .file = "t" };
	struct ecb_bus *bus;
	int ret = ecb_file_parse(&bus, "t", text, strlen(text), e);

	if (ret)
		return ret;
	how.bus = bus;
	ret = ecb_compile(&how, image, size, e);
	ecb_bus_free(bus);
	return ret;
}

static void say_data(FILE *to, const struct ec_compiled_record *r)
{
	for (uint32_t i = 0; i < r->size; i++)
		fprintf(to, " %02x", r->data[i]);
}

/* what the kernel gets, without the text for tools */
static void say(FILE *to, const struct ec_compiled_record *r)
{
	switch (r->op) {
	case EC_COMPILED_NAMES:
		return;
	case EC_COMPILED_UNIT:
		fprintf(to, "unit %s policy %u limit %u lease %u repeats %u flags %u", r->name,
			r->policy, r->limit, r->lease_cycles, r->repeats, r->flags);
		break;
	case EC_COMPILED_DOMAIN_UNIT:
		fprintf(to, "domain%u in unit %u", r->domain, r->unit);
		break;
	case EC_COMPILED_SLAVE:
		fprintf(to, "slave %u:%u 0x%x:0x%x", r->alias, r->position, r->vendor,
			r->product);
		break;
	case EC_COMPILED_GROUP:
		fprintf(to, "group %s by %u value %u port %u at %d flags %u", r->name, r->kind,
			r->number, r->to, (int)r->slave, r->flags);
		break;
	case EC_COMPILED_MEMBER:
		fprintf(to, "group %u member %u 0x%x:0x%x", r->group, r->position, r->vendor,
			r->product);
		break;
	case EC_COMPILED_PLACE:
	case EC_COMPILED_REST:
		fprintf(to, "domain%u: %s%u SM%u PDO %u", r->domain,
			r->op == EC_COMPILED_REST ? "rest of " : "", r->slave, r->subindex,
			r->index);
		break;
	case EC_COMPILED_CYCLE:
		fprintf(to, "cycle %llu", (unsigned long long)r->ns);
		break;
	case EC_COMPILED_VALUE:
		fprintf(to, "%s place %u bit %u, %u bit(s) of type %u%s 0x%x * %lld/%llu + %lld/%llu %s",
			r->name, r->place, r->bit, r->bits, r->type, r->output ? " out" : "",
			r->object, (long long)r->scale.num, (unsigned long long)r->scale.den,
			(long long)r->offset.num, (unsigned long long)r->offset.den, r->unit_text);
		break;
	default:
		fprintf(to, "%s %u %s index 0x%04x:%02x %u,%u,%u,%u %d %u %u %u",
			ec_compiled_op_name(r->op), r->slave, r->name ? r->name : "", r->index,
			r->subindex, r->complete, r->kind, r->step, r->to, r->value, r->sync0,
			r->sync1, r->ms);
		say_data(to, r);
	}
	fprintf(to, "\n");
}

static char *records(const uint8_t *image, size_t size)
{
	struct ec_compiled_record r;
	struct ec_compiled c;
	struct ec_rbuf at;
	char *text = NULL;
	size_t len;
	FILE *to = open_memstream(&text, &len);

	CHECK(to && !ec_compiled_check(&c, image, size));
	at = ec_compiled_begin(&c);
	while (ec_compiled_next(&c, &at, &r))
		say(to, &r);
	fclose(to);
	return text;
}

static void gives(const char *text, const char *expected)
{
	uint8_t *image = NULL, *again = NULL;
	size_t size = 0, same = 0;
	struct ecb_error e;
	char *found;

	if (compile(text, &image, &size, &e) || compile(text, &again, &same, &e)) {
		printf("%s\n", e.text);
		bad++;
		return;
	}
	CHECK(size == same && !memcmp(image, again, size));
	found = records(image, size);
	if (strcmp(found, expected)) {
		printf("%s---\n%s", found, expected);
		bad++;
	}
	free(found);
	free(image);
	free(again);
}

#define HEAD	"ethercat: 1\nmasters:\n- slaves:\n"
#define ENTRY(more)	HEAD "  - {name: a, vendor: 2, product: 1, pdos: [{index: 0x1a00, sm: 3, " \
	"entries: [{object: 0x6000:01, bits: 8, name: x, " more "}]}]}\n"

static void whole(void)
{
	gives("ethercat: 1\nmasters:\n- cycle: 1 ms\n  reference_clock: axis\n"
	      "  sync_units:\n  - {name: u, policy: safeop, limit: 2, lease: 100 ms, repeats: 2}\n"
	      "  groups:\n  - {name: g, alias: 9, mandatory: true}\n"
	      "  - {name: dock, parent: k, port: 2, fast: true}\n  slaves:\n"
	      "  - {name: k, vendor: 2, product: 0x10}\n"
	      "  - {name: tool, vendor: 2, product: 0x20, group: g}\n"
	      "  - {name: docked, vendor: 2, product: 0x21, group: dock, serial: 5}\n"
	      "  - name: axis\n    vendor: 2\n    product: 0x30\n    revision: 0x12\n"
	      "    sync_unit: u\n    timeouts: {preop_safeop: 10 s, mailbox: 500 ms}\n"
	      "    clock: {assign_activate: 0x0700, sync0: 1 ms, sync0_shift: -250 us}\n"
	      "    modules: [{slot: 1, ident: 0x119800}]\n    write_modules: true\n    pdos:\n"
	      "    - {index: 0x1600, sm: 2, entries: [{object: 0x7010:01, bits: 16, name: control}, {bits: 8}]}\n"
	      "    - {index: 0x1a00, sm: 3, entries: [{object: 0x6000:11, bits: 32, name: position,"
	      " type: int32, unit: mm, scale: 0.001, offset: -10}]}\n"
	      "    - {index: 0x1a01, sm: 3, entries: []}\n    startup:\n"
	      "    - {at: safeop, sdo: 0x8011:00, complete: true, data: 01 ff}\n"
	      "    - {at: safeop, idn: S-0-0032, drive: 1, type: uint16, value: 0x0b}\n"
	      "    - {at: preop, register: 0x0420, data: 02 00}\n",
	      "domain 0  index 0x0000:00 0,0,0,0 0 0 0 0\n"
	      "unit u policy 3 limit 2 lease 100 repeats 2 flags 0\ndomain0 in unit 0\n"
	      "domain 0  index 0x0000:00 0,0,0,0 0 0 0 0\n"
	      "group g by 1 value 9 port 0 at -1 flags 1\ngroup 0 member 0 0x2:0x20\n"
	      "slave 0:0 0x2:0x10\ngroup dock by 3 value 0 port 2 at 1 flags 2\n"
	      "group 1 member 0 0x2:0x21\nslave 0:1 0x2:0x30\n"
	      "flag 2 ExpectedSerial index 0x0000:00 0,0,0,0 5 0 0 0\n"
	      "flag 3 ExpectedRevision index 0x0000:00 0,0,0,0 18 0 0 0\n"
	      "SDO 3  index 0xf030:01 0,0,0,0 0 0 0 0 00 98 11 00\n"
	      "command 3  index 0xf050:01 0,0,36,0 0 0 0 0 00 98 11 00\n"
	      "SDO 3  index 0x8011:00 1,0,0,0 0 0 0 0 01 ff\n"
	      "IDN 3  index 0x0020:01 0,0,2,0 0 0 0 0 0b 00\n"
	      "command 3  index 0x0420:00 0,1,18,0 0 0 0 0 02 00\n"
	      "time limit 3  index 0x0000:00 0,0,2,4 0 0 0 10000\n"
	      "time limit of the mailbox 3  index 0x0000:00 0,0,0,0 0 0 0 500\n"
	      "SYNC signals 3  index 0x0700:00 0,0,0,0 -250000 1000000 0 0\n"
	      "PDOs 3  index 0x0000:00 0,0,0,0 0 0 0 0 02 01 01 00 00 16 02 00 10 70 01 10 00 00 00 08"
	      " 03 02 02 00 00 1a 01 00 00 60 11 20 01 1a 00 00\n"
	      "domain1: rest of 1 SM0 PDO 0\ndomain1: rest of 0 SM0 PDO 0\n"
	      "domain1: rest of 2 SM0 PDO 0\n"
	      "flag 3 FrameRepeatSupport index 0x0000:00 0,0,0,0 1 0 0 0\n"
	      "domain0: 3 SM2 PDO 0\ndomain0: 3 SM3 PDO 0\ndomain0: rest of 3 SM0 PDO 0\n"
	      "reference clock 3  index 0x0000:00 0,0,0,0 0 0 0 0\ncycle 1000000\n"
	      "axis.control place 0 bit 0, 16 bit(s) of type 0 out 0x701001 * 1/1 + 0/1 \n"
	      "axis.position place 1 bit 0, 32 bit(s) of type 4 0x600011 * 1/1000 + -10/1 mm\n");
}

/* decimal numbers are what they look like, others what the double has */
static void numbers(void)
{
	static const struct {
		const char *text;
		const char *rational;
	} n[] = {
		{ "scale: 1", "1/1 + 0/1" }, { "scale: 0.1, offset: -1.5", "1/10 + -3/2" },
		{ "scale: -360, offset: 1e9", "-360/1 + 1000000000/1" },
		{ "scale: 0.0054931640625", "45/8192 + 0/1" }, { "scale: 1e-9", "1/1000000000 + 0/1" },
		{ "scale: 0.3333333333333333", "3333333333333333/10000000000000000 + 0/1" },
		{ "scale: 1e17", "100000000000000000/1 + 0/1" },
		{ "scale: 3.0517578125e-05", "1/32768 + 0/1" },
	};
	char text[512], expected[512];

	for (size_t i = 0; i < sizeof(n) / sizeof(n[0]); i++) {
		snprintf(text, sizeof(text), ENTRY("%s"), n[i].text);
		snprintf(expected, sizeof(expected), "domain 0  index 0x0000:00 0,0,0,0 0 0 0 0\n"
			 "slave 0:0 0x2:0x1\nPDOs 0  index 0x0000:00 0,0,0,0 0 0 0 0 03 02 01 00"
			 " 00 1a 01 00 00 60 01 08\ndomain0: 0 SM3 PDO 0\n"
			 "a.x place 0 bit 0, 8 bit(s) of type 0 0x600001 * %s \n", n[i].rational);
		gives(text, expected);
	}
}

static const struct {
	const char *text;
	const char *error;
} refused[] = {
	{ HEAD "  - {name: a, vendor: 2, product: 1, identification: 3}\n",
	  "t:4: slave 'a': an application does not see the identification of slaves" },
	{ HEAD "  - {name: a, vendor: 2, product: 1, group: g}\n"
	  "  - {name: b, vendor: 2, product: 1, parent: a, port: 1}\n"
	  "  groups: [{name: g, alias: 1}]\n",
	  "t:5: slave 'b' is connected behind a hot connect group" },
	{ HEAD "  - {name: a, vendor: 2, product: 1, pdos: [{index: 0x1a00, sm: 3}, {index: 0x1a01, sm: 3}]}\n",
	  "t:4: PDO 0x1a00 of 'a' has no entries here, and other PDOs of SM3 follow; give its entries" },
	{ HEAD "  - {name: a, vendor: 2, product: 1, pdos: [{index: 0x2000, sm: 3, entries: [{bits: 8}]}]}\n",
	  "SM3 is not known as one of inputs or of outputs" },
	{ "ethercat: 1\nmasters:\n- main_device: eth0\n", "does not choose the devices" },
	{ ENTRY("scale: 1e-30"), "value 'a.x': scale 1e-30 or offset 0 is no quotient of 64-bit integers" },
	{ ENTRY("offset: 1e25"), "value 'a.x': scale 1 or offset 1e+25 is no quotient" },
};

static void refusals(void)
{
	struct ecb_load how = { .struct_size = sizeof(how) };
	struct ecb_error e;
	uint8_t *image = NULL;
	size_t size = 0;

	for (size_t i = 0; i < sizeof(refused) / sizeof(refused[0]); i++) {
		int ret = compile(refused[i].text, &image, &size, &e);

		if (ret == -EINVAL && strstr(e.text, refused[i].error) && !image)
			continue;
		printf("%zu: %d '%s', expected '%s'\n", i, ret, e.text, refused[i].error);
		bad++;
	}
	CHECK(ecb_compile(&how, &image, &size, &e) == -EINVAL);
	CHECK(ecb_compile(&how, NULL, &size, &e) == -EINVAL);
	CHECK(ecb_compile(NULL, &image, &size, &e) == -EINVAL);
}

int main(void)
{
	whole();
	numbers();
	refusals();
	return bad != 0;
}
