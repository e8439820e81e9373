// SPDX-License-Identifier: GPL-2.0-only
#include <linux/if.h>
#include <linux/slab.h>
#include "boundary/api.h"
#include "boundary/cdev.h"
#include "carry/posts.h"
#include "clock/dc.h"
#include "clock/dc_track.h"
#include "link/device.h"
#include "link/spec.h"
#include "boundary/master.h"
#include "monitor.h"
#include "config/apply.h"
#include "session/reserve.h"
#include "session/session_attach.h"
#include "session/session_units.h"
#include "bus/bus_list.h"
#include "bus/ring_heal.h"

static void master_device(struct ec_links *l, const struct ec_link *link, bool attached)
{
	struct ec_master *m = container_of(l, struct ec_master, links);

	if (attached) {
		WRITE_ONCE(m->bus.looked, false);
		ec_monitor_kick(m);
	} else if (!link->side) {
		ec_cycles_nothing_back(&m->cycles);
	}
}

static void queued(struct ec_carry *c)
{
	lockdep_assert_held(&c->links->access.lock);
	ec_api_left(container_of(c, struct ec_master, carry));
}

static void wake(struct ec_bus *bus)
{
	ec_monitor_kick(container_of(bus, struct ec_master, bus));
}

static bool attached(const struct ec_slave *s)
{
	return ec_config_of(s);
}

static const struct ec_bus_ops bus_ops = {
	.attached = attached,
	.configure = ec_apply,
	.wake = wake,
};

/* The monitor watches for it. */
static void event(struct ec_links *l)
{
	ec_monitor_kick(container_of(l, struct ec_master, links));
}

static const struct ec_links_ops links_ops = {
	.device = master_device,
	.changed = ec_carry_changed,
	.event = event,
};

static const struct ec_carry_ops carry_ops = {
	.queued = queued,
};

/* Service kicks slaves. */
static void queues_destroy(struct ec_master *m)
{
	ec_sessions_exit(&m->sessions);
	ec_bus_stop(&m->bus);
}

static void destroy(struct ec_master *m)
{
	WRITE_ONCE(m->base->stopping, true);
	ec_api_between_stop(m);
	ec_session_end(&m->sessions, NULL);
	ec_monitor_stop(m);
	ec_event_readers_exit(m);
	ec_mail_readers_exit(m);
	ec_record_readers_exit(m);
	ec_slave_devices_stop(&m->slave_devices);
	ec_eoe_stop(&m->eoe);
	ec_dc_exit(&m->dc);
	ec_dc_track_exit(&m->dc);
	queues_destroy(m);
	ec_api_destroy(m);
	ec_device_unregister(&m->links);
	ec_carry_exit(&m->carry);
	ec_links_exit(&m->links);
	ec_bus_exit(&m->bus);
	ec_log_flush(m->base, true);
	kvfree(m);
}

static struct ec_master *create(unsigned int index, const char *main, const char *backup,
				unsigned int debug)
{
	struct ec_master *m = kvzalloc(sizeof(*m), GFP_KERNEL);
	int ret;

	if (!m)
		return ERR_PTR(-ENOMEM);
	ec_base_init(m->base, index, debug);
	ec_event_readers_init(m);
	ec_eoe_init(&m->eoe);
	ec_mail_readers_init(m);
	ec_record_readers_init(m);
	m->sessions.base = m->base;
	m->sessions.links = &m->links;
	m->sessions.bus = &m->bus;
	m->sessions.dc = &m->dc;
	m->sessions.cycles = &m->cycles;
	ret = ec_links_init(&m->links, m->base, &links_ops, main, backup);
	if (ret)
		goto err_free;
	m->riders.links = &m->links;
	ret = ec_carry_init(&m->carry, &m->links, &carry_ops) ?:
	      ec_rider_register(&m->riders, &m->rider);
	if (ret)
		goto err;
	ec_cycles_init(&m->cycles, m->base, &m->carry, &m->riders, &m->dc);
	ret = ec_bus_init(&m->bus, m->base, &m->links, &bus_ops) ?:
	      ec_ring_heal_init(&m->bus, &m->riders) ?:
	      ec_sessions_init(&m->sessions, ec_session_again, ec_session_units);
	if (ret)
		goto err;
	ec_setup_init(&m->bus);
	ec_dc_init(&m->dc, m->base, &m->links, &m->bus, m->sessions.service);
	ret = ec_dc_track_init(&m->dc, &m->riders) ?: ec_api_create(m);
	if (ret)
		goto err;
	ret = ec_monitor_start(m);
	if (!ret)
		return m;
	destroy(m);
	return ERR_PTR(ret);

err:
	ec_dc_track_exit(&m->dc);
	ec_api_destroy(m);
	queues_destroy(m);
	ec_device_unregister(&m->links);
	ec_carry_exit(&m->carry);
	ec_links_exit(&m->links);
err_free:
	kvfree(m);
	return ERR_PTR(ret);
}

