// SPDX-License-Identifier: GPL-2.0-only
/*
 * The lines of 'ethercat mailbox --follow': a message as the kernel gives it. Input: flags, bytes
 * of the message beyond those kept, then its bytes.
 */
#include "fuzz.h"
#include "../../lib/tools/mail_coe.c"
#include "../../lib/tools/mail_text.c"
#include "../../lib/tools/text.c"


const struct fuzz_seed fuzz_seeds[] = {
	SEED("\1\0" "\x0a\0\0\0\0\x13" "\0\x20\x40\x18\x10\4\0\0\0\0"),
	SEED("\0\0" "\x0a\0\0\0\0\x13" "\0\x30\x4b\x18\x10\4\2\0\0\0"),
	SEED("\0\0" "\x0a\0\0\0\0\x23" "\0\x30\x80\x18\x10\4\0\0\2\6"),
	SEED("\0\0" "\x0a\0\0\0\0\x23" "\0\x10\x10\x32\4\1\2\3\4\5"),
	SEED("\0\0" "\x0a\0\0\0\0\x23" "\0\x80\2\0\1\0\2\0\0\x10"),
	SEED("\1\0" "\x0c\0\0\0\0\x24" "\2\0\1\0\0\0fw.bin"),
	SEED("\0\0" "\x0c\0\0\0\0\x24" "\5\0\1\x80\0\0no\x1b[2J"),
	SEED("\0\x30" "\x40\0\0\0\0\x24" "\3\0\1\0\0\0data"),
	SEED("\0\0" "\6\0\0\0\0\x35" "\x12\x40\x0f\0\1\x10"),
	SEED("\0\0" "\6\0\0\0\0\x32" "\0\1\0\x10\1\2"),
	SEED("\0\0" "\4\0\0\0\0\x32" "\3\0\1\2"),
	SEED("\0\0" "\7\0\0\0\0\x3f" "\2\0\0\0\1\0x"),
	SEED("\0\0" "\x20\0\0\0\0\x31" "123456\1\0" "123456\2\0" "\2\0\5\0\0\0\0\0\1\0\0\0\7\0\0\0"),
	SEED("\0\0" "\4\0\0\0\0\x30" "\1\0\2\0"),
	{ NULL, 0 }
};

static void harmless(const char *s, size_t size)
{
	MUST(memchr(s, 0, size));
	for (; *s; s++)
		MUST((u8)*s >= 0x20 && *s != 0x7f);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ect_mail m = { .struct_size = sizeof(m) };
	size_t n;

	if (len < 2)
		return 0;
	n = min(len - 2, sizeof(m.data));
	m.flags = data[0] & (ECT_MAIL_TO_SLAVE | ECT_MAIL_UNSURE | ECT_MAIL_MALFORMED);
	m.kept = (u32)n;
	/* of a message that is longer than the record, all of the record is kept */
	m.size = (u32)n + (n == sizeof(m.data) ? data[1] : 0);
	memcpy(m.data, data + 2, n);
	/* most headers fit to the message, or nothing behind them would be read */
	if (n >= EC_MBOX_HDR && !(data[0] & 0x80))
		put_unaligned_le16((u16)(m.size - EC_MBOX_HDR), m.data);
	/* what is behind is not of the message */
	memset(m.data + n, 0xa5, sizeof(m.data) - n);
	mail_decode(&m);
	MUST(*m.protocol && *m.service);
	harmless(m.protocol, sizeof(m.protocol));
	harmless(m.service, sizeof(m.service));
	harmless(m.object, sizeof(m.object));
	harmless(m.result, sizeof(m.result));
	MUST(!(m.flags & ECT_MAIL_REQUEST && m.flags & ECT_MAIL_REPLY));
	return 0;
}
