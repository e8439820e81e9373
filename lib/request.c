// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * SDO and register requests. Starting one writes to mapped memory and notes
 * that the next send has to tell; the state is read from there. No system
 * call, and nothing is printed, once they are created.
 */
#include <string.h>

#include "internal.h"

struct ec_sdo_request {
	struct ec_request r;
};

struct ec_reg_request {
	struct ec_request r;
};

/* creation and activation ----------------------------------------------------*/

static int create(struct ec_slave_config *sc, struct ec_request *r, __u32 kind,
		  size_t size)
{
	struct ec_ioc_sc_request arg = {
		.config = sc->index,
		.kind = kind,
		.size = (__u32)size,
	};
	struct ec_master *m = sc->master;
	int ret;

	if (size > UINT32_MAX)
		return ec_fail(-EINVAL, "create a request of %zu bytes", size);
	r->data = calloc(1, size ? size : 1);
	if (!r->data)
		return ec_fail(-ENOMEM, "create a request of %zu bytes", size);
	ret = ec_ioctl(m, EC_IOC_SC_REQUEST, &arg);
	if (ret) {
		free(r->data);
		return ec_fail_ioctl(m, ret,
				     "create a request of %zu bytes for slave %u:%u",
				     size, sc->alias, sc->position);
	}
	r->master = m;
	r->index = arg.index;
	r->room = size;
	r->size = size;
	r->next = m->requests;
	m->requests = r;
	return 0;
}

void ec_requests_free(struct ec_master *m)
{
	struct ec_request *r;

	while ((r = m->requests)) {
		m->requests = r->next;
		free(r->data);
		free(r);	/* first member of what was allocated */
	}
}

/* Finds the records in the area just mapped; NULL: there is none any more. */
int ec_requests_place(struct ec_master *m)
{
	struct ec_request_area *area = m->area;
	__u8 *base = m->area_base;
	struct ec_request *r;

	for (r = m->requests; r; r = r->next) {
		r->rec = NULL;
		if (!area)
			continue;
		if (r->index >= area->request_count)
			return -EPROTO;
		r->rec = (struct ec_request_record *)(base + area->requests) +
			 r->index;
		r->shared = base + r->rec->data;
	}
	return 0;
}

/* start and state ------------------------------------------------------------*/

static ec_request_state_t state(struct ec_request *r)
{
	struct ec_request_record *rec = r->rec;

	if (r->state != EC_REQUEST_BUSY || !rec ||
	    __atomic_load_n(&rec->done, __ATOMIC_ACQUIRE) != r->start)
		return r->state;
	r->state = rec->result ? EC_REQUEST_ERROR : EC_REQUEST_SUCCESS;
	if (r->state == EC_REQUEST_SUCCESS && !r->write) {
		r->size = rec->got < r->room ? rec->got : r->room;
		memcpy(r->data, r->shared, r->size);
	}
	return r->state;
}

static int start(struct ec_request *r, bool write, __u16 index, __u8 subindex,
		 size_t size)
{
	struct ec_request_record *rec = r->rec;

	if (!rec)
		return -EINVAL;
	if (state(r) == EC_REQUEST_BUSY)
		return -EBUSY;
	if (write)
		memcpy(r->shared, r->data, size);
	rec->index = index;
	rec->subindex = subindex;
	rec->op = write;
	rec->size = (__u32)size;
	rec->timeout_ms = r->timeout_ms;
	r->write = write;
	r->start = r->start + 1 ? r->start + 1 : 1;
	r->state = EC_REQUEST_BUSY;
	__atomic_store_n(&rec->start, r->start, __ATOMIC_RELEASE);
	r->master->send_flags |= EC_SEND_FLAG_REQUESTS;
	return 0;
}

/* SDO requests ---------------------------------------------------------------*/

ec_sdo_request_t *ecrt_slave_config_create_sdo_request(ec_slave_config_t *sc,
						       uint16_t index,
						       uint8_t subindex,
						       size_t size)
{
	ec_sdo_request_t *req;

	if (!sc) {
		errno = EINVAL;
		return NULL;
	}
	req = calloc(1, sizeof(*req));
	if (!req) {
		ec_fail(-ENOMEM, "create an SDO request");
		return NULL;
	}
	if (create(sc, &req->r, EC_REQUEST_SDO, size)) {
		free(req);
		return NULL;
	}
	req->r.sdo_index = index;
	req->r.subindex = subindex;
	return req;
}

int ecrt_sdo_request_index(ec_sdo_request_t *req, uint16_t index,
			   uint8_t subindex)
{
	if (!req)
		return -EINVAL;
	if (state(&req->r) == EC_REQUEST_BUSY)
		return -EBUSY;
	req->r.sdo_index = index;
	req->r.subindex = subindex;
	return 0;
}

int ecrt_sdo_request_timeout(ec_sdo_request_t *req, uint32_t timeout)
{
	if (!req)
		return -EINVAL;
	req->r.timeout_ms = timeout;
	return 0;
}

uint8_t *ecrt_sdo_request_data(const ec_sdo_request_t *req)
{
	return req ? req->r.data : NULL;
}

size_t ecrt_sdo_request_data_size(const ec_sdo_request_t *req)
{
	return req ? req->r.size : 0;
}

ec_request_state_t ecrt_sdo_request_state(ec_sdo_request_t *req)
{
	return req ? state(&req->r) : EC_REQUEST_ERROR;
}

int ecrt_sdo_request_write(ec_sdo_request_t *req)
{
	if (!req || !req->r.size)
		return -EINVAL;
	return start(&req->r, true, req->r.sdo_index, req->r.subindex,
		     req->r.size);
}

int ecrt_sdo_request_read(ec_sdo_request_t *req)
{
	if (!req)
		return -EINVAL;
	return start(&req->r, false, req->r.sdo_index, req->r.subindex, 0);
}

/* register requests ----------------------------------------------------------*/

ec_reg_request_t *ecrt_slave_config_create_reg_request(ec_slave_config_t *sc,
						       size_t size)
{
	ec_reg_request_t *req;

	if (!sc) {
		errno = EINVAL;
		return NULL;
	}
	req = calloc(1, sizeof(*req));
	if (!req) {
		ec_fail(-ENOMEM, "create a register request");
		return NULL;
	}
	if (create(sc, &req->r, EC_REQUEST_REG, size)) {
		free(req);
		return NULL;
	}
	return req;
}

uint8_t *ecrt_reg_request_data(const ec_reg_request_t *req)
{
	return req ? req->r.data : NULL;
}

/* The prototype says const; what it points to never is. */
ec_request_state_t ecrt_reg_request_state(const ec_reg_request_t *req)
{
	return req ? state((struct ec_request *)&req->r) : EC_REQUEST_ERROR;
}

static int start_reg(ec_reg_request_t *req, bool write, uint16_t address,
		     size_t size)
{
	if (!req || !size)
		return -EINVAL;
	if (size > req->r.room)
		return -ENOBUFS;
	return start(&req->r, write, address, 0, size);
}

int ecrt_reg_request_write(ec_reg_request_t *req, uint16_t address,
			   size_t size)
{
	return start_reg(req, true, address, size);
}

int ecrt_reg_request_read(ec_reg_request_t *req, uint16_t address, size_t size)
{
	return start_reg(req, false, address, size);
}
