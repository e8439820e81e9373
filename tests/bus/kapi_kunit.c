// SPDX-License-Identifier: GPL-2.0-only
/* Life and configuration of applications in the kernel. */
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/sched/signal.h>
#include "kapp.h"
#include "devices/sim/app.h"
#include "master/boundary/api.h"
#include "master/config/config.h"
#include "master/boundary/ioctl.h"

static const char pair[] = "segment seed=8\nslave a drive in=8 out=8 mbox=128 serial=11 mapping=rewritable\n"
			   "slave b io in=16 out=16\nconnect b.1 -> b.1\nconnect b.9 -> b.9\n";

static void kapi_request(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	ec_master_t *m;

	KUNIT_EXPECT_EQ(test, ecrt_version_magic(), 0x0106u);
	KUNIT_EXPECT_NULL(test, ecrt_request_master(1));
	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	/* a second one, in the kernel or a process, is told */
	KUNIT_EXPECT_NULL(test, ecrt_request_master(0));
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), -EBUSY);
	KUNIT_EXPECT_NOT_NULL(test,
			      strstr(b->app.reason, "reserved by an application in the kernel"));
	/* and does not take it from the first one by giving it back */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RELEASE, NULL), -EPERM);
	KUNIT_EXPECT_NOT_NULL(test, ecrt_master_create_domain(m));
	ecrt_release_master(m);
	ecrt_release_master(m);
	ecrt_release_master(NULL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_NULL(test, ecrt_request_master(0));
	/* a master that was given back is nobody's */
	KUNIT_EXPECT_NULL(test, ecrt_master_create_domain(m));
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(m), -EPERM);
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(m, 1), -EPERM);
	KUNIT_EXPECT_EQ(test, ecrt_master_send(m), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RELEASE, NULL), 0);
	m = ecrt_request_master(0);
	KUNIT_EXPECT_NOT_NULL(test, m);
	ecrt_release_master(m);
}

static void kapi_without_device(struct kunit *test)
{
	struct bus *b = bus_new(test, pair);
	ec_master_t *m;

	KUNIT_EXPECT_NULL(test, ecrt_request_master(0));
	KUNIT_EXPECT_NOT_NULL_MSG(test,
				  strstr(bus_api(b)->file.reason, "waiting for its device bus0"),
				  "%s", bus_api(b)->file.reason);
	/* nothing but the device was missing */
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	bus_idle(b);
	m = ecrt_request_master(0);
	KUNIT_EXPECT_NOT_NULL(test, m);
	ecrt_release_master(m);
}

/* What the master knows, without any lock or traffic. */
static void kapi_info(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	ec_master_scan_progress_t progress;
	ec_master_link_state_t link;
	ec_master_state_t state;
	ec_master_info_t info;
	ec_slave_info_t slave;
	ec_master_t *m;

	bus_idle(b);
	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(m, 77), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master(m, &info), 0);
	KUNIT_EXPECT_EQ(test, info.slave_count, 2u);
	KUNIT_EXPECT_TRUE(test, info.link_up);
	KUNIT_EXPECT_EQ(test, info.scan_busy, 0);
	KUNIT_EXPECT_EQ(test, info.app_time, 77ull);
	KUNIT_EXPECT_EQ(test, ecrt_master_scan_progress(m, &progress), 0);
	KUNIT_EXPECT_EQ(test, progress.slave_count, 2u);
	KUNIT_EXPECT_EQ(test, progress.scan_index, 2u);
	KUNIT_EXPECT_EQ(test, ecrt_master_state(m, &state), 0);
	KUNIT_EXPECT_EQ(test, state.slaves_responding, 2u);
	KUNIT_EXPECT_TRUE(test, state.al_states == EC_AL_STATE_PREOP);
	KUNIT_EXPECT_TRUE(test, state.link_up);
	KUNIT_EXPECT_EQ(test, ecrt_master_link_state(m, 0, &link), 0);
	KUNIT_EXPECT_EQ(test, link.slaves_responding, 2u);
	KUNIT_EXPECT_TRUE(test, link.al_states == EC_AL_STATE_PREOP);
	KUNIT_EXPECT_EQ(test, ecrt_master_link_state(m, 1, &link), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_slave(m, 0, &slave), 0);
	KUNIT_EXPECT_EQ(test, slave.vendor_id, bus_slave(b, 0)->info.vendor);
	KUNIT_EXPECT_EQ(test, slave.serial_number, 11u);
	KUNIT_EXPECT_EQ(test, slave.al_state, EC_AL_STATE_PREOP);
	KUNIT_EXPECT_EQ(test, slave.ports[1].next_slave, 1);
	KUNIT_EXPECT_STREQ(test, slave.name, bus_slave(b, 0)->name);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_slave(m, 2, &slave), -ENOENT);
	ecrt_release_master(m);
}

