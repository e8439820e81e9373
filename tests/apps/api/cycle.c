// SPDX-License-Identifier: GPL-2.0-only
/* Activation and the cycle. */
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include "api.h"

static void activation(void)
{
	ec_slave_config_state_t s;
	ec_domain_state_t ds;
	ec_master_info_t info;
	ec_master_state_t ms;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	YES(!CALL(ecrt_domain_data)(b.d));
	SILENT(CALL(ecrt_domain_process)(b.d), -EINVAL);
	SILENT(CALL(ecrt_domain_queue)(b.d), -EINVAL);
	SILENT(CALL(ecrt_master_send)(b.m), -EINVAL);
	SILENT(CALL(ecrt_master_receive)(b.m), -EINVAL);
	/* not active: nothing is freed */
	SILENT(CALL(ecrt_master_deactivate)(b.m), -EINVAL);
	IS(CALL(ecrt_domain_size)(b.d), 20);
	NEED(bench_activate(&b));
	for (int i = 0; i < 20; i++)
		IS(b.data[i], 0);
	SAYS(CALL(ecrt_master_activate)(b.m), 0);
	SILENT(CALL(ecrt_domain_state)(b.d, &ds), 0);
	IS(ds.wc_state, EC_WC_ZERO);
	NEED(bench_op(&b));
	YES(CALL(ecrt_domain_data)(b.d) == b.data);
	IS(CALL(ecrt_domain_size)(b.d), 20);
	/* each slave of the bench, and one writing and one reading each: 2 + 1, 1, 3 */
	bench_cycle(&b, 5);
	IS(CALL(ecrt_domain_state)(b.d, &ds), 0);
	IS(ds.wc_state, EC_WC_COMPLETE);
	IS(ds.working_counter, 6);
	IS(ds.redundancy_active, 0);
	SILENT(CALL(ecrt_master_state)(b.m, &ms), 0);
	IS(ms.slaves_responding, SLAVES);
	IS(ms.al_states & EC_AL_STATE_OP, EC_AL_STATE_OP);
	IS(ms.link_up, 1);
	SILENT(CALL(ecrt_slave_config_state)(b.motor, &s), 0);
	YES(s.online && s.operational && s.al_state == EC_AL_STATE_OP);
	IS(CALL(ecrt_master_application_time)(b.m, 123456789), 0);
	bench_cycle(&b, 2);
	IS(CALL(ecrt_master)(b.m, &info), 0);
	IS(info.app_time, 123456789);
	IS(CALL(ecrt_master_deactivate)(b.m), 0);
	SILENT(CALL(ecrt_master_deactivate)(b.m), -EINVAL);
	bench_down(&b);
}

static void wire_is_on(struct bench *b)
{
	EC_WRITE_BIT(b->data + b->out_byte, b->out_bit, 1);
}

static void process_data(void)
{
	ec_domain_state_t ds;
	struct bench b;

	NEED(bench_up(&b));
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 0);
	EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, 1);
	bench_cycle(&b, 5);
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 1);
	/* outputs stay what they are */
	IS(EC_READ_U8(b.data + b.out_byte), 1 << b.out_bit);
	EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, 0);
	bench_cycle(&b, 5);
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 0);
	/* the drive: switch on disabled, then a command shows in its status word */
	EC_WRITE_U16(b.data + b.control, 0x0006);
	bench_cycle(&b, 20);
	IS(EC_READ_U16(b.data + b.status) & 0x6f, 0x21);
	/* written between process and queue */
	b.each = wire_is_on;
	bench_cycle(&b, 5);
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 1);
	IS(CALL(ecrt_domain_state)(b.d, &ds), 0);
	IS(ds.wc_state, EC_WC_COMPLETE);
	bench_down(&b);
}

/* A domain that is not queued stands still; receiving nothing is no error. */
static void left_out(void)
{
	ec_domain_state_t ds;
	struct bench b;

	NEED(bench_up(&b));
	EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, 1);
	bench_cycle(&b, 5);
	EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, 0);
	for (int i = 0; i < 10; i++) {
		bench_sleep();
		SILENT(CALL(ecrt_master_receive)(b.m), 0);
		SILENT(CALL(ecrt_domain_process)(b.d), 0);
		SILENT(CALL(ecrt_master_send)(b.m), 0);
	}
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 1);
	IS(CALL(ecrt_domain_state)(b.d, &ds), 0);
	IS(ds.wc_state, EC_WC_COMPLETE);
	IS(ds.working_counter, 6);
	/* twice in a row, and without a send between */
	SILENT(CALL(ecrt_master_receive)(b.m), 0);
	SILENT(CALL(ecrt_master_receive)(b.m), 0);
	SILENT(CALL(ecrt_domain_queue)(b.d), 0);
	SILENT(CALL(ecrt_domain_queue)(b.d), 0);
	bench_cycle(&b, 5);
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 0);
	bench_down(&b);
}

