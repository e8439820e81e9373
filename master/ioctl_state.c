// SPDX-License-Identifier: GPL-2.0-only
/* Commands about the states of an application's slaves. */
#include "ioctl.h"
#include "master.h"
#include "session.h"
#include "why.h"

int ec_ioc_config_why(struct ec_file *f, void *arg)
{
	struct ec_master *m = f->master;
	struct ec_ioc_config_why *i = arg;
	int ret = 0;

	mutex_lock(&m->session_lock);
	if (!m->session || i->index >= m->session->n_configs)
		ret = ec_refuse(f, -ENOENT, "there is no slave configuration %u", i->index);
	else
		i->len = ec_config_why(m->session->configs[i->index], i->text, sizeof(i->text));
	mutex_unlock(&m->session_lock);
	return ret;
}

int ec_ioc_slaves_down(struct ec_file *f, void *arg)
{
	struct ec_master *m = f->master;
	int ret;

	mutex_lock(&m->session_lock);
	if (!m->session || m->session->owner != f)
		ret = ec_refuse(f, -EPERM, "reserve the master first (ecrt_request_master)");
	else
		ret = ec_session_slaves_down(m->session);
	mutex_unlock(&m->session_lock);
	return ret == -EINVAL ? ec_refuse(f, ret, "the master is not active") : ret;
}
