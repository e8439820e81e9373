// SPDX-License-Identifier: GPL-2.0-only
/*
 * An application takes over the detached session of another one. What it has
 * configured must be the same, to the last bit of what reaches a slave or decides
 * where something lies in the mapped memory. The two are compared, not hashes of
 * them: so the first difference can be told.
 */
#include "../config/config.h"
#include "../cycle/copy.h"
#include "../cycle/cycle_thread.h"
#include "../config/domain.h"
#include "request.h"
#include "session.h"

/* where the first difference is described */
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

#define SLAVE(c)	(c)->alias, (c)->position

static bool pdo_differs(const struct ec_config *c, u8 sm, const struct ec_pdo *a,
			const struct ec_pdo *b, const struct text *t)
{
	unsigned int i;

	if (a->index != b->index)
		return differs(t, "slave %u:%u, SM%u has PDO 0x%04x, not 0x%04x", SLAVE(c), sm,
			       a->index, b->index);
	for (i = 0; i < max(a->n_entries, b->n_entries); i++)
		if (i >= a->n_entries || i >= b->n_entries ||
		    a->entries[i].index != b->entries[i].index ||
		    a->entries[i].sub != b->entries[i].sub ||
		    a->entries[i].bits != b->entries[i].bits)
			return differs(t, "slave %u:%u, PDO 0x%04x, entry %u", SLAVE(c), a->index,
				       i);
	return false;
}

static bool sms_differ(const struct ec_config *a, const struct ec_config *b,
		       const struct text *t)
{
	unsigned int i, p;

	for (i = 0; i < EC_MAX_SM; i++) {
		const struct ec_config_sm *x = &a->sm[i], *y = &b->sm[i];

		if (x->dir != y->dir || x->watchdog != y->watchdog || x->explicit != y->explicit)
			return differs(t, "slave %u:%u, SM%u", SLAVE(a), i);
		if (x->pdos.n != y->pdos.n)
			return differs(t, "slave %u:%u, SM%u has %u PDOs, not %u", SLAVE(a), i,
				       x->pdos.n, y->pdos.n);
		for (p = 0; p < x->pdos.n; p++)
			if (pdo_differs(a, i, &x->pdos.pdos[p], &y->pdos.pdos[p], t))
				return true;
	}
	return false;
}

static bool fmmus_differ(const struct ec_config *a, const struct ec_config *b)
{
	unsigned int i;

	if (a->n_fmmus != b->n_fmmus)
		return true;
	for (i = 0; i < a->n_fmmus; i++) {
		const struct ec_config_fmmu *x = &a->fmmus[i], *y = &b->fmmus[i];

		if (x->domain->index != y->domain->index || x->sm != y->sm || x->dir != y->dir ||
		    x->offset != y->offset || x->size != y->size)
			return true;
	}
	return false;
}

static bool command_differs(const struct ec_config *c, const struct ec_startup *u,
			    const struct text *t)
{
	switch (u->type) {
	case EC_STARTUP_SDO:
		return differs(t, "slave %u:%u, startup SDO 0x%04x:%02x", SLAVE(c), u->index,
			       u->sub);
	case EC_STARTUP_IDN:
		return differs(t, "slave %u:%u, startup IDN 0x%04x", SLAVE(c), u->index);
	case EC_STARTUP_IP:
		return differs(t, "slave %u:%u, IP parameters", SLAVE(c));
	default:
		return differs(t, "slave %u:%u, watchdog", SLAVE(c));
	}
}

