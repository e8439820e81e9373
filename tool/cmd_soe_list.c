// SPDX-License-Identifier: GPL-2.0-only
/* The IDNs of a drive, as lists of the drive name them. */
#include "../master/wire/soe.h"
#include "out.h"
#include "idn.h"
#include "sdo.h"

#define ALL		17	/* list of all operation data */
#define SHOWN		16	/* bytes of a value */

struct listing {
	const struct tool *t;
	struct dev *d;
	struct ect_slave s;
	u8 data[SOE_MAX];
};

/* Bytes of an element; 0: the drive does not have it; negative: it failed, and why is printed. */
static long element(struct listing *l, struct soe_addr *a, u8 which)
{
	long n;

	a->element = which;
	n = soe_get(l->t, l->d, &l->s, a, l->data);
	if (n < 0 && !ect_error_code(l->d->h)) {
		soe_failed(l->d, (int)n, &l->s, a, "read");
		return -1;
	}
	return n < 0 ? 0 : n;
}

/* A text element, with control characters replaced; -1 after an error. */
static int text(struct listing *l, struct soe_addr *a, u8 which, char *buf, size_t size)
{
	long n = element(l, a, which);
	size_t len = 0;

	if (n < 0)
		return -1;
	if (soe_list_is_valid(l->data, (size_t)n)) {
		len = min((size_t)n - EC_SOE_LIST_HDR, size - 1);
		memcpy(buf, l->data + EC_SOE_LIST_HDR, len);
	}
	for (size_t i = 0; i < len; i++)
		if ((u8)buf[i] < 0x20 || (u8)buf[i] == 0x7f || ((u8)buf[i] & 0xe0) == 0x80)
			buf[i] = '?';
	buf[len] = 0;
	return 0;
}

/* --verbose: an element in hexadecimal, as drives send it; -1 after an error. */
static int bytes(struct listing *l, struct soe_addr *a, u8 which, const char *key,
		 const char *label)
{
	long n = element(l, a, which);

	if (n <= 0)
		return (int)n;
	out_text("    %s", label);
	for (long i = 0; i < n && i < SHOWN; i++)
		out_text(" %02x", l->data[i]);
	out_text("%s\n", n > SHOWN ? "..." : "");
	if (out_is_json())
		out_hex(key, l->data, (size_t)n, "");
	return 0;
}

static int details(struct listing *l, struct soe_addr *a, u32 attribute)
{
	char unit[64];

	if (text(l, a, ECT_SOE_UNIT, unit, sizeof(unit)))
		return -1;
	out_str("unit", unit, NULL);
	if (*unit)
		out_text("    unit    %s\n", unit);
	return bytes(l, a, ECT_SOE_MIN, "minimum_hex", "minimum") ||
	       bytes(l, a, ECT_SOE_MAX, "maximum_hex", "maximum") ||
	       bytes(l, a, ECT_SOE_DEFAULT, "default_hex", "default") ||
	       (attribute & EC_SOE_ATTR_COMMAND ?
		bytes(l, a, ECT_SOE_STATE, "state_hex", "state  ") :
		bytes(l, a, ECT_SOE_VALUE, "value_hex", "value  ")) ? -1 : 0;
}

static int idn(struct listing *l, u8 drive, u16 number)
{
	char name[128], length[16] = "?", access[8] = "?";
	struct soe_addr a;
	u32 attribute = 0;
	long n;

	soe_addr_set(&a, drive, number);
	n = element(l, &a, ECT_SOE_ATTRIBUTE);
	if (n == 4) {
		attribute = get_unaligned_le32(l->data);
		soe_length_text(attribute, length);
		soe_access_text(attribute, access);
	}
	if (n < 0 || text(l, &a, ECT_SOE_NAME, name, sizeof(name)))
		return 1;
	out_object(NULL);
	out_u("idn", number, NULL);
	out_str("name", a.text, "%s", a.text);
	out_u("attribute", attribute, NULL);
	out_str("length", length, "  %-9s", length);
	out_str("writable", access, "  %-3s", access);
	out_str("text", name, "  %s\n", name);
	n = l->t->verbosity > 0 ? details(l, &a, attribute) : 0;
	out_end();
	return n < 0;
}

static int list(struct listing *l, struct soe_addr *a)
{
	u16 numbers[SOE_MAX / 2];
	size_t n;
	long got = soe_get(l->t, l->d, &l->s, a, l->data);
	int ret = 0;

	if (got < 0)
		return soe_failed(l->d, (int)got, &l->s, a, "read");
	if (!soe_list_is_valid(l->data, (size_t)got) || got & 1)
		return fail("Master%u slave %u: %s of drive %u is no list of IDNs: %ld bytes, length %u",
			    l->d->master, l->s.position, a->text, a->drive, got,
			    got >= 2 ? get_unaligned_le16(l->data) : 0);
	n = ((size_t)got - EC_SOE_LIST_HDR) / 2;
	for (size_t i = 0; i < n; i++)
		numbers[i] = get_unaligned_le16(l->data + EC_SOE_LIST_HDR + 2 * i);
	out_u("master", l->d->master, NULL);
	out_u("position", l->s.position, NULL);
	soe_addr_out(a);
	out_array("idns");
	for (size_t i = 0; i < n && !ret; i++)
		ret = idn(l, a->drive, numbers[i]);
	out_end();
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	static struct listing l;
	bool named = argc && soe_is_name(argv[argc - 1]);
	struct soe_addr a;
	struct dev d;
	int ret;

	if (argc > 1 && !named)
		return usage_error("invalid list '%s': expected S-SET-NUMBER or P-SET-NUMBER",
				   argv[1]);
	if (sdo_timeout_check(t) ||
	    soe_addr_parse(&a, argc > named ? argv[0] : NULL, named ? argv[argc - 1] : "S-0-17") ||
	    dev_open_single(&d, t, true))
		return 1;
	l.t = t;
	l.d = &d;
	ret = dev_select_single(&d, t, &l.s) || list(&l, &a);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_soe_list = {
	.name = "soe_list",
	.run = run,
	.args = "[DRIVE] [LIST]",
	.opts = "mapIv",
	.summary = "List the IDNs of a servo drive with their names (SoE)",
	.help = "DRIVE := { 0 to 7 }, default 0\n"
		"LIST := { S-SET-NUMBER | P-SET-NUMBER }, an IDN with a list of IDNs, default S-0-0017: all\n"
		"operation data. Others are S-0-0025 (procedure commands), S-0-0187 (what the drive can\n"
		"send in its telegram), S-0-0188 (what it can receive), S-0-0016 and S-0-0024 (what the\n"
		"two telegrams have).\n"
		"Each line has the IDN, the length of its value, the states in which it can be written\n"
		"(P: PREOP, S: SAFEOP, O: OP) and its name. --verbose shows unit, minimum, maximum,\n"
		"default and value as well, of numbers the bytes, the lowest first; of a procedure command\n"
		"its data state.\n",
	.json = "master, position, drive, idn, name, idns[]: idn, name, attribute, length, writable,\n"
		"text (name of the drive); with --verbose unit, minimum_hex, maximum_hex, default_hex,\n"
		"value_hex or state_hex where the drive has them",
	.flags = CMD_ONE_MASTER,
	.min_args = 0,
	.max_args = 2,
};
