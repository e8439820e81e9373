// SPDX-License-Identifier: LGPL-2.1-or-later
#include "demo.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <uapi/ethercat.h>

#define BECKHOFF	0x00000002
#define EL1004		0x03ec3052
#define EL1859		0x07433052
#define EL2004		0x07d43052
#define EL3062		0x0bf63052
#define EL4002		0x0fa23052
#define EL7201		0x1c213052

#define NS_PER_S	1000000000LL
#define STOP_CYCLES	100
#define PRIORITY	80

static volatile sig_atomic_t stopped;

static void on_signal(int sig)
{
	(void)sig;
	stopped = 1;
}

static long long now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec * NS_PER_S + t.tv_nsec;
}

/* segment -------------------------------------------------------------------*/

static int add_bits(struct point *points, unsigned int *count,
		    const struct layout *l, ec_direction_t dir,
		    ec_slave_config_t *sc, ec_domain_t *domain)
{
	const struct entry *e;
	unsigned int n;
	int ret;

	for (n = 0; *count < BITS_MAX && (e = layout_nth(l, dir, 1, n)); n++) {
		ret = point_register(&points[*count], sc, domain, e);
		if (ret)
			return ret;
		(*count)++;
	}
	return 0;
}

/* The first 16 bit entry is channel 1, in compact and in long PDOs. */
static int add_analog(struct point *p, const struct layout *l,
		      ec_direction_t dir, ec_slave_config_t *sc,
		      ec_domain_t *domain)
{
	const struct entry *e = layout_nth(l, dir, 16, 0);

	return e && !p->bits ? point_register(p, sc, domain, e) : 0;
}

static int add_axis(struct demo *d, const struct layout *l,
		    ec_slave_config_t *sc, ec_domain_t *domain)
{
	int ret;

	if (d->n_axes == AXES_MAX)
		return 0;
	ret = axis_register(&d->axes[d->n_axes], l, sc, domain);
	if (!ret)
		d->n_axes++;
	else if (ret > 0)
		fprintf(stderr, "demo: slave %u: no axis: control word, status word, position or target is not mapped\n",
			l->position);
	return ret < 0 ? ret : 0;
}

/* Everything is exchanged: a slave whose outputs nobody sends refuses OP. */
static int add_all(const struct layout *l, ec_slave_config_t *sc,
		   ec_domain_t *domain)
{
	struct point unused;
	unsigned int i;
	int ret = 0;

	for (i = 0; i < l->count && !ret; i++)
		ret = point_register(&unused, sc, domain, &l->entries[i]);
	return ret;
}

static int add_slave(struct demo *d, ec_master_t *m, ec_domain_t *domain,
		     uint16_t position)
{
	static struct layout l;
	ec_slave_config_t *sc;
	ec_slave_info_t info;
	int ret = 0;

	if (ecrt_master_get_slave(m, position, &info))
		return -1;
	/* those without process data, too: the whole segment shall reach OP */
	sc = ecrt_master_slave_config(m, 0, position, info.vendor_id,
				      info.product_code);
	if (!sc)
		return -1;
	d->sc[d->slaves++] = sc;
	if (layout_read(m, &info, &l) || add_all(&l, sc, domain))
		return -1;
	if (info.vendor_id != BECKHOFF)
		return 0;
	switch (info.product_code) {
	case EL1859:
	case EL1004:
	case EL2004:
		ret = add_bits(d->di, &d->n_di, &l, EC_DIR_INPUT, sc, domain);
		if (!ret)
			ret = add_bits(d->dout, &d->n_do, &l, EC_DIR_OUTPUT, sc,
				       domain);
		break;
	case EL3062:
		ret = add_analog(&d->ai, &l, EC_DIR_INPUT, sc, domain);
		break;
	case EL4002:
		d->ao_slave = d->ao.bits ? d->ao_slave : position;
		ret = add_analog(&d->ao, &l, EC_DIR_OUTPUT, sc, domain);
		break;
	case EL7201:
		ret = add_axis(d, &l, sc, domain);
		break;
	}
	return ret;
}

