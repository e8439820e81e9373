// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Requests through the mailbox: SDOs, IDNs of servo drives, VoE. */
#include "ecrt_int.h"

#define DRIVES	8

/* For SDO and IDN requests: @index and @subindex, or IDN and drive. */
static int aim(struct ec_app_request *r, uint16_t index, uint8_t subindex, __u32 flags)
{
	if (ec_app_request_state(r) == EC_REQUEST_BUSY)
		return -EBUSY;
	r->index16 = index;
	r->subindex = subindex;
	r->flags = flags;
	return 0;
}

static void *create(ec_slave_config_t *sc, __u32 kind, uint16_t index, uint8_t subindex,
		    __u32 flags, size_t size)
{
	struct ec_app_request *r = ec_app_request_create(sc, kind, sizeof(*r), size);

	if (r)
		aim(r, index, subindex, flags);
	return r;
}

/* A value of @size bytes; an empty one is not written. */
static int write_sized(struct ec_app_request *r, size_t size)
{
	return size ? ec_app_request_start(r, EC_REQUEST_OP_WRITE, size) : -EINVAL;
}

/* SDOs ---------------------------------------------------------------------*/

ec_sdo_request_t *ecrt_slave_config_create_sdo_request(ec_slave_config_t *sc, uint16_t index,
						       uint8_t subindex, size_t size)
{
	return create(sc, EC_REQUEST_SDO, index, subindex, 0, size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_sdo_request);

ec_sdo_request_t *ecrt_slave_config_create_sdo_request_complete(ec_slave_config_t *sc,
								uint16_t index, size_t size)
{
	return create(sc, EC_REQUEST_SDO, index, 0, EC_SDO_FLAG_COMPLETE, size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_sdo_request_complete);

int ecrt_sdo_request_index(ec_sdo_request_t *req, uint16_t index, uint8_t subindex)
{
	return req ? aim(&req->r, index, subindex, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_index);

int ecrt_sdo_request_index_complete(ec_sdo_request_t *req, uint16_t index)
{
	return req ? aim(&req->r, index, 0, EC_SDO_FLAG_COMPLETE) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_index_complete);

int ecrt_sdo_request_write(ec_sdo_request_t *req)
{
	return req ? write_sized(&req->r, req->r.size) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_write);

int ecrt_sdo_request_write_with_size(ec_sdo_request_t *req, size_t size)
{
	return req ? write_sized(&req->r, size) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_request_write_with_size);

/* IDNs ---------------------------------------------------------------------*/

ec_soe_request_t *ecrt_slave_config_create_soe_request(ec_slave_config_t *sc, uint8_t drive_no,
						       uint16_t idn, size_t size)
{
	if (sc && drive_no >= DRIVES) {
		ec_fail_sc(sc, -EINVAL, "use drive %u, only 0 to 7,", drive_no);
		return ec_no_handle(-EINVAL);
	}
	return create(sc, EC_REQUEST_SOE, idn, drive_no, 0, size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_soe_request);

int ecrt_soe_request_idn(ec_soe_request_t *req, uint8_t drive_no, uint16_t idn)
{
	return req && drive_no < DRIVES ? aim(&req->r, idn, drive_no, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_idn);

int ecrt_soe_request_write(ec_soe_request_t *req)
{
	return req ? write_sized(&req->r, req->r.size) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_write);

/* VoE: messages of the vendor ------------------------------------------------*/

ec_voe_handler_t *ecrt_slave_config_create_voe_handler(ec_slave_config_t *sc, size_t size)
{
	return ec_app_request_create(sc, EC_REQUEST_VOE, sizeof(ec_voe_handler_t), size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_voe_handler);

int ecrt_voe_handler_send_header(ec_voe_handler_t *voe, uint32_t vendor_id, uint16_t vendor_type)
{
	if (!voe)
		return -EINVAL;
	voe->r.vendor_id = vendor_id;
	voe->r.index16 = vendor_type;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_send_header);

int ecrt_voe_handler_received_header(const ec_voe_handler_t *voe, uint32_t *vendor_id,
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
EXPORT_SYMBOL_GPL(ecrt_voe_handler_received_header);

/* A message may be empty. */
int ecrt_voe_handler_write(ec_voe_handler_t *voe, size_t size)
{
	return voe ? ec_app_request_start(&voe->r, EC_REQUEST_OP_WRITE, size) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_voe_handler_write);

