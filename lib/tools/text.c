// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Names from slaves are printed to a terminal: nothing in them may move the
 * cursor, change the terminal or reverse the direction of the text.
 */
#include "text.h"

#include <stdio.h>
#include <string.h>

#include "../../include/ethercat-tools/slave.h"
#include "../../master/wire/env.h"

/**
 * utf8_len() - length of the character at @p
 * @p: bytes
 * @size: how many
 *
 * Return: bytes of the UTF-8 sequence, 0 when there is no valid one.
 */
int utf8_len(const unsigned char *p, size_t size)
{
	int n;

	if (!size)
		return 0;
	n = p[0] < 0x80 ? 1 : p[0] >= 0xc2 && p[0] < 0xe0 ? 2 :
		p[0] >= 0xe0 && p[0] < 0xf0 ? 3 : p[0] >= 0xf0 && p[0] < 0xf5 ? 4 : 0;
	if ((size_t)n > size)
		return 0;
	for (int i = 1; i < n; i++)
		if ((p[i] & 0xc0) != 0x80)
			return 0;
	if ((p[0] == 0xe0 && p[1] < 0xa0) || (p[0] == 0xed && p[1] > 0x9f) ||
	    (p[0] == 0xf0 && p[1] < 0x90) || (p[0] == 0xf4 && p[1] > 0x8f))
		return 0;
	return n;
}

/* U+2028 to U+202E, U+2066 to U+2069, U+200E, U+200F: lines and directions */
static bool turns(const unsigned char *p)
{
	if (p[0] != 0xe2)
		return false;
	if (p[1] == 0x80)
		return (p[2] >= 0xa8 && p[2] <= 0xae) || p[2] == 0x8e || p[2] == 0x8f;
	return p[1] == 0x81 && p[2] >= 0xa6 && p[2] <= 0xa9;
}

/**
 * text_harmless() - may the character go to a terminal?
 * @p: its bytes
 * @n: as of utf8_len()
 *
 * Return: true if so.
 */
bool text_harmless(const unsigned char *p, int n)
{
	switch (n) {
	case 0:
		return p[0] >= 0xa0;	/* Latin-1; below are its controls */
	case 1:
		return p[0] >= 0x20 && p[0] != 0x7f;
	case 2:
		return p[0] != 0xc2 || p[1] >= 0xa0;
	case 3:
		return !turns(p);
	default:
		return true;
	}
}

/**
 * text_clean() - make bytes safe for a terminal
 * @s: bytes; what is not safe becomes '?'
 * @size: how many
 *
 * Bytes that are no UTF-8 stay, they are Latin-1 in many EEPROMs.
 */
void text_clean(char *s, size_t size)
{
	unsigned char *p = (unsigned char *)s;
	size_t step;

	for (size_t i = 0; i < size; i += step) {
		int n = utf8_len(p + i, size - i);

		step = n ? (size_t)n : 1;
		if (!text_harmless(p + i, n))
			memset(p + i, '?', step);
	}
}

/* the same for a string in a buffer of @size bytes, which is ended */
void string_clean(char *s, size_t size)
{
	s[size - 1] = 0;
	text_clean(s, strlen(s));
}

/* letters that differ, are missing, too many, or exchanged with the next one */
size_t text_typos(const char *a, const char *b)
{
	enum { MOST = 32 };
	size_t rows[3][MOST + 1], n = strlen(b);

	if (strlen(a) > MOST || n > MOST)
		return MOST;
	for (size_t j = 0; j <= n; j++)
		rows[0][j] = j;
	for (size_t i = 1; a[i - 1]; i++) {
		size_t *row = rows[i % 3], *up = rows[(i - 1) % 3];

		row[0] = i;
		for (size_t j = 1; j <= n; j++) {
			row[j] = min(up[j], row[j - 1]) + 1;
			row[j] = min(row[j], up[j - 1] + (a[i - 1] != b[j - 1]));
			if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
				row[j] = min(row[j], rows[(i - 2) % 3][j - 2] + 1);
		}
	}
	return rows[strlen(a) % 3][n];
}

/**
 * text_nearer() - which of two names a mistyped word is nearer to
 * @word: as typed
 * @nearest: name that was found before, or NULL
 * @name: candidate
 *
 * A name may have one slip in up to 5 letters, two in more, none in up to 2.
 *
 * Return: @name, otherwise @nearest.
 */
const char *text_nearer(const char *word, const char *nearest, const char *name)
{
	size_t len = strlen(word), n = text_typos(word, name);

	if (n > (len < 3 ? 0 : len < 6 ? 1 : 2) || (nearest && n >= text_typos(word, nearest)))
		return nearest;
	return name;
}

/**
 * text_duration() - a duration as "3.1 s", "12 min" or "5 h"
 * @ns: duration
 * @buf: result
 * @size: of @buf
 *
 * Return: @buf.
 */
const char *text_duration(uint64_t ns, char *buf, size_t size)
{
	unsigned long long ds = ns / 100000000;

	if (ds < 1000)
		snprintf(buf, size, "%llu.%llu s", ds / 10, ds % 10);
	else if (ds < 72000)
		snprintf(buf, size, "%llu min", ds / 600);
	else
		snprintf(buf, size, "%llu h", ds / 36000);
	return buf;
}

/**
 * text_behind() - the device behind a closed port
 * @b: device
 * @buf: result: " (EL2008 0x00000002/0x07d83052, serial number 0x00000001, 3 slaves)", or ""
 * @size: of @buf
 *
 * Return: @buf.
 */
const char *text_behind(const struct ect_behind *b, char *buf, size_t size)
{
	char slaves[32] = "", serial[40] = "";

	if (b->slaves > 1)
		snprintf(slaves, sizeof(slaves), ", %u slaves", b->slaves);
	if (b->serial_number)
		snprintf(serial, sizeof(serial), ", serial number 0x%08x", b->serial_number);
	buf[0] = '\0';
	if (b->vendor_id || b->product_code)
		snprintf(buf, size, " (%s%s0x%08x/0x%08x%s%s)", b->name, b->name[0] ? " " : "",
			 b->vendor_id, b->product_code, serial, slaves);
	return buf;
}
