/* SPDX-License-Identifier: GPL-2.0-only */
/* Writing the EEPROM of a slave. */
#ifndef EC_EEPROM_WRITE_H
#define EC_EEPROM_WRITE_H

#include <linux/bits.h>
#include <linux/completion.h>
#include <linux/workqueue.h>
#include "../../include/uapi/ethercat_common.h"

struct ec_slave;

#define EC_EEPROM_FORCE		BIT(0)	/* also while it runs, or the image of another device */
#define EC_EEPROM_UNSAFE	BIT(1)	/* also what may make the slave unreachable */
#define EC_EEPROM_REPAIR	BIT(2)	/* alias: also if the checksum was wrong before */
#define EC_EEPROM_DRY_RUN	BIT(3)	/* check and compare only */

/**
 * struct ec_eeprom_job - one write
 * @slave: slave
 * @flags: EC_EEPROM_*
 * @image: content from word 0 on; NULL: only the alias is changed
 * @bytes: at @image
 * @alias: for a change of the alias alone
 * @abandon: set by the caller to end it after the present word
 * @words: result: words that are to be the same, also while it runs
 * @done: of these: words that are
 * @differ: result: words that differed
 * @written: of these: words that were written and read back
 * @word: address of the word that was written last, or failed
 * @register_alias: result: register 0x0012, the alias that the slave uses
 * @renewed: result: a scan has read the slave again
 * @ret: result
 * @why: why it is refused or has failed, a text without the slave
 */
struct ec_eeprom_job {
	struct ec_slave *slave;
	u32 flags;
	const u8 *image;
	size_t bytes;
	u16 alias;
	bool abandon;
	u32 words;
	u32 done;
	u32 differ;
	u32 written;
	u32 word;
	u16 register_alias;
	bool renewed;
	int ret;
	char why[EC_UAPI_REASON];
};

int ec_eeprom_write(struct ec_eeprom_job *job, void (*progress)(void *ctx, u32 done, u32 words),
		    void *ctx);

#endif
