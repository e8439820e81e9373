// SPDX-License-Identifier: GPL-2.0-only
/* Values and number lists: text in, bytes or numbers out, and back. */
#include "../../tool/value.h"

#include <stdio.h>
#include <stdlib.h>

#include "../../tool/select.h"

static unsigned int passed, failed;

static void check(bool ok, const char *what, const char *a, const char *b)
{
	if (ok) {
		passed++;
		return;
	}
	failed++;
	printf("FAILED: %s %s: %s\n", what, a, b);
}

static int parse(const char *type, const char *text, u8 *buf, size_t cap, size_t *size)
{
	const char *why;

	return value_parse(ec_type_by_name(type), text, strlen(text), buf, cap, size, &why);
}

/* @hex: expected bytes, NULL: refused */
static void in(const char *type, const char *text, const char *hex)
{
	char got[512] = "";
	u8 buf[128];
	size_t size = 0;
	int ret = parse(type, text, buf, sizeof(buf), &size);

	for (size_t i = 0; !ret && i < size; i++)
		snprintf(got + 2 * i, 3, "%02x", buf[i]);
	check(hex ? !ret && !strcmp(got, hex) : ret, type, text, ret ? "refused" : got);
}

static size_t unhex(const char *hex, u8 *data)
{
	size_t n = 0;
	unsigned int v;

	for (; *hex && sscanf(hex, "%2x", &v) == 1; hex += 2)
		data[n++] = (u8)v;
	return n;
}

/* @text: expected, NULL: refused */
static void out(const char *type, const char *hex, const char *text)
{
	char got[1024] = "";
	u8 data[128];
	size_t n = unhex(hex, data);
	int ret = value_format(ec_type_by_name(type), data, n, got, sizeof(got));

	check(text ? ret == (int)strlen(text) && !strcmp(got, text) : ret < 0, type, hex, got);
}

/* every printed number can be typed again */
static bool round_trip(const char *type, const u8 *data, size_t n)
{
	char text[1024], *value;
	u8 back[128];
	size_t size;
	int ret;

	value_format(ec_type_by_name(type), data, n, text, sizeof(text));
	value = strchr(text, ' ');
	if (ec_type_by_name(type)->kind == EC_KIND_RAW || !value)
		value = text;
	else
		value++;
	ret = parse(type, value, back, sizeof(back), &size);
	if (!ret && size == n && !memcmp(back, data, n))
		return true;
	printf("%s: %s does not come back\n", type, text);
	return false;
}

static void random_round_trips(void)
{
	static const char *const types[] = {
		"int8", "int16", "int24", "int32", "int40", "int48", "int56", "int64", "uint8",
		"uint16", "uint24", "uint32", "uint40", "uint48", "uint56", "uint64", "float",
		"double", "raw", "byte", "dword",
	};
	u32 x = 1;

	for (size_t t = 0; t < ARRAY_SIZE(types); t++) {
		bool ok = true;

		for (int i = 0; i < 2000; i++) {
			size_t n = value_bytes(ec_type_by_name(types[t]));
			u8 data[8];

			for (size_t k = 0; k < sizeof(data); k++) {
				x = x * 1664525 + 1013904223;
				data[k] = (u8)(x >> 24);
			}
			/* no NaN: its text says nothing about its bits */
			if (types[t][0] == 'f')
				data[3] &= 0xbf;
			else if (types[t][0] == 'd' && types[t][1] == 'o')
				data[7] &= 0xbf;
			ok &= round_trip(types[t], data, n ? n : 8);
		}
		check(ok, types[t], "round trip", "2000 values");
	}
}

static void list(const char *text, unsigned int count, const char *want)
{
	char got[256] = "error";
	struct numbers n;
	const char *why;
	struct list l;

	if (!list_parse(&l, text, &why) && !list_expand(&l, count, &n)) {
		got[0] = 0;
		for (size_t i = 0; i < n.n; i++)
			snprintf(got + strlen(got), sizeof(got) - strlen(got), "%s%u", i ? " " : "",
				 n.v[i]);
		numbers_free(&n);
	}
	check(!strcmp(got, want), "list", text, got);
}

static void lists(void)
{
	list("0", 3, "0");
	list("-", 3, "0 1 2");
	list("1-", 3, "1 2");
	list("-1", 3, "0 1");
	list("2-0", 3, "2 1 0");
	list("5-2", 9, "5 4 3 2");
	list("5-1", 3, "2 1");
	list("1,1,,0", 3, "1 1 0");
	list("3", 3, "");
	list("7-", 3, "");
	list("4-9", 3, "");
	list("010", 20, "10");
	list("-", 0, "");
	list("99999999999999999999", 3, "");
	list("", 3, "error");
	list(",", 3, "error");
	list("x", 3, "error");
	list("0x1", 3, "error");
	list("1-2-3", 9, "error");
	list("--", 3, "error");
	list("1 ", 3, "error");
	list("1;2", 3, "error");
	list("1a", 3, "error");
}

