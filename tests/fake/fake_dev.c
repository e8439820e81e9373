// SPDX-License-Identifier: GPL-2.0-only
/*
 * Takes the place of lib/tools/sys.c and tool/sys.c, with the other files fake_*.c: a master with
 * an EK1100, an EL2008 with alias 1001 and an EL7201, made of tables. FAKE_BUS chooses what else is
 * going on:
 *   idle (default), app (an application runs), kcycle (with a cycle the kernel
 *   runs), empty, scanning, cut (ring
 *   broken behind slave 1), two (two masters), foreign (not our interface),
 *   detached (its application is gone), waiting (no network interface), evil (names that attack
 *   the reader),
 *   big (1000 slaves), shrinks (slaves are lost), noref (no reference clock), mute (registers of
 *   slave 1 are not readable), lossy (one read of registers in four succeeds);
 *   fake_glance.c has more
 * FAKE_LOG names a file that gets a line for each change, FAKE_COUNT one that
 * gets the number of ioctls.
 */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../lib/tools/sys.h"
#include "fake.h"

#define FD	100

unsigned int fake_index;

static bool writable[2];
static char reason[EC_UAPI_REASON];
static unsigned int polls, scans = 1, ioctls;

bool fake_bus(const char *name)
{
	const char *b = getenv("FAKE_BUS");

	return !strcmp(b ? b : "idle", name);
}

void fake_record(const char *fmt, ...)
{
	const char *path = getenv("FAKE_LOG");
	FILE *f = path ? fopen(path, "a") : NULL;
	va_list ap;

	if (!f)
		return;
	va_start(ap, fmt);
	vfprintf(f, fmt, ap);
	va_end(ap);
	fclose(f);
}

__attribute__((destructor)) static void store_count(void)
{
	const char *path = getenv("FAKE_COUNT");
	FILE *f = path ? fopen(path, "w") : NULL;

	if (!f)
		return;
	fprintf(f, "%u\n", ioctls);
	fclose(f);
}

int fake_fail(int err, const char *why)
{
	snprintf(reason, sizeof(reason), "%s", why);
	errno = err;
	return -1;
}

/* as the kernel, it may be asked by several threads */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static int open_locked(const char *path, int flags)
{
	const char *n = strstr(path, "EtherCAT");
	int i = n ? atoi(n + 8) : 0;

	if (i > 1 || (i == 1 && !fake_bus("two")) || fake_bus("none")) {
		errno = ENOENT;
		return -1;
	}
	writable[i] = (flags & O_ACCMODE) == O_RDWR;
	if (writable[i] && getenv("FAKE_READONLY")) {
		errno = EACCES;
		return -1;
	}
	return FD + i;
}

int ect_sys_open(const char *path, int flags)
{
	int fd, err;

	pthread_mutex_lock(&lock);
	fd = open_locked(path, flags);
	err = errno;
	pthread_mutex_unlock(&lock);
	errno = err;
	return fd;
}

void ect_sys_close(int fd)
{
	(void)fd;
}

static void fill_device(struct ec_ioc_device *d)
{
	static const struct ec_ioc_device main_device = {
		.address = { 0x02, 0x00, 0x00, 0x12, 0x34, 0x56 }, .state = EC_DEVICE_ATTACHED,
		.link_up = 1, .slaves = 3, .name = "eth0", .tx_frames = 18342,
		.tx_bytes = 1100520, .rx_frames = 18340, .rx_bytes = 1100400, .lost = 2,
		.tx_frame_rate = { 250, 249, 248 }, .rx_frame_rate = { 250, 249, 248 },
		.tx_byte_rate = { 14950, 14950, 14950 }, .rx_byte_rate = { 14950, 14950, 14950 },
		.loss_rate = { 0, 1, 2 },
	};

	*d = main_device;
}

static struct fake_master last;	/* what EC_IOC_DEVICE has of it */

