// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "port_text.h"
#include "../../include/uapi/ethercat.h"

/**
 * ec_port_text() - why a port is closed although it has a link
 * @kept: EC_PORT_*
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: texts; of a reason that a newer module has as well.
 */
const struct ec_port_text *ec_port_text(u32 kept)
{
	static const struct ec_port_text texts[] = {
		{ "reason unknown to this version", "see the kernel log", false },
		[EC_PORT_NO_REPLY] = {
			"no slave replies behind it",
			"connect port 0 (IN) of a slave there, or remove the cable",
			false,
		},
		[EC_PORT_LOOPS] = {
			"the slave behind it does not keep register 0x0101, and others are behind that",
			"connect them before activation",
			false,
		},
		[EC_PORT_LOSSES] = {
			"it has lost its link again and again",
			"check cable and plugs",
			false,
		},
		[EC_PORT_OTHER] = {
			"another device than the hot connect group of this port",
			"connect that",
			true,
		},
		[EC_PORT_SIGN] = {
			"another alias or identification than the group",
			"connect the right one",
			true,
		},
		[EC_PORT_SERIAL] = {
			"another serial number than the group",
			"connect the right one",
			true,
		},
		[EC_PORT_SECOND] = {
			"a device with the alias or identification of another slave",
			"change one",
			true,
		},
		[EC_PORT_REVERSED] = {
			"a device that is not connected by its port 0",
			"connect port 0 (IN)",
			true,
		},
		[EC_PORT_BOOT] = {
			"a device in BOOT",
			"switch it off and on",
			true,
		},
		[EC_PORT_UNREADABLE] = {
			"a device whose EEPROM cannot be read",
			"check that device",
			true,
		},
		[EC_PORT_UNKNOWN] = {
			"an unexpected device (border=closed)",
			"remove it",
			true,
		},
		[EC_PORT_SWALLOWS] = {
			"no frame returned while it was open",
			"connect slaves there again, no PC or switch",
			false,
		},
		[EC_PORT_WRONG_WAY] = {
			"the slave behind it is connected the wrong way round, with others at its port 0",
			"connect port 0 (IN) of that slave there",
			false,
		},
		[EC_PORT_NO_TIME] = {
			"the cycle leaves too little time on the wire for looking behind it",
			"use a longer cycle, or connect it before activation",
			false,
		},
		[EC_PORT_EARLY] = {
			"the slave with this port is connected the wrong way round",
			"connect port 0 (IN) of that slave to the slave before it",
			false,
		},
	};

	return &texts[kept < ARRAY_SIZE(texts) ? kept : 0];
}
