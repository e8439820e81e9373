// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * dc_motion: two drives (CiA 402, or EL7201 terminals) move by a sine, with distributed clocks:
 * both accept their target positions at the same SYNC0, a third of a cycle after the frame. When
 * one leaves operation, by a fault or its enable input, both stop and the program ends: it resets
 * faults only before the motion. usage() has the arguments. The time reference is
 *
 *   lead    this program: the reference clock is synchronized to it; for machines with a
 *           better clock than that of the drives
 *   follow  the reference clock: a small controller synchronizes this program to it; the
 *           best for the drives
 *
 * (With ecrt_master_set_cycle() and EC_CYCLE_FOLLOW_REFERENCE the kernel does the same as
 * "follow", see kcycle.c.)
 */
#include <ecrt.h>
#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

#define PERIOD_NS	1000000
#define SHIFT_NS	(PERIOD_NS / 3)	/* later than the frame */
#define NS_PER_S	1000000000L
#define AXES		2		/* at most */
#define STOP_CYCLES	1000		/* for a quick stop */
#define AMPLITUDE	100000.0	/* counts, peak to peak */
#define TURN_S		2.0		/* one period of the motion */
#define TWO_PI		6.283185307179586
#define MODE_CSP	8		/* cyclic synchronous position */

/* one drive; offsets in the domain are filled in by the registration */
struct axis {
	ec_slave_config_t *config;
	unsigned int position;
	unsigned int control, target, mode;	/* 0x6040, 0x607a, 0x6060 */
	unsigned int status, actual;		/* 0x6041, 0x6064 */
	int moving;
	int32_t origin, last, low, high;
};

static ec_master_t *master;
static ec_domain_t *domain;
static uint8_t *data;
static struct axis axes[AXES];
static int n_axes, follow, reached_op;
static int failed;	/* a drive left operation while it moved */

static volatile sig_atomic_t stop;

static void usage(FILE *file)
{
	fprintf(file, "usage: dc_motion [lead|follow [FIRST [SECOND|- [SECONDS]]]]\n"
		"One or two drives move by a sine. WARNING: by %d counts, check that nothing is\n"
		"in the way.\n"
		"  lead           this program is the time reference (default)\n"
		"  follow         the reference clock is\n"
		"  FIRST, SECOND  ring positions of the drives, see 'ethercat slaves'; default 4\n"
		"                 and 5, as in the simulated segment 'bench'. FIRST alone, or '-'\n"
		"                 as SECOND: one drive\n"
		"  SECONDS        to run, 1 to 65535; default: until Ctrl-C\n"
		"exit status: 0 ended by time or Ctrl-C after all drives moved; 1 failure, or a\n"
		"drive did not move or left operation; 2 invalid argument\n", (int)AMPLITUDE);
}

/* Exits for --help and for invalid arguments. @values: defaults of FIRST, SECOND, SECONDS. */
static void parse(int argc, char **argv, unsigned long values[3])
{
	unsigned long value;
	char *end;
	int i;

	n_axes = argc == 3 || (argc > 3 && !strcmp(argv[3], "-")) ? 1 : AXES;
	for (i = 1; i < argc; i++) {
		if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
			usage(stdout);
			exit(0);
		}
		if (i == 1 && (!strcmp(argv[1], "follow") || !strcmp(argv[1], "lead"))) {
			follow = argv[1][0] == 'f';
			continue;
		}
		if (i == 3 && n_axes == 1)
			continue;
		value = strtoul(argv[i], &end, 10);
		if (i == 1 || i > 4 || *argv[i] < '0' || *argv[i] > '9' || *end ||
		    value > 0xffff || (i == 4 && !value)) {
			fprintf(stderr, "dc_motion: invalid argument '%s'\n", argv[i]);
			usage(stderr);
			exit(2);
		}
		values[i - 2] = value;
	}
	if (n_axes > 1 && values[0] == values[1]) {
		fprintf(stderr, "dc_motion: FIRST and SECOND are both %lu\n", values[0]);
		exit(2);
	}
}

static void on_signal(int number)
{
	(void)number;
	stop = 1;
}

/* configuration --------------------------------------------------------------*/

/* a drive by the profile: its PDOs can be mapped */
static ec_pdo_entry_info_t cia_out[] = { { 0x6040, 0, 16 }, { 0x607a, 0, 32 }, { 0x6060, 0, 8 } };
static ec_pdo_entry_info_t cia_in[] = { { 0x6041, 0, 16 }, { 0x6064, 0, 32 } };
static ec_pdo_info_t cia_rx[] = { { 0x1600, 3, cia_out } };
static ec_pdo_info_t cia_tx[] = { { 0x1a00, 2, cia_in } };

