/* SPDX-License-Identifier: GPL-2.0-only */
/* Memory for the model that is counted, limited, and sometimes refused. */
#ifndef EC_FUZZ_SIM_H
#define EC_FUZZ_SIM_H

#include "fuzz.h"
#include "../../devices/sim/describe.h"

#define FUZZ_MEM_MAX	(4u << 20)	/* a segment of 65535 slaves is not built here */

static unsigned int fuzz_blocks;	/* allocated and not freed */
static size_t fuzz_bytes;
static int fuzz_fail_at;		/* this many allocations succeed; -1: all */

static void *fuzz_alloc(size_t bytes)
{
	void *p;

	if (!fuzz_fail_at || fuzz_bytes + bytes > FUZZ_MEM_MAX)
		return NULL;
	if (fuzz_fail_at > 0)
		fuzz_fail_at--;
	p = calloc(1, bytes);
	if (!p)
		exit(2);
	fuzz_bytes += bytes;
	fuzz_blocks++;
	return p;
}

static void fuzz_free(void *p)
{
	fuzz_blocks -= !!p;
	free(p);
}

static const struct ec_sim_ops fuzz_ops = { fuzz_alloc, fuzz_free };

/* @text describes a segment, or says why not; NULL then */
static struct ec_sim *fuzz_describe(const char *text, size_t len,
				    const struct ec_sim_loader *loader, int fail_at)
{
	struct ec_sim_error err = { .line = 12345 };
	struct ec_sim *sim = NULL;
	unsigned int lines = 1;
	size_t i;
	int ret;

	fuzz_blocks = 0;
	fuzz_bytes = 0;
	fuzz_fail_at = fail_at;
	ret = ec_sim_describe(&sim, &fuzz_ops, text, len, loader, &err);
	fuzz_fail_at = -1;
	if (!ret) {
		MUST(sim);
		return sim;
	}
	for (i = 0; i < len; i++)
		lines += text[i] == '\n';
	MUST(ret == -EINVAL || ret == -ENOMEM || ret == -ENOENT);
	MUST(err.line <= lines);
	MUST(memchr(err.text, 0, sizeof(err.text)) && err.text[0]);
	MUST(!fuzz_blocks);
	return NULL;
}

static void fuzz_release(struct ec_sim *sim)
{
	ec_sim_free(sim);
	MUST(!fuzz_blocks);
}

#endif
