// SPDX-License-Identifier: GPL-2.0-only
/*
 * SDO information: client and server against anything. Input: kind, buffer
 * size, then messages, each behind a length byte.
 */
#include "fuzz.h"
#include "../../devices/sim/sdoinfo_server.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\0\x40" "\x0A" "\0\x80\x82\0\1\0\1\0\0\x10" "\x08" "\0\x80\2\0\0\0\x18\x10"),
	SEED("\1\x40" "\x0E" "\0\x80\4\0\0\0\x18\x10\x23\0\4\x09ID"),
	SEED("\2\x40" "\x12" "\0\x80\6\0\0\0\x18\x10\1\0\7\0\x20\0\7\0PC"),
	SEED("\2\x40" "\x18" "\0\x80\6\0\0\0\x18\x10\1\x70\6\0\x10\0\7\0\1\0\2\0\3\0PC"),
	SEED("\0\x40" "\x0A" "\0\x80\7\0\0\0\0\0\2\6"),
	SEED("\3\x40" "\x08" "\0\x80\1\0\0\0\1\0" "\x0A" "\0\x80\5\0\0\0\x18\x10\1\0"),
	SEED("\4\x10" "0123456789abcdefghijklmnopqrstuvwxyz"),
	{ NULL, 0 }
};

static void client(const uint8_t *p, size_t len, int kind, size_t cap)
{
	u8 *buf = malloc(cap + 1), tx[16];
	struct ec_sdoinfo s;
	struct ec_od_object o;
	struct ec_od_entry e;
	struct ec_od_values v;
	int ret = EC_STALE;

	if (kind == 0)
		ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, buf, cap);
	else if (kind == 1)
		ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1018, 0, buf, cap);
	else
		ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1018, 1, buf, cap);
	MUST(ec_sdoinfo_tx(&s, tx, sizeof(tx)) == (kind == 2 ? 10 : 8));
	while (len) {
		size_t n = min((size_t)p[0], len - 1);

		ret = ec_sdoinfo_rx(&s, p + 1, n);
		MUST(s.size <= cap);
		if (ret != EC_WAIT && ret != EC_STALE) {
			MUST(ret <= 0 && ec_sdoinfo_rx(&s, p + 1, n) == -EINVAL);
			break;
		}
		p += 1 + n;
		len -= 1 + n;
	}
	if (ret == 0) {
		if (!ec_od_object_decode(buf, s.size, &o))
			MUST(o.name_len <= s.size - 6);
		if (!ec_od_entry_decode(buf, s.size, &e))
			MUST(e.name_len <= s.size - 10);
		for (size_t plain = 0; plain < s.size + 2; plain++)
			if (!ec_od_values_decode(buf, s.size, plain, &v))
				MUST(!v.max || v.max + v.size <= buf + plain + s.size);
	}
	free(buf);
}

static void server(const uint8_t *p, size_t len)
{
	struct ec_sdoinfo_req req;

	while (len) {
		size_t n = min((size_t)p[0], len - 1);

		if (!ec_sdoinfo_req_decode(p + 1, n, &req))
			MUST(req.opcode == 1 || req.opcode == 3 || req.opcode == 5);
		p += 1 + n;
		len -= 1 + n;
	}
}

/* Whatever the server cuts into fragments, the client puts together again. */
static void both(const uint8_t *p, size_t len, size_t mbox)
{
	static u8 body[16384], got[16384];
	u8 tx[256];
	struct ec_sdoinfo_resp resp;
	struct ec_sdoinfo s;
	int n, ret = EC_WAIT;

	body[0] = 0x18;
	body[1] = 0x10;
	memcpy(body + 2, p, len);
	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1018, 0, got, sizeof(got));
	ec_sdoinfo_resp_init(&resp, EC_SDOINFO_OBJECT_RESP, body, len + 2);
	while ((n = ec_sdoinfo_resp_next(&resp, tx, mbox)) > 0) {
		MUST(n <= (int)mbox && ret == EC_WAIT);
		ret = ec_sdoinfo_rx(&s, tx, (size_t)n);
	}
	if (mbox < 10) {
		MUST(n == -EMSGSIZE);
		return;
	}
	MUST(ret == 0 && s.size == len + 2 && !memcmp(got, body, s.size));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	if (len < 2)
		return 0;
	switch (data[0] & 7) {
	case 0:
	case 1:
	case 2:
		client(data + 2, len - 2, data[0] & 7, data[1]);
		break;
	case 3:
		server(data + 2, len - 2);
		break;
	default:
		both(data + 2, len - 2, data[1]);
		break;
	}
	return 0;
}
