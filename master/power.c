// SPDX-License-Identifier: GPL-2.0-only
/*
 * Reboot and suspend. A reboot takes the slaves out of OP while process data and network card
 * still work; a panic and emergency_restart() call no notifier that may sleep, so the watchdogs
 * of the slaves do it then. A suspend is refused while an application has a master; an idle
 * master sends no frame until the computer resumes, then it scans the bus.
 */
#include <linux/delay.h>
#include <linux/jiffies.h>
#include <linux/ktime.h>
#include <linux/notifier.h>
#include <linux/reboot.h>
#include <linux/suspend.h>
#include <linux/workqueue.h>
#include "boundary/cdev.h"
#include "boundary/master.h"
#include "bus/bus_list.h"
#include "bus/slave.h"
#include "carry/xfer.h"
#include "mailbox/foe.h"
#include "monitor.h"
#include "power.h"
#include "session/detached.h"

#define PREOP_MS	2000	/* for the slaves' workers */
#define INIT_MS		500	/* for slaves that have not followed them */
#define NAMES_MS	500	/* to find the slaves that stay */
#define LIMIT_MS	4000	/* for all masters, also on a broken bus */
#define FILE_MS		30000	/* more, for files that are written to slaves */
#define FILE_POLL_MS	10
#define PAUSE_MS	10000	/* until the monitor has ended a scan */

#define MISSING		BIT(8)	/* besides AL states: a slave does not reply */

/*
 * A master that takes its slaves down. A worker does that, as the caller of reboot(2) may be
 * killed: a killed caller does not wait for its frames.
 */
struct descent {
	struct work_struct work;
	struct ec_master *m;
	const char *what;
	bool file;	/* all is done but for files that are written to slaves */
};

static struct descent descents[EC_MAX_MASTERS];
static atomic_t n_descents;
static DECLARE_WAIT_QUEUE_HEAD(over);

/* slaves that do not leave SAFEOP or OP */
struct stay {
	unsigned int n;
	unsigned int position;	/* of the first one */
	u8 state;		/* AL state of it, 0: it does not reply */
};

/* From now on no slave is brought beyond PREOP. Return: how many are beyond it. */
static unsigned int request_preop(struct ec_master *m)
{
	unsigned int n = 0;

	WRITE_ONCE(m->bus.down, true);
	down_read(&m->bus.topo);
	ec_for_each_slave(s, &m->bus) {
		bool beyond = READ_ONCE(s->al.status) & EC_AL_BEYOND_PREOP;

		n += beyond;
		if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED ||
		    (!beyond && !(READ_ONCE(s->al.requested) & EC_AL_BEYOND_PREOP)))
			continue;
		ec_slave_request_anew(s, EC_AL_PREOP, 0);
	}
	up_read(&m->bus.topo);
	return n;
}

/* How many slaves have to reply; @silent: those that do not any more. */
static unsigned int replying(struct ec_master *m, bool silent)
{
	unsigned int n = 0;

	down_read(&m->bus.topo);
	ec_for_each_slave(s, &m->bus)
		n += silent ? READ_ONCE(s->reply.silent) :
			      READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED;
	up_read(&m->bus.topo);
	return n;
}

/* States beyond PREOP on the bus, known slaves or not, and MISSING. */
static unsigned int beyond_preop(struct ec_master *m)
{
	u8 al[2] = { 0, 0 };
	struct ec_dg dg = EC_DG(EC_CMD_BRD, 0, EC_REG_AL_STATUS, 2, al);

	if (ec_xfer_urgent(&m->links, &dg, 1) || dg.wkc < replying(m, false))
		return MISSING;
	return al[0] & EC_AL_BEYOND_PREOP;
}

/* Wait for beyond_preop() to return 0: up to @ms, while a link is up. Return: its result. */
static unsigned int wait_down(struct ec_master *m, unsigned int ms)
{
	u64 end = ktime_get_ns() + ms * (u64)NSEC_PER_MSEC;
	unsigned int states;

	while ((states = beyond_preop(m)) && ktime_get_ns() < end && ec_links_is_up(&m->links))
		usleep_range(500, 1000);
	return states;
}

/*
 * The bus as a whole, so that it reaches slaves that no worker has. No acknowledge: a slave with
 * device emulation would show it as an error, and INIT ends an error of most others.
 */
static void broadcast_init(struct ec_master *m)
{
	u8 control[2] = { EC_AL_INIT, 0 };
	struct ec_dg dg = EC_DG(EC_CMD_BWR, 0, EC_REG_AL_CONTROL, 2, control);

	ec_xfer_urgent(&m->links, &dg, 1);
}

