// SPDX-License-Identifier: GPL-2.0-only
/* Slaves of the list that do not reply any more; they stay in their place until they do. */
#include <linux/ktime.h>
#include "../base/once64.h"
#include "silent.h"
#include "slave.h"

/**
 * ec_slave_set_silent() - the slave does not reply to its station address
 * @s: slave
 * @why: cause, a text
 *
 * Context: The monitor thread.
 * Return: false: that was known already.
 */
bool ec_slave_set_silent(struct ec_slave *s, const char *why)
{
	if (READ_ONCE(s->reply.silent))
		return false;
	WRITE_ONCE(s->reply.silent, true);
	s->lost.seen_ns = s->bus->complete_ns ?: ktime_get_ns();
	WRITE_ONCE(s->al.status, 0);
	ec_slave_event(s, EC_EVENT_SLAVE_SILENT);
	ec_slave_fail(s, EC_SLAVE_SCAN_FAILED, EC_CAUSE(SILENT), "%s", why);
	ec_slave_retry(s, EC_PROBE_MAX_MS);
	return true;
}

/**
 * ec_slave_set_replies() - the slave replies to its station address
 * @s: slave
 *
 * Context: The monitor thread.
 * Return: false: it did before.
 */
bool ec_slave_set_replies(struct ec_slave *s)
{
	if (!READ_ONCE(s->reply.silent))
		return false;
	WRITE_ONCE(s->reply.silent, false);
	ec_slave_set_ok(s, true);
	s->reply.retry_ms = 0;
	ec_write64(&s->reply.retry_ns, 0);
	ec_slave_report(s, EC_EVENT_SLAVE_REPLIES);
	return true;
}
