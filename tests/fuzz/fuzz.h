/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * What a fuzz target provides: LLVMFuzzerTestOneInput() as libFuzzer wants it,
 * and seeds for our own driver (driver.c), which needs no clang.
 */
#ifndef EC_FUZZ_H
#define EC_FUZZ_H

#include "../../master/wire/env.h"
#include <stdio.h>
#include <stdlib.h>

struct fuzz_seed {
	const void *data;
	size_t len;
};

/* ends with .data == NULL */
extern const struct fuzz_seed fuzz_seeds[];

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len);

#define SEED(bytes)	{ bytes, sizeof(bytes) - 1 }

/* A property that must hold for every input. */
#define MUST(cond)							\
	do {								\
		if (!(cond)) {						\
			fprintf(stderr, "%s:%d: violated: %s\n",	\
				__FILE__, __LINE__, #cond);		\
			abort();					\
		}							\
	} while (0)

#endif
