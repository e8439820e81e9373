// SPDX-License-Identifier: GPL-2.0-only
/* Copies of both ends of a ring: nothing behind the frame is touched, and none is lost. */
#include "fuzz.h"
#include "../../master/wire/frame.h"
#include "../../master/wire/merge.h"

/* FPRD, BRD and LRW; then both copies, which begin with the length of what was sent */
const struct fuzz_seed fuzz_seeds[] = {
	SEED("\x0E\x10\x04\x05\xE9\x03\x30\x01\x02\x00\x00\x00\x00\x00\x00\x00"
	     "\x0E\x10\x04\x05\xE9\x03\x30\x01\x02\x00\x00\x00\x08\x00\x01\x00"
	     "\x0E\x10\x04\x05\xE9\x03\x30\x01\x02\x00\x00\x00\x00\x00\x00\x00"),
	SEED("\x0E\x10\x07\x05\x00\x00\x30\x01\x02\x00\x00\x00\x00\x00\x00\x00"
	     "\x0E\x10\x07\x05\x02\x00\x30\x01\x02\x00\x00\x00\x02\x00\x02\x00"
	     "\x0E\x10\x07\x05\x03\x00\x30\x01\x02\x00\x04\x00\x08\x00\x03\x00"),
	SEED("\x16\x10\x0C\x05\x00\x00\x00\x01\x0A\x00\x00\x00\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5\x00\x00"
	     "\x16\x10\x0C\x05\x00\x00\x00\x01\x0A\x00\x00\x00\xA6\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5\x03\x00"
	     "\x16\x10\x0C\x05\x00\x00\x00\x01\x0A\x00\x00\x00\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5\x5A\x03\x00"),
	{ NULL, 0 }
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	size_t each = len / 3, at = EC_FRAME_HDR, size;
	u8 *a = malloc(each), *b = malloc(each), *sent = malloc(each), *to = malloc(each);
	u8 *copy = malloc(each), *all;
	u16 none = 0xffff, cut = len ? data[len - 1] : 0;

	MUST(a && b && sent && to && copy);
	memcpy(sent, data, each);
	memcpy(a, data + each, each);
	memcpy(b, data + 2 * each, each);
	if (each >= at)
		ec_merge_dgrams(to + at, a + at, b + at, sent + at, each - at);
	/* working counters are those of both */
	while (at + EC_DGRAM_OVERHEAD <= each) {
		u16 word = get_unaligned_le16(sent + at + 6);

		size = EC_DGRAM_OVERHEAD + (word & EC_DGRAM_LEN_MASK);
		if (size > each - at)
			break;
		MUST(get_unaligned_le16(to + at + size - EC_DGRAM_WKC) ==
		     (u16)(get_unaligned_le16(a + at + size - EC_DGRAM_WKC) +
			   get_unaligned_le16(b + at + size - EC_DGRAM_WKC)));
		if (!(word & EC_DGRAM_MORE))
			break;
		at += size;
	}
	/* data are merged alike, wherever those of one copy are said to end */
	all = ec_merge_data(to, a, b, sent, each, &none);
	MUST(all == to);
	MUST(!memcmp(ec_merge_data(copy, a, b, sent, each, &cut), to, each));
	free(copy);
	free(a);
	free(b);
	free(sent);
	free(to);
	return 0;
}
