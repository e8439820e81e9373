// SPDX-License-Identifier: GPL-2.0-only
/* How domains are sent: the same data each way. */
#include "api.h"

/* the bench in OP, its wire works, with these options */
static void with(uint32_t options, uint8_t overlap, unsigned int working_counter)
{
	ec_domain_state_t ds;
	ec_domain_age_t age;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	SILENT(CALL(ecrt_domain_set_options)(b.d, options), 0);
	SILENT(CALL(ecrt_domain_set_max_age)(b.d, 5), 0);
	SILENT(CALL(ecrt_slave_config_overlapping_pdos)(b.motor, overlap), 0);
	IS(CALL(ecrt_domain_size)(b.d), 20);
	NEED(bench_activate(&b) && bench_op(&b));
	EC_WRITE_BIT(b.data + b.out_byte, b.out_bit, 1);
	EC_WRITE_U16(b.data + b.control, 0x0006);
	bench_cycle(&b, 20);
	IS(EC_READ_BIT(b.data + b.in_byte, b.in_bit), 1);
	IS(EC_READ_U16(b.data + b.status) & 0x6f, 0x21);
	IS(EC_READ_U16(b.data + b.control), 0x0006);
	IS(CALL(ecrt_domain_state)(b.d, &ds), 0);
	IS(ds.wc_state, EC_WC_COMPLETE);
	IS(ds.working_counter, working_counter);
	IS(CALL(ecrt_domain_age)(b.d, &age), 0);
	IS(age.age, 0);
	IS(age.limit, 5);
	YES(!age.stale);
	SAYS(CALL(ecrt_domain_set_max_age)(b.d, 2), -EBUSY);
	SAYS(CALL(ecrt_domain_set_options)(b.d, 0), -EBUSY);
	SAYS(CALL(ecrt_slave_config_overlapping_pdos)(b.motor, 0), -EBUSY);
	bench_down(&b);
}

static void plain(void) { with(0, 0, 6); }
static void overlapping(void) { with(0, 1, 6); }
static void overlap(void) { with(EC_DOMAIN_OVERLAP, 0, 6); }
static void own_frame(void) { with(EC_DOMAIN_OWN_FRAME, 0, 6); }
/* LRD and LWR: one for each slave that is read, one for each that is written */
static void separate(void) { with(EC_DOMAIN_SEPARATE, 0, 4); }

/* A cycle in which nothing else fits is refused, or makes so many late. */
static void late_cycles(void)
{
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	SAYS(CALL(ecrt_master_set_late_cycles)(b.m, 100001), -EINVAL);
	SILENT(CALL(ecrt_master_set_late_cycles)(b.m, 0), 0);
	SILENT(CALL(ecrt_master_set_send_interval)(b.m, 10), 0);
	SAYS(CALL(ecrt_master_activate)(b.m), -ENOSPC);
	SILENT(CALL(ecrt_master_set_late_cycles)(b.m, 1000), 0);
	SILENT(CALL(ecrt_master_activate)(b.m), 0);
	SAYS(CALL(ecrt_master_set_late_cycles)(b.m, 0), -EBUSY);
	bench_down(&b);
}

static void refused(void)
{
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	SAYS(CALL(ecrt_domain_set_options)(b.d, EC_DOMAIN_OVERLAP | EC_DOMAIN_SEPARATE), -EINVAL);
	SAYS(CALL(ecrt_domain_set_options)(b.d, 0x8000), -EOPNOTSUPP);
	bench_down(&b);
}

/* A group that is not connected, in a domain of its own */
static void groups(void)
{
	ec_group_info_t g = { .name = "tool", .by = EC_GROUP_ID, .value = 4711 };
	ec_slave_config_state_t cs;
	struct bench b;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_group)(b.m, &g), 0);
	IS(ecrt_master_group(b.m, &g), 0);
	NEED(CALL(ecrt_master_group_config)(b.m, 0, 0, 0xec51, 0x402));
	YES(ecrt_master_group_config(b.m, 0, 0, 0xec51, 0x402) ==
	    ecrt_master_group_config(b.m, 0, 0, 0xec51, 0x402));
	YES(!ecrt_master_group_config(b.m, 0, 0, 0xec51, 0x403));
	YES(!ecrt_master_group_config(b.m, 0, 2, 0xec51, 0x402));
	YES(!ecrt_master_group_config(b.m, 1, 0, 0xec51, 0x402));
	g.name = "other";
	SAYS(ecrt_master_group(b.m, &g), -EEXIST);
	g.value = 0;
	SAYS(ecrt_master_group(b.m, &g), -EINVAL);
	g.name = NULL;
	SAYS(ecrt_master_group(b.m, &g), -EINVAL);
	NEED(bench_activate(&b));
	IS(ecrt_slave_config_state(ecrt_master_group_config(b.m, 0, 0, 0xec51, 0x402), &cs), 0);
	YES(!cs.online && !cs.operational);
	g.name = "late";
	g.value = 5;
	SAYS(ecrt_master_group(b.m, &g), -EBUSY);
	bench_down(&b);
}

