// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ctype.h>
#include <linux/pid_namespace.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include "../config/config.h"
#include "../cycle/copy.h"
#include "../cycle/cycle_lock.h"
#include "../cycle/cycle_thread.h"
#include "../cycle/domain.h"
#include "../mailbox/emerg.h"
#include "../mailbox/mailbox.h"
#include "../master.h"
#include "request.h"
#include "session.h"
#include "../bus/slave.h"
#include "../cycle/waiters.h"
#include "../config/why.h"
#include "../bus/slave_pdo.h"

/**
 * ec_session_of() - the session an application works with
 * @m: master
 * @owner: its open file
 *
 * Context: Process, session_lock held or after ec_show_begin().
 * Return: session, or NULL when it has not reserved the master.
 */
struct ec_session *ec_session_of(const struct ec_master *m, const void *owner)
{
	if (m->session && m->session->owner == owner)
		return m->session;
	return m->heir && m->heir->owner == owner ? m->heir : NULL;
}

/* One application at a time; one more may prepare to take a detached session over. */
static bool taken(struct ec_master *m)
{
	bool ret;

	mutex_lock(&m->session_lock);
	ret = m->heir || (m->session && m->session->owner);
	mutex_unlock(&m->session_lock);
	return ret;
}

/*
 * Mailboxes shall work from now on, whatever a tool has left behind. Who has
 * failed on the way to PREOP is left alone: that takes its time and helps nobody.
 */
static void to_preop(struct ec_master *m)
{
	unsigned int i;

	down_read(&m->bus.topo);
	for (i = 0; i < m->bus.n_slaves; i++) {
		struct ec_slave *s = m->bus.slaves[i];

		if (s->error == EC_SLAVE_SCAN_FAILED ||
		    (s->requested == EC_AL_PREOP && (s->error || s->al_status == EC_AL_PREOP)))
			continue;
		s->error = EC_SLAVE_OK;
		ec_slave_request(s, EC_AL_PREOP);
	}
	up_read(&m->bus.topo);
}

static int begin(struct ec_master *m, struct ec_session *s)
{
	int ret = 0;

	ec_session_lock(m);
	if (m->heir || (m->session && m->session->owner)) {
		ret = -EBUSY;
	} else if (m->session) {
		m->heir = s;
	} else {
		m->session = s;
		WRITE_ONCE(m->bus.freeze, true);
		to_preop(m);
	}
	ec_session_unlock(m);
	return ret;
}

/* Who reserves the master; a command may have any name, and it goes to terminals. */
static void note_process(struct ec_session *s)
{
	char *p;

	s->owner_pid = task_tgid_nr(current);
	get_task_comm(s->owner_comm, current);
	for (p = s->owner_comm; *p; p++)
		if (!isascii(*p) || !isprint(*p))
			*p = '?';
}

/**
 * ec_session_owner_text() - the process that has reserved the master
 * @m: master
 * @buf: result, such as "process 123 (demo)"
 * @size: of @buf
 *
 * The number is that of the caller's PID namespace.
 *
 * Context: Process. May sleep.
 * Return: length of the text; 0: nobody has it any more.
 */
size_t ec_session_owner_text(struct ec_master *m, char *buf, size_t size)
{
	const struct ec_session *s;
	size_t len = 0;
	pid_t nr;

	buf[0] = '\0';
	ec_session_lock(m);
	s = m->heir ?: m->session;
	if (s && s->owner) {
		rcu_read_lock();
		nr = pid_vnr(find_pid_ns(s->owner_pid, &init_pid_ns));
		rcu_read_unlock();
		/* it has left its file to a child, or is in another namespace */
		if (nr)
			len = scnprintf(buf, size, "process %d (%s)", nr, s->owner_comm);
		else
			len = scnprintf(buf, size, "another process (%s)", s->owner_comm);
	}
	ec_session_unlock(m);
	return len;
}

