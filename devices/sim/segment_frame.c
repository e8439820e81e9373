// SPDX-License-Identifier: GPL-2.0-only
/*
 * Frames through a segment.
 *
 * A frame is worked through datagram by datagram, each with all its slaves.
 * That gives the same result as slave by slave, since slaves meet only in the
 * datagram, and it allows to leave out slaves which a datagram does not
 * concern (ec_sim_set_slow() switches that off, to compare).
 */
#include "esc_int.h"

/* the application is notified at the end of the frame */
void ec_esc_pend(struct ec_esc *esc, u64 at_ns)
{
	struct ec_sim *sim = esc->sim;

	esc->pend_ns = at_ns;
	if (esc->pend_next != -2)
		return;
	esc->pend_next = -1;
	if (sim->pend_head < 0)
		sim->pend_head = esc->index;
	else
		sim->esc[sim->pend_tail]->pend_next = esc->index;
	sim->pend_tail = esc->index;
}

/* reports what frames have done */
void ec_sim_deliver(struct ec_sim *sim)
{
	while (sim->pend_head >= 0) {
		struct ec_esc *esc = sim->esc[sim->pend_head];

		sim->pend_head = esc->pend_next;
		esc->pend_next = -2;
		ec_esc_deliver(esc);
	}
}

/* one frame on its way */
struct pass {
	struct ec_sim *sim;
	struct ec_sim_route *r;
	u32 steps;
	u64 now;
	u32 wire_ns;
	int mport;
};

static void visit(const struct pass *ps, u32 i, struct ec_dgram *d)
{
	const struct ec_sim_step *st = &ps->r->step[i];
	struct ec_frame_ctx ctx;
	int p;

	if (!st->esc->powered)		/* reset itself by this frame */
		return;
	ec_esc_settle(st->esc);
	ctx.now = ps->now + st->pu_ns;
	ctx.end = ctx.now + ps->wire_ns;
	ctx.recv_mask = st->recv_mask;
	for (p = 0; p < EC_MAX_PORT; p++)
		ctx.recv[p] = ps->now + st->recv_ns[p];
	ec_esc_dgram(st->esc, d, &ctx);
}

static void visit_all(const struct pass *ps, struct ec_dgram *d)
{
	u32 i;

	for (i = 0; i < ps->steps; i++)
		visit(ps, i, d);
}

/* the IRQ field of every datagram collects the events of all slaves */
static void collect_irq(const struct pass *ps, struct ec_dgram *d)
{
	u32 i;

	if (!ps->sim->irqs)
		return;
	for (i = 0; i < ps->steps; i++) {
		const struct ec_esc *esc = ps->r->step[i].esc;

		if (esc->irq && !esc->fault.dead)
			d->irq |= ec_esc_irq(esc);
	}
	put_unaligned_le16(d->irq, d->hdr + 8);
}

static void by_position(const struct pass *ps, struct ec_dgram *d)
{
	u16 adp = d->adp, pos = (u16)-adp;

	collect_irq(ps, d);
	if (pos < ps->steps) {
		d->adp = 0;
		visit(ps, pos, d);
	}
	d->adp = (u16)(adp + ps->steps);
	put_unaligned_le16(d->adp, d->hdr + 2);
}

static void by_station(const struct pass *ps, struct ec_dgram *d)
{
	const struct ec_sim *sim = ps->sim;
	s32 node, pos = -1;

	if (!d->adp) {
		visit_all(ps, d);
		return;
	}
	node = sim->bucket[d->adp & (sim->buckets - 1)];
	for (; node >= 0; node = sim->node_next[node]) {
		s32 p = sim->esc[node / 2]->route_pos[ps->mport];

		if (sim->node_addr[node] != d->adp || p < 0 ||
		    p >= (s32)ps->steps || p == pos)
			continue;
		if (pos >= 0) {		/* two of them */
			visit_all(ps, d);
			return;
		}
		pos = p;
	}
	collect_irq(ps, d);
	if (pos >= 0)
		visit(ps, (u32)pos, d);
}

static void by_logical(const struct pass *ps, struct ec_dgram *d)
{
	struct ec_sim *sim = ps->sim;
	const struct ec_sim_hits *hits;
	u32 first = ec_dgram_logical(d), i;
	u64 last = (u64)first + d->len;
	bool quick = last <= 1ULL << 32;
	const struct ec_quick k = {
		.data = d->data, .first = first, .len = d->len, .cmd = d->cmd,
		.count = d->cmd == EC_CMD_LRW ? 2 : 1,
		.frame = sim->frame, .wire_ns = ps->wire_ns,
	};
	u16 wkc = 0;

	collect_irq(ps, d);
	hits = ec_sim_spans_hit(sim, ps->mport, ps->steps, first, d->len);
	for (i = 0; i < hits->n; i++) {
		const struct ec_sim_step *st = &ps->r->step[hits->step[i]];

		if (!quick || !st->esc->powered ||
		    !ec_esc_quick_data(st->esc, &k, ps->now + st->pu_ns, &wkc))
			visit(ps, hits->step[i], d);
	}
	if (wkc)
		ec_dgram_set_wkc(d, (u16)(ec_dgram_wkc(d) + wkc));
}

