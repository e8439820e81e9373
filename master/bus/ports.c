// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include <linux/module.h>
#include <linux/slab.h>
#include <linux/sysfs.h>
#include "../link/links.h"
#include "../wire/port_text.h"
#include "../carry/xfer.h"
#include "border.h"
#include "graph.h"
#include "ports.h"
#include "ring_exit.h"
#include "ring_heal.h"
#include "slave.h"
#include "trial.h"

#define VAIN_MAX	4	/* trials that failed: up to 1.6 s until the next one */
#define STABLE_NS	(100 * NSEC_PER_MSEC)	/* of link without loss, then a port is tried */
#define UNKNOWN_NS	(2 * (u64)NSEC_PER_SEC)	/* of a new slave, which may get a configuration */
#define WAIT_MIN_MS	1000	/* between trials at a port where no slave replies; doubles */
#define WAIT_MAX_MS	60000
#define LOSSES		3	/* of a port within LOSS_NS, then it stays closed for longer */
#define LOSS_NS		(10 * (u64)NSEC_PER_SEC)
#define LOSS_WAIT_MAX_S	60

static bool closes = true;

static int set_loops(const char *value, const struct kernel_param *kp)
{
	if (sysfs_streq(value, "closed"))
		closes = true;
	else if (sysfs_streq(value, "auto"))
		closes = false;
	else
		return -EINVAL;
	return 0;
}

static int get_loops(char *buf, const struct kernel_param *kp)
{
	return sysfs_emit(buf, "%s\n", closes ? "closed" : "auto");
}

static const struct kernel_param_ops loops_ops = {
	.set = set_loops,
	.get = get_loops,
};

module_param_cb(loops, &loops_ops, NULL, 0444);
MODULE_PARM_DESC(loops,
		 "Ports without a known slave while process data run: closed (default) or auto");

/**
 * ec_ports_guard() - process data begin or end
 * @bus: bus
 * @on: ports behind which nothing is known are closed from now on; else all open by themselves
 *
 * The monitor writes the registers.
 *
 * Context: Process. May sleep.
 */
void ec_ports_guard(struct ec_bus *bus, bool on)
{
	if (on) {
		down_read(&bus->topo);
		ec_for_each_slave(s, bus)
			WRITE_ONCE(s->ports.settled, true);
		up_read(&bus->topo);
	}
	WRITE_ONCE(bus->guarded, on && closes);
	if (!on)
		ec_border_clear(&bus->border);
	if (bus->ops && bus->ops->wake)
		bus->ops->wake(bus);
}

/**
 * ec_ports_are_guarded() - are ports closed behind which nothing is known?
 * @bus: bus
 *
 * Context: Any.
 * Return: true while process data run, but not in a ring, which ends at a port without a slave.
 */
bool ec_ports_are_guarded(const struct ec_bus *bus)
{
	return READ_ONCE(bus->guarded) && !READ_ONCE(bus->down) && ec_links_n(bus->links) == 1;
}

static u16 dl_of(const struct ec_slave *s)
{
	return s->dl_seen ?: s->dl_status;
}

static bool is_open(const struct ec_slave *s, unsigned int port)
{
	return ec_graph_open_ports(dl_of(s)) & BIT(port);
}

static bool has_port(const struct ec_slave *s, unsigned int port)
{
	return ec_slave_port_type(s, port) >= 2;
}

/* The value for a port of an ordinary slave while process data run. */
static u8 wanted_loop(const struct ec_slave *s, unsigned int port)
{
	if (!port || port == s->graph.upstream || !has_port(s, port))
		return EC_LOOP_AUTO;
	/* one that has closed itself would open by a frame from behind it, or by the next write */
	if (s->graph.at[port])
		return is_open(s, port) ? EC_LOOP_AUTO_CLOSE : EC_LOOP_CLOSED;
	/* frames leave there although no slave is known: closing it could cut some off */
	return is_open(s, port) ? EC_LOOP_AUTO : EC_LOOP_CLOSED;
}

