// SPDX-License-Identifier: GPL-2.0-only
/*
 * Linked into the unit tests with --wrap=ec_sim_new: every segment they build
 * has the deliberate bug named by the environment, so neither the model nor
 * the tests have to know of it.
 *
 *   EC_SIM_BUG=name prog GLOB	run tests against a wrong model
 *   EC_SIM_BUG=list prog	print the names of all bugs
 */
#include "../../devices/sim/sim.h"
#include <stdio.h>
#include <stdlib.h>

static enum ec_sim_bug bug;

static __attribute__((constructor)) void choose(void)
{
	const char *name = getenv("EC_SIM_BUG");
	int i;

	if (!name)
		return;
	for (i = EC_SIM_BUG_NONE; i < EC_SIM_BUGS; i++) {
		if (!strcmp(name, "list"))
			puts(ec_sim_bug_name(i));
		else if (!strcmp(name, ec_sim_bug_name(i)))
			break;
	}
	if (i == EC_SIM_BUGS) {
		if (strcmp(name, "list"))
			fprintf(stderr, "no bug \"%s\"; EC_SIM_BUG=list shows all\n", name);
		exit(strcmp(name, "list") ? 2 : 0);
	}
	bug = i;
}

struct ec_sim *__real_ec_sim_new(const struct ec_sim_ops *ops, u32 max_slaves,
				 u64 seed);
struct ec_sim *__wrap_ec_sim_new(const struct ec_sim_ops *ops, u32 max_slaves,
				 u64 seed);

struct ec_sim *__wrap_ec_sim_new(const struct ec_sim_ops *ops, u32 max_slaves,
				 u64 seed)
{
	struct ec_sim *sim = __real_ec_sim_new(ops, max_slaves, seed);

	if (sim)
		ec_sim_set_bug(sim, bug);
	return sim;
}
