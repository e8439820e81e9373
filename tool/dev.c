// SPDX-License-Identifier: GPL-2.0-only
#include "dev.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../master/wire/al.h"
#include "out.h"

double now_s(void)
{
	struct timespec ts;

	clock_gettime(CLOCK_MONOTONIC, &ts);
	return (double)ts.tv_sec + (double)ts.tv_nsec / 1e9;
}

void sleep_ms(unsigned int ms)
{
	struct timespec ts = { ms / 1000, (long)(ms % 1000) * 1000000 };

	nanosleep(&ts, NULL);
}

/**
 * dev_open() - open the device file of a master
 * @d: result, to be closed with dev_close()
 * @master: index
 * @write: for traffic or changes
 *
 * Return: 0, or 1 after printing why not.
 */
int dev_open(struct dev *d, unsigned int master, bool write)
{
	const char *dir = getenv("EC_DEVICE_DIR");
	char path[256];
	int ret;

	*d = (struct dev){ .h = ect_new(), .master = master, .selected = 1 };
	if (!d->h)
		return fail("out of memory");
	snprintf(path, sizeof(path), "%s/EtherCAT%u", dir ? dir : "/dev", master);
	ret = ect_open_path(d->h, path, write ? ECT_OPEN_WRITE : 0);
	if (!ret)
		return 0;
	if (ret == -EPROTO)
		fail("%s: %s", path, ect_reason(d->h));
	else
		fail_full(-ret, ect_reason(d->h), 0, "Failed to open %s", path);
	dev_close(d);
	return 1;
}

void dev_close(struct dev *d)
{
	ect_free(d->h);
	d->h = NULL;
}

static unsigned int master_count(void)
{
	struct dev d;
	unsigned int n;

	if (dev_open(&d, 0, false))
		return 0;
	n = max(ect_version(d.h)->masters, 1U);
	dev_close(&d);
	return n;
}

/* A note on masters of a list that do not exist, if others do. */
static void note_absent(const struct list *l, unsigned int count)
{
	for (unsigned int i = 0; l->given && i < l->n; i++)
		if (l->item[i].from == l->item[i].to && l->item[i].from >= count)
			note("warning: no master %u, the last one is master %u", l->item[i].from,
			     count - 1);
}

static int no_such_master(unsigned int count)
{
	if (count == 1)
		return usage_error("no such master, there is only master 0");
	return usage_error("no such master, there are masters 0 to %u", count - 1);
}

int dev_open_single(struct dev *d, const struct tool *t, bool write)
{
	unsigned int count = master_count();
	struct numbers m;
	int ret;

	if (!count)
		return 1;
	if (list_expand(&t->masters, count, &m))
		return fail("out of memory");
	if (m.n == 1)
		ret = dev_open(d, m.v[0], write);
	else if (m.n)
		ret = usage_error("%u masters found, the command needs one; select it with -m",
				  count);
	else
		ret = no_such_master(count);
	numbers_free(&m);
	return ret;
}

static int walk_master(const struct slave_walk *w, const struct tool *t, struct dev *d);

/* @fn or @w */
static int each_master(const struct tool *t, bool write,
		       int (*fn)(const struct tool *t, struct dev *d), const struct slave_walk *w)
{
	unsigned int count = master_count();
	struct numbers m;
	int ret = 0;

	if (!count)
		return 1;
	if (list_expand(&t->masters, count, &m))
		return fail("out of memory");
	if (!m.n)
		ret = no_such_master(count);
	else
		note_absent(&t->masters, count);
	for (size_t i = 0; i < m.n; i++) {
		struct dev d;
		int one = dev_open(&d, m.v[i], write);

		if (!one) {
			d.selected = (unsigned int)m.n;
			one = fn ? fn(t, &d) : walk_master(w, t, &d);
			dev_close(&d);
		}
		ret = max(ret, one);
	}
	numbers_free(&m);
	return ret;
}

int dev_each(const struct tool *t, bool write, int (*fn)(const struct tool *t, struct dev *d))
{
	return each_master(t, write, fn, NULL);
}

int dev_master(struct dev *d, struct ect_master *m)
{
	int err;

	m->struct_size = sizeof(*m);
	err = ect_master_read(d->h, m);
	return err ? dev_fail(d, err, "Master%u: cannot read master state", d->master) : 0;
}