static int ask_signalled(void *m)
{
	ec_slave_info_t slave;

	allow_signal(SIGUSR1);
	send_sig(SIGUSR1, current, 1);
	return ecrt_master_get_slave(m, 0, &slave);
}

/* A signal ends a call that waits for a change, with a code that applications know. */
static void kapi_signal_ends_call(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	ec_master_t *m = ecrt_request_master(0);
	struct task_struct *t;

	KUNIT_ASSERT_NOT_NULL(test, m);
	bus_lock(b);
	t = kthread_create(ask_signalled, m, "kapi-signal");
	if (!IS_ERR(t)) {
		get_task_struct(t);
		wake_up_process(t);
		msleep(20);
		KUNIT_EXPECT_EQ(test, kthread_stop(t), -EINTR);
		put_task_struct(t);
	}
	bus_unlock(b);
	KUNIT_EXPECT_FALSE(test, IS_ERR(t));
	ecrt_release_master(m);
	KUNIT_EXPECT_NULL(test, bus_session(b));
}

/* What a slave describes: SyncManagers, PDOs, entries; errors as in userspace. */
static void kapi_described(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	struct ec_slave *s = bus_slave(b, 0);
	ec_master_t *m = ecrt_request_master(0);
	const struct ec_pdo *known;
	ec_pdo_entry_info_t entry;
	ec_sync_info_t sync;
	ec_pdo_info_t pdo;

	KUNIT_ASSERT_NOT_NULL(test, m);
	known = &s->pdos.sm[2].pdos[0];
	KUNIT_EXPECT_EQ(test, ecrt_master_get_sync_manager(m, 0, 2, &sync), 0);
	KUNIT_EXPECT_EQ(test, sync.index, 2);
	KUNIT_EXPECT_EQ(test, sync.dir, EC_DIR_OUTPUT);
	KUNIT_EXPECT_EQ(test, sync.n_pdos, s->pdos.sm[2].n);
	KUNIT_EXPECT_NULL(test, sync.pdos);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_sync_manager(m, 0, 3, &sync), 0);
	KUNIT_EXPECT_EQ(test, sync.dir, EC_DIR_INPUT);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_pdo(m, 0, 2, 0, &pdo), 0);
	KUNIT_EXPECT_EQ(test, pdo.index, known->index);
	KUNIT_EXPECT_EQ(test, pdo.n_entries, known->n_entries);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_pdo_entry(m, 0, 2, 0, 0, &entry), 0);
	KUNIT_EXPECT_EQ(test, entry.index, known->entries[0].index);
	KUNIT_EXPECT_EQ(test, entry.bit_length, known->entries[0].bits);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_sync_manager(m, 0, 16, &sync), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_pdo(m, 0, 16, 0, &pdo), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_pdo_entry(m, 0, 16, 0, 0, &entry), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_sync_manager(m, 0, 9, &sync), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_sync_manager(m, 2, 2, &sync), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_pdo(m, 0, 2, 99, &pdo), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_pdo_entry(m, 0, 2, 0, 99, &entry), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_get_pdo(m, 0, 2, 0, NULL), -EINVAL);
	ecrt_release_master(m);
}

