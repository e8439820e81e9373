// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * sdo_requests: SDO and register requests and emergencies of one slave, beside a cycle of 1 ms
 * that does not wait for them. Reads serial number and station address, writes object 0x2001:08
 * and reads it back (use another object for a real slave), reads an object that the slave does
 * not have, and accesses an absent slave. Prints the results, the next emergencies, and the
 * number of cycles with a BUSY request. usage() has the arguments.
 */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <ecrt.h>

#define PERIOD_NS	1000000L
#define WAIT_CYCLES	20000	/* of one step */

static ec_master_t *master;
static ec_domain_t *domain;
static unsigned long busy;
static unsigned int failed;	/* steps */
static volatile sig_atomic_t stop;

static void usage(FILE *file)
{
	fprintf(file, "usage: sdo_requests POSITION\n"
		"SDO and register requests and emergencies of one slave beside a cycle of 1 ms.\n"
		"WARNING: it writes object 0x2001:08 of the slave.\n"
		"  POSITION  ring position of the slave, see 'ethercat slaves'\n"
		"exit status: 0 each step had the expected result; 1 failure or Ctrl-C; 2 invalid\n"
		"argument\n");
}

/* Returns the position; exits for --help and for invalid arguments. */
static uint16_t parse(int argc, char **argv)
{
	const char *arg = argc > 1 ? argv[1] : "";
	unsigned long position;
	char *end;

	if (!strcmp(arg, "--help") || !strcmp(arg, "-h")) {
		usage(stdout);
		exit(0);
	}
	position = strtoul(arg, &end, 10);
	if (argc == 2 && *arg >= '0' && *arg <= '9' && !*end && position <= 0xffff)
		return (uint16_t)position;
	if (argc < 2)
		fprintf(stderr, "sdo_requests: POSITION is missing\n");
	else
		fprintf(stderr, "sdo_requests: invalid argument '%s'\n", argv[argc - 1]);
	usage(stderr);
	exit(2);
}

static void on_signal(int number)
{
	(void)number;
	stop = 1;
}

static void cycle(struct timespec *t)
{
	t->tv_nsec += PERIOD_NS;
	if (t->tv_nsec >= 1000000000L) {
		t->tv_nsec -= 1000000000L;
		t->tv_sec++;
	}
	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, t, NULL);
	ecrt_master_receive(master);
	ecrt_domain_process(domain);
	ecrt_domain_queue(domain);
	ecrt_master_send(master);
}

static const char *name(ec_request_state_t state)
{
	static const char *const names[] = { "UNUSED", "BUSY", "SUCCESS", "ERROR" };

	return names[state];
}

/* Cycles until the request is not BUSY any more. */
static ec_request_state_t finish(struct timespec *t, ec_sdo_request_t *req)
{
	unsigned int i;

	for (i = 0; i < WAIT_CYCLES && !stop &&
	     ecrt_sdo_request_state(req) == EC_REQUEST_BUSY; i++) {
		cycle(t);
		busy++;
	}
	return ecrt_sdo_request_state(req);
}

/* One step; @expected: what it is to end with. */
static void show(const char *what, ec_request_state_t state, ec_request_state_t expected)
{
	printf("%s: %s", what, name(state));
	if (state != expected) {
		printf(" (expected %s)", name(expected));
		failed++;
	}
}

static void show_object(const char *what, ec_request_state_t expected, struct timespec *t,
			ec_sdo_request_t *req)
{
	const ec_request_state_t state = finish(t, req);

	show(what, state, expected);
	if (state == EC_REQUEST_SUCCESS)
		printf(" 0x%08x, %zu bytes", EC_READ_U32(ecrt_sdo_request_data(req)),
		       ecrt_sdo_request_data_size(req));
	printf("\n");
}

static void read_object(struct timespec *t, const char *what, ec_request_state_t expected,
			ec_sdo_request_t *req, uint16_t index, uint8_t subindex)
{
	ecrt_sdo_request_index(req, index, subindex);
	ecrt_sdo_request_read(req);
	show_object(what, expected, t, req);
}

static void write_object(struct timespec *t, ec_sdo_request_t *req, uint32_t value)
{
	ecrt_sdo_request_index(req, 0x2001, 8);
	EC_WRITE_U32(ecrt_sdo_request_data(req), value);
	ecrt_sdo_request_write(req);
	show("write", finish(t, req), EC_REQUEST_SUCCESS);
	printf("\n");
	EC_WRITE_U32(ecrt_sdo_request_data(req), 0);
	read_object(t, "read back", EC_REQUEST_SUCCESS, req, 0x2001, 8);
	failed += EC_READ_U32(ecrt_sdo_request_data(req)) != value;
}

static void read_register(struct timespec *t, ec_reg_request_t *req)
{
	unsigned int i;

	ecrt_reg_request_read(req, 0x0010, 2);
	for (i = 0; i < WAIT_CYCLES && !stop &&
	     ecrt_reg_request_state(req) == EC_REQUEST_BUSY; i++)
		cycle(t);
	show("register", ecrt_reg_request_state(req), EC_REQUEST_SUCCESS);
	printf(" 0x%04x\n", EC_READ_U16(ecrt_reg_request_data(req)));
}

