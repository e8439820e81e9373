// SPDX-License-Identifier: GPL-2.0-only
#include "absent.h"

#include <stdio.h>

#include "../lib/tools/text.h"
#include "../master/wire/port_text.h"
#include "out.h"

/* what people call the slave, with a blank before it, or "" */
static const char *label(const struct ect_slave *s, char *buf, size_t size)
{
	const char *name = s->order[0] ? s->order : s->name;

	snprintf(buf, size, "%s%s", name[0] ? " " : "", name);
	return buf;
}

static const struct ect_slave *by_device(const struct slaves *all, u64 device)
{
	for (size_t i = 0; i < all->n; i++)
		if (all->v[i].device == device)
			return &all->v[i];
	return NULL;
}

/* "7 slaves disconnected, since 3.1 s" */
static void what_text(const struct ect_absent *a, char *buf, size_t size)
{
	char since[24];

	text_duration(a->since_ns, since, sizeof(since));
	if (a->slaves == 1)
		snprintf(buf, size, "slave %u (%s) disconnected, since %s", a->first, a->name,
			 since);
	else
		snprintf(buf, size, "%u slaves disconnected, since %s: %u (%s) to %u", a->slaves,
			 since, a->first, a->name, a->last);
}

static void absent_text(const struct ect_absent *a, const struct ect_slave *up, char *buf,
			size_t size)
{
	char what[160], name[ECT_STRING + 1];

	what_text(a, what, sizeof(what));
	if (up)
		snprintf(buf, size, "behind port %u of slave %u%s: %s", a->port, up->position,
			 label(up, name, sizeof(name)), what);
	else
		snprintf(buf, size, "behind the main device: %s", what);
}

static void absent_json(const struct ect_absent *a, const struct ect_slave *up)
{
	out_object(NULL);
	if (up) {
		out_u("upstream", up->position, NULL);
		out_u("port", a->port, NULL);
	} else {
		out_null("upstream", NULL);
		out_null("port", NULL);
	}
	out_u("slaves", a->slaves, NULL);
	out_u("since_ns", a->since_ns, NULL);
	out_u("first", a->first, NULL);
	out_u("last", a->last, NULL);
	out_str("first_name", a->name, NULL);
	out_end();
}

/* @b: what is behind it, without a device: zeros */
static void closed_text(const struct ect_slave *s, unsigned int port, const struct ect_behind *b,
			char *buf, size_t size)
{
	const struct ec_port_text *text = ec_port_text(s->port_kept[port]);
	char name[ECT_STRING + 1], more[160] = "", how[64] = "";

	if (s->port_kept[port] == ECT_PORT_LOSSES)
		snprintf(more, sizeof(more), ", opens after %u s of link without loss",
			 s->port_wait_s[port]);
	if (text->device) {
		text_behind(b, more, sizeof(more));
		snprintf(how, sizeof(how), ", or 'ethercat slaves -p %u --let-in %u'", s->position,
			 port);
	}
	snprintf(buf, size, "port %u of slave %u%s stays closed despite its link: %s%s; %s%s",
		 port, s->position, label(s, name, sizeof(name)), text->reason, more,
		 text->remedy, how);
}

static void closed_json(const struct ect_slave *s, unsigned int port, const struct ect_behind *b)
{
	static const char *const keys[] = {
		"", "no_reply", "no_loop_control", "losses", "other_device", "other_sign",
		"other_serial", "second", "reversed", "boot", "unreadable", "unexpected",
		"wrong_way", "swallows_frames",
	};
	u8 kept = s->port_kept[port];

	out_object(NULL);
	out_u("slave", s->position, NULL);
	out_u("port", port, NULL);
	out_str("reason", kept < ARRAY_SIZE(keys) ? keys[kept] : "unknown", NULL);
	out_u("wait_s", s->port_wait_s[port], NULL);
	if (!ec_port_text(b->kept)->device) {
		out_null("behind", NULL);
	} else {
		out_object("behind");
		out_u("vendor_id", b->vendor_id, NULL);
		out_u("product_code", b->product_code, NULL);
		out_u("revision_number", b->revision_number, NULL);
		out_u("serial_number", b->serial_number, NULL);
		out_u("alias", b->alias, NULL);
		out_u("identification", b->identification, NULL);
		out_u("slaves", b->slaves, NULL);
		out_str("name", b->name, NULL);
		out_end();
	}
	out_end();
}

