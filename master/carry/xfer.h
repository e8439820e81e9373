/* SPDX-License-Identifier: GPL-2.0-only */
/* Acyclic datagrams: a batch is sent, the caller sleeps until all have results. */
#ifndef EC_XFER_H
#define EC_XFER_H

#include "dg.h"

struct ec_links;

int ec_xfer(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_all(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_probe(struct ec_links *l, struct ec_dg *dg, u8 side);
int ec_xfer_urgent(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_clock(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_train(struct ec_links *l, struct ec_dg *dg, unsigned int n);
int ec_xfer_one(struct ec_links *l, u8 cmd, u16 adp, u16 ado, void *data, u16 len);
int ec_xfer_fprd(struct ec_links *l, u16 station, u16 ado, void *data, u16 len);
int ec_xfer_fpwr(struct ec_links *l, u16 station, u16 ado, const void *data, u16 len);

#endif
