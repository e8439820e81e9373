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
	CHECK(arg->slave.position == 3 && arg->password == 0x12345678 && arg->size == 8);
	CHECK(arg->timeout_ms == 700 && !strcmp(arg->name, "a.bin") && !arg->done && !arg->flags);
	CHECK(n == 4 && !memcmp(b, "file", 4) && !error);
	CHECK(!ecrt_master_foe_read(m, 3, longest, 0, b, 8, &n, NULL, 0));
	CHECK(!memcmp(arg->name, longest, 64));
	calls = fake.calls;
	CHECK(ecrt_master_foe_read(m, 3, "", 0, b, 8, &n, &error, 0) == -EINVAL);
	CHECK(ecrt_master_foe_read(m, 3, "a\nb", 0, b, 8, &n, &error, 0) == -EINVAL);
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
	CHECK(fake.last == (unsigned int)EC_IOC_FOE_WRITE);
	CHECK(arg->slave.position == 2 && arg->size == 4);
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

static void request_of_nobody(void)
{
	CHECK(!ecrt_slave_config_create_foe_request(NULL, 4));
	CHECK(ecrt_foe_request_file(NULL, "a", 0) == -EINVAL);
	CHECK(ecrt_foe_request_timeout(NULL, 0) == -EINVAL);
	CHECK(!ecrt_foe_request_data(NULL) && !ecrt_foe_request_data_size(NULL));
	CHECK(ecrt_foe_request_state(NULL) == EC_REQUEST_ERROR);
	CHECK(!ecrt_foe_request_progress(NULL) && !ecrt_foe_request_error_code(NULL));
	CHECK(ecrt_foe_request_result(NULL) == -EINVAL);
	CHECK(ecrt_foe_request_read(NULL) == -EINVAL);
	CHECK(ecrt_foe_request_write(NULL, 1) == -EINVAL);
	CHECK(ecrt_foe_request_cancel(NULL) == -EINVAL);
}

#define LARGE		40000
#define PART		16384
#define memory		(fake.area + 4096)	/* of the request: name, data */

static void names(ec_foe_request_t *r)
{
	CHECK(ecrt_foe_request_file(r, NULL, 0) == -EINVAL);
	CHECK(ecrt_foe_request_file(r, "", 0) == -EINVAL);
	CHECK(ecrt_foe_request_file(r, "a\177", 0) == -EINVAL);
	CHECK(ecrt_foe_request_file(r, "0123456789abcdef0123456789abcdef0123456789abcdef"
				    "0123456789abcdef0", 0) == -EINVAL);
	CHECK(ecrt_foe_request_read(r) == -EINVAL);	/* none yet */
	CHECK(!ecrt_foe_request_file(r, longest, 7));
	CHECK(!ecrt_foe_request_timeout(r, 300));
}

/* Each call copies a part; nothing is started before all of it is there. */
static void write_in_parts(ec_master_t *m, ec_foe_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 0);
	unsigned int calls = fake.calls;

	memset(ecrt_foe_request_data(r), 0x5a, LARGE);
	CHECK(ecrt_foe_request_write(r, LARGE + 1) == -ENOBUFS);
	CHECK(!ecrt_foe_request_write(r, LARGE));
	CHECK(!rec->start && memory[64 + PART - 1] == 0x5a && !memory[64 + PART]);
	CHECK(!memcmp(memory, longest, 64));
	CHECK(ecrt_foe_request_write(r, 1) == -EBUSY && !rec->start);
	CHECK(memory[64 + 2 * PART - 1] == 0x5a && !memory[64 + 2 * PART]);
	CHECK(!ecrt_foe_request_progress(r));
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_BUSY && rec->start == 1);
	CHECK(rec->op == EC_REQUEST_OP_WRITE && rec->size == LARGE && rec->vendor_id == 7);
	CHECK(rec->timeout_ms == 300 && memory[64 + LARGE - 1] == 0x5a);
	CHECK(fake.calls == calls);
	CHECK(!ecrt_master_send(m) && fake.send_flags == EC_SEND_FLAG_REQUESTS);
	CHECK(ecrt_foe_request_read(r) == -EBUSY && ecrt_foe_request_file(r, "a", 0) == -EBUSY);
	rec->progress = 500;
	CHECK(ecrt_foe_request_progress(r) == 500);
	rec->result = -EIO;
	rec->abort_code = 0x8003;
	rec->done = rec->start;
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_ERROR);
	CHECK(ecrt_foe_request_result(r) == -EIO && ecrt_foe_request_error_code(r) == 0x8003);
	/* one that was not passed to the kernel ends at once */
	CHECK(!ecrt_foe_request_write(r, LARGE) && !ecrt_foe_request_cancel(r));
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_ERROR && rec->start == 1);
	CHECK(ecrt_foe_request_result(r) == -ECANCELED && !ecrt_foe_request_error_code(r));
}

/* What has arrived is copied while the rest is in transfer. */
static void read_in_parts(ec_foe_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 0);
	const uint8_t *data = ecrt_foe_request_data(r);
	unsigned int calls = fake.calls;

	memset(memory + 64, 0x77, LARGE);
	CHECK(!ecrt_foe_request_file(r, "b", 0));
	CHECK(!ecrt_foe_request_read(r) && rec->start == 2 && !rec->progress);
	CHECK(!rec->op && !strcmp((char *)memory, "b"));
	rec->progress = 100;
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_BUSY);
	CHECK(data[99] == 0x77 && data[100] == 0x5a);
	rec->result = 0;
	rec->got = LARGE - 1;
	rec->progress = LARGE - 1;
	rec->done = rec->start;
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_BUSY && data[PART + 99] == 0x77 &&
	      data[PART + 100] == 0x5a);
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_BUSY);
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(data[LARGE - 2] == 0x77 && data[LARGE - 1] == 0x5a);
	CHECK(ecrt_foe_request_data_size(r) == LARGE - 1 && !ecrt_foe_request_result(r));
	CHECK(ecrt_foe_request_progress(r) == LARGE - 1);
	/* a number that is larger than the buffer is not believed */
	CHECK(!ecrt_foe_request_read(r));
	CHECK(!ecrt_foe_request_cancel(r) && rec->cancel == 3);
	rec->progress = ~0u;
	rec->got = ~0u;
	rec->done = rec->start;
	while (ecrt_foe_request_state(r) == EC_REQUEST_BUSY)
		;
	CHECK(ecrt_foe_request_data_size(r) == LARGE);
	CHECK(fake.calls == calls);
}

void files(void)
{
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 1, 2);
	ec_foe_request_t *r = ecrt_slave_config_create_foe_request(sc, LARGE);
	const struct ec_ioc_sc_request *arg = (void *)fake.arg;

	CHECK(r && arg->kind == EC_REQUEST_FOE && arg->size == LARGE && arg->config == 5);
	CHECK(ecrt_foe_request_state(r) == EC_REQUEST_UNUSED);
	CHECK(ecrt_foe_request_cancel(r) == -EINVAL && ecrt_foe_request_write(r, 1) == -EINVAL);
	nobody();
	request_of_nobody();
	read_at_once(m);
	write_at_once(m);
	names(r);
	fake.large = 65536;
	CHECK(!ecrt_master_activate(m));
	write_in_parts(m, r);
	read_in_parts(r);
	ecrt_release_master(m);
}
