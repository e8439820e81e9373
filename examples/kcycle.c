// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Example: the kernel runs the cycle, this program only reads inputs and writes outputs. It
 * needs no real-time priority: the frames are punctual in any case. usage() has the arguments.
 *
 * WARNING: it switches outputs. Run it only where no output moves or heats anything.
 *
 * The program increments the first output byte of each slave with digital outputs; 0 stays in all
 * other outputs. It leaves out slaves with the control word of a drive (CiA 402, SoE) in their
 * EEPROM, and names them; they stay in PREOP. See dc_motion.c for drives.
 *
 * With "follow" a frame passes the reference clock always at the same time after the SYNC
 * signals. (ecrt_slave_config_dc() configures such signals, see dc_motion.c.)
 *
 * When the program exits before its last cycle, by a signal or kill -9, the kernel continues the
 * cycle; a new start with the same options continues counting. 'ethercat release' ends the session.
 * See Documentation/kernel-cycle.rst.
 */
#include <ecrt.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define SLAVES_MAX	128
#define PERIOD_NS	1000000U
#define PHASE_NS	250000U		/* of the frame, after SYNC0 */
#define OP_TIMEOUT_S	60
#define CYCLES		5000
#define CYCLES_MAX	1000000000UL

static ec_master_t *master;
static ec_domain_t *domain;
static ec_slave_config_t *slaves[SLAVES_MAX];	/* NULL: a drive, skipped */
static int outputs[SLAVES_MAX];		/* byte of digital outputs in the domain, or -1 */
static unsigned int n_slaves, n_configured;
static unsigned long cycles = CYCLES;
static int follow, interrupt;
static volatile sig_atomic_t stop;

static void usage(FILE *file)
{
	fprintf(file, "usage: kcycle [CYCLES] [follow] [interrupt]\n"
		"The kernel runs a cycle of 1 ms with the default process data of all slaves but\n"
		"drives. The program increments the first output byte of each slave with digital\n"
		"outputs. WARNING: run it only where no output moves or heats anything.\n"
		"  CYCLES     cycles after all slaves are in OP, 1 to %lu; default %d\n"
		"  follow     synchronize the clocks of the slaves, and lock the cycle to the\n"
		"             reference clock\n"
		"  interrupt  run the cycle in the interrupt of its timer: native device, root\n"
		"After Ctrl-C the kernel continues the cycle; 'ethercat release' ends it.\n"
		"exit status: 0 all cycles done, or Ctrl-C; 1 failure; 2 invalid argument\n",
		CYCLES_MAX, CYCLES);
}

/* Exits for --help and for invalid arguments. */
static void parse(int argc, char **argv)
{
	int n_numbers = 0;
	char *end;

	for (int i = 1; i < argc; i++) {
		if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h")) {
			usage(stdout);
			exit(0);
		}
		if (!strcmp(argv[i], "follow")) {
			follow = 1;
			continue;
		}
		if (!strcmp(argv[i], "interrupt")) {
			interrupt = 1;
			continue;
		}
		cycles = strtoul(argv[i], &end, 10);
		if (n_numbers++ || *argv[i] < '0' || *argv[i] > '9' || *end || !cycles ||
		    cycles > CYCLES_MAX) {
			fprintf(stderr, "kcycle: invalid argument '%s'\n", argv[i]);
			usage(stderr);
			exit(2);
		}
	}
}

static void on_signal(int number)
{
	(void)number;
	stop = 1;
}

/* Outputs of a slave by the entries of its PDOs. */
enum outputs {
	NO_OUTPUTS,
	DIGITAL,		/* the first byte has single bits only */
	OTHER,			/* a value of several bits, never changed here */
	DRIVE,			/* control word of CiA 402 or SoE */
};

/* CiA 402 has an object for each of 8 axes, SoE the master control word S-0-0134. */
static int is_control_word(const ec_pdo_entry_info_t *e)
{
	const uint16_t axis = (uint16_t)(e->index - 0x6040);

	return e->bit_length == 16 && (e->index == 0x0086 ||
				       (!e->subindex && axis < 0x4000 && axis % 0x0800 == 0));
}

static enum outputs outputs_of(uint16_t position, uint8_t sync_index, const ec_sync_info_t *sync)
{
	enum outputs found = NO_OUTPUTS;
	unsigned int bits = 0;
	ec_pdo_info_t pdo;
	ec_pdo_entry_info_t entry;

