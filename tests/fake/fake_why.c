// SPDX-License-Identifier: GPL-2.0-only
/*
 * Fake master: what is wrong with it. FAKE_WHY names causes, separated by spaces: all slaves are
 * in OP except for what these change.
 */
#include <stdlib.h>
#include <string.h>

#include "fake.h"

static bool wrong(const char *name)
{
	const char *all = getenv("FAKE_WHY"), *at = all;
	size_t n = strlen(name);

	while (at && (at = strstr(at, name))) {
		if ((at == all || at[-1] == ' ') && (!at[n] || at[n] == ' '))
			return true;
		at += n;
	}
	return false;
}

void fake_why_master(struct fake_master *m)
{
	static __u64 late;

	if (!getenv("FAKE_WHY"))
		return;
	m->no_cycle = wrong("no_cycle");
	if (wrong("no_device"))
		m->phase = EC_PHASE_WAITING;
	if (wrong("link_down"))
		m->devices[0].link_up = m->links_up = 0;
	if (wrong("no_slaves"))
		m->slave_count = m->slaves_responding = 0;
	if (wrong("scan"))
		m->scan_busy = 1;
	if (wrong("lost_frames"))
		m->devices[0].loss_rate[0] = m->devices[0].loss_rate[1] = 5;
	else
		memset(m->devices[0].loss_rate, 0, sizeof(m->devices[0].loss_rate));
	/* one more each time */
	if (wrong("late_frames"))
		m->devices[0].late = ++late;
	if (wrong("sync_cycle"))
		m->cycle_interval_us = 1300;
	if (wrong("cycle_too_short"))
		m->cycle_wire_ns = 1500000;
}

void fake_why_slave(struct fake_slave *s)
{
	if (!getenv("FAKE_WHY"))
		return;
	if (!s->position || fake_bus("app"))
		s->al_status = s->al_requested = s->position ? 8 : 2;
	s->al_code = 0;
	s->error = 0;
	s->why[0] = '\0';
	s->config = s->position;
	if (!fake_bus("app")) {
		s->config = 0;
		s->al_status = s->al_requested = 2;
	}
	s->dc_set = s->position == 2;
	if (!s->position && wrong("id_loaded"))
		s->al_status |= 0x20;	/* no part of the state */
	if (s->position == 2 && wrong("boot"))
		s->al_requested = 3;
	if (s->position == 2 && wrong("eeprom")) {
		strcpy(s->warning, "EEPROM checksum 0x12, expected 0x34; content used anyway");
		s->cause.kind = EC_CAUSE_EEPROM;
	}
	if (!s->position && wrong("alias_other"))
		s->alias = 1;
	if (s->position == 2 && wrong("alias_twice")) {
		strcpy(s->warning, "alias 5 is not unique; configurations use slave 1, the first one");
		s->cause.kind = EC_CAUSE_ALIAS_TWICE;
	}
	if (s->position == 2 && wrong("drive"))
		s->mbox_protocols |= 1 << 4;
	if (s->position == 2 && wrong("process_data"))
		strcpy(s->warning, "process data of SM2 may belong to other objects");
	if (s->position == 2 && wrong("clock_off"))
		s->dc_diff = -4711;
	if (s->position == 2 && wrong("clock_not_set"))
		s->dc_set = 0;
	if (s->position == 0 && wrong("unreadable")) {
		s->error = 1;
		strcpy(s->why, "SII read failed at word 0x0000: no acknowledgment; check the slave");
		s->cause.kind = EC_CAUSE_EEPROM;
	}
}

static void config(struct ec_ioc_config *c)
{
	bool absent = wrong("cable") || wrong("different") || wrong("wrong_place") ||
		      wrong("missing") || wrong("no_alias") || wrong("alias_other") ||
		      wrong("group_absent") || wrong("group_not_started") ||
		      wrong("ring_place") || wrong("older");

	c->slave_position = c->index && absent ? -1 : (__s32)c->index + 1;
	c->al_status = 8;
	c->state = EC_STATUS_SC_OP | EC_STATUS_SC_ONLINE | 8;
	if (wrong("wrong_place") && c->index)
		c->product_code = 0x044c2c52;
	if (wrong("alias_other") && c->index)
		c->alias = 11;
	if (wrong("missing") && c->index)
		c->position = getenv("FAKE_FAR") ? 9 : 3;
}

