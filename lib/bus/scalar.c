// SPDX-License-Identifier: LGPL-2.1-or-later
/* Values of a bus file as texts: each kind of field is read, described and written here. */
#include <errno.h>
#include <inttypes.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fields.h"
#include "internal.h"
#include "../tools/text.h"

static const struct {
	const char *name;
	int64_t ns;
} time_units[] = { { "s", 1000000000 }, { "ms", 1000000 }, { "us", 1000 }, { "ns", 1 } };

uint64_t scalar_number(const struct field *f, const void *from)
{
	if (f->size == 1)
		return *(const uint8_t *)from;
	if (f->size == 2)
		return *(const uint16_t *)from;
	return f->size == 4 ? *(const uint32_t *)from : *(const uint64_t *)from;
}

void scalar_set(const struct field *f, void *to, uint64_t value)
{
	if (f->size == 1)
		*(uint8_t *)to = (uint8_t)value;
	else if (f->size == 2)
		*(uint16_t *)to = (uint16_t)value;
	else if (f->size == 4)
		*(uint32_t *)to = (uint32_t)value;
	else
		*(uint64_t *)to = value;
}

/* digits up to @end, decimal or 0x; false: none, others, or more than 64 bits */
static bool digits(const char *s, const char *end, uint64_t *value)
{
	bool hex = end - s > 2 && s[0] == '0' && (s[1] == 'x' || s[1] == 'X');
	unsigned int base = hex ? 16 : 10, d;

	if (hex)
		s += 2;
	*value = 0;
	if (s == end)
		return false;
	for (; s < end; s++) {
		if (*s >= '0' && *s <= '9')
			d = *s - '0';
		else if (hex && ((*s | 32) >= 'a' && (*s | 32) <= 'f'))
			d = (*s | 32) - 'a' + 10;
		else
			return false;
		if (*value > (UINT64_MAX - d) / base)
			return false;
		*value = *value * base + d;
	}
	return true;
}

static bool signed_number(const char *s, size_t len, int64_t *to)
{
	bool minus = len && *s == '-';
	uint64_t v;

	if (!digits(s + minus, s + len, &v) || v > (uint64_t)INT64_MAX + minus)
		return false;
	*to = minus ? (int64_t)-v : (int64_t)v;
	return true;
}

static bool duration(const struct field *f, const char *s, size_t len, int64_t *to)
{
	bool minus = f->flags & F_SIGN && len && *s == '-';
	const char *end = s + len, *unit;
	uint64_t v;

	s += minus;
	unit = s + strspn(s, "0123456789");
	if (!digits(s, unit, &v))
		return false;
	unit += *unit == ' ';
	for (size_t i = 0; i < 4; i++) {
		if (strcmp(unit, time_units[i].name) || unit + strlen(unit) != end)
			continue;
		if (v > f->max / time_units[i].ns || v * time_units[i].ns < f->min)
			return false;
		*to = (int64_t)(v * time_units[i].ns) * (minus ? -1 : 1);
		return true;
	}
	return false;
}

static bool is_word(const char *s, size_t len, unsigned int dots)
{
	size_t n = 0;

	for (size_t i = 0; i < len; i++, n++) {
		char c = s[i];

		if (c == '.' && dots && n) {
			dots--;
			n = (size_t)-1;
		} else if (!((c | 32) >= 'a' && (c | 32) <= 'z') && !(c >= '0' && c <= '9') &&
			   c != '_') {
			return false;
		}
		if (n == ECB_WORD - 1)
			return false;
	}
	return n;
}

static bool is_text(const char *s, size_t len)
{
	for (size_t i = 0; i < len;) {
		int n = utf8_len((const unsigned char *)s + i, len - i);

		if (!n || !text_harmless((const unsigned char *)s + i, n))
			return false;
		i += n;
	}
	return len && len <= TEXT_MAX;
}

static int hex_digit(char c)
{
	return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ?
		(c | 32) - 'a' + 10 : -1;
}

/* "01 ff" */
static bool bytes(struct whole *w, const char *s, size_t len, struct ecb_bytes *to)
{
	size_t n = (len + 1) / 3;
	uint8_t *data;

	if (len % 3 != 2 || n > BYTES_MAX)
		return false;
	for (size_t i = 0; i < len; i++)
		if (i % 3 == 2 ? s[i] != ' ' : hex_digit(s[i]) < 0)
			return false;
	data = ecb_alloc(w, n);
	if (!data)
		return false;
	for (size_t i = 0; i < n; i++)
		data[i] = (uint8_t)(hex_digit(s[3 * i]) << 4 | hex_digit(s[3 * i + 1]));
	to->data = data;
	to->size = n;
	return true;
}

