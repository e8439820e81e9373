// SPDX-License-Identifier: GPL-2.0-only
#include "talk.h"
#include "master/wire/sdoinfo.h"

struct talk *talk_new(struct bus *b, u32 position, u32 timeout_ms)
{
	struct talk *t = kunit_kzalloc(b->test, sizeof(*t), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, t);
	t->test = b->test;
	t->s = bus_slave(b, position);
	t->limit.timeout_ms = timeout_ms;
	return t;
}

/* Another content for each size. */
void talk_fill(struct talk *t, size_t size)
{
	size_t i;

	for (i = 0; i < size; i++)
		t->data[i] = (u8)(i * 31 + size + (i >> 8));
}

bool talk_is_filled(const struct talk *t, size_t size)
{
	size_t i;

	for (i = 0; i < size; i++)
		if (t->data[i] != (u8)(i * 31 + size + (i >> 8)))
			return false;
	return t->got == size;
}

int talk_upload(struct talk *t, u16 index, u8 sub, bool complete)
{
	memset(t->data, 0, sizeof(t->data));
	return ec_coe_upload(&t->s->mbox, index, sub, complete, t->data, sizeof(t->data),
			     &t->got, &t->abort, &t->limit);
}

int talk_download(struct talk *t, u16 index, u8 sub, bool complete, size_t size)
{
	talk_fill(t, size);
	return ec_coe_download(&t->s->mbox, index, sub, complete, t->data, size, &t->abort,
			       &t->limit);
}

int talk_info(struct talk *t, u8 opcode, u16 index, u8 sub)
{
	struct ec_sdoinfo info;
	int ret;

	ec_sdoinfo_init(&info, opcode, index, sub, t->data, sizeof(t->data));
	ret = ec_coe_info(&t->s->mbox, &info, &t->limit);
	t->got = ret ? 0 : info.size;
	t->abort = info.abort;
	return ret;
}

static int fill(void *ctx, u64 at, u8 *buf, size_t n)
{
	struct talk *t = ctx;

	if (at + n > TALK_MAX)
		return -EFAULT;
	memcpy(buf, t->data + at, n);
	return 0;
}

static int take(void *ctx, u64 at, u8 *buf, size_t n)
{
	struct talk *t = ctx;

	if (at + n > TALK_MAX)
		return -EFAULT;
	memcpy(t->data + at, buf, n);
	return 0;
}

static int transfer(struct talk *t, bool write, const char *name, size_t size)
{
	struct ec_foe_file file = { .size = size, .copy = write ? fill : take, .ctx = t };
	int ret;

	t->foe = (struct ec_foe){ .write = write, .name = name, .name_len = strlen(name) };
	ret = ec_foe_transfer(&t->s->mbox, &t->foe, &file, &t->limit);
	t->got = ret ? 0 : t->foe.size;
	return ret;
}

int talk_get(struct talk *t, const char *name)
{
	memset(t->data, 0, sizeof(t->data));
	return transfer(t, false, name, sizeof(t->data));
}

int talk_put(struct talk *t, const char *name, size_t size)
{
	talk_fill(t, size);
	return transfer(t, true, name, size);
}
