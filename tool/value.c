// SPDX-License-Identifier: GPL-2.0-only
#include "value.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const not_a_number = "expected a decimal, 0x... or 0... number";

/* bytes of a fixed-size type, 0: any number */
size_t value_bytes(const struct ec_type *t)
{
	return (t->bits + 7u) / 8;
}

/* true if the bytes are the text */
bool value_is_text(const struct ec_type *t)
{
	return t->kind == EC_KIND_STRING || t->kind == EC_KIND_OCTETS ||
		t->kind == EC_KIND_UNICODE;
}

/* sign and magnitude; the whole of @text must be a number */
static int parse_int(const char *text, bool *negative, u64 *magnitude, const char **why)
{
	const char *p = text;
	char *end;

	*why = not_a_number;
	*negative = *p == '-';
	if (*p == '-' || *p == '+')
		p++;
	if (!isdigit((unsigned char)*p))
		return -EINVAL;
	errno = 0;
	*magnitude = strtoull(p, &end, 0);
	if (*end)
		return -EINVAL;
	if (errno) {
		*why = "the number has more than 64 bits";
		return -ERANGE;
	}
	return 0;
}

/**
 * number_parse() - parse an argument that is not negative
 * @text: decimal, 0x... hexadecimal or 0... octal
 * @max: largest value allowed
 * @v: result
 * @why: set to what is wrong
 *
 * Return: 0, -EINVAL when it is no number, -ERANGE when it is too large.
 */
int number_parse(const char *text, u64 max, u64 *v, const char **why)
{
	bool negative;
	int ret = parse_int(text, &negative, v, why);

	if (ret)
		return ret;
	if (*v > max || (negative && *v)) {
		*why = "the number is out of range";
		return -ERANGE;
	}
	return 0;
}

static void store(u64 v, u8 *buf, size_t bytes)
{
	for (size_t i = 0; i < bytes; i++)
		buf[i] = (u8)(v >> 8 * i);
}

static int parse_integer(const struct ec_type *t, const char *text, u8 *buf, const char **why)
{
	u64 v, limit = t->bits == 64 ? ~0ULL : (1ULL << t->bits) - 1;
	bool negative;
	int ret = parse_int(text, &negative, &v, why);

	if (ret)
		return ret;
	*why = "the number is out of range for the type";
	if (t->kind == EC_KIND_INT || t->kind == EC_KIND_SM)
		limit = (limit >> 1) + (negative && t->kind == EC_KIND_INT);
	else if (negative && v)
		return -ERANGE;
	if (v > limit)
		return -ERANGE;
	if (negative && t->kind == EC_KIND_SM)
		v |= 1ULL << (t->bits - 1);
	else if (negative)
		v = -v;
	store(v, buf, value_bytes(t));
	return 0;
}

static int parse_real(const struct ec_type *t, const char *text, u8 *buf, const char **why)
{
	float f = 0;
	double d;
	u64 raw = 0;
	char *end;

	*why = "expected a number such as -1.5 or 2e3";
	if (!*text || isspace((unsigned char)*text))
		return -EINVAL;
	if (t->bits == 32)
		d = f = strtof(text, &end);
	else
		d = strtod(text, &end);
	if (*end)
		return -EINVAL;
	*why = "the number is out of range for the type";
	if (isinf(d) && !strpbrk(text, "iI"))
		return -ERANGE;
	if (t->bits == 32) {
		u32 r;

		memcpy(&r, &f, sizeof(r));
		raw = r;
	} else {
		memcpy(&raw, &d, sizeof(raw));
	}
	store(raw, buf, value_bytes(t));
	return 0;
}

