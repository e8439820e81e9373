// SPDX-License-Identifier: GPL-2.0-only
/* Causes of slaves that are there: one function or one row for each kind. */
#include <stdio.h>
#include <string.h>

#include "../master/wire/al.h"
#include "../master/wire/regs.h"
#include "../master/wire/sii.h"
#include "why.h"

#define CODE_WATCHDOG	0x001b
#define DIR_OUTPUT	1	/* of struct ec_ioc_config_sm */

/* this version writes no EEPROM */
#define EEPROM_REMEDY \
	"repair the EEPROM with the tool of the manufacturer, or replace the slave; its content: 'ethercat sii_read -v'"

/* what to do about an AL status code; others have a general remedy */
static const struct {
	u16 code;
	const char *remedy;
} al_remedies[] = {
	{ 0x0014, "load the firmware of the slave: 'ethercat firmware'" },
	{ 0x0016, "power-cycle the slave; if it stays, compare its mailbox ('ethercat slaves -v') with the manual, ask the manufacturer" },
	{ 0x0019, "let the application send outputs before the slave is in OP" },
	{ 0x001b, "let the application send in each cycle, or lengthen the watchdog: ecrt_slave_config_watchdog()" },
	{ 0x001d, "compare the outputs that are configured with those of the slave: 'ethercat config -v', 'ethercat pdos'" },
	{ 0x001e, "compare the inputs that are configured with those of the slave: 'ethercat config -v', 'ethercat pdos'" },
	{ 0x001f, "correct the watchdog, or leave that of the slave: ecrt_slave_config_watchdog()" },
	{ 0x0024, "map inputs that the slave has: 'ethercat pdos'" },
	{ 0x0025, "map outputs that the slave has: 'ethercat pdos'" },
	{ 0x002c, "check AssignActivate and cycle times against the ESI: ecrt_slave_config_dc()" },
	{ 0x002d, "check AssignActivate against the ESI: ecrt_slave_config_dc()" },
	{ 0x0030, "check AssignActivate against the ESI: ecrt_slave_config_dc()" },
	{ 0x0035, "configure a cycle time that the slave supports: ecrt_slave_config_dc()" },
};

static const char *al_remedy(u32 code)
{
	for (size_t i = 0; i < ARRAY_SIZE(al_remedies); i++)
		if (al_remedies[i].code == code)
			return al_remedies[i].remedy;
	return "look up the code in the manual of the slave; see also its messages: 'ethercat diag', 'ethercat emergencies'";
}

/* kinds whose finding is the kernel's text and a remedy */
static const struct {
	u32 kind;
	bool warning;
	const char *cause;
	const char *remedy;
} kinds[] = {
	{ EC_CAUSE_REQUESTED, false, "not_requested",
	  "" },
	{ EC_CAUSE_UNDER_WAY, false, "under_way",
	  "repeat the command; nothing has failed so far" },
	{ EC_CAUSE_SILENT, false, "no_reply",
	  "power-cycle the slave; replace it if it stays silent" },
	{ EC_CAUSE_REGISTERS, false, "no_reply",
	  "check the cables of the slave; power-cycle or replace it" },
	{ EC_CAUSE_EEPROM, false, "eeprom",
	  EEPROM_REMEDY },
	{ EC_CAUSE_EEPROM_PART, true, "eeprom_reading",
	  "wait until the EEPROM has been read" },
	{ EC_CAUSE_IDN, false, "idn",
	  "correct the startup IDN in the application: 'ethercat soe_read'" },
	{ EC_CAUSE_REGISTER, false, "register",
	  "correct the startup register in the application" },
	{ EC_CAUSE_IP, false, "ip",
	  "correct the IP parameters in the application, or remove them" },
	{ EC_CAUSE_LAYOUT, false, "layout",
	  "change domains and PDOs of the application as the text says" },
	{ EC_CAUSE_SYNC, false, "sync",
	  "correct the SYNC signals in the application: ecrt_slave_config_dc(); compare with the ESI" },
	{ EC_CAUSE_SLOW, false, "al_timeout",
	  "check that the application of the slave runs: LEDs, 'ethercat diag'; or allow more time: ecrt_slave_config_state_timeout(), state_timeout_ms of ec_master" },
	{ EC_CAUSE_FRAMES, false, "frames",
	  "look for the cable with errors: 'ethercat crc'" },
	{ EC_CAUSE_MEMORY, false, "memory",
	  "free memory of this computer; the master tries again" },
};

static struct why_finding *by_table(struct why *w, const struct ec_cause *cause, const char *text)
{
	for (size_t i = 0; i < ARRAY_SIZE(kinds); i++) {
		struct why_finding *f;

		if (kinds[i].kind != cause->kind)
			continue;
		f = why_add(w, kinds[i].cause, kinds[i].remedy, "%s", text);
		f->warning = kinds[i].warning;
		f->wait = cause->kind == EC_CAUSE_UNDER_WAY;
		return f;
	}
	/* an older module, or a cause that is new to this tool */
	return why_add(w, "not_in_op", "see 'ethercat config -v' and the kernel log", "%s", text);
}

