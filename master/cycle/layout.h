/* SPDX-License-Identifier: GPL-2.0-only */
/* The datagrams of a cycle, and what is copied into and out of them. */
#ifndef EC_LAYOUT_H
#define EC_LAYOUT_H

#include <linux/types.h>
#include "../wire/frame.h"

struct ec_config;
struct ec_wanted;

/**
 * struct ec_cyc_dgram - one datagram of the cyclic layout, immutable in use but for @wrote
 * @before, and the best copy
 */
struct ec_cyc_dgram {
	/** @domain: index */
	u16 domain;
	/** @cmd: LRD, LWR or LRW */
	u8 cmd;
	/** @own_frame: shares no frame with datagrams of other domains */
	bool own_frame : 1;
	/** @holes: @n_copies areas do not cover it: clear it first */
	bool holes : 1;
	/** @solid: one piece of the image has the same bytes as the whole datagram */
	bool solid : 1;
	/** @best_ok: if there are several, the best copy of send @best_send is complete */
	bool best_ok : 1;
	/** @repeats: so many frames with it are sent in a cycle */
	u8 repeats;
	/** @best: its working counter */
	u16 best;
	/** @best_send: number of that send */
	u32 best_send;
	/** @wrote: low half of the number of the last send before its inputs were last written */
	u16 wrote;
	/** @before: as @wrote, without what incomplete replies of that receive have written */
	u16 before;
	/** @logical: logical address */
	u32 logical;
	/** @len: bytes */
	u16 len;
	/**
	 * @expected: working counter if every slave processes it that has to now: slaves of
	 * optional groups may be absent; written by counts.c while the cycle runs
	 */
	u16 expected;
	/**
	 * @spare: so much more is complete as well: of slaves of such groups that are not yet in OP
	 */
	u16 spare;
	/** @full: working counter with all slaves */
	u16 full;
	/** @first_copy: first area that is copied into it, in struct ec_layout.areas */
	u32 first_copy;
	/**
	 * @of: in a ring: working counters of the last copies, if both were processed, and struct
	 * ec_cycle.opened then
	 */
	u64 of;
	/** @sides: likewise, which bytes are of which link, see ring_sides.h; 0: not known */
	aligned_u64 sides;
	/** @n_copies: areas that are copied into it */
	u16 n_copies;
	/** @n_plain: inputs that were sent with their last value */
	u16 n_plain;
	/** @n_whole: @n_plain, and inputs that replace outputs in the datagram */
	u16 n_whole;
	/** @n_inputs: @n_whole, and inputs of which other datagrams have a part */
	u16 n_inputs;
	/** @first_input: first of its inputs in struct ec_layout.areas */
	u32 first_input;
	/** @cut: in a ring: bytes of the main link in the last data, see ec_merge_data() */
	u16 cut;
};

/* Did every slave process it that does so now? */
static inline bool ec_cyc_is_complete(const struct ec_cyc_dgram *d, u16 wkc)
{
	/* before what is expected: what is no spare any more is expected already */
	u16 spare = smp_load_acquire(&d->spare);

	return (u16)(wkc - READ_ONCE(d->expected)) <= spare;
}

/* May @d not be in the frame of @last, the datagram before it, which may be NULL? */
static inline bool ec_cyc_is_apart(const struct ec_cyc_dgram *d, const struct ec_cyc_dgram *last)
{
	return last && (d->own_frame | last->own_frame) && d->domain != last->domain;
}

/* It has inputs only, and their last values are in the image. */
static inline bool ec_cyc_from_image(const struct ec_cyc_dgram *d)
{
	return d->cmd == EC_CMD_LRD;
}

/**
 * struct ec_cyc_area - process data to copy into or out of a datagram: values of one
 * size at equal distances, as slaves of a kind in a row have them
 */
struct ec_cyc_area {
	/** @offset: byte in the image */
	u32 offset;
	/** @pos: byte in the datagram */
	u16 pos;
	/** @len: bytes of a value */
	u16 len;
	/** @count: values */
	u16 count;
	/** @offset_stride: from one to the next in the image, bytes */
	u16 offset_stride;
	/** @pos_stride: in the datagram */
	u16 pos_stride;
	/** @cut: number in struct ec_layout.cuts, for inputs of several datagrams */
	u16 cut;
};

/** struct ec_cyc_cut - inputs that are larger than a datagram */
struct ec_cyc_cut {
	/** @offset: byte in the image */
	u32 offset;
	/** @len: bytes */
	u32 len;
	/** @parts: datagrams that have a part of them */
	u16 parts;
	/** @have: parts received */
	u16 have;
	/** @send: number of the send they belong to */
	u32 send;
};

/** struct ec_cyc_share - what a slave of an optional group adds to a working counter */
struct ec_cyc_share {
	/** @config: its configuration */
	const struct ec_config *config;
	/** @dgram: number of the datagram */
	u16 dgram;
	/** @wkc: what it adds */
	u16 wkc;
};

/** struct ec_cyc_wire - frames, and how long they occupy the wire */
struct ec_cyc_wire {
	/** @frames: how many */
	u32 frames;
	/** @ns: at 100 Mbit/s, preamble, padding, FCS and gap included */
	u32 ns;
};

/** struct ec_layout - datagrams of a cycle; immutable while it is active but for the counts */
struct ec_layout {
	/** @dgrams: datagrams in the order of their domains */
	struct ec_cyc_dgram *dgrams;
	/** @n_dgrams: entries in @dgrams */
	unsigned int n_dgrams;
	/** @areas: what is copied, in the order of the datagrams */
	struct ec_cyc_area *areas;
	/** @n_areas: entries in @areas */
	unsigned int n_areas;
	/** @cuts: inputs of several datagrams; their counts are of the cycle owner */
	struct ec_cyc_cut *cuts;
	/** @n_cuts: entries in @cuts */
	unsigned int n_cuts;
	/** @shares: of slaves that may be absent */
	struct ec_cyc_share *shares;
	/** @n_shares: entries in @shares */
	unsigned int n_shares;
	/** @stage: an image in which their parts are collected, or NULL; of the cycle owner */
	u8 *stage;
	/** @plain: frames of a cycle that sends all domains */
	struct ec_cyc_wire plain;
	/** @clocked: the same with all clock datagrams */
	struct ec_cyc_wire clocked;
};

/* Wire time of a minimum Ethernet frame: no acyclic frame needs less, ns. */
static inline u32 ec_layout_need_ns(void)
{
	return ec_frame_wire_ns(EC_ETH_MIN);
}

int ec_layout_make(struct ec_layout *l, struct ec_wanted *w, unsigned int max_datagrams,
		   size_t image_size);
void ec_layout_free(struct ec_layout *l);

#endif
