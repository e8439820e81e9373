// SPDX-License-Identifier: GPL-2.0-only
#include <linux/mm.h>
#include <linux/slab.h>
#include "known_table.h"

/**
 * ec_known_init() - no device has a number
 * @k: numbers of a bus
 *
 * Context: Process.
 */
void ec_known_init(struct ec_known *k)
{
	INIT_LIST_HEAD(&k->oldest);
}

static void image_free(struct kref *kref)
{
	kvfree(container_of(kref, struct ec_image, kref));
}

/**
 * ec_image_put() - give a reference back
 * @image: image or NULL
 *
 * Context: Process. May sleep.
 */
void ec_image_put(struct ec_image *image)
{
	if (image)
		kref_put(&image->kref, image_free);
}

/**
 * ec_known_drop() - forget a device that was disconnected
 * @k: numbers of a bus
 * @l: device
 *
 * Context: Process. The caller changes the table of slaves, or frees it.
 */
void ec_known_drop(struct ec_known *k, struct ec_lost *l)
{
	hlist_del(&l->by_number);
	hlist_del(&l->by_station);
	hlist_del_init(&l->by_serial);
	list_del(&l->age);
	k->n_lost--;
	ec_image_put(l->image);
	kfree(l);
}

/**
 * ec_known_exit() - forget the devices that were disconnected
 * @k: numbers of a bus without users
 *
 * Context: Process.
 */
void ec_known_exit(struct ec_known *k)
{
	struct ec_lost *l, *next;

	list_for_each_entry_safe(l, next, &k->oldest, age)
		ec_known_drop(k, l);
	kfree(k->absent);
}
