// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * What a careful application does in each cycle beside process data: clocks,
 * states, emergencies, requests. None of it is a system call of its own.
 */
#include "bench.h"

#define STATUS_REG	0x0130	/* AL status */

int extras_setup(struct bench *b)
{
	unsigned int i;

	for (i = 0; i < b->slaves && i < REQUESTS_MAX; i++) {
		if (ecrt_slave_config_emerg_size(b->sc[i], 4))
			return -1;
		b->sdo[i] = ecrt_slave_config_create_sdo_request(b->sc[i], 0x1018, 1, 4);
		b->reg[i] = ecrt_slave_config_create_reg_request(b->sc[i], 2);
		if (!b->sdo[i] || !b->reg[i])
			return -1;
	}
	b->n_requests = i;
	return 0;
}

/* What has arrived, and what everybody is at. */
void extras_ask(struct bench *b, long long at)
{
	uint8_t emergency[EC_COE_EMERGENCY_MSG_SIZE];
	ec_slave_config_state_t sc;
	ec_master_link_state_t ls;
	ec_master_state_t ms;
	ec_domain_state_t ds;
	unsigned int i;
	uint32_t ref;

	b->call_errors += !!ecrt_master_application_time(b->master, (uint64_t)at);
	b->call_errors += !!ecrt_master_state(b->master, &ms);
	b->call_errors += !!ecrt_master_link_state(b->master, 0, &ls);
	ecrt_master_reference_clock_time(b->master, &ref);
	ecrt_master_sync_monitor_process(b->master);
	for (i = 0; i < b->n_domains; i++)
		b->call_errors += !!ecrt_domain_state(b->domains[i], &ds);
	for (i = 0; i < b->slaves; i++)
		b->call_errors += !!ecrt_slave_config_state(b->sc[i], &sc);
	for (i = 0; i < b->n_requests; i++) {
		while (!ecrt_slave_config_emerg_pop(b->sc[i], emergency))
			;
		if (ecrt_sdo_request_state(b->sdo[i]) != EC_REQUEST_BUSY) {
			b->requests_done += ecrt_sdo_request_state(b->sdo[i]) ==
					    EC_REQUEST_SUCCESS;
			ecrt_sdo_request_read(b->sdo[i]);
		}
		if (ecrt_reg_request_state(b->reg[i]) != EC_REQUEST_BUSY) {
			b->requests_done += ecrt_reg_request_state(b->reg[i]) ==
					    EC_REQUEST_SUCCESS;
			ecrt_reg_request_read(b->reg[i], STATUS_REG, 2);
		}
	}
}

/* Clock datagrams of the next send. */
void extras_queue(struct bench *b, long long at)
{
	if (b->mode != MODE_OWN)
		return;		/* the kernel queues them */
	ecrt_master_sync_reference_clock_to(b->master, (uint64_t)at);
	ecrt_master_sync_slave_clocks(b->master);
	ecrt_master_sync_monitor_queue(b->master);
}
