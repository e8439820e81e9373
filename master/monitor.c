// SPDX-License-Identifier: GPL-2.0-only
/* One thread per master: link, number of slaves, AL states; starts scans. */
#include <linux/kthread.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include "base/report.h"
#include "boundary/master.h"
#include "event_log.h"
#include "monitor.h"
#include "quiet.h"
#include "base/once64.h"
#include "bus/absent.h"
#include "bus/doubt.h"
#include "bus/identify.h"
#include "bus/known.h"
#include "bus/line_errors.h"
#include "bus/mailboxes.h"
#include "bus/owed.h"
#include "bus/ports.h"
#include "bus/ring_break.h"
#include "bus/ring_exit.h"
#include "bus/slave.h"
#include "bus/survey.h"
#include "bus/swallowed.h"
#include "carry/xfer.h"
#include "bus/scan.h"
#include "bus/scan_count.h"
#include "bus/silent.h"
#include "wire/regs.h"
#include "session/session_attach.h"
#include "session/session_status.h"
#include "clock/dc.h"
#include "clock/dc_armw.h"
#include "clock/dc_behind.h"

#define PERIOD_MS	20
#define SLACK_MS	4	/* by which a look may be earlier while all is well */
#define BOUNCE_MS	5	/* between looks while the number of slaves changes */
#define SILENT_LOOKS	2	/* without an answer before a scan starts */
#define STABLE_LOOKS	2	/* equal counts before a scan starts */
#define MOVING_NS	(100 * NSEC_PER_MSEC)	/* or so long: a contact may bounce all the time */
#define PORTS_NS	(20 * NSEC_PER_MSEC)	/* between reads of all ports because of an event */
#define LOST_NS		NSEC_PER_SEC	/* all frames, then all slaves are disconnected */
#define UNASKED_NS	NSEC_PER_SEC	/* if the event says nothing, while ports are closed */
#define TRIES		2	/* to poll all slaves */
#define STAYS		5	/* looks that do not clear an event, then it is not watched */
#define ALONE_NS	NSEC_PER_SEC	/* frames of its own, after a cycle that carried no rider */

static const char lost[] =
	"no reply, list of slaves held; check cable and power: a slave that was switched off is found again at activation or release of the master";
static const char doubled[] =
	"another slave replies at the same station address, list of slaves held; disconnect the other slave, or activate or release the master";

/* what the monitor remembers between two looks */
struct watch {
	struct ec_master *m;
	bool link_up;
	unsigned int count;	/* of the last look */
	unsigned int same;	/* looks with that count */
	u64 moving_ns;		/* since when counts differ and no scan has begun, 0: they do not */
	bool scanned;		/* @count slaves are scanned */
	bool held;		/* the list is held: no scan now, also if not @scanned */
	unsigned int silent;	/* looks in which a slave did not answer to its address */
	unsigned int too_many;	/* slaves of the last reply, more than a scan takes on */
	u64 scanned_ns;
	u64 rates_ns;
	u64 alone_ns;		/* no rider before that time */
	bool well;		/* all slaves are in their requested state */
	struct ec_survey survey;	/* of all slaves */
	u32 changes;		/* of them before it */
	u64 survey_ns;		/* when; 0: due */
	bool riding;		/* the rider is in flight; its reply is for the next look */
	u64 ride_ns;		/* since then */
	u16 irq;		/* events of all slaves */
	u16 watched;		/* that are to wake it, until the next look */
	bool woken;		/* by one of them */
	unsigned int stays;	/* looks in a row that did not clear the AL event */
	u64 ports_ns;		/* last read of all ports */
	u64 lost_ns;		/* since when no frame returns, 0: frames do */
	bool door;		/* a closed port has a link */
	u32 path;		/* changes of ports before this look */
	unsigned int dl_stays;	/* looks in a row that did not clear the event of a port */
	u64 event;		/* number of the next one for the kernel log */
	struct ec_quiet quiet;	/* looks of the timer */
};

static void check_links(struct watch *w)
{
	struct ec_master *m = w->m;
	u64 now = ktime_get_ns();

	w->link_up = ec_links_look(&m->links);
	if (now - w->rates_ns >= NSEC_PER_SEC) {
		w->rates_ns = now;
		ec_links_update_rates(&m->links);
	}
}

