// SPDX-License-Identifier: GPL-2.0-only
/* Segments which are always at hand. */
#include "describe.h"

static const struct {
	const char *name;
	const char *text;
} segments[] = {
	{
		.name = "thin",
		.text =
		"segment seed=1\n"
		"slave coupler EK1100\n"
		"slave out EL2008\n",
	}, {
		/* the segment of the examples of the command line tool */
		.name = "three",
		.text =
		"segment seed=3\n"
		"slave coupler EK1100\n"
		"slave out EL2008 alias=1001\n"
		"slave axis EL7201 motor=AM8121\n",
	}, {
		.name = "bench",
		.text =
		"# didactic bench: two couplers, an extension, a fieldbus coupler\n"
		"segment seed=20 response=200us transition=1ms\n"
		"slave coupler1 EK1100 alias=1 drift=12ppm\n"
		"slave dio EL1859 drift=-7ppm\n"
		"slave ai EL3062 drift=20ppm\n"
		"slave ao EL4002 drift=3ppm\n"
		"slave axis1 EL7201 motor=AM8121 drift=-18ppm\n"
		"slave axis2 EL7201 motor=AM8121 drift=9ppm\n"
		"slave switch EL6614\n"
		"slave extension EK1110\n"
		"slave coupler2 EK1100 alias=2 cable=50 drift=-25ppm\n"
		"slave di1 EL1008\n"
		"slave di2 EL1004\n"
		"slave do1 EL2008 alias=1001\n"
		"slave do2 EL2004\n"
		"slave ai2 EL3062\n"
		"slave ao2 EL4002\n"
		"branch coupler1 2\n"
		"slave wago 750-354 alias=3 cable=100 drift=5ppm\n"
		"slave drive1 drive in=22 out=22 id=11\n"
		"slave drive2 drive in=22 out=22 id=12\n"
		"slave io io in=64 out=64\n"
		"slave coupler3 EK1100 alias=4 cable=500\n"
		"slave do3 EL2008\n"
		"slave di3 EL1008\n"
		"# signals at the first inputs; the first outputs are wired to others\n"
		"ramp dio.1 amplitude=2 period=200ms\n"
		"connect dio.1 -> dio.5\n"
		"connect dio.2 -> dio.2\n"
		"sine ai.1 offset=16384 amplitude=15000 period=1s\n"
		"connect ao.1 -> ai.2\n"
		"connect do1.1 -> di1.1\n"
		"connect do1.2 -> di1.2\n"
		"connect do2.1 -> di2.1\n"
		"connect ao2.1 -> ai2.1\n"
		"ramp ai2.2 amplitude=30000 period=2s\n"
		"connect wago.1 -> wago.1\n"
		"connect wago.5 -> wago.5\n"
		"const wago.6 value=1234\n"
		"connect do3.1 -> di3.1\n",
	}, {
		/* two slaves with a web page behind EoE, one of them with process data */
		.name = "eoe",
		.text =
		"segment seed=35 response=200us transition=1ms\n"
		"slave coupler EK1100\n"
		"slave web EL6614 alias=5 eoe=host\n"
		"branch coupler 2\n"
		"slave axis drive in=8 out=8 mbox=512 eoe=host\n",
	}, {
		.name = "line100",
		.text =
		"segment seed=100\n"
		"repeat 100 slave d drive in=8 out=8 drift=10ppm cable=50\n",
	}, {
		.name = "line1000",
		.text =
		"segment seed=1000\n"
		"repeat 1000 slave d drive in=8 out=8 drift=10ppm cable=50\n",
	},
};

/**
 * ec_sim_builtin() - description of a built-in segment
 * @name: "thin", "three", "bench", "eoe", "line100", "line1000"
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its text, NULL: no such segment.
 */
const char *ec_sim_builtin(const char *name)
{
	for (u32 i = 0; i < ARRAY_SIZE(segments); i++)
		if (!strcmp(segments[i].name, name))
			return segments[i].text;
	return NULL;
}

/**
 * ec_sim_builtin_at() - name of the @n-th built-in segment
 * @n: from 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: its name, NULL behind the last.
 */
const char *ec_sim_builtin_at(u32 n)
{
	return n < ARRAY_SIZE(segments) ? segments[n].name : NULL;
}
