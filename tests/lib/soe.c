// SPDX-License-Identifier: LGPL-2.1-or-later
/* IDNs and VoE messages: arguments, and what goes through mapped memory. */
#include "session.h"

#include <errno.h>
#include <string.h>

static void done(struct ec_request_record *rec, int result, const char *data)
{
	rec->result = result;
	rec->got = (unsigned int)strlen(data);
	memcpy(fake.area + rec->data, data, strlen(data));
	rec->done = rec->start;
}

static void nobody(void)
{
	uint8_t b[2] = { 0 };
	uint16_t type;
	uint32_t id;
	size_t n;

	CHECK(ecrt_master_read_idn(NULL, 0, 0, 1, b, 2, &n, NULL) == -EINVAL);
	CHECK(ecrt_master_write_idn(NULL, 0, 0, 1, b, 2, NULL) == -EINVAL);
	CHECK(ecrt_slave_config_idn(NULL, 0, 1, EC_AL_STATE_PREOP, b, 2) ==
	      -EINVAL);
	CHECK(!ecrt_slave_config_create_soe_request(NULL, 0, 1, 2));
	CHECK(ecrt_soe_request_idn(NULL, 0, 1) == -EINVAL);
	CHECK(ecrt_soe_request_timeout(NULL, 0) == -EINVAL);
	CHECK(!ecrt_soe_request_data(NULL) && !ecrt_soe_request_data_size(NULL));
	CHECK(ecrt_soe_request_state(NULL) == EC_REQUEST_ERROR);
	CHECK(ecrt_soe_request_read(NULL) == -EINVAL);
	CHECK(ecrt_soe_request_write(NULL) == -EINVAL);
	CHECK(!ecrt_slave_config_create_voe_handler(NULL, 2));
	CHECK(ecrt_voe_handler_send_header(NULL, 1, 2) == -EINVAL);
	CHECK(ecrt_voe_handler_received_header(NULL, &id, &type) == -EINVAL);
	CHECK(!ecrt_voe_handler_data(NULL) && !ecrt_voe_handler_data_size(NULL));
	CHECK(ecrt_voe_handler_write(NULL, 1) == -EINVAL);
	CHECK(ecrt_voe_handler_read(NULL) == -EINVAL);
	CHECK(ecrt_voe_handler_read_nosync(NULL) == -EINVAL);
	CHECK(ecrt_voe_handler_execute(NULL) == EC_REQUEST_ERROR);
}

static void at_once(ec_master_t *m)
{
	const struct ec_ioc_soe *arg = (void *)fake.arg;
	uint8_t b[8] = { 1, 2 };
	unsigned int calls;
	uint16_t error = 9;
	size_t n = 99;

	CHECK(!ecrt_master_read_idn(m, 3, 7, 0x8096, b, 8, &n, &error));
	CHECK(arg->slave.position == 3 && arg->drive == 7 && arg->idn == 0x8096 &&
	      arg->size == 8);
	CHECK(n == 2 && EC_READ_U16(b) == 0x1234 && !error);
	CHECK(!ecrt_master_write_idn(m, 3, 1, 15, b, 2, &error));
	CHECK(fake.last == (unsigned int)EC_IOC_SOE_WRITE && arg->idn == 15 &&
	      arg->size == 2);
	calls = fake.calls;
	CHECK(ecrt_master_read_idn(m, 3, 8, 15, b, 8, &n, &error) == -EINVAL);
	CHECK(ecrt_master_read_idn(m, 3, 0, 15, b, 8, NULL, &error) == -EINVAL);
	CHECK(ecrt_master_write_idn(m, 3, 0, 15, NULL, 8, &error) == -EINVAL);
	CHECK(fake.calls == calls);
	fake.refuse = EC_IOC_SOE_READ;
	fake.err = EIO;
	n = 99;
	CHECK(ecrt_master_read_idn(m, 3, 0, 15, b, 8, &n, &error) == -EIO);
	CHECK(error == 0x1001 && n == 99);
	CHECK(ecrt_master_read_idn(m, 3, 0, 15, b, 8, &n, NULL) == -EIO);
	fake.refuse = EC_IOC_SOE_WRITE;
	CHECK(ecrt_master_write_idn(m, 3, 0, 15, b, 2, &error) == -EIO);
	CHECK(error == 0x1001);
	fake.err = ENOENT;
	CHECK(ecrt_master_write_idn(m, 3, 0, 15, b, 2, &error) == -EINVAL);
	CHECK(!error);
	fake.refuse = 0;
}