/**
 * ec_session_begin() - an application reserves the master
 * @m: master
 * @owner: its open file
 * @waiters: wait queue of that file; freed after an RCU grace period
 *
 * Waits for a scan in progress, then the list of slaves is frozen until
 * activation and all go to PREOP; that is waited for, too. While a detached
 * session runs, the new one is its heir: it touches no slave until activation.
 *
 * Context: Process. May sleep.
 * Return: 0, -EBUSY when somebody else has it, -ENODEV without device,
 * -EINTR, -ENOMEM.
 */
int ec_session_begin(struct ec_master *m, const void *owner, struct ec_waiters *waiters)
{
	struct ec_session *s;
	int ret;

	if (!READ_ONCE(m->links.link[0].dev))
		return -ENODEV;
	if (taken(m))
		return -EBUSY;
	ret = ec_bus_wait_scan(&m->bus);
	if (ret == -EINTR)
		return ret;
	s = kvzalloc(sizeof(*s), GFP_KERNEL_ACCOUNT);
	if (!s)
		return -ENOMEM;
	s->master = m;
	s->owner = owner;
	RCU_INIT_POINTER(s->waiters, waiters);
	note_process(s);
	s->ref_config = EC_UAPI_NONE32;
	s->late_per_s = EC_LATE_PER_S;
	ret = begin(m, s);
	if (ret) {
		kvfree(s);
		return ret;
	}
	if (READ_ONCE(m->heir) == s)
		return 0;
	ret = ec_bus_wait_slaves(&m->bus);
	if (ret != -EINTR)
		return 0;	/* one that is slow is no reason to refuse */
	ec_session_end(m, owner);
	return ret;
}

/* An heir only looks at slaves. */
static bool owned(const struct ec_config *c)
{
	return c->slave && c->slave->config == c;
}

/* Detach slave and configuration; the slave goes back to PREOP. */
static void detach(struct ec_config *c)
{
	struct ec_slave *slave = c->slave;
	unsigned int sm;

	if (!slave)
		return;
	if (!owned(c)) {
		c->slave = NULL;
		ec_slave_unref(slave);
		return;
	}
	c->slave = NULL;
	ec_emerg_set(&slave->mbox, NULL);
	ec_mbox_keep_voe(&slave->mbox, false);
	WRITE_ONCE(slave->stop.interrupt, true);
	mutex_lock(&slave->lock);
	for (sm = 0; sm < EC_MAX_SM; sm++)
		/* the slave keeps what was written */
		if (c->sm[sm].explicit ||
		    !ec_pdo_list_same(&c->sm[sm].pdos, &slave->sm_pdos[sm]))
			WRITE_ONCE(slave->pdos_known, false);
	slave->config = NULL;
	slave->plan = NULL;
	ec_slave_clear_warning(slave);
	slave->pdo_refusal[0] = '\0';
	slave->reconfigure = true;
	slave->stop.interrupt = false;
	mutex_unlock(&slave->lock);
	if (!slave->stop.gone && !slave->bus->master->base->stopping)
		ec_slave_request(slave, EC_AL_PREOP);
	ec_slave_unref(slave);
}

static void clear(struct ec_session *s)
{
	unsigned int i;

	ec_session_lower_ref(s);
	/* all at once: a worker may need a moment to leave */
	for (i = 0; i < s->n_configs; i++)
		if (owned(s->configs[i]))
			WRITE_ONCE(s->configs[i]->slave->stop.interrupt, true);
	for (i = 0; i < s->n_configs; i++) {
		detach(s->configs[i]);
		ec_config_free(s->configs[i]);
	}
	kvfree(s->configs);
	kvfree(s->specs);
	s->specs = NULL;
	s->n_specs = 0;
	s->request_bytes = 0;
	s->configs = NULL;
	s->n_configs = 0;
	s->bytes = 0;
	for (i = 0; i < s->n_domains; i++)
		ec_domain_free(s->domains[i]);
	s->n_domains = 0;
	kvfree(s->copies);
	s->copies = NULL;
	s->n_copies = 0;
	s->ref_config = EC_UAPI_NONE32;
	s->late_per_s = EC_LATE_PER_S;
	memset(&s->kernel, 0, sizeof(s->kernel));
	s->priority = 0;
	s->cpu_lost = false;
	s->cpu_losses = 0;
}

