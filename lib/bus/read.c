// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Bus files are read event by event along the table of fields. Nothing is kept that the table does
 * not have, so that nesting ends where the table ends, and an alias is refused where it stands.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <yaml.h>

#include "fields.h"
#include "internal.h"
#include "../tools/text.h"

struct reader {
	struct whole *w;
	const char *file;
	const char *data;
	size_t size;
	struct ecb_error *e;
	yaml_parser_t parser;
	yaml_event_t event;
	bool has_event;
};

#define AT_EVENT(r)	(r)->event.start_mark.line + 1, (r)->event.start_mark.column + 1

static int memory(struct reader *r)
{
	ecb_report(r->e, r->file, 0, 0, "needs more than %u MiB of memory", ECB_MEMORY_MAX >> 20);
	return -ENOMEM;
}

/* what libyaml says of bytes that are no YAML; of some errors it knows the byte only */
static int syntax(struct reader *r)
{
	const yaml_parser_t *p = &r->parser;
	size_t line = p->problem_mark.line, start = 0;

	if (p->error == YAML_MEMORY_ERROR)
		return memory(r);
	if (p->error != YAML_READER_ERROR)
		return ecb_report(r->e, r->file, line + 1, p->problem_mark.column + 1,
				  "%s; expected YAML", p->problem);
	line = 1;
	for (size_t i = 0; i < p->problem_offset && i < r->size; i++)
		if (r->data[i] == '\n') {
			line++;
			start = i + 1;
		}
	return ecb_report(r->e, r->file, line, p->problem_offset - start + 1,
			  "%s; expected YAML in UTF-8", p->problem);
}

static int next(struct reader *r)
{
	const yaml_char_t *anchor = NULL, *tag = NULL;

	if (r->has_event)
		yaml_event_delete(&r->event);
	r->has_event = yaml_parser_parse(&r->parser, &r->event);
	if (!r->has_event)
		return syntax(r);
	switch (r->event.type) {
	case YAML_ALIAS_EVENT:
		return ecb_report(r->e, r->file, AT_EVENT(r),
				  "alias '*%.40s'; expected the value itself, since bus files have no aliases",
				  (char *)r->event.data.alias.anchor);
	case YAML_SCALAR_EVENT:
		anchor = r->event.data.scalar.anchor;
		tag = r->event.data.scalar.tag;
		break;
	case YAML_SEQUENCE_START_EVENT:
		anchor = r->event.data.sequence_start.anchor;
		tag = r->event.data.sequence_start.tag;
		break;
	case YAML_MAPPING_START_EVENT:
		anchor = r->event.data.mapping_start.anchor;
		tag = r->event.data.mapping_start.tag;
		break;
	default:
		break;
	}
	if (anchor || tag)
		return ecb_report(r->e, r->file, AT_EVENT(r),
				  "%s '%.40s'; expected a value without it", anchor ? "anchor" : "tag",
				  (char *)(anchor ? anchor : tag));
	return 0;
}

/* what the event is, for messages */
static const char *found(const struct reader *r, char *buf, size_t size)
{
	switch (r->event.type) {
	case YAML_SCALAR_EVENT:
		if (!r->event.data.scalar.length)
			return "nothing";
		snprintf(buf, size, "'%.60s'", (char *)r->event.data.scalar.value);
		return buf;
	case YAML_SEQUENCE_START_EVENT:
		return "a list";
	case YAML_MAPPING_START_EVENT:
		return "keys";
	default:
		return "nothing";
	}
}

static int wrong(struct reader *r, const struct field *f)
{
	char expected[256], buf[64];

	scalar_expected(f, expected, sizeof(expected));
	return ecb_report(r->e, r->file, AT_EVENT(r), "%s: found %s, expected %s", f->key,
			  found(r, buf, sizeof(buf)), expected);
}

static int unknown(struct reader *r, const struct type *type, const char *key)
{
	const char *nearest = NULL;
	char all[300] = "";
	size_t n = 0;

	for (size_t i = 0; i < type->count; i++) {
		nearest = text_nearer(key, nearest, type->fields[i].key);
		n += (size_t)snprintf(all + n, sizeof(all) - n, "%s%s", i ? ", " : "",
				      type->fields[i].key);
		if (n >= sizeof(all))
			n = sizeof(all) - 1;
	}
	if (nearest)
		return ecb_report(r->e, r->file, AT_EVENT(r),
				  "unknown key '%.60s' of %s; did you mean '%s'?", key, type->name,
				  nearest);
	return ecb_report(r->e, r->file, AT_EVENT(r),
			  "unknown key '%.60s' of %s; expected one of %s", key, type->name, all);
}