/* EL7201: PDOs of fixed content to choose from; the same words at other indexes */
static ec_pdo_entry_info_t el_control[] = { { 0x7010, 1, 16 } };
static ec_pdo_entry_info_t el_target[] = { { 0x7010, 5, 32 } };
static ec_pdo_entry_info_t el_mode[] = { { 0x7010, 3, 8 }, { 0, 0, 8 } };
static ec_pdo_entry_info_t el_actual[] = { { 0x6000, 0x11, 32 } };
static ec_pdo_entry_info_t el_status[] = { { 0x6010, 1, 16 } };
static ec_pdo_info_t el_rx[] = {
	{ 0x1600, 1, el_control }, { 0x1606, 1, el_target }, { 0x1605, 2, el_mode },
};
static ec_pdo_info_t el_tx[] = { { 0x1a00, 1, el_actual }, { 0x1a01, 1, el_status } };

/* SM2 and SM3, and control, target, mode, status, actual */
struct layout {
	ec_sync_info_t syncs[3];
	struct {
		uint16_t index;
		uint8_t subindex;
	} entry[5];
};

static const struct layout cia402 = {
	{ { 2, EC_DIR_OUTPUT, 1, cia_rx, EC_WD_ENABLE },
	  { 3, EC_DIR_INPUT, 1, cia_tx, EC_WD_DISABLE },
	  { 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT } },
	{ { 0x6040, 0 }, { 0x607a, 0 }, { 0x6060, 0 }, { 0x6041, 0 }, { 0x6064, 0 } },
};

static const struct layout el7201 = {
	{ { 2, EC_DIR_OUTPUT, 3, el_rx, EC_WD_ENABLE },
	  { 3, EC_DIR_INPUT, 2, el_tx, EC_WD_DISABLE },
	  { 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT } },
	{ { 0x7010, 1 }, { 0x7010, 5 }, { 0x7010, 3 }, { 0x6010, 1 }, { 0x6000, 0x11 } },
};

static int configure(struct axis *a, uint16_t position)
{
	unsigned int *offset[] = { &a->control, &a->target, &a->mode, &a->status, &a->actual };
	const struct layout *l;
	ec_slave_info_t info;
	ec_slave_config_t *sc;
	size_t i;
	int ret;

	if (ecrt_master_get_slave(master, position, &info))
		return -1;
	l = info.vendor_id == 2 && info.product_code == 0x1c213052 ? &el7201 : &cia402;
	sc = ecrt_master_slave_config(master, 0, position, info.vendor_id, info.product_code);
	if (!sc || ecrt_slave_config_pdos(sc, EC_END, l->syncs))
		return -1;
	a->config = sc;
	a->position = position;
	for (i = 0; i < sizeof(offset) / sizeof(offset[0]); i++) {
		ret = ecrt_slave_config_reg_pdo_entry(sc, l->entry[i].index,
						      l->entry[i].subindex, domain, NULL);
		if (ret < 0)
			return -1;
		*offset[i] = (unsigned int)ret;
	}
	/* SYNC0 in each cycle; most drives have 0x0300 in their ESI */
	return ecrt_slave_config_dc(sc, 0x0300, PERIOD_NS, SHIFT_NS, 0, 0);
}

/* Time of a clock in ns; EtherCAT counts from 2000, but any epoch works. */
static uint64_t ns(const struct timespec *t)
{
	return (uint64_t)t->tv_sec * (uint64_t)NS_PER_S + (uint64_t)t->tv_nsec;
}

/* The library prints the reason of each failure on stderr. */
static int setup(const unsigned long *positions)
{
	int i;

	master = ecrt_request_master(0);
	if (!master)
		return -1;
	domain = ecrt_master_create_domain(master);
	if (!domain)
		return -1;
	for (i = 0; i < n_axes; i++)
		if (configure(&axes[i], (uint16_t)positions[i]))
			return -1;
	if (ecrt_master_set_send_interval(master, PERIOD_NS / 1000) ||
	    ecrt_master_activate(master))
		return -1;
	data = ecrt_domain_data(domain);
	return data ? 0 : -1;
}

/* Avoids page faults in the cycle, and gives the thread a real-time priority. */
static void become_realtime(void)
{
	struct sched_param param;

	memset(&param, 0, sizeof(param));
	param.sched_priority = 80;
	if (mlockall(MCL_CURRENT | MCL_FUTURE))
		perror("Not locked in memory");
	if (pthread_setschedparam(pthread_self(), SCHED_FIFO, &param))
		fprintf(stderr, "Not real-time: no right to use SCHED_FIFO\n");
}

