/* SPDX-License-Identifier: GPL-2.0-only */
/* A program that listens to uevents, as udev does. */
#ifndef EC_UEVENTS_H
#define EC_UEVENTS_H

#include "ec_kunit.h"

#define UEVENTS		8192

struct socket;

/**
 * struct uevent - of a slave, or of the master
 * @action: a, r, c: add, remove, change
 * @master: of the master
 * @name: of the device
 * @modalias: as in the uevent, or ""
 * @changes: that the master has reported
 * @at: when it was heard (ktime)
 */
struct uevent {
	char action;
	bool master;
	char name[24];
	char modalias[40];
	u32 changes;
	u64 at;
};

/**
 * struct uevents - those heard so far
 * @test: case
 * @sock: netlink socket
 * @heard: uevents
 * @n: their number
 * @buf: one message
 */
struct uevents {
	struct kunit *test;
	struct socket *sock;
	struct uevent *heard;
	u32 n;
	char buf[4096];
};

struct uevents *uevents_new(struct kunit *test);
void uevents_free(struct uevents *u);
void uevents_listen(struct uevents *u);
void uevents_listen_ms(struct uevents *u, u32 ms);
u32 uevents_count(const struct uevents *u, u32 from, char action, bool master);

#endif
