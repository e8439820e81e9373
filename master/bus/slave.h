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

struct ec_line_errors;

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
 * enum ec_identify - the request of an identification by AL control
 * @EC_IDENTIFY_DUE: it was not asked so far
 * @EC_IDENTIFY_STANDS: asked in PREOP, the reply may come any time
 * @EC_IDENTIFY_CUT: asked, and has left PREOP before it has replied
 * @EC_IDENTIFY_SEEN: it has replied; the request has to be ended
 * @EC_IDENTIFY_DONE: nothing is to be done
 */
enum ec_identify {
	EC_IDENTIFY_DUE,
	EC_IDENTIFY_STANDS,
	EC_IDENTIFY_CUT,
	EC_IDENTIFY_SEEN,
	EC_IDENTIFY_DONE,
};

/** struct ec_slave_eeprom - the EEPROM of a slave as read: scan_sii.c */
struct ec_slave_eeprom {
	/** @data: image */
	u8 *data;
	/** @bytes: at @data */
	size_t bytes;
	/** @counted: what it, or @part, counts in @sii_bytes of the bus */
	size_t counted;
	/** @part: first bytes of a large one that is still being read, or NULL */
	u8 *part;
	/** @part_bytes: at @part */
	size_t part_bytes;
	/** @flaw: found when it was read */
	struct ec_sii_flaw flaw;
};

/** struct ec_slave_graph - the neighbors of a slave: graph.c, under bus->topo */
struct ec_slave_graph {
	/** @at: by port, NULL none */
	struct ec_slave *at[EC_MAX_PORT];
	/** @upstream: port towards the main device */
	u8 upstream;
	/** @parent_port: port of the slave it hangs at */
	u8 parent_port;
	/** @hung: its neighbor at @upstream is known, or it hangs at the main device */
	bool hung;
	/** @inconsistent: open ports contradict the ring order, here or upstream */
	bool inconsistent;
};

/** struct ec_slave_lost - a slave that was lost: scan_lost.c, under bus->topo */
struct ec_slave_lost {
	/** @parent: where the first slave hung that was lost with it, in words */
	char parent[EC_UAPI_STRING];
	/** @first: that one, in words; empty: itself */
	char first[40];
	/** @at: where the way to it broke then */
	struct ec_break at;
	/**
	 * @seen_ns: when all slaves replied last before it was lost or silent (ktime); 0: it was
	 * not, or is in its state again
	 */
	u64 seen_ns;
};

/** struct ec_slave_pdos - of the EEPROM, then of the dictionary: pdo_coe.c, under bus->topo */
struct ec_slave_pdos {
	/** @sm: by SyncManager */
	struct ec_pdo_list sm[EC_MAX_SM];
	/** @free: without SyncManager */
	struct ec_pdo_list free;
	/** @known: the object dictionary was read, or there is none */
	bool known;
	/** @unread: @known, but they could not be read */
	bool unread;
	/** @wanted: read them when the slave is in its requested state */
	bool wanted;
	/** @names_done: the slave was asked for names that its EEPROM does not have */
	bool names_done;
	/** @again_ms: they are read again after that time since the last try */
	u32 again_ms;
	/** @again_ns: when that is (ktime), 0: not */
	aligned_u64 again_ns;
	/** @names: from the object dictionary */
	struct ec_names names;
};

/** struct ec_slave_al - AL state: al.c, and slave.c for what is requested */
struct ec_slave_al {
	/** @status: AL status seen last */
	u16 status;
	/** @code: AL status code that belongs to it */
	u16 code;
	/** @reads: how often a worker has read the two: what was asked for before is older */
	u32 reads;
	/** @limit_ms: time limit of each transition to @requested, 0: the usual ones */
	u32 limit_ms;
	/** @awaited_ms: that of @awaited */
	u32 awaited_ms;
	/**
	 * @awaited: state that was asked for and is not reached so far, 0: none. It is taken when
	 * it comes after its time limit
	 */
	u8 awaited;
	/** @requested: state that its worker brings it to */
	u8 requested;
};

/** struct ec_slave_note - what is wrong with a slave: slave.c. ec_slave_why() copies texts */
struct ec_slave_note {
	/** @lock: protects the texts, @cause, ec_slave.pending, and @error where it changes */
	raw_spinlock_t lock;
	/** @error: EC_SLAVE_OK... */
	u8 error;
	/** @listed: in the list of the bus; what fails before is reported when it comes there */
	bool listed;
	/** @unreported: @why is to be reported then */
	bool unreported;
	/** @why: cause of @error */
	char why[EC_UAPI_REASON];
	/** @cause: the same for programs */
	struct ec_cause cause;
	/** @warning: what is not certain of its process data, empty: nothing */
	char warning[EC_UAPI_WARNING];
	/** @sii_flaw: what is wrong with its EEPROM, empty: nothing */
	char sii_flaw[EC_UAPI_WARNING];
};

/** struct ec_slave_reply - does a slave reply, and when it is tried again: silent.c, the monitor */
struct ec_slave_reply {
	/** @silent: its error is that it does not; it is in its place until it does */
	bool silent;
	/** @missed: polls in a row without its reply, while the list is held */
	u8 missed;
	/** @retry_ms: distance between the last two tries of what failed */
	u32 retry_ms;
	/** @retry_ns: when to try again (ktime), 0: never */
	aligned_u64 retry_ns;
};

