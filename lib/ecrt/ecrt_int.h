/* SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later */
/*
 * The part of ecrt.h that is written once and compiled twice, for libethercat and for
 * ec_master.ko: configuration, information and requests. A function builds the argument
 * of a command and executes it by ec_command(): ioctl() in a process, a call in the kernel.
 *
 * The header of each side, included below, has the handles (struct ec_master, ec_domain,
 * ec_slave_config), the inline functions that read them, and ec_command(), ec_complain(),
 * ec_zalloc(), ec_free().
 */
#ifndef EC_ECRT_INT_H
#define EC_ECRT_INT_H

#ifdef __KERNEL__
#include "../../master/boundary/api.h"
#define EC_IN_KERNEL const	/* of a parameter whose prototype differs */
#define EC_NO_SLAVE (-ENOENT)	/* ecrt_master_get_slave() of an empty position */
#define ec_no_result(size) (*(size) = 0)
#else
#include "../internal.h"
#define EC_IN_KERNEL
#define EC_NO_SLAVE (-EINVAL)
#define ec_no_result(size) ((void)(size))	/* untouched */
#endif

#define EC_U32_MAX	0xffffffffU

/**
 * struct ec_app_request - a request of any kind
 * @master: of the slave configuration
 * @next: in the list of @master
 * @index: in the session
 * @data: buffer, the application's
 * @room: its bytes
 * @size: of them used
 * @timeout_ms: of a start, 0: unlimited
 * @index16: object, IDN, register, type of a VoE message
 * @subindex: or drive; command of a datagram
 * @op: EC_REQUEST_OP_* of the last start
 * @flags: EC_SDO_FLAG_COMPLETE; of SDO information EC_SDO_INFO_*
 * @vendor_id: of a VoE message; password of a file; address of a datagram
 * @got_vendor_id: of the VoE message read last
 * @got_type: likewise; working counter of a datagram
 * @start: number of the last start
 * @state: as last seen
 * @rec: record in shared memory, NULL before activation
 * @shared: data of the record
 */
struct ec_app_request {
	struct ec_master *master;
	struct ec_app_request *next;
	unsigned int index;
	__u8 *data;
	size_t room;
	size_t size;
	__u32 timeout_ms;
	__u16 index16;
	__u8 subindex;
	__u8 op;
	__u32 flags;
	__u32 vendor_id;
	__u32 got_vendor_id;
	__u16 got_type;
	__u32 start;
	ec_request_state_t state;
	struct ec_request_record *rec;
	__u8 *shared;
};

struct ec_reg_request {
	struct ec_app_request r;
};

struct ec_datagram_request {
	struct ec_app_request r;
};

struct ec_sdo_request {
	struct ec_app_request r;
};

struct ec_soe_request {
	struct ec_app_request r;
};

struct ec_sdo_info_request {
	struct ec_app_request r;
};

struct ec_voe_handler {
	struct ec_app_request r;
};

/**
 * struct ec_foe_request - a file of a slave
 * @r: part of all requests
 * @name: of the file on the slave; all bytes, or up to a zero
 * @filling: a write whose content is not in shared memory yet
 * @copied: bytes copied between buffer and shared memory
 * @result: of the last transfer: 0 or -errno
 * @error_code: of the slave
 */
struct ec_foe_request {
	struct ec_app_request r;
	char name[EC_FOE_NAME];
	bool filling;
	size_t copied;
	int result;
	__u32 error_code;
};

/*
 * ec_do() executes a command. When the command fails, one line reports @fmt, which is an
 * infinitive without "to", and the reason that the command left. ec_fail() reports a call
 * that fails without a command. Macros with a slave configuration name it at the end of the
 * line; ec_do_valid() executes no command when an argument is invalid. Without a handle nothing
 * is reported. Each returns 0 or -errno.
 */
#define ec_do(m, cmd, arg, ...) \
	ec_complain(m, NULL, ec_give(m, cmd, arg), true, __VA_ARGS__)
#define ec_do_sc(sc, cmd, arg, ...) \
	ec_complain(ec_sc_master(sc), sc, ec_give(ec_sc_master(sc), cmd, arg), true, __VA_ARGS__)
#define ec_do_valid(sc, valid, cmd, arg, ...) \
	(!(sc) || (valid) ? ec_do_sc(sc, cmd, arg, __VA_ARGS__) : \
			    ec_fail_sc(sc, -EINVAL, __VA_ARGS__))
#define ec_fail(m, err, ...) ec_complain(m, NULL, err, false, __VA_ARGS__)
#define ec_fail_sc(sc, err, ...) ec_complain(ec_sc_master(sc), sc, err, false, __VA_ARGS__)

/* Size of a buffer in a command; one that is too large stays too large. */
static inline __u32 ec_u32(size_t size)
{
	return size > EC_U32_MAX ? EC_U32_MAX : (__u32)size;
}

int ec_give(const ec_master_t *m, unsigned int cmd, void *arg);

/* request.c: for all kinds of requests */
void *ec_app_request_create(ec_slave_config_t *sc, __u32 kind, size_t object, size_t size);
void *ec_app_request_create_datagram(ec_master_t *m, size_t object, size_t size);
ec_request_state_t ec_app_request_state(struct ec_app_request *r);
int ec_app_request_start(struct ec_app_request *r, __u8 op, size_t size);
void ec_app_request_give(struct ec_app_request *r, __u8 op, size_t size);
void ec_app_request_stop(struct ec_app_request *r);
int ec_app_request_cancel(struct ec_app_request *r);
int ec_app_requests_place(ec_master_t *m);
void ec_app_requests_free(ec_master_t *m);

/* cycle.c: a cycle that the kernel runs */
int ec_exchange_begin(struct ec_app_cycle *a, struct ec_exchange *x, size_t size,
		      const struct ec_status *st);
int ec_exchange_add(struct ec_domain *d);
int ec_exchange_receive(ec_master_t *m, const struct ec_status *st);
void ec_exchange_process(struct ec_domain *d);
void ec_exchange_queue(struct ec_domain *d);
int ec_exchange_send(ec_master_t *m, const struct ec_status *st);

#endif
