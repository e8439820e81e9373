// SPDX-License-Identifier: GPL-2.0-only
/* Commands of the application that has reserved the master. */
#include "api.h"
#include "../config/config.h"
#include "../config/unit.h"
#include "../config/domain.h"
#include "ioctl.h"
#include "master.h"
#include "../session/activate.h"
#include "../session/detached.h"
#include "../session/reserve.h"
#include "../session/session.h"
#include "../session/session_attach.h"
#include "../session/session_slave.h"
#include "../session/takeover.h"
#include "../bus/bus_list.h"
#include "../bus/ring_ends.h"
#include "../bus/slave.h"
#include "../config/why.h"

/**
 * ec_ioc_refuse_reserved() - refuse a command since an application has the master
 * @call: command
 *
 * Context: Process. May sleep.
 * Return: -EBUSY with the reason noted.
 */
int ec_ioc_refuse_reserved(struct ec_call *call)
{
	const struct ec_sessions *ss = &call->master->sessions;
	unsigned int index = call->master->base->index;
	const char *paused = READ_ONCE(ss->paused);
	char who[64];

	if (paused)
		return ec_refuse(call, -EBUSY, "master %u %s; try again", index, paused);
	if (READ_ONCE(call->master->api->reserved))
		return ec_refuse(call, -EBUSY,
				 "master %u is reserved by an application in the kernel; remove its module, 'lsmod' shows the users of ec_master",
				 index);
	if (ec_session_owner_text(&call->master->sessions, who, sizeof(who)))
		return ec_refuse(call, -EBUSY,
				 "master %u is reserved by %s; stop that application first", index,
				 who);
	if (ec_detached_runs(&call->master->sessions))
		return ec_refuse(call, -EBUSY,
				 "master %u runs without an application ('ethercat run'); end that with 'ethercat stop'",
				 index);
	if (READ_ONCE(ss->session))
		return ec_refuse(call, -EBUSY,
				 "master %u has a detached session; end it with 'ethercat release'",
				 index);
	return ec_refuse(call, -EBUSY,
			 "master %u was reserved by an application that has just ended; try again",
			 index);
}

int ec_ioc_reserve(struct ec_call *call)
{
	int ret = ec_session_begin(&call->master->sessions, call->file, &call->file->waiters);
	char name[EC_UAPI_STRING];

	switch (ret) {
	case -EBUSY:
		return ec_ioc_refuse_reserved(call);
	case -ENODEV:
		return ec_refuse(call, ret,
				 "master %u is waiting for its device %s; load the driver or correct main_devices=",
				 call->master->base->index,
				 ec_links_name(&call->master->links, 0, name, sizeof(name)));
	default:
		return ret;
	}
}

/* Has this file reserved the master? No lock is kept: the rest of the command takes its own. */
static int check_reserved(struct ec_call *call)
{
	int ret = ec_ioc_lock_session(call);

	if (!ret)
		ec_sessions_unlock(&call->master->sessions);
	return ret;
}

int ec_ioc_release(struct ec_call *call)
{
	int ret = check_reserved(call);

	if (ret)
		return ret;
	ec_session_end(&call->master->sessions, call->file);
	return 0;
}

int ec_ioc_create_domain(struct ec_call *call)
{
	struct ec_ioc_create_domain *i = call->arg;
	struct ec_domain *d = ec_domain_create(&call->session->wanted);

	if (IS_ERR(d))
		return ec_refuse(call, PTR_ERR(d), "at most %u domains", EC_MAX_DOMAINS);
	i->index = d->index;
	return 0;
}

static int config_failed(struct ec_call *call, const struct ec_ioc_slave_config *i,
			 const struct ec_session *s, int ret)
{
	ec_for_each_config(c, &s->wanted)
		if (ret == -ENOENT && c->alias == i->alias && c->position == i->position)
			return ec_refuse(call, ret,
					 "slave %u:%u is configured as 0x%08x/0x%08x already, not as 0x%08x/0x%08x",
					 i->alias, i->position, c->vendor, c->product,
					 i->vendor_id, i->product_code);
	if (ret == -ENOSPC)
		return ec_refuse(call, ret, "limit of %u slave configurations reached",
				 EC_MAX_CONFIGS);
	return ec_refuse(call, ret, "slave %u:%u cannot be configured (%pe)", i->alias, i->position,
			 ERR_PTR(ret));
}

