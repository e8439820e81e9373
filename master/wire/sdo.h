/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * SDO upload and download (ETG.1000.6 clause 5.6.2) as exchanges without I/O:
 * ..._tx() writes the next message, ..._rx() takes what arrived. Messages
 * start at the CoE header; the mailbox header is not part of them.
 *
 *	do {
 *		len = ec_sdo_tx(&sdo, tx, sizeof(tx));
 *		(send; receive)
 *		ret = ec_sdo_rx(&sdo, rx, len);
 *	} while (ret == EC_MORE);
 *	if (sdo.send_abort)
 *		(send ec_sdo_tx() once more, expect no answer)
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
 * struct ec_sdo - an upload (the master reads) or a download (the master writes)
 * @down: download
 * @state: where it is
 * @index: object
 * @sub: subindex; 0 or 1 with @complete
 * @complete: complete access
 * @data: upload: where the data go; download: value, only read
 * @cap: upload: bytes at @data
 * @size: upload: bytes received so far; download: bytes at @data
 * @total: upload: bytes announced by the slave, 0: not known
 * @mbox_size: download: bytes a mailbox message may have behind the mailbox header
 * @sent: download: bytes the slave has taken
 * @chunk: download: bytes in the message under way
 * @toggle: toggle bit of the next segment
 * @abort: abort code received, or about to be sent
 * @send_abort: the slave needs an abort: call ec_sdo_tx() once more
 */
struct ec_sdo {
	bool down;
	enum ec_sdo_state state;
	u16 index;
	u8 sub;
	bool complete;
	u8 *data;
	size_t cap;
	size_t size;
	size_t total;
	size_t mbox_size;
	size_t sent;
	size_t chunk;
	u8 toggle;
	u32 abort;
	bool send_abort;
};

void ec_sdo_upload_init(struct ec_sdo *s, u16 index, u8 sub, bool complete, u8 *data, size_t cap);
void ec_sdo_download_init(struct ec_sdo *s, u16 index, u8 sub, bool complete,
			  const u8 *data, size_t size, size_t mbox_size);
int ec_sdo_tx(struct ec_sdo *s, u8 *tx, size_t cap);
int ec_sdo_rx(struct ec_sdo *s, const u8 *rx, size_t len);
void ec_sdo_cancel(struct ec_sdo *s);

#endif
