// SPDX-License-Identifier: LGPL-2.1-or-later
/* SDO requests, of one entry or of a whole object (complete access). */
#include "internal.h"

struct ec_sdo_request {
	struct ec_request r;
};

static ec_sdo_request_t *create(ec_slave_config_t *sc, uint16_t index,
				uint8_t subindex, __u32 flags, size_t size)
{
	ec_sdo_request_t *req = ec_request_create(sc, EC_REQUEST_SDO, size);

	if (req) {
		req->r.index16 = index;
		req->r.subindex = subindex;
		req->r.flags = flags;
	}
	return req;
}

ec_sdo_request_t *ecrt_slave_config_create_sdo_request(ec_slave_config_t *sc,
						       uint16_t index,
						       uint8_t subindex,
						       size_t size)
{
	return create(sc, index, subindex, 0, size);
}

ec_sdo_request_t *
ecrt_slave_config_create_sdo_request_complete(ec_slave_config_t *sc,
					      uint16_t index, size_t size)
{
	return create(sc, index, 0, EC_SDO_FLAG_COMPLETE, size);
}

static int aim(ec_sdo_request_t *req, uint16_t index, uint8_t subindex,
	       __u32 flags)
{
	if (!req)
		return -EINVAL;
	if (ec_request_state(&req->r) == EC_REQUEST_BUSY)
		return -EBUSY;
	req->r.index16 = index;
	req->r.subindex = subindex;
	req->r.flags = flags;
	return 0;
}

int ecrt_sdo_request_index(ec_sdo_request_t *req, uint16_t index,
			   uint8_t subindex)
{
	return aim(req, index, subindex, 0);
}

int ecrt_sdo_request_index_complete(ec_sdo_request_t *req, uint16_t index)
{
	return aim(req, index, 0, EC_SDO_FLAG_COMPLETE);
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
	return req ? ec_request_state(&req->r) : EC_REQUEST_ERROR;
}

int ecrt_sdo_request_write(ec_sdo_request_t *req)
{
	if (!req || !req->r.size)
		return -EINVAL;
	return ec_request_start(&req->r, EC_REQUEST_OP_WRITE, req->r.size);
}

int ecrt_sdo_request_write_with_size(ec_sdo_request_t *req, size_t size)
{
	int ret;

	if (!req || !size)
		return -EINVAL;
	ret = ec_request_start(&req->r, EC_REQUEST_OP_WRITE, size);
	if (!ret)
		req->r.size = size;
	return ret;
}

int ecrt_sdo_request_read(ec_sdo_request_t *req)
{
	if (!req)
		return -EINVAL;
	return ec_request_start(&req->r, EC_REQUEST_OP_READ, 0);
}
