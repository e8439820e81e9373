// SPDX-License-Identifier: GPL-2.0-only
#include "out.h"
#include "idn.h"
#include "sdo.h"

static int soe_read(const struct tool *t, struct dev *d, const struct soe_addr *a,
		    const struct ec_type *type)
{
	static u8 data[65536];
	struct ect_slave s;
	const u8 *from = data;
	long n;

	if (dev_select_single(d, t, &s))
		return 1;
	n = ect_soe_read(d->h, s.device, a->drive, a->idn, t->timeout_ms, data, sizeof(data));
	if (n < 0)
		return soe_failed(d, (int)n, &s, a, "read");
	out_u("master", d->master, NULL);
	out_u("position", s.position, NULL);
	soe_addr_out(a);
	/* a text is a list: length and largest length, then the characters */
	if (value_is_text(type) && n >= 4 && get_unaligned_le16(data) == n - 4) {
		from += 4;
		n -= 4;
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
	    io_type(t->type ? t->type : "raw", &type) || dev_open_single(&d, t, true))
		return 1;
	ret = soe_read(t, &d, &a, type);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_soe_read = {
	.name = "soe_read",
	.run = run,
	.args = "[DRIVE] IDN",
	.opts = "maptI",
	.summary = "Read an IDN of a servo drive (SoE)",
	.help = "DRIVE := { 0 to 7 }, default 0\n"
		"IDN := { S-SET-NUMBER | P-SET-NUMBER | 0 to 0xffff }     S-0-15, P-0-150, 0x8096\n"
		"Without --type the value is shown as hex bytes; a list includes its two lengths, a\n"
		"text does not.\n",
	.json = "master, position, drive, idn, name, type, size_bytes,\n"
		"value (not for bytes without a value form), data_hex",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 2,
};
