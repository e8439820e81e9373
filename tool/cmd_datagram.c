// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "io.h"
#include "out.h"
#include "dev.h"

/* what follows the name of a command */
#define ONE	1	/* the slave, before the register */
#define RING	2	/* it is a ring position */
#define WRITES	4	/* data to send */
#define READS	8	/* the data that return are a result */
#define LOGICAL	16	/* 32 bits instead of a register */

/* by their numbers in ETG.1000.4 */
static const struct {
	const char *name;
	unsigned int flags;
} commands[] = {
	{ "NOP", LOGICAL | READS },
	{ "APRD", ONE | RING | READS }, { "APWR", ONE | RING | WRITES },
	{ "APRW", ONE | RING | READS | WRITES },
	{ "FPRD", ONE | READS }, { "FPWR", ONE | WRITES }, { "FPRW", ONE | READS | WRITES },
	{ "BRD", READS }, { "BWR", WRITES }, { "BRW", READS | WRITES },
	{ "LRD", LOGICAL | READS }, { "LWR", LOGICAL | WRITES },
	{ "LRW", LOGICAL | READS | WRITES },
	{ "ARMW", ONE | RING | READS | WRITES }, { "FRMW", ONE | READS | WRITES },
};

struct datagram {
	u8 command;
	unsigned int flags;
	u32 address;
	const struct ec_type *type;	/* NULL: raw bytes, to write from a file */
	u8 *data;
	size_t size;
};

static int find_command(const char *text, struct datagram *d)
{
	for (d->command = 0; d->command < ARRAY_SIZE(commands); d->command++)
		if (!strcasecmp(text, commands[d->command].name)) {
			d->flags = commands[d->command].flags;
			return 0;
		}
	return usage_error("unknown command '%s': expected NOP, APRD, APWR, APRW, FPRD, FPWR, FPRW, BRD, BWR, BRW, LRD, LWR, LRW, ARMW or FRMW",
			   text);
}

static int get_address(char ***arg, int *n, struct datagram *d)
{
	u64 slave = 0, address;

	if (*n < (d->flags & ONE ? 2 : 1))
		return usage_error("missing argument: %s needs %s",
				   commands[d->command].name,
				   d->flags & RING ? "the ring position and the register" :
				   d->flags & ONE ? "the station address and the register" :
				   "an address");
	if (d->flags & ONE) {
		if (io_number(d->flags & RING ? "ring position" : "station address", **arg, 0xffff,
			      &slave))
			return 1;
		(*arg)++;
		(*n)--;
	}
	if (io_number("address", **arg, d->flags & LOGICAL ? 0xffffffff : 0xffff, &address))
		return 1;
	(*arg)++;
	(*n)--;
	/* each slave adds 1 to the position; that which gets 0 executes the command */
	if (d->flags & RING)
		slave = -slave & 0xffff;
	d->address = d->flags & LOGICAL ? (u32)address : (u32)(slave | address << 16);
	return 0;
}

static int get_value(const char *text, struct datagram *d)
{
	return d->type ? io_value(d->type, text, &d->data, &d->size) :
			 io_read(text, &d->data, &d->size);
}

/* @size as typed, or NULL; what a value lacks are zeros */
static int get_size(const char *size, struct datagram *d)
{
	size_t fixed = d->type ? value_bytes(d->type) : 0;
	u64 wanted = d->data ? d->size : fixed;
	u8 *more;

	if (size && io_number("size", size, ECT_DATAGRAM_MAX, &wanted))
		return 1;
	if (!size && !wanted)
		return usage_error("missing argument: SIZE in bytes, or a --type that fixes it");
	if (!wanted || wanted > ECT_DATAGRAM_MAX)
		return usage_error("invalid size %llu: a datagram has 1 to %u bytes",
				   (unsigned long long)wanted, ECT_DATAGRAM_MAX);
	if (fixed && wanted != fixed)
		return usage_error("type %s has %zu byte(s), not %llu", d->type->name, fixed,
				   (unsigned long long)wanted);
	if (wanted < d->size)
		return usage_error("the value has %zu byte(s), not %llu", d->size,
				   (unsigned long long)wanted);
	more = realloc(d->data, wanted);
	if (!more)
		return fail("out of memory");
	memset(more + d->size, 0, wanted - d->size);
	d->data = more;
	d->size = wanted;
	return 0;
}

