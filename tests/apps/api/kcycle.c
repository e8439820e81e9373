// SPDX-License-Identifier: GPL-2.0-only
/* The kernel runs the cycle. */
#include <poll.h>

#include "api.h"

static ec_cycle_config_t config = { .period_ns = 1000000 };

static void refused(void)
{
	ec_cycle_config_t bad = config;
	ec_cycle_state_t s;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	bad.period_ns = 0;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad.period_ns = 9999;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad = config;
	bad.phase_ns = bad.period_ns;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad = config;
	bad.priority = 99;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad = config;
	bad.cpu = 4000;
	bad.flags = EC_CYCLE_BIND_CPU;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad.cpu = -1;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad.cpu = 1;	/* without the flag: does it want that one or not? */
	bad.flags = 0;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad = config;
	bad.stall = (ec_cycle_stall_t)3;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	SILENT(CALL(ecrt_master_set_cycle)(b.m, &config), 0);
	SILENT(CALL(ecrt_master_wait_cycle)(b.m, 1000), -EINVAL);
	SILENT(CALL(ecrt_master_cycle_fd)(b.m), -EINVAL);
	SILENT(CALL(ecrt_master_cycle_inputs)(b.m, NULL, NULL), -EINVAL);
	SILENT(CALL(ecrt_master_cycle_state)(b.m, &s), -EINVAL);
	IS(CALL(ecrt_master_cycle_count)(b.m), 0);
	/* and back: the application runs it */
	SILENT(CALL(ecrt_master_set_cycle)(b.m, NULL), 0);
	NEED(bench_activate(&b) && bench_op(&b));
	SILENT(CALL(ecrt_master_wait_cycle)(b.m, 1000), -EINVAL);
	SILENT(CALL(ecrt_master_cycle_fd)(b.m), -EINVAL);
	IS(CALL(ecrt_master_cycle_state)(b.m, &s), 0);
	IS(s.run, EC_CYCLE_NONE);
	bench_down(&b);
}

/* one cycle, as ecrt.h shows it */
static int cycle(struct bench *b)
{
	int n = CALL(ecrt_master_wait_cycle)(b->m, 1000000);

	CALL(ecrt_master_receive)(b->m);
	CALL(ecrt_domain_process)(b->d);
	CALL(ecrt_domain_queue)(b->d);
	CALL(ecrt_master_send)(b->m);
	return n;
}

static void runs(void)
{
	ec_slave_config_state_t state = { 0 };
	ec_cycle_state_t s;
	struct pollfd fd;
	struct bench b;
	uint64_t count, number = 0, at = 0;
	int i;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_set_cycle)(b.m, &config), 0);
	NEED(bench_activate(&b));
	for (i = 0; i < 20000 && !state.operational; i++) {
		YES(cycle(&b) >= 1);
		CALL(ecrt_slave_config_state)(b.motor, &state);
	}
	NEED(state.operational);
	YES(CALL(ecrt_domain_data)(b.d) == b.data);
	EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, 1);
	for (i = 0; i < 10; i++)
		YES(cycle(&b) >= 1);
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 1);
	count = CALL(ecrt_master_cycle_count)(b.m);
	YES(count > 10);
	IS(CALL(ecrt_master_cycle_inputs)(b.m, &number, &at), 0);
	YES(number > 10 && number <= count);
	IS(at % config.period_ns, 0);
	fd.fd = CALL(ecrt_master_cycle_fd)(b.m);
	fd.events = POLLIN;
	CALL(ecrt_master_receive)(b.m);
	IS(poll(&fd, 1, 10000), 1);
	IS(fd.revents, POLLIN);
	YES(CALL(ecrt_master_cycle_count)(b.m) >= count);
	IS(CALL(ecrt_master_cycle_state)(b.m, &s), 0);
	/* the application has given new outputs in nearly each cycle */
	YES(s.run == EC_CYCLE_RUNNING && s.cycles >= count && s.late_max >= s.late_min);
	IS(CALL(ecrt_master_cycle_state)(b.m, NULL), -EINVAL);
	IS(CALL(ecrt_master_deactivate)(b.m), 0);
	bench_down(&b);
}

