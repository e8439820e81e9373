// SPDX-License-Identifier: GPL-2.0-only
/* Posts of a master, from their begin to their end. */
#include "loss.h"
#include "posts.h"

/**
 * ec_carry_init() - prepare the posts of a master
 * @c: zeroed structure
 * @l: links; their @carry is set
 * @ops: callbacks of higher layers, NULL: none; they stay valid
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno.
 */
int ec_carry_init(struct ec_carry *c, struct ec_links *l, const struct ec_carry_ops *ops)
{
	unsigned int i;

	c->links = l;
	c->ops = ops;
	raw_spin_lock_init(&c->lock);
	for (i = 0; i < EC_POST_CLASSES; i++)
		INIT_LIST_HEAD(&c->ready[i]);
	INIT_LIST_HEAD(&c->later);
	c->due_ns = U64_MAX;
	for (i = 0; i < EC_SLOTS; i++)
		INIT_LIST_HEAD(&c->flight[i].posts);
	l->carry = c;
	return ec_loss_start(c);
}

/**
 * ec_carry_exit() - end all posts
 * @c: posts of links without device; later posts are not sent, and their @done is not called
 *
 * Context: Process. May sleep.
 */
void ec_carry_exit(struct ec_carry *c)
{
	unsigned long flags;

	ec_loss_stop(c);
	raw_spin_lock_irqsave(&c->lock, flags);
	c->closed = true;
	raw_spin_unlock_irqrestore(&c->lock, flags);
	ec_loss_end_all(c);
}
