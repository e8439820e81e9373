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

bool fake_bus(const char *name);
void fake_record(const char *fmt, ...) __attribute__((format(printf, 1, 2)));
void fake_hex(const char *what, const __u8 *data, __u32 n);
int fake_fail(int err, const char *why);

extern const struct ec_ip_params fake_net;

/* 0, -1 with errno, or FAKE_OTHER */
int fake_app(unsigned long request, void *arg);
int fake_mbox(unsigned long request, void *arg);
int fake_events(unsigned long request, void *arg);

void fake_why(unsigned long request, void *arg);
/* fake_glance.c */
void fake_glance_slave(struct ec_ioc_slave *s);
void fake_glance_registers(const struct ec_ioc_reg *x, __u8 *to);

/* of the application that runs */
extern const unsigned int fake_configs, fake_domains;
extern unsigned int fake_index;	/* of the master */

#endif