/* the event is a key: its field */
static int key(struct reader *r, const struct type *type, uint64_t seen, const struct field **to)
{
	const char *text = (const char *)r->event.data.scalar.value;

	if (r->event.type != YAML_SCALAR_EVENT)
		return ecb_report(r->e, r->file, AT_EVENT(r), "expected a key of %s",
				  type->name);
	for (size_t i = 0; i < type->count; i++) {
		const struct field *f = &type->fields[i];

		if (strcmp(f->key, text) || strlen(text) != r->event.data.scalar.length)
			continue;
		if (f->kind == K_LATER)
			return ecb_report(r->e, r->file, AT_EVENT(r),
					  "'%s' (%s) is not supported yet; remove it", text,
					  f->text);
		if (seen >> i & 1)
			return ecb_report(r->e, r->file, AT_EVENT(r), "key '%s' of %s twice", text,
					  type->name);
		*to = f;
		return 0;
	}
	return unknown(r, type, text);
}

static int item(struct reader *r, const struct type *type, void *to);

static int list(struct reader *r, const struct field *f, void *to)
{
	void *entry;
	int ret;

	if (r->event.type != YAML_SEQUENCE_START_EVENT)
		return wrong(r, f);
	for (size_t n = 0;; n++) {
		ret = next(r);
		if (ret || r->event.type == YAML_SEQUENCE_END_EVENT)
			return ret;
		if (n == f->type->most)
			return ecb_report(r->e, r->file, AT_EVENT(r), "%s: expected at most %zu",
					  f->key, n);
		entry = ecb_append(r->w, to, f->type);
		if (!entry)
			return memory(r);
		ret = item(r, f->type, entry);
		if (ret)
			return ret;
	}
}

static int value(struct reader *r, const struct field *f, char *to)
{
	void *entry;

	if (f->kind == K_LIST)
		return list(r, f, to);
	if (f->kind == K_ITEM) {
		if (r->event.type != YAML_MAPPING_START_EVENT)
			return wrong(r, f);
		entry = ecb_alloc(r->w, f->type->size);
		if (!entry)
			return memory(r);
		ecb_defaults(f->type, entry);
		*(void **)to = entry;
		return item(r, f->type, entry);
	}
	if (r->event.type != YAML_SCALAR_EVENT)
		return wrong(r, f);
	if (scalar_parse(r->w, f, (const char *)r->event.data.scalar.value,
			 r->event.data.scalar.length, to))
		return 0;
	return errno == ENOMEM ? memory(r) : wrong(r, f);
}

/* keys and values; the event begins them, and afterwards it ends them */
static int item(struct reader *r, const struct type *type, void *to)
{
	yaml_mark_t start = r->event.start_mark;
	const struct field *f = NULL;
	uint64_t seen = 0;
	char buf[64];
	int ret;

	if (r->event.type != YAML_MAPPING_START_EVENT)
		return ecb_report(r->e, r->file, AT_EVENT(r), "found %s, expected keys of %s",
				  found(r, buf, sizeof(buf)), type->name);
	*(uint32_t *)to = (uint32_t)start.line + 1;
	for (;;) {
		ret = next(r);
		if (ret)
			return ret;
		if (r->event.type == YAML_MAPPING_END_EVENT)
			break;
		ret = key(r, type, seen, &f);
		if (!ret)
			ret = next(r);
		if (!ret)
			ret = value(r, f, (char *)to + f->at);
		if (ret)
			return ret;
		seen |= (uint64_t)1 << (f - type->fields);
	}
	for (size_t i = 0; i < type->count; i++)
		if (type->fields[i].flags & F_REQUIRED && !(seen >> i & 1))
			return ecb_report(r->e, r->file, start.line + 1, start.column + 1,
					  "%s without '%s'", type->name, type->fields[i].key);
	return 0;
}

/* a line of YAML also ends with CR, NEL, LS and PS */
static bool begins_line(const char *data, size_t i)
{
	return !i || data[i - 1] == '\n' || data[i - 1] == '\r' ||
		(i > 1 && !memcmp(data + i - 2, "\xc2\x85", 2)) ||
		(i > 2 && !memcmp(data + i - 3, "\xe2\x80\xa8", 3)) ||
		(i > 2 && !memcmp(data + i - 3, "\xe2\x80\xa9", 3));
}