static int ioctl_app_slave_config(struct ec_call *call, struct ec_ioc_slave_config *i)
{
	struct ec_session *s = call->session;
	struct ec_config *c;

	c = s->wanted.active ?
	    ec_config_find(&s->wanted, i->alias, i->position, i->vendor_id, i->product_code) :
	    ec_session_configure(s, i->alias, i->position, i->vendor_id, i->product_code);
	if (!c)
		return ec_refuse(call, -EBUSY,
				 "slave %u:%u has no configuration and the master is active; configure before ecrt_master_activate()",
				 i->alias, i->position);
	if (IS_ERR(c) && PTR_ERR(c) == -EDQUOT)
		return ec_ioc_limit(call, PTR_ERR(c));
	if (IS_ERR(c))
		return config_failed(call, i, s, PTR_ERR(c));
	i->index = c->index;
	return 0;
}

/**
 * ec_ioc_wait_pdos() - a configuration starts with the PDOs of its slave: wait until they are read
 * @call: command, with the lock of the sessions held, which is released meanwhile
 * @slave: slave with a reference, which is dropped; NULL: there is none to wait for
 *
 * Context: Process. May sleep.
 * Return: 0, the lock is held again; or as ec_ioc_lock_session().
 */
int ec_ioc_wait_pdos(struct ec_call *call, struct ec_slave *slave)
{
	lockdep_assert_held(&call->master->sessions.lock);
	if (!slave)
		return 0;
	ec_sessions_unlock(&call->master->sessions);
	ec_bus_wait_slave(slave);
	ec_slave_unref(slave);
	return ec_ioc_lock_session(call);
}

int ec_ioc_slave_config(struct ec_call *call)
{
	struct ec_master *m = call->master;
	struct ec_slave *slave = NULL;
	int ret = ec_ioc_lock_session(call);

	if (ret)
		return ret;
	/* a candidate session: the running session has the slaves */
	if (!call->session->wanted.active && call->session != m->sessions.candidate)
		slave = ec_session_find(call->session, call->arg);
	ret = ec_ioc_wait_pdos(call, slave);
	if (ret)
		return ret;
	ret = ioctl_app_slave_config(call, call->arg);
	ec_sessions_unlock(&m->sessions);
	return ret;
}

int ec_ioc_sc_sync(struct ec_call *call)
{
	struct ec_ioc_sc_sync *i = call->arg;
	int ret = ec_config_sync(call->config, i->sm, i->dir, i->watchdog);

	if (ret)
		ec_refuse(call, ret,
			  "SyncManager %u, direction %u, watchdog %u: use 0..15, 1..2, 0..2",
			  i->sm, i->dir, i->watchdog);
	return ret;
}

int ec_ioc_sc_watchdog(struct ec_call *call)
{
	struct ec_ioc_sc_watchdog *i = call->arg;

	return ec_ioc_limit(call, ec_config_reg(call->config, EC_REG_WD_DIVIDER, i->divider) ?:
				  ec_config_reg(call->config, EC_REG_WD_SM, i->intervals));
}

static void sc_pdo_failed(struct ec_call *call, const struct ec_ioc_sc_pdo *i, int ret)
{
	if (i->op > EC_SC_PDO_MAP_CLEAR)
		ec_refuse(call, ret, "PDO configuration: unknown operation %u", i->op);
	else if (i->op == EC_SC_PDO_MAP_ADD && ret == -ENOENT)
		ec_refuse(call, ret,
			  "cannot add entry 0x%04x:%02x to PDO 0x%04x: the PDO is not assigned; assign it first",
			  i->entry_index, i->subindex, i->pdo);
	else if (i->op == EC_SC_PDO_MAP_ADD)
		ec_refuse(call, ret,
			  "cannot add entry 0x%04x:%02x with %u bits to PDO 0x%04x (%pe)",
			  i->entry_index, i->subindex, i->bits, i->pdo, ERR_PTR(ret));
	else
		ec_refuse(call, ret,
			  "cannot change the PDOs of SM%u, PDO 0x%04x (%pe); use SM0 to SM%u",
			  i->sm, i->pdo, ERR_PTR(ret), EC_MAX_SM - 1);
}

