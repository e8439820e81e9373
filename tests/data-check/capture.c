// SPDX-License-Identifier: GPL-2.0-only
/*
 * Captures of real buses. Every EtherCAT frame is decoded and built again byte
 * by byte. Mailbox requests of the foreign master are compared with what our
 * exchanges would have sent; the answers of the slaves are fed to them.
 */
#include "check.h"
#include "../../devices/sim/esc_page.h"
#include "../../devices/sim/mbox_encode.h"
#include "../../devices/sim/sdo_server.h"
#include "../../devices/sim/sdoinfo_server.h"
#include "../../master/wire/frame.h"
#include "../../master/wire/regs.h"
#include "../../master/wire/sdo.h"

static int faults;
static const char *file;
static unsigned long packet, frames, dgrams, requests, answers, emergencies, loose, pages;

static void fault(const char *what)
{
	printf("%s: packet %lu: %s\n", file, packet, what);
	faults++;
}

/* What one slave has been asked last. */
static struct talk {
	enum { NOTHING, UPLOAD, DOWNLOAD, INFO } kind;
	u16 station;
	struct ec_sdo up;
	struct ec_sdo down;
	struct ec_sdoinfo info;
	u8 buf[65536];
} talks[4];

static struct talk *talk_with(u16 station)
{
	size_t i;

	for (i = 0; i < ARRAY_SIZE(talks); i++) {
		if (!talks[i].station)
			talks[i].station = station;
		if (talks[i].station == station)
			return &talks[i];
	}
	return NULL;
}

static void same(const u8 *ours, int n, const u8 *theirs, size_t len)
{
	if (n != (int)len || memcmp(ours, theirs, len))
		fault("we would have sent another request");
	requests++;
}

static void info_request(struct talk *t, const u8 *p, size_t len)
{
	struct ec_sdoinfo_req req;
	u8 tx[16];

	if (ec_sdoinfo_req_decode(p, len, &req)) {
		fault("SDO information request not understood");
		return;
	}
	t->kind = INFO;
	ec_sdoinfo_init(&t->info, req.opcode, req.index, req.sub, t->buf, sizeof(t->buf));
	t->info.info = req.info;
	same(tx, ec_sdoinfo_tx(&t->info, tx, sizeof(tx)), p, len);
}

static void sdo_request(struct talk *t, const u8 *p, size_t len)
{
	static u8 tx[1500];
	struct ec_rbuf r = ec_rbuf(p, len);
	u8 cmd, sub;
	u16 index;
	size_t size;

	ec_rbuf_le16(&r);
	cmd = ec_rbuf_u8(&r);
	index = ec_rbuf_le16(&r);
	sub = ec_rbuf_u8(&r);
	switch (cmd >> 5) {
	case 2:
		t->kind = UPLOAD;
		ec_sdo_upload_init(&t->up, index, sub, cmd & 0x10, t->buf, sizeof(t->buf));
		same(tx, ec_sdo_tx(&t->up, tx, sizeof(tx)), p, len);
		break;
	case 3:
		if (t->kind == UPLOAD)
			same(tx, ec_sdo_tx(&t->up, tx, sizeof(tx)), p, len);
		break;
	case 1:
		t->kind = DOWNLOAD;
		size = cmd & 2 ? 4u - (cmd >> 2 & 3) : ec_rbuf_le32(&r);
		if (r.bad || size > ec_rbuf_left(&r)) {
			t->kind = NOTHING;	/* segmented: not in these captures */
			break;
		}
		memcpy(t->buf, r.p, size);
		ec_sdo_download_init(&t->down, index, sub, cmd & 0x10, t->buf, size, len);
		/* others may use the normal form where we use the short one */
		size = (size_t)ec_sdo_tx(&t->down, tx, sizeof(tx));
		if (cmd & 2 || t->down.size > 4 || t->down.complete)
			same(tx, (int)size, p, len);
		else
			requests++;
		break;
	}
}

