// SPDX-License-Identifier: GPL-2.0-only
/*
 * The IP host of a simulated slave, behind EoE. Input: a byte with the scripted fault, then frames,
 * each a length byte, a byte with the wait before it, and its content behind the addresses.
 * Checksums are put right, so that what they protect is reached.
 */
#include "fuzz_sim.h"
#include "../../devices/sim/eoe.h"

#define SIZE	128	/* of a mailbox */

/* IPv4 header, 192.168.0.1 to .2; TCP header behind it */
#define IP(len, proto)	"\x8\0\x45\0\0" len "\0\1\0\0\x40" proto "\0\0\xc0\xa8\0\1\xc0\xa8\0\2"
#define TCP(port, seq, ack, flags) "\x10\0\0" port "\0\0\0" seq ack "\x50" flags "\x10\0\0\0\0\0"

const struct fuzz_seed fuzz_seeds[] = {
	/* ARP; echo request */
	SEED("\0" "\x1e\0" "\x8\6\0\1\x8\0\6\4\0\1\2\0\0\0\0\1\xc0\xa8\0\1\0\0\0\0\0\0\xc0\xa8\0\2"
	     "\x20\0" IP("\x1e", "\1") "\x8\0\0\0\0\1\0\1" "ab"),
	/* echo: SYN, data, FIN; the slave's numbers begin with 64001 */
	SEED("\0" "\x2a\0" IP("\x28", "\6") TCP("\7", "\1", "\0\0\0\0", "\2")
	     "\x2e\1" IP("\x2c", "\6") TCP("\7", "\2", "\0\0\xfa\1", "\x10") "data"
	     "\x2a\1" IP("\x28", "\6") TCP("\7", "\6", "\0\0\xfa\5", "\x11")
	     "\x2a\1" IP("\x28", "\6") TCP("\7", "\7", "\0\0\xfa\6", "\x10")),
	/* SYN with options: nothing, segment size, scale */
	SEED("\0" "\x32\0" IP("\x30", "\6") "\x10\0\0\7\0\0\0\1\0\0\0\0\x70\2\x10\0\0\0\0\0"
	     "\1\2\4\5\xb4\3\3\7"),
	/* HTTP */
	SEED("\0" "\x2a\0" IP("\x28", "\6") TCP("\x50", "\1", "\0\0\0\0", "\2")
	     "\x33\1" IP("\x31", "\6") TCP("\x50", "\2", "\0\0\xfa\1", "\x10") "GET / \n\r\n"
	     "\x2a\xff" IP("\x28", "\6") TCP("\x50", "\xb", "\0\0\xfa\x20", "\x11")),
	/* with a fault */
	SEED("\1" "\x20\0" IP("\x1e", "\1") "\x8\0\0\0\0\1\0\1" "ab"),
	SEED("\7" "\x20\0" IP("\x1e", "\1") "\x8\0\0\0\0\1\0\1" "ab"),
	SEED("\x9" "\x20\0" IP("\x1e", "\1") "\x8\0\0\0\0\1\0\1" "ab"),
	{ NULL, 0 }
};

static struct ec_sim *sim;
static struct ec_app *app;
static struct ec_eoe_part part;	/* of a frame of the slave */

static void tear_down(void)
{
	fuzz_release(sim);
}

static void set_up(void)
{
	static const char text[] = "segment response=10us\nslave d drive mbox=128 eoe=host\n";

	sim = fuzz_describe(text, sizeof(text) - 1, NULL, -1);
	MUST(sim);
	app = ec_sim_find(sim, "d");
	app->state = EC_AL_PREOP;
	app->ip.now.which = EC_EOE_IP | EC_EOE_MAC;
	memcpy(app->ip.now.ip, "\xc0\xa8\0\2", 4);
	memcpy(app->ip.now.mac, "\2\0\0\0\0\2", 6);
	atexit(tear_down);
}

