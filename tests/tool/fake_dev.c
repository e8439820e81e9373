// SPDX-License-Identifier: GPL-2.0-only
/*
 * Takes the place of tool/sys.c, with the other files fake_*.c: a master with an
 * EK1100, an EL2008 with alias 1001 and an EL7201, made of tables. FAKE_BUS chooses what else is
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
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../tool/sys.h"
#include "fake.h"

#define SLAVES	3
#define BIG	1000
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

int sys_open(const char *path, int flags)
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

void sys_close(int fd)
{
	(void)fd;
}

static const struct ec_ioc_slave slaves[SLAVES] = {
	{
		.position = 0, .station = 0x03e9, .al_status = 2, .al_requested = 2,
		.vendor_id = 2, .product_code = 0x044c2c52, .revision_number = 0x00110000,
		.dc_supported = 2, .has_general = 1, .current_ma = -2000, .dl_status = 0x5530,
		.sii_words = 0x50, .fmmu_count = 2,
		.ports = {
			{ 3, 1, 0, 1, 1000, EC_UAPI_NONE16, 0, 0 },
			{ 2, 1, 0, 1, 1290, 1, 0, 145 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 },
		},
		.group = "Couplers", .order = "EK1100", .name = "EK1100 Coupler",
	}, {
		.position = 1, .station = 0x03ea, .alias = 1001, .alias_group = 1001,
		.al_status = 2, .al_requested = 2, .vendor_id = 2, .product_code = 0x07d83052,
		.revision_number = 0x00100000, .dc_supported = 1, .dc_delay_only = 1,
		.has_general = 1, .current_ma = 110, .sm_count = 1, .fmmu_count = 1,
		.transmission_delay = 145, .sii_words = 0x50,
		.ports = {
			{ 2, 1, 0, 1, 3000, 0, 0, 145 },
			{ 2, 1, 0, 1, 2990, 2, 0, 145 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 },
		},
		.group = "Terminals", .order = "EL2008", .name = "EL2008 8-ch output",
	}, {
		.position = 2, .station = 0x03eb, .alias_group = 1001, .alias_pos = 1,
		.al_status = 0x12, .al_code = 0x001d, .al_requested = 4, .error = 2,
		.vendor_id = 2, .product_code = 0x1c213052, .revision_number = 0x00110000,
		.boot_rx_offset = 0x1000, .boot_rx_size = 512, .boot_tx_offset = 0x1200,
		.boot_tx_size = 512, .std_rx_offset = 0x1000, .std_rx_size = 256,
		.std_tx_offset = 0x1100, .std_tx_size = 256, .mbox_protocols = 0x0c,
		.has_general = 1, .coe_details = 0x03, .current_ma = 190, .dc_supported = 2,
		.sm_count = 4, .fmmu_count = 3, .transmission_delay = 290, .sii_words = 0x50,
		.ports = {
			{ 2, 1, 0, 1, 5000, 1, 0, 145 },
			{ 2, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 },
		},
		.group = "Terminals", .order = "EL7201", .name = "EL7201 servo terminal",
		.why = "SM2 has 8 bytes configured, the slave expects 6",
	},
};

static const struct ec_ioc_sm sms[] = {
	{ .position = 1, .sm = 0, .start = 0x0f00, .default_size = 1, .control = 0x44, .enable = 1,
	  .pdo_count = 2 },
	{ .position = 2, .sm = 0, .start = 0x1000, .default_size = 256, .control = 0x26,
	  .enable = 1 },
	{ .position = 2, .sm = 1, .start = 0x1100, .default_size = 256, .control = 0x22,
	  .enable = 1 },
	{ .position = 2, .sm = 2, .start = 0x1200, .default_size = 6, .control = 0x24,
	  .enable = 1, .pdo_count = 1 },
	{ .position = 2, .sm = 3, .start = 0x1300, .default_size = 6, .control = 0x20,
	  .enable = 1, .pdo_count = 1 },
};

static const struct ec_ioc_pdo pdos[] = {
	{ .position = 1, .sm = 0, .pdo_pos = 0, .index = 0x1600, .entry_count = 1,
	  .name = "Channel 1" },
	{ .position = 1, .sm = 0, .pdo_pos = 1, .index = 0x1601, .entry_count = 1,
	  .name = "Channel */ 2" },
	{ .position = 2, .sm = 2, .pdo_pos = 0, .index = 0x1600, .entry_count = 1,
	  .name = "DRV Controlword" },
	{ .position = 2, .sm = 3, .pdo_pos = 0, .index = 0x1a00, .entry_count = 2,
	  .name = "FB Position" },
};

