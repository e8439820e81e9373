// SPDX-License-Identifier: GPL-2.0-only
/* Run the bus without an application. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "out.h"
#include "run.h"

#define WAIT_S		30.0

/**
 * struct plan - what each slave of the bus will do
 * @all: slaves
 * @names: struct ect_name, in the same order
 * @kinds: ECT_KIND_* of each
 * @takes: whether it runs
 * @n: how many do
 */
struct plan {
	struct slaves all;
	struct ect_list *names;
	unsigned int *kinds;
	bool *takes;
	size_t n;
};

static const char *const kind_key[] = { "io", "drive", "safety", "unknown" };

static const char *name_of(const struct plan *p, size_t i)
{
	const struct ect_name *n = ect_list_get(p->names, i);

	return n->name;
}

/* Is @name one of those that --include names, apart by commas? */
static bool included(const char *list, const char *name)
{
	size_t len = strlen(name);

	for (const char *at = list; at && *at; at += *at == ',') {
		size_t n = strcspn(at, ",");

		if (n == len && !memcmp(at, name, len))
			return true;
		at += n;
	}
	return false;
}

static int check_included(const struct dev *d, const struct plan *p, const char *list)
{
	char one[ECT_WORD];

	for (const char *at = list; at && *at; at += *at == ',') {
		size_t n = strcspn(at, ","), i = 0;

		snprintf(one, sizeof(one), "%.*s", (int)n, at);
		while (i < p->all.n && strcmp(one, name_of(p, i)))
			i++;
		if (i == p->all.n)
			return fail("Master%u has no slave %s; 'ethercat run --dry-run' shows their names",
				    d->master, one);
		at += n;
	}
	return 0;
}

static void plan_free(struct plan *p)
{
	slaves_free(&p->all);
	ect_list_free(p->names);
	free(p->kinds);
	free(p->takes);
}

static int make_plan(struct dev *d, const struct tool *t, struct plan *p)
{
	int err;

	*p = (struct plan){ 0 };
	if (dev_slaves(d, &p->all))
		return 1;
	if (!p->all.n)
		return dev_none_present(d);
	err = ect_names_read(d->h, &p->names);
	if (err)
		return dev_fail(d, err, "Master%u: cannot read the names", d->master);
	if (ect_list_count(p->names) != p->all.n)
		return fail("Master%u: slaves have changed; repeat the command", d->master);
	p->kinds = calloc(p->all.n, sizeof(*p->kinds));
	p->takes = calloc(p->all.n, sizeof(*p->takes));
	if (!p->kinds || !p->takes)
		return fail("out of memory");
	if (check_included(d, p, t->include))
		return 1;
	for (size_t i = 0; i < p->all.n; i++) {
		err = ect_kind_read(d->h, &p->all.v[i], &p->kinds[i]);
		if (err)
			return dev_fail(d, err, "Master%u: cannot read what %s is", d->master,
					name_of(p, i));
		p->takes[i] = p->kinds[i] == ECT_KIND_IO || included(t->include, name_of(p, i));
		p->n += p->takes[i];
	}
	return 0;
}

static const char *why_left_out(unsigned int kind)
{
	switch (kind) {
	case ECT_KIND_DRIVE:
		return "a drive";
	case ECT_KIND_SAFETY:
		return "a safety device";
	default:
		return "it does not say what it is";
	}
}

static void show_plan(const struct plan *p, bool dry)
{
	out_array("slaves");
	for (size_t i = 0; i < p->all.n; i++) {
		out_object(NULL);
		out_u("position", p->all.v[i].position, NULL);
		out_str("name", name_of(p, i), NULL);
		out_str("kind", kind_key[p->kinds[i]], NULL);
		out_bool("runs", p->takes[i], NULL);
		out_end();
		if (p->takes[i] && dry)
			out_text("  %u  %s: to OP\n", p->all.v[i].position, name_of(p, i));
		else if (!p->takes[i])
			out_text("  %u  %s: omitted, %s; add it with --include %s\n",
				 p->all.v[i].position, name_of(p, i), why_left_out(p->kinds[i]),
				 name_of(p, i));
	}
	out_end();
}