/* A unit that begins without authority: zeros until it is complete and has it */
static void units(void)
{
	ec_unit_config_t u = { .name = "axis", .policy = EC_UNIT_HOLD, .flags = EC_UNIT_AUTHORITY };
	ec_unit_state_t st;
	struct bench b;
	int i, ret;

	NEED(bench_request(&b) && bench_configure(&b));
	IS(CALL(ecrt_master_unit)(b.m, &u), 0);
	IS(ecrt_master_unit(b.m, &u), 0);
	u.limit = 9;
	SAYS(ecrt_master_unit(b.m, &u), -EEXIST);
	u.name = "1";
	SAYS(ecrt_master_unit(b.m, &u), -EINVAL);
	u.name = NULL;
	SAYS(ecrt_master_unit(b.m, &u), -EINVAL);
	SAYS(CALL(ecrt_domain_set_unit)(b.d, 1), -ENOENT);
	IS(ecrt_domain_set_unit(b.d, -2), -EINVAL);
	IS(ecrt_domain_set_unit(b.d, -1), 0);
	IS(ecrt_domain_set_unit(b.d, 0), 0);
	SAYS(CALL(ecrt_master_unit_authority)(b.m, 0, 1), -EINVAL);
	IS(CALL(ecrt_master_unit_state)(b.m, 0, &st), -EINVAL);
	NEED(bench_activate(&b));
	u.name = "late";
	SAYS(ecrt_master_unit(b.m, &u), -EBUSY);
	IS(ecrt_master_unit_state(b.m, 0, NULL), -EINVAL);
	IS(ecrt_master_unit_state(b.m, 1, &st), -EINVAL);
	IS(ecrt_master_unit_state(b.m, 64, &st), -EINVAL);
	IS(ecrt_master_unit_state(b.m, 0, &st), 0);
	YES(!st.authority && st.outputs == EC_UNIT_SENDS_ZEROS);
	SAYS(ecrt_master_unit_authority(b.m, 1, 1), -ENOENT);
	SAYS(CALL(ecrt_master_unit_hold)(b.m, "axis", NULL), -EPERM);
	SAYS(ecrt_master_unit_hold(b.m, NULL, NULL), -EINVAL);
	SAYS(CALL(ecrt_master_unit_write)(b.m, 0, (const uint8_t *)&st, 1, NULL), -EPERM);
	SAYS(CALL(ecrt_master_unit_read)(b.m, 0, (uint8_t *)&st, 1, &st), -EPERM);
	NEED(bench_op(&b));
	for (i = 0, ret = -EINPROGRESS; i < 2000 && ret == -EINPROGRESS; i++) {
		bench_cycle(&b, 1);
		ret = ecrt_master_unit_authority(b.m, 0, 1);
	}
	IS(ret, 0);
	bench_cycle(&b, 1);
	bench_cycle(&b, 1);
	IS(ecrt_master_unit_state(b.m, 0, &st), 0);
	YES(st.authority && st.outputs == EC_UNIT_SENDS_APPLICATION && st.run == EC_UNIT_COMPLETE);
	YES(!st.faults && !st.down && !st.held && !st.lease_ended);
	bench_down(&b);
}

const struct api_case layout_cases[] = {
	{ "as it is without options", plain },
	{ "a slave whose process data overlap", overlapping },
	{ "overlap", overlap },
	{ "separate", separate },
	{ "own frame", own_frame },
	{ "late cycles", late_cycles },
	{ "hot connect groups", groups },
	{ "sync units", units },
	{ "what cannot be is refused", refused },
	{ NULL, NULL },
};
