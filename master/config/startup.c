// SPDX-License-Identifier: GPL-2.0-only
#include <linux/err.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "config.h"
#include "startup.h"
#include "../base/limits.h"
#include "../bus/result.h"
#include "../bus/slave_ip.h"
#include "../carry/xfer.h"
#include "../mailbox/coe.h"
#include "../mailbox/mailbox.h"
#include "../mailbox/soe.h"
#include "../wire/coe.h"
#include "../wire/soe.h"

#define AGAIN_MS	2	/* between two reads */

/**
 * struct startup_reply - what a slave has answered to a command
 * @code: its own error number, 0: none
 * @got: first bytes that were read
 * @n: how many
 */
struct startup_reply {
	u32 code;
	u8 got[8];
	u8 n;
};

/* By type; registers by address, so that equal settings make equal lists. */
static bool comes_before(const struct ec_startup *a, const struct ec_startup *b)
{
	if (a->type != b->type)
		return a->type < b->type;
	return a->type == EC_STARTUP_REG && a->index < b->index;
}

/**
 * ec_startup_add() - add a command to a configuration
 * @c: configuration
 * @what: type, transition, index, sub, complete, and size of @data
 * @data: its value
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: the command; ERR_PTR: -ENOSPC beyond the limit of its type, -ENOMEM, -EDQUOT as
 * ec_budget_charge().
 */
struct ec_startup *ec_startup_add(struct ec_config *c, const struct ec_startup *what,
				  const void *data)
{
	static const u16 limit[EC_STARTUP_TYPES] = {
		EC_MAX_SC_SDOS, EC_MAX_SC_IDNS, EC_MAX_SC_COMMANDS, 1, EC_MAX_SC_REGS,
	};
	struct ec_startup *u, *before;

	lockdep_assert_held(c->wanted->lock);
	if (c->n_startup[what->type] >= limit[what->type])
		return ERR_PTR(-ENOSPC);
	u = ec_config_alloc(c->wanted, struct_size(u, data, what->size));
	if (IS_ERR(u))
		return u;
	*u = *what;
	memcpy(u->data, data, what->size);
	list_for_each_entry_reverse(before, &c->startup, list)
		if (!comes_before(u, before))
			break;
	list_add(&u->list, &before->list);
	c->n_startup[u->type]++;
	return u;
}

/**
 * ec_startup_find() - find IP parameters or a register write
 * @c: configuration
 * @type: EC_STARTUP_IP or EC_STARTUP_REG: there are few, at the end of the list
 * @index: register
 *
 * Context: Process, lock of the session held or in a show section.
 * Return: command, or NULL.
 */
struct ec_startup *ec_startup_find(const struct ec_config *c, u8 type, u16 index)
{
	struct ec_startup *u;

	ec_wanted_assert_stays(c->wanted);
	list_for_each_entry_reverse(u, &c->startup, list) {
		if (u->type < EC_STARTUP_IP)
			break;
		if (u->type == type && u->index == index)
			return u;
	}
	return NULL;
}

/**
 * ec_startup_del() - remove a command
 * @c: its configuration
 * @u: command
 *
 * Context: Process, lock of the session held.
 */
void ec_startup_del(struct ec_config *c, struct ec_startup *u)
{
	lockdep_assert_held(c->wanted->lock);
	list_del(&u->list);
	c->n_startup[u->type]--;
	ec_budget_release(&c->wanted->budget, struct_size(u, data, u->size));
	kvfree(u);
}

/* May a SDO for @index change the PDOs of a SyncManager? */
static bool changes(u16 index, unsigned int sm, const struct ec_pdo_list *a,
		    const struct ec_pdo_list *b)
{
	return index == EC_PDO_ASSIGN + sm || index == EC_PDO_MODULES ||
	       (ec_pdo_is_mapping(index) && (ec_pdo_find(a, index) || ec_pdo_find(b, index)));
}

/**
 * ec_startup_changes() - the startup SDO that may change the PDOs of a SyncManager
 * @c: configuration
 * @s: its slave
 * @sm: SyncManager
 *
 * Context: The slave's worker.
 * Return: the last one, or NULL.
 */
const struct ec_startup *ec_startup_changes(const struct ec_config *c, const struct ec_slave *s,
					    unsigned int sm)
{
	const struct ec_startup *u, *last = NULL;

	lockdep_assert_held(&s->lock);
	list_for_each_entry(u, &c->startup, list)
		if (u->type == EC_STARTUP_SDO &&
		    changes(u->index, sm, &c->sm[sm].pdos, &s->pdos.sm[sm]))
			last = u;
	return last;
}

/* the protocol of a command */
static u8 protocol(const struct ec_startup *u)
{
	return u->type == EC_STARTUP_COMMAND ? u->kind : u->type;
}

