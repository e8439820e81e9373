/* SPDX-License-Identifier: GPL-2.0-only */
/* Names by which users choose a device: MAC address, interface, PCI address, sim0. */
#ifndef EC_SPEC_H
#define EC_SPEC_H

#include <linux/types.h>

bool ec_spec_is_valid(const char *spec);
bool ec_spec_is_any(const char *spec);
bool ec_spec_same(const char *a, const char *b);
bool ec_spec_matches(const char *spec, const char *name, const u8 *mac);

#endif
