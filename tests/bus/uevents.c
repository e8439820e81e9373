// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/netlink.h>
#include <net/net_namespace.h>
#include <net/sock.h>
#include "uevents.h"

/* Of @key=VALUE in a message; "": it has no such key. */
static const char *value(const char *msg, size_t len, const char *key)
{
	size_t at = 0, n = strlen(key);

	for (; at < len; at += strlen(msg + at) + 1)
		if (!strncmp(msg + at, key, n) && msg[at + n] == '=')
			return msg + at + n + 1;
	return "";
}

static void take(struct uevents *u, size_t len)
{
	struct uevent *e = &u->heard[u->n];
	const char *subsystem = value(u->buf, len, "SUBSYSTEM");

	*e = (struct uevent){ .action = u->buf[0], .at = ktime_get_ns() };
	e->master = !strcmp(subsystem, "ec_test");
	if (!e->master && strcmp(subsystem, "ethercat"))
		return;
	strscpy(e->name, kbasename(value(u->buf, len, "DEVPATH")), sizeof(e->name));
	strscpy(e->modalias, value(u->buf, len, "MODALIAS"), sizeof(e->modalias));
	if (kstrtou32(value(u->buf, len, "ETHERCAT_SLAVES_CHANGED"), 10, &e->changes))
		e->changes = 0;
	KUNIT_ASSERT_LT(u->test, ++u->n, (u32)UEVENTS);
}

/**
 * uevents_new() - listen from now on
 * @test: case
 *
 * The master is a device of the class "ec_test".
 */
struct uevents *uevents_new(struct kunit *test)
{
	struct sockaddr_nl all = { .nl_family = AF_NETLINK, .nl_groups = 1 };
	struct uevents *u = kzalloc(sizeof(*u), GFP_KERNEL);
	int ret;

	KUNIT_ASSERT_NOT_NULL(test, u);
	u->test = test;
	u->heard = kvcalloc(UEVENTS, sizeof(*u->heard), GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(test, u->heard);
	ret = sock_create_kern(&init_net, AF_NETLINK, SOCK_RAW, NETLINK_KOBJECT_UEVENT, &u->sock);
	KUNIT_ASSERT_EQ(test, ret, 0);
	/* none may be lost */
	u->sock->sk->sk_rcvbuf = 16 << 20;
	KUNIT_ASSERT_EQ(test, kernel_bind(u->sock, (struct sockaddr *)&all, sizeof(all)), 0);
	return u;
}

void uevents_free(struct uevents *u)
{
	sock_release(u->sock);
	kvfree(u->heard);
	kfree(u);
}

/* Take what has come so far. */
void uevents_listen(struct uevents *u)
{
	for (;;) {
		struct kvec iov = { u->buf, sizeof(u->buf) - 1 };
		struct msghdr msg = { .msg_flags = MSG_DONTWAIT };
		int ret = kernel_recvmsg(u->sock, &msg, &iov, 1, iov.iov_len, MSG_DONTWAIT);

		if (ret == -EAGAIN)
			return;
		KUNIT_ASSERT_GT(u->test, ret, 0);
		u->buf[ret] = 0;
		take(u, ret);
	}
}

void uevents_listen_ms(struct uevents *u, u32 ms)
{
	u64 end = ktime_get_ns() + ms * (u64)NSEC_PER_MSEC;

	while (ktime_get_ns() < end) {
		usleep_range(1000, 1001);
		uevents_listen(u);
	}
}

/* Those of slaves, or of the master, from number @from on. */
u32 uevents_count(const struct uevents *u, u32 from, char action, bool master)
{
	u32 n = 0;

	for (; from < u->n; from++)
		n += u->heard[from].action == action && u->heard[from].master == master;
	return n;
}