static const struct {
	const char *name;
	struct ec_cause cause;
	const char *text;
} causes[] = {
	{ "cable", { .kind = EC_CAUSE_LOST, .position = 1, .port = 1 },
	  "slave 2 (EL7201) disconnected from port 1 of slave 1 (EL2008), last seen 3 s ago" },
	{ "different", { .kind = EC_CAUSE_DIFFERENT, .position = 2 },
	  "slave 2 is 0x00000002/0x1c213052, configured is 0x00000002/0x1c213053" },
	{ "wrong_place", { .kind = EC_CAUSE_DIFFERENT, .position = 2 },
	  "slave 2 is 0x00000002/0x1c213052, configured is 0x00000002/0x044c2c52" },
	{ "missing", { .kind = EC_CAUSE_NO_SLAVE, .position = 3 },
	  "no slave at ring position 3: 3 slave(s) connected" },
	{ "alias_other", { .kind = EC_CAUSE_NO_ALIAS },
	  "none of the 3 slave(s) on the bus has alias 11" },
	{ "no_alias", { .kind = EC_CAUSE_NO_ALIAS },
	  "none of the 3 slave(s) on the bus has alias 0" },
	{ "group_absent", { .kind = EC_CAUSE_NO_GROUP, .position = 0xffff },
	  "group tool: no slave has identification 6" },
	{ "group_not_started", { .kind = EC_CAUSE_GROUP, .position = 1 },
	  "group tool: slave 1 is not at port 1 of slave 0: connect it there" },
	{ "ring_place", { .kind = EC_CAUSE_RING, .position = 3 },
	  "ring position 3 not certain: the ring is open (3 connected)" },
	{ "older", { .kind = EC_CAUSE_NONE }, "a reason of an older module" },
	{ "no_cycle", { .kind = EC_CAUSE_NO_CYCLE },
	  "AL state SAFEOP; cycle timeout: the application sends no cyclic frames" },
	{ "not_requested", { .kind = EC_CAUSE_REQUESTED, .state = 2 },
	  "AL state PREOP, requested PREOP" },
	{ "under_way", { .kind = EC_CAUSE_UNDER_WAY },
	  "AL state SAFEOP on the way to OP, waiting for two cycles of its domains" },
	{ "boot", { .kind = EC_CAUSE_REQUESTED, .state = 3 }, "AL state BOOT, requested BOOT" },
	{ "no_reply", { .kind = EC_CAUSE_SILENT },
	  "no reply from the slave, frames pass; waiting for a reply" },
	{ "sdo", { .kind = EC_CAUSE_SDO, .object = 0x8010, .subindex = 3, .code = 0x06020000 },
	  "startup SDO 0x8010:03 (2 byte(s)) failed: abort 0x06020000: the object does not exist" },
	{ "mailbox", { .kind = EC_CAUSE_SDO, .object = 0x8010, .subindex = 3 },
	  "startup SDO 0x8010:03 (2 byte(s)) failed: no reply in the mailbox" },
	{ "pdo", { .kind = EC_CAUSE_PDO, .sm = 2, .object = 0x1600, .code = 0x06010002 },
	  "SM2 bit 0: registered 0x7010:01, 16 bit; slave has 0x7010:06, 16 bit; PDO mapping 0x1600 refused: abort 0x06010002 (read only)" },
	{ "local", { .kind = EC_CAUSE_SDO, .object = 0x8010, .subindex = 3, .code = 0x08000021 },
	  "startup SDO 0x8010:03 (2 byte(s)) failed: abort 0x08000021: the device is under local control" },
	{ "length", { .kind = EC_CAUSE_SDO, .object = 0x8010, .subindex = 3, .code = 0x06070012 },
	  "startup SDO 0x8010:03 (2 byte(s)) failed: abort 0x06070012: the length is too high" },
	{ "direction", { .kind = EC_CAUSE_REFUSED, .state = 4, .code = 0x0017 },
	  "SAFEOP refused: AL status code 0x0017 (SyncManager configuration invalid)" },
	{ "unsent_waits", { .kind = EC_CAUSE_UNDER_WAY },
	  "AL state SAFEOP on the way to OP, waiting for two cycles of its domains" },
	{ "al_refused", { .kind = EC_CAUSE_REFUSED, .state = 4, .code = 0x001d },
	  "SAFEOP refused: AL status code 0x001d (invalid output configuration)" },
	{ "watchdog", { .kind = EC_CAUSE_AL_ERROR, .state = 4, .code = 0x001b },
	  "AL state SAFEOP with error, AL status code 0x001b (watchdog)" },
	{ "al_timeout", { .kind = EC_CAUSE_SLOW, .state = 4 },
	  "SAFEOP not reached in time, AL state PREOP" },
	{ "sync", { .kind = EC_CAUSE_SYNC },
	  "SYNC signals started but not running (0x0984 = 0x01)" },
};

static void config_why(struct ec_ioc_config_why *x)
{
	x->text[0] = '\0';
	for (size_t i = 0; x->index == 1 && i < LEN(causes); i++)
		if (wrong(causes[i].name)) {
			x->cause = causes[i].cause;
			snprintf(x->text, sizeof(x->text), "%s", causes[i].text);
		}
}

static void cycle(struct ec_ioc_cycle_stats *x)
{
	struct ec_status_cycle *st = (struct ec_status_cycle *)(uintptr_t)x->data;

	if (x->size != sizeof(*st))
		return;
	st->overruns = wrong("overruns") ? 500 : 3;
	if (wrong("stall_zero") || wrong("stall_stop")) {
		x->kind = EC_CYCLE_BY_KERNEL;
		x->stall = wrong("stall_zero") ? EC_STALL_ZERO : EC_STALL_STOP;
		st->state = wrong("stall_zero") ? EC_CYCLE_STATE_STALLED : EC_CYCLE_STATE_STOPPED;
	}
}

