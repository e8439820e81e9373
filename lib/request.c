// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Requests of all kinds. Starting one writes to mapped memory and notes that
 * the next send has to tell; the state is read from there. No system call,
 * and nothing is printed, once they are created.
 */
#include <string.h>

#include "internal.h"

/**
 * ec_request_create() - a request and its buffer, set to 0
 * @sc: slave configuration
 * @kind: EC_REQUEST_*
 * @size: of the buffer
 *
 * Return: request, freed with the session; NULL with errno set.
 */
void *ec_request_create(struct ec_slave_config *sc, __u32 kind, size_t size)
{
	struct ec_ioc_sc_request arg = {
		.kind = kind,
		.size = (__u32)size,
	};
	struct ec_request *r;
	int ret = -ENOMEM;

	if (!sc) {
		errno = EINVAL;
		return NULL;
	}
	if (size > UINT32_MAX) {
		ec_fail(-EINVAL, "create a request of %zu bytes", size);
		return NULL;
	}
	r = calloc(1, sizeof(*r));
	if (r)
		r->data = calloc(1, size ? size : 1);
	if (!r || !r->data) {
		ec_fail(ret, "create a request of %zu bytes", size);
		goto failed;
	}
	arg.config = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_SC_REQUEST, &arg);
	if (ret) {
		ec_fail_ioctl(sc->master, ret,
			      "create a request of %zu bytes for slave %u:%u",
			      size, sc->alias, sc->position);
		goto failed;
	}
	r->master = sc->master;
	r->index = arg.index;
	r->room = size;
	r->size = size;
	r->next = sc->master->requests;
	sc->master->requests = r;
	return r;
failed:
	if (r)
		free(r->data);
	free(r);
	errno = -ret;
	return NULL;
}

void ec_requests_free(struct ec_master *m)
{
	struct ec_request *r;

	while ((r = m->requests)) {
		m->requests = r->next;
		free(r->data);
		free(r);
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
		/* the application before may have started it */
		r->start = r->rec->start;
		r->op = r->rec->op;
		if (r->rec->done != r->start)
			r->state = EC_REQUEST_BUSY;
	}
	return 0;
}

/**
 * ec_request_state() - how far a request is; takes the result of a finished one
 * @r: request
 *
 * Return: state.
 */
ec_request_state_t ec_request_state(struct ec_request *r)
{
	struct ec_request_record *rec = r->rec;

	if (r->state != EC_REQUEST_BUSY || !rec ||
	    __atomic_load_n(&rec->done, __ATOMIC_ACQUIRE) != r->start)
		return r->state;
	r->state = rec->result ? EC_REQUEST_ERROR : EC_REQUEST_SUCCESS;
	if (r->state == EC_REQUEST_SUCCESS && r->op != EC_REQUEST_OP_WRITE) {
		r->size = rec->got < r->room ? rec->got : r->room;
		memcpy(r->data, r->shared, r->size);
		r->got_vendor_id = rec->got_vendor_id;
		r->got_type = rec->got_type;
	}
	return r->state;
}

/**
 * ec_request_start() - start a request; the next send tells
 * @r: request
 * @op: EC_REQUEST_OP_*
 * @size: bytes to write; registers: to read, too
 *
 * Return: 0; -ENOBUFS larger than the buffer; -EBUSY; -EINVAL not active.
 */
int ec_request_start(struct ec_request *r, __u8 op, size_t size)
{
	struct ec_request_record *rec = r->rec;

	if (size > r->room)
		return -ENOBUFS;
	if (!rec)
		return -EINVAL;
	if (ec_request_state(r) == EC_REQUEST_BUSY)
		return -EBUSY;
	if (op == EC_REQUEST_OP_WRITE || op == EC_REQUEST_OP_READWRITE)
		memcpy(r->shared, r->data, size);
	rec->index = r->index16;
	rec->subindex = r->subindex;
	rec->op = op;
	rec->flags = r->flags;
	rec->vendor_id = r->vendor_id;
	rec->size = (__u32)size;
	rec->timeout_ms = r->timeout_ms;
	r->op = op;
	r->start = r->start + 1 ? r->start + 1 : 1;
	r->state = EC_REQUEST_BUSY;
	__atomic_store_n(&rec->start, r->start, __ATOMIC_RELEASE);
	/* told by the next send, or seen by the cycle the kernel runs */
	r->master->send_flags |= EC_SEND_FLAG_REQUESTS;
	__atomic_fetch_add(&r->master->area->starts, 1, __ATOMIC_RELEASE);
	return 0;
}

/* register requests ----------------------------------------------------------*/

struct ec_reg_request {
	struct ec_request r;
};

ec_reg_request_t *ecrt_slave_config_create_reg_request(ec_slave_config_t *sc,
						       size_t size)
{
	return ec_request_create(sc, EC_REQUEST_REG, size);
}

uint8_t *ecrt_reg_request_data(const ec_reg_request_t *req)
{
	return req ? req->r.data : NULL;
}

/* The prototype says const; what it points to never is. */
ec_request_state_t ecrt_reg_request_state(const ec_reg_request_t *req)
{
	return req ? ec_request_state((struct ec_request *)&req->r) :
		     EC_REQUEST_ERROR;
}

static int start_reg(ec_reg_request_t *req, __u8 op, uint16_t address,
		     size_t size)
{
	if (!req || !size)
		return -EINVAL;
	/* one that is busy has its address already */
	req->r.index16 = address;
	return ec_request_start(&req->r, op, size);
}

int ecrt_reg_request_write(ec_reg_request_t *req, uint16_t address,
			   size_t size)
{
	return start_reg(req, EC_REQUEST_OP_WRITE, address, size);
}

int ecrt_reg_request_read(ec_reg_request_t *req, uint16_t address, size_t size)
{
	return start_reg(req, EC_REQUEST_OP_READ, address, size);
}

int ecrt_reg_request_readwrite(ec_reg_request_t *req, uint16_t address,
			       size_t size)
{
	return start_reg(req, EC_REQUEST_OP_READWRITE, address, size);
}
