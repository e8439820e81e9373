/* SPDX-License-Identifier: GPL-2.0-only */
/* Tests write compiled bus files with this. */
#ifndef COMPILED_FILE_H
#define COMPILED_FILE_H

#include "../../master/wire/compiled.h"

/* a file that is written here */
struct compiled_file {
	u8 data[2048];
	struct ec_wbuf w;
	u8 *body;
	u32 n;
};

static struct compiled_file f;

static inline void begin(u16 op)
{
	ec_wbuf_le16(&f.w, op);
	ec_wbuf_le16(&f.w, 0);
	ec_wbuf_le32(&f.w, 0);
	f.body = f.w.p;
	f.n++;
}

static inline void end(void)
{
	size_t size = (size_t)(f.w.p - f.body);

	put_unaligned_le32((u32)size, f.body - 4);
	ec_wbuf_zero(&f.w, -size & 3);
}

static inline void text(const char *s)
{
	ec_wbuf_le16(&f.w, (u16)(strlen(s) + 1));
	ec_wbuf_bytes(&f.w, s, strlen(s) + 1);
}

static inline void numbers(const u32 *v, unsigned int n)
{
	while (n--)
		ec_wbuf_le32(&f.w, *v++);
}

#define U32(...) numbers((const u32[]){ __VA_ARGS__ }, ARRAY_SIZE(((const u32[]){ __VA_ARGS__ })))

static inline void bytes(const char *s, size_t n)
{
	ec_wbuf_bytes(&f.w, s, n);
}

static inline void start(void)
{
	memset(&f, 0, sizeof(f));
	f.w = ec_wbuf(f.data, sizeof(f.data));
	ec_wbuf_zero(&f.w, EC_COMPILED_HEADER);
}

/* a header that is right for @size bytes */
static inline void seal(u8 *data, size_t size, u32 n)
{
	memcpy(data, EC_COMPILED_MAGIC, sizeof(EC_COMPILED_MAGIC));
	put_unaligned_le16(EC_COMPILED_VERSION, data + 8);
	put_unaligned_le32((u32)size, data + 12);
	put_unaligned_le32(n, data + 20);
	put_unaligned_le32(ec_compiled_crc(data + 20, size - 20), data + EC_COMPILED_CRC_AT);
}

static inline size_t finish(void)
{
	size_t size = (size_t)(f.w.p - f.data);

	seal(f.data, size, f.n);
	return size;
}

#endif