/* time -----------------------------------------------------------------------*/

/* relation of the reference clock to the cycle */
static struct {
	uint64_t app_time;	/* application time of the last cycle */
	int32_t error;		/* deviation of that frame by the reference clock */
	int64_t integral;	/* correction that keeps its rate, ns * 512 */
	int64_t corrected;	/* sum of all corrections, ns */
} clock_state;

/*
 * The error is the time of the reference clock at the last frame minus the application time of
 * that frame. A part of it, and of its sum, corrects the next period, by at most 1/100.
 */
static long correction(void)
{
	uint32_t time;
	int64_t c;

	if (ecrt_master_reference_clock_time(master, &time))
		return 0;	/* not synchronized yet, or that frame was lost */
	clock_state.error = (int32_t)(time - (uint32_t)clock_state.app_time);
	if (!follow)
		return 0;
	c = -(clock_state.error / 16 + clock_state.integral / 512);
	if (c > PERIOD_NS / 100)
		c = PERIOD_NS / 100;
	else if (c < -PERIOD_NS / 100)
		c = -PERIOD_NS / 100;
	else
		clock_state.integral += clock_state.error;
	clock_state.corrected += c;
	return (long)c;
}

static void add(struct timespec *t, long add_ns)
{
	t->tv_nsec += add_ns;
	if (t->tv_nsec >= NS_PER_S) {
		t->tv_nsec -= NS_PER_S;
		t->tv_sec++;
	}
}

/*
 * Sleeps until the next cycle; skips cycles that have passed. The application time advances by
 * whole periods: of the clock of this program with "lead", of the reference clock with
 * "follow".
 */
static unsigned int wait_period(struct timespec *next, uint64_t *app_time, long correct)
{
	unsigned int missed = 0;
	struct timespec now;

	for (;; missed++, correct = 0) {
		add(next, PERIOD_NS + correct);
		*app_time += PERIOD_NS;
		clock_gettime(CLOCK_MONOTONIC, &now);
		if (ns(next) > ns(&now))
			break;
	}
	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, next, NULL);
	return missed;
}

/* motion ---------------------------------------------------------------------*/

/* Control word of the next transition towards operation. */
static uint16_t next_control(uint16_t status, unsigned long n)
{
	if ((status & 0x4f) == 0x08)		/* fault: reset is an edge */
		return n % 2 ? 0x80 : 0x00;
	if ((status & 0x4f) == 0x40)		/* switch on disabled */
		return 0x06;
	if ((status & 0x6f) == 0x21)		/* ready to switch on */
		return 0x07;
	return (status & 0x6f) == 0x23 || (status & 0x6f) == 0x27 ? 0x0f : 0x00;
}

/* request to a drive */
enum phase { ENABLE, MOVE, QUICK_STOP };

/* @t_s: time since the motion began */
static void move(struct axis *a, unsigned long n, enum phase phase, double t_s)
{
	int32_t at = EC_READ_S32(data + a->actual), target = at;

	if (phase == MOVE) {
		if (!a->moving)
			a->origin = at;
		a->moving = 1;
		target = a->origin +
			 (int32_t)lrint(AMPLITUDE / 2 * (1 - cos(TWO_PI * t_s / TURN_S)));
		a->last = at - a->origin;
		a->low = a->last < a->low ? a->last : a->low;
		a->high = a->last > a->high ? a->last : a->high;
	}
	EC_WRITE_S8(data + a->mode, MODE_CSP);
	EC_WRITE_S32(data + a->target, target);
	EC_WRITE_U16(data + a->control, phase == QUICK_STOP ? 0x02 :
					next_control(EC_READ_U16(data + a->status), n));
}

/* How many drives have a status word that is @value in the bits of the state? */
static int count(uint16_t value)
{
	int i, n = 0;

	for (i = 0; i < n_axes; i++)
		n += (EC_READ_U16(data + axes[i].status) & 0x6f) == value;
	return n;
}

static int all_enabled(void)
{
	return count(0x27) == n_axes;
}

/* cycle ----------------------------------------------------------------------*/

