// SPDX-License-Identifier: LGPL-2.1-or-later
/* Values of each cycle. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "sys.h"

#define BATCH_BYTES	65536

/* where a value is in a record: its first byte, and the first bit there */
struct place {
	u32 byte;
	u8 shift;
	u8 bits;
};

/**
 * struct ect_recording - values that are recorded
 * @h: master
 * @domains: of the values, bit n: domain n
 * @places: of the values
 * @size: bytes of a record
 * @batch: records that were read
 * @room: bytes that fit there
 * @got: bytes there
 * @at: the next record there
 * @last: the one that was read last, within @batch
 */
struct ect_recording {
	struct ect_handle *h;
	u64 domains;
	struct place *places;
	size_t size;
	u8 *batch;
	size_t room;
	size_t got;
	size_t at;
	const u8 *last;
};

/**
 * struct masks - bytes of the image that are wanted
 * @logical: where each domain begins
 * @domains: how many
 * @bytes: of each mask
 * @mask: of inputs, then of outputs
 */
struct masks {
	u32 *logical;
	unsigned int domains;
	size_t bytes;
	u8 *mask;
};

static void masks_free(struct masks *m)
{
	free(m->logical);
	free(m->mask);
}

static int read_domains(struct ect_handle *h, struct masks *m)
{
	struct ect_master x = { .struct_size = sizeof(x) };
	int ret = ect_get_master(h, &x);
	size_t image = 0;

	if (ret)
		return ret;
	m->logical = calloc(x.domain_count + 1u, sizeof(*m->logical));
	if (!m->logical)
		return ect_no_memory(h);
	m->domains = x.domain_count;
	for (unsigned int i = 0; i < m->domains && !ret; i++) {
		struct ect_domain d = { .struct_size = sizeof(d) };

		ret = ect_domain_read(h, i, &d);
		m->logical[i] = d.logical;
		image = max_t(size_t, image, (size_t)d.logical + d.size);
	}
	m->bytes = (image + 7) / 8;
	m->mask = calloc(2, m->bytes + 1);
	return ret ? ret : m->mask ? 0 : ect_no_memory(h);
}

/* The bytes of a value in the image; false: they are not in it. */
static bool span_of(const struct masks *m, const struct ect_value *v, size_t *from, size_t *to)
{
	if (v->domain >= m->domains)
		return false;
	*from = m->logical[v->domain] + (size_t)v->bit / 8;
	*to = m->logical[v->domain] + ((size_t)v->bit + v->bits + 7) / 8;
	return *to <= 8 * m->bytes;
}

static u8 *mask_of(const struct masks *m, const struct ect_value *v)
{
	return m->mask + (v->dir == ECT_DIR_OUTPUT ? m->bytes : 0);
}

static int stale(struct ect_handle *h)
{
	return ect_fail(h, -ERANGE, "another session has begun meanwhile; repeat the command");
}

static int want(struct ect_handle *h, struct masks *m, const struct ect_value *const *values,
		size_t n)
{
	size_t from, to;

	for (size_t i = 0; i < n; i++) {
		if (!span_of(m, values[i], &from, &to))
			return stale(h);
		for (; from < to; from++)
			mask_of(m, values[i])[from / 8] |= (u8)(1 << from % 8);
	}
	return 0;
}

/* Where the wanted bytes are in a record */
static int locate(struct ect_recording *r, const struct masks *m,
		  const struct ect_value *const *values, size_t n)
{
	u32 *where = calloc(16 * m->bytes + 1, sizeof(*where)), at = sizeof(struct ec_record);
	size_t from, to;

	r->places = calloc(n + 1, sizeof(*r->places));
	if (!where || !r->places) {
		free(where);
		return ect_no_memory(r->h);
	}
	for (size_t i = 0; i < 16 * m->bytes; i++) {
		where[i] = at;
		at += m->mask[i / 8] >> i % 8 & 1;
	}
	for (size_t i = 0; i < n; i++) {
		const struct ect_value *v = values[i];

		if (!span_of(m, v, &from, &to))
			continue;	/* want() has refused it */
		r->places[i] = (struct place){
			.byte = where[from + (v->dir == ECT_DIR_OUTPUT ? 8 * m->bytes : 0)],
			.shift = v->bit % 8, .bits = v->bits,
		};
		r->domains |= 1ULL << v->domain % 64;
	}
	free(where);
	/* of the kernel's record, which ends with zeros */
	if (r->size < (at + 7u) / 8 * 8)
		return stale(r->h);
	return 0;
}