/* The status of a slave has changed without its worker. */
static void note_change(struct ec_slave *s, u16 status, u16 code)
{
	u8 state = status & EC_AL_STATE_MASK, before = READ_ONCE(s->al.status) & EC_AL_STATE_MASK;
	bool left = state < before && before == READ_ONCE(s->al.requested) &&
		    state != READ_ONCE(s->al.awaited);

	ec_slave_set_al(s, status, code, left ? EC_AL_BY_ITSELF : EC_AL_BY_REQUEST);
}

/* The next pass of the monitor starts a scan, unless the list is held. */
static void scan_next(struct watch *w)
{
	w->scanned = false;
	w->same = STABLE_LOOKS;
}

/* The list is held: a slave that does not reply is lost, and stays in its place. */
static void note_reply(struct watch *w, struct ec_slave *s, const struct ec_dg *dg)
{
	/* a lost frame says nothing of a slave, unless all are lost */
	bool missing = dg->err ? !w->count : dg->wkc != 1;

	if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED && !READ_ONCE(s->reply.silent))
		return;
	if (!missing && !dg->err) {
		s->reply.missed = 0;
		/* a loose contact must not fill the log */
		if (!ec_survey_is_due(s, ktime_get_ns()) || !ec_slave_set_replies(s))
			return;
		ec_slave_kick(s);
	} else if (missing && ++s->reply.missed >= SILENT_LOOKS) {
		s->reply.missed = SILENT_LOOKS;
		if (!ec_slave_set_silent(s, !dg->err && dg->wkc ? doubled : lost))
			return;
		WRITE_ONCE(w->m->bus.due, true);
		scan_next(w);
	} else {
		return;
	}
	WRITE_ONCE(w->m->dc.changed, true);
}

/*
 * AL status of every slave; used when the broadcast is not one plain state.
 * Returns false when a scanned slave did not respond at its station address.
 */
static bool check_slaves(struct watch *w)
{
	struct ec_master *m = w->m;
	bool all = true;
	struct ec_dg *dg;
	struct {
		u8 al[6];
		u32 reads;	/* by its worker, before this one */
	} *r;
	unsigned int i;

	dg = kvcalloc(m->bus.n_slaves + 1, sizeof(*dg), GFP_KERNEL);
	r = kvcalloc(m->bus.n_slaves + 1, sizeof(*r), GFP_KERNEL);
	if (!dg || !r)
		goto out;
	for (i = 0; i < m->bus.n_slaves; i++) {
		r[i].reads = READ_ONCE(m->bus.slaves[i]->al.reads);
		dg[i] = EC_FPRD(m->bus.slaves[i]->station, EC_REG_AL_STATUS, 6, r[i].al);
	}
	ec_xfer(&m->links, dg, m->bus.n_slaves);
	for (i = 0; i < m->bus.n_slaves; i++) {
		struct ec_slave *s = m->bus.slaves[i];
		u16 status = get_unaligned_le16(r[i].al), code = get_unaligned_le16(r[i].al + 4);

		if (!dg[i].err && !dg[i].wkc && READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED)
			all = false;
		if (w->held)
			note_reply(w, s, &dg[i]);
		if (dg[i].err || dg[i].wkc != 1)
			continue;
		/* its worker knows better */
		if (ec_slave_busy(s) || READ_ONCE(s->al.reads) != r[i].reads)
			continue;
		note_change(s, status, code);
		if (ec_identify_is_due(s))
			ec_slave_kick(s);
		if (ec_survey_is_off(s, status))
			ec_slave_kick(s);
	}
out:
	kvfree(dg);
	kvfree(r);
	return all;
}

/* All slaves in their requested state, none with an error, all of them replied? */
static bool as_wanted(const struct ec_survey *sv, u16 ored, u16 wkc)
{
	return !sv->differ && ored == sv->state && wkc >= sv->replying;
}

/*
 * The count of a reply. One above the limit, which is logged once, says nothing: the count stays
 * what it was.
 */
static unsigned int believable(struct watch *w, unsigned int count)
{
	unsigned int limit = ec_scan_limit();

	if (count <= limit) {
		w->too_many = 0;
		return count;
	}
	if (!w->too_many)
		ec_warn(w->m,
			"a reply reports %u slaves, limit %u by memory; not scanned: check the cables and the last slave\n",
			count, limit);
	w->too_many = count;
	return w->count;
}

