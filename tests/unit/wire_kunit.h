/* SPDX-License-Identifier: GPL-2.0-only */
/* What tests of master/wire/ include: its types first, then KUnit. */
#ifndef WIRE_KUNIT_H
#define WIRE_KUNIT_H

#include "../../master/wire/env.h"
#ifndef __KERNEL__
#define EC_KUNIT_NO_TYPES
#endif
#include "ec_kunit.h"

#endif
