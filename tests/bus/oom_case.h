/* SPDX-License-Identifier: GPL-2.0-only */
/* What the suites about failing allocations share; oom.h stands before the master's sources. */
#ifndef EC_OOM_CASE_H
#define EC_OOM_CASE_H

#include "cyc.h"

#define OOM_SLAVES	4
#define OOM_DRIVE	1
#define OOM_SWITCH	3

extern const char oom_line[];
extern unsigned long oom_place;	/* of the last allocation that failed */

void oom_fail(u32 n);
void oom_fail_two(u32 n, u32 m);
void oom_fail_from(u32 n);
bool oom_has_failed(void);
void oom_exit(struct kunit *test);

bool oom_becomes_whole(struct bus *b);
int oom_configure(struct bus *b, struct cyc *c, bool kernel);

#endif
