// SPDX-License-Identifier: LGPL-2.1-or-later
/* Object dictionary: commands and their answers, requests in mapped memory. */
#include "session.h"

#include <errno.h>
#include <string.h>

static void nobody(void)
{
	ec_sdo_object_info_t o;
	ec_sdo_entry_info_t e;
	uint16_t list[2];
	size_t n;

	CHECK(ecrt_master_sdo_info_list(NULL, 0, 1, list, 2, &n, NULL) == -EINVAL);
	CHECK(ecrt_master_sdo_info_object(NULL, 0, 1, &o, NULL) == -EINVAL);
	CHECK(ecrt_master_sdo_info_entry(NULL, 0, 1, 1, &e, NULL) == -EINVAL);
	CHECK(ecrt_master_sdo_info_forget(NULL, 0) == -EINVAL);
	CHECK(!ecrt_slave_config_create_sdo_info_request(NULL, 4));
	CHECK(ecrt_sdo_info_request_list(NULL, 1) == -EINVAL);
	CHECK(ecrt_sdo_info_request_object(NULL, 1) == -EINVAL);
	CHECK(ecrt_sdo_info_request_entry(NULL, 1, 1) == -EINVAL);
	CHECK(ecrt_sdo_info_request_timeout(NULL, 1) == -EINVAL);
	CHECK(ecrt_sdo_info_request_cancel(NULL) == -EINVAL);
	CHECK(!ecrt_sdo_info_request_data(NULL) && !ecrt_sdo_info_request_data_size(NULL));
	CHECK(ecrt_sdo_info_request_state(NULL) == EC_REQUEST_ERROR);
	CHECK(ecrt_sdo_info_request_get_object(NULL, &o) == -EINVAL);
	CHECK(ecrt_sdo_info_request_get_entry(NULL, &e) == -EINVAL);
	CHECK(!ecrt_sdo_info_request_abort_code(NULL));
}

static void lists(ec_master_t *m)
{
	const struct ec_ioc_sdo_info *arg = (void *)fake.arg;
	uint16_t list[4] = { 0 };
	uint32_t abort = 9;
	unsigned int calls;
	size_t n = 99;

	CHECK(!ecrt_master_sdo_info_list(m, 3, 1, list, 4, &n, &abort));
	CHECK(arg->slave.position == 3 && arg->what == EC_SDO_INFO_LIST && arg->index == 1);
	CHECK(arg->size == 8 && n == 2 && list[0] == 0x1000 && list[1] == 0x1018 && !abort);
	CHECK(!ecrt_master_sdo_info_list(m, 3, 1, list, 1 << 20, &n, NULL) && arg->size == 65536);
	calls = fake.calls;
	CHECK(ecrt_master_sdo_info_list(m, 3, 6, list, 4, &n, &abort) == -EINVAL);
	CHECK(ecrt_master_sdo_info_list(m, 3, 1, NULL, 4, &n, &abort) == -EINVAL);
	CHECK(ecrt_master_sdo_info_list(m, 3, 1, list, 4, NULL, &abort) == -EINVAL);
	CHECK(fake.calls == calls);
	fake.refuse = EC_IOC_SDO_INFO;
	fake.err = EIO;
	n = 99;
	CHECK(ecrt_master_sdo_info_list(m, 3, 1, list, 4, &n, &abort) == -EIO);
	CHECK(n == 99 && abort == 0x06020000);
	fake.err = ENOENT;
	CHECK(ecrt_master_sdo_info_list(m, 3, 1, list, 4, &n, &abort) == -EINVAL && !abort);
	fake.refuse = 0;
}

