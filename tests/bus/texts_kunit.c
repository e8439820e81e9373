// SPDX-License-Identifier: GPL-2.0-only
/* One text per cause: what a refusal claims has been found so. */
#include "bus.h"
#include "cyc.h"
#include "master/mailbox/coe.h"
#include "master/boundary/ioctl.h"
#include "master/mailbox/mailbox.h"
#include "master/wire/mbox.h"

static const char text[] =
	"segment seed=9 response=200us transition=200us\n"
	"slave coupler EK1100\nslave bad drive serial=5\n";

#define BAD	1

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, text, 2);
	u32 i;

	for (i = 0; i < 1000 && !bus_settled(b); i++)
		msleep(1);
	KUNIT_ASSERT_TRUE(test, bus_settled(b));
	return b;
}

static void expect_text(struct bus *b, const char *want)
{
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(b->app.reason, want), "'%s' has no '%s'",
				  b->app.reason, want);
}

static int upload(struct bus *b, u16 position, u16 index)
{
	u8 data[4];
	struct ec_ioc_sdo i = {
		.slave.position = position, .index = index, .subindex = 1, .size = 4,
		.timeout_ms = 100, .data = (uintptr_t)data,
	};

	return ec_ioc(&b->app, EC_IOC_SDO_UPLOAD, &i);
}

static void texts_sdo(struct kunit *test)
{
	struct bus *b = ready(test);
	u16 size = bus_slave(b, BAD)->info.std.rx_size;

	KUNIT_EXPECT_EQ(test, upload(b, 0, 0x1018), -EPROTONOSUPPORT);
	expect_text(b, "SDO 0x1018:01 of slave 0: no CoE mailbox");
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x5fff), -EIO);
	expect_text(b, "aborted with code 0x06020000: ");
	/* the slave has sent nothing: its mailbox is too small by its EEPROM */
	bus_slave(b, BAD)->info.std.rx_size = 12;
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x1018), -EMSGSIZE);
	expect_text(b,
		    "slave 1: the mailbox is too small for the message, or larger than a datagram");
	bus_slave(b, BAD)->info.std.rx_size = size;
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_SHORT, 0);
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x1018), -EBADMSG);
	expect_text(b, "slave 1: invalid reply");
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_GOOD, 0);
	bus_fault(b, EC_SIM_FAULT_MUTE, BAD, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x1018), -ETIMEDOUT);
	expect_text(b, "slave 1: no reply in time");
	bus_fault(b, EC_SIM_FAULT_MUTE, BAD, 0, 0, 0);
	bus_request(b, BAD, EC_AL_INIT);
	bus_wait_al(b, BAD, EC_AL_INIT, 500);
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x1018), -EAGAIN);
	expect_text(b, "slave 1: not in PREOP or above");
}

/* Each mailbox error reply has the text of its code, the same for a command and an SDO at start. */
static void texts_mailbox_error(struct kunit *test)
{
	static const char * const want[] = {
		"mailbox error reply, unknown code; see the kernel log",
		"mailbox error reply 0x0001 (the mailbox header is wrong)",
		"mailbox error reply 0x0002 (the mailbox protocol is not supported)",
		"mailbox error reply 0x0003 (the channel in the mailbox header is wrong)",
		"mailbox error reply 0x0004 (the service of the mailbox protocol is not supported)",
		"mailbox error reply 0x0005 (the header of the mailbox protocol is wrong)",
		"mailbox error reply 0x0006 (the mailbox message is too short)",
		"mailbox error reply 0x0007 (the slave has no memory left for the mailbox message)",
		"mailbox error reply 0x0008 (the sizes in the mailbox message contradict each other)",
		"mailbox error reply 0x0009 (the slave still works on an earlier request)",
		"mailbox error reply, unknown code; see the kernel log",
	};
	struct bus *b = ready(test);
	char line[128];
	int ret;
	u32 i;

	for (i = 0; i < ARRAY_SIZE(want); i++) {
		bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_ERROR, i);
		ret = upload(b, BAD, 0x1018);
		KUNIT_EXPECT_EQ(test, ret, ec_mbox_error_errno(i));
		scnprintf(line, sizeof(line), "SDO 0x1018:01 of slave 1: %s", want[i]);
		KUNIT_EXPECT_STREQ(test, b->app.reason, line);
	}
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_GOOD, 0);
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x1018), 0);
}

static void texts_startup_mailbox_error(struct kunit *test)
{
	static const u8 value[4];
	struct bus *b = ready(test);
	struct cyc *c = cyc_new(b, 1000);
	u32 config = cyc_config(c, BAD);
	struct ec_ioc_sc_sdo sdo = {
		.config = config, .index = 0x1018, .subindex = 3, .size = 4,
		.data = (uintptr_t)value,
	};

	cyc_map(c, config, 2, cyc_domain(c));
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), 0);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_ERROR, EC_MBOX_ERR_NO_MEMORY);
	cyc_activate(c);
	cyc_run(c, 500);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, BAD)->note.why,
			   "startup SDO 0x1018:03 (4 byte(s)) failed: mailbox error reply 0x0007 (the slave has no memory left for the mailbox message)");
	cyc_release(c);
}

