// SPDX-License-Identifier: GPL-2.0-only
/* The cycle of each master beside the thread of the module that finds lost acyclic frames. */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../include/ethercat-tools.h"
#include "../lib/tools/attr.h"
#include "../lib/tools/text.h"
#include "rt.h"
#include "sys.h"
#include "tool.h"

#define DEADLINE	6	/* SCHED_DEADLINE, which sched.h has with _GNU_SOURCE only */
#define ABOVE_ALL	100	/* its priority, and that of an interrupt */

/**
 * struct thread - a thread of this computer
 * @id: number, 0: none was found
 * @priority: 1 to 99 with SCHED_FIFO and SCHED_RR, else 0 or %ABOVE_ALL
 * @text: its scheduling for a message, "SCHED_FIFO 80"
 * @name: of its program
 * @cpus: where it may run
 */
struct thread {
	int id;
	unsigned int priority;
	char text[32];
	char name[32];
	bool cpus[RT_CPUS];
};

static void set_scheduling(struct thread *t, unsigned int policy, unsigned int priority)
{
	t->priority = priority;
	if (policy == SCHED_FIFO || policy == SCHED_RR)
		attr_path(t->text, sizeof(t->text), "SCHED_%s %u",
			  policy == SCHED_FIFO ? "FIFO" : "RR", priority);
	else
		attr_path(t->text, sizeof(t->text), "SCHED_%s",
			  policy == DEADLINE ? "DEADLINE" : "OTHER");
	if (policy == DEADLINE)
		t->priority = ABOVE_ALL;
}

static void read_cpus(struct thread *t, const char *dir)
{
	char path[640], line[512], list[256];
	FILE *f;

	attr_path(path, sizeof(path), "%s/status", dir);
	f = fopen(path, "r");
	while (f && fgets(line, sizeof(line), f))
		if (sscanf(line, "Cpus_allowed_list: %255s", list) == 1)
			rt_cpus(list, t->cpus);
	if (f)
		fclose(f);
}

/* @dir: its folder in procfs; false: it has just ended, or cannot be read */
static bool read_thread(struct thread *t, const char *dir)
{
	unsigned int priority, policy;
	char line[1024];
	const char *p;

	memset(t, 0, sizeof(*t));
	if (!attr_read(dir, "stat", line, sizeof(line)))
		return false;
	/* fields 40 and 41; the second one, a name in brackets, may contain anything */
	p = strrchr(line, ')');
	for (unsigned int field = 2; p && field < 40; field++)
		p = strchr(p + 1, ' ');
	if (!p || sscanf(p, "%u %u", &priority, &policy) != 2)
		return false;
	t->id = atoi(line);
	set_scheduling(t, policy, priority);
	attr_read(dir, "comm", t->name, sizeof(t->name));
	string_clean(t->name, sizeof(t->name));
	read_cpus(t, dir);
	return true;
}

/* Calls @fn for each folder of @dir that has a number as its name, until one returns true. */
static bool each_number(const char *dir, bool (*fn)(const char *dir, void *arg), void *arg)
{
	bool found = false;
	struct dirent *e;
	char path[600];
	DIR *d = opendir(dir);

	while (d && !found && (e = readdir(d))) {
		if (!isdigit((unsigned char)*e->d_name))
			continue;
		attr_path(path, sizeof(path), "%s/%s", dir, e->d_name);
		found = fn(path, arg);
	}
	if (d)
		closedir(d);
	return found;
}

static bool is_named(const char *dir, void *arg)
{
	struct thread *t = arg, found;
	char name[32];

	if (!attr_read(dir, "comm", name, sizeof(name)) || strcmp(name, t->name) ||
	    !read_thread(&found, dir))
		return false;
	*t = found;
	return true;
}

/* the thread of the application that has the highest priority */
struct search {
	const char *device;
	struct thread *cycle;
};

static bool take_highest(const char *dir, void *arg)
{
	struct search *s = arg;
	struct thread t;

	if (read_thread(&t, dir) && (!s->cycle->id || t.priority > s->cycle->priority))
		*s->cycle = t;
	return false;
}

/* @dir: a descriptor in fd/ of a process; a command that only shows something reads */
static bool is_device(const char *dir, void *arg)
{
	const struct search *s = arg;
	char path[640], target[128];
	const char *number = strrchr(dir, '/');
	ssize_t n = readlink(dir, target, sizeof(target) - 1);
	unsigned int flags;
	char line[64];
	bool writes = false;
	FILE *f;

	if (n < 0)
		return false;
	target[n] = '\0';
	if (strcmp(target, s->device))
		return false;
	attr_path(path, sizeof(path), "%.*s/../fdinfo%s", (int)(number - dir), dir, number);
	f = fopen(path, "r");
	while (f && fgets(line, sizeof(line), f))
		if (sscanf(line, "flags: %o", &flags) == 1)
			writes = (flags & O_ACCMODE) == O_RDWR;
	if (f)
		fclose(f);
	return writes;
}

static bool look_at_process(const char *dir, void *arg)
{
	char path[640];

	attr_path(path, sizeof(path), "%s/fd", dir);
	if (!each_number(path, is_device, arg))
		return false;
	attr_path(path, sizeof(path), "%s/task", dir);
	return each_number(path, take_highest, arg);
}