/* Process data both ways, then the same master once more without giving it back. */
static void kapi_cycle(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	struct kapp *k;
	u32 i, round;
	u8 *pd;

	bus_idle(b);
	k = kapp_new(b, 1000);
	for (round = 0; round < 2; round++) {
		if (round)
			k->d = ecrt_master_create_domain(k->m);
		kapp_map(k, 0);
		kapp_map(k, 1);
		KUNIT_EXPECT_EQ(test, ecrt_domain_size(k->d), (size_t)(8 + 8 + 2 + 2));
		KUNIT_EXPECT_NULL(test, ecrt_domain_data(k->d));
		KUNIT_EXPECT_EQ(test, ecrt_domain_queue(k->d), -EINVAL);
		KUNIT_EXPECT_EQ(test, ecrt_domain_process(k->d), -EINVAL);
		KUNIT_EXPECT_EQ(test, ecrt_master_receive(k->m), -EINVAL);
		kapp_op(k);
		/* once more is no error here */
		KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), 0);
		pd = ecrt_domain_data(k->d);
		KUNIT_ASSERT_NOT_NULL(test, pd);
		k->incomplete = 0;
		for (i = 0; i < 20; i++) {
			EC_WRITE_U16(pd + k->out[1], 0x0101 * (i & 1));
			EC_WRITE_U16(pd + k->out[0], i);
			kapp_run(k, 3);
			KUNIT_EXPECT_EQ(test, EC_READ_U16(pd + k->in[1]), 0x0101 * (i & 1));
			KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "a"), EC_APP_OUT, 0), i);
		}
		KUNIT_EXPECT_EQ(test, k->incomplete, 0ull);
		KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
		KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
		KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), -EINVAL);
		KUNIT_EXPECT_EQ(test, ecrt_master_send(k->m), -EINVAL);
		KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 3000), ~0ull);
		memset(k->sc, 0, sizeof(k->sc));
	}
	ecrt_release_master(k->m);
}

static void kapi_external_memory(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	u8 *own = kunit_kzalloc(test, 64, GFP_KERNEL);
	ec_domain_t *second;
	struct kapp *k;
	int other;

	bus_idle(b);
	KUNIT_ASSERT_NOT_NULL(test, own);
	k = kapp_new(b, 1000);
	kapp_map(k, 0);
	/* one behind it lies in the master's memory */
	second = ecrt_master_create_domain(k->m);
	kapp_config(k, 1);
	other = ecrt_slave_config_reg_pdo_entry_pos(k->sc[1], 0, 0, 0, second, NULL);
	KUNIT_ASSERT_GE(test, other, 0);
	memset(own, 0x5a, 64);
	ecrt_domain_external_memory(k->d, own);
	KUNIT_EXPECT_PTR_EQ(test, ecrt_domain_data(k->d), own);
	KUNIT_EXPECT_NULL(test, ecrt_domain_data(second));
	EC_WRITE_U16(own + k->out[0], 0x1234);
	kapp_op(k);
	KUNIT_EXPECT_PTR_EQ(test, ecrt_domain_data(k->d), own);
	KUNIT_EXPECT_PTR_NE(test, ecrt_domain_data(second), own);
	kapp_run(k, 3);
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "a"), EC_APP_OUT, 0), 0x1234);
	/* the status word came here, and nothing beyond the domain */
	KUNIT_EXPECT_NE(test, EC_READ_U16(own + k->in[0]), 0x5a5a);
	KUNIT_EXPECT_EQ(test, own[ecrt_domain_size(k->d)], 0x5a);
	/* too late */
	ecrt_domain_external_memory(k->d, own + 1);
	KUNIT_EXPECT_PTR_EQ(test, ecrt_domain_data(k->d), own);
	ecrt_release_master(k->m);
	KUNIT_EXPECT_EQ(test, EC_READ_U16(own + k->out[0]), 0x1234);
}

static const ec_pdo_entry_info_t new_out[] = {
	{ 0x6040, 0, 16 }, { 0x607A, 0, 32 }, { 0x6071, 0, 16 },
};

static const ec_pdo_entry_info_t new_in[] = { { 0x6041, 0, 16 }, { 0x6064, 0, 32 } };
static const ec_pdo_info_t out_pdos[] = { { 0x1600, 3, new_out } };
static const ec_pdo_info_t in_pdos[] = { { 0x1a00, 2, new_in } };

