/* SPDX-License-Identifier: GPL-2.0-only */
/* What the files that read EEPROMs share. */
#ifndef EC_SCAN_SII_INT_H
#define EC_SCAN_SII_INT_H

#include "../link/links.h"
#include "../wire/regs.h"
#include "slave.h"

/* one slave being read, into its @part */
struct reader {
	struct ec_slave *slave;
	size_t need;
	size_t began;	/* bytes of the parts before */
	struct ec_image *kept;	/* of a disconnected device with the same head */
	u32 check;	/* word at which the two are compared */
	bool looked;	/* for @kept */
	u8 tries;
	u8 len;		/* bytes of @reg that are of interest */
	bool alone;	/* left the lockstep */
	bool unheard;	/* no reply to the last read */
	bool done;
	u8 reg[14];	/* 0x0502-0x050F */
};

struct job {
	struct ec_bus *bus;
	struct reader *rd;
	unsigned int n;
	unsigned int count;	/* slaves on the bus */
	struct ec_dg *dg;
	u8 (*cmd)[6];
	struct reader **rds;
	bool broadcast;
	u64 wait_ns;	/* from the command to the first look, 0: not known */
	u64 good_ns;	/* @wait_ns that was long enough */
	bool settled;	/* a shorter wait was too short */
	u64 began_ns;
};

/* Without link, or with other slaves, none is to blame: the scan ends and fails as a whole. */
static inline bool ec_scan_sii_goes_on(const struct job *j)
{
	return !READ_ONCE(j->bus->base->stopping) && ec_links_is_up(j->bus->links);
}

/* The command that reads at @word, for registers 0x0502 to 0x0507 */
static inline void ec_scan_command(u8 *c, u32 word)
{
	put_unaligned_le16(EC_EEP_CMD_READ, c);
	put_unaligned_le32(word, c + 2);
}

/* An access that ended without data; asking again does not help. @reg: registers from 0x0502 */
static inline bool ec_scan_is_refused(const u8 *reg)
{
	u16 ctl = get_unaligned_le16(reg);

	return !(ctl & EC_EEP_BUSY) && ctl & EC_EEP_ERR_ACK;
}

/* Are the data those at @word? */
static inline bool ec_scan_has_word(const u8 *reg, u32 word)
{
	/* controllers for small EEPROMs have 16 bits */
	u32 mask = word > 0xffff ? ~0u : 0xffff;

	return !(get_unaligned_le16(reg) & (EC_EEP_BUSY | EC_EEP_CMD_MASK | EC_EEP_ERR_ACK)) &&
	       (get_unaligned_le32(reg + 2) & mask) == word;
}

/* scan_image.c */
void ec_scan_image_begin(struct reader *r, struct ec_slave *s);
void ec_scan_image_done(struct reader *r);
void ec_scan_image_fail(struct reader *r, const char *what, const char *remedy);
void ec_scan_image_enlarge(struct reader *r, size_t bytes);
void ec_scan_image_plan(struct reader *r);
u32 ec_scan_image_word(const struct reader *r);
u32 ec_scan_image_room(const struct reader *r);
bool ec_scan_image_reads_on(struct reader *r, size_t bytes);
void ec_scan_image_take(struct reader *r, const u8 *data, size_t len);
void ec_scan_image_reached(struct reader *r, size_t bytes);
void ec_scan_image_drop(struct reader *r);
void ec_scan_image_interrupt(struct job *j);

/* scan_chain.c */
void ec_scan_chain_run(struct job *j);

#endif
