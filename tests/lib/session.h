/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of this test share. */
#ifndef TEST_SESSION_H
#define TEST_SESSION_H

#include <stdio.h>

#include "../fake/app_side.h"

extern int failures;

#define CHECK(c) \
	do { \
		if (!(c)) { \
			printf("%s:%d: %s\n", __FILE__, __LINE__, #c); \
			failures++; \
		} \
	} while (0)

ec_master_t *start(void);
void requests(void);
void idns_and_vendor_messages(void);
void dictionary(void);
void files(void);
void eoe(void);
void events(void);
void extensions(void);
void rules(void);

#endif
