/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* CANopen over EtherCAT: header, emergencies, abort codes (ETG.1000.6 clause 5.6). */
#ifndef EC_WIRE_COE_H
#define EC_WIRE_COE_H

#include "mbox.h"

#define EC_COE_HDR		2
#define EC_COE_EMERGENCY_SIZE	(EC_COE_HDR + 8)

enum ec_coe_service {
	EC_COE_EMERGENCY = 1,
	EC_COE_SDO_REQ = 2,
	EC_COE_SDO_RESP = 3,
	EC_COE_TXPDO = 4,
	EC_COE_RXPDO = 5,
	EC_COE_TXPDO_REMOTE = 6,
	EC_COE_RXPDO_REMOTE = 7,
	EC_COE_SDO_INFO = 8,
};

#define EC_ABORT_TOGGLE		0x05030000u
#define EC_ABORT_TIMEOUT	0x05040000u
#define EC_ABORT_COMMAND	0x05040001u
#define EC_ABORT_MEMORY		0x05040005u
#define EC_ABORT_ACCESS		0x06010000u
#define EC_ABORT_WRITE_ONLY	0x06010001u
#define EC_ABORT_READ_ONLY	0x06010002u
#define EC_ABORT_SUB0_FIRST	0x06010003u
#define EC_ABORT_CA_VARIABLE	0x06010004u
#define EC_ABORT_TOO_LONG_MBOX	0x06010005u
#define EC_ABORT_MAPPED		0x06010006u
#define EC_ABORT_NO_OBJECT	0x06020000u
#define EC_ABORT_NOT_MAPPABLE	0x06040041u
#define EC_ABORT_PDO_LENGTH	0x06040042u
#define EC_ABORT_PARAMETER	0x06040043u
#define EC_ABORT_INTERNAL	0x06040047u
#define EC_ABORT_HARDWARE	0x06060000u
#define EC_ABORT_LENGTH		0x06070010u
#define EC_ABORT_TOO_LONG	0x06070012u
#define EC_ABORT_TOO_SHORT	0x06070013u
#define EC_ABORT_NO_SUB		0x06090011u
#define EC_ABORT_RANGE		0x06090030u
#define EC_ABORT_TOO_HIGH	0x06090031u
#define EC_ABORT_TOO_LOW	0x06090032u
#define EC_ABORT_MODULES	0x06090033u
#define EC_ABORT_GENERAL	0x08000000u
#define EC_ABORT_STORE		0x08000020u
#define EC_ABORT_LOCAL		0x08000021u
#define EC_ABORT_STATE		0x08000022u
#define EC_ABORT_NO_DICT	0x08000023u

/**
 * struct ec_coe_hdr - CoE header, decoded
 * @number: PDO number, 0 for SDOs
 * @service: enum ec_coe_service
 */
struct ec_coe_hdr {
	u16 number;
	u8 service;
};

/**
 * struct ec_coe_emergency - emergency message
 * @code: error code, 0: error gone
 * @reg: copy of object 0x1001
 * @data: manufacturer's own
 */
struct ec_coe_emergency {
	u16 code;
	u8 reg;
	u8 data[5];
};

int ec_coe_hdr_decode(struct ec_rbuf *r, struct ec_coe_hdr *h);
void ec_coe_hdr_encode(struct ec_wbuf *w, u8 service);
const char *ec_coe_service_name(u8 service);

int ec_coe_emergency_decode(const u8 *rx, size_t len, struct ec_coe_emergency *e);
const char *ec_coe_emergency_text(u16 code);

const char *ec_coe_abort_text(u32 code);
int ec_coe_abort_errno(u32 code);
u32 ec_coe_errno_abort(int err);

#endif
