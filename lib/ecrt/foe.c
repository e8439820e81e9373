// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Files of slaves (FoE), read and written at once, and by requests beside a cycle. */
#include "ecrt_int.h"

/* Length of a name; 0 for one that no slave can have. */
static size_t name_length(const char *name)
{
	size_t n = 0;

	while (name && n <= EC_FOE_NAME && name[n]) {
		if (name[n] < ' ' || name[n] > '~')
			return 0;
		n++;
	}
	return n > EC_FOE_NAME ? 0 : n;
}

/* at once --------------------------------------------------------------------*/

/* @error_code: that of a slave that refuses, otherwise 0; may be NULL */
static int transfer(ec_master_t *master, unsigned int cmd, const char *name,
		    struct ec_ioc_foe *i, uint32_t *error_code)
{
	bool read = cmd == EC_IOC_FOE_READ;
	const char *verb = read ? "read" : "write", *way = read ? "of" : "to";
	size_t len = name_length(name);
	int ret;

	if (!len)
		return ec_fail(master, -EINVAL,
			       "%s a file %s slave %u without a name of 1 to %d printable characters",
			       verb, way, i->slave.position, EC_FOE_NAME);
	memcpy(i->name, name, len);
	ret = ec_do(master, cmd, i, "%s file '%s' %s slave %u", verb, name, way, i->slave.position);
	if (ret == -EIO && error_code)
		*error_code = i->error_code;
	return ret;
}

int ecrt_master_foe_read(ec_master_t *master, uint16_t slave_position, const char *file_name,
			 uint32_t password, uint8_t *target, size_t target_size,
			 size_t *result_size, uint32_t *error_code, uint32_t timeout)
{
	struct ec_ioc_foe i = {
		.slave.position = slave_position, .password = password, .size = ec_u32(target_size),
		.timeout_ms = timeout, .data = (uintptr_t)target,
	};
	int ret;

	if (result_size)
		ec_no_result(result_size);
	if (error_code)
		*error_code = 0;
	if (!master)
		return -EINVAL;
	if (!result_size || (!target && target_size))
		return ec_fail(master, -EINVAL, "read a file of slave %u to nowhere",
			       slave_position);
	ret = transfer(master, EC_IOC_FOE_READ, file_name, &i, error_code);
	if (!ret)
		*result_size = i.size;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_foe_read);

