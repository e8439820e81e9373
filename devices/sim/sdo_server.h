/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* SDO server of a slave (ETG.1000.6 clause 5.6.2) without I/O: a request in, an answer out. */
#ifndef EC_SIM_SDO_SERVER_H
#define EC_SIM_SDO_SERVER_H

#include "../../master/wire/coe.h"
#include "codes.h"

/**
 * struct ec_sdo_srv_ops - object dictionary behind an SDO server
 * @read: copy an object to @buf and set @len; returns 0 or an abort code
 * @write: take an object; returns 0 or an abort code
 */
struct ec_sdo_srv_ops {
	u32 (*read)(void *ctx, u16 index, u8 sub, bool complete, u8 *buf, size_t cap, size_t *len);
	u32 (*write)(void *ctx, u16 index, u8 sub, bool complete, const u8 *data, size_t len);
};

enum ec_sdo_srv_state {
	EC_SDO_SRV_IDLE,
	EC_SDO_SRV_UPLOAD,
	EC_SDO_SRV_DOWNLOAD,
};

/**
 * struct ec_sdo_srv - SDO server of a slave
 * @ops: object dictionary
 * @ctx: its argument
 * @buf: transfer buffer
 * @cap: bytes at @buf: the largest object
 * @state: segmented transfer under way
 * @index: its object
 * @sub: its subindex
 * @complete: complete access
 * @size: bytes of the object
 * @pos: bytes moved
 * @toggle: toggle bit expected
 */
struct ec_sdo_srv {
	const struct ec_sdo_srv_ops *ops;
	void *ctx;
	u8 *buf;
	size_t cap;
	enum ec_sdo_srv_state state;
	u16 index;
	u8 sub;
	bool complete;
	size_t size;
	size_t pos;
	u8 toggle;
};

void ec_sdo_srv_init(struct ec_sdo_srv *srv, const struct ec_sdo_srv_ops *ops, void *ctx,
		     u8 *buf, size_t cap);
int ec_sdo_srv_handle(struct ec_sdo_srv *srv, const u8 *req, size_t len, u8 *resp, size_t cap);

#endif