/* The next application begins with what it tells itself. */
static void forget_told(struct ec_master *m)
{
	ec_dc_end(&m->dc);
	m->links.access.interval_us = EC_INTERVAL_US;
	m->links.access.interval_set = false;
}

/**
 * ec_session_deactivate() - stop process data, free what was configured
 * @s: session
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0, or -EINVAL when it was not active.
 */
int ec_session_deactivate(struct ec_session *s)
{
	struct ec_master *m = s->master;
	struct ec_shared *sh;

	if (!s->active)
		return -EINVAL;
	mutex_lock(&m->cyclic_lock);
	m->active = NULL;
	WRITE_ONCE(m->active_owner, NULL);
	mutex_unlock(&m->cyclic_lock);
	ec_cycle_thread_stop(s);
	ec_access_change(&m->links, EC_ACCESS_DIRECT);
	ec_late_end(s);
	s->active = false;
	s->ending = false;
	s->stall_log.open = false;
	ec_requests_end(s);
	clear(s);
	ec_cycle_free(m, &s->cycle);
	ec_copies_end(s);
	sh = s->shared;
	s->shared = NULL;
	ec_shared_put(sh);
	forget_told(m);
	if ((u32)atomic_read(&m->links.access.timeouts) != s->stall_log.told)
		ec_warn(m, "%u more cycle timeout(s) since the last message\n",
			atomic_read(&m->links.access.timeouts) - s->stall_log.told);
	ec_info(m, "session deactivated\n");
	return 0;
}

/**
 * ec_session_free() - a session that is not active goes away
 * @s: session nobody finds any more
 *
 * Context: Process, session_lock held. May sleep.
 */
void ec_session_free(struct ec_session *s)
{
	clear(s);
	kvfree(s);
}

/* The heir of a session that has ended: from now on its slaves are its own. */
static void inherit(struct ec_master *m)
{
	struct ec_session *s = m->heir;
	unsigned int i;

	m->heir = NULL;
	m->session = s;
	WRITE_ONCE(m->bus.freeze, s != NULL);
	if (s)
		to_preop(m);
	for (i = 0; s && i < s->n_configs; i++) {
		detach(s->configs[i]);
		ec_session_attach_one(s, s->configs[i]);
	}
}

static void end(struct ec_master *m)
{
	struct ec_session *s = m->session;

	/* one that was never active may have told its time and interval, too */
	if (ec_session_deactivate(s))
		forget_told(m);
	m->session = NULL;
	ec_session_free(s);
	inherit(m);
}

/**
 * ec_session_set_owner() - an active session changes hands
 * @s: session
 * @owner: open file, or NULL
 * @waiters: wait queue of that file, or NULL
 *
 * Context: Process, session_lock held. May sleep.
 */
void ec_session_set_owner(struct ec_session *s, const void *owner, struct ec_waiters *waiters)
{
	struct ec_waiters *before = rcu_dereference_protected(s->waiters,
						lockdep_is_held(&s->master->session_lock));

	mutex_lock(&s->master->cyclic_lock);
	WRITE_ONCE(s->owner, owner);
	rcu_assign_pointer(s->waiters, waiters);
	WRITE_ONCE(s->master->active_owner, owner);
	mutex_unlock(&s->master->cyclic_lock);
	/* no cycle wakes them any more */
	if (before)
		ec_waiters_wake(before);
}

/**
 * ec_session_end() - the application is gone or releases the master
 * @m: master
 * @owner: its open file, NULL: whoever it is; another's session stays
 *
 * An active session whose cycle the kernel runs is detached instead, when it was
 * configured so; with @owner NULL it ends, too.
 *
 * Context: Process. May sleep.
 */