static const ec_sync_info_t syncs[] = {
	{ 0, EC_DIR_OUTPUT }, { 1, EC_DIR_INPUT },
	{ 2, EC_DIR_OUTPUT, 1, out_pdos, EC_WD_ENABLE },
	{ 3, EC_DIR_INPUT, 1, in_pdos, EC_WD_DISABLE },
	{ 0xff }
};

/* A mapping of one's own, entries registered one by one and as a list. */
static void kapi_pdos(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	u32 vendor = bus_slave(b, 0)->info.vendor, product = bus_slave(b, 0)->info.product;
	unsigned int control, status, position, bit = 9;
	const ec_pdo_entry_reg_t regs[] = {
		{ 0, 0, vendor, product, 0x6040, 0, &control },
		{ 0, 0, vendor, product, 0x6041, 0, &status, &bit },
		{ 0, 0, vendor, product, 0x6064, 0, &position },
		{}
	}, wrong[] = { { 0, 0, vendor, product, 0x6060, 0, &control }, {} };
	struct kapp *k;
	int target;

	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_config(k, 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdos(k->sc[0], EC_END, NULL), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdos(k->sc[0], EC_END, syncs), 0);
	/* the last entry again by single calls */
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sync_manager(k->sc[0], 3, EC_DIR_INPUT,
							     EC_WD_DEFAULT), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_assign_clear(k->sc[0], 3), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_assign_add(k->sc[0], 3, 0x1a00), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_mapping_clear(k->sc[0], 0x1a00), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_mapping_add(k->sc[0], 0x1a00, 0x6041, 0, 16),
			0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_mapping_add(k->sc[0], 0x1a00, 0x6064, 0, 32),
			0);
	KUNIT_EXPECT_EQ(test, ecrt_domain_reg_pdo_entry_list(k->d, regs), 0);
	KUNIT_EXPECT_EQ(test, control, 0u);
	KUNIT_EXPECT_EQ(test, status, 8u);
	KUNIT_EXPECT_EQ(test, position, 10u);
	KUNIT_EXPECT_EQ(test, bit, 0u);
	target = ecrt_slave_config_reg_pdo_entry(k->sc[0], 0x607A, 0, k->d, NULL);
	KUNIT_EXPECT_EQ(test, target, 2);
	/* the same handle for the same slave; another device is refused */
	KUNIT_EXPECT_PTR_EQ(test, ecrt_master_slave_config(k->m, 0, 0, vendor, product), k->sc[0]);
	KUNIT_EXPECT_NULL(test, ecrt_master_slave_config(k->m, 0, 0, vendor, product + 1));
	/* what cannot be */
	KUNIT_EXPECT_EQ(test, ecrt_domain_reg_pdo_entry_list(k->d, wrong), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sync_manager(k->sc[0], 16, EC_DIR_INPUT,
							     EC_WD_DEFAULT), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sync_manager(k->sc[0], 2, EC_DIR_INVALID,
							     EC_WD_DEFAULT), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_assign_add(k->sc[0], 16, 0x1600), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_assign_clear(k->sc[0], 16), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdo_mapping_add(k->sc[0], 0x1700, 0x6040, 0, 16),
			-ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry_pos(k->sc[0], 16, 0, 0, k->d, NULL),
			-EINVAL);
	kapp_op(k);
	EC_WRITE_S32(ecrt_domain_data(k->d) + target, -5);
	kapp_run(k, 3);
	KUNIT_EXPECT_EQ(test, ec_app_channel(bus_app(b, "a"), EC_APP_OUT, 1), -5);
	/* configuring is over */
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_pdos(k->sc[0], EC_END, syncs), -EBUSY);
	KUNIT_EXPECT_NULL(test, ecrt_master_create_domain(k->m));
	KUNIT_EXPECT_NULL(test, ecrt_master_slave_config(k->m, 0, 1, vendor, product));
	/* what there is, is found */
	KUNIT_EXPECT_PTR_EQ(test, ecrt_master_slave_config(k->m, 0, 0, vendor, product), k->sc[0]);
	KUNIT_EXPECT_NULL(test, ecrt_master_slave_config(k->m, 0, 0, vendor, product + 1));
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_select_reference_clock(k->m, NULL), -EBUSY);
	ecrt_release_master(k->m);
}

