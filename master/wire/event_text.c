// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/* Texts of events that need more than the template of their row in event.c. */
#include "event_text.h"
#include "al.h"
#include "coe.h"
#include "emergency.h"
#include "port_text.h"

#define add	ec_event_add

static void about_missed(struct ec_event_buf *t, const struct ec_event *e,
			 const struct ec_event_more *more)
{
	(void)more;
	add(t, "%llu event(s) missed: the reader was too slow",
	    (unsigned long long)((u64)e->arg[1] << 32 | e->arg[0]));
}

/* a slave by the name that the kernel knows, else by its identity */
static void identity(struct ec_event_buf *t, const struct ec_event *e, const char *name)
{
	if (e->arg[2])
		add(t, "alias %u, ", e->arg[2]);
	if (name)
		add(t, "%.40s", name);
	else
		add(t, "0x%08x/0x%08x", e->arg[3], e->arg[4]);
}

/* One port, with all that is behind it. */
static void about_place(struct ec_event_buf *t, const struct ec_event *e,
			const struct ec_event_more *more)
{
	bool lost = e->kind == EC_EVENT_SLAVE_LOST;
	u32 n = e->arg[lost ? 6 : 5];

	if (more->place)
		add(t, "behind %s: ", more->place);
	else if (e->arg[0] == EC_EVENT_NONE)
		add(t, "behind the main device: ");
	else
		add(t, "behind port %u of slave %u: ", e->arg[1], e->arg[0]);
	if (n > 1)
		add(t, "%u slaves %s, ", n, lost ? "disconnected" : "connected");
	else
		add(t, "slave ");
	add(t, "%u (", e->slave);
	identity(t, e, more->name);
	add(t, ")");
	if (n > 1)
		add(t, " to %u", e->slave + n - 1);
	else
		add(t, " %s", lost ? "disconnected" : "connected");
	if (n > 1 && more->last)
		add(t, " (%.40s)", more->last);
	if (lost)
		add(t, ", last seen %u ms ago", e->arg[5]);
}

static void about_port(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	const struct ec_port_text *text = ec_port_text(e->arg[1]);

	(void)more;
	add(t, "port %u stays closed despite its link: %s", e->arg[0], text->reason);
	if (e->arg[2])
		add(t, " (%u times in %u s; opened after 1 s of link, then after up to %u s)",
		    e->arg[2], e->arg[3], e->arg[4]);
	if (e->arg[5] || e->arg[6])
		add(t, ": 0x%08x/0x%08x", e->arg[5], e->arg[6]);
	if (e->arg[7] > 1)
		add(t, ", %u slaves", e->arg[7]);
	add(t, "; %s", text->remedy);
	if (text->device)
		add(t, ", or 'ethercat slaves -p %u --let-in %u'", e->slave, e->arg[0]);
}

static void slave_with_name(struct ec_event_buf *t, u32 slave, const char *name)
{
	add(t, "slave %u", slave);
	if (name)
		add(t, " (%.30s)", name);
}

static void about_line(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	const u32 *a = e->arg;

	if (a[1])
		add(t, "%u CRC errors", a[1]);
	if (a[2] || !a[1])
		add(t, "%s%u receiver errors", a[1] ? ", " : "", a[2]);
	add(t, " in %u s at port %u of ", a[3], a[0]);
	slave_with_name(t, e->slave, more->name);
	if (a[4] != EC_EVENT_NONE) {
		add(t, ": cable to ");
		slave_with_name(t, a[4], more->last);
	} else {
		add(t, a[6] ? ": cable to the main device" : ", where no slave is connected");
	}
	add(t, "; check that cable, its plugs and shielding");
}

static void about_ring(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	const u32 *a = e->arg;

	(void)more;
	add(t, "ring open between ");
	if (a[0] == EC_EVENT_NONE)
		add(t, "the main device");
	else if (a[1] == EC_EVENT_NONE)
		add(t, "slave %u", a[0]);
	else
		add(t, "port %u of slave %u", a[1], a[0]);
	if (a[2] == EC_EVENT_NONE)
		add(t, " and the backup device");
	else
		add(t, " and slave %u", a[2]);
	add(t, ": slaves run on, a second break is not covered; check the cable there");
}

static void about_ends(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	const char *name = more->detail ? more->detail : "the backup device";

	if (e->arg[0])
		add(t, "devices of the ring exchanged: %s is at port 0 of the first slave, and is the main device now; exchange the cables or the two names",
		    name);
	else
		add(t, "devices of the ring connected as configured");
}

static void about_back(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	(void)more;
	add(t, "back in OP, %u ms after %s last seen", e->arg[0],
	    e->arg[1] < 2 ? "it was" : "they were");
}

