// SPDX-License-Identifier: GPL-2.0-only
#include <time.h>

#include "dev.h"
#include "out.h"

#define EPOCH_2000	946684800LL	/* seconds from 1970 to 2000 */

/* three averages, over 1, 10 and 60 s */
static void rates(const char *label, const char *key, const double *v, int decimals)
{
	out_array(key);
	out_text("      %-20s", label);
	for (int i = 0; i < ECT_RATES; i++)
		out_f("", v[i], " %6.*f", decimals, v[i]);
	out_end();
	out_text("\n");
}

static void byte_rates(const char *label, const char *key, const u32 *bytes)
{
	double kbyte[ECT_RATES];

	out_array(key);
	for (int i = 0; i < ECT_RATES; i++) {
		out_u("", bytes[i], NULL);
		kbyte[i] = bytes[i] / 1024.0;
	}
	out_end();
	out_text("      %-20s %6.1f %6.1f %6.1f\n", label, kbyte[0], kbyte[1], kbyte[2]);
}

static void count_rates(const char *label, const char *key, const u32 *v)
{
	double d[ECT_RATES] = { v[0], v[1], v[2] };

	rates(label, key, d, 0);
}

/* "%llu" is not the format of u64 everywhere */
static void big(const char *key, const char *fmt, u64 v)
{
	out_u(key, v, fmt, (unsigned long long)v);
}

static void counters(const struct ect_device *d)
{
	big("tx_frames", "      Tx frames:   %llu\n", d->tx_frames);
	big("tx_bytes", "      Tx bytes:    %llu\n", d->tx_bytes);
	big("rx_frames", "      Rx frames:   %llu\n", d->rx_frames);
	big("rx_bytes", "      Rx bytes:    %llu\n", d->rx_bytes);
}

static void all_rates(const struct ect_device *d)
{
	count_rates("Tx frame rate [1/s]:", "tx_frames_per_s", d->tx_frame_rate);
	byte_rates("Tx rate [KByte/s]:", "tx_bytes_per_s", d->tx_byte_rate);
	count_rates("Rx frame rate [1/s]:", "rx_frames_per_s", d->rx_frame_rate);
	byte_rates("Rx rate [KByte/s]:", "rx_bytes_per_s", d->rx_byte_rate);
}

static void device(const char *label, const struct ect_device *d)
{
	const u8 *a = d->address;
	bool attached = d->attached;
	char mac[18];

	snprintf(mac, sizeof(mac), "%02x:%02x:%02x:%02x:%02x:%02x", a[0], a[1], a[2], a[3], a[4],
		 a[5]);
	out_object(NULL);
	/* without a device: its name in main_devices= */
	out_str("mac", mac, "    %s: %s (", label, attached || !d->name[0] ? mac : d->name);
	out_bool("attached", attached, "%s)\n", attached ? "attached" : "waiting...");
	out_str("interface", d->name, NULL);
	out_bool("link_up", d->link_up, "      Link: %s\n", d->link_up ? "UP" : "DOWN");
	counters(d);
	big("tx_errors", "      Tx errors:   %llu\n", d->tx_errors);
	all_rates(d);
	out_u("slaves_responding", d->slaves, NULL);
	out_u("lost_frames", d->lost, NULL);
	out_u("late_frames", d->late, NULL);
	out_u("unmatched_frames", d->unmatched, NULL);
	out_u("foreign_frames", d->foreign, NULL);
	out_end();
}

static void sum(struct ect_device *c, const struct ect_device *d)
{
	c->tx_frames += d->tx_frames;
	c->tx_bytes += d->tx_bytes;
	c->rx_frames += d->rx_frames;
	c->rx_bytes += d->rx_bytes;
	c->lost += d->lost;
	c->late += d->late;
	c->unmatched += d->unmatched;
	c->foreign += d->foreign;
	for (int i = 0; i < ECT_RATES; i++) {
		c->tx_frame_rate[i] += d->tx_frame_rate[i];
		c->rx_frame_rate[i] += d->rx_frame_rate[i];
		c->tx_byte_rate[i] += d->tx_byte_rate[i];
		c->rx_byte_rate[i] += d->rx_byte_rate[i];
		c->loss_rate[i] += d->loss_rate[i];
	}
}