int dev_devices(struct dev *d, struct ect_list **list)
{
	int err = ect_devices_read(d->h, list);

	return err ? dev_fail(d, err, "Master%u: cannot read master state", d->master) : 0;
}

int dev_slave_at(struct dev *d, unsigned int position, struct ect_slave *s)
{
	int err;

	s->struct_size = sizeof(*s);
	err = ect_slave_at(d->h, position, s);
	return err ? dev_fail(d, err, "Master%u slave %u: cannot read slave state", d->master,
			position) : 0;
}

int dev_slave(struct dev *d, struct ect_slave *s)
{
	unsigned int position = s->position;
	int err = ect_slave_read(d->h, s->device, s);

	return err ? dev_fail(d, err, "Master%u slave %u: cannot read slave state", d->master,
			position) : 0;
}

void dev_config_why(struct dev *d, unsigned int config, char *buf, size_t size)
{
	struct ect_config_why w = { .struct_size = sizeof(w) };

	if (ect_config_why(d->h, config, &w))
		w.text[0] = '\0';
	snprintf(buf, size, "%s", w.text);
}

void slaves_free(struct slaves *s)
{
	ect_list_free(s->list);
	free(s->v);
	*s = (struct slaves){ 0 };
}

int slaves_copy(struct slaves *to, const struct ect_list *list)
{
	*to = (struct slaves){ .n = ect_list_count(list) };
	to->v = calloc(to->n + 1, sizeof(*to->v));
	if (!to->v)
		return fail("out of memory");
	/* those of a newer library are longer */
	for (size_t i = 0; i < to->n; i++) {
		const struct ect_slave *s = ect_list_get(list, i);

		memcpy(&to->v[i], s, min(sizeof(*s), (size_t)s->struct_size));
		to->v[i].struct_size = sizeof(*s);
	}
	return 0;
}

int dev_slaves(struct dev *d, struct slaves *all)
{
	struct ect_list *list = NULL;
	int err = ect_slaves_read(d->h, &list);

	*all = (struct slaves){ 0 };
	if (err)
		return dev_fail(d, err, "Master%u: cannot read the slaves", d->master);
	if (slaves_copy(all, list)) {
		ect_list_free(list);
		return 1;
	}
	all->list = list;
	return 0;
}

/* Single positions that the ring does not have, beside others that it has. */
static void name_absent(const struct dev *d, const struct tool *t, size_t selected, size_t count)
{
	const struct list *l = &t->positions;

	for (unsigned int i = 0; selected && l->given && list_all(&t->aliases) && i < l->n; i++)
		if (l->item[i].from == l->item[i].to && l->item[i].from >= count)
			note("Master%u: no slave at position %u, the last one is %zu", d->master,
			     l->item[i].from, count - 1);
}

int dev_select(struct dev *d, const struct tool *t, struct slaves *selected, size_t *all)
{
	struct numbers pos;
	struct slaves bus;

	*selected = (struct slaves){ 0 };
	if (dev_slaves(d, &bus))
		return 1;
	if (select_slaves(&t->aliases, &t->positions, bus.v, bus.n, &pos)) {
		slaves_free(&bus);
		return fail("out of memory");
	}
	selected->v = calloc(pos.n + 1, sizeof(*selected->v));
	for (size_t i = 0; selected->v && i < pos.n; i++)
		selected->v[selected->n++] = bus.v[pos.v[i]];
	if (all)
		*all = bus.n;
	name_absent(d, t, pos.n, bus.n);
	dev_selected("slave", !list_all(&t->aliases) || !list_all(&t->positions), pos.n);
	numbers_free(&pos);
	slaves_free(&bus);
	return selected->v ? 0 : fail("out of memory");
}

/* masters[]: master, slaves[]: ... */
static int walk_master(const struct slave_walk *w, const struct tool *t, struct dev *d)
{
	struct slaves sel;
	size_t taken = 0;
	int ret = 0;

	if (dev_select(d, t, &sel, NULL))
		return 1;
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_array("slaves");
	if (w->title && d->selected > 1)
		out_text("Master%u\n", d->master);
	for (size_t i = 0; i < sel.n; i++) {
		if (w->takes && !w->takes(&sel.v[i]))
			continue;
		taken++;
		ret |= w->slave(w, t, d, &sel.v[i], sel.n > 1 || d->selected > 1);
	}
	out_end();
	if (w->end && !ret)
		ret |= w->end(w, d, taken, sel.n);
	out_end();
	slaves_free(&sel);
	return ret;
}

