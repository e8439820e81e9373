// SPDX-License-Identifier: GPL-2.0-only
/*
 * An application takes over the detached session of another one. What it has configured must be
 * the same: all that is sent to a slave, and all that determines places in the mapped memory. The
 * two are compared, not hashes of them, so that the first difference can be reported.
 */
#include "../base/report.h"
#include "../config/group.h"
#include "../config/unit.h"
#include "../cycle/cycle_sched.h"
#include "../cycle/cycle_thread.h"
#include "../cycle/units.h"
#include "clear.h"
#include "request_layout.h"
#include "session_status.h"
#include "takeover.h"

/* the description of the first difference */
struct text {
	char *buf;
	size_t size;
};

/* Always true: there is a difference. */
static __printf(2, 3) bool differs(const struct text *t, const char *fmt, ...)
{
	va_list args;

	va_start(args, fmt);
	vscnprintf(t->buf, t->size, fmt, args);
	va_end(args);
	return true;
}

/* Compare member @m of @a and @b, two structures; @t describes the difference, if any. */
#define NUMBER(m, fmt, ...) \
	(a->m != b->m && differs(t, fmt, ##__VA_ARGS__, a->m, b->m))
#define CONTENT(m, fmt, ...) \
	(memcmp(&a->m, &b->m, sizeof(a->m)) && differs(t, fmt, ##__VA_ARGS__))

static bool sms_differ(const struct ec_config *a, const struct ec_config *b,
		       const struct text *t)
{
	unsigned int i;

	for (i = 0; i < EC_MAX_SM; i++) {
		const struct ec_config_sm *x = &a->sm[i], *y = &b->sm[i];

		if (x->dir != y->dir || x->watchdog != y->watchdog || x->explicit != y->explicit ||
		    !ec_pdo_list_same(&x->pdos, &y->pdos))
			return differs(t, "slave %s, SM%u: its direction, watchdog or PDOs",
				       a->name, i);
	}
	return false;
}

static bool fmmus_differ(const struct ec_config *a, const struct ec_config *b)
{
	unsigned int i;

	if (a->overlap != b->overlap || a->n_fmmus != b->n_fmmus)
		return true;
	for (i = 0; i < a->n_fmmus; i++) {
		const struct ec_config_fmmu *x = &a->fmmus[i], *y = &b->fmmus[i];

		if (x->domain->index != y->domain->index || x->sm != y->sm || x->dir != y->dir ||
		    x->offset != y->offset || x->size != y->size)
			return true;
	}
	return false;
}

static bool name_command(const struct ec_config *c, const struct ec_startup *u,
			 const struct text *t)
{
	switch (u->type) {
	case EC_STARTUP_SDO:
		return differs(t, "slave %s, startup SDO 0x%04x:%02x", c->name, u->index,
			       u->sub);
	case EC_STARTUP_IDN:
		return differs(t, "slave %s, startup IDN 0x%04x", c->name, u->index);
	case EC_STARTUP_COMMAND:
		return differs(t, "slave %s, command for a transition, 0x%04x", c->name, u->index);
	case EC_STARTUP_IP:
		return differs(t, "slave %s, IP parameters", c->name);
	default:
		return differs(t, "slave %s, watchdog", c->name);
	}
}

static bool same_command(const struct ec_startup *a, const struct ec_startup *b)
{
	return a->type == b->type && a->transition == b->transition && a->index == b->index &&
	       a->sub == b->sub && a->complete == b->complete && a->kind == b->kind &&
	       a->how == b->how && a->timeout_ms == b->timeout_ms && a->size == b->size &&
	       !memcmp(a->data, b->data, a->size);
}

/* The lists are compared whole: the first command that is not in both is the difference. */
static bool startup_differs(const struct ec_config *a, const struct ec_config *b,
			    const struct text *t)
{
	const struct ec_startup *x, *y = list_first_entry(&b->startup, typeof(*y), list);

	list_for_each_entry(x, &a->startup, list) {
		if (list_entry_is_head(y, &b->startup, list) || !same_command(x, y))
			return name_command(a, x, t);
		y = list_next_entry(y, list);
	}
	return !list_entry_is_head(y, &b->startup, list) && name_command(a, y, t);
}

static bool flags_differ(const struct ec_config *a, const struct ec_config *b,
			 const struct text *t)
{
	const struct ec_config_flag *x, *y = list_first_entry(&b->flags, typeof(*y), list);

	if (NUMBER(n_flags, "slave %s has %u flags, not %u", a->name))
		return true;
	list_for_each_entry(x, &a->flags, list) {
		if (strcmp(x->key, y->key) || x->value != y->value)
			return differs(t, "slave %s, flag %.32s", a->name, x->key);
		y = list_next_entry(y, list);
	}
	return false;
}

static bool replay_differs(const struct ec_config *a, const struct ec_config *b)
{
	const struct ec_replay *x = &a->replay, *y = &b->replay;

	return x->mode != y->mode || x->n_named != y->n_named ||
	       memcmp(x->named, y->named, sizeof(x->named));
}

static bool config_differs(const struct ec_config *a, const struct ec_config *b,
			   const struct text *t)
{
	if (strcmp(a->name, b->name))
		return differs(t, "slave configuration %u is %s, not %s", a->index,
			       a->name, b->name);
	return NUMBER(vendor, "slave %s has vendor id 0x%08x, not 0x%08x", a->name) ||
	       NUMBER(product, "slave %s has product code 0x%08x, not 0x%08x", a->name) ||
	       sms_differ(a, b, t) || startup_differs(a, b, t) || flags_differ(a, b, t) ||
	       (fmmus_differ(a, b) &&
		differs(t, "slave %s, its place in the domains", a->name)) ||
	       (replay_differs(a, b) &&
		differs(t, "slave %s, what is replayed to it", a->name)) ||
	       CONTENT(sync.assign, "slave %s, distributed clock", a->name) ||
	       CONTENT(sync.period, "slave %s, distributed clock", a->name) ||
	       CONTENT(sync.shift, "slave %s, distributed clock", a->name) ||
	       CONTENT(timeout_ms, "slave %s, time limits of its states", a->name) ||
	       NUMBER(reply_ms, "slave %s has %u ms for a reply, not %u", a->name) ||
	       NUMBER(emergencies, "slave %s keeps %u emergencies, not %u", a->name);
}

static bool domain_differs(const struct ec_domain *a, const struct ec_domain *b,
			   const struct text *t)
{
	return NUMBER(size, "domain %u has %u bytes, not %u", a->index) ||
	       NUMBER(options, "domain %u has the options 0x%x, not 0x%x", a->index) ||
	       NUMBER(max_age, "domain %u has stale data after %u sends, not %u", a->index) ||
	       NUMBER(division, "domain %u is sent every %u cycles, not %u", a->index) ||
	       NUMBER(phase, "domain %u is first sent in cycle %u, not %u", a->index);
}

static bool cycle_differs(const struct ec_cycle_setup *a, const struct ec_cycle_setup *b,
			  const struct text *t)
{
	unsigned int i;

	if (NUMBER(copies.n, "it has %u copies, not %u"))
		return true;
	for (i = 0; i < a->copies.n; i++)
		if (CONTENT(copies.list[i], "copy %u", i))
			return true;
	if (!b->kernel.period_ns)
		return differs(t, "the kernel runs its cycle");
	return NUMBER(kernel.period_ns, "the period is %u ns, not %u") ||
	       CONTENT(kernel, "how the kernel runs the cycle");
}

static bool wanted_differs(const struct ec_wanted *a, const struct ec_wanted *b,
			   const struct text *t)
{
	unsigned int i;

	if (NUMBER(n_configs, "it has %u slaves, not %u"))
		return true;
	for (i = 0; i < a->n_configs; i++)
		if (config_differs(a->configs[i], b->configs[i], t))
			return true;
	if (NUMBER(n_groups, "it has %u groups, not %u"))
		return true;
	for (i = 0; i < a->n_groups; i++)
		if (ec_group_differs(a->groups[i], b->groups[i]))
			return differs(t, "group %s", a->groups[i]->name);
	if (NUMBER(n_domains, "it has %u domains, not %u"))
		return true;
	for (i = 0; i < a->n_domains; i++)
		if (domain_differs(a->domains[i], b->domains[i], t))
			return true;
	if (NUMBER(n_units, "it has %u sync units, not %u"))
		return true;
	for (i = 0; i < a->n_units; i++)
		if (ec_unit_differs(a->units[i], b->units[i]) ||
		    a->units[i]->domains != b->units[i]->domains)
			return differs(t, "sync unit %s", a->units[i]->what.name);
	return false;
}

static bool session_differs(const struct ec_session *a, const struct ec_session *b,
			    const struct text *t)
{
	if (wanted_differs(&a->wanted, &b->wanted, t))
		return true;
	if (a->ref_config != b->ref_config)
		return differs(t, "reference clock");
	if (a->n_specs != b->n_specs || a->request_bytes != b->request_bytes ||
	    (a->n_specs && memcmp(a->specs, b->specs, a->n_specs * sizeof(*a->specs))))
		return differs(t, "its %u SDO and register requests", a->n_specs);
	return cycle_differs(&a->cycle.setup, &b->cycle.setup, t);
}

/*
 * The number of cycles that acyclic frames may delay is not compared: no slave gets it, and the
 * layout does not depend on it. The value of the new application is used from now on.
 */
static void adopt_late(struct ec_session *s, u32 per_s)
{
	s->cycle.setup.late_per_s = per_s;
	WRITE_ONCE(s->sessions->links->carry->share.late_per_s, per_s);
}

/* Its values are called as the new application says. */
static void take_names(struct ec_session *s, struct ec_session *candidate)
{
	lockdep_assert_held(s->wanted.lock);
	s->wanted.budget.bytes += candidate->names_size;
	s->wanted.budget.bytes -= s->names_size;
	candidate->wanted.budget.bytes += s->names_size;
	candidate->wanted.budget.bytes -= candidate->names_size;
	swap(s->names, candidate->names);
	swap(s->names_size, candidate->names_size);
}

/**
 * ec_session_take_over() - give the detached session to the application of the candidate
 * @ss: sessions of a master with a detached session and a candidate
 * @why: result: the first difference of the two
 * @size: of @why
 * @keep: the candidate's configuration stays until the session ends
 *
 * The cycle continues, with the priority that the candidate's process may use; without @keep the
 * candidate's configuration is freed.
 *
 * Context: Process, session lock held. Sleeps until the next cycle has begun.
 * Return: 0; -EEXIST another configuration; -ENOSPC as for an activation;
 * -ETIMEDOUT the cycle does not run.
 */
int ec_session_take_over(struct ec_sessions *ss, char *why, size_t size, bool keep)
{
	const struct text t = { .buf = why, .size = size };
	struct ec_session *s = ss->session, *candidate = ss->candidate;
	int ret;

	if (session_differs(s, candidate, &t))
		return -EEXIST;
	if (!candidate->cycle.setup.late_per_s &&
	    ec_access_slack_ns(ss->links) < ec_layout_need_ns())
		return -ENOSPC;
	ret = ec_cycle_thread_adopt(&s->cycle);
	if (ret)
		return ret;
	/* it may have held units of the other application */
	ec_units_leave(&s->cycle, EC_UNIT_NONE, candidate->cycle.owner);
	ec_units_take_over(&s->cycle);
	if (s->requests)
		ec_requests_describe(s);
	adopt_late(s, candidate->cycle.setup.late_per_s);
	ec_cycle_thread_inherit(&s->cycle, candidate->cycle.setup.priority,
				candidate->cycle.setup.may_interrupt);
	WRITE_ONCE(ss->candidate, NULL);
	ec_session_fill_status(s);
	ec_cycle_set_owner(&s->cycle, candidate->cycle.owner,
			   rcu_dereference_protected(candidate->cycle.waiters,
						     lockdep_is_held(&ss->lock)));
	s->owner_pid = candidate->owner_pid;
	memcpy(s->owner_comm, candidate->owner_comm, sizeof(s->owner_comm));
	ec_report(ss->base, EC_EVENT_TAKEN_OVER, s->owner_pid);
	take_names(s, candidate);
	/* the previous application has no handles any more */
	if (s->handles)
		ec_session_free(s->handles);
	s->handles = keep ? candidate : NULL;
	if (!keep)
		ec_session_free(candidate);
	return 0;
}
