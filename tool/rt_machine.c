// SPDX-License-Identifier: GPL-2.0-only
/* Kernel, CPUs and rights of the user. */
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "../lib/tools/attr.h"
#include "rt.h"
#include "sys.h"

#define CAP_IPC_LOCK	14
#define CAP_SYS_NICE	23
#define IDLE_US		20	/* to leave an idle state; more is visible in a cycle of 1 ms */
#define PRIORITY	50	/* of a cycle that the kernel runs, without a setting */

void rt_find(struct rt *r, const char *check, enum rt_level level, const char *fix,
	     const char *fmt, ...)
{
	struct rt_finding *v = realloc(r->v, (r->n + 1) * sizeof(*v));
	va_list ap;

	if (!v) {
		r->failed = true;
		return;
	}
	r->v = v;
	v += r->n++;
	v->check = check;
	v->level = level;
	attr_path(v->fix, sizeof(v->fix), "%s", fix ? fix : "");
	va_start(ap, fmt);
	vsnprintf(v->found, sizeof(v->found), fmt, ap);
	va_end(ap);
}

unsigned int rt_cpus(const char *list, bool *cpus)
{
	unsigned int n = 0;
	char *end;

	memset(cpus, 0, RT_CPUS * sizeof(*cpus));
	while (isdigit((unsigned char)*list)) {
		unsigned long from = strtoul(list, &end, 10), to = from;

		if (*end == '-')
			to = strtoul(end + 1, &end, 10);
		for (; from <= to && from < RT_CPUS; from++) {
			n += !cpus[from];
			cpus[from] = true;
		}
		list = *end == ',' ? end + 1 : end;
	}
	return n;
}

static void sys_path(char *dir, size_t size, const char *name)
{
	attr_path(dir, size, "%s/%s", sys_fs(), name);
}

static void check_preempt(struct rt *r)
{
	char dir[512], release[96];
	static const char fix[] = "boot a kernel with PREEMPT_RT (Debian: apt install linux-image-rt-amd64)";

	attr_path(dir, sizeof(dir), "%s/sys/kernel", sys_proc());
	attr_read(dir, "osrelease", release, sizeof(release));
	sys_path(dir, sizeof(dir), "kernel");
	if (attr_number(dir, "realtime"))
		rt_find(r, "kernel", RT_OK, NULL, "%s, PREEMPT_RT", release);
	else
		rt_find(r, "kernel", RT_ERROR, fix,
			"%s without PREEMPT_RT: a wake-up may take milliseconds", release);
}

static void check_clock(struct rt *r)
{
	static const char slow[] = "dmesg | grep -i tsc (why the kernel does not use the TSC)";
	char dir[512], now[32];

	sys_path(dir, sizeof(dir), "devices/system/clocksource/clocksource0");
	if (!attr_read(dir, "current_clocksource", now, sizeof(now)))
		rt_find(r, "clocksource", RT_UNKNOWN, NULL, "cannot be read");
	else if (!strcmp(now, "hpet") || !strcmp(now, "acpi_pm") || !strcmp(now, "jiffies"))
		rt_find(r, "clocksource", RT_ERROR, slow, "%s: slow, or too coarse for a cycle",
			now);
	else
		rt_find(r, "clocksource", RT_OK, NULL, "%s", now);
}

/* a setting of sysctl(8) with one good value */
static void check_sysctl(struct rt *r, const char *check, const char *name, long good,
			 const char *what)
{
	char dir[512], text[32], fix[96];

	attr_path(dir, sizeof(dir), "%s/sys/kernel", sys_proc());
	attr_path(fix, sizeof(fix), "sysctl -w kernel.%s=%ld", name, good);
	if (!attr_read(dir, name, text, sizeof(text)))
		rt_find(r, check, RT_UNKNOWN, NULL, "kernel.%s cannot be read", name);
	else if (strtol(text, NULL, 10) == good)
		rt_find(r, check, RT_OK, NULL, "kernel.%s is %s", name, text);
	else
		rt_find(r, check, RT_WARNING, fix, "kernel.%s is %s: %s", name, text, what);
}

/* does the kernel have a file in /proc? */
static bool has_proc(const char *name)
{
	char path[512];

	attr_path(path, sizeof(path), "%s/%s", sys_proc(), name);
	return !access(path, F_OK);
}

