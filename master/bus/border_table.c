// SPDX-License-Identifier: GPL-2.0-only
#include <linux/mm.h>
#include <linux/module.h>
#include <linux/slab.h>
#include <linux/sysfs.h>
#include "border_table.h"

static const char * const modes[] = {
	[EC_BORDER_AUTO] = "auto", [EC_BORDER_CLOSED] = "closed", [EC_BORDER_OPEN] = "open",
};

static enum ec_border_mode border_mode;

static int set_border(const char *value, const struct kernel_param *kp)
{
	int mode = sysfs_match_string(modes, value);

	if (mode < 0)
		return mode;
	border_mode = mode;
	return 0;
}

static int get_border(char *buf, const struct kernel_param *kp)
{
	return sysfs_emit(buf, "%s\n", modes[border_mode]);
}

static const struct kernel_param_ops border_ops = {
	.set = set_border,
	.get = get_border,
};

module_param_cb(border, &border_ops, NULL, 0444);
MODULE_PARM_DESC(border,
		 "Ports that stay closed before unexpected devices while process data run: auto (default: where a hot connect group is expected), closed (all) or open (none)");

/**
 * ec_border_init() - nothing is expected
 * @b: of a bus
 *
 * Context: Process.
 */
void ec_border_init(struct ec_border *b)
{
	b->mode = border_mode;
	raw_spin_lock_init(&b->lock);
	INIT_LIST_HEAD(&b->found);
}

/**
 * ec_border_clear() - nothing is expected any more, and what was let in is forgotten
 * @b: of a bus
 *
 * Context: Process.
 */
void ec_border_clear(struct ec_border *b)
{
	struct ec_border_found *f, *next;
	struct ec_border_sign *signs;
	unsigned long flags;
	LIST_HEAD(found);

	raw_spin_lock_irqsave(&b->lock, flags);
	signs = b->signs;
	b->signs = NULL;
	b->n_signs = 0;
	b->waiting = false;
	list_splice_init(&b->found, &found);
	b->n_found = 0;
	raw_spin_unlock_irqrestore(&b->lock, flags);
	kvfree(signs);
	list_for_each_entry_safe(f, next, &found, list)
		kfree(f);
}
