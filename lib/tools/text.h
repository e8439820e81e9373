/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Text of unknown origin: names in EEPROMs, strings of slaves. */
#ifndef EC_LIB_TOOLS_TEXT_H
#define EC_LIB_TOOLS_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

int utf8_len(const unsigned char *p, size_t size);
bool text_harmless(const unsigned char *p, int n);
void text_clean(char *s, size_t size);
void string_clean(char *s, size_t size);
size_t text_typos(const char *a, const char *b);
const char *text_nearer(const char *word, const char *nearest, const char *name);
const char *text_duration(uint64_t ns, char *buf, size_t size);
struct ect_behind;
const char *text_behind(const struct ect_behind *b, char *buf, size_t size);

#endif
