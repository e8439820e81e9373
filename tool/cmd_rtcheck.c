// SPDX-License-Identifier: GPL-2.0-only
#include <stdlib.h>

#include "out.h"
#include "rt.h"
#include "tool.h"

static const char *const levels[] = { "ok", "warning", "error", "unknown" };

static void show(const struct rt_finding *f)
{
	out_object(NULL);
	out_str("level", levels[f->level], "%-8s  ", levels[f->level]);
	out_str("check", f->check, "%-12s  ", f->check);
	out_str("found", f->found, "%s\n", f->found);
	if (*f->fix)
		out_str("fix", f->fix, "          set: %s\n", f->fix);
	else
		out_str("fix", "", NULL);
	out_end();
}

static int run(struct tool *t, int argc, char **argv)
{
	unsigned int count[RT_UNKNOWN + 1] = { 0 };
	struct rt r = { 0 };
	int ret;

	(void)t, (void)argc, (void)argv;
	rt_check_kernel(&r);
	rt_check_cpus(&r);
	rt_check_interrupts(&r);
	rt_check_user(&r);
	ret = rt_check_cards(&r);
	rt_check_posts(&r);
	if (r.failed)
		ret = fail("out of memory");
	out_array("checks");
	for (size_t i = 0; !ret && i < r.n; i++) {
		count[r.v[i].level]++;
		show(&r.v[i]);
	}
	out_end();
	if (!ret) {
		out_u("errors", count[RT_ERROR], "%u error(s), ", count[RT_ERROR]);
		out_u("warnings", count[RT_WARNING], "%u warning(s), ", count[RT_WARNING]);
		out_u("unknown", count[RT_UNKNOWN], "%u not known\n", count[RT_UNKNOWN]);
	}
	free(r.v);
	return ret || count[RT_ERROR];
}

const struct cmd cmd_rtcheck = {
	.name = "rtcheck",
	.run = run,
	.args = "",
	.opts = "",
	.summary = "Check the settings of this computer for real time",
	.help = "Checks kernel, CPUs, interrupts, the rights of the user, and the network cards of the\n"
		"masters. Each line has a level: an error delays cycles, a warning may delay them, and\n"
		"what cannot be read is unknown. The line below it says how to change the setting.\n"
		"Changes nothing. Exit code 1 if there is an error.\n"
		"The line \"posts\" says which one loses where they share a CPU: the cycle, or the\n"
		"thread EtherCAT<n>-post, which finds lost acyclic frames. The cycle of an application\n"
		"is its thread with the highest priority; to see that of another user it needs root.\n",
	.json = "checks[]: level (ok, warning, error, unknown), check, found, fix; errors, warnings,\n"
		"unknown",
};