static int in_op(struct dev *d, size_t configs, size_t *n)
{
	*n = 0;
	for (unsigned int i = 0; i < configs; i++) {
		struct ect_config c = { .struct_size = sizeof(c) };
		int err = ect_config_read(d->h, i, &c);

		if (err)
			return dev_fail(d, err, "Master%u: cannot read a configuration",
					d->master);
		/* a hot connect group may be absent */
		*n += c.in_op || (c.group && !c.group_mandatory && c.slave_position < 0);
	}
	return 0;
}

/* Configurations without a slave in OP, on stderr */
static void name_others(struct dev *d, size_t configs)
{
	for (unsigned int i = 0; i < configs; i++) {
		struct ect_config_why w = { .struct_size = sizeof(w) };

		if (!ect_config_why(d->h, i, &w) && w.text[0])
			note("configuration %u: %s", i, w.text);
	}
}

int run_wait_op(struct dev *d, const struct tool *t, size_t configs, size_t *n)
{
	double end = now_s() + (t->wait_s >= 0 ? t->wait_s : WAIT_S);

	for (;;) {
		if (in_op(d, configs, n))
			return 1;
		if (*n == configs)
			return 0;
		if (now_s() >= end)
			break;
		sleep_ms(20);
	}
	name_others(d, configs);
	if (t->force)
		return 0;
	return fail("Master%u: %zu of %zu slave(s) not in OP, so the bus does not run; 'ethercat why' says more, --force runs the others",
		    d->master, configs - *n, configs);
}

static void show_cycle(struct dev *d)
{
	struct ect_cycle c = { .struct_size = sizeof(c) };

	if (ect_cycle_read(d->h, &c))
		return;
	out_u("period_ns", c.interval_ns, ", cycle %g ms, ", c.interval_ns / 1e6);
	out_u("priority", c.priority, NULL);
	if (c.priority)
		out_text("SCHED_FIFO %u\n", c.priority);
	else
		out_text("SCHED_OTHER: no right to real-time priority (RLIMIT_RTPRIO), frames may be late\n");
}

void run_show(struct dev *d, size_t n)
{
	out_u("in_op", n, "Master%u runs: %zu slave(s) in OP", d->master, n);
	show_cycle(d);
	out_text("Outputs are zero. 'ethercat watch' shows values, 'ethercat set' sets outputs, 'ethercat stop' ends it.\n");
}

static int start(struct dev *d, const struct tool *t, struct plan *p)
{
	struct ect_run how = {
		.struct_size = sizeof(how), .cpu = -1,
		.period_ns = t->period_us ? 1000 * t->period_us : RUN_PERIOD_NS,
	};
	size_t n;
	int err = 0;

	for (size_t i = 0; i < p->all.n && !err; i++) {
		if (!p->takes[i])
			continue;
		err = ect_run_add(d->h, &p->all.v[i]);
		if (err)
			return dev_fail(d, err, "Master%u: cannot configure %s", d->master,
					name_of(p, i));
	}
	err = ect_run_start(d->h, &how);
	if (err)
		return dev_fail(d, err, "Master%u: cannot start the cycle", d->master);
	if (run_wait_op(d, t, p->n, &n))
		return 1;
	run_show(d, n);
	return 0;
}

int run_finish_output(void)
{
	int err = out_finish();

	return err ? fail("cannot write the output (%s); the bus does not run", strerror(-err)) : 0;
}

/* The last step: when the process ends before it, the session ends as well. */
static int leave(struct dev *d)
{
	int err = run_finish_output();

	if (err)
		return err;
	err = ect_run_leave(d->h);
	if (err)
		return dev_fail(d, err,
				"Master%u: cannot leave the cycle to the master; the bus does not run",
				d->master);
	return 0;
}

