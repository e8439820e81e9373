// SPDX-License-Identifier: GPL-2.0-only
/*
 * An application in the kernel that knows its bus by a file: it uses values by their names. It
 * logs an input when it changes, in its unit, and copies it to an output if one is named.
 *
 * WARNING: it switches that output. Run it only where no output moves or heats anything.
 *
 *   ethercat bus compile bus.yaml -o /lib/firmware/ethercat-bus.bin
 *   make -C /lib/modules/$(uname -r)/build M=$PWD ECRT=/usr/local/include \
 *	KBUILD_EXTRA_SYMBOLS=/lib/modules/$(uname -r)/updates/ethercat/Module.symvers
 *   insmod ec_named.ko input=axis1.position
 *
 * The module may contain the bus instead: "xxd -i <bus.bin >bus.inc", and BUS=$PWD/bus.inc for
 * make. In the source tree "make mini" builds it.
 */
#include <linux/delay.h>
#include <linux/err.h>
#include <linux/firmware.h>
#include <linux/kthread.h>
#include <linux/math64.h>
#include <linux/module.h>
#include <linux/platform_device.h>
#include <ecrt.h>

static unsigned int master_index;
module_param_named(master, master_index, uint, 0444);
MODULE_PARM_DESC(master, "index of the master");

static char *bus = "ethercat-bus.bin";
module_param(bus, charp, 0444);
MODULE_PARM_DESC(bus, "compiled bus file, in the folder of firmware");

static char *input;
module_param(input, charp, 0444);
MODULE_PARM_DESC(input, "name of a value, for example axis1.position");

static char *output;
module_param(output, charp, 0444);
MODULE_PARM_DESC(output, "name of a value of the same size that gets the input; none: nothing");

static ec_master_t *master;
static ec_value_t from, to;
static struct task_struct *task;

#ifdef BUS
/* the bus is in this module */
static int load(void)
{
	static const u8 image[] = {
#include BUS
	};

	return ecrt_master_load_compiled(master, image, sizeof(image));
}
#else
/* the bus is a file, which is not needed any more once it is loaded */
static int load(void)
{
	struct platform_device *dev = platform_device_register_simple("ec_named", -1, NULL, 0);
	const struct firmware *fw;
	int ret;

	if (IS_ERR(dev))
		return PTR_ERR(dev);
	ret = request_firmware(&fw, bus, &dev->dev);
	if (!ret) {
		ret = ecrt_master_load_compiled(master, fw->data, fw->size);
		release_firmware(fw);
	} else {
		pr_err("ec_named: cannot read %s in the folder of firmware (%pe)\n", bus,
		       ERR_PTR(ret));
	}
	platform_device_unregister(dev);
	return ret;
}
#endif

/* Integers of whole bytes, and single bits. */
static s64 read_value(const ec_value_t *v)
{
	const u8 *data = ecrt_domain_data(v->domain) + v->byte;
	bool sign = v->type >= 2 && v->type <= 5;

	switch (v->bits) {
	case 1:
		return EC_READ_BIT(data, v->bit);
	case 8:
		return sign ? EC_READ_S8(data) : EC_READ_U8(data);
	case 16:
		return sign ? EC_READ_S16(data) : EC_READ_U16(data);
	case 32:
		return sign ? (s64)EC_READ_S32(data) : (s64)EC_READ_U32(data);
	default:
		return EC_READ_S64(data);
	}
}

static void write_value(const ec_value_t *v, s64 raw)
{
	u8 *data = ecrt_domain_data(v->domain) + v->byte;

	switch (v->bits) {
	case 1:
		EC_WRITE_BIT(data, v->bit, raw & 1);
		break;
	case 8:
		EC_WRITE_U8(data, raw);
		break;
	case 16:
		EC_WRITE_U16(data, raw);
		break;
	case 32:
		EC_WRITE_U32(data, raw);
		break;
	default:
		EC_WRITE_U64(data, raw);
	}
}

/* In thousandths of its unit; numbers of usual bus files do not overflow. */
static s64 scaled(const ec_value_t *v, s64 raw)
{
	return div64_s64(1000 * raw * v->scale_num, v->scale_den) +
	       div64_s64(1000 * v->offset_num, v->offset_den);
}

static void show(s64 raw)
{
	s64 n = scaled(&from, raw);
	s32 thousandths;

	n = div_s64_rem(n, 1000, &thousandths);
	pr_info_ratelimited("ec_named: %s = %s%lld.%03d %s\n", input,
			    n || thousandths >= 0 ? "" : "-", n, abs(thousandths), from.unit);
}

static void cycle(void)
{
	static s64 last;
	static bool shown;
	s64 raw;

	ecrt_master_receive(master);
	ecrt_domain_process(from.domain);
	if (output && to.domain != from.domain)
		ecrt_domain_process(to.domain);
	raw = read_value(&from);
	if (!shown || raw != last)
		show(raw);
	shown = true;
	last = raw;
	if (output)
		write_value(&to, raw);
	ecrt_domain_queue(from.domain);
	if (output && to.domain != from.domain)
		ecrt_domain_queue(to.domain);
	ecrt_master_send(master);
}

/* A thread of the master exchanges the process data. */
static int run(void *unused)
{
	while (!kthread_should_stop()) {
		if (ecrt_master_wait_cycle(master, 0) < 0)
			usleep_range(1000, 2000);
		else
			cycle();
	}
	return 0;
}

static int find(const char *name, ec_value_t *v)
{
	int ret = name ? ecrt_master_value(master, name, v) : -EINVAL;

	if (!ret && v->bits != 1 && (v->bit || v->bits % 8 || v->bits == 24 || v->bits > 64))
		ret = -EINVAL;
	if (ret)
		pr_err("ec_named: no value %s in the bus file, or neither bytes nor a bit\n",
		       name ?: "(parameter input)");
	return ret;
}

/* The master logs the reason of most failures. */
static int configure(void)
{
	ec_cycle_config_t period = { .period_ns = NSEC_PER_MSEC };
	ec_loaded_t loaded;
	int ret = load() ?: find(input, &from);

	if (!ret && output)
		ret = find(output, &to);
	if (!ret && output && (!to.output || to.bits != from.bits)) {
		pr_err("ec_named: %s is no output of %u bits\n", output, from.bits);
		ret = -EINVAL;
	}
	if (ret)
		return ret;
	ecrt_master_loaded(master, &loaded);
	if (loaded.cycle_ns)
		period.period_ns = loaded.cycle_ns;
	pr_info("ec_named: %u slaves, %u values\n", loaded.slaves, loaded.values);
	return ecrt_master_set_cycle(master, &period) ?: ecrt_master_activate(master);
}

static int __init ec_named_init(void)
{
	int ret;

	master = ecrt_request_master(master_index);
	if (!master)
		return -EBUSY;
	ret = configure();
	if (ret)
		goto err;
	task = kthread_run(run, NULL, "ec_named");
	if (!IS_ERR(task))
		return 0;
	ret = PTR_ERR(task);
err:
	ecrt_release_master(master);
	return ret;
}

static void __exit ec_named_exit(void)
{
	kthread_stop(task);
	ecrt_release_master(master);
}

module_init(ec_named_init);
module_exit(ec_named_exit);

MODULE_DESCRIPTION("EtherCAT: an application in the kernel that uses values by name");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
