/* SPDX-License-Identifier: GPL-2.0-only */
/* Texts of diagnosis messages, from the device description (ESI) of a slave. */
#ifndef EC_TOOL_ESI_TEXTS_H
#define EC_TOOL_ESI_TEXTS_H

#include "tool.h"

struct esi_text {
	u16 id;
	char *text;		/* for a terminal */
};

struct esi_texts {
	struct esi_text *v;
	size_t n;
};

int esi_texts_load(const char *path, struct esi_texts *t);
void esi_texts_free(struct esi_texts *t);
/* NULL: there is none */
const char *esi_text(const struct esi_texts *t, u16 id);

#endif
