// SPDX-License-Identifier: GPL-2.0-only
/*
 * A client with the habits of a machine controller's driver: each slave is
 * configured in full, SyncManagers 0 to 3; objects are written twice; several
 * domains at different rates; all states are asked for in each cycle; activation
 * happens in the first cycle of a real-time thread.
 */
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>

#include "api.h"

#define DOMAINS		3
#define OP_CYCLES	20000

static const struct {
	uint32_t vendor, product;
} known[SLAVES] = {
	[OUT] = { BECKHOFF, EL2008 },
	[IN] = { BECKHOFF, EL1008 }, [SERVO] = { BECKHOFF, EL7201 },
	[SWITCH] = { BECKHOFF, EL6614 },
};

/* domain 0 has the drives, 1 outputs, 2 inputs; queued every n-th cycle */
static const unsigned int divider[DOMAINS] = { 1, 2, 4 };
static const unsigned int expected[DOMAINS] = { 5, 1, 1 };

static ec_master_t *m;
static ec_domain_t *dom[DOMAINS];
static ec_slave_config_t *sc[SLAVES];
static ec_sdo_request_t *sdo;
static uint8_t *data[DOMAINS];
static int size[DOMAINS];
static unsigned int control, status, mode, bit7[8], byte7[8], inb[8], inbit[8];
static unsigned int servo, servo_bit, mode_bit, status_bit, control_bit;
static bool queued[DOMAINS], multi;
static unsigned long cycle, al_changes, wc_changes, sc_changes;
static ec_master_state_t ms;
static ec_domain_state_t ds[DOMAINS];
static ec_slave_config_state_t ss[SLAVES];

/* configuration --------------------------------------------------------------*/

