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

bool soe_is_name(const char *idn)
{
	u16 v;

	return parse_name(idn, &v) || (idn[0] && idn[1] == '-');
}

/* the value of an IDN */
void soe_addr_set(struct soe_addr *a, u8 drive, u16 idn)
{
	a->drive = drive;
	a->idn = idn;
	a->element = ECT_SOE_VALUE;
	snprintf(a->text, sizeof(a->text), "%c-%u-%04u", idn & 0x8000 ? 'P' : 'S', idn >> 12 & 7,
		 idn & 0xfff);
}

/**
 * soe_addr_parse() - parse what names an IDN
 * @a: result, its value
 * @drive: "0" to "7", or NULL for 0
 * @idn: "S-0-15", "P-0-150", or a number of 16 bits
 *
 * Return: 0, or 1 after printing what is wrong.
 */
int soe_addr_parse(struct soe_addr *a, const char *drive, const char *idn)
{
	u64 d = 0, v;
	u16 number;

	if (drive && io_number("drive", drive, EC_SOE_DRIVES - 1, &d))
		return 1;
	if (!parse_name(idn, &number)) {
		if (idn[0] && idn[1] == '-')
			return usage_error("invalid IDN '%s': expected S-SET-NUMBER or P-SET-NUMBER, set 0 to 7, number 0 to 4095",
					   idn);
		if (io_number("IDN", idn, 0xffff, &v))
			return 1;
		number = (u16)v;
	}
	soe_addr_set(a, (u8)d, number);
	return 0;
}

static const struct {
	const char *name;
	const char *phrase;
} elements[8] = {
	{ "state", "the data state of " }, { "name", "the name of " },
	{ "attribute", "the attribute of " }, { "unit", "the unit of " },
	{ "minimum", "the minimum of " }, { "maximum", "the maximum of " },
	{ "value", "" }, { "default", "the default value of " },
};

/**
 * soe_element_parse() - parse the name of an element
 * @a: result
 * @name: as --element has it, NULL: the value
 *
 * Return: 0, or 1 after printing what is wrong.
 */
int soe_element_parse(struct soe_addr *a, const char *name)
{
	for (u32 i = 0; i < ARRAY_SIZE(elements); i++) {
		if (name && strcmp(name, elements[i].name))
			continue;
		a->element = name ? (u8)(1u << i) : ECT_SOE_VALUE;
		return 0;
	}
	return usage_error("invalid element '%s': expected state, name, attribute, unit, minimum, maximum, value or default",
			   name);
}

bool soe_element_is_text(u8 element)
{
	return element == ECT_SOE_NAME || element == ECT_SOE_UNIT;
}

static u32 element_index(const struct soe_addr *a)
{
	u32 i = 0;

	while (i < ARRAY_SIZE(elements) - 1 && !(a->element & 1u << i))
		i++;
	return i;
}

void soe_addr_out(const struct soe_addr *a)
{
	out_u("drive", a->drive, NULL);
	out_u("idn", a->idn, NULL);
	out_str("name", a->text, NULL);
	if (a->element != ECT_SOE_VALUE)
		out_str("element", elements[element_index(a)].name, NULL);
}

/* Return: 1 */
int soe_failed(struct dev *d, int err, const struct ect_slave *s, const struct soe_addr *a,
	       const char *verb)
{
	const char *phrase = elements[element_index(a)].phrase;
	u32 code = ect_error_code(d->h);
	const char *text = ec_soe_error_text((u16)code);

	if (code)
		return fail("Master%u slave %u: cannot %s %s%s of drive %u: 0x%04x: %s", d->master,
			    s->position, verb, phrase, a->text, a->drive, code,
			    text ? text : "unknown code");
	return dev_fail(d, err, "Master%u slave %u: cannot %s %s%s of drive %u", d->master,
			s->position, verb, phrase, a->text, a->drive);
}

/* @data: SOE_MAX bytes. Return: bytes, or a negative errno */
long soe_get(const struct tool *t, struct dev *d, const struct ect_slave *s,
	     const struct soe_addr *a, u8 *data)
{
	if (a->element == ECT_SOE_VALUE)
		return ect_soe_read(d->h, s->device, a->drive, a->idn, t->timeout_ms, data,
				    SOE_MAX);
	return ect_soe_read_element(d->h, s->device, a->drive, a->idn, a->element, t->timeout_ms,
				    data, SOE_MAX);
}

/* Return: 0, or a negative errno */
int soe_put(const struct tool *t, struct dev *d, const struct ect_slave *s,
	    const struct soe_addr *a, const u8 *data, size_t size)
{
	if (a->element == ECT_SOE_VALUE)
		return ect_soe_write(d->h, s->device, a->drive, a->idn, t->timeout_ms, data, size);
	return ect_soe_write_element(d->h, s->device, a->drive, a->idn, a->element, t->timeout_ms,
				     data, size);
}

/* A list, or a text: length and largest length, then as many bytes. */
bool soe_list_is_valid(const u8 *data, size_t size)
{
	return size >= EC_SOE_LIST_HDR && get_unaligned_le16(data) == size - EC_SOE_LIST_HDR;
}

/* "4 bytes", "list of 2" */
void soe_length_text(u32 attribute, char buf[16])
{
	u32 bytes = 1u << ((attribute & EC_SOE_ATTR_LEN) >> 16 & 3);

	if (attribute & EC_SOE_ATTR_COMMAND)
		snprintf(buf, 16, "command");
	else if (attribute & EC_SOE_ATTR_LIST)
		snprintf(buf, 16, "list of %u", bytes);
	else
		snprintf(buf, 16, "%u bytes", bytes);
}

/* the states in which it can be written: "PSO" for PREOP, SAFEOP and OP */
void soe_access_text(u32 attribute, char buf[8])
{
	snprintf(buf, 8, "%c%c%c", attribute & EC_SOE_ATTR_PREOP ? '-' : 'P',
		 attribute & EC_SOE_ATTR_SAFEOP ? '-' : 'S',
		 attribute & EC_SOE_ATTR_OP ? '-' : 'O');
}
