// SPDX-License-Identifier: GPL-2.0-only
/* SDO and register requests, emergencies. */
#include "api.h"

#define WAIT_CYCLES	20000

static struct bench b;
static ec_sdo_request_t *sdo, *lost, *small;
static ec_reg_request_t *reg;

static ec_request_state_t sdo_done(ec_sdo_request_t *req)
{
	for (int i = 0; i < WAIT_CYCLES && CALL(ecrt_sdo_request_state)(req) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_sdo_request_state)(req);
}

/* as an application of the patches to the IgH master does it */
static ec_request_state_t reg_done(void)
{
	for (int i = 0; i < WAIT_CYCLES; i++) {
		if (CALL(ecrt_reg_request_state)(reg) != EC_REQUEST_BUSY)
			break;
		CALL(ecrt_master_exec_slave_requests)(b.m);
		bench_cycle(&b, 1);
	}
	return CALL(ecrt_reg_request_state)(reg);
}

static void before(void)
{
	ec_slave_config_t *nobody;

	NEED(bench_request(&b) && bench_configure(&b));
	nobody = CALL(ecrt_master_slave_config)(b.m, 0, NOWHERE, BECKHOFF, EL7201);
	sdo = CALL(ecrt_slave_config_create_sdo_request)(b.motor, 0x1018, 4, 8);
	small = CALL(ecrt_slave_config_create_sdo_request)(b.motor, 0x1018, 4, 2);
	lost = CALL(ecrt_slave_config_create_sdo_request)(nobody, 0x1018, 4, 4);
	reg = CALL(ecrt_slave_config_create_reg_request)(b.motor, 4);
	NEED(sdo && small && lost && reg);
	IS(CALL(ecrt_slave_config_emerg_size)(b.motor, 2), 0);
	IS(CALL(ecrt_master_rt_slave_requests)(b.m, 1), 0);
	IS(CALL(ecrt_master_eoe_is_open)(b.m), 0);
	IS(CALL(ecrt_master_eoe_process)(b.m), 0);
	/* it has no EoE; and no such slave */
	SAYS(CALL(ecrt_master_eoe_addif)(b.m, 0, 0), -EPROTONOSUPPORT);
	SAYS(CALL(ecrt_master_eoe_delif)(b.m, 0, 999), -ENOENT);

	IS(CALL(ecrt_sdo_request_state)(sdo), EC_REQUEST_UNUSED);
	IS(CALL(ecrt_sdo_request_data_size)(sdo), 8);
	YES(CALL(ecrt_sdo_request_data)(sdo) != NULL);
	for (int i = 0; i < 8; i++)
		IS(CALL(ecrt_sdo_request_data)(sdo)[i], 0);
	IS(CALL(ecrt_sdo_request_timeout)(sdo, 5000), 0);
	IS(CALL(ecrt_sdo_request_index)(sdo, 0x1018, 4), 0);
	SILENT(CALL(ecrt_sdo_request_read)(sdo), -EINVAL);
	SILENT(CALL(ecrt_sdo_request_write)(sdo), -EINVAL);
	IS(CALL(ecrt_reg_request_state)(reg), EC_REQUEST_UNUSED);
	YES(CALL(ecrt_reg_request_data)(reg) != NULL);
	SILENT(CALL(ecrt_reg_request_read)(reg, 0x10, 2), -EINVAL);
	SILENT(CALL(ecrt_reg_request_write)(reg, 0x10, 2), -EINVAL);
	NEED(bench_activate(&b) && bench_op(&b));
}

static void sdo_requests(void)
{
	uint8_t *data = CALL(ecrt_sdo_request_data)(sdo);

	NEED(b.data);
	SILENT(CALL(ecrt_sdo_request_read)(sdo), 0);
	IS(CALL(ecrt_sdo_request_state)(sdo), EC_REQUEST_BUSY);
	/* not while it is busy */
	SILENT(CALL(ecrt_sdo_request_read)(sdo), -EBUSY);
	SILENT(CALL(ecrt_sdo_request_write)(sdo), -EBUSY);
	SILENT(CALL(ecrt_sdo_request_index)(sdo, 0x2001, 8), -EBUSY);
	IS(sdo_done(sdo), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_sdo_request_data_size)(sdo), 4);
	IS(EC_READ_U32(data), 77);

	/* a short read shortens what is written; the buffer stays where it is */
	IS(CALL(ecrt_sdo_request_index)(sdo, 0x2001, 8), 0);
	EC_WRITE_U32(data, 0xdeadbeef);
	IS(CALL(ecrt_sdo_request_write)(sdo), 0);
	EC_WRITE_U32(data, 0);	/* it was copied */
	IS(sdo_done(sdo), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_sdo_request_read)(sdo), 0);
	IS(sdo_done(sdo), EC_REQUEST_SUCCESS);
	IS(EC_READ_U32(data), 0xdeadbeef);
	YES(CALL(ecrt_sdo_request_data)(sdo) == data);

	/* no such object, then another try */
	IS(CALL(ecrt_sdo_request_index)(sdo, 0x3fff, 0), 0);
	IS(CALL(ecrt_sdo_request_read)(sdo), 0);
	IS(sdo_done(sdo), EC_REQUEST_ERROR);
	IS(CALL(ecrt_sdo_request_index)(sdo, 0x2001, 8), 0);
	IS(CALL(ecrt_sdo_request_read)(sdo), 0);
	IS(sdo_done(sdo), EC_REQUEST_SUCCESS);

	/* more than the buffer holds */
	IS(CALL(ecrt_sdo_request_read)(small), 0);
	IS(sdo_done(small), EC_REQUEST_ERROR);
	/* all of it goes over the wire: 2 bytes into an object of 4 are refused */
	IS(CALL(ecrt_sdo_request_index)(small, 0x2001, 8), 0);
	IS(CALL(ecrt_sdo_request_data_size)(small), 2);
	IS(CALL(ecrt_sdo_request_write)(small), 0);
	IS(sdo_done(small), EC_REQUEST_ERROR);
	/* nothing to cancel */
	SILENT(CALL(ecrt_sdo_request_cancel)(small), 0);
	IS(CALL(ecrt_sdo_request_state)(small), EC_REQUEST_ERROR);
}

