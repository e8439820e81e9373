// SPDX-License-Identifier: GPL-2.0-only
/*
 * Opens the files that it is given again and again, and keeps each open for some rounds before it
 * reads and closes it. Writes a letter for each file that it could open: "a" for the first one,
 * "b" for the second one... With SIGUSR1 it closes all and pauses until the next one.
 *
 * usage: opener FILE...
 */
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#define KEPT	8	/* rounds */
#define FILES	8

static int fd[KEPT][FILES];
static volatile sig_atomic_t pausing;

static void toggle(int number)
{
	(void)number;
	pausing = !pausing;
}

static void end(int *f)
{
	char byte[64];

	/* whatever it answers */
	if (*f >= 0 && read(*f, byte, sizeof(byte)) < 0)
		(void)lseek(*f, 0, SEEK_SET);
	if (*f >= 0)
		close(*f);
	*f = -1;
}

static void end_all(void)
{
	int i, k;

	for (k = 0; k < KEPT; k++)
		for (i = 0; i < FILES; i++)
			end(&fd[k][i]);
}

int main(int argc, char **argv)
{
	const struct timespec round = { .tv_nsec = 500000 };
	int i, k;

	if (argc < 2 || argc > FILES + 1) {
		fprintf(stderr, "usage: opener FILE...\n");
		return 2;
	}
	for (k = 0; k < KEPT; k++)
		for (i = 0; i < FILES; i++)
			fd[k][i] = -1;
	signal(SIGUSR1, toggle);
	for (k = 0;; k = (k + 1) % KEPT) {
		if (pausing)
			end_all();
		for (i = 0; i < argc - 1 && !pausing; i++) {
			end(&fd[k][i]);
			fd[k][i] = open(argv[i + 1], O_RDONLY | O_NONBLOCK | O_CLOEXEC);
			if (fd[k][i] >= 0 && write(STDOUT_FILENO, &"abcdefgh"[i], 1) != 1)
				return 1;
		}
		nanosleep(&round, NULL);
	}
}
