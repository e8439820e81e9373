// SPDX-License-Identifier: GPL-2.0-only
/* IDNs, VoE messages, whole objects, registers written and read in one. */
#include "api.h"

#define WAIT_CYCLES	20000
#define VOE_TYPE	0x4321	/* of the answers of the drive, see api.bats */
#define P(n)		(0x8000 | (n))

static struct bench b;
static ec_soe_request_t *soe, *small, *lost;
static ec_voe_handler_t *voe, *other, *without;
static ec_sdo_request_t *whole;
static ec_reg_request_t *reg;
static ec_datagram_request_t *datagram;

/* of a master that is only open, or reserved */
static void at_once(void)
{
	uint8_t data[32] = { 0 };
	uint16_t error = 1;
	size_t size = 0;

	NEED(bench_request(&b));
	IS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 1, 91, data, 4, &size, &error), 0);
	IS(size, 4);
	IS(error, 0);
	IS(EC_READ_U32(data), 3000);
	EC_WRITE_U32(data, 2000);
	IS(CALL(ecrt_master_write_idn)(b.m, MOTOR, 1, 91, data, 4, &error), 0);
	IS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 1, 91, data, 4, &size, NULL), 0);
	IS(EC_READ_U32(data), 2000);
	/* a text: length, largest length, characters */
	IS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 0, 30, data, sizeof(data), &size, &error), 0);
	IS(size, 11);
	YES(!memcmp(data, "\x07\0\x10\0SIM 1.0", 11));

	size = 99;
	SAYS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 0, 92, data, 4, &size, &error), -EIO);
	IS(error, 0x1001);
	IS(size, 99);
	SAYS(CALL(ecrt_master_write_idn)(b.m, MOTOR, 0, 30, data, 4, &error), -EIO);
	IS(error, 0x7004);
	SAYS(CALL(ecrt_master_write_idn)(b.m, MOTOR, 0, 91, data, 3, NULL), -EIO);
	SAYS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 0, 91, data, 3, &size, &error), -ENOBUFS);
	SAYS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 0, 91, data, 0, &size, &error), -ENOBUFS);
	SAYS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 8, 91, data, 4, &size, &error), -EINVAL);
	SAYS(CALL(ecrt_master_write_idn)(b.m, MOTOR, 8, 91, data, 4, &error), -EINVAL);
	SAYS(CALL(ecrt_master_read_idn)(b.m, NOWHERE, 0, 91, data, 4, &size, &error), -EINVAL);
	SAYS(CALL(ecrt_master_read_idn)(b.m, SERVO, 0, 91, data, 4, &size, &error),
	     -EPROTONOSUPPORT);
	IS(CALL(ecrt_master_read_idn)(b.m, MOTOR, 0, 91, data, 4, NULL, &error), -EINVAL);
	bench_down(&b);
}

/* in PREOP and in SAFEOP; P-0-0170 can be written in one of them only */
static void startup(void)
{
	uint8_t data[2];

	EC_WRITE_U16(data, 6);
	IS(CALL(ecrt_slave_config_idn)(b.motor, 0, 15, EC_AL_STATE_PREOP, data, 2), 0);
	EC_WRITE_U16(data, 0x5aa5);
	IS(CALL(ecrt_slave_config_idn)(b.motor, 1, P(170), EC_AL_STATE_SAFEOP, data, 2), 0);
	SAYS(CALL(ecrt_slave_config_idn)(b.motor, 8, 15, EC_AL_STATE_PREOP, data, 2), -EINVAL);
	SAYS(CALL(ecrt_slave_config_idn)(b.motor, 0, 15, EC_AL_STATE_OP, data, 2), -EINVAL);
	SAYS(CALL(ecrt_slave_config_idn)(b.motor, 0, 15, EC_AL_STATE_PREOP, data, 0), -EINVAL);
	SAYS(CALL(ecrt_slave_config_idn)(b.motor, 0, 15, EC_AL_STATE_PREOP, NULL, 2), -EINVAL);
}