/* A port that has opened meanwhile has nothing behind it. */
static struct ect_behind behind(struct dev *d, const struct ect_slave *s, unsigned int port)
{
	struct ect_behind b = { .struct_size = sizeof(b) };

	if (!ec_port_text(s->port_kept[port])->device || ect_behind_read(d->h, s->device, port, &b))
		return (struct ect_behind){ 0 };
	return b;
}

static void closed_ports(struct dev *d, const struct slaves *all, absent_line *line)
{
	char text[480];

	out_array("closed_ports");
	for (size_t i = 0; i < all->n; i++)
		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			struct ect_behind b;

			if (!all->v[i].port_kept[p])
				continue;
			b = behind(d, &all->v[i], p);
			closed_text(&all->v[i], p, &b, text, sizeof(text));
			line(d, text);
			closed_json(&all->v[i], p, &b);
		}
	out_end();
}

static void closed_draw(struct dev *d, const struct slaves *all)
{
	for (size_t i = 0; i < all->n; i++)
		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			struct ect_behind b = behind(d, &all->v[i], p);

			if (!ec_port_text(b.kept)->device)
				continue;
			out_text("\n\tclosed%zu_%u [shape=\"box\", style=\"dotted\", label=\"",
				 i, p);
			out_quoted(b.name[0] ? b.name : "unknown device");
			out_text("\\nnot let in\"]\n\tslave%u -- closed%zu_%u [style=\"dotted\", taillabel=\"%u\"]\n",
				 all->v[i].position, i, p, p);
		}
}

static int absent_list(struct dev *d, struct ect_list **list)
{
	int err = ect_absent_read(d->h, list);

	return err ? dev_fail(d, err, "Master%u: cannot read absent slaves", d->master) : 0;
}

int absent_show(struct dev *d, const struct slaves *all, absent_line *line)
{
	const struct ect_absent *a;
	struct ect_list *list;
	char text[320];

	if (absent_list(d, &list))
		return 1;
	out_array("absent");
	for (size_t i = 0; (a = ect_list_get(list, i)); i++) {
		const struct ect_slave *up = by_device(all, a->device);

		if (a->device && !up)
			continue;
		absent_text(a, up, text, sizeof(text));
		line(d, text);
		absent_json(a, up);
	}
	out_end();
	ect_list_free(list);
	closed_ports(d, all, line);
	return 0;
}

int absent_draw(struct dev *d, const struct slaves *all)
{
	const struct ect_absent *a;
	struct ect_list *list;

	if (absent_list(d, &list))
		return 1;
	for (size_t i = 0; (a = ect_list_get(list, i)); i++) {
		const struct ect_slave *up = by_device(all, a->device);
		char since[24];

		if (a->device && !up)
			continue;
		text_duration(a->since_ns, since, sizeof(since));
		out_text("\n\tabsent%zu [shape=\"box\", style=\"dashed\", label=\"%u slave%s disconnected\\nsince %s\"]\n",
			 i, a->slaves, a->slaves == 1 ? "" : "s", since);
		if (up)
			out_text("\tslave%u -- absent%zu [style=\"dashed\", taillabel=\"%u\"]\n",
				 up->position, i, a->port);
		else
			out_text("\tmaster -- absent%zu [style=\"dashed\"]\n", i);
	}
	ect_list_free(list);
	closed_draw(d, all);
	return 0;
}
