// SPDX-License-Identifier: GPL-2.0-only
/* The slaves whose clocks are set, the reference clock, and latches of their times. */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "../bus/graph.h"
#include "dc_job.h"

/**
 * ec_dc_job_free() - end a job
 * @j: job
 *
 * Context: Process. May sleep.
 */
void ec_dc_job_free(struct ec_dc_job *j)
{
	unsigned int i;

	for (i = 0; j->slaves && i < j->n; i++)
		if (j->slaves[i])
			ec_slave_unref(j->slaves[i]);
	kvfree(j->slaves);
	kvfree(j->nodes);
	kvfree(j->recv);
	kvfree(j->unit);
	kvfree(j->sum);
	kvfree(j->dg);
	kvfree(j->spoiled);
	kvfree(j->silent);
}

static bool dc_job_has_times(const struct ec_slave *s)
{
	return ec_slave_features(s) & EC_FEAT_DC &&
	       READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED;
}

static bool is_clock(const struct ec_dc_job *j, unsigned int i)
{
	return j->nodes[i].dc && !READ_ONCE(j->slaves[i]->delay_only);
}

static void fill_node(struct ec_dc_job *j, unsigned int i)
{
	const struct ec_slave *s = j->slaves[i], *up = ec_graph_parent(s);
	struct ec_dc_node *n = &j->nodes[i];
	int exit = j->ring == EC_RING_CLOSED ? ec_graph_free_port(s) : -1;

	lockdep_assert_held(&j->dc->bus->topo);
	n->parent = up ? up->position : EC_DC_NONE;
	n->entry = s->graph.upstream;
	n->other = ec_graph_is_reversed(s);
	n->dc = dc_job_has_times(s);
	n->parent_port = up ? s->graph.parent_port : 0;
	n->open = ec_graph_open_ports(s->dl_status);
	if (exit >= 0) {
		j->exit = i;
		j->exit_port = exit;
		n->open &= ~BIT(exit);
	}
}

/*
 * Behind a break frames come from the backup device: by a port that leads to no slave, and from
 * there on to the first slave behind the break.
 */
static void dc_job_turn(struct ec_dc_job *j)
{
	s32 parent = EC_DC_NONE;
	int entry = -1, at = 0;
	const struct ec_slave *s;
	unsigned int i;

	lockdep_assert_held(&j->dc->bus->topo);
	for (i = j->n; i && j->nodes[i - 1].other && entry < 0; i--)
		entry = ec_graph_free_port(j->slaves[i - 1]);
	if (entry < 0) {
		/* without such a port nothing can be measured there */
		for (i = 0; i < j->n; i++)
			j->nodes[i].dc &= !j->nodes[i].other ||
					  (ec_clock_is_set(j->slaves[i]) &&
					   ec_job_clock(j, i)->measured);
		return;
	}
	for (s = j->slaves[i]; s; s = ec_graph_parent(s)) {
		struct ec_dc_node *n = &j->nodes[s->position];

		n->entry = entry;
		n->parent = parent;
		n->parent_port = at;
		parent = s->position;
		at = s->graph.upstream;
		entry = s->graph.parent_port;
	}
}

/**
 * ec_dc_chosen() - does a slave belong to a group?
 * @j: job
 * @i: index of the slave
 * @who: group
 *
 * Context: Process.
 * Return: whether it does.
 */
bool ec_dc_chosen(const struct ec_dc_job *j, unsigned int i, enum ec_dc_who who)
{
	const struct ec_slave *s = j->slaves[i];
	bool wide = ec_slave_features(s) & EC_FEAT_DC64;

	if (who == EC_DC_TIMES)
		return j->nodes[i].dc;
	if (!is_clock(j, i) || who == EC_DC_CLOCKS)
		return is_clock(j, i);
	return !ec_clock_is_set(s) && (who == EC_DC_NEW || wide == (who == EC_DC_NEW_WIDE));
}

/**
 * ec_dc_count() - count the slaves of a group
 * @j: job
 * @who: group
 *
 * Context: Process.
 * Return: how many.
 */
