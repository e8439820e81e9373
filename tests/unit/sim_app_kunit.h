/* SPDX-License-Identifier: GPL-2.0-only */
/* Segments from text, and a small master to talk to their slaves with. */
#ifndef SIM_APP_KUNIT_H
#define SIM_APP_KUNIT_H

#include "sim_esc_kunit.h"
#include "../../devices/sim/describe.h"
#include "../../master/wire/sdo.h"

#define STATION(i)	((u16)(1001 + (i)))

/* builds @text and addresses its first @n slaves: 1001, 1002... */
static inline struct bed *app_bed_part(struct kunit *test, const char *text, u32 n)
{
	struct bed *b = kunit_kzalloc(test, sizeof(*b), GFP_KERNEL);
	struct ec_sim_error err;
	int ret;

	KUNIT_ASSERT_NOT_NULL(test, b);
	test->priv = b;
	b->now = 1000000;
	b->gap = 20000;
	ret = ec_sim_describe(&b->sim, &bed_ops, text, strlen(text), NULL, &err);
	KUNIT_ASSERT_EQ_MSG(test, ret, 0, "line %u: %s", err.line, err.text);
	for (u32 i = 0; i < min(n, ec_sim_count(b->sim)); i++)
		KUNIT_ASSERT_EQ(test, bed_station(b, (u16)-i, STATION(i)), 1);
	return b;
}

/* all of them */
static inline struct bed *app_bed(struct kunit *test, const char *text)
{
	return app_bed_part(test, text, ~0u);
}

/* AL status in bits 0-15, code in bits 16-31 */
static inline u32 app_al_status(struct bed *b, u16 station)
{
	u8 v[6];

	if (bed_rd(b, station, EC_REG_AL_STATUS, v, 6) != 1)
		return ~0u;
	return get_unaligned_le16(v) | (u32)get_unaligned_le16(v + 4) << 16;
}

/* requests a state and waits up to @ms */
static inline u32 app_al(struct bed *b, u16 station, u16 control, u32 ms)
{
	u64 end = b->now + ms * 1000000ull;
	u32 st = ~0u;

	if (bed_put(b, station, EC_REG_AL_CONTROL, control, 2) != 1)
		return ~0u;
	while (b->now < end) {
		st = app_al_status(b, station);
		if ((st & 0x0F) == (control & 0x0F) || st & EC_AL_ERROR)
			break;
		b->now += 100000;
	}
	return st;
}

/* SyncManagers of a mailbox at 0x1000, @size each */
static inline void app_mbox_sms(struct bed *b, u16 station, u16 size)
{
	bed_sm(b, station, 0, 0x1000, size, 0x26);
	bed_sm(b, station, 1, (u16)(0x1000 + size), size, 0x22);
}

/**
 * struct app_mbox - mailbox of a slave, the master's side
 * @station: address
 * @size: bytes of each mailbox
 * @counter: of the last message sent
 * @tx: message, header included
 * @rx: answer
 */
struct app_mbox {
	u16 station;
	u16 size;
	u8 counter;
	u8 tx[1486];
	u8 rx[1486];
};

/* sends @len bytes that stand behind the header in @tx; returns the WKC */
static inline int app_send(struct bed *b, struct app_mbox *m, u8 type,
			   size_t len)
{
	struct ec_wbuf w = ec_wbuf(m->tx, sizeof(m->tx));
	struct ec_mbox_hdr h = { .len = (u16)len, .type = type };

	m->counter = ec_mbox_next_counter(m->counter);
	h.counter = m->counter;
	ec_mbox_hdr_encode(&w, &h);
	memset(m->tx + EC_MBOX_HDR + len, 0, m->size - EC_MBOX_HDR - len);
	return bed_tx(b, EC_CMD_FPWR, m->station, 0x1000, m->tx, m->size);
}

/* polls up to @ms; returns bytes behind the header, or -1 */
static inline int app_recv(struct bed *b, struct app_mbox *m,
			   struct ec_mbox_hdr *h, u32 ms)
{
	u64 end = b->now + ms * 1000000ull;

	while (b->now < end) {
		struct ec_rbuf r;

		if (bed_rd(b, m->station, (u16)(0x1000 + m->size), m->rx,
			   m->size) != 1) {
			b->now += 100000;
			continue;
		}
		r = ec_rbuf(m->rx, m->size);
		if (ec_mbox_hdr_decode(&r, h))
			return -1;
		return h->len;
	}
	return -1;
}

/* returns bytes read, or -1 with the abort code in @abort */
static inline int app_upload(struct bed *b, struct app_mbox *m, u16 index,
			     u8 sub, bool ca, u8 *buf, size_t cap, u32 *abort)
{
	struct ec_mbox_hdr h;
	struct ec_sdo u;
	int len, ret;

	ec_sdo_upload_init(&u, index, sub, ca, buf, cap);
	do {
		len = ec_sdo_tx(&u, m->tx + EC_MBOX_HDR,
				   m->size - EC_MBOX_HDR);
		if (len < 0 || app_send(b, m, EC_MBOX_COE, (size_t)len) != 1)
			return -2;
		do {
			len = app_recv(b, m, &h, 100);
			if (len < 0)
				return -3;
			ret = ec_sdo_rx(&u, m->rx + EC_MBOX_HDR, (size_t)len);
		} while (ret == EC_STALE);
	} while (ret == EC_MORE);
	*abort = u.abort;
	return ret ? -1 : (int)u.size;
}

/* returns 0, the abort code, or ~0 */
static inline u32 app_download(struct bed *b, struct app_mbox *m, u16 index,
			       u8 sub, bool ca, const void *data, size_t size)
{
	struct ec_mbox_hdr h;
	struct ec_sdo d;
	int len, ret;

	ec_sdo_download_init(&d, index, sub, ca, data, size,
			 m->size - EC_MBOX_HDR);
	do {
		len = ec_sdo_tx(&d, m->tx + EC_MBOX_HDR,
				     m->size - EC_MBOX_HDR);
		if (len < 0 || app_send(b, m, EC_MBOX_COE, (size_t)len) != 1)
			return ~0u;
		do {
			len = app_recv(b, m, &h, 100);
			if (len < 0)
				return ~0u;
			ret = ec_sdo_rx(&d, m->rx + EC_MBOX_HDR,
					     (size_t)len);
		} while (ret == EC_STALE);
	} while (ret == EC_MORE);
	return ret ? d.abort ? d.abort : ~0u : 0;
}

static inline u64 app_get(struct bed *b, struct app_mbox *m, u16 index, u8 sub)
{
	u8 v[8] = { 0 };
	u32 abort;

	return app_upload(b, m, index, sub, false, v, sizeof(v), &abort) < 0 ?
		~0ull : get_unaligned_le64(v);
}

static inline u32 app_put(struct bed *b, struct app_mbox *m, u16 index, u8 sub,
			  u64 val, size_t size)
{
	u8 v[8];

	put_unaligned_le64(val, v);
	return app_download(b, m, index, sub, false, v, size);
}

#endif