static void set_rider(struct ec_rider *r, const struct ec_dg *dg)
{
	r->cmd = dg->cmd;
	r->adp = dg->adp;
	r->ado = dg->ado;
	r->len = dg->len;
	memset(r->data, 0, dg->len);
}

/* Slaves that have not changed need no look. */
static void survey(struct watch *w)
{
	/* the count before the slaves */
	u32 changes = atomic_read_acquire(&w->m->bus.changes);
	u64 now = ktime_get_ns();

	if (w->survey_ns && changes == w->changes && ec_survey_lasts(&w->survey) &&
	    now - w->survey_ns < EC_SURVEY_NS)
		return;
	w->changes = changes;
	w->survey_ns = now;
	ec_survey(&w->m->bus, &w->survey);
}

/*
 * AL status and number of all slaves. The first try is a rider if the cycle carries it; after
 * the loss of that frame only a frame of its own shows whether slaves respond.
 */
static int broadcast(struct watch *w, struct ec_dg *dg, bool first)
{
	struct ec_master *m = w->m;
	struct ec_rider *r = &m->rider;
	int ret = -EAGAIN;

	/* only a frame of its own shows which link's copy has passed which slaves */
	if (first && READ_ONCE(m->links.only) && ec_access_is_cyclic(&m->links.access) &&
	    ktime_get_ns() >= w->alone_ns) {
		set_rider(r, dg);
		ret = ec_rider_exchange(&m->riders, r);
		if (ret == -EAGAIN)
			w->alone_ns = ktime_get_ns() + ALONE_NS;
	}
	if (ret == -EAGAIN)
		return ec_xfer_urgent(&m->links, dg, 1);
	dg->wkc = r->wkc;
	dg->back = r->back;
	dg->irq = r->irq;
	memcpy(dg->data, r->data, dg->len);
	return ret;
}

static void set_present(struct ec_master *m, unsigned int count, u32 al_states)
{
	WRITE_ONCE(m->bus.responding, count);
	WRITE_ONCE(m->bus.al_states, al_states);
	ec_links_saw(&m->links, count, al_states);
}

static void ask_slaves(struct watch *w)
{
	struct ec_master *m = w->m;
	unsigned int count = 0, try;
	bool lost = true;
	u8 al[2] = { 0, 0 };
	struct ec_dg dg = EC_DG(EC_CMD_BRD, 0, EC_REG_AL_STATUS, 2, al);
	u16 ored = 0, wkc = 0;

	dg.repeat = false;
	for (try = 0; try < TRIES && w->link_up; try++) {
		int ret = broadcast(w, &dg, !try);

		if (ret == -EBUSY || ret == -ENOMEM)
			return;		/* nothing was sent, so nothing is known */
		if (ret || !ec_scan_see_ring(&m->bus, &dg, try + 1 == TRIES))
			continue;
		lost = false;
		count = believable(w, dg.back);
		wkc = dg.wkc;
		ored = get_unaligned_le16(al);
		w->irq = dg.irq;
		break;
	}
	if (lost && w->link_up && ec_ring_exit_close(&m->bus))
		return;
	/* frames that do not return say nothing of the slaves, unless that lasts */
	w->lost_ns = !lost ? 0 : w->lost_ns ?: ktime_get_ns();
	if (lost && READ_ONCE(m->bus.guarded) && w->link_up &&
	    ktime_get_ns() - w->lost_ns < LOST_NS) {
		ec_swallowed(&m->bus);
		return;
	}
	set_present(m, count, ored & EC_AL_STATE_MASK);
	if (count != w->count) {
		if (w->scanned)
			ec_report(m->base, EC_EVENT_RESPONDING, count, w->count);
		w->count = count;
		w->same = 0;
		w->scanned = false;
		w->moving_ns = w->moving_ns ?: ktime_get_ns();
	} else {
		w->same++;
	}
	if (w->scanned && count && !w->held &&
	    (m->bus.front != m->links.ring.front ||
	     (ec_ring_break_is_news(&m->bus) && !ec_dc_busy(&m->dc))))
		scan_next(w);
	survey(w);
	if (w->scanned && count && wkc >= w->survey.replying)
		m->bus.complete_ns = ktime_get_ns();
	w->well = w->scanned && as_wanted(&w->survey, ored, wkc);
	if (w->held) {
		w->silent = 0;
		w->well = w->well && !w->survey.silent;
		if (!w->well)
			check_slaves(w);
		return;
	}
	/* also while a contact bounces somewhere: the others are looked after */
	if (w->well || !count || check_slaves(w) || !w->scanned)
		w->silent = 0;
	else
		w->silent++;
	/* power was off for a moment: address and state are lost */
	if (w->silent >= SILENT_LOOKS) {
		ec_report(m->base, EC_EVENT_NO_ANSWER, SILENT_LOOKS);
		w->silent = 0;
		scan_next(w);
	}
}

