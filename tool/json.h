/* SPDX-License-Identifier: GPL-2.0-only */
/* A reader of JSON files, which may have any content. */
#ifndef EC_TOOL_JSON_H
#define EC_TOOL_JSON_H

#include <stdbool.h>
#include <stddef.h>

#include "../master/wire/env.h"

enum json_kind { JSON_NULL, JSON_BOOL, JSON_NUMBER, JSON_STRING, JSON_ARRAY, JSON_OBJECT };

/**
 * struct json - a value
 * @kind: of it
 * @key: in an object; points into the text that was parsed
 * @text: of a string; likewise
 * @integer: the number is a whole one from 0 on, in @u
 * @u: this number; of a bool 0 or 1
 * @child: first of array and object
 * @next: of the same array or object
 */
struct json {
	enum json_kind kind;
	const char *key;
	const char *text;
	bool integer;
	u64 u;
	struct json *child;
	struct json *next;
};

struct json *json_parse(char *text, size_t *line, const char **why);
void json_free(struct json *j);
const struct json *json_get(const struct json *object, const char *key);
bool json_u(const struct json *object, const char *key, u64 max, u64 *v);
const char *json_str(const struct json *object, const char *key);

#endif
