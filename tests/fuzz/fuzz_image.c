// SPDX-License-Identifier: GPL-2.0-only
/*
 * EEPROM images as slaves: refused, or a slave that lives: goes through the
 * states with what its image says, and gets the rest of the input as mailbox.
 */
#include "fuzz_sim.h"

#define FIXED "\x05\x0C\x03\x06\x10\x27\0\0\0\0\0\0\0\0\x00\0\x37\x13\0\0\x56\x34\x12\0\1\0\0\0\0\0\0\0" \
	"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x10\x40\0\x40\x10\x40\0\4\0\0\0\0\0\0\0" \
	"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0" \
	"\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x0F\0\1\0"
#define SMS "\x29\0\x10\0\0\x10\x40\0\x26\0\1\1\x40\x10\x40\0\x22\0\1\2" \
	"\0\x11\2\0\x24\0\1\3\x80\x11\2\0\x20\0\1\4"
#define GENERAL "\x1E\0\x10\0\0\0\0\0\0\x2F\0\0\0\0\0\0\0\0\0\0\x11\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"
#define PDOS "\x32\0\x08\0\0\x1A\1\3\0\0\0\0\0\x60\1\0\6\x10\0\0" \
	"\x33\0\x08\0\0\x16\1\2\0\0\0\0\0\x70\1\0\6\x10\0\0"

const struct fuzz_seed fuzz_seeds[] = {
	SEED(FIXED GENERAL SMS PDOS "\xFF\xFF"),
	SEED(FIXED SMS PDOS "\xFF\xFF"),
	SEED(FIXED "\x0A\0\2\0\1\1A\xFF" GENERAL "\x28\0\1\0\1\2" SMS
	     "\x3C\0\x0C\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\3\1\0\0\0\0\0\0\0\xFF\xFF"),
	SEED(FIXED "\xFF\xFF"),
	{ NULL, 0 }
};

static u8 image[8192 + 16];
static size_t image_len;

static int load(void *ctx, const char *name, u8 *buf, size_t cap)
{
	(void)ctx;
	MUST(!strcmp(name, "x.bin"));
	memcpy(buf, image, min(image_len, cap));
	return (int)image_len;
}

static const struct ec_sim_loader loader = { load, NULL };
static u64 now;

static int dgram(struct ec_sim *sim, u8 cmd, u16 ado, const void *data, u16 len)
{
	static u8 frame[1500];
	struct ec_frame_buf f;
	u8 *p;

	ec_frame_begin(&f, frame, sizeof(frame));
	p = ec_frame_add(&f, cmd, 1, 0, ado, len);
	if (!p)
		return -1;
	memset(p, 0, len);
	if (data)
		memcpy(p, data, len);
	now += 1000000;
	ec_sim_frame(sim, 0, frame, ec_frame_end(&f), now);
	return get_unaligned_le16(p + len);
}

static void live(struct ec_sim *sim)
{
	struct ec_sii_sm sm[16];
	struct ec_sii_info info;
	u8 page[EC_SM_PAGE], state[2] = { 0 };
	int i, n = ec_sii_decode_sms(image, image_len, sm, 16);

	MUST(!ec_sii_decode_info(image, image_len, &info));
	for (i = 0; i < n; i++) {
		struct ec_sm s = { .start = sm[i].start, .len = sm[i].len,
				   .control = sm[i].control, .activate = 1 };

		ec_sm_encode(&s, page);
		dgram(sim, EC_CMD_APWR, (u16)EC_REG_SM(i), page, sizeof(page));
	}
	for (state[0] = 2; state[0] <= 8; state[0] *= 2) {
		dgram(sim, EC_CMD_APWR, EC_REG_AL_CONTROL, state, 2);
		ec_sim_advance(sim, now += 2000000);
		/* any bytes will do as a request */
		if (info.std.rx_size && info.std.rx_size <= image_len - 16)
			dgram(sim, EC_CMD_APWR, info.std.rx_offset,
			      image + 16, info.std.rx_size);
		if (info.std.tx_size && info.std.tx_size < 1400)
			dgram(sim, EC_CMD_APRD, info.std.tx_offset, NULL, info.std.tx_size);
		for (i = 2; i < n; i++)
			if (sm[i].len && sm[i].len < 1400)
				dgram(sim, sm[i].control & 4 ? EC_CMD_APWR : EC_CMD_APRD,
				      sm[i].start, NULL, sm[i].len);
	}
	ec_sim_advance(sim, now += 1000000000);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	static const char text[] = "slave x file=x.bin\n";
	struct ec_sim *sim;

	image_len = min(len, sizeof(image));
	memcpy(image, data, image_len);
	if (image_len > 15 && !(len & 1))	/* else the slave's PDI is dead */
		image[14] = ec_sii_crc(image);
	now = 0;
	sim = fuzz_describe(text, sizeof(text) - 1, &loader, -1);
	if (!sim)
		return 0;
	live(sim);
	fuzz_release(sim);
	return 0;
}