/* The rider of the last look has returned: all slaves reply, each in its requested state. */
static bool all_well(struct watch *w)
{
	struct ec_master *m = w->m;
	const struct ec_rider *r = &m->rider;
	u16 ored;

	if (!w->riding)
		return false;
	w->riding = false;
	if (ec_rider_end(&m->rider) || READ_ONCE(m->links.ring.news) || !w->scanned ||
	    !w->link_up || r->back != w->count)
		return false;
	ored = get_unaligned_le16(r->data);
	survey(w);
	if (!as_wanted(&w->survey, ored, r->wkc))
		return false;
	/* the last slave may have come to its state since the last look */
	set_present(m, w->count, ored & EC_AL_STATE_MASK);
	m->bus.complete_ns = w->ride_ns;
	w->irq = r->irq;
	w->well = true;
	return true;
}

/* While all is well no look waits for its reply: the next one takes it. */
static void ride(struct watch *w)
{
	struct ec_master *m = w->m;
	struct ec_access *a = &m->links.access;

	if (!w->scanned || !w->link_up || w->silent || !ec_access_is_cyclic(a) ||
	    2 * ec_access_interval_us(a) > PERIOD_MS * USEC_PER_MSEC)
		return;
	w->ride_ns = ktime_get_ns();
	if (w->ride_ns < w->alone_ns)
		return;
	set_rider(&m->rider, &EC_DG(EC_CMD_BRD, 0, EC_REG_AL_STATUS, 2, NULL));
	ec_rider_begin(&m->riders, &m->rider);
	w->riding = true;
}

/* Has the bus slaves that the monitor polls now? */
static bool looks_after_list(const struct watch *w)
{
	return w->scanned || w->held || (w->count && w->m->bus.n_slaves);
}

/*
 * A port has got or lost its link: slaves may have changed although their number has not. One that
 * shows the event all the time is ignored.
 */
static void monitor_note_ports(struct watch *w)
{
	u64 now = ktime_get_ns(), due = 0;
	bool event = w->irq & EC_ECAT_EVENT_DL;

	if (!event)
		w->dl_stays = 0;
	if (event && w->dl_stays < STAYS)
		due = PORTS_NS;
	else if (event && READ_ONCE(w->m->bus.guarded))
		due = UNASKED_NS;
	if (!due || !w->scanned || w->held || now - w->ports_ns < due ||
	    READ_ONCE(w->m->links.ring.measured))
		return;
	w->dl_stays += event;
	w->ports_ns = now;
	if (ec_scan_worth(&w->m->bus, event))
		scan_next(w);
}

static void note_held(struct watch *w)
{
	bool held = READ_ONCE(w->m->bus.held);

	if (held && !w->held)
		ec_for_each_slave(s, &w->m->bus)
			s->reply.missed = 0;
	w->held = held;
}

static void monitor_count_slaves(struct watch *w)
{
	note_held(w);
	w->irq = 0;
	w->well = false;
	if (w->woken && w->riding) {
		/* it may have passed before the event */
		w->riding = false;
		ec_rider_end(&w->m->rider);
	}
	ec_scan_look_at_mute(&w->m->bus);
	if (!all_well(w))
		ask_slaves(w);
	w->stays = w->irq & EC_ECAT_EVENT_AL ? w->stays + w->woken : 0;
	monitor_note_ports(w);
	ride(w);
	if (looks_after_list(w) && w->link_up)
		w->survey.exchange |= ec_mailboxes_look(&w->m->bus, w->irq);
}