/* 0x6000:01 with exactly these digits */
static bool object(const char *s, size_t len, uint32_t *to)
{
	*to = 0;
	if (len != 9 || s[0] != '0' || s[1] != 'x' || s[6] != ':')
		return false;
	for (size_t i = 2; i < len; i++) {
		if (i == 6)
			continue;
		if (hex_digit(s[i]) < 0)
			return false;
		*to = *to << 4 | (uint32_t)hex_digit(s[i]);
	}
	return *to >> 8;
}

/* S-0-0032, P-7-4095 */
static bool idn(const char *s, size_t len, uint32_t *to)
{
	uint64_t set, number;

	if (len != 8 || (s[0] != 'S' && s[0] != 'P') || s[1] != '-' || s[3] != '-' ||
	    !digits(s + 2, s + 3, &set) || !digits(s + 4, s + 8, &number) || set > 7 ||
	    number > 4095)
		return false;
	*to = (uint32_t)((s[0] == 'P' ? 0x8000 : 0) | set << 12 | number);
	return true;
}

/* as JSON, in any locale */
static bool real(const char *s, size_t len, double *to)
{
	static const char allowed[] = "+-.0123456789eE";
	locale_t plain, before;
	char *end;

	if (!len || len > 40 || strspn(s, allowed) != len)
		return false;
	plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
	if (!plain)
		return false;
	before = uselocale(plain);
	*to = strtod(s, &end);
	uselocale(before);
	freelocale(plain);
	return end == s + len && isfinite(*to);
}

bool scalar_parse(struct whole *w, const struct field *f, const char *s, size_t len, void *to)
{
	uint64_t v = 0;
	uint32_t o;
	bool ok = strlen(s) == len;

	errno = 0;
	switch (f->kind) {
	case K_NUMBER:
		ok = ok && digits(s, s + len, &v) && v >= f->min && v <= f->max;
		break;
	case K_BOOL:
		v = !strcmp(s, "true");
		ok = ok && (v || !strcmp(s, "false"));
		break;
	case K_WORD:
		while (f->words[v] && strcmp(f->words[v], s))
			v++;
		ok = ok && f->words[v];
		break;
	case K_OBJECT:
		ok = ok && object(s, len, &o);
		v = ok ? o : 0;
		break;
	case K_IDN:
		ok = ok && idn(s, len, &o);
		v = ok ? o : 0;
		break;
	case K_SIGNED:
		return ok && signed_number(s, len, to);
	case K_TIME:
		return ok && duration(f, s, len, to);
	case K_REAL:
		return ok && real(s, len, to);
	case K_BYTES:
		return ok && bytes(w, s, len, to);
	case K_TEXT:
	case K_NAME:
	case K_VALUE:
		ok = ok && (f->kind == K_TEXT ? is_text(s, len) :
			    is_word(s, len, f->kind == K_VALUE));
		if (ok)
			*(const char **)to = ecb_copy(w, s, len);
		return ok && *(const char **)to;
	default:
		return false;
	}
	if (ok)
		scalar_set(f, to, v);
	return ok;
}

void scalar_expected(const struct field *f, char *buf, size_t size)
{
	char low[32], high[32];
	size_t n = 0;

	switch (f->kind) {
	case K_NUMBER:
		snprintf(buf, size, f->flags & F_HEX ? "a number from 0x%" PRIx64 " to 0x%" PRIx64 :
			 "a number from %" PRIu64 " to %" PRIu64, f->min, f->max);
		break;
	case K_WORD:
		n = (size_t)snprintf(buf, size, "one of");
		for (size_t i = 0; f->words[i] && n < size; i++)
			n += (size_t)snprintf(buf + n, size - n, "%s %s", i ? "," : "",
					      f->words[i]);
		break;
	case K_TIME:
		scalar_print(f, &(int64_t){ (int64_t)f->min }, low, sizeof(low));
		scalar_print(f, &(int64_t){ (int64_t)f->max }, high, sizeof(high));
		snprintf(buf, size, "a time from %s%s to %s with ns, us, ms or s",
			 f->flags & F_SIGN ? "-" : "", f->flags & F_SIGN ? high : low, high);
		break;
	case K_NAME:
		snprintf(buf, size, "1 to %d letters, digits and '_'", ECB_WORD - 1);
		break;
	case K_VALUE:
		snprintf(buf, size, "1 to %d letters, digits and '_', or two such words with '.'",
			 ECB_WORD - 1);
		break;
	case K_TEXT:
		snprintf(buf, size, "1 to %d bytes of text without control characters", TEXT_MAX);
		break;
	case K_BYTES:
		snprintf(buf, size, "1 to %d bytes such as '01 ff'", BYTES_MAX);
		break;
	default:
		snprintf(buf, size, "%s", f->kind == K_BOOL ? "true or false" :
			 f->kind == K_SIGNED ? "a number with at most 64 bits" :
			 f->kind == K_REAL ? "a number such as 0.1 or 1e-3" :
			 f->kind == K_OBJECT ? "an object such as 0x6000:01" :
			 f->kind == K_IDN ? "an IDN such as S-0-0032" :
			 f->kind == K_LIST ? "a list" : "keys with values");
	}
}

