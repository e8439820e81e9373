/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What a mailbox message does, in words. */
#ifndef EC_LIB_TOOLS_MAIL_TEXT_H
#define EC_LIB_TOOLS_MAIL_TEXT_H

#include "internal.h"
#include "../../master/wire/mbox.h"

/**
 * struct mail_in - the content of a message
 * @r: cursor behind the mailbox header, over what was kept
 * @len: bytes behind the mailbox header, by that header
 */
struct mail_in {
	struct ec_rbuf r;
	size_t len;
};

/* appends to a text of @size bytes */
void mail_add(char *to, size_t size, const char *fmt, ...) __attribute__((format(printf, 3, 4)));
#define MAIL_SERVICE(m, ...)	mail_add((m)->service, sizeof((m)->service), __VA_ARGS__)
#define MAIL_OBJECT(m, ...)	mail_add((m)->object, sizeof((m)->object), __VA_ARGS__)
#define MAIL_RESULT(m, ...)	mail_add((m)->result, sizeof((m)->result), __VA_ARGS__)

void mail_name(struct ect_mail *m, const char *const *names, size_t n, unsigned int number);
void mail_bytes(struct ect_mail *m, const u8 *p, size_t n);

/* mail_coe.c */
void mail_coe(struct ect_mail *m, struct mail_in *in);
/* mail_text.c; sets all members behind @kept, and ECT_MAIL_* that follow from the content */
void mail_decode(struct ect_mail *m);

#endif
