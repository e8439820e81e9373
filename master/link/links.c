// SPDX-License-Identifier: GPL-2.0-only
#include "../base/report.h"
#include "capture.h"
#include "device.h"
#include "links.h"

/* Frames are sent on two links, or on one. */
static void set_two(struct ec_links *l, bool two)
{
	WRITE_ONCE(l->sides, two ? BIT(EC_MAIN) | BIT(EC_BACKUP) : BIT(EC_MAIN));
	WRITE_ONCE(l->only, two ? NULL : &l->link[EC_MAIN]);
	WRITE_ONCE(l->ring.state, two ? EC_RING_UNKNOWN : EC_RING_NONE);
	WRITE_ONCE(l->ring.front, U32_MAX);
	WRITE_ONCE(l->ring.news, false);
}

static void name_backup(struct ec_links *l, const char *name)
{
	strscpy(l->backup_name, name, sizeof(l->backup_name));
	WRITE_ONCE(l->backup, *name ? l->backup_name : NULL);
}

/**
 * ec_links_init() - prepare the links of a master, which then wait for their devices
 * @l: zeroed structure
 * @base: of the master
 * @ops: callbacks of the master; they stay valid
 * @main: main device: MAC address or device name
 * @backup: backup device, NULL: none
 *
 * Context: Process. May sleep, takes RTNL.
 * Return: 0, -ENOMEM, or -EEXIST when the capture interface exists already.
 */
int ec_links_init(struct ec_links *l, struct ec_base *base, const struct ec_links_ops *ops,
		  const char *main, const char *backup)
{
	unsigned int i;
	int ret;

	l->base = base;
	l->ops = ops;
	strscpy(l->main, main, sizeof(l->main));
	raw_spin_lock_init(&l->main_lock);
	name_backup(l, backup ?: "");
	set_two(l, backup);
	l->max_datagrams = 15;
	l->io_timeout_us = 20000;
	for (i = 0; i < EC_MAX_LINKS; i++)
		ec_link_init(&l->link[i], l, i);
	ec_access_init(&l->access);
	INIT_LIST_HEAD(&l->list);
	ret = ec_slots_init(&l->slots, backup);
	if (ret)
		return ret;
	ret = ec_capture_create(l);
	if (ret)
		ec_slots_exit(&l->slots);
	return ret;
}

/**
 * ec_links_exit() - release all devices and free what ec_links_init() has allocated
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

/**
 * ec_links_set_backup() - the master has another backup device, or none, from now on
 * @l: links without a device, after ec_slots_reserve(); no slave is known, no session open
 * @name: of the backup device; "": none, so the bus is no ring
 *
 * Context: Process. May sleep. No device comes meanwhile.
 */
void ec_links_set_backup(struct ec_links *l, const char *name)
{
	rt_mutex_lock(&l->access.lock);
	ec_access_shut(l);
	raw_spin_lock(&l->main_lock);
	name_backup(l, name);
	WRITE_ONCE(l->exchanged, false);
	raw_spin_unlock(&l->main_lock);
	if (!l->only != !!*name) {
		set_two(l, *name);
		ec_slots_set_two(&l->slots, *name);
	}
	ec_access_reopen(l);
	rt_mutex_unlock(&l->access.lock);
}

/**
 * ec_links_name() - get the name of the device that a link is configured for
 * @l: links
 * @i: number of the link, 0: main device, 1: backup device
 * @buf: result: name, MAC address or PCI address as the user gave it; "": none
 * @size: of @buf
 *
 * Context: Any but interrupts. RT-safe: bounded, no sleep, no allocation.
 * Return: @buf.
 */
const char *ec_links_name(struct ec_links *l, unsigned int i, char *buf, size_t size)
{
	raw_spin_lock(&l->main_lock);
	strscpy(buf, ec_links_named(l, i) ? l->backup ?: "" : l->main, size);
	raw_spin_unlock(&l->main_lock);
	return buf;
}

/**
 * ec_links_need_thread() - does a device send only in a thread, not in a hard interrupt?
 * @l: links
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether one does.
 */
