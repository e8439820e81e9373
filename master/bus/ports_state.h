/* SPDX-License-Identifier: GPL-2.0-only */
/* What the monitor knows of the ports of a slave; see ports.h. */
#ifndef EC_PORTS_STATE_H
#define EC_PORTS_STATE_H

#include <linux/types.h>
#include "../wire/regs.h"

/**
 * struct ec_door - a port behind which nothing is known
 * @link_ns: since when it has had a link without loss (ktime), 0: it has none
 * @next_ns: no trial before (ktime)
 * @wait_ms: distance of the last two trials in which no slave replied
 * @fresh: station address that a trial gave to the slave behind it
 * @was: the one that this slave had before
 * @kept: EC_PORT_*: why it stays closed, which was reported
 * @vain: trials in a row that failed for another reason
 */
struct ec_door {
	u64 link_ns;
	u64 next_ns;
	u16 wait_ms;
	u16 fresh;
	u16 was;
	u8 kept;
	u8 vain;
};

/**
 * struct ec_loss - losses of the link of a port
 * @since_ns: the first one that counts, once @wait_s is set the last one (ktime)
 * @n: since then
 * @wait_s: the port is opened after so much time of link without loss; 0: soon
 */
struct ec_loss {
	u64 since_ns;
	u8 n;
	u8 wait_s;
};

/**
 * struct ec_ports - loop control of a slave; the monitor's
 * @control: register 0x0100, low byte, as read
 * @loops: register 0x0101 as read or written last
 * @fixed: the slave does not keep what is written there
 * @doors: a port is a door
 * @fast: ports that are opened as soon as they have a link, a bit each; of the session
 * @settled: connected before process data began
 * @let_in: by port: a user has just let the device behind it in
 * @unsure: a write whose reply is lost may have been executed: @loops is to be written again
 * @lost: its counters of lost links, 0x0310, as read last
 * @door: by port
 * @loss: by port
 */
struct ec_ports {
	u8 control;
	u8 loops;
	bool unsure;
	bool fixed;
	bool doors;
	u8 fast;
	bool settled;
	bool let_in[EC_MAX_PORT];
	u8 lost[EC_MAX_PORT];
	struct ec_door door[EC_MAX_PORT];
	struct ec_loss loss[EC_MAX_PORT];
};

/* Register 0x0101 with another value for one port */
static inline u8 ec_loops_with(u8 loops, unsigned int port, u8 value)
{
	return (loops & ~(3 << 2 * port)) | value << 2 * port;
}

#endif
