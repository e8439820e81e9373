// SPDX-License-Identifier: GPL-2.0-only
/* The object dictionary of slaves. */
#include "api.h"

#define OBJECTS		500
#define WAIT_CYCLES	20000

static struct bench b;
static ec_sdo_info_request_t *req;

static void at_once(void)
{
	ec_master_t *m = CALL(ecrt_open_master)(0);
	static uint16_t list[OBJECTS];
	ec_sdo_object_info_t object;
	ec_sdo_entry_info_t entry;
	uint32_t abort = 1;
	size_t n = 0;

	NEED(m);
	IS(CALL(ecrt_master_sdo_info_list)(m, MOTOR, 1, list, OBJECTS, &n, &abort), 0);
	YES(n > 10 && list[0] == 0x1000);
	IS(abort, 0);
	SAYS(CALL(ecrt_master_sdo_info_list)(m, MOTOR, 1, list, 2, &n, &abort), -ENOBUFS);
	SAYS(CALL(ecrt_master_sdo_info_list)(m, MOTOR, 6, list, 2, &n, &abort), -EINVAL);
	IS(CALL(ecrt_master_sdo_info_object)(m, MOTOR, 0x1018, &object, &abort), 0);
	IS(object.max_subindex, 4);
	IS(object.object_code, 9);
	IS(CALL(ecrt_master_sdo_info_forget)(m, MOTOR), 0);
	SAYS(CALL(ecrt_master_sdo_info_forget)(m, NOWHERE), -EINVAL);
	IS(CALL(ecrt_master_sdo_info_entry)(m, MOTOR, 0x1018, 4, &entry, &abort), 0);
	IS(entry.bit_length, 32);
	YES(*entry.name && *object.name);
	SAYS(CALL(ecrt_master_sdo_info_object)(m, MOTOR, 0x3fff, &object, &abort), -EIO);
	IS(abort, 0x06020000);
	SAYS(CALL(ecrt_master_sdo_info_entry)(m, OUT, 0x1018, 4, &entry, &abort),
	     -EPROTONOSUPPORT);
	SAYS(CALL(ecrt_master_sdo_info_entry)(m, NOWHERE, 0x1018, 4, &entry, &abort), -EINVAL);
	CALL(ecrt_release_master)(m);
}

static ec_request_state_t done(void)
{
	for (int i = 0;
	     i < WAIT_CYCLES && CALL(ecrt_sdo_info_request_state)(req) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_sdo_info_request_state)(req);
}

static void requests(void)
{
	ec_sdo_object_info_t object;
	ec_sdo_entry_info_t entry;

	NEED(bench_request(&b) && bench_configure(&b));
	req = CALL(ecrt_slave_config_create_sdo_info_request)(b.motor, 2 * OBJECTS);
	NEED(req);
	IS(CALL(ecrt_sdo_info_request_timeout)(req, 5000), 0);
	SILENT(CALL(ecrt_sdo_info_request_list)(req, 1), -EINVAL);
	NEED(bench_activate(&b) && bench_op(&b));
	SILENT(CALL(ecrt_sdo_info_request_list)(req, 1), 0);
	SILENT(CALL(ecrt_sdo_info_request_object)(req, 0x1018), -EBUSY);
	IS(done(), EC_REQUEST_SUCCESS);
	YES(CALL(ecrt_sdo_info_request_data_size)(req) > 20);
	IS(EC_READ_U16(CALL(ecrt_sdo_info_request_data)(req)), 0x1000);
	SILENT(CALL(ecrt_sdo_info_request_object)(req, 0x1018), 0);
	IS(done(), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_sdo_info_request_get_object)(req, &object), 0);
	IS(object.max_subindex, 4);
	SILENT(CALL(ecrt_sdo_info_request_entry)(req, 0x1018, 1), 0);
	IS(done(), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_sdo_info_request_get_entry)(req, &entry), 0);
	IS(entry.bit_length, 32);
	SILENT(CALL(ecrt_sdo_info_request_object)(req, 0x3fff), 0);
	IS(done(), EC_REQUEST_ERROR);
	IS(CALL(ecrt_sdo_info_request_abort_code)(req), 0x06020000);
	SILENT(CALL(ecrt_sdo_info_request_cancel)(req), 0);
	bench_down(&b);
}

const struct api_case dict_cases[] = {
	{ "object dictionary at once", at_once },
	{ "requests for the object dictionary", requests },
	{ NULL, NULL },
};
