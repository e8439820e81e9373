// SPDX-License-Identifier: GPL-2.0-only
/* Fake master: its slaves, of tables, and the commands for one of them. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "fake.h"

static const struct fake_slave slaves[FAKE_SLAVES] = {
	{
		.position = 0, .station = 0x03e9, .al_status = 2, .al_requested = 2,
		.vendor_id = 2, .product_code = 0x044c2c52, .revision_number = 0x00110000,
		.dc_supported = 2, .has_general = 1, .current_ma = -2000, .dl_status = 0x5530,
		.sii_words = 0x50, .fmmu_count = 2,
		.ports = {
			{ 3, 1, 0, 1, 1000, EC_UAPI_NONE16, 0 },
			{ 2, 1, 0, 1, 1290, 1, 145 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0 },
		},
		.group = "Couplers", .order = "EK1100", .name = "EK1100 Coupler",
	}, {
		.position = 1, .station = 0x03ea, .alias = 1001, .alias_group = 1001,
		.al_status = 2, .al_requested = 2, .vendor_id = 2, .product_code = 0x07d83052,
		.revision_number = 0x00100000, .dc_supported = 1, .dc_delay_only = 1,
		.has_general = 1, .current_ma = 110, .sm_count = 1, .fmmu_count = 1,
		.transmission_delay = 145, .sii_words = 0x50,
		.ports = {
			{ 2, 1, 0, 1, 3000, 0, 145 },
			{ 2, 1, 0, 1, 2990, 2, 145 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0 },
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
			{ 2, 1, 0, 1, 5000, 1, 145 },
			{ 2, 0, 1, 0, 0, EC_UAPI_NONE16, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0 },
			{ 0, 0, 1, 0, 0, EC_UAPI_NONE16, 0 },
		},
		.group = "Terminals", .order = "EL7201", .name = "EL7201 servo terminal",
		.why = "SM2 has 8 bytes configured, the slave expects 6",
	},
};

#define AT(p)	.slave.position = (p)

static const struct ec_ioc_sm sms[] = {
	{ AT(1), .sm = 0, .start = 0x0f00, .default_size = 1, .control = 0x44, .enable = 1,
	  .pdo_count = 2 },
	{ AT(2), .sm = 0, .start = 0x1000, .default_size = 256, .control = 0x26,
	  .enable = 1 },
	{ AT(2), .sm = 1, .start = 0x1100, .default_size = 256, .control = 0x22,
	  .enable = 1 },
	{ AT(2), .sm = 2, .start = 0x1200, .default_size = 6, .control = 0x24,
	  .enable = 1, .pdo_count = 1 },
	{ AT(2), .sm = 3, .start = 0x1300, .default_size = 6, .control = 0x20,
	  .enable = 1, .pdo_count = 1 },
};

static const struct ec_ioc_pdo pdos[] = {
	{ AT(1), .sm = 0, .pdo_pos = 0, .index = 0x1600, .entry_count = 1,
	  .name = "Channel 1" },
	{ AT(1), .sm = 0, .pdo_pos = 1, .index = 0x1601, .entry_count = 1,
	  .name = "Channel */ 2" },
	{ AT(2), .sm = 2, .pdo_pos = 0, .index = 0x1600, .entry_count = 1,
	  .name = "DRV Controlword" },
	{ AT(2), .sm = 3, .pdo_pos = 0, .index = 0x1a00, .entry_count = 2,
	  .name = "FB Position" },
};

static const struct ec_ioc_pdo_entry entries[] = {
	{ AT(1), .sm = 0, .pdo_pos = 0, .entry_pos = 0, .index = 0x7000, .subindex = 1,
	  .bits = 1, .name = "Output" },
	{ AT(1), .sm = 0, .pdo_pos = 1, .entry_pos = 0, .index = 0x7010, .subindex = 1,
	  .bits = 1, .name = "Output" },
	{ AT(2), .sm = 2, .pdo_pos = 0, .entry_pos = 0, .index = 0x7010, .subindex = 1,
	  .bits = 16, .name = "Controlword" },
	{ AT(2), .sm = 3, .pdo_pos = 0, .entry_pos = 0, .index = 0x6000, .subindex = 0x11,
	  .bits = 32, .name = "Position" },
	{ AT(2), .sm = 3, .pdo_pos = 0, .entry_pos = 1, .index = 0, .subindex = 0,
	  .bits = 16 },
};

static struct fake_slave state[FAKE_SLAVES];

