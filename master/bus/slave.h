/* SPDX-License-Identifier: GPL-2.0-only */
/* A slave that is present on the bus. */
#ifndef EC_SLAVE_H
#define EC_SLAVE_H

#include <linux/kref.h>
#include <linux/mutex.h>
#include <linux/spinlock.h>
#include "../base/once64.h"
#include "../base/report.h"
#include "../mailbox/mailbox.h"
#include "bus.h"
#include "dict.h"
#include "names.h"
#include "pdo.h"
#include "pending.h"
#include "ports_state.h"
#include "../wire/al.h"
#include "../wire/regs.h"
#include "../wire/sii.h"

/* distance of the tries to read or configure a slave that failed; doubles each time */
#define EC_RETRY_MIN_MS		250
#define EC_RETRY_MAX_MS		60000
#define EC_PROBE_MAX_MS		1000	/* of a slave that does not reply at all */

/**
 * struct ec_break - where the way to a lost slave breaks
 * @station: address of the slave that is still there, 0: the main device
 * @up: position in the list of that it hung at itself, EC_UAPI_NONE16: at the main device
 * @position: ring position it had then, EC_EVENT_NONE: the main device
 * @port: its port
 * @up_port: port of that at @up
 */
struct ec_break {
	u16 station;
	u16 up;
	u32 position;
	u8 port;
	u8 up_port;
};

/**
 * struct ec_slave - one slave
 *
 * Fixed after the scan:
 * @kref: reference count; the master's table holds one
 * @bus: bus
 * @ext: parts of higher layers in the memory of the slave, initially zeroed
 * @stop: ends what callers and its worker wait for
 * @mbox: its mailbox
 * @station: station address
 * @sii: EEPROM image as read
 * @sii_bytes: bytes at @sii
 * @flaw: of @sii, found when it was read
 * @sii_counted: what it, or @part, counts in the master's @sii_bytes
 * @part: first bytes of a large EEPROM that is still being read, or NULL
 * @part_bytes: bytes there
 * @info: fixed area of the EEPROM
 * @general: general category
 * @has_general: it has one
 * @sms: SyncManagers of the EEPROM
 * @n_sms: entries in @sms
 * @emulation: AL status follows AL control
 * @group: group name of the EEPROM
 * @image: name of the picture
 * @order: order number
 * @name: name
 *
 * Of the last scan, changed under bus->topo:
 * @device: device number
 * @by_device: in bus->known.present while it is in the list
 * @kept_station: station address with which it was found, 0: it had none of its own
 * @position: ring position
 * @regs: registers 0x0000-0x0009
 * @dl_status: register 0x0110
 * @dl_seen: the same, read later than @dl_status because of an event; the monitor's
 * @ports: loop control; the monitor's
 * @alias: effective alias
 * @identification: explicit device identification as read when it was found, 0: none
 * @alias_first: another slave has @alias: ring position + 1 of the first one; 0: none has
 * @recv: receive times at the ports
 * @identified: it was asked for @identification, or has none
 * @delay_only: it has receive times, but no other register of a clock (0x0928)
 * @at: neighbors at the ports, NULL none; what graph.c finds
 * @upstream: port towards the main device
 * @hung: its neighbor there is known, or it hangs at the main device
 * @parent: where the first slave hung that was lost with it, in words
 * @first_lost: the first slave that was lost with it, in words; empty: itself
 * @lost_at: where the way to it broke then
 * @parent_port: port of the slave it hangs at
 * @topology_inconsistent: open ports contradict the ring order, here or upstream
 *
 * Of the EEPROM, then of the object dictionary, changed under bus->topo:
 * @sm_pdos: PDOs by SyncManager
 * @free_pdos: PDOs without SyncManager
 * @pdos_known: the object dictionary was read, or there is none
 * @pdos_unread: @pdos_known, but they could not be read
 * @pdos_again_ns: when they are read again then (ktime), 0: not
 * @pdos_again_ms: after that time since the last try
 * @names: from the object dictionary
 * @names_done: the slave was asked for those its EEPROM does not have
 *
 * Changing:
 * @mbox_doubt: in what its EEPROM is inconsistent about the mailbox, enum ec_sii_mbox_doubt
 * @dict: answers about its object dictionary
 * @al_status: last AL status seen
 * @al_code: AL status code that belongs to it
 * @al_reads: how often a worker has read the two: what was asked for before
 *	is older
 * @requested: AL state that its worker brings it to
 * @limit_ms: time limit of each transition to it, 0: the usual ones
 * @awaited: AL state that was asked for and is not reached so far, 0: none. It is taken when it
 *	comes after its time limit
 * @awaited_ms: that limit
 * @pending: changes that have no event so far
 * @note_lock: protects @pending, @why, @cause and @warning, and @error where it changes; without
 *	@lock a caller copies the texts by ec_slave_why() and ec_slave_warning()
 * @error: EC_SLAVE_OK...
 * @why: cause of @error
 * @cause: the same for programs
 * @warning: what is not certain of its process data, empty: nothing
 * @found: the list that it was in first, counted by bus->lists
 * @listing: it is in the list that is being made; the monitor's
 * @listed: it is in the list of the bus; what fails before is reported when it comes there
 * @unreported: @why is to be reported then
 * @sii_flaw: what is wrong with its EEPROM, empty: nothing
 * @silent: @error because it does not answer any more; it is in its place until it does
 * @missed: polls in a row without its reply, while the list is held; the monitor's
 * @retry_ns: when to try again what failed (ktime), 0: never
 * @retry_ms: distance between the last two tries
 * @seen_ns: when all slaves replied last before it was lost or silent (ktime); 0: it was not,
 *	or is in its state again
 * @job: brings it to @requested
 * @works: runs of @job that are queued or in progress
 * @unshown: messages that did not show in the IRQ field; the monitor's
 * @lock: one worker or caller at a time changes its state
 * @read_pdos: read the PDOs when it is in @requested
 * @reconfigure: go through INIT and configure again
 * @clean: nothing of a configuration is left in its registers
 * @ours: this master has brought it from INIT to PREOP or BOOT, not an earlier one
 */
