// SPDX-License-Identifier: GPL-2.0-only
/* Frames: every datagram stays inside, and what is sound is built again byte by byte. */
#include "fuzz.h"
#include "../../devices/sim/esc_page.h"
#include "../../master/wire/frame.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\x0E\x10\x07\x05\x00\x00\x30\x01\x02\x00\x00\x00\x00\x00\x00\x00"),
	SEED("\x1B\x10\x05\x80\xE9\x03\x20\x01\x02\x80\x00\x00\x02\x00\x00\x00"
	     "\x0A\x80\x10\x00\x00\x01\x01\x00\x00\x00\x00\x00\x00"),
	SEED("\x0C\x10\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\0\0\0\0\0\0\0\0\0\0"),
	{ NULL, 0 }
};

static void pages(const uint8_t *p, size_t len)
{
	struct ec_fmmu f;
	struct ec_sm sm;
	u8 page[16], again[16];

	if (len < 16)
		return;
	ec_fmmu_decode(&f, p);
	ec_fmmu_encode(&f, page);
	ec_fmmu_decode(&f, page);
	ec_fmmu_encode(&f, again);
	MUST(!memcmp(page, again, 16));
	MUST(ec_fmmu_bits(&f) <= 8u * f.len);
	ec_sm_decode(&sm, p);
	ec_sm_encode(&sm, page);
	MUST(!memcmp(page, p, 8));
}

/* Sound datagrams appended to those of another frame: what was there stays as it was. */
static void append(const uint8_t *data, size_t len, size_t last, unsigned int count)
{
	static u8 buf[EC_FRAME_HDR + EC_FRAME_BODY_MAX];
	struct ec_frame_iter it;
	struct ec_frame_buf f;
	struct ec_dgram d;
	size_t body = (get_unaligned_le16(data) & 0x7FF), total;
	unsigned int n = 0;

	MUST(body <= len - EC_FRAME_HDR);
	ec_frame_begin(&f, buf, sizeof(buf));
	memset(ec_frame_add(&f, EC_CMD_BRD, 5, 0, 0x0130, 2), 0, 2);
	if (!ec_frame_append(&f, data + EC_FRAME_HDR, body, last, count)) {
		MUST(body > EC_FRAME_BODY_MAX - 14);
		return;
	}
	total = ec_frame_end(&f);
	MUST(!ec_frame_iter_init(&it, buf, total));
	while (ec_frame_iter_next(&it, &d) == 1)
		n++;
	MUST(n == count + 1 && total == EC_FRAME_HDR + 14 + body);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	static u8 again[EC_FRAME_HDR + EC_FRAME_BODY_MAX];
	struct ec_frame_iter it;
	struct ec_frame_buf f;
	struct ec_dgram d;
	u8 *frame = (u8 *)data;		/* only read here */
	int ret, n = 0;
	bool fits = true;
	size_t last = 0;

	pages(data, len);
	if (ec_frame_iter_init(&it, frame, len))
		return 0;
	ec_frame_begin(&f, again, sizeof(again));
	while ((ret = ec_frame_iter_next(&it, &d)) == 1) {
		u8 *p;

		MUST(d.hdr >= frame && d.data + d.len + 2 <= frame + len);
		MUST(++n <= 200);
		last = d.hdr - frame - EC_FRAME_HDR;
		p = ec_frame_add(&f, d.cmd, d.idx, d.adp, d.ado, d.len);
		if (!p) {
			fits = false;
			continue;
		}
		memcpy(p, d.data, (size_t)d.len + 2);
		put_unaligned_le16(d.irq, p - 2);
		if (d.circulating)
			p[-3] |= 0x40;
		/* reserved bits are the only ones that do not come back */
		if (fits)
			MUST(!memcmp(p - 10, d.hdr, 7) && !memcmp(p - 2, d.hdr + 8, d.len + 4u));
	}
	MUST(ec_frame_iter_next(&it, &d) == ret);
	if (!ret && fits)
		MUST(ec_frame_end(&f) == 2u + (get_unaligned_le16(frame) & 0x7FF));
	if (!ret && n)
		append(data, len, last, n);
	return 0;
}