/* slave 2 hangs at the master by its port 1, slave 0 behind its port 0 */
static void reversed(struct fake_slave *s)
{
	if (s->position == 0) {
		s->ports[0].next_slave = 2;
	} else if (s->position == 1) {
		s->ports[1] = (struct fake_port){ 2, 0, 1, 0, 0, EC_UAPI_NONE16, 0 };
	} else {
		s->ports[0].next_slave = 0;
		s->ports[1] = (struct fake_port){ 3, 1, 0, 1, 4000, EC_UAPI_NONE16, 0 };
		s->dc_odd = 1;
	}
}

/* @s: its position is set */
static int slave(struct fake_slave *s)
{
	if (fake_bus("big") && s->position < FAKE_BIG) {
		__u16 p = s->position;

		*s = slaves[1];
		s->position = p;
		s->alias = p % 100 ? 0 : p / 100 + 1;
		s->alias_group = p / 100 + 1;
		s->alias_pos = p % 100;
		return 0;
	}
	if (s->position >= FAKE_SLAVES)
		return fake_fail(EINVAL, "there is no such slave");
	if (!state[s->position].vendor_id)
		state[s->position] = slaves[s->position];
	*s = state[s->position];
	if (getenv("FAKE_SII"))
		s->sii_words = 0x80;
	if (fake_bus("cut") && s->position == 2)
		s->device_index = 1;
	/* all have the same alias */
	if (getenv("FAKE_ALIAS"))
		s->alias = (__u16)atoi(getenv("FAKE_ALIAS"));
	if (getenv("FAKE_ORDER"))
		snprintf(s->order, sizeof(s->order), "%s", getenv("FAKE_ORDER"));
	if (fake_bus("reversed"))
		reversed(s);
	fake_glance_slave(s);
	fake_run_slave(s);
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
		snprintf(s->name, sizeof(s->name), "%s",
			 "\033[2J\302\233H\2341m"
			 "\342\200\256 Gr\303\266\337e\r\n\177");
		snprintf(s->order, sizeof(s->order), "%s", "*/ \"x\\ /* int");
		memset(s->group, 'g', sizeof(s->group));	/* no end */
	}
	return 0;
}

int fake_slave_get(__u16 position, struct fake_slave *s)
{
	int ret;

	*s = (struct fake_slave){ .position = position };
	ret = slave(s);
	if (ret)
		return ret;
	s->device = FAKE_DEVICE + position;
	fake_why_slave(s);
	return 0;
}