static int read_master(struct fake_master *m, int index)
{
	bool app = fake_bus("app") || fake_bus("detached") || fake_bus("dc");

	*m = (struct fake_master){
		.index = (__u32)index, .phase = app ? EC_PHASE_OPERATION : EC_PHASE_IDLE,
		.active = app,
		.session = fake_bus("detached") ? EC_SESSION_DETACHED : app ? EC_SESSION_ACTIVE :
			   EC_SESSION_NONE,
		.slave_count = FAKE_SLAVES, .slaves_responding = FAKE_SLAVES,
		.scan_count = scans, .config_count = app ? fake_configs : 0,
		.domain_count = app ? fake_domains : 0, .device_count = 1,
		.app_time = 815000000123456789ULL, .scan_us = 12345, .scan_frames = 678,
		.links_up = 1, .acyclic_max = 64, .sii_bytes = 3072, .sii_limit = 67108864,
	};
	if (app) {
		m->cycle_lock = EC_CYCLE_LOCK_LOCKED;
		m->phase_error = -12;
		m->rate_ppb = -8700;
		m->lock_losses = 1;
		m->cycle_interval_us = 1000;
		m->cycle_datagrams = 3;
		m->cycle_frames = 2;
		m->cycle_wire_ns = 13440;
		m->sent_frames = 1;
		m->sent_wire_ns = 6720;
		m->acyclic_slack_ns = 5000;
		m->acyclic_need_ns = 6720;
		m->late_per_s = 100;
		m->late_cycles = 9;
	}
	if (fake_bus("held") || fake_bus("held_same")) {
		m->held = 1;
		m->session = EC_SESSION_RESERVED;
		strcpy(m->owner, "process 123 (demo)");
		m->slaves_responding += fake_bus("held");
	}
	if (fake_bus("noref"))
		m->ref_clock = -1;
	fill_device(&m->devices[0]);
	if (fake_bus("cut")) {
		m->device_count = 2;
		fill_device(&m->devices[1]);
		m->devices[1].address[5]++;
		m->links_up = 3;
	}
	if (fake_bus("empty") || fake_bus("waiting"))
		m->slave_count = 0;
	if (fake_bus("big"))
		m->slave_count = FAKE_BIG;
	if (fake_bus("shrinks") && polls++ > 4)
		m->slave_count = 2;
	if (fake_bus("waiting")) {
		m->phase = EC_PHASE_WAITING;
		m->devices[0].state = EC_DEVICE_WAITING;
		m->devices[0].link_up = m->links_up = 0;
	}
	if (scans % 2 == 0 && polls++ < 4)
		m->scan_busy = 1;	/* after a request */
	/* modules that were loaded just now; FAKE_BUS=unread: and stay so */
	if (fake_bus("unread") || (fake_bus("fresh") && polls++ < 4)) {
		m->scan_count = 0;
		m->slave_count = 0;
		m->scan_busy = polls > 2;
	}
	/* a scan that ends after a while */
	if (fake_bus("scanning") && polls++ < 4) {
		m->scan_busy = 1;
		m->slave_count = 1;
	}
	return 0;
}

static int master(struct ec_ioc_master *m, int index)
{
	int ret = read_master(&last, index);

	fake_why_master(&last);
	fake_run_master(&last);
	memcpy(m, &last, sizeof(*m));
	return ret;
}

static int device(struct ec_ioc_device *d)
{
	__u32 index = d->index;

	if (index >= last.device_count)
		return fake_fail(ENOENT, "there is no such device");
	*d = last.devices[index];
	d->index = index;
	return 0;
}

void fake_hex(const char *what, const __u8 *data, __u32 n)
{
	fake_record("%s", what);
	for (__u32 i = 0; i < n; i++)
		fake_record("%02x", data[i]);
	fake_record("\n");
}

