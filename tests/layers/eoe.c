// SPDX-License-Identifier: GPL-2.0-only
/* The network device of a slave with EoE follows the slave. No monitor runs. */
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include <linux/slab.h>
#include "master/eoe/netdev.h"
#include "master/eoe/netdevs.h"
#include "scanned.h"

static const char text[] =
	"segment seed=4\n"
	"slave coupler EK1100\n"
	"slave web EL6614 alias=7 eoe=host\n";

struct bench {
	struct scanned s;
	struct ec_eoe eoe;
};

static void bench_free(struct bench *b)
{
	ec_eoe_stop(&b->eoe);
	scanned_end(&b->s);
	kvfree(b);
}

static struct bench *bench_new(bool automatic)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	if (!scanned_begin(&b->s, text)) {
		kvfree(b);
		return NULL;
	}
	if (!scanned_scan(&b->s, 2)) {
		scanned_end(&b->s);
		kvfree(b);
		return NULL;
	}
	ec_eoe_init(&b->eoe);
	ec_eoe_start(&b->eoe, &b->s.bus, NULL, automatic);
	ec_eoe_look(&b->eoe);
	return b;
}

static bool is_there(void *ctx)
{
	struct net_device *nd = dev_get_by_name(&init_net, "eoe0a7");

	if (nd)
		dev_put(nd);
	return nd;
}

static bool has_carrier(void *ctx)
{
	struct net_device *nd = dev_get_by_name(&init_net, "eoe0a7");
	bool carrier = nd && netif_carrier_ok(nd);

	if (nd)
		dev_put(nd);
	return carrier;
}

static void set_up(bool up)
{
	struct net_device *nd = dev_get_by_name(&init_net, "eoe0a7");

	if (!CHECK(nd))
		return;
	rtnl_lock();
	if (up)
		CHECK_EQ(dev_open(nd, NULL), 0);
	else
		dev_close(nd);
	rtnl_unlock();
	dev_put(nd);
}

static void device_has_a_carrier_while_it_is_up(void)
{
	struct bench *b = bench_new(true);

	if (!b)
		return;
	CHECK(alone_wait(is_there, NULL, 2000));
	CHECK(!has_carrier(NULL));
	set_up(true);
	CHECK(alone_wait(has_carrier, NULL, 2000));
	set_up(false);
	CHECK(!has_carrier(NULL));
	bench_free(b);
	CHECK(!is_there(NULL));
}

static void device_goes_although_it_is_up(void)
{
	struct bench *b = bench_new(true);

	if (!b)
		return;
	CHECK(alone_wait(is_there, NULL, 2000));
	set_up(true);
	CHECK(alone_wait(has_carrier, NULL, 2000));
	bench_free(b);
	CHECK(!is_there(NULL));
}

static void device_is_made_on_wish(void)
{
	struct bench *b = bench_new(false);

	if (!b)
		return;
	msleep(100);
	CHECK(!is_there(NULL));
	CHECK_EQ(ec_eoe_wish(&b->eoe, b->s.bus.slaves[1]->device, EC_EOE_WISH_ON), 0);
	CHECK(alone_wait(is_there, NULL, 2000));
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(device_has_a_carrier_while_it_is_up),
	TEST(device_goes_although_it_is_up),
	TEST(device_is_made_on_wish),
	{ }
};
