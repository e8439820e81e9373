// SPDX-License-Identifier: GPL-2.0-only
/* The kernel runs the cycle. */
#include <poll.h>

#include "api.h"

static ec_cycle_config_t config = { .period_ns = 1000000, .cpu = -1 };

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
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	bad = config;
	bad.stall = (ec_cycle_stall_t)3;
	SAYS(CALL(ecrt_master_set_cycle)(b.m, &bad), -EINVAL);
	SILENT(CALL(ecrt_master_set_cycle)(b.m, &config), 0);
	SILENT(CALL(ecrt_master_wait_cycle)(b.m, 1000), -EINVAL);
	SILENT(CALL(ecrt_master_cycle_fd)(b.m), -EINVAL);
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
	uint64_t count;
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

const struct api_case kcycle_cases[] = {
	{ "what cannot be is refused", refused },
	{ "it runs", runs },
	{ NULL, NULL },
};
