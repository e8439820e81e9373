// SPDX-License-Identifier: GPL-2.0-only
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

/* What does not fit is left out as a whole: a part of an entry would be another entry. */
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

static void wanted(struct why *w, const struct why_config *c, unsigned int sm, struct line *l)
{
	struct ec_ioc_config_sm s = { .index = c->c.index, .sm = (__u8)sm };

	if (dev_ioctl(w->d, EC_IOC_CONFIG_SM, &s))
		return;
	put(l, "%s", s.pdo_count ? "" : " none");
	for (u32 p = 0; p < s.pdo_count && !l->full; p++) {
		struct ec_ioc_config_pdo pdo = {
			.index = c->c.index, .sm = (__u8)sm, .pdo_pos = p,
		};

		if (dev_ioctl(w->d, EC_IOC_CONFIG_PDO, &pdo))
			return;
		put(l, " 0x%04x", pdo.pdo_index);
		for (u32 e = 0; e < pdo.entry_count && !l->full; e++) {
			struct ec_ioc_config_entry entry = {
				.index = c->c.index, .sm = (__u8)sm, .pdo_pos = p, .entry_pos = e,
			};

			if (dev_ioctl(w->d, EC_IOC_CONFIG_ENTRY, &entry))
				return;
			put(l, "%c%04x:%02x/%u", e ? ' ' : '(', entry.entry_index, entry.subindex,
			    entry.bits);
		}
		put(l, "%s", pdo.entry_count ? ")" : "");
	}
}

static void offered(struct why *w, const struct why_config *c, unsigned int sm, struct line *l)
{
	const struct ec_ioc_address slave = {
		.kind = EC_ADDRESS_DEVICE, .device = c->c.device,
	};
	struct ec_ioc_sm s = { .slave = slave, .sm = (__u8)sm };

	if (dev_ioctl(w->d, EC_IOC_SM, &s))
		return;
	put(l, "%s", s.pdo_count ? "" : " none");
	for (u16 p = 0; p < s.pdo_count && !l->full; p++) {
		struct ec_ioc_pdo pdo = { .slave = slave, .sm = (__u8)sm, .pdo_pos = p };

		if (dev_ioctl(w->d, EC_IOC_PDO, &pdo))
			return;
		put(l, " 0x%04x", pdo.index);
		for (u16 e = 0; e < pdo.entry_count && !l->full; e++) {
			struct ec_ioc_pdo_entry entry = {
				.slave = slave, .sm = (__u8)sm, .pdo_pos = p, .entry_pos = e,
			};

			if (dev_ioctl(w->d, EC_IOC_PDO_ENTRY, &entry))
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
void why_pdo_lists(struct why *w, const struct why_config *c, unsigned int sm, char *buf,
		   size_t size)
{
	struct line want = { .buf = buf, .size = size / 2 }, have;

	put(&want, "SM%u configured:", sm);
	wanted(w, c, sm, &want);
	have = (struct line){ .buf = buf + want.len, .size = size - want.len };
	put(&have, "; SM%u of the slave:", sm);
	offered(w, c, sm, &have);
}
