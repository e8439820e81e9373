// SPDX-License-Identifier: GPL-2.0-only
/*
 * Datagrams of every command: what slaves do with them, which of them are refused while an
 * application runs the bus, and how they end without a link.
 */
#include <linux/cred.h>
#include "kapp.h"
#include "master/boundary/ioctl.h"

#define N	3
#define RAM	0x0f80	/* registers that the chip does not use */

static const char text[] =
	"segment seed=3 response=50us transition=200us\n"
	"slave a io in=8 out=8\nslave b io in=8 out=8\nslave c io in=8 out=8\n";

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);

	bus_idle(b);
	return b;
}

static u32 at(u16 adp, u16 ado)
{
	return adp | (u32)ado << 16;
}

/* Send; the working counter, or -errno. */
static int datagram(struct bus *b, u8 command, u32 address, void *data, u32 size)
{
	struct ec_ioc_datagram d = {
		.command = command, .address = address, .size = size, .data = (uintptr_t)data,
		.working_counter = 0x7777,
	};
	int ret = ec_ioc(&b->app, EC_IOC_DATAGRAM, &d);

	return ret ?: d.working_counter;
}

static u8 *ram(struct bus *b, u32 position)
{
	return &bus_esc(b, position)->mem[RAM];
}

/* Of each slave another value. */
static void fill(struct bus *b)
{
	u32 i;

	for (i = 0; i < N; i++) {
		ram(b, i)[0] = 0x10 << i;
		ram(b, i)[1] = 0x01 << i;
	}
}

static void expect_ram(struct bus *b, u16 first, u16 second, u16 third)
{
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(ram(b, 0)), first);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(ram(b, 1)), second);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(ram(b, 2)), third);
}

/* One slave, by position or station: it reads, writes, or both. */
static void datagram_one_slave(struct kunit *test)
{
	static const struct {
		u8 command[2];
		int wkc;
		bool reads, writes;
	} rows[] = {
		{ { EC_CMD_APRD, EC_CMD_FPRD }, 1, true, false },
		{ { EC_CMD_APWR, EC_CMD_FPWR }, 1, false, true },
		{ { EC_CMD_APRW, EC_CMD_FPRW }, 3, true, true },
	};
	struct bus *b = ready(test);
	u16 to[2] = { -1, bus_slave(b, 1)->station };
	u32 i, k;

	for (i = 0; i < 2 * ARRAY_SIZE(rows); i++) {
		u8 data[2] = { 0xcd, 0xab };

		k = i / 2;
		fill(b);
		KUNIT_EXPECT_EQ(test, datagram(b, rows[k].command[i % 2], at(to[i % 2], RAM), data,
					       sizeof(data)), rows[k].wkc);
		KUNIT_EXPECT_EQ(test, get_unaligned_le16(data), rows[k].reads ? 0x0220 : 0xabcd);
		expect_ram(b, 0x0110, rows[k].writes ? 0xabcd : 0x0220, 0x0440);
	}
	/* no slave has this station or position */
	for (i = 0; i < 2; i++) {
		u8 data[2] = { 0xcd, 0xab };

		fill(b);
		KUNIT_EXPECT_EQ(test, datagram(b, rows[2].command[i], at(0x7fff, RAM), data,
					       sizeof(data)), 0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le16(data), 0xabcd);
		expect_ram(b, 0x0110, 0x0220, 0x0440);
	}
}

/* All slaves: OR of what they contain, the same value for each, and from one to the others. */
static void datagram_all_slaves(struct kunit *test)
{
	struct bus *b = ready(test);
	u8 data[2] = { 0 };

	fill(b);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, at(0, RAM), data, 2), N);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(data), 0x0770);
	put_unaligned_le16(0x1234, data);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BWR, at(0, RAM), data, 2), N);
	expect_ram(b, 0x1234, 0x1234, 0x1234);
	put_unaligned_le16(0x4321, data);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRW, at(0, RAM), data, 2), 3 * N);
	KUNIT_EXPECT_NE(test, get_unaligned_le16(data), 0x4321);
	fill(b);
	/* the slave that is read is the first one */
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_ARMW, at(0, RAM), data, 2), N);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(data), 0x0110);
	expect_ram(b, 0x0110, 0x0110, 0x0110);
	fill(b);
	put_unaligned_le16(0x5555, data);
	/* the one before it gets what was sent */
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_FRMW, at(bus_slave(b, 1)->station, RAM), data, 2),
			N);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(data), 0x0220);
	expect_ram(b, 0x5555, 0x0220, 0x0220);
}

static void datagram_no_slave(struct kunit *test)
{
	static const u8 commands[] = { EC_CMD_NOP, EC_CMD_LRD, EC_CMD_LWR, EC_CMD_LRW };
	struct bus *b = ready(test);
	u32 i;

	for (i = 0; i < ARRAY_SIZE(commands); i++) {
		u8 data[2] = { 0xcd, 0xab };

		/* no FMMU has this address */
		KUNIT_EXPECT_EQ(test, datagram(b, commands[i], 0x70000000, data, 2), 0);
		if (commands[i] != EC_CMD_LRD)
			KUNIT_EXPECT_EQ(test, get_unaligned_le16(data), 0xabcd);
	}
}