static void common(const struct ect_list *devices)
{
	struct ect_device c = { 0 };
	const struct ect_device *d;
	double loss[ECT_RATES];

	for (size_t i = 0; (d = ect_list_get(devices, i)); i++)
		sum(&c, d);
	for (int i = 0; i < ECT_RATES; i++)
		loss[i] = c.tx_frame_rate[i] ? 100.0 * c.loss_rate[i] / c.tx_frame_rate[i] : 0;
	out_object("common");
	out_text("    Common:\n");
	counters(&c);
	big("lost_frames", "      Lost frames: %llu\n", c.lost);
	all_rates(&c);
	count_rates("Loss rate [1/s]:", "lost_frames_per_s", c.loss_rate);
	rates("Frame loss [%]:", "frame_loss_percent", loss, 1);
	out_end();
}

static void number(const char *key, bool there, unsigned int value)
{
	if (there && value != ECT_NONE32)
		out_u(key, value, NULL);
	else
		out_null(key, NULL);
}

/* of both devices */
static void ring(const struct ect_master *m)
{
	static const char *const key[] = { "none", "unknown", "closed", "open" };
	bool open = m->ring == ECT_RING_OPEN;

	out_object("ring");
	out_str("state", m->ring < ARRAY_SIZE(key) ? key[m->ring] : "unknown", NULL);
	number("slave", open, m->ring_slave);
	number("port", open, m->ring_port);
	number("next", open, m->ring_next);
	out_bool("exchanged", m->ring_exchanged, NULL);
	number("turned", m->ring_turned, m->ring_turned - 1);
	out_end();
	if (m->ring == ECT_RING_NONE)
		return;
	out_text("  Ring: %s", m->ring < ARRAY_SIZE(key) ? key[m->ring] : "unknown");
	if (open && m->ring_slave == ECT_NONE32)
		out_text(" between the main device");
	else if (open && m->ring_port == ECT_NONE32)
		out_text(" between slave %u", m->ring_slave);
	else if (open)
		out_text(" between port %u of slave %u", m->ring_port, m->ring_slave);
	if (open && m->ring_next == ECT_NONE32)
		out_text(" and the backup device");
	else if (open)
		out_text(" and slave %u", m->ring_next);
	out_text("\n");
	if (m->ring_turned)
		out_text("  Wrong way round: slave %u; let its port 0 lead towards the main device\n",
			 m->ring_turned - 1);
	if (m->ring_exchanged)
		out_text("  Devices exchanged: the one configured as backup device is at port 0 of the first slave, and is the main device; exchange the cables or the two names\n");
}

/* a cycle of the kernel that is synchronized to the reference clock */
static void lock(const struct ect_master *m)
{
	static const char *const text[] = { "", "seeking", "locked", "holdover" };
	const char *key = cycle_lock_key(m->cycle_lock);

	if (!key) {
		out_null("cycle_lock", NULL);
		return;
	}
	out_str("cycle_lock", key, "    Cycle lock:        %s, ",
		text[m->cycle_lock]);
	out_i("phase_error_ns", m->phase_error, "phase error %d ns, ", m->phase_error);
	out_i("rate_ppb", m->rate_ppb, "rate %+d ppb, ", m->rate_ppb);
	out_u("lock_losses", m->lock_losses, "lock losses %u\n", m->lock_losses);
}

static void clocks(const struct ect_master *m)
{
	time_t s = (time_t)(m->app_time / 1000000000) + EPOCH_2000;
	char text[32];
	struct tm tm;

	out_object("dc");
	out_text("  Distributed clocks:\n");
	if (m->ref_clock >= 0)
		out_i("reference_clock", m->ref_clock, "    Reference clock:   Slave %d\n",
		      m->ref_clock);
	else
		out_null("reference_clock", "    Reference clock:   None\n");
	lock(m);
	big("reference_time_ns", "    DC reference time: %llu\n", m->dc_ref_time);
	big("application_time_ns", "    Application time:  %llu\n", m->app_time);
	if (gmtime_r(&s, &tm) && strftime(text, sizeof(text), "%Y-%m-%d %H:%M:%S", &tm))
		out_text("                       %s.%09llu\n", text,
			 (unsigned long long)m->app_time % 1000000000);
	out_end();
}