int ec_ioc_sc_pdo(struct ec_call *call)
{
	struct ec_ioc_sc_pdo *i = call->arg;
	struct ec_pdo_entry e = { .index = i->entry_index, .sub = i->subindex, .bits = i->bits };
	struct ec_config *c = call->config;
	int ret = 0;

	switch (i->op) {
	case EC_SC_PDO_ASSIGN_ADD:
		ret = ec_config_assign_add(c, i->sm, i->pdo);
		break;
	case EC_SC_PDO_ASSIGN_CLEAR:
		ret = ec_config_assign_clear(c, i->sm);
		break;
	case EC_SC_PDO_MAP_ADD:
		ret = ec_config_map_add(c, i->pdo, &e);
		break;
	case EC_SC_PDO_MAP_CLEAR:
		ret = ec_config_map_clear(c, i->pdo);
		break;
	default:
		ret = -EINVAL;
	}
	if (ret == -EDQUOT)
		ret = ec_ioc_limit(call, ret);
	else if (ret)
		sc_pdo_failed(call, i, ret);
	return ret;
}

static const char *dir_name(u8 dir)
{
	return dir == EC_CFG_DIR_OUTPUT ? "outputs" : "inputs";
}

/* -EBUSY when process data were changed after they got their place in a domain. */
static int check_maps(struct ec_call *call, const struct ec_config *c)
{
	unsigned int i;

	for (i = 0; i < c->n_fmmus; i++) {
		const struct ec_config_fmmu *fm = &c->fmmus[i];

		if (ec_config_changed(c, fm))
			return ec_refuse(call, -EBUSY,
					 "slave %s: SM%u was registered in domain %u with %u bytes of %s; now it has %u of %s: set directions, PDOs and entries before the first of them is registered",
					 c->name, fm->sm, fm->domain->index,
					 fm->size, dir_name(fm->dir),
					 ec_pdo_list_bytes(&c->sm[fm->sm].pdos),
					 dir_name(c->sm[fm->sm].dir));
	}
	return 0;
}

/* Without a slave the PDOs have to be named; the reason includes why none is attached. */
static void not_mapped(struct ec_call *call, const struct ec_config *c,
		       const struct ec_ioc_reg_entry *i)
{
	char entry[32], why[96];
	struct ec_cause cause;

	if (i->flags & EC_REG_ENTRY_BY_POS)
		scnprintf(entry, sizeof(entry), "entry %u of PDO %u of SM%u", i->entry_pos,
			  i->pdo_pos, i->sm);
	else
		scnprintf(entry, sizeof(entry), "entry 0x%04x:%02x", i->entry_index, i->subindex);
	if (c->slave) {
		ec_refuse(call, -ENOENT,
			  "%s is not mapped in slave %s; see 'ethercat pdos', or name the PDOs with ecrt_slave_config_pdos()",
			  entry, c->name);
		return;
	}
	down_read(&call->master->bus.topo);
	ec_config_why(c, why, sizeof(why), &cause);
	up_read(&call->master->bus.topo);
	ec_refuse(call, -ENOENT,
		  "%s is not known, no slave is attached to %s (%s); name its PDOs with ecrt_slave_config_pdos()",
		  entry, c->name, why);
}

int ec_ioc_reg_entry(struct ec_call *call)
{
	struct ec_ioc_reg_entry *i = call->arg;
	u32 *bit = i->flags & EC_REG_ENTRY_ALIGNED ? NULL : &i->bit;
	struct ec_session *s = call->session;
	struct ec_config *c = call->config;
	int ret;

	i->bit = 0;
	if (i->domain >= s->wanted.n_domains)
		return ec_refuse(call, -ENOENT, "there is no domain %u", i->domain);
	if (i->flags & EC_REG_ENTRY_BY_POS)
		ret = ec_config_reg_entry_pos(c, i->sm, i->pdo_pos, i->entry_pos,
					      s->wanted.domains[i->domain], &i->offset, bit);
	else
		ret = ec_config_reg_entry(c, i->entry_index, i->subindex,
					  s->wanted.domains[i->domain], &i->offset, bit);
	if (ret == -ENOENT)
		not_mapped(call, c, i);
	else if (ret == -EBUSY)
		check_maps(call, c);
	else if (ret == -EFAULT)
		ec_refuse(call, ret,
			  "the entry is not byte-aligned in slave %s; pass bit_position",
			  c->name);
	else if (ret == -EOVERFLOW)
		ec_refuse(call, ret,
			  "slave %s: its configuration has %u of at most %u FMMUs, domain %u %u bytes; limits: %u bytes in the SyncManager, %u in all domains",
			  c->name, c->n_fmmus, EC_MAX_FMMU, i->domain,
			  s->wanted.domains[i->domain]->size, EC_MAX_SM_BYTES, EC_MAX_IMAGE);
	else if (ret == -EINVAL)
		ec_refuse(call, ret,
			  "slave %s: a SyncManager above %u or without direction; set it with ecrt_slave_config_sync_manager()",
			  c->name, EC_MAX_SM - 1);
	return ret;
}

