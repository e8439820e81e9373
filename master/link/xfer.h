/* SPDX-License-Identifier: GPL-2.0-only */
/* Acyclic datagrams: a batch goes out, the caller sleeps until it is back. */
#ifndef EC_XFER_H
#define EC_XFER_H

#include <linux/completion.h>
#include <linux/types.h>
#include "../wire/frame.h"

struct ec_links;

/**
 * struct ec_dg - one datagram of a batch
 * @cmd: enum ec_cmd
 * @repeat: may be sent again when its frame is lost (reads without side
 *	effect, writes that may be executed twice)
 * @adp: low half of the address
 * @ado: high half of the address
 * @len: data bytes
 * @data: sent for writing commands, filled for reading ones
 * @wkc: result: working counter
 * @back: result: @adp as it came back (position plus slaves passed)
 * @irq: result: OR of the enabled events of the slaves passed
 * @sent_ns: result: when its frame left, as far as the master knows (ktime)
 * @err: result: 0, or -ETIMEDOUT (frame not back), -ENETDOWN (link is down), -ENODEV,
 *	-EINTR (caller killed), -EBUSY (the device sends nothing)
 */
struct ec_dg {
	u8 cmd;
	bool repeat;
	u16 adp;
	u16 ado;
	u16 len;
	void *data;
	u16 wkc;
	u16 back;
	u16 irq;
	u64 sent_ns;
	int err;
};

#define EC_DG(c, a, o, l, d) \
	((struct ec_dg){ .cmd = (c), .repeat = true, .adp = (a), .ado = (o), .len = (l), \
			 .data = (d) })

/* by station address; a write leaves its data as they are */
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

/* The result of a datagram that has returned. */
static inline void ec_dg_take(struct ec_dg *dg, const struct ec_dgram *d, u64 sent_ns)
{
	dg->wkc = ec_dgram_wkc(d);
	dg->back = d->adp;
	dg->irq = d->irq;
	dg->sent_ns = sent_ns;
	if (ec_cmd_reads(d->cmd))
		memcpy(dg->data, d->data, d->len);
	dg->err = 0;
}

/**
 * struct ec_xfer - a caller that waits for frames
 * @pending: frames not back yet, plus one while the caller still sends
 * @done: completed when @pending is zero
 * @notify: called instead; RT-safe, in the context that receives
 */
struct ec_xfer {
	atomic_t pending;
	struct completion done;
	void (*notify)(struct ec_xfer *x);
};

int ec_xfer(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_all(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_urgent(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_clock(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_one(struct ec_links *l, u8 cmd, u16 adp, u16 ado, void *data, u16 len);
int ec_xfer_fprd(struct ec_links *l, u16 station, u16 ado, void *data, u16 len);
int ec_xfer_fpwr(struct ec_links *l, u16 station, u16 ado, const void *data, u16 len);
void ec_xfer_done(struct ec_xfer *x);

#endif
