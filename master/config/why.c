// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include "../base/report.h"
#include "config.h"
#include "group.h"
#include "../link/links.h"
#include "ethercat_map.h"
#include "../bus/find.h"
#include "../bus/slave.h"
#include "why.h"

#define LOG_MAX		32	/* lines per activation */
#define EVENTS_MAX	256	/* events per activation: others stay in the ring */
#define WALK		16	/* configurations to check without a pause */

/**
 * ec_config_place() - the position in the closed ring that a configuration means
 * @c: configuration
 * @place: result, also when the ring ends before it
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: false: no slave has its alias, or its place is that of its hot connect group.
 */
bool ec_config_place(const struct ec_config *c, unsigned int *place)
{
	unsigned int at;

	ec_bus_assert_stays(c->wanted->bus);
	if (c->group)
		return false;
	if (c->wanted->n_groups) {
		*place = c->place;
		return !c->alias || ec_find_place(c->wanted->bus, c->alias, c->alias_at, 0, &at);
	}
	return ec_find_place(c->wanted->bus, c->alias, c->alias_at, c->position, place);
}

/**
 * ec_config_index() - where the slave is in the list that a configuration means
 * @c: configuration
 *
 * That is its ring position, unless the ring is open and slaves are missing there.
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: index, also behind the end of the list; -ENOENT: it is absent, or as for
 * ec_config_place(); -EAGAIN: it is not certain where it is, and struct ec_wanted.certain is set.
 */
int ec_config_index(const struct ec_config *c)
{
	const struct ec_wanted *w = c->wanted;
	unsigned int place;
	int i;

	ec_bus_assert_stays(w->bus);
	if (!ec_config_place(c, &place))
		return -ENOENT;
	if (w->n_groups)
		return place <= EC_MAX_SLAVES * 2 ? (int)place : -(int)(U32_MAX - place);
	i = ec_find_index(w->bus, c->alias, c->alias_at, c->position, w->n_places);
	return i == -EAGAIN && !w->certain ? (c->alias ? c->alias_at : 0) + c->position : i;
}

/* So many slaves has the ring at least. */
static void count_places(struct ec_config *c)
{
	struct ec_wanted *w = c->wanted;
	unsigned int place = c->position;

	lockdep_assert_held(w->lock);
	if (c->group || (c->alias && (w->n_groups || !ec_config_place(c, &place))))
		return;
	w->n_places = max(w->n_places, place + 1);
}

/**
 * ec_config_locate() - look for the slaves by which the place of a configuration is known
 * @c: configuration
 *
 * These are the slave that has its alias, and the one behind which its lost slave was. Called
 * for a new configuration, and when slaves were connected or disconnected: readers of a
 * configuration must not search all slaves.
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_config_locate(struct ec_config *c)
{
	struct ec_bus *bus = c->wanted->bus;
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	if (!c->alias)
		count_places(c);
	if (!c->alias && !c->lost.text[0] && !c->wanted->n_groups)
		return;
	down_read(&bus->topo);
	if (c->wanted->n_groups)
		c->place = ec_groups_place(c->wanted, c->alias, c->position, &c->alias_at);
	else if (c->alias)
		c->alias_at = ec_find_alias(bus, c->alias);
	if (c->alias)
		count_places(c);
	for (i = 0; c->lost.text[0] && i < bus->n_slaves &&
	     bus->slaves[i]->station != c->lost.at.station; i++)
		;
	c->lost.up_at = i;
	up_read(&bus->topo);
}

/* Behind which port of which slave the lost one was; it may be lost as well by now. */
static struct ec_cause lost_at(const struct ec_config *c)
{
	const struct ec_bus *bus = c->wanted->bus;
	u32 up = c->lost.up_at;

	ec_bus_assert_stays(bus);
	if (up >= bus->n_slaves || bus->slaves[up]->station != c->lost.at.station)
		up = EC_UAPI_NONE16;
	return *EC_CAUSE(LOST, .position = up, .port = c->lost.at.port);
}

/* Do both name the slave at @pos, which is not only where another one has been? */
static bool twice(const struct ec_config *has, unsigned int pos)
{
	return ec_config_index(has) == (int)pos;
}