static void find_cycle(struct thread *t, const char *device, const struct ect_cycle *c)
{
	struct search s = { .device = device, .cycle = t };

	memset(t, 0, sizeof(*t));
	if (c->kind == ECT_CYCLE_BY_APP) {
		each_number(sys_proc(), look_at_process, &s);
		return;
	}
	t->id = -1;
	attr_path(t->name, sizeof(t->name), "of the kernel");
	set_scheduling(t, c->priority ? SCHED_FIFO : SCHED_OTHER, c->priority);
	if (c->place == ECT_PLACE_INTERRUPT) {
		t->priority = ABOVE_ALL;
		attr_path(t->text, sizeof(t->text), "interrupt");
	}
	for (unsigned int i = 0; i < RT_CPUS; i++)
		t->cpus[i] = c->cpu < 0 || i == (unsigned int)c->cpu;
}

/* The scheduler moves a thread to a reserved CPU only if it may run on no other. */
static void leave_reserved(const struct rt *r, struct thread *t)
{
	bool others = false;
	unsigned int i;

	for (i = 0; i < RT_CPUS; i++)
		others |= t->cpus[i] && !r->isolated[i];
	for (i = 0; others && i < RT_CPUS; i++)
		t->cpus[i] &= !r->isolated[i];
}

static bool share_cpu(const struct thread *a, const struct thread *b)
{
	for (unsigned int i = 0; i < RT_CPUS; i++)
		if (a->cpus[i] && b->cpus[i])
			return true;
	return false;
}

/* how the cycle gets a priority of 2 or more */
static void set_raise(char *fix, size_t size, const struct thread *cycle)
{
	if (cycle->id > 0)
		attr_path(fix, size,
			  "sched_setscheduler() in the application, or chrt -f -p 80 %d",
			  cycle->id);
	else
		attr_path(fix, size,
			  "a priority of 2 to 98 for ecrt_master_set_cycle(), and the right to it");
}

/* Which of the two loses? */
static void compare(struct rt *r, const struct thread *post, const struct thread *cycle)
{
	char who[128], raise[128];

	if (cycle->id > 0)
		attr_path(who, sizeof(who), "the cycle (%s, thread %d, %s)", cycle->name,
			  cycle->id, cycle->text);
	else
		attr_path(who, sizeof(who), "the cycle (%s, %s)", cycle->name, cycle->text);
	set_raise(raise, sizeof(raise), cycle);
	if (!share_cpu(post, cycle))
		rt_find(r, "posts", RT_OK, NULL, "%s and %s (%s) share no CPU", who, post->name,
			post->text);
	else if (!cycle->priority && post->priority)
		rt_find(r, "posts", RT_WARNING, raise, "%s loses: %s (%s) preempts it", who,
			post->name, post->text);
	else if (!cycle->priority)
		rt_find(r, "posts", RT_WARNING, raise,
			"%s loses: each program may delay it, and %s (%s), too", who, post->name,
			post->text);
	else if (!post->priority)
		rt_find(r, "posts", RT_WARNING, "load ec_master without fifo_posts=N",
			"%s (%s) loses: %s preempts it, and each program may delay it; lost frames are found late",
			post->name, post->text, who);
	else if (cycle->priority <= post->priority)
		rt_find(r, "posts", RT_WARNING, raise,
			"%s (%s) loses if the cycle spins, as neither preempts the other: %s; lost frames are found late",
			post->name, post->text, who);
	else
		rt_find(r, "posts", RT_OK, NULL, "%s preempts %s (%s)", who, post->name,
			post->text);
}

/* No cycle runs: what one would find. */
static void foretell(struct rt *r, const struct thread *post)
{
	if (post->priority)
		rt_find(r, "posts", RT_OK, NULL,
			"no cycle runs; one with SCHED_FIFO %u or more preempts %s (%s)",
			post->priority + 1, post->name, post->text);
	else
		rt_find(r, "posts", RT_WARNING, "load ec_master without fifo_posts=N",
			"no cycle runs; %s (%s) loses to one with SCHED_FIFO, and to any program",
			post->name, post->text);
}

static void check_master(struct rt *r, struct ect_handle *h, unsigned int master)
{
	struct ect_cycle c = { .struct_size = sizeof(c) };
	struct thread post = { 0 }, cycle;
	int err = ect_cycle_read(h, &c);

	attr_path(post.name, sizeof(post.name), "EtherCAT%u-post", master);
	if (err) {
		rt_find(r, "posts", RT_UNKNOWN, NULL, "Master%u: %s", master, strerror(-err));
		return;
	}
	if (!each_number(sys_proc(), is_named, &post)) {
		rt_find(r, "posts", RT_UNKNOWN, "run it as root, outside of a container",
			"there is no thread %s in %s", post.name, sys_proc());
		return;
	}
	leave_reserved(r, &post);
	if (c.kind == ECT_CYCLE_BY_NOBODY || !c.active) {
		foretell(r, &post);
		return;
	}
	find_cycle(&cycle, ect_path(h), &c);
	if (!cycle.id)
		rt_find(r, "posts", RT_UNKNOWN, "run it as root",
			"no process that has %s open for writing can be seen; %s has %s",
			ect_path(h), post.name, post.text);
	else
		compare(r, &post, &cycle);
}

void rt_check_posts(struct rt *r)
{
	struct ect_handle *h = ect_new();
	unsigned int i;
	int err = 0;

	for (i = 0; h && !err; i++) {
		err = ect_open(h, i, 0);
		if (!err)
			check_master(r, h, i);
		else if (err != -ENOENT)
			rt_find(r, "posts", RT_UNKNOWN, NULL, "Master%u: %s", i, strerror(-err));
		ect_close(h);
	}
	r->failed |= !h && fail("out of memory");
	ect_free(h);
}