void ec_session_end(struct ec_master *m, const void *owner)
{
	struct ec_session *s;

	ec_session_lock(m);
	s = m->heir;
	if (s && (!owner || s->owner == owner)) {
		m->heir = NULL;
		ec_session_free(s);
	}
	s = m->session;
	if (s && owner && s->owner != owner)
		s = NULL;
	if (s && owner && s->thread && !s->ending &&
	    s->kernel.flags & EC_CYCLE_FLAG_DETACH) {
		ec_session_set_owner(s, NULL, NULL);
		ec_info(m, "application exited or released the master; session detached, kernel cycle continues\n");
	} else if (s) {
		end(m);
	}
	ec_session_unlock(m);
}

/**
 * ec_session_end_detached() - end the cycle of an application that has gone
 * @m: master
 *
 * Slaves go to PREOP. One who wanted to take over has the master then.
 *
 * Context: Process. May sleep.
 * Return: 0; -ENOENT nothing is active; -EBUSY its application is there.
 */
int ec_session_end_detached(struct ec_master *m)
{
	int ret = 0;

	ec_session_lock(m);
	if (!m->session)
		ret = -ENOENT;
	else if (m->session->owner)
		ret = -EBUSY;
	else
		end(m);
	ec_session_unlock(m);
	return ret;
}

/**
 * ec_session_find() - the slave that a configuration means
 * @m: master
 * @alias: alias or 0
 * @position: position
 * @vendor: expected vendor id
 * @product: expected product code
 *
 * Context: Process. May sleep.
 * Return: slave with a reference, or NULL.
 */
struct ec_slave *ec_session_find(struct ec_master *m, u16 alias, u16 position, u32 vendor,
				 u32 product)
{
	struct ec_slave *slave = NULL;
	unsigned int i, pos = position;

	down_read(&m->bus.topo);
	if (alias) {
		for (i = 0; i < m->bus.n_slaves && m->bus.slaves[i]->alias != alias; i++)
			;
		pos += i;
	}
	if (pos < m->bus.n_slaves && m->bus.slaves[pos]->info.vendor == vendor &&
	    m->bus.slaves[pos]->info.product == product && !m->bus.slaves[pos]->stop.gone)
		slave = ec_slave_ref(m->bus.slaves[pos]);
	up_read(&m->bus.topo);
	return slave;
}

/* Another configuration has @slave; it is told once, to who waits for this one. */
static void tell_taken(const struct ec_session *s, const struct ec_config *c,
		       struct ec_slave *slave)
{
	const struct ec_config *has = slave->config;

	if (s->active)
		ec_slave_warn(slave, "slave attached to %u:%u since activation; configuration %u:%u expects this position and has no slave: reconnect the missing slave or restart the application\n",
			      has->alias, has->position, c->alias, c->position);
	else
		ec_slave_warn(slave, "two configurations for this slave, %u:%u and %u:%u; use one of them\n",
			      has->alias, has->position, c->alias, c->position);
}

/* Reasons go on naming the slave that was lost, whoever is in its place now. */
static void note_loss(struct ec_config *c)
{
	ec_slave_lost_text(c->slave, c->lost.text, sizeof(c->lost.text));
	c->lost.seen_ns = c->slave->seen_ns;
}

/**
 * ec_session_attach_one() - connect a configuration with its slave
 * @s: session
 * @c: configuration
 *
 * An active session keeps a slave as long as it is there: when one in front of it is
 * pulled its position changes, but its outputs must not be those of another.
 *
 * Context: Process, session_lock held. May sleep.
 */
void ec_session_attach_one(struct ec_session *s, struct ec_config *c)
{
	struct ec_slave *slave;

	ec_config_find_alias(c);
	if (s->active && c->slave && !c->slave->stop.gone)
		return;
	slave = ec_session_find(s->master, c->alias, c->position, c->vendor, c->product);
	if (slave == c->slave) {
		if (slave)
			ec_slave_unref(slave);
		return;
	}
	if (s->active && c->slave)
		note_loss(c);
	detach(c);
	if (!slave)
		return;
	if (s == s->master->heir) {	/* only to look at */
		c->slave = slave;
		return;
	}
	/* the monitor must not wait for what its worker waits for */
	WRITE_ONCE(slave->stop.interrupt, true);
	mutex_lock(&slave->lock);
	WRITE_ONCE(slave->stop.interrupt, false);
	if (slave->config) {
		tell_taken(s, c, slave);
		mutex_unlock(&slave->lock);
		ec_slave_unref(slave);
		return;
	}
	slave->config = c;
	slave->reconfigure = true;
	slave->seen_ns = c->lost.seen_ns;
	mutex_unlock(&slave->lock);
	c->slave = slave;
	ec_requests_attach(s, c->index);
	if (s->active && !s->ending)
		ec_slave_request(slave, EC_AL_OP);
	else
		ec_slave_kick(slave);
}

