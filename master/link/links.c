// SPDX-License-Identifier: GPL-2.0-only
#include "capture.h"
#include "device.h"
#include "links.h"

/**
 * ec_links_init() - prepare the links of a master, which then wait for their devices
 * @l: zeroed structure
 * @base: of the master
 * @ops: what it wants to know; stays
 * @main: main device: MAC address or device name; stays
 * @backup: backup device, NULL: none
 *
 * Context: Process. May sleep, takes RTNL.
 * Return: 0, -ENOMEM, or -EEXIST when there is such a capture interface.
 */
int ec_links_init(struct ec_links *l, struct ec_base *base, const struct ec_links_ops *ops,
		  const char *main, const char *backup)
{
	unsigned int i;
	int ret;

	l->base = base;
	l->ops = ops;
	l->spec[0] = main;
	l->spec[1] = backup;
	l->max_datagrams = 15;
	l->io_timeout_us = 20000;
	for (i = 0; i < EC_MAX_LINKS; i++)
		ec_link_init(&l->link[i], l, i);
	ec_access_init(&l->access);
	ec_queues_init(&l->queues);
	INIT_LIST_HEAD(&l->list);
	ret = ec_slots_init(&l->slots);
	if (ret)
		return ret;
	ret = ec_capture_create(l);
	if (ret)
		ec_slots_exit(&l->slots);
	return ret;
}

/**
 * ec_links_exit() - give back all devices and free what ec_links_init() has allocated
 * @l: links
 *
 * Context: Process. May sleep, takes RTNL.
 */
void ec_links_exit(struct ec_links *l)
{
	ec_device_unregister(l);
	ec_capture_destroy(l);
	ec_slots_exit(&l->slots);
}