static void datagram_invalid(struct kunit *test)
{
	static u8 data[EC_MAX_DATAGRAM_SIZE + 1];
	struct bus *b = ready(test);

	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, 0, data, 0), -EINVAL);
	KUNIT_EXPECT_STREQ(test, b->app.reason, "a datagram has 1 to 1486 bytes, not 0");
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, 0, data, sizeof(data)), -EINVAL);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, 0, data, ~0u), -EINVAL);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, 0, data, sizeof(data) - 1), N);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_FRMW + 1, 0, data, 1), -EINVAL);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "15 is no EtherCAT command; use 0 (NOP) to 14 (FRMW)");
	KUNIT_EXPECT_EQ(test, datagram(b, 255, 0, data, 1), -EINVAL);
}

static void datagram_no_link(struct kunit *test)
{
	struct bus *b = ready(test);
	u8 data[2] = { 0 };

	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, at(0, RAM), data, 2), -ETIMEDOUT);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, at(0, RAM), data, 2), -ENETDOWN);
	ec_sim_link_destroy(b->link);
	b->link = NULL;
	b->sim = NULL;
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, at(0, RAM), data, 2), -ENODEV);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "datagram of command 7 to 0x0f800000: the main device is missing or has no link; check the cable");
}

/* who may what ---------------------------------------------------------------*/

/* The call as by a user without privileges. */
static int as_user(struct bus *b, int (*call)(struct bus *b, u8 command, u16 ado, u16 len),
		   u8 command, u16 ado, u16 len)
{
	struct cred *user = prepare_creds();
	const struct cred *before;
	int ret;

	KUNIT_ASSERT_NOT_NULL(b->test, user);
	cap_clear(user->cap_effective);
	before = override_creds(user);
	ret = call(b, command, ado, len);
	revert_creds(before);
	put_cred(user);
	return ret;
}

/* to a station that no slave has: nothing is changed */
static int raw(struct bus *b, u8 command, u16 ado, u16 len)
{
	static u8 data[256];

	return datagram(b, command, at(0x7fff, ado), data, len);
}

static int reg(struct bus *b, u8 command, u16 ado, u16 len)
{
	static u8 data[256];
	struct ec_ioc_reg r = {
		.address = ado, .size = len, .data = (uintptr_t)data,
		.flags = command == EC_CMD_APWR || command == EC_CMD_APRD ?
			 EC_REG_FLAG_EMERGENCY : 0,
	};

	memcpy(data, &bus_esc(b, 0)->mem[ado], len);
	if (command == EC_CMD_APRD || command == EC_CMD_FPRD)
		return ec_ioc(&b->app, EC_IOC_REG_READ, &r);
	return ec_ioc(&b->app, command == EC_CMD_FPRW ? EC_IOC_REG_RDWR : EC_IOC_REG_WRITE, &r);
}

static const struct {
	u16 ado, len;
	const char *name;	/* NULL: it does not run the bus */
} registers[] = {
	{ 0x000f, 1 }, { 0x0010, 2, "station address" }, { 0x0008, 9, "station address" },
	{ 0x0012, 2 }, { 0x0100, 1, "DL control" }, { 0x00ff, 1 }, { 0x0103, 1, "DL control" },
	{ 0x0104, 2 }, { 0x0120, 2, "AL control" }, { 0x0121, 1, "AL control" },
	{ 0x0200, 2, "event mask" }, { 0x0300, 20 }, { 0x0420, 2 }, { 0x0500, 1 },
	{ 0x0502, 8 }, { 0x0600, 1, "FMMU" }, { 0x06ff, 1, "FMMU" }, { 0x0700, 1 },
	{ 0x07ff, 1 }, { 0x0800, 1, "SyncManager" }, { 0x07fc, 8, "SyncManager" },
	{ 0x087f, 1, "SyncManager" }, { 0x0880, 1 }, { 0x0900, 4, "distributed clock" },
	{ 0x09a7, 1, "distributed clock" }, { 0x09a8, 2 }, { RAM, 128 },
};

static const struct {
	u8 command;
	const char *name;
} everywhere[] = {
	{ EC_CMD_BWR, "all slaves" }, { EC_CMD_BRW, "all slaves" }, { EC_CMD_ARMW, "all slaves" },
	{ EC_CMD_FRMW, "all slaves" }, { EC_CMD_LWR, "a logical address" },
	{ EC_CMD_LRW, "a logical address" },
};

static void expect_refused(struct bus *b, int ret, const char *name)
{
	char what[64];

	scnprintf(what, sizeof(what), "a write to %s needs CAP_SYS_ADMIN (root)", name);
	KUNIT_EXPECT_EQ(b->test, ret, -EPERM);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(b->app.reason, what), "'%s' has no '%s'",
				  b->app.reason, what);
}