int ec_ioc_sc_dc(struct ec_call *call)
{
	struct ec_ioc_sc_dc *i = call->arg;
	struct ec_config *c = call->config;

	c->sync.assign = i->assign_activate;
	c->sync.period[0] = i->cycle0;
	c->sync.period[1] = i->cycle1;
	c->sync.shift[0] = i->shift0;
	c->sync.shift[1] = i->shift1;
	return 0;
}

/* Flags as applications of the IgH EtherCAT Master set them: kept and shown, few have an effect. */
int ec_ioc_sc_flag(struct ec_call *call)
{
	struct ec_ioc_sc_flag *i = call->arg;
	int ret;

	i->key[sizeof(i->key) - 1] = '\0';
	if (!i->key[0])
		return ec_refuse(call, -EINVAL, "the name of the flag is empty");
	ret = ec_config_flag_set(call->config, i->key, i->value);
	if (ret == -ENOSPC)
		ec_refuse(call, ret, "a slave configuration has at most %u flags", EC_MAX_SC_FLAGS);
	return ec_ioc_limit(call, ret);
}

static int reply_timeout(struct ec_call *call, u32 ms)
{
	struct ec_config *c = call->config;

	if (ms > EC_MAX_SDO_MS)
		return ec_refuse(call, -EINVAL, "a reply timeout is at most %u ms, not %u",
				 EC_MAX_SDO_MS, ms);
	c->reply_ms = ms;
	if (ec_session_owns(c))
		WRITE_ONCE(c->slave->mbox.reply_ms, ms);
	return 0;
}

int ec_ioc_sc_timeout(struct ec_call *call)
{
	struct ec_ioc_sc_timeout *i = call->arg;

	if (i->flags & EC_SC_TIMEOUT_REPLY)
		return reply_timeout(call, i->timeout_ms);
	if (!ec_al_state_valid(i->from) || !ec_al_state_valid(i->to) || i->from == EC_AL_BOOT ||
	    i->to == EC_AL_BOOT)
		return ec_refuse(call, -EINVAL, "AL states are 1, 2, 4, 8, not %u and %u", i->from,
				 i->to);
	call->config->timeout_ms[i->from][i->to] = i->timeout_ms;
	return 0;
}

static int activate_failed(struct ec_call *call, const struct ec_session *s, int ret)
{
	u32 bytes = 0;

	ec_for_each_domain(d, &s->wanted)
		bytes += d->size;
	switch (ret) {
	case -EBUSY:
		return ec_refuse(call, ret, "the master is active already");
	case -EOVERFLOW:
		return ec_refuse(call, ret,
				 "%u bytes of process data in %u domains do not fit: at most %u bytes, %u datagrams and %u frames a cycle; register fewer SyncManagers, or let inputs overlap outputs",
				 bytes, s->wanted.n_domains, EC_MAX_IMAGE, EC_MAX_CYCLE_DGRAMS,
				 EC_MAX_CYCLE_FRAMES);
	case -ENOSPC:
		return ec_refuse(call, ret,
				 "the cycle leaves no wire time for acyclic frames, which need %u ns (the kernel log has the figures), and the limit of delayed cycles is 0; choose a longer cycle, overlap inputs and outputs, or see ecrt_master_set_late_cycles()",
				 ec_layout_need_ns());
	case -EDQUOT:
		return ec_ioc_limit(call, ret);
	case -ENOMEM:
		return ec_refuse(call, ret, "no memory for %u bytes of process data", bytes);
	case -EOPNOTSUPP:
		return ec_refuse(call, ret,
				 "a domain has a division, but the application runs the cycle; call ecrt_master_set_cycle(), or queue the domain in some cycles only");
	case -ENODEV:
		return ec_refuse(call, ret,
				 "CPU %d is not online; choose another one for the cycle",
				 s->cycle.setup.kernel.cpu);
	default:
		return ec_refuse(call, ret, "activation failed (%pe)", ERR_PTR(ret));
	}
}

/* An application takes over a detached session. */
static int take_over(struct ec_call *call)
{
	char why[96];
	const struct ec_session *candidate = call->master->sessions.candidate;
	/* handles of an application in the kernel are pointers to its own configurations */
	int ret = ec_session_take_over(&call->master->sessions, why, sizeof(why),
				       call->file == &call->master->api->file);

	if (ret == -EEXIST)
		return ec_refuse(call, ret,
				 "the detached session of master %u has another configuration: %s; configure the same, or end it with 'ethercat release' or ecrt_master_end_detached()",
				 call->master->base->index, why);
	if (ret == -ENOSPC)
		return activate_failed(call, candidate, ret);
	if (ret)
		return ec_refuse(call, ret,
				 "the cycle of the detached session does not answer; end it with 'ethercat release'");
	return 0;
}