/** struct ec_slave_work - how the worker brings a slave to its requested state: config/apply.c */
struct ec_slave_work {
	/** @job: does it */
	struct ec_job job;
	/** @runs: of @job that are queued or in progress */
	atomic_t runs;
	/** @reconfigure: go through INIT and configure again */
	bool reconfigure;
	/** @clean: nothing of a configuration is left in its registers */
	bool clean;
	/** @ours: this master has brought it from INIT to PREOP or BOOT, not an earlier one */
	bool ours;
	/** @mapped: logical address of its first FMMU, and 1; 0: it has none */
	u32 mapped;
	/** @renew: its EEPROM was written: the next scan reads it as if it were new */
	bool renew;
};

/** struct ec_slave - one slave. What is not a part with an owner is fixed after the scan */
struct ec_slave {
	/** @kref: reference count; the master's table holds one */
	struct kref kref;
	/** @bus: bus */
	struct ec_bus *bus;
	/** @ext: parts of higher layers in the memory of the slave, initially zeroed */
	void *ext[EC_N_EXT];
	/** @stop: ends what callers and its worker wait for */
	struct ec_stop stop;
	/** @mbox: its mailbox */
	struct ec_mbox mbox;
	/** @station: station address */
	u16 station;
	/** @eeprom: as read */
	struct ec_slave_eeprom eeprom;
	/** @info: fixed area of the EEPROM */
	struct ec_sii_info info;
	/** @mbox_doubt: in what it is inconsistent about the mailbox, enum ec_sii_mbox_doubt */
	u8 mbox_doubt;
	/** @general: general category */
	struct ec_sii_general general;
	/** @has_general: it has one */
	bool has_general;
	/** @sms: SyncManagers of the EEPROM */
	struct ec_sii_sm sms[EC_MAX_SM];
	/** @n_sms: entries in @sms */
	unsigned int n_sms;
	/** @emulation: AL status follows AL control */
	bool emulation;
	/** @group: group name of the EEPROM */
	char group[EC_UAPI_STRING];
	/** @image: name of the picture */
	char image[EC_UAPI_STRING];
	/** @order: order number */
	char order[EC_UAPI_STRING];
	/** @name: name */
	char name[EC_UAPI_STRING];

	/* of the last scan: scan_*.c and known.c, under bus->topo */
	/** @register_alias: register 0x0012 */
	u16 register_alias;
	/** @device: device number */
	u64 device;
	/** @by_device: in bus->known.present while it is in the list */
	struct hlist_node by_device;
	/** @kept_station: station address with which it was found, 0: none of its own */
	u16 kept_station;
	/** @position: ring position */
	u16 position;
	/** @regs: registers 0x0000-0x0009 */
	u8 regs[EC_INFO_SIZE];
	/** @dl_status: register 0x0110 */
	u16 dl_status;
	/** @dl_seen: the same, read later because of an event; the monitor's */
	u16 dl_seen;
	/** @alias: effective alias */
	u16 alias;
	/** @identification: explicit device identification read when it was found, 0: none */
	u16 identification;
	/** @alias_first: ring position + 1 of the first one with this alias; 0: it is this one */
	u16 alias_first;
	/** @recv: receive times at the ports */
	u32 recv[EC_MAX_PORT];
	/** @delay_only: it has receive times, but no other register of a clock (0x0928) */
	bool delay_only;
	/** @identify: enum ec_identify: has it been asked for @identification? */
	u8 identify;
	/** @listing: it is in the list that is being made; the monitor's */
	bool listing;
	/** @unshown: messages that did not show in the IRQ field: mailboxes.c */
	u8 unshown;
	/** @found: the list that it was in first, counted by bus->lists */
	u32 found;

	/* parts with an owner */
	/** @ports: loop control: ports.c, the monitor's */
	struct ec_ports ports;
	/** @lines: its error counters, NULL: not read so far; the monitor's */
	struct ec_line_errors *lines;
	/** @graph: its neighbors */
	struct ec_slave_graph graph;
	/** @lost: if it was lost */
	struct ec_slave_lost lost;
	/** @pdos: its PDOs */
	struct ec_slave_pdos pdos;
	/** @dict: answers about its object dictionary: dict.c */
	struct ec_dict dict;
	/** @al: its AL state */
	struct ec_slave_al al;
	/** @pending: changes that have no event so far: pending.c */
	struct ec_pending pending;
	/** @note: what is wrong with it */
	struct ec_slave_note note;
	/** @reply: does it reply */
	struct ec_slave_reply reply;
	/** @work: its worker */
	struct ec_slave_work work;
	/** @lock: one worker or caller at a time changes its state */
	struct mutex lock;
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
void ec_slave_want_states(struct ec_bus *bus);
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
	return atomic_read_acquire(&slave->work.runs) > 0;
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
	u16 al = READ_ONCE(s->al.status);
	u64 again = ec_read64(&s->pdos.again_ns);

	if (READ_ONCE(s->pdos.known) && (!again || ktime_get_ns() < again))
		return false;
	return READ_ONCE(s->note.error) == EC_SLAVE_OK && s->eeprom.data &&
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
