/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Requests of the application that run beside its cycle: SDOs, registers, IDNs,
 * VoE messages, files, the object dictionary, datagrams.
 *
 * Their records are in memory that the application has mapped. It starts a request
 * there, and reports the start with its next send; for a kernel cycle it counts the
 * start there. From then on the kernel works with its own copy. Each configuration
 * has a request queue: a worker that executes one request after the other, so that
 * a slow slave does not delay the others.
 */
#ifndef EC_REQUEST_H
#define EC_REQUEST_H

#include <linux/types.h>

struct ec_config;
struct ec_cycle;
struct ec_emerg;
struct ec_request_record;
struct ec_session;

int ec_requests_begin(struct ec_session *s);
void ec_requests_end(struct ec_session *s);
void ec_requests_kick(struct ec_session *s);
void ec_requests_attach(const struct ec_session *s, const struct ec_config *c);
struct ec_request_record *ec_requests_record(const struct ec_session *s, u32 index, u8 **data);
struct ec_emerg *ec_requests_emerg(const struct ec_session *s, u32 config);
void ec_requests_notice(struct ec_cycle *c);

#endif
