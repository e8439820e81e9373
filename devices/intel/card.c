// SPDX-License-Identifier: GPL-2.0-only
/*
 * While no cycle polls the rings a timer does, and only while replies are awaited.
 */
#include "card.h"
#include "master/kernel/compat.h"
#include "master/wire/frame.h"
#include "phy.h"

#define IDLE_NS		(50 * NSEC_PER_USEC)	/* between two polls without a cycle */
#define OUT_NS		(20 * NSEC_PER_MSEC)	/* a later reply waits for another poll */

#define BUSY_POLL	0	/* a poll runs */
#define BUSY_TIMER	1	/* the timer is started, or its function runs */

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

/* Are there replies to come that no cycle polls for? */
static bool waits(struct intel *n)
{
	return READ_ONCE(n->ready) && !READ_ONCE(n->cycle) && ecdev_awaits(n->dev) &&
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

/* The functions that use the rings are called in an RCU read section. */
static u8 *intel_tx_get(void *priv)
{
	struct intel *n = priv;

	return READ_ONCE(n->ready) ? ec_ring_tx_get(&n->nic, &n->tx) : NULL;
}

static int intel_tx_send(void *priv, u8 *buf, size_t len)
{
	struct intel *n = priv;

	if (!READ_ONCE(n->ready) || !READ_ONCE(n->nic.up))
		return -ENETDOWN;
	ec_ring_tx_put(&n->nic, &n->tx, len);
	return 0;
}

static void intel_tx_flush(void *priv)
{
	struct intel *n = priv;

	if (!READ_ONCE(n->ready) || !ec_ring_tx_flush(&n->nic, &n->tx) || READ_ONCE(n->cycle))
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

static unsigned int intel_speed(void *priv)
{
	struct intel *n = priv;

	return READ_ONCE(n->nic.speed);
}

static void note_phy(struct intel *n, int ret)
{
	n->negotiate = ret;
	if (ret && __ratelimit(&n->faults))
		pci_warn(n->pdev, "cannot switch its PHY on (%pe); tried again while there is no link\n",
			 ERR_PTR(ret));
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
	note_phy(n, ec_nic_connect(&n->nic));
	n->nic.gone = false;
	n->failed = false;
	n->health.looks = 0;
	/* counts of before the start have another cause */
	ec_health_clear(&n->health, &n->nic);
	WRITE_ONCE(n->ready, true);
	return 0;
}

/* No frame, no DMA, no caller in the rings. */
static void quiesce_locked(struct intel *n)
{
	lockdep_assert_held(&n->lock);
	n->failed = false;
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

/**
 * ec_card_quiesce() - no frame, no DMA; its state in PCI may change now
 * @n: card
 *
 * Context: Process. May sleep.
 */
void ec_card_quiesce(struct intel *n)
{
	mutex_lock(&n->lock);
	quiesce_locked(n);
	mutex_unlock(&n->lock);
}

/* Frames in the ring of a lost link would leave when it returns: old outputs. */
static void start_anew(struct intel *n)
{
	bool again = n->failed;
	int ret;

	quiesce_locked(n);
	ret = run(n);
	n->failed = ret;
	if (ret && !again && __ratelimit(&n->restarts))
		pci_err(n->pdev, "does not start again (%pe); tried each second\n", ERR_PTR(ret));
}

static void look_each_second(struct intel *n)
{
	lockdep_assert_held(&n->lock);
	if (!n->nic.up)
		note_phy(n, ec_phy_wake(&n->nic, n->negotiate));
	if (!ec_health_count(&n->health, &n->nic) || !__ratelimit(&n->faults))
		return;
	if (n->health.damaged)
		pci_warn(n->pdev, "has received %u damaged frame(s): check the cable between this card and the slaves\n",
			 n->health.damaged);
	if (n->health.missed)
		pci_warn(n->pdev, "had no free buffer for %u received frame(s): they come faster than they are polled\n",
			 n->health.missed);
	n->health.damaged = 0;
	n->health.missed = 0;
}

static void look_running(struct intel *n, bool second)
{
	bool was_up = n->nic.up, was_gone = n->nic.gone;

	lockdep_assert_held(&n->lock);
	/* a card that hangs may stop the CPU that reads it for a while */
	if (was_gone && !second)
		return;
	ec_nic_look(&n->nic);
	if (n->nic.gone && !was_gone && __ratelimit(&n->restarts))
		pci_warn(n->pdev, "does not answer: unplugged?\n");
	if (n->nic.gone)
		return;
	if (was_gone || (was_up && !n->nic.up)) {
		start_anew(n);
		return;
	}
	if (ec_health_stuck(&n->health, &n->nic, &n->tx, ktime_get_ns())) {
		if (__ratelimit(&n->restarts))
			pci_warn(n->pdev, "has sent no frame for 500 ms: started again\n");
		start_anew(n);
		return;
	}
	/* of errors while a cable is plugged in */
	if (n->nic.up && !was_up)
		ec_health_clear(&n->health, &n->nic);
	if (n->nic.up && !was_up && n->nic.slow && __ratelimit(&n->restarts))
		pci_warn(n->pdev, "the link has 10 Mbit/s or half duplex; EtherCAT needs 100 Mbit/s, full duplex: check the device at the other end\n");
	if (second)
		look_each_second(n);
}

static void intel_look(void *priv)
{
	struct intel *n = priv;
	bool second;

	/* the rings start or end now: look next time */
	if (!mutex_trylock(&n->lock))
		return;
	second = ec_health_second(&n->health, ktime_get_ns());
	if (n->ready)
		look_running(n, second);
	else if (n->failed && second && !n->shut)
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

/**
 * ec_card_run_again() - go on after a reset, an error of the bus, or a suspend
 * @n: card; what has restored its state has used it up
 *
 * Context: Process. May sleep.
 * Return: 0, also when no master uses it, or as ec_nic_reset() and ec_ring_start(); a failure is
 * tried again.
 */
int ec_card_run_again(struct intel *n)
{
	int ret = 0;

	mutex_lock(&n->lock);
	/* a master may have started it meanwhile */
	quiesce_locked(n);
	pci_save_state(n->pdev);
	if (n->started)
		ret = run(n);
	n->failed = ret;
	mutex_unlock(&n->lock);
	return ret;
}

const struct ecdev_ops ec_card_ops = {
	.kind = "native",
	.atomic = true,
	.burst = INTEL_TX - INTEL_TX / 4,
	.start = intel_start,
	.stop = intel_stop,
	.tx_get = intel_tx_get,
	.stays = true,
	.tx_send = intel_tx_send,
	.tx_flush = intel_tx_flush,
	.poll = intel_poll,
	.keeps = true,
	.cycle = intel_cycle,
	.link_up = intel_link_up,
	.speed = intel_speed,
	.look = intel_look,
};

/**
 * ec_card_shut() - the computer goes down
 * @n: card; another kernel may start in its memory, so no command of a tool starts it again
 *
 * Context: Process. May sleep.
 */
void ec_card_shut(struct intel *n)
{
	mutex_lock(&n->lock);
	n->shut = true;
	quiesce_locked(n);
	mutex_unlock(&n->lock);
}

/**
 * ec_card_init() - prepare a card
 * @n: zeroed structure with @pdev and @chip
 *
 * Context: Process.
 */
void ec_card_init(struct intel *n)
{
	mutex_init(&n->lock);
	ratelimit_state_init(&n->faults, 60 * HZ, 3);
	ratelimit_state_init(&n->restarts, 60 * HZ, 3);
	ratelimit_set_flags(&n->faults, RATELIMIT_MSG_ON_RELEASE);
	ratelimit_set_flags(&n->restarts, RATELIMIT_MSG_ON_RELEASE);
	hrtimer_setup(&n->idle, poll_idle, CLOCK_MONOTONIC, HRTIMER_MODE_REL_SOFT);
}
