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
		{ "reason unknown to this version", "see the kernel log" },
		[EC_PORT_NO_REPLY] = {
			"no slave replies behind it",
			"connect port 0 (IN) of a slave there, or remove the cable",
		},
		[EC_PORT_LOOPS] = {
			"the slave behind it does not keep register 0x0101, and others are behind that",
			"connect them before activation",
		},
		[EC_PORT_LOSSES] = {
			"it has lost its link again and again",
			"check cable and plugs",
		},
		[EC_PORT_SWALLOWS] = {
			"no frame returned while it was open",
			"connect slaves there again, no PC or switch",
		},
		[EC_PORT_REVERSED] = {
			"the slave behind it is connected the wrong way round, with others at its port 0",
			"connect port 0 (IN) of that slave there",
		},
	};

	return &texts[kept < ARRAY_SIZE(texts) ? kept : 0];
}
