/* SPDX-License-Identifier: GPL-2.0-only */
/* A master's device file. Functions print their error and return 0 or 1. */
#ifndef EC_TOOL_DEV_H
#define EC_TOOL_DEV_H

#include "../include/ethercat-tools.h"
#include "tool.h"

struct dev {
	struct ect_handle *h;
	unsigned int master;
	unsigned int selected;		/* masters that -m leaves */
};

/* those that a selection has, or all of a master: only then there is @list */
struct slaves {
	size_t n;
	struct ect_slave *v;
	struct ect_list *list;
};

int dev_open(struct dev *d, unsigned int master, bool write);
void dev_close(struct dev *d);
/* the failure @err of the library, which is negative */
int dev_fail(struct dev *d, int err, const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));

/* the one master of a command that needs exactly one */
int dev_open_single(struct dev *d, const struct tool *t, bool write);
/* calls @fn for every selected master; its value is the largest returned */
int dev_each(const struct tool *t, bool write, int (*fn)(const struct tool *t, struct dev *d));

/**
 * struct slave_walk - what a command does with the selected slaves of each master
 * @write: for traffic or changes
 * @title: a line with the master where there are several
 * @takes: whether the command works on a slave, NULL: on all
 * @slave: does it, @several slaves may follow each other; returns the exit code
 * @end: behind the slaves of a master unless one has failed, with the number of slaves taken and
 *	selected; may be NULL
 * @ctx: of the command
 */
struct slave_walk {
	bool write;
	bool title;
	bool (*takes)(const struct ect_slave *s);
	int (*slave)(const struct slave_walk *w, const struct tool *t, struct dev *d,
		     const struct ect_slave *s, bool several);
	int (*end)(const struct slave_walk *w, struct dev *d, size_t taken, size_t selected);
	void *ctx;
};

int dev_each_slave(const struct tool *t, const struct slave_walk *w);

int dev_master(struct dev *d, struct ect_master *m);
/* main, backup; to be freed with ect_list_free() */
int dev_devices(struct dev *d, struct ect_list **list);
int dev_slave_at(struct dev *d, unsigned int position, struct ect_slave *s);
/* @s again */
int dev_slave(struct dev *d, struct ect_slave *s);
int dev_slaves(struct dev *d, struct slaves *all);
/* copies of a list, without it; 0, or 1 after printing that there is no memory */
int slaves_copy(struct slaves *s, const struct ect_list *list);
void slaves_free(struct slaves *s);

/* why a configured slave is not in OP; "": it is, or an older module does not say */
void dev_config_why(struct dev *d, unsigned int config, char *buf, size_t size);

/* what -a and -p select; @all may be NULL */
int dev_select(struct dev *d, const struct tool *t, struct slaves *selected, size_t *all);
/* whether all of that was nothing, on all masters */
void dev_selected(const char *what, bool given, size_t n);
int dev_nothing_selected(void);
int dev_none_present(struct dev *d);
/* exactly one */
int dev_select_single(struct dev *d, const struct tool *t, struct ect_slave *s);

/* why no slave is on the bus, as far as the master knows; "" when it does not */
int dev_why_empty(struct dev *d, const struct ect_master *m, char *buf, size_t size);
int dev_wait_scan(struct dev *d, double timeout_s);

void slave_name(const struct ect_slave *s, char *buf, size_t size);
const char *cycle_lock_key(u32 lock);
void al_state_text(unsigned int al_status, char *buf, size_t size);
unsigned int slave_alias_pos(const struct ect_slave *s);
double now_s(void);
void sleep_ms(unsigned int ms);

#endif
