// SPDX-License-Identifier: GPL-2.0-only
/* Request, activate and release a master; for applications in the kernel. */
#include <linux/delay.h>
#include "api_values.h"
#include "cdev.h"
#include "../../lib/ecrt/ecrt_int.h"
#include "../session/reserve.h"
#include "../session/session_attach.h"

ec_master_t *ecrt_request_master(unsigned int master_index)
{
	struct ec_master *m;
	int ret;

	if (master_index >= ec_cdev_count()) {
		pr_err_ratelimited("EtherCAT: kernel API: no master %u; main_devices= names %u\n",
				   master_index, ec_cdev_count());
		return NULL;
	}
	m = ec_cdev_master(master_index);
	/* a caller that got the symbols by symbol_get() does not keep the module loaded */
	__module_get(THIS_MODULE);
	ret = ec_do(m, EC_IOC_RESERVE, NULL, "reserve the master");
	if (ret) {
		module_put(THIS_MODULE);
		return NULL;
	}
	m->api->reserved = true;
	m->api->send_cb = NULL;
	m->api->receive_cb = NULL;
	return m;
}
EXPORT_SYMBOL_GPL(ecrt_request_master);

/* The session is not active any more: cyclic calls do not find it, and their state is cleared. */
static void forget(struct ec_master *m)
{
	struct ec_api *api = m->api;

	ec_api_between_stop(m);
	WRITE_ONCE(api->active, NULL);
	/* wait for a call that has found the session */
	while (atomic_cmpxchg(&api->busy, 0, 1))
		usleep_range(50, 100);
	memset(&api->cycle, 0, sizeof(api->cycle));
	kvfree(api->image);
	api->image = NULL;
	atomic_set_release(&api->busy, 0);
}

void ecrt_release_master(ec_master_t *master)
{
	if (!master)
		return;
	if (!master->api->reserved) {
		ec_warn(master,
			"kernel API: ecrt_release_master() without ecrt_request_master()\n");
		return;
	}
	forget(master);
	ec_session_end(&master->sessions, &master->api->file);
	ec_app_requests_free(master);
	ec_loaded_free(master);
	master->api->reserved = false;
	module_put(THIS_MODULE);
}
EXPORT_SYMBOL_GPL(ecrt_release_master);

/* The session of the application; it may be the candidate for a detached one. */
static struct ec_session *session_of(struct ec_master *m)
{
	struct ec_session *s;

	mutex_lock(&m->sessions.lock);
	s = ec_session_of(&m->sessions, &m->api->file);
	mutex_unlock(&m->sessions.lock);
	return s;
}

ec_domain_t *ecrt_master_create_domain(ec_master_t *master)
{
	struct ec_ioc_create_domain i = { 0 };

	if (ec_do(master, EC_IOC_CREATE_DOMAIN, &i, "create a domain"))
		return NULL;
	return session_of(master)->wanted.domains[i.index];
}
EXPORT_SYMBOL_GPL(ecrt_master_create_domain);

ec_slave_config_t *ecrt_master_slave_config(ec_master_t *master, uint16_t alias,
					    uint16_t position, uint32_t vendor_id,
					    uint32_t product_code)
{
	struct ec_ioc_slave_config i = {
		.alias = alias, .position = position, .vendor_id = vendor_id,
		.product_code = product_code,
	};

	if (ec_do(master, EC_IOC_SLAVE_CONFIG, &i, "configure slave %u:%u as 0x%08x/0x%08x", alias,
		  position, vendor_id, product_code))
		return NULL;
	return (ec_slave_config_t *)session_of(master)->wanted.configs[i.index];
}
EXPORT_SYMBOL_GPL(ecrt_master_slave_config);

