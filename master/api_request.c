// SPDX-License-Identifier: GPL-2.0-only
/*
 * SDO and register requests of applications in the kernel. They use the records
 * of the session's request area as a process does; the buffer is the request's
 * own, so that it is there before activation and stays where it is.
 */
#include <linux/mm.h>
#include <linux/slab.h>
#include "api.h"
#include "request.h"

/**
 * struct ec_api_request - one request; but for @list the cyclic caller's
 * @list: in struct ec_api
 * @m: master
 * @number: in the session
 * @data: buffer
 * @room: its bytes
 * @size: of them used
 * @timeout_ms: to begin with a start; 0: unlimited
 * @index: object
 * @sub: subindex
 * @write: of the last start
 * @start: number of the last start
 * @state: as last seen
 * @rec: record, NULL before activation
 * @shared: data of the record
 */
struct ec_api_request {
	struct list_head list;
	struct ec_master *m;
	u32 number;
	u8 *data;
	size_t room;
	size_t size;
	u32 timeout_ms;
	u16 index;
	u8 sub;
	bool write;
	u32 start;
	ec_request_state_t state;
	struct ec_request_record *rec;
	u8 *shared;
};

struct ec_sdo_request {
	struct ec_api_request r;
};

struct ec_reg_request {
	struct ec_api_request r;
};

/* creation and activation ----------------------------------------------------*/

static struct ec_api_request *create(ec_slave_config_t *sc, u32 kind, size_t size)
{
	struct ec_ioc_sc_request i = { .kind = kind, .size = min_t(size_t, size, U32_MAX) };
	struct ec_api_request *r;
	struct ec_master *m;
	int ret;

	if (!sc)
		return NULL;
	m = ec_api_master(sc);
	i.config = ec_api_config(sc)->index;
	ret = ec_api_do(m, ec_ioc_sc_request, &i);
	if (ret)
		goto fail;
	/* the session has one more than it needs when there is no memory for it here */
	r = kzalloc(sizeof(*r), GFP_KERNEL);
	if (r)
		r->data = kvzalloc(max_t(size_t, size, 1), GFP_KERNEL);
	if (!r || !r->data) {
		kfree(r);
		ret = -ENOMEM;
		goto fail;
	}
	r->m = m;
	r->number = i.index;
	r->room = size;
	r->size = size;
	list_add_tail(&r->list, &m->api->requests);
	return r;
fail:
	ec_api_fail_sc(sc, ret, "create a request of %zu bytes", size);
	return NULL;
}

/**
 * ec_api_requests_place() - the session is active: requests have their records
 * @m: master
 *
 * Context: Process. May sleep.
 */
void ec_api_requests_place(struct ec_master *m)
{
	struct ec_api_request *r;

	list_for_each_entry(r, &m->api->requests, list)
		r->rec = ec_requests_record(m->session, r->number, &r->shared);
}

/**
 * ec_api_requests_free() - the session has ended, and its requests with it
 * @m: master
 *
 * Context: Process. May sleep.
 */
void ec_api_requests_free(struct ec_master *m)
{
	struct ec_api_request *r, *next;

	list_for_each_entry_safe(r, next, &m->api->requests, list) {
		kvfree(r->data);
		kfree(r);	/* first member of its kind */
	}
	INIT_LIST_HEAD(&m->api->requests);
}

/* start and state ------------------------------------------------------------*/

static ec_request_state_t state(struct ec_api_request *r)
{
	struct ec_request_record *rec = r->rec;

	if (r->state != EC_REQUEST_BUSY || smp_load_acquire(&rec->done) != r->start)
		return r->state;
	r->state = rec->result ? EC_REQUEST_ERROR : EC_REQUEST_SUCCESS;
	if (r->state == EC_REQUEST_SUCCESS && !r->write) {
		r->size = min_t(size_t, rec->got, r->room);
		memcpy(r->data, r->shared, r->size);
	}
	return r->state;
}

