// SPDX-License-Identifier: GPL-2.0-only
/*
 * Propagation delays. Those of a closed ring stay while it is open: they are the way of frames of
 * the main device, and no such frame passes the slaves behind the break. What is unknown there is
 * measured by frames of the backup device, which pass these slaves in the same order; only how
 * much earlier or later they arrive, compared with the other side, cannot be measured. The master
 * then takes it that the cables of both devices are equal, as their sends are.
 */
#include <linux/ktime.h>
#include "dc_delays.h"
#include "dc_job.h"

#define ROUNDS		16	/* latches; the times have 10 ns of noise */
#define HELD_ROUNDS	8	/* while clocks that are set wait for the delays */
#define TOGETHER	4	/* latches in a row while clocks that are set drift apart */
#define CORRECT_CYCLES	8	/* then the cycle compensates them, so many cycles */
#define CORRECT_MS	20	/* or so long */
#define LOST		16	/* lost latches, then the measurement fails */
#define EXIT_NS		(300 * NSEC_PER_MSEC)	/* a port closed for a second is closed again */
#define EXIT_MAX_NS	(900 * NSEC_PER_MSEC)	/* it may have opened itself */
#define ESTIMATED	U64_MAX	/* as ec_clock.measured_after: valid until the ring is closed */

static void sum_up(struct ec_dc_job *j)
{
	unsigned int i;

	ec_dc_compute(j);
	for (i = 0; i < j->n; i++)
		j->sum[i] += (s32)j->nodes[i].delay;
}

/*
 * In a closed ring no frame returns to the ports through which it has left. So while delays are
 * measured the last port before the backup device is closed: frames turn there. The setting is
 * temporary: if the ring breaks meanwhile, no frame reaches this slave before the port has opened
 * itself.
 */
static void close_exit(struct ec_dc_job *j, bool close)
{
	const struct ec_slave *s = j->slaves[j->exit];
	u8 control[2];
	struct ec_dg dg = EC_FPWR(s->station, EC_REG_DL_CONTROL, sizeof(control), control);

	control[0] = s->ports.control & ~EC_DL_TEMPORARY;
	control[1] = s->ports.loops;
	if (close) {
		control[0] |= EC_DL_TEMPORARY;
		control[1] |= EC_LOOP_CLOSED << 2 * j->exit_port;
	}
	if (!ec_xfer(j->dc->links, &dg, 1))
		j->exit_ns = dg.sent_ns;
}

/*
 * Closes or opens it, and clears the event of that by a read of the ports, which would cause
 * another scan: in a frame of its own, since a slave may change its ports behind the first one.
 */
static void turn_exit(struct ec_dc_job *j, bool close)
{
	u8 dl[2];

	close_exit(j, close);
	ec_xfer_fprd(j->dc->links, j->slaves[j->exit]->station, EC_REG_DL_STATUS, dl, sizeof(dl));
}

/* before it opens itself */
static void keep_exit_closed(struct ec_dc_job *j)
{
	if (j->exit < j->n && ktime_get_ns() - j->exit_ns > EXIT_NS)
		close_exit(j, true);
}

/* Has a frame that left now turned at the exit? */
static bool exit_was_closed(const struct ec_dc_job *j, u64 sent_ns)
{
	return j->exit == j->n || sent_ns - j->exit_ns < EXIT_MAX_NS;
}

/*
 * The receive times of a latch are read in the transfer of the next one: by then the frame has
 * passed all ports.
 */
static int measure_rounds(struct ec_dc_job *j)
{
	unsigned int rounds = 0, lost = 0, n;
	bool latched = false;
	int ret;

	j->rounds = j->compensated && ec_dc_path_changed(j->dc) ? HELD_ROUNDS : ROUNDS;
	memset(j->sum, 0, j->n * sizeof(*j->sum));
	memset(j->silent, 0, j->n * sizeof(*j->silent));
	while (rounds < j->rounds) {
		if (ec_dc_job_ended(j))
			return -ECANCELED;
		keep_exit_closed(j);
		n = latched ? ec_dc_add(j, 0, EC_DC_TIMES, EC_CMD_FPRD, EC_REG_DC_RECV(0),
					sizeof(j->recv[0]), j->recv[0], sizeof(j->recv[0])) : 0;
		n = ec_dc_add_latch(j, n);
		ret = ec_dc_once(j, n);
		if (ret && ret != -ETIMEDOUT && ret != -EBUSY)
			return ret;
		if (ret && ++lost > LOST)
			return ret;
		if (latched)
			ret = ec_dc_answers(j, 0, EC_DC_TIMES);
		if (ret == -EAGAIN)
			return ret;
		if (latched && !ret) {
			sum_up(j);
			rounds++;
			if (j->compensated && rounds < j->rounds && rounds % TOGETHER == 0 &&
			    !ec_dc_path_changed(j->dc))
				ec_dc_correct_between(j, CORRECT_CYCLES, CORRECT_MS);
		}
		latched = !j->dg[n - 1].err && exit_was_closed(j, j->dg[n - 1].sent_ns);
		if (!latched && !j->dg[n - 1].err && ++lost > LOST)
			return -ETIMEDOUT;
	}
	return 0;
}

/* Is a ring what the list of slaves says? Else a scan follows. */
static bool ring_is_as_listed(const struct ec_dc_job *j)
{
	const struct ec_ring *r = &j->dc->links->ring;

	return j->dc->links->only ||
	       (READ_ONCE(r->state) == j->ring && READ_ONCE(r->front) == j->front);
}