static const struct ec_ioc_pdo_entry entries[] = {
	{ .position = 1, .sm = 0, .pdo_pos = 0, .entry_pos = 0, .index = 0x7000, .subindex = 1,
	  .bits = 1, .name = "Output" },
	{ .position = 1, .sm = 0, .pdo_pos = 1, .entry_pos = 0, .index = 0x7010, .subindex = 1,
	  .bits = 1, .name = "Output" },
	{ .position = 2, .sm = 2, .pdo_pos = 0, .entry_pos = 0, .index = 0x7010, .subindex = 1,
	  .bits = 16, .name = "Controlword" },
	{ .position = 2, .sm = 3, .pdo_pos = 0, .entry_pos = 0, .index = 0x6000, .subindex = 0x11,
	  .bits = 32, .name = "Position" },
	{ .position = 2, .sm = 3, .pdo_pos = 0, .entry_pos = 1, .index = 0, .subindex = 0,
	  .bits = 16 },
};

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

static int master(struct ec_ioc_master *m, int index)
{
	bool app = fake_bus("app") || fake_bus("detached") || fake_bus("dc");

	*m = (struct ec_ioc_master){
		.index = (__u32)index, .phase = app ? EC_PHASE_OPERATION : EC_PHASE_IDLE,
		.active = app,
		.session = fake_bus("detached") ? EC_SESSION_DETACHED : app ? EC_SESSION_ACTIVE :
			   EC_SESSION_NONE,
		.slave_count = SLAVES, .slaves_responding = SLAVES,
		.scan_count = scans, .config_count = app ? fake_configs : 0,
		.domain_count = app ? fake_domains : 0, .device_count = 1,
		.app_time = 815000000123456789ULL, .scan_us = 12345, .scan_frames = 678,
		.acyclic_max = 64, .sii_bytes = 3072, .sii_limit = 67108864,
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
	}
	if (fake_bus("empty") || fake_bus("waiting"))
		m->slave_count = 0;
	if (fake_bus("big"))
		m->slave_count = BIG;
	if (fake_bus("shrinks") && polls++ > 4)
		m->slave_count = 2;
	if (fake_bus("waiting")) {
		m->phase = EC_PHASE_WAITING;
		m->devices[0].state = EC_DEVICE_WAITING;
		m->devices[0].link_up = 0;
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

static struct ec_ioc_slave state[SLAVES];

/* slave 2 hangs at the master by its port 1, slave 0 behind its port 0 */
static void reversed(struct ec_ioc_slave *s)
{
	if (s->position == 0) {
		s->ports[0].next_slave = 2;
	} else if (s->position == 1) {
		s->ports[1] = (struct ec_ioc_port){ 2, 0, 1, 0, 0, EC_UAPI_NONE16, 0, 0 };
	} else {
		s->ports[0].next_slave = 0;
		s->ports[1] = (struct ec_ioc_port){ 3, 1, 0, 1, 4000, EC_UAPI_NONE16, 0, 0 };
		s->dc_odd = 1;
	}
}

static int slave(struct ec_ioc_slave *s)
{
	if (fake_bus("big") && s->position < BIG) {
		__u16 p = s->position;

		*s = slaves[1];
		s->position = p;
		s->alias = p % 100 ? 0 : p / 100 + 1;
		s->alias_group = p / 100 + 1;
		s->alias_pos = p % 100;
		return 0;
	}
	if (s->position >= SLAVES)
		return fake_fail(EINVAL, "there is no such slave");
	if (!state[s->position].vendor_id)
		state[s->position] = slaves[s->position];
	*s = state[s->position];
	if (getenv("FAKE_SII"))
		s->sii_words = 0x80;
	if (fake_bus("cut") && s->position == 2)
		s->device_index = 1;
	if (fake_bus("reversed"))
		reversed(s);
	fake_glance_slave(s);
	if (fake_bus("differs") && s->position == 1) {
		s->config = 2;
		s->differs = 1;
		strcpy(s->warning, "process data of SM2 may belong to other objects");
	}
	if (fake_bus("held") && s->position == 1) {
		s->al_status = 0;
		s->error = EC_SLAVE_SCAN_FAILED;
		s->cause.kind = EC_CAUSE_SILENT;
	}
	if (fake_bus("evil") && s->position == 2) {
		snprintf(s->name, sizeof(s->name), "%s", "\033[2J\302\233H\2341m\342\200\256 Gr\303\266\337e\r\n\177");
		snprintf(s->order, sizeof(s->order), "%s", "*/ \"x\\ /* int");
		memset(s->group, 'g', sizeof(s->group));	/* no end */
	}
	return 0;
}

static int request_state(const struct ec_ioc_state *r)
{
	struct ec_ioc_slave s = { .position = r->position };

	if (slave(&s))
		return -1;
	fake_record("state %u %u\n", r->position, r->state);
	state[r->position].al_requested = r->state;
	state[r->position].error = 0;
	state[r->position].why[0] = 0;
	if (r->position == 2 && r->state == 8)
		return 0;	/* never gets there */
	state[r->position].al_status = r->state;
	state[r->position].al_code = 0;
	if (r->position == 2 && r->state == 4) {
		state[r->position].al_status = 0x12;
		state[r->position].al_code = 0x001e;
		state[r->position].error = EC_SLAVE_CONFIG_FAILED;
		strcpy(state[r->position].why, "SAFEOP refused: AL status code 0x001e (inputs)");
	}
	return 0;
}

#define FIND(table, match)							\
	do {									\
		for (size_t i_ = 0; i_ < LEN(table); i_++) {			\
			const __typeof__(table[0]) *t_ = &table[i_];		\
										\
			if (match) {						\
				*x = *t_;					\
				return 0;					\
			}							\
		}								\
		return fake_fail(EINVAL, "there is no such entry");		\
	} while (0)

static int sm(struct ec_ioc_sm *x)
{
	FIND(sms, t_->position == x->position && t_->sm == x->sm);
}

static int pdo(struct ec_ioc_pdo *x)
{
	if (fake_bus("evil") && x->position == 2 && x->sm == 2) {
		*x = (struct ec_ioc_pdo){ .position = 2, .sm = 2, .index = 0x1600, .entry_count = 1,
			.name = "*/*/ int /*/ \\" };
		return 0;
	}
	FIND(pdos, t_->position == x->position && t_->sm == x->sm && t_->pdo_pos == x->pdo_pos);
}

static int entry(struct ec_ioc_pdo_entry *x)
{
	FIND(entries, t_->position == x->position && t_->sm == x->sm &&
	     t_->pdo_pos == x->pdo_pos && t_->entry_pos == x->entry_pos);
}


void fake_hex(const char *what, const __u8 *data, __u32 n)
{
	fake_record("%s", what);
	for (__u32 i = 0; i < n; i++)
		fake_record("%02x", data[i]);
	fake_record("\n");
}

static int reg_read(struct ec_ioc_reg *x)
{
	__u8 *to = (__u8 *)(uintptr_t)x->data;
	static unsigned int lost;

	if (!x->size || x->size > 1024)
		return fake_fail(EINVAL, "1 to 1024 bytes");
	if ((fake_bus("mute") && x->position == 1) || (fake_bus("lossy") && lost++ % 4 != 3))
		return fake_fail(ETIMEDOUT, "no reply to register access");
	for (__u32 i = 0; i < x->size; i++) {
		__u32 a = x->address + i;

		to[i] = a == 0x0130 ? 0x12 : 0;
		if (!x->position && a == 0x0302)
			to[i] = 3;
		if (!x->position && a == 0x0309)
			to[i] = 1;
		if (a == 0xffff)
			to[i] = 0x77;
		/*
		 * slave 2: latch 0 is high and has seen it rise, latch 1 is the slave's,
		 * with FAKE_LATCHES both are
		 */
		if (x->position == 2 && (a == 0x0980 || a == 0x09ae || a == 0x09b0 || a == 0x09a9))
			to[i] = a == 0x0980 ? (getenv("FAKE_LATCHES") ? 0x30 : 0x20) :
				a == 0x09ae ? 5 : a == 0x09a9 ? 1 : 0x15;
	}
	fake_glance_registers(x, to);
	return 0;
}

static int reg_write(struct ec_ioc_reg *x)
{
	char what[64];

	snprintf(what, sizeof(what), "reg %u 0x%04x%s ", x->position, x->address,
		 x->flags ? " emergency" : "");
	fake_hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int reg_rdwr(struct ec_ioc_reg *x)
{
	reg_write(x);
	return reg_read(x);
}

/* with PDOs, others than those the slave has: see fake_mbox.c */
static int sii_pdos(struct ec_ioc_sii *x)
{
	static const char categories[] =
		"\x0a\0\7\0" "\2\3DRV\7Control\0"
		"\x33\0\x1c\0"
		"\0\x16\1\2\0\1\0\0" "\x10\x70\1\2\6\x10\0\0"
		"\1\x16\1\2\0\0\0\0" "\x10\x70\6\0\5\x08\0\0"
		"\2\x16\2\xff\0\0\0\0" "\x10\x70\6\0\5\x08\0\0" "\0\0\0\0\0\x08\0\0"
		"\x32\0\x0c\0"
		"\0\x1a\2\3\0\0\0\0" "\0\x60\x11\0\7\x20\0\0" "\0\0\0\0\0\x10\0\0"
		"\xff\xff";
	__u8 image[0x100] = { 0 };

	memcpy(image + 0x80, categories, sizeof(categories));
	if (x->offset >= sizeof(image))
		return fake_fail(EINVAL, "beyond the image");
	if (x->size > sizeof(image) - x->offset)
		x->size = (__u32)(sizeof(image) - x->offset);
	memcpy((void *)(uintptr_t)x->data, image + x->offset, x->size);
	return 0;
}

static int sii(struct ec_ioc_sii *x)
{
	/* fixed area, then General (2 words) and the end */
	__u8 image[0xa0] = { [0x10] = 2, [0x80] = 0x1e, [0x82] = 2, [0x84] = 1, 2, 3, 4,
			     [0x88] = 0xff, 0xff };

	if (getenv("FAKE_SII"))
		return sii_pdos(x);
	if (x->offset >= sizeof(image))
		return fake_fail(EINVAL, "beyond the image");
	if (x->size > 64)
		x->size = 64;	/* in pieces */
	if (x->size > sizeof(image) - x->offset)
		x->size = sizeof(image) - x->offset;
	memcpy((void *)(uintptr_t)x->data, image + x->offset, x->size);
	return 0;
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
	if (nr >= 0x20 && !writable[fd - FD])
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
	case EC_IOC_SLAVE:
		return slave(arg);
	case EC_IOC_SM:
		return sm(arg);
	case EC_IOC_PDO:
		return pdo(arg);
	case EC_IOC_PDO_ENTRY:
		return entry(arg);
	case EC_IOC_SII:
		return sii(arg);
	case EC_IOC_REG_READ:
		return reg_read(arg);
	case EC_IOC_REG_WRITE:
		return reg_write(arg);
	case EC_IOC_REG_RDWR:
		return reg_rdwr(arg);
	case EC_IOC_STATE:
		return request_state(arg);
	case EC_IOC_RESCAN:
		fake_record("rescan %d\n", fd - FD);
		scans = 2;
		polls = 0;
		return 0;
	case EC_IOC_END_DETACHED:
		if (!fake_bus("detached"))
			return fake_fail(ENOENT, "master 0 has no session");
		fake_record("release %d\n", fd - FD);
		return 0;
	case EC_IOC_DEVICE_USE:
		fake_record("use %d %s\n", fd - FD, ((struct ec_ioc_device_use *)arg)->name);
		return 0;
	case EC_IOC_DEBUG:
		fake_record("debug %d %u\n", fd - FD, ((struct ec_ioc_debug *)arg)->level);
		return 0;
	default:
		ret = fake_app(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_mbox(request, arg);
		if (ret == FAKE_OTHER)
			ret = fake_events(request, arg);
		if (ret != FAKE_OTHER)
			return ret;
		errno = ENOTTY;
		return -1;
	}
}

int sys_ioctl(int fd, unsigned long request, void *arg)
{
	int ret;

	fake_index = (unsigned int)(fd - FD);
	ret = answer(fd, request, arg);
	if (!ret)
		fake_why(request, arg);
	return ret;
}
