/* SPDX-License-Identifier: GPL-2.0-only */
/* Frames of several callers that leave as one. */
#ifndef EC_PACK_H
#define EC_PACK_H

#include "slots.h"

#define EC_PACKED	0x80	/* second octet of the source address, beside the side */

/**
 * struct ec_pack - frames that leave as one; owned by the cyclic caller
 * @e: their slots, in state FILL until the frame is sent or left
 * @n: how many
 * @len: bytes of the frame behind the EtherType
 * @dgrams: datagrams in it
 */
struct ec_pack {
	struct ec_queued e[EC_PACK_MAX];
	unsigned int n;
	unsigned int len;
	unsigned int dgrams;
};

/* room of a frame that several callers share */
struct ec_pack_room {
	unsigned int len;	/* bytes behind the EtherType */
	unsigned int dgrams;
};

void ec_pack_begin(struct ec_pack *p);
bool ec_pack_add(struct ec_pack *p, const struct ec_queued *e, const struct ec_pack_room *room);
void ec_pack_place(struct ec_slots *s, struct ec_pack *p, u64 sent_ns);
size_t ec_pack_write(const struct ec_pack *p, u8 *buf);
void ec_pack_release(struct ec_pack *p, enum ec_slot_state state);
void ec_pack_move(struct ec_pack *p, enum ec_slot_state from, enum ec_slot_state to);

/**
 * struct ec_pack_matched - callers whose frames have come back as one
 * @n: how many
 * @xfer: the callers; their slots may be in use by others already
 */
struct ec_pack_matched {
	unsigned int n;
	struct ec_xfer *xfer[EC_PACK_MAX];
};

enum ec_match ec_pack_match(struct ec_slots *s, const u8 *src, const u8 *data, size_t len,
			    struct ec_pack_matched *got);

#endif
