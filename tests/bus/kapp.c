// SPDX-License-Identifier: GPL-2.0-only
#include <linux/hrtimer.h>
#include "kapp.h"

/**
 * kapp_new() - an application requests the master
 * @b: bus, scanned
 * @period_us: of its cycle
 *
 * Return: application with one domain.
 */
struct kapp *kapp_new(struct bus *b, u32 period_us)
{
	struct kapp *k = kunit_kzalloc(b->test, sizeof(*k), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(b->test, k);
	k->b = b;
	k->period_ns = (u64)period_us * NSEC_PER_USEC;
	k->m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(b->test, k->m);
	KUNIT_ASSERT_EQ(b->test, ecrt_master_set_send_interval(k->m, period_us), 0);
	k->d = ecrt_master_create_domain(k->m);
	KUNIT_ASSERT_NOT_NULL(b->test, k->d);
	return k;
}

/* The kernel runs the cycle, with the period of the application unless @cycle has one. */
void kapp_kernel_cycle(struct kapp *k, ec_cycle_config_t cycle)
{
	cycle.period_ns = cycle.period_ns ?: k->period_ns;
	KUNIT_ASSERT_EQ(k->b->test, ecrt_master_set_cycle(k->m, &cycle), 0);
	k->kernel = true;
}

/* Configure the slave at a ring position as what it is. */
ec_slave_config_t *kapp_config(struct kapp *k, u32 position)
{
	ec_slave_info_t info;

	KUNIT_ASSERT_EQ(k->b->test, ecrt_master_get_slave(k->m, position, &info), 0);
	k->sc[position] = ecrt_master_slave_config(k->m, 0, position, info.vendor_id,
						   info.product_code);
	KUNIT_ASSERT_NOT_NULL(k->b->test, k->sc[position]);
	return k->sc[position];
}

/* All process data of the slave at a ring position into the domain. */
void kapp_map(struct kapp *k, u32 position)
{
	ec_slave_config_t *sc = kapp_config(k, position);
	struct ec_slave *s = bus_slave(k->b, position);
	u32 sm;

	for (sm = 0; sm < s->n_sms; sm++) {
		u32 *offset = s->sms[sm].control & EC_SM_DIR_WRITE ? k->out : k->in;
		int ret;

		if (!ec_pdo_list_bytes(&s->pdos.sm[sm]))
			continue;
		ret = ecrt_slave_config_reg_pdo_entry_pos(sc, sm, 0, 0, k->d, NULL);
		KUNIT_ASSERT_GE(k->b->test, ret, 0);
		offset[position] = ret;
	}
}

void kapp_activate(struct kapp *k)
{
	KUNIT_ASSERT_EQ(k->b->test, ecrt_master_activate(k->m), 0);
	k->next = ktime_get();
}

/* until the next cycle begins */
void kapp_wait(struct kapp *k)
{
	if (k->kernel) {
		KUNIT_ASSERT_GT(k->b->test, ecrt_master_wait_cycle(k->m, 0), 0);
		return;
	}
	k->next = ktime_add_ns(k->next, k->period_ns);
	set_current_state(TASK_UNINTERRUPTIBLE);
	schedule_hrtimeout(&k->next, HRTIMER_MODE_ABS);
}

/* What an application does in a cycle; the first error, 0: none. */
int kapp_exchange(struct kapp *k)
{
	ec_domain_state_t state;
	int ret = ecrt_master_receive(k->m);

	ret = ret ?: ecrt_domain_process(k->d);
	ret = ret ?: ecrt_domain_state(k->d, &state);
	if (!ret)
		k->incomplete += state.wc_state != EC_WC_COMPLETE;
	if (k->each)
		k->each(k);
	ret = ret ?: ecrt_domain_queue(k->d);
	return ret ?: ecrt_master_send(k->m);
}

void kapp_run(struct kapp *k, u32 cycles)
{
	while (cycles--) {
		kapp_wait(k);
		KUNIT_ASSERT_EQ(k->b->test, kapp_exchange(k), 0);
	}
}

/* Are all configured slaves in OP, as the application sees them? */
bool kapp_all_op(struct kapp *k)
{
	ec_slave_config_state_t state;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(k->sc); i++) {
		if (!k->sc[i])
			continue;
		KUNIT_ASSERT_EQ(k->b->test, ecrt_slave_config_state(k->sc[i], &state), 0);
		if (!state.online || !state.operational || state.al_state != EC_AL_STATE_OP)
			return false;
	}
	return true;
}

/* Activate and cycle until all are in OP. */
void kapp_op(struct kapp *k)
{
	u32 i;

	kapp_activate(k);
	for (i = 0; i < 5000 && !kapp_all_op(k); i++)
		kapp_run(k, 1);
	KUNIT_ASSERT_TRUE(k->b->test, kapp_all_op(k));
}
