// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * All work of a cycle: what the CPUs execute in N cycles, of every thread and interrupt,
 * without the simulator. Under -icount an instruction takes a nanosecond while time that
 * nobody uses passes at once, so work is the time that has passed less the idle time.
 */
#include "bench.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The kernel's idle time of all CPUs, ns. It stands still while somebody works. */
static unsigned long long idle_ns(void)
{
	unsigned long long sum = 0, ns;
	char line[256];
	FILE *f = fopen("/proc/timer_list", "r");

	while (f && fgets(line, sizeof(line), f))
		if (sscanf(line, " .idle_sleeptime : %llu", &ns) == 1)
			sum += ns;
	if (f)
		fclose(f);
	return sum;
}

/* First line of /proc/PID/@file */
static int task_line(const char *pid, const char *file, char *line, int size)
{
	char path[300];
	FILE *f;
	int ok;

	snprintf(path, sizeof(path), "/proc/%s/%s", pid, file);
	f = fopen(path, "r");
	ok = f && fgets(line, size, f);
	if (f)
		fclose(f);
	return ok;
}

/* What the simulator and the interrupt threads of its network card have run, ns. */
static unsigned long long simulator_ns(void)
{
	unsigned long long sum = 0, ns;
	char line[256];
	struct dirent *e;
	DIR *d = opendir("/proc");

	while (d && (e = readdir(d))) {
		if (*e->d_name < '0' || *e->d_name > '9' ||
		    !task_line(e->d_name, "comm", line, sizeof(line)) ||
		    (strcmp(line, "ethercat-sim\n") && !(!strncmp(line, "irq/", 4) && strstr(line, "eth1"))))
			continue;
		if (task_line(e->d_name, "schedstat", line, sizeof(line)) &&
		    sscanf(line, "%llu", &ns) == 1)
			sum += ns;
	}
	if (d)
		closedir(d);
	return sum;
}

static long long now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec * 1000000000LL + t.tv_nsec;
}

/* Reading the figures is work: idle time is read next to the clock at both ends. */
void work_begin(struct work *w)
{
	w->simulator = simulator_ns();
	w->idle = idle_ns();
	w->begin = now_ns();
}

void work_end(struct work *w)
{
	w->all = (unsigned long long)(now_ns() - w->begin);
	w->all -= idle_ns() - w->idle;
	w->simulator = simulator_ns() - w->simulator;
}

/* What the machine does while nobody wants anything of it, in @ms milliseconds. */
int work_baseline(unsigned int ms)
{
	struct timespec t = { .tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000L };
	struct work w;

	nanosleep(&t, NULL);
	work_begin(&w);
	nanosleep(&t, NULL);
	work_end(&w);
	printf("baseline_per_ms %llu\n", w.all / ms);
	return 0;
}
