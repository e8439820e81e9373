// SPDX-License-Identifier: GPL-2.0-only
/*
 * memory: configures startup SDOs of 64 KiB until one is refused, then says how many
 * there are, and why there is no more.
 */
#include <ecrt.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

int main(void)
{
	static const uint8_t value[64 * 1024];
	ec_master_t *m = ecrt_request_master(0);
	ec_slave_config_t *sc = NULL;
	unsigned int n = 0;
	int ret = 0;

	if (!m)
		return 2;
	for (uint16_t pos = 0; pos < 4 && !ret; pos++) {
		sc = ecrt_master_slave_config(m, 0, pos, 1, 2);
		if (!sc)
			return 2;
		/* one configuration has at most 1024 */
		for (unsigned int i = 0; i < 1000 && !ret; i++, n += !ret)
			ret = ecrt_slave_config_sdo(sc, 0x2000, (uint8_t)i, value, sizeof(value));
	}
	printf("%u values, then: %s\n", n, strerror(-ret));
	ecrt_release_master(m);
	return 0;
}
