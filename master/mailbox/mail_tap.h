/* SPDX-License-Identifier: GPL-2.0-only */
/* Copies of mailbox messages for their readers. */
#ifndef EC_MAIL_TAP_H
#define EC_MAIL_TAP_H

#include <linux/atomic.h>
#include <linux/rcupdate.h>
#include <linux/spinlock.h>
#include "ethercat_mail.h"
#include "../base/base.h"

#define EC_MAIL_PLACES	(EC_MAILS_KEPT + 1)

/* a record as words, which are copied one by one */
union ec_mail_place {
	struct ec_mail mail;
	u32 word[sizeof(struct ec_mail) / sizeof(u32)];
};

/** struct ec_mail_tap - copies of the messages of a master; there is one while it has a reader */
struct ec_mail_tap {
	/** @lock: protects @head and @place against other writers */
	raw_spinlock_t lock;
	/** @head: number of the next message */
	atomic64_t head;
	/** @rcu: frees it after the last writer */
	struct rcu_head rcu;
	/** @place: of message n: n modulo EC_MAIL_PLACES */
	union ec_mail_place place[EC_MAIL_PLACES];
};

/* A pointer and no static key: a reader that begins interrupts no CPU, on which a cycle may run. */
static __always_inline bool ec_mail_tap_wanted(const struct ec_base *base)
{
	return unlikely(rcu_access_pointer(base->mail_tap));
}

static inline u64 ec_mail_tap_head(const struct ec_mail_tap *t)
{
	return atomic64_read(&t->head);
}

struct ec_mail_tap *ec_mail_tap_new(u64 next);
void ec_mail_tap_put(const struct ec_base *base, u16 station, u32 flags, const u8 *bytes,
		     u16 size);
bool ec_mail_tap_get(const struct ec_mail_tap *t, u64 *at, struct ec_mail *m);

#endif
