// SPDX-License-Identifier: GPL-2.0-only
/*
 * What is needed of an ESI file: <DiagMessage> with <TextId> and <MessageText>. No more of XML is
 * understood than elements, CDATA and the five entities.
 */
#define _GNU_SOURCE	/* memmem() */
#include "esi_texts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/tools/text.h"
#include "io.h"

#define ENGLISH	"1033"

/* a part of the file */
struct span {
	char *p;
	char *end;
};

/*
 * The next element @name of @in; @in then begins behind it. @head: its start tag.
 * Elements of this name in each other do not occur.
 */
static bool element(struct span *in, const char *name, struct span *head, struct span *body)
{
	size_t n = strlen(name);

	while (in->p < in->end) {
		char *open = memchr(in->p, '<', (size_t)(in->end - in->p)), *stop;
		char close[32];

		if (!open)
			break;
		in->p = open + 1;
		if (strncmp(in->p, name, n) || !strchr(" \t\r\n>", in->p[n]))
			continue;
		stop = strchr(in->p, '>');
		if (!stop || stop >= in->end || stop[-1] == '/')
			continue;
		*head = (struct span){ in->p + n, stop };
		snprintf(close, sizeof(close), "</%s", name);
		body->p = stop + 1;
		body->end = strstr(stop, close);
		if (!body->end || body->end > in->end)
			break;
		in->p = body->end;
		return true;
	}
	in->p = in->end;
	return false;
}

static bool contains(const struct span *s, const char *text)
{
	return memmem(s->p, (size_t)(s->end - s->p), text, strlen(text));
}

/* "#x1a" or decimal */
static bool text_id(const struct span *s, u16 *id)
{
	bool hex;
	char *end, *p = s->p;
	unsigned long v;

	p += strspn(p, " \t\r\n");
	hex = p[0] == '#' && p[1] == 'x';
	v = strtoul(hex ? p + 2 : p, &end, hex ? 16 : 10);
	*id = (u16)v;
	return end > p && end <= s->end && v <= 0xffff;
}

/* The text without CDATA and entities, to be freed. */
static char *plain(const struct span *s)
{
	static const struct {
		const char *name;
		char c;
	} entities[] = {
		{ "&lt;", '<' }, { "&gt;", '>' }, { "&amp;", '&' }, { "&quot;", '"' },
		{ "&apos;", '\'' },
	};
	char *to = malloc((size_t)(s->end - s->p) + 1), *at = to;

	for (const char *p = s->p; to && p < s->end;) {
		size_t step = 0;

		if (!strncmp(p, "<![CDATA[", 9))
			step = 9;
		else if (!strncmp(p, "]]>", 3))
			step = 3;
		for (size_t i = 0; !step && i < sizeof(entities) / sizeof(*entities); i++)
			if (!strncmp(p, entities[i].name, strlen(entities[i].name))) {
				step = strlen(entities[i].name);
				*at++ = entities[i].c;
			}
		if (!step)
			*at++ = *p;
		p += step ? step : 1;
	}
	if (to) {
		*at = 0;
		text_clean(to, (size_t)(at - to));
	}
	return to;
}

static int add(struct esi_texts *t, u16 id, const struct span *text)
{
	struct esi_text *more;

	if (esi_text(t, id))
		return 0;
	more = realloc(t->v, (t->n + 1) * sizeof(*t->v));
	if (!more)
		return 1;
	t->v = more;
	t->v[t->n] = (struct esi_text){ .id = id, .text = plain(text) };
	return t->v[t->n].text ? !++t->n : 1;
}

static bool is_space(char c)
{
	return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static void trim(struct span *s)
{
	while (s->p < s->end && is_space(*s->p))
		s->p++;
	while (s->p < s->end && is_space(s->end[-1]))
		s->end--;
}

/* English, otherwise the first language */
static bool message_text(struct span message, struct span *text)
{
	struct span head, body;
	bool found = false;

	while (element(&message, "MessageText", &head, &body)) {
		bool english = contains(&head, ENGLISH);

		if (!found || english)
			*text = body;
		found = true;
		if (english)
			break;
	}
	if (found)
		trim(text);
	return found;
}

void esi_texts_free(struct esi_texts *t)
{
	for (size_t i = 0; i < t->n; i++)
		free(t->v[i].text);
	free(t->v);
	*t = (struct esi_texts){ 0 };
}

/**
 * esi_texts_load() - read the texts of an ESI file
 * @path: name, "-" for stdin
 * @t: result, to be freed with esi_texts_free()
 *
 * Return: 0, or 1 after printing what is wrong.
 */
int esi_texts_load(const char *path, struct esi_texts *t)
{
	struct span all, head, message, in, text;
	size_t size;
	int bad = 0;
	u8 *data;
	u16 id;

	*t = (struct esi_texts){ 0 };
	if (io_read(path, &data, &size))
		return 1;
	all = (struct span){ (char *)data, (char *)data + strlen((char *)data) };
	while (!bad && element(&all, "DiagMessage", &head, &message)) {
		in = message;
		if (element(&in, "TextId", &head, &text) && text_id(&text, &id) &&
		    message_text(message, &text))
			bad = add(t, id, &text);
	}
	free(data);
	if (bad) {
		esi_texts_free(t);
		return fail("out of memory");
	}
	if (!t->n)
		return fail("'%s' has no texts of diagnosis messages (DiagMessage with TextId and MessageText); pass the ESI file of the slave",
			    path);
	return 0;
}

const char *esi_text(const struct esi_texts *t, u16 id)
{
	for (size_t i = 0; i < t->n; i++)
		if (t->v[i].id == id)
			return t->v[i].text;
	return NULL;
}
