// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Example: analog output 1 of an EL4002 is half of analog input 1 of an EL3062, 1000 times a
 * second. A startup SDO selects the filter of the input. The clocks are synchronized: the EL4002
 * takes over its output at SYNC0. The kernel runs the cycle; mirror.c runs its own.
 */
#include <ecrt.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PERIOD_NS	1000000U
#define SHIFT_NS	500000		/* SYNC0, later than the frame */
#define VOLTS(value)	((value) * 10.0 / 32767)

static ec_master_t *master;
static ec_domain_t *domain;
static ec_slave_config_t *slaves[2];	/* input, output */
static unsigned long args[3] = { 2, 3, 10 };
static volatile sig_atomic_t stop;

static const char usage[] = "usage: analog [INPUT [OUTPUT [SECONDS]]]\n"
	"An analog output follows an analog input. WARNING: it switches an output.\n"
	"  INPUT, OUTPUT  ring positions of an EL3062 and an EL4002, see 'ethercat slaves';\n"
	"                 default 2 and 3, as in the simulated segment \"bench\"\n"
	"  SECONDS        to run, 1 to 65535; default 10\n"
	"exit status: 0 by time or Ctrl-C; 1 failure, or a slave not in OP; 2 invalid argument\n";

/* Exits for --help and for invalid arguments. */
static void parse(int argc, char **argv)
{
	for (int i = 1; i < argc; i++) {
		char *end;
		unsigned long value = strtoul(argv[i], &end, 10);

		if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
			fputs(usage, stdout);
			exit(0);
		}
		if (i > 3 || *argv[i] < '0' || *argv[i] > '9' || *end || value > 0xffff ||
		    (i == 3 && !value)) {
			fprintf(stderr, "analog: invalid argument '%s'\n%s", argv[i], usage);
			exit(2);
		}
		args[i - 1] = value;
	}
}

static void on_signal(int number)
{
	(void)number;
	stop = 1;
}

/* Default PDOs. The library prints the reason of each failure on stderr. */
static int setup(int *input, int *output)
{
	ec_cycle_config_t cycle;

	memset(&cycle, 0, sizeof(cycle));
	cycle.period_ns = PERIOD_NS;
	cycle.dc = EC_CYCLE_SYNC_SLAVES | EC_CYCLE_FOLLOW_REFERENCE;
	domain = ecrt_master_create_domain(master);
	slaves[0] = ecrt_master_slave_config(master, 0, (uint16_t)args[0], 2, 0x0bf63052);
	slaves[1] = ecrt_master_slave_config(master, 0, (uint16_t)args[1], 2, 0x0fa23052);
	*input = ecrt_slave_config_reg_pdo_entry(slaves[0], 0x6000, 0x11, domain, NULL);
	*output = ecrt_slave_config_reg_pdo_entry(slaves[1], 0x7000, 0x01, domain, NULL);
	/* startup SDO: filter 2, IIR 1; 0x0300: AssignActivate, see the ESI of the slave */
	return *input < 0 || *output < 0 ||
	       ecrt_slave_config_sdo16(slaves[0], 0x8000, 0x15, 2) ||
	       ecrt_slave_config_dc(slaves[1], 0x0300, PERIOD_NS, SHIFT_NS, 0, 0) ||
	       ecrt_master_set_cycle(master, &cycle) || ecrt_master_activate(master);
}

/* Returns 0, or the errno that ended the cycle. */
static int run(int input, int output)
{
	uint8_t *data = ecrt_domain_data(domain);

	for (unsigned long n = 1; n <= args[2] * 1000 && !stop; n++) {
		int value, ret = ecrt_master_wait_cycle(master, 1000000);

		if (ret < 0 && !stop)
			return -ret;
		ecrt_master_receive(master);
		ecrt_domain_process(domain);
		value = EC_READ_S16(data + input);	/* 0 to 32767 */
		EC_WRITE_S16(data + output, (int16_t)(value / 2));
		ecrt_domain_queue(domain);
		ecrt_master_send(master);
		if (n % 1000 == 0)
			printf("input %.2f V, output %.2f V\n", VOLTS(value), VOLTS(value / 2));
	}
	return 0;
}

int main(int argc, char **argv)
{
	int input, output, ret;
	char reason[256];

	parse(argc, argv);
	signal(SIGINT, on_signal);
	signal(SIGTERM, on_signal);
	master = ecrt_request_master(0);
	if (!master || setup(&input, &output))
		return 1;	/* the kernel releases the master */
	ret = run(input, output);
	printf("ended %s\n", ret ? strerror(ret) : stop ? "by a signal" : "after the given time");
	for (int i = 0; i < 2; i++)
		if (ecrt_slave_config_reason(slaves[i], reason, sizeof(reason)) > 0) {
			printf("slave %lu is not in OP: %s\n", args[i], reason);
			ret = 1;
		}
	ecrt_release_master(master);
	return ret ? 1 : 0;
}