static void quick_update(struct ec_esc *esc)
{
	if (!esc->quick.known)
		ec_esc_quick_update(esc);
}

/* registers which are read as they lie in the memory */
static bool plain_read(const struct ec_dgram *d)
{
	u32 end = d->ado + (u32)d->len;

	return d->cmd == EC_CMD_BRD && d->len &&
	       (end <= EC_REG_DL_STATUS ||
		(d->ado >= EC_REG_DL_STATUS + 2 && end <= EC_REG_ECAT_EVENT));
}

static void plain_broadcast(const struct pass *ps, struct ec_dgram *d)
{
	bool al = d->ado < EC_REG_AL_STATUS + 2 && d->ado + d->len > EC_REG_AL_STATUS;
	u16 wkc = 0, passed = 0;
	u32 i, k;

	collect_irq(ps, d);
	for (i = 0; i < ps->steps; i++) {
		struct ec_esc *esc = ps->r->step[i].esc;
		const u8 *m = esc->mem + d->ado;

		quick_update(esc);
		if (!esc->quick.bcast || !esc->powered) {
			visit(ps, i, d);
			continue;
		}
		for (k = 0; k < d->len; k++)
			d->data[k] |= m[k];
		if (al && esc->ecat_event & EC_ECAT_EVENT_AL)
			ec_esc_event(esc, 0, EC_ECAT_EVENT_AL);
		wkc++;
		passed++;
	}
	d->adp = (u16)(d->adp + passed);
	put_unaligned_le16(d->adp, d->hdr + 2);
	ec_dgram_set_wkc(d, (u16)(ec_dgram_wkc(d) + wkc));
}

/* FRMW to 0x0910: the time of one slave for those behind it */
static void spread_time(const struct pass *ps, struct ec_dgram *d)
{
	u16 wkc = 0;
	u32 i;

	collect_irq(ps, d);
	for (i = 0; i < ps->steps; i++) {
		const struct ec_sim_step *st = &ps->r->step[i];
		struct ec_esc *esc = st->esc;

		quick_update(esc);
		if (!esc->quick.time || !esc->powered || ec_esc_addressed(esc, d)) {
			visit(ps, i, d);
			continue;
		}
		ec_esc_dc_time(esc, d->data, d->len == 8, ps->now + st->pu_ns);
		wkc++;
	}
	if (wkc)
		ec_dgram_set_wkc(d, (u16)(ec_dgram_wkc(d) + wkc));
}

static void datagram(const struct pass *ps, struct ec_dgram *d)
{
	if (ps->sim->slow || ps->r->repeats) {
		visit_all(ps, d);
		return;
	}
	switch (d->cmd) {
	case EC_CMD_NOP:
		collect_irq(ps, d);
		break;
	case EC_CMD_APRD:
	case EC_CMD_APWR:
	case EC_CMD_APRW:
		if (ps->sim->bug == EC_SIM_BUG_AP_NO_INC)
			visit_all(ps, d);
		else
			by_position(ps, d);
		break;
	case EC_CMD_FPRD:
	case EC_CMD_FPWR:
	case EC_CMD_FPRW:
		by_station(ps, d);
		break;
	case EC_CMD_LRD:
	case EC_CMD_LWR:
	case EC_CMD_LRW:
		by_logical(ps, d);
		break;
	case EC_CMD_FRMW:
		if (d->ado == EC_REG_DC_SYSTIME && (d->len == 4 || d->len == 8))
			spread_time(ps, d);
		else
			visit_all(ps, d);
		break;
	default:
		if (plain_read(d))
			plain_broadcast(ps, d);
		else
			visit_all(ps, d);
	}
}

/*
 * An ESC processes while the frame passes: it goes by the headers of the datagrams
 * and their "more" bits up to the end of the frame, never by the length in the
 * EtherCAT header. Returns false: not of the type that is processed.
 */
bool ec_sim_datagrams(struct ec_frame_iter *it, u8 *frame, size_t len)
{
	if (len < EC_FRAME_HDR + EC_DGRAM_OVERHEAD ||
	    get_unaligned_le16(frame) >> 12 != EC_FRAME_TYPE_DGRAM)
		return false;
	it->p = frame + EC_FRAME_HDR;
	it->end = frame + len;
	it->more = true;
	return true;
}

/*
 * Circulating bit: an ESC without upstream link sets it, and destroys a frame
 * that has it. Returns false if this frame ends there.
 */
static bool circulating(struct pass *ps, u8 *frame, size_t len)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	bool had = false;

	if (ps->r->circ < 0 || ps->sim->bug == EC_SIM_BUG_CIRCULATING ||
	    !ec_sim_datagrams(&it, frame, len))
		return true;
	while (it.more && ec_frame_iter_next(&it, &d) > 0) {
		had |= d.circulating;
		d.hdr[7] |= EC_SIM_LEN_CIRCULATING;
	}
	if (had)
		ps->steps = (u32)ps->r->circ;
	return !had;
}

