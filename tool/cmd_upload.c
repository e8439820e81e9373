// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>

#include "out.h"
#include "sdo.h"

/*
 * Not described by the slave: three objects are strings by their definition, the
 * rest is an unsigned number if its size is one's.
 */
static const struct ec_type *guess(const struct sdo_addr *a, size_t size)
{
	if (a->complete)
		return ec_type_by_code(EC_TYPE_OCTET_STRING);
	if (a->index >= 0x1008 && a->index <= 0x100a && !a->sub)
		return ec_type_by_code(EC_TYPE_STRING);
	switch (size) {
	case 1:
		return ec_type_by_code(EC_TYPE_UINT8);
	case 2:
		return ec_type_by_code(EC_TYPE_UINT16);
	case 4:
		return ec_type_by_code(EC_TYPE_UINT32);
	case 8:
		return ec_type_by_code(EC_TYPE_UINT64);
	default:
		return ec_type_by_code(EC_TYPE_RAW);
	}
}

/* NULL where the dictionary contradicts the data */
static const struct ec_type *described(struct dev *d, const struct ect_slave *s,
				       const struct sdo_addr *a, u32 timeout_ms, size_t size)
{
	u32 abort;
	const struct ec_type *type = sdo_described_type(d, s, a, timeout_ms, &abort);

	return type && (!value_bytes(type) || value_bytes(type) == size) ? type : NULL;
}

static int upload(const struct tool *t, struct dev *d, const struct sdo_addr *a,
		  const struct ec_type *type)
{
	struct ect_slave s;
	size_t size;
	u8 *data;
	int ret;

	if (dev_select_single(d, t, &s) ||
	    sdo_upload(d, &s, a, t->timeout_ms, &data, &size))
		return 1;
	out_u("master", d->master, NULL);
	out_u("position", s.position, NULL);
	sdo_addr_out(a);
	if (!type)
		type = described(d, &s, a, t->timeout_ms, size);
	out_bool("type_guessed", !type, NULL);
	if (!type)
		type = guess(a, size);
	ret = io_print(type, data, size);
	free(data);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct ec_type *type = NULL;
	struct sdo_addr a;
	struct dev d;
	int ret;

	if (sdo_addr_parse(&a, argv[0], argc > 1 ? argv[1] : NULL) ||
	    (t->type && io_type(t->type, &type)) || sdo_timeout_check(t) ||
	    dev_open_single(&d, t, true))
		return 1;
	ret = upload(t, &d, &a, type);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_upload = {
	.name = "upload",
	.run = run,
	.args = "INDEX [SUBINDEX]",
	.opts = "maptI",
	.summary = "Read an SDO from a slave",
	.help = "INDEX := { 0 to 0xffff | INDEX:HH }     HH: subindex, two hex digits\n"
		"SUBINDEX := { 0 to 0xff }\n"
		"Without a subindex the whole object is read (complete access), by default as\n"
		"octet_string. With a subindex and without --type the type is that of the slave's\n"
		"dictionary, which costs one more transfer. If the slave describes no objects, 0x1008\n"
		"to 0x100a are strings; other data of 1, 2, 4 or 8 bytes are shown as unsigned numbers\n"
		"and the rest as hex bytes. --timeout is the time limit of each reply, at most 60 s,\n"
		"by default 5 s or that of the application.\n",
	.json = "master, position, index, subindex, complete_access, type_guessed (not from the\n"
		"dictionary or --type), type, size_bytes,\n"
		"value (not for bytes without a value form), data_hex",
	.flags = CMD_HISTORIC | CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 2,
};
