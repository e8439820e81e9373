// SPDX-License-Identifier: LGPL-2.1-or-later
/* Mailbox messages as they pass. */
#include <errno.h>

#include "internal.h"
#include "mail_text.h"
#include "sys.h"

#define BATCH	32

_Static_assert(ECT_MAIL_DATA == EC_MAIL_DATA, "bytes of a message");
_Static_assert(ECT_MAIL_TO_SLAVE == EC_MAIL_TO_SLAVE, "flags");
_Static_assert(ECT_MAIL_UNSURE == EC_MAIL_UNSURE, "flags");
_Static_assert(ECT_MAIL_MALFORMED == EC_MAIL_MALFORMED, "flags");

int ect_mail_begin(struct ect_handle *h)
{
	struct ec_ioc_mail arg = { .size = sizeof(struct ec_mail) };

	return ect_command(h, EC_IOC_MAIL, &arg);
}

static void convert_mail(struct ect_mail *to, const struct ec_mail *from)
{
	to->flags = from->flags & (EC_MAIL_TO_SLAVE | EC_MAIL_UNSURE | EC_MAIL_MALFORMED);
	to->number = from->number;
	to->missed = from->missed;
	to->time_ns = from->time_ns;
	to->wall_ns = from->wall_ns;
	to->position = from->position == EC_MAIL_ABSENT ? ECT_NONE32 : from->position;
	to->station = from->station;
	to->size = from->size;
	to->kept = min_t(u32, from->kept, ECT_MAIL_DATA);
	memcpy(to->data, from->data, sizeof(to->data));
	mail_decode(to);
}

int ect_mail_read(struct ect_handle *h, struct ect_list **list)
{
	struct ec_mail m[BATCH];
	struct ect_list *l;
	long n;

	do
		n = ect_sys_read(h->fd, m, sizeof(m));
	while (n < 0 && errno == EINTR);
	if (n < 0)
		return ect_failed(h);
	l = ect_list_new(sizeof(struct ect_mail));
	for (size_t i = 0; l && i < (size_t)n / sizeof(*m); i++) {
		struct ect_mail *to = ect_list_add(l);

		if (!to) {
			ect_list_free(l);
			l = NULL;
			break;
		}
		convert_mail(to, &m[i]);
	}
	*list = l;
	return l ? 0 : ect_no_memory(h);
}