/* what to do about an abort code of which more is known than that the SDO is wrong */
static const struct {
	u32 code;
	u32 mask;
	const char *remedy;
} sdo_remedies[] = {
	{ 0x06070010, 0xfffffffc,
	  "give the startup SDO the length that the object has: 'ethercat sdos'" },
	{ 0x06090030, 0xfffffffc,
	  "give the startup SDO a value that the slave takes: limits in 'ethercat sdos -v', or the manual" },
	{ 0x08000020, 0xfffffffe,
	  "release the local control of the slave (panel, other fieldbus), then restart the application" },
	{ 0, 0,
	  "correct or remove the startup SDO in the application: 'ethercat sdos', 'ethercat config -v'" },
};

/* without an abort code the mailbox itself failed */
static struct why_finding *sdo(struct why *w, const struct ec_cause *cause, const char *text)
{
	struct why_finding *f;
	size_t i = 0;

	while ((cause->code & sdo_remedies[i].mask) != sdo_remedies[i].code)
		i++;
	if (cause->code)
		f = why_add(w, "sdo", sdo_remedies[i].remedy, "%s", text);
	else
		f = why_add(w, "mailbox",
			    "power-cycle the slave: its mailbox does not reply as the protocol demands; if that stays, compare its mailbox and protocols ('ethercat slaves -v') with the manual",
			    "%s", text);
	f->code = cause->code;
	return f;
}

static struct why_finding *pdo(struct why *w, const struct why_config *c,
			       const struct ec_cause *cause, const char *text)
{
	struct why_finding *f;
	char lists[WHY_TEXT - EC_UAPI_REASON] = "";

	if (c)
		why_pdo_lists(w, c, cause->sm, lists, sizeof(lists));
	f = why_add(w, "pdo",
		    "configure the PDOs that the slave has ('ethercat cstruct' writes them), or set flag AcceptOtherPdos, but only if its manual says that these are the same objects at the same offsets",
		    "%s; %s", text, lists);
	f->code = cause->code;
	return f;
}

/* The SyncManager that is configured against its direction in the slave, or -1. */
static int against(struct why *w, const struct why_config *c, bool *output)
{
	for (__u8 sm = 0; sm < EC_MAX_SM; sm++) {
		struct ec_ioc_config_sm want = { .index = c->c.index, .sm = sm };
		struct ec_ioc_sm have = {
			.slave = { .kind = EC_ADDRESS_DEVICE, .device = c->c.device }, .sm = sm,
		};

		if (dev_ioctl(w->d, EC_IOC_SM, &have))
			continue;
		*output = (have.control & EC_SM_DIR_MASK) == EC_SM_DIR_WRITE;
		if (!dev_ioctl(w->d, EC_IOC_CONFIG_SM, &want) && want.dir &&
		    (want.dir == DIR_OUTPUT) != *output)
			return sm;
	}
	return -1;
}

static struct why_finding *al(struct why *w, const struct why_config *c,
			      const struct ec_cause *cause, const char *text)
{
	const char *name = cause->code == CODE_WATCHDOG ? "watchdog" :
			   cause->kind == EC_CAUSE_REFUSED ? "al_refused" : "al_error";
	struct why_finding *f;
	bool output = false;
	int sm = -1;

	if (c && cause->kind == EC_CAUSE_REFUSED && cause->state == EC_AL_SAFEOP)
		sm = against(w, c, &output);
	if (sm < 0)
		f = why_add(w, name, al_remedy(cause->code), "%s", text);
	else
		f = why_add(w, name,
			    "correct the direction of this SyncManager in the application; 'ethercat cstruct' writes what the slave has",
			    "%s; SM%d is configured for %s, the slave has it for %s", text, sm,
			    output ? "inputs" : "outputs", output ? "outputs" : "inputs");
	f->code = cause->code;
	return f;
}

/* what it takes to begin anew, with the place */
static void again(struct why_finding *f, const struct ec_cause *cause)
{
	size_t len = strlen(f->remedy);

	switch (cause->kind) {
	case EC_CAUSE_REQUESTED:
		why_remedy(f, "the tool or an error has requested this state: 'ethercat states OP -p %d', or restart the application",
			   f->slave);
		break;
	case EC_CAUSE_REFUSED:
	case EC_CAUSE_SLOW:
		snprintf(f->remedy + len, sizeof(f->remedy) - len,
			 "; the master tries again by itself, at once with 'ethercat states %s -p %d'",
			 cause->state == EC_AL_PREOP ? "PREOP" : "OP", f->slave);
		break;
	}
}

static void add(struct why *w, int position, struct why_config *c, const struct ec_cause *cause,
		const char *text)
{
	struct why_finding *f;

	switch (cause->kind) {
	case EC_CAUSE_SDO:
		f = sdo(w, cause, text);
		break;
	case EC_CAUSE_PDO:
		f = pdo(w, c, cause, text);
		break;
	case EC_CAUSE_REFUSED:
	case EC_CAUSE_AL_ERROR:
		f = al(w, c, cause, text);
		break;
	default:
		f = by_table(w, cause, text);
		break;
	}
	f->slave = position;
	again(f, cause);
	if (!c)
		return;
	f->config = (int)(c - w->configs);
	why_explain(w, c);
}

