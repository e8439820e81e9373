/* SPDX-License-Identifier: GPL-2.0-only */
/* Ethernet frames through the mailbox of a slave: fragments both ways. */
#ifndef EC_EOE_PORT_H
#define EC_EOE_PORT_H

#include <linux/skbuff.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include <linux/workqueue.h>
#include "../mailbox/mbox.h"
#include "../wire/eoe_frame.h"

#define EC_EOE_FRAMES	64	/* frames that wait for the mailbox; a power of 2 */
#define EC_EOE_MESSAGES	16	/* messages of the slave that wait for @work; a power of 2 */
#define EC_EOE_OPEN	16	/* frames of the slave at most that are not complete */

/**
 * struct ec_eoe_counts - statistics of a port, since it was made; readers take no lock
 * @tx_frames: frames whose last fragment is in the mailbox of the slave
 * @tx_bytes: bytes of them
 * @rx_fragments: fragments of the slave
 * @tx_fragments: fragments to the slave
 * @rx_errors: messages that are no fragments, and frames that were not completed
 * @rx_missed: messages of the slave that came while too many waited
 * @rx_dropped: frames that were not taken, for lack of memory
 * @tx_lost: fragments that were lost, perhaps, as their frame on the fieldbus was
 * @tx_dropped: frames that waited when the slave was left
 * @refused: mailbox error replies of the slave to fragments
 */
struct ec_eoe_counts {
	aligned_u64 tx_frames;
	aligned_u64 tx_bytes;
	aligned_u64 rx_fragments;
	aligned_u64 tx_fragments;
	aligned_u64 rx_errors;
	aligned_u64 rx_missed;
	aligned_u64 rx_dropped;
	aligned_u64 tx_lost;
	aligned_u64 tx_dropped;
	aligned_u64 refused;
};

/**
 * struct ec_eoe_message - message of the slave
 * @len: bytes of @data
 * @data: behind the mailbox header
 */
struct ec_eoe_message {
	u16 len;
	u8 data[EC_MBOX_MAX];
};

/**
 * struct ec_eoe_open - a frame of the slave that is put together; only the work of the port uses it
 * @part: how far it is
 * @skb: the frame; NULL: this entry is free
 * @since_ns: its last fragment (ktime)
 */
struct ec_eoe_open {
	struct ec_eoe_part part;
	struct sk_buff *skb;
	u64 since_ns;
};

/**
 * struct ec_eoe_ways - memory of a port while it is attached
 * @tx_data: message to the slave
 * @frames: that wait; entry n at n % EC_EOE_FRAMES
 * @messages: of the slave; entry n at n % EC_EOE_MESSAGES
 * @open: its incomplete frames
 */
struct ec_eoe_ways {
	u8 tx_data[EC_MBOX_MAX];
	struct sk_buff *frames[EC_EOE_FRAMES];
	struct ec_eoe_message messages[EC_EOE_MESSAGES];
	struct ec_eoe_open open[EC_EOE_OPEN];
};

/**
 * struct ec_eoe_port - way of Ethernet frames to a slave and back
 *
 * The mailbox calls it where a frame of the fieldbus arrives, perhaps in a hard interrupt: there
 * a message is only copied, and the next fragment is cut. All else is done by @work.
 */
struct ec_eoe_port {
	/** @lock: protects what follows; inside the lock of the mailbox transport */
	raw_spinlock_t lock;
	/** @counts: statistics */
	struct ec_eoe_counts counts;
	/** @attached: frames may be given, and are answered */
	bool attached;
	/** @busy: @tx has a fragment, or @work will give it one */
	bool busy;
	/** @again: a fragment was perhaps lost: @work goes on with the next one */
	bool again;
	/** @err: why the mailbox does not run, 0: it does */
	int err;
	/** @given: frames that were given so far */
	u32 given;
	/** @sent: those of them that are in the mailbox of the slave */
	u32 sent;
	/** @freed: those of them that are freed; of @work */
	u32 freed;
	/** @at: bytes of the present frame in fragments before that of @tx */
	u16 at;
	/** @cut: bytes in that of @tx */
	u16 cut;
	/** @number: of the fragment in @tx */
	u8 number;
	/** @frame: number of the present frame, modulo 16 */
	u8 frame;
	/** @stood: @sent when ec_eoe_port_stands() was called last; of its caller */
	u32 stood;
	/** @got: messages of the slave so far */
	u32 got;
	/** @taken: those of them that @work has taken */
	u32 taken;
	/** @broken: frames of the slave that were lost, by their number; of @work */
	u16 broken;

	/** @mb: mailbox of the slave; NULL: none; changes while not @attached */
	struct ec_mbox *mb;
	/** @ways: memory; NULL: none; changes while not @attached */
	struct ec_eoe_ways *ways;
	/** @tx: writes fragments */
	struct ec_mbox_user tx;
	/** @rx: reads messages */
	struct ec_mbox_user rx;
	/** @work: puts frames together, frees those that are sent, reports errors */
	struct work_struct work;
};

void ec_eoe_port_init(struct ec_eoe_port *p);
int ec_eoe_port_attach(struct ec_eoe_port *p, struct ec_mbox *mb);
void ec_eoe_port_close(struct ec_eoe_port *p);
void ec_eoe_port_detach(struct ec_eoe_port *p);
int ec_eoe_port_send(struct ec_eoe_port *p, struct sk_buff *skb);
bool ec_eoe_port_has_room(const struct ec_eoe_port *p);
u32 ec_eoe_port_waiting(const struct ec_eoe_port *p);
bool ec_eoe_port_stands(struct ec_eoe_port *p);
void ec_eoe_port_counts(const struct ec_eoe_port *p, struct ec_eoe_counts *counts);
bool ec_eoe_runs(const struct ec_mbox *mb);

#endif
