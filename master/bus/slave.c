// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../base/once64.h"
#include "../base/report.h"
#include "../carry/carry.h"
#include "../kernel/trace.h"
#include "slave.h"
#include "slave_mbox.h"
#include "slave_pdo.h"

#define EXT_ALIGN	__alignof__(unsigned long long)	/* of parts of higher layers */

static void run_job(struct ec_job *job)
{
	struct ec_slave *s = container_of(job, struct ec_slave, work.job);

	if (s->bus->ops && s->bus->ops->configure)
		s->bus->ops->configure(s);
}

static void end_job(struct ec_job *job)
{
	struct ec_slave *s = container_of(job, struct ec_slave, work.job);

	atomic_dec_return_release(&s->work.runs);
	ec_slave_changed(s);
	ec_bus_settled(s->bus);
	ec_slave_unref(s);
}

/**
 * ec_slave_alloc() - a slave found by the scan
 * @bus: bus
 * @station: its station address
 *
 * Context: Process. May sleep.
 * Return: slave with one reference, or NULL.
 */
struct ec_slave *ec_slave_alloc(struct ec_bus *bus, u16 station)
{
	const size_t *bytes = bus->slave_bytes;
	size_t size = ALIGN(sizeof(struct ec_slave), EXT_ALIGN);
	struct ec_slave *s;
	unsigned int x;

	for (x = 0; x < EC_N_EXT; x++)
		size += ALIGN(bytes[x], EXT_ALIGN);
	s = kzalloc(size, GFP_KERNEL);
	if (!s)
		return NULL;
	/* in one piece: a slave without these parts cannot be, and all end together */
	for (x = EC_N_EXT; x-- > 0;) {
		size -= ALIGN(bytes[x], EXT_ALIGN);
		s->ext[x] = (u8 *)s + size;
	}
	kref_init(&s->kref);
	s->bus = bus;
	s->station = station;
	s->al.requested = EC_AL_PREOP;
	s->work.job.run = run_job;
	s->work.job.end = end_job;
	mutex_init(&s->lock);
	raw_spin_lock_init(&s->note.lock);
	ec_stop_init(&s->stop, bus->base);
	s->mbox.base = bus->base;
	s->mbox.box.links = bus->links;
	s->mbox.stop = &s->stop;
	s->mbox.box.sii = &s->info;
	s->mbox.box.al_status = &s->al.status;
	s->mbox.changes = &bus->changes;
	s->mbox.position = &s->position;
	s->mbox.box.station = station;
	ec_mbox_init(&s->mbox);
	ec_dict_init(&s->dict);
	return s;
}

static void slave_release(struct kref *kref)
{
	struct ec_slave *s = container_of(kref, struct ec_slave, kref);
	unsigned int i;

	for (i = 0; i < EC_MAX_SM; i++)
		ec_pdo_list_clear(&s->pdos.sm[i]);
	ec_pdo_list_clear(&s->pdos.free);
	ec_names_free(s);
	ec_dict_forget(&s->dict);
	ec_mbox_exit(&s->mbox);
	atomic_long_sub(s->eeprom.counted, &s->bus->sii_bytes);
	kvfree(s->eeprom.data);
	kvfree(s->eeprom.part);
	kfree(s->lines);
	kfree(s);
}

struct ec_slave *ec_slave_ref(struct ec_slave *slave)
{
	kref_get(&slave->kref);
	return slave;
}

/* @slave may be NULL. */
void ec_slave_unref(struct ec_slave *slave)
{
	if (slave)
		kref_put(&slave->kref, slave_release);
}

static void string(struct ec_slave *s, u8 index, char *buf)
{
	if (!index ||
	    ec_sii_string(s->eeprom.data, s->eeprom.bytes, index, buf, EC_UAPI_STRING) < 0)
		buf[0] = '\0';
}

