/* SPDX-License-Identifier: GPL-2.0-only */
/* An acyclic datagram with its result. */
#ifndef EC_DG_H
#define EC_DG_H

#include <linux/string.h>
#include <linux/types.h>
#include "../base/limits.h"
#include "../wire/frame.h"

#define EC_DG_NO_COPY	0xffff	/* of @side_wkc: no copy was received on that link */

/** struct ec_dg - one acyclic datagram */
struct ec_dg {
	/** @cmd: enum ec_cmd */
	u8 cmd;
	/**
	 * @repeat: may be sent again when its frame is lost (reads without side effect, writes that
	 * may be executed twice)
	 */
	bool repeat : 1;
	/**
	 * @keep: the reply leaves @data unchanged; only such datagrams in flight may share @data
	 */
	bool keep : 1;
	/** @last: of ec_xfer_train(): the next datagram is in another frame */
	bool last : 1;
	/** @pair: the next datagram is in the same frame, so that one slave executes both */
	bool pair : 1;
	/** @first: of ec_xfer_clock(): its frame is the first clock frame of a cyclic send */
	bool first : 1;
	/** @adp: low half of the address */
	u16 adp;
	/** @ado: high half of the address */
	u16 ado;
	/** @len: data bytes */
	u16 len;
	/** @data: sent for writing commands, filled for reading ones */
	void *data;
	/** @wkc: result: working counter, of all copies together */
	u16 wkc;
	/** @side_wkc: result: working counter of each link's copy, or %EC_DG_NO_COPY */
	u16 side_wkc[EC_MAX_LINKS];
	/** @side_back: result: slaves that each link's copy has passed */
	u16 side_back[EC_MAX_LINKS];
	/** @crossed: result: mask of the links whose copy the other one has received */
	u8 crossed;
	/** @back: result: @adp of the reply (position plus slaves passed by all copies) */
	u16 back;
	/** @irq: result: OR of the enabled events of the slaves passed */
	u16 irq;
	/**
	 * @err: result: 0, or -ETIMEDOUT (lost frame), -ENETDOWN (link is down), -ENODEV, -EINTR
	 * (caller killed), -EBUSY (the device sends nothing), -EAGAIN (it does not fit beside the
	 * cycle any more); -EINPROGRESS while there is no result
	 */
	int err;
	/** @sent_ns: result: when its frame left, as far as the master knows (ktime) */
	u64 sent_ns;
};

#define EC_DG(c, a, o, l, d) \
	((struct ec_dg){ .cmd = (c), .repeat = true, .adp = (a), .ado = (o), .len = (l), \
			 .data = (d) })

/* by station address; a write does not change its data */
#define EC_FPRD(a, o, l, d)	EC_DG(EC_CMD_FPRD, a, o, l, d)
#define EC_FPWR(a, o, l, d)	EC_DG(EC_CMD_FPWR, a, o, l, (void *)(const void *)(d))

/* The data of a datagram that is sent. */
static inline void ec_dg_fill(const struct ec_dg *dg, u8 *p)
{
	if (ec_cmd_writes(dg->cmd) || dg->cmd == EC_CMD_NOP)
		memcpy(p, dg->data, dg->len);
	else
		memset(p, 0, dg->len);
}

/* Before it is sent: no result yet. */
static inline void ec_dg_begin(struct ec_dg *dg)
{
	unsigned int i;

	dg->err = -EINPROGRESS;
	dg->wkc = 0;
	dg->irq = 0;
	dg->back = dg->adp;
	dg->crossed = 0;
	for (i = 0; i < EC_MAX_LINKS; i++)
		dg->side_wkc[i] = EC_DG_NO_COPY;
}

/* commands that each slave counts as one more position */
static inline bool ec_dg_is_broadcast(const struct ec_dg *dg)
{
	return dg->cmd == EC_CMD_BRD || dg->cmd == EC_CMD_BWR || dg->cmd == EC_CMD_BRW;
}

/*
 * Take a received copy, whose address was sent with @shift added. The data are those of the first
 * one that a slave has processed, of a broadcast those of all.
 */
static inline void ec_dg_take(struct ec_dg *dg, const struct ec_dgram *d, u8 side, u16 shift)
{
	u16 wkc = ec_dgram_wkc(d), i;

	dg->side_back[side] = d->adp - shift - dg->adp;
	dg->back += dg->side_back[side];
	if (ec_cmd_reads(d->cmd) && !dg->keep) {
		if (!dg->wkc)
			memcpy(dg->data, d->data, d->len);
		else if (wkc && ec_dg_is_broadcast(dg))
			for (i = 0; i < d->len; i++)
				((u8 *)dg->data)[i] |= d->data[i];
	}
	dg->side_wkc[side] = wkc;
	dg->wkc += wkc;
	dg->irq |= d->irq;
	dg->err = 0;
}

/* No slave has passed it. */
static inline void ec_dg_take_blank(struct ec_dg *dg, u8 side)
{
	dg->side_wkc[side] = 0;
	dg->side_back[side] = 0;
	dg->err = 0;
}

#endif