static int run_master(const struct tool *t, struct dev *d)
{
	struct plan p = { 0 };
	int err = t->dry_run ? 0 : ect_run_reserve(d->h), ret;

	if (err)
		return dev_fail(d, err, "Master%u: cannot run the bus", d->master);
	out_object(NULL);
	out_u("master", d->master, NULL);
	out_bool("dry_run", t->dry_run, NULL);
	ret = make_plan(d, t, &p);
	if (!ret && t->dry_run)
		out_text("Master%u: %zu of %zu slave(s) would go to OP with the PDOs that they have now, outputs zero, cycle %g ms:\n",
			 d->master, p.n, p.all.n,
			 (t->period_us ? t->period_us : RUN_PERIOD_NS / 1000) / 1e3);
	if (!ret)
		show_plan(&p, t->dry_run);
	if (!ret && !p.n)
		ret = fail("Master%u: no slave would run; name those that are to run with --include",
			   d->master);
	if (!ret && !t->dry_run)
		ret = start(d, t, &p);
	out_end();
	plan_free(&p);
	return ret || t->dry_run ? ret : leave(d);
}

static int run(struct tool *t, int argc, char **argv)
{
	struct dev d;
	int ret;

	if (argc && t->include)
		return usage_error("FILE and --include exclude each other: the file names what runs");
	if (argc)
		return run_file(t, argv[0]);
	if (dev_open_single(&d, t, true))
		return 1;
	ret = run_master(t, &d);
	/* without ect_run_leave() the session ends here, and with the process */
	dev_close(&d);
	return ret;
}

const struct cmd cmd_run = {
	.name = "run",
	.run = run,
	.args = "[<FILE>]",
	.opts = "mDfGPw",
	.summary = "Run the bus without an application",
	.help = "All slaves go to OP with the PDOs that they have now, and the kernel exchanges their\n"
		"process data: each millisecond, or in the time of --period. Outputs are zero until\n"
		"'ethercat set' sets them. The command returns when all slaves are in OP, and the cycle\n"
		"continues, without any process, until 'ethercat stop' or until the module is removed.\n"
		"If the command is ended before, or a slave is not in OP after 30 s (--wait), all is\n"
		"as before; --force lets the others run nevertheless. No application gets the master\n"
		"meanwhile.\n"
		"\n"
		"Drives and safety devices are omitted unless --include names them: what moves must\n"
		"not do so by surprise. A drive has profile 402 in object 0x1000 or of a module\n"
		"(0xF010), or SoE; a safety device has an FSoE address (0xF980:01), or PDOs or a name\n"
		"with FSoE or Safety. Nothing of this is certain: use --dry-run first. Clocks of slaves\n"
		"are not synchronized, and no startup commands are written.\n"
		"\n"
		"With a bus file ('ethercat bus save') all slaves of the file run, as it says: PDOs,\n"
		"startup commands, time limits, clocks, sync units, hot connect groups, cycle. Other\n"
		"slaves are omitted and named. A file with one master is for that master, otherwise -m\n"
		"chooses one. When slaves differ from the file nothing runs, and each difference is\n"
		"named; with --force the other slaves run. A file that the group or others may write, or\n"
		"that belongs to another user, is refused.\n"
		"\n"
		"With the right to it (CAP_SYS_NICE or RLIMIT_RTPRIO) the cycle has SCHED_FIFO 50,\n"
		"otherwise SCHED_OTHER, which the command reports.\n",
	.json = "master, dry_run, slaves[]: position, name, kind (io, drive, safety, unknown), runs;\n"
		"with FILE: file, differences[] as in 'bus check', slaves[]: name, runs;\n"
		"without --dry-run: in_op (slaves), period_ns, priority (0: SCHED_OTHER)",
	.flags = CMD_ONE_MASTER,
	.max_args = 1,
};
