/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * Server of SDO information (ETG.1000.6 clause 5.6.3): reads requests and writes an answer of any
 * size in as many fragments as it needs.
 */
#ifndef EC_SIM_SDOINFO_SERVER_H
#define EC_SIM_SDOINFO_SERVER_H

#include "../../master/wire/sdoinfo.h"
#include "codes.h"

/**
 * struct ec_sdoinfo_req - a request as the server sees it
 * @opcode: EC_SDOINFO_LIST_REQ...
 * @index: object, or list type
 * @sub: subindex
 * @info: optional fields asked for
 */
struct ec_sdoinfo_req {
	u8 opcode;
	u16 index;
	u8 sub;
	u8 info;
};

/**
 * struct ec_sdoinfo_resp - an answer on its way out
 * @opcode: EC_SDOINFO_LIST_RESP...
 * @data: body; of a list the list type first, then the indexes
 * @size: bytes at @data
 * @pos: bytes sent
 * @done: the last fragment is out
 */
struct ec_sdoinfo_resp {
	u8 opcode;
	const u8 *data;
	size_t size;
	size_t pos;
	bool done;
};

int ec_sdoinfo_req_decode(const u8 *rx, size_t len, struct ec_sdoinfo_req *req);
int ec_od_object_encode(u8 *buf, size_t cap, const struct ec_od_object *o);
int ec_od_entry_encode(u8 *buf, size_t cap, const struct ec_od_entry *e,
		       const struct ec_od_values *v);
void ec_sdoinfo_resp_init(struct ec_sdoinfo_resp *r, u8 opcode, const u8 *data, size_t size);
int ec_sdoinfo_resp_next(struct ec_sdoinfo_resp *r, u8 *tx, size_t cap);
int ec_sdoinfo_error_encode(u8 *tx, size_t cap, u32 abort);

#endif