/* A slave that answers nothing is not one that aborts with code 0. */
static void texts_dead(struct kunit *test)
{
	struct bus *b = ready(test);
	int ret;

	bus_fault(b, EC_SIM_FAULT_DEAD, BAD, 0, 1, 0);
	ret = upload(b, BAD, 0x1018);
	KUNIT_EXPECT_LT(test, ret, 0);
	KUNIT_EXPECT_NULL(test, strstr(b->app.reason, "abort"));
	expect_text(b, "SDO 0x1018:01 of slave 1: ");
}

/* Each way in which a register access fails has its text. */
static void texts_register(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_reg reg = { .slave.position = BAD, .address = 0x0130, .size = 2 };

	bus_fault(b, EC_SIM_FAULT_DEAD, BAD, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_READ, &reg), -EIO);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "slave 1 did not execute access to 0x0130: working counter 0, expected 1");
	bus_fault(b, EC_SIM_FAULT_DEAD, BAD, 0, 0, 0);
	/* every frame is lost, the link stays */
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_READ, &reg), -ETIMEDOUT);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "no reply to register access 0x0130 at slave 1; check the cables");
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
}

/* The slave is there and its mailbox is silent. */
static void texts_silent_mailbox(struct kunit *test)
{
	struct bus *b = ready(test);

	bus_fault(b, EC_SIM_FAULT_MUTE, BAD, 0, 1, 0);
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x1018), -ETIMEDOUT);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "SDO 0x1018:01 of slave 1: no reply in time, limit 100 ms; if the slave needs longer, allow more: --timeout, ecrt_slave_config_sdo_timeout()");
}

/* Without a link, and without a device: not the slave is to blame, and no cable behind it. */
static void texts_link(struct kunit *test)
{
	static const char none[] = "the main device is missing or has no link; check the cable";
	static const char reg_none[] =
		"register access 0x0130 at slave 1: the main device is missing or has no link; check the cable";
	struct bus *b = ready(test);
	struct ec_slave *s = ec_slave_ref(bus_slave(b, BAD));
	struct ec_mbox_limit limit = { .timeout_ms = 100 };
	struct ec_ioc_reg reg = {
		.slave.position = BAD, .address = 0x0130, .size = 2, .flags = EC_REG_FLAG_EMERGENCY,
	};
	char why[96];
	u8 v[4];
	size_t got;
	u32 abort;

	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_READ, &reg), -ENETDOWN);
	KUNIT_EXPECT_STREQ(test, b->app.reason, reg_none);
	KUNIT_EXPECT_EQ(test,
			ec_coe_upload(&s->mbox, 0x1018, 1, false, v, sizeof(v), &got, &abort,
				      &limit),
			-ENETDOWN);
	KUNIT_EXPECT_STREQ(test, ec_mbox_fail_text(-ENETDOWN, "CoE", why, sizeof(why)), none);
	ec_sim_link_destroy(b->link);
	b->link = NULL;
	b->sim = NULL;
	b->app.reason[0] = '\0';
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_REG_READ, &reg), -ENODEV);
	KUNIT_EXPECT_STREQ(test, b->app.reason, reg_none);
	KUNIT_EXPECT_STREQ(test, ec_mbox_fail_text(-ENODEV, "CoE", why, sizeof(why)), none);
	ec_slave_unref(s);
}

/* Startup SDO: an abort without a text is one, an error without abort is none. */
static void texts_startup(struct kunit *test)
{
	static const u8 value[4];
	struct bus *b = ready(test);
	struct cyc *c = cyc_new(b, 1000);
	u32 config = cyc_config(c, BAD);
	struct ec_ioc_sc_sdo sdo = {
		.config = config, .index = 0x5fff, .subindex = 3, .size = 4,
		.data = (uintptr_t)value,
	};

	cyc_map(c, config, 2, cyc_domain(c));
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), 0);
	cyc_activate(c);
	cyc_run(c, 500);
	KUNIT_EXPECT_NOT_NULL_MSG(test,
		strstr(bus_slave(b, BAD)->note.why,
		       "startup SDO 0x5fff:03 (4 byte(s)) failed: abort 0x06020000: "),
		"%s", bus_slave(b, BAD)->note.why);
	cyc_release(c);
}

