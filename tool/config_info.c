// SPDX-License-Identifier: GPL-2.0-only
/* Everything about one slave configuration. */
#include "config_info.h"

#include <errno.h>
#include <stdio.h>

#include "../master/wire/al.h"
#include "ip.h"
#include "out.h"

#define SMS		16
#define SHOWN		1024	/* bytes of an SDO */

/* Alias and position, or group and member. Return: @buf */
const char *config_name(const struct ect_config *c, char *buf, size_t size)
{
	if (c->group)
		snprintf(buf, size, "%s:%u", c->group_name, c->position);
	else
		snprintf(buf, size, "%u:%u", c->alias, c->position);
	return buf;
}

/* Return: 1 */
int config_failed(struct dev *d, int err, const struct ect_config *c)
{
	char name[CONFIG_NAME];

	return dev_fail(d, err, "Master%u: cannot read the state of configuration %s", d->master,
			config_name(c, name, sizeof(name)));
}

static int entries(struct dev *d, const struct ect_config *c, const char *in, unsigned int sm,
		   unsigned int pdo, unsigned int count)
{
	for (unsigned int i = 0; i < count; i++) {
		struct ect_pdo_entry e = { .struct_size = sizeof(e) };
		int err = ect_config_entry(d->h, c->index, sm, pdo, i, &e);

		if (err)
			return config_failed(d, err, c);
		out_object(NULL);
		out_u("index", e.index, "%s    PDO entry 0x%04x", in, e.index);
		out_u("subindex", e.subindex, ":%02x", e.subindex);
		out_u("size_bits", e.bits, ", %2u bit\n", e.bits);
		out_end();
	}
	return 0;
}

static int sync_manager(struct dev *d, const struct ect_config *c, const char *in,
			const struct ect_config_sm *s)
{
	static const char *const wd[] = { "Default", "Enable", "Disable" };
	const char *watchdog = s->watchdog < ARRAY_SIZE(wd) ? wd[s->watchdog] : "???";
	int ret = 0;

	out_object(NULL);
	out_u("index", s->sm, "%sSM%u", in, s->sm);
	out_str("direction", s->dir == 1 ? "output" : "input", ", Dir: %s",
		s->dir == 1 ? "Output" : "Input");
	out_str("watchdog", watchdog, ", Watchdog: %s\n", watchdog);
	out_array("pdos");
	for (unsigned int i = 0; i < s->pdo_count && !ret; i++) {
		struct ect_pdo p = { .struct_size = sizeof(p) };
		int err = ect_config_pdo(d->h, c->index, s->sm, i, &p);

		if (err) {
			ret = config_failed(d, err, c);
			break;
		}
		out_object(NULL);
		out_u("index", p.index, "%s  PDO 0x%04x\n", in, p.index);
		out_array("entries");
		ret = entries(d, c, in, s->sm, i, p.entry_count);
		out_end();
		out_end();
	}
	out_end();
	out_end();
	return ret;
}

static int sync_managers(struct dev *d, const struct ect_config *c, const char *in)
{
	int ret = 0;

	out_array("sync_managers");
	for (unsigned int i = 0; i < SMS && !ret; i++) {
		struct ect_config_sm s = { .struct_size = sizeof(s) };
		int err = ect_config_sm(d->h, c->index, i, &s);

		if (err)
			ret = config_failed(d, err, c);
		else if (s.pdo_count)
			ret = sync_manager(d, c, in, &s);
	}
	out_end();
	return ret;
}

static int sdo(struct dev *d, const struct ect_config *c, const char *in, unsigned int pos)
{
	u8 data[SHOWN];
	struct ect_startup s = { .struct_size = sizeof(s) };
	int err = ect_config_sdo(d->h, c->index, pos, &s, data, sizeof(data));
	bool complete = s.complete;
	char indent[16];

	if (err)
		return config_failed(d, err, c);
	snprintf(indent, sizeof(indent), "%s    ", in);
	out_object(NULL);
	out_u("index", s.index, "%s  0x%04x", in, s.index);
	if (complete)
		out_text(" C");
	else
		out_u("subindex", s.subindex, ":%02x", s.subindex);
	out_bool("complete_access", complete, NULL);
	out_u("size_bytes", s.bytes, ", %u byte\n", s.bytes);
	out_hex("data_hex", data, min(s.bytes, (u32)SHOWN), indent);
	if (s.bytes > SHOWN)
		out_text("%s...\n", indent);
	out_end();
	return 0;
}

static int sdos(struct dev *d, const struct ect_config *c, const char *in)
{
	int ret = 0;

	out_text("%sSDO configuration:\n", in);
	out_array("sdos");
	for (unsigned int i = 0; i < c->sdo_count && !ret; i++)
		ret = sdo(d, c, in, i);
	out_end();
	if (!c->sdo_count)
		out_text("%s  None.\n", in);
	return ret;
}