static void before(void)
{
	ec_slave_config_t *nobody;

	NEED(bench_request(&b) && bench_configure(&b));
	startup();
	nobody = CALL(ecrt_master_slave_config)(b.m, 0, NOWHERE, BECKHOFF, EL7201);
	soe = CALL(ecrt_slave_config_create_soe_request)(b.motor, 0, 91, 8);
	small = CALL(ecrt_slave_config_create_soe_request)(b.motor, 0, 91, 2);
	lost = CALL(ecrt_slave_config_create_soe_request)(nobody, 0, 91, 4);
	voe = CALL(ecrt_slave_config_create_voe_handler)(b.motor, 16);
	other = CALL(ecrt_slave_config_create_voe_handler)(b.motor, 4);
	without = CALL(ecrt_slave_config_create_voe_handler)(b.out, 4);
	whole = CALL(ecrt_slave_config_create_sdo_request_complete)(b.motor, 0x1018, 32);
	reg = CALL(ecrt_slave_config_create_reg_request)(b.motor, 4);
	datagram = CALL(ecrt_master_create_datagram_request)(b.m, 4);
	NEED(soe && small && lost && voe && other && without && whole && reg && datagram);
	SAYS(CALL(ecrt_master_create_datagram_request)(b.m, 0) != NULL, 0);
	SAYS(CALL(ecrt_master_create_datagram_request)(b.m, 1487) != NULL, 0);
	SAYS(CALL(ecrt_slave_config_create_soe_request)(b.motor, 8, 91, 8) != NULL, 0);

	IS(CALL(ecrt_soe_request_state)(soe), EC_REQUEST_UNUSED);
	IS(CALL(ecrt_soe_request_data_size)(soe), 8);
	YES(CALL(ecrt_soe_request_data)(soe) && !CALL(ecrt_soe_request_data)(soe)[7]);
	IS(CALL(ecrt_soe_request_timeout)(soe, 5000), 0);
	IS(CALL(ecrt_soe_request_timeout)(lost, 100), 0);
	IS(CALL(ecrt_soe_request_idn)(soe, 1, 91), 0);
	SILENT(CALL(ecrt_soe_request_read)(soe), -EINVAL);
	SILENT(CALL(ecrt_soe_request_write)(soe), -EINVAL);
	IS(CALL(ecrt_voe_handler_execute)(voe), EC_REQUEST_UNUSED);
	IS(CALL(ecrt_voe_handler_data_size)(voe), 16);
	SILENT(CALL(ecrt_voe_handler_read)(voe), -EINVAL);
	SILENT(CALL(ecrt_voe_handler_read_nosync)(voe), -EINVAL);
	SILENT(CALL(ecrt_voe_handler_write)(voe, 1), -EINVAL);
	SILENT(CALL(ecrt_reg_request_readwrite)(reg, 0x0420, 2), -EINVAL);
	NEED(bench_activate(&b) && bench_op(&b));
}

static ec_request_state_t soe_done(ec_soe_request_t *req)
{
	for (int i = 0; i < WAIT_CYCLES && CALL(ecrt_soe_request_state)(req) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_soe_request_state)(req);
}

static ec_request_state_t voe_done(ec_voe_handler_t *v)
{
	for (int i = 0; i < WAIT_CYCLES && CALL(ecrt_voe_handler_execute)(v) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_voe_handler_execute)(v);
}

static void soe_requests(void)
{
	uint8_t *data = CALL(ecrt_soe_request_data)(soe);

	NEED(b.data);
	SILENT(CALL(ecrt_soe_request_read)(soe), 0);
	SILENT(CALL(ecrt_soe_request_read)(soe), -EBUSY);
	SILENT(CALL(ecrt_soe_request_write)(soe), -EBUSY);
	SILENT(CALL(ecrt_soe_request_idn)(soe, 0, 91), -EBUSY);
	IS(soe_done(soe), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_soe_request_data_size)(soe), 4);
	IS(EC_READ_U32(data), 2000);
	EC_WRITE_U32(data, 1500);
	IS(CALL(ecrt_soe_request_write)(soe), 0);
	EC_WRITE_U32(data, 0);	/* it was copied */
	IS(soe_done(soe), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_soe_request_read)(soe), 0);
	IS(soe_done(soe), EC_REQUEST_SUCCESS);
	IS(EC_READ_U32(data), 1500);
	/* what was written at startup */
	IS(CALL(ecrt_soe_request_idn)(soe, 0, 15), 0);
	IS(CALL(ecrt_soe_request_read)(soe), 0);
	IS(soe_done(soe), EC_REQUEST_SUCCESS);
	IS(EC_READ_U16(data), 6);
	IS(CALL(ecrt_soe_request_idn)(soe, 1, P(170)), 0);
	IS(CALL(ecrt_soe_request_read)(soe), 0);
	IS(soe_done(soe), EC_REQUEST_SUCCESS);
	IS(EC_READ_U16(data), 0x5aa5);
	/* no such drive, no such IDN, too large, nobody there */
	SILENT(CALL(ecrt_soe_request_idn)(soe, 8, 15), -EINVAL);
	IS(CALL(ecrt_soe_request_idn)(soe, 2, 15), 0);
	IS(CALL(ecrt_soe_request_read)(soe), 0);
	IS(soe_done(soe), EC_REQUEST_ERROR);
	IS(CALL(ecrt_soe_request_idn)(soe, 0, 92), 0);
	IS(CALL(ecrt_soe_request_read)(soe), 0);
	IS(soe_done(soe), EC_REQUEST_ERROR);
	IS(CALL(ecrt_soe_request_read)(small), 0);
	IS(soe_done(small), EC_REQUEST_ERROR);
	IS(CALL(ecrt_soe_request_read)(lost), 0);
	IS(soe_done(lost), EC_REQUEST_ERROR);
	IS(CALL(ecrt_soe_request_timeout)(lost, 0), 0);
	IS(CALL(ecrt_soe_request_read)(lost), 0);
	SILENT(CALL(ecrt_soe_request_cancel)(lost), 0);
	IS(soe_done(lost), EC_REQUEST_ERROR);
}