/* What was registered does not change any more; a refusal leaves nothing behind. */
static void kapi_map_first(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8 mapping=rewritable\n", 1);
	unsigned int bit = 9;
	ec_slave_config_t *sc;
	ec_domain_t *other;
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, 1000);
	sc = kapp_config(k, 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_mapping_clear(sc, 0x1600), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_mapping_add(sc, 0x1600, 0, 0, 3), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_mapping_add(sc, 0x1600, 0x6040, 0, 16), 0);
	/* bit 3, and no place for that */
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x6040, 0, k->d, NULL), -EFAULT);
	KUNIT_EXPECT_EQ(test, ecrt_domain_size(k->d), 0ul);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry_pos(sc, 2, 0, 1, k->d, NULL),
			-EFAULT);
	KUNIT_EXPECT_EQ(test, ecrt_domain_size(k->d), 0ul);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x6040, 0, k->d, &bit), 0);
	KUNIT_EXPECT_EQ(test, bit, 3u);
	KUNIT_EXPECT_EQ(test, ecrt_domain_size(k->d), 3ul);
	/* another one is larger: the entry would lie in the neighbour's place, or beside it */
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_mapping_clear(sc, 0x1600), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_mapping_add(sc, 0x1600, 0x6040, 0, 16), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_mapping_add(sc, 0x1600, 0x607A, 0, 32), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x607A, 0, k->d, NULL), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x6040, 0, k->d, NULL), -EBUSY);
	/* in another domain it is the first */
	other = ecrt_master_create_domain(k->m);
	KUNIT_ASSERT_NOT_NULL(test, other);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x607A, 0, other, NULL), 2);
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), -EBUSY);
	ecrt_release_master(k->m);
}

/* The direction counts, too; what is the same in the end is no change. */
static void kapi_map_again(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8 mapping=rewritable\n", 1);
	ec_slave_config_t *sc;
	struct kapp *k;

	bus_idle(b);
	k = kapp_new(b, 1000);
	sc = kapp_config(k, 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_assign_clear(sc, 2), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_assign_add(sc, 2, 0x1600), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x6040, 0, k->d, NULL), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_assign_clear(sc, 2), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_pdo_assign_add(sc, 2, 0x1600), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x6040, 0, k->d, NULL), 0);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_sync_manager(sc, 2, EC_DIR_INPUT, EC_WD_DEFAULT),
			0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_reg_pdo_entry(sc, 0x6040, 0, k->d, NULL), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), -EBUSY);
	KUNIT_ASSERT_EQ(test, ecrt_slave_config_sync_manager(sc, 2, EC_DIR_OUTPUT, EC_WD_DEFAULT),
			0);
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(k->m), 0);
	ecrt_release_master(k->m);
}