unsigned int ec_dc_count(const struct ec_dc_job *j, enum ec_dc_who who)
{
	unsigned int i, n = 0;

	for (i = 0; i < j->n; i++)
		n += ec_dc_chosen(j, i, who);
	return n;
}

/* The clock with this station address, or the first one; @n: there is none. */
static unsigned int dc_job_find(const struct ec_dc_job *j, u16 station)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (is_clock(j, i) &&
		    (station == EC_DC_ANY || j->slaves[i]->station == station))
			break;
	return i;
}

/**
 * ec_dc_can_be() - does the bus have a clock that can be the reference?
 * @dc: clocks
 * @choice: station address of the reference clock, or EC_DC_ANY...
 *
 * Context: Process. May sleep.
 * Return: whether it has one.
 */
bool ec_dc_can_be(struct ec_dc *dc, u16 choice)
{
	bool ret = false;
	unsigned int i;

	down_read(&dc->bus->topo);
	for (i = 0; i < dc->bus->n_slaves && !ret; i++)
		ret = dc_job_has_times(dc->bus->slaves[i]) &&
		      ec_slave_has_clock(dc->bus->slaves[i]) &&
		      (choice == EC_DC_ANY || dc->bus->slaves[i]->station == choice);
	up_read(&dc->bus->topo);
	return ret;
}

static bool any_set(const struct ec_dc_job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (ec_clock_is_set(j->slaves[i]))
			return true;
	return false;
}

/*
 * The configured reference clock; else the one that others are synchronized to, so that a
 * slave that connects upstream of it changes nothing; else the first one, even with 32 bits,
 * since clocks upstream of the reference get no time from it. When the configured one is
 * lost, another clock substitutes it. When it was absent from the start, no clock is set; but in an
 * open ring it may be what the break has cut off, and SYNC that is started without a clock would
 * have to be started again when the ring closes.
 */
static void choose(struct ec_dc_job *j)
{
	u16 choice = READ_ONCE(j->dc->choice);
	bool waits = choice == EC_DC_NOBODY && j->ring == EC_RING_OPEN && !j->dc->links->only;

	j->ref = j->n;
	if (choice != EC_DC_ANY) {
		j->ref = dc_job_find(j, choice);
		if (j->ref == j->n && !waits && !any_set(j))
			return;
	}
	if (j->ref == j->n)
		j->ref = dc_job_find(j, j->followed);
}

/**
 * ec_dc_job_init() - begin a job with the present slaves
 * @j: job
 * @dc: clocks
 * @sends: it has transfers
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_dc_job_init(struct ec_dc_job *j, struct ec_dc *dc, bool sends)
{
	unsigned int i;

	*j = (struct ec_dc_job){ .dc = dc };
	j->path = READ_ONCE(dc->path_scanned);
	/* the monitor may change it at any time */
	j->ring = READ_ONCE(dc->links->ring.state);
	down_read(&dc->bus->topo);
	j->n = dc->bus->n_slaves;
	j->front = dc->bus->front;
	j->exit = j->n;
	j->slaves = kvcalloc(j->n + 1, sizeof(*j->slaves), GFP_KERNEL);
	j->nodes = kvcalloc(j->n + 1, sizeof(*j->nodes), GFP_KERNEL);
	for (i = 0; j->slaves && i < j->n; i++)
		j->slaves[i] = ec_slave_ref(dc->bus->slaves[i]);
	for (i = 0; j->slaves && j->nodes && i < j->n; i++)
		fill_node(j, i);
	if (j->slaves && j->nodes)
		dc_job_turn(j);
	if (dc->ref && ec_clock_is_set(dc->ref) && !READ_ONCE(dc->ref->stop.gone))
		j->followed = dc->ref->station;
	up_read(&dc->bus->topo);
	j->recv = kvcalloc(j->n + 1, sizeof(*j->recv), GFP_KERNEL);
	j->unit = kvcalloc(j->n + 1, sizeof(*j->unit), GFP_KERNEL);
	j->sum = kvcalloc(j->n + 1, sizeof(*j->sum), GFP_KERNEL);
	/* up to four of each slave */
	j->dg = kvcalloc(sends ? 4 * j->n + EC_DC_BATCH : 1, sizeof(*j->dg), GFP_KERNEL);
	j->spoiled = kvcalloc(j->n + 1, sizeof(*j->spoiled), GFP_KERNEL);
	j->silent = kvcalloc(j->n + 1, sizeof(*j->silent), GFP_KERNEL);
	if (!j->slaves || !j->nodes || !j->recv || !j->unit || !j->sum || !j->dg || !j->spoiled ||
	    !j->silent) {
		ec_dc_job_free(j);
		return -ENOMEM;
	}
	choose(j);
	return 0;
}

