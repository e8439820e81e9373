/* SPDX-License-Identifier: GPL-2.0-only */
/* A master's device file. Functions print their error and return 0 or 1. */
#ifndef EC_TOOL_DEV_H
#define EC_TOOL_DEV_H

#include "tool.h"

struct dev {
	int fd;
	unsigned int master;
	char path[256];
	struct ec_ioc_version version;
	unsigned int selected;		/* masters that -m leaves */
};

/* state of a master, with its network devices */
struct master {
	struct ec_ioc_master;
	struct ec_ioc_device devices[EC_UAPI_DEVICES];
};

/*
 * A slave as it was found, with its texts and ports. @slave of the anonymous member names the
 * device: further commands reach this one or fail, whatever slave has its position by now.
 */
struct slave {
	struct ec_ioc_slave;
	struct ec_ioc_port ports[EC_UAPI_PORTS];
	char group[EC_UAPI_STRING];
	char image[EC_UAPI_STRING];
	char order[EC_UAPI_STRING];
	char name[EC_UAPI_STRING];
	char why[EC_UAPI_REASON];
	char warning[EC_UAPI_WARNING];
	struct ec_cause cause;
};

struct slaves {
	size_t n;
	struct slave *v;
};

int dev_open(struct dev *d, unsigned int master, bool write);
void dev_close(struct dev *d);
int dev_ioctl(struct dev *d, unsigned long request, void *arg);
void dev_reason(struct dev *d, int err, char *buf, size_t size);
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
	bool (*takes)(const struct slave *s);
	int (*slave)(const struct slave_walk *w, const struct tool *t, struct dev *d,
		     const struct slave *s, bool several);
	int (*end)(const struct slave_walk *w, struct dev *d, size_t taken, size_t selected);
	void *ctx;
};

int dev_each_slave(const struct tool *t, const struct slave_walk *w);

int master_read(int fd, struct master *m);
int dev_master(struct dev *d, struct master *m);
int dev_slave(struct dev *d, unsigned int position, struct slave *s);
/* the same device again, wherever it is now; @s may be @of */
int dev_slave_again(struct dev *d, const struct slave *of, struct slave *s);
int dev_slaves(struct dev *d, struct slaves *all);
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
int dev_select_single(struct dev *d, const struct tool *t, struct slave *s);

/* why nobody is on the bus, as far as the master knows; "" when it does not */
void dev_why_empty(const struct master *m, char *buf, size_t size);
int dev_wait_scan(struct dev *d, double timeout_s);

void slave_name(const struct slave *s, char *buf, size_t size);
const char *cycle_lock_key(u32 lock);
void al_state_text(unsigned int al_status, char *buf, size_t size);
unsigned int slave_alias_pos(const struct slave *s);
double now_s(void);
void sleep_ms(unsigned int ms);

#endif