	for (uint16_t i = 0; i < sync->n_pdos; i++) {
		if (ecrt_master_get_pdo(master, position, sync_index, i, &pdo))
			return OTHER;
		for (uint16_t k = 0; k < pdo.n_entries; k++) {
			if (ecrt_master_get_pdo_entry(master, position, sync_index, i, k, &entry))
				return OTHER;
			if (is_control_word(&entry))
				return DRIVE;
			if (bits < 8 && found != OTHER)
				found = entry.bit_length == 1 || !entry.index ? DIGITAL : OTHER;
			bits += entry.bit_length;
		}
	}
	return found;
}

/* The drives, as far as their EEPROMs say. */
static int is_drive(uint16_t position, const ec_slave_info_t *info)
{
	ec_sync_info_t sync;

	for (uint8_t i = 0; i < info->sync_count; i++)
		if (!ecrt_master_get_sync_manager(master, position, i, &sync) &&
		    sync.dir == EC_DIR_OUTPUT && outputs_of(position, i, &sync) == DRIVE)
			return 1;
	return 0;
}

/* Default process data of a slave: every SyncManager with PDOs goes into the domain. */
static int add_slave(uint16_t position)
{
	ec_slave_info_t info;
	ec_sync_info_t sync;
	unsigned int bit;

	outputs[position] = -1;
	if (ecrt_master_get_slave(master, position, &info))
		return -1;
	if (is_drive(position, &info)) {
		printf("slave %u skipped: %s is a drive\n", position, info.name);
		return 0;
	}
	slaves[position] = ecrt_master_slave_config(master, 0, position, info.vendor_id,
						    info.product_code);
	if (!slaves[position])
		return -1;
	for (uint8_t i = 0; i < info.sync_count; i++) {
		int offset;

		if (ecrt_master_get_sync_manager(master, position, i, &sync))
			return -1;
		if (!sync.n_pdos)
			continue;
		offset = ecrt_slave_config_reg_pdo_entry_pos(slaves[position], i, 0, 0, domain,
							     &bit);
		if (offset < 0)
			return -1;
		if (sync.dir == EC_DIR_OUTPUT && outputs[position] < 0 &&
		    outputs_of(position, i, &sync) == DIGITAL)
			outputs[position] = offset;
	}
	return 0;
}

static int configure(void)
{
	/*
	 * Any CPU may run the cycle; to name one: EC_CYCLE_BIND_CPU and .cpu = 1. Without outputs
	 * of this program, also after its exit, the slaves get the last ones. All members, in the
	 * order of ecrt.h, so that this is C++20 as well.
	 */
	ec_cycle_config_t cycle = {
		.period_ns = PERIOD_NS,
		.phase_ns = follow ? PHASE_NS : 0U,
		.cpu = 0,
		.priority = 0,
		.stall = EC_CYCLE_HOLD,
		.stall_cycles = 0,
		.dc = follow ? EC_CYCLE_SYNC_SLAVES | EC_CYCLE_FOLLOW_REFERENCE : 0U,
		.flags = EC_CYCLE_DETACH | (interrupt ? EC_CYCLE_INTERRUPT : 0U),
	};
	ec_master_info_t info;

	domain = ecrt_master_create_domain(master);
	if (!domain || ecrt_master(master, &info))
		return -1;
	n_slaves = info.slave_count;
	if (!n_slaves || n_slaves > SLAVES_MAX) {
		fprintf(stderr, "kcycle: %u slaves found, expected 1 to %u\n", n_slaves,
			SLAVES_MAX);
		return -1;
	}
	for (unsigned int i = 0; i < n_slaves; i++) {
		if (add_slave((uint16_t)i))
			return -1;
		n_configured += slaves[i] != NULL;
	}
	if (!n_configured) {
		fprintf(stderr, "kcycle: no slave but drives found\n");
		return -1;
	}
	return ecrt_master_set_cycle(master, &cycle);
}

/*
 * One cycle: wait for the cycle of the kernel, take its inputs, give outputs for the next cycle.
 * The wait is the only system call. Returns the result of ecrt_master_wait_cycle().
 */
static int cycle(ec_domain_state_t *state)
{
	uint8_t *data = ecrt_domain_data(domain);
	int n = ecrt_master_wait_cycle(master, 1000000);

	if (n < 0)
		return n;
	ecrt_master_receive(master);
	ecrt_domain_process(domain);
	ecrt_domain_state(domain, state);
	for (unsigned int i = 0; i < n_slaves; i++)
		if (outputs[i] >= 0)
			EC_WRITE_U8(data + outputs[i], EC_READ_U8(data + outputs[i]) + 1);
	ecrt_domain_queue(domain);
	ecrt_master_send(master);
	return n;
}