/* Waits for an emergency and reads all. */
static void emergencies(struct timespec *t, ec_slave_config_t *sc)
{
	uint8_t e[EC_COE_EMERGENCY_MSG_SIZE];
	unsigned int i, n = 0;

	for (i = 0; i < WAIT_CYCLES && !n && !stop; i++) {
		cycle(t);
		for (; !ecrt_slave_config_emerg_pop(sc, e); n++)
			printf("emergency: 0x%04x register 0x%02x\n", EC_READ_U16(e), e[2]);
	}
	if (!n)
		printf("no emergency in %lu s\n", i / (1000000000L / PERIOD_NS));
	printf("dropped emergencies: %d\n", ecrt_slave_config_emerg_overruns(sc));
}

/* Default process data of the slave, so that it reaches OP. */
static ec_slave_config_t *configure(uint16_t position, ec_slave_info_t *info)
{
	ec_slave_config_t *sc;
	ec_sync_info_t sync;
	unsigned int bit;
	uint8_t i;

	if (ecrt_master_get_slave(master, position, info))
		return NULL;
	sc = ecrt_master_slave_config(master, 0, position, info->vendor_id, info->product_code);
	for (i = 0; sc && i < info->sync_count; i++)
		if (!ecrt_master_get_sync_manager(master, position, i, &sync) && sync.n_pdos &&
		    ecrt_slave_config_reg_pdo_entry_pos(sc, i, 0, 0, domain, &bit) < 0)
			return NULL;
	return sc;
}

/* Returns 0 when the slave is in OP. */
static int wait_op(struct timespec *t, ec_slave_config_t *sc)
{
	ec_slave_config_state_t state;
	char reason[256];
	unsigned int i;

	memset(&state, 0, sizeof(state));
	for (i = 0; i < WAIT_CYCLES && !state.operational && !stop; i++) {
		cycle(t);
		ecrt_slave_config_state(sc, &state);
	}
	if (state.operational) {
		printf("slave is in OP\n");
		return 0;
	}
	if (ecrt_slave_config_reason(sc, reason, sizeof(reason)) <= 0)
		strcpy(reason, "see 'ethercat why'");
	printf("slave is not in OP: %s\n", reason);
	return -1;
}

static int setup(uint16_t position, ec_slave_config_t **sc, ec_slave_config_t **absent)
{
	ec_slave_info_t info;

	/* the library prints the reason of each failure on stderr */
	master = ecrt_request_master(0);
	domain = master ? ecrt_master_create_domain(master) : NULL;
	*sc = domain ? configure(position, &info) : NULL;
	*absent = *sc ? ecrt_master_slave_config(master, 0, 1000, 1, 1) : NULL;
	return *absent ? ecrt_slave_config_emerg_size(*sc, 16) : -1;
}

static void steps(struct timespec *t, ec_slave_config_t *sc, ec_sdo_request_t *sdo,
		  ec_sdo_request_t *lost, ec_reg_request_t *reg)
{
	ecrt_sdo_request_timeout(sdo, 5000);
	ecrt_sdo_request_timeout(lost, 200);
	ecrt_sdo_request_read(lost);
	read_object(t, "serial number", EC_REQUEST_SUCCESS, sdo, 0x1018, 4);
	write_object(t, sdo, 0x1234abcd);
	read_object(t, "no such object", EC_REQUEST_ERROR, sdo, 0x3fff, 0);
	read_register(t, reg);
	printf("cycles with a request: %lu\n", busy);
	show_object("absent slave", EC_REQUEST_ERROR, t, lost);
	emergencies(t, sc);
}

int main(int argc, char **argv)
{
	const uint16_t position = parse(argc, argv);
	ec_slave_config_t *sc, *absent;
	ec_sdo_request_t *sdo, *lost;
	struct sigaction action;
	ec_reg_request_t *reg;
	struct timespec t;

	memset(&action, 0, sizeof(action));
	action.sa_handler = on_signal;
	sigaction(SIGINT, &action, NULL);
	sigaction(SIGTERM, &action, NULL);
	setvbuf(stdout, NULL, _IOLBF, 0);
	if (setup(position, &sc, &absent))
		return 1;
	sdo = ecrt_slave_config_create_sdo_request(sc, 0x1018, 4, 4);
	lost = ecrt_slave_config_create_sdo_request(absent, 0x1018, 4, 4);
	reg = ecrt_slave_config_create_reg_request(sc, 2);
	if (!sdo || !lost || !reg || ecrt_master_activate(master))
		return 1;
	clock_gettime(CLOCK_MONOTONIC, &t);
	if (wait_op(&t, sc))
		failed++;
	else
		steps(&t, sc, sdo, lost, reg);
	if (stop)
		printf("ended by a signal\n");
	else if (failed)
		printf("ended: %u step(s) without the expected result\n", failed);
	else
		printf("ended: each step had the expected result\n");
	ecrt_release_master(master);
	return stop || failed ? 1 : 0;
}
