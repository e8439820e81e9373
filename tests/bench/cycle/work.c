// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * All work of a cycle: what the CPU executes in N cycles, of every thread and interrupt, as
 * bench_split.ko counts it. The simulator's part is apart: its thread, the threads of its
 * network cards (eth1, in a ring also eth3), the work that their driver puts off, and the
 * interrupts that wake them. As a check of that, all of it is also the time that has passed less
 * the idle time.
 */
#include "bench.h"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <time.h>
#include <unistd.h>

#define BESIDE		"beside"
#define PARAMETERS	"/sys/module/bench_split/parameters/"

static enum worker worker(const char *name)
{
	if (!strcmp(name, "ethercat-sim") || (!strncmp(name, "irq/", 4) &&
					      (strstr(name, "eth1") || strstr(name, "eth3"))))
		return WORKER_SIMULATOR;
	/* with the generic device it may be of either card */
	if (!strcmp(name, "e1000e") && access("/sys/class/net/eth0", F_OK))
		return WORKER_SIMULATOR;
	if (!strcmp(name, "cycle-bench"))
		return WORKER_APPLICATION;
	if (!strncmp(name, "irq/", 4) && (strstr(name, "eth0") || strstr(name, "eth2")))
		return WORKER_CARD;
	if (!strcmp(name, BESIDE))
		return WORKER_OTHER;
	return !strncmp(name, "EtherCAT", 8) ? WORKER_MASTER : WORKER_REST;
}

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

static long long now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec * 1000000000LL + t.tv_nsec;
}

/* @spins: a process computes all the time. false: bench_split.ko does not count */
bool work_begin(struct work *w, bool spins)
{
	const char *way = spins ? "spin" : "1";
	int fd = open(PARAMETERS "clear", O_WRONLY | O_CLOEXEC);
	bool ok;

	w->idle = idle_ns();
	w->begin = now_ns();
	ok = fd >= 0 && write(fd, way, strlen(way)) == (ssize_t)strlen(way);
	if (fd >= 0)
		close(fd);
	return ok;
}

void work_end(struct work *w)
{
	char text[4096], name[64], *p = text;
	int fd = open(PARAMETERS "tasks", O_RDONLY | O_CLOEXEC), len;
	ssize_t n = fd >= 0 ? read(fd, text, sizeof(text) - 1) : 0;
	unsigned long long ns;

	if (fd >= 0)
		close(fd);
	w->all = (unsigned long long)(now_ns() - w->begin);
	w->all -= idle_ns() - w->idle;
	text[n > 0 ? n : 0] = '\0';
	memset(w->by, 0, sizeof(w->by));
	for (; sscanf(p, "%63s %llu %n", name, &ns, &len) == 2; p += len) {
		/* in the kernel's idle time, but executed */
		if (!strcmp(name, "idling"))
			w->all += ns;
		else
			w->by[worker(name)] += ns;
	}
}

/* A process without priority that computes until it is killed; returns its PID, or -1. */
pid_t work_beside(void)
{
	struct sched_param none = { 0 };
	pid_t pid = fork();

	if (pid)
		return pid;
	prctl(PR_SET_PDEATHSIG, SIGKILL);
	prctl(PR_SET_NAME, BESIDE);
	if (sched_setscheduler(0, SCHED_OTHER, &none))
		_exit(1);
	while (1)
		;
}

/*
 * What the machine does while no one wants anything of it, in @ms milliseconds; and while a
 * process computes, without what that executes: then the clock ticks.
 */
int work_baseline(unsigned int ms)
{
	struct timespec t = { .tv_sec = ms / 1000, .tv_nsec = ms % 1000 * 1000000L };
	unsigned long long sum = 0, spinning = 0;
	struct work w;
	long long end;

	nanosleep(&t, NULL);
	if (!work_begin(&w, false)) {
		fprintf(stderr, "cycle-bench: bench_split.ko is not loaded\n");
		return 1;
	}
	nanosleep(&t, NULL);
	work_end(&w);
	for (unsigned int i = 0; i < WORKERS; i++)
		sum += w.by[i];
	if (!work_begin(&w, true)) {
		perror("cycle-bench: bench_split.ko");
		return 1;
	}
	end = now_ns() + ms * 1000000LL;
	while (now_ns() < end)
		;
	work_end(&w);
	for (unsigned int i = 0; i < WORKERS; i++)
		spinning += i == WORKER_APPLICATION ? 0 : w.by[i];
	printf("baseline_per_ms %llu\nspinning_per_ms %llu\n", sum / ms, spinning / ms);
	return 0;
}
