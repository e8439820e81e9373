// SPDX-License-Identifier: GPL-2.0-only
/*
 * Frames that are on their way while something happens to ports.
 *
 * Mostly a frame goes its whole way when it is sent. When a port may change before it is
 * back, it goes from slave to slave at the times it gets there, and each time finds the
 * ports as they are then:
 *
 * - its first bit decides where it goes on, and each slave processes it then;
 * - a link that is lost between the first and the last bit of a frame on a cable ends it;
 * - a loop that opens or closes acts on the frames that get there later, never on the
 *   frame whose write did it;
 * - a cable that damages frames makes their FCS wrong: the slave at its end counts an invalid
 *   frame, those that get it later a forwarded error, as the register 0x0300 of each port says;
 * - a frame that comes back to a port whose loop closed after the frame was sent is lost
 *   or passes, as ec_sim_set_under_way() says.
 */
#include "esc_int.h"

/**
 * ec_sim_next_step() - when a frame on its way gets to the next slave
 * @sim: segment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: simulation time, ns; ~0 when no frame is on its way.
 */
u64 ec_sim_next_step(const struct ec_sim *sim)
{
	return sim->flights ? sim->flights->at_ns : EC_ESC_NEVER;
}

/**
 * ec_sim_set_under_way() - what becomes of frames behind a port whose loop closes
 * @sim: segment
 * @how: fate of those that come back to it
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sim_set_under_way(struct ec_sim *sim, enum ec_sim_under_way how)
{
	sim->under_way = how;
}

/**
 * ec_sim_disturbed() - frames that were on their way when a link came or went
 * @sim: segment
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: how many, lost or not; those with such an event are "induced" in their results.
 */
u64 ec_sim_disturbed(const struct ec_sim *sim)
{
	return sim->disturbed;
}

/* when ports change by themselves; the bound is exact after this */
static u64 port_next(struct ec_sim *sim)
{
	sim->port_next = EC_ESC_NEVER;
	for (u32 i = 0; i < sim->count; i++)
		ec_sim_port_due(sim, min(sim->esc[i]->loop_restore, sim->esc[i]->link_wake));
	return sim->port_next;
}

/*
 * May a port change before a frame, sent now, is back at @until? If loops that close
 * concern frames sent before, then any later frame may do so.
 */
bool ec_sim_must_fly(struct ec_sim *sim, u64 until)
{
	return sim->flights || sim->damages || sim->under_way != EC_SIM_UNDER_WAY_BACK ||
	       ec_sim_faults_next(sim) <= until ||
	       (sim->port_next <= until && port_next(sim) <= until);
}

/* the last bit of a frame is back; @delay_ns after the first one was sent */
void ec_sim_arrive(struct ec_sim *sim, struct ec_sim_flight *fl, int out_port, u64 delay_ns)
{
	struct ec_sim_result *res = &fl->res;

	if (res->mangled)
		ec_sim_faults_mangle(sim, fl->frame, fl->len);
	if (fl->eth)
		ec_sim_eth_mark(sim, fl);
	res->copies++;
	res->out_port = out_port;
	res->delay_ns = (s64)(delay_ns + fl->extra_ns);
	fl->due_ns = fl->start_ns + (u64)res->delay_ns;
	fl->done = true;
	if (fl->faults >= 0)
		ec_sim_faults_end(sim, fl);
	if (fl->mport < 0)
		ec_sim_host_done(sim, fl);
}

void ec_sim_lose(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	fl->res.copies = 0;
	fl->res.mangled = false;
	fl->res.out_port = -1;
	fl->res.delay_ns = -ENOLINK;
	fl->done = true;
	if (fl->faults >= 0)
		ec_sim_faults_end(sim, fl);
	if (fl->mport < 0)
		ec_sim_host_done(sim, fl);
}

static void on_its_way(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	struct ec_sim_flight **at = &sim->flights;

	while (*at && (*at)->at_ns <= fl->at_ns)
		at = &(*at)->next;
	fl->next = *at;
	*at = fl;
}

/**
 * ec_sim_recall() - the model forgets a frame
 * @sim: segment
 * @fl: frame; not back and not lost: it is lost
 *
 * Context: Any. RT-safe: bounded by the frames, no sleep, no allocation.
 */
void ec_sim_recall(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	struct ec_sim_flight **at = &sim->flights;

	while (*at && *at != fl)
		at = &(*at)->next;
	if (!*at)
		return;
	*at = fl->next;
	ec_sim_lose(sim, fl);
}

/* let time pass until a frame is back or lost */
void ec_sim_finish(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	while (!fl->done)
		ec_sim_advance(sim, ec_sim_next_step(sim));
}

static void cut_off(struct ec_sim *sim, const struct ec_esc_transit *t, u64 now)
{
	struct ec_sim_flight *fl = sim->flights;

	if (t->until <= now || (sim->passing && t->number == sim->frame))
		return;
	while (fl && fl->number != t->number)
		fl = fl->next;
	if (fl)
		ec_sim_recall(sim, fl);
}

