/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * SDO upload and download (ETG.1000.6 clause 5.6.2) as exchanges without I/O:
 * ..._tx() writes the next message, ..._rx() takes what arrived. Messages
 * start at the CoE header; the mailbox header is not part of them.
 *
 *	do {
 *		len = ec_sdo_up_tx(&up, tx, sizeof(tx));
 *		(send; receive)
 *		ret = ec_sdo_up_rx(&up, rx, len);
 *	} while (ret == EC_MORE);
 *	if (up.send_abort)
 *		(send ec_sdo_up_tx() once more, expect no answer)
 */
#ifndef EC_WIRE_SDO_H
#define EC_WIRE_SDO_H

#include "coe.h"

#define EC_SDO_MSG		10	/* CoE header, command, index, subindex, 4 bytes */
#define EC_SDO_SEG_HDR		3	/* CoE header, command */
#define EC_SDO_SEG_MIN		7	/* data field of a segment, at least */

enum ec_sdo_state {
	EC_SDO_INITIATE,
	EC_SDO_SEGMENT,
	EC_SDO_ABORT,		/* the next message sent is an abort */
	EC_SDO_DONE,
};

/**
 * struct ec_sdo_up - an upload: the master reads
 * @state: where it is
 * @index: object
 * @sub: subindex; 0 or 1 with @complete
 * @complete: complete access
 * @data: where the data go
 * @cap: bytes at @data
 * @size: bytes received so far
 * @total: bytes announced by the slave, 0: not known
 * @toggle: toggle bit of the next segment
 * @abort: abort code received, or about to be sent
 * @send_abort: the slave must be told: call ec_sdo_up_tx() once more
 */
struct ec_sdo_up {
	enum ec_sdo_state state;
	u16 index;
	u8 sub;
	bool complete;
	u8 *data;
	size_t cap;
	size_t size;
	size_t total;
	u8 toggle;
	u32 abort;
	bool send_abort;
};

/**
 * struct ec_sdo_down - a download: the master writes
 * @state: where it is
 * @index: object
 * @sub: subindex; 0 or 1 with @complete
 * @complete: complete access
 * @data: what to write
 * @size: bytes at @data
 * @mbox_size: bytes a mailbox message may have behind the mailbox header
 * @sent: bytes the slave has taken
 * @chunk: bytes in the message under way
 * @toggle: toggle bit of the next segment
 * @abort: abort code received, or about to be sent
 * @send_abort: the slave must be told: call ec_sdo_down_tx() once more
 */
struct ec_sdo_down {
	enum ec_sdo_state state;
	u16 index;
	u8 sub;
	bool complete;
	const u8 *data;
	size_t size;
	size_t mbox_size;
	size_t sent;
	size_t chunk;
	u8 toggle;
	u32 abort;
	bool send_abort;
};

const char *ec_sdo_state_name(enum ec_sdo_state state);

void ec_sdo_up_init(struct ec_sdo_up *u, u16 index, u8 sub, bool complete, u8 *data, size_t cap);
int ec_sdo_up_tx(struct ec_sdo_up *u, u8 *tx, size_t cap);
int ec_sdo_up_rx(struct ec_sdo_up *u, const u8 *rx, size_t len);
void ec_sdo_up_cancel(struct ec_sdo_up *u, u32 abort);

void ec_sdo_down_init(struct ec_sdo_down *d, u16 index, u8 sub, bool complete,
		      const u8 *data, size_t size, size_t mbox_size);
int ec_sdo_down_tx(struct ec_sdo_down *d, u8 *tx, size_t cap);
int ec_sdo_down_rx(struct ec_sdo_down *d, const u8 *rx, size_t len);
void ec_sdo_down_cancel(struct ec_sdo_down *d, u32 abort);

#endif
