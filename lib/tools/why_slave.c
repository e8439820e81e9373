// SPDX-License-Identifier: LGPL-2.1-or-later
/* Causes of slaves that are present: one function or one row for each kind. */
#include <stdio.h>
#include <string.h>

#include "../../master/wire/al.h"
#include "../../master/wire/regs.h"
#include "../../master/wire/sii.h"
#include "why.h"

#define CODE_WATCHDOG	0x001b

/* kinds whose finding is the kernel's text and a remedy */
static const struct {
	u32 kind;
	enum why_text text;
} kinds[] = {
	{ ECT_CAUSE_REQUESTED, WHY_REQUESTED },
	{ ECT_CAUSE_UNDER_WAY, WHY_UNDER_WAY },
	{ ECT_CAUSE_SILENT, WHY_SILENT },
	{ ECT_CAUSE_REGISTERS, WHY_REGISTERS },
	{ ECT_CAUSE_EEPROM, WHY_EEPROM },
	{ ECT_CAUSE_EEPROM_PART, WHY_EEPROM_PART },
	{ ECT_CAUSE_IDN, WHY_IDN },
	{ ECT_CAUSE_REGISTER, WHY_REGISTER },
	{ ECT_CAUSE_IP, WHY_IP },
	{ ECT_CAUSE_LAYOUT, WHY_LAYOUT },
	{ ECT_CAUSE_SYNC, WHY_SYNC },
	{ ECT_CAUSE_SLOW, WHY_SLOW },
	{ ECT_CAUSE_FRAMES, WHY_FRAMES },
	{ ECT_CAUSE_MEMORY, WHY_MEMORY },
};

static struct ect_finding *by_table(struct why *w, const struct ect_cause *cause, const char *text)
{
	for (size_t i = 0; i < ARRAY_SIZE(kinds); i++)
		if (kinds[i].kind == cause->kind)
			return why_add_finding(w, kinds[i].text, "%s", text);
	/* an older module, or a cause that is new to this library */
	return why_add(w, NOT_IN_OP, text);
}

/* without an abort code the mailbox itself failed */
static struct ect_finding *sdo(struct why *w, const struct ect_cause *cause, const char *text)
{
	struct ect_finding *f;

	if (!cause->code)
		return why_add(w, MAILBOX, text);
	f = why_add(w, SDO, text);
	why_remedy(f, PLAIN, why_sdo_remedy(cause->code));
	f->code = cause->code;
	return f;
}

static struct ect_finding *pdo(struct why *w, const struct ect_explained *c,
			       const struct ect_cause *cause, const char *text)
{
	char lists[sizeof(w->lost.text) - ECT_TEXT] = "";
	struct ect_finding *f;

	if (c)
		why_pdo_lists(w, c, cause->sm, lists, sizeof(lists));
	f = why_add(w, PDO, text, lists);
	f->code = cause->code;
	return f;
}

/* The SyncManager that is configured against its direction in the slave, or -1. */
static int against(struct why *w, const struct ect_explained *c, bool *output)
{
	u64 device;

	if ((size_t)c->config.slave_position >= w->bus->n)
		return -1;
	device = why_slave(w, (size_t)c->config.slave_position)->device;
	for (unsigned int sm = 0; sm < EC_MAX_SM; sm++) {
		struct ect_config_sm want = { .struct_size = sizeof(want) };
		struct ect_sm have = { .struct_size = sizeof(have) };

		if (ect_sm_read(w->h, device, sm, &have))
			continue;
		*output = (have.control & EC_SM_DIR_MASK) == EC_SM_DIR_WRITE;
		if (!ect_config_sm(w->h, c->config.index, sm, &want) && want.dir &&
		    (want.dir == ECT_DIR_OUTPUT) != *output)
			return (int)sm;
	}
	return -1;
}

static struct ect_finding *al(struct why *w, const struct ect_explained *c,
			      const struct ect_cause *cause, const char *text)
{
	bool output = false;
	struct ect_finding *f;
	int sm = -1;

	if (c && cause->kind == ECT_CAUSE_REFUSED && cause->state == EC_AL_SAFEOP)
		sm = against(w, c, &output);
	if (sm >= 0)
		f = why_add(w, DIRECTION, text, sm, output ? "inputs" : "outputs",
			    output ? "outputs" : "inputs");
	else if (cause->code == CODE_WATCHDOG)
		f = why_add(w, WATCHDOG, text);
	else if (cause->kind == ECT_CAUSE_REFUSED)
		f = why_add(w, AL_REFUSED, text);
	else
		f = why_add(w, AL_ERROR, text);
	if (sm < 0)
		why_remedy(f, PLAIN, why_al_remedy(cause->code));
	f->code = cause->code;
	return f;
}

/* the remedy by which the slave is configured again, with its position */
static void again(struct ect_finding *f, const struct ect_cause *cause)
{
	char so_far[sizeof(f->remedy)];

	switch (cause->kind) {
	case ECT_CAUSE_REQUESTED:
		why_remedy(f, REQUESTED, f->slave);
		break;
	case ECT_CAUSE_REFUSED:
	case ECT_CAUSE_SLOW:
		memcpy(so_far, f->remedy, sizeof(so_far));
		why_remedy(f, AGAIN, so_far, cause->state == EC_AL_PREOP ? "PREOP" : "OP",
			   f->slave);
		break;
	}
}