static int put(struct ec_slave *s, const struct ec_startup *u, u32 size, u32 *code)
{
	/* a slave that goes through INIT instead would only begin again to store it */
	static const struct ec_mbox_limit limit = { .patient = true };
	u16 error = 0;
	int ret;

	switch (protocol(u)) {
	case EC_STARTUP_SDO:
		return ec_coe_download(&s->mbox, u->index, u->sub, u->complete, u->data, size,
				       code, &limit);
	case EC_STARTUP_IDN:
		ret = ec_soe_write(&s->mbox, u->sub, u->index, u->data, size, &error,
				   &limit);
		break;
	case EC_STARTUP_IP:
		ret = ec_slave_give_ip(s, (const void *)u->data, &error);
		break;
	default:
		return ec_xfer_fpwr(s->bus->links, s->station, u->index, u->data, size);
	}
	*code = error;
	return ret;
}

/* Read as many bytes as are expected; -EBADE: the value has another length. */
static int fetch(struct ec_slave *s, const struct ec_startup *u, u8 *to, u32 n, u32 *code)
{
	static const struct ec_mbox_limit limit = { .patient = true };
	size_t got = n;
	u16 error = 0;
	int ret;

	switch (u->kind) {
	case EC_STARTUP_SDO:
		ret = ec_coe_upload(&s->mbox, u->index, u->sub, u->complete, to, n, &got, code,
				    &limit);
		break;
	case EC_STARTUP_IDN:
		ret = ec_soe_read(&s->mbox, u->sub, u->index, to, n, &got, &error, &limit);
		*code = error;
		break;
	default:
		return ec_xfer_fprd(s->bus->links, s->station, u->index, to, n);
	}
	return ret == -ENOBUFS || (!ret && got != n) ? -EBADE : ret;
}

static bool startup_same(const u8 *got, const u8 *expect, const u8 *mask, u32 n)
{
	u32 i;

	for (i = 0; i < n; i++)
		if ((got[i] ^ expect[i]) & mask[i])
			return false;
	return true;
}

/* Read until the value is as expected, within the time limit; -EBADE: it was not. */
static int startup_check(struct ec_slave *s, const struct ec_startup *u, struct startup_reply *r)
{
	u64 until = ktime_get_ns() + (u64)u->timeout_ms * NSEC_PER_MSEC;
	u32 n = ec_startup_bytes(u);
	const u8 *expect = u->data + (u->how & EC_STARTUP_WRITES ? n : 0);
	u8 *got = kvmalloc(n, GFP_KERNEL);
	int ret;

	lockdep_assert_held(&s->lock);
	if (!got)
		return -ENOMEM;
	for (;;) {
		r->code = 0;
		ret = fetch(s, u, got, n, &r->code);
		if (!ret && !startup_same(got, expect, expect + n, n)) {
			r->n = min_t(u32, n, sizeof(r->got));
			memcpy(r->got, got, r->n);
			ret = -EBADE;
		}
		if (!ret || ret == -ECANCELED || ret == -EINTR || ktime_get_ns() >= until)
			break;
		if (wait_event_idle_timeout(s->stop.wake, ec_stop_worker(&s->stop),
					    msecs_to_jiffies(AGAIN_MS) + 1)) {
			ret = -ECANCELED;
			break;
		}
	}
	kvfree(got);
	return ret;
}

/* What a command does. */
static int startup_run(struct ec_slave *s, const struct ec_startup *u, struct startup_reply *r)
{
	int ret = 0;

	if (u->type != EC_STARTUP_COMMAND)
		return put(s, u, u->size, &r->code);
	if (u->how & EC_STARTUP_WRITES)
		ret = put(s, u, ec_startup_bytes(u), &r->code);
	if (!ret && u->how & EC_STARTUP_CHECKS)
		ret = startup_check(s, u, r);
	return ret;
}

static void why(char *text, size_t size, const struct ec_startup *u, int ret,
		const struct startup_reply *r)
{
	u8 type = protocol(u);
	bool sdo = type == EC_STARTUP_SDO;

	if (ret == -EBADE && r->n)
		scnprintf(text, size, "it reads %*ph, not as expected within %u ms", r->n, r->got,
			  u->timeout_ms);
	else if (ret == -EBADE)
		scnprintf(text, size, "it has another length than expected");
	else if (type == EC_STARTUP_REG && ret != -EIO && ret != -ETIMEDOUT)
		scnprintf(text, size, "transfer failed (%pe)", ERR_PTR(ret));
	else if (ret == -EIO && r->code)
		scnprintf(text, size, sdo ? "abort 0x%08x: %s" : "SoE error 0x%04x: %s", r->code,
			  (sdo ? ec_coe_abort_text(r->code) : ec_soe_error_text(r->code)) ?:
			  "unknown code");
	else
		ec_mbox_fail_text(ret, sdo ? "CoE" : type == EC_STARTUP_IDN ? "SoE" : "EoE",
				  text, size);
}