/* Frames of the active application, and how long they occupy the wire. */
static void cycle(const struct tool *t, const struct ect_master *m)
{
	out_object("cycle");
	out_u("interval_us", m->cycle_interval_us, NULL);
	out_u("datagrams", m->cycle_datagrams, NULL);
	out_u("frames", m->cycle_frames, NULL);
	out_u("wire_ns", m->cycle_wire_ns, NULL);
	out_u("last_frames", m->sent_frames, NULL);
	out_u("last_wire_ns", m->sent_wire_ns, NULL);
	out_u("acyclic_slack_ns", m->acyclic_slack_ns, NULL);
	out_u("acyclic_need_ns", m->acyclic_need_ns, NULL);
	out_u("late_cycles", m->late_cycles, NULL);
	out_u("late_cycles_per_s", m->late_per_s, NULL);
	out_end();
	if (!t->verbosity || !m->active)
		return;
	out_text("  Cycle: every %u us\n", m->cycle_interval_us);
	out_text("    All domains: %u datagram(s), %u frame(s), %.2f us of wire time\n",
		 m->cycle_datagrams, m->cycle_frames, m->cycle_wire_ns / 1000.0);
	out_text("    Last send:   %u frame(s), %.2f us of wire time\n", m->sent_frames,
		 m->sent_wire_ns / 1000.0);
	out_text("    Free for acyclic frames: %.2f us, minimum %.2f us%s\n",
		 m->acyclic_slack_ns / 1000.0, m->acyclic_need_ns / 1000.0,
		 m->acyclic_slack_ns < m->acyclic_need_ns ? " (not enough)" : "");
	out_text("    Cycles delayed by acyclic frames: %u (limit %u/s)\n", m->late_cycles,
		 m->late_per_s);
}

static const char *phase_text(unsigned int phase)
{
	static const char *const text[] = { "Waiting for device(s)...", "Idle", "Operation" };

	return phase < ARRAY_SIZE(text) ? text[phase] : "???";
}

/* --verbose */
static void more(struct dev *d, const struct ect_master *m, const struct ect_list *devices)
{
	const struct ect_device *one;

	out_text("  Module: %s, interface version %u\n", ect_version(d->h)->release,
		 ect_version(d->h)->interface);
	out_text("  Slaves responding: %u\n", m->slaves_responding);
	out_text("  Bus scan: number %u, %s, %u us, %llu frames\n", m->scan_count,
		 m->scan_busy ? "running" : "finished", m->scan_us,
		 (unsigned long long)m->scan_frames);
	for (size_t i = 0; (one = ect_list_get(devices, i)); i++)
		out_text("  Late frames, %s device: %llu\n", i ? "backup" : "main",
			 (unsigned long long)one->late);
	out_text("  Acyclic frames of a send: at most %u (module parameter max_acyclic)\n",
		 m->acyclic_max);
	out_text("  EEPROM images in memory: %llu bytes, limit %u\n",
		 (unsigned long long)m->sii_bytes, m->sii_limit);
	out_text("  Debug level: %u\n", m->debug_level);
}

