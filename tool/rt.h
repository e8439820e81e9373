/* SPDX-License-Identifier: GPL-2.0-only */
/* Settings of this computer that matter for a cycle in real time. */
#ifndef EC_TOOL_RT_H
#define EC_TOOL_RT_H

#include <stdbool.h>
#include <stddef.h>

#define RT_CPUS	1024

enum rt_level {
	RT_OK,
	RT_WARNING,	/* may delay a cycle */
	RT_ERROR,	/* delays cycles */
	RT_UNKNOWN,	/* cannot be read */
};

/**
 * struct rt_finding - result of one check
 * @check: its name
 * @level: how good it is
 * @found: the setting
 * @fix: command or kernel parameter that changes it, "" when it is fine
 */
struct rt_finding {
	const char *check;
	enum rt_level level;
	char found[256];
	char fix[256];
};

/**
 * struct rt - all of them
 * @n: findings in @v
 * @v: in the order of the checks
 * @failed: out of memory
 * @isolated: CPUs that the scheduler leaves alone
 * @n_isolated: how many
 * @list: the same as the kernel writes them
 */
struct rt {
	size_t n;
	struct rt_finding *v;
	bool failed;
	bool isolated[RT_CPUS];
	unsigned int n_isolated;
	char list[128];
};

/* @fix is NULL for RT_OK; what was found follows */
void rt_find(struct rt *r, const char *check, enum rt_level level, const char *fix,
	     const char *fmt, ...) __attribute__((format(printf, 5, 6)));
/* "0-2,5"; returns how many */
unsigned int rt_cpus(const char *list, bool *cpus);

void rt_check_kernel(struct rt *r);
void rt_check_cpus(struct rt *r);
void rt_check_interrupts(struct rt *r);
void rt_check_user(struct rt *r);
int rt_check_cards(struct rt *r);
/* after rt_check_cpus(), which finds the reserved ones */
void rt_check_posts(struct rt *r);

#endif