/**
 * ec_dc_add() - add the same access to every slave of a group
 * @j: job
 * @at: datagrams of the transfer so far
 * @who: group
 * @cmd: enum ec_cmd
 * @ado: register
 * @len: bytes
 * @data: of the first slave of the job
 * @stride: from there to that of the next slave, bytes
 *
 * Context: Process.
 * Return: datagrams of the transfer.
 */
unsigned int ec_dc_add(struct ec_dc_job *j, unsigned int at, enum ec_dc_who who, u8 cmd, u16 ado,
		       u16 len, u8 *data, size_t stride)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (ec_dc_chosen(j, i, who))
			j->dg[at++] = EC_DG(cmd, j->slaves[i]->station, ado, len,
					    data + i * stride);
	return at;
}

/**
 * ec_dc_answers() - find the slaves of a group without a valid reply
 * @j: job whose transfer has ended
 * @at: first datagram of ec_dc_add() for @who
 * @who: group
 *
 * Adds them to @j->silent.
 *
 * Context: Process.
 * Return: 0; -EAGAIN: a reply is missing; or the error of a datagram.
 */
int ec_dc_answers(struct ec_dc_job *j, unsigned int at, enum ec_dc_who who)
{
	unsigned int i;
	int ret = 0;

	for (i = 0; i < j->n; i++) {
		const struct ec_dg *dg = &j->dg[at];

		if (!ec_dc_chosen(j, i, who))
			continue;
		at++;
		if (dg->err) {
			ret = dg->err;
		} else if (dg->wkc != 1) {
			j->silent[i] = true;
			ret = ret ?: -EAGAIN;
		}
	}
	return ret;
}

/**
 * ec_dc_leave_out() - exclude slaves without a valid reply while others have one
 * @j: job, @silent as found in the last attempt
 *
 * After some attempts, so that one slave does not keep the others from being set. The watch
 * polls an excluded slave.
 *
 * Context: Process.
 */
void ec_dc_leave_out(struct ec_dc_job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++) {
		struct ec_slave *s = j->slaves[i];

		if (!j->silent[i] || ++j->spoiled[i] < EC_DC_OUT_TRIES)
			continue;
		j->nodes[i].dc = false;
		if (s->delay_only)
			continue;
		if (ec_clock_event(ec_clock_of(s), EC_CLOCK_ON_SILENT) < EC_CLOCK_EXCLUDED &&
		    !READ_ONCE(s->stop.gone))
			ec_slave_warn(s, "no valid reply to DC register access in %d attempts; clock excluded until it replies\n",
				      EC_DC_OUT_TRIES);
		if (s->station == j->followed)
			j->followed = 0;
		if (i == j->ref)
			choose(j);
	}
}

/**
 * ec_dc_job_ended() - is a job to end early?
 * @j: job
 *
 * Only one of the worker: that of the monitor needs no session.
 *
 * Context: Process.
 * Return: whether it is.
 */
bool ec_dc_job_ended(const struct ec_dc_job *j)
{
	return j->worker && READ_ONCE(j->dc->stop);
}

/**
 * ec_dc_correct_between() - let the cycle compensate clocks that are set, for some cycles
 * @j: job
 * @cycles: how many
 * @limit_ms: maximum time
 *
 * A clock that is being corrected runs too fast or too slow to be measured; without
 * correction, clocks that are set drift apart. Ends early when the worker is to stop.
 *
 * Context: Process. May sleep.
 */
