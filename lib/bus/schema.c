// SPDX-License-Identifier: LGPL-2.1-or-later
/* JSON Schema of bus files, made of the table of fields. */
#include <errno.h>
#include <inttypes.h>

#include "fields.h"
#include "internal.h"

static void words(FILE *to, const struct field *f)
{
	fputs("\"enum\": [", to);
	for (size_t i = 0; f->words[i]; i++)
		fprintf(to, "%s\"%s\"", i ? ", " : "", f->words[i]);
	putc(']', to);
}

static void number(FILE *to, const struct field *f)
{
	if (f->kind == K_REAL)
		fputs("{\"type\": \"number\"}", to);
	else if (f->kind == K_SIGNED)
		fputs("{\"type\": \"integer\"}", to);
	else
		fprintf(to, "{\"type\": \"integer\", \"minimum\": %" PRIu64 ", \"maximum\": %"
			PRIu64 "}", f->min, f->max);
}

static void object(FILE *to, const struct type *type, unsigned int depth);

static void field(FILE *to, const struct field *f, unsigned int depth)
{
	const char *pattern = scalar_pattern(f);

	fprintf(to, "%*s\"%s\": {\n%*s\"description\": \"%s\",\n%*s", depth, "", f->key,
		depth + 2, "", f->text, depth + 2, "");
	switch (f->kind) {
	case K_NUMBER:
	case K_SIGNED:
	case K_REAL:
		fputs("\"anyOf\": [", to);
		number(to, f);
		fprintf(to, ", {\"type\": \"string\", \"pattern\": \"%s\"}]", pattern);
		break;
	case K_BOOL:
		fputs("\"type\": \"boolean\"", to);
		break;
	case K_WORD:
		words(to, f);
		break;
	case K_TEXT:
		fprintf(to, "\"type\": \"string\", \"minLength\": 1, \"maxLength\": %d", TEXT_MAX);
		break;
	case K_LIST:
		fprintf(to, "\"type\": \"array\", \"maxItems\": %zu,\n%*s\"items\": ",
			f->type->most, depth + 2, "");
		object(to, f->type, depth + 2);
		break;
	case K_ITEM:
		fputs("\"allOf\": [", to);
		object(to, f->type, depth + 2);
		putc(']', to);
		break;
	default:
		fprintf(to, "\"type\": \"string\", \"pattern\": \"%s\"", pattern);
	}
	fprintf(to, "\n%*s}", depth, "");
}

static void object(FILE *to, const struct type *type, unsigned int depth)
{
	const char *sep = "";

	fprintf(to, "{\n%*s\"type\": \"object\", \"additionalProperties\": false,\n", depth + 2, "");
	fprintf(to, "%*s\"required\": [", depth + 2, "");
	for (size_t i = 0; i < type->count; i++)
		if (type->fields[i].flags & F_REQUIRED) {
			fprintf(to, "%s\"%s\"", sep, type->fields[i].key);
			sep = ", ";
		}
	fprintf(to, "],\n%*s\"properties\": {\n", depth + 2, "");
	sep = "";
	for (size_t i = 0; i < type->count; i++) {
		if (type->fields[i].kind == K_LATER)
			continue;
		fputs(sep, to);
		field(to, &type->fields[i], depth + 4);
		sep = ",\n";
	}
	fprintf(to, "\n%*s}\n%*s}", depth + 2, "", depth, "");
}

ECB_API int ecb_file_schema(FILE *to)
{
	fputs("{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
	      "  \"title\": \"EtherCAT bus file\",\n  \"allOf\": [", to);
	object(to, &type_bus, 2);
	fputs("]\n}\n", to);
	return fflush(to) || ferror(to) ? -EIO : 0;
}