static bool startup_differs(const struct ec_config *a, const struct ec_config *b,
			    const struct text *t)
{
	const struct ec_startup *x, *y = list_first_entry(&b->startup, typeof(*y), list);
	struct ec_startup kind = { };
	const u32 *n = a->n_startup, *k = b->n_startup;

	for (; kind.type < EC_STARTUP_TYPES; kind.type++) {
		if (n[kind.type] == k[kind.type])
			continue;
		if (kind.type == EC_STARTUP_SDO || kind.type == EC_STARTUP_IDN)
			return differs(t, "slave %u:%u has %u startup %ss, not %u", SLAVE(a),
				       n[kind.type], kind.type == EC_STARTUP_SDO ? "SDO" : "IDN",
				       k[kind.type]);
		return command_differs(a, &kind, t);
	}
	list_for_each_entry(x, &a->startup, list) {
		if (x->transition != y->transition || x->index != y->index || x->sub != y->sub ||
		    x->complete != y->complete || x->size != y->size ||
		    memcmp(x->data, y->data, x->size))
			return command_differs(a, x, t);
		y = list_next_entry(y, list);
	}
	return false;
}

static bool flags_differ(const struct ec_config *a, const struct ec_config *b,
			 const struct text *t)
{
	const struct ec_config_flag *x, *y = list_first_entry(&b->flags, typeof(*y), list);

	if (a->n_flags != b->n_flags)
		return differs(t, "slave %u:%u has %u flags, not %u", SLAVE(a), a->n_flags,
			       b->n_flags);
	list_for_each_entry(x, &a->flags, list) {
		if (strcmp(x->key, y->key) || x->value != y->value)
			return differs(t, "slave %u:%u, flag %.32s", SLAVE(a), x->key);
		y = list_next_entry(y, list);
	}
	return false;
}

static bool config_differs(const struct ec_config *a, const struct ec_config *b,
			   const struct text *t)
{
	if (a->alias != b->alias || a->position != b->position)
		return differs(t, "slave configuration %u is %u:%u, not %u:%u", a->index,
			       SLAVE(a), SLAVE(b));
	if (a->vendor != b->vendor || a->product != b->product)
		return differs(t, "slave %u:%u is 0x%08x/0x%08x, not 0x%08x/0x%08x", SLAVE(a),
			       a->vendor, a->product, b->vendor, b->product);
	if (sms_differ(a, b, t) || startup_differs(a, b, t) || flags_differ(a, b, t))
		return true;
	if (a->overlap != b->overlap || fmmus_differ(a, b))
		return differs(t, "slave %u:%u, its place in the domains", SLAVE(a));
	if (a->sync.assign != b->sync.assign ||
	    memcmp(a->sync.period, b->sync.period, sizeof(a->sync.period)) ||
	    memcmp(a->sync.shift, b->sync.shift, sizeof(a->sync.shift)))
		return differs(t, "slave %u:%u, distributed clock", SLAVE(a));
	if (memcmp(a->timeout_ms, b->timeout_ms, sizeof(a->timeout_ms)))
		return differs(t, "slave %u:%u, time limits of its states", SLAVE(a));
	if (a->emergencies != b->emergencies)
		return differs(t, "slave %u:%u keeps %u emergencies, not %u", SLAVE(a),
			       a->emergencies, b->emergencies);
	return false;
}

static bool domain_differs(const struct ec_domain *a, const struct ec_domain *b,
			   const struct text *t)
{
	if (a->size != b->size)
		return differs(t, "domain %u has %u bytes, not %u", a->index, a->size, b->size);
	if (a->options != b->options)
		return differs(t, "domain %u has the options 0x%x, not 0x%x", a->index, a->options,
			       b->options);
	if (a->max_age != b->max_age)
		return differs(t, "domain %u has stale data after %u sends, not %u", a->index,
			       a->max_age, b->max_age);
	if (a->division != b->division || a->phase != b->phase)
		return differs(t, "domain %u goes every %u cycles (phase %u), not %u (%u)",
			       a->index, a->division, a->phase, b->division, b->phase);
	return false;
}

static bool cycle_differs(const struct ec_ioc_cycle *a, const struct ec_ioc_cycle *b,
			  const struct text *t)
{
	if (!b->period_ns)
		return differs(t, "the kernel runs its cycle");
	if (a->period_ns != b->period_ns)
		return differs(t, "the period is %u ns, not %u", a->period_ns, b->period_ns);
	return memcmp(a, b, sizeof(*a)) && differs(t, "how the kernel runs the cycle");
}

