// SPDX-License-Identifier: GPL-2.0-only
/* The bus at a glance, again and again. */
#include <stdio.h>
#include <string.h>

#include "facts.h"
#include "out.h"
#include "screen.h"
#include "top_names.h"

#define EVERY_S		1.0

/**
 * struct look - what the user wants to see
 * @first: slave that is shown first
 * @faults: only slaves with a fault
 * @names: of slaves
 */
struct look {
	size_t first;
	bool faults;
	struct top_names names;
};

/* text goes to the terminal, and to a pipe without what moves a cursor */
static void line(bool screen, unsigned int columns, const char *text)
{
	if (screen)
		screen_line(columns, "%s", text);
	else
		out_text("%.*s\n", (int)columns - 1, text);
}

static void show_head(const struct facts *f, bool screen, unsigned int columns)
{
	const struct ect_device *n;
	char text[256];

	snprintf(text, sizeof(text), "Master%u  %u slave(s), %u reply  %s", f->master,
		 f->m.slave_count, f->m.slaves_responding, facts_session(&f->m));
	line(screen, columns, text);
	for (size_t i = 0; (n = facts_device(f, i)); i++) {
		snprintf(text, sizeof(text), "Link %zu: %s  %.1f frames/s  %.1f kB/s  lost %llu",
			 i, n->link_up ? "up" : "down", (double)n->tx_frame_rate[0],
			 n->tx_byte_rate[0] / 1024.0, (unsigned long long)n->lost);
		line(screen, columns, text);
	}
	if (f->c.kind == ECT_CYCLE_BY_NOBODY || !f->c.active) {
		line(screen, columns, "Cycle: none");
		return;
	}
	snprintf(text, sizeof(text),
		 "Cycle: %g ms  wire %.1f %%  deviation 99.9 %% %.1f us  max %.1f us  overruns %llu",
		 f->c.interval_ns / 1e6,
		 f->c.interval_ns ? 100.0 * f->m.cycle_wire_ns / f->c.interval_ns : 0,
		 (double)ect_cycle_quantile(&f->c, 999) / 1000, f->c.late_max / 1000.0,
		 (unsigned long long)f->c.overruns);
	line(screen, columns, text);
}

static void show_domains(const struct facts *f, bool screen, unsigned int columns)
{
	for (size_t i = 0; i < f->domain_count; i++) {
		const struct ect_domain *dom = &f->domains[i];
		char text[128];

		snprintf(text, sizeof(text), "Domain %zu: %u bytes  working counter %u of %u%s", i,
			 dom->size, dom->working_counter, dom->expected,
			 dom->wc_state == ECT_WC_COMPLETE ? "" : "  INCOMPLETE");
		line(screen, columns, text);
	}
}

/* "axis1 (EL7201)", or as the EEPROM calls it */
static void name_of(const struct look *l, const struct ect_slave *s, char *buf, size_t size)
{
	const char *name = top_name(&l->names, s);

	if (!name)
		slave_name(s, buf, size);
	else if (s->order[0])
		snprintf(buf, size, "%s (%s)", name, s->order);
	else
		snprintf(buf, size, "%s", name);
}

/* @room of the slaves */
static void show_slaves(const struct facts *f, const struct look *l, bool screen,
			unsigned int columns, size_t room)
{
	size_t skipped = 0, shown = 0;

	line(screen, columns, "  pos  state         name");
	for (size_t i = 0; i < f->slaves.n && shown < room; i++) {
		const struct ect_slave *s = &f->slaves.v[i];
		char state[16], name[2 * ECT_STRING], text[512];

		if (l->faults && !s->error && !s->why[0])
			continue;
		if (skipped++ < l->first)
			continue;
		shown++;
		al_state_text(s->al_status, state, sizeof(state));
		name_of(l, s, name, sizeof(name));
		snprintf(text, sizeof(text), "%5u  %-12s  %s%s%s", s->position, state, name,
			 s->why[0] ? ": " : "", s->why);
		line(screen, columns, text);
	}
}

static void json(const struct facts *f)
{
	out_object(NULL);
	out_u("master", f->master, NULL);
	out_u("slaves", f->m.slave_count, NULL);
	out_u("slaves_responding", f->m.slaves_responding, NULL);
	out_str("session", facts_session(&f->m), NULL);
	out_u("interval_ns", f->c.active ? f->c.interval_ns : 0, NULL);
	out_u("wire_ns", f->m.cycle_wire_ns, NULL);
	out_u("overruns", f->c.overruns, NULL);
	out_u("late_max_ns", f->c.late_max, NULL);
	out_end();
}

static void show(const struct facts *f, const struct look *l, bool screen)
{
	unsigned int lines = 24, columns = 80;
	size_t head = 5 + f->m.domain_count + f->m.device_count;

	if (screen)
		screen_size(&lines, &columns);
	if (screen)
		screen_begin();
	show_head(f, screen, columns);
	show_domains(f, screen, columns);
	show_slaves(f, l, screen, columns,
		    screen ? lines > head ? lines - head : 1 : f->slaves.n);
	if (!screen)
		return;
	screen_line(columns, "q: end  j, k: down, up  e: %s", l->faults ? "all" : "faults only");
	screen_end();
}

static void press(struct look *l, int key)
{
	if (key == 'j')
		l->first++;
	else if (key == 'k' && l->first)
		l->first--;
	else if (key == 'e')
		l->faults = !l->faults;
}

static int look(const struct tool *t, struct dev *d, struct look *l, bool screen)
{
	struct facts f;
	int ret = facts_read(d, &f) || top_names_read(t, d, &f.slaves, &l->names);

	if (!ret && out_is_json())
		json(&f);
	else if (!ret)
		show(&f, l, screen);
	facts_free(&f);
	return ret;
}

static int top(const struct tool *t, struct dev *d, struct look *l)
{
	bool screen = out_to_terminal() && !out_is_json();
	double every = t->watch_s > 0 ? t->watch_s : EVERY_S;
	int ret = 0, key = 0;

	screen_catch_end();
	if (screen)
		screen_grab();
	while (!ret && key != 'q' && !screen_ended()) {
		ret = look(t, d, l, screen);
		/* in a pipe once, unless a time was given */
		if (ret || (!screen && !t->watch_s))
			break;
		if (!screen)
			out_text("\n");
		if (fflush(stdout))
			break;
		key = screen_key(every);
		press(l, key);
	}
	screen_release();
	screen_forget_interruption();
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct look l = { 0 };
	struct dev d;
	int ret;

	(void)argc, (void)argv;
	if (dev_open_single(&d, t, false))
		return 1;
	ret = top(t, &d, &l);
	top_names_free(&l.names);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_top = {
	.name = "top",
	.run = run,
	.args = "",
	.opts = "mWi",
	.summary = "Show slaves, working counters and the cycle again and again",
	.help = "The owner of the master, links with their load, the cycle with its share of the wire and\n"
		"its deviation, working counters, slaves with states and errors. Each second, or in the\n"
		"time of --watch. Keys: q ends, j and k move in the slaves, e shows only those with a\n"
		"fault. Not on a terminal: the same lines once, or with --watch again and again. Slaves\n"
		"have the names that the application or 'ethercat run FILE' gives them, or of the bus\n"
		"file of --file. It only reads, and sends no frame.\n",
	.json = "each line is an object: master, slaves, slaves_responding, session, interval_ns (0: no\n"
		"cycle), wire_ns, overruns, late_max_ns",
	.flags = CMD_ONE_MASTER | CMD_LINES,
};
