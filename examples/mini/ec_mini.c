// SPDX-License-Identifier: GPL-2.0-only
/*
 * A small application in the kernel: 1000 times a second it copies the first
 * bytes of the inputs of one slave to its outputs. Beside the cycle it reads an object, and it
 * logs changes.
 *
 *   make -C /lib/modules/$(uname -r)/build M=$PWD ECRT=/usr/local/include \
 *	KBUILD_EXTRA_SYMBOLS=/lib/modules/$(uname -r)/updates/ethercat/Module.symvers
 *   insmod ec_mini.ko position=0
 *
 * With kernel_cycle=1 a thread of the master exchanges the process data, and the thread of
 * this module waits for its cycles. With in_interrupt=1 the cycle runs in the interrupt of a
 * timer, which needs a native or virtual device.
 *
 * In the source tree "make mini" builds it.
 */
#include <linux/delay.h>
#include <linux/err.h>
#include <linux/hrtimer.h>
#include <linux/kthread.h>
#include <linux/module.h>
#include <linux/sched.h>
#include <linux/version.h>
#include <ecrt.h>

#define PERIOD_US	1000
#define PERIOD_NS	(PERIOD_US * NSEC_PER_USEC)
#define BYTES		2	/* copied in each cycle */
#define READ_CYCLES	1000	/* between two reads of the object */

static unsigned int master_index;
module_param_named(master, master_index, uint, 0444);
MODULE_PARM_DESC(master, "index of the master");

static ushort position;
module_param(position, ushort, 0444);
MODULE_PARM_DESC(position, "ring position of the slave: SM2 outputs, SM3 inputs, CoE");

static bool kernel_cycle;
module_param(kernel_cycle, bool, 0444);
MODULE_PARM_DESC(kernel_cycle, "the master runs the cycle");

static bool in_interrupt;
module_param(in_interrupt, bool, 0444);
MODULE_PARM_DESC(in_interrupt, "the cycle runs in the interrupt of a timer");

static ec_master_t *master;
static ec_domain_t *domain;
static ec_slave_config_t *slave;
static ec_sdo_request_t *serial;
static struct task_struct *task;
static struct hrtimer timer;
static int out, in;

/* Reads the serial number again and again, beside the cycle. */
static void read_serial(unsigned int cycle)
{
	static ec_request_state_t last;
	ec_request_state_t now = ecrt_sdo_request_state(serial);

	if (now != last && now == EC_REQUEST_SUCCESS)
		pr_info("ec_mini: serial number %u\n",
			EC_READ_U32(ecrt_sdo_request_data(serial)));
	if (now != last && now == EC_REQUEST_ERROR)
		pr_info("ec_mini: cannot read the serial number\n");
	last = now;
	if (now != EC_REQUEST_BUSY && cycle % READ_CYCLES == 0)
		ecrt_sdo_request_read(serial);
}

/* None of this sleeps or waits, so that it may be an interrupt; only a change is printed. */
static void show_changes(void)
{
	static ec_slave_config_state_t last;
	static ec_domain_state_t last_data;
	ec_slave_config_state_t now;
	ec_domain_state_t data;

	ecrt_slave_config_state(slave, &now);
	if (now.al_state != last.al_state || now.operational != last.operational)
		pr_info("ec_mini: slave is in state %u%s\n", now.al_state,
			now.operational ? ", operational" : "");
	last = now;
	ecrt_domain_state(domain, &data);
	if (data.wc_state != last_data.wc_state)
		pr_info("ec_mini: working counter %u, %s\n", data.working_counter,
			data.wc_state == EC_WC_COMPLETE ? "complete" : "incomplete");
	last_data = data;
}

static int cycle(unsigned int n)
{
	u8 *data = ecrt_domain_data(domain);
	int ret = ecrt_master_receive(master);

	ecrt_domain_process(domain);
	show_changes();
	read_serial(n);
	memcpy(data + out, data + in, BYTES);
	ecrt_domain_queue(domain);
	ecrt_master_send(master);
	return ret;
}

