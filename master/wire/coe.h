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

/* SDO abort codes that the master sends; texts exist for all */
#define EC_ABORT_TOGGLE		0x05030000u
#define EC_ABORT_TIMEOUT	0x05040000u
#define EC_ABORT_COMMAND	0x05040001u
#define EC_ABORT_MEMORY		0x05040005u

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

int ec_coe_emergency_decode(const u8 *rx, size_t len, struct ec_coe_emergency *e);

const char *ec_coe_abort_text(u32 code);

#endif
