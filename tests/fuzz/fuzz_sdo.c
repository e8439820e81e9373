// SPDX-License-Identifier: GPL-2.0-only
/*
 * SDO client and server against anything. Input: flags, buffer size, mailbox
 * size, then messages, each behind a length byte.
 */
#include "fuzz.h"
#include "../../devices/sim/sdo_server.h"
#include "../../master/wire/sdo.h"

const struct fuzz_seed fuzz_seeds[] = {
	/* expedited upload, segmented upload, abort */
	SEED("\0\x10\x40" "\x0A" "\0\x30\x43\0\x20\1\1\2\3\4"),
	SEED("\0\x40\x40" "\x0A" "\0\x30\x41\0\x20\1\x0A\0\0\0"
	     "\x0A" "\0\x30\0\1\2\3\4\5\6\7" "\x0A" "\0\x30\x19\1\2\3\0\0\0\0"),
	SEED("\0\x40\x40" "\x0A" "\0\x20\x80\0\x20\1\0\0\2\6"),
	SEED("\0\x40\x40" "\x0E" "\0\x30\x41\0\x20\1\4\0\0\0\1\2\3\4"),
	/* downloads */
	SEED("\1\4\x40" "\x0A" "\0\x30\x60\0\x20\1\0\0\0\0"),
	SEED("\1\x20\x0C" "\x0A" "\0\x30\x60\0\x20\1\0\0\0\0"
	     "\x0A" "\0\x30\x20\0\0\0\0\0\0\0" "\x0A" "\0\x30\x30\0\0\0\0\0\0\0"
	     "\x0A" "\0\x30\x20\0\0\0\0\0\0\0"),
	/* requests to the server */
	SEED("\2\x40\x18" "\x0A" "\0\x20\x40\0\x20\1\0\0\0\0" "\x0A" "\0\x20\x60\0\0\0\0\0\0\0"
	     "\x0A" "\0\x20\x70\0\0\0\0\0\0\0"),
	SEED("\2\x40\x18" "\x0A" "\0\x20\x2F\0\x20\1\5\0\0\0"
	     "\x0C" "\0\x20\x21\0\x20\1\x0B\0\0\0\1\2" "\x0C" "\0\x20\0\1\2\3\4\5\6\7\x08\x09"
	     "\x0A" "\0\x20\x01\1\2\3\4\5\6\7" "\x0A" "\0\x20\x50\0\x20\0\0\0\0\0"),
	{ NULL, 0 }
};

static size_t object_len;

static u32 read_object(void *ctx, u16 index, u8 sub, bool complete, u8 *buf, size_t cap, size_t *len)
{
	(void)ctx, (void)complete;
	if (index == 0x2001)
		return EC_ABORT_NO_OBJECT;
	*len = object_len + sub;
	if (*len <= cap)
		memset(buf, 0x5A, *len);
	return 0;
}

static u32 write_object(void *ctx, u16 index, u8 sub, bool complete, const u8 *data, size_t len)
{
	volatile u8 sum = 0;

	(void)ctx, (void)sub, (void)complete;
	while (len--)
		sum = (u8)(sum + data[len]);
	return index & 1 ? EC_ABORT_READ_ONLY : 0;
}

static void serve(const uint8_t *p, size_t len, size_t cap, size_t mbox)
{
	static const struct ec_sdo_srv_ops ops = { read_object, write_object };
	u8 *buf = malloc(cap + 1), *resp = malloc(mbox + 1);
	struct ec_sdo_srv srv;
	int ret;

	object_len = cap / 2;
	ec_sdo_srv_init(&srv, &ops, NULL, buf, cap);
	while (len) {
		size_t n = min((size_t)p[0], len - 1);

		ret = ec_sdo_srv_handle(&srv, p + 1, n, resp, mbox);
		MUST(ret <= (int)mbox && (ret <= 0 || ret >= 10));
		MUST(ret != -EINVAL || mbox < EC_SDO_MSG);
		MUST(srv.state == EC_SDO_SRV_IDLE || (srv.pos <= srv.size && srv.size <= cap));
		p += 1 + n;
		len -= 1 + n;
	}
	free(buf);
	free(resp);
}

/* A last message is due exactly when the exchange says so. */
static void ended(int ret, bool send_abort, int abort_len, int after)
{
	MUST(ret <= 0);
	MUST(!send_abort || ret < 0);
	MUST(abort_len == (send_abort ? 10 : -EINVAL));
	MUST(after == -EINVAL);
}

static void up(const uint8_t *p, size_t len, size_t cap, bool complete)
{
	u8 *buf = malloc(cap + 1), tx[16];
	struct ec_sdo u;
	int ret = EC_MORE;
	bool tell;

	ec_sdo_upload_init(&u, 0x2000, 1, complete, buf, cap);
	while (len) {
		size_t n = min((size_t)p[0], len - 1);

		if (ret == EC_MORE)
			MUST(ec_sdo_tx(&u, tx, sizeof(tx)) == 10);
		ret = ec_sdo_rx(&u, p + 1, n);
		MUST(u.size <= cap);
		if (ret != EC_MORE && ret != EC_STALE) {
			tell = u.send_abort;
			ended(ret, tell, ec_sdo_tx(&u, tx, sizeof(tx)),
			      ec_sdo_rx(&u, p + 1, n));
			break;
		}
		p += 1 + n;
		len -= 1 + n;
	}
	free(buf);
}

static void down(const uint8_t *p, size_t len, size_t size, size_t mbox, bool complete)
{
	u8 *buf = malloc(size + 1), *tx = malloc(mbox + 1);
	struct ec_sdo d;
	int ret = EC_MORE, n;
	bool tell;

	memset(buf, 0xA5, size + 1);
	ec_sdo_download_init(&d, 0x2000, 1, complete, buf, size, mbox);
	while (len) {
		size_t l = min((size_t)p[0], len - 1);

		if (ret == EC_MORE) {
			n = ec_sdo_tx(&d, tx, mbox);
			MUST(n <= (int)mbox);
			if (n < 0) {
				MUST(mbox < EC_SDO_MSG);
				break;
			}
		}
		ret = ec_sdo_rx(&d, p + 1, l);
		MUST(d.sent <= size);
		if (ret != EC_MORE && ret != EC_STALE) {
			MUST(ret || d.sent == size);
			tell = d.send_abort;
			ended(ret, tell, ec_sdo_tx(&d, tx, mbox),
			      ec_sdo_rx(&d, p + 1, l));
			break;
		}
		p += 1 + l;
		len -= 1 + l;
	}
	free(buf);
	free(tx);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	if (len < 3)
		return 0;
	switch (data[0] & 3) {
	case 0:
		up(data + 3, len - 3, data[1], data[0] & 4);
		break;
	case 1:
		down(data + 3, len - 3, data[1], data[2], data[0] & 4);
		break;
	default:
		serve(data + 3, len - 3, data[1], data[2]);
		break;
	}
	return 0;
}
