// SPDX-License-Identifier: GPL-2.0-only
/* What the functions for applications in the kernel share. */
#include <linux/slab.h>
#include "api.h"

/**
 * ec_api_create() - a master can be requested by applications in the kernel
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
	INIT_LIST_HEAD(&api->requests);
	INIT_WORK(&api->work, ec_api_work);
	init_waitqueue_head(&api->between_wq);
	m->api = api;
	return 0;
}

/**
 * ec_api_destroy() - nobody in the kernel uses the master any more
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
	ec_api_requests_free(m);
	kfree(m->api);
	m->api = NULL;
}

/* A failure without text must not show the one before. */
void ec_api_begin(struct ec_master *m)
{
	struct ec_file *f = &m->api->file;

	raw_spin_lock(&f->lock);
	f->reason[0] = '\0';
	raw_spin_unlock(&f->lock);
}

/**
 * ec_command() - give a command
 * @m: master
 * @cmd: EC_IOC_*
 * @arg: its argument; addresses in it are the kernel's
 *
 * Context: Process. As the command.
 * Return: as the command.
 */
int ec_command(const struct ec_master *m, unsigned int cmd, void *arg)
{
	return ec_ioc(&m->api->file, cmd, arg);
}

/* The log may wait for a slow console: nothing is printed under the lock. */
static void complain(struct ec_master *m, int err, struct va_format *what, const char *slave)
{
	struct ec_file *f = &m->api->file;
	char reason[sizeof(f->reason)];

	raw_spin_lock(&f->lock);
	strscpy(reason, f->reason, sizeof(reason));
	raw_spin_unlock(&f->lock);
	ec_err(m, "kernel API: cannot %pV%s (%pe)%s%s\n", what, slave, ERR_PTR(err),
	       reason[0] ? ": " : "", reason);
}

/**
 * ec_api_fail() - one line in the log that says what failed and why
 * @m: master
 * @err: -errno
 * @fmt: what was tried, after "cannot"
 *
 * Context: Process. May sleep.
 * Return: @err.
 */
int ec_api_fail(struct ec_master *m, int err, const char *fmt, ...)
{
	struct va_format vaf = { .fmt = fmt };
	va_list args;

	va_start(args, fmt);
	vaf.va = &args;
	complain(m, err, &vaf, "");
	va_end(args);
	return err;
}

/* The same for a slave configuration; the line ends with its name. */
int ec_api_fail_sc(const ec_slave_config_t *sc, int err, const char *fmt, ...)
{
	struct va_format vaf = { .fmt = fmt };
	char slave[32];
	va_list args;

	snprintf(slave, sizeof(slave), " of slave %u:%u", ec_api_config(sc)->alias,
		 ec_api_config(sc)->position);
	va_start(args, fmt);
	vaf.va = &args;
	complain(ec_api_master(sc), err, &vaf, slave);
	va_end(args);
	return err;
}
