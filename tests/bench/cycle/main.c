// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * What a cycle costs: receive, process, queue and send of all slaves on the
 * bus, through the library. Prints "name value" lines for tests/bench.
 */
#include "bench.h"

#include <errno.h>
#include <getopt.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>

#define NS_PER_S	1000000000LL
#define PRIORITY	80
#define SETTLE		50	/* cycles before the first one that counts */

static const char * const part_names[PARTS] = {
	"receive", "process", "queue", "send", "work", "total", "late_ns",
};

static const char * const worker_names[WORKERS] = {
	"application", "card", "master", "rest", "simulator", "other",
};

static long long now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec * NS_PER_S + t.tv_nsec;
}

/* Time the tasks of all CPUs have run, ns. */
static unsigned long long busy_ns(void)
{
	unsigned long long sum = 0, run;
	char line[256];
	FILE *f = fopen("/proc/schedstat", "r");

	while (f && fgets(line, sizeof(line), f))
		if (sscanf(line, "cpu%*u %*u %*u %*u %*u %*u %*u %llu", &run) == 1)
			sum += run;
	if (f)
		fclose(f);
	return sum;
}

/* cycle ---------------------------------------------------------------------*/

/* Absolute: what one cycle is late is not added to the next. */
static long long sleep_until(struct bench *b, long long *at)
{
	long long period = b->period_us * 1000LL, late;
	struct timespec t;

	*at += period;
	t.tv_sec = *at / NS_PER_S;
	t.tv_nsec = *at % NS_PER_S;
	while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) == EINTR)
		;
	late = now_ns() - *at;
	if (late >= period) {
		b->overruns++;
		*at += late / period * period;
	}
	return late > 0 ? late : 0;
}

/* Until the kernel has run a cycle. */
static void wait_cycle(struct bench *b, long long *at)
{
	uint64_t now;

	if (b->mode == MODE_WAIT || (b->mode == MODE_SPIN && !b->measuring)) {
		b->call_errors += ecrt_master_wait_cycle(b->master, 0) < 0;
	} else if (b->mode == MODE_TIMER) {
		/* half a period behind the begin of the kernel's cycle */
		if (!b->seen)
			*at += 500LL * b->period_us - *at % (1000LL * b->period_us);
		sleep_until(b, at);
	} else {
		while (ecrt_master_cycle_count(b->master) == b->seen)
			;
	}
	now = ecrt_master_cycle_count(b->master);
	if (b->seen && now > b->seen + 1)
		b->overruns += (unsigned int)(now - b->seen - 1);
	b->seen = now;
}

/* What the thread of the kernel did in the last cycle; ns are instructions. */
static uint32_t kernel_work(struct bench *b)
{
	ec_cycle_state_t state;

	b->call_errors += !!ecrt_master_cycle_state(b->master, &state);
	return state.work_last;
}

/* Waits for its time; its lateness is what is returned. */
static long long one_cycle(struct bench *b, long long *next, uint32_t *cost)
{
	long long at, late = 0;
	uint64_t t[5];
	unsigned int i;

	if (b->mode == MODE_OWN)
		late = sleep_until(b, next);
	if (b->syscalls)
		syscalls_mark(true);
	if (b->mode != MODE_OWN)
		wait_cycle(b, next);
	at = *next;
	t[0] = ticks();
	b->call_errors += !!ecrt_master_receive(b->master);
	t[1] = ticks();
	for (i = 0; i < b->n_domains; i++)
		b->call_errors += !!ecrt_domain_process(b->domains[i]);
	t[2] = ticks();
	if (b->extras)
		extras_ask(b, at);
	for (i = 0; i < b->n_domains; i++) {
		uint8_t *data = ecrt_domain_data(b->domains[i]);

		if (data)
			data[0]++;
	}
	t[3] = ticks();
	cost[PART_PROCESS] = (uint32_t)(t[2] - t[1]);
	for (i = 0; i < b->n_domains; i++)
		b->call_errors += !!ecrt_domain_queue(b->domains[i]);
	if (b->extras)
		extras_queue(b, at);
	t[4] = ticks();
	cost[PART_QUEUE] = (uint32_t)(t[4] - t[3]);
	b->call_errors += !!ecrt_master_send(b->master);
	cost[PART_SEND] = (uint32_t)(ticks() - t[4]);
	cost[PART_RECEIVE] = (uint32_t)(t[1] - t[0]);
	cost[PART_WORK] = b->mode == MODE_OWN ? 0 : kernel_work(b);
	cost[PART_TOTAL] = cost[PART_RECEIVE] + cost[PART_PROCESS] +
			   cost[PART_QUEUE] + cost[PART_SEND] + cost[PART_WORK];
	if (b->syscalls)
		syscalls_mark(false);
	return late;
}