const char *scalar_pattern(const struct field *f)
{
	switch (f->kind) {
	case K_NUMBER: return "^(0[xX][0-9a-fA-F]+|[0-9]+)$";
	case K_SIGNED: return "^-?(0[xX][0-9a-fA-F]+|[0-9]+)$";
	case K_REAL: return "^[-+.0-9eE]+$";
	case K_NAME: return "^[A-Za-z0-9_]{1,63}$";
	case K_VALUE: return "^[A-Za-z0-9_]{1,63}(\\\\.[A-Za-z0-9_]{1,63})?$";
	case K_TIME: return f->flags & F_SIGN ? "^-?[0-9]+ ?(ns|us|ms|s)$" :
		"^[0-9]+ ?(ns|us|ms|s)$";
	case K_BYTES: return "^[0-9a-fA-F]{2}( [0-9a-fA-F]{2})*$";
	case K_OBJECT: return "^0x[0-9a-fA-F]{4}:[0-9a-fA-F]{2}$";
	case K_IDN: return "^[SP]-[0-7]-[0-4][0-9]{3}$";
	default: return NULL;
	}
}

bool scalar_given(const struct field *f, const void *from)
{
	switch (f->kind) {
	case K_TEXT:
	case K_NAME:
	case K_VALUE:
	case K_ITEM:
		return *(const void *const *)from;
	case K_REAL:
		return *(const double *)from != (double)f->def;
	case K_BYTES:
		return ((const struct ecb_bytes *)from)->size;
	case K_LIST:
		return *(const size_t *)((const char *)from + sizeof(void *));
	case K_LATER:
		return false;
	default:
		return scalar_number(f, from) != f->def || f->flags & F_REQUIRED;
	}
}

static void print_time(int64_t v, char *buf, size_t size)
{
	size_t i = 0;

	while (v % time_units[i].ns)
		i++;
	if (!v)
		i = 3;
	snprintf(buf, size, "%" PRId64 " %s", v / time_units[i].ns, time_units[i].name);
}

static void print_bytes(const struct ecb_bytes *b, char *buf, size_t size)
{
	*buf = 0;
	for (size_t i = 0; i < b->size && 3 * i + 3 < size; i++)
		snprintf(buf + 3 * i, size - 3 * i, "%02x ", b->data[i]);
	if (*buf)
		buf[strlen(buf) - 1] = 0;
}

/* 17 digits give the number itself back, but 0.1 is written as that */
static void print_real(double v, char *buf, size_t size)
{
	locale_t plain = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
	locale_t before = plain ? uselocale(plain) : (locale_t)0;

	for (int n = 15; n <= 17; n++) {
		snprintf(buf, size, "%.*g", n, v);
		if (strtod(buf, NULL) == v)
			break;
	}
	if (plain) {
		uselocale(before);
		freelocale(plain);
	}
}

void scalar_print(const struct field *f, const void *from, char *buf, size_t size)
{
	uint64_t v;

	switch (f->kind) {
	case K_TEXT:
	case K_NAME:
	case K_VALUE:
		snprintf(buf, size, "%s", *(const char *const *)from);
		return;
	case K_REAL:
		print_real(*(const double *)from, buf, size);
		return;
	case K_BYTES:
		print_bytes(from, buf, size);
		return;
	case K_TIME:
		print_time(*(const int64_t *)from, buf, size);
		return;
	case K_SIGNED:
		snprintf(buf, size, "%" PRId64, *(const int64_t *)from);
		return;
	default:
		break;
	}
	v = scalar_number(f, from);
	switch (f->kind) {
	case K_BOOL:
		snprintf(buf, size, "%s", v ? "true" : "false");
		break;
	case K_WORD:
		snprintf(buf, size, "%s", f->words[v]);
		break;
	case K_OBJECT:
		snprintf(buf, size, "0x%04x:%02x", ECB_INDEX(v), ECB_SUBINDEX(v));
		break;
	case K_IDN:
		snprintf(buf, size, "%c-%u-%04u", v & 0x8000 ? 'P' : 'S',
			 (unsigned int)(v >> 12 & 7), (unsigned int)(v & 0xfff));
		break;
	default:
		snprintf(buf, size, f->flags & F_HEX ? f->max <= 0xffff ? "0x%04" PRIx64 :
			 "0x%08" PRIx64 : "%" PRIu64, v);
	}
}