static void descriptions(ec_master_t *m)
{
	const struct ec_ioc_sdo_info *arg = (void *)fake.arg;
	ec_sdo_object_info_t o;
	ec_sdo_entry_info_t e;
	uint32_t abort = 9;

	CHECK(!ecrt_master_sdo_info_object(m, 2, 0x1018, &o, &abort) && !abort);
	CHECK(arg->slave.position == 2 && arg->what == EC_SDO_INFO_OBJECT && arg->index == 0x1018);
	CHECK(o.index == 0x1018 && o.data_type == 0x23 && o.max_subindex == 4 &&
	      o.object_code == 9 && !strcmp(o.name, "Identity"));
	CHECK(!ecrt_master_sdo_info_entry(m, 2, 0x1018, 1, &e, &abort));
	CHECK(arg->what == EC_SDO_INFO_ENTRY && arg->subindex == 1);
	CHECK(e.index == 0x1018 && e.subindex == 1 && e.data_type == 7 && e.bit_length == 32 &&
	      e.access == 7 && !strcmp(e.name, "Vendor"));
	CHECK(ecrt_master_sdo_info_object(m, 2, 0x1018, NULL, &abort) == -EINVAL);
	CHECK(ecrt_master_sdo_info_entry(m, 2, 0x1018, 1, NULL, &abort) == -EINVAL);
	CHECK(!ecrt_master_sdo_info_forget(m, 7) && arg->slave.position == 7);
	CHECK(arg->what == EC_SDO_INFO_FORGET && !arg->size);
	/* shorter than any answer, without a name, longer than a name may be */
	fake.answer = 5;
	CHECK(ecrt_master_sdo_info_object(m, 2, 0x1018, &o, &abort) == -EBADMSG);
	CHECK(ecrt_master_sdo_info_entry(m, 2, 0x1018, 1, &e, &abort) == -EBADMSG);
	fake.answer = 6;
	CHECK(!ecrt_master_sdo_info_object(m, 2, 0x1018, &o, &abort) && !o.name[0]);
	fake.answer = 11;
	CHECK(!ecrt_master_sdo_info_entry(m, 2, 0x1018, 1, &e, &abort) && !e.name[0]);
	fake.answer = 4096;
	CHECK(!ecrt_master_sdo_info_object(m, 2, 0x1018, &o, &abort));
	CHECK(!strcmp(o.name, "Identity"));
	fake.answer = 0;
}

static void done(struct ec_request_record *rec, int result, const char *data, unsigned int size)
{
	rec->result = result;
	rec->got = size;
	memcpy(fake.area + rec->data, data, size);
	rec->done = rec->start;
}

static void requests_of(ec_sdo_info_request_t *r)
{
	struct ec_request_record *rec = fake_request(fake.area, 0);
	unsigned int calls = fake.calls;
	ec_sdo_object_info_t o;
	ec_sdo_entry_info_t e;

	CHECK(ecrt_sdo_info_request_list(r, 6) == -EINVAL);
	CHECK(!ecrt_sdo_info_request_list(r, 2) && rec->flags == EC_SDO_INFO_LIST);
	CHECK(rec->index == 2 && !rec->op && rec->timeout_ms == 400);
	CHECK(ecrt_sdo_info_request_object(r, 1) == -EBUSY);
	CHECK(!ecrt_sdo_info_request_cancel(r) && rec->cancel == 1);
	done(rec, 0, "\x00\x10\x18\x10", 4);
	CHECK(ecrt_sdo_info_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(ecrt_sdo_info_request_data_size(r) == 4);
	CHECK(EC_READ_U16(ecrt_sdo_info_request_data(r) + 2) == 0x1018);
	CHECK(ecrt_sdo_info_request_get_object(r, &o) == -EINVAL);
	CHECK(!ecrt_sdo_info_request_object(r, 0x1018) && rec->flags == EC_SDO_INFO_OBJECT);
	CHECK(ecrt_sdo_info_request_get_object(r, &o) == -EINVAL);	/* BUSY */
	done(rec, 0, "\x18\x10\x23\0\4\x09" "Id", 8);
	CHECK(ecrt_sdo_info_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(!ecrt_sdo_info_request_get_object(r, &o) && !strcmp(o.name, "Id"));
	CHECK(!ecrt_sdo_info_request_entry(r, 0x1018, 4) && rec->flags == EC_SDO_INFO_ENTRY &&
	      rec->subindex == 4);
	done(rec, 0, "\x18\x10\4\0\7\0\x20\0\7\0Serial", 16);
	CHECK(ecrt_sdo_info_request_state(r) == EC_REQUEST_SUCCESS);
	CHECK(!ecrt_sdo_info_request_get_entry(r, &e) && !strcmp(e.name, "Serial"));
	CHECK(!ecrt_sdo_info_request_object(r, 1));
	rec->abort_code = 0x06020000;
	done(rec, -EIO, "", 0);
	CHECK(ecrt_sdo_info_request_state(r) == EC_REQUEST_ERROR);
	CHECK(ecrt_sdo_info_request_abort_code(r) == 0x06020000);
	CHECK(fake.calls == calls);
}

void dictionary(void)
{
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 1, 2);
	ec_sdo_info_request_t *r = ecrt_slave_config_create_sdo_info_request(sc, 64);
	const struct ec_ioc_sc_request *arg = (void *)fake.arg;

	CHECK(r && arg->kind == EC_REQUEST_SDO_INFO && arg->size == 64);
	CHECK(!ecrt_sdo_info_request_timeout(r, 400));
	CHECK(ecrt_sdo_info_request_list(r, 1) == -EINVAL);	/* not active */
	nobody();
	lists(m);
	descriptions(m);
	CHECK(!ecrt_master_activate(m));
	requests_of(r);
	ecrt_release_master(m);
}
