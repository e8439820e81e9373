// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * mirror: eight digital inputs switch eight digital outputs, 1000 times a
 * second. The smallest complete application: configure, activate, run the
 * cycle in a real-time thread, stop cleanly. usage() has the arguments.
 *
 * For other slaves: "ethercat cstruct" prints the tables to insert here.
 */
#include <ecrt.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

#define PERIOD_NS	1000000L
#define NS_PER_S	1000000000L
#define CHANNELS	8
#define BECKHOFF	0x00000002u
#define EL1008		0x03f03052u
#define EL2008		0x07d83052u

static ec_master_t *master;
static ec_domain_t *domain;
static uint8_t *data;

/* position of a channel in the domain, written by the registration */
static unsigned int in_byte[CHANNELS], in_bit[CHANNELS];
static unsigned int out_byte[CHANNELS], out_bit[CHANNELS];

/* inputs, outputs */
static struct {
	ec_slave_config_t *config;
	uint16_t position;
} slaves[2];

static volatile sig_atomic_t stop;

static void usage(FILE *file)
{
	fprintf(file, "usage: mirror [INPUTS [OUTPUTS [SECONDS]]]\n"
		"Eight digital inputs switch eight digital outputs, 1000 times a second.\n"
		"WARNING: run it only where no output moves or heats anything.\n"
		"  INPUTS, OUTPUTS  ring positions of an EL1008 and an EL2008, see 'ethercat\n"
		"                   slaves'; default 1 and 2\n"
		"  SECONDS          to run, 1 to 65535; default: until Ctrl-C\n"
		"exit status: 0 ended by time or Ctrl-C, both slaves in OP; 1 failure, or a\n"
		"slave not in OP at the end; 2 invalid argument\n");
}

/* Exits for --help and for invalid arguments. @values: their defaults. */
static void parse(int argc, char **argv, unsigned long values[3])
{
	unsigned long value;
	char *end;
	int i;

	for (i = 1; i < argc; i++) {
		if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
			usage(stdout);
			exit(0);
		}
		value = strtoul(argv[i], &end, 10);
		if (i > 3 || *argv[i] < '0' || *argv[i] > '9' || *end || value > 0xffff ||
		    (i == 3 && !value)) {
			fprintf(stderr, "mirror: invalid argument '%s'\n", argv[i]);
			usage(stderr);
			exit(2);
		}
		values[i - 1] = value;
	}
}

static void on_signal(int number)
{
	(void)number;
	stop = 1;
}

/* configuration --------------------------------------------------------------*/