/* What is wrong with the EEPROM; the slave is used as far as it goes. */
static void check_sii(struct ec_slave *s)
{
	size_t size = sizeof(s->note.sii_flaw);
	const struct ec_sii_flaw *f = &s->eeprom.flaw;

	s->note.sii_flaw[0] = '\0';
	switch (f->kind) {
	case EC_SII_FLAW_NONE:
		if (s->info.checksum_ok)
			return;
		scnprintf(s->note.sii_flaw, size,
			  "EEPROM checksum 0x%02x, expected 0x%02x; content used anyway",
			  s->info.checksum, s->info.checksum_calc);
		break;
	case EC_SII_FLAW_BLANK:
		scnprintf(s->note.sii_flaw, size,
			  "EEPROM is blank (only 0x%02x): no identity, no mailbox; write an image",
			  f->type);
		/* all ones are no mailbox either */
		s->info.protocols = 0;
		memset(&s->info.std, 0, sizeof(s->info.std));
		s->emulation = false;
		break;
	case EC_SII_FLAW_LARGE:
		scnprintf(s->note.sii_flaw, size,
			  "EEPROM: category 0x%04x at word 0x%04zx has %zu bytes, the EEPROM has %zu; data from there on are not used",
			  f->type, f->offset / 2, f->bytes, f->declared);
		break;
	case EC_SII_FLAW_NO_END:
		scnprintf(s->note.sii_flaw, size,
			  "EEPROM: no end marker up to word 0x%04zx; data from there on are not used",
			  f->end / 2);
		break;
	case EC_SII_FLAW_BEYOND:
		scnprintf(s->note.sii_flaw, size,
			  "EEPROM: categories end at byte %zu, beyond the declared size of %zu (word 0x003e); all are used",
			  f->end, f->declared);
		break;
	case EC_SII_FLAW_ENTRY:
		scnprintf(s->note.sii_flaw, size,
			  "EEPROM: an entry of category 0x%04x at word 0x%04zx is longer than the category",
			  f->type, f->offset / 2);
		break;
	}
}

/**
 * ec_slave_parse_sii() - take what the master needs from the EEPROM image
 * @slave: slave with @sii, @sii_bytes set
 *
 * Context: Process. May sleep.
 * Return: 0, -ENOMEM; -EBADMSG when the fixed area is missing, -ENOSPC a PDO is too large.
 */
int ec_slave_parse_sii(struct ec_slave *slave)
{
	int ret = ec_sii_decode_info(slave->eeprom.data, slave->eeprom.bytes, &slave->info);

	if (ret)
		return ret;
	slave->emulation = slave->info.pdi_control & EC_SII_PDI_EMULATION;
	slave->alias = slave->info.alias;
	check_sii(slave);
	slave->has_general = !ec_sii_decode_general(slave->eeprom.data, slave->eeprom.bytes,
						    &slave->general);
	if (slave->has_general) {
		string(slave, slave->general.group, slave->group);
		string(slave, slave->general.image, slave->image);
		string(slave, slave->general.order, slave->order);
		string(slave, slave->general.name, slave->name);
	}
	slave->mbox.box.can_repeat = slave->has_general &&
				     slave->general.flags & EC_SII_FLAG_MBOX_DLL;
	ret = ec_sii_decode_sms(slave->eeprom.data, slave->eeprom.bytes, slave->sms, EC_MAX_SM);
	slave->n_sms = ret > 0 ? min_t(unsigned int, ret, EC_MAX_SM) : 0;
	ec_slave_settle_mbox(slave);
	return ec_slave_read_pdos(slave);
}

static void report_failure(struct ec_slave *slave, const char *text, u8 error,
			   const struct ec_cause *cause)
{
	const struct ec_event_more more = { .detail = text };

	ec_pending_before(slave);
	ec_report_more(slave->bus->base, EC_EVENT_SLAVE_FAILED, slave->position, &more, error,
		       READ_ONCE(slave->al.code), cause->kind, cause->code, cause->object,
		       cause->subindex, cause->sm, cause->state);
}

/**
 * ec_slave_fail() - note why a slave could not be scanned or configured
 * @slave: slave
 * @error: EC_SLAVE_SCAN_FAILED or EC_SLAVE_CONFIG_FAILED
 * @cause: the same for programs, see EC_CAUSE()
 * @fmt: text: what was expected, what found, what to do
 *
 * The same cause is logged once; that of a slave which is not in the list yet when it comes there,
 * since the scan may be thrown away.
 *
 * Context: Process. May sleep.
 */
void ec_slave_fail(struct ec_slave *slave, u8 error, const struct ec_cause *cause,
		   const char *fmt, ...)
{
	char text[EC_UAPI_REASON];
	va_list args;
	int other = 0;

	va_start(args, fmt);
	vscnprintf(text, sizeof(text), fmt, args);
	va_end(args);
	raw_spin_lock(&slave->note.lock);
	/* a worker that has not ended yet: what it meets is no cause of its own */
	if (slave->note.error != EC_SLAVE_SCAN_FAILED || error != EC_SLAVE_CONFIG_FAILED) {
		WRITE_ONCE(slave->note.error, error);
		other = strcmp(slave->note.why, text);
		slave->note.cause = *cause;
		if (other)
			strscpy(slave->note.why, text, sizeof(slave->note.why));
	}
	slave->note.unreported |= other && !slave->note.listed;
	other = other && slave->note.listed;
	raw_spin_unlock(&slave->note.lock);
	ec_slave_changed(slave);
	if (other)
		report_failure(slave, text, error, cause);
}