static void answer(struct talk *t, const u8 *p, size_t len)
{
	int ret = EC_STALE;

	if (t->kind == UPLOAD)
		ret = ec_sdo_rx(&t->up, p, len);
	else if (t->kind == DOWNLOAD)
		ret = ec_sdo_rx(&t->down, p, len);
	else if (t->kind == INFO)
		ret = ec_sdoinfo_rx(&t->info, p, len);

	if (ret == EC_STALE && t->kind != NOTHING)
		fault("answer taken for a stale one");
	if (ret < 0 && ret != -EIO)
		fault("answer refused");
	if (ret == -EIO && !ec_coe_abort_text(t->kind == UPLOAD ? t->up.abort :
			t->kind == DOWNLOAD ? t->down.abort : t->info.abort))
		fault("abort code without a text");
	if (ret == 0 && t->kind == INFO) {
		struct ec_od_object o;
		struct ec_od_entry e;

		if (t->info.opcode == EC_SDOINFO_OBJECT_REQ &&
		    (ec_od_object_decode(t->buf, t->info.size, &o) || o.index != t->info.index))
			fault("object description not understood");
		if (t->info.opcode == EC_SDOINFO_ENTRY_REQ &&
		    (ec_od_entry_decode(t->buf, t->info.size, &e) || e.index != t->info.index))
			fault("entry description not understood");
	}
	if (ret != EC_MORE && ret != EC_WAIT)
		t->kind = NOTHING;
	answers++;
}

/* Requests are taken on their way out, answers when they are back. */
static void mailbox(const struct ec_dgram *d)
{
	bool write = d->cmd == EC_CMD_FPWR;
	struct ec_rbuf r = ec_rbuf(d->data, d->len);
	struct ec_mbox_hdr h;
	struct ec_coe_hdr c;
	struct ec_coe_emergency e;
	struct talk *t;
	u8 hdr[EC_MBOX_HDR];
	struct ec_wbuf w = ec_wbuf(hdr, sizeof(hdr));
	const u8 *p;

	if ((!write && d->cmd != EC_CMD_FPRD) || d->ado < 0x1000 || d->len < 16 ||
	    ec_dgram_wkc(d) != (write ? 0 : 1))
		return;
	if (ec_mbox_hdr_decode(&r, &h) || h.type != EC_MBOX_COE || h.len < EC_COE_HDR)
		return;
	ec_mbox_hdr_encode(&w, &h);
	if (memcmp(hdr, d->data, sizeof(hdr)))
		fault("mailbox header is not the same after decoding and encoding");

	t = talk_with(d->adp);
	p = r.p;
	ec_coe_hdr_decode(&r, &c);
	if (!t)
		return;
	if (c.service == EC_COE_EMERGENCY) {
		if (ec_coe_emergency_decode(p, h.len, &e))
			fault("emergency not understood");
		emergencies++;
	} else if (write && c.service == EC_COE_SDO_INFO) {
		info_request(t, p, h.len);
	} else if (write && c.service == EC_COE_SDO_REQ) {
		sdo_request(t, p, h.len);
	} else if (!write) {
		answer(t, p, h.len);
	}
}

/* FMMU and SyncManager pages as other masters write them */
static void config_pages(const struct ec_dgram *d)
{
	u8 page[EC_FMMU_PAGE];
	struct ec_fmmu f;
	struct ec_sm sm;
	u16 i;

	if ((d->cmd != EC_CMD_FPWR && d->cmd != EC_CMD_APWR) || ec_dgram_wkc(d))
		return;
	if (d->ado >= EC_REG_FMMU(0) && d->ado < EC_REG_FMMU(EC_MAX_FMMU))
		for (i = 0; i + EC_FMMU_PAGE <= d->len; i += EC_FMMU_PAGE) {
			ec_fmmu_decode(&f, d->data + i);
			ec_fmmu_encode(&f, page);
			if (memcmp(page, d->data + i, EC_FMMU_PAGE))
				fault("FMMU is not the same after decoding and encoding");
			pages++;
		}
	if (d->ado >= EC_REG_SM(0) && d->ado < EC_REG_SM(EC_MAX_SM))
		for (i = 0; i + EC_SM_PAGE <= d->len; i += EC_SM_PAGE) {
			ec_sm_decode(&sm, d->data + i);
			ec_sm_encode(&sm, page);
			if (memcmp(page, d->data + i, EC_SM_PAGE))
				fault("SyncManager is not the same after decoding and encoding");
			pages++;
		}
}

