/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Who owns the links, and the cyclic exchange of an activated session.
 *
 * IDLE: whoever calls ec_xfer() sends at once, under io_lock. CYCLE: only the
 * cyclic caller sends and polls, the others leave their frames in a queue.
 * When the cyclic caller stalls, the monitor takes the links back.
 */
#ifndef EC_CYCLE_H
#define EC_CYCLE_H

#include <linux/types.h>

struct ec_master;
struct ec_session;
struct ec_slot;

enum ec_owner {
	EC_OWNER_IDLE,
	EC_OWNER_CYCLE,
};

/**
 * struct ec_cyc_dgram - one datagram of the cyclic layout, immutable in use
 * @domain: index
 * @cmd: LRD, LWR or LRW
 * @logical: logical address
 * @offset: of its data in the image of all domains
 * @len: bytes
 * @expected: working counter when every slave takes part
 * @frame: which cyclic frame of its domain set
 * @pos: of the data in the EtherCAT part of that frame
 */
struct ec_cyc_dgram {
	u16 domain;
	u8 cmd;
	u32 logical;
	u32 offset;
	u16 len;
	u16 expected;
	u16 pos;
};

/* a frame of the cycle that is on its way */
struct ec_cyc_flight {
	struct ec_slot *slot;
	u16 first;	/* datagram indexes of the layout it carries */
	u16 count;
	u16 pos[16];	/* of the data of each, in the EtherCAT part */
};

#define EC_CYC_FRAMES	64	/* in flight at most */

/**
 * struct ec_cyc_bits - input bits to copy out of a returned datagram
 * @dgram: index in the layout
 * @offset: byte in the image
 * @len: bytes
 */
struct ec_cyc_input {
	u16 dgram;
	u32 offset;
	u16 len;
};

/**
 * struct ec_cycle - cyclic layout and its state; owned by the cyclic caller
 * @dgrams: layout
 * @n_dgrams: entries in @dgrams
 * @inputs: input areas in order of their datagram
 * @n_inputs: entries in @inputs
 * @flight: frames on their way
 * @n_flight: entries in @flight
 * @cycles: sends so far
 */
struct ec_cycle {
	struct ec_cyc_dgram *dgrams;
	unsigned int n_dgrams;
	struct ec_cyc_input *inputs;
	unsigned int n_inputs;
	struct ec_cyc_flight flight[EC_CYC_FRAMES];
	unsigned int n_flight;
	u64 cycles;
};

int ec_cycle_submit(struct ec_master *m, struct ec_slot *slot);
u32 ec_cycle_timeout_us(const struct ec_master *m);
void ec_cycle_own(struct ec_master *m, enum ec_owner owner);
bool ec_cycle_stalled(struct ec_master *m);

int ec_cycle_layout(struct ec_session *s);
void ec_cycle_free(struct ec_master *m, struct ec_cycle *c);
int ec_cycle_receive(struct ec_session *s);
int ec_cycle_send(struct ec_session *s, u64 queued);

#endif
