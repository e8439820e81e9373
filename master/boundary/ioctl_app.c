// SPDX-License-Identifier: GPL-2.0-only
/* Commands of the application that has reserved the master. */
#include <linux/slab.h>
#include <linux/uaccess.h>
#include "api.h"
#include "../config/config.h"
#include "../cycle/domain.h"
#include "ioctl.h"
#include "../master.h"
#include "../session/request.h"
#include "../session/session.h"
#include "../bus/slave.h"
#include "../config/why.h"

int ec_ioc_reserve(struct ec_file *f, void *arg)
{
	int ret = ec_session_begin(f->master, f, &f->waiters);
	char who[64];

	switch (ret) {
	case -EBUSY:
		if (READ_ONCE(f->master->api->reserved))
			return ec_refuse(f, ret, "master %u is reserved by an application in the kernel; remove its module, 'lsmod' shows the users of ec_master",
					 f->master->base->index);
		if (!ec_session_owner_text(f->master, who, sizeof(who)))
			return ec_refuse(f, ret, "master %u was reserved by an application that has just ended; try again",
					 f->master->base->index);
		return ec_refuse(f, ret, "master %u is reserved by %s; stop that application first",
				 f->master->base->index, who);
	case -ENODEV:
		return ec_refuse(f, ret, "master %u is waiting for its device %s; load the driver or correct main_devices=",
				 f->master->base->index, f->master->links.spec[0]);
	default:
		return ret;
	}
}

/* Locks the session of this file. */
static struct ec_session *lock(struct ec_file *f, int *ret)
{
	struct ec_master *m = f->master;
	struct ec_session *s;

	ec_session_lock(m);
	s = ec_session_of(m, f);
	if (s)
		return s;
	ec_session_unlock(m);
	*ret = ec_refuse(f, -EPERM, "reserve the master first (ecrt_request_master)");
	return NULL;
}

/**
 * ec_ioc_lock_idle() - lock the session, for changes before activation
 * @f: open file
 * @ret: why it is not possible
 *
 * Context: Process. May sleep. session_lock is held when one is returned.
 * Return: session of this file that is not active, or NULL.
 */
struct ec_session *ec_ioc_lock_idle(struct ec_file *f, int *ret)
{
	struct ec_session *s = lock(f, ret);

	if (s && s->active) {
		ec_session_unlock(f->master);
		*ret = ec_refuse(f, -EBUSY, "the master is active; configure before ecrt_master_activate()");
		return NULL;
	}
	return s;
}

static int done(struct ec_file *f, int ret)
{
	ec_session_unlock(f->master);
	return ret;
}

/**
 * ec_ioc_lock_config() - lock the session and find a configuration in it
 * @f: open file
 * @index: of the configuration
 * @ret: why there is none
 *
 * Context: Process. May sleep. session_lock is held when one is returned.
 * Return: configuration, of a session that is not active; or NULL.
 */
struct ec_config *ec_ioc_lock_config(struct ec_file *f, u32 index, int *ret)
{
	struct ec_session *s = ec_ioc_lock_idle(f, ret);

	if (!s)
		return NULL;
	if (index < s->n_configs)
		return s->configs[index];
	*ret = done(f, ec_refuse(f, -ENOENT, "there is no slave configuration %u", index));
	return NULL;
}

int ec_ioc_release(struct ec_file *f, void *arg)
{
	int ret = 0;

	if (!lock(f, &ret))
		return ret;
	ec_session_unlock(f->master);
	ec_session_end(f->master, f);
	return 0;
}

int ec_ioc_create_domain(struct ec_file *f, void *arg)
{
	struct ec_ioc_create_domain *i = arg;
	struct ec_domain *d;
	int ret = 0;
	struct ec_session *s = ec_ioc_lock_idle(f, &ret);

	if (!s)
		return ret;
	d = ec_domain_create(s);
	if (IS_ERR(d))
		return done(f, ec_refuse(f, PTR_ERR(d), "at most %u domains", EC_MAX_DOMAINS));
	i->index = d->index;
	return done(f, 0);
}

