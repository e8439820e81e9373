// SPDX-License-Identifier: GPL-2.0-only
/* Bits from place to place, against the slow way: one after the other. */
#include "fuzz.h"
#include "../../devices/sim/esc_page.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\0\0\x08\x01\x02\x03\x04"),
	SEED("\x03\x06\x0B\xC5\x12\xFF\x00\x55\xAA"),
	{ NULL, 0 }
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	u8 fast[64], slow[64];
	u32 to, from, bits, i;

	if (len < 4)
		return 0;
	to = data[0];
	from = data[1];
	bits = data[2];
	data += 3;
	len -= 3;
	if (to + bits > 8 * sizeof(fast) || from + bits > 8 * len)
		return 0;
	memset(fast, data[0], sizeof(fast));
	memcpy(slow, fast, sizeof(slow));
	ec_bits_copy(fast, to, data, from, bits);
	for (i = 0; i < bits; i++) {
		u8 bit = data[(from + i) / 8] >> (from + i) % 8 & 1;
		u8 *p = &slow[(to + i) / 8];

		*p = (u8)((*p & ~(1 << (to + i) % 8)) | bit << (to + i) % 8);
	}
	MUST(!memcmp(fast, slow, sizeof(fast)));
	return 0;
}