static unsigned int count_operational(struct bench *b)
{
	ec_slave_config_state_t state;
	unsigned int i, n = 0;

	for (i = 0; i < b->slaves; i++)
		if (!ecrt_slave_config_state(b->sc[i], &state))
			n += state.operational;
	return n;
}

static unsigned int wc_errors(struct bench *b)
{
	ec_domain_state_t state;
	unsigned int i, n = 0;

	for (i = 0; i < b->n_domains; i++) {
		ecrt_domain_state(b->domains[i], &state);
		n += state.wc_state != EC_WC_COMPLETE &&
		     ecrt_domain_size(b->domains[i]);
	}
	return n;
}

/* The host looks at the time of its own CPUs when it reads this line. */
static void mark(const char *at)
{
	printf("mark_%s 0\n", at);
	fflush(stdout);
}

/* Cycles as an application runs them, with nothing measured in between. */
static void lean_cycles(struct bench *b, long long *at)
{
	unsigned int overruns = b->overruns, i, k;
	bool computes = b->beside || b->mode == MODE_SPIN;
	pid_t other = b->beside ? work_beside() : -1;

	mark("begin");
	*at = now_ns();
	b->seen = 0;
	for (k = 0; k < SETTLE + b->work_cycles; k++) {
		if (k == SETTLE)
			b->worked = work_begin(&b->work, computes);
		if (b->mode == MODE_OWN)
			sleep_until(b, at);
		else
			wait_cycle(b, at);
		b->call_errors += !!ecrt_master_receive(b->master);
		for (i = 0; i < b->n_domains; i++)
			b->call_errors += !!ecrt_domain_process(b->domains[i]);
		for (i = 0; i < b->n_domains; i++)
			b->call_errors += !!ecrt_domain_queue(b->domains[i]);
		b->call_errors += !!ecrt_master_send(b->master);
	}
	if (b->worked)
		work_end(&b->work);
	mark("end");
	if (other > 0) {
		kill(other, SIGKILL);
		waitpid(other, NULL, 0);
	}
	b->overruns = overruns;
}

/* Each part was measured with one ticks() more than it has. */
static void take_ticks_off(struct bench *b, uint32_t *cost)
{
	unsigned int p;

	for (p = PART_RECEIVE; p <= PART_SEND; p++) {
		uint32_t less = cost[p] < b->tick ? cost[p] : b->tick;

		cost[p] -= less;
		cost[PART_TOTAL] -= less;
	}
}

/* Nothing of this may page-fault or print: it runs at real-time priority. */
static void measure(struct bench *b, long long *at)
{
	unsigned long long lost, late, busy;
	uint32_t cost[PARTS];
	unsigned int i, p;

	frame_counters(b, &lost, &late);
	busy = busy_ns();
	/* the grid stays: frames through 1000 slaves take more than a cycle */
	b->seen = 0;
	b->measuring = true;
	for (i = 0; i < SETTLE + b->cycles; i++) {
		if (i == SETTLE) {
			b->overruns = 0;
			b->call_errors = 0;
			trace_switch(true);
		}
		cost[PART_LATE] = (uint32_t)one_cycle(b, at, cost);
		take_ticks_off(b, cost);
		if (b->violate)
			trace_violate(b, i);
		/* the reply of the cycle before was judged */
		if (i)
			b->wc_errors += wc_errors(b);
		for (p = 0; i >= SETTLE && p < PARTS; p++)
			b->samples[p][i - SETTLE] = cost[p];
	}
	trace_switch(false);
	b->busy_ns = busy_ns() - busy;
	frame_counters(b, &b->lost, &b->late);
	b->lost -= lost;
	b->late -= late;
	b->operational = count_operational(b);
	b->interrupted = in_interrupt(b);
}

static int run(struct bench *b)
{
	long long begin = now_ns(), at = begin;
	bool syscalls = b->syscalls;
	uint32_t cost[PARTS];
	unsigned int ready = 0;
	uint64_t first;

	b->syscalls = false;	/* not while starting */
	while (ready < b->ready) {
		one_cycle(b, &at, cost);
		ready = count_operational(b) == b->slaves && !wc_errors(b) ?
			ready + 1 : 0;
		if (!ready && now_ns() - begin > b->wait_s * NS_PER_S) {
			fprintf(stderr, "cycle-bench: %u of %u slaves in OP after %u s; see 'ethercat slaves'\n",
				count_operational(b), b->slaves, b->wait_s);
			return -1;
		}
	}
	b->syscalls = syscalls;
	for (b->tick = ~0u, ready = 0; ready < 100; ready++) {
		uint64_t t = ticks();

		t = ticks() - t;
		b->tick = t < b->tick ? (unsigned int)t : b->tick;
	}
	if (uploads_start(b) || (b->record && record_begin(b)))
		return -1;
	first = b->mode == MODE_OWN ? 0 : ecrt_master_cycle_count(b->master);
	measure(b, &at);
	/* a cycle of the kernel that was late is none */
	b->record_cycles = b->mode == MODE_OWN ? SETTLE + b->cycles :
			   ecrt_master_cycle_count(b->master) - first;
	b->recorded = b->record ? record_end() : 0;
	while (uploads_running())
		one_cycle(b, &at, cost);
	uploads_join(b);
	if (!syscalls && !b->trace)
		lean_cycles(b, &at);
	return 0;
}

