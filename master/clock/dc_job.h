/* SPDX-License-Identifier: GPL-2.0-only */
/* One measurement or setting of all clocks of a segment. */
#ifndef EC_DC_JOB_H
#define EC_DC_JOB_H

#include "../carry/carry.h"
#include "dc_state.h"
#include "../bus/slave.h"
#include "../wire/dc.h"
#include "../carry/xfer.h"

#define EC_DC_OUT_TRIES	5	/* attempts that may fail because of one slave */
#define EC_DC_BATCH	7000	/* datagrams of one transfer, beside those of the slaves */

/**
 * struct ec_dc_job - all slaves of the segment, in ring order
 * @dc: clocks
 * @n: slaves
 * @slaves: with a reference each
 * @nodes: input and result of the computation of the delays
 * @recv: receive times of the ports
 * @unit: receive times of the processing units
 * @sum: of the measured delays, ns
 * @rounds: measurements of which it is
 * @dg: datagrams of a transfer
 * @spoiled: attempts that failed because of each slave
 * @silent: slaves without a valid reply in the last transfer
 * @followed: station address of the clock that the others are synchronized to, or 0
 * @ref: index of the reference clock, @n: none
 * @ring: EC_RING_* at the begin of the job
 * @front: slaves before the break of an open ring
 * @shift: how much later a frame reaches the clocks on the other side of a break than the
 *	reference clock, beyond their delays, ns
 * @shifted: @shift is known
 * @given: the clocks behind a break are set without one that was set there before
 * @guessed: and by the time of sending alone
 * @shift_behind: then as struct ec_ring_clock.shift
 * @exit: index of the slave at which a closed ring leads to the backup device, @n: none
 * @exit_port: its port there
 * @exit_ns: when it was closed (ktime)
 * @latch_ns: when the last latch was sent (ktime)
 * @path: changes of ports that the list of slaves takes into account
 * @compensated: the cycle has compensated clocks until now
 * @worker: a job of the worker, which ends with dc.stop
 * @first: all clocks are set for the first time in the session
 * @time: in frames that compensate
 */
struct ec_dc_job {
	struct ec_dc *dc;
	unsigned int n;
	struct ec_slave **slaves;
	struct ec_dc_node *nodes;
	u8 (*recv)[4 * EC_DC_PORTS];
	u8 (*unit)[8];
	s64 *sum;
	unsigned int rounds;
	struct ec_dg *dg;
	u8 *spoiled;
	bool *silent;
	u16 followed;
	unsigned int ref;
	u8 ring;
	u32 front;
	s32 shift;
	bool shifted;
	bool given;
	bool guessed;
	s32 shift_behind;
	unsigned int exit;
	int exit_port;
	u64 exit_ns;
	u64 latch_ns;
	u32 path;
	bool compensated;
	bool worker;
	bool first;
	u8 time[8];
};

/* measured after the last scan */
static inline u32 ec_dc_scan(const struct ec_dc_job *j)
{
	return READ_ONCE(j->dc->bus->scan_count) + 1;
}

static inline struct ec_clock *ec_job_clock(const struct ec_dc_job *j, unsigned int i)
{
	return ec_clock_of(j->slaves[i]);
}

/* all with receive times; all clocks; those not set yet; of these 64 and 32 bits */
enum ec_dc_who { EC_DC_TIMES, EC_DC_CLOCKS, EC_DC_NEW, EC_DC_NEW_WIDE, EC_DC_NEW_NARROW };

bool ec_dc_can_be(struct ec_dc *dc, u16 choice);
int ec_dc_job_init(struct ec_dc_job *j, struct ec_dc *dc, bool sends);
void ec_dc_job_free(struct ec_dc_job *j);
bool ec_dc_chosen(const struct ec_dc_job *j, unsigned int i, enum ec_dc_who who);
unsigned int ec_dc_count(const struct ec_dc_job *j, enum ec_dc_who who);
unsigned int ec_dc_add(struct ec_dc_job *j, unsigned int at, enum ec_dc_who who, u8 cmd, u16 ado,
		       u16 len, u8 *data, size_t stride);
int ec_dc_answers(struct ec_dc_job *j, unsigned int at, enum ec_dc_who who);
void ec_dc_leave_out(struct ec_dc_job *j);
int ec_dc_latch(struct ec_dc_job *j);
void ec_dc_compute(struct ec_dc_job *j);
bool ec_dc_job_ended(const struct ec_dc_job *j);
unsigned int ec_dc_add_latch(struct ec_dc_job *j, unsigned int n);
int ec_dc_once(struct ec_dc_job *j, unsigned int n);
bool ec_dc_has_clocks(const struct ec_dc_job *j, bool other, bool set);
void ec_dc_correct_between(struct ec_dc_job *j, u32 cycles, unsigned int limit_ms);
bool ec_dc_has_upstream(const struct ec_dc_job *j);

#endif
