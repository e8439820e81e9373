// SPDX-License-Identifier: LGPL-2.1-or-later
/* VoE handlers: vendor specific messages beside the cycle. */
#include "internal.h"

struct ec_voe_handler {
	struct ec_request r;
};

ec_voe_handler_t *ecrt_slave_config_create_voe_handler(ec_slave_config_t *sc,
						       size_t size)
{
	return ec_request_create(sc, EC_REQUEST_VOE, size);
}

int ecrt_voe_handler_send_header(ec_voe_handler_t *voe, uint32_t vendor_id,
				 uint16_t vendor_type)
{
	if (!voe)
		return -EINVAL;
	voe->r.vendor_id = vendor_id;
	voe->r.index16 = vendor_type;
	return 0;
}

int ecrt_voe_handler_received_header(const ec_voe_handler_t *voe,
				     uint32_t *vendor_id,
				     uint16_t *vendor_type)
{
	if (!voe)
		return -EINVAL;
	if (vendor_id)
		*vendor_id = voe->r.got_vendor_id;
	if (vendor_type)
		*vendor_type = voe->r.got_type;
	return 0;
}

uint8_t *ecrt_voe_handler_data(const ec_voe_handler_t *voe)
{
	return voe ? voe->r.data : NULL;
}

size_t ecrt_voe_handler_data_size(const ec_voe_handler_t *voe)
{
	return voe ? voe->r.size : 0;
}

int ecrt_voe_handler_write(ec_voe_handler_t *voe, size_t size)
{
	int ret;

	if (!voe)
		return -EINVAL;
	ret = ec_request_start(&voe->r, EC_REQUEST_OP_WRITE, size);
	if (!ret)
		voe->r.size = size;
	return ret;
}

int ecrt_voe_handler_read(ec_voe_handler_t *voe)
{
	return voe ? ec_request_start(&voe->r, EC_REQUEST_OP_READ, 0) :
		     -EINVAL;
}

int ecrt_voe_handler_read_nosync(ec_voe_handler_t *voe)
{
	return voe ? ec_request_start(&voe->r, EC_REQUEST_OP_READ_NOW, 0) :
		     -EINVAL;
}

ec_request_state_t ecrt_voe_handler_execute(ec_voe_handler_t *voe)
{
	return voe ? ec_request_state(&voe->r) : EC_REQUEST_ERROR;
}