static void drive_syncs(ec_slave_config_t *c)
{
	static const ec_pdo_entry_info_t out[] = {
		{ 0x6040, 0, 16 }, { 0, 0, 3 }, { 0x6060, 0, 8 }, { 0, 0, 5 }, { 0x60ff, 0, 32 },
	};
	static const ec_pdo_entry_info_t in[] = { { 0x6041, 0, 16 }, { 0, 0, 16 }, { 0x6064, 0, 32 } };
	static const ec_pdo_info_t rx = { 0x1600, 5, out }, tx = { 0x1a00, 3, in };
	const ec_sync_info_t syncs[] = {
		{ 0, EC_DIR_OUTPUT, 0, NULL, EC_WD_DEFAULT }, { 1, EC_DIR_INPUT, 0, NULL, EC_WD_DEFAULT },
		{ 2, EC_DIR_OUTPUT, 1, &rx, EC_WD_DEFAULT }, { 3, EC_DIR_INPUT, 1, &tx, EC_WD_DEFAULT },
		{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
	};

	IS(ecrt_slave_config_pdos(c, EC_END, syncs), 0);
}

/* simple I/O: SyncManager 0 is process data */
static void io_syncs(ec_slave_config_t *c, ec_direction_t dir)
{
	ec_pdo_entry_info_t e[8];
	ec_pdo_info_t p[8];
	const ec_sync_info_t syncs[] = {
		{ 0, dir, 8, p, EC_WD_DEFAULT }, { 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
	};

	for (unsigned int i = 0; i < 8; i++) {
		e[i] = (ec_pdo_entry_info_t){
			(uint16_t)((dir == EC_DIR_INPUT ? 0x6000 : 0x7000) + 16 * i), 1, 1 };
		p[i] = (ec_pdo_info_t){
			(uint16_t)((dir == EC_DIR_INPUT ? 0x1a00 : 0x1600) + i), 1, &e[i] };
	}
	IS(ecrt_slave_config_pdos(c, EC_END, syncs), 0);
}

static void lists(const ec_slave_info_t *drive)
{
	const ec_pdo_entry_reg_t d0[] = {
		{ 0, MOTOR, drive->vendor_id, drive->product_code, 0x6040, 0, &control, &control_bit },
		{ 0, MOTOR, drive->vendor_id, drive->product_code, 0x6060, 0, &mode, &mode_bit },
		{ 0, MOTOR, drive->vendor_id, drive->product_code, 0x6041, 0, &status, &status_bit },
		{ 0, SERVO, BECKHOFF, EL7201, 0x7010, 6, &servo, &servo_bit },
		{ 0 },
	};
	ec_pdo_entry_reg_t d1[9] = { { 0 } }, d2[9] = { { 0 } };

	for (unsigned int i = 0; i < 8; i++) {
		d1[i] = (ec_pdo_entry_reg_t){ 0, OUT, BECKHOFF, EL2008, (uint16_t)(0x7000 + 16 * i), 1,
					      &byte7[i], &bit7[i] };
		d2[i] = (ec_pdo_entry_reg_t){ 0, IN, BECKHOFF, EL1008, (uint16_t)(0x6000 + 16 * i), 1,
					      &inb[i], &inbit[i] };
	}
	IS(ecrt_domain_reg_pdo_entry_list(dom[0], d0), 0);
	IS(ecrt_domain_reg_pdo_entry_list(dom[1], d1), 0);
	IS(ecrt_domain_reg_pdo_entry_list(dom[2], d2), 0);
}

/* Each stored object is tried first, so that a refusal is seen at once. */
static void objects(void)
{
	const uint8_t value[2] = { 0x34, 0x12 };
	uint32_t abort = 0xffffffff;
	uint8_t back[4];
	size_t got = 0;

	IS(ecrt_master_sdo_upload(m, MOTOR, 0x1018, 1, back, 4, &got, &abort), 0);
	IS(got, 4);
	IS(ecrt_master_sdo_download(m, MOTOR, 0x2001, 7, value, 2, &abort), 0);
	IS(ecrt_slave_config_sdo(sc[MOTOR], 0x2001, 7, value, 2), 0);
	/* the number of PDO objects is printed, whatever happened: it must be one */
	abort = 0xffffffff;
	IS(ecrt_master_sdo_download(m, MOTOR, 0x1018, 1, value, 2, &abort), -EIO);
	YES(abort != 0 && abort != 0xffffffff);
	abort = 0xffffffff;
	IS(ecrt_master_sdo_download(m, NOWHERE, 0x1018, 1, value, 2, &abort), -EINVAL);
	IS(abort, 0);
}

static void configure(void)
{
	ec_slave_info_t drive;
	struct timeval tv;

	m = ecrt_request_master(0);
	NEED(m);
	IS(ecrt_master_get_slave(m, MOTOR, &drive), 0);
	for (unsigned int i = 0; i < DOMAINS; i++) {
		dom[i] = ecrt_master_create_domain(m);
		NEED(dom[i]);
		queued[i] = false;
		data[i] = NULL;
	}
	/* not the coupler, whose clock is the reference: it goes to OP all the same */
	for (uint16_t i = OUT; i < SLAVES; i++) {
		sc[i] = ecrt_master_slave_config(m, 0, i, i == MOTOR ? drive.vendor_id : known[i].vendor,
						 i == MOTOR ? drive.product_code : known[i].product);
		NEED(sc[i]);
	}
	objects();
	drive_syncs(sc[MOTOR]);
	io_syncs(sc[OUT], EC_DIR_OUTPUT);
	io_syncs(sc[IN], EC_DIR_INPUT);
	IS(ecrt_slave_config_dc(sc[MOTOR], 0x300, 1000000, 250000, 0, 0), 0);
	/* the number of bits of an object of 16, taken as bytes */
	sdo = ecrt_slave_config_create_sdo_request(sc[MOTOR], 0x2001, 7, 16);
	NEED(sdo);
	lists(&drive);
	gettimeofday(&tv, NULL);
	IS(ecrt_master_application_time(m, EC_TIMEVAL2NANO(tv)), 0);
	multi = false;
	cycle = 0;
	memset(ds, 0, sizeof(ds));
	memset(ss, 0, sizeof(ss));
	memset(&ms, 0, sizeof(ms));
}

/* cycle ----------------------------------------------------------------------*/

static void read_all(void)
{
	ec_master_state_t master;
	ec_slave_config_state_t slave;
	ec_domain_state_t d;

	ecrt_master_receive(m);
	for (unsigned int i = 0; i < DOMAINS; i++) {
		if (queued[i])
			ecrt_domain_process(dom[i]);
		ecrt_domain_state(dom[i], &d);
		wc_changes += d.working_counter != ds[i].working_counter || d.wc_state != ds[i].wc_state;
		ds[i] = d;
	}
	ecrt_master_sync_monitor_process(m);
	ecrt_master_state(m, &master);
	al_changes += master.al_states != ms.al_states || master.link_up != ms.link_up ||
		      master.slaves_responding != ms.slaves_responding;
	ms = master;
	for (unsigned int i = OUT; i < SLAVES; i++) {
		ecrt_slave_config_state(sc[i], &slave);
		sc_changes += slave.online != ss[i].online || slave.operational != ss[i].operational ||
			      slave.al_state != ss[i].al_state;
		ss[i] = slave;
	}
	multi = multi || ms.al_states == EC_AL_STATE_OP;
}

static void write_all(void)
{
	struct timeval tv;
	uint32_t ref;

	for (unsigned int i = 0; i < DOMAINS; i++) {
		queued[i] = !multi || cycle % divider[i] == 0;
		if (queued[i])
			ecrt_domain_queue(dom[i]);
	}
	gettimeofday(&tv, NULL);
	ecrt_master_application_time(m, EC_TIMEVAL2NANO(tv));
	ecrt_master_reference_clock_time(m, &ref);
	if (cycle % 10 == 0)
		ecrt_master_sync_reference_clock(m);
	ecrt_master_sync_slave_clocks(m);
	ecrt_master_sync_monitor_queue(m);
	ecrt_master_send(m);
	cycle++;
}

static void activate(void)
{
	NEED(IS(ecrt_master_activate(m), 0));
	for (unsigned int i = 0; i < DOMAINS; i++) {
		data[i] = ecrt_domain_data(dom[i]);
		size[i] = (int)ecrt_domain_size(dom[i]);
		YES(data[i] != NULL && size[i] > 0);
	}
}

static void cycles(unsigned int n)
{
	for (; n && data[0]; n--) {
		bench_sleep();
		read_all();
		write_all();
	}
}

/* in the thread of the cycle -------------------------------------------------*/

static long faults(void)
{
	struct rusage u;

	getrusage(RUSAGE_THREAD, &u);
	return u.ru_minflt + u.ru_majflt;
}

static void start(void)
{
	long before;

	activate();
	NEED(data[0]);
	before = faults();
	/* every byte is there already */
	for (unsigned int i = 0; i < DOMAINS; i++)
		for (int k = 0; k < size[i]; k++)
			((volatile uint8_t *)data[i])[k] = 0;
	for (unsigned int i = 0; i < OP_CYCLES && !multi; i++)
		cycles(1);
	if (!YES(multi))
		printf("# AL states 0x%x of %u slaves\n", ms.al_states, ms.slaves_responding);
	cycles(200);
	before = faults();
	cycles(1000);
	IS(faults() - before, 0);
}

static void steady(void)
{
	NEED(data[0]);
	for (unsigned int i = OUT; i < SLAVES; i++) {
		char why[256];

		if (!YES(ss[i].online && ss[i].operational && ss[i].al_state == EC_AL_STATE_OP) &&
		    ecrt_slave_config_reason(sc[i], why, sizeof(why)) >= 0)
			printf("# slave %u: %s\n", i, why);
	}
	al_changes = wc_changes = sc_changes = 0;
	cycles(2000);
	IS(al_changes, 0);
	IS(wc_changes, 0);
	IS(sc_changes, 0);
	for (unsigned int i = 0; i < DOMAINS; i++) {
		IS(ds[i].working_counter, expected[i]);
		IS(ds[i].wc_state, EC_WC_COMPLETE);
	}
}

/* bit entries: neighbours stay, what is not written stays */
static void bits(void)
{
	NEED(data[0]);
	for (unsigned int i = 0; i < 8; i++)
		EC_WRITE_BIT(data[1] + byte7[i], bit7[i], i % 2);
	cycles(20);
	IS(data[1][byte7[0]], 0xaa);
	/* outputs 1 and 2 are wired to inputs 1 and 2 */
	IS(EC_READ_BIT(data[2] + inb[0], inbit[0]), 0);
	IS(EC_READ_BIT(data[2] + inb[1], inbit[1]), 1);
	EC_WRITE_BIT(data[1] + byte7[0], bit7[0], 1);
	EC_WRITE_BIT(data[1] + byte7[1], bit7[1], 0);
	cycles(20);
	IS(data[1][byte7[0]], 0xa9);
	IS(EC_READ_BIT(data[2] + inb[0], inbit[0]), 1);
	IS(EC_READ_BIT(data[2] + inb[1], inbit[1]), 0);
	/* gaps count: the mode of the drive is behind 16 and 3 bits; 8 is the fourth bit of it */
	IS(mode, control + 2);
	IS(mode_bit, 3);
	EC_WRITE_U16(data[0] + control, 0x0006);
	EC_WRITE_BIT(data[0] + mode, mode_bit + 3, 1);
	cycles(20);
	IS(EC_READ_U16(data[0] + status) & 0x6f, 0x21);
	IS(EC_READ_U16(data[0] + control), 0x0006);
	IS(data[0][mode], 0x40);
}

/* Inputs are copied to outputs in each cycle, and by another path back. */
static void copied(void)
{
	NEED(data[0]);
	for (int i = 0; i < 300; i++) {
		bench_sleep();
		read_all();
		EC_WRITE_BIT(data[1] + byte7[1], bit7[1], EC_READ_BIT(data[2] + inb[0], inbit[0]));
		EC_WRITE_BIT(data[1] + byte7[0], bit7[0], i / 50 % 2);
		write_all();
		if (i % 50 == 49)	/* once through all of it: 4 + 2 + 4 cycles at least */
			IS(EC_READ_BIT(data[2] + inb[1], inbit[1]), i / 50 % 2);
	}
}

/* A request that is started again whenever it is not busy, though it is refused. */
static void refused_request(void)
{
	unsigned int errors = 0, others = 0;

	NEED(data[0]);
	for (int i = 0; i < 1000; i++) {
		ec_request_state_t s = ecrt_sdo_request_state(sdo);

		errors += s == EC_REQUEST_ERROR;
		others += s == EC_REQUEST_SUCCESS;
		if (s != EC_REQUEST_BUSY) {
			EC_WRITE_U16(ecrt_sdo_request_data(sdo), 5);
			IS(ecrt_sdo_request_write(sdo), 0);
		}
		cycles(1);
	}
	/* 16 bytes go on the wire, and the drive does not take them */
	YES(errors > 10);
	IS(others, 0);
	IS(wc_changes, 0);
}

static void in_thread(void (*run)(void))
{
	struct sched_param p = { .sched_priority = 70 };
	pthread_attr_t attr;
	pthread_t t;

	pthread_attr_init(&attr);
	pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED);
	pthread_attr_setschedpolicy(&attr, SCHED_FIFO);
	pthread_attr_setschedparam(&attr, &p);
	NEED(!pthread_create(&t, &attr, (void *(*)(void *))run, NULL));
	pthread_join(t, NULL);
	pthread_attr_destroy(&attr);
}

static void rt_start(void)
{
	YES(!mlockall(MCL_CURRENT | MCL_FUTURE));
	in_thread(start);
}

static void end(void)
{
	NEED(m);
	IS(ecrt_master_deactivate(m), 0);
	ecrt_release_master(m);
	data[0] = NULL;
	munlockall();
}

/* All masters are deactivated, also those that never were active. */
static void never_active(void)
{
	configure();
	NEED(m);
	SILENT(ecrt_master_deactivate(m), -EINVAL);
	/* the configuration is still there to be cleaned up */
	YES(ecrt_domain_size(dom[0]) > 0);
	ecrt_release_master(m);
}

const struct api_case lcec_cases[] = {
	{ "9.1-9.3 request, SDOs, SyncManagers 0 to 3, gaps, lists", configure },
	{ "9.4 activation in the real-time thread, no page fault", rt_start },
	{ "9.6 states polled each cycle do not flicker", steady },
	{ "9.3 bits and gaps", bits },
	{ "9.5 inputs copied to outputs, domains at different rates", copied },
	{ "9.9 a request of the wrong size", refused_request },
	{ "9.11 deactivate, release", end },
	{ "9.11 deactivate a master that never was active", never_active },
	{ NULL, NULL },
};