static bool session_differs(const struct ec_session *a, const struct ec_session *b,
			    const struct text *t)
{
	unsigned int i;

	if (a->wanted.n_configs != b->wanted.n_configs)
		return differs(t, "it has %u slaves, not %u", a->wanted.n_configs,
			       b->wanted.n_configs);
	for (i = 0; i < a->wanted.n_configs; i++)
		if (config_differs(a->wanted.configs[i], b->wanted.configs[i], t))
			return true;
	if (a->wanted.n_domains != b->wanted.n_domains)
		return differs(t, "it has %u domains, not %u", a->wanted.n_domains,
			       b->wanted.n_domains);
	for (i = 0; i < a->wanted.n_domains; i++)
		if (domain_differs(a->wanted.domains[i], b->wanted.domains[i], t))
			return true;
	if (a->ref_config != b->ref_config)
		return differs(t, "reference clock");
	if (a->n_specs != b->n_specs || a->request_bytes != b->request_bytes ||
	    (a->n_specs && memcmp(a->specs, b->specs, a->n_specs * sizeof(*a->specs))))
		return differs(t, "its %u SDO and register requests", a->n_specs);
	if (a->cycle.n_copies != b->cycle.n_copies)
		return differs(t, "it has %u copies, not %u", a->cycle.n_copies, b->cycle.n_copies);
	for (i = 0; i < a->cycle.n_copies; i++)
		if (memcmp(&a->cycle.copies[i], &b->cycle.copies[i], sizeof(a->cycle.copies[i])))
			return differs(t, "copy %u", i);
	return cycle_differs(&a->cycle.kernel, &b->cycle.kernel, t);
}

/*
 * How many cycles may be late is not part of what is compared: no slave gets it,
 * and nothing is laid out by it. The new application's word counts from now on.
 */
static void adopt_late(struct ec_session *s, u32 per_s)
{
	s->cycle.late_per_s = per_s;
	WRITE_ONCE(s->sessions->links->share.late_per_s, per_s);
}

/**
 * ec_session_take_over() - the heir's application gets the detached session
 * @ss: sessions of a master with a detached session and an heir
 * @why: result: the first difference of the two
 * @size: room there
 *
 * The cycle goes on, with the priority that the heir's process may use; the heir's
 * configuration is freed.
 *
 * Context: Process, session lock held. Sleeps until the next cycle has begun.
 * Return: 0; -EEXIST another configuration; -ENOSPC as for an activation;
 * -ETIMEDOUT the cycle does not run.
 */
int ec_session_take_over(struct ec_sessions *ss, char *why, size_t size)
{
	const struct text t = { .buf = why, .size = size };
	struct ec_session *s = ss->session, *heir = ss->heir;
	int ret;

	if (session_differs(s, heir, &t))
		return -EEXIST;
	if (!heir->cycle.late_per_s && ec_access_slack_ns(ss->links) < ec_cycle_need_ns())
		return -ENOSPC;
	ret = ec_cycle_thread_adopt(&s->cycle);
	if (ret)
		return ret;
	if (s->requests)
		ec_requests_describe(s);
	adopt_late(s, heir->cycle.late_per_s);
	ec_cycle_thread_inherit(&s->cycle, heir->cycle.priority);
	WRITE_ONCE(ss->heir, NULL);
	ec_session_fill_status(s);
	ec_cycle_set_owner(&s->cycle, heir->cycle.owner,
			   rcu_dereference_protected(heir->cycle.waiters,
						     lockdep_is_held(&ss->lock)));
	s->owner_pid = heir->owner_pid;
	memcpy(s->owner_comm, heir->owner_comm, sizeof(s->owner_comm));
	ec_session_free(heir);
	ec_info(ss, "detached session taken over by a new application\n");
	return 0;
}
