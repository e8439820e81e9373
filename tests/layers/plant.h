/* SPDX-License-Identifier: GPL-2.0-only */
/* Slaves in PREOP and what is wanted of them, without a session: for "config" and "cycle". */
#ifndef EC_PLANT_H
#define EC_PLANT_H

#include <linux/slab.h>
#include "master/bus/pdo_coe.h"
#include "master/bus/slave.h"
#include "master/config/apply.h"
#include "master/config/config.h"
#include "master/config/domain.h"
#include "scanned.h"
#include "master/clock/dc.h"

/**
 * struct plant - a segment and a configuration
 * @s: segment and slaves
 * @dc: clocks
 * @service: its queue
 * @lock: of @wanted
 * @memory: of @wanted
 * @sends: cycles so far
 * @wanted: configurations and domains
 */
struct plant {
	struct scanned s;
	struct ec_dc dc;
	struct workqueue_struct *service;
	struct mutex lock;
	atomic_long_t memory;
	aligned_u64 sends;
	struct ec_wanted wanted;
};

static inline void plant_end(struct plant *p)
{
	unsigned int i;

	for (i = 0; i < p->wanted.n_configs; i++) {
		struct ec_config *c = p->wanted.configs[i];

		ec_setup_of(c->slave)->config = NULL;
		ec_slave_unref(c->slave);
		ec_config_free(c);
	}
	kvfree(p->wanted.configs);
	for (i = 0; i < p->wanted.n_domains; i++)
		ec_domain_free(p->wanted.domains[i]);
	ec_dc_exit(&p->dc);
	destroy_workqueue(p->service);
	scanned_end(&p->s);
}

/* @p is zeroed; plant_end() must follow when it returns true */
static inline bool plant_begin(struct plant *p, const char *text, unsigned int slaves)
{
	unsigned int i;

	p->service = alloc_workqueue("ec_alone", WQ_UNBOUND, 0);
	if (!CHECK(p->service))
		return false;
	if (!scanned_begin(&p->s, text)) {
		destroy_workqueue(p->service);
		return false;
	}
	ec_dc_init(&p->dc, &p->s.seg.base, &p->s.seg.links, &p->s.bus, p->service);
	ec_setup_init(&p->s.bus);
	mutex_init(&p->lock);
	p->wanted.base = &p->s.seg.base;
	p->wanted.links = &p->s.seg.links;
	p->wanted.bus = &p->s.bus;
	p->wanted.lock = &p->lock;
	spin_lock_init(&p->wanted.writes_lock);
	p->wanted.sends = &p->sends;
	p->wanted.budget.lock = &p->lock;
	p->wanted.budget.total = &p->memory;
	if (!scanned_scan(&p->s, slaves)) {
		plant_end(p);
		return false;
	}
	for (i = 0; i < slaves; i++) {
		mutex_lock(&p->s.bus.slaves[i]->lock);
		ec_slave_read_coe_pdos(p->s.bus.slaves[i]);
		mutex_unlock(&p->s.bus.slaves[i]->lock);
	}
	return true;
}

/* the configuration of a slave, attached to it; with the lock */
static inline struct ec_config *plant_config(struct plant *p, u16 position)
{
	struct ec_slave *s = p->s.bus.slaves[position];
	struct ec_config *c = ec_config_create(&p->wanted, 0, position, s->info.vendor,
					       s->info.product);

	if (!CHECK(!IS_ERR(c)))
		return NULL;
	c->slave = ec_slave_ref(s);
	ec_setup_of(s)->config = c;
	ec_config_begin(c);
	return c;
}

/* what the worker of the slave does when a state is requested */
static inline void plant_state(struct plant *p, u16 position, u8 state)
{
	ec_slave_request(p->s.bus.slaves[position], state);
	ec_apply(p->s.bus.slaves[position]);
}

#endif