/*
 * While all is well, an event in a frame of the cycle wakes the monitor, once between two looks in
 * turn: a slave that shows one without end costs no more than another look.
 */
static void watch_events(struct watch *w)
{
	struct ec_master *m = w->m;

	w->watched = 0;
	if (w->riding && w->well && !w->woken) {
		w->watched = ec_mailboxes_watch(&m->bus, w->survey.exchange);
		if (w->stays < STAYS)
			w->watched |= EC_ECAT_EVENT_AL;
		if (w->dl_stays < STAYS)
			w->watched |= EC_ECAT_EVENT_DL;
	}
	WRITE_ONCE(m->links.events, w->watched);
}

/*
 * What failed is tried again with growing distance. One that replies to its ring position
 * is scanned, unless the list is held: another slave may be there then. One that was lost on
 * its way to its state is brought there.
 */
static void monitor_try_again(struct watch *w)
{
	struct ec_master *m = w->m;
	struct ec_slave *due[16];
	u8 b[ARRAY_SIZE(due)][2];
	struct ec_dg dg[ARRAY_SIZE(due)];
	u64 now = ktime_get_ns();
	unsigned int i, n = 0;

	if (!looks_after_list(w))
		return;
	ec_for_each_slave(s, &m->bus) {
		if (n == ARRAY_SIZE(due))
			break;
		if (!ec_survey_is_due(s, now))
			continue;
		if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED || READ_ONCE(s->reply.silent)) {
			if (w->held)
				continue;
			dg[n] = EC_DG(EC_CMD_APRD, (u16)-s->position, EC_REG_STATION, 2, b[n]);
			due[n++] = s;
		} else if (!ec_slave_busy(s)) {
			/* the worker plans the next one, if it has to */
			ec_write64(&s->reply.retry_ns, 0);
			ec_slave_kick(s);
		}
	}
	if (!n || ec_xfer_urgent(&m->links, dg, n))
		return;
	for (i = 0; i < n; i++) {
		if (dg[i].wkc == 1)
			scan_next(w);
		else
			ec_slave_retry(due[i], EC_PROBE_MAX_MS);
	}
}

/* Slaves that were let in are found at once. */
static void look_at_ports(struct watch *w)
{
	enum ec_ports_result result = EC_PORTS_QUIET;
	int count;

	if (w->link_up && w->count)
		result = ec_ports_work(&w->m->bus, w->scanned && w->count == w->m->bus.n_slaves,
				       w->irq & EC_ECAT_EVENT_DL);
	w->door = result != EC_PORTS_QUIET;
	if (result != EC_PORTS_FOUND)
		return;
	count = ec_scan_count(&w->m->bus);
	if (count > 0 && believable(w, count)) {
		w->count = count;
		WRITE_ONCE(w->m->bus.responding, count);
		scan_next(w);
	}
}

static void maybe_scan(struct watch *w)
{
	struct ec_master *m = w->m;
	struct ec_scan_result result = { 0 };
	bool asked = false;

	ec_owed_pay(&m->bus);
	/* one that is due, or asked for, has to wait */
	if (READ_ONCE(m->bus.held))
		return;
	if (READ_ONCE(m->bus.rescan) || xchg(&m->bus.renew, false) ||
	    ec_doubt_is_due(&m->bus) || (w->scanned && READ_ONCE(m->bus.due)))
		scan_next(w);
	if (w->scanned || (w->same < STABLE_LOOKS &&
			   !(w->moving_ns && ktime_get_ns() - w->moving_ns >= MOVING_NS)))
		return;
	w->moving_ns = 0;
	WRITE_ONCE(m->bus.scan_index, 0);
	WRITE_ONCE(m->bus.scan_slaves, w->count);
	/* a reader that sees the scan sees its numbers */
	smp_wmb();
	/* an application may have reserved the master just now */
	if (!ec_bus_begin_scan(&m->bus))
		return;
	if (READ_ONCE(m->bus.rescan)) {
		/*
		 * Forget what is known, so that everything is read again; not while
		 * an application uses it, even one whose cycle has timed out. A reader
		 * sees the scan before the request for it is cleared.
		 */
		smp_wmb();
		WRITE_ONCE(m->bus.rescan, false);
		asked = true;
		ec_known_forget_images(&m->bus);
		if (READ_ONCE(m->links.access.mode) == EC_ACCESS_DIRECT &&
		    !READ_ONCE(m->sessions.session))
			ec_scan(&m->bus, 0, &result);
		ec_absent_forget(&m->bus);
	}
	if (!ec_scan(&m->bus, w->count, &result)) {
		w->scanned = !result.again;
		w->same = result.again ? 0 : w->same;
		/* a reservation waits for the next one */
		WRITE_ONCE(m->bus.due, result.again || result.unsure);
		WRITE_ONCE(m->bus.scan_count, m->bus.scan_count + 1);
		w->scanned_ns = ktime_get_ns();
		/* the ports are proven to be as the scan has found them */
		w->path = ec_dc_path(&m->dc);
		WRITE_ONCE(m->dc.path_scanned, w->path);
		/* before their workers ask for their clocks; delays are measured again on demand */
		if (result.changed || asked)
			WRITE_ONCE(m->dc.changed, true);
		ec_session_attach(&m->sessions);
		if (!READ_ONCE(m->cycles.active))
			ec_dc_measure(&m->dc);
		if (!result.again)
			ec_doubt_judge(&m->bus, result.changed, !READ_ONCE(m->cycles.active) &&
				       ec_dc_is_contradicted(&m->dc));
		ec_slave_want_states(&m->bus);
	} else {
		w->same = 0;
	}
	ec_dc_look_behind(&m->dc, NULL);
	w->survey_ns = 0;
	WRITE_ONCE(m->bus.scan_busy, false);
	ec_bus_settled(&m->bus);
}