/* A configuration begins with the PDOs of its slave: they may be being read yet. */
static void wait_pdos(struct ec_file *f, const struct ec_ioc_slave_config *i)
{
	struct ec_slave *slave;

	slave = ec_session_find(f->master, i->alias, i->position, i->vendor_id, i->product_code);
	if (!slave)
		return;
	ec_master_wait_slave(slave);
	ec_slave_unref(slave);
}

static int config_failed(struct ec_file *f, const struct ec_ioc_slave_config *i,
			 const struct ec_session *s, int ret)
{
	unsigned int k;

	for (k = 0; ret == -ENOENT && k < s->n_configs; k++) {
		const struct ec_config *c = s->configs[k];

		if (c->alias == i->alias && c->position == i->position)
			return ec_refuse(f, ret, "slave %u:%u is configured as 0x%08x/0x%08x already, not as 0x%08x/0x%08x",
					 i->alias, i->position, c->vendor, c->product,
					 i->vendor_id, i->product_code);
	}
	if (ret == -ENOSPC)
		return ec_refuse(f, ret, "limit of %u slave configurations reached", EC_MAX_CONFIGS);
	return ec_refuse(f, ret, "slave %u:%u cannot be configured (%pe)", i->alias, i->position,
			 ERR_PTR(ret));
}

int ec_ioc_slave_config(struct ec_file *f, void *arg)
{
	struct ec_ioc_slave_config *i = arg;
	struct ec_config *c;
	struct ec_session *s;
	bool wait;
	int ret = 0;

	s = lock(f, &ret);
	if (!s)
		return ret;
	/* the running session of an heir has its slaves */
	wait = !s->active && s != f->master->heir;
	done(f, 0);
	if (wait)
		wait_pdos(f, i);
	s = lock(f, &ret);
	if (!s)
		return ret;
	c = s->active ?
	    ec_config_find(s, i->alias, i->position, i->vendor_id, i->product_code) :
	    ec_config_create(s, i->alias, i->position, i->vendor_id, i->product_code);
	if (!c)
		return done(f, ec_refuse(f, -EBUSY, "slave %u:%u has no configuration and the master is active; configure before ecrt_master_activate()",
					 i->alias, i->position));
	if (IS_ERR(c) && PTR_ERR(c) == -EDQUOT)
		return done(f, ec_ioc_limit(f, PTR_ERR(c)));
	if (IS_ERR(c))
		return done(f, config_failed(f, i, s, PTR_ERR(c)));
	i->index = c->index;
	return done(f, 0);
}

int ec_ioc_sc_sync(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_sync *i = arg;
	int ret = 0;
	struct ec_config *c = ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
	ret = ec_config_sync(c, i->sm, i->dir, i->watchdog);
	if (ret)
		ec_refuse(f, ret, "SyncManager %u, direction %u, watchdog %u: use 0..15, 1..2, 0..2",
			  i->sm, i->dir, i->watchdog);
	return done(f, ret);
}

int ec_ioc_sc_watchdog(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_watchdog *i = arg;
	int ret = 0;
	struct ec_config *c = ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
	c->wd_divider = i->divider;
	c->wd_intervals = i->intervals;
	return done(f, 0);
}