/* report --------------------------------------------------------------------*/

static int ascending(const void *a, const void *b)
{
	uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;

	return (x > y) - (x < y);
}

static void report(struct bench *b)
{
	unsigned int p;

	printf("slaves %u\noperational %u\nimage_bytes %llu\ncycles %u\n",
	       b->slaves, b->operational, (unsigned long long)b->image_bytes,
	       b->cycles);
	if (b->uploads)
		printf("uploads_done %u\nupload_errors %u\n", b->uploads_done, b->upload_errors);
	if (b->record)
		printf("recorded %llu\nrecord_cycles %llu\n", b->recorded,
		       (unsigned long long)b->record_cycles);
	if (b->extras)
		printf("requests_done %u\n", b->requests_done);
	printf("lost %llu\nlate_frames %llu\nwc_errors %u\ncall_errors %u\noverruns %u\n",
	       b->lost, b->late, b->wc_errors, b->call_errors, b->overruns);
	printf("interrupted %u\n", b->interrupted);
	if (b->syscalls)
		return;
	printf("entry %u\nbusy_ns_per_cycle %llu\n", b->entry,
	       b->busy_ns / (SETTLE + b->cycles));
	for (p = 0; b->worked && p < WORKERS; p++)
		printf("%s_work %llu\n", worker_names[p], b->work.by[p] / b->work_cycles);
	if (b->worked)
		printf("whole_work %llu\n", b->work.all / b->work_cycles);
	for (p = 0; p < PARTS; p++) {
		uint32_t *s = b->samples[p];
		unsigned long long sum = 0;

		for (unsigned int i = 0; i < b->cycles; i++)
			sum += s[i];
		printf("%s_mean %llu\n", part_names[p], sum / b->cycles);
		qsort(s, b->cycles, sizeof(*s), ascending);
		printf("%s_min %u\n%s_median %u\n%s_p999 %u\n%s_max %u\n",
		       part_names[p], s[0], part_names[p], s[b->cycles / 2],
		       part_names[p], s[b->cycles - 1 - b->cycles / 1000],
		       part_names[p], s[b->cycles - 1]);
	}
}

/* process -------------------------------------------------------------------*/

/* One that spins on the only CPU leaves none to the simulator if it has a priority. */
static void become_realtime(const struct bench *b)
{
	struct sched_param param = { .sched_priority = PRIORITY };

	if (mlockall(MCL_CURRENT | MCL_FUTURE) ||
	    (b->mode != MODE_SPIN && sched_setscheduler(0, SCHED_FIFO, &param)))
		perror("cycle-bench: not real-time");
}

static int bench(void *arg)
{
	struct bench *b = arg;
	int ret;

	b->master = ecrt_request_master(b->index);
	if (!b->master)
		return 1;
	become_realtime(b);
	ret = setup(b);
	b->entry = syscall_entry(b);
	if (!ret)
		ret = run(b);
	ecrt_release_master(b->master);
	if (ret)
		return 1;
	report(b);
	return b->lost || b->wc_errors || b->call_errors ||
	       b->operational != b->slaves ? 1 : 0;
}

static void usage(FILE *out)
{
	fprintf(out,
		"usage: cycle-bench [options]\n"
		"  --master N     index of the master, default 0\n"
		"  --cycles N     cycles to measure, default 1000\n"
		"  --work N       cycles of which all work is counted afterwards, default 300\n"
		"  --period-us N  time between cycles, default 1000\n"
		"  --wait-s N     seconds to wait for OP, default 60\n"
		"  --ready N      complete cycles before that, default 1100: a cycle of the kernel\n"
		"                 waits for 1000\n"
		"  --domains N    spread the slaves over N domains, default 1\n"
		"  --units        each of them is a sync unit\n"
		"  --extras       clocks, states, emergencies and requests, too\n"
		"  --record       a reader of records of all process data\n"
		"  --uploads N    meanwhile others upload an object of each of N slaves, again and again\n"
		"  --kernel HOW   the kernel runs the cycle; how the application waits:\n"
		"                 wait (a system call), spin, timer (one of its own)\n"
		"  --interrupt    and runs it in the interrupt of its timer\n"
		"  --cpu N        on that CPU, else on any\n"
		"  --beside       count all work while another process computes\n"
		"  --syscalls     count system calls instead of time\n"
		"  --trace        switch ftrace on while measuring\n"
		"  --baseline MS  only measure what the machine does by itself in a millisecond,\n"
		"                 idle and while a process computes\n"
		"  --floor        only measure cycles in which nothing is done\n"
		"  --violate      sleep, fault and print in the cycle, now and then\n"
		"Exit code 0: no frame lost, no working-counter error; 1: not; 2: usage.\n");
}

