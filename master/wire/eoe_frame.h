/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Ethernet over EtherCAT: fragments of Ethernet frames (ETG.1000.6 clause 5.7). */
#ifndef EC_WIRE_EOE_FRAME_H
#define EC_WIRE_EOE_FRAME_H

#include "eoe.h"

#define EC_EOE_FRAME_MIN	60	/* bytes without FCS; a shorter one is padded */
#define EC_EOE_FRAME_MAX	1518	/* with a VLAN tag, without FCS */
#define EC_EOE_UNIT		32	/* fragments but the last one are a multiple */

/**
 * struct ec_eoe_fragment - part of a frame
 * @port: of the slave, 0: not given
 * @number: in the frame, from 0
 * @frame: number of the frame, modulo 16
 * @last: the frame ends with it
 * @time_request: the sender wants to know when the frame is sent
 * @units: of EC_EOE_UNIT bytes: size of the whole frame, rounded up, when
 *	@number is 0; else the offset of @data in the frame
 * @data: bytes of the frame
 * @len: how many, without the time stamp behind them
 */
struct ec_eoe_fragment {
	u8 port;
	u8 number;
	u8 frame;
	bool last;
	bool time_request;
	u16 units;
	const u8 *data;
	u16 len;
};

/**
 * struct ec_eoe_part - a frame that is put together; its bytes belong to the caller
 * @len: bytes so far
 * @next: number of the fragment that follows
 * @port: of the last fragment seen, that of the frame when it is complete
 * @frame: number of the frame
 * @open: fragments are missing
 * @room: bytes it may have
 */
struct ec_eoe_part {
	u16 len;
	u8 next;
	u8 port;
	u8 frame;
	bool open;
	u16 room;
};

int ec_eoe_fragment_decode(const u8 *rx, size_t len, struct ec_eoe_fragment *f);
int ec_eoe_fragment_encode(u8 *tx, size_t cap, const struct ec_eoe_fragment *f);
unsigned int ec_eoe_fragment_room(unsigned int mailbox);
unsigned int ec_eoe_fragment_cut(struct ec_eoe_fragment *f, const u8 *frame, u16 frame_len,
				 u16 at, u8 number, unsigned int mailbox);
int ec_eoe_part_add(struct ec_eoe_part *p, u8 *data, size_t cap, const struct ec_eoe_fragment *f);
bool ec_eoe_is_ethercat(const u8 *frame, size_t len);

#endif