static int start(struct ect_recording *r, const struct masks *m, struct ect_record_info *info)
{
	struct ec_ioc_recorder arg = {
		.data = (uintptr_t)m->mask, .size = (u32)(2 * m->bytes),
	};
	int ret = ect_command(r->h, EC_IOC_RECORDER, &arg);
	struct ect_record_info to = {
		.struct_size = sizeof(to), .kept = arg.kept, .record_size = arg.record_size,
		.next = arg.next,
	};

	if (ret)
		return ret;
	if (arg.record_size < sizeof(struct ec_record))
		return ect_fail(r->h, -EINVAL, "the module and this library do not match");
	r->size = arg.record_size;
	r->room = r->size > BATCH_BYTES ? r->size : BATCH_BYTES / r->size * r->size;
	r->batch = malloc(r->room);
	if (!r->batch)
		return ect_no_memory(r->h);
	return info ? ect_give(r->h, info, &to, sizeof(to)) : 0;
}

int ect_record_begin(struct ect_handle *h, const struct ect_value *const *values, size_t n,
		     struct ect_recording **result, struct ect_record_info *info)
{
	struct ect_recording *r = calloc(1, sizeof(*r));
	struct masks m = { 0 };
	int ret = r ? read_domains(h, &m) : ect_no_memory(h);

	if (r)
		r->h = h;
	ret = ret ? ret : want(h, &m, values, n);
	ret = ret ? ret : start(r, &m, info);
	ret = ret ? ret : locate(r, &m, values, n);
	masks_free(&m);
	if (ret)
		ect_record_free(r);
	else
		*result = r;
	return ret;
}

/* The next records of the kernel; it returns whole ones. */
static int refill(struct ect_recording *r)
{
	long n = ect_sys_read(r->h->fd, r->batch, r->room);

	if (n < 0 && (errno == EINTR || errno == EAGAIN))
		return -EINTR;
	if (n < 0 && errno == ENODATA)
		return ect_fail(r->h, -ENODATA, "the session has ended");
	if (n < 0 && errno == ENOBUFS)
		return ect_fail(r->h, -ENOBUFS,
				"the session has ended, and what was not read was dropped for newer recordings");
	if (n < 0)
		return ect_failed(r->h);
	r->at = 0;
	r->got = (size_t)n / r->size * r->size;
	return r->got ? 0 : -EINTR;
}

static u32 worst(const struct ect_recording *r, const struct ec_record *x)
{
	if (x->zero & r->domains)
		return ECT_WC_ZERO;
	return r->domains & ~x->complete ? ECT_WC_INCOMPLETE : ECT_WC_COMPLETE;
}

int ect_record_read(struct ect_recording *r, struct ect_record *result)
{
	struct ect_record to = { .struct_size = sizeof(to) };
	int ret = r->at == r->got ? refill(r) : 0;
	struct ec_record x;

	if (ret)
		return ret;
	r->last = r->batch + r->at;
	r->at += r->size;
	memcpy(&x, r->last, sizeof(x));
	to.wc_state = worst(r, &x);
	to.number = x.number;
	to.missed = x.missed;
	to.time_ns = x.time_ns;
	to.app_time_ns = x.app_time_ns;
	to.cycle = x.cycle;
	to.sent = x.sent;
	return ect_give(r->h, result, &to, sizeof(to));
}

size_t ect_record_waiting(const struct ect_recording *r)
{
	return (r->got - r->at) / r->size;
}

uint64_t ect_record_bits(const struct ect_recording *r, size_t i)
{
	const struct place *p = &r->places[i];
	const u8 *from = r->last + p->byte;
	unsigned int bits = p->bits < 64 ? p->bits : 64, bytes = (p->shift + bits + 7u) / 8;
	u64 value = 0;

	for (unsigned int k = 0; k < bytes && k < 8; k++)
		value |= (u64)from[k] << 8 * k;
	value >>= p->shift;
	if (bytes > 8)
		value |= (u64)from[8] << (64 - p->shift);
	return bits < 64 ? value & ((1ULL << bits) - 1) : value;
}

void ect_record_free(struct ect_recording *r)
{
	if (!r)
		return;
	free(r->places);
	free(r->batch);
	free(r);
}
