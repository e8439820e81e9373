/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_DEVICE_USE_H
#define EC_TOOL_DEVICE_USE_H

struct tool;

/* the master of -m gets the card @name; prints its error and returns 0 or 1 */
int device_use(const struct tool *t, const char *name);

#endif