/* other debug options leave no trace that every user may see */
static void check_debug(struct rt *r)
{
	if (has_proc("lockdep_stats"))
		rt_find(r, "debugging", RT_ERROR, "boot a kernel without CONFIG_LOCKDEP",
			"the kernel checks its locks: each takes many times longer");
	else
		rt_find(r, "debugging", RT_OK, NULL, "the kernel does not check its locks");
}

/* a kernel with PREEMPT_RT has none */
static void check_huge_pages(struct rt *r)
{
	static const char never[] = "echo never > /sys/kernel/mm/transparent_hugepage/enabled";
	char dir[512], text[96];

	sys_path(dir, sizeof(dir), "kernel/mm/transparent_hugepage");
	if (attr_read(dir, "enabled", text, sizeof(text)) && strstr(text, "[always]"))
		rt_find(r, "huge pages", RT_WARNING, never,
			"the kernel moves pages of any program to make huge ones");
	else
		rt_find(r, "huge pages", RT_OK, NULL, "none of programs that do not ask for them");
}

/* a kernel without swap has no such file; the first line is a title */
static void check_swap(struct rt *r)
{
	char path[512], line[512];
	unsigned int lines = 0;
	FILE *f;

	attr_path(path, sizeof(path), "%s/swaps", sys_proc());
	f = fopen(path, "r");
	while (f && fgets(line, sizeof(line), f))
		lines++;
	if (f)
		fclose(f);
	if (lines > 1)
		rt_find(r, "swap", RT_WARNING, "swapoff -a, and mlockall() in the application",
			"pages that the application has not locked may be on a disk");
	else
		rt_find(r, "swap", RT_OK, NULL, "none");
}

static void check_pressure(struct rt *r)
{
	if (has_proc("pressure/cpu"))
		rt_find(r, "pressure", RT_WARNING, "kernel parameter psi=0",
			"the kernel accounts for it at each switch to another task");
	else
		rt_find(r, "pressure", RT_OK, NULL, "the kernel does not account for it");
}

void rt_check_kernel(struct rt *r)
{
	check_preempt(r);
	check_clock(r);
	check_sysctl(r, "throttling", "sched_rt_runtime_us", -1,
		     "the kernel stops real-time threads that use their share of a second");
	check_sysctl(r, "timers", "timer_migration", 0, "timers may expire on another CPU");
	check_sysctl(r, "watchdog", "nmi_watchdog", 0,
		     "a periodic interrupt that nothing can hold up");
	check_debug(r);
	check_huge_pages(r);
	check_swap(r);
	check_pressure(r);
}

static void check_isolation(struct rt *r, unsigned int online)
{
	char dir[512], tick[128], others[16];
	bool quiet[RT_CPUS];
	unsigned int i, loud = 0;
	char fix[192];

	sys_path(dir, sizeof(dir), "devices/system/cpu");
	attr_read(dir, "isolated", r->list, sizeof(r->list));
	attr_read(dir, "nohz_full", tick, sizeof(tick));
	r->n_isolated = rt_cpus(r->list, r->isolated);
	if (!r->n_isolated) {
		attr_path(others, sizeof(others), online > 2 ? "0-%u" : "0", online - 2);
		attr_path(fix, sizeof(fix), online < 2 ? "use a machine with 2 CPUs or more" :
			  "kernel parameters isolcpus=managed_irq,domain,%u nohz_full=%u irqaffinity=%s",
			  online - 1, online - 1, others);
		rt_find(r, "isolation", RT_WARNING, fix,
			"no CPU is reserved for the cycle (%u online)", online);
		return;
	}
	rt_find(r, "isolation", RT_OK, NULL, "CPU %s is reserved", r->list);
	rt_cpus(tick, quiet);
	for (i = 0; i < RT_CPUS; i++)
		loud += r->isolated[i] && !quiet[i];
	attr_path(fix, sizeof(fix), "kernel parameter nohz_full=%s", r->list);
	if (loud)
		rt_find(r, "tick", RT_WARNING, fix, "%u reserved CPU(s) have a periodic tick",
			loud);
	else
		rt_find(r, "tick", RT_OK, NULL, "no tick on reserved CPUs");
}

/* CPUs of the cycle: the reserved ones, or any */
static bool is_used(const struct rt *r, const bool *online, unsigned int cpu)
{
	return r->n_isolated ? r->isolated[cpu] : online[cpu];
}

