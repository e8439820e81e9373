// SPDX-License-Identifier: LGPL-2.1-or-later
/* The PDOs that are configured for a SyncManager, and those of the slave. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "why.h"

#define MORE	" ..."

/* a text that grows up to its buffer */
struct line {
	char *buf;
	size_t size;
	size_t len;
	bool full;
};

static void put(struct line *l, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* Append a text, or omit it if it does not fit: a part of an entry would be another entry. */
static void put(struct line *l, const char *fmt, ...)
{
	char part[64];
	va_list ap;
	int n;

	va_start(ap, fmt);
	n = vsnprintf(part, sizeof(part), fmt, ap);
	va_end(ap);
	if (l->full || n < 0)
		return;
	l->full = l->len + (size_t)n + sizeof(MORE) > l->size;
	l->len += (size_t)snprintf(l->buf + l->len, l->size - l->len, "%s", l->full ? MORE : part);
}

static void wanted(struct why *w, const struct ect_explained *c, unsigned int sm, struct line *l)
{
	struct ect_config_sm s = { .struct_size = sizeof(s) };

	if (ect_config_sm(w->h, c->config.index, sm, &s))
		return;
	put(l, "%s", s.pdo_count ? "" : " none");
	for (u32 p = 0; p < s.pdo_count && !l->full; p++) {
		struct ect_pdo pdo = { .struct_size = sizeof(pdo) };

		if (ect_config_pdo(w->h, c->config.index, sm, p, &pdo))
			return;
		put(l, " 0x%04x", pdo.index);
		for (u32 e = 0; e < pdo.entry_count && !l->full; e++) {
			struct ect_pdo_entry entry = { .struct_size = sizeof(entry) };

			if (ect_config_entry(w->h, c->config.index, sm, p, e, &entry))
				return;
			put(l, "%c%04x:%02x/%u", e ? ' ' : '(', entry.index, entry.subindex,
			    entry.bits);
		}
		put(l, "%s", pdo.entry_count ? ")" : "");
	}
}

static void offered(struct why *w, u64 device, unsigned int sm, struct line *l)
{
	struct ect_sm s = { .struct_size = sizeof(s) };

	if (ect_sm_read(w->h, device, sm, &s))
		return;
	put(l, "%s", s.pdo_count ? "" : " none");
	for (u16 p = 0; p < s.pdo_count && !l->full; p++) {
		struct ect_pdo pdo = { .struct_size = sizeof(pdo) };

		if (ect_pdo_read(w->h, device, sm, p, &pdo))
			return;
		put(l, " 0x%04x", pdo.index);
		for (u16 e = 0; e < pdo.entry_count && !l->full; e++) {
			struct ect_pdo_entry entry = { .struct_size = sizeof(entry) };

			if (ect_pdo_entry_read(w->h, device, sm, p, e, &entry))
				return;
			put(l, "%c%04x:%02x/%u", e ? ' ' : '(', entry.index, entry.subindex,
			    entry.bits);
		}
		put(l, "%s", pdo.entry_count ? ")" : "");
	}
}

/**
 * why_pdo_lists() - both lists of PDOs of a SyncManager in words
 * @w: what is known
 * @c: configuration with a slave
 * @sm: SyncManager
 * @buf: result; each list has half of it, and ends with "..." if it does not fit
 * @size: of @buf
 */
void why_pdo_lists(struct why *w, const struct ect_explained *c, unsigned int sm, char *buf,
		   size_t size)
{
	struct line want = { .buf = buf, .size = size / 2 }, have;

	put(&want, "SM%u configured:", sm);
	wanted(w, c, sm, &want);
	have = (struct line){ .buf = buf + want.len, .size = size - want.len };
	put(&have, "; SM%u of the slave:", sm);
	if ((size_t)c->config.slave_position < w->bus->n)
		offered(w, why_slave(w, (size_t)c->config.slave_position)->device, sm, &have);
}