/* The order of the slaves would change with each break. */
static int check_ring(struct ec_call *call)
{
	struct ec_bus *bus = &call->master->bus;
	const struct ec_slave *s, *branch;
	unsigned int port;
	int ret = 0;

	down_read(&bus->topo);
	s = ec_ring_ends_turned(bus);
	branch = s ? ec_ring_ends_branch(bus, &port) : NULL;
	if (branch)
		ret = ec_refuse(call, -EINVAL,
				"frames of the main device do not pass slave %u (%.24s) of the ring because of a branch at slave %u, port %u or a later one: connect branches there before the ring (order of ports: 3, 1, 2), and none with both ends",
				s->position, ec_slave_label(s), branch->position, port);
	else if (s)
		ret = ec_refuse(call, -EINVAL,
				"slave %u (%.24s) is connected the wrong way round in the ring, so the positions of slaves change when it opens: exchange the cables of this slave, so that its port 0 leads towards the main device",
				s->position, ec_slave_label(s));
	up_read(&bus->topo);
	return ret;
}

static int activate(struct ec_call *call, struct ec_session *s, const void *preset, u32 size)
{
	char why[EC_UAPI_REASON];
	unsigned int i;
	int ret;

	for (i = 0; !s->wanted.active && i < s->wanted.n_configs; i++) {
		ret = check_maps(call, s->wanted.configs[i]);
		if (ret)
			return ret;
	}
	if (size && !s->wanted.active && size != ec_session_place(s))
		return ec_refuse(call, -EINVAL,
				 "initial image has %u bytes, domains need %u; register all entries first",
				 size, ec_session_place(s));
	ret = ec_units_check(&s->wanted, s->cycle.setup.kernel.period_ns, why, sizeof(why));
	if (ret)
		return ec_refuse(call, ret, "%s", why);
	ret = check_ring(call);
	if (ret)
		return ret;
	s->preset = preset;
	ret = ec_session_activate(s);
	s->preset = NULL;
	return ret ? activate_failed(call, s, ret) : 0;
}

static void tell_sizes(const struct ec_session *s, struct ec_ioc_activate *i)
{
	i->image_size = s->cycle.shared->image_size;
	i->status_size = EC_STATUS_BYTES;
	i->request_size = s->cycle.shared->request_size;
	i->exchange_size = s->cycle.shared->exchange_size;
}

int ec_ioc_activate(struct ec_call *call)
{
	struct ec_ioc_activate *i = call->arg;
	struct ec_session *s = call->session;
	int ret;

	i->taken_over = s == call->master->sessions.candidate;
	ret = i->taken_over ? take_over(call) : activate(call, s, call->data, call->size);
	if (!ret)
		tell_sizes(call->master->sessions.session, i);
	return ret;
}

int ec_ioc_deactivate(struct ec_call *call)
{
	return check_reserved(call) ?: ec_session_stop(&call->master->sessions, call->file);
}

int ec_ioc_domain_offset(struct ec_call *call)
{
	struct ec_ioc_domain_offset *i = call->arg;
	struct ec_session *s = call->session;

	if (i->domain >= s->wanted.n_domains)
		return ec_refuse(call, -ENOENT, "there is no domain %u", i->domain);
	if (!s->wanted.active)
		ec_session_place(s);
	i->offset = s->wanted.domains[i->domain]->offset;
	i->size = s->wanted.domains[i->domain]->size;
	return 0;
}

int ec_ioc_ref_clock(struct ec_call *call)
{
	struct ec_ioc_ref_clock *i = call->arg;
	struct ec_session *s = call->session;

	if (i->config != EC_UAPI_NONE32 && i->config >= s->wanted.n_configs)
		return ec_refuse(call, -ENOENT, "there is no slave configuration %u", i->config);
	s->ref_config = i->config;
	return 0;
}

int ec_ioc_interval(struct ec_call *call)
{
	struct ec_ioc_interval *i = call->arg;

	if (!i->interval_us)
		return ec_refuse(call, -EINVAL, "send interval must be 1 us or more");
	ec_session_interval(&call->master->sessions, i->interval_us);
	return 0;
}
