// SPDX-License-Identifier: LGPL-2.1-or-later
/* Files of slaves: arguments of the commands. */
#include "session.h"

#include <errno.h>
#include <string.h>

static const char longest[] = "0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef";

static void nobody(void)
{
	uint8_t b[4] = { 0 };
	size_t n = 99;

	CHECK(ecrt_master_foe_read(NULL, 0, "a", 0, b, 4, &n, NULL, 0) == -EINVAL);
	CHECK(ecrt_master_foe_write(NULL, 0, "a", 0, b, 4, NULL, 0) == -EINVAL);
	CHECK(n == 99);
}

static void read_at_once(ec_master_t *m)
{
	const struct ec_ioc_foe *arg = (void *)fake.arg;
	uint32_t error = 9;
	unsigned int calls;
	uint8_t b[8];
	size_t n = 99;

	CHECK(!ecrt_master_foe_read(m, 3, "a.bin", 0x12345678, b, 8, &n, &error, 700));
	CHECK(fake.last == (unsigned int)EC_IOC_FOE_READ);
	CHECK(arg->position == 3 && arg->password == 0x12345678 && arg->size == 8);
	CHECK(arg->timeout_ms == 700 && !strcmp(arg->name, "a.bin") && !arg->done && !arg->flags);
	CHECK(n == 4 && !memcmp(b, "file", 4) && !error);
	CHECK(!ecrt_master_foe_read(m, 3, longest, 0, b, 8, &n, NULL, 0));
	CHECK(!memcmp(arg->name, longest, 64));
	calls = fake.calls;
	CHECK(ecrt_master_foe_read(m, 3, "", 0, b, 8, &n, &error, 0) == -EINVAL);
	CHECK(ecrt_master_foe_read(m, 3, NULL, 0, b, 8, &n, &error, 0) == -EINVAL);
	CHECK(ecrt_master_foe_read(m, 3, "a", 0, NULL, 8, &n, &error, 0) == -EINVAL);
	CHECK(ecrt_master_foe_read(m, 3, "a", 0, b, 8, NULL, &error, 0) == -EINVAL);
	CHECK(fake.calls == calls);
	fake.refuse = EC_IOC_FOE_READ;
	fake.err = EIO;
	n = 99;
	CHECK(ecrt_master_foe_read(m, 3, "a", 0, b, 8, &n, &error, 0) == -EIO);
	CHECK(error == 0x8001 && n == 99);
	CHECK(ecrt_master_foe_read(m, 3, "a", 0, b, 8, &n, NULL, 0) == -EIO);
	fake.err = ENOENT;	/* no such slave */
	CHECK(ecrt_master_foe_read(m, 3, "a", 0, b, 8, &n, &error, 0) == -EINVAL && !error);
	fake.refuse = 0;
}

static void write_at_once(ec_master_t *m)
{
	const struct ec_ioc_foe *arg = (void *)fake.arg;
	uint8_t b[4] = { 1, 2 };
	uint32_t error = 9;
	unsigned int calls;

	CHECK(!ecrt_master_foe_write(m, 2, "b", 0, b, 4, &error, 0));
	CHECK(fake.last == (unsigned int)EC_IOC_FOE_WRITE && arg->position == 2 && arg->size == 4);
	CHECK(arg->data == (uintptr_t)b && !arg->timeout_ms && !error);
	CHECK(!ecrt_master_foe_write(m, 2, "b", 0, NULL, 0, NULL, 0) && !arg->size);
	calls = fake.calls;
	CHECK(ecrt_master_foe_write(m, 2, "b", 0, NULL, 1, &error, 0) == -EINVAL);
	CHECK(ecrt_master_foe_write(m, 2, "0123456789abcdef0123456789abcdef0123456789abcdef"
				    "0123456789abcdef0", 0, b, 4, &error, 0) == -EINVAL);
#if __SIZEOF_SIZE_T__ > 4
	CHECK(ecrt_master_foe_write(m, 2, "b", 0, b, (size_t)1 << 32, &error, 0) == -EINVAL);
#endif
	CHECK(fake.calls == calls);
	fake.refuse = EC_IOC_FOE_WRITE;
	fake.err = EIO;
	CHECK(ecrt_master_foe_write(m, 2, "b", 0, b, 4, &error, 0) == -EIO && error == 0x8001);
	fake.refuse = 0;
}

void files(void)
{
	ec_master_t *m = start();

	nobody();
	read_at_once(m);
	write_at_once(m);
	ecrt_release_master(m);
}
