// SPDX-License-Identifier: GPL-2.0-only
/*
 * Takes the place of tool/sys.c, with fake_sys.c: a master with an EK1100, an EL2008 with alias
 * 1001 and an EL7201, made of tables. FAKE_BUS chooses what else is going on:
 *   idle (default), app (an application runs), kcycle (with a cycle the kernel
 *   runs), empty, scanning, cut (ring
 *   broken behind slave 1), two (two masters), foreign (not our interface),
 *   detached (its application is gone), waiting (no network interface), evil (names that attack the reader),
 *   big (1000 slaves)
 * FAKE_LOG names a file that gets a line for each change, FAKE_COUNT one that
 * gets the number of ioctls.
 */
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../include/uapi/ethercat.h"
#include "../../tool/sys.h"

#define SLAVES	3
#define BIG	1000
#define FD	100
#define LEN(a)	(sizeof(a) / sizeof((a)[0]))

static bool writable[2];
static char reason[EC_UAPI_REASON];
static unsigned int polls, scans = 1, ioctls;

static bool bus(const char *name)
{
	const char *b = getenv("FAKE_BUS");

	return !strcmp(b ? b : "idle", name);
}

__attribute__((format(printf, 1, 2))) static void record(const char *fmt, ...)
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

static int fail(int err, const char *why)
{
	snprintf(reason, sizeof(reason), "%s", why);
	errno = err;
	return -1;
}