static void numbers(void)
{
	const char *why;
	u64 v;

	check(!number_parse("0x10", 255, &v, &why) && v == 16, "number", "0x10", "");
	check(!number_parse("010", 255, &v, &why) && v == 8, "number", "010", "");
	check(number_parse("256", 255, &v, &why) == -ERANGE, "number", "256", "");
	check(number_parse("-1", 255, &v, &why) == -ERANGE, "number", "-1", "");
	check(number_parse("2000h", ~0ULL, &v, &why) == -EINVAL, "number", "2000h", "");
	check(number_parse("", 255, &v, &why) == -EINVAL, "number", "empty", "");
	check(number_parse(" 1", 255, &v, &why) == -EINVAL, "number", "blank", "");
	check(number_parse("0x", 255, &v, &why) == -EINVAL, "number", "0x", "");
	check(number_parse("08", 255, &v, &why) == -EINVAL, "number", "08", "");
	check(number_parse("99999999999999999999999", ~0ULL, &v, &why) == -ERANGE, "number", "huge",
	      "");
}

int main(void)
{
	in("bool", "1", "01");
	in("bool", "2", NULL);
	in("int8", "-1", "ff");
	in("int8", "-128", "80");
	in("int8", "-129", NULL);
	in("int8", "127", "7f");
	in("int8", "128", NULL);
	in("int16", "-0x10", "f0ff");
	in("uint8", "255", "ff");
	in("uint8", "256", NULL);
	in("uint8", "-1", NULL);
	in("uint16", "0x1234", "3412");
	in("uint32", "0x65766173", "73617665");
	in("uint32", "12abc", NULL);
	in("uint32", "", NULL);
	in("uint32", "1 ", NULL);
	in("int64", "-9223372036854775808", "0000000000000080");
	in("int64", "-9223372036854775809", NULL);
	in("int64", "9223372036854775807", "ffffffffffffff7f");
	in("uint64", "18446744073709551615", "ffffffffffffffff");
	in("uint64", "18446744073709551616", NULL);
	in("int24", "-2", "feffff");
	in("int24", "8388608", NULL);
	in("uint40", "0x0102030405", "0504030201");
	in("uint56", "72057594037927936", NULL);
	in("sm8", "-1", "81");
	in("sm8", "-127", "ff");
	in("sm8", "-128", NULL);
	in("sm16", "1", "0100");
	in("sm64", "-1", "0100000000000080");
	in("float", "1.5", "0000c03f");
	in("float", "0x10", "00008041");
	in("float", "1e99", NULL);
	in("float", "-inf", "000080ff");
	in("float", "1.5x", NULL);
	in("float", "", NULL);
	in("double", "0.1", "9a9999999999b93f");
	in("string", "ab cd", "6162206364");
	in("string", "", "");
	in("octet_string", "a b\n", "6120620a");
	in("unicode_string", "a", "61");
	in("raw", "0x12 0x34", "1234");
	in("raw", "1234", "1234");
	in("raw", "0x1234", "1234");
	in("raw", "1 2", "0102");
	in("raw", "12:34,56", "123456");
	in("raw", "123", NULL);
	in("raw", "0x", NULL);
	in("raw", "xy", NULL);
	in("raw", "", NULL);
	in("guid", "00112233445566778899aabbccddeeff", "00112233445566778899aabbccddeeff");
	in("guid", "0011", NULL);
	in("bit3", "7", "07");
	in("bit3", "8", NULL);
	in("UINT16", "1", "0100");
	in("u16", "1", "0100");

	out("bool", "01", "0x01 1");
	out("int8", "ff", "0xff -1");
	out("int16", "6080", "0x8060 -32672");
	out("int32", "f6ffffff", "0xfffffff6 -10");
	out("int64", "ffffffffffffffff", "0xffffffffffffffff -1");
	out("uint8", "0f", "0x0f 15");
	out("uint16", "3412", "0x1234 4660");
	out("uint32", "02000000", "0x00000002 2");
	out("uint64", "0100000000000000", "0x0000000000000001 1");
	out("int24", "feffff", "0xfffffe -2");
	out("uint48", "010000000080", "0x800000000001 140737488355329");
	out("sm8", "81", "0x81 -1");
	out("sm16", "0180", "0x8001 -1");
	out("float", "0000c03f", "1.5");
	out("float", "cdcccc3d", "0.1");
	out("float", "0000c07f", "nan");
	out("double", "182d4454fb210940", "3.141592653589793");
	out("raw", "010203", "0x01 0x02 0x03");
	out("raw", "", "");
	out("uint16", "01", NULL);
	out("uint16", "010203", NULL);
	out("float", "0000", NULL);

	random_round_trips();
	lists();
	numbers();
	printf("%u %u\n", passed, failed);
	return failed != 0;
}
