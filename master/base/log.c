// SPDX-License-Identifier: GPL-2.0-only
/*
 * The kernel log. Users, slaves and cables can repeat an event as fast as they like:
 * what repeats is counted, and logged once more at the end of its window.
 */
#include <linux/ktime.h>
#include <linux/math64.h>
#include <linux/ratelimit.h>
#include <linux/string.h>
#include "base.h"

/* one line that is to be written when the lock is free */
struct line {
	const char *level;
	int slave;
	u32 id;
	u32 more;
	u32 age_ms;	/* so long ago it was, 0: now */
	char text[EC_LOG_TEXT];
};

/**
 * ec_log_init() - initialize the log of a master
 * @l: log, zeroed
 *
 * Context: Any.
 */
void ec_log_init(struct ec_log *l)
{
	raw_spin_lock_init(&l->lock);
}

static void print(const struct ec_base *b, const struct line *line)
{
	char who[24], more[40] = "", ago[32] = "";

	if (line->slave == EC_LOG_ANY)
		scnprintf(who, sizeof(who), "%u", b->index);
	else
		scnprintf(who, sizeof(who), "%u-%d", b->index, line->slave);
	if (line->more)
		scnprintf(more, sizeof(more), " (%u more in the last 10 s)", line->more);
	if (line->age_ms >= 100)
		scnprintf(ago, sizeof(ago), ", %u.%u s ago", line->age_ms / 1000,
			  line->age_ms / 100 % 10);
	printk("%sEtherCAT %s: %s%s%s\n", line->level, who, line->text, ago, more);
}

static bool over(const struct ec_log_event *e, u64 now)
{
	return now - e->since >= EC_LOG_WINDOW_NS;
}

/* The entry of this event, else a free one, else one whose window ended with nothing missed. */
static struct ec_log_event *log_find(struct ec_log *l, const struct line *line, const char *key,
				     u64 now)
{
	bool many = line->slave != EC_LOG_ANY || line->id;
	unsigned int i = many ? EC_LOG_OF_MASTER : 0;
	unsigned int end = many ? ARRAY_SIZE(l->events) : EC_LOG_OF_MASTER;
	struct ec_log_event *unused = NULL;

	lockdep_assert_held(&l->lock);
	for (; i < end; i++) {
		struct ec_log_event *e = &l->events[i];

		if (e->key == key && e->slave == line->slave && e->id == line->id)
			return e;
		if (!unused && (!e->key || (over(e, now) && !e->missed)))
			unused = e;
	}
	if (unused)
		unused->key = NULL;
	return unused;
}

static u32 most_lines(const struct ec_log_event *e, const char *text)
{
	if (!strcmp(e->level, KERN_INFO))
		return EC_LOG_CHANGES;
	return strcmp(e->text, text) ? EC_LOG_VARIED : EC_LOG_REPEATED;
}

/* Is this line to be logged? @line->more: those that were counted before */
static bool log_admit(struct ec_log *l, const char *key, struct line *line, u64 now)
{
	struct ec_log_event *e = log_find(l, line, key, now);
	bool yes, flood;

	lockdep_assert_held(&l->lock);
	if (!e) {
		l->lost_since = l->lost++ ? l->lost_since : now;
		l->pending = true;
		return false;
	}
	if (!e->key || over(e, now)) {
		flood = e->key && e->missed;
		line->more = flood ? e->missed : 0;
		e->key = key;
		e->slave = line->slave;
		e->id = line->id;
		e->level = line->level;
		e->since = now;
		/* a flood continues with one line in each window */
		e->lines = flood ? EC_LOG_CHANGES : 0;
		e->missed = 0;
		e->text[0] = '\0';
		yes = true;
	} else {
		yes = e->lines < most_lines(e, line->text);
	}
	if (yes) {
		e->lines++;
	} else {
		e->missed++;
		l->pending = true;
	}
	strscpy(e->text, line->text, sizeof(e->text));
	e->last = now;
	return yes;
}

static void log_line(struct ec_base *b, const char *key, struct line *line)
{
	struct ec_log *l = &b->log;
	unsigned long irq;
	bool yes;

	raw_spin_lock_irqsave(&l->lock, irq);
	yes = log_admit(l, key, line, ktime_get_ns());
	l->lines += yes;
	raw_spin_unlock_irqrestore(&l->lock, irq);
	if (yes)
		print(b, line);
}

