// SPDX-License-Identifier: GPL-2.0-only
#include <linux/etherdevice.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "boundary/api.h"
#include "boundary/cdev.h"
#include "link/device.h"
#include "master.h"
#include "session/session.h"
#include "bus/slave.h"
#include "bus/slave_pdo.h"

static struct ec_master *masters[EC_MAX_MASTERS];
static unsigned int n_masters;

unsigned int ec_master_count(void)
{
	return n_masters;
}

struct ec_master *ec_master_get(unsigned int index)
{
	return masters[index];
}

static void device(struct ec_links *l, const struct ec_link *link, bool attached)
{
	struct ec_master *m = container_of(l, struct ec_master, links);

	if (attached) {
		WRITE_ONCE(m->looked, false);
		ec_monitor_kick(m);
	} else if (!link->side) {
		mutex_lock(&m->cyclic_lock);
		if (m->active)
			ec_cycle_nothing_back(m->active);
		mutex_unlock(&m->cyclic_lock);
	}
}

static void queued(struct ec_links *l)
{
	ec_api_left(container_of(l, struct ec_master, links));
}

static const struct ec_links_ops links_ops = {
	.device = device,
	.queued = queued,
};

/**
 * ec_master_slave() - a slave by its ring position
 * @m: master
 * @position: ring position
 *
 * Context: Process. May sleep.
 * Return: the slave with a reference for the caller, or NULL.
 */
struct ec_slave *ec_master_slave(struct ec_master *m, unsigned int position)
{
	struct ec_slave *s = NULL;

	down_read(&m->topo);
	if (position < m->n_slaves)
		s = ec_slave_ref(m->slaves[position]);
	up_read(&m->topo);
	return s;
}

/* No slave on its way to another state, PDOs read. */
static bool slave_settled(struct ec_slave *s)
{
	return s->stop.gone || (!work_busy(&s->work) && !ec_slave_pdos_pending(s));
}

static bool slaves_settled(struct ec_master *m)
{
	unsigned int i;
	bool ok = true;

	down_read(&m->topo);
	for (i = 0; i < m->n_slaves && ok; i++)
		ok = slave_settled(m->slaves[i]);
	up_read(&m->topo);
	return ok;
}

static bool settled(struct ec_master *m)
{
	if (READ_ONCE(m->scan_busy) || READ_ONCE(m->rescan) || !READ_ONCE(m->looked))
		return false;
	/* a bus that answers is scanned first */
	return slaves_settled(m) && READ_ONCE(m->n_slaves) == READ_ONCE(m->slaves_responding);
}

/* The last step of a worker wakes nobody, so that is looked at now and then. */
static int wait_until(struct ec_master *m, bool (*there)(struct ec_master *m), unsigned int looks,
		      unsigned int look_ms)
{
	unsigned int i;
	long ret;

	for (i = 0; i < looks; i++) {
		ret = wait_event_interruptible_timeout(m->scan_wq, there(m),
						       msecs_to_jiffies(look_ms));
		if (ret < 0)
			return -EINTR;
		if (ret)
			return 0;
	}
	return -ETIMEDOUT;
}

/**
 * ec_master_wait_scan() - wait until the bus is scanned and has settled
 * @m: master
 *
 * Context: Process. May sleep, at most some seconds.
 * Return: 0, -EINTR, or -ETIMEDOUT.
 */
int ec_master_wait_scan(struct ec_master *m)
{
	return wait_until(m, settled, 300, 100);
}

/**
 * ec_master_wait_slaves() - wait until no slave is on its way to another state
 * @m: master
 *
 * Context: Process. May sleep, at most 10 s.
 * Return: 0, -EINTR, or -ETIMEDOUT.
 */
int ec_master_wait_slaves(struct ec_master *m)
{
	return wait_until(m, slaves_settled, 1000, 10);
}

/**
 * ec_master_wait_slave() - wait until a slave is in its state and its PDOs are known
 * @slave: slave
 *
 * Not without link: nobody reads them then.
 *
 * Context: Process. May sleep, at most 5 s.
 */
void ec_master_wait_slave(struct ec_slave *slave)
{
	struct ec_master *m = slave->master;
	unsigned int i;

	for (i = 0; i < 500 && READ_ONCE(m->links.link[0].up); i++)
		if (wait_event_killable_timeout(m->scan_wq, slave_settled(slave),
						msecs_to_jiffies(10)))
			return;
}

