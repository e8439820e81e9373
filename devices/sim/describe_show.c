// SPDX-License-Identifier: GPL-2.0-only
/* A segment that runs, slave by slave, with the words of its description. */
#include "describe_int.h"
#include "esc_int.h"

struct line {
	char *buf;
	size_t size;
	size_t at;
};

static void add(struct line *l, const char *s)
{
	while (*s && l->at + 1 < l->size)
		l->buf[l->at++] = *s++;
	l->buf[l->at] = '\0';
}

static void add_number(struct line *l, u32 v)
{
	char text[11];
	size_t at = sizeof(text);

	text[--at] = '\0';
	do {
		text[--at] = (char)('0' + v % 10);
		v /= 10;
	} while (v);
	add(l, text + at);
}

/* "coupler1.1": a port of a slave, or of the master (-2 - n) */
static void add_place(struct line *l, const struct ec_sim *sim, int peer, u32 port)
{
	const struct ec_app *app = peer < 0 ? NULL : ec_app_of(ec_sim_at(sim, (u32)peer));

	add(l, app ? app->name : "master");
	add(l, ".");
	add_number(l, app ? port : (u32)(-2 - peer));
}

/* where the slave hangs: at the master, at an earlier slave, else at a later one */
static void add_parent(struct line *l, const struct ec_esc *esc)
{
	const struct ec_esc_port *at = NULL;

	for (u32 i = EC_MAX_PORT; i--; ) {
		const struct ec_esc_port *p = &esc->port[i];

		if (p->peer == -1 || p->peer == EC_ESC_PEER_HOST)
			continue;
		if (!at || p->peer < esc->index || at->peer > esc->index)
			at = p;
	}
	add(l, at ? " at " : " unplugged");
	if (at)
		add_place(l, esc->sim, at->peer, at->peer_port);
}

static void add_faults(struct line *l, const struct ec_esc *esc)
{
	const struct ec_esc_fault *f = &esc->fault;
	const struct {
		const char *word;
		bool on;
	} faults[] = {
		{ "off", !esc->powered }, { "dead", f->dead }, { "deaf", f->miss_broadcast },
		{ "mute", f->app_mute }, { "refuse", f->al_refuse },
		{ "busy", f->eeprom_busy }, { "noack", f->eeprom_noack },
		{ "wkc", f->wkc_add }, { "mailbox", f->mailbox }, { "eoe", f->eoe },
	};
	const char *before = ": ";

	for (u32 i = 0; i < ARRAY_SIZE(faults); i++) {
		if (!faults[i].on)
			continue;
		add(l, before);
		add(l, faults[i].word);
		before = ", ";
	}
	for (u32 i = 0; i < EC_MAX_PORT; i++) {
		bool host = esc->port[i].peer == EC_ESC_PEER_HOST;

		if (!esc->port[i].cut && !host)
			continue;
		add(l, before);
		add(l, esc->port[i].cut ? "cut ." : "host .");
		add_number(l, i);
		before = ", ";
	}
}

/**
 * ec_sim_show() - describe a slave in one line
 * @sim: segment
 * @index: slave, below ec_sim_count()
 * @buf: out: "3 ai EL3062 at dio.1: off, cut .1", with terminator; cut off when it is too long
 * @size: of @buf, above 0
 *
 * Number, name, device, where the slave hangs, and the faults that last.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_sim_show(const struct ec_sim *sim, u32 index, char *buf, size_t size)
{
	const struct ec_esc *esc = ec_sim_at(sim, index);
	const struct ec_app *app = ec_app_of(esc);
	struct line l = { .buf = buf, .size = size };

	add_number(&l, index);
	add(&l, " ");
	add(&l, app->name);
	add(&l, " ");
	add(&l, app->model->table ? app->model->dev.name : "(EEPROM image)");
	add_parent(&l, esc);
	add_faults(&l, esc);
}
