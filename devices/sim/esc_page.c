// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/* FMMU and SyncManager pages as the ESC reads them, and the bits an FMMU moves. */
#include "esc_page.h"

/**
 * ec_fmmu_decode() - read an FMMU register page
 * @f: result
 * @page: 16 bytes from register 0x0600 + 16 * n
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_fmmu_decode(struct ec_fmmu *f, const u8 page[EC_FMMU_PAGE])
{
	f->logical = get_unaligned_le32(page);
	f->len = get_unaligned_le16(page + 4);
	f->lbit_start = page[6] & 7;
	f->lbit_stop = page[7] & 7;
	f->phys = get_unaligned_le16(page + 8);
	f->pbit = page[10] & 7;
	f->type = page[11] & 3;
	f->enable = page[12] & 1;
}

/**
 * ec_fmmu_bits() - number of bits an FMMU maps
 * @f: FMMU
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bits, 0 when the stop bit lies before the start bit.
 */
u32 ec_fmmu_bits(const struct ec_fmmu *f)
{
	u32 end;

	if (!f->len)
		return 0;
	end = (u32)(f->len - 1) * 8 + f->lbit_stop + 1;
	return end > f->lbit_start ? end - f->lbit_start : 0;
}

/**
 * ec_sm_decode() - read a SyncManager register page
 * @sm: result
 * @page: 8 bytes from register 0x0800 + 8 * n
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sm_decode(struct ec_sm *sm, const u8 page[EC_SM_PAGE])
{
	sm->start = get_unaligned_le16(page);
	sm->len = get_unaligned_le16(page + 2);
	sm->control = page[4];
	sm->status = page[5];
	sm->activate = page[6];
	sm->pdi = page[7];
}

/**
 * ec_bits_copy() - copy a bit field, least significant bit first
 * @dst: destination bytes
 * @dst_bit: first bit in @dst
 * @src: source bytes
 * @src_bit: first bit in @src
 * @bits: how many; neighbouring bits of @dst stay as they are
 *
 * Context: Any. RT-safe: time grows with @bits, no sleep, no allocation.
 */
void ec_bits_copy(u8 *dst, u32 dst_bit, const u8 *src, u32 src_bit, u32 bits)
{
	u32 i;

	if (!((dst_bit | src_bit) & 7)) {
		memcpy(dst + dst_bit / 8, src + src_bit / 8, bits / 8);
		i = bits & ~7u;
	} else {
		i = 0;
	}
	for (; i < bits; i++) {
		u32 d = dst_bit + i, s = src_bit + i;
		u8 bit = src[s / 8] >> (s & 7) & 1;

		dst[d / 8] = (u8)((dst[d / 8] & ~(1u << (d & 7))) | bit << (d & 7));
	}
}