static int answer(int fd, unsigned long request, void *arg)
{
	unsigned int nr = _IOC_NR(request);
	int ret;

	ioctls++;
	if (fake_bus("foreign")) {
		errno = ENOTTY;
		return -1;
	}
	/* the numbers below 0x20 are used up */
	if (nr >= 0x20 && nr != _IOC_NR(EC_IOC_EOE) && nr != _IOC_NR(EC_IOC_NAMES) &&
	    nr != _IOC_NR(EC_IOC_RECORDER) && !writable[fd - FD])
		return fake_fail(EPERM, "the file is open for reading only");
	switch (request) {
	case EC_IOC_VERSION:
		*(struct ec_ioc_version *)arg = (struct ec_ioc_version){
			.abi = EC_UAPI_VERSION, .master_count = fake_bus("two") ? 2 : 1,
			.release = "0.1.0",
		};
		return 0;
	case EC_IOC_REASON: {
		struct ec_ioc_reason *r = arg;

		memcpy(r->text, reason, sizeof(r->text));
		r->len = (__u32)strlen(reason);
		return 0;
	}
	case EC_IOC_MASTER:
		return master(arg, fd - FD);
	case EC_IOC_DEVICE:
		return device(arg);
	case EC_IOC_RESCAN:
		fake_record("rescan %d\n", fd - FD);
		scans = 2;
		polls = 0;
		return 0;
	case EC_IOC_END_DETACHED:
		if (!fake_bus("detached") && !fake_bus("run"))
			return fake_fail(ENOENT, "master 0 has no session");
		fake_record("release %d\n", fd - FD);
		return 0;
	case EC_IOC_DEVICE_USE:
		fake_record("use%s %d %s\n",
			    ((struct ec_ioc_device_use *)arg)->flags ? " backup" : "", fd - FD,
			    ((struct ec_ioc_device_use *)arg)->name);
		return 0;
	case EC_IOC_DEBUG:
		fake_record("debug %d %u\n", fd - FD, ((struct ec_ioc_debug *)arg)->level);
		return 0;
	default:
		ret = fake_run(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_slave_command(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_app(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_mbox(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_events(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_mail(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_recorder(request, arg);
		if (ret != FAKE_OTHER)
			return ret;
		errno = ENOTTY;
		return -1;
	}
}

/* of a command for a slave */
static struct ec_ioc_address *address_of(unsigned long request, void *arg)
{
	static const unsigned long for_a_slave[] = {
		EC_IOC_SLAVE, EC_IOC_SLAVE_NAMES, EC_IOC_SLAVE_WHY, EC_IOC_PORT, EC_IOC_SM,
		EC_IOC_PDO, EC_IOC_PDO_ENTRY, EC_IOC_SII, EC_IOC_REG_READ, EC_IOC_REG_WRITE,
		EC_IOC_REG_RDWR, EC_IOC_STATE, EC_IOC_SDO_UPLOAD, EC_IOC_SDO_DOWNLOAD,
		EC_IOC_SDO_INFO, EC_IOC_SOE_READ, EC_IOC_SOE_WRITE, EC_IOC_FOE_READ,
		EC_IOC_FOE_WRITE, EC_IOC_IP_GET, EC_IOC_IP_SET, EC_IOC_EMERGENCIES,
		EC_IOC_LET_IN, EC_IOC_SII_WRITE, EC_IOC_ALIAS,
	};

	_Static_assert(offsetof(struct ec_ioc_slave, slave) == offsetof(struct ec_ioc_foe, slave),
		       "at the same place in all");
	for (size_t i = 0; i < LEN(for_a_slave); i++)
		if (request == for_a_slave[i])
			return (void *)((char *)arg + offsetof(struct ec_ioc_slave, slave));
	return NULL;
}

/*
 * The parts see a ring position. FAKE_BUS=moved: after the slaves were listed each of them was
 * replaced by another one.
 */
static int resolve(unsigned long request, struct ec_ioc_address *a)
{
	const struct ec_ioc_address by_device = { .kind = EC_ADDRESS_DEVICE, .device = a->device };

	if (a->kind == EC_ADDRESS_POSITION)
		return 0;
	if (memcmp(a, &by_device, sizeof(by_device)) || a->device < FAKE_DEVICE)
		return fake_fail(EINVAL, "not an address");
	if (fake_bus("moved") && _IOC_NR(request) >= 0x20)
		return fake_fail(ENODEV, "device 13, which was slave 2 (EL7201), disconnected 3 s ago");
	*a = (struct ec_ioc_address){ .position = (__u16)(a->device - FAKE_DEVICE) };
	return 0;
}

static void attached(struct ec_ioc_config *c)
{
	c->device = c->slave_position < 0 ? 0 : FAKE_DEVICE + (__u64)c->slave_position;
}

static int command(int fd, unsigned long request, void *arg)
{
	struct ec_ioc_address *a = address_of(request, arg), asked;
	int ret;

	fake_index = (unsigned int)(fd - FD);
	if (a)
		asked = *a;
	ret = (a && resolve(request, a)) ? -1 : answer(fd, request, arg);
	if (!ret)
		fake_why(request, arg);
	if (!ret && request == EC_IOC_CONFIG)
		attached(arg);
	if (a)
		*a = asked;
	return ret;
}

int ect_sys_ioctl(int fd, unsigned long request, void *arg)
{
	int ret, err;

	pthread_mutex_lock(&lock);
	ret = command(fd, request, arg);
	err = errno;
	pthread_mutex_unlock(&lock);
	errno = err;
	return ret;
}
