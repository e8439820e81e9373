/* SPDX-License-Identifier: GPL-2.0-only */
/* One request, as the files that work on requests see it. */
#ifndef EC_REQUEST_INT_H
#define EC_REQUEST_INT_H

#include <linux/kref.h>
#include <linux/list.h>
#include <linux/mutex.h>
#include <linux/types.h>
#include <linux/workqueue.h>
#include "../include/uapi/ethercat.h"
#include "../mailbox/emerg.h"

struct ec_session;
struct ec_sessions;
struct ec_shared;
struct ec_slave;

enum ec_request_phase {
	EC_REQUEST_IDLE,
	EC_REQUEST_PENDING,
	EC_REQUEST_RUNNING,
};

/**
 * struct ec_request_result - how a request has ended
 * @err: 0 or -errno
 * @got: bytes read
 * @code: of the slave: SDO abort code, SoE or FoE error code
 * @vendor: VoE: of the message read
 * @type: likewise; datagram: working counter
 */
struct ec_request_result {
	int err;
	size_t got;
	u32 code;
	u32 vendor;
	u16 type;
};

/**
 * struct ec_request - the kernel's side of one request
 * @list: in its request queue
 * @rec: mapped by the application; read once, when a start is seen
 * @kind: EC_REQUEST_SDO...
 * @cap: bytes of @data at most
 * @data: data of the request, mapped
 * @seq: number of the last start seen
 * @phase: how far it is
 * @since_ns: when that start was seen (ktime)
 * @timeout_ms: limit until the transfer begins, 0: unlimited
 * @index: object, register address, IDN or type of a VoE message
 * @sub: subindex or drive
 * @op: EC_REQUEST_OP_*
 * @complete: SDO: complete access
 * @what: SDO information: EC_SDO_INFO_*
 * @vendor: VoE: vendor id; FoE: password
 * @size: bytes to transfer; of a read at most
 * @recorded: it is recorded to be replayed, see ec_replay_record()
 * @stop: the application has cancelled it, or its session has ended
 * @buf: private copy of the data, @cap bytes; FoE: of the name
 * @res: result; of the worker while it is RUNNING
 */
struct ec_request {
	struct list_head list;
	struct ec_request_record *rec;
	u32 kind;
	u32 cap;
	u8 *data;
	u32 seq;
	enum ec_request_phase phase;
	u64 since_ns;
	u32 timeout_ms;
	u16 index;
	u8 sub;
	u8 op;
	bool complete;
	u8 what;
	u32 vendor;
	u32 size;
	bool recorded;
	bool stop;
	u8 *buf;
	struct ec_request_result res;
};

/**
 * struct ec_lane - request queue: requests that are executed one after the other
 * @work: executes them
 * @rq: all request queues
 * @config: number of the configuration they belong to; %EC_UAPI_NONE32: datagrams, of none
 * @requests: of this queue
 * @emerg: ring of emergencies of the configuration
 * @voe: the configuration has VoE handlers
 * @files: queue of its files, or NULL
 *
 * First one queue for each configuration, with @emerg, @voe and @files. Then one for each VoE
 * handler, so that a handler that waits for a message does not delay other requests, one for the
 * files of each configuration, which take long, and one for each datagram.
 */
struct ec_lane {
	struct work_struct work;
	struct ec_requests *rq;
	u32 config;
	struct list_head requests;
	struct ec_emerg emerg;
	bool voe;
	struct ec_lane *files;
};

/**
 * struct ec_requests - all requests of an activation
 * @kref: the session and each work that is queued or runs
 * @sessions: of the master
 * @shared: mapped memory, with a reference
 * @lock: protects the requests; inside session lock
 * @starts: the area's, as ec_requests_notice() last saw it
 * @kick: checks the requests once
 * @watch: checks them periodically while one waits
 * @reqs: requests
 * @bufs: private copies of all data but files, allocated by the application that activates, as its
 *	memory
 * @lanes: request queues
 * @n_lanes: entries in @lanes
 */
struct ec_requests {
	struct kref kref;
	struct ec_sessions *sessions;
	struct ec_shared *shared;
	struct mutex lock;
	u32 starts;
	struct work_struct kick;
	struct work_struct watch;
	struct ec_request *reqs;
	u8 *bufs;
	struct ec_lane *lanes;
	unsigned int n_lanes;
};

/* A file goes between mapped memory and mailbox packet by packet; @buf has its name. */
static inline bool ec_request_is_file(const struct ec_request *r)
{
	return r->kind == EC_REQUEST_FOE;
}

static inline bool ec_request_reads(const struct ec_request *r)
{
	return r->op != EC_REQUEST_OP_WRITE;
}

static inline bool ec_request_writes(const struct ec_request *r)
{
	return r->op == EC_REQUEST_OP_WRITE || r->op == EC_REQUEST_OP_READWRITE;
}

/* Time (ktime) until which a request has to begin; 0: unlimited. */
static inline u64 ec_request_begin_ns(const struct ec_request *r)
{
	return r->timeout_ms ? r->since_ns + (u64)r->timeout_ms * NSEC_PER_MSEC : 0;
}

#endif
