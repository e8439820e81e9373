// SPDX-License-Identifier: GPL-2.0-only
/* All layers in a master that no module parameter names and no monitor watches. */
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/slab.h>
#include "devices/sim/describe.h"
#include "devices/sim/sim_link.h"
#include "devices/sim/sim_wire.h"
#include "include/ecrt.h"
#include "master/boundary/api.h"
#include "master/boundary/cdev.h"
#include "master/boundary/ioctl.h"
#include "master/boundary/master.h"
#include "master/bus/bus_list.h"
#include "master/bus/scan.h"
#include "master/carry/posts.h"
#include "master/config/apply.h"
#include "master/link/device.h"
#include "alone.h"
#include "master/session/reserve.h"
#include "master/session/session_attach.h"
#include "master/session/session_units.h"
#include "master/clock/dc.h"

static const u8 mac[ETH_ALEN] = { 0x02, 0x00, 0x00, 0xec, 0x00, 0x03 };
static const char text[] =
	"segment seed=7\n"
	"slave coupler EK1100\n"
	"slave axis drive in=8 out=8\n";

enum { AXIS = 1, SLAVES };

struct bench {
	struct ec_master *m;
	struct ec_sim *sim;
	struct ec_sim_link *device;
	struct ec_file file;
};

static bool attached(const struct ec_slave *s)
{
	return ec_config_of(s);
}

static const struct ec_links_ops links_ops = {
	.changed = ec_carry_changed,
};

/* of layers below */
static const struct ec_bus_ops bus_ops = {
	.configure = ec_apply,
	.attached = attached,
};

/* what the top does, without monitor */
static int compose(struct ec_master *m)
{
	int ret;

	ec_base_init(m->base, 0, 0);
	ec_eoe_init(&m->eoe);
	m->sessions.base = m->base;
	m->sessions.links = &m->links;
	m->sessions.bus = &m->bus;
	m->sessions.dc = &m->dc;
	m->sessions.cycles = &m->cycles;
	m->riders.links = &m->links;
	ret = ec_links_init(&m->links, m->base, &links_ops, "test0", NULL) ?:
	      ec_carry_init(&m->carry, &m->links, NULL);
	if (ret)
		return ret;
	ec_cycles_init(&m->cycles, m->base, &m->carry, &m->riders, &m->dc);
	ret = ec_bus_init(&m->bus, m->base, &m->links, &bus_ops) ?:
	      ec_sessions_init(&m->sessions, ec_session_again, ec_session_units);
	ec_setup_init(&m->bus);
	ec_dc_init(&m->dc, m->base, &m->links, &m->bus, m->sessions.service);
	ret = ret ?: ec_api_create(m) ?: ec_cdev_init();
	if (ret)
		return ret;
	ec_cdev_add(m);
	ec_device_register(&m->links);
	return ec_cdev_publish(false);
}

static void bench_free(struct bench *b)
{
	struct ec_master *m = b->m;

	WRITE_ONCE(m->base->stopping, true);
	ec_cdev_unpublish();
	ec_cdev_remove();
	ec_session_end(&m->sessions, NULL);
	ec_dc_exit(&m->dc);
	ec_sessions_exit(&m->sessions);
	ec_bus_stop(&m->bus);
	ec_api_destroy(m);
	ec_device_unregister(&m->links);
	ec_carry_exit(&m->carry);
	ec_links_exit(&m->links);
	ec_bus_exit(&m->bus);
	kvfree(m);
	ec_cdev_exit();
	if (b->device)
		ec_sim_link_destroy(b->device);
	kfree(b);
}

static bool scan(struct ec_master *m)
{
	struct ec_scan_result result;

	if (!CHECK_EQ(ec_scan(&m->bus, SLAVES, &result), 0))
		return false;
	ec_links_look(&m->links);
	WRITE_ONCE(m->bus.responding, SLAVES);
	WRITE_ONCE(m->bus.looked, true);
	WRITE_ONCE(m->bus.slaves[AXIS]->pdos.wanted, true);
	ec_slave_kick(m->bus.slaves[AXIS]);
	while (ec_slave_busy(m->bus.slaves[AXIS]))
		usleep_range(100, 200);
	return true;
}

static struct bench *bench_new(void)
{
	struct bench *b = kzalloc(sizeof(*b), GFP_KERNEL);
	struct ec_sim_error err = { 0 };