/*
 * Reading PDOs takes many mailbox exchanges; the way to PREOP comes first. One
 * slow slave does not hold up the others for long.
 */
static void read_pdos(struct watch *w)
{
	struct ec_master *m = w->m;
	bool busy = false;

	ec_for_each_slave(s, &m->bus)
		busy |= ec_slave_busy(s);
	if (!looks_after_list(w) || (busy && ktime_get_ns() - w->scanned_ns < NSEC_PER_SEC))
		return;
	ec_for_each_slave(s, &m->bus) {
		if (!ec_slave_pdos_pending(s) || ec_slave_busy(s))
			continue;
		WRITE_ONCE(s->pdos.wanted, true);
		ec_slave_kick(s);
	}
}

/* While nothing else is to be done. */
static void count_line_errors(struct watch *w)
{
	bool event = w->irq & EC_ECAT_EVENT_DL && w->dl_stays < STAYS;

	if (w->scanned && w->link_up && !w->survey.chores)
		ec_line_errors_look(&w->m->bus, event);
}

/* No link and no known slaves: this completes a requested scan. */
static void no_slaves(struct ec_master *m)
{
	set_present(m, 0, 0);
	if (!READ_ONCE(m->bus.rescan) || READ_ONCE(m->bus.held))
		return;
	WRITE_ONCE(m->bus.rescan, false);
	WRITE_ONCE(m->bus.scan_count, m->bus.scan_count + 1);
	WRITE_ONCE(m->bus.looked, true);
	ec_bus_settled(&m->bus);
}

/* The computer sleeps: no frame until it has resumed. */
static void stand_still(struct ec_master *m)
{
	WRITE_ONCE(m->paused, true);
	ec_bus_settled(&m->bus);
	for (;;) {
		set_current_state(TASK_IDLE);
		if (kthread_should_stop() || !READ_ONCE(m->pause))
			break;
		schedule();
	}
	__set_current_state(TASK_RUNNING);
	WRITE_ONCE(m->paused, false);
}

/*
 * Until the next look, or what wakes the monitor. While all is well the timer may expire together
 * with that of the cycle: an interrupt of its own costs as much as a look.
 */
static void quiet_sleep(struct watch *w)
{
	struct ec_quiet *q = &w->quiet;
	bool quiet = w->riding && w->well && !w->woken && !w->door;
	unsigned int ms = w->same < STABLE_LOOKS ? BOUNCE_MS : PERIOD_MS;

	if (quiet) {
		q->count = w->count;
		q->survey = &w->survey;
		q->changes = w->changes;
		q->event = w->event;
		/* an event that stays is no news */
		q->events = EC_ECAT_EVENT_SM(1) |
			    (w->watched & (EC_ECAT_EVENT_AL | EC_ECAT_EVENT_DL));
		q->until_ns = w->rates_ns + NSEC_PER_SEC;
		q->ride_ns = w->ride_ns;
		ms -= SLACK_MS;
		ec_quiet_allow(q);
	}
	ec_quiet_sleep(q, ms_to_ktime(ms), quiet ? SLACK_MS * NSEC_PER_MSEC : 0);
	if (quiet)
		w->ride_ns = q->ride_ns;
}

