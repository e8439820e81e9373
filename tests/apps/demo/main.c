// SPDX-License-Identifier: LGPL-2.1-or-later
/* Options, and from request to release of the master. */
#include "demo.h"

#include <errno.h>
#include <getopt.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>

#define PRIORITY	80

static void on_signal(int sig)
{
	(void)sig;
	stopped = 1;
}

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
		"usage: demo [--master N] [--cycles N] [--period-us N] [--wait-s N] [--wired]\n"
		"            [--excuse] [--json]\n"
		"  --master N     index of the master, default 0\n"
		"  --cycles N     cycles to measure, default 5000\n"
		"  --period-us N  time between cycles in microseconds, default 1000\n"
		"  --wait-s N     seconds to wait for OP and enabled axes, default 30\n"
		"  --wired        analog output 1 is wired to analog input 2 and digital\n"
		"                 output 1 to digital input 5 of the same terminal: check them\n"
		"  --excuse       a check that misses because the machine stood still for 10 ms\n"
		"                 or more fails nothing; needs SCHED_FIFO\n"
		"  --json         one JSON object instead of text\n"
		"Exit code 0: all checks passed; 1: not; 2: usage.\n");
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
		{ "wired", no_argument, NULL, 'b' },
		{ "excuse", no_argument, NULL, 'e' },
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
		case 'b':
			d->wired = true;
			break;
		case 'e':
			d->excuse = true;
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

	if (!domain || segment_configure(d, m, domain))
		return -1;
	if (!d->n_do && !d->ao.bits && !d->n_axes)
		fprintf(stderr, "demo: none of the %u slaves has outputs that this demo knows\n",
			d->slaves);
	if (d->wired && (!d->ai_back.bits || !d->ao.bits || d->n_di < 5 || !d->n_do)) {
		fprintf(stderr, "demo: --wired needs an EL3062, an EL4002 and an EL1859\n");
		return -1;
	}
	d->rb.master = d->index;
	d->rb.slave = d->ao_slave;
	d->rb.index = d->ao.index;
	d->rb.subindex = d->ao.subindex;
	become_realtime(d);
	d->excuse = d->excuse && d->fifo && still_watch();
	if (ecrt_master_activate(m))
		return -1;
	cycle_run(d, m, domain, ecrt_domain_data(domain));
	still_end();
	return 0;
}

int main(int argc, char **argv)
{
	static struct demo d = { .cycles = 5000, .period_us = 1000,
				 .wait_s = 30 };
	ec_master_t *m;
	int ret;

	parse(&d, argc, argv);
	if (trace_alloc(&d.analog, d.cycles) ||
	    trace_alloc(&d.digital, d.cycles)) {
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
	trace_judge(&d.analog);
	trace_judge(&d.digital);
	if (d.json)
		report_json(&d);
	else
		report_text(&d);
	return demo_passed(&d) ? 0 : 1;
}
