// SPDX-License-Identifier: GPL-2.0-only
/*
 * Faults while a segment runs: /sys/kernel/debug/ec_sim/sim0 takes a line of a
 * description. Only root may write.
 */
#include <linux/debugfs.h>
#include <linux/err.h>
#include <linux/fs.h>
#include <linux/module.h>
#include <linux/slab.h>
#include "describe.h"
#include "sim_control.h"

#define TEXT_MAX	512

static struct dentry *dir;

static ssize_t control_write(struct file *file, const char __user *user, size_t count, loff_t *pos)
{
	struct ec_sim_wire *w = file->private_data;
	struct ec_sim_error err;
	struct ec_sim_fault f;
	size_t len = count;
	char *text;
	int ret;

	if (count > TEXT_MAX)
		return -EMSGSIZE;
	text = memdup_user(user, count);
	if (IS_ERR(text))
		return PTR_ERR(text);
	ret = ec_sim_command(w->sim, &ec_sim_kernel_ops, text, len, &f, &err);
	if (!ret)
		ret = ec_sim_wire_fault(w, &f);
	else
		pr_err_ratelimited("ec_sim: %s: %s\n", file->f_path.dentry->d_iname, err.text);
	kfree(text);
	return ret ? ret : (ssize_t)count;
}

static const struct file_operations control_fops = {
	.owner = THIS_MODULE,
	.open = simple_open,
	.write = control_write,
	.llseek = noop_llseek,
};

/**
 * ec_sim_control_init() - make the folder
 *
 * Without debugfs there is none, which is no failure.
 *
 * Context: Process. May sleep.
 */
void ec_sim_control_init(void)
{
	dir = debugfs_create_dir("ec_sim", NULL);
}

/**
 * ec_sim_control_add() - take faults for a segment
 * @name: of the file
 * @w: the segment; must stay until ec_sim_control_exit()
 *
 * Context: Process. May sleep.
 */
void ec_sim_control_add(const char *name, struct ec_sim_wire *w)
{
	debugfs_create_file(name, 0200, dir, w, &control_fops);
}

/**
 * ec_sim_control_exit() - take the files away; no write is at work afterwards
 *
 * Context: Process. May sleep.
 */
void ec_sim_control_exit(void)
{
	debugfs_remove(dir);
}
