// SPDX-License-Identifier: GPL-2.0-only
/*
 * Lets one step of the load of a module fail: call number @at of those functions below that its
 * init function calls. The call returns at once with an error. The modules have nothing for it.
 */
#include <linux/delay.h>
#include <linux/kprobes.h>
#include <linux/module.h>
#include <linux/notifier.h>
#include <linux/string.h>

static char *module = "";
module_param(module, charp, 0444);
MODULE_PARM_DESC(module, "the module whose load fails");

static unsigned int at;
module_param(at, uint, 0644);
MODULE_PARM_DESC(at, "the step that fails, 1 is the first; 0: none");

static unsigned int steps;
module_param(steps, uint, 0444);
MODULE_PARM_DESC(steps, "of the last load");

#define LOADED	8

/* under the notifier's lock; modules of ours that are loaded, as they call each other */
static struct module *loaded[LOADED];
static struct task_struct *loader;
static unsigned long last_caller;

/* as an x86 function returns */
void ec_fail_return(void);
asm(".pushsection .text\n"
    ".type ec_fail_return, @function\n"
    "ec_fail_return:\n\t"
    ASM_ENDBR
    ASM_RET
    ".size ec_fail_return, . - ec_fail_return\n"
    ".popsection");

/* of functions that return memory; of those that return -errno, also as a pointer */
#define NOTHING	0
#define ERROR	(-ENOMEM)

struct place {
	const char *name;
	long result;
	struct kprobe probe;
};

/* what a kernel does not have is left out */
static struct place places[] = {
	{ "__kmalloc", NOTHING },
	{ "__kmalloc_noprof", NOTHING },
	{ "kmalloc_trace", NOTHING },
	{ "kmem_cache_alloc_trace", NOTHING },
	{ "__kmalloc_cache_noprof", NOTHING },
	{ "kvmalloc_node", NOTHING },
	{ "__kvmalloc_node_noprof", NOTHING },
	{ "vmalloc", NOTHING },
	{ "vzalloc", NOTHING },
	{ "__vmalloc", NOTHING },
	{ "vmalloc_noprof", NOTHING },
	{ "vzalloc_noprof", NOTHING },
	{ "__alloc_skb", NOTHING },
	{ "alloc_netdev_mqs", NOTHING },
	{ "alloc_workqueue", NOTHING },
	{ "cdev_alloc", NOTHING },
	{ "kmem_cache_create", NOTHING },
	{ "__kmem_cache_create_args", NOTHING },
	{ "bus_register", ERROR },
	{ "__class_create", ERROR },
	{ "class_create", ERROR },
	{ "kthread_create_on_node", ERROR },
	{ "device_create", ERROR },
	{ "device_add", ERROR },
	{ "cdev_device_add", ERROR },
	{ "debugfs_create_dir", ERROR },
	{ "debugfs_create_file", ERROR },
	{ "alloc_chrdev_region", ERROR },
	{ "cdev_add", ERROR },
	{ "register_netdev", ERROR },
	{ "register_reboot_notifier", ERROR },
	{ "register_pm_notifier", ERROR },
	{ "register_netdevice_notifier", ERROR },
	{ "register_inetaddr_notifier", ERROR },
	{ "blocking_notifier_chain_register", ERROR },
	{ "netdev_rx_handler_register", ERROR },
	{ "nf_register_net_hook", ERROR },
	{ "__pci_register_driver", ERROR },
};

static bool ours(unsigned long address)
{
	unsigned int i;

	for (i = 0; i < LOADED; i++)
		if (loaded[i] && within_module(address, loaded[i]))
			return true;
	return false;
}

/* A call at the end of an init function may be a jump. */
static bool from_init(unsigned long address)
{
	char name[32];

	snprintf(name, sizeof(name), "%ps", (void *)address);
	return !strcmp(name, "do_one_initcall");
}

static int enter(struct kprobe *p, struct pt_regs *regs)
{
	struct place *place = container_of(p, struct place, probe);
	unsigned long caller = regs_get_kernel_stack_nth(regs, 0);

	if (current != loader || (!ours(caller) && !from_init(caller)))
		return 0;
	/* a call that is repeated is one step */
	if (caller == last_caller)
		return 0;
	last_caller = caller;
	if (++steps != at)
		return 0;
	pr_info("ec_fail: step %u: %s\n", steps, place->name);
	/* a program that waits for a moment to open something runs before the failure is seen */
	mdelay(1);
	regs->ax = place->result;
	instruction_pointer_set(regs, (unsigned long)ec_fail_return);
	return 1;
}

static void set_loaded(struct module *from, struct module *to)
{
	unsigned int i;

	for (i = 0; i < LOADED; i++)
		if (loaded[i] == from) {
			loaded[i] = to;
			return;
		}
}

static int event(struct notifier_block *nb, unsigned long state, void *data)
{
	struct module *m = data;

	if (strncmp(m->name, "ec_", 3) || m == THIS_MODULE)
		return NOTIFY_DONE;
	if (state == MODULE_STATE_COMING) {
		set_loaded(NULL, m);
		if (!strcmp(m->name, module)) {
			steps = 0;
			last_caller = 0;
			loader = current;
		}
		return NOTIFY_DONE;
	}
	if (!strcmp(m->name, module))
		loader = NULL;
	if (state == MODULE_STATE_GOING)
		set_loaded(m, NULL);
	return NOTIFY_DONE;
}

static struct notifier_block notifier = { .notifier_call = event };

static int __init fail_init(void)
{
	unsigned int i, n = 0;

	for (i = 0; i < ARRAY_SIZE(places); i++) {
		places[i].probe.symbol_name = places[i].name;
		places[i].probe.pre_handler = enter;
		if (register_kprobe(&places[i].probe))
			places[i].probe.pre_handler = NULL;
		else
			n++;
	}
	pr_info("ec_fail: %u place(s)\n", n);
	return register_module_notifier(&notifier);
}

static void __exit fail_exit(void)
{
	unsigned int i;

	unregister_module_notifier(&notifier);
	for (i = 0; i < ARRAY_SIZE(places); i++)
		if (places[i].probe.pre_handler)
			unregister_kprobe(&places[i].probe);
}

module_init(fail_init);
module_exit(fail_exit);

MODULE_DESCRIPTION("Test of the EtherCAT master: failures of a module's load");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
