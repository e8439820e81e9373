// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include <linux/sched.h>
#include "carry.h"
#include "post_int.h"

#define URGENT_MORE	2	/* frames of the monitor beside those that have a place */

/**
 * ec_carry_expect() - expect the thread of the posts to run
 * @c: posts of the master
 * @after_ns: in how many ns; the log reports it when the thread has not run a second later
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_carry_expect(struct ec_carry *c, u64 after_ns)
{
	hrtimer_start(&c->starved, ns_to_ktime(after_ns + EC_STARVED_NS), HRTIMER_MODE_REL_HARD);
}

/**
 * ec_carry_kick() - the thread of the posts has something to do
 * @c: posts of the master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_carry_kick(struct ec_carry *c)
{
	struct task_struct *t = READ_ONCE(c->thread);
	bool kicked = READ_ONCE(c->kicked);

	WRITE_ONCE(c->kicked, true);
	if (!t)
		return;
	/* a second runs since the first kick */
	if (!kicked && READ_ONCE(c->rests))
		ec_carry_expect(c, 0);
	wake_up_process(t);
}

/* Set the limit of acyclic frames in flight; a cycle is limited by its free wire time instead. */
static void set_places(struct ec_link *link)
{
	const struct ecdev *dev = READ_ONCE(link->dev);
	unsigned int n = dev && dev->ops->burst ? dev->ops->burst : EC_LINK_ACYCLIC;

	if (ec_access_is_cyclic(&link->links->access))
		n = EC_LINK_QUEUED;
	WRITE_ONCE(link->places, n);
}

/**
 * ec_carry_changed() - the bus access or a device has changed
 * @l: links
 *
 * With direct access transmit buffers of the device are left for the monitor.
 *
 * Context: Process, with the access lock held.
 */
void ec_carry_changed(struct ec_links *l)
{
	unsigned int i;

	lockdep_assert_held(&l->access.lock);
	for (i = 0; i < EC_MAX_LINKS; i++)
		set_places(&l->link[i]);
	if (l->carry)
		ec_carry_kick(l->carry);
}

/**
 * ec_carry_has_place() - may one more frame be in flight?
 * @c: posts of the master
 * @class: enum ec_post_class
 *
 * Tools must not delay the monitor, which watches the application and the link.
 *
 * Context: The owner of the bus access. RT-safe.
 * Return: whether it may.
 */
bool ec_carry_has_place(const struct ec_carry *c, u8 class)
{
	unsigned int more = ec_post_first(class) ? URGENT_MORE : 0;
	unsigned long left;

	for (left = READ_ONCE(c->links->sides); left; left &= left - 1) {
		const struct ec_link *link = &c->links->link[__ffs(left)];

		if (atomic_read(&link->acyclic) >= READ_ONCE(link->places) + more)
			return false;
	}
	return true;
}