static u8 wanted_loops(const struct ec_slave *s)
{
	unsigned int p;
	u8 loops = 0;

	if (!ec_ports_are_guarded(s->bus) || s->ports.fixed)
		return ec_ring_exit_loops(s, ec_ring_heal_loops(s, 0));
	for (p = 0; p < EC_MAX_PORT; p++)
		loops |= wanted_loop(s, p) << 2 * p;
	return ec_ring_exit_loops(s, loops);
}

static bool may_write(const struct ec_slave *s)
{
	return !READ_ONCE(s->reply.silent) && READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED;
}

static void note_written(struct ec_slave *s, const struct ec_dg *dg, u8 wrote, const u8 *is)
{
	/* it may have been executed although its reply is lost */
	s->ports.unsure = dg[0].err || dg[0].wkc != 1 || dg[1].err || dg[1].wkc != 1;
	if (s->ports.unsure)
		return;
	s->ports.control = is[0];
	s->ports.loops = is[1];
	if (is[1] == wrote || !wrote)
		return;
	s->ports.fixed = true;
	ec_slave_warn(s, "register 0x0101 keeps 0x%02x, not 0x%02x: %s\n", is[1], wrote,
		      ec_links_n(s->bus->links) == 1 ?
		      "slaves connected here during operation get process data at once" :
		      "a loose contact here costs a frame each time it changes");
}

static bool has_to_write(const struct ec_slave *s)
{
	return (wanted_loops(s) != s->ports.loops || s->ports.unsure) && may_write(s);
}

/* Slaves whose loop control is not what it has to be. */
static unsigned int collect(struct ec_bus *bus, struct ec_slave **list, unsigned int n)
{
	unsigned int k = 0;

	ec_for_each_slave(s, bus)
		if (k < n && has_to_write(s))
			list[k++] = s;
	return k;
}

/* A port that has opened meanwhile must not be closed: a slave may be behind it. */
static void read_ports(struct ec_bus *bus, struct ec_slave **list, unsigned int n,
		       struct ec_dg *dg, u8 (*v)[3])
{
	unsigned int i;

	for (i = 0; i < n; i++)
		dg[i] = EC_FPRD(list[i]->station, EC_REG_DL_STATUS, 2, v[i]);
	ec_xfer(bus->links, dg, n);
	for (i = 0; i < n; i++)
		if (!dg[i].err && dg[i].wkc == 1)
			list[i]->dl_seen = get_unaligned_le16(v[i]);
}

static void write_ports(struct ec_bus *bus, struct ec_slave **list, unsigned int n,
			struct ec_dg *dg, u8 (*v)[3])
{
	unsigned int i;

	for (i = 0; i < n; i++) {
		v[i][2] = wanted_loops(list[i]);
		dg[2 * i] = EC_FPWR(list[i]->station, EC_REG_DL_LOOPS, 1, &v[i][2]);
		/* else the read could be executed before a repeated write */
		dg[2 * i].pair = true;
		dg[2 * i + 1] = EC_FPRD(list[i]->station, EC_REG_DL_CONTROL, 2, v[i]);
	}
	ec_xfer(bus->links, dg, 2 * n);
	for (i = 0; i < n; i++)
		note_written(list[i], &dg[2 * i], v[i][2], v[i]);
}

/* Write loop control where it is not what it has to be. */
static void write_loops(struct ec_bus *bus)
{
	struct ec_slave **list;
	unsigned int n = 0;
	struct ec_dg *dg;
	u8 (*v)[3];

	ec_for_each_slave(s, bus)
		n += has_to_write(s);
	if (!n)
		return;
	list = kvcalloc(n, sizeof(*list), GFP_KERNEL);
	dg = kvcalloc(2 * n, sizeof(*dg), GFP_KERNEL);
	v = kvcalloc(n, sizeof(*v), GFP_KERNEL);
	if (list && dg && v) {
		n = collect(bus, list, n);
		read_ports(bus, list, n, dg, v);
		ec_ring_heal_open(bus);
		/* those that still have to be written */
		n = collect(bus, list, n);
		write_ports(bus, list, n, dg, v);
	}
	kvfree(list);
	kvfree(dg);
	kvfree(v);
}