/* the drive sends each message back, with a type of its own */
static void voe_messages(void)
{
	uint8_t *data = CALL(ecrt_voe_handler_data)(voe);
	uint32_t vendor = 1;
	uint16_t type = 1;

	NEED(b.data && data);
	IS(CALL(ecrt_voe_handler_received_header)(voe, &vendor, &type), 0);
	IS(vendor, 0);
	IS(CALL(ecrt_voe_handler_send_header)(voe, 0xec51, 0x1234), 0);
	memcpy(data, "hello, drive", 12);
	SILENT(CALL(ecrt_voe_handler_write)(voe, 17), -ENOBUFS);
	SILENT(CALL(ecrt_voe_handler_write)(voe, 12), 0);
	SILENT(CALL(ecrt_voe_handler_write)(voe, 12), -EBUSY);
	SILENT(CALL(ecrt_voe_handler_read)(voe), -EBUSY);
	memset(data, 0, 12);
	IS(voe_done(voe), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_voe_handler_data_size)(voe), 12);
	SILENT(CALL(ecrt_voe_handler_read)(voe), 0);
	IS(voe_done(voe), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_voe_handler_data_size)(voe), 12);
	YES(!memcmp(data, "hello, drive", 12));
	IS(CALL(ecrt_voe_handler_received_header)(voe, &vendor, &type), 0);
	IS(vendor, 0xec51);
	IS(type, VOE_TYPE);
	/* without a look first: it must be there by then */
	IS(CALL(ecrt_voe_handler_write)(voe, 2), 0);
	IS(voe_done(voe), EC_REQUEST_SUCCESS);
	bench_cycle(&b, 100);
	SILENT(CALL(ecrt_voe_handler_read_nosync)(voe), 0);
	IS(voe_done(voe), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_voe_handler_data_size)(voe), 2);
	SILENT(CALL(ecrt_voe_handler_read_nosync)(voe), 0);
	IS(voe_done(voe), EC_REQUEST_ERROR);
	SILENT(CALL(ecrt_voe_handler_read)(voe), 0);
	IS(voe_done(voe), EC_REQUEST_ERROR);
	/* one handler sends, another reads: more than it has room for, then less */
	IS(CALL(ecrt_voe_handler_write)(voe, 5), 0);
	IS(voe_done(voe), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_voe_handler_read)(other), 0);
	IS(voe_done(other), EC_REQUEST_ERROR);
	IS(CALL(ecrt_voe_handler_read)(other), 0);
	IS(CALL(ecrt_voe_handler_write)(voe, 3), 0);
	IS(voe_done(other), EC_REQUEST_SUCCESS);
	IS(voe_done(voe), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_voe_handler_data_size)(other), 3);
	/* a slave without VoE */
	IS(CALL(ecrt_voe_handler_read)(without), 0);
	IS(voe_done(without), EC_REQUEST_ERROR);
}

static ec_request_state_t whole_done(void)
{
	for (int i = 0; i < WAIT_CYCLES && CALL(ecrt_sdo_request_state)(whole) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_sdo_request_state)(whole);
}