/**
 * ec_session_attach() - after a scan: connect configurations and slaves anew
 * @m: master
 *
 * Context: Process. May sleep.
 */
void ec_session_attach(struct ec_master *m)
{
	unsigned int i;

	ec_session_lock(m);
	for (i = 0; m->session && i < m->session->n_configs; i++)
		ec_session_attach_one(m->session, m->session->configs[i]);
	for (i = 0; m->heir && i < m->heir->n_configs; i++)
		ec_config_find_alias(m->heir->configs[i]);
	ec_session_unlock(m);
}

/* Station address of the chosen reference clock, as for ec_dc_begin(). */
static u16 ref_choice(const struct ec_session *s)
{
	if (s->ref_config >= s->n_configs)
		return EC_DC_ANY;
	return s->configs[s->ref_config]->slave ? s->configs[s->ref_config]->slave->station :
						  EC_DC_NOBODY;
}

/**
 * ec_session_uses_clocks() - does the session need distributed clocks for sure?
 * @s: session
 *
 * Context: Process, session_lock held.
 * Return: true: a slave has SYNC signals, or the kernel's cycle keeps clocks.
 */
bool ec_session_uses_clocks(const struct ec_session *s)
{
	unsigned int i;

	if (s->kernel.dc)
		return true;
	for (i = 0; i < s->n_configs; i++)
		if (s->configs[i]->sync.assign)
			return true;
	return false;
}

/*
 * One that was chosen and is not there is told at once: its clock calls fail, so
 * nothing else would ever begin to look for it.
 */
static bool begins_clocks(const struct ec_session *s)
{
	return ec_session_uses_clocks(s) ||
	       (s->ref_config < s->n_configs && !ec_dc_can_be(&s->master->dc, ref_choice(s)));
}

/**
 * ec_session_clocks() - set clocks that somebody wants and nobody has set
 * @m: master
 *
 * The clocks of an application begin with its activation when a slave has SYNC
 * signals, else with the first clock datagram it sends. They begin anew when slaves
 * have come or gone, and when one that did not answer does.
 *
 * Context: The monitor thread. May sleep.
 */
void ec_session_clocks(struct ec_master *m)
{
	struct ec_dc *dc = &m->dc;
	struct ec_session *s;

	/* held by an activation: next time then */
	if (!ec_session_trylock(m))
		return;
	s = m->session;
	if (s && s->active && (dc->begun ? dc->changed || READ_ONCE(dc->again) :
					   READ_ONCE(dc->wanted)))
		ec_dc_begin(&m->dc, !dc->begun, ref_choice(s));
	if (dc->changed) {
		WRITE_ONCE(dc->changed, false);
		wake_up_all(&dc->wq);
	}
	if (s && s->active && !s->ending)
		ec_session_raise_ref(s);
	mutex_unlock(&m->session_lock);
}

/**
 * ec_session_place() - give the domains their places in the image
 * @s: session, not active
 *
 * Context: Process, session_lock held.
 * Return: bytes of all domains.
 */
u32 ec_session_place(struct ec_session *s)
{
	u32 offset = 0;
	unsigned int i;

	for (i = 0; i < s->n_domains; i++) {
		s->domains[i]->offset = offset;
		s->domains[i]->logical = offset;
		offset += ALIGN(s->domains[i]->size, 8);
	}
	return offset;
}