/* Without device or link there is no slave at all. */
static size_t no_link(struct ec_links *l, char *buf, size_t size, struct ec_cause *cause)
{
	char name[EC_UAPI_STRING];

	if (ec_links_any_up(l))
		return 0;
	*cause = *EC_CAUSE(NO_DEVICE);
	if (!ec_links_any_device(l))
		return scnprintf(buf, size, "no network device: master %u waits for %s",
				 l->base->index, ec_links_name(l, 0, name, sizeof(name)));
	*cause = *EC_CAUSE(LINK_DOWN);
	return scnprintf(buf, size, "link down: check the cable at the main device of master %u",
			 l->base->index);
}

/* The whole group is connected, or none of its slaves is used. */
static size_t group_absent(const struct ec_group *g, char *buf, size_t size,
			   struct ec_cause *cause)
{
	*cause = *EC_CAUSE(UNATTACHED, .position = g->position);
	if (g->cause == EC_CAUSE_NONE)
		return scnprintf(buf, size, "group %s is not attached yet", g->name);
	*cause = (struct ec_cause){ .kind = g->cause, .position = g->position };
	return scnprintf(buf, size, "%sgroup %s: %s", g->mandatory ? "" : "optional ", g->name,
			 g->why);
}

/* No slave is attached: which one is at this position instead? @topo is held, or it is shown. */
static size_t absent(const struct ec_config *c, char *buf, size_t size, struct ec_cause *cause)
{
	const struct ec_bus *bus = c->wanted->bus;
	const struct ec_config *has;
	char why[EC_UAPI_REASON];
	struct ec_slave *s;
	unsigned int place;
	int pos;
	size_t len = no_link(c->wanted->links, buf, size, cause);

	ec_bus_assert_stays(c->wanted->bus);
	if (len)
		return len;
	if (c->group)
		return group_absent(c->group, buf, size, cause);
	*cause = lost_at(c);
	if (c->wanted->active && c->lost.text[0])
		return scnprintf(buf, size, "%s, last seen %llu s ago", c->lost.text,
				 div_u64(ktime_get_ns() - c->lost.seen_ns, NSEC_PER_SEC));
	*cause = *EC_CAUSE(NO_ALIAS);
	if (!ec_config_place(c, &place))
		return scnprintf(buf, size, "none of the %u slave(s) on the bus has alias %u",
				 bus->n_slaves, c->alias);
	pos = ec_config_index(c);
	/* between groups it is a place of the list, or there is none */
	if (pos < 0 && c->wanted->n_groups)
		place = c->position;
	*cause = *EC_CAUSE(RING, .position = min_t(u32, place, EC_UAPI_NONE16));
	if (pos == -EAGAIN)
		return scnprintf(buf, size,
				 "ring position %u not certain: the ring is open, and a slave may be missing there (%u connected); close the ring once, configure all slaves, or use an alias",
				 place, bus->n_slaves);
	cause->kind = EC_CAUSE_NO_SLAVE;
	if (pos < 0 || pos >= bus->n_slaves)
		return scnprintf(buf, size, "no slave at ring position %u: %u slave(s) connected",
				 place, bus->n_slaves);
	s = bus->slaves[pos];
	ec_slave_cause(s, cause);
	cause->position = pos;
	if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED)
		return scnprintf(buf, size, "slave %d could not be read: %.160s", pos,
				 ec_slave_why(s, why, sizeof(why)));
	*cause = *EC_CAUSE(DIFFERENT, .position = pos);
	if (s->info.vendor != c->vendor || s->info.product != c->product)
		return scnprintf(buf, size,
				 "slave %d is 0x%08x/0x%08x, configured is 0x%08x/0x%08x",
				 pos, s->info.vendor, s->info.product, c->vendor, c->product);
	has = ec_config_of(s);
	*cause = *EC_CAUSE(TAKEN, .position = pos, .code = has ? has->index : 0);
	if (has && c->wanted->active && !twice(has, pos))
		return scnprintf(buf, size,
				 "no slave: position %d holds the slave attached to %s; this slave or one upstream is disconnected",
				 pos, has->name);
	if (has)
		return scnprintf(buf, size,
				 "slave %d has another configuration, %s; use one of the two",
				 pos, has->name);
	*cause = *EC_CAUSE(UNATTACHED, .position = pos);
	return scnprintf(buf, size, "slave %d matches and is not attached yet", pos);
}

