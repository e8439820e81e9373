/* SPDX-License-Identifier: GPL-2.0-only */
/* A device that behaves as a test says, for "link" and "carry"; there is no slave. */
#ifndef EC_CARD_H
#define EC_CARD_H

#include <linux/ktime.h>
#include <linux/rcupdate.h>
#include <linux/slab.h>
#include "devices/ecdev.h"
#include "master/base/limits.h"
#include "master/base/once64.h"
#include "master/link/device.h"
#include "master/link/links.h"

static const u8 mac[ETH_ALEN] __maybe_unused = { 0x02, 0x00, 0x00, 0xec, 0x00, 0x01 };

enum behaviour {
	ANSWERS,	/* at once, as one slave would */
	HOLDS,		/* keeps the last frame for deliver() */
};

struct test_device {
	enum behaviour does;
	bool up;
	int refuses;		/* result of a send, or 0 */
	bool seen;		/* the last look has found it up */
	bool started;
	unsigned int sent;
	size_t len;
	u8 tx[EC_ETH_MAX];
	u8 held[EC_ETH_MAX];
	struct ecdev *dev;
	const struct ec_links *links;
	bool cyclic;
	int mode;		/* of the access when the device heard of it */
};

/* the held frame comes back */
static void deliver(struct test_device *d)
{
	u8 *body = d->held + EC_ETH_HDR;
	struct ec_frame_iter it;
	struct ec_dgram dg;

	ec_frame_iter_init(&it, body, d->len - EC_ETH_HDR);
	while (ec_frame_iter_next(&it, &dg) == 1) {
		memset(dg.data, 0xa5, dg.len);
		ec_dgram_set_wkc(&dg, ec_dgram_wkc(&dg) + 1);
	}
	rcu_read_lock();
	ecdev_receive(d->dev, d->held + ETH_ALEN, body, d->len - EC_ETH_HDR);
	rcu_read_unlock();
}

static int start(void *priv, struct ecdev *dev)
{
	struct test_device *d = priv;

	d->dev = dev;
	d->started = true;
	return 0;
}

static void stop(void *priv)
{
	struct test_device *d = priv;

	d->started = false;
}

static u8 *tx_get(void *priv)
{
	struct test_device *d = priv;

	return d->tx;
}

static int tx_send(void *priv, u8 *buf, size_t len)
{
	struct test_device *d = priv;

	if (d->refuses)
		return d->refuses;
	memcpy(d->held, buf, len);
	d->len = len;
	d->sent++;
	if (d->does == ANSWERS)
		deliver(d);
	return 0;
}

static bool link_up(void *priv)
{
	const struct test_device *d = priv;

	return READ_ONCE(d->up);
}

static void cycle(void *priv, bool on)
{
	struct test_device *d = priv;

	d->cyclic = on;
	d->mode = READ_ONCE(d->links->access.mode);
}

static void look(void *priv)
{
	struct test_device *d = priv;

	WRITE_ONCE(d->seen, READ_ONCE(d->up));
}

static bool link_seen(void *priv)
{
	const struct test_device *d = priv;

	return READ_ONCE(d->seen);
}

static const struct ecdev_ops device_ops __maybe_unused = {
	.kind = "test", .atomic = true, .start = start, .stop = stop, .tx_get = tx_get,
	.tx_send = tx_send, .cycle = cycle, .link_up = link_up,
};

/* as a network card without interrupts */
static const struct ecdev_ops looking_ops __maybe_unused = {
	.kind = "test", .atomic = true, .start = start, .stop = stop, .tx_get = tx_get,
	.tx_send = tx_send, .cycle = cycle, .link_up = link_seen, .look = look,
};

#endif
