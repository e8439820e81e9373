// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/*
 * Requests of all kinds. The start of a request writes to shared memory, and the next send
 * notifies the master; the state is read from shared memory. Once requests are created they
 * need no command, and nothing is printed. A request has a buffer of its own, so that the
 * buffer exists before activation and its address never changes.
 */
#include "ecrt_int.h"

static void request_free(struct ec_app_request *r)
{
	if (r)
		ec_free(r->data);
	ec_free(r);
}

static struct ec_app_request *request_alloc(size_t object, size_t size)
{
	struct ec_app_request *r = ec_zalloc(object);

	if (!r)
		return NULL;
	r->data = ec_zalloc(size ? size : 1);
	if (!r->data) {
		request_free(r);
		return NULL;
	}
	r->room = size;
	r->size = size;
	return r;
}

/* The request, which the kernel has under a number; NULL: it refused it with @err. */
static void *request_keep(ec_master_t *m, struct ec_app_request *r, unsigned int index, int err)
{
	struct ec_app_request **list;

	if (err) {
		request_free(r);
		return ec_no_handle(err);
	}
	list = ec_request_list(m);
	r->master = m;
	r->index = index;
	r->next = *list;
	*list = r;
	return r;
}

/**
 * ec_app_request_create() - a request and its buffer, set to 0
 * @sc: slave configuration
 * @kind: EC_REQUEST_*
 * @object: bytes of the request, which begins with struct ec_app_request
 * @size: of the buffer
 *
 * Return: request, freed with the session, the first member of each kind; NULL with the
 * reason reported.
 */
void *ec_app_request_create(ec_slave_config_t *sc, __u32 kind, size_t object, size_t size)
{
	struct ec_ioc_sc_request arg = {
		.kind = kind, .config = ec_sc_index(sc), .size = ec_u32(size),
	};
	struct ec_app_request *r;
	int ret;

	if (!sc)
		return ec_no_handle(-EINVAL);
	r = request_alloc(object, size);
	ret = r ? ec_do_sc(sc, EC_IOC_SC_REQUEST, &arg, "create a request of %zu bytes", size) :
		  ec_fail_sc(sc, -ENOMEM, "create a request of %zu bytes", size);
	return request_keep(ec_sc_master(sc), r, arg.index, ret);
}

/**
 * ec_app_request_create_datagram() - create a request for datagrams, and its buffer, set to 0
 * @m: master
 * @object: as of ec_app_request_create()
 * @size: of the buffer
 *
 * Return: as ec_app_request_create().
 */
void *ec_app_request_create_datagram(ec_master_t *m, size_t object, size_t size)
{
	struct ec_ioc_datagram_request arg = { .size = ec_u32(size) };
	struct ec_app_request *r;
	int ret;

	if (!m)
		return ec_no_handle(-EINVAL);
	r = request_alloc(object, size);
	ret = r ? ec_do(m, EC_IOC_DATAGRAM_REQUEST, &arg, "create a datagram request of %zu bytes",
			size) :
		  ec_fail(m, -ENOMEM, "create a datagram request of %zu bytes", size);
	return request_keep(m, r, arg.index, ret);
}

/* The session has ended, and its requests with it. */
void ec_app_requests_free(ec_master_t *m)
{
	struct ec_app_request *r, **list = ec_request_list(m);

	while ((r = *list)) {
		*list = r->next;
		request_free(r);
	}
}

/**
 * ec_app_requests_place() - find the records in the memory of the session
 * @m: master that has just become active or inactive
 *
 * Return: 0, -EPROTO when a record is missing.
 */
int ec_app_requests_place(ec_master_t *m)
{
	struct ec_app_request *r;
	int ret = 0;

	for (r = *ec_request_list(m); r; r = r->next) {
		r->rec = ec_request_record(m, r->index, &r->shared);
		if (!r->rec) {
			ret = -EPROTO;
			continue;
		}
		/* the previous application may have started it */
		r->start = ec_status_read(r->rec->start);
		r->op = ec_status_read(r->rec->op);
		if (ec_status_read(r->rec->done) != r->start)
			r->state = EC_REQUEST_BUSY;
	}
	return ret;
}

/**
 * ec_app_request_state() - state of a request; takes the result of a finished one
 * @r: request
 *
 * Context: RT-safe: bounded, no sleep, no allocation.
 * Return: state.
 */
ec_request_state_t ec_app_request_state(struct ec_app_request *r)
{
	struct ec_request_record *rec = r->rec;
	__u32 got;

	if (r->state != EC_REQUEST_BUSY || !rec || ec_load_acquire(&rec->done) != r->start)
		return r->state;
	r->state = ec_status_read(rec->result) ? EC_REQUEST_ERROR : EC_REQUEST_SUCCESS;
	if (r->state == EC_REQUEST_SUCCESS && r->op != EC_REQUEST_OP_WRITE) {
		got = ec_status_read(rec->got);
		r->size = got < r->room ? got : r->room;
		memcpy(r->data, r->shared, r->size);
		r->got_vendor_id = ec_status_read(rec->got_vendor_id);
		r->got_type = ec_status_read(rec->got_type);
	}
	return r->state;
}

