/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * Example application: copies digital and analog inputs to outputs and moves
 * CiA 402 axes, on whatever of these the segment has.
 */
#ifndef DEMO_H
#define DEMO_H

#include <ecrt.h>

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

#define BITS_MAX	64
#define AXES_MAX	16
#define SLAVES_MAX	256
#define ENTRIES_MAX	512
#define BUCKETS		20
#define PERIODS		15	/* buckets of the cycle time */
#define RECENT		4096	/* analog outputs remembered, power of 2 */

/* layout.c: what the slaves say about themselves ----------------------------*/

struct entry {
	uint8_t sm;
	uint16_t pdo_pos;
	uint16_t entry_pos;
	ec_direction_t dir;
	ec_pdo_entry_info_t info;
};

/* process data of one slave */
struct layout {
	uint16_t position;
	unsigned int count;
	struct entry entries[ENTRIES_MAX];
};

/* where an entry is in the domain; @bits 0: it is not */
struct point {
	unsigned int byte;
	unsigned int bit;
	unsigned int bits;
	uint16_t index;
	uint8_t subindex;
};

int layout_read(ec_master_t *master, const ec_slave_info_t *slave,
		struct layout *l);
const struct entry *layout_find(const struct layout *l, ec_direction_t dir,
				uint16_t index, uint8_t subindex);
const struct entry *layout_nth(const struct layout *l, ec_direction_t dir,
			       unsigned int bits, unsigned int n);
int point_register(struct point *p, ec_slave_config_t *sc, ec_domain_t *domain,
		   const struct entry *e);

/* axis.c: a CiA 402 drive ---------------------------------------------------*/

/* sums of a correlation: x expected, y measured */
struct correlation {
	double n, x, y, xx, yy, xy;
};

struct axis {
	uint16_t position;
	struct point control, status, mode, target_pos, target_vel, actual;
	bool enabled;		/* now */
	bool reset;		/* fault reset bit of the last control word */
	bool moving;
	int32_t origin;		/* actual position when it began to move */
	int32_t last;		/* and now, min and max relative to origin */
	int32_t min, max;
	unsigned int faults;	/* cycles in state fault */
	double expected;
	struct correlation c;
};

int axis_register(struct axis *a, const struct layout *l, ec_slave_config_t *sc,
		  ec_domain_t *domain);
void axis_cycle(struct axis *a, uint8_t *data, bool on, double t_s,
		double dt_s, double turn_s);
double axis_correlation(const struct axis *a);
bool axis_followed(const struct axis *a);

/* readback.c: what a slave says its output is ------------------------------*/

/*
 * @recent, @head: analog outputs as the cycle wrote them
 * @same, @other: answers that were, were not one of those just written
 */
struct readback {
	unsigned int master;
	uint16_t slave;
	uint16_t index;
	uint8_t subindex;
	_Atomic int16_t recent[RECENT];
	atomic_uint head;
	atomic_bool run;
	unsigned int same;
	unsigned int other;
	bool unavailable;
};

bool readback_start(struct readback *rb, pthread_t *thread);

/* still.c: when the machine itself ran no thread ----------------------------*/

#define STILL_MS	10	/* threads of the highest priority that run later than this */
#define STILL_AFTER_MS	2000	/* slaves that left OP meanwhile are back by then */

bool still_watch(void);
void still_end(void);
bool still_lately(long long now_ns);
unsigned int still_count(void);
double still_longest_ms(void);

/* trace.c: an output that is wired back to an input ------------------------*/

/*
 * @sent, @seen: what was written to the output and what the input showed, one
 * value per measured cycle, and whether the machine stood still shortly before; @lag, @off,
 * @off_still, @worst: see trace_judge()
 */
struct trace {
	int16_t *sent, *seen;
	bool *still;
	unsigned int count;
	int min, max;
	unsigned int lag;
	unsigned int off;
	unsigned int off_still;
	unsigned int worst;
};

int trace_alloc(struct trace *t, unsigned int cycles);
void trace_add(struct trace *t, int16_t sent, int16_t seen, bool still);
void trace_judge(struct trace *t);
bool trace_followed(const struct trace *t, bool excuse);

/* all of it -----------------------------------------------------------------*/

struct demo {
	/* options */
	unsigned int index;
	unsigned int cycles;
	unsigned int period_us;
	unsigned int wait_s;
	bool json;
	bool wired;
	bool excuse;			/* what a machine that stood still explains */

	/* segment */
	unsigned int slaves;
	ec_slave_config_t *sc[SLAVES_MAX];
	struct point di[BITS_MAX], dout[BITS_MAX];
	unsigned int n_di, n_do;
	struct point ai, ao;
	struct point ai_back;		/* channel 2, beside @ai */
	uint16_t ao_slave;
	struct axis axes[AXES_MAX];
	unsigned int n_axes;

	/* results */
	bool fifo, locked;
	bool all_op, axes_enabled;
	unsigned int operational;
	double startup_s;
	unsigned int done;		/* measured cycles */
	unsigned int wc_errors;
	unsigned int overruns;		/* cycles left out */
	unsigned int call_errors;
	unsigned int wc_still;		/* of these, those soon after a standstill */
	unsigned int call_still;
	bool end_still;			/* the last state is from soon after one */
	unsigned long long lost;
	bool lost_known;
	unsigned int buckets[BUCKETS];	/* 0: below 1 us; n: below 2^n us */
	unsigned int periods[PERIODS];	/* see period_edges */
	double period_min_us, period_max_us;
	double late_sum_us;
	double late_max_us;
	unsigned int di_changes;
	unsigned int do_mismatches;
	unsigned int ao_mismatches;
	struct trace analog, digital;
	struct readback rb;
};

/* segment.c */
int segment_configure(struct demo *d, ec_master_t *m, ec_domain_t *domain);

/* cycle.c; edges in percent of the period, the last bucket has none */
extern const unsigned int period_edges[PERIODS - 1];
extern volatile sig_atomic_t stopped;

void cycle_run(struct demo *d, ec_master_t *m, ec_domain_t *domain,
	       uint8_t *data);

/* report.c */
bool demo_passed(const struct demo *d);
void report_text(const struct demo *d);
void report_json(const struct demo *d);

#endif