/* count as two bytes, then four values */
static void whole_objects(void)
{
	uint8_t *data = CALL(ecrt_sdo_request_data)(whole);

	NEED(b.data);
	IS(CALL(ecrt_sdo_request_read)(whole), 0);
	IS(whole_done(), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_sdo_request_data_size)(whole), 18);
	IS(data[0], 4);
	IS(EC_READ_U32(data + 14), 77);
	/* one entry, in its own size; the one read before does not matter */
	IS(CALL(ecrt_sdo_request_index)(whole, 0x2001, 8), 0);
	SILENT(CALL(ecrt_sdo_request_write_with_size)(whole, 0), -EINVAL);
	SILENT(CALL(ecrt_sdo_request_write_with_size)(whole, 33), -ENOBUFS);
	EC_WRITE_U32(data, 0xabcd1234);
	IS(CALL(ecrt_sdo_request_write_with_size)(whole, 4), 0);
	IS(CALL(ecrt_sdo_request_data_size)(whole), 4);
	SILENT(CALL(ecrt_sdo_request_index_complete)(whole, 0x1018), -EBUSY);
	IS(whole_done(), EC_REQUEST_SUCCESS);
	EC_WRITE_U32(data, 0);
	IS(CALL(ecrt_sdo_request_read)(whole), 0);
	IS(whole_done(), EC_REQUEST_SUCCESS);
	IS(EC_READ_U32(data), 0xabcd1234);
	IS(CALL(ecrt_sdo_request_index_complete)(whole, 0x1018), 0);
	IS(CALL(ecrt_sdo_request_read)(whole), 0);
	IS(whole_done(), EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_sdo_request_data_size)(whole), 18);
}

static ec_request_state_t reg_done(void)
{
	for (int i = 0; i < WAIT_CYCLES && CALL(ecrt_reg_request_state)(reg) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_reg_request_state)(reg);
}

static void readwrite(void)
{
	uint8_t *data = CALL(ecrt_reg_request_data)(reg);

	NEED(b.data);
	EC_WRITE_U16(data, 1111);
	IS(CALL(ecrt_reg_request_write)(reg, 0x0420, 2), 0);
	IS(reg_done(), EC_REQUEST_SUCCESS);
	EC_WRITE_U16(data, 2222);
	SILENT(CALL(ecrt_reg_request_readwrite)(reg, 0x0420, 2), 0);
	SILENT(CALL(ecrt_reg_request_readwrite)(reg, 0x0420, 2), -EBUSY);
	IS(reg_done(), EC_REQUEST_SUCCESS);
	IS(EC_READ_U16(data), 1111);
	IS(CALL(ecrt_reg_request_read)(reg, 0x0420, 2), 0);
	IS(reg_done(), EC_REQUEST_SUCCESS);
	IS(EC_READ_U16(data), 2222);
	SILENT(CALL(ecrt_reg_request_readwrite)(reg, 0x0420, 5), -ENOBUFS);
	SILENT(CALL(ecrt_reg_request_readwrite)(reg, 0x0420, 0), -EINVAL);
}

static ec_request_state_t datagram_done(ec_datagram_command_t command, uint32_t address)
{
	IS(CALL(ecrt_datagram_request_send)(datagram, command, address, 2), 0);
	SILENT(CALL(ecrt_datagram_request_send)(datagram, command, address, 2), -EBUSY);
	for (int i = 0; i < WAIT_CYCLES &&
	     CALL(ecrt_datagram_request_state)(datagram) == EC_REQUEST_BUSY; i++)
		bench_cycle(&b, 1);
	return CALL(ecrt_datagram_request_state)(datagram);
}

/* as the register above, by the ring position */
static void datagrams(void)
{
	uint8_t *data = CALL(ecrt_datagram_request_data)(datagram);

	NEED(b.data);
	EC_WRITE_U16(data, 3333);
	IS(datagram_done(EC_DATAGRAM_APRW, EC_DATAGRAM_POSITION(MOTOR, 0x0420)),
	   EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_datagram_request_working_counter)(datagram), 3);
	IS(EC_READ_U16(data), 2222);
	IS(datagram_done(EC_DATAGRAM_APRD, EC_DATAGRAM_POSITION(MOTOR, 0x0420)),
	   EC_REQUEST_SUCCESS);
	IS(CALL(ecrt_datagram_request_working_counter)(datagram), 1);
	IS(EC_READ_U16(data), 3333);
	SILENT(CALL(ecrt_datagram_request_send)(datagram, EC_DATAGRAM_BRD, 0, 5), -ENOBUFS);
	SILENT(CALL(ecrt_datagram_request_send)(datagram, EC_DATAGRAM_BRD, 0, 0), -EINVAL);
}

static void end(void) { bench_down(&b); }

const struct api_case soe_cases[] = {
	{ "IDNs at once", at_once },
	{ "before activation, IDNs at startup", before },
	{ "SoE requests", soe_requests },
	{ "VoE messages", voe_messages },
	{ "whole objects", whole_objects },
	{ "registers, written and read", readwrite },
	{ "datagrams", datagrams },
	{ "release", end },
	{ NULL, NULL },
};