/* What failed, for a message: "startup", "replayed", "PREOP to SAFEOP command". */
static void kind_text(char *text, size_t size, const struct ec_startup *u)
{
	if (u->type == EC_STARTUP_COMMAND)
		scnprintf(text, size, "%s to %s command",
			  ec_al_state_name(EC_TRANSITION_FROM(u->transition)),
			  ec_al_state_name(EC_TRANSITION_TO(u->transition)));
	else
		strscpy(text, u->write ? "replayed" : "startup", size);
}

static struct ec_result startup_failed(struct ec_slave *s, const struct ec_startup *u, int ret,
				       const struct startup_reply *r)
{
	int err = r->code ? -EREMOTEIO : ret == -EBADE ? -EREMOTEIO : ret;
	u32 bytes = u->type == EC_STARTUP_COMMAND ? ec_startup_bytes(u) : u->size;
	char name[12], text[96], what[32];
	u32 code = r->code;

	why(text, sizeof(text), u, ret, r);
	kind_text(what, sizeof(what), u);
	switch (protocol(u)) {
	case EC_STARTUP_SDO:
		return ec_result_fail(s, err, EC_CAUSE(SDO, .object = u->index, .subindex = u->sub,
						       .code = code),
				      "%s SDO 0x%04x:%02x (%u byte(s)) failed: %s", what,
				      u->index, u->sub, bytes, text);
	case EC_STARTUP_IDN:
		return ec_result_fail(s, err, EC_CAUSE(IDN, .object = u->index, .subindex = u->sub,
						       .code = code),
				      "%s IDN %s of drive %u (%u byte(s)) failed: %s", what,
				      ec_soe_idn_text(u->index, name), u->sub, bytes, text);
	case EC_STARTUP_REG:
		return ec_result_fail(s, err, EC_CAUSE(REGISTER, .object = u->index),
				      "%s register 0x%04x failed: %s", what, u->index, text);
	}
	if (ret == -EREMOTEIO)
		return ec_result_fail(s, err, EC_CAUSE(IP, .code = code),
				      "IP parameters refused: EoE result 0x%04x (%s)", code,
				      ec_eoe_result_text(code));
	if (ret == -EPROTONOSUPPORT)
		return ec_result_fail(s, err, EC_CAUSE(IP),
				      "IP parameters configured, but the slave has no EoE; remove ecrt_slave_config_eoe_*()");
	return ec_result_fail(s, err, EC_CAUSE(IP), "IP parameters failed: %s", text);
}

/**
 * ec_startup_write() - run one command
 * @s: slave
 * @u: command
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: as ec_startup_run().
 */
struct ec_result ec_startup_write(struct ec_slave *s, const struct ec_startup *u)
{
	struct startup_reply reply = { 0 };
	int ret = startup_run(s, u, &reply);

	lockdep_assert_held(&s->lock);
	if (ret && ret != -ECANCELED && ret != -EINTR)
		return startup_failed(s, u, ret, &reply);
	return EC_RESULT(ret);
}

/**
 * ec_startup_has() - has a transition commands?
 * @s: slave
 * @c: its active configuration
 * @transition: EC_TRANSITION()
 *
 * Context: The slave's worker.
 * Return: whether it has.
 */
bool ec_startup_has(const struct ec_slave *s, const struct ec_config *c, u8 transition)
{
	const struct ec_startup *u;

	/* the session changes c->slave without this lock */
	lockdep_assert_held(&s->lock);
	list_for_each_entry(u, &c->startup, list)
		if (u->transition == transition)
			return true;
	return false;
}

/**
 * ec_startup_leaves() - has a state commands for steps down?
 * @s: slave with @c as its active configuration, or NULL with the lock of the session held
 * @c: configuration
 * @from: AL state where they begin
 * @to: the lowest one where they end
 *
 * Context: The slave's worker, or process with the lock of the session held.
 * Return: whether it has.
 */
bool ec_startup_leaves(const struct ec_slave *s, const struct ec_config *c, u8 from, u8 to)
{
	const struct ec_startup *u;

	lockdep_assert(lockdep_is_held(s ? &s->lock : c->wanted->lock));
	list_for_each_entry(u, &c->startup, list)
		if (EC_TRANSITION_FROM(u->transition) == from &&
		    EC_TRANSITION_TO(u->transition) < from &&
		    EC_TRANSITION_TO(u->transition) >= to)
			return true;
	return false;
}

/**
 * ec_startup_run() - run the commands of a transition
 * @s: slave, in the state where it begins
 * @c: configuration
 * @transition: EC_TRANSITION()
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0; -ECANCELED, -EINTR; else an error, reported: -EREMOTEIO when the slave refused a
 * command with an error number, or as its protocol has it.
 */
struct ec_result ec_startup_run(struct ec_slave *s, const struct ec_config *c, u8 transition)
{
	struct ec_result r = { 0 };
	const struct ec_startup *u;

	lockdep_assert_held(&s->lock);
	list_for_each_entry(u, &c->startup, list) {
		if (u->transition != transition)
			continue;
		r = ec_startup_write(s, u);
		if (r.err)
			break;
	}
	return r;
}
