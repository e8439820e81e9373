/* SPDX-License-Identifier: GPL-2.0-only */
/* A link: one device of a master, with its statistics. */
#ifndef EC_LINK_H
#define EC_LINK_H

#include <linux/atomic.h>
#include <linux/types.h>
#include "ethercat.h"

struct ecdev;
struct ec_links;
struct ec_slot;

/**
 * struct ec_link_stats - counters since the device was attached
 *
 * The owner of the bus access writes the transmit counters, the context that delivers
 * frames the receive counters; a reader may see one counter newer than another.
 */
struct ec_link_stats {
	/** @tx_frames: frames that the device has taken */
	atomic64_t tx_frames;
	/** @tx_bytes: bytes of them, from the Ethernet header on, without FCS */
	atomic64_t tx_bytes;
	/** @tx_errors: frames that the device has refused */
	atomic64_t tx_errors;
	/** @rx_frames: received EtherCAT frames */
	atomic64_t rx_frames;
	/** @rx_bytes: bytes of them, likewise */
	atomic64_t rx_bytes;
	/** @lost: frames without a reply in time */
	atomic64_t lost;
	/** @late: replies received after the timeout, or after the next cyclic send */
	atomic64_t late;
	/** @unmatched: received EtherCAT frames that match no frame in flight */
	atomic64_t unmatched;
	/** @foreign: frames that are no EtherCAT frames of this master */
	atomic64_t foreign;
	/** @not_captured: frames that capture programs did not see: their ring was full */
	atomic64_t not_captured;
};

/** struct ec_link_rates - averages, kept by the monitor */
struct ec_link_rates {
	/** @last: counters one second ago: tx frames, rx frames, tx bytes, rx bytes, lost */
	u64 last[5];
	/** @rate: per second, averaged over 1, 10, 60 s */
	u32 rate[5][EC_UAPI_RATES];
	/** @restart: the counters have been cleared */
	bool restart;
};

/** struct ec_link - port to the wire */
struct ec_link {
	/** @links: links of the master, immutable */
	struct ec_links *links;
	/** @side: 0 main, 1 backup, immutable */
	u8 side;
	/**
	 * @dev: attached device or NULL; changes under the access lock. Used by the owner of the
	 * bus access; other threads use it only in an RCU read section
	 */
	struct ecdev *dev;
	/** @acyclic: acyclic frames in flight */
	atomic_t acyclic;
	/** @acyclic_ns: wire time of these frames */
	atomic_t acyclic_ns;
	/** @places: limit of @acyclic */
	unsigned int places;
	/**
	 * @keep: the cycle owner polls the device, and takes replies to the cycle from its memory
	 */
	bool keep;
	/** @up: link state as last seen by the monitor */
	bool up;
	/** @mute: up, but no frame returns: the other link alone is used; the monitor's */
	bool mute;
	/** @missed_ns: since when no copy has returned although it is up (ktime); the monitor's */
	u64 missed_ns;
	/** @missed_rx: frames received before */
	u64 missed_rx;
	/** @slaves: slaves that answered the last broadcast on this link */
	u32 slaves;
	/** @al_states: OR of their AL states */
	u32 al_states;
	/** @stats: counters */
	struct ec_link_stats stats;
	/** @rates: averages */
	struct ec_link_rates rates;
};

void ec_link_init(struct ec_link *link, struct ec_links *l, u8 side);
void ec_link_trace(const struct ec_link *link, const char *what, const u8 *data, size_t len);
void ec_link_show(struct ec_link *link, struct ecdev *dev, const u8 *frame, size_t len);
int ec_link_send_traced(const struct ec_link *link, struct ecdev *dev, u8 *buf, size_t len);
int ec_links_send(struct ec_links *l, struct ec_slot *slot, u8 sides, u64 now);
void ec_link_poll(struct ec_link *link);
void ec_links_poll_each(struct ec_links *l);
bool ec_link_is_up(const struct ec_link *link);
bool ec_link_look(struct ec_link *link);
void ec_link_hears(struct ec_link *link);
bool ec_link_missed(struct ec_link *link);
void ec_link_clear_counters(struct ec_link *link);
void ec_link_rates_update(struct ec_link *link);

#endif
