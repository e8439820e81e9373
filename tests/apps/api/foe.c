// SPDX-License-Identifier: GPL-2.0-only
/* Files of slaves. */
#include "api.h"

#define FILE_BYTES	50000

static uint8_t out[FILE_BYTES], in[FILE_BYTES];

static void fill(void)
{
	for (unsigned int i = 0; i < FILE_BYTES; i++)
		out[i] = (uint8_t)(i * 31 + (i >> 8));
	memset(in, 0, sizeof(in));
}

/* of a master that is only open */
static void at_once(void)
{
	ec_master_t *m = CALL(ecrt_open_master)(0);
	uint32_t error = 1;
	size_t size = 99;

	NEED(m);
	fill();
	IS(CALL(ecrt_master_foe_write)(m, MOTOR, "data.bin", 7, out, FILE_BYTES, &error, 0), 0);
	IS(error, 0);
	SAYS(CALL(ecrt_master_foe_read)(m, MOTOR, "data.bin", 7, in, 10, &size, &error, 0), -ENOBUFS);
	IS(size, 99);
	IS(CALL(ecrt_master_foe_read)(m, MOTOR, "data.bin", 7, in, FILE_BYTES, &size, &error, 5000),
	   0);
	IS(size, FILE_BYTES);
	YES(!memcmp(in, out, FILE_BYTES));
	SAYS(CALL(ecrt_master_foe_read)(m, MOTOR, "none", 0, in, FILE_BYTES, &size, &error, 0), -EIO);
	IS(error, 0x8001);
	IS(size, FILE_BYTES);
	SAYS(CALL(ecrt_master_foe_read)(m, OUT, "a", 0, in, 10, &size, &error, 0),
	     -EPROTONOSUPPORT);
	SAYS(CALL(ecrt_master_foe_write)(m, NOWHERE, "a", 0, out, 10, &error, 0), -EINVAL);
	SAYS(CALL(ecrt_master_foe_write)(m, MOTOR, "a\nb", 0, out, 10, &error, 0), -EINVAL);
	SAYS(CALL(ecrt_master_foe_write)(m, MOTOR, "", 0, out, 10, &error, 0), -EINVAL);
	IS(CALL(ecrt_master_foe_write)(m, MOTOR, "empty", 0, NULL, 0, NULL, 0), 0);
	IS(CALL(ecrt_master_foe_read)(m, MOTOR, "empty", 0, in, 10, &size, NULL, 0), 0);
	IS(size, 0);
	CALL(ecrt_release_master)(m);
}

const struct api_case foe_cases[] = {
	{ "files at once", at_once },
	{ NULL, NULL },
};