static void put_right(u8 *f, u16 len)
{
	u16 hdr = (u16)((f[14] & 0x0f) * 4), total;
	u8 *ip = f + 14, *p = ip + hdr, pseudo[12] = { 0 };

	if (len < 34 || hdr < 20 || 14 + hdr > len || ec_app_get_be16(f + 12) != EC_APP_ETH_IP)
		return;
	ec_app_put_be16(ip + 10, 0);
	ec_app_put_be16(ip + 10, ec_app_ip_sum(ip, hdr, 0));
	total = ec_app_get_be16(ip + 2);
	if (total > len - 14 || total < hdr + 20)
		return;
	total = (u16)(total - hdr);
	memcpy(pseudo, ip + 12, 8);
	pseudo[9] = ip[9];
	ec_app_put_be16(pseudo + 10, total);
	p += ip[9] == 1 ? 2 : 16;
	ec_app_put_be16(p, 0);
	ec_app_put_be16(p, ec_app_ip_sum(ip + hdr, total, ip[9] == 1 ? 0 :
					 (u16)~ec_app_ip_sum(pseudo, sizeof(pseudo), 0)));
}

static void send(const u8 *frame, u16 len)
{
	struct ec_eoe_fragment f = { .frame = 1 };
	u8 msg[SIZE], number = 0;
	u16 at = 0;

	while (at < len) {
		int n, ret;

		at = (u16)(at + ec_eoe_fragment_cut(&f, frame, len, at, number++, SIZE));
		n = ec_eoe_fragment_encode(msg, SIZE - EC_MBOX_HDR, &f);
		MUST(n > 0);
		ret = ec_app_eoe(app, msg, (size_t)n, NULL, 0);
		MUST(!ret || (ret == -EINVAL && app->esc->fault.eoe == EC_SIM_EOE_REFUSE));
	}
}

static void check(void)
{
	const struct ec_app_eoe *e = app->eoe;

	MUST(e->n <= EC_APP_EOE_QUEUE && e->n == (u32)__builtin_popcount(e->used));
	for (u32 i = 0; i < EC_APP_EOE_CONNS; i++) {
		const struct ec_app_tcp *c = &e->conns[i];

		MUST(c->state == EC_APP_TCP_FREE ||
		     (c->sent <= c->len && c->len <= EC_APP_EOE_BUF));
	}
}

/* what the slave sends: without a fault each fragment keeps the rules */
static void drain(u32 limit, bool right)
{
	static u8 data[EC_EOE_FRAME_MAX];
	u8 msg[SIZE];

	while (limit--) {
		int n = ec_app_eoe_next(app, msg, SIZE - EC_MBOX_HDR, app->mbox.now);
		struct ec_eoe_fragment f;

		MUST(n >= 0 && n <= SIZE - EC_MBOX_HDR);
		check();
		if (!n)
			return;
		MUST(!ec_eoe_fragment_decode(msg, (size_t)n, &f));
		n = ec_eoe_part_add(&part, data, sizeof(data), &f);
		MUST(!right || n >= 0);
		MUST(!right || n < 1 || n >= EC_EOE_FRAME_MIN);
		MUST(!right || n < 1 || !memcmp(data + 6, "\2\0\0\0\0\2", 6));
	}
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_rbuf r = ec_rbuf(data, len);
	u8 fault;

	if (!sim)
		set_up();
	fault = ec_rbuf_u8(&r) % EC_SIM_EOE_FAULTS;
	ec_app_eoe_reset(app);
	memset(&part, 0, sizeof(part));
	app->eoe->isn = 0;
	app->esc->fault.eoe = fault;
	app->esc->fault.eoe_every = 2;
	app->mbox.now = 1000000;
	ec_app_eoe_fault(app, app->mbox.now);
	drain(100, !fault);
	while (ec_rbuf_left(&r) > 2) {
		size_t n = ec_rbuf_u8(&r);
		u8 wait = ec_rbuf_u8(&r), f[12 + 255] = { 2, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 1 };

		n = min(n, ec_rbuf_left(&r));
		if (n < 2)
			continue;
		memcpy(f + 12, ec_rbuf_take(&r, n), n);
		put_right(f, (u16)(n + 12));
		app->mbox.now += wait * 10000000ull + 20000;
		ec_app_eoe_poll(app, app->mbox.now);
		check();
		send(f, (u16)(n + 12));
		check();
		drain(wait & 1 ? 100 : 3, !fault);
	}
	return 0;
}