/* All that is kept for each time a slave is configured. */
static void kapi_stored(struct kunit *test)
{
	static const unsigned char mac[6] = { 2, 0, 0, 0xec, 1, 7 };
	static const u8 record[] = { 1, 0, 0x78, 0x56, 0x34, 0x12 };
	struct bus *b = bus_up(test, "slave a drive in=8 out=8 mbox=128\nslave sw EL6614\n", 2);
	struct in_addr ip = { htonl(0xc0a80011) }, mask = { htonl(0xffffff00) };
	struct ec_app *sw = bus_app(b, "sw");
	ec_slave_config_t *sc;
	const struct ec_config *c;
	struct kapp *k;
	u8 value[4];
	size_t got;
	u32 abort;

	bus_idle(b);
	k = kapp_new(b, 1000);
	kapp_map(k, 0);
	sc = k->sc[0];
	c = bus_config(k->b, 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_watchdog(sc, 2498, 500), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_flag(sc, "AssignToPdi", 1), 0);
	KUNIT_EXPECT_EQ(test, c->n_flags, 1u);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_flag(sc, "", 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_state_timeout(sc, EC_AL_STATE_PREOP,
							      EC_AL_STATE_SAFEOP, 1500), 0);
	KUNIT_EXPECT_EQ(test, c->timeout_ms[2][4], 1500u);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_state_timeout(sc, 3, EC_AL_STATE_OP, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sdo32(sc, 0x2001, 8, 0x12345678), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sdo16(sc, 0x2001, 7, 0x1122), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sdo8(sc, 0x2001, 2, 0x33), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sdo(sc, 0x2000, 0, record, 6), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_complete_sdo(sc, 0x2001, record, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_sdo(sc, 0x2000, 0, NULL, 4), -EINVAL);
	KUNIT_EXPECT_EQ(test, c->n_startup[EC_STARTUP_SDO], 4u);
	sc = kapp_config(k, 1);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_eoe_mac_address(sc, mac), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_eoe_ip_address(sc, ip), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_eoe_subnet_mask(sc, mask), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_eoe_default_gateway(sc, ip), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_eoe_dns_address(sc, ip), 0);
	KUNIT_EXPECT_EQ(test,
			ecrt_slave_config_eoe_hostname(sc,
						       "a-name-of-more-than-31-characters!"), 0);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_eoe_mac_address(NULL, mac), -EINVAL);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 0, 0x2001, 8, value, 4, &got, &abort),
			0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(value), 0x12345678u);
	KUNIT_EXPECT_EQ(test, ecrt_master_sdo_upload(k->m, 0, 0x2001, 7, value, 4, &got, &abort),
			0);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(value), 0x1122);
	KUNIT_EXPECT_EQ(test, sw->ip.now.which, (u32)EC_IP_ALL);
	KUNIT_EXPECT_MEMEQ(test, sw->ip.now.mac, mac, 6);
	KUNIT_EXPECT_MEMEQ(test, sw->ip.now.ip, "\xc0\xa8\x00\x11", 4);
	KUNIT_EXPECT_STREQ(test, (char *)sw->ip.now.name, "a-name-of-more-than-31-characte");
	ecrt_release_master(k->m);
}

/* Calls that get nothing answer, and touch nothing. */
static void kapi_null(struct kunit *test)
{
	KUNIT_EXPECT_NULL(test, ecrt_master_create_domain(NULL));
	KUNIT_EXPECT_NULL(test, ecrt_master_slave_config(NULL, 0, 0, 1, 1));
	KUNIT_EXPECT_EQ(test, ecrt_master_activate(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_send(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_send_ext(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_receive(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_reset(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_set_send_interval(NULL, 1000), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_application_time(NULL, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sync_reference_clock(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_sync_monitor_process(NULL), ~0u);
	KUNIT_EXPECT_EQ(test, ecrt_domain_queue(NULL), -EINVAL);
	KUNIT_EXPECT_NULL(test, ecrt_domain_data(NULL));
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_dc(NULL, 0, 0, 0, 0, 0), -EINVAL);
	KUNIT_EXPECT_NULL(test, ecrt_slave_config_create_sdo_request(NULL, 0, 0, 4));
	KUNIT_EXPECT_NULL(test, ecrt_slave_config_create_reg_request(NULL, 4));
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_read(NULL), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_sdo_request_state(NULL), EC_REQUEST_ERROR);
	KUNIT_EXPECT_EQ(test, ecrt_reg_request_read(NULL, 0, 4), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_slave_config_emerg_pop(NULL, NULL), -EINVAL);
	ecrt_master_callbacks(NULL, NULL, NULL, NULL);
	ecrt_domain_external_memory(NULL, NULL);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kapi_request),
	KUNIT_CASE(kapi_without_device),
	KUNIT_CASE(kapi_info),
	KUNIT_CASE(kapi_signal_ends_call),
	KUNIT_CASE(kapi_described),
	KUNIT_CASE(kapi_cycle),
	KUNIT_CASE(kapi_external_memory),
	KUNIT_CASE(kapi_pdos),
	KUNIT_CASE(kapi_map_first),
	KUNIT_CASE(kapi_map_again),
	KUNIT_CASE(kapi_stored),
	KUNIT_CASE(kapi_null),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
