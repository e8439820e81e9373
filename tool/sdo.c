// SPDX-License-Identifier: GPL-2.0-only
#include "sdo.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../master/wire/sii.h"
#include "out.h"

#define DESCRIBE_MS	1000	/* for a type that can be given as well */
#define MOST_MS	60000u

/**
 * sdo_addr_parse() - parse what names an SDO
 * @a: result
 * @index: "0x1018", or "0x1018:01" with the subindex in hex, as listings print it
 * @sub: subindex or NULL; without any it is complete access
 *
 * Return: 0, or 1 after printing what is wrong.
 */
int sdo_addr_parse(struct sdo_addr *a, const char *index, const char *sub)
{
	const char *colon = strchr(index, ':');
	char head[32], *end;
	u64 v, s = 0;

	if (colon && sub)
		return usage_error("'%s' has a subindex already", index);
	snprintf(head, sizeof(head), "%.*s", colon ? (int)(colon - index) : 31, index);
	if (io_number("index", colon ? head : index, 0xffff, &v))
		return 1;
	if (sub && io_number("subindex", sub, 0xff, &s))
		return 1;
	if (colon) {
		s = strtoul(colon + 1, &end, 16);
		if (!colon[1] || strspn(colon + 1, "0123456789abcdefABCDEF") > 2 || *end ||
		    end > colon + 3)
			return usage_error("invalid subindex '%s': expected two hex digits behind ':'",
					   colon + 1);
	}
	*a = (struct sdo_addr){ .index = (u16)v, .sub = (u8)s, .complete = !sub && !colon };
	if (strspn(index, "0123456789") == 4 && *index != '0')
		snprintf(a->meant, sizeof(a->meant), "0x%.4s", index);
	snprintf(a->text, sizeof(a->text), a->complete ? "0x%04x" : "0x%04x:%02x", a->index,
		 a->sub);
	return 0;
}

void sdo_addr_out(const struct sdo_addr *a)
{
	out_u("index", a->index, NULL);
	if (!a->complete)
		out_u("subindex", a->sub, NULL);
	out_bool("complete_access", a->complete, NULL);
}

int sdo_timeout_check(const struct tool *t)
{
	if (t->timeout_ms > MOST_MS)
		return usage_error("--timeout of a mailbox reply is at most %u seconds",
				   MOST_MS / 1000);
	return 0;
}

static int failed(struct dev *d, int err, const struct ect_slave *s, const struct sdo_addr *a,
		  const char *verb)
{
	u32 abort = ect_error_code(d->h);
	char hint[48] = "";

	if (abort == SDO_NO_OBJECT && *a->meant)
		snprintf(hint, sizeof(hint), ", in decimal %u (did you mean %s?)", a->index,
			 a->meant);
	if (abort)
		return fail_full(-err, NULL, abort, "Master%u slave %u: SDO %s %s%s", d->master,
				 s->position, verb, a->text, hint);
	return dev_fail(d, err, "Master%u slave %u: SDO %s %s", d->master, s->position, verb,
			a->text);
}

/**
 * sdo_described_type() - read the data type of an entry from the dictionary of its slave
 * @d: master, open for writing
 * @s: slave
 * @a: entry
 * @timeout_ms: of each reply, 0: default
 * @abort: set to the abort code of the slave, 0: there is none
 *
 * A slave whose EEPROM announces no SDO information gets no request: it might not answer.
 *
 * Return: type, or NULL without an error message: complete access, or the slave or this command
 * has no type for it.
 */
const struct ec_type *sdo_described_type(struct dev *d, const struct ect_slave *s,
					 const struct sdo_addr *a, u32 timeout_ms, u32 *abort)
{
	struct ect_entry e = { .struct_size = sizeof(e) };

	*abort = 0;
	if (a->complete || !(s->mbox_protocols & EC_SII_PROTO_COE) ||
	    !(s->coe_details & EC_SII_COE_SDO_INFO))
		return NULL;
	if (!ect_entry_read(d->h, s->device, a->index, a->sub, 0, timeout_ms ?: DESCRIBE_MS, &e))
		return ec_type_by_code(e.type);
	*abort = ect_error_code(d->h);
	return NULL;
}

/* @data is to be freed */
int sdo_upload(struct dev *d, const struct ect_slave *s, const struct sdo_addr *a, u32 timeout_ms,
	       u8 **data, size_t *size)
{
	u8 *buf = malloc(ECT_SDO_MAX);
	long n;

	if (!buf)
		return fail("out of memory");
	n = ect_sdo_upload(d->h, s->device, a->index, a->sub, a->complete ? ECT_SDO_COMPLETE : 0,
			   timeout_ms, buf, ECT_SDO_MAX);
	if (n < 0) {
		free(buf);
		return failed(d, (int)n, s, a, "upload");
	}
	*data = buf;
	*size = (size_t)n;
	return 0;
}

int sdo_download(struct dev *d, const struct ect_slave *s, const struct sdo_addr *a,
		 u32 timeout_ms, const u8 *data, size_t size)
{
	int err = ect_sdo_download(d->h, s->device, a->index, a->sub,
				   a->complete ? ECT_SDO_COMPLETE : 0, timeout_ms, data, size);

	return err ? failed(d, err, s, a, "download") : 0;
}