static void process(struct pass *ps, u8 *frame, size_t len)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	int ret = 1;

	if (!ec_sim_datagrams(&it, frame, len))
		return;				/* forwarded as it is */
	while (it.more && (ret = ec_frame_iter_next(&it, &d)) > 0)
		datagram(ps, &d);
	if (ret < 0 && ps->steps) {
		u8 *count = ps->r->step[0].esc->mem + EC_REG_ERR_PU;

		if (*count != 0xff)
			++*count;
	}
}

/* the whole way at once, as it is now */
static void pass(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	const struct ec_sim_route *r = &sim->route[fl->mport];
	struct pass ps = {
		.sim = sim, .r = &sim->route[fl->mport], .steps = r->steps,
		.now = fl->start_ns, .wire_ns = fl->wire_ns, .mport = fl->mport,
	};
	bool lost = !circulating(&ps, fl->frame, fl->len);

	fl->res.processed = r->steps;
	sim->passing = true;
	process(&ps, fl->frame, fl->len);
	sim->passing = false;
	if (r->opens >= 0) {		/* heard at an auto-closed port */
		struct ec_esc *esc = sim->esc[r->opens];

		esc->port[r->opens_port].auto_closed = false;
		ec_sim_loops(esc, false, fl->start_ns);
	}
	ec_sim_deliver(sim);

	if (lost || fl->lose_back || r->out_port < 0)
		ec_sim_lose(sim, fl);
	else
		ec_sim_arrive(sim, fl, r->out_port, r->delay_ns + fl->wire_ns);
}

/* a frame, of which eth, frame and their lengths are given, is sent at a master port */
void ec_sim_start(struct ec_sim *sim, struct ec_sim_flight *fl, int port, u64 now_ns)
{
	bool lose_out = false;

	fl->number = ++sim->frames;
	fl->mport = port;
	fl->start_ns = now_ns;
	fl->wire_ns = ec_frame_wire_ns(fl->eth_len) - 12 * 80;
	ec_sim_advance(sim, now_ns);
	if (sim->fault_wait >= 0)
		ec_sim_faults_wait(sim, fl);
	sim->frame = fl->number;
	ec_sim_faults_frame(sim, fl, &lose_out);
	if (sim->dirty)
		ec_sim_routes(sim);
	if (lose_out || !ec_sim_link(sim, port))
		ec_sim_lose(sim, fl);
	else if (fl->faults >= 0 ||
		 ec_sim_must_fly(sim, now_ns + sim->route[port].span_ns + fl->wire_ns))
		ec_sim_fly(sim, fl);
	else
		pass(sim, fl);
}

/**
 * ec_sim_frame_result() - pass one frame through the segment and back
 * @sim: segment
 * @port: master port at which it is sent, 0 or 1
 * @frame: EtherCAT header and datagrams, modified in place
 * @len: bytes in @frame, padding included
 * @now_ns: when the first bit is sent
 * @res: what became of it
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 * Return: delay in ns until the last bit is back, or -ENOLINK if it was lost.
 */
s64 ec_sim_frame_result(struct ec_sim *sim, int port, u8 *frame, size_t len,
			u64 now_ns, struct ec_sim_result *res)
{
	struct ec_sim_flight fl;

	ec_sim_flight_init(&fl, NULL, frame, len, EC_ETH_HDR + len);
	ec_sim_start(sim, &fl, port, now_ns);
	ec_sim_finish(sim, &fl);
	*res = fl.res;
	return res->delay_ns;
}

/**
 * ec_sim_frame2() - as ec_sim_frame(), for a ring
 * @sim: segment
 * @port: master port at which it is sent
 * @frame: EtherCAT header and datagrams, modified in place
 * @len: bytes in @frame
 * @now_ns: when the first bit is sent
 * @out_port: gets the master port at which it comes back, -1 if lost
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 * Return: delay in ns until the last bit is back, or -ENOLINK if it was lost.
 */
s64 ec_sim_frame2(struct ec_sim *sim, int port, u8 *frame, size_t len,
		  u64 now_ns, int *out_port)
{
	struct ec_sim_result res;

	ec_sim_frame_result(sim, port, frame, len, now_ns, &res);
	*out_port = res.out_port;
	return res.delay_ns;
}

/**
 * ec_sim_frame() - pass one frame through the segment and back
 * @sim: segment
 * @port: master port at which it is sent, 0 or 1
 * @frame: EtherCAT header and datagrams, modified in place
 * @len: bytes in @frame
 * @now_ns: when the first bit is sent
 *
 * Context: Any. RT-safe: bounded by datagrams times slaves.
 * Return: delay in ns until the last bit is back, or -ENOLINK if it was lost.
 */
s64 ec_sim_frame(struct ec_sim *sim, int port, u8 *frame, size_t len,
		 u64 now_ns)
{
	struct ec_sim_result res;

	return ec_sim_frame_result(sim, port, frame, len, now_ns, &res);
}

/**
 * ec_sim_set_slow() - let every datagram visit every slave
 * @sim: segment
 * @slow: without shortcuts; results must not differ
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sim_set_slow(struct ec_sim *sim, bool slow)
{
	u32 i;

	for (i = 0; i < sim->count; i++)
		ec_esc_settle(sim->esc[i]);
	sim->slow = slow;
}