static enum hrtimer_restart tick(struct hrtimer *t)
{
	static unsigned int n;

	if (cycle(n++) == -EWOULDBLOCK) {
		pr_err("ec_mini: this device cannot be used in an interrupt; the cycle ends\n");
		return HRTIMER_NORESTART;
	}
	hrtimer_forward_now(t, ns_to_ktime(PERIOD_NS));
	return HRTIMER_RESTART;
}

/* Until the next cycle begins. */
static void wait_cycle(ktime_t *next)
{
	*next = ktime_add_us(*next, PERIOD_US);
	if (kernel_cycle) {
		/* the cycle has stopped, or this thread is to end */
		if (ecrt_master_wait_cycle(master, 0) < 0)
			usleep_range(PERIOD_US, 2 * PERIOD_US);
		return;
	}
	set_current_state(TASK_IDLE);
	schedule_hrtimeout(next, HRTIMER_MODE_ABS);
}

static int run(void *unused)
{
	ktime_t next = ktime_get();
	unsigned int n;

	sched_set_fifo(current);
	for (n = 0; !kthread_should_stop(); n++) {
		wait_cycle(&next);
		cycle(n);
	}
	return 0;
}

/* Default process data of the slave. */
static int configure(void)
{
	const ec_cycle_config_t period = { .period_ns = PERIOD_NS };
	ec_slave_info_t info;
	int ret = ecrt_master_get_slave(master, position, &info);

	if (ret)
		return ret;
	domain = ecrt_master_create_domain(master);
	slave = ecrt_master_slave_config(master, 0, position, info.vendor_id, info.product_code);
	if (!domain || !slave)
		return -ENOMEM;
	out = ecrt_slave_config_reg_pdo_entry_pos(slave, 2, 0, 0, domain, NULL);
	if (out < 0)
		return out;
	in = ecrt_slave_config_reg_pdo_entry_pos(slave, 3, 0, 0, domain, NULL);
	if (in < 0)
		return in;
	serial = ecrt_slave_config_create_sdo_request(slave, 0x1018, 4, 4);
	if (!serial)
		return -ENOMEM;
	ecrt_sdo_request_timeout(serial, 500);
	if (kernel_cycle)
		return ecrt_master_set_cycle(master, &period);
	return ecrt_master_set_send_interval(master, PERIOD_US);
}

/* The master logs the reason of a failure. */
static int __init ec_mini_init(void)
{
	const ktime_t period = ns_to_ktime(PERIOD_NS);
	int ret;

	master = ecrt_request_master(master_index);
	if (!master)
		return -EBUSY;
	ret = configure() ?: ecrt_master_activate(master);
	if (ret)
		goto err;
	if (in_interrupt) {
#if LINUX_VERSION_CODE < KERNEL_VERSION(6, 13, 0)
		hrtimer_init(&timer, CLOCK_MONOTONIC, HRTIMER_MODE_REL_HARD);
		timer.function = tick;
#else
		hrtimer_setup(&timer, tick, CLOCK_MONOTONIC, HRTIMER_MODE_REL_HARD);
#endif
		hrtimer_start(&timer, period, HRTIMER_MODE_REL_HARD);
		return 0;
	}
	task = kthread_run(run, NULL, "ec_mini");
	if (!IS_ERR(task))
		return 0;
	ret = PTR_ERR(task);
err:
	ecrt_release_master(master);
	return ret;
}

/* Stop the cycle before its master is released. */
static void __exit ec_mini_exit(void)
{
	if (in_interrupt)
		hrtimer_cancel(&timer);
	else
		kthread_stop(task);
	ecrt_release_master(master);
}

module_init(ec_mini_init);
module_exit(ec_mini_exit);

MODULE_DESCRIPTION("EtherCAT: a small application in the kernel");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
