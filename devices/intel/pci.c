// SPDX-License-Identifier: GPL-2.0-only
/*
 * Native device: an Intel network controller that the master has for itself, without interrupts.
 * The driver binds to devices whose driver_override names it, and to no other: a network card
 * in use by the system is never taken. While no cycle polls the ring a timer does, and only
 * while frames are on their way.
 */
#include <linux/hrtimer.h>
#include <linux/module.h>
#include <linux/mutex.h>
#include <linux/pci.h>
#include "devices/ecdev.h"
#include "master/wire/compat.h"
#include "master/wire/frame.h"
#include "nic.h"
#include "ring.h"

#define NAME		"ec_intel"
#define IDLE_NS		(50 * NSEC_PER_USEC)	/* between two polls without a cycle */
#define OUT_NS		(20 * NSEC_PER_MSEC)	/* a frame that is on its way longer is lost */

#define BUSY_POLL	0	/* a poll runs */
#define BUSY_TIMER	1	/* the timer is started, or its function runs */

/**
 * struct intel - one network controller
 */
struct intel {
	/** @pdev: PCI function */
	struct pci_dev *pdev;
	/** @chip: what it is */
	const struct intel_chip *chip;
	/** @nic: its registers */
	struct intel_nic nic;
	/** @tx: transmit ring; one sender at a time */
	struct intel_ring tx;
	/** @rx: receive ring; only in a poll */
	struct intel_ring rx;
	/** @dev: receives the frames; set before the first one can arrive */
	struct ecdev *dev;
	/** @lock: while the rings start, run or end they are those of one caller */
	struct mutex lock;
	/** @idle: polls while no cycle does */
	struct hrtimer idle;
	/** @sent_ns: when the last frame was sent without a cycle (ktime) */
	atomic64_t sent_ns;
	/** @busy: bits BUSY_* */
	unsigned long busy;
	/** @cycle: the cycle polls */
	bool cycle;
	/** @started: a master uses it */
	bool started;
	/** @ready: the rings run */
	bool ready;
	/** @shut: the computer goes down: they never run again */
	bool shut;
};

/* In an RCU read section. */
static void poll(struct intel *n)
{
	const u8 *frame;
	size_t len;

	/* the cycle begins while the timer's poll has not ended yet, or the reverse */
	if (!READ_ONCE(n->ready) || test_and_set_bit_lock(BUSY_POLL, &n->busy))
		return;
	/* those of the poll before; of one poll there are at most as many as buffers */
	ec_ring_rx_put(&n->nic, &n->rx);
	while ((frame = ec_ring_rx_get(&n->nic, &n->rx, &len))) {
		if (len >= EC_ETH_HDR && get_unaligned_be16(frame + 12) == EC_ETHERTYPE)
			ecdev_receive(n->dev, frame + ETH_ALEN, frame + EC_ETH_HDR,
				      len - EC_ETH_HDR);
		else if (len)
			ecdev_foreign(n->dev);
	}
	clear_bit_unlock(BUSY_POLL, &n->busy);
}

/* Are there frames in flight that no cycle polls for? */
static bool waits(struct intel *n)
{
	return READ_ONCE(n->ready) && !READ_ONCE(n->cycle) &&
	       ktime_get_ns() - atomic64_read(&n->sent_ns) <= OUT_NS;
}

static enum hrtimer_restart poll_idle(struct hrtimer *timer)
{
	struct intel *n = container_of(timer, struct intel, idle);

	rcu_read_lock();
	if (!READ_ONCE(n->cycle))
		poll(n);
	rcu_read_unlock();
	if (!waits(n)) {
		clear_bit(BUSY_TIMER, &n->busy);
		smp_mb__after_atomic();	/* the bit before the time; pairs with intel_tx_flush() */
		/* a sender that comes now starts the timer again, unless this function continues */
		if (!waits(n) || test_and_set_bit(BUSY_TIMER, &n->busy))
			return HRTIMER_NORESTART;
	}
	hrtimer_forward_now(timer, ns_to_ktime(IDLE_NS));
	return HRTIMER_RESTART;
}

static u8 *intel_tx_get(void *priv)
{
	struct intel *n = priv;

	return READ_ONCE(n->ready) ? ec_ring_tx_get(&n->nic, &n->tx) : NULL;
}

static int intel_tx_send(void *priv, u8 *buf, size_t len)
{
	struct intel *n = priv;

	int ret = -ENETDOWN;

	rcu_read_lock();
	if (READ_ONCE(n->ready) && READ_ONCE(n->nic.up)) {
		ec_ring_tx_put(&n->nic, &n->tx, len);
		ret = 0;
	}
	rcu_read_unlock();
	return ret;
}

static void intel_tx_flush(void *priv)
{
	struct intel *n = priv;

	bool sent;

	rcu_read_lock();
	sent = READ_ONCE(n->ready) && ec_ring_tx_flush(&n->nic, &n->tx);
	rcu_read_unlock();
	if (!sent || READ_ONCE(n->cycle))
		return;
	atomic64_set(&n->sent_ns, ktime_get_ns());
	/* the time before the bit; pairs with poll_idle() */
	if (!test_and_set_bit(BUSY_TIMER, &n->busy))
		hrtimer_start(&n->idle, ns_to_ktime(IDLE_NS), HRTIMER_MODE_REL_SOFT);
}

