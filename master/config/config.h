/* SPDX-License-Identifier: GPL-2.0-only */
/* What an application configures for one slave; exists without the slave. */
#ifndef EC_CONFIG_H
#define EC_CONFIG_H

#include <linux/list.h>
#include <linux/mutex.h>
#include <linux/types.h>
#include "../include/uapi/ethercat.h"
#include "../base/budget.h"
#include "../bus/pdo.h"
#include "../clock/dc_state.h"
#include "../wire/eoe.h"
#include "../wire/regs.h"
#include "startup.h"
#include "writes.h"

struct ec_domain;
struct ec_group;
struct ec_slave;
struct ec_unit;

#define EC_CONFIG_NAME	(EC_UAPI_STRING + 8)

/* values of the application interface */
#define EC_CFG_DIR_OUTPUT	1
#define EC_CFG_DIR_INPUT	2
#define EC_CFG_WD_DEFAULT	0
#define EC_CFG_WD_ENABLE	1
#define EC_CFG_WD_DISABLE	2

/**
 * struct ec_config_sm - one SyncManager of a configuration
 * @dir: EC_CFG_DIR_*, 0: not configured
 * @watchdog: EC_CFG_WD_*
 * @explicit: the application named PDOs itself: write the assignment
 * @pdos: assigned PDOs
 */
struct ec_config_sm {
	u8 dir;
	u8 watchdog;
	bool explicit;
	struct ec_pdo_list pdos;
};

/**
 * struct ec_config_fmmu - a SyncManager in a domain
 * @domain: which
 * @sm: SyncManager
 * @dir: EC_CFG_DIR_*
 * @shared: inputs at logical addresses of outputs; set by activation
 * @offset: byte in the domain's data
 * @logical: byte in the domain's logical addresses; set by activation
 * @size: bytes
 */
struct ec_config_fmmu {
	struct ec_domain *domain;
	u8 sm;
	u8 dir;
	bool shared;
	u32 offset;
	u32 logical;
	u32 size;
};

/* milliseconds between configuration and the request of SAFEOP */
#define EC_FLAG_WAIT_SAFEOP	"WaitBeforeSAFEOPms"

/* not 0: to OP although the slave has other process data than those registered */
#define EC_FLAG_ANY_PDOS	"AcceptOtherPdos"

/* the serial number that a member of a hot connect group has to have; 0: any */
#define EC_FLAG_SERIAL		"ExpectedSerial"

/* the revision number that the slave should have; another one is reported */
#define EC_FLAG_REVISION	"ExpectedRevision"

/* not 0: the application writes to a slave that returns before the master configures it */
#define EC_FLAG_HOLD		"ReinitHold"

/* not 0: the same frame may be sent several times in a cycle, as its ESI says */
#define EC_FLAG_REPEAT		"FrameRepeatSupport"

/* not 0: the slave ignores FRMW; clocks get the time by ARMW */
#define EC_FLAG_NO_FRMW		"IgnoresFRMW"

/* a named number that other masters know; in the order of the calls */
struct ec_config_flag {
	struct list_head list;
	s32 value;
	char key[EC_UAPI_STRING];
};

/**
 * struct ec_config - configuration of one slave, under the lock of the session; what is
 *	configured is compared in takeover.c
 * @wanted: owner
 * @index: number there
 * @name: for messages: alias and position, or group and member
 * @group: hot connect group of which it is member @position, or NULL
 * @alias: 0: @position is the ring position
 * @position: else slaves behind the one with @alias
 * @alias_at: ring position of the first slave with @alias at the last search
 * @place: with hot connect groups: ring position that it means, as slaves of groups do not count;
 *	the number of slaves: there is none; of the last search
 * @vendor: expected
 * @product: expected
 * @sm: SyncManagers
 * @fmmus: what is mapped where
 * @n_fmmus: entries in @fmmus
 * @startup: startup commands
 * @n_startup: how many, by type
 * @flags: named numbers
 * @n_flags: how many
 * @overlap: its inputs may share logical addresses with its outputs
 * @lrw: its process data are in an LRW datagram
 * @in_ring: they share logical addresses with those of other slaves, as long as
 *	it is where it was: at @ring_position
 * @ring_position: when it was activated
 * @sync: SYNC signals
 * @timeout_ms: of AL transitions, by from and to state, 0: default
 * @reply_ms: limit of its replies to SDOs and IDNs, 0: default
 * @replay: what the application has written
 * @emergencies: how many to keep
 * @emerg_cleared: by an application in the kernel, of the lost ones
 * @lost: the slave that it had while active, in words, when all slaves replied last before
 *	that (ktime), where the way to it broke, and the ring position of that place at the
 *	last search; its station address and serial number; the first list of slaves
 *	(bus->lists) whose new slaves may be attached instead; it is lost, and only its
 *	place can bring a slave back
 * @device: number of the device that it had last, 0: none
 * @slave: attached slave with a reference, or NULL
 */