static unsigned int number(const char *name, const char *text, unsigned int max)
{
	char *end;
	unsigned long n;

	errno = 0;
	n = strtoul(text, &end, 0);
	if (*text < '0' || *text > '9' || *end || errno || n > max) {
		fprintf(stderr, "cycle-bench: --%s %s: a number up to %u is needed\n",
			name, text, max);
		exit(2);
	}
	return (unsigned int)n;
}

static int kernel_mode(const char *how)
{
	return !strcmp(how, "wait") ? MODE_WAIT : !strcmp(how, "spin") ? MODE_SPIN :
	       !strcmp(how, "timer") ? MODE_TIMER : -1;
}

static void parse(struct bench *b, int argc, char **argv)
{
	static const struct option options[] = {
		{ "master", required_argument, NULL, 'm' },
		{ "cycles", required_argument, NULL, 'c' },
		{ "work", required_argument, NULL, 'n' },
		{ "period-us", required_argument, NULL, 'p' },
		{ "wait-s", required_argument, NULL, 'w' },
		{ "ready", required_argument, NULL, 'r' },
		{ "domains", required_argument, NULL, 'd' },
		{ "uploads", required_argument, NULL, 'u' },
		{ "units", no_argument, NULL, 'U' },
		{ "extras", no_argument, NULL, 'e' },
		{ "record", no_argument, NULL, 'R' },
		{ "syscalls", no_argument, NULL, 's' },
		{ "kernel", required_argument, NULL, 'k' },
		{ "trace", no_argument, NULL, 't' },
		{ "violate", no_argument, NULL, 'v' },
		{ "baseline", required_argument, NULL, 'b' },
		{ "floor", no_argument, NULL, 'f' },
		{ "interrupt", no_argument, NULL, 'i' },
		{ "cpu", required_argument, NULL, 'C' },
		{ "beside", no_argument, NULL, 'B' },
		{ "help", no_argument, NULL, 'h' },
		{ NULL, 0, NULL, 0 },
	};
	unsigned int *value;
	int c, at;

	while ((c = getopt_long(argc, argv, "h", options, &at)) != -1) {
		value = c == 'm' ? &b->index : c == 'c' ? &b->cycles :
			c == 'p' ? &b->period_us : c == 'w' ? &b->wait_s :
			c == 'd' ? &b->n_domains : c == 'n' ? &b->work_cycles :
			c == 'r' ? &b->ready : c == 'u' ? &b->uploads : NULL;
		if (value)
			*value = number(options[at].name, optarg,
					c == 'd' ? DOMAINS_MAX :
					c == 'u' ? UPLOADS_MAX : 10000000);
		else if (c == 'U')
			b->units = true;
		else if (c == 'e')
			b->extras = true;
		else if (c == 'R')
			b->record = true;
		else if (c == 's')
			b->syscalls = true;
		else if (c == 't')
			b->trace = true;
		else if (c == 'v')
			b->violate = true;
		else if (c == 'f')
			b->floor = true;
		else if (c == 'i')
			b->interrupt = true;
		else if (c == 'C')
			b->cpu = (int)number("cpu", optarg, 4095);
		else if (c == 'B')
			b->beside = true;
		else if (c == 'b')
			exit(work_baseline(number("baseline", optarg, 60000) ?: 1));
		else if (c == 'k' && kernel_mode(optarg) > 0)
			b->mode = (enum mode)kernel_mode(optarg);
		else
			usage(c == 'h' ? stdout : stderr), exit(c == 'h' ? 0 : 2);
	}
	if (optind < argc || !b->cycles || !b->work_cycles || !b->period_us || !b->n_domains) {
		usage(stderr);
		exit(2);
	}
}

int main(int argc, char **argv)
{
	static struct bench b = { .cycles = 1000, .period_us = 1000,
				  .wait_s = 60, .n_domains = 1, .work_cycles = 300, .ready = 1100,
				  .cpu = -1 };
	unsigned int p;

	parse(&b, argc, argv);
	if (b.floor)
		return floor_measure(b.cycles, b.period_us);
	if (b.trace && trace_open())
		return 1;
	for (p = 0; p < PARTS; p++) {
		b.samples[p] = calloc(b.cycles, sizeof(*b.samples[p]));
		if (!b.samples[p]) {
			fprintf(stderr, "cycle-bench: no memory for %u cycles\n",
				b.cycles);
			return 1;
		}
	}
	return b.syscalls ? syscalls_run(bench, &b) : bench(&b);
}
