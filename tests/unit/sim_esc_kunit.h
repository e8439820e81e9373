/* SPDX-License-Identifier: GPL-2.0-only */
/* A segment to test with, and one-datagram frames. */
#ifndef SIM_ESC_KUNIT_H
#define SIM_ESC_KUNIT_H

#include "wire_kunit.h"
#include "../../devices/sim/sim.h"

#ifdef __KERNEL__
#include <linux/mm.h>
static void *bed_alloc(size_t bytes)
{
	return kvzalloc(bytes, GFP_KERNEL);
}

static void bed_free(void *p)
{
	kvfree(p);
}
#else
static void *bed_alloc(size_t bytes)
{
	return calloc(1, bytes);
}

static void bed_free(void *p)
{
	free(p);
}
#endif

static const struct ec_sim_ops bed_ops = { bed_alloc, bed_free };

/**
 * struct bed - test bed
 * @sim: segment
 * @now: time of the next frame
 * @gap: time from frame to frame
 * @cfg: configuration of the next slave
 * @eeprom: its EEPROM content, 128 bytes with a good checksum
 * @irq: IRQ field of the last datagram
 * @adp: its address when it came back
 * @circ: its circulating bit
 * @delay: what ec_sim_frame() returned
 * @out: master port at which it came back
 * @frame: the last frame
 */
struct bed {
	struct ec_sim *sim;
	u64 now;
	u64 gap;
	struct ec_esc_config cfg;
	u8 eeprom[128];
	u16 irq;
	u16 adp;
	bool circ;
	s64 delay;
	int out;
	u8 frame[1600];
};

static inline void bed_checksum(struct bed *b)
{
	b->eeprom[14] = ec_esc_eeprom_crc(b->eeprom);
}

/* one datagram; returns the working counter, -1 when the frame is lost */
static inline int bed_tx_port(struct bed *b, int port, u8 cmd, u16 adp,
			      u16 ado, void *data, u16 len)
{
	struct ec_frame_buf f;
	struct ec_frame_iter it;
	struct ec_dgram d;
	u8 *p;
	size_t n;

	ec_frame_begin(&f, b->frame, sizeof(b->frame));
	p = ec_frame_add(&f, cmd, 1, adp, ado, len);
	memcpy(p, data, len);
	n = ec_frame_end(&f);
	b->delay = ec_sim_frame2(b->sim, port, b->frame, n, b->now, &b->out);
	b->now += b->gap;
	if (b->delay < 0)
		return -1;
	if (ec_frame_iter_init(&it, b->frame, n) ||
	    ec_frame_iter_next(&it, &d) != 1)
		return -2;
	b->irq = d.irq;
	b->adp = d.adp;
	b->circ = d.circulating;
	memcpy(data, d.data, len);
	return ec_dgram_wkc(&d);
}

static inline int bed_tx(struct bed *b, u8 cmd, u16 adp, u16 ado, void *data,
			 u16 len)
{
	return bed_tx_port(b, 0, cmd, adp, ado, data, len);
}

static inline int bed_rd(struct bed *b, u16 station, u16 ado, void *data,
			 u16 len)
{
	memset(data, 0, len);
	return bed_tx(b, EC_CMD_FPRD, station, ado, data, len);
}

/* a register of up to 8 bytes, ~0 when nobody answers */
static inline u64 bed_get(struct bed *b, u16 station, u16 ado, u16 len)
{
	u8 v[8] = {};

	return bed_rd(b, station, ado, v, len) == 1 ? get_unaligned_le64(v) :
						      ~0ull;
}

static inline int bed_put(struct bed *b, u16 station, u16 ado, u64 val, u16 len)
{
	u8 v[8];

	put_unaligned_le64(val, v);
	return bed_tx(b, EC_CMD_FPWR, station, ado, v, len);
}

static inline int bed_sm(struct bed *b, u16 station, int n, u16 start, u16 len,
			 u8 control)
{
	struct ec_sm sm = { .start = start, .len = len, .control = control,
			    .activate = 1 };
	u8 page[EC_SM_PAGE];

	bed_put(b, station, (u16)(EC_REG_SM(n) + EC_SM_OFS_ACTIVATE), 0, 1);
	ec_sm_encode(&sm, page);
	return bed_tx(b, EC_CMD_FPWR, station, (u16)EC_REG_SM(n), page, 8);
}

static inline int bed_fmmu(struct bed *b, u16 station, int n,
			   struct ec_fmmu f)
{
	u8 page[EC_FMMU_PAGE];

	ec_fmmu_encode(&f, page);
	return bed_tx(b, EC_CMD_FPWR, station, (u16)EC_REG_FMMU(n), page, 16);
}

static inline int bed_station(struct bed *b, u16 adp, u16 station)
{
	u8 v[2];

	put_unaligned_le16(station, v);
	return bed_tx(b, EC_CMD_APWR, adp, EC_REG_STATION, v, 2);
}

/* @n slaves in a line, 100 ns of cable between them, station 1001 + i */
static inline struct bed *bed_new(struct kunit *test, u32 max, u32 n)
{
	struct bed *b = kunit_kzalloc(test, sizeof(*b), GFP_KERNEL);
	struct ec_esc *esc;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, b);
	test->priv = b;
	b->now = 1000000;
	b->gap = 20000;
	for (i = 0; i < sizeof(b->eeprom); i++)
		b->eeprom[i] = (u8)i;
	memset(b->eeprom, 0, 14);
	b->eeprom[0] = 5;
	b->eeprom[4] = 10;		/* SYNC pulses of 100 ns */
	b->eeprom[8] = 0x34;
	b->eeprom[9] = 0x12;
	bed_checksum(b);
	ec_esc_config_init(&b->cfg);
	b->cfg.eeprom = b->eeprom;
	b->cfg.eeprom_len = sizeof(b->eeprom);
	b->cfg.dc_noise_ns = 0;
	b->sim = ec_sim_new(&bed_ops, max, 42);
	KUNIT_ASSERT_NOT_NULL(test, b->sim);
	for (i = 0; i < n; i++) {
		esc = ec_sim_add(b->sim, &b->cfg);
		KUNIT_ASSERT_NOT_NULL(test, esc);
		KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, (int)i - 1, 1, (int)i,
						  0, 100), 0);
	}
	for (i = 0; i < n; i++)
		bed_station(b, (u16)-i, (u16)(1001 + i));
	return b;
}

static inline void bed_exit(struct kunit *test)
{
	struct bed *b = test->priv;

	if (b)
		ec_sim_free(b->sim);
}

#endif