/**
 * ec_session_activate() - lay out process data, hand the links to the cycle
 * @s: session
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0; -EBUSY when active already; -EOPNOTSUPP a domain has a division and
 * the application runs the cycle; -EOVERFLOW when the image or a cycle
 * is too large; -EDQUOT as ec_session_fits(); -ENOSPC as ec_cycle_check_room(); -ENODEV when the CPU of the cycle is offline; -ENOMEM.
 */
int ec_session_activate(struct ec_session *s)
{
	struct ec_master *m = s->master;
	unsigned int i;
	u32 offset;
	int ret;

	if (s->active)
		return -EBUSY;
	for (i = 0; i < s->n_domains; i++)
		if (s->domains[i]->division > 1 && !s->kernel.period_ns)
			return -EOPNOTSUPP;
	offset = ec_session_place(s);
	if (offset > EC_MAX_IMAGE)
		return -EOVERFLOW;
	ret = ec_session_fits(s, offset);
	if (ret)
		return ret;
	s->shared = ec_shared_create(m, offset, ec_requests_bytes(s));
	if (!s->shared)
		return -ENOMEM;
	if (s->preset)
		memcpy(s->shared->image, s->preset, offset);
	ret = ec_requests_begin(s) ?: ec_copies_begin(s) ?: ec_cycle_layout(s) ?:
	      ec_cycle_check_room(s);
	if (!ret && s->kernel.period_ns)
		ret = ec_cycle_thread_create(s, offset);
	if (ret) {
		ec_cycle_free(m, &s->cycle);
		ec_copies_end(s);
		ec_requests_end(s);
		ec_shared_put(s->shared);
		s->shared = NULL;
		return ret;
	}
	s->shared->status->config_count = s->n_configs;
	s->shared->status->dc_monitor = ~0u;
	for (i = 0; i < s->n_domains; i++)
		s->shared->status->domains[i].expected = s->domains[i]->expected;
	/* from now on workers go by the configurations, which stay as they are */
	smp_store_release(&s->active, true);
	s->stall_log.told = atomic_read(&m->links.access.timeouts);
	s->lock_told = EC_CYCLE_LOCK_OFF;
	WRITE_ONCE(m->bus.freeze, false);
	/* one that waits for outputs takes the links with its first frame */
	if (!s->thread || !(s->kernel.flags & EC_CYCLE_FLAG_WAIT))
		ec_access_change(&m->links, EC_ACCESS_CYCLIC);
	mutex_lock(&m->cyclic_lock);
	m->active = s;
	WRITE_ONCE(m->active_owner, s->owner);
	mutex_unlock(&m->cyclic_lock);
	if (begins_clocks(s))
		ec_dc_begin(&m->dc, true, ref_choice(s));
	s->shared->status->dc_ref = READ_ONCE(m->dc.ref_station) != 0;
	ec_session_fill_status(s);
	ec_cycle_thread_start(s);
	for (i = 0; i < s->n_configs; i++)
		if (s->configs[i]->slave)
			ec_slave_request(s->configs[i]->slave, EC_AL_OP);
	ec_session_raise_ref(s);
	if (s->requests)
		ec_requests_kick(s->requests);
	ec_config_log_differences(s);
	ec_info(m, "session activated: %u domain(s), %u bytes, %u datagram(s) per cycle\n",
		s->n_domains, offset, s->cycle.n_dgrams);
	return 0;
}

/**
 * ec_session_slaves_down() - take the slaves to PREOP, the cycle goes on
 * @s: session
 *
 * The state changes while process data and SYNC signals still run, so that no
 * slave sees a fault; the SYNC signals are switched off in PREOP.
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0, or -EINVAL when it is not active.
 */
int ec_session_slaves_down(struct ec_session *s)
{
	unsigned int i;

	if (!s->active)
		return -EINVAL;
	s->ending = true;
	ec_session_lower_ref(s);
	for (i = 0; i < s->n_configs; i++)
		if (s->configs[i]->slave)
			ec_slave_request(s->configs[i]->slave, EC_AL_PREOP);
	return 0;
}