void ec_dc_correct_between(struct ec_dc_job *j, u32 cycles, unsigned int limit_ms)
{
	u32 polls = READ_ONCE(j->dc->links->access.polls);
	unsigned int ms;

	/* a poll: the cycle wakes no thread of the master */
	WRITE_ONCE(j->dc->mode, j->compensated ? EC_DC_COMPENSATE : EC_DC_IDLE);
	for (ms = 0; ms < limit_ms && !ec_dc_job_ended(j) &&
	     READ_ONCE(j->dc->links->access.polls) - polls < cycles; ms++)
		usleep_range(1000, 1100);
	WRITE_ONCE(j->dc->mode, EC_DC_IDLE);
}

/**
 * ec_dc_add_latch() - add the datagram by which all slaves latch their times
 * @j: job
 * @n: datagrams of the transfer so far
 *
 * Context: Process.
 * Return: datagrams of the transfer.
 */
unsigned int ec_dc_add_latch(struct ec_dc_job *j, unsigned int n)
{
	static u8 any[4];

	j->dg[n] = EC_DG(EC_CMD_BWR, 0, EC_REG_DC_RECV(0), sizeof(any), any);
	return n + 1;
}

/**
 * ec_dc_once() - a transfer with a latch: a repeated datagram would belong to another one
 * @j: job
 * @n: datagrams
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_xfer().
 */
int ec_dc_once(struct ec_dc_job *j, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++)
		j->dg[i].repeat = false;
	return ec_xfer_clock(j->dc->links, j->dg, n);
}

/**
 * ec_dc_latch() - let all clocks latch their time, and read it
 * @j: job
 *
 * Both in one transfer: the processing unit has its time at once, a port only when the frame
 * has returned to it.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EAGAIN when slaves do not answer; or as ec_xfer().
 */
int ec_dc_latch(struct ec_dc_job *j)
{
	static u8 none[14];
	unsigned int i, first, n = ec_dc_add_latch(j, 0);
	int ret;

	memset(j->silent, 0, j->n * sizeof(*j->silent));
	/* the reads are in another frame */
	for (i = 1; i < EC_CLOCK_DATAGRAMS; i++)
		j->dg[n++] = EC_DG(EC_CMD_NOP, 0, 0, 1, none);
	first = n;
	n = ec_dc_add(j, n, EC_DC_CLOCKS, EC_CMD_FPRD, EC_REG_DC_RECV_PU, sizeof(j->unit[0]),
		      j->unit[0], sizeof(j->unit[0]));
	ret = ec_dc_once(j, n) ?: ec_dc_answers(j, first, EC_DC_CLOCKS);
	j->latch_ns = j->dg[0].sent_ns;
	return ret;
}

/**
 * ec_dc_compute() - compute the delays from the receive times of a latch
 * @j: job with a reference clock
 *
 * Context: Process.
 */
void ec_dc_compute(struct ec_dc_job *j)
{
	unsigned int i, p;

	for (i = 0; i < j->n; i++)
		for (p = 0; p < EC_DC_PORTS; p++)
			j->nodes[i].recv[p] = get_unaligned_le32(j->recv[i] + 4 * p);
	ec_dc_delays(j->nodes, j->n, j->ref);
}

/**
 * ec_dc_has_clocks() - has an end of the ring clocks?
 * @j: job
 * @other: behind the break
 * @set: that are set
 *
 * Context: Process.
 * Return: whether it has.
 */
bool ec_dc_has_clocks(const struct ec_dc_job *j, bool other, bool set)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (is_clock(j, i) && j->nodes[i].other == other &&
		    (!set || ec_clock_is_set(j->slaves[i])))
			return true;
	return false;
}

/**
 * ec_dc_has_upstream() - does a job have clocks upstream of the reference clock?
 * @j: job
 *
 * Context: Process.
 * Return: whether it has.
 */
bool ec_dc_has_upstream(const struct ec_dc_job *j)
{
	unsigned int i;

	for (i = 0; i < j->ref; i++)
		if (ec_dc_chosen(j, i, EC_DC_CLOCKS))
			return true;
	return false;
}