/* the link at a port came or went: what is on its cable is lost */
void ec_sim_link_changed(struct ec_esc *esc, int port, u64 now)
{
	struct ec_esc_port *p = &esc->port[port];
	struct ec_sim *sim = esc->sim;

	for (struct ec_sim_flight *fl = sim->flights; fl; fl = fl->next) {
		sim->disturbed += !fl->disturbed;
		fl->disturbed = true;
		fl->res.induced = true;
	}
	if (p->link)
		return;
	p->lost_at = ++sim->port_events;
	cut_off(sim, &p->sent, now);
	cut_off(sim, &p->received, now);
}

/* the frame sets out to what is at @peer, @peer_port; its first bit leaves at @t */
static void leave(struct ec_sim *sim, struct ec_sim_flight *fl, const struct ec_esc_port *cable,
		  struct ec_esc_transit *transit, u64 t)
{
	fl->left_at = sim->port_events;
	fl->to = cable->peer;
	fl->to_port = cable->peer_port;
	fl->at_ns = t + cable->cable_ns;
	transit->number = fl->number;
	transit->until = fl->at_ns + fl->wire_ns;
	if (fl->to < 0)
		fl->at_ns += fl->wire_ns;
	ec_sim_faults_pass(sim, fl, t);
	on_its_way(sim, fl);
}

/* nothing has happened to it yet */
static void set_out(const struct ec_sim *sim, struct ec_sim_flight *fl, int from)
{
	fl->circulating = false;
	fl->disturbed = false;
	fl->damaged = false;
	fl->hops = 0;
	fl->from = from;
	fl->from_port = 0;
	fl->started_at = sim->port_events;
	fl->left_at = sim->port_events;
}

/* a frame, of which ec_sim_start() knows the beginning, leaves the master */
void ec_sim_fly(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	const struct ec_esc_port *cable = &sim->mport[fl->mport];
	struct ec_frame_iter it;
	struct ec_dgram d;

	set_out(sim, fl, -2 - fl->mport);
	if (ec_sim_datagrams(&it, fl->frame, fl->len))
		while (it.more && ec_frame_iter_next(&it, &d) > 0)
			fl->circulating |= d.circulating;
	leave(sim, fl, cable, &sim->esc[cable->peer]->port[cable->peer_port].received,
	      fl->start_ns);
}

/* a frame of a host is at the port of a slave */
void ec_sim_fly_from_host(struct ec_sim *sim, struct ec_sim_flight *fl, int slave, int port)
{
	struct ec_esc_transit *transit = &sim->esc[slave]->port[port].received;

	set_out(sim, fl, EC_ESC_PEER_HOST);
	fl->to = slave;
	fl->to_port = (u8)port;
	fl->at_ns = fl->start_ns;
	transit->number = fl->number;
	transit->until = fl->at_ns + fl->wire_ns;
	on_its_way(sim, fl);
}

/* was the cable that the frame took whole all the time */
static bool came_through(const struct ec_sim *sim, const struct ec_sim_flight *fl)
{
	const struct ec_esc_port *p = fl->from < 0 ? &sim->esc[fl->to]->port[fl->to_port] :
						     &sim->esc[fl->from]->port[fl->from_port];

	return p->link && p->lost_at <= fl->left_at;
}

/* the loop of the port at which the frame arrives is closed: does it pass */
static bool let_in(struct ec_sim *sim, const struct ec_sim_flight *fl, struct ec_esc *esc)
{
	struct ec_esc_port *port = &esc->port[fl->to_port];
	bool in = port->closed_at > fl->started_at;

	if (in && sim->under_way == EC_SIM_UNDER_WAY_RANDOM)
		in = ec_sim_random(sim) & 1;
	else if (sim->under_way == EC_SIM_UNDER_WAY_LOST)
		in = false;
	if (ec_esc_port_waits(esc, fl->to_port)) {
		port->auto_closed = false;
		ec_sim_loops(esc, false, fl->at_ns);
	}
	return in;
}

/* where the frame can leave: what its own writes did to loops is for the frames after it */
static u8 exits(const struct ec_esc *esc, const struct ec_sim_flight *fl)
{
	u8 open = ec_esc_open_ports(esc), links = 0;

	if (esc->loop_frame != fl->number)
		return open;
	for (int p = 0; p < EC_MAX_PORT; p++)
		links |= (u8)(esc->port[p].link << p);
	return esc->loop_before & (links | open);
}

/* when the frame comes to the ports of a slave, if nothing more happens */
static void arrivals(struct ec_sim *sim, const struct ec_sim_flight *fl, const struct ec_esc *esc,
		     struct ec_frame_ctx *ctx)
{
	const struct ec_sim_route *r;
	const struct ec_sim_step *st;
	u64 sent = fl->start_ns;

	ctx->recv_mask = 1;
	ctx->recv[0] = ctx->now;
	if (fl->mport < 0)
		return;
	if (sim->dirty)
		ec_sim_routes(sim);
	if (esc->route_pos[fl->mport] < 0)
		return;
	r = &sim->route[fl->mport];
	st = &r->step[esc->route_pos[fl->mport]];
	if (!r->repeats)	/* it may have gone another way so far */
		sent = ctx->now - st->pu_ns;
	ctx->recv_mask = st->recv_mask;
	for (int p = 0; p < EC_MAX_PORT; p++)
		ctx->recv[p] = sent + st->recv_ns[p];
}