static int hex_digit(char c)
{
	if (c >= '0' && c <= '9')
		return c - '0';
	c = (char)(c | 0x20);
	return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

/* hex bytes, apart or together: 0x12 0x34, 12 34, 12:34, 1234, 0x1234 */
static int parse_raw(const char *p, u8 *buf, size_t cap, size_t *size, const char **why)
{
	size_t n = 0;

	*why = "expected hex bytes such as 0x12 0x34 or 1234";
	while (*p) {
		size_t digits = 0;

		if (strchr(" \t\n,:", *p)) {
			p++;
			continue;
		}
		if (p[0] == '0' && (p[1] | 0x20) == 'x')
			p += 2;
		while (hex_digit(p[digits]) >= 0)
			digits++;
		if (!digits || (digits > 1 && digits % 2) || !strchr(" \t\n,:", p[digits]))
			return -EINVAL;
		if (n + (digits + 1) / 2 > cap) {
			*why = "too many bytes";
			return -ERANGE;
		}
		if (digits == 1)
			buf[n++] = (u8)hex_digit(*p++);
		for (; digits > 1; digits -= 2, p += 2)
			buf[n++] = (u8)(hex_digit(p[0]) << 4 | hex_digit(p[1]));
	}
	*size = n;
	return n ? 0 : -EINVAL;
}

/**
 * value_parse() - text to bytes
 * @t: data type
 * @text: value, terminated; strings may contain NULs
 * @len: bytes at @text
 * @buf: result
 * @cap: bytes at @buf, at least 8
 * @size: set to the bytes used
 * @why: set to what is wrong
 *
 * Strings are not changed; raw data are hex bytes.
 *
 * Return: 0, -EINVAL when it is malformed, -ERANGE when it does not fit.
 */
int value_parse(const struct ec_type *t, const char *text, size_t len, u8 *buf, size_t cap,
		size_t *size, const char **why)
{
	int ret;

	*size = value_bytes(t);
	if (value_is_text(t)) {
		*why = "the text is too long";
		if (len > cap)
			return -ERANGE;
		memcpy(buf, text, len);
		*size = len;
		return 0;
	}
	if (strlen(text) != len) {
		*why = "a NUL byte in a number";
		return -EINVAL;
	}
	if (t->kind == EC_KIND_FLOAT)
		return parse_real(t, text, buf, why);
	if (t->kind != EC_KIND_RAW)
		return parse_integer(t, text, buf, why);
	ret = parse_raw(text, buf, cap, size, why);
	if (!ret && t->bits && *size != value_bytes(t)) {
		*why = "wrong number of bytes for the type";
		return -ERANGE;
	}
	return ret;
}

u64 value_unsigned(const u8 *data, size_t size)
{
	u64 v = 0;

	for (size_t i = 0; i < size && i < 8; i++)
		v |= (u64)data[i] << 8 * i;
	return v;
}

s64 value_signed(const struct ec_type *t, const u8 *data, size_t size)
{
	u64 v = value_unsigned(data, size);
	u64 sign = 1ULL << (t->bits - 1);

	if (t->kind == EC_KIND_SM)
		return v & sign ? -(s64)(v & ~sign) : (s64)v;
	return t->bits == 64 ? (s64)v : (s64)((v ^ sign) - sign);
}

double value_real(const u8 *data, size_t size)
{
	u64 raw = value_unsigned(data, size);
	u32 raw32 = (u32)raw;
	double d;
	float f;

	memcpy(&d, &raw, sizeof(d));
	memcpy(&f, &raw32, sizeof(f));
	return size == 4 ? (double)f : d;
}

/* the shortest text that reads back as the same number, six digits or more */
static int format_real(const struct ec_type *t, const u8 *data, char *out, size_t cap)
{
	double d = value_real(data, value_bytes(t));
	int n = 0;

	for (int digits = 6; digits <= 17; digits++) {
		n = snprintf(out, cap, "%.*g", digits, d);
		if (t->bits == 32 ? strtof(out, NULL) == (float)d : strtod(out, NULL) == d)
			break;
		if (isnan(d))
			break;
	}
	return n;
}

static int format_raw(const u8 *data, size_t size, char *out, size_t cap)
{
	size_t n = 0;

	if (cap < 5 * size + 1)
		return -ENOSPC;
	out[0] = 0;
	for (size_t i = 0; i < size; i++)
		n += (size_t)snprintf(out + n, cap - n, "%s0x%02x", i ? " " : "", data[i]);
	return (int)n;
}

/**
 * value_format() - bytes to text
 * @t: data type, not a string
 * @data: bytes
 * @size: how many
 * @out: text, terminated, without a newline
 * @cap: bytes at @out; VALUE_TEXT, for raw data 5 * @size + 1
 *
 * Return: length of the text, -EMSGSIZE when @size is not that of the type.
 */
int value_format(const struct ec_type *t, const u8 *data, size_t size, char *out, size_t cap)
{
	unsigned int bytes = (unsigned int)value_bytes(t);

	if (bytes && size != bytes)
		return -EMSGSIZE;
	switch (t->kind) {
	case EC_KIND_FLOAT:
		return format_real(t, data, out, cap);
	case EC_KIND_INT:
	case EC_KIND_SM:
		return snprintf(out, cap, "0x%0*llx %lld", 2 * (int)bytes,
				(unsigned long long)value_unsigned(data, size),
				(long long)value_signed(t, data, size));
	case EC_KIND_BOOL:
	case EC_KIND_UINT:
	case EC_KIND_BITS:
		return snprintf(out, cap, "0x%0*llx %llu", 2 * (int)bytes,
				(unsigned long long)value_unsigned(data, size),
				(unsigned long long)value_unsigned(data, size));
	default:
		return format_raw(data, size, out, cap);
	}
}
