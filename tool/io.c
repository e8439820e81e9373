// SPDX-License-Identifier: GPL-2.0-only
#include "io.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "out.h"

#define MAX_INPUT	(256u << 20)

int io_number(const char *what, const char *text, u64 max, u64 *v)
{
	const char *why;

	switch (number_parse(text, max, v, &why)) {
	case 0:
		return 0;
	case -ERANGE:
		if (max < 10)
			return usage_error("invalid %s '%s': expected 0 to %u", what, text,
					   (unsigned int)max);
		return usage_error("invalid %s '%s': expected 0 to 0x%llx", what, text,
				   (unsigned long long)max);
	default:
		return usage_error("invalid %s '%s': %s", what, text, why);
	}
}

int io_type(const char *name, const struct ec_type **t)
{
	*t = ec_type_by_name(name);
	return *t ? 0 : usage_error("unknown data type '%s'; 'ethercat help types' lists them",
				    name);
}

static int read_stream(FILE *f, u8 **data, size_t *size)
{
	u8 *buf = NULL, *more;
	size_t n = 0, cap = 0, got;

	do {
		if (n == cap) {
			cap = cap ? 2 * cap : 4096;
			more = cap > MAX_INPUT ? NULL : realloc(buf, cap + 1);
			if (!more) {
				free(buf);
				return cap > MAX_INPUT ? EFBIG : ENOMEM;
			}
			buf = more;
		}
		got = fread(buf + n, 1, cap - n, f);
		n += got;
	} while (got);
	if (ferror(f)) {
		free(buf);
		return errno ? errno : EIO;
	}
	buf[n] = 0;
	*data = buf;
	*size = n;
	return 0;
}

/* a whole file, "-" is stdin; a NUL follows the data, which are to be freed */
int io_read_any(const char *path, u8 **data, size_t *size)
{
	bool in = !strcmp(path, "-");
	FILE *f = in ? stdin : fopen(path, "rb");
	int err;

	if (!f)
		return fail_full(errno, NULL, 0, "cannot open %s", path);
	err = read_stream(f, data, size);
	if (!in)
		fclose(f);
	return err ? fail_full(err, NULL, 0, "cannot read %s", in ? "stdin" : path) : 0;
}

/* the same; it must not be empty */
int io_read(const char *path, u8 **data, size_t *size)
{
	int ret = io_read_any(path, data, size);

	if (ret || *size)
		return ret;
	free(*data);
	return fail("%s is empty", strcmp(path, "-") ? path : "stdin");
}

/* hex bytes typed for a type whose value is the characters */
static bool looks_like_hex(const char *text)
{
	return !strncasecmp(text, "0x", 2) && !text[strspn(text, "0123456789abcdefABCDEFxX ")];
}

static int bad_value(const struct ec_type *t, const char *text, int err, const char *why)
{
	u64 most = t->bits < 64 ? (1ULL << t->bits) - 1 : ~0ULL;

	if (err == -ERANGE && (t->kind == EC_KIND_INT || t->kind == EC_KIND_SM))
		return usage_error("invalid value '%s' for type %s: expected %lld to %lld", text,
				   t->name, -(long long)(most >> 1) - (t->kind == EC_KIND_INT),
				   (long long)(most >> 1));
	if (err == -ERANGE && (t->kind == EC_KIND_BOOL || t->kind == EC_KIND_UINT ||
			       t->kind == EC_KIND_BITS))
		return usage_error("invalid value '%s' for type %s: expected 0 to %llu", text,
				   t->name, (unsigned long long)most);
	return usage_error("invalid value '%s' for type %s: %s", text, t->name, why);
}

/* bytes of a value as typed, "-" takes it from stdin; to be freed */
int io_value(const struct ec_type *t, const char *text, u8 **data, size_t *size)
{
	u8 *in = NULL, *buf;
	size_t len = strlen(text), cap;
	const char *why;
	int ret;

	if (!strcmp(text, "-")) {
		if (io_read("-", &in, &len))
			return 1;
		/* the end of the line is no part of a number */
		while (!value_is_text(t) && len && strchr(" \t\r\n", in[len - 1]))
			in[--len] = 0;
	}
	cap = max(len, (size_t)8);
	buf = malloc(cap);
	if (!buf) {
		free(in);
		return fail("out of memory");
	}
	if (!in && t->kind == EC_KIND_OCTETS && looks_like_hex(text))
		note("warning: %s writes the characters '%s'; --type raw writes these bytes",
		     t->name, text);
	ret = value_parse(t, in ? (const char *)in : text, len, buf, cap, size, &why);
	if (ret) {
		bad_value(t, in ? "-" : text, ret, why);
		free(buf);
	} else {
		*data = buf;
	}
	free(in);
	return ret ? 1 : 0;
}

static void print_json(const struct ec_type *t, const u8 *data, size_t size)
{
	char *text;

	switch (t->kind) {
	case EC_KIND_BOOL:
		out_bool("value", value_unsigned(data, size), NULL);
		break;
	case EC_KIND_INT:
	case EC_KIND_SM:
		out_i("value", value_signed(t, data, size), NULL);
		break;
	case EC_KIND_UINT:
	case EC_KIND_BITS:
		out_u("value", value_unsigned(data, size), NULL);
		break;
	case EC_KIND_FLOAT:
		out_f("value", value_real(data, size), NULL);
		break;
	case EC_KIND_STRING:
		text = calloc(size + 1, 1);
		if (text)
			memcpy(text, data, size);
		out_str("value", text ? text : "", NULL);
		free(text);
		break;
	default:
		break;
	}
}

/* a value on stdout: text unchanged, other types formatted; JSON adds the bytes */
int io_print(const struct ec_type *t, const u8 *data, size_t size)
{
	size_t bytes = value_bytes(t), cap = max((size_t)VALUE_TEXT, 5 * size + 1), len = size;
	char *text;

	if (bytes && size != bytes)
		return fail("type %s has %zu byte(s), but %zu were received", t->name, bytes, size);
	out_str("type", t->name, NULL);
	out_u("size_bytes", size, NULL);
	if (out_is_json()) {
		print_json(t, data, size);
		out_hex("data_hex", data, size, "");
		return 0;
	}
	if (t->kind == EC_KIND_UNICODE && out_to_terminal()) {
		out_utf16(data, size);
		out_text("\n");
		return 0;
	}
	if (value_is_text(t) &&
	    !(t->kind == EC_KIND_OCTETS && out_to_terminal() && !out_is_line(data, size))) {
		/* slaves fill a string up with NULs */
		while (t->kind == EC_KIND_STRING && len && !data[len - 1])
			len--;
		out_text_bytes(data, len);
		if (t->kind != EC_KIND_OCTETS)
			out_text("\n");
		return 0;
	}
	text = malloc(cap);
	if (!text)
		return fail("out of memory");
	value_format(value_is_text(t) ? ec_type_by_code(EC_TYPE_RAW) : t, data, size, text, cap);
	out_text("%s\n", text);
	free(text);
	return 0;
}
