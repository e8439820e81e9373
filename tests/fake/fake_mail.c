// SPDX-License-Identifier: GPL-2.0-only
/*
 * Mailbox messages of the fake master. FAKE_MAIL=gap: some are lost while they are read, =denied:
 * the user has no CAP_NET_RAW, =old: the module has no such command.
 */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "fake.h"

#define WALL	1764000000000000000ULL
#define STATION	0x03e9	/* of slave 0 */

/* @us: time, @s: ring position, content with the mailbox header */
struct fake_mail {
	unsigned int us;
	__u16 slave;
	__u32 flags;
	__u16 size;	/* 0: that of @bytes */
	__u16 n;
	const char *bytes;
};

#define TO	EC_MAIL_TO_SLAVE
#define MAIL(us, s, f, bytes)		{ us, s, f, 0, sizeof(bytes) - 1, bytes }
#define LONG(us, s, f, size, bytes)	{ us, s, f, size, sizeof(bytes) - 1, bytes }

static const struct fake_mail all[] = {
	MAIL(0, 2, TO, "\x0a\0\0\0\0\x13" "\0\x20\x40\x18\x10\4\0\0\0\0"),
	MAIL(812, 2, 0, "\x0a\0\0\0\0\x13" "\0\x30\x43\x18\x10\4\xef\xbe\xad\xde"),
	MAIL(1000, 2, TO, "\x0a\0\0\0\0\x23" "\0\x20\x21\x00\x80\1\x40\0\0\0"),
	MAIL(1500, 2, 0, "\x0a\0\0\0\0\x23" "\0\x30\x80\x00\x80\1\0\0\2\6"),
	MAIL(1600, 1, 0, "\x0a\0\0\0\0\x13" "\0\x10\x10\x32\4\1\2\3\4\5"),
	MAIL(1700, 2, TO, "\x0a\0\0\0\0\x33" "\0\x20\x60\x00\0\0\0\0\0\0"),
	MAIL(1800, 2, 0, "\x0d\0\0\0\0\x33" "\0\x30\x01" "abcdefghij"),
	MAIL(1900, 2, TO, "\x08\0\0\0\0\x43" "\0\x80\1\0\0\0\2\0"),
	LONG(2900, 2, 0, 300, "\x26\1\0\0\0\x43" "\0\x80\x82\0\3\0\2\0\0\x10"),
	MAIL(3000, 2, TO, "\x0c\0\0\0\0\x54" "\2\0\x34\x12\0\0fw.bin"),
	MAIL(3100, 2, 0, "\6\0\0\0\0\x54" "\4\0\0\0\0\0"),
	MAIL(3200, 2, TO | EC_MAIL_UNSURE, "\x0a\0\0\0\0\x64" "\3\0\1\0\0\0data"),
	MAIL(3300, 2, 0, "\x0d\0\0\0\0\x64" "\5\0\3\x80\0\0fu\x1b[2Jl"),
	MAIL(4000, 2, TO, "\4\0\0\0\0\x75" "\1\x40\x0f\0"),
	MAIL(4400, 2, 0, "\6\0\0\0\0\x75" "\x12\x40\x0f\0\1\x10"),
	MAIL(4500, 2, 0, "\4\0\0\0\0\x75" "\x45\x0c\x7f\x80"),
	MAIL(5000, 2, TO, "\6\0\0\0\0\x12" "\0\1\x02\x10\1\2"),
	MAIL(5100, 2, TO, "\4\0\0\0\0\x22" "\6\1\0\0"),
	MAIL(5200, 2, 0, "\4\0\0\0\0\x22" "\7\1\1\2"),
	MAIL(6000, 2, 0, "\7\0\0\0\0\x3f" "\2\0\0\0\1\0x"),
	MAIL(7000, 2, TO, "\x20\0\0\0\0\x41" "123456\1\0" "123456\2\0" "\2\0\4\0\0\0\0\0\0\0\0\0\7\0\0\0"),
	MAIL(7100, 2, 0, "\4\0\0\0\0\x50" "\1\0\2\0"),
	MAIL(8000, 2, EC_MAIL_MALFORMED, "\xff\xff\0\0\0\x13" "\0\x30"),
	MAIL(8100, 2, 0, "\3\0\0\0\0\x23" "\0\x30\x43"),
	MAIL(8200, 2, 0, "\1\0\0\0\0\x27" "x"),
};

static unsigned int at;
static bool reading;

static bool is(const char *what)
{
	const char *v = getenv("FAKE_MAIL");

	return v && !strcmp(v, what);
}

int fake_mail(unsigned long request, void *arg)
{
	struct ec_ioc_mail *i = arg;

	if (request != EC_IOC_MAIL)
		return FAKE_OTHER;
	if (is("old")) {
		errno = ENOTTY;
		return -1;
	}
	if (is("denied"))
		return fake_fail(EPERM, "mailbox messages may contain passwords");
	if (i->size != sizeof(struct ec_mail) || i->flags)
		return fake_fail(EINVAL, "another size");
	at = 0;
	reading = true;
	i->next = 7;
	return 0;
}

/* three at a time; false: the file is no reader of messages */
bool fake_mail_read(void *buf, unsigned long size, long *bytes)
{
	struct ec_mail *m = buf;
	unsigned int n;

	if (!reading)
		return false;
	for (n = 0; n < 3 && at < LEN(all) && size >= sizeof(*m); n++, m++, at++) {
		const struct fake_mail *from;

		*m = (struct ec_mail){ .missed = is("gap") && at == 4 ? 3 : 0 };
		at += (unsigned int)m->missed;
		from = &all[at];
		m->flags = from->flags;
		m->station = STATION + from->slave;
		m->position = from->slave;
		m->number = 7 + at;
		m->time_ns = 5000000000ULL + from->us * 1000ULL;
		m->wall_ns = WALL + from->us * 1000ULL;
		m->kept = from->size ? EC_MAIL_DATA : from->n;
		m->size = from->size ? from->size : from->n;
		memcpy(m->data, from->bytes, from->n);
		size -= sizeof(*m);
	}
	*bytes = (long)(n * sizeof(*m));
	return true;
}