static size_t present(struct ec_slave *s, char *buf, size_t size, struct ec_cause *cause)
{
	u16 status = READ_ONCE(s->al.status), code = READ_ONCE(s->al.code);
	const char *state = ec_al_state_name(status & EC_AL_STATE_MASK);
	u8 want = READ_ONCE(s->al.requested);
	const char *doing = READ_ONCE(ec_setup_of(s)->waits_for);
	bool cyclic = ec_access_runs(&s->bus->links->access);

	ec_slave_cause(s, cause);
	if (READ_ONCE(s->note.error) != EC_SLAVE_OK)
		return strlen(ec_slave_why(s, buf, size));
	*cause = *EC_CAUSE(AL_ERROR, .state = status & EC_AL_STATE_MASK, .code = code);
	/* without a cycle an expired watchdog is what follows from it */
	if (status & EC_AL_ERROR && (cyclic || code != EC_AL_CODE_SM_WATCHDOG))
		return scnprintf(buf, size, "AL state %s with error, AL status code 0x%04x (%s)",
				 state, code,
				 ec_al_code_text(code));
	*cause = *EC_CAUSE(REQUESTED, .state = want);
	if (want != EC_AL_OP)
		return scnprintf(buf, size, "AL state %s, requested %s", state,
				 ec_al_state_name(want));
	*cause = *EC_CAUSE(NO_CYCLE);
	if (!cyclic)
		return scnprintf(buf, size,
				 "AL state %s; cycle timeout: the application sends no cyclic frames", state);
	*cause = *EC_CAUSE(UNDER_WAY);
	if (doing)
		return scnprintf(buf, size, "AL state %s on the way to OP, waiting for %s", state,
				 doing);
	return scnprintf(buf, size, "AL state %s on the way to OP", state);
}

/* The revision is no part of the identity. It is checked when the application sets the flag. */
static bool other_revision(const struct ec_config *c, const struct ec_slave *s)
{
	u32 expected = ec_config_flag(c, EC_FLAG_REVISION);

	ec_wanted_assert_stays(c->wanted);
	return expected && expected != s->info.revision;
}

/**
 * ec_config_at() - find the configuration that a slave has or differs from
 * @w: what an application configures
 * @slave: slave
 * @from: number of the first configuration to check, initially 0; set behind the last one
 *	checked
 *
 * Checks some configurations only, as a section of a reader is short.
 *
 * Context: After ec_show_begin().
 * Return: the one that is attached; else one without slave that means its place; or NULL:
 * call again until @from is the number of configurations.
 */
const struct ec_config *ec_config_at(const struct ec_wanted *w, const struct ec_slave *slave,
				     unsigned int *from)
{
	const struct ec_config *has = ec_config_of(slave);
	unsigned int end = min(w->n_configs, *from + WALK);

	ec_wanted_assert_stays(w);
	if (has && has->wanted == w)
		return has;
	while (*from < end) {
		const struct ec_config *c = w->configs[(*from)++];

		if (!c->slave && ec_config_index(c) == slave->position)
			return c;
	}
	return NULL;
}

/**
 * ec_config_differs() - is a slave another one than a configuration expects?
 * @c: what ec_config_at() found
 * @slave: for that slave
 *
 * Context: Process; with lock of the configuration held, or after ec_show_begin().
 * Return: true: identity or revision differ.
 */
bool ec_config_differs(const struct ec_config *c, const struct ec_slave *slave)
{
	ec_wanted_assert_stays(c->wanted);
	return c->slave != slave || other_revision(c, slave);
}

/**
 * ec_config_revision_text() - how the revision of a slave differs from the expected one
 * @c: what ec_config_at() found
 * @slave: for that slave
 * @buf: one line of text, untouched when the revision does not differ
 * @size: of @buf
 *
 * Context: Process; with lock of the configuration held, or after ec_show_begin().
 * Return: whether it differs.
 */
bool ec_config_revision_text(const struct ec_config *c, const struct ec_slave *slave, char *buf,
			     size_t size)
{
	ec_wanted_assert_stays(c->wanted);
	if (c->slave != slave || !other_revision(c, slave))
		return false;
	scnprintf(buf, size, "slave %u has revision 0x%08x, expected 0x%08x", slave->position,
		  slave->info.revision, (u32)ec_config_flag(c, EC_FLAG_REVISION));
	return true;
}