struct ec_slave {
	struct kref kref;
	struct ec_bus *bus;
	void *ext[EC_N_EXT];
	struct ec_stop stop;
	struct ec_mbox mbox;
	u16 station;
	u8 *sii;
	size_t sii_bytes;
	size_t sii_counted;
	u8 *part;
	size_t part_bytes;
	struct ec_sii_flaw flaw;
	struct ec_sii_info info;
	u8 mbox_doubt;
	struct ec_sii_general general;
	bool has_general;
	struct ec_sii_sm sms[EC_MAX_SM];
	unsigned int n_sms;
	bool emulation;
	char group[EC_UAPI_STRING];
	char image[EC_UAPI_STRING];
	char order[EC_UAPI_STRING];
	char name[EC_UAPI_STRING];

	u64 device;
	struct hlist_node by_device;
	u16 kept_station;
	u16 position;
	u8 regs[EC_INFO_SIZE];
	u16 dl_status;
	u16 dl_seen;
	struct ec_ports ports;
	u16 alias;
	u16 identification;
	u16 alias_first;
	u32 recv[EC_MAX_PORT];
	bool delay_only;
	bool identified;
	struct ec_slave *at[EC_MAX_PORT];
	u8 upstream;
	bool hung;
	u8 parent_port;
	char parent[EC_UAPI_STRING];
	char first_lost[40];
	struct ec_break lost_at;
	bool topology_inconsistent;

	struct ec_pdo_list sm_pdos[EC_MAX_SM];
	struct ec_pdo_list free_pdos;
	bool pdos_known;
	bool pdos_unread;
	u32 pdos_again_ms;
	aligned_u64 pdos_again_ns;
	struct ec_names names;
	bool names_done;

	struct ec_dict dict;
	u16 al_status;
	u16 al_code;
	u32 al_reads;
	u8 requested;
	u32 limit_ms;
	u8 awaited;
	u32 awaited_ms;
	struct ec_pending pending;
	raw_spinlock_t note_lock;
	u8 error;
	char why[EC_UAPI_REASON];
	struct ec_cause cause;
	char warning[EC_UAPI_WARNING];
	u32 found;
	bool listing;
	bool listed;
	bool unreported;
	char sii_flaw[EC_UAPI_WARNING];
	bool silent;
	u8 missed;
	aligned_u64 retry_ns;
	u32 retry_ms;
	u64 seen_ns;
	struct ec_job job;
	atomic_t works;
	u8 unshown;
	struct mutex lock;
	bool read_pdos;
	bool reconfigure;
	bool clean;
	bool ours;
};

