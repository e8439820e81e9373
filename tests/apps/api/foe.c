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
	SAYS(CALL(ecrt_master_foe_read)(m, MOTOR, "data.bin", 7, in, 10, &size, &error, 0),
	     -ENOBUFS);
	IS(size, 99);
	IS(CALL(ecrt_master_foe_read)(m, MOTOR, "data.bin", 7, in, FILE_BYTES, &size, &error, 5000),
	   0);
	IS(size, FILE_BYTES);
	YES(!memcmp(in, out, FILE_BYTES));
	SAYS(CALL(ecrt_master_foe_read)(m, MOTOR, "none", 0, in, FILE_BYTES, &size, &error, 0),
	     -EIO);
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

#define WAIT_CYCLES	20000

static struct bench b;
static ec_foe_request_t *req, *small;

static void before(void)
{
	NEED(bench_request(&b) && bench_configure(&b));
	req = CALL(ecrt_slave_config_create_foe_request)(b.motor, FILE_BYTES);
	small = CALL(ecrt_slave_config_create_foe_request)(b.motor, 10);
	NEED(req && small);
	SAYS(CALL(ecrt_slave_config_create_foe_request)(b.motor, 16 << 20) != NULL, 0);
	IS(CALL(ecrt_foe_request_state)(req), EC_REQUEST_UNUSED);
	IS(CALL(ecrt_foe_request_data_size)(req), FILE_BYTES);
	YES(CALL(ecrt_foe_request_data)(req) && !CALL(ecrt_foe_request_data)(req)[FILE_BYTES - 1]);
	IS(CALL(ecrt_foe_request_timeout)(req, 5000), 0);
	SILENT(CALL(ecrt_foe_request_file)(req, "", 0), -EINVAL);
	IS(CALL(ecrt_foe_request_file)(req, "async.bin", 9), 0);
	IS(CALL(ecrt_foe_request_file)(small, "async.bin", 9), 0);
	SILENT(CALL(ecrt_foe_request_read)(req), -EINVAL);
	SILENT(CALL(ecrt_foe_request_write)(req, 1), -EINVAL);
	SILENT(CALL(ecrt_foe_request_cancel)(req), -EINVAL);
	NEED(bench_activate(&b) && bench_op(&b));
}

static ec_request_state_t done(ec_foe_request_t *r)
{
	for (int i = 0;
	     i < WAIT_CYCLES && CALL(ecrt_foe_request_state)(r) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_foe_request_state)(r);
}

static void requests(void)
{
	uint8_t *data = CALL(ecrt_foe_request_data)(req);

	NEED(b.data && data);
	fill();
	memcpy(data, out, FILE_BYTES);
	SILENT(CALL(ecrt_foe_request_write)(req, FILE_BYTES + 1), -ENOBUFS);
	SILENT(CALL(ecrt_foe_request_write)(req, FILE_BYTES), 0);
	SILENT(CALL(ecrt_foe_request_read)(req), -EBUSY);
	SILENT(CALL(ecrt_foe_request_file)(req, "other", 0), -EBUSY);
	IS(done(req), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_foe_request_progress)(req), FILE_BYTES);
	memset(data, 0, FILE_BYTES);
	SILENT(CALL(ecrt_foe_request_read)(req), 0);
	IS(done(req), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_foe_request_data_size)(req), FILE_BYTES);
	IS(CALL(ecrt_foe_request_result)(req), 0);
	YES(!memcmp(data, out, FILE_BYTES));
	/* too large, unknown, cancelled */
	IS(CALL(ecrt_foe_request_read)(small), 0);
	IS(done(small), EC_REQUEST_ERROR);
	IS(CALL(ecrt_foe_request_result)(small), -ENOBUFS);
	IS(CALL(ecrt_foe_request_file)(small, "none", 0), 0);
	IS(CALL(ecrt_foe_request_read)(small), 0);
	IS(done(small), EC_REQUEST_ERROR);
	IS(CALL(ecrt_foe_request_result)(small), -EIO);
	IS(CALL(ecrt_foe_request_error_code)(small), 0x8001);
	IS(CALL(ecrt_foe_request_write)(req, FILE_BYTES), 0);
	for (int i = 0;
	     i < WAIT_CYCLES && CALL(ecrt_foe_request_progress)(req) < FILE_BYTES / 4; i++) {
		IS(CALL(ecrt_foe_request_state)(req), EC_REQUEST_BUSY);
		bench_cycle(&b, 1);
	}
	SILENT(CALL(ecrt_foe_request_cancel)(req), 0);
	IS(done(req), EC_REQUEST_ERROR);
	IS(CALL(ecrt_foe_request_result)(req), -ECANCELED);
	YES(CALL(ecrt_foe_request_progress)(req) < FILE_BYTES);
}

static void end(void) { bench_down(&b); }

const struct api_case foe_cases[] = {
	{ "files at once", at_once },
	{ "before activation", before },
	{ "requests of files", requests },
	{ "release", end },
	{ NULL, NULL },
};
