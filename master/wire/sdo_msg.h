/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Messages of SDO transfers: for the client in sdo.c and the server of the simulator. */
#ifndef EC_WIRE_SDO_MSG_H
#define EC_WIRE_SDO_MSG_H

#include "sdo.h"

/* command byte */
#define CMD_SHIFT	5
#define CMD_BIT4	0x10	/* complete access, or toggle */
#define CMD_EXPEDITED	0x02
#define CMD_SIZE	0x01
#define SEG_LAST	0x01

/* bits 7-5 of requests (service 2) and responses (service 3) */
enum {
	REQ_DOWN_SEG = 0,
	REQ_DOWN = 1,
	REQ_UP = 2,
	REQ_UP_SEG = 3,
	REQ_ABORT = 4,
	RESP_UP_SEG = 0,
	RESP_DOWN_SEG = 1,
	RESP_UP = 2,
	RESP_DOWN = 3,
};

int ec_sdo_put(u8 *tx, size_t cap, u8 service, u8 cmd, u16 index, u8 sub, u32 arg);
int ec_sdo_put_abort(u8 *tx, size_t cap, u16 index, u8 sub, u32 abort);
int ec_sdo_put_object(u8 *tx, size_t cap, u8 service, u8 cmd, u16 index, u8 sub,
		      const u8 *data, size_t size, size_t *chunk);
int ec_sdo_put_segment(u8 *tx, size_t cap, u8 service, u8 cmd, const u8 *data, size_t n,
		       bool last);
size_t ec_sdo_segment_len(u8 cmd, size_t field);

#endif
