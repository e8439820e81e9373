// SPDX-License-Identifier: GPL-2.0-only
/* The application most cases work with. */
#include <time.h>

#include "api.h"

#define PERIOD_NS	1000000L
#define OP_CYCLES	20000

static struct timespec next;
static ec_master_t *left;	/* by a case that failed */

/* until the next cycle */
void bench_sleep(void)
{
	if (!next.tv_sec)
		clock_gettime(CLOCK_MONOTONIC, &next);
	next.tv_nsec += PERIOD_NS;
	if (next.tv_nsec >= 1000000000L) {
		next.tv_nsec -= 1000000000L;
		next.tv_sec++;
	}
	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
}

bool bench_request(struct bench *b)
{
	if (left)
		ecrt_release_master(left);
	memset(b, 0, sizeof(*b));
	next.tv_sec = 0;
	b->m = CALL(ecrt_request_master)(0);
	left = b->m;
	return YES(b->m != NULL);
}

static bool configure_drive(struct bench *b)
{
	static const ec_pdo_entry_info_t out[] = {
		{ 0x6040, 0, 16 }, { 0x60ff, 0, 32 }, { 0, 0, 16 },
	};
	static const ec_pdo_entry_info_t in[] = {
		{ 0x6041, 0, 16 }, { 0x6064, 0, 32 }, { 0x606c, 0, 32 },
	};
	static const ec_pdo_info_t rx = { 0x1600, 3, out }, tx = { 0x1a00, 3, in };
	static const ec_sync_info_t syncs[] = {
		{ 2, EC_DIR_OUTPUT, 1, &rx, EC_WD_ENABLE },
		{ 3, EC_DIR_INPUT, 1, &tx, EC_WD_DISABLE },
		{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
	};
	ec_slave_info_t info;

	if (!YES(!CALL(ecrt_master_get_slave)(b->m, MOTOR, &info)))
		return false;
	b->motor = CALL(ecrt_master_slave_config)(b->m, 0, MOTOR, info.vendor_id,
						  info.product_code);
	if (!YES(b->motor != NULL) || !IS(CALL(ecrt_slave_config_pdos)(b->motor, EC_END, syncs), 0))
		return false;
	b->control = CALL(ecrt_slave_config_reg_pdo_entry)(b->motor, 0x6040, 0, b->d, NULL);
	b->status = CALL(ecrt_slave_config_reg_pdo_entry)(b->motor, 0x6041, 0, b->d, NULL);
	return YES(b->control >= 0) && YES(b->status >= 0);
}

bool bench_configure(struct bench *b)
{
	const ec_pdo_entry_reg_t regs[] = {
		{ 0, OUT, BECKHOFF, EL2008, 0x7000, 1, &b->out_byte, &b->out_bit },
		{ 0, IN, BECKHOFF, EL1008, 0x6000, 1, &b->in_byte, &b->in_bit },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};

	b->d = CALL(ecrt_master_create_domain)(b->m);
	if (!YES(b->d != NULL))
		return false;
	b->out = CALL(ecrt_master_slave_config)(b->m, 0, OUT, BECKHOFF, EL2008);
	b->in = CALL(ecrt_master_slave_config)(b->m, 0, IN, BECKHOFF, EL1008);
	return YES(b->out && b->in) &&
	       IS(CALL(ecrt_domain_reg_pdo_entry_list)(b->d, regs), 0) && configure_drive(b);
}

bool bench_activate(struct bench *b)
{
	if (!IS(CALL(ecrt_master_activate)(b->m), 0))
		return false;
	b->data = CALL(ecrt_domain_data)(b->d);
	return YES(b->data != NULL);
}

void bench_cycle(struct bench *b, unsigned int n)
{
	for (; n; n--) {
		bench_sleep();
		CALL(ecrt_master_receive)(b->m);
		CALL(ecrt_domain_process)(b->d);
		if (b->each)
			b->each(b);
		CALL(ecrt_domain_queue)(b->d);
		CALL(ecrt_master_send)(b->m);
		b->cycles++;
	}
}

bool bench_op(struct bench *b)
{
	ec_slave_config_t *const sc[] = { b->out, b->in, b->motor };
	ec_slave_config_state_t s;
	unsigned int i, n;

	for (n = 0; n < OP_CYCLES; n++) {
		bench_cycle(b, 1);
		for (i = 0; i < 3; i++)
			if (sc[i] && (CALL(ecrt_slave_config_state)(sc[i], &s) || !s.operational))
				break;
		if (i == 3)
			return true;
	}
	return YES(!"all slaves in OP");
}

bool bench_up(struct bench *b)
{
	return bench_request(b) && bench_configure(b) && bench_activate(b) && bench_op(b);
}

void bench_down(struct bench *b)
{
	if (b->m)
		CALL(ecrt_release_master)(b->m);
	b->m = NULL;
	left = NULL;
}