bool ec_links_need_thread(const struct ec_links *l)
{
	unsigned int i;

	for (i = 0; i < EC_MAX_LINKS; i++) {
		const struct ecdev *dev = READ_ONCE(l->link[i].dev);	/* may be withdrawn now */

		if (READ_ONCE(l->sides) & BIT(i) && dev && !dev->ops->atomic)
			return true;
	}
	return false;
}

/**
 * ec_links_one_attached() - has one of several links a device?
 * @l: links
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether one has.
 */
bool ec_links_one_attached(const struct ec_links *l)
{
	const struct ec_link *link;

	ec_links_for_each(l, link)
		if (READ_ONCE(l->sides) & BIT(link->side) && READ_ONCE(link->dev))
			return true;
	return false;
}

/**
 * ec_links_count_at() - count a frame; see ec_links_count()
 * @l: links
 * @sides: mask of those that count it
 * @counter: offset in struct ec_link_stats
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_links_count_at(struct ec_links *l, unsigned long sides, size_t counter)
{
	for (; sides; sides &= sides - 1)
		atomic64_inc((atomic64_t *)((u8 *)&l->link[__ffs(sides)].stats + counter));
}

/**
 * ec_links_lost() - count a frame as lost
 * @l: links
 * @slot: its slot
 * @sides: mask of the links without its copy; 0: none
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_links_lost(struct ec_links *l, const struct ec_slot *slot, unsigned long sides)
{
	/* a copy that cannot return while delays are measured */
	if (READ_ONCE(l->ring.measured))
		sides &= ~BIT(EC_BACKUP);
	ec_links_count(l, sides, lost);
	if (!trace_ec_frame_lost_enabled())
		return;
	for (; sides; sides &= sides - 1)
		trace_ec_frame_lost(l->base->index, __ffs(sides), slot->index,
				    l->slots.numbered ? READ_ONCE(slot->seq) : 0,
				    READ_ONCE(slot->eth_len));
}

/* Return: whether the state of a link has changed; a device that is withdrawn leaves it down. */
static bool has_changed(struct ec_link *link)
{
	struct ec_links *l = link->links;
	bool up, was;

	ec_link_look(link);
	rt_mutex_lock(&l->access.lock);
	up = ec_link_is_up(link);
	was = link->up;
	WRITE_ONCE(link->up, up);
	/* the way of all frames of a ring changes */
	if (up != was)
		WRITE_ONCE(l->ring.news, !l->only);
	rt_mutex_unlock(&l->access.lock);
	return up != was;
}

/**
 * ec_links_look() - read the physical state of the links; log changes
 * @l: links
 *
 * Context: The monitor.
 * Return: whether one is up.
 */
bool ec_links_look(struct ec_links *l)
{
	struct ec_link *link;
	bool any = false;

	ec_links_for_each(l, link) {
		if (has_changed(link)) {
			ec_link_hears(link);
			ec_report(l->base, link->up ? EC_EVENT_LINK_UP : EC_EVENT_LINK_DOWN,
				  link->side);
		}
		any |= link->up;
	}
	return any;
}

/**
 * ec_links_update_rates() - update the averages; called once a second
 * @l: links
 *
 * Context: The monitor.
 */
void ec_links_update_rates(struct ec_links *l)
{
	unsigned int i;

	for (i = 0; i < EC_MAX_LINKS; i++)
		ec_link_rates_update(&l->link[i]);
}

/**
 * ec_links_saw() - store the results of the last broadcast
 * @l: links
 * @slaves: slaves that answered: in a ring those before the break on the main link
 * @al_states: OR of their AL states
 *
 * Context: The monitor.
 */
void ec_links_saw(struct ec_links *l, u32 slaves, u32 al_states)
{
	u32 by[EC_MAX_LINKS] = { min(slaves, l->ring.front) };
	unsigned int i;

	by[EC_BACKUP] = slaves - by[EC_MAIN];
	for (i = 0; i < EC_MAX_LINKS; i++) {
		WRITE_ONCE(l->link[i].slaves, by[i]);
		WRITE_ONCE(l->link[i].al_states, by[i] ? al_states : 0);
	}
}
