/* SPDX-License-Identifier: GPL-2.0-only */
/* A terminal that is drawn again and again, without flicker and without a library. */
#ifndef EC_TOOL_SCREEN_H
#define EC_TOOL_SCREEN_H

#include <stdbool.h>

void screen_size(unsigned int *lines, unsigned int *columns);
/* the cursor goes to the top, lines replace the old ones, and the rest is cleared */
void screen_begin(void);
void screen_line(unsigned int columns, const char *fmt, ...)
	__attribute__((format(printf, 2, 3)));
void screen_end(void);

/* from now on SIGINT and SIGTERM only end screen_wait() */
void screen_catch_end(void);
bool screen_ended(void);
void screen_wait(double seconds);
/* what it has interrupted may have been a write, which is no fault of the output */
void screen_forget_interruption(void);

/* keys come one by one; until screen_release() */
void screen_grab(void);
void screen_release(void);
/* a key within @seconds, or 0 */
int screen_key(double seconds);

#endif
