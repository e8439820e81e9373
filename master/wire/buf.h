/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * Cursors over byte buffers with a sticky error: read or write all fields,
 * test @bad once. A short read returns zeros, a short write is dropped.
 */
#ifndef EC_WIRE_BUF_H
#define EC_WIRE_BUF_H

#include "env.h"

/**
 * struct ec_rbuf - read cursor
 * @p: next byte
 * @end: first byte behind the buffer
 * @bad: set by the first read that did not fit
 */
struct ec_rbuf {
	const u8 *p;
	const u8 *end;
	bool bad;
};

/**
 * struct ec_wbuf - write cursor
 * @p: next byte
 * @end: first byte behind the buffer
 * @bad: set by the first write that did not fit
 */
struct ec_wbuf {
	u8 *p;
	u8 *end;
	bool bad;
};

static inline struct ec_rbuf ec_rbuf(const void *data, size_t len)
{
	return (struct ec_rbuf){ .p = data, .end = (const u8 *)data + len };
}

static inline size_t ec_rbuf_left(const struct ec_rbuf *r)
{
	return (size_t)(r->end - r->p);
}

/* NULL when fewer than @n bytes are left */
static inline const u8 *ec_rbuf_take(struct ec_rbuf *r, size_t n)
{
	const u8 *p = r->p;

	if (r->bad || ec_rbuf_left(r) < n) {
		r->bad = true;
		return NULL;
	}
	r->p += n;
	return p;
}

static inline u8 ec_rbuf_u8(struct ec_rbuf *r)
{
	const u8 *p = ec_rbuf_take(r, 1);

	return p ? *p : 0;
}

static inline u16 ec_rbuf_le16(struct ec_rbuf *r)
{
	const u8 *p = ec_rbuf_take(r, 2);

	return p ? get_unaligned_le16(p) : 0;
}

static inline u32 ec_rbuf_le32(struct ec_rbuf *r)
{
	const u8 *p = ec_rbuf_take(r, 4);

	return p ? get_unaligned_le32(p) : 0;
}

static inline u64 ec_rbuf_le64(struct ec_rbuf *r)
{
	const u8 *p = ec_rbuf_take(r, 8);

	return p ? get_unaligned_le64(p) : 0;
}

static inline struct ec_wbuf ec_wbuf(void *data, size_t cap)
{
	return (struct ec_wbuf){ .p = data, .end = (u8 *)data + cap };
}

static inline u8 *ec_wbuf_take(struct ec_wbuf *w, size_t n)
{
	u8 *p = w->p;

	if (w->bad || (size_t)(w->end - w->p) < n) {
		w->bad = true;
		return NULL;
	}
	w->p += n;
	return p;
}

static inline void ec_wbuf_u8(struct ec_wbuf *w, u8 v)
{
	u8 *p = ec_wbuf_take(w, 1);

	if (p)
		*p = v;
}

static inline void ec_wbuf_le16(struct ec_wbuf *w, u16 v)
{
	u8 *p = ec_wbuf_take(w, 2);

	if (p)
		put_unaligned_le16(v, p);
}

static inline void ec_wbuf_le32(struct ec_wbuf *w, u32 v)
{
	u8 *p = ec_wbuf_take(w, 4);

	if (p)
		put_unaligned_le32(v, p);
}

static inline void ec_wbuf_le64(struct ec_wbuf *w, u64 v)
{
	u8 *p = ec_wbuf_take(w, 8);

	if (p)
		put_unaligned_le64(v, p);
}

static inline void ec_wbuf_bytes(struct ec_wbuf *w, const void *data, size_t n)
{
	u8 *p = ec_wbuf_take(w, n);

	if (p && n)
		memcpy(p, data, n);
}

static inline void ec_wbuf_zero(struct ec_wbuf *w, size_t n)
{
	u8 *p = ec_wbuf_take(w, n);

	if (p && n)
		memset(p, 0, n);
}

#endif