/* An open ring may break once more, or heal. In it each delay is measured once for all. */
static int measure_open(struct ec_dc_job *j)
{
	u32 path = ec_dc_path(j->dc);
	int ret = measure_rounds(j);

	if (ret || j->dc->links->only)
		return ret;
	return ring_is_as_listed(j) && ec_dc_path(j->dc) == path ? 0 : -EAGAIN;
}

static int dc_job_measure(struct ec_dc_job *j)
{
	struct ec_ring *r = &j->dc->links->ring;
	int ret;

	if (!ring_is_as_listed(j))
		return -EAGAIN;
	if (j->ring != EC_RING_CLOSED)
		return measure_open(j);
	/* its last slave was not read: nothing turns the frames */
	if (j->exit == j->n)
		return -EAGAIN;
	/* to the monitor it is as before */
	WRITE_ONCE(r->measured, true);
	turn_exit(j, true);
	ret = measure_rounds(j);
	turn_exit(j, false);
	WRITE_ONCE(r->measured, false);
	return ret;
}

static u64 device_before(const struct ec_dc_job *j, unsigned int i)
{
	return i ? j->slaves[i - 1]->device : 0;
}

static bool is_first_behind(const struct ec_dc_job *j, unsigned int i)
{
	return j->nodes[i].other && (!i || !j->nodes[i - 1].other);
}

/*
 * Does a delay stay valid? A ring that opens and closes changes no way in it, and cannot be
 * measured while it runs without opening it: there a delay is valid as long as the slave is behind
 * the same one, or has none before it.
 */
static bool delay_stays(const struct ec_dc_job *j, unsigned int i, u32 scan)
{
	const struct ec_clock *c = ec_job_clock(j, i);

	if (j->dc->links->only)
		return c->measured == scan;
	if (!c->measured)
		return false;
	if (c->measured_after == ESTIMATED)
		return j->ring == EC_RING_OPEN;
	return is_first_behind(j, i) || c->measured_after == device_before(j, i);
}

/* Delays that stay are counted from the present reference clock. */
static void rebase(struct ec_dc_job *j, u32 scan)
{
	u32 zero = delay_stays(j, j->ref, scan) ? ec_job_clock(j, j->ref)->delay : 0;
	unsigned int i;

	/* also of excluded slaves: their clocks may be set again */
	for (i = 0; zero && i < j->n; i++)
		if (delay_stays(j, i, scan))
			ec_job_clock(j, i)->delay -= zero;
}

/*
 * Is it to be known how much later frames reach the clocks on the other side of a break? Clocks
 * that are set there show it.
 */
static bool needs_shift(const struct ec_dc_job *j)
{
	if (!j->worker || j->shifted || !ec_dc_has_clocks(j, false, false) ||
	    !ec_dc_has_clocks(j, true, false))
		return false;
	return !ec_dc_has_clocks(j, false, true) || !ec_dc_has_clocks(j, true, true);
}

/* Do all delays stay valid? */
static bool known(struct ec_dc_job *j, u32 scan)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (j->nodes[i].dc && !delay_stays(j, i, scan))
			return false;
	return !needs_shift(j);
}

static u32 dc_delays_mean(const struct ec_dc_job *j, unsigned int i)
{
	return (u32)div_s64(j->sum[i], j->rounds);
}

/* The delays that stay keep their values: how much more was measured on this side? */
static bool measured_more(const struct ec_dc_job *j, bool other, u32 scan, s32 *more)
{
	unsigned int i, n = 0;
	s64 sum = 0;

	for (i = 0; i < j->n; i++)
		if (j->nodes[i].dc && j->nodes[i].other == other && delay_stays(j, i, scan)) {
			sum += (s32)(dc_delays_mean(j, i) - ec_job_clock(j, i)->delay);
			n++;
		}
	*more = n ? (s32)div_s64(sum, n) : 0;
	return n;
}

/* Take what was measured on one side of a break, or all. */
static void take_side(struct ec_dc_job *j, bool other, u32 scan)
{
	bool apart = other != j->nodes[j->ref].other, keeps = other || apart, stays;
	unsigned int i;
	s32 more = 0;

	stays = keeps && measured_more(j, other, scan, &more);
	if (apart) {
		j->shift = more;
		j->shifted = true;
	}
	for (i = 0; i < j->n; i++) {
		struct ec_clock *c = ec_job_clock(j, i);

		if (!j->nodes[i].dc || j->nodes[i].other != other ||
		    (keeps && delay_stays(j, i, scan)))
			continue;
		c->delay = dc_delays_mean(j, i) - more;
		c->prev_delay = j->nodes[i].hop;
		c->measured = scan;
		c->measured_after = device_before(j, i);
		if ((apart && !stays) || (i && is_first_behind(j, i)))
			c->measured_after = ESTIMATED;
		WRITE_ONCE(c->delay_unreliable, j->nodes[i].unreliable);
	}
}

/**
 * ec_dc_get_delays() - get the propagation delays of all slaves
 * @j: job with a reference clock
 *
 * They are measured once after each scan, in a ring once for all. Sets @j->shift where it is
 * needed.
 *
 * Context: Process, dc.lock held. Waits for bus traffic.
 * Return: 0; -EAGAIN when slaves do not answer; -ECANCELED when the worker is to stop; or as
 * ec_xfer().
 */
int ec_dc_get_delays(struct ec_dc_job *j)
{
	u32 scan = ec_dc_scan(j);
	int ret;

	lockdep_assert_held(&j->dc->lock);
	rebase(j, scan);
	if (known(j, scan))
		return 0;
	ret = dc_job_measure(j);
	if (ret)
		return ret;
	take_side(j, false, scan);
	take_side(j, true, scan);
	/* one that was new behind the break */
	rebase(j, scan);
	return 0;
}
