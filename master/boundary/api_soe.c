// SPDX-License-Identifier: GPL-2.0-only
/* IDNs of servo drives, for applications in the kernel: at once, at startup, requests. */
#include <linux/mm.h>
#include "api_request.h"
#include "../wire/soe.h"

/* at once --------------------------------------------------------------------*/

static int ended(struct ec_master *m, const struct ec_ioc_soe *i, int ret, u16 *error_code,
		 const char *what)
{
	if (error_code)
		*error_code = ret == -EIO ? i->error_code : 0;
	if (!ret)
		return 0;
	return ec_api_fail(m, ret == -ENOENT ? -EINVAL : ret,
			   "%s IDN 0x%04x of drive %u of slave %u", what, i->idn, i->drive,
			   i->position);
}

int ecrt_master_write_idn(ec_master_t *master, uint16_t slave_position, uint8_t drive_no,
			  uint16_t idn, const uint8_t *data, size_t data_size,
			  uint16_t *error_code)
{
	struct ec_ioc_soe i = {
		.position = slave_position, .idn = idn, .drive = drive_no,
		.size = min_t(size_t, data_size, U32_MAX),
	};

	if (error_code)
		*error_code = 0;
	if (!master || !data)
		return -EINVAL;
	i.data = (uintptr_t)data;
	return ended(master, &i, ec_command(master, EC_IOC_SOE_WRITE, &i), error_code, "write");
}
EXPORT_SYMBOL_GPL(ecrt_master_write_idn);

int ecrt_master_read_idn(ec_master_t *master, uint16_t slave_position, uint8_t drive_no,
			 uint16_t idn, uint8_t *target, size_t target_size, size_t *result_size,
			 uint16_t *error_code)
{
	struct ec_ioc_soe i = {
		.position = slave_position, .idn = idn, .drive = drive_no,
		.size = min_t(size_t, target_size, U32_MAX),
	};
	int ret;

	if (error_code)
		*error_code = 0;
	if (result_size)
		*result_size = 0;
	if (!master || (!target && target_size) || !result_size)
		return -EINVAL;
	i.data = (uintptr_t)target;
	ret = ec_command(master, EC_IOC_SOE_READ, &i);
	if (!ret)
		*result_size = i.size;
	return ended(master, &i, ret, error_code, "read");
}
EXPORT_SYMBOL_GPL(ecrt_master_read_idn);

/* at startup -----------------------------------------------------------------*/

int ecrt_slave_config_idn(ec_slave_config_t *sc, uint8_t drive_no, uint16_t idn,
			  ec_al_state_t state, const uint8_t *data, size_t size)
{
	struct ec_ioc_sc_idn i = {
		.idn = idn, .drive = drive_no, .state = min_t(unsigned int, state, U8_MAX),
		.size = min_t(size_t, size, U32_MAX),
	};
	int ret;

	if (!sc || !data)
		return -EINVAL;
	i.config = ec_api_config(sc)->index;
	i.data = (uintptr_t)data;
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_IDN, &i);
	return ret ? ec_api_fail_sc(sc, ret, "store IDN 0x%04x of drive %u", idn, drive_no) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_idn);

/* beside the cycle -----------------------------------------------------------*/

ec_soe_request_t *ecrt_slave_config_create_soe_request(ec_slave_config_t *sc, uint8_t drive_no,
						       uint16_t idn, size_t size)
{
	struct ec_api_request *r;

	if (!sc)
		return NULL;
	if (drive_no >= EC_SOE_DRIVES) {
		ec_api_fail_sc(sc, -EINVAL, "create a request for drive %u, only 0 to 7,", drive_no);
		return NULL;
	}
	r = ec_api_request_create(sc, EC_REQUEST_SOE, size);
	if (!r)
		return NULL;
	r->index = idn;
	r->sub = drive_no;
	return container_of(r, struct ec_soe_request, r);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_soe_request);

int ecrt_soe_request_idn(ec_soe_request_t *req, uint8_t drive_no, uint16_t idn)
{
	if (!req || drive_no >= EC_SOE_DRIVES)
		return -EINVAL;
	if (ec_api_request_state(&req->r) == EC_REQUEST_BUSY)
		return -EBUSY;
	req->r.index = idn;
	req->r.sub = drive_no;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_idn);

int ecrt_soe_request_timeout(ec_soe_request_t *req, uint32_t timeout)
{
	if (!req)
		return -EINVAL;
	req->r.timeout_ms = timeout;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_timeout);

uint8_t *ecrt_soe_request_data(const ec_soe_request_t *req)
{
	return req ? req->r.data : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_data);

size_t ecrt_soe_request_data_size(const ec_soe_request_t *req)
{
	return req ? req->r.size : 0;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_data_size);

/* The prototype says const; what it points to never is. */
ec_request_state_t ecrt_soe_request_state(const ec_soe_request_t *req)
{
	return req ? ec_api_request_state((struct ec_api_request *)&req->r) : EC_REQUEST_ERROR;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_state);

int ecrt_soe_request_write(ec_soe_request_t *req)
{
	if (!req || !req->r.size)
		return -EINVAL;
	return ec_api_request_start(&req->r, EC_REQUEST_OP_WRITE, req->r.size);
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_write);

int ecrt_soe_request_read(ec_soe_request_t *req)
{
	return req ? ec_api_request_start(&req->r, EC_REQUEST_OP_READ, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_soe_request_read);