static int start(struct ec_api_request *r, bool write, u16 index, u8 sub, size_t size)
{
	struct ec_request_record *rec = r->rec;

	if (!rec)
		return -EINVAL;
	if (state(r) == EC_REQUEST_BUSY)
		return -EBUSY;
	if (write)
		memcpy(r->shared, r->data, size);
	rec->index = index;
	rec->subindex = sub;
	rec->op = write ? EC_REQUEST_OP_WRITE : EC_REQUEST_OP_READ;
	rec->size = size;
	rec->timeout_ms = r->timeout_ms;
	r->write = write;
	r->start = r->start + 1 ?: 1;
	r->state = EC_REQUEST_BUSY;
	smp_store_release(&rec->start, r->start);
	r->m->api->next.flags |= EC_SEND_FLAG_REQUESTS;
	return 0;
}

/* SDO requests ---------------------------------------------------------------*/

ec_sdo_request_t *ecrt_slave_config_create_sdo_request(ec_slave_config_t *sc, uint16_t index,
						       uint8_t subindex, size_t size)
{
	struct ec_api_request *r = create(sc, EC_REQUEST_SDO, size);

	if (!r)
		return NULL;
	r->index = index;
	r->sub = subindex;
	return container_of(r, struct ec_sdo_request, r);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_sdo_request);

int ecrt_sdo_request_index(ec_sdo_request_t *req, uint16_t index, uint8_t subindex)
{
	if (!req)
		return -EINVAL;
	if (state(&req->r) == EC_REQUEST_BUSY)
		return -EBUSY;
	req->r.index = index;
	req->r.sub = subindex;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_index);

int ecrt_sdo_request_timeout(ec_sdo_request_t *req, uint32_t timeout)
{
	if (!req)
		return -EINVAL;
	req->r.timeout_ms = timeout;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_timeout);

uint8_t *ecrt_sdo_request_data(const ec_sdo_request_t *req)
{
	return req ? req->r.data : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_data);

size_t ecrt_sdo_request_data_size(const ec_sdo_request_t *req)
{
	return req ? req->r.size : 0;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_data_size);

/* The prototype says const; what it points to never is. */
ec_request_state_t ecrt_sdo_request_state(const ec_sdo_request_t *req)
{
	return req ? state((struct ec_api_request *)&req->r) : EC_REQUEST_ERROR;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_state);

int ecrt_sdo_request_write(ec_sdo_request_t *req)
{
	if (!req || !req->r.size)
		return -EINVAL;
	return start(&req->r, true, req->r.index, req->r.sub, req->r.size);
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_write);

int ecrt_sdo_request_read(ec_sdo_request_t *req)
{
	return req ? start(&req->r, false, req->r.index, req->r.sub, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_read);

/* register requests ----------------------------------------------------------*/

ec_reg_request_t *ecrt_slave_config_create_reg_request(ec_slave_config_t *sc, size_t size)
{
	struct ec_api_request *r = create(sc, EC_REQUEST_REG, size);

	return r ? container_of(r, struct ec_reg_request, r) : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_reg_request);

uint8_t *ecrt_reg_request_data(const ec_reg_request_t *req)
{
	return req ? req->r.data : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_data);

ec_request_state_t ecrt_reg_request_state(const ec_reg_request_t *req)
{
	return req ? state((struct ec_api_request *)&req->r) : EC_REQUEST_ERROR;
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_state);

/* A size larger than the buffer is cut; the field's applications know it so here. */
static int start_reg(ec_reg_request_t *req, bool write, u16 address, size_t size)
{
	if (!req || !size)
		return -EINVAL;
	return start(&req->r, write, address, 0, min(size, req->r.room));
}

int ecrt_reg_request_write(ec_reg_request_t *req, uint16_t address, size_t size)
{
	return start_reg(req, true, address, size);
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_write);

int ecrt_reg_request_read(ec_reg_request_t *req, uint16_t address, size_t size)
{
	return start_reg(req, false, address, size);
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_read);
