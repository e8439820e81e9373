// SPDX-License-Identifier: GPL-2.0-only
/* SDO requests of applications in the kernel. */
#include "api_request.h"

ec_sdo_request_t *ecrt_slave_config_create_sdo_request(ec_slave_config_t *sc, uint16_t index,
						       uint8_t subindex, size_t size)
{
	struct ec_api_request *r = ec_api_request_create(sc, EC_REQUEST_SDO, size);

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
	if (ec_api_request_state(&req->r) == EC_REQUEST_BUSY)
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
	return req ? ec_api_request_state((struct ec_api_request *)&req->r) : EC_REQUEST_ERROR;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_state);

int ecrt_sdo_request_write(ec_sdo_request_t *req)
{
	if (!req || !req->r.size)
		return -EINVAL;
	return ec_api_request_start(&req->r, EC_REQUEST_OP_WRITE, req->r.size);
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_write);

int ecrt_sdo_request_read(ec_sdo_request_t *req)
{
	return req ? ec_api_request_start(&req->r, EC_REQUEST_OP_READ, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_read);