/* The values are behind one another. */
static void command(ec_slave_config_t *sc)
{
	const struct ec_ioc_sc_command *arg = (void *)fake.arg;
	const uint8_t data[] = { 1, 2 }, expect[] = { 3, 4 }, mask[] = { 5, 6 };
	ec_command_t c = {
		.kind = EC_COMMAND_IDN, .index = 0x8096, .subindex = 3, .size = 2, .data = data,
	};
	unsigned int calls;

	CHECK(!ecrt_slave_config_command(sc, EC_STEP_SO, &c));
	CHECK(arg->config == 5 && arg->from == 4 && arg->to == 8 && arg->kind == EC_REQUEST_SOE);
	CHECK(arg->index == 0x8096 && arg->subindex == 3 && arg->size == 2);
	CHECK(arg->flags == EC_COMMAND_FLAG_WRITE && !memcmp(fake.values, "\1\2", 2));
	c.expect = expect;
	c.kind = EC_COMMAND_SDO;
	c.complete = 1;
	c.timeout_ms = 70;
	CHECK(!ecrt_slave_config_command(sc, EC_STEP_PI, &c));
	CHECK(arg->flags == 7 && arg->size == 6 && arg->timeout_ms == 70 && !arg->kind);
	CHECK(arg->from == 2 && arg->to == 1 && !memcmp(fake.values, "\1\2\3\4\xff\xff", 6));
	c.data = NULL;
	c.complete = 0;
	c.mask = mask;
	c.kind = EC_COMMAND_REG;
	CHECK(!ecrt_slave_config_command(sc, EC_STEP_IB, &c));
	CHECK(arg->flags == EC_COMMAND_FLAG_CHECK && arg->size == 4 && arg->to == 3);
	CHECK(arg->kind == EC_REQUEST_REG && !memcmp(fake.values, "\3\4\5\6", 4));
	calls = fake.calls;
	c.expect = NULL;
	CHECK(ecrt_slave_config_command(sc, EC_STEP_IB, &c) == -EINVAL);
	c.data = data;
	c.size = 0;
	CHECK(ecrt_slave_config_command(sc, EC_STEP_IB, &c) == -EINVAL);
	c.size = 0x10001;
	CHECK(ecrt_slave_config_command(sc, EC_STEP_IB, &c) == -EINVAL);
	c.size = 2;
	c.kind = (ec_command_kind_t)3;
	CHECK(ecrt_slave_config_command(sc, EC_STEP_IB, &c) == -EINVAL);
	CHECK(ecrt_slave_config_command(sc, EC_STEP_IB, NULL) == -EINVAL);
	CHECK(ecrt_slave_config_command(NULL, EC_STEP_IB, &c) == -EINVAL);
	CHECK(fake.calls == calls);
}

static void at_startup(ec_slave_config_t *sc)
{
	const struct ec_ioc_sc_idn *arg = (void *)fake.arg;
	unsigned int calls;
	uint8_t b[2] = { 1, 2 };

	CHECK(!ecrt_slave_config_idn(sc, 1, 0x8096, EC_AL_STATE_SAFEOP, b, 2));
	CHECK(arg->config == 5 && arg->drive == 1 && arg->idn == 0x8096 &&
	      arg->state == 4 && arg->size == 2);
	CHECK(!ecrt_slave_config_idn(sc, 0, 15, EC_AL_STATE_PREOP, b, 2));
	CHECK(arg->state == 2);
	calls = fake.calls;
	CHECK(ecrt_slave_config_idn(sc, 8, 15, EC_AL_STATE_PREOP, b, 2) ==
	      -EINVAL);
	CHECK(ecrt_slave_config_idn(sc, 0, 15, EC_AL_STATE_OP, b, 2) ==
	      -EINVAL);
	CHECK(ecrt_slave_config_idn(sc, 0, 15, EC_AL_STATE_PREOP, NULL, 2) ==
	      -EINVAL);
	CHECK(ecrt_slave_config_idn(sc, 0, 15, EC_AL_STATE_PREOP, b, 0) ==
	      -EINVAL);
	CHECK(!ecrt_slave_config_create_soe_request(sc, 8, 15, 2) &&
	      errno == EINVAL);
	CHECK(fake.calls == calls);
}