int ecrt_master_foe_write(ec_master_t *master, uint16_t slave_position, const char *file_name,
			  uint32_t password, const uint8_t *data, size_t data_size,
			  uint32_t *error_code, uint32_t timeout)
{
	struct ec_ioc_foe i = {
		.slave.position = slave_position, .password = password, .size = ec_u32(data_size),
		.timeout_ms = timeout, .data = (uintptr_t)data,
	};

	if (error_code)
		*error_code = 0;
	if (!master)
		return -EINVAL;
	if ((!data && data_size) || data_size > EC_U32_MAX)
		return ec_fail(master, -EINVAL, "write %zu bytes to a file of slave %u", data_size,
			       slave_position);
	return transfer(master, EC_IOC_FOE_WRITE, file_name, &i, error_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_foe_write);

/* requests -----------------------------------------------------------------*/

/*
 * A file may be much larger than what a cycle has the time to copy, so that each call
 * copies a part: before a write starts, and while a read is in progress.
 */
#define PART	((size_t)16 << 10)

static size_t part(size_t from, size_t to)
{
	size_t n = to > from ? to - from : 0;

	return n < PART ? n : PART;
}

/* The part of a write that comes next; the last one starts it. */
static void fill(struct ec_foe_request *f)
{
	struct ec_app_request *r = &f->r;
	size_t n = part(f->copied, r->size);

	memcpy(r->shared + f->copied, r->data + f->copied, n);
	f->copied += n;
	if (f->copied < r->size)
		return;
	f->filling = false;
	ec_app_request_give(r, EC_REQUEST_OP_WRITE, r->size);
}

/* The part of a read that has arrived since; true: there is none, of @to bytes. */
static bool take(struct ec_foe_request *f, size_t to)
{
	struct ec_app_request *r = &f->r;
	size_t n;

	if (to > r->room)
		to = r->room;
	n = part(f->copied, to);
	memcpy(r->data + f->copied, r->shared + f->copied, n);
	f->copied += n;
	return f->copied >= to;
}

static ec_request_state_t poll_file(struct ec_foe_request *f)
{
	struct ec_app_request *r = &f->r;
	struct ec_request_record *rec = r->rec;
	bool done;

	if (r->state != EC_REQUEST_BUSY || !rec)
		return r->state;
	if (f->filling) {
		fill(f);
		return EC_REQUEST_BUSY;
	}
	done = ec_load_acquire(&rec->done) == r->start;
	if (done)
		f->result = ec_status_read(rec->result);
	if (done && f->result) {
		f->error_code = ec_status_read(rec->abort_code);
		return r->state = EC_REQUEST_ERROR;
	}
	if (r->op == EC_REQUEST_OP_READ) {
		done = take(f, done ? ec_status_read(rec->got) :
				      ec_load_acquire(&rec->progress)) && done;
		r->size = done ? f->copied : r->size;
	}
	return r->state = done ? EC_REQUEST_SUCCESS : EC_REQUEST_BUSY;
}

ec_foe_request_t *ecrt_slave_config_create_foe_request(ec_slave_config_t *sc, size_t size)
{
	return ec_app_request_create(sc, EC_REQUEST_FOE, sizeof(ec_foe_request_t), size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_foe_request);

int ecrt_foe_request_file(ec_foe_request_t *req, const char *file_name, uint32_t password)
{
	size_t len = name_length(file_name);

	if (!req || !len)
		return -EINVAL;
	if (poll_file(req) == EC_REQUEST_BUSY)
		return -EBUSY;
	memset(req->name, 0, sizeof(req->name));
	memcpy(req->name, file_name, len);
	req->r.vendor_id = password;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_file);

/* Common begin of a read and a write. */
static int begin(struct ec_foe_request *f, size_t size)
{
	struct ec_app_request *r = &f->r;

	if (size > r->room)
		return -ENOBUFS;
	if (!r->rec || !f->name[0])
		return -EINVAL;
	if (poll_file(f) == EC_REQUEST_BUSY)
		return -EBUSY;
	memcpy(r->shared - EC_FOE_NAME, f->name, EC_FOE_NAME);
	f->copied = 0;
	f->result = 0;
	f->error_code = 0;
	return 0;
}

int ecrt_foe_request_write(ec_foe_request_t *req, size_t size)
{
	int ret = req ? begin(req, size) : -EINVAL;

	if (ret)
		return ret;
	req->r.size = size;
	req->r.state = EC_REQUEST_BUSY;
	req->filling = true;
	fill(req);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_write);

int ecrt_foe_request_read(ec_foe_request_t *req)
{
	int ret = req ? begin(req, 0) : -EINVAL;

	if (!ret)
		ec_app_request_give(&req->r, EC_REQUEST_OP_READ, 0);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_read);

/* The object of a const handle is never const itself. */
ec_request_state_t ecrt_foe_request_state(const ec_foe_request_t *req)
{
	return req ? poll_file((ec_foe_request_t *)req) : EC_REQUEST_ERROR;
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_state);

int ecrt_foe_request_cancel(ec_foe_request_t *req)
{
	if (!req || !req->r.rec)
		return -EINVAL;
	if (poll_file(req) != EC_REQUEST_BUSY)
		return 0;
	if (!req->filling) {
		ec_app_request_stop(&req->r);
		return 0;
	}
	req->filling = false;
	req->result = -ECANCELED;
	req->r.state = EC_REQUEST_ERROR;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_cancel);

size_t ecrt_foe_request_progress(const ec_foe_request_t *req)
{
	const struct ec_request_record *rec = req ? req->r.rec : NULL;

	return !rec || req->filling ? 0 : ec_status_read(rec->progress);
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_progress);

int ecrt_foe_request_result(const ec_foe_request_t *req)
{
	return req ? req->result : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_result);

uint32_t ecrt_foe_request_error_code(const ec_foe_request_t *req)
{
	return req ? req->error_code : 0;
}
EXPORT_SYMBOL_GPL(ecrt_foe_request_error_code);
