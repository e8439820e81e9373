// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "fmmu.h"

/**
 * ec_fmmu_encode() - write an FMMU register page
 * @f: what to write
 * @page: 16 bytes for register 0x0600 + 16 * n; reserved bytes become 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_fmmu_encode(const struct ec_fmmu *f, u8 page[EC_FMMU_PAGE])
{
	put_unaligned_le32(f->logical, page);
	put_unaligned_le16(f->len, page + 4);
	page[6] = f->lbit_start & 7;
	page[7] = f->lbit_stop & 7;
	put_unaligned_le16(f->phys, page + 8);
	page[10] = f->pbit & 7;
	page[11] = f->type & 3;
	page[12] = f->enable;
	memset(page + 13, 0, 3);
}

/**
 * ec_sm_encode() - write a SyncManager register page
 * @sm: what to write
 * @page: 8 bytes for register 0x0800 + 8 * n
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sm_encode(const struct ec_sm *sm, u8 page[EC_SM_PAGE])
{
	put_unaligned_le16(sm->start, page);
	put_unaligned_le16(sm->len, page + 2);
	page[4] = sm->control;
	page[5] = sm->status;
	page[6] = sm->activate;
	page[7] = sm->pdi;
}