static void sc_pdo_failed(struct ec_file *f, const struct ec_ioc_sc_pdo *i, int ret)
{
	if (i->op > EC_SC_PDO_MAP_CLEAR)
		ec_refuse(f, ret, "PDO configuration: unknown operation %u", i->op);
	else if (i->op == EC_SC_PDO_MAP_ADD && ret == -ENOENT)
		ec_refuse(f, ret, "cannot add entry 0x%04x:%02x to PDO 0x%04x: the PDO is not assigned; assign it first",
			  i->entry_index, i->subindex, i->pdo);
	else if (i->op == EC_SC_PDO_MAP_ADD)
		ec_refuse(f, ret, "cannot add entry 0x%04x:%02x with %u bits to PDO 0x%04x (%pe)",
			  i->entry_index, i->subindex, i->bits, i->pdo, ERR_PTR(ret));
	else
		ec_refuse(f, ret, "cannot change the PDOs of SM%u, PDO 0x%04x (%pe); use SM0 to SM%u",
			  i->sm, i->pdo, ERR_PTR(ret), EC_MAX_SM - 1);
}

int ec_ioc_sc_pdo(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_pdo *i = arg;
	struct ec_pdo_entry e = { .index = i->entry_index, .sub = i->subindex, .bits = i->bits };
	int ret = 0;
	struct ec_config *c = ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
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
		ret = ec_ioc_limit(f, ret);
	else if (ret)
		sc_pdo_failed(f, i, ret);
	return done(f, ret);
}

static const char *dir_name(u8 dir)
{
	return dir == EC_CFG_DIR_OUTPUT ? "outputs" : "inputs";
}

/* -EBUSY when process data were changed after they got their place in a domain. */
static int check_maps(struct ec_file *f, const struct ec_config *c)
{
	unsigned int i;

	for (i = 0; i < c->n_fmmus; i++) {
		const struct ec_config_fmmu *fm = &c->fmmus[i];

		if (ec_config_changed(c, fm))
			return ec_refuse(f, -EBUSY, "slave %u:%u: SM%u was registered in domain %u with %u bytes of %s; now it has %u of %s: set directions, PDOs and entries before the first of them is registered",
					 c->alias, c->position, fm->sm, fm->domain->index,
					 fm->size, dir_name(fm->dir),
					 ec_pdo_list_bytes(&c->sm[fm->sm].pdos),
					 dir_name(c->sm[fm->sm].dir));
	}
	return 0;
}

/* What no slave describes has to be named; that there is none is worth telling why. */
static void not_mapped(struct ec_file *f, const struct ec_config *c,
		       const struct ec_ioc_reg_entry *i)
{
	char entry[32], why[96];

	if (i->flags & EC_REG_ENTRY_BY_POS)
		scnprintf(entry, sizeof(entry), "entry %u of PDO %u of SM%u", i->entry_pos,
			  i->pdo_pos, i->sm);
	else
		scnprintf(entry, sizeof(entry), "entry 0x%04x:%02x", i->entry_index, i->subindex);
	if (c->slave) {
		ec_refuse(f, -ENOENT, "%s is not mapped in slave %u:%u; see 'ethercat pdos', or name the PDOs with ecrt_slave_config_pdos()",
			  entry, c->alias, c->position);
		return;
	}
	down_read(&f->master->topo);
	ec_config_why(c, why, sizeof(why));
	up_read(&f->master->topo);
	ec_refuse(f, -ENOENT, "%s is not known, no slave is attached to %u:%u (%s); name its PDOs with ecrt_slave_config_pdos()",
		  entry, c->alias, c->position, why);
}