static void intel_poll(void *priv)
{
	struct intel *n = priv;

	poll(n);
}

/* no sender may come meanwhile */
static void stop_timer(struct intel *n)
{
	hrtimer_cancel(&n->idle);
	clear_bit(BUSY_TIMER, &n->busy);
}

static void intel_cycle(void *priv, bool on)
{
	struct intel *n = priv;

	WRITE_ONCE(n->cycle, on);
	if (on)
		stop_timer(n);
}

static bool intel_link_up(void *priv)
{
	struct intel *n = priv;

	return READ_ONCE(n->nic.up);
}

static int run(struct intel *n)
{
	int ret;

	lockdep_assert_held(&n->lock);
	if (n->shut)
		return -ESHUTDOWN;
	ret = ec_nic_reset(&n->nic);
	if (!ret) {
		/* without it no descriptor is fetched */
		pci_set_master(n->pdev);
		ret = ec_ring_start(&n->nic, &n->tx, &n->rx);
	}
	if (ret) {
		pci_clear_master(n->pdev);
		return ret;
	}
	ec_nic_connect(&n->nic);
	n->nic.gone = false;
	WRITE_ONCE(n->ready, true);
	return 0;
}

/* No frame, no DMA, no caller in the rings: senders are stopped by the master. */
static void quiesce_locked(struct intel *n)
{
	lockdep_assert_held(&n->lock);
	if (!n->ready)
		return;
	WRITE_ONCE(n->nic.up, false);
	WRITE_ONCE(n->ready, false);
	/* a caller in the rings leaves */
	synchronize_rcu();
	stop_timer(n);
	ec_nic_quiet(&n->nic);
	pci_clear_master(n->pdev);
}

static void quiesce(struct intel *n)
{
	mutex_lock(&n->lock);
	quiesce_locked(n);
	mutex_unlock(&n->lock);
}

/* Frames in the ring of a lost link would leave when it returns: old outputs. */
static void start_anew(struct intel *n)
{
	int ret;

	quiesce_locked(n);
	ret = run(n);
	if (ret)
		pci_err(n->pdev,
			"does not start after a loss of the link (%pe); unbind and bind it\n",
			ERR_PTR(ret));
}

static void intel_look(void *priv)
{
	struct intel *n = priv;
	bool was_up, was_gone;

	/* the rings start or end now: look next time */
	if (!mutex_trylock(&n->lock))
		return;
	was_up = n->nic.up;
	was_gone = n->nic.gone;
	if (n->ready)
		ec_nic_look(&n->nic);
	if (n->nic.gone && !was_gone)
		pci_warn(n->pdev, "does not answer: unplugged?\n");
	else if (was_up && !n->nic.up)
		start_anew(n);
	mutex_unlock(&n->lock);
}

static int intel_start(void *priv, struct ecdev *dev)
{
	struct intel *n = priv;
	int ret;

	n->dev = dev;
	mutex_lock(&n->lock);
	ret = run(n);
	n->started = !ret;
	mutex_unlock(&n->lock);
	return ret;
}

static void intel_stop(void *priv)
{
	struct intel *n = priv;

	mutex_lock(&n->lock);
	quiesce_locked(n);
	n->started = false;
	mutex_unlock(&n->lock);
}

/* after a reset, an error of the bus, or a suspend; what has restored the state has used it up */
static int run_again(struct intel *n)
{
	int ret = 0;

	mutex_lock(&n->lock);
	pci_save_state(n->pdev);
	if (n->started)
		ret = run(n);
	mutex_unlock(&n->lock);
	return ret;
}

static const struct ecdev_ops intel_ops = {
	.kind = "native",
	.atomic = true,
	.burst = INTEL_TX - INTEL_TX / 4,
	.start = intel_start,
	.stop = intel_stop,
	.tx_get = intel_tx_get,
	.tx_send = intel_tx_send,
	.tx_flush = intel_tx_flush,
	.poll = intel_poll,
	.keeps = true,
	.cycle = intel_cycle,
	.link_up = intel_link_up,
	.look = intel_look,
};

static int check(struct pci_dev *pdev, const struct intel_chip *chip)
{
	if (pdev->vendor != PCI_VENDOR_ID_INTEL || !chip)
		pci_err(pdev, "%04x:%04x is not in the list of chips; use the generic device\n",
			pdev->vendor, pdev->device);
	else if (!chip->class)
		pci_err(pdev, "%s is not supported: %s; use the generic device\n", chip->name,
			chip->why_not);
	else
		return 0;
	return -ENODEV;
}