static int master_check_name(const char *list, const char *spec, unsigned int index)
{
	if (!spec || !*spec) {
		pr_err("EtherCAT: %s: entry %u is empty; give a MAC address, an interface name or sim0\n",
		       list, index);
		return -EINVAL;
	}
	if (ec_spec_is_valid(spec))
		return 0;
	if (strchr(spec, ':'))
		pr_err("EtherCAT: %s: \"%s\" is neither the MAC address of a device, as 00:11:22:33:44:55 (ff:ff:ff:ff:ff:ff: the first device), nor a PCI address, as 0000:01:00.0\n",
		       list, spec);
	else
		pr_err("EtherCAT: %s: \"%s\" cannot be an interface name (1 to %u characters, no slash, no space)\n",
		       list, spec, IFNAMSIZ - 1);
	return -EINVAL;
}

static bool names_have(const char *spec, char **names, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++)
		if (names[i] && *names[i] && ec_spec_same(spec, names[i]))
			return true;
	return false;
}

/* An empty entry: that master has no backup device. */
static int check_backups(char **main, unsigned int n_main, char **backup, unsigned int n_backup)
{
	unsigned int i;
	int ret;

	for (i = 0; i < n_backup; i++) {
		if (!backup[i] || !*backup[i])
			continue;
		ret = master_check_name("backup_devices", backup[i], i);
		if (ret)
			return ret;
		if (i >= n_main) {
			pr_err("EtherCAT: backup_devices: %s: there is no master %u; main_devices= has %u entries\n",
			       backup[i], i, n_main);
			return -EINVAL;
		}
		if (ec_spec_is_any(backup[i]) || ec_spec_is_any(main[i])) {
			pr_err("EtherCAT: backup_devices: master %u: with a backup device both ends of the ring need the name of their device, not ff:ff:ff:ff:ff:ff\n",
			       i);
			return -EINVAL;
		}
		if (!names_have(backup[i], main, n_main) && !names_have(backup[i], backup, i))
			continue;
		pr_err("EtherCAT: backup_devices: device %s is listed twice; each end of a ring needs its own\n",
		       backup[i]);
		return -EINVAL;
	}
	return 0;
}

/*
 * A name that can never work is refused before the first master is created: it would wait for its
 * device forever.
 */
static int check_names(char **main, unsigned int n_main, char **backup, unsigned int n_backup)
{
	unsigned int i;
	int ret;

	for (i = 0; i < n_main; i++) {
		ret = master_check_name("main_devices", main[i], i);
		if (ret)
			return ret;
		if (!names_have(main[i], main, i))
			continue;
		pr_err("EtherCAT: main_devices: device %s is listed twice; each master needs its own\n",
		       main[i]);
		return -EINVAL;
	}
	return check_backups(main, n_main, backup, n_backup);
}

/**
 * ec_masters_create() - create the masters the module parameters name
 * @main: main device of each: MAC address or device name
 * @n_main: how many
 * @backup: backup device of each, at the other end of its ring; "": none
 * @n_backup: how many
 * @debug: log level
 *
 * Context: Process. May sleep.
 * Return: 0; -EINVAL for invalid names or level; -ENOMEM, or another -errno.
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
		ec_cdev_add(m);
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
	struct ec_master *m;

	while ((m = ec_cdev_remove()))
		destroy(m);
}
