// SPDX-License-Identifier: LGPL-2.1-or-later
/* IDNs of servo drives: at once, at startup, beside the cycle. */
#include "internal.h"

#define DRIVES	8

struct ec_soe_request {
	struct ec_request r;
};

/* at once --------------------------------------------------------------------*/

static int transfer(ec_master_t *master, unsigned long cmd,
		    struct ec_ioc_soe *soe, uint16_t *error_code)
{
	int ret;

	if (error_code)
		*error_code = 0;
	if (!master || (!soe->data && soe->size))
		return -EINVAL;
	if (soe->drive >= DRIVES)
		return ec_fail(-EINVAL, "use drive %u; there are 0 to 7",
			       soe->drive);
	ret = ec_ioctl(master, cmd, soe);
	if (!ret)
		return 0;
	if (ret == -EIO && error_code)
		*error_code = (uint16_t)soe->error_code;
	return ec_fail_ioctl(master, ec_not_there(ret),
			     "%s IDN 0x%04x of drive %u of slave %u",
			     cmd == EC_IOC_SOE_READ ? "read" : "write",
			     soe->idn, soe->drive, soe->position);
}

static __u32 limited(size_t size)
{
	return size > UINT32_MAX ? UINT32_MAX : (__u32)size;
}

int ecrt_master_read_idn(ec_master_t *master, uint16_t slave_position,
			 uint8_t drive_no, uint16_t idn, uint8_t *target,
			 size_t target_size, size_t *result_size,
			 uint16_t *error_code)
{
	struct ec_ioc_soe soe = {
		.position = slave_position,
		.idn = idn,
		.drive = drive_no,
		.size = limited(target_size),
		.data = (uintptr_t)target,
	};
	int ret;

	if (!result_size)
		return -EINVAL;
	ret = transfer(master, EC_IOC_SOE_READ, &soe, error_code);
	if (!ret)
		*result_size = soe.size;
	return ret;
}

int ecrt_master_write_idn(ec_master_t *master, uint16_t slave_position,
			  uint8_t drive_no, uint16_t idn, const uint8_t *data,
			  size_t data_size, uint16_t *error_code)
{
	struct ec_ioc_soe soe = {
		.position = slave_position,
		.idn = idn,
		.drive = drive_no,
		.size = limited(data_size),
		.data = (uintptr_t)data,
	};

	return transfer(master, EC_IOC_SOE_WRITE, &soe, error_code);
}

/* at startup -----------------------------------------------------------------*/

int ecrt_slave_config_idn(ec_slave_config_t *sc, uint8_t drive_no,
			  uint16_t idn, ec_al_state_t state,
			  const uint8_t *data, size_t size)
{
	struct ec_ioc_sc_idn arg = {
		.idn = idn,
		.drive = drive_no,
		.state = (__u8)state,
		.size = limited(size),
		.data = (uintptr_t)data,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	if (!data || !size || drive_no >= DRIVES ||
	    (state != EC_AL_STATE_PREOP && state != EC_AL_STATE_SAFEOP))
		return ec_fail(-EINVAL,
			       "store IDN 0x%04x of drive %u for slave %u:%u",
			       idn, drive_no, sc->alias, sc->position);
	arg.config = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_SC_IDN, &arg);
	return ret ? ec_fail_ioctl(sc->master, ret,
				   "store IDN 0x%04x of drive %u for slave %u:%u",
				   idn, drive_no, sc->alias, sc->position) : 0;
}

/* beside the cycle -----------------------------------------------------------*/

ec_soe_request_t *ecrt_slave_config_create_soe_request(ec_slave_config_t *sc,
						       uint8_t drive_no,
						       uint16_t idn,
						       size_t size)
{
	ec_soe_request_t *req;

	if (drive_no >= DRIVES) {
		ec_fail(-EINVAL, "use drive %u; there are 0 to 7", drive_no);
		errno = EINVAL;
		return NULL;
	}
	req = ec_request_create(sc, EC_REQUEST_SOE, size);
	if (req) {
		req->r.index16 = idn;
		req->r.subindex = drive_no;
	}
	return req;
}

int ecrt_soe_request_idn(ec_soe_request_t *req, uint8_t drive_no, uint16_t idn)
{
	if (!req || drive_no >= DRIVES)
		return -EINVAL;
	if (ec_request_state(&req->r) == EC_REQUEST_BUSY)
		return -EBUSY;
	req->r.index16 = idn;
	req->r.subindex = drive_no;
	return 0;
}

int ecrt_soe_request_timeout(ec_soe_request_t *req, uint32_t timeout)
{
	if (!req)
		return -EINVAL;
	req->r.timeout_ms = timeout;
	return 0;
}

uint8_t *ecrt_soe_request_data(const ec_soe_request_t *req)
{
	return req ? req->r.data : NULL;
}

size_t ecrt_soe_request_data_size(const ec_soe_request_t *req)
{
	return req ? req->r.size : 0;
}

ec_request_state_t ecrt_soe_request_state(ec_soe_request_t *req)
{
	return req ? ec_request_state(&req->r) : EC_REQUEST_ERROR;
}

int ecrt_soe_request_write(ec_soe_request_t *req)
{
	if (!req || !req->r.size)
		return -EINVAL;
	return ec_request_start(&req->r, EC_REQUEST_OP_WRITE, req->r.size);
}

int ecrt_soe_request_read(ec_soe_request_t *req)
{
	if (!req)
		return -EINVAL;
	return ec_request_start(&req->r, EC_REQUEST_OP_READ, 0);
}
