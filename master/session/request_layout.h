/* SPDX-License-Identifier: GPL-2.0-only */
/* The memory of requests: what an application maps, and where each request has its part. */
#ifndef EC_REQUEST_LAYOUT_H
#define EC_REQUEST_LAYOUT_H

#include <linux/types.h>

/* kind of struct ec_ioc_datagram_request, which is none of struct ec_ioc_sc_request */
#define EC_REQUEST_DATAGRAM	6

struct ec_requests;
struct ec_session;

/** struct ec_request_spec - a request to be made by activation */
struct ec_request_spec {
	/** @config: of the slave */
	u32 config;
	/** @kind: EC_REQUEST_* */
	u32 kind;
	/** @size: bytes of its data at most */
	u32 size;
};

int ec_requests_add(struct ec_session *s, u32 config, u32 kind, u32 size, u32 *index);
size_t ec_requests_bytes(const struct ec_session *s);
size_t ec_requests_buf_bytes(const struct ec_session *s);
unsigned int ec_requests_lanes(const struct ec_session *s);
void ec_requests_lay_out(struct ec_session *s, struct ec_requests *rq);
void ec_requests_describe(const struct ec_session *s);

#endif
