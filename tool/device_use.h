/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_DEVICE_USE_H
#define EC_TOOL_DEVICE_USE_H

struct tool;

/*
 * The master of -m gets the card @name, with --backup at the other end of its ring ("none": none).
 * Prints its error and returns 0 or 1.
 */
int device_use(const struct tool *t, const char *name);

#endif