static void expect_rule(struct bus *b, bool active)
{
	static const u8 writes[] = { EC_CMD_APWR, EC_CMD_APRW, EC_CMD_FPWR, EC_CMD_FPRW };
	static const u8 reads[] = { EC_CMD_NOP, EC_CMD_APRD, EC_CMD_FPRD };
	u32 i, k;

	for (i = 0; i < ARRAY_SIZE(registers); i++) {
		u16 ado = registers[i].ado, len = registers[i].len;

		for (k = 0; k < ARRAY_SIZE(writes); k++) {
			int ret = as_user(b, raw, writes[k], ado, len);

			if (active && registers[i].name)
				expect_refused(b, ret, registers[i].name);
			else
				KUNIT_EXPECT_EQ(b->test, ret, 0);
		}
		for (k = 0; k < ARRAY_SIZE(reads); k++)
			KUNIT_EXPECT_EQ(b->test, as_user(b, raw, reads[k], ado, len), 0);
	}
	for (i = 0; active && i < ARRAY_SIZE(everywhere); i++)
		expect_refused(b, as_user(b, raw, everywhere[i].command, RAM, 1),
			       everywhere[i].name);
	KUNIT_EXPECT_EQ(b->test, as_user(b, raw, EC_CMD_BRD, 0x0120, 2), N);
	KUNIT_EXPECT_EQ(b->test, as_user(b, raw, EC_CMD_LRD, 0x0120, 2), 0);
}

/* An application that runs the bus and is not the caller. */
static struct kapp *others(struct bus *b)
{
	struct kapp *k = kapp_new(b, 1000);
	u32 i;

	for (i = 0; i < N; i++)
		kapp_map(k, i);
	kapp_kernel_cycle(k, (ec_cycle_config_t){ 0 });
	return k;
}

static void datagram_rule(struct kunit *test)
{
	struct bus *b = ready(test);
	struct kapp *k;

	expect_rule(b, false);
	k = others(b);
	/* reserved and not active: slaves are not run */
	expect_rule(b, false);
	kapp_op(k);
	expect_rule(b, true);
	/* root */
	KUNIT_EXPECT_EQ(test, raw(b, EC_CMD_FPWR, EC_REG_AL_CONTROL, 2), 0);
	KUNIT_EXPECT_EQ(test, raw(b, EC_CMD_BWR, RAM, 1), N);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
	expect_rule(b, false);
	ecrt_release_master(k->m);
}

static void datagram_register_rule(struct kunit *test)
{
	struct bus *b = ready(test);
	struct kapp *k = others(b);
	u32 i;

	kapp_op(k);
	for (i = 0; i < ARRAY_SIZE(registers); i++) {
		u16 ado = registers[i].ado, len = registers[i].len;

		if (registers[i].name) {
			expect_refused(b, as_user(b, reg, EC_CMD_FPWR, ado, len),
				       registers[i].name);
			expect_refused(b, as_user(b, reg, EC_CMD_APWR, ado, len),
				       registers[i].name);
			expect_refused(b, as_user(b, reg, EC_CMD_FPRW, ado, len),
				       registers[i].name);
		}
		/* -EIO: the simulated chip lacks the register */
		KUNIT_EXPECT_NE(test, as_user(b, reg, EC_CMD_FPRD, ado, len), -EPERM);
	}
	/* the recovery of a drive */
	KUNIT_EXPECT_EQ(test, as_user(b, reg, EC_CMD_FPWR, EC_REG_EEP_OWNER, 1), 0);
	KUNIT_EXPECT_EQ(test, as_user(b, reg, EC_CMD_APWR, EC_REG_EEP_OWNER, 1), 0);
	KUNIT_EXPECT_EQ(test, as_user(b, reg, EC_CMD_FPWR, EC_REG_DC_LATCH0_CTRL, 1), 0);
	/* root */
	KUNIT_EXPECT_EQ(test, reg(b, EC_CMD_FPWR, EC_REG_ECAT_MASK, 2), 0);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
	ecrt_release_master(k->m);
}

/* The longest datagram, beside a cycle in which it has no room: it delays one at most. */
static void datagram_beside_cycle(struct kunit *test)
{
	static u8 data[EC_MAX_DATAGRAM_SIZE];
	struct bus *b = ready(test);
	struct kapp *k = others(b);

	k->period_ns = 100 * NSEC_PER_USEC;
	kapp_kernel_cycle(k, (ec_cycle_config_t){ 0 });
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, 0, data, 2), N);
	KUNIT_EXPECT_EQ(test, datagram(b, EC_CMD_BRD, 0, data, sizeof(data)), N);
	kapp_run(k, 20);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
	ecrt_release_master(k->m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(datagram_one_slave),
	KUNIT_CASE(datagram_all_slaves),
	KUNIT_CASE(datagram_no_slave),
	KUNIT_CASE(datagram_invalid),
	KUNIT_CASE(datagram_no_link),
	KUNIT_CASE(datagram_rule),
	KUNIT_CASE(datagram_register_rule),
	KUNIT_CASE(datagram_beside_cycle),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_datagram",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