/* Somebody loads firmware into it, or has forgotten it there. */
static bool in_boot(struct why *w, const struct slave *s, struct why_config *c)
{
	struct why_finding *f;

	if (s->al_requested != EC_AL_BOOT)
		return false;
	f = why_add(w, "boot", "",
		    "state BOOT is requested, as for a firmware update; AL state %s",
		    ec_al_state_name((u8)s->al_status));
	f->slave = s->position;
	why_remedy(f, "wait for the end of the firmware update, then 'ethercat states PREOP -p %u'",
		   s->position);
	f->warning = !c;
	if (!c)
		return true;
	f->config = (int)(c - w->configs);
	why_explain(w, c);
	return true;
}

/* A slave without configuration has to reach what was requested, PREOP as a rule. */
static void unconfigured(struct why *w, const struct slave *s)
{
	struct ec_cause cause = s->cause;
	char text[EC_UAPI_REASON];

	if (in_boot(w, s, NULL))
		return;
	if (s->error) {
		add(w, s->position, NULL, &cause, s->why);
	} else if (s->al_status & EC_AL_ERROR) {
		cause = (struct ec_cause){ .kind = EC_CAUSE_AL_ERROR, .code = s->al_code };
		snprintf(text, sizeof(text), "AL state %s with error, AL status code 0x%04x (%s)",
			 ec_al_state_name((u8)s->al_status), s->al_code,
			 ec_al_code_text(s->al_code));
		add(w, s->position, NULL, &cause, text);
	} else if ((s->al_status & EC_AL_STATE_MASK) != s->al_requested) {
		cause = (struct ec_cause){ .kind = EC_CAUSE_UNDER_WAY };
		snprintf(text, sizeof(text), "AL state %s, requested %s",
			 ec_al_state_name((u8)s->al_status), ec_al_state_name(s->al_requested));
		add(w, s->position, NULL, &cause, text);
	}
}

/* The slave of a configuration: why it is not in OP. */
static void configured(struct why *w, struct why_config *c)
{
	int position = c->c.slave_position;

	if (c->finding || !c->text[0])
		return;
	if (position < 0 && c->cause.kind >= EC_CAUSE_SILENT)
		position = c->cause.position;	/* what is there cannot be read */
	if (position >= 0 && (size_t)position < w->bus.n &&
	    in_boot(w, &w->bus.v[position], c))
		return;
	/* what fails is reported before activation, too; the rest is no fault until then */
	if (c->cause.kind == EC_CAUSE_INACTIVE)
		return;
	add(w, position, c, &c->cause, c->text);
}

/* Used all the same, but not as it should be. */
static void warnings(struct why *w, const struct slave *s)
{
	struct why_finding *f;

	if (!s->warning[0] || s->error)
		return;
	if (s->cause.kind == EC_CAUSE_EEPROM)
		f = why_add(w, "eeprom", EEPROM_REMEDY, "%s", s->warning);
	else if (s->cause.kind == EC_CAUSE_ALIAS_TWICE)
		f = why_add(w, "alias_twice",
			    "set another alias with the tool of the manufacturer (this version writes no EEPROM), or use ring positions",
			    "%s", s->warning);
	else if (s->cause.kind == EC_CAUSE_MAILBOX)
		f = why_add(w, "mailbox",
			    "nothing while the slave works; if it refuses PREOP or SAFEOP with 0x0016, or SDOs fail, compare its mailbox ('ethercat slaves -v') with the manual",
			    "%s", s->warning);
	else if (s->differs)
		f = why_add(w, "revision",
			    "connect a slave of that revision, or correct flag ExpectedRevision",
			    "%s", s->warning);
	else
		f = why_add(w, "process_data",
			    s->mbox_protocols & EC_SII_PROTO_COE ?
			    "compare 'ethercat pdos --coe' with the configuration: 'ethercat config -v'" :
			    "compare 'ethercat pdos' with the configuration: 'ethercat config -v'; 'ethercat cstruct' writes the names of the slave",
			    "%s", s->warning);
	f->slave = s->position;
	f->warning = true;
}

/* told as that of its configuration, or of one that expects another slave in its place */
static bool told(const struct why *w, const struct slave *s)
{
	for (size_t i = 0; i < w->n; i++)
		if (w->f[i].slave == s->position && w->f[i].port == WHY_NONE &&
		    w->f[i].config != WHY_NONE)
			return true;
	return false;
}

/**
 * why_slaves() - why slaves are not in the state that is requested
 * @w: what is known
 */
void why_slaves(struct why *w)
{
	for (size_t i = 0; i < w->n_configs; i++)
		if (!why_in_op(&w->configs[i]))
			configured(w, &w->configs[i]);
	for (size_t i = 0; i < w->bus.n; i++) {
		const struct slave *s = &w->bus.v[i];
		bool active = w->m.active && s->config && !s->differs;

		if (!active && !told(w, s))
			unconfigured(w, s);
		warnings(w, s);
	}
}