/* Cycles until all is in OP, and ten more for values to come round. */
static bool until_op(struct bench *b)
{
	ec_slave_config_state_t motor = { 0 }, out = { 0 };
	int i;

	for (i = 0; i < 20000 && !(motor.operational && out.operational); i++) {
		if (!YES(cycle(b) >= 1))
			return false;
		CALL(ecrt_slave_config_state)(b->motor, &motor);
		CALL(ecrt_slave_config_state)(b->out, &out);
	}
	for (i = 0; i < 10; i++)
		cycle(b);
	return YES(motor.operational && out.operational);
}

/* Who spins and waits for nothing learns that the cycle has stopped. */
static void stops(void)
{
	ec_cycle_config_t c = config;
	ec_domain_state_t ds;
	struct bench b;
	int ret;

	c.stall = EC_CYCLE_STOP;
	c.stall_cycles = 100;
	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_set_cycle)(b.m, &c), 0);
	NEED(bench_activate(&b) && until_op(&b));
	CALL(ecrt_domain_state)(b.d, &ds);
	IS(ds.wc_state, EC_WC_COMPLETE);
	do
		ret = CALL(ecrt_master_receive)(b.m);
	while (!ret);
	IS(ret, -ECANCELED);
	CALL(ecrt_domain_process)(b.d);
	CALL(ecrt_domain_state)(b.d, &ds);
	IS(ds.working_counter, 0);
	IS(ds.wc_state, EC_WC_ZERO);
	CALL(ecrt_domain_queue)(b.d);
	SILENT(CALL(ecrt_master_send)(b.m), -ECANCELED);
	SILENT(CALL(ecrt_master_wait_cycle)(b.m, 0), -ECANCELED);
	CALL(ecrt_master_deactivate)(b.m);
	bench_down(&b);
}

/* A domain that goes every tenth cycle brings no more than one change in that time. */
static void divided(void)
{
	uint64_t first, changes = 0;
	struct bench b;
	int i, last;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_set_cycle)(b.m, &config), 0);
	SAYS(CALL(ecrt_domain_set_division)(b.d, 0, 0), -EINVAL);
	SAYS(CALL(ecrt_domain_set_division)(b.d, 10, 10), -EINVAL);
	IS(CALL(ecrt_domain_set_division)(b.d, 10, 9), 0);
	NEED(bench_activate(&b) && until_op(&b));
	SAYS(CALL(ecrt_domain_set_division)(b.d, 1, 0), -EBUSY);
	first = CALL(ecrt_master_cycle_count)(b.m);
	last = EC_READ_BIT(b.data + b.in_byte, b.in_bit);
	for (i = 0; i < 100; i++) {
		ec_domain_state_t ds;

		YES(cycle(&b) >= 1);
		CALL(ecrt_domain_state)(b.d, &ds);
		IS(ds.wc_state, EC_WC_COMPLETE);
		changes += EC_READ_BIT(b.data + b.in_byte, b.in_bit) != last;
		last = EC_READ_BIT(b.data + b.in_byte, b.in_bit);
		EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, !last);
	}
	YES(changes >= 2);
	YES(changes <= (CALL(ecrt_master_cycle_count)(b.m) - first) / 10 + 1);
	CALL(ecrt_master_deactivate)(b.m);
	bench_down(&b);
}

/* Input 1 becomes output 2, whatever the application writes there. */
static void copied(void)
{
	struct bench b;
	int i;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_set_cycle)(b.m, &config), 0);
	SAYS(CALL(ecrt_domain_copy)(b.d, b.in_byte, b.in_bit, b.d, b.in_byte, b.in_bit, 1), -EINVAL);
	SAYS(CALL(ecrt_domain_copy)(b.d, b.out_byte, 1, b.d, b.out_byte, 0, 1), -EINVAL);
	IS(CALL(ecrt_domain_copy)(b.d, b.out_byte, b.out_bit + 1, b.d, b.in_byte, b.in_bit, 1), 0);
	SAYS(CALL(ecrt_domain_copy)(b.d, b.out_byte, b.out_bit + 1, b.d, b.in_byte, 5, 1), -EEXIST);
	NEED(bench_activate(&b) && until_op(&b));
	SAYS(CALL(ecrt_domain_copy)(b.d, b.out_byte, 5, b.d, b.in_byte, 5, 1), -EBUSY);
	for (i = 0; i < 4; i++) {
		EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, i % 2);
		EC_WRITE_BIT(b.data + b.out_byte, b.out_bit + 1, i < 2);
		for (int k = 0; k < 10; k++)
			YES(cycle(&b) >= 1);
		IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), i % 2);
		IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit + 1), i % 2);
	}
	CALL(ecrt_master_deactivate)(b.m);
	bench_down(&b);
}

