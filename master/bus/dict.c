// SPDX-License-Identifier: GPL-2.0-only
/*
 * A dictionary of some hundred objects takes seconds to read, and tools read it again and
 * again. Nothing is asked for in advance. What was asked for is kept, within a limit, until
 * the slave goes through INIT or BOOT, where another configuration or firmware may give it
 * another dictionary, or until a caller wants to read it again.
 */
#include <linux/mm.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "../mailbox/coe.h"
#include "../wire/sdoinfo.h"
#include "slave.h"

#define FIRST_BYTES	1024

/* abort codes, see ec_coe_abort_text() */
#define NO_OBJECT	0x06020000
#define NO_SUBINDEX	0x06090011

/*
 * An answer, before its bytes. The first five are the question.
 */
struct answer {
	u8 opcode;
	u8 sub;
	u16 index;
	u8 info;
	u8 reserved[3];
	u32 abort;
	u32 size;
};

static size_t bytes(size_t size)
{
	return ALIGN(sizeof(struct answer) + size, __alignof__(struct answer));
}

static struct answer *dict_find(const struct ec_dict *d, const struct ec_sdoinfo *i)
{
	size_t at;

	lockdep_assert_held(&d->lock);
	for (at = 0; at < d->used; at += bytes(((struct answer *)(d->answers + at))->size)) {
		struct answer *a = (struct answer *)(d->answers + at);

		if (a->opcode == i->opcode && a->index == i->index && a->sub == i->sub &&
		    a->info == i->info)
			return a;
	}
	return NULL;
}

/* The answer that is kept as if the slave had sent it: 0, -EIO, -ENOBUFS; 1: there is none. */
static int recall(struct ec_dict *d, struct ec_sdoinfo *i, u32 *forgotten)
{
	const struct answer *a;
	int ret = 1;

	mutex_lock(&d->lock);
	*forgotten = d->forgotten;
	a = dict_find(d, i);
	if (a) {
		i->state = EC_SDOINFO_DONE;
		i->abort = a->abort;
		ret = a->abort ? -EIO : a->size > i->cap ? -ENOBUFS : 0;
	}
	if (!ret) {
		memcpy(i->data, a + 1, a->size);
		i->size = a->size;
	}
	mutex_unlock(&d->lock);
	return ret;
}

static bool make_space(struct ec_dict *d, size_t need)
{
	size_t size = d->size ?: FIRST_BYTES;
	u8 *larger;

	lockdep_assert_held(&d->lock);
	if (d->used + need > EC_MAX_DICT_BYTES)
		return false;
	while (size < d->used + need)
		size *= 2;
	if (size == d->size)
		return true;
	/* the memory is that of the caller, until the slave changes */
	larger = kvmalloc(size, GFP_KERNEL_ACCOUNT | __GFP_NOWARN);
	if (!larger)
		return false;
	if (d->used)
		memcpy(larger, d->answers, d->used);
	kvfree(d->answers);
	d->answers = larger;
	d->size = size;
	return true;
}

/* What finds no space, or no memory, is asked for again. */
static void dict_keep(struct ec_dict *d, const struct ec_sdoinfo *i, u32 forgotten)
{
	size_t size = i->abort ? 0 : i->size;

	mutex_lock(&d->lock);
	if (d->forgotten == forgotten && !dict_find(d, i) && make_space(d, bytes(size))) {
		struct answer *a = (struct answer *)(d->answers + d->used);

		*a = (struct answer){
			.opcode = i->opcode, .sub = i->sub, .index = i->index, .info = i->info,
			.abort = i->abort, .size = size,
		};
		memcpy(a + 1, i->data, size);
		d->used += bytes(size);
	}
	mutex_unlock(&d->lock);
}

/**
 * ec_dict_init() - nothing is kept
 * @d: dictionary of a new slave
 *
 * Context: Any.
 */
void ec_dict_init(struct ec_dict *d)
{
	mutex_init(&d->lock);
}

/**
 * ec_dict_forget() - drop all answers and free their memory
 * @d: dictionary
 *
 * Context: Process. May sleep.
 */
void ec_dict_forget(struct ec_dict *d)
{
	mutex_lock(&d->lock);
	kvfree(d->answers);
	d->answers = NULL;
	d->used = 0;
	d->size = 0;
	d->forgotten++;
	mutex_unlock(&d->lock);
}

/* An object that does not exist does not begin to; other refusals depend on the state. */
static bool lasts(int ret, u32 abort)
{
	return !ret || (ret == -EIO && (abort == NO_OBJECT || abort == NO_SUBINDEX));
}

/**
 * ec_dict_info() - ask about the object dictionary of a slave, or recall the answer
 * @s: slave
 * @info: request, of ec_sdoinfo_init(), and its answer
 * @limit: limits of the exchange; NULL: the usual ones
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_coe_info().
 */
int ec_dict_info(struct ec_slave *s, struct ec_sdoinfo *info, const struct ec_mbox_limit *limit)
{
	u32 forgotten;
	int ret = recall(&s->dict, info, &forgotten);

	if (ret <= 0)
		return ret;
	ret = ec_coe_info(&s->mbox, info, limit);
	if (lasts(ret, info->abort))
		dict_keep(&s->dict, info, forgotten);
	return ret;
}
