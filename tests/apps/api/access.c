// SPDX-License-Identifier: GPL-2.0-only
/* Values in process data: the functions behind the macros. */
#include "api.h"

static void reals(void)
{
	static const uint8_t one_and_a_half[4] = { 0, 0, 0xc0, 0x3f };
	static const uint8_t minus_two[8] = { 0, 0, 0, 0, 0, 0, 0, 0xc0 };
	uint8_t m[16];

	memset(m, 0xee, sizeof(m));
	YES(CALL(ecrt_read_real)(one_and_a_half) == 1.5f);
	YES(CALL(ecrt_read_lreal)(minus_two) == -2.0);
	/* unaligned, and no byte beside */
	CALL(ecrt_write_real)(m + 1, 1.5f);
	YES(!memcmp(m + 1, one_and_a_half, 4));
	YES(m[0] == 0xee && m[5] == 0xee);
	CALL(ecrt_write_lreal)(m + 7, -2.0);
	YES(!memcmp(m + 7, minus_two, 8));
	YES(m[6] == 0xee && m[15] == 0xee);
	EC_WRITE_REAL(m + 3, -0.25f);
	YES(EC_READ_REAL(m + 3) == -0.25f);
	EC_WRITE_LREAL(m + 3, 1e300);
	YES(EC_READ_LREAL(m + 3) == 1e300);
}

const struct api_case access_cases[] = {
	{ "floating point", reals },
	{ NULL, NULL },
};