static int config_index(const struct why *w, const struct ect_explained *c)
{
	return (int)(((const u8 *)c - w->configs->at) / w->configs->size);
}

static void add(struct why *w, int position, struct ect_explained *c, const struct ect_cause *cause,
		const char *text)
{
	struct ect_finding *f;

	switch (cause->kind) {
	case ECT_CAUSE_SDO:
		f = sdo(w, cause, text);
		break;
	case ECT_CAUSE_PDO:
		f = pdo(w, c, cause, text);
		break;
	case ECT_CAUSE_REFUSED:
	case ECT_CAUSE_AL_ERROR:
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
	f->config = config_index(w, c);
	why_explain(w, c);
}

/* BOOT was requested: a firmware update is in progress, or its end was forgotten. */
static bool in_boot(struct why *w, const struct ect_slave *s, struct ect_explained *c)
{
	struct ect_finding *f;

	if (s->al_requested != EC_AL_BOOT)
		return false;
	f = why_add(w, BOOT, ec_al_state_name((u8)s->al_status));
	f->slave = s->position;
	why_remedy(f, BOOT, s->position);
	if (!c) {
		f->level = ECT_WARNING;
		return true;
	}
	f->config = config_index(w, c);
	why_explain(w, c);
	return true;
}

/* A slave without configuration has to reach what was requested, PREOP as a rule. */
static void unconfigured(struct why *w, const struct ect_slave *s)
{
	struct ect_cause cause = s->cause;
	char text[ECT_TEXT];

	if (in_boot(w, s, NULL))
		return;
	if (s->error) {
		add(w, s->position, NULL, &cause, s->why);
	} else if (s->al_status & EC_AL_ERROR) {
		cause = (struct ect_cause){ .kind = ECT_CAUSE_AL_ERROR, .code = s->al_code };
		snprintf(text, sizeof(text), "AL state %s with error, AL status code 0x%04x (%s)",
			 ec_al_state_name((u8)s->al_status), s->al_code,
			 ec_al_code_text(s->al_code));
		add(w, s->position, NULL, &cause, text);
	} else if ((s->al_status & EC_AL_STATE_MASK) != s->al_requested) {
		cause = (struct ect_cause){ .kind = ECT_CAUSE_UNDER_WAY };
		snprintf(text, sizeof(text), "AL state %s, requested %s",
			 ec_al_state_name((u8)s->al_status), ec_al_state_name(s->al_requested));
		add(w, s->position, NULL, &cause, text);
	}
}

/* The slave of a configuration: why it is not in OP. */
static void configured(struct why *w, struct ect_explained *c)
{
	int position = c->config.slave_position;

	if (c->finding || !c->text[0])
		return;
	if (position < 0 && c->cause.kind >= ECT_CAUSE_SILENT)
		position = c->cause.position;	/* the slave there is unreadable */
	if (position >= 0 && (size_t)position < w->bus->n &&
	    in_boot(w, why_slave(w, (size_t)position), c))
		return;
	/* before activation only failures are reported; being not in OP is no fault then */
	if (c->cause.kind == ECT_CAUSE_INACTIVE)
		return;
	add(w, position, c, &c->cause, c->text);
}

/* Slaves that are used with a warning. */
static void warnings(struct why *w, const struct ect_slave *s)
{
	struct ect_finding *f;

	if (!s->warning[0] || s->error)
		return;
	if (s->cause.kind == ECT_CAUSE_EEPROM)
		f = why_add(w, EEPROM_FLAW, s->warning);
	else if (s->cause.kind == ECT_CAUSE_ALIAS_TWICE)
		f = why_add(w, ALIAS_TWICE, s->warning);
	else if (s->cause.kind == ECT_CAUSE_MAILBOX)
		f = why_add(w, MAILBOX_FLAW, s->warning);
	else if (s->differs)
		f = why_add(w, REVISION, s->warning);
	else if (s->mbox_protocols & EC_SII_PROTO_COE)
		f = why_add(w, PROCESS_DATA_COE, s->warning);
	else
		f = why_add(w, PROCESS_DATA, s->warning);
	f->slave = s->position;
}

/* has its configuration a finding, or one that expects another slave in its place? */
static bool told(const struct why *w, const struct ect_slave *s)
{
	for (size_t i = 0; i < w->findings->n; i++) {
		const struct ect_finding *f = why_finding(w, i);

		if (f->slave == s->position && f->port == ECT_NONE && f->config != ECT_NONE)
			return true;
	}
	return false;
}

/**
 * why_slaves() - why slaves are not in the state that is requested
 * @w: what is known
 */
void why_slaves(struct why *w)
{
	for (size_t i = 0; i < w->configs->n; i++)
		if (!why_in_op(why_config(w, i)))
			configured(w, why_config(w, i));
	for (size_t i = 0; i < w->bus->n; i++) {
		const struct ect_slave *s = why_slave(w, i);
		bool active = w->m.active && s->config && !s->differs;

		if (!active && !told(w, s))
			unconfigured(w, s);
		warnings(w, s);
	}
}
