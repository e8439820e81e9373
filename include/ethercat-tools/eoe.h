/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: network devices of slaves with EoE. */
#ifndef ETHERCAT_TOOLS_EOE_H
#define ETHERCAT_TOOLS_EOE_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* a network device; the counters begin when it is made */
struct ect_eoe {
	uint32_t struct_size;
	uint32_t index;
	uint64_t device;	/* number of the slave */
	uint16_t position;	/* of the slave, when it was seen last */
	uint8_t connected;	/* the slave is connected */
	uint8_t up;		/* the network device is up */
	uint8_t running;	/* frames pass: the mailbox of the slave runs */
	uint8_t reserved;
	uint8_t address[6];
	uint32_t waiting;	/* frames that wait for the mailbox */
	uint32_t room;		/* how many may wait */
	uint32_t rx_rate;	/* bytes/s, of the last second */
	uint32_t tx_rate;
	uint64_t rx_frames;	/* of the slave */
	uint64_t rx_bytes;
	uint64_t rx_errors;	/* frames with wrong or missing fragments */
	uint64_t rx_missed;	/* messages that came while too many waited */
	uint64_t rx_dropped;	/* frames that are not allowed, or for lack of memory */
	uint64_t tx_frames;	/* to the slave */
	uint64_t tx_bytes;
	uint64_t tx_lost;	/* fragments that were lost, perhaps */
	uint64_t tx_dropped;	/* frames that are not allowed, or came without a carrier */
	char name[ECT_STRING];	/* empty: in another network namespace */
};

/**
 * ect_eoe_read() - a network device of a slave with EoE
 * @h: master
 * @index: from 0 on
 * @e: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0; -ENOENT there is no such device; -ENOTTY an older module; or another negative errno.
 */
int ect_eoe_read(struct ect_handle *h, unsigned int index, struct ect_eoe *e);

/* whether a slave has a network device */
#define ECT_EOE_AUTO	0	/* as all others: parameter eoe of ec_master */
#define ECT_EOE_ON	1
#define ECT_EOE_OFF	2

/**
 * ect_eoe_wish() - make or remove the network device of a slave with EoE
 * @h: master, open for writing
 * @device: number of the slave
 * @wish: ECT_EOE_*
 *
 * It is done shortly after the return.
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0; -EPERM without CAP_NET_ADMIN; -EPROTONOSUPPORT the slave has no EoE; or another
 * negative errno.
 */
int ect_eoe_wish(struct ect_handle *h, uint64_t device, unsigned int wish);

#ifdef __cplusplus
}
#endif

#endif
