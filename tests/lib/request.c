// SPDX-License-Identifier: LGPL-2.1-or-later
/* Requests and emergencies: what the library writes to and reads from memory. */
#include "session.h"

#include <errno.h>
#include <string.h>

static struct ec_emerg_ring *ring(unsigned int i)
{
	struct ec_request_area *area = (void *)fake.area;

	return (struct ec_emerg_ring *)(fake.area + area->rings) + i;
}

static void done(struct ec_request_record *rec, int result, const char *data)
{
	rec->result = result;
	rec->got = (unsigned int)strlen(data);
	memcpy(fake.area + rec->data, data, strlen(data));
	rec->done = rec->start;
}

static void nobody(void)
{
	uint8_t b[8];

	CHECK(!ecrt_slave_config_create_sdo_request(NULL, 0, 0, 1));
	CHECK(!ecrt_slave_config_create_reg_request(NULL, 1));
	CHECK(ecrt_sdo_request_index(NULL, 0, 0) == -EINVAL);
	CHECK(ecrt_sdo_request_timeout(NULL, 0) == -EINVAL);
	CHECK(!ecrt_sdo_request_data(NULL) && !ecrt_reg_request_data(NULL));
	CHECK(!ecrt_sdo_request_data_size(NULL));
	CHECK(ecrt_sdo_request_read(NULL) == -EINVAL);
	CHECK(ecrt_sdo_request_write(NULL) == -EINVAL);
	CHECK(ecrt_sdo_request_state(NULL) == EC_REQUEST_ERROR);
	CHECK(ecrt_sdo_request_cancel(NULL) == -EINVAL);
	CHECK(ecrt_soe_request_cancel(NULL) == -EINVAL);
	CHECK(ecrt_reg_request_read(NULL, 0, 1) == -EINVAL);
	CHECK(ecrt_reg_request_write(NULL, 0, 1) == -EINVAL);
	CHECK(ecrt_reg_request_readwrite(NULL, 0, 1) == -EINVAL);
	CHECK(!ecrt_slave_config_create_sdo_request_complete(NULL, 0, 1));
	CHECK(ecrt_sdo_request_index_complete(NULL, 0) == -EINVAL);
	CHECK(ecrt_sdo_request_write_with_size(NULL, 1) == -EINVAL);
	CHECK(ecrt_reg_request_state(NULL) == EC_REQUEST_ERROR);
	CHECK(!ecrt_master_create_datagram_request(NULL, 1) && errno == EINVAL);
	CHECK(!ecrt_datagram_request_data(NULL));
	CHECK(ecrt_datagram_request_send(NULL, EC_DATAGRAM_NOP, 0, 1) == -EINVAL);
	CHECK(ecrt_datagram_request_state(NULL) == EC_REQUEST_ERROR);
	CHECK(!ecrt_datagram_request_working_counter(NULL));
	CHECK(ecrt_slave_config_emerg_size(NULL, 1) == -EINVAL);
	CHECK(ecrt_slave_config_emerg_pop(NULL, b) == -EINVAL);
	CHECK(ecrt_slave_config_emerg_clear(NULL) == -EINVAL);
	CHECK(ecrt_slave_config_emerg_overruns(NULL) == -EINVAL);
}

static ec_sdo_request_t *other;

static void start_other(void)
{
	CHECK(!ecrt_sdo_request_read(other));
}