/**
 * ec_app_request_give() - pass a request with its data to the kernel
 * @r: request that is not BUSY, of an active master; data to write are in shared memory
 * @op: EC_REQUEST_OP_*
 * @size: bytes to write; registers: to read, too
 *
 * Context: One caller at a time. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_request_give(struct ec_app_request *r, __u8 op, size_t size)
{
	struct ec_request_record *rec = r->rec;

	rec->index = r->index16;
	rec->subindex = r->subindex;
	rec->op = op;
	rec->flags = r->flags;
	rec->vendor_id = r->vendor_id;
	rec->size = (__u32)size;
	rec->timeout_ms = r->timeout_ms;
	rec->progress = 0;
	r->op = op;
	if (op == EC_REQUEST_OP_WRITE)
		r->size = size;
	r->start = r->start + 1 ? r->start + 1 : 1;
	r->state = EC_REQUEST_BUSY;
	ec_store_release(&rec->start, r->start);
	ec_request_started(r->master);
}

/**
 * ec_app_request_start() - start a request; the next send notifies the master
 * @r: request
 * @op: EC_REQUEST_OP_*
 * @size: bytes to write; registers: to read, too
 *
 * Context: One caller at a time. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; -ENOBUFS larger than the buffer; -EBUSY; -EINVAL not active.
 */
int ec_app_request_start(struct ec_app_request *r, __u8 op, size_t size)
{
	if (size > r->room)
		return -ENOBUFS;
	if (!r->rec)
		return -EINVAL;
	if (ec_app_request_state(r) == EC_REQUEST_BUSY)
		return -EBUSY;
	if (op == EC_REQUEST_OP_WRITE || op == EC_REQUEST_OP_READWRITE)
		memcpy(r->shared, r->data, size);
	ec_app_request_give(r, op, size);
	return 0;
}

/**
 * ec_app_request_stop() - have the kernel end a request; the next send notifies the master
 * @r: request that is BUSY
 *
 * Context: One caller at a time. RT-safe: bounded, no sleep, no allocation.
 */
void ec_app_request_stop(struct ec_app_request *r)
{
	struct ec_request_record *rec = r->rec;

	rec->cancel = r->start;
	ec_request_started(r->master);
}

/**
 * ec_app_request_cancel() - end a request; the next send notifies the master
 * @r: request
 *
 * Context: One caller at a time. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; -EINVAL not active.
 */
int ec_app_request_cancel(struct ec_app_request *r)
{
	if (!r->rec)
		return -EINVAL;
	if (ec_app_request_state(r) == EC_REQUEST_BUSY)
		ec_app_request_stop(r);
	return 0;
}

/* what several kinds have; a handle may be NULL ------------------------------*/

#define DEFINE_DATA(type, function) \
uint8_t *function(type req) \
{ \
	return req ? req->r.data : NULL; \
} \
EXPORT_SYMBOL_GPL(function)

DEFINE_DATA(const ec_reg_request_t *, ecrt_reg_request_data);
DEFINE_DATA(const ec_datagram_request_t *, ecrt_datagram_request_data);
DEFINE_DATA(const ec_sdo_request_t *, ecrt_sdo_request_data);
DEFINE_DATA(const ec_sdo_info_request_t *, ecrt_sdo_info_request_data);
DEFINE_DATA(const ec_soe_request_t *, ecrt_soe_request_data);
DEFINE_DATA(const ec_voe_handler_t *, ecrt_voe_handler_data);
DEFINE_DATA(const ec_foe_request_t *, ecrt_foe_request_data);

#define DEFINE_SIZE(type, function) \
size_t function(type req) \
{ \
	return req ? req->r.size : 0; \
} \
EXPORT_SYMBOL_GPL(function)

DEFINE_SIZE(const ec_sdo_request_t *, ecrt_sdo_request_data_size);
DEFINE_SIZE(const ec_sdo_info_request_t *, ecrt_sdo_info_request_data_size);
DEFINE_SIZE(const ec_soe_request_t *, ecrt_soe_request_data_size);
DEFINE_SIZE(const ec_voe_handler_t *, ecrt_voe_handler_data_size);
DEFINE_SIZE(const ec_foe_request_t *, ecrt_foe_request_data_size);

