/* SPDX-License-Identifier: GPL-2.0-only */
/* Text of slaves in files for other programs: valid UTF-8 without controls. */
#ifndef EC_TOOL_ESCAPE_H
#define EC_TOOL_ESCAPE_H

#include <stdio.h>

void escape_html(FILE *f, const char *s);
void escape_label(FILE *f, const char *s);

#endif
