/* SPDX-License-Identifier: GPL-2.0-only */
/* Tests of a layer of master/ in a module that has no higher layer; see run.sh. */
#ifndef EC_ALONE_H
#define EC_ALONE_H

#include <linux/types.h>
#include "master/base/base.h"

/**
 * struct alone_test - one test
 * @name: what holds
 * @run: calls the layer, with ops NULL
 */
struct alone_test {
	const char *name;
	void (*run)(void);
};

#define TEST(fn)	{ #fn, fn }

/* of each layer, the last one without name */
extern const struct alone_test alone_tests[];

void alone_failed(const char *file, int line, const char *what, s64 a, s64 b);
bool alone_wait(bool (*there)(void *ctx), void *ctx, unsigned int ms);

#define CHECK_OP(a, op, b) \
	({ \
		s64 a_ = (s64)(a), b_ = (s64)(b); \
		bool ok_ = a_ op b_; \
		\
		if (!ok_) \
			alone_failed(__FILE__, __LINE__, #a " " #op " " #b, a_, b_); \
		ok_; \
	})
#define CHECK_EQ(a, b)	CHECK_OP(a, ==, b)
#define CHECK(x)	CHECK_OP(!!(x), ==, true)

#endif