static int map(struct intel *n)
{
	struct pci_dev *pdev = n->pdev;
	int ret = pcim_enable_device(pdev);

	if (ret)
		return ret;
	/* the largest offset that any chip of the list uses */
	if (pci_resource_len(pdev, 0) < 0x10000) {
		pci_err(pdev, "BAR 0 has %llu byte(s), 65536 needed\n",
			(unsigned long long)pci_resource_len(pdev, 0));
		return -ENXIO;
	}
	ret = pcim_iomap_regions(pdev, BIT(0), NAME);
	if (ret)
		return ret;
	n->nic.regs = pcim_iomap_table(pdev)[0];
	n->nic.class = n->chip->class;
	/* some chips on a 32-bit bus fail with addresses of 64 bits */
	ret = n->chip->class->pcie ? dma_set_mask_and_coherent(&pdev->dev, DMA_BIT_MASK(64)) : -EIO;
	if (ret)
		ret = dma_set_mask_and_coherent(&pdev->dev, DMA_BIT_MASK(32));
	/* leaving a power saving state takes longer than a frame */
	pci_disable_link_state(pdev, PCIE_LINK_STATE_L0S | PCIE_LINK_STATE_L1);
	pci_intx(pdev, 0);
	return ret ?: ec_ring_alloc(&pdev->dev, &n->tx, &n->rx);
}

static int probe(struct pci_dev *pdev, const struct pci_device_id *id)
{
	const struct intel_chip *chip = ec_chip_find(pdev->device);
	struct ecdev *dev;
	struct intel *n;
	int ret = check(pdev, chip);

	if (ret)
		return ret;
	n = devm_kzalloc(&pdev->dev, sizeof(*n), GFP_KERNEL);
	if (!n)
		return -ENOMEM;
	n->pdev = pdev;
	n->chip = chip;
	mutex_init(&n->lock);
	hrtimer_init(&n->idle, CLOCK_MONOTONIC, HRTIMER_MODE_REL_SOFT);
	n->idle.function = poll_idle;
	ret = map(n);
	if (ret)
		return ret;
	/* the address is known after it, and the controller is quiet until a master wants it */
	ret = ec_nic_reset(&n->nic);
	if (ret) {
		pci_err(pdev, "cannot reset the controller (%pe)\n", ERR_PTR(ret));
		return ret;
	}
	pci_set_drvdata(pdev, n);
	pci_save_state(pdev);
	pci_info(pdev, "%s (%s)%s, %pM\n", chip->name, chip->class->name,
		 chip->tested ? "" : ", never tested", n->nic.mac);
	dev = ecdev_offer(pci_name(pdev), n->nic.mac, &intel_ops, n);
	if (IS_ERR(dev))
		return PTR_ERR(dev);
	n->dev = dev;
	return 0;
}

static void remove(struct pci_dev *pdev)
{
	struct intel *n = pci_get_drvdata(pdev);

	ecdev_withdraw(n->dev);
}

/* another kernel may start in this memory, so no command of a tool starts the rings again */
static void shutdown(struct pci_dev *pdev)
{
	struct intel *n = pci_get_drvdata(pdev);

	mutex_lock(&n->lock);
	n->shut = true;
	quiesce_locked(n);
	mutex_unlock(&n->lock);
}

static void reset_prepare(struct pci_dev *pdev)
{
	quiesce(pci_get_drvdata(pdev));
}

static void reset_done(struct pci_dev *pdev)
{
	struct intel *n = pci_get_drvdata(pdev);
	int ret = run_again(n);

	if (ret)
		pci_err(pdev, "does not start after a reset (%pe)\n", ERR_PTR(ret));
}

/*
 * A card without these functions keeps the kernel from ending the errors of other functions behind
 * the same port. Also after an error that needs no reset the descriptors may be wrong.
 */
static pci_ers_result_t error_detected(struct pci_dev *pdev, pci_channel_state_t state)
{
	quiesce(pci_get_drvdata(pdev));
	switch (state) {
	case pci_channel_io_normal:
		return PCI_ERS_RESULT_CAN_RECOVER;
	case pci_channel_io_frozen:
		return PCI_ERS_RESULT_NEED_RESET;
	default:
		return PCI_ERS_RESULT_DISCONNECT;
	}
}

/* It was never disabled: its registers answer again with the state. */
static pci_ers_result_t slot_reset(struct pci_dev *pdev)
{
	pci_restore_state(pdev);
	return PCI_ERS_RESULT_RECOVERED;
}

static int suspend(struct device *dev)
{
	quiesce(dev_get_drvdata(dev));
	return 0;
}

static int resume(struct device *dev)
{
	return run_again(dev_get_drvdata(dev));
}

static DEFINE_SIMPLE_DEV_PM_OPS(pm_ops, suspend, resume);

static const struct pci_error_handlers errors = {
	.reset_prepare = reset_prepare,
	.reset_done = reset_done,
	.error_detected = error_detected,
	.slot_reset = slot_reset,
	.resume = reset_done,
};

/* none: only driver_override chooses a device, see pci_match_device() */
static const struct pci_device_id ids[] = { {} };

static struct pci_driver intel_driver = {
	.name = NAME,
	.id_table = ids,
	.probe = probe,
	.remove = remove,
	.shutdown = shutdown,
	.err_handler = &errors,
	.driver.pm = pm_sleep_ptr(&pm_ops),
};
module_pci_driver(intel_driver);

MODULE_DESCRIPTION("EtherCAT master: native device for Intel network controllers");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