/* Age of the current inputs, ns: time since their cycle began. */
static int64_t age(void)
{
	struct timespec now;
	uint64_t began;

	clock_gettime(CLOCK_MONOTONIC, &now);
	if (ecrt_master_cycle_inputs(master, NULL, &began))
		return 0;
	return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec - (int64_t)began;
}

/* The clocks need about a second to synchronize, then the cycle locks. */
static int locked(void)
{
	ec_cycle_state_t state;

	return !follow || (!ecrt_master_cycle_state(master, &state) &&
			   state.lock == EC_CYCLE_LOCKED);
}

/* Returns whether all slaves are in OP; @name: prints the reason of each one that is not. */
static int in_op(int name)
{
	ec_slave_config_state_t state;
	char reason[256];
	int all = 1;

	for (unsigned int i = 0; i < n_slaves; i++) {
		if (!slaves[i] ||
		    (!ecrt_slave_config_state(slaves[i], &state) && state.operational))
			continue;
		all = 0;
		if (!name)
			break;
		if (ecrt_slave_config_reason(slaves[i], reason, sizeof(reason)) <= 0)
			strcpy(reason, "run 'ethercat why'");
		fprintf(stderr, "kcycle: slave %u is not in OP: %s\n", i, reason);
	}
	return all;
}

static void report(int64_t oldest)
{
	ec_cycle_state_t state;

	ecrt_master_cycle_state(master, &state);
	printf("kernel: %" PRIu64 " cycles, %" PRIu64 " overruns, sent up to %" PRIu32
	       " ns after the schedule\n", state.cycles, state.overruns, state.late_max);
	printf("inputs taken up to %" PRId64 " ns after their cycle began\n", oldest);
	if (follow)
		printf("reference clock: runs %+" PRId32 " ppb, phase error %" PRId32
		       " ns, lost %" PRIu32 " times\n", state.rate_ppb, state.phase_error,
		       state.lock_losses);
}

/* The reason why cycle() returned @n below 0. */
static int ended(int n)
{
	if (stop) {
		printf("ended by a signal: the kernel continues the cycle\n");
		printf("'ethercat release' ends the session\n");
		return 0;
	}
	fprintf(stderr, "kcycle: the cycle ended: %s\n", strerror(-n));
	return -1;
}

/* Returns 1 when all slaves are in OP and the cycle is locked, else the result of run(). */
static int start(void)
{
	time_t end = time(NULL) + OP_TIMEOUT_S;
	ec_domain_state_t domain_state;
	int n;

	while (!(in_op(0) && locked())) {
		n = stop ? -1 : cycle(&domain_state);
		if (n < 0)
			return ended(n);
		if (time(NULL) < end)
			continue;
		if (in_op(1))
			fprintf(stderr, "kcycle: cycle not locked after %d s, see 'ethercat dc'\n",
				OP_TIMEOUT_S);
		return -1;
	}
	return 1;
}

/* Returns 0: all cycles done; -1: failure. */
static int run(void)
{
	unsigned long skipped = 0, incomplete = 0;
	int64_t oldest = 0, ns;
	ec_domain_state_t domain_state;
	ec_cycle_state_t state;
	int n = start();

	if (n <= 0)
		return n;
	ecrt_master_cycle_state(master, &state);
	printf("%u slaves in OP%s\n", n_configured, state.takeovers ? "; cycle taken over" : "");
	for (unsigned long i = 0; i < cycles; i++) {
		n = stop ? -1 : cycle(&domain_state);
		if (n < 0)
			return ended(n);
		/* cycles that this program missed; the kernel has sent their frames */
		skipped += (unsigned long)n - 1;
		incomplete += domain_state.wc_state != EC_WC_COMPLETE;
		ns = age();
		oldest = ns > oldest ? ns : oldest;
	}
	printf("%lu cycles, %lu skipped, %lu incomplete\n", cycles, skipped, incomplete);
	report(oldest);
	printf("ended after %lu cycles\n", cycles);
	return 0;
}

int main(int argc, char **argv)
{
	struct sigaction action;
	int ret = -1;

	parse(argc, argv);
	memset(&action, 0, sizeof(action));
	action.sa_handler = on_signal;
	sigaction(SIGINT, &action, NULL);
	sigaction(SIGTERM, &action, NULL);
	setvbuf(stdout, NULL, _IOLBF, 0);
	/* the library prints the reason of each failure on stderr */
	master = ecrt_request_master(0);
	if (!master)
		return 1;
	if (!configure() && !ecrt_master_activate(master)) {
		ret = run();
		/* without this call the kernel continues the cycle */
		if (!stop)
			ecrt_master_deactivate(master);
	}
	ecrt_release_master(master);
	return ret ? 1 : 0;
}
