// SPDX-License-Identifier: GPL-2.0-only
/* Options of the slave statement for slaves that are unlike others. */
#include "app_int.h"
#include "describe_int.h"

/* "0x1600,0x1601" or "none" */
static int list(struct ec_desc *d, const char *key, struct ec_app_list *l)
{
	struct ec_desc_word w = ec_desc_value(d, key);

	if (!w.s)
		return 0;
	l->given = true;
	if (ec_desc_is(&w, "none"))
		return 0;
	for (size_t from = 0, i = 0; i <= w.n; i++) {
		struct ec_desc_word one = { .s = w.s + from, .n = i - from };
		s64 v;

		if (i < w.n && w.s[i] != ',')
			continue;
		if (l->n == EC_APP_LIST)
			return ec_desc_fail(d, "'", &w, "': a list has at most 16 numbers");
		if (ec_desc_parse_number(d, &one, 0, 0xFFFF, &v))
			return -EINVAL;
		l->v[l->n++] = (u16)v;
		from = i + 1;
	}
	return 0;
}

/* "0x119800,0": idents by slot */
static int modules(struct ec_desc *d, struct ec_app_quirks *q)
{
	struct ec_desc_word w = ec_desc_value(d, "modules");

	for (size_t from = 0, i = 0; w.s && i <= w.n; i++) {
		struct ec_desc_word one = { .s = w.s + from, .n = i - from };
		s64 v;

		if (i < w.n && w.s[i] != ',')
			continue;
		if (q->n_modules == EC_APP_LIST)
			return ec_desc_fail(d, "'", &w, "': a slave has at most 16 slots");
		if (ec_desc_parse_number(d, &one, 0, 0xFFFFFFFF, &v))
			return -EINVAL;
		q->modules[q->n_modules++] = (u32)v;
		from = i + 1;
	}
	return 0;
}

/**
 * ec_desc_quirks() - what is unusual in the EEPROM and the dictionary of a slave
 * @d: description, a slave statement
 * @q: result
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_quirks(struct ec_desc *d, struct ec_app_quirks *q)
{
	bool words = true, protocols = true;
	s64 out = 0, in = 0;
	int ret;

	ret = ec_desc_yes(d, "mbox_words", &words);
	if (!ret)
		ret = ec_desc_yes(d, "mbox_protocols", &protocols);
	if (!ret)
		ret = list(d, "assign_out", &q->assign[EC_APP_OUT]);
	if (!ret)
		ret = list(d, "assign_in", &q->assign[EC_APP_IN]);
	if (!ret)
		ret = list(d, "dc_modes", &q->dc_modes);
	if (!ret)
		ret = list(d, "fixed", &q->fixed);
	if (!ret)
		ret = modules(d, q);
	if (!ret)
		ret = ec_desc_number(d, "sm_out", 1, EC_APP_SMS_MAX, &out);
	if (!ret)
		ret = ec_desc_number(d, "sm_in", 1, EC_APP_SMS_MAX, &in);
	q->sms[EC_APP_OUT] = (u8)out;
	q->sms[EC_APP_IN] = (u8)in;
	q->no_mbox_words = !words;
	q->no_protocols = !protocols;
	q->any = q->no_mbox_words || q->no_protocols || q->assign[EC_APP_OUT].given ||
		 q->assign[EC_APP_IN].given || q->dc_modes.given || q->fixed.given ||
		 q->n_modules || out > 1 || in > 1;
	return ret;
}

/**
 * ec_desc_steps() - how a slave changes its state
 * @d: description, a slave statement; @c->transition_ns is known
 * @c: result
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_steps(struct ec_desc *d, struct ec_app_config *c)
{
	static const char * const keys[EC_APP_STEPS] = {
		[EC_APP_STEP_PREOP] = "transition_preop",
		[EC_APP_STEP_BOOT] = "transition_boot",
		[EC_APP_STEP_SAFEOP] = "transition_safeop",
		[EC_APP_STEP_OP] = "transition_op",
	};
	bool ack = true, lrw = true, frmw = true;
	int ret = 0;

	for (u32 i = 0; i < EC_APP_STEPS && !ret; i++) {
		c->step_ns[i] = c->transition_ns;
		ret = ec_desc_time(d, keys[i], EC_DESC_TIME_MAX, &c->step_ns[i]);
	}
	if (!ret)
		ret = ec_desc_yes(d, "ack", &ack);
	if (!ret)
		ret = ec_desc_yes(d, "own_eeprom", &c->own_eeprom);
	if (!ret)
		ret = ec_desc_yes(d, "lrw", &lrw);
	if (!ret)
		ret = ec_desc_yes(d, "frmw", &frmw);
	c->no_ack = !ack;
	c->no_lrw = !lrw;
	c->no_frmw = !frmw;
	return ret;
}

/**
 * ec_desc_quirks_fit() - is a slave such that its oddities can show
 * @d: description, a slave statement
 * @name: of the slave
 * @m: its model
 * @c: what is its own
 *
 * Context: Process. May sleep.
 * Return: 0, or -EINVAL.
 */
int ec_desc_quirks_fit(struct ec_desc *d, const struct ec_desc_word *name,
		       const struct ec_app_model *m, const struct ec_app_config *c)
{
	const struct ec_app_quirks *q = &m->params.quirks;

	if (m->emulation && (c->no_ack || c->own_eeprom))
		return ec_desc_fail(d, "'", name,
				    "' has no CPU that changes its state; remove ack= and own_eeprom=");
	if ((q->no_mbox_words || q->no_protocols) && !m->dev.std.rx_len)
		return ec_desc_fail(d, "'", name,
				    "' has no mailbox; remove mbox_words= and mbox_protocols=");
	for (int dir = 0; dir < EC_APP_DIRS; dir++)
		if (q->assign[dir].given &&
		    (!m->n_areas[dir] || !(m->dev.protocols & EC_SII_PROTO_COE)))
			return ec_desc_fail(d, "'", name,
				"' has no CoE or no such process data; remove assign_out= and assign_in=");
	if (q->n_modules && !(m->dev.protocols & EC_SII_PROTO_COE))
		return ec_desc_fail(d, "'", name, "' has no CoE; remove modules=");
	if (q->dc_modes.given && m->emulation)
		return ec_desc_fail(d, "'", name,
				    "' has no CPU that knows operation modes; remove dc_modes=");
	if ((q->sms[EC_APP_OUT] || q->sms[EC_APP_IN]) &&
	    (!m->table || !ec_app_dev_is_generic(m->table)))
		return ec_desc_fail(d, "'", name,
				    "' has its own SyncManagers; remove sm_out= and sm_in=");
	for (u32 i = 0; i < q->fixed.n; i++)
		if (!ec_app_pdo_is_config(q->fixed.v[i]) ||
		    !ec_app_od_object(m, q->fixed.v[i]))
			return ec_desc_fail(d, "'", name,
				"' has no such PDO or assignment; expected for example fixed=0x1600,0x1C13");
	return 0;
}
