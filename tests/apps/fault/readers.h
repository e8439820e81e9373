/* SPDX-License-Identifier: GPL-2.0-only */
/* The application that readers look at: readers_app.c. */
#ifndef READERS_H
#define READERS_H

#define APP_CONFIGS	500	/* all but the first without slave */
#define APP_SDOS	1000	/* of the second one */
#define SOME_BYTES	65536	/* of data that a reader wants at once */

int updates(unsigned int count);
int cycles(unsigned int count, int by_kernel);

#endif