static void idn(const struct ect_startup *i, const u8 *data, const char *in)
{
	char indent[16], name[12];

	snprintf(name, sizeof(name), "%c-%u-%04u", i->index & 0x8000 ? 'P' : 'S',
		 i->index >> 12 & 7u, i->index & 0xfffu);
	snprintf(indent, sizeof(indent), "%s    ", in);
	out_object(NULL);
	out_u("drive", i->subindex, "%s  Drive %u, ", in, i->subindex);
	out_u("idn", i->index, NULL);
	out_str("name", name, "%s, ", name);
	out_str("state", ec_al_state_name(i->state), NULL);
	out_u("size_bytes", i->bytes, "%u byte", i->bytes);
	/* scripts know the line of an IDN that is written in PREOP */
	if (i->state != EC_AL_PREOP)
		out_text(", in %s", ec_al_state_name(i->state));
	out_text("\n");
	out_hex("data_hex", data, min(i->bytes, (u32)SHOWN), indent);
	if (i->bytes > SHOWN)
		out_text("%s...\n", indent);
	out_end();
}

/* An older module does not show IDNs: then nothing is printed. */
static int idns(struct dev *d, const struct ect_config *c, const char *in)
{
	unsigned int pos;

	for (pos = 0;; pos++) {
		u8 data[SHOWN];
		struct ect_startup i = { .struct_size = sizeof(i) };
		int err = ect_config_idn(d->h, c->index, pos, &i, data, sizeof(data));

		if (err == -ENOTTY) {
			out_null("idns", NULL);
			return 0;
		}
		if (!pos) {
			out_text("%sIDN configuration:\n", in);
			out_array("idns");
		}
		if (err && err != -ENOENT)
			return config_failed(d, err, c);
		if (err)
			break;
		idn(&i, data, in);
	}
	out_end();
	if (!pos)
		out_text("%s  None.\n", in);
	return 0;
}

static void write_head(const struct ect_write *w, const char *in)
{
	static const char *const kind[] = { "SDO", "IDN", "register" };

	out_str("kind", w->kind < ARRAY_SIZE(kind) ? kind[w->kind] : "???", "%s  ", in);
	if (w->kind == ECT_WRITE_IDN) {
		out_u("drive", w->subindex, "IDN of drive %u, ", w->subindex);
		out_u("idn", w->index, "0x%04x", w->index);
		return;
	}
	if (w->kind == ECT_WRITE_REG) {
		out_u("register", w->index, "register 0x%04x", w->index);
		return;
	}
	out_u("index", w->index, "SDO 0x%04x", w->index);
	if (w->complete)
		out_text(" C");
	else
		out_u("subindex", w->subindex, ":%02x", w->subindex);
	out_bool("complete_access", w->complete, NULL);
}

static void write_out(const struct ect_write *w, const u8 *data, const char *in)
{
	char indent[16];

	snprintf(indent, sizeof(indent), "%s    ", in);
	out_object(NULL);
	write_head(w, in);
	out_u("size_bytes", w->bytes, ", %u byte", w->bytes);
	if (w->why[0])
		out_str("not_replayed", w->why, ", not replayed: %s", w->why);
	else
		out_null("not_replayed", NULL);
	out_text("\n");
	out_hex("data_hex", data, min(w->bytes, (u32)SHOWN), indent);
	if (w->bytes > SHOWN)
		out_text("%s...\n", indent);
	out_end();
}

/* What the application has written itself; only when there is any. */
static int writes(struct dev *d, const struct ect_config *c, const char *in)
{
	unsigned int pos;

	for (pos = 0;; pos++) {
		u8 data[SHOWN];
		struct ect_write w = { .struct_size = sizeof(w) };
		int err = ect_config_write(d->h, c->index, pos, &w, data, sizeof(data));

		if (err == -ENOTTY) {
			out_null("writes", NULL);
			return 0;
		}
		if (!pos)
			out_array("writes");
		if (err && err != -ENOENT)
			return config_failed(d, err, c);
		if (err)
			break;
		if (!pos)
			out_text("%sWrites of the application:\n", in);
		if (!pos && w.forgotten)
			out_text("%s  %u older ones, not listed\n", in, w.forgotten);
		write_out(&w, data, in);
	}
	out_end();
	return 0;
}

static int flags(struct dev *d, const struct ect_config *c, const char *in)
{
	out_text("%sFeature flags:\n", in);
	out_array("flags");
	for (unsigned int i = 0; i < c->flag_count; i++) {
		struct ect_flag f = { .struct_size = sizeof(f) };
		int err = ect_config_flag(d->h, c->index, i, &f);

		if (err)
			return config_failed(d, err, c);
		out_object(NULL);
		out_str("key", f.key, "%s  %s", in, f.key);
		out_i("value", f.value, ": %d\n", f.value);
		out_end();
	}
	out_end();
	if (!c->flag_count)
		out_text("%s  None.\n", in);
	return 0;
}

/* only when there are any */
static int ip(struct dev *d, const struct ect_config *c, const char *in)
{
	struct ect_ip i = { .struct_size = sizeof(i) };
	int err = ect_config_ip(d->h, c->index, &i);
	char indent[16];

	/* a module that is older than the command */
	if (err == -ENOTTY)
		i.which = 0;
	else if (err)
		return config_failed(d, err, c);
	if (!i.which) {
		out_null("eoe_ip", NULL);
		return 0;
	}
	snprintf(indent, sizeof(indent), "%s  ", in);
	out_text("%sEoE IP parameters:\n", in);
	out_object("eoe_ip");
	ip_out(&i, indent, true);
	out_end();
	return 0;
}