static int configure(struct demo *d, ec_master_t *m, ec_domain_t *domain)
{
	ec_master_info_t info;
	unsigned int i;

	if (ecrt_master(m, &info))
		return -1;
	if (!info.slave_count || info.slave_count > SLAVES_MAX) {
		fprintf(stderr, "demo: %u slaves; 1..%u are needed\n",
			info.slave_count, SLAVES_MAX);
		return -1;
	}
	for (i = 0; i < info.slave_count; i++)
		if (add_slave(d, m, domain, (uint16_t)i))
			return -1;
	return ecrt_master_set_send_interval(m, d->period_us);
}

/* cycle ---------------------------------------------------------------------*/

static bool bit_get(const struct point *p, const uint8_t *data)
{
	return EC_READ_BIT(data + p->byte, p->bit);
}

static void copy_bits(struct demo *d, uint8_t *data, bool measure)
{
	static bool in[BITS_MAX];
	static bool valid;
	unsigned int i;
	bool now;

	for (i = 0; i < d->n_do && i < d->n_di; i++) {
		/* what the last cycle wrote must still be there */
		if (measure && valid)
			d->do_mismatches += bit_get(&d->dout[i], data) != in[i];
		now = bit_get(&d->di[i], data);
		if (measure && valid)
			d->di_changes += now != in[i];
		in[i] = now;
		EC_WRITE_BIT(data + d->dout[i].byte, d->dout[i].bit, now);
	}
	valid = true;
}

static void copy_analog(struct demo *d, uint8_t *data, bool measure)
{
	static int16_t last;
	static bool valid;
	int16_t in, out;

	if (!d->ai.bits)
		return;
	in = EC_READ_S16(data + d->ai.byte);
	out = in;
	if (d->ao.bits) {
		out = EC_READ_S16(data + d->ao.byte);
		EC_WRITE_S16(data + d->ao.byte, in);
		d->rb.recent[d->rb.head % RECENT] = in;
		d->rb.head++;
	}
	if (measure) {
		if (d->ao.bits && valid)
			d->ao_mismatches += out != last;
		d->in[d->done] = in;
		d->out[d->done] = out;
		d->ai_min = in < d->ai_min ? in : d->ai_min;
		d->ai_max = in > d->ai_max ? in : d->ai_max;
	}
	last = in;
	valid = true;
}

static void count_late(struct demo *d, double late_us)
{
	unsigned int i = 0;

	while (i < BUCKETS - 1 && late_us >= (double)(1u << i))
		i++;
	d->buckets[i]++;
	d->late_sum_us += late_us;
	if (late_us > d->late_max_us)
		d->late_max_us = late_us;
}

static bool all_operational(struct demo *d)
{
	ec_slave_config_state_t state;
	unsigned int i;

	d->operational = 0;
	for (i = 0; i < d->slaves; i++)
		if (!ecrt_slave_config_state(d->sc[i], &state))
			d->operational += state.operational;
	return d->operational == d->slaves;
}

static bool all_enabled(const struct demo *d)
{
	unsigned int i;

	for (i = 0; i < d->n_axes; i++)
		if (!d->axes[i].enabled)
			return false;
	return true;
}

enum phase { START, RUN, STOP };

/* Absolute: what one cycle is late is not added to the next. */
static double sleep_until(struct demo *d, long long *at, long long period)
{
	struct timespec t;
	long long late;

	*at += period;
	t.tv_sec = *at / NS_PER_S;
	t.tv_nsec = *at % NS_PER_S;
	while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL) ==
	       EINTR && !stopped)
		;
	late = now_ns() - *at;
	if (late >= period) {
		if (d->operational == d->slaves)
			d->overruns += (unsigned int)(late / period);
		*at += late / period * period;
	}
	return (double)late / 1000;
}

