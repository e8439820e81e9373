// SPDX-License-Identifier: GPL-2.0-only
/* Copies of process values of every length: right bytes, and none beside them. */
#include <kunit/test.h>
#include "master/base/bytes.h"

#define LONGEST	40
#define GAP	3	/* bytes between two values, which nothing may change */

struct bytes {
	u8 from[3 * (LONGEST + 2)];
	u8 to[3 * (LONGEST + GAP) + GAP];
};

/* Three values are copied; each of their bytes differs from its neighbours. */
static void bytes_all_lengths_exact(struct kunit *test)
{
	struct bytes *b = kunit_kzalloc(test, sizeof(*b), GFP_KERNEL);
	unsigned int len, count, i, at, wrong;

	KUNIT_ASSERT_NOT_NULL(test, b);
	for (i = 0; i < sizeof(b->from); i++)
		b->from[i] = 1 + i;
	for (len = 0; len <= LONGEST; len++) {
		for (count = 0; count <= 3; count++) {
			memset(b->to, 0xee, sizeof(b->to));
			ec_bytes_run(b->to + GAP, len + GAP, b->from, len + 2, len, count);
			for (i = 0, wrong = 0; i < sizeof(b->to); i++) {
				at = i % (len + GAP);
				if (i / (len + GAP) < count && at >= GAP)
					wrong += b->to[i] !=
						 b->from[i / (len + GAP) * (len + 2) + at - GAP];
				else
					wrong += b->to[i] != 0xee;
			}
			KUNIT_EXPECT_EQ_MSG(test, wrong, 0u, "%u values of %u bytes", count, len);
		}
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(bytes_all_lengths_exact),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_bytes",
	.test_cases = cases,
};
kunit_test_suite(suite);