static bool is_door(const struct ec_slave *s, unsigned int port)
{
	u16 dl = dl_of(s);

	return port && port != s->graph.upstream && !s->graph.at[port] && has_port(s, port) &&
	       dl & EC_DLS_LINK(port) && dl & EC_DLS_LOOP(port) &&
	       (s->ports.loops >> 2 * port & 3) == EC_LOOP_CLOSED;
}

static bool has_door(const struct ec_slave *s)
{
	unsigned int p;

	for (p = 1; p < EC_MAX_PORT; p++)
		if (is_door(s, p))
			return true;
	return false;
}

/* One that is new may be a slave at whose port a group is expected, which shows soon. */
static u64 stable_ns(const struct ec_slave *s, unsigned int port)
{
	const struct ec_bus *bus = s->bus;
	bool attached = bus->ops && bus->ops->attached && bus->ops->attached(s);

	return attached || READ_ONCE(s->ports.settled) || !ec_border_may_be(s->bus, 0, port) ?
		STABLE_NS : UNKNOWN_NS;
}

/* Has the link of a door been there without loss? Its counters show losses in between. */
static bool is_stable(struct ec_slave *s, unsigned int port, u8 lost, u64 now)
{
	struct ec_door *d = &s->ports.door[port];

	if (d->link_ns && lost != s->ports.lost[port]) {
		ec_ports_note_loss(s, port, false);
		d->link_ns = 0;
	}
	s->ports.lost[port] = lost;
	d->link_ns = d->link_ns ?: now;
	if (xchg(&s->ports.let_in[port], false))
		d->next_ns = 0;
	if (READ_ONCE(s->ports.fast) & BIT(port) && !d->wait_ms)
		return now >= d->next_ns;
	return now >= d->next_ns &&
	       now - d->link_ns >= max(stable_ns(s, port),
				       s->ports.loss[port].wait_s * (u64)NSEC_PER_SEC);
}

/* The port is in use, or has no link any more. */
static void forget_door(struct ec_slave *s, unsigned int port)
{
	struct ec_door *d = &s->ports.door[port];

	if (d->link_ns && !s->graph.at[port])
		ec_ports_note_loss(s, port, false);
	if (d->kept)
		ec_border_forget(s->bus, s->device, port);
	*d = (struct ec_door){ 0 };
}

/* The port stays closed: reported once, and tried again ever less often. */
static void note_closed(struct ec_slave *s, unsigned int port, const struct ec_behind *is)
{
	bool device = ec_port_text(is->kept)->device, differs = false;
	struct ec_door *d = &s->ports.door[port];

	if (device)
		differs = ec_border_note(s->bus, s->device, port, is);
	else if (d->kept)
		ec_border_forget(s->bus, s->device, port);
	d->wait_ms = clamp_t(u32, 2 * d->wait_ms, WAIT_MIN_MS, WAIT_MAX_MS);
	d->next_ns = ktime_get_ns() + d->wait_ms * (u64)NSEC_PER_MSEC;
	if (d->kept == is->kept && !differs)
		return;
	/* the first one says more */
	if (d->kept == EC_PORT_SWALLOWS && is->kept == EC_PORT_NO_REPLY)
		return;
	WRITE_ONCE(d->kept, is->kept);
	ec_slave_report(s, EC_EVENT_PORT_KEPT, port, d->kept, 0, 0, 0, is->vendor, is->product,
			is->slaves);
}