static void about_al(struct ec_event_buf *t, const struct ec_event *e,
		     const struct ec_event_more *more)
{
	(void)more;
	add(t, "AL state %s, before %s", ec_al_state_name((u8)e->arg[0]),
	    ec_al_state_name((u8)e->arg[1]));
	if (e->arg[3])
		add(t, ", in between %s", ec_al_state_name((u8)e->arg[3]));
}

static void about_emergency(struct ec_event_buf *t, const struct ec_event *e,
			    const struct ec_event_more *more)
{
	(void)more;
	add(t, "CoE emergency: code 0x%04x (%s), error register 0x%02x", e->arg[0],
	    ec_emergency_text((u16)e->arg[0], e->arg[4]), e->arg[1]);
}

static void about_soe(struct ec_event_buf *t, const struct ec_event *e,
		      const struct ec_event_more *more)
{
	const u32 *a = e->arg;
	unsigned int i;

	(void)more;
	add(t, "SoE %s of drive %u: IDN %c-%u-%04u, elements 0x%02x, %u byte(s)",
	    e->kind == EC_EVENT_SOE_EMERGENCY ? "emergency" : "notification", a[0],
	    a[1] & 0x8000 ? 'P' : 'S', a[1] >> 12 & 7, a[1] & 0xfff, a[2], a[3]);
	for (i = 0; i < 8 && i < a[3]; i++)
		add(t, i ? " %02x" : ": %02x", a[4 + i / 4] >> 8 * (i % 4) & 0xff);
	if (a[3] > 8)
		add(t, "...");
}

/* a startup command with its code; without one the mailbox itself failed */
static void startup(struct ec_event_buf *t, const u32 *a)
{
	if (a[2] == EC_CAUSE_IDN)
		add(t, "startup IDN 0x%04x of drive %u, SoE error 0x%04x", a[4], a[5], a[3]);
	else if (a[2] == EC_CAUSE_IP)
		add(t, "IP parameters, EoE result 0x%04x", a[3]);
	else if (a[2] == EC_CAUSE_REGISTER)
		add(t, "startup register 0x%04x", a[4]);
	else if (a[3])
		add(t, "startup SDO 0x%04x:%02x, abort 0x%08x (%s)", a[4], a[5], a[3],
		       ec_coe_abort_text(a[3]));
	else
		add(t, "startup SDO 0x%04x:%02x, mailbox failed", a[4], a[5]);
}

static void pdos(struct ec_event_buf *t, const u32 *a)
{
	if (a[3])
		add(t, "PDOs of SM%u: 0x%04x refused, abort 0x%08x (%s)", a[6], a[4], a[3],
		       ec_coe_abort_text(a[3]));
	else
		add(t, "PDOs of SM%u are not those of the slave", a[6]);
}

/* why a slave failed; nothing: only the AL status code says it */
static void cause(struct ec_event_buf *t, const u32 *a)
{
	const char *state = ec_al_state_name((u8)a[7]);

	switch (a[2]) {
	case EC_CAUSE_SILENT:
		add(t, "no reply, frames pass");
		break;
	case EC_CAUSE_REGISTERS:
		add(t, "no reply at its registers or station address, frames pass");
		break;
	case EC_CAUSE_EEPROM:
		add(t, "EEPROM not readable or invalid");
		break;
	case EC_CAUSE_SDO:
	case EC_CAUSE_IDN:
	case EC_CAUSE_REGISTER:
	case EC_CAUSE_IP:
		startup(t, a);
		break;
	case EC_CAUSE_PDO:
		pdos(t, a);
		break;
	case EC_CAUSE_LAYOUT:
		add(t, "it cannot serve the layout of the process data");
		break;
	case EC_CAUSE_SYNC:
		add(t, "SYNC signals refused, not started or not running");
		break;
	case EC_CAUSE_SLOW:
		add(t, "%s not reached in time", state);
		break;
	case EC_CAUSE_FRAMES:
		add(t, "frames lost before %s", state);
		break;
	case EC_CAUSE_MEMORY:
		add(t, "no memory before %s", state);
		break;
	case EC_CAUSE_REFUSED:
		add(t, "%s refused, AL status code 0x%04x (%s)", state, a[3],
		       ec_al_code_text((u16)a[3]));
		break;
	default:
		add(t, "AL status code 0x%04x (%s)", a[1], ec_al_code_text((u16)a[1]));
	}
}

static void about_failure(struct ec_event_buf *t, const struct ec_event *e,
			  const struct ec_event_more *more)
{
	add(t, "%s failed: ", e->arg[0] == 1 ? "scan" : "configuration");
	if (more->detail)
		add(t, "%s", more->detail);
	else
		cause(t, e->arg);
}

