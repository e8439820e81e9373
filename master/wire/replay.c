// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "replay.h"

/* Profile area of the axes 0 to 7 of CiA 402: each has 0x800 objects (ETG.6010). */
#define AXES		0x6000
#define AXES_END	0xa000
#define AXIS		0x0800

/**
 * ec_replay_sdo_why() - may a value of an object be written again?
 * @index: object
 *
 * Context: Any.
 * Return: EC_REPLAY_WHY_NONE: yes; else why not, unless the application names the object.
 */
enum ec_replay_why ec_replay_sdo_why(u16 index)
{
	if (index == 0x1010 || index == 0x1011)
		return EC_REPLAY_WHY_STORE;
	if (index >= 0x10f2 && index <= 0x10ff)
		return EC_REPLAY_WHY_COMMAND;
	if (index < AXES || index >= AXES_END)
		return EC_REPLAY_WHY_NONE;
	switch (AXES + index % AXIS) {
	case 0x6040:
		return EC_REPLAY_WHY_CONTROL;
	case 0x6071:	/* torque */
	case 0x607a:	/* position */
	case 0x60c1:	/* interpolation data */
	case 0x60ff:	/* velocity */
		return EC_REPLAY_WHY_TARGET;
	default:
		return EC_REPLAY_WHY_NONE;
	}
}

/**
 * ec_replay_idn_why() - the same for an IDN of a servo drive
 * @idn: IDN
 *
 * Context: Any.
 * Return: As ec_replay_sdo_why().
 */
enum ec_replay_why ec_replay_idn_why(u16 idn)
{
	switch (idn) {
	case 134:	/* S-0-0134 */
		return EC_REPLAY_WHY_CONTROL;
	case 36:	/* velocity, position and torque command value */
	case 47:
	case 80:
		return EC_REPLAY_WHY_TARGET;
	default:
		return EC_REPLAY_WHY_NONE;
	}
}

/**
 * ec_replay_register_why() - the same for registers
 * @address: of the first one
 * @size: bytes
 *
 * The master writes most registers itself. Error counters, watchdogs, and those from 0x0e00 on,
 * which are the device's, are not among them.
 *
 * Context: Any.
 * Return: As ec_replay_sdo_why().
 */
enum ec_replay_why ec_replay_register_why(u16 address, u32 size)
{
	u32 end = address + size;

	if ((address >= 0x0300 && end <= 0x0500) || (address >= 0x0e00 && end <= 0x1000))
		return EC_REPLAY_WHY_NONE;
	return EC_REPLAY_WHY_REGISTER;
}

/**
 * ec_replay_why_text() - why a write is not replayed
 * @why: EC_REPLAY_WHY_*, of any module
 *
 * Context: Any.
 * Return: text; empty for EC_REPLAY_WHY_NONE.
 */
const char *ec_replay_why_text(u8 why)
{
	static const char *const text[EC_REPLAY_WHYS] = {
		[EC_REPLAY_WHY_NONE] = "",
		[EC_REPLAY_WHY_OFF] = "switched off",
		[EC_REPLAY_WHY_STORE] = "stores or restores parameters",
		[EC_REPLAY_WHY_COMMAND] = "device command or diagnosis",
		[EC_REPLAY_WHY_CONTROL] = "control word",
		[EC_REPLAY_WHY_TARGET] = "target value",
		[EC_REPLAY_WHY_OUTPUT] = "mapped to outputs",
		[EC_REPLAY_WHY_REGISTER] = "register of the master",
		[EC_REPLAY_WHY_STARTUP] = "a startup command writes it",
		[EC_REPLAY_WHY_OWN] = "written by the application after the return",
		[EC_REPLAY_WHY_LIMIT] = "value not kept, limit 512 values and 64 KiB",
	};

	return why < EC_REPLAY_WHYS ? text[why] : "unknown reason";
}