ec_slave_config_t *ecrt_master_group_config(ec_master_t *master, unsigned int group,
					    uint16_t member, uint32_t vendor_id,
					    uint32_t product_code)
{
	struct ec_ioc_group_config i = {
		.group = group, .member = member, .vendor_id = vendor_id,
		.product_code = product_code,
	};

	if (ec_do(master, EC_IOC_GROUP_CONFIG, &i,
		  "configure member %u of group %u as 0x%08x/0x%08x", member, group, vendor_id,
		  product_code))
		return NULL;
	return (ec_slave_config_t *)session_of(master)->wanted.configs[i.index];
}
EXPORT_SYMBOL_GPL(ecrt_master_group_config);

/*
 * Memory for process data of the domains while the kernel runs the cycle. It belongs to the
 * application, as each cycle exchanges images. External memory of domains has the first outputs.
 */
static int make_image(struct ec_master *m, struct ec_ioc_activate *i)
{
	struct ec_api *api = m->api;
	struct ec_session *s;
	struct ec_domain *d;
	u32 size = 0;

	ec_sessions_lock(&m->sessions);
	s = ec_session_of(&m->sessions, &api->file);
	api->wanted = s ? &s->wanted : NULL;
	if (s && s->cycle.setup.kernel.period_ns)
		size = ec_session_place(s);
	ec_sessions_unlock(&m->sessions);
	/* activation refuses an image that is too large, with the reason */
	if (!size || size > EC_MAX_IMAGE)
		return 0;
	api->image = ec_zalloc(size);
	if (!api->image)
		return ec_fail(m, -ENOMEM, "allocate %u bytes of process data", size);
	ec_for_each_app_domain(m, d)
		if (d->memory)
			memcpy(api->image + d->offset, d->memory, d->size);
	i->preset = (uintptr_t)api->image;
	i->preset_size = size;
	return 0;
}

/* Where the application finds its process data. */
static int place_domains(struct ec_master *m, const struct ec_session *s)
{
	struct ec_app_cycle *a = &m->api->cycle;
	const struct ec_shared *sh = s->cycle.shared;
	struct ec_domain *d;
	int ret = 0;

	if (sh->exchange)
		ret = ec_exchange_begin(a, sh->exchange, sh->exchange_size, sh->status);
	ec_for_each_app_domain(m, d) {
		if (!d->memory)
			d->data = a->exchange ? m->api->image + d->offset :
						ec_session_domain_data(d);
		if (!ret && a->exchange)
			ret = ec_exchange_add(d);
	}
	return ret;
}

int ecrt_master_activate(ec_master_t *master)
{
	struct ec_ioc_activate i = { 0 };
	int ret;

	if (!master)
		return -EINVAL;
	if (READ_ONCE(master->api->active)) {
		ec_warn(master, "kernel API: the master is active already\n");
		return 0;
	}
	ret = make_image(master, &i) ?:
	      ec_do(master, EC_IOC_ACTIVATE, &i, "activate the master");
	if (ret) {
		kvfree(master->api->image);
		master->api->image = NULL;
		return ret;
	}
	ec_app_requests_place(master);
	master->api->atomic = false;
	master->api->warned = false;
	ret = place_domains(master, master->sessions.session);
	/* a cyclic call that sees the session finds it complete */
	smp_store_release(&master->api->active, master->sessions.session);
	ret = ret ?: ec_api_between_start(master);
	if (ret) {
		/* a cycle that another application has started continues */
		if (i.taken_over)
			forget(master);
		else
			ecrt_master_deactivate(master);
		return ec_fail(master, ret,
			       "exchange process data, or start the thread for callbacks");
	}
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_activate);

int ecrt_master_deactivate(ec_master_t *master)
{
	int ret;

	if (!master)
		return -EINVAL;
	if (!READ_ONCE(master->api->active)) {
		ec_warn(master, "kernel API: the master is not active\n");
		return -EINVAL;
	}
	forget(master);
	ret = ec_command(master, EC_IOC_DEACTIVATE, NULL);
	ec_app_requests_free(master);
	ec_loaded_free(master);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_deactivate);

int ecrt_master_reset(ec_master_t *master)
{
	if (!master)
		return -EINVAL;
	ec_session_try_again(&master->sessions);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_reset);
