// SPDX-License-Identifier: GPL-2.0-only
/*
 * Clocks in the cycle: the time to the reference clock, from there to all
 * slaves, and the differences that are left. They go in front of the process
 * data of the first frame, so that their distance to the send is always the
 * same. Nothing here allocates, prints or waits.
 */
#include "cycle.h"
#include "master.h"
#include "session.h"
#include "wire/regs.h"

#define SYNC_REF	EC_SEND_FLAG_SYNC_REF
#define SYNC_SLAVES	EC_SEND_FLAG_SYNC_SLAVES
#define MONITOR		EC_SEND_FLAG_MONITOR
#define REF_TIME	EC_SEND_FLAG_REF_TIME
#define SHIFT		16	/* above it: how many more SYNC_SLAVES */
#define BOOST		11	/* of them in a send: one frame takes 15 datagrams */

static unsigned int syncs(u32 dc)
{
	return dc & SYNC_SLAVES ? (dc >> SHIFT) + 1 : 0;
}

static u16 time_bytes(const struct ec_master *m)
{
	return m->dc.ref_wide ? 8 : 4;
}

/* Comparisons of this send beyond one. */
static u32 boost(struct ec_master *m)
{
	u32 left = READ_ONCE(m->dc.boost), n = min_t(u32, left, BOOST);

	if (n)
		WRITE_ONCE(m->dc.boost, left - n);
	return n;
}

/**
 * ec_dc_wanted() - clock datagrams of this send
 * @m: master
 * @flags: EC_SEND_FLAG_*
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: those of @flags that make datagrams, and in the upper half how many
 * more times the time goes to the slaves; 0 without reference clock.
 */
u32 ec_dc_wanted(struct ec_master *m, u32 flags)
{
	flags &= SYNC_REF | SYNC_SLAVES | MONITOR | REF_TIME;
	if (!flags)
		return 0;
	if (!READ_ONCE(m->dc.wanted))
		WRITE_ONCE(m->dc.wanted, true);
	if (!READ_ONCE(m->dc.running))
		return 0;
	if (flags & SYNC_SLAVES)
		flags |= boost(m) << SHIFT;
	return flags;
}

/*
 * Slaves in front of the reference see what was sent: the time it will have,
 * as far as the last answer tells.
 */
static u64 predicted(const struct ec_cycle *c, u64 now)
{
	return c->dc_time ? c->dc_time + (now - c->dc_time_ns) : 0;
}

/**
 * ec_dc_fill() - add the clock datagrams to an empty frame
 * @s: active session
 * @fb: frame
 * @index: of its slot
 * @dc: as from ec_dc_wanted()
 * @sync_time: for the reference clock, ns
 * @now: time of the send (ktime)
 *
 * Registers 0x0910, 0x092C.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_dc_fill(struct ec_session *s, struct ec_frame_buf *fb, u8 index, u32 dc, u64 sync_time,
		u64 now)
{
	const struct ec_master *m = s->master;
	u16 ref = READ_ONCE(m->dc.ref_station);
	unsigned int i;
	u8 t[8], *p;

	if (dc & SYNC_REF) {
		p = ec_frame_add(fb, EC_CMD_FPWR, index, ref, EC_REG_DC_SYSTIME, 4);
		put_unaligned_le32((u32)sync_time, p);
	}
	put_unaligned_le64(predicted(&s->cycle, now), t);
	for (i = 0; i < syncs(dc); i++) {
		p = ec_frame_add(fb, EC_CMD_FRMW, index, ref, EC_REG_DC_SYSTIME, time_bytes(m));
		memcpy(p, t, time_bytes(m));
	}
	if (dc & REF_TIME) {
		p = ec_frame_add(fb, EC_CMD_FPRD, index, ref, EC_REG_DC_SYSTIME, time_bytes(m));
		memset(p, 0, time_bytes(m));
	}
	if (dc & MONITOR) {
		p = ec_frame_add(fb, EC_CMD_BRD, index, 0, EC_REG_DC_DIFF, 4);
		put_unaligned_le32(0, p);
	}
	s->cycle.dc_sent |= dc & EC_SEND_FLAG_ALL;
}

static const u8 *skip(const u8 *data, u16 len)
{
	return data + len + EC_DGRAM_OVERHEAD;
}

/* The upper half of a 32-bit clock is the one of the application's time. */
static u64 whole_time(struct ec_master *m, const u8 *data, u16 len)
{
	u64 app;

	if (len == 8)
		return get_unaligned_le64(data);
	app = ec_dc_now(m);
	return app + (s32)(get_unaligned_le32(data) - (u32)app);
}

/**
 * ec_dc_take() - results of the clock datagrams of a returned frame
 * @s: active session
 * @dc: what ec_dc_fill() has put there
 * @data: data of the first datagram, matched against what was sent
 * @sent_ns: when the frame was sent (ktime)
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: data of the first datagram of process data.
 */
const u8 *ec_dc_take(struct ec_session *s, u32 dc, const u8 *data, u64 sent_ns)
{
	struct ec_cycle *c = &s->cycle;
	u16 len = time_bytes(s->master);
	unsigned int i;

	if (dc & SYNC_REF)
		data = skip(data, 4);
	if (dc & SYNC_SLAVES) {
		if (get_unaligned_le16(data + len)) {
			c->dc_time = len == 8 ? get_unaligned_le64(data) :
				     get_unaligned_le32(data);
			c->dc_time_ns = sent_ns;
			c->dc_back |= SYNC_SLAVES;
		}
		for (i = 0; i < syncs(dc); i++)
			data = skip(data, len);
	}
	if (dc & REF_TIME) {
		if (get_unaligned_le16(data + len)) {
			c->dc_time64 = whole_time(s->master, data, len);
			c->dc_back |= REF_TIME;
		}
		data = skip(data, len);
	}
	if (dc & MONITOR) {
		if (get_unaligned_le16(data + 4)) {
			c->dc_diff = get_unaligned_le32(data);
			c->dc_back |= MONITOR;
		}
		data = skip(data, 4);
	}
	return data;
}

/**
 * ec_dc_judge() - tell the application what is back of what it has sent
 * @s: active session
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_dc_judge(struct ec_session *s)
{
	struct ec_cycle *c = &s->cycle;
	struct ec_status *st = s->shared->status;

	WRITE_ONCE(st->dc_ref, READ_ONCE(s->master->dc.ref_station) != 0);
	if (c->dc_sent & SYNC_SLAVES) {
		WRITE_ONCE(st->dc_time, c->dc_time);
		WRITE_ONCE(st->dc_time_valid, !!(c->dc_back & SYNC_SLAVES));
	}
	if (c->dc_sent & REF_TIME) {
		WRITE_ONCE(st->dc_time64, c->dc_time64);
		WRITE_ONCE(st->dc_time64_valid, !!(c->dc_back & REF_TIME));
	}
	if (c->dc_sent & MONITOR)
		WRITE_ONCE(st->dc_monitor, c->dc_back & MONITOR ?
			   c->dc_diff & ~(u32)EC_DC_DIFF_AHEAD : ~0u);
	c->dc_sent = 0;
	c->dc_back = 0;
}
