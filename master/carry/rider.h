/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Riders: datagrams of the master in frames of the cycle, behind the process data. They need no
 * frame of their own, and no domain counts them.
 *
 *   IDLE -> QUEUED -> HELD -> SENT -> HELD -> BACK -> IDLE
 *              \----------------\-> IDLE  (its owner ends it)
 */
#ifndef EC_RIDER_H
#define EC_RIDER_H

#include <linux/atomic.h>
#include <linux/completion.h>
#include <linux/types.h>

struct ec_frame_buf;
struct ec_links;

#define EC_RIDERS	8	/* of a master */
#define EC_RIDER_BYTES	8

enum ec_rider_state {
	EC_RIDER_IDLE,
	EC_RIDER_QUEUED,
	EC_RIDER_HELD,
	EC_RIDER_SENT,
	EC_RIDER_BACK,
};

/** struct ec_rider - one datagram; it belongs to its owner while it is IDLE */
struct ec_rider {
	/** @state: enum ec_rider_state */
	atomic_t state;
	/** @number: bit in the masks of struct ec_riders, immutable */
	u8 number;
	/** @seq: number of the frame that carries it */
	u32 seq;
	/** @cmd: enum ec_cmd */
	u8 cmd;
	/** @adp: low half of the address */
	u16 adp;
	/** @ado: high half of the address */
	u16 ado;
	/** @len: data bytes */
	u16 len;
	/** @data: sent; then that of the reply */
	u8 data[EC_RIDER_BYTES];
	/** @wkc: result: working counter */
	u16 wkc;
	/** @back: result: @adp of the reply */
	u16 back;
	/** @irq: result: OR of the enabled events of the slaves passed */
	u16 irq;
	/** @done: completed when the reply is received */
	struct completion done;
};

/** struct ec_riders - riders of a master */
struct ec_riders {
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @rider: all of them, NULL: none with this number */
	struct ec_rider *rider[EC_RIDERS];
	/** @queued: mask of riders that may wait for a frame */
	atomic_t queued;
	/** @seq: number of the last frame that carried riders; written by the cycle owner */
	u32 seq;
};

/** struct ec_riding - riders in one frame; 0: none */
struct ec_riding {
	/** @mask: their numbers; in the frame they are in this order */
	u32 mask;
	/** @seq: number of the frame */
	u32 seq;
};

int ec_rider_register(struct ec_riders *rs, struct ec_rider *r);
void ec_rider_begin(struct ec_riders *rs, struct ec_rider *r);
bool ec_rider_is_back(const struct ec_rider *r);
void ec_rider_again(struct ec_riders *rs, struct ec_rider *r);
int ec_rider_end(struct ec_rider *r);
int ec_rider_exchange(struct ec_riders *rs, struct ec_rider *r);
int ec_rider_exchange_all(struct ec_riders *rs, struct ec_rider *r, unsigned int n);
void ec_riders_add(struct ec_riders *rs, struct ec_frame_buf *fb, u8 index,
		   struct ec_riding *riding);
void ec_riders_return(struct ec_riders *rs, const struct ec_riding *riding);
void ec_riders_take(struct ec_riders *rs, const struct ec_riding *riding, const u8 *at,
		    const u8 *end);

#endif
