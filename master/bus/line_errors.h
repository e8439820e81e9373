/* SPDX-License-Identifier: GPL-2.0-only */
/* Cables that damage frames: the error counters of the ports, read all the time. */
#ifndef EC_LINE_ERRORS_H
#define EC_LINE_ERRORS_H

#include <linux/types.h>
#include "../wire/regs.h"

struct ec_bus;
struct ec_slave;

#define EC_LINE_RX_BYTES	12	/* a write to one of these clears them all */
#define EC_LINE_AT(reg)		((reg) - EC_REG_ERRORS)	/* place of a register in @regs */

/**
 * struct ec_line_port - what a port has counted
 * @crc: invalid frames in this period
 * @phy: errors of the receiver
 * @crc_new: invalid frames found by the last read: they count unless the link changes now
 * @phy_new: likewise
 * @crc_before: @crc of the period before
 * @noise: a counter has grown in this period, for any reason
 * @calm: periods since then
 * @reported: its cable is reported, and has not been calm long enough since
 */
struct ec_line_port {
	u16 crc;
	u16 phy;
	u16 crc_new;
	u16 phy_new;
	u16 crc_before;
	bool noise;
	u8 calm;
	bool reported;
};

/**
 * struct ec_line_errors - error counters of a slave
 * @regs: registers 0x0300 to 0x0313 as read last, or after the master has cleared them
 * @bytes: of them that the slave lets read together
 * @known: @regs are valid
 * @emptying: the reply to a write that clears them was lost
 * @kept: they stay full after such a write
 * @links: of struct ec_line_watch when they were read
 * @dl: DL status that was known then
 * @parent: device number of the neighbor towards the main device then, 0: none
 * @read_ns: when they were read (ktime)
 * @from_ns: when the counts of this period begin (ktime)
 * @to_ns: and when they end so far
 * @before_ns: duration of the period before
 * @cleared: counts that the registers do not contain any more, as the master has cleared them
 * @void_cleared: a user has cleared the registers: @cleared are 0; any thread sets it
 * @port: counts of each port
 * @shown: of each port, what ec_line_errors_seen() gives; the monitor writes it
 * @shown_n: counts of a port in @shown that the slave has, 0: none was read
 * @shown_at: when they were read (jiffies)
 */
struct ec_line_errors {
	u8 regs[EC_ERRORS_SIZE];
	u8 bytes;
	bool known;
	bool emptying;
	bool kept;
	u32 links;
	u16 dl;
	u64 parent;
	u64 read_ns;
	u64 from_ns;
	u64 to_ns;
	u64 before_ns;
	u32 cleared[EC_LINE_RX_BYTES];
	bool void_cleared;
	struct ec_line_port port[EC_MAX_PORT];
	u32 shown[EC_MAX_PORT][4];
	u32 shown_n;
	unsigned long shown_at;
};

/* errors of a cable in 10 s, 0: none; module parameter line_errors */
extern unsigned int ec_line_errors_limit;

void ec_line_errors_look(struct ec_bus *bus, bool links_changed);
void ec_line_errors_show(struct ec_line_errors *e);
u32 ec_line_errors_seen(const struct ec_slave *s, unsigned int port, u32 errors[4], u32 *age_ms);
void ec_line_errors_cleared(const struct ec_slave *s, unsigned int port, u32 cleared[3]);
void ec_line_errors_written(struct ec_slave *s, u32 reg, u32 n);

#endif