static void about_eeprom(struct ec_event_buf *t, const struct ec_event *e,
			 const struct ec_event_more *more)
{
	if (more->detail)
		add(t, "%s", more->detail);
	else if (e->arg[0])
		add(t, "EEPROM blank or malformed (flaw %u), the valid part is used", e->arg[0]);
	else
		add(t, "EEPROM checksum 0x%02x, expected 0x%02x; content used anyway", e->arg[1],
		    e->arg[2]);
}

static void about_wkc(struct ec_event_buf *t, const struct ec_event *e,
		      const struct ec_event_more *more)
{
	const u32 *a = e->arg;

	(void)more;
	add(t, "domain %u: working counter %u of %u", a[0], a[1], a[3]);
	/* one datagram has too much, another too little */
	if (a[6] && a[1] == a[3])
		add(t, " in sum, not of each datagram");
	add(t, ", before %u", a[2]);
	if (a[1] > a[3])
		add(t, ": more slaves answer than it has, see 'ethercat why'");
	if (a[4])
		add(t, "; %u more change(s)", a[4]);
}

static void about_stall(struct ec_event_buf *t, const struct ec_event *e,
			const struct ec_event_more *more)
{
	/* EC_STALL_* */
	static const char *const done[] = {
		"the last outputs are held", "outputs are zero", "the cycle is stopped",
	};
	const u32 *a = e->arg;

	(void)more;
	add(t, "output stall: no new outputs for %u cycle(s); %s", a[1],
	    a[0] < ARRAY_SIZE(done) ? done[a[0]] : "?");
	if (a[2])
		add(t, "; %u more stall(s) before", a[2]);
}

/* as EC_EVENT_UNIT has them */
enum unit_reason {
	UNIT_COUNTER, UNIT_LEASE, UNIT_COMMAND, UNIT_STOP,
};

static const char *unit_reason(const u32 *a)
{
	switch (a[2]) {
	case UNIT_LEASE:
		return a[1] & EC_UNIT_LEASE_ENDED ? "no new outputs within the lease" :
						    "new outputs";
	case UNIT_COMMAND:
		return a[1] & EC_UNIT_HAS_AUTHORITY ? "authority given" : "authority taken";
	case UNIT_STOP:
		return "another unit has stopped all";
	default:
		return (a[1] & 0xf) == EC_UNIT_RUN_COMPLETE ? "complete" :
							      "a slave is not in OP";
	}
}

static void about_unit(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	/* EC_UNIT_SENDS_* */
	static const char *const sends[] = {
		"outputs of the application", "outputs zero", "outputs held",
	};
	const u32 *a = e->arg;
	u32 sent = a[1] >> 4 & 0xf;

	(void)more;
	add(t, "unit %u: %s", a[0], sent < ARRAY_SIZE(sends) ? sends[sent] : "?");
	if (a[1] & EC_UNIT_DOWN)
		add(t, ", slaves to SAFEOP");
	if (a[2] == UNIT_COUNTER && a[3] != EC_EVENT_NONE && (a[1] & 0xf) == EC_UNIT_RUN_FAILED)
		add(t, ": domain %u has working counter %u of %u", a[3], a[4], a[5]);
	else
		add(t, ": %s", unit_reason(a));
	if (a[6])
		add(t, "; %u more change(s) before", a[6]);
}

static void about_ref_clock(struct ec_event_buf *t, const struct ec_event *e,
			    const struct ec_event_more *more)
{
	const u32 *a = e->arg;

	(void)more;
	if (a[1])
		add(t, "reference clock lost: ");
	if (a[0] == EC_EVENT_NONE)
		add(t, "clocks run free");
	else if (a[2])
		add(t, "slave %u substitutes until it returns", a[0]);
	else
		add(t, "slave %u is the new reference clock", a[0]);
}

static void about_dc_failed(struct ec_event_buf *t, const struct ec_event *e,
			    const struct ec_event_more *more)
{
	(void)more;
	add(t, "distributed clocks not synchronized (");
#ifdef __KERNEL__
	add(t, "%pe", ERR_PTR(-(long)min_t(u32, e->arg[0], MAX_ERRNO)));
#else
	add(t, "%s", strerror((int)(e->arg[0] & 0xfff)));
#endif
	add(t, ")%s", e->arg[1] ? "; retrying" : "");
}

static void about_window(struct ec_event_buf *t, const struct ec_event *e,
			 const struct ec_event_more *more)
{
	const u32 *a = e->arg;

	(void)more;
	if (a[0])
		add(t, "%u of %u clocks outside the sync window, worst: slave %u by %u ns", a[0],
		    a[1], a[2], a[3]);
	else
		add(t, "all %u clocks inside the sync window", a[1]);
}

