/* SPDX-License-Identifier: GPL-2.0-only */
/* Network interface on which capture programs see the frames of a master. */
#ifndef EC_CAPTURE_H
#define EC_CAPTURE_H

#include <linux/types.h>

struct ec_capture;
struct ec_master;

int ec_capture_create(struct ec_master *m);
void ec_capture_destroy(struct ec_master *m);
bool ec_capture_sent(struct ec_capture *c, const u8 *frame, size_t len);
bool ec_capture_received(struct ec_capture *c, const u8 *src, const u8 *data, size_t len);
bool ec_capture_is(const struct ec_capture *c, const char *name);

#endif