/**
 * dev_each_slave() - call a function for each selected slave of each selected master
 * @t: command line
 * @w: what to do
 *
 * In JSON, masters[] has for each master its index and slaves[].
 *
 * Return: the exit code.
 */
int dev_each_slave(const struct tool *t, const struct slave_walk *w)
{
	int ret;

	out_array("masters");
	ret = each_master(t, w->write, NULL, w);
	out_end();
	return ret;
}

/* Return: 0, or 1 after printing an error */
int dev_why_empty(struct dev *d, const struct ect_master *m, char *buf, size_t size)
{
	const struct ect_device *i;
	struct ect_list *devices;
	bool up = false;

	*buf = 0;
	if (dev_devices(d, &devices))
		return 1;
	for (size_t k = 0; (i = ect_list_get(devices, k)); k++)
		up |= i->link_up;
	i = ect_list_get(devices, 0);
	if (m->phase == ECT_PHASE_WAITING)
		snprintf(buf, size, "no network interface yet, waiting for %s", i ? i->name : "");
	else if (!up)
		snprintf(buf, size, "%s has no link, check the cable", i ? i->name : "");
	else if (m->scan_busy)
		snprintf(buf, size, "a bus scan is running");
	ect_list_free(devices);
	return 0;
}

/* what -a, -p and -d have selected so far, on all masters */
static const char *narrowed;
static size_t selected_count;

/**
 * dev_selected() - note how much a selection has matched
 * @what: was looked for: "slave", "configuration", "domain"
 * @given: the user narrowed it down
 * @n: matches on one master
 */
void dev_selected(const char *what, bool given, size_t n)
{
	if (given)
		narrowed = what;
	selected_count += n;
}

/**
 * dev_nothing_selected() - fail when a selection has matched nothing on any master
 *
 * Return: 0, or 1 after printing that.
 */
int dev_nothing_selected(void)
{
	if (!narrowed || selected_count)
		return 0;
	return fail("the selection matches no %s", narrowed);
}

/* the failure of a command that has no slave to work on */
int dev_none_present(struct dev *d)
{
	struct ect_master m;
	char why[160];

	if (dev_master(d, &m) || dev_why_empty(d, &m, why, sizeof(why)))
		return 1;
	return fail("Master%u: no slaves%s%s", d->master, *why ? ": " : "", why);
}

int dev_select_single(struct dev *d, const struct tool *t, struct ect_slave *s)
{
	struct slaves sel;
	size_t all;
	int ret = 0;

	if (dev_select(d, t, &sel, &all))
		return 1;
	if (sel.n == 1)
		*s = sel.v[0];
	else if (!all)
		ret = dev_none_present(d);
	else
		ret = usage_error("the selection matches %zu of %zu slaves, the command needs one; "
				  "use -p or -a", sel.n, all);
	slaves_free(&sel);
	return ret;
}

int dev_wait_scan(struct dev *d, double timeout_s)
{
	double end = now_s() + timeout_s;

	for (;;) {
		struct ect_master m;

		if (dev_master(d, &m))
			return 1;
		if (!m.scan_busy && m.phase != ECT_PHASE_WAITING)
			return 0;
		if (now_s() >= end)
			return fail("Master%u: %s after %g s", d->master,
				    m.scan_busy ? "the bus scan has not finished" :
				    "no network interface", timeout_s);
		sleep_ms(20);
	}
}

void slave_name(const struct ect_slave *s, char *buf, size_t size)
{
	if (s->name[0])
		snprintf(buf, size, "%s", s->name);
	else
		snprintf(buf, size, "0x%08x:0x%08x", s->vendor_id, s->product_code);
}

/* as in JSON; NULL: not synchronized to the reference clock */
const char *cycle_lock_key(u32 lock)
{
	static const char *const key[] = { NULL, "seeking", "locked", "holding" };

	return lock < ARRAY_SIZE(key) ? key[lock] : NULL;
}

void al_state_text(unsigned int al_status, char *buf, size_t size)
{
	snprintf(buf, size, "%s%s", ec_al_state_name((u8)al_status),
		 al_status & EC_AL_ERROR ? "+ERROR" : "");
}

/* second number of "alias:relative" */
unsigned int slave_alias_pos(const struct ect_slave *s)
{
	return s->alias_group ? s->alias_pos : s->position;
}