static void about_lock(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	/* EC_CYCLE_LOCK_* */
	static const char *const locks[] = {
		"off", "seeking", "locked", "in holdover, reference clock not answering",
	};
	const u32 *a = e->arg;

	(void)more;
	add(t, "kernel cycle %s%s: phase error %d ns, rate %+d ppb",
	    a[0] == 1 && a[3] ? "lost lock, " : "",
	    a[0] < ARRAY_SIZE(locks) ? locks[a[0]] : "?", (s32)a[1], (s32)a[2]);
}

/* why a configuration has no slave */
static void about_config(struct ec_event_buf *t, const struct ec_event *e,
			 const struct ec_event_more *more)
{
	const u32 *a = e->arg;

	add(t, "configuration %u:%u: ", a[0], a[1]);
	if (more->detail)
		add(t, "%s", more->detail);
	else if (a[2] == EC_CAUSE_NO_ALIAS)
		add(t, "no slave has alias %u", a[0]);
	else if (a[2] == EC_CAUSE_RING)
		add(t, "the ring is open: which slave is at its position is not certain");
	else if (a[2] == EC_CAUSE_DIFFERENT)
		add(t, "slave %u is 0x%08x/0x%08x, configured is 0x%08x/0x%08x", e->slave, a[5],
		    a[6], a[3], a[4]);
	else if (a[2] == EC_CAUSE_TAKEN)
		add(t, "slave %u has another configuration", e->slave);
	else if (a[2] == EC_CAUSE_UNATTACHED)
		add(t, "slave %u is not attached yet", e->slave);
	else if (e->slave != EC_EVENT_NO_SLAVE)
		add(t, "slave %u could not be read", e->slave);
	else
		add(t, "no slave (0x%08x/0x%08x) at its position", a[3], a[4]);
}

static void about_group(struct ec_event_buf *t, const struct ec_event *e,
			const struct ec_event_more *more)
{
	const u32 *a = e->arg;

	if (more->name)
		add(t, "%sgroup %s: ", a[2] ? "mandatory " : "", more->name);
	else
		add(t, "%sgroup %u: ", a[2] ? "mandatory " : "", a[0]);
	if (a[1] == EC_CAUSE_NONE)
		add(t, "connected, %u slave(s) from slave %u on", a[3], e->slave);
	else
		add(t, "not %s", a[1] == EC_CAUSE_NO_GROUP ? "connected" : "started");
	if (more->detail)
		add(t, ": %s", more->detail);
	else if (a[1] == EC_CAUSE_GROUP)
		add(t, " because of slave %u; see 'ethercat why'", e->slave);
}

/**
 * ec_event_text_add() - append the text of an event whose row has no template
 * @t: text
 * @e: event; nothing in it is trusted
 * @more: what the record does not contain
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_event_text_add(struct ec_event_buf *t, const struct ec_event *e,
		       const struct ec_event_more *more)
{
	static const struct {
		u32 kind;
		void (*about)(struct ec_event_buf *t, const struct ec_event *e,
			      const struct ec_event_more *more);
	} texts[] = {
		{ EC_EVENT_MISSED, about_missed },
		{ EC_EVENT_SLAVE_LOST, about_place },
		{ EC_EVENT_RING_OPEN, about_ring },
		{ EC_EVENT_RING_EXCHANGED, about_ends },
		{ EC_EVENT_SLAVE_FOUND, about_place },
		{ EC_EVENT_PORT_KEPT, about_port },
		{ EC_EVENT_LINE_ERRORS, about_line },
		{ EC_EVENT_SLAVE_BACK, about_back },
		{ EC_EVENT_AL_STATE, about_al },
		{ EC_EVENT_EMERGENCY, about_emergency },
		{ EC_EVENT_SOE_NOTIFICATION, about_soe },
		{ EC_EVENT_SOE_EMERGENCY, about_soe },
		{ EC_EVENT_SLAVE_FAILED, about_failure },
		{ EC_EVENT_EEPROM, about_eeprom },
		{ EC_EVENT_WKC, about_wkc },
		{ EC_EVENT_STALL, about_stall },
		{ EC_EVENT_UNIT, about_unit },
		{ EC_EVENT_REF_CLOCK, about_ref_clock },
		{ EC_EVENT_DC_FAILED, about_dc_failed },
		{ EC_EVENT_DC_WINDOW, about_window },
		{ EC_EVENT_LOCK, about_lock },
		{ EC_EVENT_CONFIG, about_config },
		{ EC_EVENT_GROUP, about_group },
	};
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(texts); i++)
		if (texts[i].kind == e->kind)
			texts[i].about(t, e, more);
}
