// SPDX-License-Identifier: GPL-2.0-only
/* Commands for what a slave gets again that returns: what the application has written itself. */
#include <linux/nospec.h>
#include "../config/config.h"
#include "../config/replay.h"
#include "../config/replay_run.h"
#include "ioctl.h"
#include "master.h"
#include "../session/session.h"
#include "../wire/soe.h"

#define WALK	64	/* list entries at once */

/* of an entry, for programs */
static const u8 kinds[] = {
	[EC_STARTUP_SDO] = EC_WRITE_KIND_SDO,
	[EC_STARTUP_IDN] = EC_WRITE_KIND_IDN,
	[EC_STARTUP_REG] = EC_WRITE_KIND_REG,
};

/* Most callers are tools: they do not wait for the lock of the sessions. */
static bool is_recorded(struct ec_call *call)
{
	struct ec_show *show = &call->master->base->show;
	const struct ec_session *s;
	bool ret;

	if (ec_show_begin(show))
		return true;
	s = ec_session_of(&call->master->sessions, call->file);
	ret = s && ec_replay_is_open(&s->wanted, call->slave);
	ec_show_end(show);
	return ret;
}

/**
 * ec_ioc_record() - note what the caller has written, if it is the application
 * @call: command for a slave, with the value in its buffer
 * @what: type, index, sub, complete
 *
 * Context: Process. May sleep.
 */
void ec_ioc_record(struct ec_call *call, const struct ec_startup *what)
{
	struct ec_sessions *ss = &call->master->sessions;
	struct ec_startup w = *what;
	struct ec_session *s;

	if (!is_recorded(call))
		return;
	w.size = call->size;
	ec_sessions_lock(ss);
	s = ec_session_of(ss, call->file);
	if (s)
		ec_replay_record(&s->wanted, call->slave, &w, call->data);
	ec_sessions_unlock(ss);
}

static int replay_object(struct ec_call *call, u8 type)
{
	const struct ec_ioc_sc_replay *i = call->arg;
	int ret = ec_replay_name(call->config, type, i->object, i->subindex);

	if (ret)
		return ec_refuse(call, ret,
				 "at most %u objects of a slave configuration can be named",
				 EC_MAX_SC_REPLAYS);
	return 0;
}

int ec_ioc_sc_replay(struct ec_call *call)
{
	const struct ec_ioc_sc_replay *i = call->arg;

	if (i->flags == EC_SC_REPLAY_SDO)
		return replay_object(call, EC_STARTUP_SDO);
	if (i->flags == EC_SC_REPLAY_IDN && i->subindex < EC_SOE_DRIVES)
		return replay_object(call, EC_STARTUP_IDN);
	if (i->flags)
		return ec_refuse(call, -EINVAL, "name one SDO, or one IDN of drive 0 to 7");
	if (i->mode >= EC_REPLAY_MODES)
		return ec_refuse(call, -EINVAL,
				 "replay is 0 (default), 1 (none) or 2 (all), not %u", i->mode);
	call->config->replay.mode = i->mode;
	return 0;
}

int ec_ioc_hold(struct ec_call *call)
{
	struct ec_wanted *w = &call->session->wanted;
	struct ec_ioc_hold *i = call->arg;
	struct ec_config *c;

	if (i->config >= w->n_configs)
		return ec_refuse(call, -ENOENT, "there are %u slave configurations, no %u",
				 w->n_configs, i->config);
	c = w->configs[array_index_nospec(i->config, w->n_configs)];
	if (!(i->flags & EC_HOLD_FLAG_RESUME)) {
		i->hold = ec_replay_held(c);
		return 0;
	}
	if (ec_replay_resume(c, i->hold))
		return ec_refuse(call, -ESTALE,
				 "slave %s is not held with number %u; see ecrt_slave_config_held()",
				 c->name, i->hold);
	return 0;
}

/* Return: 0 within the same show section; -ENOENT; or as ec_ioc_pause(). */
static int find_write(struct ec_call *call, u32 n, const struct ec_startup **found)
{
	const struct ec_startup *u;
	u32 k = 0;
	int ret;

	list_for_each_entry(u, &call->config->replay.writes, list) {
		if (k++ == n) {
			*found = u;
			return 0;
		}
		ret = k % WALK ? 0 : ec_ioc_pause(call);
		if (ret)
			return ret;
	}
	return ec_refuse(call, -ENOENT, "configuration %u has %u recorded writes",
			 call->config->index, call->config->replay.n);
}

int ec_ioc_config_write(struct ec_call *call)
{
	struct ec_ioc_config_write *i = call->arg;
	const struct ec_startup *u = NULL;
	int ret = find_write(call, i->write_pos, &u);

	if (ret)
		return ret;
	i->flags = u->complete ? EC_SDO_FLAG_COMPLETE : 0;
	i->object = u->index;
	i->subindex = u->sub;
	i->kind = kinds[u->type];
	i->why = ec_replay_why(call->config, u);
	i->total = call->config->replay.n;
	i->forgotten = call->config->replay.forgotten;
	i->size = u->write & EC_WRITE_DROPPED ? 0 : u->size;
	return ec_ioc_copy_out(call, u->data, i->size);
}
