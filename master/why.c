// SPDX-License-Identifier: GPL-2.0-only
#include "config.h"
#include "master.h"
#include "session.h"
#include "slave.h"
#include "why.h"

/* The ring position @c names now; false: nobody has its alias. @topo is held, or it is shown. */
static bool place(const struct ec_config *c, unsigned int *pos)
{
	const struct ec_master *m = c->session->master;
	unsigned int i = 0;

	while (c->alias && i < m->n_slaves && m->slaves[i]->alias != c->alias)
		i++;
	*pos = i + c->position;
	return !c->alias || i < m->n_slaves;
}

/* Do both name the slave at @pos, which is not only where another one has been? */
static bool twice(const struct ec_config *has, unsigned int pos)
{
	unsigned int p;

	return place(has, &p) && p == pos;
}

/* Nobody is attached: who is there instead? @topo is held, or it is shown. */
static size_t absent(const struct ec_config *c, char *buf, size_t size)
{
	const struct ec_master *m = c->session->master;
	const struct ec_slave *s;
	unsigned int pos;

	if (!place(c, &pos))
		return scnprintf(buf, size, "none of the %u slave(s) on the bus has alias %u",
				 m->n_slaves, c->alias);
	if (pos >= m->n_slaves)
		return scnprintf(buf, size, "is not on the bus: there are %u slave(s), it would be number %u",
				 m->n_slaves, pos);
	s = m->slaves[pos];
	if (s->info.vendor != c->vendor || s->info.product != c->product)
		return scnprintf(buf, size, "slave %u is 0x%08x/0x%08x, configured is 0x%08x/0x%08x",
				 pos, s->info.vendor, s->info.product, c->vendor, c->product);
	if (s->config && c->session->active && !twice(s->config, pos))
		return scnprintf(buf, size, "is missing, or one in front of it: slave %u was at %u:%u on activation",
				 pos, s->config->alias, s->config->position);
	if (s->config)
		return scnprintf(buf, size, "slave %u has another configuration, %u:%u; use one of the two",
				 pos, s->config->alias, s->config->position);
	return scnprintf(buf, size, "slave %u has just appeared", pos);
}

static size_t present(const struct ec_slave *s, char *buf, size_t size)
{
	u16 status = READ_ONCE(s->al_status), code = READ_ONCE(s->al_code);
	const char *state = ec_al_state_name(status & EC_AL_STATE_MASK);
	u8 want = READ_ONCE(s->requested);

	if (s->error != EC_SLAVE_OK)
		return scnprintf(buf, size, "%s", s->why);
	if (status & EC_AL_ERROR)
		return scnprintf(buf, size, "is in %s with error 0x%04x: %s", state, code,
				 ec_al_code_text(code));
	if (want != EC_AL_OP)
		return scnprintf(buf, size, "is in %s, %s was requested", state,
				 ec_al_state_name(want));
	if (s->master->owner == EC_OWNER_IDLE)
		return scnprintf(buf, size, "is in %s; the application does not send", state);
	return scnprintf(buf, size, "is in %s, on its way to OP", state);
}

/**
 * ec_config_why() - why a configured slave is not in OP
 * @c: configuration
 * @buf: one line of text, empty when it is in OP
 * @size: of @buf
 *
 * Context: Process; with session_lock and topo held, or after ec_show_begin().
 * Return: length of the text.
 */
size_t ec_config_why(const struct ec_config *c, char *buf, size_t size)
{
	size_t len;

	lockdep_assert(lockdep_is_held(&c->session->master->topo) ||
		       atomic_read(&c->session->master->show.showing));
	buf[0] = '\0';
	if (!c->slave || c->slave->gone)
		len = absent(c, buf, size);
	else if (ec_session_config_status(c) & EC_STATUS_SC_OP)
		len = 0;
	else if (!c->session->active)
		len = scnprintf(buf, size, "is in %s; the master is not active",
				ec_al_state_name(c->slave->al_status & EC_AL_STATE_MASK));
	else
		len = present(c->slave, buf, size);
	return len;
}