static void frame(u8 *p, size_t len)
{
	static u8 out[EC_FRAME_HDR + EC_FRAME_BODY_MAX];
	struct ec_frame_iter it;
	struct ec_frame_buf f;
	struct ec_dgram d;
	size_t n;
	int ret;

	frames++;
	if (ec_frame_iter_init(&it, p, len)) {
		fault("frame refused");
		return;
	}
	ec_frame_begin(&f, out, sizeof(out));
	while ((ret = ec_frame_iter_next(&it, &d)) == 1) {
		u8 *data = ec_frame_add(&f, d.cmd, d.idx, d.adp, d.ado, d.len);

		dgrams++;
		if (!data) {
			fault("no room to build the frame again");
			return;
		}
		memcpy(data, d.data, (size_t)d.len + EC_DGRAM_WKC);
		put_unaligned_le16(d.irq, data - 2);
		if (d.circulating)
			data[-3] |= 0x40;
		mailbox(&d);
		config_pages(&d);
	}
	n = ec_frame_end(&f);
	/* Some masters write a length that is too large; slaves never look at it. */
	if ((get_unaligned_le16(p) & 0x7FF) > n - EC_FRAME_HDR && !it.more) {
		loose++;
		ret = 0;
		memcpy(out, p, EC_FRAME_HDR);
	}
	if (ret)
		fault("datagram refused");
	else if (memcmp(out, p, n))
		fault("frame is not the same after decoding and encoding");
}

static void ethernet(u8 *p, size_t len)
{
	size_t at = 12;

	if (len >= 18 && p[12] == 0x81 && p[13] == 0x00)
		at = 16;
	if (len >= at + 2 && p[at] == 0x88 && p[at + 1] == 0xA4)
		frame(p + at + 2, len - at - 2);
}

int check_capture(const char *path, const u8 *data, size_t len, char *note, size_t cap)
{
	size_t at = 0;

	file = path;
	faults = 0;
	packet = frames = dgrams = requests = answers = emergencies = loose = pages = 0;
	memset(talks, 0, sizeof(talks));

	while (len - at >= 12) {
		const u8 *b = data + at;
		u32 type = get_unaligned_le32(b), size = get_unaligned_le32(b + 4), n;

		if (!at && (type != 0x0A0D0D0A || get_unaligned_le32(b + 8) != 0x1A2B3C4D)) {
			fault("no little-endian pcapng file");
			return faults;
		}
		if (size < 12 || size & 3 || size > len - at) {
			fault("block is cut off");
			return faults;
		}
		if (type == 1 && get_unaligned_le16(b + 8) != 1) {
			fault("link type is not Ethernet");
			return faults;
		}
		if (type == 6 && size >= 32) {	/* enhanced packet block */
			packet++;
			n = get_unaligned_le32(b + 20);
			if (n > size - 32)
				fault("packet is cut off");
			else
				ethernet((u8 *)b + 28, n);
		}
		at += size;
	}
	if (!frames)
		fault("no EtherCAT frame");
	snprintf(note, cap,
		 "%lu frames, %lu datagrams, %lu FMMU and SM pages; CoE: %lu requests, %lu answers, %lu emergencies;"
		 " length too large in %lu frames",
		 frames, dgrams, pages, requests, answers, emergencies, loose);
	return faults;
}