int ec_ioc_reg_entry(struct ec_file *f, void *arg)
{
	struct ec_ioc_reg_entry *i = arg;
	u32 *bit = i->flags & EC_REG_ENTRY_ALIGNED ? NULL : &i->bit;
	struct ec_session *s;
	int ret = 0;
	struct ec_config *c = ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
	s = c->session;
	i->bit = 0;
	if (i->domain >= s->n_domains)
		return done(f, ec_refuse(f, -ENOENT, "there is no domain %u", i->domain));
	if (i->flags & EC_REG_ENTRY_BY_POS)
		ret = ec_config_reg_entry_pos(c, i->sm, i->pdo_pos, i->entry_pos,
					      s->domains[i->domain], &i->offset, bit);
	else
		ret = ec_config_reg_entry(c, i->entry_index, i->subindex, s->domains[i->domain],
					  &i->offset, bit);
	if (ret == -ENOENT)
		not_mapped(f, c, i);
	else if (ret == -EBUSY)
		check_maps(f, c);
	else if (ret == -EFAULT)
		ec_refuse(f, ret, "the entry is not byte-aligned in slave %u:%u; pass bit_position",
			  c->alias, c->position);
	else if (ret == -EOVERFLOW)
		ec_refuse(f, ret, "slave %u:%u: its configuration has %u of at most %u FMMUs, domain %u %u bytes; limits: %u bytes in the SyncManager, %u in all domains",
			  c->alias, c->position, c->n_fmmus, EC_MAX_FMMU, i->domain,
			  s->domains[i->domain]->size, EC_MAX_SM_BYTES, EC_MAX_IMAGE);
	else if (ret == -EINVAL)
		ec_refuse(f, ret, "slave %u:%u: a SyncManager above %u or without direction; set it with ecrt_slave_config_sync_manager()",
			  c->alias, c->position, EC_MAX_SM - 1);
	return done(f, ret);
}

int ec_ioc_sc_dc(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_dc *i = arg;
	int ret = 0;
	struct ec_config *c = ec_ioc_lock_config(f, i->config, &ret);

	if (!c)
		return ret;
	c->dc_assign = i->assign_activate;
	c->dc_cycle[0] = i->cycle0;
	c->dc_cycle[1] = i->cycle1;
	c->dc_shift[0] = i->shift0;
	c->dc_shift[1] = i->shift1;
	return done(f, 0);
}

/* Flags of other masters' applications; they are kept and shown, few have a meaning here. */
int ec_ioc_sc_flag(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_flag *i = arg;
	int ret = 0;
	struct ec_config *c;

	i->key[sizeof(i->key) - 1] = '\0';
	if (!i->key[0])
		return ec_refuse(f, -EINVAL, "the name of the flag is empty");
	c = ec_ioc_lock_config(f, i->config, &ret);
	if (!c)
		return ret;
	ret = ec_config_flag_set(c, i->key, i->value);
	if (ret == -ENOSPC)
		ec_refuse(f, ret, "a slave configuration has at most %u flags", EC_MAX_SC_FLAGS);
	return done(f, ec_ioc_limit(f, ret));
}

int ec_ioc_sc_timeout(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_timeout *i = arg;
	int ret = 0;
	struct ec_config *c;

	if (!ec_al_state_valid(i->from) || !ec_al_state_valid(i->to) || i->from == EC_AL_BOOT ||
	    i->to == EC_AL_BOOT)
		return ec_refuse(f, -EINVAL, "AL states are 1, 2, 4, 8, not %u and %u", i->from,
				 i->to);
	c = ec_ioc_lock_config(f, i->config, &ret);
	if (!c)
		return ret;
	c->timeout_ms[i->from][i->to] = i->timeout_ms;
	return done(f, 0);
}

static int activate_failed(struct ec_file *f, const struct ec_session *s, int ret)
{
	u32 bytes = 0;
	unsigned int i;

	for (i = 0; i < s->n_domains; i++)
		bytes += s->domains[i]->size;
	switch (ret) {
	case -EBUSY:
		return ec_refuse(f, ret, "the master is active already");
	case -EOVERFLOW:
		return ec_refuse(f, ret, "%u bytes of process data in %u domains do not fit: at most %u bytes, %u datagrams and %u frames a cycle; register fewer SyncManagers, or let inputs overlap outputs",
				 bytes, s->n_domains, EC_MAX_IMAGE, EC_MAX_CYCLE_DGRAMS,
				 EC_MAX_CYCLE_FRAMES);
	case -ENOSPC:
		return ec_refuse(f, ret, "the cycle leaves no wire time for acyclic frames, which need %u ns (the kernel log has the figures), and the limit of delayed cycles is 0; choose a longer cycle, overlap inputs and outputs, or see ecrt_master_set_late_cycles()",
				 ec_cycle_need_ns());
	case -EDQUOT:
		return ec_ioc_limit(f, ret);
	case -ENOMEM:
		return ec_refuse(f, ret, "no memory for %u bytes of process data", bytes);
	case -EOPNOTSUPP:
		return ec_refuse(f, ret, "a domain has a division, but the application runs the cycle; call ecrt_master_set_cycle(), or queue the domain in some cycles only");
	case -ENODEV:
		return ec_refuse(f, ret, "CPU %d is not online; choose another one for the cycle",
				 s->kernel.cpu);
	default:
		return ec_refuse(f, ret, "activation failed (%pe)", ERR_PTR(ret));
	}
}