static int request_state(const struct ec_ioc_state *r)
{
	const __u16 p = r->slave.position;
	struct fake_slave s;

	if (fake_slave_get(p, &s))
		return -1;
	fake_record("state %u %u\n", p, r->state);
	state[p].al_requested = r->state;
	state[p].error = 0;
	state[p].why[0] = 0;
	if (p == 2 && r->state == 8)
		return 0;	/* never gets there */
	state[p].al_status = r->state;
	state[p].al_code = 0;
	if (p == 2 && r->state == 4) {
		state[p].al_status = 0x12;
		state[p].al_code = 0x001e;
		state[p].error = EC_SLAVE_CONFIG_FAILED;
		strcpy(state[p].why, "SAFEOP refused: AL status code 0x001e (inputs)");
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
	FIND(sms, t_->slave.position == x->slave.position && t_->sm == x->sm);
}

static int pdo(struct ec_ioc_pdo *x)
{
	if (fake_bus("evil") && x->slave.position == 2 && x->sm == 2) {
		*x = (struct ec_ioc_pdo){ AT(2), .sm = 2, .index = 0x1600, .entry_count = 1,
			.name = "*/*/ int /*/ \\" };
		return 0;
	}
	FIND(pdos, t_->slave.position == x->slave.position && t_->sm == x->sm &&
	     t_->pdo_pos == x->pdo_pos);
}

static int entry(struct ec_ioc_pdo_entry *x)
{
	FIND(entries, t_->slave.position == x->slave.position && t_->sm == x->sm &&
	     t_->pdo_pos == x->pdo_pos && t_->entry_pos == x->entry_pos);
}


static int reg_read(struct ec_ioc_reg *x)
{
	__u8 *to = (__u8 *)(uintptr_t)x->data;
	static unsigned int lost;

	if (!x->size || x->size > 1024)
		return fake_fail(EINVAL, "1 to 1024 bytes");
	if ((fake_bus("mute") && x->slave.position == 1) || (fake_bus("lossy") && lost++ % 4 != 3))
		return fake_fail(ETIMEDOUT, "no reply to register access");
	for (__u32 i = 0; i < x->size; i++) {
		__u32 a = x->address + i;

		to[i] = a == 0x0130 ? 0x12 : 0;
		if (!x->slave.position && a == 0x0302)
			to[i] = 3;
		if (!x->slave.position && a == 0x0309)
			to[i] = 1;
		if (a == 0xffff)
			to[i] = 0x77;
		/*
		 * slave 2: latch 0 is high and has seen it rise, latch 1 is the slave's,
		 * with FAKE_LATCHES both are
		 */
		if (x->slave.position == 2 &&
		    (a == 0x0980 || a == 0x09ae || a == 0x09b0 || a == 0x09a9))
			to[i] = a == 0x0980 ? (getenv("FAKE_LATCHES") ? 0x30 : 0x20) :
				a == 0x09ae ? 5 : a == 0x09a9 ? 1 : 0x15;
	}
	fake_glance_registers(x, to);
	return 0;
}

static int reg_write(struct ec_ioc_reg *x)
{
	char what[64];

	snprintf(what, sizeof(what), "reg %u 0x%04x%s ", x->slave.position, x->address,
		 x->flags ? " emergency" : "");
	fake_hex(what, (const __u8 *)(uintptr_t)x->data, x->size);
	return 0;
}

static int reg_rdwr(struct ec_ioc_reg *x)
{
	reg_write(x);
	return reg_read(x);
}

/* three slaves whose registers count up from 0x40 */
static int any_command(struct ec_ioc_datagram *x)
{
	static const __u8 per_slave[] = { 0, 0, 0, 0, 0, 0, 0, 1, 1, 3, 0, 0, 0, 1, 1 };
	static const __u8 single[] = { 0, 1, 1, 3, 1, 1, 3 };
	__u8 *data = (__u8 *)(uintptr_t)x->data;
	char what[64];

	if (!x->size || x->size > 1486)
		return fake_fail(EINVAL, "a datagram has 1 to 1486 bytes");
	if (fake_bus("app") && x->command == 8)
		return fake_fail(EPERM, "process 7 (demo) runs the bus");
	snprintf(what, sizeof(what), "datagram %u 0x%08x ", x->command, x->address);
	fake_hex(what, data, x->size);
	x->working_counter = x->command < 7 ? single[x->command] : 3 * per_slave[x->command];
	for (__u32 i = 0; x->working_counter != 0 && i < x->size; i++)
		if (x->command != 2 && x->command != 5 && x->command != 8)
			data[i] = (__u8)(0x40 + i);
	return 0;
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

/* FAKE_REFUSE: neither; FAKE_RUNS: the slave is in OP; FAKE_RELOAD: it sets its register */
static int sii_write(struct ec_ioc_sii_write *x)
{
	const __u8 *data = (const __u8 *)(uintptr_t)x->data;

	if (getenv("FAKE_REFUSE"))
		return fake_fail(EBADMSG, "EEPROM of slave 2: the image moves the mailboxes");
	fake_record("sii_write %u: %u bytes, checksum 0x%02x, flags 0x%x\n", x->slave.position,
		    x->size, x->size > 14 ? data[14] : 0, x->flags);
	x->differ = 3;
	x->written = x->flags & EC_SII_FLAG_DRY_RUN ? 0 : 3;
	x->renewed = !getenv("FAKE_RUNS");
	return 0;
}

static int alias(struct ec_ioc_alias *x)
{
	if (getenv("FAKE_REFUSE"))
		return fake_fail(EBUSY, "EEPROM of slave 2: the slave is in OP");
	fake_record("alias %u: %u, flags 0x%x\n", x->slave.position, x->alias, x->flags);
	x->register_alias = getenv("FAKE_RELOAD") ? x->alias : 0;
	x->renewed = !getenv("FAKE_RUNS");
	return 0;
}

static int names(struct ec_ioc_slave_names *x)
{
	struct fake_slave s;

	if (fake_slave_get(x->slave.position, &s))
		return -1;
	memcpy(x->group, s.group, sizeof(x->group));
	memcpy(x->image, s.image, sizeof(x->image));
	memcpy(x->order, s.order, sizeof(x->order));
	memcpy(x->name, s.name, sizeof(x->name));
	return 0;
}

static int why(struct ec_ioc_slave_why *x)
{
	struct fake_slave s;

	if (fake_slave_get(x->slave.position, &s))
		return -1;
	memcpy(x->why, s.why, sizeof(x->why));
	memcpy(x->warning, s.warning, sizeof(x->warning));
	x->cause = s.cause;
	return 0;
}

/* FAKE_BORDER: a device that is not the group at port 2 of slave 1; "boot": it was not read */
static void kept_out(struct ec_ioc_port *x)
{
	x->kept = EC_PORT_SIGN;
	x->slaves = 3;
	x->alias = 7;
	x->identification = 9;
	if (!strcmp(getenv("FAKE_BORDER"), "boot")) {
		x->kept = EC_PORT_BOOT;
		return;
	}
	x->vendor_id = 2;
	x->product_code = 0x07d83052;
	x->revision_number = 0x110000;
	x->serial_number = 61;
	strcpy(x->name, "EL\"2008\x1b");
}

static int port(struct ec_ioc_port *x)
{
	struct fake_slave s;
	const struct fake_port *p;

	if (x->port >= EC_UAPI_PORTS)
		return fake_fail(EINVAL, "there is no such port");
	if (fake_slave_get(x->slave.position, &s))
		return -1;
	p = &s.ports[x->port];
	x->type = p->type;
	x->link_up = p->link_up;
	x->loop_closed = p->loop_closed;
	x->signal = p->signal;
	x->receive_time = p->receive_time;
	x->next_slave = p->next_slave;
	x->delay_to_next_dc = p->delay_to_next_dc;
	if (getenv("FAKE_ABSENT") && x->port == 3) {
		x->kept = s.position ? EC_PORT_NO_REPLY : EC_PORT_LOSSES;
		x->wait_s = s.position ? 0 : 4;
	}
	if (getenv("FAKE_BORDER") && s.position == 1 && x->port == 2)
		kept_out(x);
	if (fake_bus("emptied") && s.position == 1 && !x->port) {
		x->cleared[0] = 300;
		x->cleared[1] = 7;
		x->cleared[2] = 2;
	}
	/* slave 0 was not read yet, and slave 1 has no counter of lost links */
	x->errors_known = s.position < 2 ? s.position * 3u : 4;
	if (s.position == 1)
		memcpy(x->errors, (const __u32[]){ 300, 7, x->port, 0 }, sizeof(x->errors));
	return 0;
}

static int let_in(const struct ec_ioc_let_in *x)
{
	if (!getenv("FAKE_BORDER") || x->slave.position != 1 || x->port != 2)
		return fake_fail(ENOENT, "no device waits there");
	fake_record("let_in %u %u 0x%x 0x%x 0x%x 0x%x\n", x->slave.position, x->port,
		    x->vendor_id, x->product_code, x->revision_number, x->serial_number);
	return 0;
}

static int state_of(struct ec_ioc_slave *x)
{
	struct fake_slave s;

	if (fake_slave_get(x->slave.position, &s))
		return -1;
	memcpy(x, &s, sizeof(*x));
	return 0;
}

/* FAKE_ABSENT: behind port 2 of slave 0, behind the main device, and a closed port */
static int absent(struct ec_ioc_absent *x)
{
	static const struct ec_ioc_absent ports[] = {
		{ .device = FAKE_DEVICE, .port = 2, .slaves = 7, .first = 1, .last = 7,
		  .since_ns = 3100000000ULL, .name = "EL2008" },
		{ .device = FAKE_DEVICE + 1, .port = 1, .slaves = 1, .first = 2, .last = 2,
		  .since_ns = 300000000000ULL, .name = "EL7201" },
		{ .slaves = 2, .first = 8, .last = 9, .since_ns = 1, .name = "EK1100" },
	};
	__u32 index = x->index;

	if (getenv("FAKE_ABSENT") && index < sizeof(ports) / sizeof(ports[0]))
		*x = ports[index];
	else
		x->slaves = 0;
	x->index = index;
	return 0;
}

int fake_slave_command(unsigned long request, void *arg)
{
	switch (request) {
	case EC_IOC_ABSENT:
		return absent(arg);
	case EC_IOC_SLAVE:
		return state_of(arg);
	case EC_IOC_SLAVE_NAMES:
		return names(arg);
	case EC_IOC_SLAVE_WHY:
		return why(arg);
	case EC_IOC_PORT:
		return port(arg);
	case EC_IOC_LET_IN:
		return let_in(arg);
	case EC_IOC_SM:
		return sm(arg);
	case EC_IOC_PDO:
		return pdo(arg);
	case EC_IOC_PDO_ENTRY:
		return entry(arg);
	case EC_IOC_SII:
		return sii(arg);
	case EC_IOC_SII_WRITE:
		return sii_write(arg);
	case EC_IOC_ALIAS:
		return alias(arg);
	case EC_IOC_REG_READ:
		return reg_read(arg);
	case EC_IOC_REG_WRITE:
		return reg_write(arg);
	case EC_IOC_REG_RDWR:
		return reg_rdwr(arg);
	case EC_IOC_DATAGRAM:
		return any_command(arg);
	case EC_IOC_STATE:
		return request_state(arg);
	default:
		return FAKE_OTHER;
	}
}