/* One PDO with one entry of one bit for each channel, in one SyncManager. */
static int configure(uint16_t position, uint32_t product, ec_direction_t dir,
		     unsigned int byte[], unsigned int bit[])
{
	const uint16_t object = dir == EC_DIR_INPUT ? 0x6000 : 0x7000;
	const uint16_t pdo = dir == EC_DIR_INPUT ? 0x1a00 : 0x1600;
	ec_pdo_entry_info_t entries[CHANNELS];
	ec_pdo_info_t pdos[CHANNELS];
	const ec_sync_info_t syncs[] = {
		{ 0, dir, CHANNELS, pdos,
		  dir == EC_DIR_OUTPUT ? EC_WD_ENABLE : EC_WD_DISABLE },
		{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
	};
	ec_pdo_entry_reg_t regs[CHANNELS + 1];
	ec_slave_config_t *sc;
	unsigned int i;

	slaves[dir == EC_DIR_OUTPUT].position = position;
	memset(regs, 0, sizeof(regs));	/* an index of 0 ends the list */
	for (i = 0; i < CHANNELS; i++) {
		entries[i].index = (uint16_t)(object + 0x10 * i);
		entries[i].subindex = 1;
		entries[i].bit_length = 1;
		pdos[i].index = (uint16_t)(pdo + i);
		pdos[i].n_entries = 1;
		pdos[i].entries = &entries[i];
		regs[i].position = position;
		regs[i].vendor_id = BECKHOFF;
		regs[i].product_code = product;
		regs[i].index = entries[i].index;
		regs[i].subindex = 1;
		regs[i].offset = &byte[i];
		regs[i].bit_position = &bit[i];
	}
	/* the slave may be absent: the master configures it when it connects */
	sc = ecrt_master_slave_config(master, 0, position, BECKHOFF, product);
	if (!sc || ecrt_slave_config_pdos(sc, EC_END, syncs))
		return -1;
	slaves[dir == EC_DIR_OUTPUT].config = sc;
	return ecrt_domain_reg_pdo_entry_list(domain, regs);
}

/* The library prints the reason of each failure on stderr. */
static int setup(uint16_t inputs, uint16_t outputs)
{
	master = ecrt_request_master(0);
	if (!master)
		return -1;
	domain = ecrt_master_create_domain(master);
	if (!domain ||
	    configure(inputs, EL1008, EC_DIR_INPUT, in_byte, in_bit) ||
	    configure(outputs, EL2008, EC_DIR_OUTPUT, out_byte, out_bit) ||
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

/* cycle ----------------------------------------------------------------------*/

/* Sleeps until the next cycle; skips cycles that have passed. */
static unsigned int wait_period(struct timespec *next)
{
	unsigned int missed = 0;
	struct timespec now;

	for (;; missed++) {
		next->tv_nsec += PERIOD_NS;
		if (next->tv_nsec >= NS_PER_S) {
			next->tv_nsec -= NS_PER_S;
			next->tv_sec++;
		}
		clock_gettime(CLOCK_MONOTONIC, &now);
		if (next->tv_sec > now.tv_sec ||
		    (next->tv_sec == now.tv_sec && next->tv_nsec > now.tv_nsec))
			break;
	}
	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, next, NULL);
	return missed;
}

/* one cycle; @off: outputs are switched off; returns the inputs, bit by bit */
static unsigned int cycle(int off)
{
	unsigned int i, value, inputs = 0;

	ecrt_master_receive(master);
	ecrt_domain_process(domain);
	for (i = 0; i < CHANNELS; i++) {
		value = EC_READ_BIT(data + in_byte[i], in_bit[i]) ? 1 : 0;
		inputs |= value << i;
		EC_WRITE_BIT(data + out_byte[i], out_bit[i], value && !off);
	}
	ecrt_domain_queue(domain);
	ecrt_master_send(master);
	return inputs;
}

/*
 * Prints changes. Printing takes too long for a cycle: an application with hard limits prints in
 * a thread without real-time priority.
 */
static void report(unsigned int inputs)
{
	static unsigned int last_inputs, last_states, last_wc;
	ec_master_state_t ms;
	ec_domain_state_t ds;

	/* both only read memory: fast enough for each cycle */
	ecrt_master_state(master, &ms);
	ecrt_domain_state(domain, &ds);
	if (ms.al_states != last_states)
		printf("AL states: 0x%02x of %u slaves\n", ms.al_states,
		       ms.slaves_responding);
	if (ds.wc_state != last_wc)
		printf("working counter: %u, %s\n", ds.working_counter,
		       ds.wc_state == EC_WC_COMPLETE ? "complete" : "not complete");
	if (inputs != last_inputs)
		printf("inputs: 0x%02x\n", inputs);
	last_states = ms.al_states;
	last_wc = ds.wc_state;
	last_inputs = inputs;
}

static void run(unsigned long cycles)
{
	unsigned long n, missed = 0;
	struct timespec next;
	unsigned int i;

	clock_gettime(CLOCK_MONOTONIC, &next);
	for (n = 0; !stop && (!cycles || n < cycles); n++) {
		missed += wait_period(&next);
		report(cycle(0));
	}
	/* send zeros before the last frame */
	for (i = 0; i < 10; i++) {
		wait_period(&next);
		cycle(1);
	}
	printf("%lu cycles, %lu skipped\n", n, missed);
	if (stop)
		printf("ended by a signal\n");
	else
		printf("ended after %lu s\n", n / (unsigned long)(NS_PER_S / PERIOD_NS));
}

/* Prints why; returns how many of the slaves are not in OP. */
static int not_in_op(void)
{
	ec_slave_config_state_t state;
	char reason[256];
	int i, n = 0;

	for (i = 0; i < 2; i++) {
		if (!ecrt_slave_config_state(slaves[i].config, &state) && state.operational)
			continue;
		n++;
		if (ecrt_slave_config_reason(slaves[i].config, reason, sizeof(reason)) <= 0)
			reason[0] = 0;
		printf("slave %u is not in OP: %s\n", slaves[i].position,
		       reason[0] ? reason : "see 'ethercat why'");
	}
	return n;
}

int main(int argc, char **argv)
{
	unsigned long args[3] = { 1, 2, 0 };
	struct sigaction action;
	int failed;

	parse(argc, argv, args);
	memset(&action, 0, sizeof(action));
	action.sa_handler = on_signal;
	sigaction(SIGINT, &action, NULL);
	sigaction(SIGTERM, &action, NULL);

	if (setup((uint16_t)args[0], (uint16_t)args[1])) {
		ecrt_release_master(master);
		return 1;
	}
	setvbuf(stdout, NULL, _IOLBF, 0);
	become_realtime();
	run(args[2] * (unsigned long)(NS_PER_S / PERIOD_NS));
	failed = not_in_op();
	ecrt_release_master(master);	/* slaves go to PREOP */
	return failed ? 1 : 0;
}
