// SPDX-License-Identifier: GPL-2.0-only
/*
 * sdo_requests: SDO and register requests and emergencies of one slave, beside a cycle of 1 ms
 * that does not wait for them. Reads serial number and station address, writes object 0x2001:08
 * and reads it back (use another object for a real slave), reads an object that the slave does
 * not have, and accesses an absent slave. Prints the results, the next emergencies, and the
 * number of cycles with a BUSY request.
 *
 * usage: sdo_requests POSITION
 */
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

	for (i = 0; i < WAIT_CYCLES && ecrt_sdo_request_state(req) == EC_REQUEST_BUSY; i++) {
		cycle(t);
		busy++;
	}
	return ecrt_sdo_request_state(req);
}

static void show(const char *what, ec_request_state_t state, const ec_sdo_request_t *req)
{
	printf("%s: %s", what, name(state));
	if (state == EC_REQUEST_SUCCESS)
		printf(" 0x%08x, %zu bytes", EC_READ_U32(ecrt_sdo_request_data(req)),
		       ecrt_sdo_request_data_size(req));
	printf("\n");
}

static void read_object(struct timespec *t, const char *what, ec_sdo_request_t *req,
			uint16_t index, uint8_t subindex)
{
	ecrt_sdo_request_index(req, index, subindex);
	ecrt_sdo_request_read(req);
	show(what, finish(t, req), req);
}

static void write_object(struct timespec *t, ec_sdo_request_t *req, uint32_t value)
{
	ecrt_sdo_request_index(req, 0x2001, 8);
	EC_WRITE_U32(ecrt_sdo_request_data(req), value);
	ecrt_sdo_request_write(req);
	printf("write: %s\n", name(finish(t, req)));
	EC_WRITE_U32(ecrt_sdo_request_data(req), 0);
	read_object(t, "read back", req, 0x2001, 8);
}

static void read_register(struct timespec *t, ec_reg_request_t *req)
{
	unsigned int i;

	ecrt_reg_request_read(req, 0x0010, 2);
	for (i = 0; i < WAIT_CYCLES && ecrt_reg_request_state(req) == EC_REQUEST_BUSY; i++)
		cycle(t);
	printf("register: %s 0x%04x\n", name(ecrt_reg_request_state(req)),
	       EC_READ_U16(ecrt_reg_request_data(req)));
}

/* Waits for an emergency and reads all. */
static void emergencies(struct timespec *t, ec_slave_config_t *sc)
{
	uint8_t e[EC_COE_EMERGENCY_MSG_SIZE];
	unsigned int i, n = 0;

	for (i = 0; i < WAIT_CYCLES && !n; i++) {
		cycle(t);
		for (; !ecrt_slave_config_emerg_pop(sc, e); n++)
			printf("emergency: 0x%04x register 0x%02x\n", EC_READ_U16(e), e[2]);
	}
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

static void wait_op(struct timespec *t, ec_slave_config_t *sc)
{
	ec_slave_config_state_t state = { 0 };
	unsigned int i;

	for (i = 0; i < WAIT_CYCLES && !state.operational; i++) {
		cycle(t);
		ecrt_slave_config_state(sc, &state);
	}
	printf("slave is %s\n", state.operational ? "in OP" : "not in OP");
}

int main(int argc, char **argv)
{
	ec_slave_config_t *sc, *absent;
	ec_sdo_request_t *sdo, *lost;
	ec_reg_request_t *reg;
	ec_slave_info_t info;
	struct timespec t;

	if (argc != 2) {
		fprintf(stderr, "usage: sdo_requests POSITION\n");
		return 2;
	}
	master = ecrt_request_master(0);
	domain = master ? ecrt_master_create_domain(master) : NULL;
	sc = domain ? configure((uint16_t)atoi(argv[1]), &info) : NULL;
	absent = sc ? ecrt_master_slave_config(master, 0, 1000, 1, 1) : NULL;
	if (!absent || ecrt_slave_config_emerg_size(sc, 16))
		return 1;
	sdo = ecrt_slave_config_create_sdo_request(sc, 0x1018, 4, 4);
	lost = ecrt_slave_config_create_sdo_request(absent, 0x1018, 4, 4);
	reg = ecrt_slave_config_create_reg_request(sc, 2);
	if (!sdo || !lost || !reg || ecrt_master_activate(master))
		return 1;
	clock_gettime(CLOCK_MONOTONIC, &t);
	wait_op(&t, sc);
	ecrt_sdo_request_timeout(sdo, 5000);
	ecrt_sdo_request_timeout(lost, 200);
	ecrt_sdo_request_read(lost);
	read_object(&t, "serial number", sdo, 0x1018, 4);
	write_object(&t, sdo, 0x1234abcd);
	read_object(&t, "no such object", sdo, 0x3fff, 0);
	read_register(&t, reg);
	printf("cycles with a request: %lu\n", busy);
	show("absent slave", finish(&t, lost), lost);
	emergencies(&t, sc);
	ecrt_release_master(master);
	return 0;
}