static void check_governor(struct rt *r, const bool *online)
{
	static const char fix[] = "cpupower frequency-set -g performance";
	char dir[512], text[32], bad[32] = "";
	unsigned int i, cpu = 0, n = 0;

	for (i = 0; i < RT_CPUS; i++) {
		if (!is_used(r, online, i))
			continue;
		attr_path(dir, sizeof(dir), "%s/devices/system/cpu/cpu%u/cpufreq", sys_fs(), i);
		if (!attr_read(dir, "scaling_governor", text, sizeof(text)) ||
		    !strcmp(text, "performance"))
			continue;
		if (!n++) {
			attr_path(bad, sizeof(bad), "%s", text);
			cpu = i;
		}
	}
	if (n)
		rt_find(r, "frequency", RT_ERROR, fix, "CPU %u has the governor %s, and %u more",
			cpu, bad, n - 1);
	else
		rt_find(r, "frequency", RT_OK, NULL, "the governor does not lower it");
}

/* the longest time that an enabled idle state of the CPU needs to end, us */
static unsigned long deepest(unsigned int cpu, char *name, size_t size)
{
	unsigned long most = 0;

	for (unsigned int i = 0; i < 32; i++) {
		char dir[512];
		unsigned long us;

		attr_path(dir, sizeof(dir), "%s/devices/system/cpu/cpu%u/cpuidle/state%u", sys_fs(),
			  cpu, i);
		us = attr_number(dir, "latency");
		if (us <= most || attr_number(dir, "disable"))
			continue;
		most = us;
		attr_read(dir, "name", name, size);
	}
	return most;
}

static void check_idle(struct rt *r, const bool *online)
{
	static const char fix[] = "kernel parameter cpuidle.off=1, or write 0 to /dev/cpu_dma_latency and keep it open";
	unsigned long most = 0, us;
	char name[32], worst[32] = "";
	unsigned int cpu = 0;

	for (unsigned int i = 0; i < RT_CPUS; i++) {
		us = is_used(r, online, i) ? deepest(i, name, sizeof(name)) : 0;
		if (us <= most)
			continue;
		most = us;
		cpu = i;
		attr_path(worst, sizeof(worst), "%s", name);
	}
	if (most > IDLE_US)
		rt_find(r, "idle states", RT_WARNING, fix,
			"CPU %u may enter %s and needs %lu us to leave it", cpu, worst, most);
	else
		rt_find(r, "idle states", RT_OK, NULL, "at most %lu us to leave one", most);
}

void rt_check_cpus(struct rt *r)
{
	char dir[512], list[128];
	bool online[RT_CPUS];
	unsigned int n;

	sys_path(dir, sizeof(dir), "devices/system/cpu");
	if (!attr_read(dir, "online", list, sizeof(list))) {
		rt_find(r, "isolation", RT_UNKNOWN, NULL, "%s/online cannot be read", dir);
		return;
	}
	n = rt_cpus(list, online);
	check_isolation(r, n);
	check_governor(r, online);
	check_idle(r, online);
	if (attr_number(dir, "smt/active"))
		rt_find(r, "threads", RT_WARNING, "kernel parameter nosmt",
			"two threads share the execution units of a core");
	else
		rt_find(r, "threads", RT_OK, NULL, "one thread for each core");
}

/* effective capability of this process */
static bool capable(unsigned int cap)
{
	char path[512], line[256];
	unsigned long long caps = 0;
	FILE *f;

	attr_path(path, sizeof(path), "%s/self/status", sys_proc());
	f = fopen(path, "r");
	while (f && fgets(line, sizeof(line), f))
		if (sscanf(line, "CapEff: %llx", &caps) == 1)
			break;
	if (f)
		fclose(f);
	return caps >> cap & 1;
}

static void check_limit(struct rt *r, const char *check, int resource, unsigned int cap,
			rlim_t needed, const char *what, const char *fix)
{
	struct rlimit l = { 0 };

	if (capable(cap) || (!getrlimit(resource, &l) && l.rlim_cur >= needed))
		rt_find(r, check, RT_OK, NULL, "this user may %s", what);
	else
		rt_find(r, check, RT_WARNING, fix, "this user may not %s (limit %llu)", what,
			(unsigned long long)l.rlim_cur);
}

void rt_check_user(struct rt *r)
{
	check_limit(r, "memory", RLIMIT_MEMLOCK, CAP_IPC_LOCK, RLIM_INFINITY, "lock memory",
		    "a line '@ethercat - memlock unlimited' in /etc/security/limits.d/ethercat.conf");
	check_limit(r, "priority", RLIMIT_RTPRIO, CAP_SYS_NICE, PRIORITY,
		    "run threads at priority 50",
		    "a line '@ethercat - rtprio 90' in /etc/security/limits.d/ethercat.conf");
}
