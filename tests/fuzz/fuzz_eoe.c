// SPDX-License-Identifier: GPL-2.0-only
/* IP parameters of EoE. */
#include "fuzz.h"
#include "../../master/wire/eoe.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\2\1\0\0\x3f\0\0\0\2\0\0\xec\1\7\1\0\xa8\xc0\0\xff\xff\xff\xfe\0\xa8\xc0\1\2\3\4name\0"
	     "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"),
	SEED("\7\1\0\0\2\0\0\0\0\0\0\0\0\0\1\0\xa8\xc0"),
	SEED("\2\1\0\0\x0a\0\0\0\1\0\xa8\xc0\xfe\0\xa8\xc0"),	/* packed */
	SEED("\3\1\1\2"),
	SEED("\6\1\0\0"),
	{ NULL, 0 }
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	static const u8 mac[6] = { 2 };
	struct ec_eoe_ip p, again;
	u8 out[EC_EOE_IP_SIZE];
	u16 result;
	int type = ec_eoe_type_decode(data, len);

	MUST((type < 0) == (len < EC_EOE_HDR) && type < 16);
	if (!ec_eoe_result_decode(data, len, EC_EOE_SET_IP_RESP, &result)) {
		MUST(type == EC_EOE_SET_IP_RESP && ec_eoe_result_text(result));
		MUST(ec_eoe_result_encode(out, sizeof(out), (u8)type, result) == EC_EOE_HDR);
		MUST(!memcmp(out + 2, data + 2, 2));
	}
	if (!ec_eoe_ip_decode_packed(data, len, &p)) {
		int n = ec_eoe_ip_encode_packed(out, sizeof(out), EC_EOE_SET_IP_REQ, &p);

		MUST(n >= EC_EOE_HDR + 4 && (size_t)n <= len);
		MUST(!memcmp(out + EC_EOE_HDR + 4, data + EC_EOE_HDR + 4,
			     (size_t)n - EC_EOE_HDR - 4));
		MUST(!ec_eoe_ip_decode_packed(out, (size_t)n, &again) &&
		     !memcmp(&p, &again, sizeof(p)));
	}
	if (ec_eoe_ip_decode(data, len, &p))
		return 0;
	MUST(len >= EC_EOE_HDR + 4 && !(p.which & ~EC_EOE_ALL));
	MUST(ec_eoe_ip_encode(out, sizeof(out), EC_EOE_SET_IP_REQ, &p) == EC_EOE_IP_SIZE);
	MUST(!ec_eoe_ip_decode(out, sizeof(out), &again) && !memcmp(&p, &again, sizeof(p)));
	/* without gaps both readings are the same */
	if (ec_eoe_ip_fill(&p, &again, mac)) {
		MUST(ec_eoe_ip_encode(out, sizeof(out), EC_EOE_SET_IP_REQ, &p) == EC_EOE_IP_SIZE);
		MUST(!ec_eoe_ip_decode_packed(out, sizeof(out), &again) &&
		     !memcmp(&p, &again, sizeof(p)));
	}
	return 0;
}