/* How many slaves a file is written to; @position: of the first one. */
static unsigned int written(struct ec_master *m, unsigned int *position)
{
	unsigned int n = 0;

	down_read(&m->bus.topo);
	ec_for_each_slave(s, &m->bus)
		if (ec_foe_writes(&s->mbox) && !n++)
			*position = s->position;
	up_read(&m->bus.topo);
	return n;
}

/* INIT would end a file that is written to a slave, and leave it without firmware. */
static void init_others(struct ec_master *m)
{
	u64 end = ktime_get_ns() + INIT_MS * (u64)NSEC_PER_MSEC;
	u8 control[2] = { 0 };
	struct ec_slave *s;
	unsigned int i;

	for (i = 0; ktime_get_ns() < end && (s = ec_bus_slave(&m->bus, i)); i++) {
		/* not each slave stack takes INIT as an acknowledge */
		control[0] = s->emulation ? EC_AL_INIT : EC_AL_INIT | EC_AL_ERROR;
		if (READ_ONCE(s->al.status) & EC_AL_BEYOND_PREOP && !ec_foe_writes(&s->mbox))
			ec_xfer_fpwr(s->bus->links, s->station, EC_REG_AL_CONTROL, control,
				     sizeof(control));
		ec_slave_unref(s);
	}
}

/* AL state of a slave that was beyond PREOP; PREOP also when it is not worth a message. */
static u8 state_of(struct ec_slave *s)
{
	u8 b[2];

	/* its AL state is not known */
	if (READ_ONCE(s->reply.silent))
		return 0;
	if (!(READ_ONCE(s->al.status) & EC_AL_BEYOND_PREOP))
		return EC_AL_PREOP;
	if (ec_xfer_fprd(s->bus->links, s->station, EC_REG_AL_STATUS, b, sizeof(b)))
		return 0;
	return b[0] & EC_AL_STATE_MASK;
}

static void find_stays(struct ec_master *m, struct stay *stay)
{
	u64 end = ktime_get_ns() + NAMES_MS * (u64)NSEC_PER_MSEC;
	struct ec_slave *s;
	unsigned int i;
	u8 state;

	for (i = 0; ktime_get_ns() < end && (s = ec_bus_slave(&m->bus, i)); i++) {
		state = state_of(s);
		if ((!state || state & EC_AL_BEYOND_PREOP) && !stay->n++) {
			stay->position = i;
			stay->state = state;
		}
		ec_slave_unref(s);
	}
}

static void report_stays(struct ec_master *m, const char *what, unsigned int states)
{
	struct stay stay = { };

	find_stays(m, &stay);
	if (stay.n && stay.state)
		ec_warn(m, "%s: slave %u stays in %s, %u slave(s) in all; their watchdogs have to switch off their outputs\n",
			what, stay.position, ec_al_state_name(stay.state), stay.n);
	else if (stay.n)
		ec_warn(m, "%s: slave %u does not reply, %u slave(s) in all; their watchdogs have to switch off their outputs\n",
			what, stay.position, stay.n);
	else if (states & EC_AL_BEYOND_PREOP)
		ec_warn(m, "%s: a slave that was not scanned stays in SAFEOP or OP; its watchdog has to switch off its outputs\n",
			what);
	else
		ec_info(m, "%s: no slave in SAFEOP or OP, but some do not reply\n", what);
}

static void power_take_down(struct ec_master *m, const char *what)
{
	u64 t0 = ktime_get_ns();
	unsigned int n = request_preop(m), states, position;

	states = ec_links_is_up(&m->links) ? wait_down(m, PREOP_MS) : 0;
	if (states & EC_AL_BEYOND_PREOP && ec_links_is_up(&m->links)) {
		if (written(m, &position))
			init_others(m);
		else
			broadcast_init(m);
		states = wait_down(m, INIT_MS);
	}
	if (!ec_links_is_up(&m->links) && n)
		ec_warn(m, "%s: no link to %u slave(s) in SAFEOP or OP; their watchdogs have to switch off their outputs\n",
			what, n);
	else if (states || replying(m, true))
		report_stays(m, what, states);
	else if (n)
		ec_info(m, "%s: %u slave(s) taken out of SAFEOP and OP in %llu ms\n", what, n,
			div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC));
	else
		ec_info(m, "%s: no slave in SAFEOP or OP\n", what);
}

