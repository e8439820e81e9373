/* SPDX-License-Identifier: GPL-2.0-only */
/* What the parts of the fake master share. */
#ifndef EC_FAKE_H
#define EC_FAKE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "../../include/uapi/ethercat.h"

#define FAKE_OTHER	1	/* the command is of another part */
#define LEN(a)		(sizeof(a) / sizeof((a)[0]))

/* as in older versions of the interface: all of a slave, and of a master, in one piece */
struct fake_port {
	__u8 type;
	__u8 link_up;
	__u8 loop_closed;
	__u8 signal;
	__u32 receive_time;
	__u16 next_slave;
	__u32 delay_to_next_dc;
};

struct fake_slave {
	struct ec_ioc_slave;
	struct fake_port ports[EC_UAPI_PORTS];
	char group[EC_UAPI_STRING];
	char image[EC_UAPI_STRING];
	char order[EC_UAPI_STRING];
	char name[EC_UAPI_STRING];
	char why[EC_UAPI_REASON];
	char warning[EC_UAPI_WARNING];
	struct ec_cause cause;
};

struct fake_master {
	struct ec_ioc_master;
	struct ec_ioc_device devices[EC_UAPI_DEVICES];
};

#define FAKE_SLAVES	3
#define FAKE_BIG	1000
#define FAKE_DEVICE	11	/* number of the device at position 0 */

bool fake_bus(const char *name);
void fake_record(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
void fake_hex(const char *what, const __u8 *data, __u32 n);
int fake_fail(int err, const char *why);

extern const struct ec_ip_params fake_net;

/* 0, -1 with errno, or FAKE_OTHER */
int fake_app(unsigned long request, void *arg);
int fake_mbox(unsigned long request, void *arg);
int fake_run(unsigned long request, void *arg);
void fake_run_master(struct fake_master *m);
void fake_run_slave(struct fake_slave *s);
int fake_events(unsigned long request, void *arg);
int fake_mail(unsigned long request, void *arg);
bool fake_mail_read(void *buf, unsigned long size, long *bytes);
int fake_recorder(unsigned long request, void *arg);
bool fake_recorder_read(void *buf, unsigned long size, long *bytes);

void fake_why(unsigned long request, void *arg);
bool fake_why_unit(struct ec_ioc_unit_info *x);
void fake_why_master(struct fake_master *m);
void fake_why_slave(struct fake_slave *s);
/* fake_slave.c */
int fake_slave_command(unsigned long request, void *arg);
int fake_slave_get(__u16 position, struct fake_slave *s);
/* fake_glance.c */
void fake_glance_slave(struct fake_slave *s);
void fake_glance_registers(const struct ec_ioc_reg *x, __u8 *to);

/* of the application that runs */
extern const unsigned int fake_configs, fake_domains;
extern unsigned int fake_index;	/* of the master */

#endif
