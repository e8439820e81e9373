// SPDX-License-Identifier: GPL-2.0-only
/*
 * Faults while a segment runs: /sys/kernel/debug/ec_sim/sim0 takes a line of a
 * description, and shows the segment. For root only.
 */
#include <linux/debugfs.h>
#include <linux/err.h>
#include <linux/fs.h>
#include <linux/module.h>
#include <linux/seq_file.h>
#include <linux/slab.h>
#include "describe.h"
#include "sim_control.h"

#define TEXT_MAX	512
#define LINE_MAX	160	/* of the segment */

static struct dentry *dir;

static ssize_t control_write(struct file *file, const char __user *user, size_t count, loff_t *pos)
{
	const char *name = file->f_path.dentry->d_iname;
	struct ec_sim_wire *w = file_inode(file)->i_private;
	struct ec_sim_error err;
	struct ec_sim_fault f;
	size_t len = count;
	char *text;
	int ret;

	if (count > TEXT_MAX) {
		pr_err_ratelimited("ec_sim: %s: fault of %zu characters, limit %u\n", name,
				   count, TEXT_MAX);
		return -EMSGSIZE;
	}
	text = memdup_user(user, count);
	if (IS_ERR(text))
		return PTR_ERR(text);
	ret = ec_sim_command(w->sim, &ec_sim_kernel_ops, text, len, &f, &err);
	if (ret) {
		pr_err_ratelimited("ec_sim: %s: %s\n", name, err.text);
	} else {
		ret = ec_sim_wire_fault(w, &f);
		if (ret)
			pr_err_ratelimited("ec_sim: %s: cannot add the fault (%pe)\n", name,
					   ERR_PTR(ret));
	}
	kfree(text);
	return ret ? ret : (ssize_t)count;
}

/* Slaves are never added or removed, so only each line needs the lock. */
static int control_show(struct seq_file *m, void *unused)
{
	struct ec_sim_wire *w = m->private;
	u32 n = ec_sim_count(w->sim);
	char line[LINE_MAX];

	seq_printf(m, "# %u slave(s); a line written to this file is a fault: cut NAME.1\n", n);
	for (u32 i = 0; i < n; i++) {
		ec_sim_wire_show(w, i, line, sizeof(line));
		seq_printf(m, "%s\n", line);
	}
	return 0;
}

static int control_open(struct inode *inode, struct file *file)
{
	return single_open(file, control_show, inode->i_private);
}

static const struct file_operations control_fops = {
	.owner = THIS_MODULE,
	.open = control_open,
	.read = seq_read,
	.write = control_write,
	.llseek = seq_lseek,
	.release = single_release,
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
	debugfs_create_file(name, 0600, dir, w, &control_fops);
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
