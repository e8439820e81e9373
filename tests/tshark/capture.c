// SPDX-License-Identifier: GPL-2.0-only
/*
 * Linked into the unit tests with --wrap=ec_sim_frame2: writes the frames they
 * exchange with the model to $CAPTURE.pcap, and what our decoders make of each
 * to $CAPTURE.txt, one line a frame:
 *
 *	cmd idx adp ado len irq wkc[; ...][ | mailbox]
 *
 * as tests/tshark/compare.py wants it. Without CAPTURE nothing is written.
 */
#include "../../devices/sim/sim.h"
#include "../../master/wire/coe.h"
#include "../../master/wire/mbox.h"
#include "../../master/wire/sdoinfo.h"
#include <stdio.h>
#include <stdlib.h>

static FILE *pcap, *text;

static void put32(u32 v)
{
	fwrite(&v, sizeof(v), 1, pcap);		/* the magic number tells the order */
}

static FILE *create(const char *name, const char *suffix)
{
	char path[4096];
	FILE *f;

	snprintf(path, sizeof(path), "%s%s", name, suffix);
	f = fopen(path, "w");
	if (!f) {
		perror(path);
		exit(2);
	}
	return f;
}

static __attribute__((constructor)) void open_files(void)
{
	const char *name = getenv("CAPTURE");

	if (!name)
		return;
	pcap = create(name, ".pcap");
	text = create(name, ".txt");
	put32(0xa1b23c4d);		/* times in ns */
	put32(2 | 4 << 16);
	put32(0);
	put32(0);
	put32(65535);
	put32(1);			/* Ethernet */
}

/* an ESC marks what it returns: bit 1 of the source address */
static void write_pcap(const u8 *frame, size_t len, u64 now, bool back)
{
	const u8 head[14] = { 0xff, 0xff, 0xff, 0xff, 0xff, 0xff,
			      back ? 0x12 : 0x10, 0, 0, 0, 0, 1, 0x88, 0xa4 };
	static const u8 zero[60];
	size_t pad = len < 46 ? 46 - len : 0;

	put32((u32)(now / 1000000000));
	put32((u32)(now % 1000000000));
	put32((u32)(sizeof(head) + len + pad));
	put32((u32)(sizeof(head) + len + pad));
	fwrite(head, sizeof(head), 1, pcap);
	fwrite(frame, len, 1, pcap);
	fwrite(zero, pad, 1, pcap);
}

/* what the SDO commands have in common; segments have no index */
static void write_sdo(const struct ec_coe_hdr *h, struct ec_rbuf r)
{
	u8 cmd = ec_rbuf_u8(&r), cs = cmd >> 5;
	bool segment = h->service == EC_COE_SDO_REQ ? cs == 0 || cs == 3 : cs < 2;
	u16 index = ec_rbuf_le16(&r);
	u8 sub = ec_rbuf_u8(&r);

	if (r.bad)
		fprintf(text, " short");
	else if (segment)
		fprintf(text, " segment=%u toggle=%u", cs, cmd >> 4 & 1);
	else if (cmd == 0x80)		/* tshark does not tell the index of these */
		fprintf(text, " cs=%u abort=%08x", cs, ec_rbuf_le32(&r));
	else
		fprintf(text, " cs=%u index=%04x sub=%02x", cs, index, sub);
}

static void write_info(struct ec_rbuf r)
{
	u8 opcode = ec_rbuf_u8(&r);	/* with "incomplete" */

	ec_rbuf_u8(&r);
	fprintf(text, " opcode=%u left=%u", opcode, ec_rbuf_le16(&r));
}

static void write_mailbox(const struct ec_dgram *d)
{
	struct ec_rbuf r = ec_rbuf(d->data, d->len);
	struct ec_mbox_hdr h;
	struct ec_coe_hdr c;

	if (ec_mbox_hdr_decode(&r, &h)) {
		fprintf(text, " | refused");
		return;
	}
	/* what tshark calls priority are bits of the channel */
	fprintf(text, " | type=%u len=%u address=%04x counter=%u",
		h.type, h.len, h.address, h.counter);
	r = ec_rbuf(r.p, h.len);
	if (h.type != EC_MBOX_COE)
		return;
	if (ec_coe_hdr_decode(&r, &c)) {
		fprintf(text, " refused");
		return;
	}
	fprintf(text, " service=%u number=%u", c.service, c.number);
	if (c.service == EC_COE_SDO_REQ || c.service == EC_COE_SDO_RESP)
		write_sdo(&c, r);
	else if (c.service == EC_COE_SDO_INFO)
		write_info(r);
}

/* a whole mailbox: in the tests they begin at 0x1000, 64 to 512 bytes each */
static bool is_mailbox(const struct ec_dgram *d)
{
	bool cmd = d->cmd == EC_CMD_FPWR || d->cmd == EC_CMD_FPRD;

	return cmd && d->len >= 64 && (d->ado == 0x1000 || d->ado == 0x1000 + d->len) &&
	       (d->cmd == EC_CMD_FPWR || ec_dgram_wkc(d)) && d->len <= 512;
}

static void write_text(u8 *frame, size_t len)
{
	struct ec_frame_iter it;
	struct ec_dgram d, mbox = { 0 };
	bool first = true;
	int ret;

	if (ec_frame_iter_init(&it, frame, len)) {
		fprintf(text, "refused\n");
		return;
	}
	while ((ret = ec_frame_iter_next(&it, &d)) == 1) {
		fprintf(text, "%s%u %u %04x %04x %u %04x %u", first ? "" : "; ", d.cmd,
			d.idx, d.adp, d.ado, d.len, d.irq, ec_dgram_wkc(&d));
		if (is_mailbox(&d))
			mbox = d;
		first = false;
	}
	if (ret < 0)
		fprintf(text, "; refused");
	if (mbox.data)
		write_mailbox(&mbox);
	fprintf(text, "\n");
}

s64 __real_ec_sim_frame2(struct ec_sim *sim, int port, u8 *frame, size_t len,
			 u64 now_ns, int *out_port);
s64 __wrap_ec_sim_frame2(struct ec_sim *sim, int port, u8 *frame, size_t len,
			 u64 now_ns, int *out_port);

s64 __wrap_ec_sim_frame2(struct ec_sim *sim, int port, u8 *frame, size_t len,
			 u64 now_ns, int *out_port)
{
	s64 delay;

	if (pcap) {
		write_pcap(frame, len, now_ns, false);
		write_text(frame, len);
	}
	delay = __real_ec_sim_frame2(sim, port, frame, len, now_ns, out_port);
	if (pcap && delay >= 0) {
		write_pcap(frame, len, now_ns + (u64)delay, true);
		write_text(frame, len);
	}
	return delay;
}