/* Some prototypes have a const handle; its object is never const itself. */
#define DEFINE_STATE(type, function) \
ec_request_state_t function(type req) \
{ \
	return req ? ec_app_request_state((struct ec_app_request *)&req->r) : EC_REQUEST_ERROR; \
} \
EXPORT_SYMBOL_GPL(function)

DEFINE_STATE(const ec_reg_request_t *, ecrt_reg_request_state);
DEFINE_STATE(const ec_datagram_request_t *, ecrt_datagram_request_state);
DEFINE_STATE(EC_IN_KERNEL ec_sdo_request_t *, ecrt_sdo_request_state);
DEFINE_STATE(EC_IN_KERNEL ec_soe_request_t *, ecrt_soe_request_state);
DEFINE_STATE(const ec_sdo_info_request_t *, ecrt_sdo_info_request_state);
DEFINE_STATE(ec_voe_handler_t *, ecrt_voe_handler_execute);

#define DEFINE_READ(type, function, op) \
int function(type req) \
{ \
	return req ? ec_app_request_start(&req->r, op, 0) : -EINVAL; \
} \
EXPORT_SYMBOL_GPL(function)

DEFINE_READ(ec_sdo_request_t *, ecrt_sdo_request_read, EC_REQUEST_OP_READ);
DEFINE_READ(ec_soe_request_t *, ecrt_soe_request_read, EC_REQUEST_OP_READ);
DEFINE_READ(ec_voe_handler_t *, ecrt_voe_handler_read, EC_REQUEST_OP_READ);
DEFINE_READ(ec_voe_handler_t *, ecrt_voe_handler_read_nosync, EC_REQUEST_OP_READ_NOW);

#define DEFINE_TIMEOUT(type, function) \
int function(type req, uint32_t timeout) \
{ \
	if (!req) \
		return -EINVAL; \
	req->r.timeout_ms = timeout; \
	return 0; \
} \
EXPORT_SYMBOL_GPL(function)

DEFINE_TIMEOUT(ec_sdo_request_t *, ecrt_sdo_request_timeout);
DEFINE_TIMEOUT(ec_soe_request_t *, ecrt_soe_request_timeout);
DEFINE_TIMEOUT(ec_sdo_info_request_t *, ecrt_sdo_info_request_timeout);
DEFINE_TIMEOUT(ec_foe_request_t *, ecrt_foe_request_timeout);

#define DEFINE_CANCEL(type, function) \
int function(type req) \
{ \
	return req ? ec_app_request_cancel(&req->r) : -EINVAL; \
} \
EXPORT_SYMBOL_GPL(function)

DEFINE_CANCEL(ec_sdo_request_t *, ecrt_sdo_request_cancel);
DEFINE_CANCEL(ec_soe_request_t *, ecrt_soe_request_cancel);
DEFINE_CANCEL(ec_sdo_info_request_t *, ecrt_sdo_info_request_cancel);

/* registers ----------------------------------------------------------------*/

ec_reg_request_t *ecrt_slave_config_create_reg_request(ec_slave_config_t *sc, size_t size)
{
	return ec_app_request_create(sc, EC_REQUEST_REG, sizeof(ec_reg_request_t), size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_reg_request);

static int start_reg(ec_reg_request_t *req, __u8 op, uint16_t address, size_t size)
{
	if (!req || !size)
		return -EINVAL;
	/* one that is busy has its address already */
	req->r.index16 = address;
	return ec_app_request_start(&req->r, op, size);
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

int ecrt_reg_request_readwrite(ec_reg_request_t *req, uint16_t address, size_t size)
{
	return start_reg(req, EC_REQUEST_OP_READWRITE, address, size);
}
EXPORT_SYMBOL_GPL(ecrt_reg_request_readwrite);

/* datagrams ------------------------------------------------------------------*/

ec_datagram_request_t *ecrt_master_create_datagram_request(ec_master_t *master, size_t size)
{
	return ec_app_request_create_datagram(master, sizeof(ec_datagram_request_t), size);
}
EXPORT_SYMBOL_GPL(ecrt_master_create_datagram_request);

int ecrt_datagram_request_send(ec_datagram_request_t *req, ec_datagram_command_t command,
			       uint32_t address, size_t size)
{
	if (!req || !size || (unsigned int)command > EC_DATAGRAM_FRMW)
		return -EINVAL;
	/* one that is busy has command and address already */
	req->r.subindex = (__u8)command;
	req->r.vendor_id = address;
	return ec_app_request_start(&req->r, EC_REQUEST_OP_READWRITE, size);
}
EXPORT_SYMBOL_GPL(ecrt_datagram_request_send);

uint16_t ecrt_datagram_request_working_counter(const ec_datagram_request_t *req)
{
	return req && req->r.state == EC_REQUEST_SUCCESS ? req->r.got_type : 0;
}
EXPORT_SYMBOL_GPL(ecrt_datagram_request_working_counter);
