// SPDX-License-Identifier: GPL-2.0-only
/* Slave configuration: arguments, and what arrives at the slave. */
#include "api.h"

#define CODE(have, want) IS(have, want)
#define MISSING(pointer) YES(!(pointer))
#define CODES_NO_SLAVE (-EINVAL)
#include "../../bus/codes.h"

static void slave_config(void)
{
	struct bench b;
	ec_slave_config_t *sc;

	NEED(bench_request(&b));
	sc = CALL(ecrt_master_slave_config)(b.m, 0, OUT, BECKHOFF, EL2008);
	YES(sc && sc == CALL(ecrt_master_slave_config)(b.m, 0, OUT, BECKHOFF, EL2008));
	errno = 0;
	YES(!CALL(ecrt_master_slave_config)(b.m, 0, OUT, BECKHOFF, EL1008));
	IS(errno, ENOENT);
	/* somebody who is not there, and an identity that nobody has, are no errors */
	YES(CALL(ecrt_master_slave_config)(b.m, 0, NOWHERE, BECKHOFF, EL2008) != NULL);
	YES(CALL(ecrt_master_slave_config)(b.m, 0, IN, BECKHOFF, EL2008) != NULL);
	bench_down(&b);
}

/* by alias: the slave that has it, and the one behind it */
static void alias(void)
{
	ec_slave_config_t *out, *in;
	ec_slave_config_state_t s;
	struct bench b;

	NEED(bench_request(&b));
	out = CALL(ecrt_master_slave_config)(b.m, 1001, 0, BECKHOFF, EL2008);
	in = CALL(ecrt_master_slave_config)(b.m, 1001, 1, BECKHOFF, EL1008);
	IS(CALL(ecrt_slave_config_state)(out, &s), 0);
	IS(s.online, 1);
	IS(CALL(ecrt_slave_config_state)(in, &s), 0);
	IS(s.online, 1);
	bench_down(&b);
}

static void sync_manager(void)
{
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_slave_config_sync_manager)(b.motor, 2, EC_DIR_OUTPUT, EC_WD_DISABLE), 0);
	/* the mailbox: accepted */
	IS(CALL(ecrt_slave_config_sync_manager)(b.motor, 0, EC_DIR_OUTPUT, EC_WD_DEFAULT), 0);
	SAYS(CALL(ecrt_slave_config_sync_manager)(b.motor, 16, EC_DIR_OUTPUT, EC_WD_DEFAULT),
	     -ENOENT);
	SAYS(CALL(ecrt_slave_config_sync_manager)(b.motor, 2, EC_DIR_INVALID, EC_WD_DEFAULT),
	     -EINVAL);
	SAYS(CALL(ecrt_slave_config_sync_manager)(b.motor, 2, EC_DIR_COUNT, EC_WD_DEFAULT), -EINVAL);
	bench_down(&b);
}

static uint32_t read_reg(struct bench *b, ec_reg_request_t *req, uint16_t address)
{
	if (!IS(CALL(ecrt_reg_request_read)(req, address, 4), 0))
		return 0;
	for (int i = 0; i < 20000 && CALL(ecrt_reg_request_state)(req) == EC_REQUEST_BUSY; i++)
		bench_cycle(b, 1);
	IS(CALL(ecrt_reg_request_state)(req), EC_REQUEST_SUCCESS);
	return EC_READ_U32(CALL(ecrt_reg_request_data)(req));
}

/* watchdog mode of the SyncManager, watchdog times: in the registers */
static void watchdog(void)
{
	ec_reg_request_t *req;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_slave_config_watchdog)(b.motor, 2500, 2000), 0);
	IS(CALL(ecrt_slave_config_sync_manager)(b.out, 0, EC_DIR_OUTPUT, EC_WD_DISABLE), 0);
	req = CALL(ecrt_slave_config_create_reg_request)(b.motor, 4);
	NEED(req && bench_activate(&b) && bench_op(&b));
	IS(read_reg(&b, req, 0x0400) & 0xffff, 2500);
	IS(read_reg(&b, req, 0x0420) & 0xffff, 2000);
	/* SM2: output, watchdog on */
	IS(read_reg(&b, req, 0x0814) & 0x4c, 0x44);
	bench_down(&b);
}

