// SPDX-License-Identifier: GPL-2.0-only
#include "screen.h"

#include <poll.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#define LINE_MAX_BYTES	512

static volatile sig_atomic_t ended;
static struct termios before;
static bool grabbed;

static void end(int signal)
{
	(void)signal;
	ended = 1;
}

void screen_catch_end(void)
{
	static const int signals[] = { SIGHUP, SIGINT, SIGQUIT, SIGTERM };
	const struct sigaction act = { .sa_handler = end };
	struct sigaction old;

	/* one that is ignored, as by nohup, stays so */
	for (unsigned int i = 0; i < sizeof(signals) / sizeof(*signals); i++)
		if (!sigaction(signals[i], NULL, &old) && old.sa_handler != SIG_IGN)
			sigaction(signals[i], &act, NULL);
}

bool screen_ended(void)
{
	return ended;
}

void screen_forget_interruption(void)
{
	if (ended)
		clearerr(stdout);
}

void screen_wait(double seconds)
{
	struct pollfd p = { .fd = STDOUT_FILENO };

	/* a signal ends it early; so does the end of the program that reads the output */
	if (poll(&p, 1, (int)(seconds * 1000)) > 0)
		ended = 1;
}

/* 80 columns and 24 lines if it does not say */
void screen_size(unsigned int *lines, unsigned int *columns)
{
	struct winsize w = { 0 };

	if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &w) || w.ws_row < 4 || w.ws_col < 40) {
		w.ws_row = 24;
		w.ws_col = 80;
	}
	*lines = w.ws_row;
	*columns = w.ws_col;
}

void screen_begin(void)
{
	fputs("\033[H", stdout);
}

void screen_line(unsigned int columns, const char *fmt, ...)
{
	char text[LINE_MAX_BYTES];
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(text, sizeof(text), fmt, ap);
	va_end(ap);
	/* the last column of some terminals begins a new line */
	if (columns - 1 < sizeof(text))
		text[columns - 1] = 0;
	printf("%s\033[K\n", text);
}

void screen_end(void)
{
	fputs("\033[J", stdout);
	fflush(stdout);
}

void screen_grab(void)
{
	struct termios t;

	if (!isatty(STDIN_FILENO) || tcgetattr(STDIN_FILENO, &before))
		return;
	t = before;
	t.c_lflag &= ~(tcflag_t)(ICANON | ECHO);
	/* a program that is stopped does not give the terminal back */
	t.c_cc[VSUSP] = _POSIX_VDISABLE;
	grabbed = !tcsetattr(STDIN_FILENO, TCSANOW, &t);
}

void screen_release(void)
{
	if (grabbed)
		tcsetattr(STDIN_FILENO, TCSANOW, &before);
	grabbed = false;
}

int screen_key(double seconds)
{
	struct pollfd p = { .fd = STDIN_FILENO, .events = POLLIN };
	char c;

	if (!grabbed) {
		screen_wait(seconds);
		return 0;
	}
	if (poll(&p, 1, (int)(seconds * 1000)) <= 0 || read(STDIN_FILENO, &c, 1) != 1)
		return 0;
	return c;
}