static void soe(ec_soe_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 0);
	unsigned int calls = fake.calls;

	CHECK(ecrt_soe_request_state(r) == EC_REQUEST_UNUSED);
	EC_WRITE_U32(ecrt_soe_request_data(r), 0x12345678);
	CHECK(!ecrt_soe_request_write(r));
	CHECK(rec->index == 91 && rec->subindex == 2 && rec->size == 4);
	CHECK(rec->op == EC_REQUEST_OP_WRITE && rec->timeout_ms == 700);
	CHECK(EC_READ_U32(fake.area + rec->data) == 0x12345678);
	CHECK(ecrt_soe_request_write(r) == -EBUSY);
	CHECK(ecrt_soe_request_read(r) == -EBUSY);
	CHECK(ecrt_soe_request_idn(r, 0, 1) == -EBUSY);
	done(rec, -EIO, "");
	CHECK(ecrt_soe_request_state(r) == EC_REQUEST_ERROR);
	CHECK(ecrt_soe_request_idn(r, 8, 1) == -EINVAL);
	CHECK(!ecrt_soe_request_idn(r, 0, 0x8096));
	CHECK(!ecrt_soe_request_read(r));
	CHECK(rec->index == 0x8096 && !rec->subindex && !rec->op);
	done(rec, 0, "ab");
	CHECK(ecrt_soe_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_soe_request_data_size(r) == 2);
	CHECK(!memcmp(ecrt_soe_request_data(r), "ab", 2));
	CHECK(fake.calls == calls);
}

static void voe(ec_master_t *m, ec_voe_handler_t *v)
{
	struct ec_request_record *rec = fake_request(fake.area, 1);
	unsigned int calls = fake.calls;
	uint16_t type = 7;
	uint32_t id = 8;

	CHECK(ecrt_voe_handler_execute(v) == EC_REQUEST_UNUSED);
	CHECK(ecrt_voe_handler_data_size(v) == 6);
	CHECK(!ecrt_voe_handler_received_header(v, &id, &type) && !id && !type);
	CHECK(!ecrt_voe_handler_send_header(v, 0xec51, 0x77));
	CHECK(ecrt_voe_handler_write(v, 7) == -ENOBUFS);
	memcpy(ecrt_voe_handler_data(v), "hello", 5);
	CHECK(!ecrt_voe_handler_write(v, 5));
	CHECK(rec->op == EC_REQUEST_OP_WRITE && rec->size == 5 &&
	      rec->vendor_id == 0xec51 && rec->index == 0x77);
	CHECK(!memcmp(fake.area + rec->data, "hello", 5));
	CHECK(ecrt_voe_handler_execute(v) == EC_REQUEST_BUSY);
	CHECK(ecrt_voe_handler_read(v) == -EBUSY);
	CHECK(fake.calls == calls);
	CHECK(!ecrt_master_send(m) && fake.send_flags == EC_SEND_FLAG_REQUESTS);
	calls = fake.calls;
	done(rec, 0, "");
	CHECK(ecrt_voe_handler_execute(v) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_voe_handler_data_size(v) == 5);

	CHECK(!ecrt_voe_handler_read(v) && rec->op == EC_REQUEST_OP_READ);
	rec->got_vendor_id = 0x1234;
	rec->got_type = 0x56;
	done(rec, 0, "xyz");
	CHECK(!ecrt_voe_handler_received_header(v, &id, &type) && !id);
	CHECK(ecrt_voe_handler_execute(v) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_voe_handler_data_size(v) == 3);
	CHECK(!memcmp(ecrt_voe_handler_data(v), "xyz", 3));
	CHECK(!ecrt_voe_handler_received_header(v, &id, &type) &&
	      id == 0x1234 && type == 0x56);
	CHECK(!ecrt_voe_handler_received_header(v, NULL, NULL));

	/* a failed read leaves header and data of the one before */
	CHECK(!ecrt_voe_handler_read_nosync(v) &&
	      rec->op == EC_REQUEST_OP_READ_NOW);
	rec->got_vendor_id = 0;
	done(rec, -ENOMSG, "");
	CHECK(ecrt_voe_handler_execute(v) == EC_REQUEST_ERROR);
	CHECK(!ecrt_voe_handler_received_header(v, &id, NULL) && id == 0x1234);
	CHECK(ecrt_voe_handler_data_size(v) == 3);
	CHECK(fake.calls == calls);
}

void idns_and_vendor_messages(void)
{
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 1, 2);
	ec_soe_request_t *s = ecrt_slave_config_create_soe_request(sc, 2, 91, 4);
	ec_voe_handler_t *v = ecrt_slave_config_create_voe_handler(sc, 6);

	nobody();
	CHECK(s && v && ecrt_soe_request_data_size(s) == 4);
	CHECK(!EC_READ_U32(ecrt_soe_request_data(s)));
	CHECK(!ecrt_soe_request_timeout(s, 700));
	CHECK(ecrt_soe_request_read(s) == -EINVAL);	/* not active */
	CHECK(ecrt_voe_handler_read(v) == -EINVAL);
	at_once(m);
	command(sc);
	at_startup(sc);
	CHECK(!ecrt_master_activate(m));
	soe(s);
	voe(m, v);
	ecrt_release_master(m);
}