static unsigned long long frames_lost(const struct demo *d)
{
	unsigned long long lost = 0;
	struct ec_ioc_master info;
	char path[40];
	unsigned int i;
	int fd;

	snprintf(path, sizeof(path), "/dev/EtherCAT%u", d->index);
	memset(&info, 0, sizeof(info));
	fd = open(path, O_RDONLY | O_CLOEXEC);
	if (fd < 0)
		return 0;
	if (!ioctl(fd, EC_IOC_MASTER, &info))
		for (i = 0; i < EC_UAPI_DEVICES; i++)
			lost += info.devices[i].lost;
	close(fd);
	return lost;
}

static void one_cycle(struct demo *d, ec_master_t *m, ec_domain_t *domain,
		      uint8_t *data, enum phase phase, double late_us)
{
	double dt = d->period_us / 1e6, run = d->cycles * dt;
	double turn = run / 2 > 1 ? run / 2 : 1;
	ec_domain_state_t state;
	unsigned int i;

	d->call_errors += !!ecrt_master_receive(m);
	d->call_errors += !!ecrt_domain_process(domain);
	ecrt_domain_state(domain, &state);
	if (phase == RUN) {
		d->wc_errors += state.wc_state != EC_WC_COMPLETE;
		count_late(d, late_us > 0 ? late_us : 0);
	}
	copy_bits(d, data, phase == RUN);
	copy_analog(d, data, phase == RUN);
	for (i = 0; i < d->n_axes; i++)
		axis_cycle(&d->axes[i], data,
			   phase != STOP && d->operational == d->slaves,
			   phase == RUN ? d->done * dt : -1, dt, turn);
	if (phase == RUN)
		d->done++;
	d->call_errors += !!ecrt_domain_queue(domain);
	d->call_errors += !!ecrt_master_send(m);
}

/*
 * What may page-fault or print is done between phases only; asking for the
 * states costs no system call.
 */
static void run(struct demo *d, ec_master_t *m, ec_domain_t *domain,
		uint8_t *data)
{
	long long period = d->period_us * 1000LL, begin = now_ns(), at = begin;
	unsigned long long lost = 0;
	enum phase phase = START;
	unsigned int stopping = 0;
	pthread_t reader;
	bool reading = false;
	double late_us;

	while (stopping < STOP_CYCLES) {
		late_us = sleep_until(d, &at, period);
		one_cycle(d, m, domain, data, phase, late_us);
		if (phase == START && all_operational(d) && all_enabled(d)) {
			d->all_op = true;
			d->axes_enabled = true;
			d->startup_s = (double)(now_ns() - begin) / NS_PER_S;
			lost = frames_lost(d);
			d->overruns = 0;
			phase = RUN;
			d->rb.run = d->ai.bits && d->ao.bits;
			reading = d->rb.run && !pthread_create(&reader, NULL,
						readback_thread, &d->rb);
			at = now_ns();
		} else if (phase == START && (stopped ||
			   now_ns() - begin > d->wait_s * NS_PER_S)) {
			d->all_op = d->operational == d->slaves;
			d->axes_enabled = all_enabled(d);
			phase = STOP;
		} else if (phase == RUN && (stopped || d->done == d->cycles)) {
			d->all_op = all_operational(d);
			d->axes_enabled = all_enabled(d);
			d->lost = frames_lost(d) - lost;
			d->rb.run = false;
			phase = STOP;
		}
		stopping += phase == STOP;
	}
	if (reading)
		pthread_join(reader, NULL);
}

/* process -------------------------------------------------------------------*/

static void become_realtime(struct demo *d)
{
	struct sched_param param = { .sched_priority = PRIORITY };

	d->locked = !mlockall(MCL_CURRENT | MCL_FUTURE);
	/* the thread that reads back must not inherit the priority */
	d->fifo = !sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK,
				      &param);
}