static void dc(const struct ect_config *c, const char *in)
{
	out_text("%sDC configuration:\n", in);
	if (!c->dc_assign_activate) {
		out_null("dc", "%s  None.\n", in);
		return;
	}
	out_object("dc");
	out_u("assign_activate", c->dc_assign_activate, "%s  AssignActivate: 0x%04x\n", in,
	      c->dc_assign_activate);
	out_text("%s          Cycle [ns]   Shift [ns]\n", in);
	out_array("sync");
	for (int i = 0; i < 2; i++) {
		out_object(NULL);
		out_u("cycle_ns", c->dc_cycle[i], "%s  SYNC%d  %11u", in, i, c->dc_cycle[i]);
		out_i("shift_ns", c->dc_shift[i], "  %11d\n", c->dc_shift[i]);
		out_end();
	}
	out_end();
	out_end();
}

static void number_or_default(const char *key, unsigned int v, const char *in, const char *label)
{
	if (v)
		out_u(key, v, "%s%s: %u\n", in, label, v);
	else
		out_null(key, "%s%s: (Default)\n", in, label);
}

static void attached(const struct ect_config *c, const char *in)
{
	char state[16];

	if (c->slave_position < 0) {
		out_null("position", "%sAttached slave: none\n", in);
		out_null("state", NULL);
		return;
	}
	al_state_text(c->al_status, state, sizeof(state));
	out_i("position", c->slave_position, "%sAttached slave: %d", in, c->slave_position);
	out_str("state", ec_al_state_name((u8)c->al_status), " (%s)\n", state);
}

static void reason(struct dev *d, const struct ect_config *c, const char *in)
{
	char text[ECT_TEXT];

	dev_config_why(d, c->index, text, sizeof(text));
	if (text[0])
		out_str("not_in_op", text, "%sNot in OP: %s\n", in, text);
	else
		out_null("not_in_op", NULL);
}

/* A warning about the process data, also in OP. */
static void warning(struct dev *d, const struct ect_config *c, const char *in)
{
	struct ect_slave s = { .struct_size = sizeof(s) };

	if (c->slave_position < 0 || ect_slave_at(d->h, (unsigned int)c->slave_position, &s))
		s.warning[0] = '\0';
	if (s.warning[0])
		out_str("warning", s.warning, "%sWarning: %s\n", in, s.warning);
	else
		out_null("warning", NULL);
}

/* Its hot connect group, and what this is known by */
static void group(const struct ect_config *c, const char *in)
{
	static const char *const by[] = { "", "alias", "identification", "port" };
	const char *what = by[c->group_by < ARRAY_SIZE(by) ? c->group_by : 0];

	if (!c->group) {
		out_null("group", NULL);
		return;
	}
	out_object("group");
	out_str("name", c->group_name, "%sGroup: %s, member %u, %s, %s", in, c->group_name,
		c->position, c->group_mandatory ? "mandatory" : "optional", what);
	out_bool("mandatory", c->group_mandatory, NULL);
	out_str("known_by", what, NULL);
	if (c->group_value)
		out_u("value", c->group_value, " %u", c->group_value);
	else
		out_null("value", NULL);
	if (c->group_at != ECT_NONE32) {
		out_u("port", c->group_port, c->group_by == ECT_GROUP_PORT ? " %u" : ", port %u",
		      c->group_port);
		out_u("at_configuration", c->group_at, " of the slave of configuration %u",
		      c->group_at);
	} else {
		out_null("port", NULL);
		out_null("at_configuration", NULL);
	}
	out_text("\n");
	out_end();
}

/* Return: 0, or 1 after printing the error. */
int config_info(struct dev *d, const struct ect_config *c, const char *in)
{
	int ret;

	out_object(NULL);
	out_u("alias", c->alias, "%sAlias: %u\n", in, c->alias);
	out_u("relative_position", c->position, "%sPosition: %u\n", in, c->position);
	out_u("vendor_id", c->vendor_id, "%sVendor Id: 0x%08x\n", in, c->vendor_id);
	out_u("product_code", c->product_code, "%sProduct code: 0x%08x\n", in, c->product_code);
	group(c, in);
	attached(c, in);
	reason(d, c, in);
	warning(d, c, in);
	number_or_default("watchdog_divider", c->watchdog_divider, in, "Watchdog divider");
	number_or_default("watchdog_intervals", c->watchdog_intervals, in, "Watchdog intervals");
	ret = sync_managers(d, c, in);
	ret = ret ? ret : sdos(d, c, in);
	ret = ret ? ret : idns(d, c, in);
	ret = ret ? ret : config_commands(d, c, in);
	ret = ret ? ret : writes(d, c, in);
	ret = ret ? ret : flags(d, c, in);
	ret = ret ? ret : ip(d, c, in);
	if (!ret) {
		dc(c, in);
		out_text("\n");
	}
	out_end();
	return ret;
}
