/* SPDX-License-Identifier: GPL-2.0-only */
/* What slaves have said about their object dictionaries, kept until they change. */
#ifndef EC_DICT_H
#define EC_DICT_H

#include <linux/mutex.h>
#include <linux/types.h>

struct ec_mbox_limit;
struct ec_sdoinfo;
struct ec_slave;

/**
 * struct ec_dict - answers of one slave
 * @lock: protects the others
 * @answers: one after the other, or NULL
 * @used: bytes there, at most EC_MAX_DICT_BYTES
 * @size: bytes allocated
 * @forgotten: how often they were dropped: an answer to an earlier question is older
 */
struct ec_dict {
	struct mutex lock;
	u8 *answers;
	size_t used;
	size_t size;
	u32 forgotten;
};

void ec_dict_init(struct ec_dict *d);
void ec_dict_forget(struct ec_dict *d);
int ec_dict_info(struct ec_slave *s, struct ec_sdoinfo *info, const struct ec_mbox_limit *limit);

#endif
