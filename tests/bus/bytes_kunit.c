// SPDX-License-Identifier: GPL-2.0-only
/* Copies of process values of every length: right bytes, and none beside them. */
#include <kunit/test.h>
#include "master/base/bytes.h"

#define LONGEST	40
#define GAP	3	/* bytes between two values, which nothing may change */

struct bytes {
	u8 from[3 * (LONGEST + GAP)];
	u8 to[3 * (LONGEST + GAP) + GAP];
};

/* Up to three values are copied; each of their bytes differs from its neighbours. */
static void exact(struct kunit *test, unsigned int from_gap)
{
	struct bytes *b = kunit_kzalloc(test, sizeof(*b), GFP_KERNEL);
	unsigned int len, count, i, at, wrong;

	KUNIT_ASSERT_NOT_NULL(test, b);
	for (i = 0; i < sizeof(b->from); i++)
		b->from[i] = 1 + i;
	for (len = 0; len <= LONGEST; len++) {
		for (count = 0; count <= 3; count++) {
			memset(b->to, 0xee, sizeof(b->to));
			ec_bytes_run(b->to + GAP, len + GAP, b->from, len + from_gap, len,
				     count);
			for (i = 0, wrong = 0; i < sizeof(b->to); i++) {
				at = i % (len + GAP);
				if (i / (len + GAP) < count && at >= GAP)
					wrong += b->to[i] !=
						 b->from[i / (len + GAP) * (len + from_gap) +
							     at - GAP];
				else
					wrong += b->to[i] != 0xee;
			}
			KUNIT_EXPECT_EQ_MSG(test, wrong, 0u, "%u values of %u bytes", count, len);
		}
	}
}

static void bytes_all_lengths_exact(struct kunit *test)
{
	exact(test, GAP - 1);
}

/* as in an image that is as its datagrams */
static void bytes_at_same_distances_exact(struct kunit *test)
{
	exact(test, GAP);
}

/* a single value may have no distance to the next */
static void bytes_single_without_distance(struct kunit *test)
{
	static const u8 from[] = "0123456789012345678901234567890123456789";
	unsigned int len;
	u8 to[LONGEST];

	for (len = 1; len <= LONGEST; len++) {
		memset(to, 0xee, sizeof(to));
		ec_bytes_run(to, 0, from, 0, len, 1);
		KUNIT_EXPECT_EQ(test, memcmp(to, from, len), 0);
		KUNIT_EXPECT_NULL(test, memchr_inv(to + len, 0xee, LONGEST - len));
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(bytes_all_lengths_exact),
	KUNIT_CASE(bytes_at_same_distances_exact),
	KUNIT_CASE(bytes_single_without_distance),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_bytes",
	.test_cases = cases,
};
kunit_test_suite(suite);