int sys_open(const char *path, int flags)
{
	const char *n = strstr(path, "EtherCAT");
	int i = n ? atoi(n + 8) : 0;

	if (i > 1 || (i == 1 && !bus("two")) || bus("none")) {
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

static const struct ec_ioc_config configs[] = {
	{ .alias = 1001, .vendor_id = 2, .product_code = 0x07d83052, .slave_position = 1,
	  .al_status = 2 },
	{ .position = 2, .vendor_id = 2, .product_code = 0x1c213052, .slave_position = -1,
	  .sdo_count = 2, .flag_count = 2, .dc_assign_activate = 0x0300, .dc_cycle = { 1000000, 0 },
	  .dc_shift = { -500, 0 }, .watchdog_divider = 2498 },
};

static const struct ec_ioc_domain domains[] = {
	{ .index = 0, .size = 1, .logical = 0, .working_counter = 1, .expected = 1,
	  .fmmu_count = 1, .datagram_count = 1, .datagram_bytes = 13, .age = 1, .max_age = 2 },
	{ .index = 1, .size = 6, .logical = 1, .working_counter = 3, .expected = 3,
	  .fmmu_count = 1, .options = EC_DOMAIN_OPT_OVERLAP | EC_DOMAIN_OPT_OWN_FRAME,
	  .datagram_count = 2, .datagram_bytes = 30, .age = 3, .max_age = 2 },
};

static const __u8 images[2][6] = { { 0xa5 }, { 1, 2, 3, 4, 5, 0xff } };

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
	bool app = bus("app") || bus("detached");

	*m = (struct ec_ioc_master){
		.index = (__u32)index, .phase = app ? EC_PHASE_OPERATION : EC_PHASE_IDLE,
		.active = app,
		.session = bus("detached") ? EC_SESSION_DETACHED : app ? EC_SESSION_ACTIVE :
			   EC_SESSION_NONE,
		.slave_count = SLAVES, .slaves_responding = SLAVES,
		.scan_count = scans, .config_count = app ? LEN(configs) : 0,
		.domain_count = app ? LEN(domains) : 0, .device_count = 1,
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
	fill_device(&m->devices[0]);
	if (bus("cut")) {
		m->device_count = 2;
		fill_device(&m->devices[1]);
		m->devices[1].address[5]++;
	}
	if (bus("empty") || bus("waiting"))
		m->slave_count = 0;
	if (bus("big"))
		m->slave_count = BIG;
	if (bus("waiting")) {
		m->phase = EC_PHASE_WAITING;
		m->devices[0].state = EC_DEVICE_WAITING;
		m->devices[0].link_up = 0;
	}
	if (scans % 2 == 0 && polls++ < 4)
		m->scan_busy = 1;	/* after a request */
	/* a scan that ends after a while */
	if (bus("scanning") && polls++ < 4) {
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
	if (bus("big") && s->position < BIG) {
		__u16 p = s->position;

		*s = slaves[1];
		s->position = p;
		s->alias = p % 100 ? 0 : p / 100 + 1;
		s->alias_group = p / 100 + 1;
		s->alias_pos = p % 100;
		return 0;
	}
	if (s->position >= SLAVES)
		return fail(EINVAL, "there is no such slave");
	if (!state[s->position].vendor_id)
		state[s->position] = slaves[s->position];
	*s = state[s->position];
	if (bus("cut") && s->position == 2)
		s->device_index = 1;
	if (bus("reversed"))
		reversed(s);
	if (bus("differs") && s->position == 1) {
		s->config = 2;
		s->differs = 1;
		strcpy(s->warning, "process data of SM2 may belong to other objects");
	}
	if (bus("evil") && s->position == 2) {
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
	record("state %u %u\n", r->position, r->state);
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
		return fail(EINVAL, "there is no such entry");			\
	} while (0)

static int sm(struct ec_ioc_sm *x)
{
	FIND(sms, t_->position == x->position && t_->sm == x->sm);
}

static int pdo(struct ec_ioc_pdo *x)
{
	if (bus("evil") && x->position == 2 && x->sm == 2) {
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

static int config_sdo(struct ec_ioc_config_sdo *x)
{
	__u8 *data = (__u8 *)(uintptr_t)x->data;
	bool big = x->sdo_pos;

	x->flags = big ? EC_SDO_FLAG_COMPLETE : 0;
	x->sdo_index = 0x8010;
	x->subindex = big ? 0 : 3;
	for (__u32 i = 0; i < (big ? 20u : 2u) && i < x->size; i++)
		data[i] = (__u8)(i + 1);
	x->size = big ? 20 : 2;
	return 0;
}

/* configuration 1 has two, the first one longer than what is shown of others */
static int config_idn(struct ec_ioc_config_idn *x)
{
	__u8 *data = (__u8 *)(uintptr_t)x->data;

	if (getenv("FAKE_NO_IDN"))
		return fail(ENOTTY, "");
	if (x->index != 1 || x->idn_pos > 1)
		return fail(ENOENT, "configuration has 2 startup IDNs");
	x->idn = x->idn_pos ? 0x8096 : 15;
	x->drive = (__u8)x->idn_pos;
	x->state = x->idn_pos ? 4 : 2;
	x->size = 2;
	data[0] = 7;
	data[1] = (__u8)x->idn_pos;
	return 0;
}

static int config_flag(struct ec_ioc_config_flag *x)
{
	static const char *const key[] = { "AssignToPdi", "WaitBeforeSAFEOPms" };

	if (x->flag_pos >= LEN(key))
		return fail(ENOENT, "there is no such flag");
	snprintf(x->key, sizeof(x->key), "%s", key[x->flag_pos]);
	x->value = x->flag_pos ? -1 : 1;
	return 0;
}

static int config_sm(struct ec_ioc_config_sm *x)
{
	if (x->sm == 2 && x->index == 1) {
		x->dir = 1;
		x->pdo_count = 1;
	}
	return 0;
}

static int domain_data(struct ec_ioc_domain_data *x)
{
	if (x->index >= LEN(domains))
		return fail(EINVAL, "there is no such domain");
	if (x->size > domains[x->index].size)
		x->size = domains[x->index].size;
	memcpy((void *)(uintptr_t)x->data, images[x->index], x->size);
	return 0;
}

static int domain_fmmu(struct ec_ioc_domain_fmmu *x)
{
	bool second = x->index == 1;

	x->alias = second ? 0 : 1001;
	x->position = second ? 2 : 0;
	x->sm = second ? 3 : 0;
	x->dir = second ? 2 : 1;
	x->logical = domains[x->index].logical;
	x->size = domains[x->index].size;
	return 0;
}

/* 10000 sends: 9900 about 1 us, 95 about 5 us, 5 about 100 us from schedule */
static int cycle_stats(struct ec_ioc_cycle_stats *x)
{
	struct ec_status_cycle st = {
		.late_sum = 10875000, .late_count = 10000, .late_min = 960, .late_max = 101234,
	};

	if (!bus("app") && !bus("kcycle")) {
		x->size = 0;
		return 0;
	}
	x->kind = bus("app") ? EC_CYCLE_BY_APP : EC_CYCLE_BY_KERNEL;
	x->active = 1;
	x->interval_set = bus("kcycle");
	x->interval_ns = bus("app") ? 1000123 : 250000;
	x->cpu = -1;
	st.late[63] = 4900;
	st.late[64] = 5000;
	st.late[81] = 95;
	st.late[116] = 5;
	if (bus("kcycle")) {
		st.state = EC_CYCLE_STATE_STALLED;
		st.overruns = 2;
		st.work_sum = 42000000;
		st.work_count = 10000;
		st.work_max = 9876;
		st.missed = 3;
		x->cpu = 2;
		x->cpu_losses = 1;
		x->priority = 40;
		x->priority_wanted = 80;
	}
	memcpy((void *)(uintptr_t)x->data, &st, sizeof(st));
	return 0;
}

static void hex(const char *what, const __u8 *data, __u32 n)
{
	record("%s", what);
	for (__u32 i = 0; i < n; i++)
		record("%02x", data[i]);
	record("\n");
}

static int abort_sdo(struct ec_ioc_sdo *x, __u32 code)
{
	x->abort_code = code;
	return fail(EIO, "SDO aborted");
}

static int upload(struct ec_ioc_sdo *x)
{
	static const struct {
		__u16 index;
		__u8 sub, size;
		const char *data;
	} dict[] = {
		{ 0x1008, 0, 8, "EL7201\0\0" },
		{ 0x1018, 1, 4, "\x02\0\0\0" },
		{ 0x1018, 2, 3, "\1\2\3" },
		{ 0x6041, 0, 2, "\x60\x80" },
		{ 0x6060, 0, 1, "\xff" },
		{ 0x2000, 0, 4, "\0\0\xc0\x3f" },
		{ 0x2002, 0, 12, "a\033[2J\302\233b\n\0\0\0" },
	};
	__u8 *to = (__u8 *)(uintptr_t)x->data;

	if (x->index == 0x3000) {
		if (x->size < 65536)
			return fail(EOVERFLOW, "the object has 65536 bytes");
		memset(to, 'x', 65536);
		x->size = 65536;
		return 0;
	}
	if (x->index == 0x4000)
		return fail(ETIMEDOUT, "slave 2 has not answered for 1000 ms");
	if (x->flags & EC_SDO_FLAG_COMPLETE) {
		memcpy(to, "\4\0\2\0", 4);
		x->size = 4;
		return 0;
	}
	for (size_t i = 0; i < LEN(dict); i++)
		if (dict[i].index == x->index && dict[i].sub == x->subindex) {
			memcpy(to, dict[i].data, dict[i].size);
			x->size = dict[i].size;
			return 0;
		}
	return abort_sdo(x, x->index == 0x5001 ? 0x12345678 : 0x06020000);
}

/* answers of SDO information: description, or 0 for what is refused */
static const struct {
	__u16 index;
	__u8 sub, object;
	__u8 size;
	const char *data;
} infos[] = {
	/* index, type, highest subindex, object code, name */
	{ 0x1018, 0, 1, 14, "\x18\x10\x23\0\3\x09Identity" },
	{ 0x1018, 0, 0, 13, "\x18\x10\0\0\5\0\x08\0\7\0Num" },
	/* index, subindex, value info, type, bits, access, name */
	{ 0x1018, 1, 0, 16, "\x18\x10\1\0\7\0\x20\0\7\0Vendor" },
	{ 0x1018, 2, 0, 10, "\x18\x10\2\0\7\0\x20\0\0\0" },
	{ 0x6060, 0, 1, 16, "\x60\x60\2\0\0\7a\033[2J\302\233b\n" },
	{ 0x6060, 0, 0, 14, "\x60\x60\0\0\2\0\x08\0\xff\0Mode" },
	{ 0x2002, 0, 1, 12, "\2\x20\x09\0\0\7Serial" },
	{ 0x2002, 0, 0, 16, "\2\x20\0\0\x09\0\x60\0\x3f\0Serial" },
	{ 0x1008, 0, 1, 10, "\x08\x10\x0a\0\0\7Name" },
	{ 0x1008, 0, 0, 14, "\x08\x10\0\0\x0a\0\x40\0\x3f\0Name" },
	/* an entry of a type that has no name, and a description cut off */
	{ 0x5001, 0, 1, 12, "\1\x50\xff\x7f\0\7Vendor" },
	{ 0x5001, 0, 0, 13, "\1\x50\0\0\xff\x7f\3\0\x3f\0Odd" },
	{ 0x5002, 0, 1, 3, "\2\x50\xff" },
};

static int sdo_info(struct ec_ioc_sdo_info *x)
{
	static const char list[] = "\x18\x10\x60\x60\2\x20\x08\x10\1\x50\2\x50\3\x50";
	__u8 *to = (__u8 *)(uintptr_t)x->data;

	if (bus("gone") && x->index == 0x6060)
		return fail(ENODEV, "no slave at ring position 2");
	if (x->what == EC_SDO_INFO_LIST) {
		x->size = sizeof(list) - 1;
		memcpy(to, list, x->size);
		return 0;
	}
	for (size_t i = 0; i < LEN(infos); i++) {
		if (infos[i].index != x->index || infos[i].sub != x->subindex ||
		    infos[i].object != (x->what == EC_SDO_INFO_OBJECT))
			continue;
		memcpy(to, infos[i].data, infos[i].size);
		x->size = infos[i].size;
		return 0;
	}
	x->abort_code = 0x06090011;
	return fail(EIO, "SDO information aborted");
}

static int emergencies(struct ec_ioc_emergencies *x)
{
	const struct ec_emergency e = {
		.time_ns = 1764000000012345678, .code = 0x8130, .error_register = 0x11,
		.data = { 1, 2, 3, 4, 0xff },
	};

	if (x->position != 2)
		return 0;
	x->total = bus("two") ? 70000 : 2;
	x->count = bus("two") ? EC_EMERGENCIES : 2;
	for (__u32 i = 0; i < x->count; i++)
		x->entry[i] = e;
	x->entry[1].code = 0;
	return 0;
}

static int download(struct ec_ioc_sdo *x)
{
	char what[64];

	if (x->index == 0x1018)
		return abort_sdo(x, 0x06010002);
	snprintf(what, sizeof(what), "sdo %u 0x%04x:%02x%s ", x->position, x->index, x->subindex,
		 x->flags ? " C" : "");
	hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int soe_error(struct ec_ioc_soe *x, __u16 code)
{
	x->error_code = code;
	return fail(EIO, "the slave refuses");
}

static int soe_read(struct ec_ioc_soe *x)
{
	static const struct {
		__u16 idn;
		__u8 size;
		const char *data;
	} idns[] = {
		{ 15, 2, "\7\0" },
		{ 30, 11, "\7\0\x10\0SIM 1.0" },
		{ 0x8096, 2, "\x34\x12" },
	};

	if (x->drive > 1)
		return soe_error(x, 0x800a);
	if (x->idn == 99)
		return fail(ETIMEDOUT, "slave 2 did not answer in time");
	for (size_t i = 0; i < LEN(idns); i++)
		if (idns[i].idn == x->idn) {
			memcpy((void *)(uintptr_t)x->data, idns[i].data, idns[i].size);
			x->size = idns[i].size;
			return 0;
		}
	return soe_error(x, x->idn == 100 ? 0x7fff : 0x1001);
}

static int soe_write(struct ec_ioc_soe *x)
{
	char what[64];

	if (x->idn == 30)
		return soe_error(x, 0x7004);
	snprintf(what, sizeof(what), "soe %u %u 0x%04x ", x->position, x->drive, x->idn);
	hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int foe_error(struct ec_ioc_foe *x, __u32 code)
{
	x->error_code = code;
	return fail(EIO, "file: error");
}

/* file "slow" takes 1.5 s, with progress after 0.5 s */
static int foe_read(struct ec_ioc_foe *x)
{
	static const char content[] = "\1\2binary\n";
	volatile __u64 *done = (volatile __u64 *)(uintptr_t)x->done;

	if (!strcmp(x->name, "none"))
		return foe_error(x, 0x8001);
	if (!strcmp(x->name, "strange"))
		return foe_error(x, 0x9999);
	if (!strcmp(x->name, "mute"))
		return fail(ETIMEDOUT, "slave 2 did not answer in time");
	if (!strcmp(x->name, "slow")) {
		usleep(500000);
		*done = 5;
		usleep(1000000);
	}
	x->size = x->password == 7 ? 0 : sizeof(content) - 1;
	memcpy((void *)(uintptr_t)x->data, content, x->size);
	*done = x->size;
	return 0;
}

static int foe_write(struct ec_ioc_foe *x)
{
	char what[128];

	if (!strcmp(x->name, "full"))
		return foe_error(x, 0x8003);
	snprintf(what, sizeof(what), "foe %u %.64s 0x%08x ", x->position, x->name, x->password);
	hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int reg_read(struct ec_ioc_reg *x)
{
	__u8 *to = (__u8 *)(uintptr_t)x->data;

	if (!x->size || x->size > 1024)
		return fail(EINVAL, "1 to 1024 bytes");
	for (__u32 i = 0; i < x->size; i++) {
		__u32 a = x->address + i;

		to[i] = a == 0x0130 ? 0x12 : 0;
		if (!x->position && a == 0x0302)
			to[i] = 3;
		if (!x->position && a == 0x0309)
			to[i] = 1;
		if (a == 0xffff)
			to[i] = 0x77;
		/* slave 2: latch 0 is high and has seen it rise, latch 1 is the slave's */
		if (x->position == 2 && (a == 0x0980 || a == 0x09ae || a == 0x09b0 || a == 0x09a9))
			to[i] = a == 0x0980 ? 0x20 : a == 0x09ae ? 5 : a == 0x09a9 ? 1 : 0x15;
	}
	return 0;
}

static int reg_write(struct ec_ioc_reg *x)
{
	char what[64];

	snprintf(what, sizeof(what), "reg %u 0x%04x%s ", x->position, x->address,
		 x->flags ? " emergency" : "");
	hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int sii(struct ec_ioc_sii *x)
{
	/* fixed area, then General (2 words) and the end */
	__u8 image[0xa0] = { [0x10] = 2, [0x80] = 0x1e, [0x82] = 2, [0x84] = 1, 2, 3, 4,
			     [0x88] = 0xff, 0xff };

	if (x->offset >= sizeof(image))
		return fail(EINVAL, "beyond the image");
	if (x->size > 64)
		x->size = 64;	/* in pieces */
	if (x->size > sizeof(image) - x->offset)
		x->size = sizeof(image) - x->offset;
	memcpy((void *)(uintptr_t)x->data, image + x->offset, x->size);
	return 0;
}

static const struct ec_ip_params net = {
	.which = EC_IP_MAC | EC_IP_ADDRESS | EC_IP_MASK | EC_IP_HOSTNAME,
	.mac = { 2, 0, 0, 0xec, 1, 7 }, .ip = { 192, 168, 0, 17 },
	.mask = { 255, 255, 255, 0 }, .name = "mixer",
};

/* slave 2 has EoE, slave 1 has none, slave 0 refuses */
static int ip(struct ec_ioc_ip *x, bool write)
{
	const struct ec_ip_params *p = &x->params;

	if (x->position == 1)
		return fail(EPROTONOSUPPORT, "slave 1 has no EoE mailbox");
	if (!x->position) {
		x->result = 0x0201;
		return fail(EIO, "slave 0: IP parameters refused: EoE result 0x0201 (the slave does not support IP)");
	}
	if (!write) {
		x->params = net;
		if (bus("evil"))
			memcpy(x->params.name, "\033[2J\302\233bbbbbbbbbbbbbbbbbbbbbbbbbb", 32);
		return 0;
	}
	record("ip %u 0x%02x %.32s\n", x->position, p->which, p->name);
	hex("", p->mac, sizeof(p->mac));
	hex("", p->ip, sizeof(p->ip));
	hex("", p->mask, sizeof(p->mask));
	hex("", p->gateway, sizeof(p->gateway));
	hex("", p->dns, sizeof(p->dns));
	return 0;
}

int sys_ioctl(int fd, unsigned long request, void *arg)
{
	unsigned int nr = _IOC_NR(request);

	ioctls++;
	if (bus("foreign")) {
		errno = ENOTTY;
		return -1;
	}
	if (nr >= 0x20 && !writable[fd - FD])
		return fail(EPERM, "the file is open for reading only");
	switch (request) {
	case EC_IOC_VERSION:
		*(struct ec_ioc_version *)arg = (struct ec_ioc_version){
			.abi = EC_UAPI_VERSION, .master_count = bus("two") ? 2 : 1,
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
	case EC_IOC_CONFIG: {
		struct ec_ioc_config *c = arg;
		__u32 i = c->index;

		*c = configs[i];
		c->index = i;
		return 0;
	}
	case EC_IOC_CONFIG_SM:
		return config_sm(arg);
	case EC_IOC_CONFIG_PDO:
		((struct ec_ioc_config_pdo *)arg)->pdo_index = 0x1600;
		((struct ec_ioc_config_pdo *)arg)->entry_count = 1;
		return 0;
	case EC_IOC_CONFIG_ENTRY:
		((struct ec_ioc_config_entry *)arg)->entry_index = 0x7010;
		((struct ec_ioc_config_entry *)arg)->subindex = 1;
		((struct ec_ioc_config_entry *)arg)->bits = 16;
		return 0;
	case EC_IOC_CONFIG_SDO:
		return config_sdo(arg);
	case EC_IOC_CONFIG_IDN:
		return config_idn(arg);
	case EC_IOC_CYCLE_STATS:
		return cycle_stats(arg);
	case EC_IOC_CYCLE_RESET:
		record("cycle reset\n");
		return 0;
	case EC_IOC_CONFIG_FLAG:
		return config_flag(arg);
	case EC_IOC_DOMAIN:
		*(struct ec_ioc_domain *)arg = domains[((struct ec_ioc_domain *)arg)->index];
		return 0;
	case EC_IOC_DOMAIN_FMMU:
		return domain_fmmu(arg);
	case EC_IOC_DOMAIN_DATA:
		return domain_data(arg);
	case EC_IOC_CONFIG_IP:
		if (((struct ec_ioc_sc_ip *)arg)->config == 1)
			((struct ec_ioc_sc_ip *)arg)->params = net;
		return 0;
	case EC_IOC_CONFIG_WHY:
		if (((struct ec_ioc_config_why *)arg)->index == 1)
			strcpy(((struct ec_ioc_config_why *)arg)->text,
			       bus("evil") ? "\033[2J" : "no slave at ring position 2: 2 slave(s) connected");
		return 0;
	case EC_IOC_IP_GET:
	case EC_IOC_IP_SET:
		return ip(arg, request == EC_IOC_IP_SET);
	case EC_IOC_SDO_UPLOAD:
		return upload(arg);
	case EC_IOC_SDO_DOWNLOAD:
		return download(arg);
	case EC_IOC_EMERGENCIES:
		return emergencies(arg);
	case EC_IOC_SDO_INFO:
		return sdo_info(arg);
	case EC_IOC_SOE_READ:
		return soe_read(arg);
	case EC_IOC_SOE_WRITE:
		return soe_write(arg);
	case EC_IOC_FOE_READ:
		return foe_read(arg);
	case EC_IOC_FOE_WRITE:
		return foe_write(arg);
	case EC_IOC_REG_READ:
		return reg_read(arg);
	case EC_IOC_REG_WRITE:
		return reg_write(arg);
	case EC_IOC_STATE:
		return request_state(arg);
	case EC_IOC_RESCAN:
		record("rescan %d\n", fd - FD);
		scans = 2;
		polls = 0;
		return 0;
	case EC_IOC_END_DETACHED:
		if (!bus("detached"))
			return fail(ENOENT, "master 0 has no session");
		record("release %d\n", fd - FD);
		return 0;
	case EC_IOC_DEVICE_USE:
		record("use %d %s\n", fd - FD, ((struct ec_ioc_device_use *)arg)->name);
		return 0;
	case EC_IOC_DEBUG:
		record("debug %d %u\n", fd - FD, ((struct ec_ioc_debug *)arg)->level);
		return 0;
	default:
		errno = ENOTTY;
		return -1;
	}
}
