// SPDX-License-Identifier: GPL-2.0-only
/* The commands of a configuration for the steps of its slave from one AL state to another. */
#include "config_info.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "../master/wire/al.h"
#include "out.h"

#define VALUE_MAX	0x10000	/* bytes of one value */
#define SHOWN		1024

static void head(const struct ect_step_command *s, const char *in)
{
	static const char *const kind[] = { "SDO", "IDN", "register" };
	char step[32];

	snprintf(step, sizeof(step), "%s to %s", ec_al_state_name(s->from),
		 ec_al_state_name(s->to));
	out_str("step", step, "%s  %s: ", in, step);
	out_str("kind", s->kind < ARRAY_SIZE(kind) ? kind[s->kind] : "???", NULL);
	if (s->kind == ECT_WRITE_IDN) {
		out_u("drive", s->subindex, "IDN of drive %u, ", s->subindex);
		out_u("idn", s->index, "0x%04x", s->index);
		return;
	}
	if (s->kind != ECT_WRITE_SDO) {
		out_u("register", s->index, "register 0x%04x", s->index);
		return;
	}
	out_u("index", s->index, "SDO 0x%04x", s->index);
	if (s->complete)
		out_text(" C");
	else
		out_u("subindex", s->subindex, ":%02x", s->subindex);
	out_bool("complete_access", s->complete, NULL);
}

/* One of its values; @there: it has this one. Return: what follows it */
static const u8 *value(const char *key, const char *label, bool there, const u8 *data, u32 bytes,
		       const char *in)
{
	char indent[16];

	if (!there) {
		out_null(key, NULL);
		return data;
	}
	snprintf(indent, sizeof(indent), "%s      ", in);
	out_text("%s    %s:\n", in, label);
	out_hex(key, data, min(bytes, (u32)SHOWN), indent);
	if (bytes > SHOWN)
		out_text("%s...\n", indent);
	return data + bytes;
}

static void step_command(const struct ect_step_command *s, const u8 *data, const char *in)
{
	out_object(NULL);
	head(s, in);
	out_u("size_bytes", s->bytes, ", %u byte", s->bytes);
	if (s->checks)
		out_u("timeout_ms", s->timeout_ms, ", time limit %u ms", s->timeout_ms);
	else
		out_null("timeout_ms", NULL);
	out_text("\n");
	data = value("write_hex", "writes", s->writes, data, s->bytes, in);
	data = value("expect_hex", "expects", s->checks, data, s->bytes, in);
	value("mask_hex", "mask", s->checks, data, s->bytes, in);
	out_end();
}

/* Only when there are any. Return: 0, or 1 after printing the error. */
int config_commands(struct dev *d, const struct ect_config *c, const char *in)
{
	u8 *data = malloc(3 * VALUE_MAX);
	unsigned int pos;
	int err = 0;

	if (!data)
		return config_failed(d, -ENOMEM, c);
	for (pos = 0; !err; pos++) {
		struct ect_step_command s = { .struct_size = sizeof(s) };

		err = ect_config_command(d->h, c->index, pos, &s, data, 3 * VALUE_MAX);
		/* an older module does not show them */
		if (err == -ENOTTY)
			break;
		if (!pos)
			out_array("commands");
		if (!pos && !err)
			out_text("%sCommands for transitions:\n", in);
		if (!err && s.bytes <= VALUE_MAX)
			step_command(&s, data, in);
	}
	free(data);
	if (err == -ENOTTY) {
		out_null("commands", NULL);
		return 0;
	}
	if (err != -ENOENT)
		return config_failed(d, err, c);
	out_end();
	return 0;
}
