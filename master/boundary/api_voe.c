// SPDX-License-Identifier: GPL-2.0-only
/* VoE handlers of applications in the kernel. */
#include "api_request.h"

ec_voe_handler_t *ecrt_slave_config_create_voe_handler(ec_slave_config_t *sc, size_t size)
{
	struct ec_api_request *r = ec_api_request_create(sc, EC_REQUEST_VOE, size);

	return r ? container_of(r, struct ec_voe_handler, r) : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_voe_handler);

int ecrt_voe_handler_send_header(ec_voe_handler_t *voe, uint32_t vendor_id,
				 uint16_t vendor_type)
{
	if (!voe)
		return -EINVAL;
	voe->r.vendor = vendor_id;
	voe->r.index = vendor_type;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_send_header);

int ecrt_voe_handler_received_header(const ec_voe_handler_t *voe, uint32_t *vendor_id,
				     uint16_t *vendor_type)
{
	if (!voe)
		return -EINVAL;
	if (vendor_id)
		*vendor_id = voe->r.got_vendor;
	if (vendor_type)
		*vendor_type = voe->r.got_type;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_received_header);

uint8_t *ecrt_voe_handler_data(const ec_voe_handler_t *voe)
{
	return voe ? voe->r.data : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_data);

size_t ecrt_voe_handler_data_size(const ec_voe_handler_t *voe)
{
	return voe ? voe->r.size : 0;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_data_size);

int ecrt_voe_handler_write(ec_voe_handler_t *voe, size_t size)
{
	int ret;

	if (!voe)
		return -EINVAL;
	ret = ec_api_request_start(&voe->r, EC_REQUEST_OP_WRITE, size);
	if (!ret)
		voe->r.size = size;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_write);

int ecrt_voe_handler_read(ec_voe_handler_t *voe)
{
	return voe ? ec_api_request_start(&voe->r, EC_REQUEST_OP_READ, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_read);

int ecrt_voe_handler_read_nosync(ec_voe_handler_t *voe)
{
	return voe ? ec_api_request_start(&voe->r, EC_REQUEST_OP_READ_NOW, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_read_nosync);

ec_request_state_t ecrt_voe_handler_execute(ec_voe_handler_t *voe)
{
	return voe ? ec_api_request_state(&voe->r) : EC_REQUEST_ERROR;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_execute);