struct ec_config {
	struct ec_wanted *wanted;
	u32 index;
	char name[EC_CONFIG_NAME];
	struct ec_group *group;
	u16 alias;
	u16 position;
	u32 alias_at;
	u32 place;
	u32 vendor;
	u32 product;
	struct ec_config_sm sm[EC_MAX_SM];
	struct ec_config_fmmu fmmus[EC_MAX_FMMU];
	unsigned int n_fmmus;
	struct list_head startup;
	unsigned int n_startup[EC_STARTUP_TYPES];
	struct list_head flags;
	unsigned int n_flags;
	bool overlap;
	bool lrw;
	bool in_ring;
	u32 ring_position;
	struct ec_dc_sync sync;
	u32 timeout_ms[9][9];
	u32 reply_ms;
	struct ec_replay replay;
	u32 emergencies;
	u32 emerg_cleared;
	struct {
		char text[EC_UAPI_REASON / 2];
		u64 seen_ns;
		struct ec_break at;
		u32 up_at;
		u16 station;
		u32 serial;
		u32 list;
		bool waits;
	} lost;
	u64 device;
	struct ec_slave *slave;
};

/** struct ec_setup - how far a slave has its configuration, under ec_slave.lock */
struct ec_setup {
	/** @config: configuration in the session; lock of the configuration held as well */
	struct ec_config *config;
	/** @active_config: @config once its session is active: what the worker applies */
	const struct ec_config *active_config;
	/** @waits_for: what the worker waits for, NULL: nothing that lasts; any reader */
	const char *waits_for;
	/** @heading: state that was requested when the present step began */
	u8 heading;
	/** @op_only: SyncManagers that are on in OP only and are on, a bit each */
	u16 op_only;
	/** @mapped: its FMMUs are set */
	bool mapped;
	/** @replayed: it has what the application has written; until it is in INIT */
	bool replayed;
	/** @made: SyncManagers whose PDOs the startup SDOs have made, and were read, a bit each */
	u16 made;
	/** @group: index + 1 of the hot connect group that it belongs to, 0: none; topo held */
	u8 group;
	/** @heads: it is the first one of that group; topo held */
	bool heads;
	/** @in_path: frames pass it from an end of a ring to the other, or the break; topo held */
	bool in_path;
	/** @mailbox: claim of the worker, for the way through INIT */
	struct ec_claim mailbox;
	/** @pdo_refusal: the first PDO mapping or assignment refused since it was configured */
	char pdo_refusal[EC_UAPI_REASON];
	/** @pdo_cause: the same for programs, when @pdo_refusal is not empty */
	struct ec_cause pdo_cause;
};

/* The slaves that a scan finds from now on have one. */
static inline void ec_setup_init(struct ec_bus *bus)
{
	bus->slave_bytes[EC_EXT_CONFIG] = sizeof(struct ec_setup);
}

static inline struct ec_setup *ec_setup_of(const struct ec_slave *s)
{
	return s->ext[EC_EXT_CONFIG];
}

static inline struct ec_config *ec_config_of(const struct ec_slave *s)
{
	return READ_ONCE(ec_setup_of(s)->config);
}