static void sdo(ec_master_t *m, ec_sdo_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 0);
	unsigned int calls = fake.calls;

	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_UNUSED);
	EC_WRITE_U32(ecrt_sdo_request_data(r), 0x12345678);
	CHECK(!ecrt_sdo_request_write(r));
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_BUSY);
	CHECK(ecrt_sdo_request_write(r) == -EBUSY);
	CHECK(ecrt_sdo_request_read(r) == -EBUSY);
	CHECK(ecrt_sdo_request_index(r, 1, 1) == -EBUSY);
	CHECK(rec->index == 0x6060 && rec->subindex == 3 && rec->op == 1);
	CHECK(rec->size == 4 && rec->start == 1 && rec->timeout_ms == 500);
	CHECK(EC_READ_U32(fake.area + rec->data) == 0x12345678);
	CHECK(fake.calls == calls);
	CHECK(!ecrt_master_send(m) && fake.send_flags == EC_SEND_FLAG_REQUESTS);
	CHECK(!ecrt_master_send(m) && !fake.send_flags);
	calls = fake.calls;
	done(rec, -EIO, "");
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_ERROR);
	CHECK(ecrt_sdo_request_data_size(r) == 4);

	CHECK(!ecrt_sdo_request_index(r, 0x1008, 0) && !ecrt_sdo_request_read(r));
	CHECK(rec->index == 0x1008 && !rec->op && rec->start == 2);
	done(rec, 0, "ab");
	CHECK(!memcmp(ecrt_sdo_request_data(r), "\x78\x56", 2));
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_sdo_request_data_size(r) == 2);
	CHECK(!memcmp(ecrt_sdo_request_data(r), "ab", 2));

	/* a short read shortens the next write */
	CHECK(!ecrt_sdo_request_write(r) && rec->size == 2);
	done(rec, 0, "");
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_sdo_request_data_size(r) == 2);
	CHECK(!ecrt_sdo_request_read(r));
	done(rec, 0, "");
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_sdo_request_write(r) == -EINVAL);	/* 0 bytes */
	CHECK(fake.calls == calls);

	/* the send that another thread is in does not tell of a start, the next one does */
	CHECK(!ecrt_master_send(m));
	other = r;
	fake.beside = start_other;
	CHECK(!ecrt_master_send(m) && !fake.send_flags);
	CHECK(!ecrt_master_send(m) && fake.send_flags == EC_SEND_FLAG_REQUESTS);
	CHECK(!ecrt_master_send(m) && !fake.send_flags);
	done(rec, 0, "");
}

/* @r is of request 2, of a whole object */
static void complete(ec_sdo_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 2);

	CHECK(!ecrt_sdo_request_read(r));
	CHECK(rec->index == 0x1c12 && !rec->subindex && !rec->op &&
	      rec->flags == EC_SDO_FLAG_COMPLETE);
	CHECK(ecrt_sdo_request_index_complete(r, 1) == -EBUSY);
	CHECK(ecrt_sdo_request_write_with_size(r, 4) == -EBUSY);
	CHECK(ecrt_sdo_request_data_size(r) == 16);
	done(rec, 0, "ab");
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_sdo_request_data_size(r) == 2);
	CHECK(ecrt_sdo_request_write_with_size(r, 0) == -EINVAL);
	CHECK(ecrt_sdo_request_write_with_size(r, 17) == -ENOBUFS);
	memcpy(ecrt_sdo_request_data(r), "0123456789", 10);
	CHECK(!ecrt_sdo_request_write_with_size(r, 10));
	CHECK(rec->size == 10 && rec->op == EC_REQUEST_OP_WRITE);
	CHECK(!memcmp(fake.area + rec->data, "0123456789", 10));
	CHECK(ecrt_sdo_request_data_size(r) == 10);
	done(rec, 0, "");
	CHECK(!ecrt_sdo_request_index(r, 0x1018, 1));
	CHECK(!ecrt_sdo_request_read(r) && !rec->flags && rec->subindex == 1);
	done(rec, 0, "");
	CHECK(!ecrt_sdo_request_index_complete(r, 0x1c13));
	CHECK(!ecrt_sdo_request_read(r) && !rec->subindex &&
	      rec->index == 0x1c13 && rec->flags == EC_SDO_FLAG_COMPLETE);
}