/* @before: AL status before, 0: the slave is new */
static void trace_al(const struct ec_slave *s, u16 before)
{
	trace_ec_al_state(s->bus->base->index, s->station, s->position, before,
			  READ_ONCE(s->al.status), READ_ONCE(s->al.code));
}

/**
 * ec_slave_list() - report what the scan has noted of a slave that comes into the list
 * @slave: new slave
 *
 * Context: The monitor thread.
 */
void ec_slave_list(struct ec_slave *slave)
{
	bool unreported;

	raw_spin_lock(&slave->note.lock);
	unreported = slave->note.unreported;
	slave->note.unreported = false;
	slave->note.listed = true;
	raw_spin_unlock(&slave->note.lock);
	trace_al(slave, 0);
	if (slave->note.sii_flaw[0]) {
		const struct ec_event_more more = { .detail = slave->note.sii_flaw };

		ec_report_more(slave->bus->base, EC_EVENT_EEPROM, slave->position, &more,
			       slave->eeprom.flaw.kind, slave->info.checksum,
			       slave->info.checksum_calc);
	}
	/* no other thread has failed with it so far */
	if (unreported)
		report_failure(slave, slave->note.why, slave->note.error, &slave->note.cause);
}

/*
 * A slave that has replied to the request of its identification late shows it instead of the code.
 * The request ends when it leaves PREOP.
 */
static void take_identification(struct ec_slave *slave, u16 *status, u16 *code)
{
	u8 is = READ_ONCE(slave->identify);

	if (is == EC_IDENTIFY_DUE)
		return;
	if ((*status & ~EC_AL_ID) != EC_AL_PREOP) {
		if (is != EC_IDENTIFY_DONE)
			WRITE_ONCE(slave->identify, is == EC_IDENTIFY_SEEN ? EC_IDENTIFY_DONE :
									     EC_IDENTIFY_CUT);
		return;
	}
	if (!(*status & EC_AL_ID))
		return;
	if (is == EC_IDENTIFY_STANDS) {
		WRITE_ONCE(slave->identification, *code);
		WRITE_ONCE(slave->identify, EC_IDENTIFY_SEEN);
		WRITE_ONCE(slave->bus->regroup, true);
	}
	*status = EC_AL_PREOP;
	*code = 0;
}

/**
 * ec_slave_set_al() - the AL status was read; a change is an event, once it is in the list
 * @slave: slave
 * @status: register 0x0130
 * @code: register 0x0134
 * @by: why it has changed
 *
 * Context: The slave's worker, or the monitor while that does not work, and before the slave is
 * in the list.
 */
void ec_slave_set_al(struct ec_slave *slave, u16 status, u16 code, enum ec_al_by by)
{
	u16 before = READ_ONCE(slave->al.status);
	u8 state = status & EC_AL_STATE_MASK, was = before & EC_AL_STATE_MASK;
	bool error = status & EC_AL_ERROR && !(before & EC_AL_ERROR);
	/* 0: not known before */
	bool moved = state != was && was;

	take_identification(slave, &status, &code);
	if (status == before && code == READ_ONCE(slave->al.code))
		return;
	if (moved && by == EC_AL_BY_ITSELF)
		ec_pending_before(slave);
	WRITE_ONCE(slave->al.status, status);
	WRITE_ONCE(slave->al.code, code);
	trace_al(slave, before);
	ec_slave_changed(slave);
	if (!slave->note.listed)
		return;
	if (moved && by != EC_AL_BY_ITSELF)
		ec_pending_al(slave, was, state);
	else if (moved && error)
		/* the line about the error has the state */
		ec_slave_event(slave, EC_EVENT_AL_LEFT, state, was);
	else if (moved)
		ec_slave_report(slave, EC_EVENT_AL_LEFT, state, was);
	if (!error)
		return;
	ec_pending_before(slave);
	if (by == EC_AL_BY_WORKER)
		ec_slave_event(slave, EC_EVENT_AL_ERROR, state, code);
	else
		ec_slave_report(slave, EC_EVENT_AL_ERROR, state, code);
}