/* Ports have changed, but no slave has: the delays are as before. */
static void note_path(struct watch *w)
{
	struct ec_dc *dc = &w->m->dc;
	bool event = w->irq & EC_ECAT_EVENT_DL && w->dl_stays < STAYS;

	ec_dc_armw_locate(dc, w->scanned && !event, w->path);
	if (w->scanned && !event && !READ_ONCE(dc->changed) && ec_dc_delays_written(dc))
		ec_dc_path_is_known(dc, w->path);
}

static int monitor(void *data)
{
	struct watch w = { .m = data };
	struct ec_master *m = w.m;
	bool idle;

	ec_quiet_init(&w.quiet, m);
	WRITE_ONCE(m->carry.monitor, current);
	while (!kthread_should_stop()) {
		if (READ_ONCE(m->pause))
			stand_still(m);
		w.path = ec_dc_path(&m->dc);
		check_links(&w);
		if (READ_ONCE(m->links.access.mode) == EC_ACCESS_CYCLIC &&
		    ec_access_timed_out(&m->links))
			ec_access_timeout(&m->links);
		if (w.link_up || m->bus.n_slaves) {
			monitor_count_slaves(&w);
			idle = w.well && !w.survey.chores;
			if (!idle)
				monitor_try_again(&w);
			look_at_ports(&w);
			maybe_scan(&w);
			if (!idle)
				read_pdos(&w);
			count_line_errors(&w);
		} else {
			no_slaves(m);
		}
		if (w.scanned || !w.link_up)
			WRITE_ONCE(m->bus.looked, true);
		ec_bus_settled(&m->bus);
		if (w.scanned && xchg(&m->bus.regroup, false))
			ec_session_attach(&m->sessions);
		ec_session_status(&m->sessions, w.scanned);
		note_path(&w);
		ec_pending_flush(&m->bus, false);
		ec_event_log(m->base, &w.event);
		ec_log_flush(m->base, false);
		ec_event_readers_kick(m);
		ec_slave_devices_kick(&m->slave_devices);
		ec_eoe_look(&m->eoe);
		set_current_state(TASK_IDLE);
		watch_events(&w);
		if (!kthread_should_stop() && !READ_ONCE(m->pause) &&
		    (!READ_ONCE(m->bus.rescan) || READ_ONCE(m->bus.held)))
			quiet_sleep(&w);
		__set_current_state(TASK_RUNNING);
		w.woken = w.watched && !READ_ONCE(m->links.events);
	}
	if (w.riding)
		ec_rider_end(&m->rider);
	ec_quiet_exit(&w.quiet);
	ec_ports_open_all(&m->bus);
	return 0;
}

/**
 * ec_monitor_start() - start watching the bus
 * @m: master
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno.
 */
int ec_monitor_start(struct ec_master *m)
{
	struct task_struct *t = kthread_run(monitor, m, "EtherCAT%u", m->base->index);

	if (!IS_ERR(t))
		m->monitor = t;
	return PTR_ERR_OR_ZERO(t);
}

/**
 * ec_monitor_stop() - stop watching
 * @m: master, @stopping set
 *
 * Context: Process. May sleep.
 */
void ec_monitor_stop(struct ec_master *m)
{
	struct task_struct *t = m->monitor;

	/* ec_monitor_kick() must not find it once it has ended */
	WRITE_ONCE(m->monitor, NULL);
	if (t)
		kthread_stop(t);
	WRITE_ONCE(m->carry.monitor, NULL);
}

/**
 * ec_monitor_kick() - wake the monitor for its next look
 * @m: master
 *
 * Context: Any.
 */
void ec_monitor_kick(struct ec_master *m)
{
	struct task_struct *t;

	/* it is not freed before the section ends */
	rcu_read_lock();
	t = READ_ONCE(m->monitor);
	if (t)
		wake_up_process(t);
	rcu_read_unlock();
}