/* An abort code of the vendor has no text: the code is shown, and that it is unknown. */
static void texts_startup_unknown_abort(struct kunit *test)
{
	static const u8 value[4];
	struct bus *b = ready(test);
	struct cyc *c = cyc_new(b, 1000);
	u32 config = cyc_config(c, BAD);
	struct ec_ioc_sc_sdo sdo = {
		.config = config, .index = 0x5fff, .subindex = 3, .size = 4,
		.data = (uintptr_t)value,
	};

	bus_fault(b, EC_SIM_FAULT_MAILBOX, BAD, 0, EC_SIM_MAILBOX_ABORT, 0x08000099);
	KUNIT_EXPECT_EQ(test, upload(b, BAD, 0x5fff), -EIO);
	KUNIT_EXPECT_STREQ(test, b->app.reason,
			   "SDO 0x5fff:01 aborted with code 0x08000099: unknown code");
	cyc_map(c, config, 2, cyc_domain(c));
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), 0);
	cyc_activate(c);
	cyc_run(c, 500);
	KUNIT_EXPECT_STREQ(test, bus_slave(b, BAD)->note.why,
			   "startup SDO 0x5fff:03 (4 byte(s)) failed: abort 0x08000099: unknown code");
	cyc_release(c);
}

/*
 * Every errno of a transfer has a text of its own: neither the default one, nor a number,
 * nor the name of the errno.
 */
static void texts_errno(struct kunit *test)
{
	static const int all[] = {
		-EPROTONOSUPPORT, -EAGAIN, -ETIMEDOUT, -EIO, -EBADMSG, -EPROTO, -EMSGSIZE,
		-ECANCELED, -EINTR, -ENOMEM, -ENODEV, -ENETDOWN, -EBUSY,
	};
	char a[96], name[24];
	u32 i;

	/* none of them stands for a mailbox error reply as well */
	for (i = 0; i < ARRAY_SIZE(all); i++)
		KUNIT_EXPECT_EQ_MSG(test, ec_mbox_errno_detail(all[i]), 0, "error %d", all[i]);

	for (i = 0; i < ARRAY_SIZE(all); i++) {
		ec_mbox_fail_text(all[i], "CoE", a, sizeof(a));
		KUNIT_EXPECT_GT_MSG(test, strlen(a), 10ul, "error %d: %s", all[i], a);
		KUNIT_EXPECT_LT_MSG(test, strlen(a), 95ul, "error %d: %s", all[i], a);
		KUNIT_EXPECT_NULL_MSG(test, strstr(a, "transfer failed"), "error %d: %s", all[i],
				      a);
		scnprintf(name, sizeof(name), "%pe", ERR_PTR(all[i]));
		KUNIT_EXPECT_NULL_MSG(test, strstr(a, name), "error %d: %s", all[i], a);
		scnprintf(name, sizeof(name), "%d", abs(all[i]));
		KUNIT_EXPECT_NULL_MSG(test, strstr(a, name), "error %d: %s", all[i], a);
	}
}

static void texts_reserved(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_file other = { .master = NULL };
	char want[80];

	ec_file_init(&other, b->m, true);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	KUNIT_EXPECT_EQ(test, ec_ioc(&other, EC_IOC_RESERVE, NULL), -EBUSY);
	scnprintf(want, sizeof(want), "reserved by process %d (%s); stop that application first",
		  task_tgid_nr(current), current->comm);
	KUNIT_EXPECT_NOT_NULL_MSG(test, strstr(other.reason, want), "%s", other.reason);
	ec_ioc(&b->app, EC_IOC_RELEASE, NULL);
}

static void texts_config(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_slave_config sc = { .position = 1, .vendor_id = 2, .product_code = 3 };
	struct ec_ioc_sc_pdo pdo = {
		.sm = 2, .op = EC_SC_PDO_MAP_ADD, .pdo = 0x1777, .entry_index = 0x7000,
		.subindex = 1, .bits = 8,
	};

	cyc_new(b, 1000);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), 0);
	sc.product_code = 4;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &sc), -ENOENT);
	expect_text(b,
		    "slave 0:1 is configured as 0x00000002/0x00000003 already, not as 0x00000002/0x00000004");
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_PDO, &pdo), -ENOENT);
	expect_text(b,
		    "cannot add entry 0x7000:01 to PDO 0x1777: the PDO is not assigned; assign it first");
	pdo.op = EC_SC_PDO_ASSIGN_ADD;
	pdo.sm = 200;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_PDO, &pdo), -EINVAL);
	KUNIT_EXPECT_NULL(test, strstr(b->app.reason, "assign the PDO"));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(texts_sdo),
	KUNIT_CASE(texts_mailbox_error),
	KUNIT_CASE(texts_startup_mailbox_error),
	KUNIT_CASE(texts_dead),
	KUNIT_CASE(texts_register),
	KUNIT_CASE(texts_silent_mailbox),
	KUNIT_CASE(texts_link),
	KUNIT_CASE(texts_startup),
	KUNIT_CASE(texts_startup_unknown_abort),
	KUNIT_CASE(texts_errno),
	KUNIT_CASE(texts_reserved),
	KUNIT_CASE(texts_config),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_texts",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
