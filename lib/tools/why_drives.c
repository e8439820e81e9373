// SPDX-License-Identifier: LGPL-2.1-or-later
/* SERCOS drives in error: what their IDNs say. */
#include <stdio.h>

#include "../../master/wire/al.h"
#include "../../master/wire/sii.h"
#include "../../master/wire/soe.h"
#include "text.h"
#include "why.h"

#define REPLY_MS	300	/* for an IDN, which a drive has at once */
#define TEXT_MAX	200	/* bytes of a text that are shown */

/* of the class 1 diagnostic, by bit */
static const char *const kinds[16] = {
	"overload", "amplifier temperature", "motor temperature", "cooling", "control voltage",
	"feedback", "commutation", "overcurrent", "overvoltage", "undervoltage",
	"phase of the power supply", "position deviation", "communication", "end of travel",
	NULL, "manufacturer",
};

static const char *kinds_text(unsigned int bits, char *buf, size_t size)
{
	size_t n = 0;

	buf[0] = '\0';
	for (unsigned int i = 0; i < ARRAY_SIZE(kinds); i++)
		if (bits & 1u << i)
			n += (size_t)snprintf(buf + n, size - n, "%s%s", n ? ", " : "",
					      kinds[i] ? kinds[i] : "reserved");
	return buf;
}

/* Return: whether the value has this size */
static bool read_number(struct ect_handle *h, u64 device, unsigned int drive, u16 idn, void *data,
			long size)
{
	return ect_soe_read(h, device, drive, idn, REPLY_MS, data, (size_t)size) == size;
}

/* the text of the drive, with what precedes it; "" without one */
static const char *read_text(struct ect_handle *h, u64 device, unsigned int drive,
			     char buf[TEXT_MAX + 8])
{
	u8 data[1024];
	long n = ect_soe_read(h, device, drive, EC_SOE_IDN_ERROR_TEXT, REPLY_MS, data,
			      sizeof(data));

	buf[0] = '\0';
	if (n <= EC_SOE_LIST_HDR)
		return buf;
	n = min(n - EC_SOE_LIST_HDR, min((long)get_unaligned_le16(data), (long)TEXT_MAX));
	snprintf(buf, TEXT_MAX + 8, ": \"%.*s\"", (int)n, (const char *)data + EC_SOE_LIST_HDR);
	string_clean(buf, TEXT_MAX + 8);
	return buf;
}

static void drive_error(struct why *w, struct ect_handle *h, const struct ect_slave *s,
			unsigned int drive, unsigned int bits)
{
	char all[256], text[TEXT_MAX + 8], number[32] = "";
	struct ect_finding *f;
	u8 data[4];
	u32 code = bits;

	if (read_number(h, s->device, drive, EC_SOE_IDN_ERROR_NUMBER, data, sizeof(data))) {
		code = get_unaligned_le32(data);
		snprintf(number, sizeof(number), ", number 0x%08x", code);
	}
	f = why_add(w, DRIVE_ERROR, drive, bits, kinds_text(bits, all, sizeof(all)), number,
		    read_text(h, s->device, drive, text));
	why_remedy(f, DRIVE_ERROR, s->position, drive);
	f->evidence_count = 2;
	f->evidence[0] = drive;
	f->evidence[1] = bits;
	f->slave = s->position;
	f->code = code;
}

/* All drives of a slave: the first one that does not reply is none. */
static void read_drives(struct why *w, struct ect_handle *h, const struct ect_slave *s)
{
	u8 data[2];

	for (unsigned int drive = 0; drive < EC_SOE_DRIVES; drive++) {
		if (!read_number(h, s->device, drive, EC_SOE_IDN_ERROR, data, sizeof(data)))
			return;
		if (get_unaligned_le16(data))
			drive_error(w, h, s, drive, get_unaligned_le16(data));
	}
}

static bool has_drives(const struct ect_slave *s)
{
	unsigned int state = s->al_status & EC_AL_STATE_MASK;

	return s->mbox_protocols & EC_SII_PROTO_SOE && state >= EC_AL_PREOP && state != EC_AL_BOOT;
}

/**
 * why_drives() - drives (SoE) whose class 1 diagnostic is not 0
 * @w: what is known
 *
 * The drives are asked, so only if the user may write to the master; @unasked says of how many
 * slaves they were not.
 */
void why_drives(struct why *w)
{
	struct ect_handle *h = NULL;

	for (size_t i = 0; i < w->bus->n; i++) {
		const struct ect_slave *s = why_slave(w, i);

		if (!has_drives(s))
			continue;
		if (!h && !w->quiet && !w->unasked)
			h = why_open(w);
		if (h)
			read_drives(w, h, s);
		else
			w->unasked++;
	}
	ect_free(h);
}