/**
 * ec_master_scan_busy() - is the bus scanned, or about to be?
 * @m: master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_master_scan_busy(const struct ec_master *m)
{
	bool busy = READ_ONCE(m->rescan);

	/* in this order: a request disappears only after @scan_busy is set */
	smp_rmb();
	return busy || READ_ONCE(m->scan_busy) ||
	       READ_ONCE(m->n_slaves) != READ_ONCE(m->slaves_responding);
}

/**
 * ec_master_scan_progress() - how far the scan has come
 * @m: master
 * @index: result: slaves that have been read
 * @count: result: slaves that the scan will find; @index is less until it has
 *	ended, unless there are none
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_master_scan_progress(const struct ec_master *m, u32 *index, u32 *count)
{
	*count = READ_ONCE(m->n_slaves);
	*index = *count;
	if (!ec_master_scan_busy(m))
		return;
	*count = READ_ONCE(m->slaves_responding);
	*index = 0;
	if (!READ_ONCE(m->scan_busy))
		return;
	smp_rmb();	/* written before */
	*count = READ_ONCE(m->scan_slaves);
	/* what was read is yet to be shown to the others */
	if (*count)
		*index = min(READ_ONCE(m->scan_index), *count - 1);
}

/**
 * ec_master_rescan() - ask for a scan
 * @m: master
 *
 * Context: Process.
 */
void ec_master_rescan(struct ec_master *m)
{
	WRITE_ONCE(m->rescan, true);
	ec_monitor_kick(m);
}

/*
 * So many workers run at once, and the others queue behind them. So what a worker
 * waits for is not in the queue he is in.
 */
static int queues_create(struct ec_master *m)
{
	m->work = alloc_workqueue("ethercat%u", WQ_UNBOUND, WQ_UNBOUND_MAX_ACTIVE, m->base->index);
	m->lanes = alloc_workqueue("ethercat%u-req", WQ_UNBOUND, WQ_UNBOUND_MAX_ACTIVE,
				   m->base->index);
	m->service = alloc_workqueue("ethercat%u-srv", WQ_UNBOUND, 0, m->base->index);
	return m->work && m->lanes && m->service ? 0 : -ENOMEM;
}

/* Service begins requests, and kicks slaves. */
static void queues_destroy(struct ec_master *m)
{
	if (m->service)
		destroy_workqueue(m->service);
	if (m->lanes)
		destroy_workqueue(m->lanes);
	if (m->work)
		destroy_workqueue(m->work);
}

static void destroy(struct ec_master *m)
{
	unsigned int i;

	WRITE_ONCE(m->base->stopping, true);
	ec_cdev_exit(m);
	ec_api_between_stop(m);
	ec_session_end(m, NULL);
	ec_monitor_stop(m);
	ec_dc_exit(m);
	queues_destroy(m);
	ec_api_destroy(m);
	ec_links_exit(&m->links);
	for (i = 0; i < m->n_slaves; i++)
		ec_slave_unref(m->slaves[i]);
	kvfree(m->slaves);
	m->slaves = NULL;
	m->n_slaves = 0;
	ec_log_flush(m->base, true);
	ec_cdev_put(m);
}

static struct ec_master *create(unsigned int index, const char *main, const char *backup,
				unsigned int debug)
{
	struct ec_master *m = kvzalloc(sizeof(*m), GFP_KERNEL);
	int ret;

	if (!m)
		return ERR_PTR(-ENOMEM);
	m->base->index = index;
	m->base->debug = debug;
	ec_log_init(&m->base->log);
	init_rwsem(&m->topo);
	init_waitqueue_head(&m->scan_wq);
	mutex_init(&m->session_lock);
	mutex_init(&m->cyclic_lock);
	ec_dc_init(m);
	ret = ec_links_init(&m->links, m->base, &links_ops, main, backup);
	if (ret)
		goto err_free;
	ret = queues_create(m);
	if (ret)
		goto err_work;
	ret = ec_api_create(m);
	if (ret)
		goto err_work;
	ret = ec_cdev_init(m);
	if (ret)
		goto err_api;
	ret = ec_monitor_start(m);
	if (ret)
		goto err_cdev;
	return m;

err_cdev:
	ec_cdev_exit(m);
	ec_api_destroy(m);
	queues_destroy(m);
	ec_links_exit(&m->links);
	ec_cdev_put(m);
	return ERR_PTR(ret);
err_api:
	ec_api_destroy(m);
err_work:
	queues_destroy(m);
	ec_links_exit(&m->links);
err_free:
	kvfree(m);
	return ERR_PTR(ret);
}