static int show(const struct dev *dev, const struct datagram *d, uint16_t wkc)
{
	const struct ec_type *type = d->type ? d->type : ec_type_by_code(EC_TYPE_RAW);
	bool bare = d->flags & READS && value_is_text(type);

	out_u("master", dev->master, NULL);
	out_str("command", commands[d->command].name, NULL);
	out_u("address", d->address, NULL);
	/* stdout has nothing but the bytes of a text */
	if (bare && !out_is_json())
		note("Working counter: %u", wkc);
	else
		out_u("working_counter", wkc, "Working counter: %u\n", wkc);
	if (d->flags & READS)
		return io_print(type, d->data, d->size);
	out_u("size_bytes", d->size, NULL);
	return 0;
}

static int transfer(const struct tool *t, struct datagram *d)
{
	uint16_t wkc = 0;
	struct dev dev;
	int ret;

	if (dev_open_single(&dev, t, true))
		return 1;
	ret = ect_datagram(dev.h, d->command, d->address, d->data, d->size, &wkc);
	if (ret)
		ret = dev_fail(&dev, ret, "Master%u: cannot send %s", dev.master,
			       commands[d->command].name);
	else
		ret = show(&dev, d, wkc);
	dev_close(&dev);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct datagram d = { 0 };
	char **arg = argv + 1;
	int n = argc - 1, ret;

	if (find_command(argv[0], &d) || (t->type && io_type(t->type, &d.type)) ||
	    get_address(&arg, &n, &d))
		return 1;
	if (d.flags & WRITES) {
		if (!n)
			return usage_error("missing argument: DATA, which %s sends", argv[0]);
		if (get_value(*arg, &d))
			return 1;
		arg++;
		n--;
	}
	if (n > 1)
		ret = usage_error("unexpected argument '%s'", arg[1]);
	else
		ret = get_size(n ? *arg : NULL, &d) || transfer(t, &d);
	free(d.data);
	return ret;
}

const struct cmd cmd_datagram = {
	.name = "datagram",
	.run = run,
	.args = "COMMAND [SLAVE] ADDRESS [DATA] [SIZE]",
	.opts = "mt",
	.summary = "Send one datagram of any EtherCAT command",
	.help = "COMMAND := { APRD | APWR | APRW | ARMW | FPRD | FPWR | FPRW | FRMW |\n"
		"  BRD | BWR | BRW | LRD | LWR | LRW | NOP }\n"
		"SLAVE := { AP..., ARMW: ring position | FP..., FRMW: station address | none }\n"
		"ADDRESS := { register, 0 to 0xffff | L..., NOP: logical, 0 to 0xffffffff }\n"
		"DATA := { all but ...RD and NOP: with --type a value, else the name of a file with\n"
		"  the bytes; - for stdin }\n"
		"SIZE := { bytes, 1 to 1486; not needed with DATA or a --type of fixed size }\n"
		"Without --type the data that return are shown as hex bytes. A datagram that returns\n"
		"is a success with any working counter. It is sent once, also if it is lost.\n"
		"While an application runs the bus, root alone may write to all slaves, to a logical\n"
		"address, or to registers that run the bus: 0x0010, 0x0100 to 0x0103, 0x0120, 0x0200,\n"
		"FMMUs, SyncManagers, clocks.\n"
		"  ethercat datagram BRD 0x0130 -t uint16\n"
		"  ethercat datagram FPRW 0x1001 0x0f80 -t uint16 0x1234\n",
	.json = "master, command, address, working_counter, size_bytes; of commands that read: type,\n"
		"value, data_hex",
	.flags = CMD_ONE_MASTER | CMD_NEGATIVE,
	.min_args = 2,
	.max_args = 5,
};