/* A slave that is not there: busy, until the time that was given is over. */
static void absent(void)
{
	NEED(b.data);
	IS(CALL(ecrt_sdo_request_read)(lost), 0);
	bench_cycle(&b, 300);
	IS(CALL(ecrt_sdo_request_state)(lost), EC_REQUEST_BUSY);
	SILENT(CALL(ecrt_sdo_request_cancel)(lost), 0);
	IS(sdo_done(lost), EC_REQUEST_ERROR);
	IS(CALL(ecrt_sdo_request_read)(lost), 0);
	bench_cycle(&b, 50);
	bench_down(&b);
	before();
	NEED(b.data);
	IS(CALL(ecrt_sdo_request_timeout)(lost, 100), 0);
	IS(CALL(ecrt_sdo_request_read)(lost), 0);
	IS(sdo_done(lost), EC_REQUEST_ERROR);
}

static void registers(void)
{
	uint8_t *data = CALL(ecrt_reg_request_data)(reg);

	NEED(b.data);
	SILENT(CALL(ecrt_reg_request_read)(reg, 0x0130, 2), 0);
	IS(CALL(ecrt_reg_request_state)(reg), EC_REQUEST_BUSY);
	SILENT(CALL(ecrt_reg_request_read)(reg, 0x0130, 2), -EBUSY);
	IS(reg_done(), EC_REQUEST_SUCCESS);
	IS(EC_READ_U16(data) & 0x0f, EC_AL_STATE_OP);
	/* the watchdog of the process data, there and back */
	EC_WRITE_U16(data, 1234);
	SILENT(CALL(ecrt_reg_request_write)(reg, 0x0420, 2), 0);
	IS(reg_done(), EC_REQUEST_SUCCESS);
	EC_WRITE_U16(data, 0);
	SILENT(CALL(ecrt_reg_request_read)(reg, 0x0420, 2), 0);
	IS(reg_done(), EC_REQUEST_SUCCESS);
	IS(EC_READ_U16(data), 1234);
	SILENT(CALL(ecrt_reg_request_read)(reg, 0x0130, 5), -ENOBUFS);
	SILENT(CALL(ecrt_reg_request_write)(reg, 0x0130, 5), -ENOBUFS);
	SILENT(CALL(ecrt_reg_request_read)(reg, 0x0130, 0), -EINVAL);
}

/* the segment has an emergency of the drive every 0.2 s */
static void emergencies(void)
{
	uint8_t e[EC_COE_EMERGENCY_MSG_SIZE];
	int ret = -ENOENT;

	NEED(b.data);
	IS(CALL(ecrt_slave_config_emerg_clear)(b.motor), 0);
	SILENT(CALL(ecrt_slave_config_emerg_pop)(b.motor, e), -ENOENT);
	for (int i = 0; i < WAIT_CYCLES && ret == -ENOENT; i++) {
		bench_cycle(&b, 1);
		ret = CALL(ecrt_slave_config_emerg_pop)(b.motor, e);
	}
	IS(ret, 0);
	IS(EC_READ_U16(e), 0x8110);
	IS(e[2], 0x11);
	/* two are kept, the rest is lost */
	for (int i = 0; i < WAIT_CYCLES && !CALL(ecrt_slave_config_emerg_overruns)(b.motor); i++)
		bench_cycle(&b, 1);
	YES(CALL(ecrt_slave_config_emerg_overruns)(b.motor) > 0);
	IS(CALL(ecrt_slave_config_emerg_pop)(b.motor, e), 0);
	IS(CALL(ecrt_slave_config_emerg_pop)(b.motor, e), 0);
	IS(CALL(ecrt_slave_config_emerg_pop)(b.motor, e), -ENOENT);
	IS(CALL(ecrt_slave_config_emerg_clear)(b.motor), 0);
	IS(CALL(ecrt_slave_config_emerg_overruns)(b.motor), 0);
	/* a slave that keeps none */
	IS(CALL(ecrt_slave_config_emerg_pop)(b.out, e), -ENOENT);
	IS(CALL(ecrt_slave_config_emerg_overruns)(b.out), 0);
}

static void end(void) { bench_down(&b); }

const struct api_case request_cases[] = {
	{ "before activation", before },
	{ "SDOs", sdo_requests },
	{ "registers", registers },
	{ "emergencies", emergencies },
	{ "an absent slave", absent },
	{ "release", end },
	{ NULL, NULL },
};
