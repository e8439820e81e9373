// SPDX-License-Identifier: GPL-2.0-only
/* What the functions for applications in the kernel share. */
#include <linux/slab.h>
#include "../../lib/ecrt/ecrt_int.h"
#include "api_values.h"

/*
 * Work that a cyclic call cannot do itself: it makes the bus access cyclic again after a cycle
 * timeout, and logs a call from a wrong context.
 */
static void work(struct work_struct *work)
{
	struct ec_api *api = container_of(work, struct ec_api, work);
	struct ec_master *m = api->file.master;

	mutex_lock(&m->cycles.lock);
	if (m->cycles.owner == &api->file && !m->cycles.active->thread &&
	    ec_links_attached(&m->links))
		ec_access_change(&m->links, EC_ACCESS_CYCLIC);
	mutex_unlock(&m->cycles.lock);
	if (READ_ONCE(api->atomic) && !api->warned) {
		api->warned = true;
		ec_err(m,
		       "kernel API: the device needs a thread for ecrt_master_send() and ecrt_master_receive(), not an interrupt or a raw spinlock; call them from a kthread\n");
	}
}

/**
 * ec_api_create() - let applications in the kernel request a master
 * @m: master
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_api_create(struct ec_master *m)
{
	struct ec_api *api = kzalloc(sizeof(*api), GFP_KERNEL);

	if (!api)
		return -ENOMEM;
	ec_file_init(&api->file, m, true);
	INIT_WORK(&api->work, work);
	init_waitqueue_head(&api->between_wq);
	m->api = api;
	return 0;
}

/**
 * ec_api_destroy() - no application in the kernel uses the master any more
 * @m: master whose session has ended
 *
 * Context: Process. May sleep.
 */
void ec_api_destroy(struct ec_master *m)
{
	if (!m->api)
		return;
	ec_api_between_stop(m);
	cancel_work_sync(&m->api->work);
	ec_app_requests_free(m);
	ec_loaded_free(m);
	kfree(m->api);
	m->api = NULL;
}

/**
 * ec_command() - execute a command
 * @m: master
 * @cmd: EC_IOC_*
 * @arg: its argument; addresses in it are the kernel's
 *
 * Context: Process. As the command.
 * Return: as the command; -EINTR a signal or kthread_stop().
 */
int ec_command(const struct ec_master *m, unsigned int cmd, void *arg)
{
	int ret = ec_ioc(&m->api->file, cmd, arg);

	return ret == -ERESTARTNOHAND || ret == -ERESTARTSYS ? -EINTR : ret;
}

/**
 * ec_complain() - one line in the log that says what failed and why
 * @m: master
 * @sc: slave configuration that the line names at its end, or NULL
 * @err: -errno, or 0: nothing failed
 * @with_reason: of a command: with its reason, and no line without master
 * @fmt: what was tried, after "cannot"
 *
 * Context: Process. May sleep.
 * Return: @err.
 */
int ec_complain(const struct ec_master *m, const ec_slave_config_t *sc, int err,
		bool with_reason, const char *fmt, ...)
{
	struct va_format vaf = { .fmt = fmt };
	char reason[EC_UAPI_REASON], slave[EC_CONFIG_NAME + 16] = "";
	struct ec_file *f;
	va_list args;

	if (!err || (with_reason && !m))
		return err;
	f = &m->api->file;
	/* the log may wait for a slow console: nothing is printed under the lock */
	raw_spin_lock(&f->lock);
	strscpy(reason, with_reason ? f->reason : "", sizeof(reason));
	raw_spin_unlock(&f->lock);
	if (sc)
		snprintf(slave, sizeof(slave), " of slave %s", ec_api_config(sc)->name);
	va_start(args, fmt);
	vaf.va = &args;
	ec_err(f->master, "kernel API: cannot %pV%s (%pe)%s%s\n", &vaf, slave, ERR_PTR(err),
	       reason[0] ? ": " : "", reason);
	va_end(args);
	return err;
}
