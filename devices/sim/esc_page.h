/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* What an ESC reads from its FMMU and SyncManager pages (ETG.1000.4 clause 6.6, 6.7). */
#ifndef EC_SIM_ESC_PAGE_H
#define EC_SIM_ESC_PAGE_H

#include "../../master/wire/fmmu.h"

void ec_fmmu_decode(struct ec_fmmu *f, const u8 page[EC_FMMU_PAGE]);
u32 ec_fmmu_bits(const struct ec_fmmu *f);
void ec_sm_decode(struct ec_sm *sm, const u8 page[EC_SM_PAGE]);
void ec_bits_copy(u8 *dst, u32 dst_bit, const u8 *src, u32 src_bit, u32 bits);

#endif