/**
 * ec_slave_set_ok() - the slave has no error any more, if it replies
 * @slave: slave
 * @replies: the scan has seen that; false: its worker has brought it to the requested state
 *
 * Context: Process.
 * Return: false when the scan has found meanwhile that the slave does not reply.
 */
bool ec_slave_set_ok(struct ec_slave *slave, bool replies)
{
	bool ok;

	raw_spin_lock(&slave->note.lock);
	ok = replies || slave->note.error != EC_SLAVE_SCAN_FAILED;
	if (ok) {
		WRITE_ONCE(slave->note.error, EC_SLAVE_OK);
		slave->note.why[0] = '\0';
		slave->note.cause = (struct ec_cause){ .kind = EC_CAUSE_NONE };
	}
	raw_spin_unlock(&slave->note.lock);
	ec_slave_changed(slave);
	return ok;
}

/**
 * ec_slave_forgive() - let the worker try again what failed in the configuration
 * @slave: slave
 *
 * The cause remains, so that it is not logged again.
 *
 * Context: Any.
 * Return: whether the configuration had failed.
 */
bool ec_slave_forgive(struct ec_slave *slave)
{
	bool failed;

	raw_spin_lock(&slave->note.lock);
	failed = slave->note.error == EC_SLAVE_CONFIG_FAILED;
	if (failed)
		WRITE_ONCE(slave->note.error, EC_SLAVE_OK);
	raw_spin_unlock(&slave->note.lock);
	ec_slave_changed(slave);
	return failed;
}

/**
 * ec_slave_why() - the cause of a slave's error
 * @slave: slave
 * @buf: result
 * @size: of @buf
 *
 * Context: Any.
 * Return: @buf.
 */
const char *ec_slave_why(struct ec_slave *slave, char *buf, size_t size)
{
	raw_spin_lock(&slave->note.lock);
	strscpy(buf, slave->note.why, size);
	raw_spin_unlock(&slave->note.lock);
	return buf;
}

/**
 * ec_slave_cause() - the cause of a slave's error, otherwise of its warning, for programs
 * @slave: slave
 * @cause: result
 *
 * Context: Any.
 */
void ec_slave_cause(struct ec_slave *slave, struct ec_cause *cause)
{
	unsigned int first = READ_ONCE(slave->alias_first);

	raw_spin_lock(&slave->note.lock);
	*cause = slave->note.cause;
	if (cause->kind || slave->note.warning[0])
		;
	else if (slave->note.sii_flaw[0])
		cause->kind = EC_CAUSE_EEPROM;
	else if (first)
		*cause = *EC_CAUSE(ALIAS_TWICE, .position = first - 1);
	else
		cause->kind = slave->mbox_doubt ? EC_CAUSE_MAILBOX : EC_CAUSE_NONE;
	raw_spin_unlock(&slave->note.lock);
}

/**
 * ec_slave_warning() - what is not certain of a slave's process data, EEPROM or mailbox
 * @slave: slave
 * @buf: result, empty: nothing
 * @size: of @buf
 *
 * Context: Any.
 */
void ec_slave_warning(struct ec_slave *slave, char *buf, size_t size)
{
	unsigned int first = READ_ONCE(slave->alias_first);

	raw_spin_lock(&slave->note.lock);
	strscpy(buf, slave->note.warning[0] ? slave->note.warning : slave->note.sii_flaw, size);
	raw_spin_unlock(&slave->note.lock);
	if (!buf[0] && first)
		scnprintf(buf, size,
			  "alias %u is not unique; configurations use slave %u, the first one",
			  slave->alias, first - 1);
	if (!buf[0])
		ec_slave_mbox_text(slave, buf, size);
}

/**
 * ec_slave_set_warning() - note what is not certain of a slave's process data
 * @slave: slave, @lock held
 * @fmt: text, empty: nothing
 *
 * Context: Process.
 */
void ec_slave_set_warning(struct ec_slave *slave, const char *fmt, ...)
{
	char text[EC_UAPI_WARNING];
	va_list args;

	lockdep_assert_held(&slave->lock);
	va_start(args, fmt);
	vscnprintf(text, sizeof(text), fmt, args);
	va_end(args);
	raw_spin_lock(&slave->note.lock);
	strscpy(slave->note.warning, text, sizeof(slave->note.warning));
	raw_spin_unlock(&slave->note.lock);
}

