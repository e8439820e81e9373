// SPDX-License-Identifier: LGPL-2.1-or-later
/* Counts the system calls between two marks, as a tracer sees them. */
#include "bench.h"

#include <errno.h>
#include <linux/ptrace.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

/* <sys/ptrace.h> and <linux/ptrace.h> exclude each other */
extern long ptrace(int request, ...);

#define BEGIN	0x7ec00001	/* arguments of a harmless call */
#define END	0x7ec00002

void syscalls_mark(bool begin)
{
	syscall(SYS_getpgid, begin ? BEGIN : END);
}

struct count {
	bool on;
	unsigned int now;
	unsigned int cycles;
	unsigned int max;
	unsigned long total;
};

static void entered(struct count *c, const struct ptrace_syscall_info *i)
{
	if (i->op != PTRACE_SYSCALL_INFO_ENTRY)
		return;
	if (i->entry.nr == SYS_getpgid && i->entry.args[0] == BEGIN) {
		c->on = true;
		c->now = 0;
	} else if (i->entry.nr == SYS_getpgid && i->entry.args[0] == END) {
		c->on = false;
		c->cycles++;
		c->total += c->now;
		if (c->now > c->max)
			c->max = c->now;
	} else if (c->on) {
		c->now++;
	}
}

/* Runs @child in a process of its own; returns its exit code. */
int syscalls_run(int (*child)(void *), void *arg)
{
	struct ptrace_syscall_info info;
	struct count c = { 0 };
	int status, sig = 0;
	pid_t pid = fork();

	if (pid < 0) {
		perror("cycle-bench: fork");
		return 1;
	}
	if (!pid) {
		if (ptrace(PTRACE_TRACEME, 0, NULL, NULL) < 0) {
			perror("cycle-bench: ptrace");
			_exit(1);
		}
		raise(SIGSTOP);
		exit(child(arg));
	}
	if (waitpid(pid, &status, 0) != pid || !WIFSTOPPED(status))
		return 1;
	ptrace(PTRACE_SETOPTIONS, pid, NULL,
	       PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
	while (!ptrace(PTRACE_SYSCALL, pid, NULL, (long)sig) &&
	       waitpid(pid, &status, 0) == pid && WIFSTOPPED(status)) {
		sig = WSTOPSIG(status);
		if (sig != (SIGTRAP | 0x80))
			continue;
		sig = 0;
		if (ptrace(PTRACE_GET_SYSCALL_INFO, pid, sizeof(info), &info) > 0)
			entered(&c, &info);
	}
	if (c.cycles)
		printf("syscalls_mean %.2f\nsyscalls_max %u\n",
		       (double)c.total / c.cycles, c.max);
	return WIFEXITED(status) && c.cycles ? WEXITSTATUS(status) : 1;
}