/* libyaml compares each tag directive with all before it, and a bus file has no tags */
static int directives(struct reader *r)
{
	size_t line = 1;

	for (size_t i = 0; i < r->size; i++) {
		line += r->data[i] == '\n';
		if (r->data[i] == '%' && begins_line(r->data, i))
			return ecb_report(r->e, r->file, line, 1,
					  "a line that begins with '%%'; expected none, since bus files have no directives");
	}
	return 0;
}

static int document(struct reader *r)
{
	int ret = directives(r);

	if (!ret)
		ret = next(r);	/* begin of the stream */
	if (!ret)
		ret = next(r);
	if (!ret && r->event.type == YAML_STREAM_END_EVENT)
		return ecb_report(r->e, r->file, 1, 1, "an empty file; expected 'ethercat: %u'",
				  ECB_VERSION);
	if (!ret)
		ret = next(r);
	if (!ret)
		ret = item(r, &type_bus, &r->w->bus);
	if (!ret)
		ret = next(r);	/* end of the document */
	if (!ret)
		ret = next(r);
	if (!ret && r->event.type != YAML_STREAM_END_EVENT)
		return ecb_report(r->e, r->file, AT_EVENT(r),
				  "a second document; expected the end of the file");
	return ret;
}

ECB_API int ecb_file_parse(struct ecb_bus **bus, const char *name, const void *data, size_t size,
			   struct ecb_error *error)
{
	struct reader r = { .file = name, .data = data, .size = size, .e = error };
	int ret;

	*bus = NULL;
	memset(error, 0, sizeof(*error));
	if (size > ECB_FILE_MAX)
		return ecb_report(error, name, 0, 0, "larger than %u MiB", ECB_FILE_MAX >> 20);
	r.w = (struct whole *)ecb_bus_new();
	if (!r.w || !yaml_parser_initialize(&r.parser)) {
		ecb_bus_free((struct ecb_bus *)r.w);
		return memory(&r);
	}
	yaml_parser_set_encoding(&r.parser, YAML_UTF8_ENCODING);
	if (size >= 3 && !memcmp(data, "\xef\xbb\xbf", 3)) {
		r.data += 3;
		r.size -= 3;
	}
	yaml_parser_set_input_string(&r.parser, (const unsigned char *)r.data, r.size);
	ret = document(&r);
	if (r.has_event)
		yaml_event_delete(&r.event);
	yaml_parser_delete(&r.parser);
	if (!ret)
		ret = ecb_rules(r.w, name, error);
	if (ret)
		ecb_bus_free(&r.w->bus);
	else
		*bus = &r.w->bus;
	return ret;
}

/* at most one byte more than is allowed */
static int slurp(int fd, char **data, size_t *size)
{
	size_t room = 1 << 16;
	char *buf = malloc(room), *grown;
	ssize_t n;

	*size = 0;
	while (buf) {
		n = read(fd, buf + *size, room - *size);
		if (n < 0 && errno == EINTR)
			continue;
		if (n < 0) {
			n = -errno;
			free(buf);
			return (int)n;
		}
		*size += (size_t)n;
		if (!n || *size > ECB_FILE_MAX) {
			*data = buf;
			return 0;
		}
		if (*size < room)
			continue;
		room = room < ECB_FILE_MAX ? 2 * room : ECB_FILE_MAX + 1;
		grown = realloc(buf, room);
		if (!grown)
			free(buf);
		buf = grown;
	}
	return -ENOMEM;
}

static int cannot_read(const char *name, int err, struct ecb_error *error)
{
	ecb_report(error, name, 0, 0, "%s", strerror(-err));
	return err;
}

ECB_API int ecb_file_read_fd(struct ecb_bus **bus, int fd, const char *name,
			     struct ecb_error *error)
{
	char *data = NULL;
	size_t size = 0;
	int ret = slurp(fd, &data, &size);

	*bus = NULL;
	memset(error, 0, sizeof(*error));
	if (ret)
		return cannot_read(name, ret, error);
	ret = ecb_file_parse(bus, name, data, size, error);
	free(data);
	return ret;
}

ECB_API int ecb_file_read(struct ecb_bus **bus, const char *path, struct ecb_error *error)
{
	bool in = !strcmp(path, "-");
	int fd = in ? 0 : open(path, O_RDONLY | O_CLOEXEC), ret;

	*bus = NULL;
	memset(error, 0, sizeof(*error));
	if (fd < 0)
		return cannot_read(path, -errno, error);
	ret = ecb_file_read_fd(bus, fd, in ? "stdin" : path, error);
	if (!in)
		close(fd);
	return ret;
}