/* Stored objects are written before OP; so the blocking read finds them. */
static void objects(void)
{
	const uint8_t bytes[3] = { 7, 8, 9 };
	uint8_t assign[4], back[8];
	ec_slave_config_t *servo;
	struct bench b;
	size_t size;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_slave_config_sdo8)(b.motor, 0x2001, 6, 0x81), 0);
	IS(CALL(ecrt_slave_config_sdo16)(b.motor, 0x2001, 7, 0x8182), 0);
	IS(CALL(ecrt_slave_config_sdo32)(b.motor, 0x2001, 8, 0x11223344), 0);
	/* the later one wins */
	IS(CALL(ecrt_slave_config_sdo32)(b.motor, 0x2001, 8, 0x81828384), 0);
	IS(CALL(ecrt_slave_config_sdo)(b.motor, 0x2000, 0, bytes, 3), 0);
	IS(CALL(ecrt_slave_config_sdo)(b.motor, 0x2000, 0, NULL, 3), -EINVAL);
	IS(CALL(ecrt_slave_config_sdo)(b.motor, 0x2000, 0, bytes, 0), -EINVAL);
	servo = CALL(ecrt_master_slave_config)(b.m, 0, SERVO, BECKHOFF, EL7201);
	EC_WRITE_U16(assign, 1);
	EC_WRITE_U16(assign + 2, 0x1601);
	IS(CALL(ecrt_slave_config_complete_sdo)(servo, 0x1c12, assign, 4), 0);
	IS(CALL(ecrt_slave_config_complete_sdo)(servo, 0x1c12, NULL, 4), -EINVAL);
	IS(CALL(ecrt_slave_config_complete_sdo)(servo, 0x1c12, assign, 0), -EINVAL);
	/* the PDOs that follow are the same, so that the servo comes up */
	IS(CALL(ecrt_slave_config_pdo_assign_clear)(servo, 2), 0);
	IS(CALL(ecrt_slave_config_pdo_assign_add)(servo, 2, 0x1601), 0);
	NEED(bench_activate(&b) && bench_op(&b));
	/* the bus is in use: these go between the cycles of another process */
	bench_down(&b);

	b.m = CALL(ecrt_open_master)(0);
	NEED(b.m);
	IS(CALL(ecrt_master_sdo_upload)(b.m, MOTOR, 0x2001, 6, back, 8, &size, NULL), 0);
	YES(size == 1 && EC_READ_U8(back) == 0x81);
	IS(CALL(ecrt_master_sdo_upload)(b.m, MOTOR, 0x2001, 7, back, 8, &size, NULL), 0);
	YES(size == 2 && EC_READ_U16(back) == 0x8182);
	IS(CALL(ecrt_master_sdo_upload)(b.m, MOTOR, 0x2001, 8, back, 8, &size, NULL), 0);
	YES(size == 4 && EC_READ_U32(back) == 0x81828384);
	IS(CALL(ecrt_master_sdo_upload)(b.m, SERVO, 0x1c12, 1, back, 8, &size, NULL), 0);
	YES(size == 2 && EC_READ_U16(back) == 0x1601);
	bench_down(&b);
}

static void settings(void)
{
	static const char longest[] = "123456789012345678901234567890123456789012345678901234567890123";
	struct bench b;
	char key[100];

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_slave_config_flag)(b.motor, "AssignToPdi", 0), 0);
	IS(CALL(ecrt_slave_config_flag)(b.motor, "AssignToPdi", 0), 0);
	IS(CALL(ecrt_slave_config_flag)(b.motor, "NobodyKnowsThis", -5), 0);
	IS(CALL(ecrt_slave_config_flag)(b.motor, longest, 1), 0);
	snprintf(key, sizeof(key), "%s4", longest);
	SAYS(CALL(ecrt_slave_config_flag)(b.motor, key, 1), -EINVAL);
	SAYS(CALL(ecrt_slave_config_flag)(b.motor, "", 1), -EINVAL);
	IS(CALL(ecrt_slave_config_flag)(b.motor, NULL, 1), -EINVAL);

	IS(CALL(ecrt_slave_config_state_timeout)(b.motor, EC_AL_STATE_PREOP, EC_AL_STATE_SAFEOP,
						 5000), 0);
	IS(CALL(ecrt_slave_config_state_timeout)(b.motor, EC_AL_STATE_PREOP, EC_AL_STATE_SAFEOP, 0),
	   0);
	SAYS(CALL(ecrt_slave_config_state_timeout)(b.motor, (ec_al_state_t)3, EC_AL_STATE_SAFEOP, 5),
	     -EINVAL);
	SAYS(CALL(ecrt_slave_config_state_timeout)(b.motor, EC_AL_STATE_PREOP, (ec_al_state_t)0, 5),
	     -EINVAL);

	IS(CALL(ecrt_slave_config_sdo_timeout)(b.motor, 20000), 0);
	SAYS(CALL(ecrt_slave_config_sdo_timeout)(b.motor, 60001), -EINVAL);
	IS(CALL(ecrt_slave_config_sdo_timeout)(b.motor, 0), 0);
	IS(CALL(ecrt_slave_config_replay)(b.motor, EC_REPLAY_NONE), 0);
	IS(CALL(ecrt_slave_config_replay)(b.motor, EC_REPLAY_DEFAULT), 0);
	SAYS(CALL(ecrt_slave_config_replay)(b.motor, (ec_replay_t)3), -EINVAL);
	IS(CALL(ecrt_slave_config_replay_sdo)(b.motor, 0x6060, 0), 0);
	SAYS(CALL(ecrt_slave_config_replay_idn)(b.motor, 8, 36), -EINVAL);
	IS(CALL(ecrt_slave_config_held)(b.motor), 0);
	SAYS(CALL(ecrt_slave_config_resume)(b.motor, 1), -ESTALE);
	IS(CALL(ecrt_slave_config_emerg_size)(b.motor, 4), 0);
	IS(CALL(ecrt_slave_config_emerg_size)(b.motor, 8), 0);
	SAYS(CALL(ecrt_slave_config_emerg_size)(b.motor, (size_t)1 << 30), -ENOMEM);
	SILENT(CALL(ecrt_slave_config_dc)(b.motor, 0x0300, 1000000, -5, 0, 0), 0);
	IS(CALL(ecrt_master_select_reference_clock)(b.m, b.motor), 0);
	IS(CALL(ecrt_master_select_reference_clock)(b.m, NULL), 0);
	SILENT(CALL(ecrt_master_set_send_interval)(b.m, 1000), 0);
	SILENT(CALL(ecrt_master_set_send_interval)(b.m, 0), -EINVAL);
	SILENT(CALL(ecrt_master_set_send_interval)(b.m, 2000000), 0);
	SILENT(CALL(ecrt_master_set_send_interval)(b.m, SIZE_MAX), 0);
	SILENT(CALL(ecrt_master_set_send_interval)(b.m, 1000), 0);
	SILENT(CALL(ecrt_master_application_time)(b.m, ~0ULL), 0);
	bench_down(&b);
}