/* After deactivation the same handle is configured anew. */
static void again(void)
{
	struct bench b;

	NEED(bench_up(&b));
	for (int i = 0; i < 2; i++) {
		IS(CALL(ecrt_master_deactivate)(b.m), 0);
		NEED(bench_configure(&b) && bench_activate(&b) && bench_op(&b));
		IS(EC_READ_BIT(b.data + b.out_byte, b.out_bit), 0);
	}
	bench_down(&b);
}

/* Nothing configured at all: an image of 0 bytes. */
static void nothing(void)
{
	ec_domain_t *d;
	struct bench b;

	NEED(bench_request(&b));
	d = CALL(ecrt_master_create_domain)(b.m);
	NEED(d);
	IS(CALL(ecrt_domain_size)(d), 0);
	IS(CALL(ecrt_master_activate)(b.m), 0);
	YES(!CALL(ecrt_domain_data)(d));
	for (int i = 0; i < 10; i++) {
		bench_sleep();
		IS(CALL(ecrt_master_receive)(b.m), 0);
		IS(CALL(ecrt_domain_process)(d), 0);
		IS(CALL(ecrt_domain_queue)(d), 0);
		IS(CALL(ecrt_master_send)(b.m), 0);
	}
	IS(CALL(ecrt_master_deactivate)(b.m), 0);
	bench_down(&b);
}

/* Whoever looks for changes finds none until there is one. */
static void no_flicker(void)
{
	ec_slave_config_state_t s, was;
	ec_master_link_state_t l;
	ec_master_state_t ms;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_slave_config_state)(b.in, &was), 0);
	IS(was.online, 1);
	IS(was.al_state, EC_AL_STATE_PREOP);
	NEED(bench_activate(&b));
	for (int i = 0; i < 100; i++) {
		IS(CALL(ecrt_master_state)(b.m, &ms), 0);
		IS(ms.slaves_responding, SLAVES);
		IS(ms.link_up, 1);
		YES(ms.al_states != 0);
		IS(CALL(ecrt_master_link_state)(b.m, 0, &l), 0);
		IS(l.slaves_responding, SLAVES);
		IS(l.link_up, 1);
		IS(CALL(ecrt_slave_config_state)(b.in, &s), 0);
		IS(s.online, 1);
		if (!i)
			IS(s.al_state, EC_AL_STATE_PREOP);
		bench_cycle(&b, 1);
	}
	bench_down(&b);
}

/* One that a tool has taken out of OP comes back. */
static void reset(void)
{
	ec_slave_config_state_t s = { 0 };
	struct bench b;

	NEED(bench_up(&b));
	IS(system("$EC_BUILD/tool/ethercat states -p3 PREOP"), 0);
	for (int i = 0; i < 20000 && s.al_state != EC_AL_STATE_PREOP; i++) {
		bench_cycle(&b, 1);
		IS(CALL(ecrt_slave_config_state)(b.motor, &s), 0);
	}
	IS(s.al_state, EC_AL_STATE_PREOP);
	SILENT(CALL(ecrt_master_reset)(b.m), 0);
	NEED(bench_op(&b));
	bench_down(&b);
}

/* Lets the process map @pages more, or as many as it likes. */
static bool room(long pages)
{
	struct rlimit limit = { RLIM_INFINITY, RLIM_INFINITY };
	unsigned long size, page = (unsigned long)sysconf(_SC_PAGESIZE);
	FILE *f;

	if (pages >= 0) {
		f = fopen("/proc/self/statm", "r");
		if (!f || fscanf(f, "%lu", &size) != 1)
			return YES(!"the size of the process");
		fclose(f);
		limit.rlim_cur = (size + (unsigned long)pages) * page;
	}
	return IS(setrlimit(RLIMIT_AS, &limit), 0);
}

/* Each of the mappings fails; then the master is free, and the next activation gets all. */
static void no_room(void)
{
	long pages, failed = 0;
	int ret = -ENOMEM;
	struct bench b;

	for (pages = 0; ret && pages < 200; pages++) {
		NEED(bench_request(&b) && bench_configure(&b) && room(pages));
		ret = ecrt_master_activate(b.m);
		NEED(room(-1));
		failed += ret == -ENOMEM;
		YES(!ret || (ret == -ENOMEM && !ecrt_domain_data(b.d)));
		if (ret)
			bench_down(&b);
	}
	printf("# activations without room: %ld\n", failed);
	YES(failed > 1);
	NEED(IS(ret, 0));
	b.data = ecrt_domain_data(b.d);
	NEED(YES(b.data != NULL) && bench_op(&b));
	bench_down(&b);
}

const struct api_case cycle_cases[] = {
	{ "activation, states, deactivation", activation },
	{ "process data", process_data },
	{ "domains and frames left out", left_out },
	{ "deactivate, configure, activate", again },
	{ "no process data", nothing },
	{ "states after activation", no_flicker },
	{ "reset", reset },
	{ "no room for the process data", no_room },
	{ NULL, NULL },
};