/**
 * ec_log_event() - log an event, or count it if it repeats
 * @b: of the master
 * @slave: ring position or EC_LOG_ANY
 * @id: makes events of one call site different ones, 0: it does not
 * @level: KERN_*
 * @fmt: text; a constant, since it identifies the event
 *
 * In 10 s one line of equal text and three of different text, or five changes
 * of state (KERN_INFO). ec_log_flush() writes the last of the others.
 *
 * Context: Any.
 */
void ec_log_event(struct ec_base *b, int slave, u32 id, const char *level, const char *fmt, ...)
{
	struct line line = { .level = level, .slave = slave, .id = id };
	va_list args;
	int n;

	va_start(args, fmt);
	n = vscnprintf(line.text, sizeof(line.text), fmt, args);
	va_end(args);
	if (n && line.text[n - 1] == '\n')
		line.text[n - 1] = '\0';
	log_line(b, fmt, &line);
}

/**
 * ec_log_text() - as ec_log_event(), with a text that is complete
 * @b: of the master
 * @slave: ring position or EC_LOG_ANY
 * @id: makes events of one @key different ones, 0: it does not
 * @level: KERN_*
 * @key: a constant, since it identifies the event
 * @text: without line end
 *
 * Context: Any.
 */
void ec_log_text(struct ec_base *b, int slave, u32 id, const char *level, const char *key,
		 const char *text)
{
	struct line line = { .level = level, .slave = slave, .id = id };

	strscpy(line.text, text, sizeof(line.text));
	log_line(b, key, &line);
}

/* The next line whose window is over; false: there is none. */
static bool log_take(struct ec_log *l, unsigned int *i, struct line *line, u64 now, bool all)
{
	struct ec_log_event *e;

	lockdep_assert_held(&l->lock);
	for (; *i < ARRAY_SIZE(l->events); (*i)++) {
		e = &l->events[*i];
		if (!e->missed)
			continue;
		if (!all && !over(e, now)) {
			l->pending = true;
			continue;
		}
		line->level = e->level;
		line->slave = e->slave;
		line->more = e->missed - 1;
		line->age_ms = div_u64(now - e->last, NSEC_PER_MSEC);
		strscpy(line->text, e->text, sizeof(line->text));
		e->since = now;
		e->lines = EC_LOG_CHANGES;
		e->missed = 0;
		l->lines++;
		return true;
	}
	return false;
}

static u32 take_lost(struct ec_log *l, u64 now, bool all)
{
	u32 lost = l->lost;

	lockdep_assert_held(&l->lock);
	if (!lost || (!all && now - l->lost_since < EC_LOG_WINDOW_NS)) {
		l->pending |= lost;
		return 0;
	}
	l->lost = 0;
	l->lines++;
	return lost;
}

/**
 * ec_log_flush() - log what was counted only, for events whose window is over
 * @b: of the master
 * @all: for all events
 *
 * Context: Process.
 */
void ec_log_flush(struct ec_base *b, bool all)
{
	struct ec_log *l = &b->log;
	u64 now = ktime_get_ns();
	struct line line;
	unsigned long irq;
	unsigned int i = 0;
	u32 lost;
	bool more;

	if (!READ_ONCE(l->pending))
		return;
	WRITE_ONCE(l->pending, false);
	do {
		raw_spin_lock_irqsave(&l->lock, irq);
		more = log_take(l, &i, &line, now, all);
		raw_spin_unlock_irqrestore(&l->lock, irq);
		if (more)
			print(b, &line);
	} while (more);
	raw_spin_lock_irqsave(&l->lock, irq);
	lost = take_lost(l, now, all);
	raw_spin_unlock_irqrestore(&l->lock, irq);
	if (lost)
		pr_warn("EtherCAT %u: %u more message(s) of other kinds in the last 10 s not logged\n",
			b->index, lost);
}

/**
 * ec_log_debug() - may a line of "ethercat debug 1" be logged now?
 *
 * Context: Any.
 * Return: true for 500 lines a second, of all masters.
 */
bool ec_log_debug(void)
{
	static DEFINE_RATELIMIT_STATE(rate, HZ, 500);

	return __ratelimit(&rate);
}