/* @fmt is a constant: it identifies what may repeat, see ec_log_event() */
#define ec_slave_log(level, s, fmt, ...) \
	ec_log_event((s)->bus->base, (s)->position, 0, level, fmt, ##__VA_ARGS__)
#define ec_slave_info(s, fmt, ...)	ec_slave_log(KERN_INFO, s, fmt, ##__VA_ARGS__)
#define ec_slave_warn(s, fmt, ...)	ec_slave_log(KERN_WARNING, s, fmt, ##__VA_ARGS__)
#define ec_slave_event(s, kind, ...) \
	ec_event_slave((s)->bus->base, kind, (s)->position, ##__VA_ARGS__)
#define ec_slave_report(s, kind, ...) \
	ec_report_more((s)->bus->base, kind, (s)->position, NULL, ##__VA_ARGS__)
#define ec_slave_dbg(s, lvl, fmt, ...) \
	ec_dbg_slave((s)->bus->base, (s)->position, lvl, fmt, ##__VA_ARGS__)
#define ec_slave_dbg_result(s, ret, fmt, ...) \
	ec_dbg_slave_result((s)->bus->base, (s)->position, ret, fmt, ##__VA_ARGS__)

/* of ec_slave_fail(): EC_CAUSE(REFUSED, .state = ...) */
#define EC_CAUSE(kind_, ...) \
	(&(const struct ec_cause){ .kind = EC_CAUSE_##kind_, ##__VA_ARGS__ })

/* why an AL status has changed */
enum ec_al_by {
	EC_AL_BY_WORKER,	/* its worker or a caller has requested it, and reports a failure */
	EC_AL_BY_REQUEST,	/* what was requested; the monitor has read it */
	EC_AL_BY_ITSELF,	/* the slave has left the requested state */
};

struct ec_slave *ec_slave_alloc(struct ec_bus *bus, u16 station);
struct ec_slave *ec_slave_ref(struct ec_slave *slave);
void ec_slave_unref(struct ec_slave *slave);
int ec_slave_parse_sii(struct ec_slave *slave);
void ec_slave_kick(struct ec_slave *slave);
u8 ec_slave_wanted(const struct ec_slave *slave);
void ec_slave_request(struct ec_slave *slave, u8 state);
void ec_slave_request_anew(struct ec_slave *slave, u8 state, u32 limit_ms);
void ec_slave_fail(struct ec_slave *slave, u8 error, const struct ec_cause *cause,
		   const char *fmt, ...) __printf(4, 5);
void ec_slave_list(struct ec_slave *slave);
bool ec_slave_set_ok(struct ec_slave *slave, bool replies);
bool ec_slave_forgive(struct ec_slave *slave);
void ec_slave_set_al(struct ec_slave *slave, u16 status, u16 code, enum ec_al_by by);
const char *ec_slave_why(struct ec_slave *slave, char *buf, size_t size);
void ec_slave_cause(struct ec_slave *slave, struct ec_cause *cause);
void ec_slave_warning(struct ec_slave *slave, char *buf, size_t size);
void ec_slave_set_warning(struct ec_slave *slave, const char *fmt, ...) __printf(2, 3);
void ec_slave_retry(struct ec_slave *slave, u32 max_ms);
size_t ec_slave_lost_text(const struct ec_slave *slave, char *buf, size_t size);

/**
 * ec_slave_changed() - what ec_survey() or ec_config_status() reads of a slave was written
 * @slave: slave
 *
 * A reader of @bus->changes that then reads the slave misses no change.
 *
 * Context: Any. RT-safe.
 */
static inline void ec_slave_changed(struct ec_slave *slave)
{
	/* what was written before the count */
	atomic_inc_return_release(&slave->bus->changes);
}

/**
 * ec_slave_busy() - is the worker bringing the slave to a state, or about to?
 * @slave: slave
 *
 * When it is not, what the worker has written is visible to the caller.
 *
 * Context: Any. RT-safe.
 * Return: whether it is.
 */
static inline bool ec_slave_busy(const struct ec_slave *slave)
{
	return atomic_read_acquire(&slave->works) > 0;
}

/**
 * ec_slave_pdos_pending() - are the PDOs to be read over CoE?
 * @s: slave
 *
 * Context: Any.
 * Return: false also when that was done or is not possible now.
 */
static inline bool ec_slave_pdos_pending(const struct ec_slave *s)
{
	u16 al = READ_ONCE(s->al_status);
	u64 again = ec_read64(&s->pdos_again_ns);

	if (READ_ONCE(s->pdos_known) && (!again || ktime_get_ns() < again))
		return false;
	return READ_ONCE(s->error) == EC_SLAVE_OK && s->sii &&
	       ec_mbox_present(&s->mbox) && s->info.protocols & EC_SII_PROTO_COE &&
	       (al == EC_AL_PREOP || al == EC_AL_SAFEOP || al == EC_AL_OP);
}

/* what people call it */
static inline const char *ec_slave_label(const struct ec_slave *s)
{
	return s->order[0] ? s->order : s->name;
}

static inline u8 ec_slave_port_type(const struct ec_slave *s, unsigned int port)
{
	return s->regs[EC_REG_PORTS] >> 2 * port & 3;
}

static inline u16 ec_slave_features(const struct ec_slave *s)
{
	return get_unaligned_le16(s->regs + EC_REG_FEATURES);
}

/* a clock that can be set, not receive times alone */
static inline bool ec_slave_has_clock(const struct ec_slave *s)
{
	return ec_slave_features(s) & EC_FEAT_DC && !READ_ONCE(s->delay_only);
}

static inline bool ec_slave_no_lrw(const struct ec_slave *s)
{
	return ec_slave_features(s) & EC_FEAT_NO_LRW ||
	       (s->has_general && s->general.flags & EC_SII_FLAG_NO_LRW);
}

#endif
