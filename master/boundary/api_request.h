/* SPDX-License-Identifier: GPL-2.0-only */
/* Requests of applications in the kernel, of any kind. */
#ifndef EC_API_REQUEST_H
#define EC_API_REQUEST_H

#include "api.h"

/**
 * struct ec_api_request - one request; but for @list the cyclic caller's
 * @list: in struct ec_api
 * @m: master
 * @number: in the session
 * @data: buffer
 * @room: its bytes
 * @size: of them used
 * @timeout_ms: to begin with a start; 0: unlimited
 * @index: object, register address, IDN or type of a VoE message
 * @sub: subindex or drive
 * @vendor: VoE: vendor id
 * @op: EC_REQUEST_OP_* of the last start
 * @start: number of the last start
 * @state: as last seen
 * @got_vendor: VoE: of the message read last
 * @got_type: likewise
 * @rec: record, NULL before activation
 * @shared: data of the record
 */
struct ec_api_request {
	struct list_head list;
	struct ec_master *m;
	u32 number;
	u8 *data;
	size_t room;
	size_t size;
	u32 timeout_ms;
	u16 index;
	u8 sub;
	u32 vendor;
	u8 op;
	u32 start;
	ec_request_state_t state;
	u32 got_vendor;
	u16 got_type;
	struct ec_request_record *rec;
	u8 *shared;
};

/* Each handle of the interface is a request and nothing else. */
struct ec_sdo_request {
	struct ec_api_request r;
};

struct ec_soe_request {
	struct ec_api_request r;
};

struct ec_voe_handler {
	struct ec_api_request r;
};

struct ec_reg_request {
	struct ec_api_request r;
};

struct ec_api_request *ec_api_request_create(ec_slave_config_t *sc, u32 kind, size_t size);
ec_request_state_t ec_api_request_state(struct ec_api_request *r);
int ec_api_request_start(struct ec_api_request *r, u8 op, size_t size);

#endif