/* Slaves that a file is written to stay in their state meanwhile. */
static void await_files(struct descent *d)
{
	struct ec_master *m = READ_ONCE(d->m);
	const char *what = READ_ONCE(d->what);
	unsigned int position, n = written(m, &position);
	u64 t0 = ktime_get_ns(), end = t0 + FILE_MS * (u64)NSEC_PER_MSEC;

	if (!n)
		return;
	WRITE_ONCE(d->file, true);
	ec_warn(m, "%s: waiting up to %u s for the file that is written to slave %u, %u slave(s) in all; do not switch off\n",
		what, FILE_MS / 1000, position, n);
	while ((n = written(m, &position)) && ktime_get_ns() < end)
		msleep(FILE_POLL_MS);
	if (n)
		ec_warn(m, "%s: file of slave %u not complete after %u s, %u slave(s) in all; write it again, since firmware may be incomplete\n",
			what, position, FILE_MS / 1000, n);
	else
		ec_info(m, "%s: no file is written any more after %llu ms\n", what,
			div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC));
	/* init_others() has left them out, and slaves that were not scanned */
	if (ec_links_is_up(&m->links) && beyond_preop(m) & EC_AL_BEYOND_PREOP)
		broadcast_init(m);
	WRITE_ONCE(d->file, false);
}

static void descent_ends(void)
{
	if (atomic_dec_and_test(&n_descents))
		wake_up_all(&over);
}

static void descend(struct work_struct *work)
{
	struct descent *d = container_of(work, struct descent, work);

	power_take_down(READ_ONCE(d->m), READ_ONCE(d->what));
	await_files(d);
	descent_ends();
}

static bool wait_over(unsigned int ms)
{
	return wait_event_timeout(over, !atomic_read(&n_descents), msecs_to_jiffies(ms));
}

static bool any_file(void)
{
	unsigned int i;

	for (i = 0; i < ec_cdev_count(); i++)
		if (READ_ONCE(descents[i].file))
			return true;
	return false;
}

/**
 * ec_power_down() - take all slaves of all masters out of SAFEOP and OP, for good
 * @what: word for the log, such as "reboot"; stays
 *
 * Applications continue their cycles, but no slave gets beyond PREOP any more. Files that are
 * written to slaves have time to end. May be called again, also at the same time.
 *
 * Context: Process. Sleeps, at most 4 s for all masters, and 30 s more for files.
 */
void ec_power_down(const char *what)
{
	unsigned int i;

	for (i = 0; i < ec_cdev_count(); i++) {
		struct descent *d = &descents[i];

		WRITE_ONCE(d->m, ec_cdev_master(i));
		WRITE_ONCE(d->what, what);
		atomic_inc(&n_descents);
		if (!queue_work(system_unbound_wq, &d->work))
			descent_ends();
	}
	if (wait_over(LIMIT_MS) || (any_file() && wait_over(FILE_MS + INIT_MS)))
		return;
	for (i = 0; i < ec_cdev_count(); i++)
		if (work_busy(&descents[i].work))
			ec_warn(ec_cdev_master(i),
				"%s: continues after %u ms without an answer of the bus\n", what,
				LIMIT_MS);
}

/*
 * A session without an application has no owner; neither has one whose process has left its file to
 * another.
 */
static void refuse(struct ec_master *m)
{
	char who[64];

	if (ec_session_owner_text(&m->sessions, who, sizeof(who)))
		ec_warn(m, "suspend refused: the master is in use by %s; stop it first\n", who);
	else if (ec_detached_runs(&m->sessions))
		ec_warn(m, "suspend refused: the bus runs without an application ('ethercat run'); end that with 'ethercat stop'\n");
	else if (READ_ONCE(m->sessions.session))
		ec_warn(m, "suspend refused: a detached session is active; end it with \"ethercat release\"\n");
	else
		ec_warn(m, "suspend refused: the master changes its device; try again\n");
}

/* A slave whose firmware may be in transfer must not lose its master. */
static bool in_boot(struct ec_master *m)
{
	unsigned int position = 0;
	bool found = false;

	down_read(&m->bus.topo);
	ec_for_each_slave(s, &m->bus) {
		found = READ_ONCE(s->al.requested) == EC_AL_BOOT;
		position = s->position;
		if (found)
			break;
	}
	up_read(&m->bus.topo);
	if (found)
		ec_warn(m, "suspend refused: slave %u is in BOOT; end the firmware update and request PREOP first\n",
			position);
	return found;
}

static bool file_written(struct ec_master *m)
{
	unsigned int position;

	if (!written(m, &position))
		return false;
	ec_warn(m, "suspend refused: a file is written to slave %u; wait for its end\n",
		position);
	return true;
}