/**
 * ec_slave_retry() - plan another try to read or configure a slave
 * @slave: slave that failed
 * @max_ms: longest distance of tries
 *
 * Context: The monitor thread, or the slave's worker with its lock held.
 */
void ec_slave_retry(struct ec_slave *slave, u32 max_ms)
{
	lockdep_assert(lockdep_is_held(&slave->lock) ||
		       current == READ_ONCE(slave->bus->links->carry->monitor));
	slave->reply.retry_ms = clamp_t(u32, 2 * slave->reply.retry_ms, EC_RETRY_MIN_MS, max_ms);
	ec_write64(&slave->reply.retry_ns,
		   ktime_get_ns() + slave->reply.retry_ms * (u64)NSEC_PER_MSEC);
}

/**
 * ec_slave_lost_text() - which slave was lost, and where
 * @slave: slave that was disconnected
 * @buf: result
 * @size: of @buf
 *
 * Context: Process.
 * Return: length of the text.
 */
size_t ec_slave_lost_text(const struct ec_slave *slave, char *buf, size_t size)
{
	char alias[16] = "";

	if (slave->alias)
		snprintf(alias, sizeof(alias), "alias %u, ", slave->alias);
	return scnprintf(buf, size, "slave %u (%s%.40s) disconnected%s%s from %s",
			 slave->position, alias, ec_slave_label(slave),
			 slave->lost.first[0] ? " with " : "", slave->lost.first,
			 slave->lost.parent);
}

/**
 * ec_slave_kick() - start the worker of a slave again
 * @slave: slave
 *
 * The requested state does not change: a caller that only wants the slave brought there must
 * not write back a state that it has read before.
 *
 * Context: Process.
 */
void ec_slave_kick(struct ec_slave *slave)
{
	ec_slave_ref(slave);
	atomic_inc(&slave->work.runs);
	ec_slave_changed(slave);
	if (ec_workers_queue(&slave->bus->workers, &slave->work.job))
		return;
	/* the run that waits in the queue does it */
	atomic_dec(&slave->work.runs);
	ec_slave_unref(slave);
}

/* Nothing beyond PREOP while the computer reboots. */
static u8 allowed(const struct ec_slave *slave, u8 state)
{
	return state & EC_AL_BEYOND_PREOP && READ_ONCE(slave->bus->down) ? EC_AL_PREOP : state;
}

/**
 * ec_slave_wanted() - the state that the worker brings the slave to
 * @slave: slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: AL state: the requested one, or PREOP instead of a higher one while the computer reboots.
 */
u8 ec_slave_wanted(const struct ec_slave *slave)
{
	return allowed(slave, READ_ONCE(slave->al.requested));
}

static void want(struct ec_slave *slave, u8 state, u32 limit_ms)
{
	WRITE_ONCE(slave->al.limit_ms, limit_ms);
	WRITE_ONCE(slave->al.requested, allowed(slave, state));
	wake_up_all(&slave->stop.wake);
}

/**
 * ec_slave_request() - let a worker bring the slave to a state
 * @slave: slave
 * @state: AL state; none beyond PREOP is reached while the computer reboots
 *
 * Context: Process.
 */
void ec_slave_request(struct ec_slave *slave, u8 state)
{
	want(slave, state, 0);
	ec_slave_kick(slave);
}

/**
 * ec_slave_request_anew() - the same for a slave that may have failed before
 * @slave: slave
 * @state: AL state; none beyond PREOP is reached while the computer reboots
 * @limit_ms: for each transition on the way to it, until the next request; 0: the usual ones
 *
 * Context: Process.
 */
void ec_slave_request_anew(struct ec_slave *slave, u8 state, u32 limit_ms)
{
	want(slave, state, limit_ms);
	/* after it: a worker that notes a failure just now sees it there, see ec_apply_report() */
	ec_slave_forgive(slave);
	ec_slave_kick(slave);
}

/**
 * ec_slave_want_states() - the workers of slaves that are not as requested have something to do
 * @bus: bus
 *
 * Context: The monitor thread.
 */
void ec_slave_want_states(struct ec_bus *bus)
{
	ec_for_each_slave(s, bus) {
		if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED)
			continue;
		if (READ_ONCE(s->al.status) != READ_ONCE(s->al.requested) ||
		    READ_ONCE(s->work.reconfigure) || !s->work.ours)
			ec_slave_kick(s);
	}
}
