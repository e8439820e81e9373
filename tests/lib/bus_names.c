// SPDX-License-Identifier: LGPL-2.1-or-later
/* Names of slaves and values: the rule, equal names, kept names, hostile texts. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../include/ethercat-bus/names.h"

static int bad;

static void same(const char *what, const char *found, const char *expected)
{
	if (!strcmp(found, expected))
		return;
	printf("%s: '%s', expected '%s'\n", what, found, expected);
	bad++;
}

static void number(const char *what, long found, long expected)
{
	if (found == expected)
		return;
	printf("%s: %ld, expected %ld\n", what, found, expected);
	bad++;
}

static void words(void)
{
	static const char *const rows[][2] = {
		{ "EL7201-9014", "el7201_9014" }, { "EK1100", "ek1100" },
		{ "750-354", "750_354" }, { "  AX 5000 (2A) ", "ax_5000_2a" },
		{ "Stra\xc3\x9f" "e", "stra_e" }, { "...", "" }, { "", "" }, { NULL, "" },
		{ "\x1b[31m\n", "31m" }, { "a__b", "a_b" },
		{ "0123456789012345678901234567890123456789012345678901234_x",
		  "0123456789012345678901234567890123456789012345678901234" },
	};
	char to[ECB_WORD], *large = malloc(1 << 20);

	for (size_t i = 0; i < sizeof(rows) / sizeof(rows[0]); i++) {
		number("length", (long)ecb_name_word(to, rows[i][0]), (long)strlen(rows[i][1]));
		same("word", to, rows[i][1]);
	}
	memset(large, 'A', (1 << 20) - 1);
	large[(1 << 20) - 1] = 0;
	number("longest", (long)ecb_name_word(to, large), 56);
	free(large);
}

static void slaves(void)
{
	struct ecb_slave_name s[] = {
		{ .order = "EL1008" }, { .order = "EL1008" }, { .order = "EL1008-2" },
		{ .order = "--", .text = "Drive", .group = "G" }, { .group = "G" }, { 0 }, { 0 },
		{ .order = "EL1008" }, { .order = "X", .name = "axis1" },
		{ .order = "axis1" }, { .order = "EL1008", .name = "el1008_3" },
	};
	static const char *const names[] = {
		"el1008", "el1008_2", "el1008_2_2", "drive", "g", "slave", "slave_2", "el1008_4",
		"axis1", "axis1_2", "el1008_3",
	};

	number("slaves", ecb_name_slaves(s, sizeof(s) / sizeof(s[0])), 0);
	for (size_t i = 0; i < sizeof(s) / sizeof(s[0]); i++)
		same("slave", s[i].name, names[i]);
	strcpy(s[0].name, "axis1");
	number("names twice", ecb_name_slaves(s, sizeof(s) / sizeof(s[0])), -EEXIST);
	number("no slaves", ecb_name_slaves(NULL, 0), 0);
}

/* a name that is searched from the beginning each time would take minutes */
static void many(void)
{
	const size_t n = 65535;
	struct ecb_slave_name *s = calloc(n, sizeof(*s));

	number("many", ecb_name_slaves(s, n), 0);
	same("first", s[0].name, "slave");
	same("last", s[n - 1].name, "slave_65535");
	free(s);
}

static void entries(void)
{
	struct ecb_entry_name e[] = {
		{ .text = "Status", .pdo = "Inputs 1", .index = 0x6000, .subindex = 1 },
		{ .index = 0, .text = "gap" },
		{ .text = "status", .pdo_index = 0x1a01, .index = 0x6010, .subindex = 1 },
		{ .text = "Value", .pdo = "Inputs 1", .index = 0x6000, .subindex = 0x11 },
		{ .index = 0x6020, .subindex = 0xff },
		{ .text = "Bit", .pdo = "P", .index = 0x6030, .subindex = 1 },
		{ .text = "Bit", .pdo = "P", .index = 0x6030, .subindex = 2 },
		{ .text = "Value", .index = 0x6040, .name = "position" },
		{ .text = "Position", .index = 0x6041 },
	};
	static const char *const names[] = {
		"inputs_1.status", "", "x1a01.status", "value", "x6020_ff", "p.bit", "p.bit_2",
		"position", "position_2",
	};
	char to[ECB_VALUE];

	number("entries", ecb_name_entries(e, sizeof(e) / sizeof(e[0])), 0);
	for (size_t i = 0; i < sizeof(e) / sizeof(e[0]); i++)
		same("entry", e[i].name, names[i]);
	number("value", (long)ecb_name_value(to, "axis1", e[0].name), 21);
	same("value", to, "axis1.inputs_1.status");
	number("gap", (long)ecb_name_value(to, "axis1", e[1].name), 0);
	same("gap", to, "");
	strcpy(e[0].name, "value");
	number("entries twice", ecb_name_entries(e, sizeof(e) / sizeof(e[0])), -EEXIST);
	number("no entries", ecb_name_entries(NULL, 0), 0);
}

int main(void)
{
	words();
	slaves();
	many();
	entries();
	return bad != 0;
}