/* What a trial says of a port behind which no device was found that could be listed. */
static u32 why_kept(int ret)
{
	return ret == -ENXIO ? EC_PORT_NO_REPLY : ret == -EXDEV ? EC_PORT_WRONG_WAY :
	       ret == -EOPNOTSUPP ? EC_PORT_LOOPS : ret == -ENOBUFS ? EC_PORT_NO_TIME :
	       ret == -EDOM ? EC_PORT_EARLY : 0;
}

static bool try_door(struct ec_slave *s, unsigned int port)
{
	struct ec_door *d = &s->ports.door[port];
	struct ec_behind is = { 0 };
	int ret = ec_trial(s, port, &is);

	if (ret > 0) {
		ec_border_forget(s->bus, s->device, port);
		*d = (struct ec_door){ 0 };
		ec_slave_dbg(s, 1, "port %u: %d new slave(s), made harmless before process data reached them\n",
			     port, ret);
		return true;
	}
	is.kept = is.kept ?: why_kept(ret);
	if (is.kept)
		note_closed(s, port, &is);
	else
		d->next_ns = ktime_get_ns() + (STABLE_NS << min_t(u32, d->vain, VAIN_MAX));
	d->vain = is.kept ? 0 : min(d->vain + 1, VAIN_MAX);
	if (ret == -ENOLINK)
		d->link_ns = 0;
	ec_slave_dbg(s, 1, "trial at port %u: %d\n", port, ret);
	return false;
}

static bool work_at_doors_of(struct ec_slave *s)
{
	u64 now = ktime_get_ns();
	u8 lost[EC_MAX_PORT];
	unsigned int p;

	for (p = 1; p < EC_MAX_PORT; p++)
		if (s->ports.doors && !is_door(s, p))
			forget_door(s, p);
	s->ports.doors = has_door(s);
	if (!s->ports.doors || ec_xfer_fprd(s->bus->links, s->station, EC_REG_ERR_LOST(0), lost,
					    sizeof(lost)))
		return false;
	for (p = 1; p < EC_MAX_PORT; p++)
		if (is_door(s, p) && is_stable(s, p, lost[p], now) && try_door(s, p))
			return true;
	return false;
}

/* Forget why ports wait: what kept them closed may be repaired. */
static void forget_waits(struct ec_bus *bus)
{
	unsigned int p;

	ec_for_each_slave(s, bus) {
		memset(s->ports.loss, 0, sizeof(s->ports.loss));
		for (p = 0; p < EC_MAX_PORT; p++) {
			s->ports.door[p].next_ns = 0;
			s->ports.door[p].wait_ms = 0;
			WRITE_ONCE(s->ports.door[p].kept, 0);
		}
	}
}

/* Check the doors; at most one is opened in a pass, as positions change by it. */
static enum ec_ports_result work_at_doors(struct ec_bus *bus)
{
	enum ec_ports_result result = EC_PORTS_QUIET;

	ec_for_each_slave(s, bus) {
		if (work_at_doors_of(s))
			return EC_PORTS_FOUND;
		if (s->ports.doors)
			result = EC_PORTS_DOOR;
	}
	return result;
}

/**
 * ec_ports_work() - bring loop control up to date, and look behind ports that have got a link
 * @bus: bus
 * @scanned: the list is that of the slaves which reply now: positions are certain
 * @event: a slave has shown the event of its DL status
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: whether slaves were let in, or another look is due soon.
 */
enum ec_ports_result ec_ports_work(struct ec_bus *bus, bool scanned, bool event)
{
	bool soon;

	ec_ring_exit_look(bus);
	soon = ec_ring_heal_look(bus, event);
	write_loops(bus);
	bus->lost_look_ns = ktime_get_ns();
	if (xchg(&bus->retry, false))
		forget_waits(bus);
	if (scanned && ec_ports_are_guarded(bus))
		return work_at_doors(bus);
	return soon ? EC_PORTS_DOOR : EC_PORTS_QUIET;
}

