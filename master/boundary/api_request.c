// SPDX-License-Identifier: GPL-2.0-only
/*
 * Requests of applications in the kernel, and those for registers. They use the
 * records of the session's request area as a process does; the buffer is the
 * request's own, so that it is there before activation and stays where it is.
 */
#include <linux/mm.h>
#include <linux/slab.h>
#include "api_request.h"
#include "../session/request.h"

/**
 * ec_api_request_create() - a request of any kind
 * @sc: slave configuration or NULL
 * @kind: EC_REQUEST_*
 * @size: room for data, bytes
 *
 * Context: Process. May sleep.
 * Return: request, or NULL with the reason in the log.
 */
struct ec_api_request *ec_api_request_create(ec_slave_config_t *sc, u32 kind, size_t size)
{
	struct ec_ioc_sc_request i = { .kind = kind, .size = min_t(size_t, size, U32_MAX) };
	struct ec_api_request *r;
	struct ec_master *m;
	int ret;

	if (!sc)
		return NULL;
	m = ec_api_master(sc);
	i.config = ec_api_config(sc)->index;
	ret = ec_command(m, EC_IOC_SC_REQUEST, &i);
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
		kfree(r);
	}
	INIT_LIST_HEAD(&m->api->requests);
}

/* start and state ------------------------------------------------------------*/

/**
 * ec_api_request_state() - how far a request is; takes the result of a finished one
 * @r: request
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: state.
 */
ec_request_state_t ec_api_request_state(struct ec_api_request *r)
{
	struct ec_request_record *rec = r->rec;

	if (r->state != EC_REQUEST_BUSY || smp_load_acquire(&rec->done) != r->start)
		return r->state;
	r->state = rec->result ? EC_REQUEST_ERROR : EC_REQUEST_SUCCESS;
	if (r->state == EC_REQUEST_SUCCESS && r->op != EC_REQUEST_OP_WRITE) {
		r->size = min_t(size_t, rec->got, r->room);
		memcpy(r->data, r->shared, r->size);
		r->got_vendor = rec->got_vendor_id;
		r->got_type = rec->got_type;
	}
	return r->state;
}

/**
 * ec_api_request_start() - start a request; the next send tells
 * @r: request
 * @op: EC_REQUEST_OP_*
 * @size: bytes to write; registers: to read, too
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: 0; -ENOBUFS larger than the buffer; -EBUSY; -EINVAL not active.
 */
int ec_api_request_start(struct ec_api_request *r, u8 op, size_t size)
{
	struct ec_request_record *rec = r->rec;

	if (size > r->room)
		return -ENOBUFS;
	if (!rec)
		return -EINVAL;
	if (ec_api_request_state(r) == EC_REQUEST_BUSY)
		return -EBUSY;
	if (op == EC_REQUEST_OP_WRITE)
		memcpy(r->shared, r->data, size);
	rec->index = r->index;
	rec->subindex = r->sub;
	rec->op = op;
	rec->vendor_id = r->vendor;
	rec->size = size;
	rec->timeout_ms = r->timeout_ms;
	r->op = op;
	r->start = r->start + 1 ?: 1;
	r->state = EC_REQUEST_BUSY;
	smp_store_release(&rec->start, r->start);
	r->m->api->next.flags |= EC_SEND_FLAG_REQUESTS;
	return 0;
}

/* register requests ----------------------------------------------------------*/

ec_reg_request_t *ecrt_slave_config_create_reg_request(ec_slave_config_t *sc, size_t size)
{
	struct ec_api_request *r = ec_api_request_create(sc, EC_REQUEST_REG, size);

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
	return req ? ec_api_request_state((struct ec_api_request *)&req->r) : EC_REQUEST_ERROR;
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_state);

/* A size larger than the buffer is cut; the field's applications know it so here. */
static int start_reg(ec_reg_request_t *req, u8 op, u16 address, size_t size)
{
	if (!req || !size)
		return -EINVAL;
	/* one that is busy has its address already */
	req->r.index = address;
	return ec_api_request_start(&req->r, op, min(size, req->r.room));
}

int ecrt_reg_request_write(ec_reg_request_t *req, uint16_t address, size_t size)
{
	return start_reg(req, EC_REQUEST_OP_WRITE, address, size);
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_write);

int ecrt_reg_request_read(ec_reg_request_t *req, uint16_t address, size_t size)
{
	return start_reg(req, EC_REQUEST_OP_READ, address, size);
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_read);