/* Returns the correction of the next period, ns. */
static long cycle(unsigned long n, uint64_t app_time, int off)
{
	enum phase phase = ENABLE;
	static uint64_t began;
	long correct;
	int i;

	ecrt_master_receive(master);
	ecrt_domain_process(domain);
	correct = correction();
	if (!began && all_enabled())
		began = app_time;
	else if (began && !off && !all_enabled())
		failed = 1;
	if (off || failed)
		phase = QUICK_STOP;
	else if (began)
		phase = MOVE;
	for (i = 0; i < n_axes; i++)
		move(&axes[i], n, phase, (double)(app_time - began) / NS_PER_S);

	/* the same order at the same place in each cycle, DC last before send */
	ecrt_domain_queue(domain);
	ecrt_master_application_time(master, app_time);
	if (!follow)
		ecrt_master_sync_reference_clock(master);
	ecrt_master_sync_slave_clocks(master);
	if (n % 100 == 0)
		ecrt_master_sync_monitor_queue(master);
	clock_state.app_time = app_time;
	ecrt_master_send(master);
	return correct;
}

/* Prints the reason for each drive that is not in OP; returns the number of these drives. */
static int not_in_op(void)
{
	ec_slave_config_state_t state;
	char reason[256];
	int i, n = 0;

	for (i = 0; i < n_axes; i++) {
		if (!ecrt_slave_config_state(axes[i].config, &state) && state.operational)
			continue;
		n++;
		if (ecrt_slave_config_reason(axes[i].config, reason, sizeof(reason)) <= 0)
			reason[0] = 0;
		printf("slave %u is not in OP: %s\n", axes[i].position,
		       reason[0] ? reason : "no reason known yet");
	}
	return n;
}

static void status_words(const char *text)
{
	int i;

	printf("%s: status words", text);
	for (i = 0; i < n_axes; i++)
		printf(" 0x%04x", EC_READ_U16(data + axes[i].status));
	printf("\n");
}

/*
 * Printing takes too long for a cycle: an application with hard limits prints in a thread
 * without real-time priority.
 */
static void report(unsigned long n)
{
	uint32_t apart = ecrt_master_sync_monitor_process(master);
	int i;

	if (n % (NS_PER_S / PERIOD_NS))
		return;
	if (n && !reached_op)
		reached_op = !not_in_op();
	if (apart == 0xffffffff)
		return;
	if (!axes[0].moving)
		status_words("not moving yet");
	printf("reference clock %+d ns, slaves' clocks within %u ns of it, axes at",
	       clock_state.error, apart);
	for (i = 0; i < n_axes; i++)
		printf(" %d", axes[i].last);
	printf("\n");
}

/* Quick stop, before the last frame. */
static void stop_drives(unsigned long n, struct timespec *next, uint64_t *app_time)
{
	int i;

	for (i = 0; i < STOP_CYCLES && (i < 10 || count(0x27) || count(0x07)); i++) {
		wait_period(next, app_time, 0);
		cycle(n + (unsigned long)i, *app_time, 1);
	}
}

static void run(unsigned long cycles)
{
	unsigned long n, missed = 0;
	uint64_t app_time;
	struct timespec next;
	long correct = 0;
	int i;

	clock_gettime(CLOCK_MONOTONIC, &next);
	app_time = ns(&next);
	for (n = 0; !stop && !failed && (!cycles || n < cycles); n++) {
		missed += wait_period(&next, &app_time, correct);
		correct = cycle(n, app_time, 0);
		report(n);
	}
	reached_op = !not_in_op();
	if (failed)
		status_words("ended: a drive has left operation, all of them stop");
	else if (!reached_op)
		printf("ended without OP\n");
	else if (!axes[0].moving)
		status_words("ended: not all drives reached operation");
	else
		printf("ended %s\n", stop ? "by a signal" : "after the given time");
	stop_drives(n, &next, &app_time);
	printf("%lu cycles, %lu skipped\n", n, missed);
	for (i = 0; i < n_axes; i++)
		printf("axis %d: from %d to %d\n", i, axes[i].low, axes[i].high);
	if (follow && n)
		printf("the reference clock runs %+.0f ppm faster than CLOCK_MONOTONIC\n",
		       -1e6 * (double)clock_state.corrected / PERIOD_NS / (double)n);
}

int main(int argc, char **argv)
{
	unsigned long args[3] = { 4, 5, 0 };
	struct sigaction action;

	parse(argc, argv, args);
	memset(&action, 0, sizeof(action));
	action.sa_handler = on_signal;
	sigaction(SIGINT, &action, NULL);
	sigaction(SIGTERM, &action, NULL);

	if (setup(args)) {
		ecrt_release_master(master);
		return 1;
	}
	setvbuf(stdout, NULL, _IOLBF, 0);
	become_realtime();
	run(args[2] * (unsigned long)(NS_PER_S / PERIOD_NS));
	ecrt_release_master(master);	/* slaves go to PREOP */
	return !reached_op || failed || !axes[0].moving;
}