static void domain(struct ec_ioc_domain *x)
{
	if ((wrong("unsent") || wrong("unsent_waits") || wrong("unsent_late")) && x->index) {
		x->working_counter = 0;
		x->wc_state = EC_STATUS_WC_ZERO;
		x->unsent = wrong("unsent_late") ? 99 : 100;
	}
	if (wrong("cancelled") && x->index)
		x->wc_state = EC_STATUS_WC_INCOMPLETE;
	if (!(wrong("working_counter") || wrong("too_high")) || !x->index)
		return;
	x->working_counter = wrong("too_high") ? 4 : 2;
	x->wc_state = EC_STATUS_WC_INCOMPLETE;
}

/* Unit 0 with domain 1. Return: there is one */
bool fake_why_unit(struct ec_ioc_unit_info *x)
{
	static const struct {
		const char *name;
		__u32 policy;
		__u32 state;
	} units[] = {
		{ "unit_down", EC_UNIT_POLICY_SAFEOP,
		  EC_UNIT_RUN_FAILED | EC_UNIT_SENDS_ZERO << 4 | EC_UNIT_DOWN | 1 << 16 },
		{ "unit_stopped", EC_UNIT_POLICY_STOP,
		  EC_UNIT_RUN_FAILED | EC_UNIT_SENDS_ZERO << 4 | EC_UNIT_DOWN | 1 << 16 },
		{ "unit_lease", EC_UNIT_POLICY_ZERO, EC_UNIT_RUN_COMPLETE |
		  EC_UNIT_SENDS_HELD << 4 | EC_UNIT_HAS_AUTHORITY | EC_UNIT_LEASE_ENDED },
		{ "no_authority", EC_UNIT_POLICY_ZERO,
		  EC_UNIT_RUN_COMPLETE | EC_UNIT_SENDS_ZERO << 4 },
	};

	for (unsigned int i = 0; !x->index && i < sizeof(units) / sizeof(units[0]); i++) {
		if (!wrong(units[i].name))
			continue;
		*x = (struct ec_ioc_unit_info){
			.policy = units[i].policy, .state = units[i].state, .active = 1,
			.domains = 2, .lease_cycles = 50, .limit = 3, .repeats = 1, .name = "axes",
		};
		return true;
	}
	return false;
}

static void counters(struct ec_ioc_reg *x)
{
	/* slave 0 has an FMMU in domain 1, slave 2 that of its configuration */
	if (x->address == 0x0600 && wrong("too_high") && x->slave.position != 1)
		memcpy((__u8 *)(uintptr_t)x->data, "\1\0\0\0\6\0\0\7\0\x11\0\1\1", 13);
	if (wrong("free_port") && x->slave.position == 2)
		((__u8 *)(uintptr_t)x->data)[6] = 7;	/* at port 3 */
	if (wrong("both_ends") && x->slave.position == 1)
		*(__u8 *)(uintptr_t)x->data = 2;	/* at port 0 */
}

static void emergency(struct ec_ioc_emergencies *x)
{
	struct ec_emergency *last;

	if (!wrong("emergency") || x->slave.position != 2)
		return;
	x->profile = 402;
	last = (struct ec_emergency *)(uintptr_t)(x->data + x->size) - 1;
	last->code = 0x7305;
}

/* its second drive */
static void drive(struct ec_ioc_soe *x)
{
	__u8 *data = (__u8 *)(uintptr_t)x->data;

	if (!wrong("drive_error") || x->drive != 1)
		return;
	if (x->idn == 11)
		memcpy(data, "\x80\x80", 2);
	else if (x->idn == 390 && wrong("old_drive"))
		x->size = 0;
	else if (x->idn == 390)
		memcpy(data, "\x19\x20\x0f\xf0", 4);
	else if (x->idn == 95)
		memcpy(data, "\xff\0\x20\0F219\33 hot", 12);	/* the length is wrong */
}

/* Changes the reply to a command that was done. */
void fake_why(unsigned long request, void *arg)
{
	if (!getenv("FAKE_WHY"))
		return;
	switch (request) {
	case EC_IOC_CONFIG: {
		struct ec_ioc_config_why w = { .index = ((struct ec_ioc_config *)arg)->index };

		config(arg);
		config_why(&w);
		if (w.text[0])
			((struct ec_ioc_config *)arg)->state = EC_STATUS_SC_ONLINE | 4;
		break;
	}
	case EC_IOC_CONFIG_WHY:
		config_why(arg);
		break;
	case EC_IOC_CYCLE_STATS:
		cycle(arg);
		break;
	case EC_IOC_DOMAIN:
		domain(arg);
		break;
	case EC_IOC_EMERGENCIES:
		emergency(arg);
		break;
	case EC_IOC_SOE_READ:
		drive(arg);
		break;
	case EC_IOC_REG_READ:
		counters(arg);
		break;
	default:
		break;
	}
}