/* A link that is down, or an absent device, is an event of its own. */
static void report_absent(const struct ec_config *c, bool line)
{
	char text[EC_UAPI_REASON];
	const struct ec_event_more more = { .detail = text };
	const struct ec_wanted *w = c->wanted;
	const struct ec_slave *s = NULL;
	struct ec_event e;
	struct ec_cause cause;

	ec_bus_assert_stays(w->bus);
	absent(c, text, sizeof(text), &cause);
	if (cause.kind != EC_CAUSE_NO_ALIAS && cause.position < w->bus->n_slaves)
		s = w->bus->slaves[cause.position];
	e = (struct ec_event){
		.kind = EC_EVENT_CONFIG, .slave = s ? cause.position : EC_EVENT_NO_SLAVE,
		.arg = { c->alias, c->position, cause.kind, c->vendor, c->product,
			 s ? s->info.vendor : 0, s ? s->info.product : 0 },
	};
	if (cause.kind != EC_CAUSE_NO_DEVICE && cause.kind != EC_CAUSE_LINK_DOWN)
		ec_events_put(&w->base->events, e.kind, e.slave, e.arg);
	if (line)
		ec_report_print(w->base, &e, &more);
}

static void report_difference(const struct ec_config *c, bool line)
{
	u32 expected = ec_config_flag(c, EC_FLAG_REVISION);

	down_read(&c->wanted->bus->topo);
	if (!c->slave)
		report_absent(c, line);
	else if (line)
		ec_slave_report(c->slave, EC_EVENT_REVISION, expected, c->slave->info.revision);
	else
		ec_slave_event(c->slave, EC_EVENT_REVISION, expected, c->slave->info.revision);
	up_read(&c->wanted->bus->topo);
}

/**
 * ec_config_log_differences() - report what is missing or different
 * @w: of a session that has just been activated
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_config_log_differences(const struct ec_wanted *w)
{
	unsigned int n = 0;

	lockdep_assert_held(w->lock);
	ec_for_each_config(c, w) {
		if (c->slave ? !other_revision(c, c->slave) : !!c->group)
			continue;
		if (n < EVENTS_MAX)
			report_difference(c, n < LOG_MAX);
		n++;
	}
	if (n > EVENTS_MAX)
		ec_event(w->base, EC_EVENT_CONFIGS, n - EVENTS_MAX);
	if (n > LOG_MAX)
		ec_warn(w, "%u more configurations differ from the bus; see 'ethercat config -v'\n",
			n - LOG_MAX);
}

/**
 * ec_config_status() - EC_STATUS_SC_* of a configuration
 * @c: configuration
 *
 * Context: Process, lock of the configuration held or after ec_show_begin().
 * Return: AL state with the bits online and operational; 0 without slave.
 */
u8 ec_config_status(const struct ec_config *c)
{
	const struct ec_slave *slave = c->slave;
	u16 status;
	u8 v;

	ec_wanted_assert_stays(c->wanted);
	if (!slave || READ_ONCE(slave->stop.gone) || READ_ONCE(slave->reply.silent))
		return 0;
	/* the monitor and the worker of the slave change them at any time */
	status = READ_ONCE(slave->al.status);
	v = (status & EC_STATUS_SC_AL) | EC_STATUS_SC_ONLINE;
	if ((status & (EC_AL_STATE_MASK | EC_AL_ERROR)) == EC_AL_OP &&
	    !READ_ONCE(slave->work.reconfigure))
		v |= EC_STATUS_SC_OP;
	return v;
}

/**
 * ec_config_why() - why a configured slave is not in OP
 * @c: configuration
 * @buf: one line of text, empty when it is in OP
 * @size: of @buf
 * @cause: result: the same for programs
 *
 * Context: Process; with lock of the configuration and topo held, or after ec_show_begin().
 * Return: length of the text.
 */
size_t ec_config_why(const struct ec_config *c, char *buf, size_t size, struct ec_cause *cause)
{
	ec_wanted_assert_stays(c->wanted);
	ec_bus_assert_stays(c->wanted->bus);
	buf[0] = '\0';
	if (!c->slave || READ_ONCE(c->slave->stop.gone))
		return absent(c, buf, size, cause);
	*cause = *EC_CAUSE(NONE);
	if (ec_config_status(c) & EC_STATUS_SC_OP)
		return 0;
	if (c->wanted->active)
		return present(c->slave, buf, size, cause);
	*cause = *EC_CAUSE(INACTIVE);
	return scnprintf(buf, size, "AL state %s; the master is not active",
			 ec_al_state_name(READ_ONCE(c->slave->al.status) & EC_AL_STATE_MASK));
}