/* @r is of request 2 and BUSY */
static void cancel(ec_master_t *m, ec_sdo_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 2);
	unsigned int calls;

	CHECK(!ecrt_master_send(m) && fake.send_flags == EC_SEND_FLAG_REQUESTS);
	calls = fake.calls;
	CHECK(!ecrt_sdo_request_cancel(r) && rec->cancel == rec->start);
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_BUSY && fake.calls == calls);
	CHECK(!ecrt_master_send(m) && fake.send_flags == EC_SEND_FLAG_REQUESTS);
	done(rec, -ECANCELED, "");
	CHECK(ecrt_sdo_request_state(r) == EC_REQUEST_ERROR);
	/* nothing to cancel any more, and the next start is another one */
	CHECK(!ecrt_sdo_request_cancel(r));
	CHECK(!ecrt_master_send(m) && !fake.send_flags);
	CHECK(!ecrt_sdo_request_read(r) && rec->cancel != rec->start);
}

static void reg(ec_reg_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 1);

	CHECK(ecrt_reg_request_state(r) == EC_REQUEST_UNUSED);
	CHECK(ecrt_reg_request_read(r, 0x10, 0) == -EINVAL);
	CHECK(ecrt_reg_request_read(r, 0x10, 3) == -ENOBUFS);
	CHECK(ecrt_reg_request_write(r, 0x10, 3) == -ENOBUFS);
	CHECK(!ecrt_reg_request_read(r, 0x110, 2));
	CHECK(rec->index == 0x110 && rec->size == 2 && !rec->op);
	CHECK(ecrt_reg_request_write(r, 0x10, 1) == -EBUSY);
	done(rec, 0, "xy");
	CHECK(ecrt_reg_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(!memcmp(ecrt_reg_request_data(r), "xy", 2));
	CHECK(!ecrt_reg_request_write(r, 0x12, 1) && rec->op == 1);
	CHECK(ecrt_reg_request_readwrite(r, 0x14, 1) == -EBUSY);
	CHECK(rec->index == 0x12);
	done(rec, 0, "");
	CHECK(ecrt_reg_request_readwrite(r, 0x14, 3) == -ENOBUFS);
	memcpy(ecrt_reg_request_data(r), "no", 2);
	CHECK(!ecrt_reg_request_readwrite(r, 0x14, 2) && rec->index == 0x14 &&
	      rec->op == EC_REQUEST_OP_READWRITE);
	CHECK(!memcmp(fake.area + rec->data, "no", 2));
	done(rec, 0, "ok");
	CHECK(ecrt_reg_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(!memcmp(ecrt_reg_request_data(r), "ok", 2));
}

/* @r is of request 3, 2 bytes */
static void datagram(ec_datagram_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 3);
	unsigned int calls = fake.calls;

	CHECK(ecrt_datagram_request_state(r) == EC_REQUEST_UNUSED);
	CHECK(ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 0) == -EINVAL);
	CHECK(ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 3) == -ENOBUFS);
	CHECK(ecrt_datagram_request_send(r, (ec_datagram_command_t)15, 0, 1) == -EINVAL);
	CHECK(ecrt_datagram_request_send(r, (ec_datagram_command_t)-1, 0, 1) == -EINVAL);
	CHECK(!rec->start);
	memcpy(ecrt_datagram_request_data(r), "ab", 2);
	CHECK(!ecrt_datagram_request_send(r, EC_DATAGRAM_FRMW, EC_DATAGRAM_STATION(0x1001, 0x910),
					  2));
	CHECK(rec->subindex == 14 && rec->vendor_id == 0x09101001 && rec->size == 2);
	CHECK(rec->op == EC_REQUEST_OP_READWRITE && !rec->flags && !rec->timeout_ms);
	CHECK(!memcmp(fake.area + rec->data, "ab", 2));
	CHECK(ecrt_datagram_request_send(r, EC_DATAGRAM_NOP, 0, 2) == -EBUSY);
	CHECK(rec->subindex == 14 && ecrt_datagram_request_state(r) == EC_REQUEST_BUSY);
	rec->got_type = 7;
	CHECK(!ecrt_datagram_request_working_counter(r));
	done(rec, 0, "xy");
	CHECK(ecrt_datagram_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_datagram_request_working_counter(r) == 7);
	CHECK(!memcmp(ecrt_datagram_request_data(r), "xy", 2));
	CHECK(!ecrt_datagram_request_send(r, EC_DATAGRAM_APRD, EC_DATAGRAM_POSITION(2, 0x130), 1));
	CHECK(rec->vendor_id == 0x0130fffe && rec->size == 1);
	done(rec, -ETIMEDOUT, "");
	CHECK(ecrt_datagram_request_state(r) == EC_REQUEST_ERROR);
	CHECK(!ecrt_datagram_request_working_counter(r) && fake.calls == calls);
	CHECK(EC_DATAGRAM_ALL(0x120) == 0x01200000);
}