/**
 * ec_ports_note_loss() - a port has lost its link
 * @s: slave
 * @port: its port
 * @open: it was open
 *
 * A contact that is lost again and again is left alone for a while.
 *
 * Context: The monitor thread.
 */
void ec_ports_note_loss(struct ec_slave *s, unsigned int port, bool open)
{
	struct ec_loss *l = &s->ports.loss[port];
	u64 now = ktime_get_ns();

	if (!ec_ports_are_guarded(s->bus) || READ_ONCE(s->ports.fast) & BIT(port))
		return;
	if (now - l->since_ns > LOSS_NS + l->wait_s * (u64)NSEC_PER_SEC)
		*l = (struct ec_loss){ .since_ns = now };
	l->n = min(l->n + 1, LOSSES);
	if (l->n < LOSSES)
		return;
	l->since_ns = now;
	if (l->wait_s) {
		l->wait_s = open ? min(2 * l->wait_s, LOSS_WAIT_MAX_S) : l->wait_s;
		return;
	}
	l->wait_s = 1;
	ec_slave_report(s, EC_EVENT_PORT_KEPT, port, EC_PORT_LOSSES, LOSSES,
			LOSS_NS / NSEC_PER_SEC, LOSS_WAIT_MAX_S);
}

/**
 * ec_ports_kept() - why a port is closed although it has a link
 * @s: slave
 * @port: its port
 * @wait_s: result: it opens after so many seconds of link without loss
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: EC_PORT_*.
 */
u32 ec_ports_kept(const struct ec_slave *s, unsigned int port, u32 *wait_s)
{
	u8 kept = READ_ONCE(s->ports.door[port].kept);

	ec_bus_assert_stays(s->bus);
	*wait_s = 0;
	if (!ec_ports_are_guarded(s->bus) || !is_door(s, port))
		return EC_PORT_NOT_KEPT;
	if (kept)
		return kept;
	*wait_s = READ_ONCE(s->ports.loss[port].wait_s);
	return *wait_s ? EC_PORT_LOSSES : EC_PORT_NOT_KEPT;
}

/**
 * ec_ports_retry() - try ports that wait at once
 * @bus: bus
 *
 * Context: Any.
 */
void ec_ports_retry(struct ec_bus *bus)
{
	WRITE_ONCE(bus->retry, true);
}

/**
 * ec_ports_let_in() - a user lets the device behind a closed port in
 * @s: slave
 * @port: its port
 * @what: identity of the device that the user has seen there
 *
 * The monitor tries the port at once.
 *
 * Context: Topo held.
 * Return: 0; -ENOENT: no device is kept behind the port; -ESTALE: it is another one.
 */
int ec_ports_let_in(struct ec_slave *s, unsigned int port, const struct ec_behind *what)
{
	u32 wait_s;
	int ret;

	lockdep_assert_held(&s->bus->topo);
	if (!ec_port_text(ec_ports_kept(s, port, &wait_s))->device)
		return -ENOENT;
	ret = ec_border_let_in(s->bus, s->device, port, what);
	if (ret)
		return ret;
	WRITE_ONCE(s->ports.let_in[port], true);
	if (s->bus->ops && s->bus->ops->wake)
		s->bus->ops->wake(s->bus);
	return 0;
}

/**
 * ec_ports_set_fast() - which ports are opened as soon as they have a link
 * @s: slave
 * @ports: a bit each; a contact that bounces there costs frames
 *
 * Context: Process.
 */
void ec_ports_set_fast(struct ec_slave *s, u8 ports)
{
	WRITE_ONCE(s->ports.fast, ports);
}

/**
 * ec_ports_open_all() - let all ports open by themselves: the next master finds the whole bus
 * @bus: bus
 *
 * Context: The monitor thread, at its end.
 */
void ec_ports_open_all(struct ec_bus *bus)
{
	WRITE_ONCE(bus->guarded, false);
	bus->exit.device = 0;
	ec_ring_heal_forget(bus);
	write_loops(bus);
}
