/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Results on stdout, as text or as JSON from the same call: the key and the
 * value go to JSON, the format and what follows it to text. A NULL key is
 * text only, a NULL format JSON only.
 */
#ifndef EC_TOOL_OUT_H
#define EC_TOOL_OUT_H

#include <stdbool.h>
#include <stdio.h>

#include "../master/wire/env.h"

#define OUT_FMT(n)	__attribute__((format(printf, n, (n) + 1)))

void out_start(bool json);
/* in JSON each object that is opened outside of any other is a line of its own */
void out_start_lines(bool json);
int out_finish(void);
bool out_is_json(void);

void out_object(const char *key);
void out_array(const char *key);
void out_end(void);

void out_text(const char *fmt, ...) OUT_FMT(1);
void out_u(const char *key, u64 v, const char *fmt, ...) OUT_FMT(3);
void out_i(const char *key, s64 v, const char *fmt, ...) OUT_FMT(3);
void out_f(const char *key, double v, const char *fmt, ...) OUT_FMT(3);
void out_bool(const char *key, bool v, const char *fmt, ...) OUT_FMT(3);
void out_str(const char *key, const char *v, const char *fmt, ...) OUT_FMT(3);
void out_null(const char *key, const char *fmt, ...) OUT_FMT(2);
/* bytes: one string of hex digits in JSON, rows of 16 behind @indent in text */
void out_hex(const char *key, const u8 *data, size_t size, const char *indent);
/* unchanged; on a terminal without characters that could control it */
void out_quoted(const char *s);
void out_text_bytes(const u8 *data, size_t size);
bool out_is_line(const u8 *data, size_t size);
void out_utf16(const u8 *data, size_t size);
bool out_to_terminal(void);
/* bytes: hex digits in JSON, unchanged in text; unchanged bytes not to a terminal */
int out_binary_allowed(const char *instead);
void out_binary(const char *key, const u8 *data, size_t size);

void out_json_string(FILE *f, const char *s);

#endif
