/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Writing EEPROMs of slaves. */
#ifndef ETHERCAT_TOOLS_EEPROM_H
#define ETHERCAT_TOOLS_EEPROM_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* flags of ect_sii_write() and ect_alias_write() */
#define ECT_SII_FORCE		1u	/* also while the slave runs; the image of another device */
#define ECT_SII_UNSAFE		2u	/* also what may make the slave unreachable */
#define ECT_SII_REPAIR		4u	/* alias: also if the checksum is wrong before */
#define ECT_SII_DRY_RUN		8u	/* image: check and compare, write nothing */

/* what a write of an EEPROM has done */
struct ect_sii_written {
	uint32_t struct_size;
	uint32_t differ;	/* words that differed; 0 for an alias */
	uint32_t written;	/* of these: words that were written and read back */
	uint16_t register_alias;	/* register 0x0012: some slaves set it at power-on only */
	uint8_t renewed;	/* the master has read the slave again */
	uint8_t reserved;
};

/**
 * ect_sii_write() - write the EEPROM of a slave
 * @h: master, open for writing
 * @device: number of the slave
 * @data: image from word 0 on, an even number of bytes
 * @size: bytes
 * @flags: ECT_SII_*
 * @w: result, its @struct_size is set; also after -EIO
 * @done: NULL, or set to the words done so far, for another thread
 *
 * Only words that differ are written, words 0 to 7 after all others, and all are read back. After
 * an interruption the same call continues.
 *
 * Context: The thread of the handle; waits for the slave, some 10 ms for each word that differs.
 * Return: 0 or a negative errno. -EBUSY: the slave runs, is configured by an application, or keeps
 * its EEPROM; -EBADMSG: refused without %ECT_SII_UNSAFE; -EPERM: refused without %ECT_SII_FORCE,
 * or no write permission.
 */
int ect_sii_write(struct ect_handle *h, uint64_t device, const void *data, size_t size,
		  uint32_t flags, struct ect_sii_written *w, uint64_t *done);

/**
 * ect_alias_write() - write the alias of a slave into its EEPROM
 * @h: master, open for writing
 * @device: number of the slave
 * @alias: 0: none
 * @flags: %ECT_SII_FORCE, %ECT_SII_REPAIR
 * @w: result, its @struct_size is set
 *
 * Context: The thread of the handle; waits for the slave.
 * Return: 0 or a negative errno as ect_sii_write(). -EBADMSG: the checksum is wrong, as a write was
 * interrupted.
 */
int ect_alias_write(struct ect_handle *h, uint64_t device, uint16_t alias, uint32_t flags,
		    struct ect_sii_written *w);

#ifdef __cplusplus
}
#endif

#endif