/* The broadcast address means any device, so it may be given again. */
static bool same_device(const char *a, const char *b)
{
	u8 x[ETH_ALEN] __aligned(2), y[ETH_ALEN] __aligned(2);

	if (mac_pton(a, x) && mac_pton(b, y))
		return ether_addr_equal(x, y) && !is_broadcast_ether_addr(x);
	return !strcmp(a, b);
}

/* A name that can be an interface's: the kernel's rules for them. */
static bool is_name(const char *spec)
{
	size_t len = strlen(spec);

	return len && len < IFNAMSIZ && strcmp(spec, ".") && strcmp(spec, "..") &&
	       !spec[strcspn(spec, "/: \t\n")];
}

/* An address that a device can have, or the broadcast address. */
static bool is_address(const char *spec)
{
	u8 mac[ETH_ALEN] __aligned(2);

	return strlen(spec) == 3 * ETH_ALEN - 1 && mac_pton(spec, mac) &&
	       (is_valid_ether_addr(mac) || is_broadcast_ether_addr(mac));
}

static int check_name(const char *spec, unsigned int index)
{
	if (!spec || !*spec) {
		pr_err("EtherCAT: main_devices: entry %u is empty; give a MAC address, an interface name or sim0\n",
		       index);
		return -EINVAL;
	}
	if (is_name(spec) || is_address(spec))
		return 0;
	if (strchr(spec, ':'))
		pr_err("EtherCAT: main_devices: \"%s\" is not the MAC address of a device; write it as 00:11:22:33:44:55, or ff:ff:ff:ff:ff:ff for the first device\n",
		       spec);
	else
		pr_err("EtherCAT: main_devices: \"%s\" cannot be an interface name (1 to %u characters, no slash, no space)\n",
		       spec, IFNAMSIZ - 1);
	return -EINVAL;
}

/*
 * Before the first master is there, as somebody may open it at once. What can never
 * work is refused: a master would wait for its device for ever.
 */
static int check_names(char **main, unsigned int n_main, char **backup, unsigned int n_backup)
{
	unsigned int i, k;
	int ret;

	for (i = 0; i < n_main; i++) {
		ret = check_name(main[i], i);
		if (ret)
			return ret;
		for (k = 0; k < i && !same_device(main[i], main[k]); k++)
			;
		if (k == i)
			continue;
		pr_err("EtherCAT: main_devices: device %s is listed twice; each master needs its own\n",
		       main[i]);
		return -EINVAL;
	}
	for (i = 0; i < n_backup; i++) {
		if (!backup[i] || !*backup[i])
			continue;
		pr_err("EtherCAT: backup_devices: \"%s\": this version has no cable redundancy; load ec_master without backup_devices=\n",
		       backup[i]);
		return -EOPNOTSUPP;
	}
	return 0;
}

/**
 * ec_masters_create() - create the masters the module parameters name
 * @main: main device of each: MAC address or device name
 * @n_main: how many
 * @backup: backup devices: empty strings only, as there is no redundancy
 * @n_backup: how many
 * @debug: log level
 *
 * Context: Process. May sleep.
 * Return: 0; -EINVAL for invalid names or level; -EOPNOTSUPP for a backup device;
 * -ENOMEM, or another -errno.
 */
int ec_masters_create(char **main, unsigned int n_main, char **backup, unsigned int n_backup,
		      unsigned int debug)
{
	unsigned int i;
	int ret = check_names(main, n_main, backup, n_backup);

	if (ret)
		return ret;
	if (debug > 2) {
		pr_err("EtherCAT: debug_level: %u is not 0, 1 or 2\n", debug);
		return -EINVAL;
	}
	for (i = 0; i < n_main; i++) {
		struct ec_master *m;

		m = create(i, main[i], i < n_backup && *backup[i] ? backup[i] : NULL, debug);
		if (IS_ERR(m)) {
			ec_masters_destroy();
			return PTR_ERR(m);
		}
		masters[i] = m;
		n_masters = i + 1;
		ec_device_register(&m->links);
	}
	return 0;
}

/**
 * ec_masters_destroy() - take all masters down
 *
 * Context: Process. May sleep.
 */
void ec_masters_destroy(void)
{
	while (n_masters)
		destroy(masters[--n_masters]);
}
