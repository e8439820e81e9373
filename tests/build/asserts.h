/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Included first in each file of modules built for a kernel without lockdep: there lockdep_assert()
 * is empty, so that a name that no longer exists would stay in one until a kernel with lockdep.
 */
#ifndef EC_BUILD_ASSERTS_H
#define EC_BUILD_ASSERTS_H

#include <linux/lockdep.h>

#ifndef CONFIG_LOCKDEP
#undef lockdep_assert
#define lockdep_assert(c) ((void)sizeof((c) ? 1 : 0))
#endif

#endif