static void emergencies(ec_slave_config_t *sc)
{
	struct ec_emerg_ring *r = ring(5);
	unsigned int calls = fake.calls;
	uint8_t b[8];

	CHECK(ecrt_slave_config_emerg_pop(sc, b) == -ENOENT);
	memcpy(fake.area + r->data, "01234567abcdefgh", 16);
	r->head = 2;
	r->overruns = 3;
	CHECK(!ecrt_slave_config_emerg_pop(sc, b) && !memcmp(b, "01234567", 8));
	CHECK(!ecrt_slave_config_emerg_pop(sc, b) && !memcmp(b, "abcdefgh", 8));
	CHECK(ecrt_slave_config_emerg_pop(sc, b) == -ENOENT && r->tail == 2);
	CHECK(ecrt_slave_config_emerg_overruns(sc) == 3);
	r->head = 4;
	CHECK(!ecrt_slave_config_emerg_clear(sc) && r->tail == 4);
	CHECK(ecrt_slave_config_emerg_overruns(sc) == 0);
	CHECK(ecrt_slave_config_emerg_pop(sc, b) == -ENOENT);
	r->overruns = 4;
	CHECK(ecrt_slave_config_emerg_overruns(sc) == 1);
	CHECK(fake.calls == calls);
}

void requests(void)
{
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 1, 2);
	ec_sdo_request_t *s = ecrt_slave_config_create_sdo_request(sc, 0x6060, 3, 4);
	ec_reg_request_t *r = ecrt_slave_config_create_reg_request(sc, 2);
	ec_sdo_request_t *c =
		ecrt_slave_config_create_sdo_request_complete(sc, 0x1c12, 16);
	ec_datagram_request_t *d = ecrt_master_create_datagram_request(m, 2);
	const uint8_t *data = ecrt_sdo_request_data(s);
	uint8_t b[8];

	nobody();
	CHECK(s && r && c && d && ecrt_sdo_request_data_size(s) == 4);
	CHECK(data && !EC_READ_U32(data));
	CHECK(!ecrt_sdo_request_timeout(s, 500));
	CHECK(ecrt_sdo_request_read(s) == -EINVAL);	/* not active */
	CHECK(ecrt_sdo_request_cancel(s) == -EINVAL);
	CHECK(ecrt_reg_request_read(r, 0, 2) == -EINVAL);
	CHECK(ecrt_datagram_request_send(d, EC_DATAGRAM_BRD, 0, 2) == -EINVAL);
	CHECK(!ecrt_slave_config_emerg_size(sc, 2));
	CHECK(ecrt_slave_config_emerg_pop(sc, b) == -ENOENT);
	CHECK(ecrt_slave_config_emerg_overruns(sc) == 0);
	fake.refuse = EC_IOC_SC_REQUEST;
	fake.err = ENOSPC;
	CHECK(!ecrt_slave_config_create_sdo_request(sc, 1, 2, 3) &&
	      errno == ENOSPC);
	fake.refuse = 0;
	CHECK(!ecrt_master_activate(m));
	sdo(m, s);
	CHECK(ecrt_sdo_request_data(s) == data);
	reg(r);
	datagram(d);
	complete(c);
	cancel(m, c);
	emergencies(sc);
	CHECK(!ecrt_master_deactivate(m));
	ecrt_release_master(m);
}