static void usage(FILE *out)
{
	fprintf(out,
		"usage: demo [--master N] [--cycles N] [--period-us N] [--wait-s N] [--json]\n"
		"  --master N     index of the master, default 0\n"
		"  --cycles N     cycles to measure, default 5000\n"
		"  --period-us N  time between cycles in microseconds, default 1000\n"
		"  --wait-s N     seconds to wait for OP and enabled axes, default 30\n"
		"  --json         one JSON object instead of text\n"
		"Exit code 0: all slaves reached OP and outputs and axes followed; 1: not; 2: usage.\n");
}

static unsigned int number(const char *name, const char *text, unsigned int min,
			   unsigned int max)
{
	char *end;
	unsigned long n;

	errno = 0;
	n = strtoul(text, &end, 0);
	if (*text < '0' || *text > '9' || *end || errno || n < min || n > max) {
		fprintf(stderr, "demo: --%s %s: a number from %u to %u is needed\n",
			name, text, min, max);
		exit(2);
	}
	return (unsigned int)n;
}

static void parse(struct demo *d, int argc, char **argv)
{
	static const struct option options[] = {
		{ "master", required_argument, NULL, 'm' },
		{ "cycles", required_argument, NULL, 'c' },
		{ "period-us", required_argument, NULL, 'p' },
		{ "wait-s", required_argument, NULL, 'w' },
		{ "json", no_argument, NULL, 'j' },
		{ "help", no_argument, NULL, 'h' },
		{ NULL, 0, NULL, 0 },
	};
	int c;

	while ((c = getopt_long(argc, argv, "h", options, NULL)) != -1) {
		switch (c) {
		case 'm':
			d->index = number("master", optarg, 0, 255);
			break;
		case 'c':
			d->cycles = number("cycles", optarg, 1, 10000000);
			break;
		case 'p':
			d->period_us = number("period-us", optarg, 50, 1000000);
			break;
		case 'w':
			d->wait_s = number("wait-s", optarg, 1, 86400);
			break;
		case 'j':
			d->json = true;
			break;
		case 'h':
			usage(stdout);
			exit(0);
		default:
			usage(stderr);
			exit(2);
		}
	}
	if (optind < argc) {
		usage(stderr);
		exit(2);
	}
}

static int demo(struct demo *d, ec_master_t *m)
{
	ec_domain_t *domain = ecrt_master_create_domain(m);

	if (!domain || configure(d, m, domain))
		return -1;
	if (!d->n_do && !d->ao.bits && !d->n_axes)
		fprintf(stderr, "demo: none of the %u slaves has outputs that this demo knows\n",
			d->slaves);
	d->rb.master = d->index;
	d->rb.slave = d->ao_slave;
	d->rb.index = d->ao.index;
	d->rb.subindex = d->ao.subindex;
	become_realtime(d);
	if (ecrt_master_activate(m))
		return -1;
	run(d, m, domain, ecrt_domain_data(domain));
	return 0;
}

int main(int argc, char **argv)
{
	static struct demo d = { .cycles = 5000, .period_us = 1000,
				 .wait_s = 30, .ai_min = 32767,
				 .ai_max = -32768 };
	ec_master_t *m;
	int ret;

	parse(&d, argc, argv);
	d.in = calloc(d.cycles, sizeof(*d.in));
	d.out = calloc(d.cycles, sizeof(*d.out));
	if (!d.in || !d.out) {
		fprintf(stderr, "demo: no memory for %u cycles\n", d.cycles);
		return 1;
	}
	signal(SIGINT, on_signal);
	signal(SIGTERM, on_signal);
	m = ecrt_request_master(d.index);
	if (!m)
		return 1;
	ret = demo(&d, m);
	ecrt_release_master(m);
	if (ret)
		return 1;
	if (d.json)
		report_json(&d);
	else
		report_text(&d);
	return demo_passed(&d) ? 0 : 1;
}