static void ip_parameters(void)
{
	const unsigned char mac[6] = { 2, 0, 0, 0, 0, 1 };
	const struct in_addr ip = { htonl(0xc0a80005) }, mask = { htonl(0xffffff00) };
	ec_slave_config_state_t state = { 0 };
	ec_slave_config_t *eoe;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	eoe = CALL(ecrt_master_slave_config)(b.m, 0, SWITCH, BECKHOFF, EL6614);
	NEED(eoe);
	IS(CALL(ecrt_slave_config_eoe_mac_address)(eoe, mac), 0);
	IS(CALL(ecrt_slave_config_eoe_mac_address)(eoe, NULL), -EINVAL);
	IS(CALL(ecrt_slave_config_eoe_ip_address)(eoe, ip), 0);
	IS(CALL(ecrt_slave_config_eoe_subnet_mask)(eoe, mask), 0);
	IS(CALL(ecrt_slave_config_eoe_default_gateway)(eoe, ip), 0);
	IS(CALL(ecrt_slave_config_eoe_dns_address)(eoe, ip), 0);
	IS(CALL(ecrt_slave_config_eoe_hostname)(eoe, "switch"), 0);
	IS(CALL(ecrt_slave_config_eoe_hostname)(eoe, NULL), -EINVAL);
	/* longer than 31 characters: cut */
	IS(CALL(ecrt_slave_config_eoe_hostname)(eoe, "a-name-of-more-than-thirty-one-characters"), 0);
	NEED(bench_activate(&b) && bench_op(&b));
	for (int i = 0; i < 20000 && !state.operational; i++) {
		bench_cycle(&b, 1);
		CALL(ecrt_slave_config_state)(eoe, &state);
	}
	IS(state.operational, 1);
	SAYS(CALL(ecrt_slave_config_eoe_ip_address)(eoe, ip), -EBUSY);
	SAYS(CALL(ecrt_slave_config_eoe_hostname)(eoe, "switch"), -EBUSY);
	bench_down(&b);
}

/* the list that the kernel's functions pass as well, in UML */
static void codes(void)
{
	struct bench b;

	NEED(bench_request(&b));
	codes_all(b.m, MOTOR, OUT);
	bench_down(&b);
}

static void codes_kernel_cycle(void)
{
	const ec_cycle_config_t slow = { .period_ns = 1000000000 };
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_set_cycle)(b.m, &slow), 0);
	NEED(bench_activate(&b));
	codes_cycle_runs(b.m, b.d);
	bench_down(&b);
}

const struct api_case config_cases[] = {
	{ "a configuration is found again", slave_config },
	{ "slaves by alias", alias },
	{ "SyncManagers", sync_manager },
	{ "watchdogs are written", watchdog },
	{ "objects are written", objects },
	{ "IP parameters", ip_parameters },
	{ "flags, timeouts, emergencies, clocks", settings },
	{ "return codes as in the kernel", codes },
	{ "the same codes of a cycle that the kernel runs", codes_kernel_cycle },
	{ NULL, NULL },
};