	if (!CHECK(b))
		return NULL;
	b->m = kvzalloc(sizeof(*b->m), GFP_KERNEL);
	/* what has no memory here has none to test either */
	if (!CHECK(b->m) || !CHECK_EQ(compose(b->m), 0))
		return NULL;
	ec_file_init(&b->file, b->m, true);
	if (CHECK_EQ(ec_sim_describe(&b->sim, &ec_sim_kernel_ops, text, strlen(text), NULL, &err),
		     0)) {
		b->device = ec_sim_link_create("test0", mac, b->sim, 0);
		if (CHECK(!IS_ERR(b->device)) && scan(b->m))
			return b;
	}
	bench_free(b);
	return NULL;
}

static void commands_show_the_bus(void)
{
	struct bench *b = bench_new();
	struct ec_ioc_master m = { 0 };
	struct ec_ioc_slave s = { .slave.position = AXIS };

	if (!b)
		return;
	CHECK_EQ(ec_ioc(&b->file, EC_IOC_MASTER, &m), 0);
	CHECK_EQ(m.slave_count, SLAVES);
	CHECK_EQ(m.scan_busy, false);
	CHECK_EQ(ec_ioc(&b->file, EC_IOC_SLAVE, &s), 0);
	CHECK_EQ(s.al_status, EC_AL_PREOP);
	CHECK_EQ(s.vendor_id, b->m->bus.slaves[AXIS]->info.vendor);
	s.slave.position = SLAVES;
	CHECK_OP(ec_ioc(&b->file, EC_IOC_SLAVE, &s), <, 0);
	CHECK(b->file.reason[0]);
	bench_free(b);
}

static void second_application_is_refused_with_a_reason(void)
{
	struct bench *b = bench_new();
	struct ec_ioc_create_domain d = { 0 };
	struct ec_file other = { 0 };

	if (!b)
		return;
	ec_file_init(&other, b->m, true);
	CHECK_EQ(ec_ioc(&b->file, EC_IOC_RESERVE, NULL), 0);
	CHECK_EQ(ec_ioc(&other, EC_IOC_RESERVE, NULL), -EBUSY);
	CHECK(strstr(other.reason, "process"));
	CHECK_OP(ec_ioc(&other, EC_IOC_CREATE_DOMAIN, &d), <, 0);
	CHECK_EQ(ec_ioc(&b->file, EC_IOC_CREATE_DOMAIN, &d), 0);
	CHECK_EQ(b->m->sessions.session->wanted.n_domains, 1);
	ec_session_end(&b->m->sessions, &b->file);
	bench_free(b);
}

struct app {
	ec_master_t *m;
	ec_domain_t *d;
};

static int cycle(void *arg)
{
	struct app *a = arg;

	while (!kthread_should_stop()) {
		ecrt_master_receive(a->m);
		ecrt_domain_process(a->d);
		ecrt_domain_queue(a->d);
		ecrt_master_send(a->m);
		usleep_range(1000, 1001);
	}
	return 0;
}

static bool in_op(void *slave)
{
	return READ_ONCE(((struct ec_slave *)slave)->al.status) == EC_AL_OP;
}

static void application_in_the_kernel_takes_a_slave_to_op(void)
{
	struct bench *b = bench_new();
	struct app a = { NULL };
	ec_slave_config_t *sc;
	struct task_struct *t;
	struct ec_slave *axis;

	if (!b)
		return;
	axis = b->m->bus.slaves[AXIS];
	a.m = ecrt_request_master(0);
	if (CHECK(a.m)) {
		a.d = ecrt_master_create_domain(a.m);
		sc = ecrt_master_slave_config(a.m, 0, AXIS, axis->info.vendor,
					      axis->info.product);
		CHECK(a.d && sc);
		CHECK_EQ(ecrt_slave_config_reg_pdo_entry_pos(sc, 2, 0, 0, a.d, NULL), 0);
		CHECK_EQ(ecrt_slave_config_reg_pdo_entry_pos(sc, 3, 0, 0, a.d, NULL), 8);
		CHECK_EQ(ecrt_master_activate(a.m), 0);
		t = kthread_run(cycle, &a, "ec_alone");
		if (CHECK(!IS_ERR(t))) {
			CHECK(alone_wait(in_op, axis, 5000));
			kthread_stop(t);
		}
		ecrt_release_master(a.m);
	}
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(commands_show_the_bus),
	TEST(second_application_is_refused_with_a_reason),
	TEST(application_in_the_kernel_takes_a_slave_to_op),
	{ }
};