/* The application of a detached session has come back, or another one. */
static int take_over(struct ec_file *f)
{
	char why[96];
	const struct ec_session *heir = f->master->heir;
	int ret = ec_session_take_over(f->master, why, sizeof(why));

	if (ret == -EEXIST)
		return ec_refuse(f, ret, "the detached session of master %u has another configuration: %s; configure the same, or end it with 'ethercat release' or ecrt_master_end_detached()",
				 f->master->base->index, why);
	if (ret == -ENOSPC)
		return activate_failed(f, heir, ret);
	if (ret)
		return ec_refuse(f, ret, "the cycle of the detached session does not answer; end it with 'ethercat release'");
	return 0;
}

static int activate(struct ec_file *f, struct ec_session *s, const void *preset, u32 size)
{
	unsigned int i;
	int ret;

	for (i = 0; !s->active && i < s->n_configs; i++) {
		ret = check_maps(f, s->configs[i]);
		if (ret)
			return ret;
	}
	if (size && !s->active && size != ec_session_place(s))
		return ec_refuse(f, -EINVAL, "initial image has %u bytes, domains need %u; register all entries first",
				 size, ec_session_place(s));
	s->preset = preset;
	ret = ec_session_activate(s);
	s->preset = NULL;
	return ret ? activate_failed(f, s, ret) : 0;
}

static void tell_sizes(const struct ec_session *s, struct ec_ioc_activate *i)
{
	i->image_size = s->shared->image_size;
	i->status_size = EC_STATUS_BYTES;
	i->request_size = s->shared->request_size;
	i->exchange_size = s->shared->exchange_size;
}

int ec_ioc_activate(struct ec_file *f, void *arg)
{
	struct ec_ioc_activate *i = arg;
	struct ec_session *s;
	u8 *preset = NULL;
	int ret = 0;

	if (i->preset_size && i->preset_size <= EC_MAX_IMAGE) {
		ret = ec_ioc_fetch(i->preset, i->preset_size, &preset);
		if (ret)
			return ret;
	}
	s = lock(f, &ret);
	if (s) {
		i->taken_over = s == f->master->heir;
		ret = i->taken_over ? take_over(f) : activate(f, s, preset, i->preset_size);
		if (!ret)
			tell_sizes(f->master->session, i);
		done(f, ret);
	}
	kvfree(preset);
	return ret;
}

int ec_ioc_deactivate(struct ec_file *f, void *arg)
{
	int ret = 0;
	struct ec_session *s = lock(f, &ret);

	return s ? done(f, ec_session_deactivate(s)) : ret;
}

int ec_ioc_domain_offset(struct ec_file *f, void *arg)
{
	struct ec_ioc_domain_offset *i = arg;
	int ret = 0;
	struct ec_session *s = lock(f, &ret);

	if (!s)
		return ret;
	if (i->domain >= s->n_domains)
		return done(f, ec_refuse(f, -ENOENT, "there is no domain %u", i->domain));
	if (!s->active)
		ec_session_place(s);
	i->offset = s->domains[i->domain]->offset;
	i->size = s->domains[i->domain]->size;
	return done(f, 0);
}

