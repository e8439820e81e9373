// SPDX-License-Identifier: GPL-2.0-only
/* Commands about the states of an application's slaves. */
#include "ioctl.h"
#include "../master.h"
#include "../session/session.h"
#include "../config/why.h"

int ec_ioc_config_why(struct ec_file *f, void *arg)
{
	struct ec_ioc_config_why *i = arg;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	i->len = ec_config_why(c, i->text, sizeof(i->text));
	ec_show_end(f->master);
	return 0;
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