/* Released without deactivation, taken over, ended by somebody else. */
static void detached(void)
{
	ec_cycle_config_t c = config;
	ec_cycle_state_t s;
	struct bench b;
	ec_master_t *m;

	c.flags = EC_CYCLE_DETACH;
	c.stall = EC_CYCLE_STOP;
	NEED(bench_request(&b) && bench_configure(&b));
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &c), -EINVAL);
	c.stall = EC_CYCLE_HOLD;
	IS(CALL(ecrt_master_set_cycle)(b.m, &c), 0);
	NEED(bench_activate(&b) && until_op(&b));
	SAYS(CALL(ecrt_master_end_detached)(b.m), -EBUSY);
	EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, 1);
	cycle(&b);
	cycle(&b);
	bench_down(&b);

	NEED(bench_request(&b) && bench_configure(&b));
	SAYS(CALL(ecrt_master_activate)(b.m), -EEXIST);
	IS(CALL(ecrt_master_set_cycle)(b.m, &c), 0);
	NEED(bench_activate(&b));
	IS(EC_READ_BIT(b.data + b.out_byte, b.out_bit), 1);
	IS(CALL(ecrt_master_cycle_state)(b.m, &s), 0);
	IS(s.takeovers, 1);
	YES(cycle(&b) >= 1);
	bench_down(&b);

	m = CALL(ecrt_open_master)(0);
	NEED(m);
	SILENT(CALL(ecrt_master_end_detached)(m), 0);
	SAYS(CALL(ecrt_master_end_detached)(m), -ENOENT);
	CALL(ecrt_release_master)(m);
}

static unsigned int released;

static void release_number(void *data)
{
	released += *(unsigned int *)data;
}

/* Left to the master: no application has it, and its handles are gone. */
static void left_to_master(void)
{
	static unsigned int one = 1, ten = 10;
	ec_cycle_config_t c = config;
	struct bench b;

	c.flags = 0;
	c.stall_cycles = 0;
	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_set_names)(b.m, "ethercat: 1", 11), 0);
	SAYS(CALL(ecrt_master_set_names)(b.m, "", 1U << 23), -E2BIG);
	SILENT(CALL(ecrt_master_leave)(b.m), -EINVAL);
	IS(CALL(ecrt_master_set_cycle)(b.m, &c), 0);
	YES(!CALL(ecrt_master_data)(b.m, release_number));
	IS(CALL(ecrt_master_set_data)(b.m, &one, release_number), 0);
	IS(CALL(ecrt_master_set_data)(b.m, &ten, release_number), 0);
	IS(released, 1);
	YES(CALL(ecrt_master_data)(b.m, release_number) == &ten);
	NEED(bench_activate(&b) && until_op(&b));
	IS(CALL(ecrt_master_leave)(b.m), 0);
	IS(released, 11);
	YES(!CALL(ecrt_master_data)(b.m, release_number));
	SILENT(CALL(ecrt_master_leave)(b.m), -EPERM);
	SAYS(CALL(ecrt_master_reserve)(b.m), -EBUSY);
	SILENT(CALL(ecrt_master_end_detached)(b.m), 0);
	IS(CALL(ecrt_master_reserve)(b.m), 0);
	bench_down(&b);
}

const struct api_case kcycle_cases[] = {
	{ "what cannot be is refused", refused },
	{ "it runs", runs },
	{ "it stops when nothing is given", stops },
	{ "a domain now and then", divided },
	{ "from slave to slave", copied },
	{ "it survives its application", detached },
	{ "it is left to the master", left_to_master },
	{ NULL, NULL },
};
