/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Interface between the master and the devices that carry its frames: the
 * generic device (any netdev), native drivers, the simulator.
 */
#ifndef EC_ECDEV_H
#define EC_ECDEV_H

#include <linux/types.h>

struct ecdev;
struct notifier_block;

/**
 * struct ecdev_ops - functions of a device driver
 * @kind: "generic", "virtual", "e1000e"... for messages
 * @atomic: mandatory. @tx_get, @tx_send and @poll may be called with
 *	preemption or interrupts off (native, virtual); otherwise in a thread only, where nothing
 *	may sleep either but in a spinlock of PREEMPT_RT
 * @burst: frames that may be sent in a row so that buffers are left for the
 *	next cycle, 0: any number
 * @start: mandatory. Takes the device for the master, brings it up; @dev is
 *	for ecdev_receive(). Process context, may sleep. Return: 0 or -errno
 * @stop: mandatory. Releases the device; no frame is delivered after the return
 * @tx_get: mandatory. A free transmit buffer of EC_ETH_MAX bytes, or NULL
 *	when the hardware still owns all of them. In an RCU read section
 * @stays: a buffer of @tx_get keeps its frame until @tx_get returns it again, at least until
 *	ecdev_withdraw() has returned
 * @tx_send: mandatory. Sends @len bytes (at least EC_ETH_MIN) from a buffer
 *	@tx_get returned. Return: 0, -ENETDOWN, -EBUSY (frame not sent). With @tx_flush
 *	it may leave only then. In the same RCU read section as @tx_get and @tx_flush
 * @tx_flush: optional. No more frames follow at once: all that were sent leave now.
 *	Context as @tx_send
 * @poll: optional. Delivers received frames through ecdev_receive(). Also
 *	called with @cycle off when a frame is overdue. In an RCU read section
 * @keeps: the frames that @poll has delivered stay as they are until it is called again, while
 *	@cycle is on, and the master may write to them; and until a grace period has ended after
 *	the device has stopped by itself
 * @cycle: optional. On: the caller polls, the device needs no interrupts
 * @link_up: mandatory. A bit test; callable from the cycle
 * @speed: optional. Mbit/s of the link when it is up, as @link_up knows it
 * @look: optional. Reads the state that @link_up returns. Called about every 20 ms, and by
 *	those whose frame is late, one at a time. Process context, may sleep
 */
struct ecdev_ops {
	const char *kind;
	bool atomic;
	unsigned int burst;
	int (*start)(void *priv, struct ecdev *dev);
	void (*stop)(void *priv);
	u8 *(*tx_get)(void *priv);
	bool stays;
	int (*tx_send)(void *priv, u8 *buf, size_t len);
	void (*tx_flush)(void *priv);
	void (*poll)(void *priv);
	bool keeps;
	void (*cycle)(void *priv, bool on);
	bool (*link_up)(void *priv);
	unsigned int (*speed)(void *priv);
	void (*look)(void *priv);
};

struct ecdev *ecdev_offer(const char *name, const u8 *mac,
			  const struct ecdev_ops *ops, void *priv);
void ecdev_withdraw(struct ecdev *dev);
void ecdev_rename(struct ecdev *dev, const char *name);
bool ecdev_numbered(struct ecdev *dev);
bool ecdev_waiting(unsigned int *index, unsigned int *master, char *name, size_t size,
		   bool *backup);
bool ecdev_wanted(const char *name, const u8 *mac, bool any);
int ecdev_register_notifier(struct notifier_block *nb);
void ecdev_unregister_notifier(struct notifier_block *nb);
void ecdev_receive(struct ecdev *dev, const u8 *src, const u8 *data, size_t len);
bool ecdev_awaits(struct ecdev *dev);
bool ecdev_in_cycle(struct ecdev *dev);
void ecdev_foreign(struct ecdev *dev);
void ecdev_not_captured(struct ecdev *dev);

#endif