int ec_ioc_ref_clock(struct ec_file *f, void *arg)
{
	struct ec_ioc_ref_clock *i = arg;
	int ret = 0;
	struct ec_session *s = ec_ioc_lock_idle(f, &ret);

	if (!s)
		return ret;
	if (i->config != EC_UAPI_NONE32 && i->config >= s->n_configs)
		return done(f, ec_refuse(f, -ENOENT, "there is no slave configuration %u",
					 i->config));
	s->ref_config = i->config;
	return done(f, 0);
}

int ec_ioc_interval(struct ec_file *f, void *arg)
{
	struct ec_ioc_interval *i = arg;
	struct ec_session *s;
	int ret = 0;

	if (!i->interval_us)
		return ec_refuse(f, -EINVAL, "send interval must be 1 us or more");
	s = ec_ioc_lock_idle(f, &ret);
	if (!s)
		return ret;
	/* the interval is that of the session which runs */
	if (s == f->master->heir)
		return done(f, 0);
	f->master->links.access.interval_us = min_t(u32, i->interval_us, EC_MAX_INTERVAL_US);
	f->master->links.access.interval_set = i->interval_us <= EC_MAX_INTERVAL_US;
	return done(f, 0);
}

/**
 * enter() - the cyclic caller begins receive or send
 * @f: open file
 * @ret: error or 0
 *
 * A mutex is safe here in real time: besides the owner of the cycle only
 * deactivation takes it, for the time of one assignment, so it is free and costs
 * one atomic operation. Should the two meet, deactivation inherits the priority of the
 * cyclic caller under PREEMPT_RT, where a mutex is an rt_mutex.
 *
 * Context: Process. The lock is held when a session is returned.
 * Return: the active session of this file, or NULL with @ret -EPERM, or -EBUSY
 * when the kernel runs the cycle.
 */
static struct ec_session *enter(struct ec_file *f, int *ret)
{
	struct ec_master *m = f->master;

	/* whoever does not own the cycle does not reach its lock */
	if (READ_ONCE(m->active_owner) != f) {
		*ret = -EPERM;
		return NULL;
	}
	mutex_lock(&m->cyclic_lock);
	*ret = !m->active || m->active->owner != f ? -EPERM : m->active->thread ? -EBUSY : 0;
	if (!*ret)
		return m->active;
	mutex_unlock(&m->cyclic_lock);
	return NULL;
}

int ec_ioc_app_time(struct ec_file *f, void *arg)
{
	struct ec_ioc_app_time *i = arg;
	struct ec_ioc_send told = { .flags = EC_SEND_FLAG_APP_TIME, .app_time = i->app_time };
	struct ec_session *s;
	int ret;

	s = enter(f, &ret);
	if (s) {
		ec_dc_told(s, &told);
		mutex_unlock(&f->master->cyclic_lock);
		return 0;
	}
	if (ret == -EBUSY)
		return ec_refuse(f, ret, "the kernel runs the cycle and sets the application time");
	s = lock(f, &ret);
	if (!s)
		return ret;
	/* before activation there is no cycle to disturb, but of a detached session */
	if (s != f->master->heir)
		ec_dc_app_time(f->master, i->app_time, ktime_get_ns());
	return done(f, 0);
}

int ec_ioc_receive(struct ec_file *f)
{
	int ret;
	struct ec_session *s = enter(f, &ret);

	if (!s)
		return ret;
	ret = ec_cycle_receive(s);
	mutex_unlock(&f->master->cyclic_lock);
	return ret;
}

int ec_ioc_send(struct ec_file *f, const struct ec_ioc_send *arg)
{
	int ret;
	struct ec_session *s = enter(f, &ret);

	if (!s)
		return ret;
	ret = ec_cycle_told(s, arg) ?: ec_cycle_send(s, arg);
	mutex_unlock(&f->master->cyclic_lock);
	return ret;
}