static int show(const struct tool *t, struct dev *d)
{
	static const char *const phase_key[] = { "waiting", "idle", "operation" };
	static const char *const session_key[] = { "none", "reserved", "active", "detached" };
	const struct ect_device *one;
	struct ect_list *devices;
	struct ect_master m;

	if (dev_master(d, &m) || dev_devices(d, &devices))
		return 1;
	out_object(NULL);
	out_u("master", d->master, "Master%u\n", d->master);
	out_str("phase", m.phase < ARRAY_SIZE(phase_key) ? phase_key[m.phase] : "unknown",
		"  Phase: %s\n", phase_text(m.phase));
	out_bool("active", m.active, "  Active: %s\n", m.active ? "yes" : "no");
	out_str("session", m.session < ARRAY_SIZE(session_key) ? session_key[m.session] : "unknown",
		NULL);
	if (m.session == ECT_SESSION_DETACHED)
		out_text("  Session: detached, without application\n");
	out_u("slaves", m.slave_count, "  Slaves: %u\n", m.slave_count);
	out_text("  Ethernet devices:\n");
	out_array("devices");
	for (size_t i = 0; (one = ect_list_get(devices, i)); i++)
		device(i ? "Backup" : "Main", one);
	out_end();
	ring(&m);
	common(devices);
	out_u("frames_not_captured", m.not_captured, NULL);
	if (m.not_captured)
		out_text("    Frames not captured: %u\n", m.not_captured);
	clocks(&m);
	cycle(t, &m);
	out_u("slaves_responding", m.slaves_responding, NULL);
	out_bool("scan_busy", m.scan_busy, NULL);
	out_bool("list_held", m.held, NULL);
	if (*m.owner)
		out_str("owner", m.owner, NULL);
	else
		out_null("owner", NULL);
	out_u("scans", m.scan_count, NULL);
	out_u("scan_duration_us", m.scan_us, NULL);
	out_u("scan_frames", m.scan_frames, NULL);
	out_u("max_acyclic_frames", m.acyclic_max, NULL);
	out_u("sii_bytes", m.sii_bytes, NULL);
	out_u("max_sii_bytes", m.sii_limit, NULL);
	out_u("debug_level", m.debug_level, NULL);
	out_u("configs", m.config_count, NULL);
	out_u("domains", m.domain_count, NULL);
	out_str("module_release", ect_version(d->h)->release, NULL);
	if (t->verbosity > 0)
		more(d, &m, devices);
	ect_list_free(devices);
	out_end();
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	out_array("masters");
	ret = dev_each(t, false, show);
	out_end();
	return ret;
}

const struct cmd cmd_master = {
	.name = "master",
	.run = run,
	.args = "",
	.opts = "mv",
	.summary = "Show masters, their network interfaces and clocks",
	.help = "Rates are averages over 1, 10 and 60 seconds; 1 KByte is 1024 bytes. Times are\n"
		"nanoseconds since 2000-01-01 UTC. --verbose adds the last bus scan and the wire time\n"
		"at 100 Mbit/s, preamble and gap included, of a cycle with all domains and configured\n"
		"clock datagrams, and of the last send. Free for acyclic frames: wire time that a cycle\n"
		"leaves for mailboxes, registers and states, and the minimum that the shortest frame\n"
		"needs. A longer acyclic frame delays a cycle. Frames not captured: the buffer of a\n"
		"capture program was full.\n",
	.json = "masters[]: master, phase (waiting, idle, operation), active, session (none,\n"
		"reserved, active, detached), slaves,\n"
		"devices[] (mac, attached, interface, link_up, tx_frames, tx_bytes, rx_frames,\n"
		"rx_bytes, tx_errors, tx_frames_per_s[], tx_bytes_per_s[], rx_frames_per_s[],\n"
		"rx_bytes_per_s[], lost_frames, late_frames, unmatched_frames, foreign_frames),\n"
		"common (the sums, lost_frames_per_s[], frame_loss_percent[]), dc (reference_clock,\n"
		"cycle_lock (seeking, locked, holding; null: not synchronized to it), phase_error_ns,\n"
		"rate_ppb, lock_losses (with cycle_lock), reference_time_ns,\n"
		"application_time_ns), cycle (interval_us, datagrams, frames, wire_ns, last_frames,\n"
		"last_wire_ns, acyclic_slack_ns, acyclic_need_ns, late_cycles, late_cycles_per_s),\n"
		"frames_not_captured, slaves_responding, scan_busy, list_held, owner (the application,\n"
		"or null), scans,\n"
		"scan_duration_us, scan_frames, max_acyclic_frames (of a send), sii_bytes (EEPROM\n"
		"images in memory), max_sii_bytes, debug_level, configs, domains, module_release",
	.flags = CMD_HISTORIC,
};
