/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of libethercat-bus share. */
#ifndef ECB_INTERNAL_H
#define ECB_INTERNAL_H

#include <stddef.h>

#define ECB_API	__attribute__((visibility("default")))

#endif