static void execute(struct ec_sim *sim, struct ec_sim_flight *fl, struct ec_esc *esc)
{
	struct ec_frame_ctx ctx = { .now = fl->at_ns, .end = fl->at_ns + fl->wire_ns };
	struct ec_frame_iter it;
	struct ec_dgram d;
	int ret = 1;

	/* nothing of a damaged frame is taken over */
	if (fl->damaged || !ec_sim_datagrams(&it, fl->frame, fl->len))
		return;
	arrivals(sim, fl, esc, &ctx);
	ec_esc_settle(esc);
	sim->frame = fl->number;
	sim->passing = true;
	while (it.more && esc->powered && (ret = ec_frame_iter_next(&it, &d)) > 0)
		ec_esc_dgram(esc, &d, &ctx);
	sim->passing = false;
	if (ret < 0 && !fl->res.processed && esc->mem[EC_REG_ERR_PU] != 0xff)
		esc->mem[EC_REG_ERR_PU]++;
	fl->res.processed = true;
	ec_sim_deliver(sim);
}

/* Past a port 0 that is closed: the second time the frame is destroyed. */
static bool circulate(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	bool had = fl->circulating;
	struct ec_frame_iter it;
	struct ec_dgram d;

	fl->circulating = true;
	if (sim->bug == EC_SIM_BUG_CIRCULATING)
		return true;
	if (ec_sim_datagrams(&it, fl->frame, fl->len))
		while (it.more && ec_frame_iter_next(&it, &d) > 0)
			d.hdr[7] |= EC_SIM_LEN_CIRCULATING;
	return !had;
}

/* through a slave; returns the port at which the frame leaves, -1: it does not */
static int through(struct ec_sim *sim, struct ec_sim_flight *fl, struct ec_esc *esc,
		   u32 *delay_ns)
{
	u8 open = exits(esc, fl);
	int p = fl->to_port;

	*delay_ns = esc->cfg.forward_ns;
	for (int n = 0; n < 2 * EC_MAX_PORT; n++) {
		if (!p) {
			if (!(open & 1) && !circulate(sim, fl))
				return -1;
			execute(sim, fl, esc);
			*delay_ns = esc->cfg.process_ns;
		}
		p = ec_sim_next_port(sim, p);
		if (open & BIT(p))
			return p;
	}
	return -1;
}

/* no EtherCAT, and 0x0100 bit 0 is set: the controller destroys it */
static bool destroyed(const struct ec_sim_flight *fl, const struct ec_esc *esc)
{
	return !fl->frame && esc->mem[EC_REG_DL_CONTROL] & 1 &&
	       !ec_esc_bug(esc, EC_SIM_BUG_FORWARD);
}

/* The frame has come to a port by its cable: is its FCS right? */
static void check(struct ec_sim *sim, struct ec_sim_flight *fl, struct ec_esc *esc)
{
	u32 ppm = esc->fault.damage_ppm[fl->to_port];
	u8 *count = esc->mem + EC_REG_ERR_RX(fl->to_port);

	if (!sim->damages)
		return;
	if (fl->damaged) {
		if (esc->cfg.features & EC_FEAT_FCS_SEPARATE)
			count = esc->mem + EC_REG_ERR_FWD(fl->to_port);
	} else if (ppm && (u64)ec_sim_random(sim) * 1000000 >> 32 < ppm) {
		fl->damaged = true;
		fl->res.induced = true;
	}
	if (fl->damaged && *count != 0xff)
		++*count;
}

/* a frame is at a slave; false: it ends there */
static bool enter(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	struct ec_esc *esc = sim->esc[fl->to];
	struct ec_esc_port *port;
	u32 delay_ns;
	int p;

	if (fl->hops++ > 8 * sim->count + 16)
		return false;
	if (!esc->port[fl->to_port].open && !let_in(sim, fl, esc))
		return false;
	check(sim, fl, esc);
	p = destroyed(fl, esc) ? -1 : through(sim, fl, esc, &delay_ns);
	if (p < 0)
		return false;
	port = &esc->port[p];
	if (!port->link || port->peer == EC_ESC_PEER_HOST)
		return false;
	fl->from = esc->index;
	fl->from_port = (u8)p;
	leave(sim, fl, port, &port->sent,
	      fl->at_ns + (sim->bug == EC_SIM_BUG_NO_DELAY ? 0 : delay_ns));
	return true;
}

/* the first of the frames on their way gets where it goes */
void ec_sim_step(struct ec_sim *sim)
{
	struct ec_sim_flight *fl = sim->flights;
	bool back = fl->to < 0;

	sim->flights = fl->next;
	if (!came_through(sim, fl) || (back ? fl->lose_back || fl->damaged : !enter(sim, fl)))
		ec_sim_lose(sim, fl);
	else if (back)
		ec_sim_arrive(sim, fl, -2 - fl->to, fl->at_ns - fl->start_ns);
}
