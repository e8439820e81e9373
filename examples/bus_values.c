// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Example: an application that is configured by a bus file. An output follows an input, both found
 * by their names and scaled as the file says; the kernel runs the cycle. It needs libethercat-bus.
 * usage() has the arguments. See Documentation/bus-file.rst.
 *
 * WARNING: it changes the output. Run it only where that moves or heats nothing.
 */
#define _POSIX_C_SOURCE 200809L	/* clock_gettime() */
#include <ethercat-bus.h>
#include <ethercat-bus/load.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define PERIOD_NS	1000000U
#define SECONDS_MAX	1000000UL

static ec_master_t *master;
static struct ecb_value input, output;
static volatile sig_atomic_t stop;

static void usage(FILE *file)
{
	fprintf(file, "usage: bus_values FILE INPUT OUTPUT SECONDS\n"
		"Configures master 0 by a bus file ('ethercat bus save --whole FILE'), then writes the\n"
		"value of INPUT to OUTPUT, in units of the file: bus_values bus.yaml ai.voltage\n"
		"ao.voltage 10. WARNING: it changes the output.\n"
		"  SECONDS  1 to %lu\n"
		"exit status: 0 after SECONDS, or Ctrl-C; 1 failure; 2 invalid argument\n",
		SECONDS_MAX);
}

static void on_signal(int number)
{
	(void)number;
	stop = 1;
}

/* Returns 0, or prints why not. */
static int find(const char *name, struct ecb_value *value)
{
	value->struct_size = sizeof(*value);
	if (!ecrt_master_value(master, name, value))
		return 0;
	fprintf(stderr, "bus_values: the file has no value %s\n", name);
	return 1;
}

static int setup(char **argv)
{
	struct ecb_loaded loaded;
	ec_cycle_config_t cycle;
	struct ecb_error error;

	if (ecrt_master_load(master, argv[1], &error)) {
		fprintf(stderr, "%s\n", error.text);
		return 1;
	}
	loaded.struct_size = sizeof(loaded);
	if (ecrt_master_loaded(master, &loaded) || find(argv[2], &input) || find(argv[3], &output))
		return 1;
	memset(&cycle, 0, sizeof(cycle));
	cycle.period_ns = loaded.cycle ? (uint32_t)loaded.cycle : PERIOD_NS;
	cycle.dc = loaded.clocks ? EC_CYCLE_SYNC_SLAVES | EC_CYCLE_FOLLOW_REFERENCE : 0;
	return ecrt_master_set_cycle(master, &cycle) || ecrt_master_activate(master);
}

/* Receives and sends all domains; the two values may be in different ones. */
static double now_s(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

/* the cycle is that of the file */
static int exchange(unsigned long seconds)
{
	double end = now_s() + (double)seconds;
	const uint8_t *from = ecrt_domain_data(input.domain);
	uint8_t *to = ecrt_domain_data(output.domain);
	double value = 0;

	while (now_s() < end && !stop) {
		if (ecrt_master_wait_cycle(master, 1000000) < 0 && !stop)
			return 1;
		ecrt_master_receive(master);
		ecrt_domain_process(input.domain);
		value = ecb_value_read(&input, from);
		if (ecb_value_write(&output, to, value))
			fprintf(stderr, "bus_values: %g %s does not fit\n", value, output.unit);
		ecrt_domain_queue(output.domain);
		ecrt_master_send(master);
	}
	printf("%.2f %s in, %.2f %s out\n", value, input.unit, ecb_value_read(&output, to),
	       output.unit);
	return 0;
}

int main(int argc, char **argv)
{
	unsigned long seconds = argc == 5 ? strtoul(argv[4], NULL, 10) : 0;
	int ret;

	if (argc == 2 && (!strcmp(argv[1], "--help") || !strcmp(argv[1], "-h"))) {
		usage(stdout);
		return 0;
	}
	if (!seconds || seconds > SECONDS_MAX || *argv[4] == '-') {
		fprintf(stderr, "bus_values: invalid argument '%s'\n", argv[argc - 1]);
		usage(stderr);
		return 2;
	}
	signal(SIGINT, on_signal);
	signal(SIGTERM, on_signal);
	master = ecrt_request_master(0);
	if (!master)
		return 1;
	ret = setup(argv) || exchange(seconds);
	ecrt_release_master(master);
	return ret;
}
