// SPDX-License-Identifier: GPL-2.0-only
#include "json.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#define DEPTH	32

struct reader {
	char *p;
	unsigned int depth;
	const char *why;
};

static struct json *value(struct reader *r);

static void *failed(struct reader *r, const char *why)
{
	if (!r->why)
		r->why = why;
	return NULL;
}

static char *skip(struct reader *r)
{
	r->p += strspn(r->p, " \t\r\n");
	return r->p;
}

static int hex4(const char *p)
{
	int v = 0;

	for (int i = 0; i < 4; i++) {
		const char *digits = "0123456789abcdef0123456789ABCDEF";
		const char *d = p[i] ? strchr(digits, p[i]) : NULL;

		if (!d)
			return -1;
		v = v << 4 | (int)((d - digits) & 15);
	}
	return v;
}

/* One half of a surrogate pair becomes a character of its own, which is not UTF-8 but harmless. */
static char *put_utf8(char *to, int c)
{
	if (c < 0x80) {
		*to++ = (char)(c ? c : '?');
	} else if (c < 0x800) {
		*to++ = (char)(0xc0 | c >> 6);
		*to++ = (char)(0x80 | (c & 0x3f));
	} else {
		*to++ = (char)(0xe0 | c >> 12);
		*to++ = (char)(0x80 | (c >> 6 & 0x3f));
		*to++ = (char)(0x80 | (c & 0x3f));
	}
	return to;
}

/* In its place: an escape is never shorter than what it stands for. */
static char *string(struct reader *r)
{
	static const char names[] = "\"\\/bfnrt", chars[] = "\"\\/\b\f\n\r\t";
	char *begin = r->p + 1, *from = begin, *to = begin;

	while (*from != '"') {
		const char *n;
		int c;

		if ((unsigned char)*from < 0x20)
			return failed(r, "string without end");
		if (*from != '\\') {
			*to++ = *from++;
			continue;
		}
		from++;
		n = *from ? strchr(names, *from) : NULL;
		if (n) {
			*to++ = chars[n - names];
			from++;
			continue;
		}
		c = *from == 'u' ? hex4(from + 1) : -1;
		if (c < 0)
			return failed(r, "unknown escape in a string");
		to = put_utf8(to, c);
		from += 5;
	}
	*to = 0;
	r->p = from + 1;
	return begin;
}

static bool number(struct reader *r, struct json *j)
{
	char *end, *digits;

	strtod(r->p, &end);
	if (end == r->p || strspn(r->p, "+-.0123456789eE") != (size_t)(end - r->p)) {
		failed(r, "value expected");
		return false;
	}
	errno = 0;
	j->kind = JSON_NUMBER;
	j->u = strtoull(r->p, &digits, 10);
	j->integer = digits == end && *r->p != '-' && !errno;
	r->p = end;
	return true;
}

static bool word(struct reader *r, struct json *j, const char *text, enum json_kind kind, u64 u)
{
	size_t n = strlen(text);

	if (strncmp(r->p, text, n))
		return false;
	j->kind = kind;
	j->u = u;
	r->p += n;
	return true;
}

static bool member_key(struct reader *r, const char **key)
{
	if (*skip(r) != '"') {
		failed(r, "key expected");
		return false;
	}
	*key = string(r);
	if (!*key)
		return false;
	if (*skip(r) != ':') {
		failed(r, "':' expected");
		return false;
	}
	r->p++;
	return true;
}

static bool members(struct reader *r, struct json *j, char close)
{
	struct json **last = &j->child;

	r->p++;
	if (*skip(r) == close) {
		r->p++;
		return true;
	}
	for (;;) {
		const char *key = NULL;

		if (close == '}' && !member_key(r, &key))
			return false;
		*last = value(r);
		if (!*last)
			return false;
		(*last)->key = key;
		last = &(*last)->next;
		if (*skip(r) == close)
			break;
		if (*r->p != ',') {
			failed(r, close == '}' ? "',' or '}' expected" : "',' or ']' expected");
			return false;
		}
		r->p++;
	}
	r->p++;
	return true;
}

static struct json *value(struct reader *r)
{
	struct json *j = calloc(1, sizeof(*j));
	bool ok;

	if (!j)
		return failed(r, "out of memory");
	if (++r->depth > DEPTH) {
		failed(r, "too many levels");
		ok = false;
	} else if (*skip(r) == '{' || *r->p == '[') {
		j->kind = *r->p == '{' ? JSON_OBJECT : JSON_ARRAY;
		ok = members(r, j, *r->p == '{' ? '}' : ']');
	} else if (*r->p == '"') {
		j->kind = JSON_STRING;
		j->text = string(r);
		ok = j->text;
	} else {
		ok = word(r, j, "null", JSON_NULL, 0) || word(r, j, "true", JSON_BOOL, 1) ||
		     word(r, j, "false", JSON_BOOL, 0) || number(r, j);
	}
	r->depth--;
	if (ok)
		return j;
	json_free(j);
	return NULL;
}

/**
 * json_parse() - read a text
 * @text: ends with a NUL; strings are decoded in it, so it must stay
 * @line: of the mistake
 * @why: what the mistake is
 *
 * Return: the value, to be freed with json_free(); NULL after a mistake.
 */
struct json *json_parse(char *text, size_t *line, const char **why)
{
	struct reader r = { .p = text };
	struct json *j = value(&r);

	if (j && *skip(&r)) {
		json_free(j);
		j = failed(&r, "more than one value");
	}
	*why = r.why;
	*line = 1;
	for (const char *p = text; p < r.p; p++)
		*line += *p == '\n';
	return j;
}

/* Values next to each other are freed in a loop: there may be many. */
void json_free(struct json *j)
{
	while (j) {
		struct json *next = j->next;

		json_free(j->child);
		free(j);
		j = next;
	}
}

const struct json *json_get(const struct json *object, const char *key)
{
	if (!object || object->kind != JSON_OBJECT)
		return NULL;
	for (const struct json *j = object->child; j; j = j->next)
		if (!strcmp(j->key, key))
			return j;
	return NULL;
}

/* false: there is none, or it is no whole number up to @max */
bool json_u(const struct json *object, const char *key, u64 max, u64 *v)
{
	const struct json *j = json_get(object, key);

	if (!j || j->kind != JSON_NUMBER || !j->integer || j->u > max)
		return false;
	*v = j->u;
	return true;
}

const char *json_str(const struct json *object, const char *key)
{
	const struct json *j = json_get(object, key);

	return j && j->kind == JSON_STRING ? j->text : NULL;
}
