/* SPDX-License-Identifier: GPL-2.0-only */
/* A bridge of Linux. */
#ifndef TOOL_BRIDGE_H
#define TOOL_BRIDGE_H

/* 0, or 1 after printing why not; both set the device up */
int bridge_make(const char *name);
int bridge_add(const char *name, const char *port);

#endif
