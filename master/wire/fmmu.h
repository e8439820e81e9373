/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* FMMU and SyncManager register pages (ETG.1000.4 clause 6.6, 6.7). */
#ifndef EC_WIRE_FMMU_H
#define EC_WIRE_FMMU_H

#include "regs.h"

#define EC_FMMU_READ	1	/* inputs to the master */
#define EC_FMMU_WRITE	2	/* outputs from the master */

/**
 * struct ec_fmmu - one FMMU, decoded
 * @logical: logical start address
 * @len: bytes touched
 * @lbit_start: first bit in the first byte
 * @lbit_stop: last bit in the last byte
 * @phys: physical start address
 * @pbit: physical start bit
 * @type: EC_FMMU_READ, EC_FMMU_WRITE or both
 * @enable: page is active
 */
struct ec_fmmu {
	u32 logical;
	u16 len;
	u8 lbit_start;
	u8 lbit_stop;
	u16 phys;
	u8 pbit;
	u8 type;
	bool enable;
};

/**
 * struct ec_sm - one SyncManager page, decoded
 * @start: physical start address
 * @len: bytes
 * @control: EC_SM_MODE_*, EC_SM_DIR_*, EC_SM_WATCHDOG...
 * @status: EC_SM_ST_*
 * @activate: EC_SM_ACT_*
 * @pdi: EC_SM_PDI_*
 */
struct ec_sm {
	u16 start;
	u16 len;
	u8 control;
	u8 status;
	u8 activate;
	u8 pdi;
};

void ec_fmmu_encode(const struct ec_fmmu *f, u8 page[EC_FMMU_PAGE]);
void ec_sm_encode(const struct ec_sm *sm, u8 page[EC_SM_PAGE]);

#endif
