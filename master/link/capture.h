/* SPDX-License-Identifier: GPL-2.0-only */
/* Network interface on which capture programs see the frames of a master. */
#ifndef EC_CAPTURE_H
#define EC_CAPTURE_H

#include <linux/types.h>
#include "tap.h"

struct ec_links;

/** struct ec_capture - private part of the interface */
struct ec_capture {
	/** @nd: the interface */
	struct net_device *nd;
	/** @tap: copies of frames for it */
	struct ec_tap tap;
};

/* the parameter; written before masters are created only */
extern bool ec_capture;

int ec_capture_create(struct ec_links *l);
void ec_capture_destroy(struct ec_links *l);
bool ec_capture_sent(struct ec_capture *c, const u8 *frame, size_t len);
bool ec_capture_received(struct ec_capture *c, const u8 *src, const u8 *data, size_t len);
bool ec_capture_is(const struct ec_capture *c, const char *name);

#endif
