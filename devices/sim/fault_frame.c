// SPDX-License-Identifier: GPL-2.0-only
/* Faults of frames, and faults that wait for a frame. */
#include "esc_int.h"

bool ec_sim_fault_of_frame(enum ec_sim_fault_type type)
{
	return type == EC_SIM_FAULT_LOSE || type == EC_SIM_FAULT_DUPLICATE ||
	       type == EC_SIM_FAULT_DELAY || type == EC_SIM_FAULT_MANGLE;
}

/* end an earlier fault by chance of the same kind and port */
static void end_chance(struct ec_sim *sim, const struct ec_sim_fault *f)
{
	int *at = &sim->fault_frame;

	while (*at >= 0) {
		int i = *at;
		const struct ec_sim_fault *o = &sim->fault[i].f;

		if (o->type == f->type && o->port == f->port && !o->arg) {
			*at = sim->fault[i].next;
			ec_sim_fault_free(sim, i);
		} else {
			at = &sim->fault[i].next;
		}
	}
}

static void append(struct ec_sim *sim, int *at, int i)
{
	while (*at >= 0)
		at = &sim->fault[*at].next;
	sim->fault[i].next = -1;
	*at = i;
}

/* a fault of frames, or one that waits for a frame, is due: from now on frames count */
void ec_sim_fault_watch(struct ec_sim *sim, int i)
{
	const struct ec_sim_fault *f = &sim->fault[i].f;

	if (f->frame) {
		append(sim, &sim->fault_wait, i);
		return;
	}
	if (!f->arg)
		end_chance(sim, f);
	if (!f->arg && !f->arg2) {
		ec_sim_fault_free(sim, i);
		return;
	}
	sim->fault[i].next = sim->fault_frame;
	sim->fault_frame = i;
}

/* has the frame a physical command that accesses this register */
static bool accesses(const struct ec_sim_flight *fl, u16 reg)
{
	struct ec_frame_iter it;
	struct ec_dgram d;

	if (!ec_sim_datagrams(&it, fl->frame, fl->len))
		return false;
	while (it.more && ec_frame_iter_next(&it, &d) > 0) {
		if (d.cmd == EC_CMD_NOP || (d.cmd >= EC_CMD_LRD && d.cmd <= EC_CMD_LRW))
			continue;
		if (ec_range_hit(d.ado, d.len, reg, 1))
			return true;
	}
	return false;
}

static bool counts(const struct ec_sim_fault *f, const struct ec_sim_flight *fl)
{
	return !f->by_register || accesses(fl, f->reg);
}

static bool hits(struct ec_sim *sim, struct ec_sim_pending_fault *pf,
		 const struct ec_sim_flight *fl)
{
	if ((pf->f.port >= 0 && pf->f.port != fl->mport) || !counts(&pf->f, fl))
		return false;
	if (pf->f.arg)
		return ++pf->seen == pf->f.arg;
	return (u64)ec_sim_random(sim) * 1000000 >> 32 < pf->f.arg2;
}

/* what happens to the frame being sent; @lose_out: it gets nowhere */
void ec_sim_faults_frame(struct ec_sim *sim, struct ec_sim_flight *fl, bool *lose_out)
{
	int *at = &sim->fault_frame;

	while (*at >= 0) {
		int i = *at;
		struct ec_sim_pending_fault *pf = &sim->fault[i];
		const struct ec_sim_fault *f = &pf->f;

		if (!hits(sim, pf, fl)) {
			at = &pf->next;
			continue;
		}
		fl->res.induced = true;
		switch (f->type) {
		case EC_SIM_FAULT_LOSE:
			if (f->value)
				fl->lose_back = true;
			else
				*lose_out = true;
			break;
		case EC_SIM_FAULT_DUPLICATE:
			fl->res.copies = (u8)(f->value ? f->value : 1);
			break;
		case EC_SIM_FAULT_DELAY:
			fl->extra_ns += f->value;
			break;
		default:
			fl->res.mangled = true;
			break;
		}
		if (f->arg) {			/* it was the n-th: done */
			*at = pf->next;
			ec_sim_fault_free(sim, i);
		} else {
			at = &pf->next;
		}
	}
}

/* change one to four bytes behind the EtherCAT header */
void ec_sim_faults_mangle(struct ec_sim *sim, u8 *frame, size_t len)
{
	u32 n = 1 + (ec_sim_random(sim) & 3);

	if (len <= EC_FRAME_HDR)
		return;
	while (n--) {
		u32 span = (u32)len - EC_FRAME_HDR;
		u32 at = EC_FRAME_HDR + ec_sim_random(sim) % span;

		frame[at] ^= (u8)(1u << (ec_sim_random(sim) & 7));
	}
}

/* what waited for a frame has waited: it happens at @t, or later as it says */
static void happen(struct ec_sim *sim, int i, u64 t)
{
	struct ec_sim_fault *f = &sim->fault[i].f;

	f->frame = 0;
	f->at_ns = t + f->after_ns;
	ec_sim_fault_queue(sim, i);
}

/* the frame is sent: is it the one that faults wait for */
void ec_sim_faults_wait(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	int *at = &sim->fault_wait;
	bool now = false;

	while (*at >= 0) {
		int i = *at;
		struct ec_sim_pending_fault *pf = &sim->fault[i];

		if (!counts(&pf->f, fl) || ++pf->seen < pf->f.frame) {
			at = &pf->next;
			continue;
		}
		*at = pf->next;
		if (pf->f.when == EC_SIM_WHEN_SENT) {
			happen(sim, i, fl->start_ns);
			now = true;
		} else {
			pf->seen = 0;
			append(sim, &fl->faults, i);
		}
	}
	if (now)
		ec_sim_advance(sim, fl->start_ns);
}

/* is it the cable of the fault that the frame enters now */
static bool on_cable(const struct ec_sim_fault *f, const struct ec_sim_flight *fl)
{
	int at = f->slave < 0 ? f->slave - 1 : f->slave, port = max(f->port, 0);

	return (fl->from == at && (at < 0 || fl->from_port == port)) ||
	       (fl->to == at && (at < 0 || fl->to_port == port));
}

/* the first bit of the frame leaves on a cable at @t */
void ec_sim_faults_pass(struct ec_sim *sim, struct ec_sim_flight *fl, u64 t)
{
	int *at = &fl->faults;

	while (*at >= 0) {
		int i = *at;
		struct ec_sim_pending_fault *pf = &sim->fault[i];

		if (!on_cable(&pf->f, fl) ||
		    (!pf->seen++ && pf->f.when == EC_SIM_WHEN_BACK)) {
			at = &pf->next;
			continue;
		}
		*at = pf->next;
		happen(sim, i, t);
	}
}

/* the frame is back or lost, and never was where it should have met these */
void ec_sim_faults_end(struct ec_sim *sim, struct ec_sim_flight *fl)
{
	while (fl->faults >= 0) {
		int i = fl->faults;

		fl->faults = sim->fault[i].next;
		happen(sim, i, sim->now);
	}
}
