// SPDX-License-Identifier: GPL-2.0-only
#include "../master/wire/soe.h"
#include "out.h"
#include "idn.h"
#include "sdo.h"

/* What a number says that is not the value of the IDN; 1: it has another size. */
static int print_number(const struct soe_addr *a, const u8 *data, size_t size)
{
	bool state = a->element == ECT_SOE_STATE;
	char length[16], access[8];
	u32 v;

	if (size != (state ? 2 : 4))
		return fail("invalid %s of %s: %zu bytes, expected %u",
			    state ? "data state" : "attribute", a->text, size, state ? 2 : 4);
	v = state ? get_unaligned_le16(data) : get_unaligned_le32(data);
	if (state) {
		out_u("value", v, "0x%04x", v);
		out_str("text", ec_soe_command_text((u16)v), "  as a procedure command: %s\n",
			ec_soe_command_text((u16)v));
		return 0;
	}
	soe_length_text(v, length);
	soe_access_text(v, access);
	out_u("value", v, "0x%08x", v);
	out_str("length", length, "  %s", length);
	out_str("writable", access, ", writable %s", access);
	out_u("format", v >> 20 & 7, ", format %u", v >> 20 & 7);
	out_u("decimal_places", v >> 24 & 15, ", %u decimal places", v >> 24 & 15);
	out_u("factor", v & 0xffff, ", factor %u\n", v & 0xffff);
	return 0;
}

static int soe_read(const struct tool *t, struct dev *d, const struct soe_addr *a,
		    const struct ec_type *type)
{
	static u8 data[SOE_MAX];
	struct ect_slave s;
	const u8 *from = data;
	bool number = a->element == ECT_SOE_STATE || a->element == ECT_SOE_ATTRIBUTE;
	long n;

	if (dev_select_single(d, t, &s))
		return 1;
	n = soe_get(t, d, &s, a, data);
	if (n < 0)
		return soe_failed(d, (int)n, &s, a, "read");
	out_u("master", d->master, NULL);
	out_u("position", s.position, NULL);
	soe_addr_out(a);
	if (number && !t->type)
		return print_number(a, data, (size_t)n);
	/* a text is a list: length and largest length, then the characters */
	if (value_is_text(type) && soe_list_is_valid(data, (size_t)n)) {
		from += EC_SOE_LIST_HDR;
		n -= EC_SOE_LIST_HDR;
	}
	return io_print(type, from, (size_t)n);
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct ec_type *type;
	struct soe_addr a;
	struct dev d;
	int ret;

	if (sdo_timeout_check(t) || soe_addr_parse(&a, argc > 1 ? argv[0] : NULL, argv[argc - 1]) ||
	    soe_element_parse(&a, t->element) ||
	    io_type(t->type ? t->type : soe_element_is_text(a.element) ? "string" : "raw", &type) ||
	    dev_open_single(&d, t, true))
		return 1;
	ret = soe_read(t, &d, &a, type);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_soe_read = {
	.name = "soe_read",
	.run = run,
	.args = "[DRIVE] IDN",
	.opts = "maptMI",
	.summary = "Read an IDN of a servo drive (SoE)",
	.help = "DRIVE := { 0 to 7 }, default 0\n"
		"IDN := { S-SET-NUMBER | P-SET-NUMBER | 0 to 0xffff }     S-0-15, P-0-150, 0x8096\n"
		"Without --element the value is read. Without --type name and unit are shown as text,\n"
		"attribute and data state with their meaning, other elements as hex bytes; a list\n"
		"includes its two lengths, a text does not. 'writable PSO' are PREOP, SAFEOP and OP.\n",
	.json = "master, position, drive, idn, name, element (not for the value), type, size_bytes,\n"
		"value (not for bytes without a value form), data_hex; of a data state value, text; of an\n"
		"attribute value, length, writable, format, decimal_places, factor",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 2,
};
