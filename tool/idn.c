// SPDX-License-Identifier: GPL-2.0-only
#include "idn.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../master/wire/soe.h"
#include "out.h"

/* "S-0-15", "P-0-0150"; false: it is not written so */
static bool parse_name(const char *text, u16 *idn)
{
	char *end;
	unsigned long set, number;

	if (!strchr("SPsp", text[0]) || !text[0] || text[1] != '-' ||
	    text[2] < '0' || text[2] > '7' || text[3] != '-' ||
	    text[4] < '0' || text[4] > '9')
		return false;
	set = (unsigned long)(text[2] - '0');
	number = strtoul(text + 4, &end, 10);
	if (*end || number > 0xfff)
		return false;
	*idn = (u16)((strchr("Pp", text[0]) ? 0x8000 : 0) | set << 12 | number);
	return true;
}

/**
 * soe_addr_parse() - parse what names an IDN
 * @a: result
 * @drive: "0" to "7", or NULL for 0
 * @idn: "S-0-15", "P-0-150", or a number of 16 bits
 *
 * Return: 0, or 1 after printing what is wrong.
 */
int soe_addr_parse(struct soe_addr *a, const char *drive, const char *idn)
{
	u64 d = 0, v;

	if (drive && io_number("drive", drive, EC_SOE_DRIVES - 1, &d))
		return 1;
	a->drive = (u8)d;
	if (!parse_name(idn, &a->idn)) {
		if (idn[0] && idn[1] == '-')
			return usage_error("invalid IDN '%s': expected S-SET-NUMBER or P-SET-NUMBER, set 0 to 7, number 0 to 4095",
					   idn);
		if (io_number("IDN", idn, 0xffff, &v))
			return 1;
		a->idn = (u16)v;
	}
	snprintf(a->text, sizeof(a->text), "%c-%u-%04u", a->idn & 0x8000 ? 'P' : 'S',
		 a->idn >> 12 & 7, a->idn & 0xfff);
	return 0;
}

void soe_addr_out(const struct soe_addr *a)
{
	out_u("drive", a->drive, NULL);
	out_u("idn", a->idn, NULL);
	out_str("name", a->text, NULL);
}

/* Return: 1 */
int soe_failed(struct dev *d, int err, const struct ect_slave *s, const struct soe_addr *a,
	       const char *verb)
{
	u32 code = ect_error_code(d->h);
	const char *text = ec_soe_error_text((u16)code);

	if (code)
		return fail("Master%u slave %u: cannot %s %s of drive %u: 0x%04x: %s", d->master,
			    s->position, verb, a->text, a->drive, code,
			    text ? text : "unknown code");
	return dev_fail(d, err, "Master%u slave %u: cannot %s %s of drive %u", d->master,
			s->position, verb, a->text, a->drive);
}
