// SPDX-License-Identifier: GPL-2.0-only
/*
 * Servers of a simulated slave: CoE, EoE, FoE, SoE and VoE, over its mailbox. Input: a byte with
 * the scripted fault, then messages, each a length byte, type and counter, and its content.
 */
#include "fuzz_sim.h"
#include "../../master/wire/frame.h"

#define SIZE	128	/* of a mailbox */
#define STATION	1001
#define AT	0x1000

const struct fuzz_seed fuzz_seeds[] = {
	/* SDO: upload, download in segments, complete access; list, object, entry */
	SEED("\0" "\x0A\x13" "\0\x20\x40\x18\x10\1\0\0\0\0" "\x0A\x23" "\0\x20\x40\0\x20\0\0\0\0\0"
	     "\x0A\x33" "\0\x20\x60\0\0\0\0\0\0\0" "\x0A\x43" "\0\x20\x70\0\0\0\0\0\0\0"),
	SEED("\0" "\x0C\x13" "\0\x20\x21\0\x20\0\xE8\3\0\0\1\2" "\x0A\x23" "\0\x20\0\1\2\3\4\5\6\7"
	     "\x0A\x33" "\0\x20\x11\1\2\3\4\5\6\7"),
	SEED("\0" "\x0A\x13" "\0\x20\x50\x18\x10\0\0\0\0\0" "\x0A\x23" "\0\x20\x23\1\x20\4\1\2\3\4"),
	SEED("\0" "\x08\x13" "\0\x80\1\0\0\0\1\0" "\x08\x23" "\0\x80\3\0\0\0\x18\x10"
	     "\x0A\x33" "\0\x80\5\0\0\0\x18\x10\1\0"),
	/* FoE: write, read, error */
	SEED("\0" "\x08\x14" "\2\0\0\0\0\0fw" "\x09\x24" "\3\0\1\0\0\0abc" "\x08\x34" "\1\0\0\0\0\0fw"
	     "\6\x44" "\4\0\1\0\0\0" "\x07\x54" "\5\0\0\x80\0\0x"),
	/* SoE: name, value, list; write. VoE */
	SEED("\0" "\4\x15" "\1\x40\x5B\0" "\4\x25" "\1\x3F\x11\0" "\x08\x35" "\3\x40\x2F\0\1\2\3\4"
	     "\x09\x3F" "\1\0\0\0\2\0abc"),
	/* EoE: IP parameters */
	SEED("\0" "\x10\x12" "\2\0\0\0\1\0\0\0\1\2\3\4\5\6\7\x08"),
	/* each with a fault */
	SEED("\x10" "\x0A\x13" "\0\x20\x40\x18\x10\1\0\0\0\0" "\x08\x24" "\2\0\0\0\0\0fw"),
	SEED("\x0C" "\x0A\x13" "\0\x20\x40\x18\x10\1\0\0\0\0" "\x08\x24" "\2\0\0\0\0\0fw"),
	{ NULL, 0 }
};

static struct ec_sim *sim;
static struct ec_app *app;
static u64 now = 1000000;

/* One datagram; its working counter. */
static u16 access(u8 cmd, u16 adp, u16 ado, u8 *data, u16 len)
{
	u8 f[SIZE + 64], *p;
	struct ec_frame_buf b;
	struct ec_frame_iter it;
	struct ec_dgram d;
	size_t n;

	ec_frame_begin(&b, f, sizeof(f));
	p = ec_frame_add(&b, cmd, 0, adp, ado, len);
	MUST(p);
	memcpy(p, data, len);
	n = ec_frame_end(&b);
	now += 100000;
	MUST(ec_sim_frame(sim, 0, f, n, now) >= 0);
	MUST(!ec_frame_iter_init(&it, f, n) && ec_frame_iter_next(&it, &d) == 1);
	memcpy(data, d.data, len);
	return ec_dgram_wkc(&d);
}

static void put(u16 ado, u16 value)
{
	u8 v[2];

	put_unaligned_le16(value, v);
	MUST(access(EC_CMD_FPWR, STATION, ado, v, 2) == 1);
}

static void sm(u16 ado, u16 start, u8 control)
{
	u8 v[8] = { 0, 0, SIZE, 0, control, 0, 1, 0 };

	put_unaligned_le16(start, v);
	MUST(access(EC_CMD_FPWR, STATION, ado, v, 8) == 1);
}

static void tear_down(void)
{
	fuzz_release(sim);
}

static void set_up(void)
{
	static const char text[] =
		"segment response=10us transition=10us\n"
		"slave d drive mbox=128 foe=16 foe_busy=1 foe_page=1ms soe=2 voe=7\n";
	u8 v[2] = { STATION & 0xff, STATION >> 8 };

	sim = fuzz_describe(text, sizeof(text) - 1, NULL, -1);
	MUST(sim);
	app = ec_sim_find(sim, "d");
	MUST(access(EC_CMD_APWR, 0, EC_REG_STATION, v, 2) == 1);
	sm(EC_REG_SM(0), AT, 0x26);
	sm(EC_REG_SM(1), AT + SIZE, 0x22);
	put(EC_REG_AL_CONTROL, EC_AL_PREOP);
	ec_sim_advance(sim, now += 1000000);
	MUST(app->state == EC_AL_PREOP);
	atexit(tear_down);
}

/* A reply that no fault concerns is one the master can read. */
static void reply(const u8 *p, bool right)
{
	struct ec_rbuf r = ec_rbuf(p, SIZE);
	struct ec_mbox_hdr h;

	if (!right)
		return;
	MUST(!ec_mbox_hdr_decode(&r, &h));
	MUST(h.counter >= 1 && h.counter <= 7 && h.len);
}

static void message(const uint8_t *data, size_t len, u8 type, bool right)
{
	u8 buf[SIZE];
	int i;

	/* the device has no EoE, its server works all the same */
	if ((type & 0x0f) == EC_MBOX_EOE)
		MUST(ec_app_eoe(app, data, len, buf, sizeof(buf)) <= (int)sizeof(buf));
	memset(buf, 0, sizeof(buf));
	put_unaligned_le16((u16)len, buf);
	buf[5] = type;
	memcpy(buf + EC_MBOX_HDR, data, min(len, sizeof(buf) - EC_MBOX_HDR));
	access(EC_CMD_FPWR, STATION, AT, buf, SIZE);
	for (i = 0; i < 3; i++)
		if (access(EC_CMD_FPRD, STATION, AT + SIZE, buf, SIZE))
			reply(buf, right);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_sim_fault f = { .type = EC_SIM_FAULT_MAILBOX };
	u8 sink[SIZE] = { 0 };
	int i, left = 16;

	if (!sim)
		set_up();
	if (!len)
		return 0;
	/* as after power-on, but for the dictionary */
	for (i = 0; i < 4 && access(EC_CMD_FPRD, STATION, AT + SIZE, sink, SIZE); i++)
		;
	ec_app_mbox_reset(app);
	ec_app_soe_reset(app);
	app->foe.valid = false;
	f.at_ns = now;
	f.arg = data[0] % EC_SIM_MAILBOX_FAULTS;
	f.arg2 = 1000000;
	MUST(!ec_sim_add_fault(sim, &f));
	ec_sim_advance(sim, ++now);
	data++;
	len--;
	while (len > 2 && left--) {
		size_t n = min((size_t)data[0], len - 2);

		message(data + 2, n, data[1], f.arg == EC_SIM_MAILBOX_GOOD);
		MUST(app->mbox.out_len <= app->mbox.cap && app->foe.at <= app->foe.cap);
		data += 2 + n;
		len -= 2 + n;
	}
	return 0;
}