static bool eeprom_written(struct ec_master *m)
{
	if (!atomic_read(&m->bus.writes))
		return false;
	ec_warn(m, "suspend refused: the EEPROM of a slave is being written; wait for its end\n");
	return true;
}

static void resume(struct ec_master *m)
{
	WRITE_ONCE(m->pause, false);
	ec_sessions_resume(&m->sessions);
	ec_monitor_kick(m);
}

static int put_to_sleep(struct ec_master *m)
{
	if (ec_sessions_pause(&m->sessions, "sleeps with the computer")) {
		refuse(m);
		return -EBUSY;
	}
	/* a slave that is slow is no reason to refuse: all of them are read again */
	if (file_written(m) || eeprom_written(m) || in_boot(m) ||
	    ec_bus_wait_scan(&m->bus) == -EINTR) {
		ec_sessions_resume(&m->sessions);
		return -EBUSY;
	}
	WRITE_ONCE(m->pause, true);
	ec_monitor_kick(m);
	if (wait_event_timeout(m->bus.settled, READ_ONCE(m->paused), msecs_to_jiffies(PAUSE_MS))) {
		ec_info(m, "computer sleeps: no frame until it resumes\n");
		return 0;
	}
	ec_warn(m, "suspend refused: the scan of the bus takes more than %u ms; try again\n",
		PAUSE_MS);
	resume(m);
	return -EBUSY;
}

/**
 * ec_power_sleep() - let all masters be silent, as the computer is about to sleep
 *
 * Context: Process. May sleep, for a scan in progress.
 * Return: 0; -EBUSY when a master is in use; then none of them is silent.
 */
int ec_power_sleep(void)
{
	unsigned int i;
	int ret;

	for (i = 0; i < ec_cdev_count(); i++) {
		ret = put_to_sleep(ec_cdev_master(i));
		if (!ret)
			continue;
		while (i--)
			resume(ec_cdev_master(i));
		return ret;
	}
	return 0;
}

/**
 * ec_power_resume() - the computer has resumed: masters that were silent scan their bus
 *
 * Context: Process. May sleep.
 */
void ec_power_resume(void)
{
	unsigned int i;

	for (i = 0; i < ec_cdev_count(); i++) {
		struct ec_master *m = ec_cdev_master(i);

		if (!READ_ONCE(m->pause))
			continue;
		ec_info(m, "computer resumed: scanning the bus\n");
		/* slaves may have lost power, or be others; an application waits for the scan */
		WRITE_ONCE(m->bus.looked, false);
		WRITE_ONCE(m->bus.rescan, true);
		resume(m);
	}
}

static int on_reboot(struct notifier_block *nb, unsigned long code, void *command)
{
	ec_power_down(code == SYS_HALT ? "halt" : code == SYS_POWER_OFF ? "power-off" : "reboot");
	return NOTIFY_DONE;
}

static int on_suspend(struct notifier_block *nb, unsigned long event, void *unused)
{
	switch (event) {
	case PM_SUSPEND_PREPARE:
	case PM_HIBERNATION_PREPARE:
	case PM_RESTORE_PREPARE:
		return notifier_from_errno(ec_power_sleep());
	case PM_POST_SUSPEND:
	case PM_POST_HIBERNATION:
	case PM_POST_RESTORE:
		ec_power_resume();
	}
	return NOTIFY_DONE;
}

static struct notifier_block reboot_nb = { .notifier_call = on_reboot };
static struct notifier_block suspend_nb = { .notifier_call = on_suspend };

static void unhear_reboot(void)
{
	unsigned int i;

	unregister_reboot_notifier(&reboot_nb);
	for (i = 0; i < EC_MAX_MASTERS; i++)
		flush_work(&descents[i].work);
}

/**
 * ec_power_init() - register for reboots and suspends
 *
 * Context: Process, after all masters were created.
 * Return: 0 or -errno.
 */
int ec_power_init(void)
{
	unsigned int i;
	int ret;

	for (i = 0; i < EC_MAX_MASTERS; i++)
		INIT_WORK(&descents[i].work, descend);
	ret = register_reboot_notifier(&reboot_nb);
	if (ret)
		return ret;
	ret = register_pm_notifier(&suspend_nb);
	if (ret)
		unhear_reboot();
	return ret;
}

/**
 * ec_power_exit() - end that; the masters may go afterwards
 *
 * Waits for notifiers that run.
 *
 * Context: Process. May sleep.
 */
void ec_power_exit(void)
{
	unregister_pm_notifier(&suspend_nb);
	unhear_reboot();
}