/** struct ec_wanted - what an application configures, under @lock */
struct ec_wanted {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @bus: slaves, immutable */
	struct ec_bus *bus;
	/** @lock: of the session, immutable */
	struct mutex *lock;
	/** @sends: cyclic sends so far; pointer immutable */
	const u64 *sends;
	/** @budget: memory that the application causes */
	struct ec_budget budget;
	/** @writes_lock: what a worker changes of ec_config.replay */
	spinlock_t writes_lock;
	/** @strays: writes to slaves that have no configuration so far */
	struct ec_replay strays;
	/** @configs: slave configurations */
	struct ec_config **configs;
	/** @n_configs: entries in @configs */
	unsigned int n_configs;
	/** @certain: in an open ring a slave is attached only if its position is certain */
	bool certain;
	/** @n_places: ring positions up to the last one that a configuration means */
	unsigned int n_places;
	/** @domains: domains */
	struct ec_domain *domains[EC_MAX_DOMAINS];
	/** @n_domains: entries in @domains */
	unsigned int n_domains;
	/** @groups: hot connect groups */
	struct ec_group *groups[EC_MAX_GROUPS];
	/** @n_groups: entries in @groups */
	unsigned int n_groups;
	/** @units: sync units */
	struct ec_unit *units[EC_MAX_DOMAINS];
	/** @n_units: entries in @units */
	unsigned int n_units;
	/** @unsure: slaves behind the break of a ring may be of a group whose head is absent */
	bool unsure;
	/** @active: activated: the configurations do not change any more, workers use them */
	bool active;
	/** @before: the same of the running session that is to be taken over, NULL: none */
	const struct ec_wanted *before;
};

/* each configuration, domain, group, unit of @w: declares @c, @d, @g, @u */
#define ec_for_each_config(c, w) \
	for (struct ec_config **c##_at = (w)->configs, *c; \
	     c##_at < (w)->configs + (w)->n_configs && (c = *c##_at, true); c##_at++)
#define ec_for_each_domain(d, w) \
	for (struct ec_domain *const *d##_at = (w)->domains, *d; \
	     d##_at < (w)->domains + (w)->n_domains && (d = *d##_at, true); d##_at++)

#define ec_for_each_group(g, w) \
	for (struct ec_group *const *g##_at = (w)->groups, *g; \
	     g##_at < (w)->groups + (w)->n_groups && (g = *g##_at, true); g##_at++)

#define ec_for_each_unit(u, w) \
	for (struct ec_unit *const *u##_at = (w)->units, *u; \
	     u##_at < (w)->units + (w)->n_units && (u = *u##_at, true); u##_at++)

/* For what reads configurations: the lock of the session is held, or they are shown. */
static inline void ec_wanted_assert_stays(const struct ec_wanted *w)
{
	lockdep_assert(lockdep_is_held(w->lock) || ec_show_begun(&w->base->show));
}

struct ec_config *ec_config_create(struct ec_wanted *w, u16 alias, u16 position, u32 vendor,
				   u32 product);
struct ec_config *ec_config_find(const struct ec_wanted *w, u16 alias, u16 position, u32 vendor,
				 u32 product);
int ec_config_begin(struct ec_config *c);
void ec_config_drop(struct ec_config *c);
void ec_config_free(struct ec_config *c);
int ec_config_sync(struct ec_config *c, u8 sm, u8 dir, u8 watchdog);
int ec_config_assign_add(struct ec_config *c, u8 sm, u16 pdo);
int ec_config_assign_clear(struct ec_config *c, u8 sm);
int ec_config_map_add(struct ec_config *c, u16 pdo, const struct ec_pdo_entry *e);
int ec_config_map_clear(struct ec_config *c, u16 pdo);
int ec_config_sdo_add(struct ec_config *c, u16 index, u8 sub, bool complete, const u8 *data,
		      u32 size);
int ec_config_idn_add(struct ec_config *c, u8 drive, u16 idn, u8 state, const u8 *data, u32 size);
s32 ec_config_flag(const struct ec_config *c, const char *key);
int ec_config_flag_set(struct ec_config *c, const char *key, s32 value);
int ec_config_ip(struct ec_config *c, const struct ec_eoe_ip *p);
int ec_config_reg(struct ec_config *c, u16 reg, u16 value);
int ec_config_follow_sdo(struct ec_config *c, u16 index);
int ec_config_known_entries(const struct ec_config *c, u16 index, struct ec_pdo *p);
void *ec_config_alloc(struct ec_wanted *w, size_t size);
bool ec_config_changed(const struct ec_config *c, const struct ec_config_fmmu *f);
int ec_config_reg_entry(struct ec_config *c, u16 index, u8 sub, struct ec_domain *d,
			u32 *offset, u32 *bit);
int ec_config_reg_entry_pos(struct ec_config *c, u8 sm, u32 pdo_pos, u32 entry_pos,
			    struct ec_domain *d, u32 *offset, u32 *bit);

#endif
