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

/** struct ec_request_result - how a request has ended */
struct ec_request_result {
	/** @err: 0 or -errno */
	int err;
	/** @got: bytes read */
	size_t got;
	/** @code: of the slave: SDO abort code, SoE or FoE error code */
	u32 code;
	/** @vendor: VoE: of the message read */
	u32 vendor;
	/** @type: likewise; datagram: working counter */
	u16 type;
};

/** struct ec_request - the kernel's side of one request */
struct ec_request {
	/** @list: in its request queue */
	struct list_head list;
	/** @rec: mapped by the application; read once, when a start is seen */
	struct ec_request_record *rec;
	/** @kind: EC_REQUEST_SDO... */
	u32 kind;
	/** @cap: bytes of @data at most */
	u32 cap;
	/** @data: data of the request, mapped */
	u8 *data;
	/** @seq: number of the last start seen */
	u32 seq;
	/** @phase: how far it is */
	enum ec_request_phase phase;
	/** @since_ns: when that start was seen (ktime) */
	u64 since_ns;
	/** @timeout_ms: limit until the transfer begins, 0: unlimited */
	u32 timeout_ms;
	/** @index: object, register address, IDN or type of a VoE message */
	u16 index;
	/** @sub: subindex or drive */
	u8 sub;
	/** @op: EC_REQUEST_OP_* */
	u8 op;
	/** @complete: SDO: complete access */
	bool complete;
	/** @what: SDO information: EC_SDO_INFO_* */
	u8 what;
	/** @vendor: VoE: vendor id; FoE: password */
	u32 vendor;
	/** @size: bytes to transfer; of a read at most */
	u32 size;
	/** @recorded: it is recorded to be replayed, see ec_replay_record() */
	bool recorded;
	/** @stop: the application has cancelled it, or its session has ended */
	bool stop;
	/** @buf: private copy of the data, @cap bytes; FoE: of the name */
	u8 *buf;
	/** @res: result; of the worker while it is RUNNING */
	struct ec_request_result res;
};

/**
 * struct ec_lane - request queue: requests that are executed one after the other
 *
 * First one queue for each configuration, with @emerg, @voe and @files. Then one for each VoE
 * handler, so that a handler that waits for a message does not delay other requests, one for the
 * files of each configuration, which take long, and one for each datagram.
 */
struct ec_lane {
	/** @work: executes them */
	struct work_struct work;
	/** @rq: all request queues */
	struct ec_requests *rq;
	/**
	 * @config: number of the configuration they belong to; %EC_UAPI_NONE32: datagrams, of none
	 */
	u32 config;
	/** @requests: of this queue */
	struct list_head requests;
	/** @emerg: ring of emergencies of the configuration */
	struct ec_emerg emerg;
	/** @voe: the configuration has VoE handlers */
	bool voe;
	/** @files: queue of its files, or NULL */
	struct ec_lane *files;
};

/** struct ec_requests - all requests of an activation */
struct ec_requests {
	/** @kref: the session and each work that is queued or runs */
	struct kref kref;
	/** @sessions: of the master */
	struct ec_sessions *sessions;
	/** @shared: mapped memory, with a reference */
	struct ec_shared *shared;
	/** @lock: protects the requests; inside session lock */
	struct mutex lock;
	/** @starts: the area's, as ec_requests_notice() last saw it */
	u32 starts;
	/** @kick: checks the requests once */
	struct work_struct kick;
	/** @watch: checks them periodically while one waits */
	struct work_struct watch;
	/** @reqs: requests */
	struct ec_request *reqs;
	/**
	 * @bufs: private copies of all data but files, allocated by the application that activates,
	 * as its memory
	 */
	u8 *bufs;
	/** @lanes: request queues */
	struct ec_lane *lanes;
	/** @n_lanes: entries in @lanes */
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
