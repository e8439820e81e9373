/* SPDX-License-Identifier: GPL-2.0-only */
/* Transfers of all mailbox protocols with one slave, with memory for objects and files. */
#ifndef EC_TALK_H
#define EC_TALK_H

#include "bus.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/foe.h"
#include "master/mailbox/mailbox.h"

#define TALK_MAX	16384

/**
 * struct talk - a slave and what is transferred
 * @test: the case
 * @s: slave
 * @limit: of each message
 * @data: of the object or file
 * @got: bytes read
 * @abort: of the slave, CoE
 * @foe: of the last file
 */
struct talk {
	struct kunit *test;
	struct ec_slave *s;
	struct ec_mbox_limit limit;
	u8 data[TALK_MAX];
	size_t got;
	u32 abort;
	struct ec_foe foe;
};

struct talk *talk_new(struct bus *b, u32 position, u32 timeout_ms);
void talk_fill(struct talk *t, size_t size);
bool talk_is_filled(const struct talk *t, size_t size);

int talk_upload(struct talk *t, u16 index, u8 sub, bool complete);
int talk_download(struct talk *t, u16 index, u8 sub, bool complete, size_t size);
int talk_info(struct talk *t, u8 opcode, u16 index, u8 sub);
int talk_get(struct talk *t, const char *name);
int talk_put(struct talk *t, const char *name, size_t size);

#endif
