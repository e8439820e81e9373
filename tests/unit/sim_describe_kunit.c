// SPDX-License-Identifier: GPL-2.0-only
/* Descriptions of segments, and the EEPROM images of the catalogue. */
#include "sim_app_kunit.h"

static int describe(struct kunit *test, const char *text, size_t len,
		    struct ec_sim_error *err)
{
	struct ec_sim *sim;
	/* a copy of its own, so that a byte read behind it is noticed */
	char *copy = kunit_kmalloc(test, len + !len, GFP_KERNEL);
	int ret;

	KUNIT_ASSERT_NOT_NULL(test, copy);
	memcpy(copy, text, len);
	ret = ec_sim_describe(&sim, &bed_ops, copy, len, NULL, err);
	if (!ret)
		ec_sim_free(sim);
	kunit_kfree(test, copy);
	return ret;
}

static void sim_describe_builtin_segments_are_valid(struct kunit *test)
{
	struct ec_sim_error err;
	const char *name;

	for (u32 i = 0; (name = ec_sim_builtin_at(i)); i++) {
		const char *text = ec_sim_builtin(name);

		KUNIT_EXPECT_EQ_MSG(test, describe(test, text, strlen(text),
						   &err), 0,
				    "%s:%u: %s", name, err.line, err.text);
	}
	KUNIT_EXPECT_NULL(test, ec_sim_builtin("nothing"));
}

/* every prefix of a long text is either right or refused with a reason */
static void sim_describe_prefixes(struct kunit *test)
{
	const char *text = ec_sim_builtin("bench");
	struct ec_sim_error err;

	for (size_t len = 0; len < strlen(text); len++) {
		int ret = describe(test, text, len, &err);

		if (ret)
			KUNIT_EXPECT_NE(test, err.text[0], 0);
		KUNIT_EXPECT_TRUE(test, !ret || ret == -EINVAL);
	}
}

static const struct {
	const char *text;
	unsigned int line;
	const char *want;
} wrong[] = {
	{ "", 0, "no slave in the description" },
	{ "slave", 1, "needs a name" },
	{ "slave a", 1, "has neither device nor EEPROM image" },
	{ "slave a EL9999", 1, "unknown device 'EL9999'" },
	{ "slave a.b EL2008", 1, "needs a name" },
	{ "slave a EL2008\nslave a EL2008", 2, "exists already" },
	{ "slave b EL2008\nslave c EL2008\nslave c EL1008", 3, "exists already" },
	{ "slave a/b EL2008", 1, "needs a name" },
	{ "slave a EL\xc3\x9c\x01", 1, "unknown device 'EL?\?\?'" },
	{ "slave a EL2008 aliass=3", 1, "'aliass=3' is unknown" },
	{ "slave a EL2008 alias=70000", 1, "'70000' is out of range" },
	{ "slave a EL2008 alias=x", 1, "'x' is not a number" },
	{ "slave a EL2008 drift=5", 1, "'5' is not a rate" },
	{ "slave a EL2008 drift=1001ppm", 1, "'1001ppm' is too much: limit 1000ppm" },
	{ "slave a EL2008\nfault latch a 2", 2, "fault latch NAME 0|1" },
	{ "slave a EL2008\nfault latch a 1 edge=up", 2, "invalid edge 'up': expected rising, falling or pulse" },
	{ "slave a EL2008 dc=16", 1, "invalid dc '16': expected 64, 32, delay or none" },
	{ "slave a EL2008 loops=open", 1, "invalid loops 'open': expected fixed" },
	{ "slave a EL2008 delay=5parsec", 1, "'5parsec' is not a time" },
	{ "slave a drive mapping=none", 1, "rewritable" },
	{ "slave a drive in=5000", 1, "at most 1486" },
	{ "slave a EL7201 motor=AM1", 1, "AM8121" },
	{ "slave a drive eeprom=none", 1, "chip or emulated" },
	{ "slave a EL2008 eeprom=emulated", 1, "no CPU" },
	{ "slave a file=x.bin", 1, "files cannot be read here" },
	{ "# as the only one\nslvae a EL2008\n", 2, "unknown statement 'slvae'" },
	{ "# nothing\n\nslave a EL2008\nfoo\n", 4, "unknown statement 'foo'" },
	{ "slave a EL2008\nbranch b 1", 2, "unknown slave 'b'" },
	{ "slave a EL2008\nbranch a 7", 2, "'7' is out of range" },
	{ "slave a EL2008\nwire a.1 - b.0", 2, "invalid wire: expected" },
	{ "slave a EL2008\nconnect a.9 -> a.1", 2, "no output channel" },
	{ "slave a EL2008\nconnect a.1 -> a.1", 2, "no input channel" },
	{ "slave a EL1008\nsine a.1 amplitude=3", 2, "invalid source: expected" },
	{ "slave a EL2008\nslave b EL1008\nconnect a.1 -> b.2\nconnect a.2 -> b.2", 4,
	  "input 'b.2' already has a source" },
	{ "slave b EL1008\nconst b.2 value=1\nramp b.2 amplitude=2 period=1s", 3,
	  "input 'b.2' already has a source" },
	{ "slave a EL4002\nslave b EL1008\nconnect a.1 -> b.1", 3,
	  "analog output 'a.1' cannot be connected to a digital input" },
	{ "slave a EK1100\nslave b EK1100\nslave c EK1100\nslave d EL2008\n"
	  "wire c.1 -> b.0\nwire b.1 -> c.0\nwire a.1 -> d.0", 2,
	  "no path from a master to 'b'; connect its segment" },
	{ "slave a EL2008\nfault explode a", 2, "unknown fault 'explode'" },
	{ "slave a EL2008\nfault cut a", 2, "has no number" },
	{ "slave a EL2008\nfault lose", 2, "no frames selected: expected" },
	{ "slave a EL2008\nfault refuse a HEAVEN", 2, "invalid refuse: expected" },
	{ "slave a EL2008\nfault wkc a", 2, "add=N" },
	{ "slave a EL2008\nfault mailbox a", 2, "expected good, length" },
	{ "slave a EL2008\nfault mailbox a full", 2, "expected good, length" },
	{ "slave a drive\nfault eoe a lost", 2, "add eoe=host" },
	{ "slave a drive eoe=host\nfault eoe a full", 2, "expected good, interleave" },
	{ "slave a drive eoe=host\nfault eoe a lost every=0", 2, "out of range" },
	{ "slave a drive eoe=yes", 1, "invalid eoe 'yes': expected host or switch" },
	{ "slave a EL2008 eoe=host", 1, "remove soe=, voe=, foe= and eoe=" },
	{ "slave a drive\nfault mailbox a lost after=-1", 2, "out of range" },
	{ "slave a drive\nfault mailbox a delay by=5s", 2, "too long here" },
	{ "slave a drive foe=1 foe_header=", 1, "expected 1 to 16 characters" },
	{ "slave a drive foe=1 foe_boot=maybe", 1, "expected yes or no" },
	{ "slave a drive mbox_words=0", 1, "invalid 'mbox_words=0': expected yes or no" },
	{ "slave a EL2008 mbox_words=no", 1, "'a' has no mailbox; remove mbox_words=" },
	{ "slave a EL2008 ack=no", 1, "has no CPU that changes its state" },
	{ "slave a EL2008 own_eeprom=yes", 1, "has no CPU that changes its state" },
	{ "slave a EL2008 assign_out=0", 1, "no CoE or no such process data" },
	{ "slave a drive assign_out=", 1, "'' is not a number" },
	{ "slave a drive assign_out=0x1600,", 1, "'' is not a number" },
	{ "slave a drive assign_out=0x16000", 1, "'0x16000' is out of range" },
	{ "slave a drive assign_out=1,2,3,4,5,6,7,8,9,1,2,3,4,5,6,7,8", 1, "at most 16 numbers" },
	{ "slave a drive transition_safeop=2h", 1, "'2h' is not a time" },
	{ "slave a drive transition=61min", 1, "'61min' is too long here" },
	{ "repeat 2 slave a drive alias=65535", 1, "no alias or serial number left" },
	{ "repeat 2 slave a drive serial=0xFFFFFFFF", 1, "no alias or serial number left" },
	{ "# 100 too many\nrepeat 2200 slave a drive cable=1ms", 2, "more than 4.29 s" },
	{ "slave a EL2008 dc_modes=0x0300", 1, "no CPU that knows operation modes" },
	{ "slave a EL2008 sm_out=2", 1, "'a' has its own SyncManagers; remove sm_out=" },
	{ "slave a drive sm_in=0", 1, "'0' is out of range" },
	{ "slave a drive sm_in=8", 1, "'8' is out of range" },
	{ "slave a drive in=1486 sm_in=7 out=1486 sm_out=7", 1, "too much process data" },
	{ "slave a drive fixed=0x1601", 1, "'a' has no such PDO or assignment" },
	{ "slave a drive fixed=0x6040", 1, "'a' has no such PDO or assignment" },
	{ "slave a drive\nfault jump a", 2, "missing time: expected fault jump NAME by=-1ms" },
	{ "slave a drive\nfault jump a by=far", 2, "'far' is not a time" },
	{ "slave a drive\nfault jump a by=-99999999999min", 2, "is not a time" },
	{ "slave a drive dc=none\nfault jump a by=1s", 2, "the slave has no clock" },
	{ "repeat 0 slave a EL2008", 1, "out of range" },
	{ "repeat 70000 slave a EL2008", 1, "out of range" },
	{ "slave a EK1100\nslave b EL2008\nbranch a 1\nslave c EL2008", 4,
	  "cannot be connected" },
};

static void sim_describe_errors_are_reported(struct kunit *test)
{
	struct ec_sim_error err;

	for (u32 i = 0; i < ARRAY_SIZE(wrong); i++) {
		int ret = describe(test, wrong[i].text, strlen(wrong[i].text),
				   &err);

		KUNIT_EXPECT_EQ_MSG(test, ret, -EINVAL, "%s", wrong[i].text);
		KUNIT_EXPECT_EQ_MSG(test, err.line, wrong[i].line, "%s",
				    wrong[i].text);
		KUNIT_EXPECT_TRUE_MSG(test, strstr(err.text, wrong[i].want),
				      "\"%s\" says \"%s\"", wrong[i].text,
				      err.text);
	}
}

static void sim_describe_options(struct kunit *test)
{
	struct bed *b = app_bed(test,
		"segment response=1ms\r\n"
		"slave a EL2008 alias=0x3E9 drift=-1.5ppm delay=600 # first\n"
		"repeat 3 slave d drive alias=10 serial=5 response=10us\n"
		"slave z drive\n");
	struct ec_app *a = ec_sim_find(b->sim, "a");
	struct ec_app *d = ec_sim_find(b->sim, "d3");

	KUNIT_ASSERT_EQ(test, ec_sim_count(b->sim), 5u);
	KUNIT_ASSERT_TRUE(test, a && d && ec_sim_find(b->sim, "z"));
	KUNIT_EXPECT_EQ(test, a->esc->cfg.drift_ppb, -1500);
	KUNIT_EXPECT_EQ(test, a->esc->cfg.process_ns, 600u);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_ALIAS, 2), 1001);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(3), EC_REG_ALIAS, 2), 12);
	KUNIT_EXPECT_EQ(test, d->serial, 7u);
	KUNIT_EXPECT_EQ(test, d->response_ns, 10000u);
	KUNIT_EXPECT_EQ(test, ec_sim_find(b->sim, "z")->response_ns, 1000000u);
	KUNIT_EXPECT_PTR_EQ(test, d->model, ec_sim_find(b->sim, "d1")->model);
}

static u32 revision(struct kunit *test, const char *device)
{
	struct bed *b;
	u32 rev;
	char text[80];

	snprintf(text, sizeof(text), "slave a %s\n", device);
	b = app_bed(test, text);
	rev = get_unaligned_le32(ec_sim_slave(b->sim, 0)->eep.data + 2 * EC_SII_W_REVISION);
	ec_sim_free(b->sim);
	b->sim = NULL;
	return rev;
}

/* masters copy what they know of one slave to others of the same identity */
static void sim_describe_revisions(struct kunit *test)
{
	static const char * const devices[] = {
		"drive", "drive in=22 out=22", "drive in=22", "drive out=22", "drive in=23 out=22",
		"drive mbox=128", "drive mapping=fixed", "drive soe=1", "drive voe=7", "drive id=3",
	}, * const ios[] = {
		"io", "io in=64 out=64", "io in=8 out=0", "io in=0 out=8", "io cpu=yes",
	};

	for (u32 i = 0; i < ARRAY_SIZE(devices); i++)
		for (u32 k = 0; k < i; k++)
			KUNIT_EXPECT_NE_MSG(test, revision(test, devices[i]),
					    revision(test, devices[k]), "%s and %s",
					    devices[i], devices[k]);
	for (u32 i = 0; i < ARRAY_SIZE(ios); i++)
		for (u32 k = 0; k < i; k++)
			KUNIT_EXPECT_NE(test, revision(test, ios[i]), revision(test, ios[k]));
	KUNIT_EXPECT_EQ(test, revision(test, "drive in=22"), revision(test, "drive out=8 in=22"));
	KUNIT_EXPECT_EQ(test, revision(test, "drive mbox=256"), revision(test, "drive"));
	KUNIT_EXPECT_EQ(test, revision(test, "drive in=22 revision=77"), 77u);
}

/* frames go the way the description says */
static void sim_describe_wiring(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave c EK1100\nslave x EL2008\n"
				"slave y EL1008\nbranch c 2\nslave e EK1100\n"
				"slave z EL2004\nwire c.1 -> y.0 cable=20\n"
				"wire y.1 -> x.0\n");
	static const u32 want[] = { 0x044C2C52, 0x03F03052, 0x07D83052,
				    0x044C2C52, 0x07D43052 };

	for (int i = 0; i < 5; i++) {
		u8 cmd[6] = { 0x00, 0x01, EC_SII_W_PRODUCT };

		bed_tx(b, EC_CMD_APWR, (u16)-i, EC_REG_EEP_CONTROL, cmd, 6);
		b->now += 5000000;
		bed_station(b, (u16)-i, (u16)(2001 + i));
		KUNIT_EXPECT_EQ(test, bed_get(b, (u16)(2001 + i),
					      EC_REG_EEP_DATA, 4), want[i]);
	}
}

/* @port of @slave has a cable to @peer, or none (-1) */
static void expect_cable(struct kunit *test, u32 slave, u32 port, int peer)
{
	struct bed *b = test->priv;

	KUNIT_EXPECT_EQ_MSG(test, ec_sim_at(b->sim, slave)->port[port].peer, peer,
			    "slave %u, port %u", slave, port);
}

/* a wire to a slave that it begins behind is one more cable */
static void sim_describe_wire_of_loop(struct kunit *test)
{
	static const char * const wires[] = {
		"wire f.1 -> b.2 cable=20\n",
		"wire f.1 -> b.2\nwire e.1 -> f.0\n",
		"wire e.1 -> f.0\nwire a.1 -> b.0\nwire f.1 -> b.2\n",
		"wire b.1 -> c.0\nwire f.1 -> b.2\nwire d.1 -> master.1\n",
	};
	char text[256];

	for (u32 i = 0; i < ARRAY_SIZE(wires); i++) {
		snprintf(text, sizeof(text), "slave a EL2008\nslave b EK1122\nslave c EL2008\n"
			 "slave d EL2008\nbranch b 3\nslave e EL2008\nslave f EL2008\n%s",
			 wires[i]);
		bed_exit(test);
		/* frames of the main device return by the loop */
		app_bed_part(test, text, 4);
		expect_cable(test, 1, 0, 0);
		expect_cable(test, 1, 2, 5);
		expect_cable(test, 5, 0, 4);
		expect_cable(test, 5, 1, 1);
	}
}

/* one loop inside of another; and a wire that closes none replaces the cable of its slave */
static void sim_describe_wires_of_loops(struct kunit *test)
{
	app_bed_part(test, "slave a EK1122\nslave b EK1122\nslave c EL2008\n"
		     "branch b 3\nslave d EL2008\nwire c.1 -> a.2\nwire d.1 -> b.2\n", 2);
	expect_cable(test, 0, 2, 2);
	expect_cable(test, 1, 2, 3);
	expect_cable(test, 1, 0, 0);
	bed_exit(test);
	app_bed(test, "slave a EK1100\nslave b EL2008\nslave c EL2008\nwire a.2 -> c.1\n");
	expect_cable(test, 0, 2, 2);
	expect_cable(test, 1, 1, -1);
}

static void sim_describe_faults(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EL2008\nslave b EL2008\n"
				"fault at=100ms cut a.1\nfault at=200ms heal a.1\n"
				"fault at=300ms off b\nfault at=1s lose frame=2\n");
	u8 v[2] = { 0 };

	b->now = 50000000;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), 2);
	b->now = 150000000;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), 1);
	b->now = 250000000;
	bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), 2);
	b->now = 350000000;
	bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), 1);
	b->now = 1000000000;
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), 1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), -1);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BRD, 0, 0x130, v, 2), 1);
}

/* the image of every device can be read back */
static void sim_describe_images(struct kunit *test)
{
	const struct ec_app_dev *d;

	for (u32 i = 0; (d = ec_app_catalogue_at(i)); i++) {
		struct ec_app_params p = { .in = 8, .out = 8 };
		struct ec_sim *sim = ec_sim_new(&bed_ops, 1, 1);
		struct ec_app_model *m;
		struct ec_sii_general g;
		struct ec_sii_info info;
		struct ec_sii_sm sm[8];
		char buf[64];
		int err;

		KUNIT_ASSERT_NOT_NULL(test, sim);
		m = ec_app_model_new(sim, d, &p, &err);
		KUNIT_EXPECT_EQ_MSG(test, err, 0, "%s", d->name);
		if (!m) {
			ec_sim_free(sim);
			continue;
		}
		KUNIT_EXPECT_EQ(test, ec_sii_decode_info(m->eeprom,
							 m->eeprom_len, &info), 0);
		KUNIT_EXPECT_TRUE(test, info.checksum_ok);
		KUNIT_EXPECT_EQ(test, info.product, d->product);
		KUNIT_EXPECT_EQ(test, ec_sii_decode_general(m->eeprom,
							    m->eeprom_len, &g), 0);
		KUNIT_EXPECT_GT(test, ec_sii_string(m->eeprom, m->eeprom_len,
						    g.name, buf, sizeof(buf)), 0);
		KUNIT_EXPECT_STREQ(test, buf, d->title);
		KUNIT_EXPECT_EQ(test, ec_sii_decode_sms(m->eeprom,
							m->eeprom_len, sm, 8),
				m->dev.n_sms);
		ec_app_model_put(m);
		ec_sim_free(sim);
	}
}

struct image {
	u8 data[4096];
	size_t len;
};

static int load(void *ctx, const char *name, u8 *buf, size_t cap)
{
	const struct image *img = ctx;

	if (strcmp(name, "axis.bin") || img->len > cap)
		return -ENOENT;
	memcpy(buf, img->data, img->len);
	return (int)img->len;
}

/* a slave made of the image of another does what that one does */
static void sim_describe_from_file(struct kunit *test)
{
	struct image *img = kunit_kzalloc(test, sizeof(*img), GFP_KERNEL);
	static const char text[] = "slave a file=axis.bin alias=5\n";
	struct ec_sim_loader loader = { .load = load, .ctx = img };
	struct bed *b = app_bed(test, "slave a EL7201\n");
	struct ec_app *a = ec_sim_find(b->sim, "a");
	struct ec_sim_error err;

	KUNIT_ASSERT_TRUE(test, img && a->model->eeprom_len <= 4096);
	img->len = a->model->eeprom_len;
	memcpy(img->data, a->model->eeprom, img->len);
	ec_sim_free(b->sim);
	b->sim = NULL;
	KUNIT_ASSERT_EQ_MSG(test, ec_sim_describe(&b->sim, &bed_ops, text,
						  strlen(text), &loader, &err),
			    0, "%s", err.text);
	b->now = 1000000;
	bed_station(b, 0, STATION(0));
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_ALIAS, 2), 5);
	app_mbox_sms(b, STATION(0), 256);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), EC_AL_PREOP, 1),
			(u32)EC_AL_PREOP);
	bed_sm(b, STATION(0), 2, 0x1200, 6, 0x64);
	bed_sm(b, STATION(0), 3, 0x1300, 6, 0x20);
	KUNIT_EXPECT_EQ(test, app_al(b, STATION(0), EC_AL_SAFEOP, 1),
			(u32)EC_AL_SAFEOP);

	ec_sim_free(b->sim);
	b->sim = NULL;
	KUNIT_EXPECT_EQ(test, ec_sim_describe(&b->sim, &bed_ops,
					      "slave a file=other", 18, &loader,
					      &err), -ENOENT);
	KUNIT_EXPECT_TRUE(test, strstr(err.text, "cannot read 'other'"));
	for (size_t n = 127; n <= 128; n++) {
		char longest[14 + 128 + 1] = "slave a file=/";

		memset(longest + 14, 'x', n - 1);
		KUNIT_EXPECT_EQ(test, ec_sim_describe(&b->sim, &bed_ops, longest,
						      strlen(longest), &loader, &err),
				n < 128 ? -ENOENT : -EINVAL);
		KUNIT_EXPECT_EQ(test, n < 128,
				!strstr(err.text, "too long, limit 127 characters"));
	}
	/* any bytes at all are taken or refused */
	for (u32 i = 0; i < 2000; i++) {
		struct ec_sim *sim;

		img->data[(i * 7919) % img->len] ^= (u8)(i * 31 + 1);
		if (!ec_sim_describe(&sim, &bed_ops, text, strlen(text),
				     &loader, &err))
			ec_sim_free(sim);
	}
}

static u32 allocs_left;

static void *scarce_alloc(size_t bytes)
{
	return allocs_left && allocs_left-- ? bed_alloc(bytes) : NULL;
}

/* with memory for n blocks only, for every n: refused, nothing is lost */
static void sim_describe_no_memory(struct kunit *test)
{
	static const struct ec_sim_ops ops = { scarce_alloc, bed_free };
	const char *text = ec_sim_builtin("bench");
	struct ec_sim_error err;
	struct ec_sim *sim;
	int ret = -ENOMEM;

	for (u32 n = 0; n < 2000 && ret; n++) {
		allocs_left = n;
		ret = ec_sim_describe(&sim, &ops, text, strlen(text), NULL,
				      &err);
		KUNIT_EXPECT_TRUE(test, !ret || ret == -ENOMEM);
		if (ret)
			KUNIT_EXPECT_STREQ(test, err.text, "out of memory");
		else
			ec_sim_free(sim);
	}
	KUNIT_EXPECT_EQ(test, ret, 0);
}

static int command(struct bed *b, const char *text, struct ec_sim_error *err)
{
	struct ec_sim_fault f;
	int ret = ec_sim_command(b->sim, &bed_ops, text, strlen(text), &f, err);

	return ret ? ret : ec_sim_add_fault(b->sim, &f);
}

/* faults while the segment runs */
static void sim_describe_commands(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EL1008\nslave m drive\n");
	struct ec_app *a = ec_sim_find(b->sim, "a");
	static const struct {
		const char *text, *want;
	} bad[] = {
		{ "", "no fault given" },
		{ "off b", "unknown slave 'b'; the segment has a, m" },
		{ "off a\noff m", "expected one fault" },
		{ "off a now", "'now' is unknown" },
		{ "input a.9 value=1", "no input channel" },
		{ "input a.1", "value=N" },
		{ "eeprom a word=0xFFFF value=1", "EEPROM ends before" },
		{ "error a", "code=N" },
	};
	struct app_mbox *m = kunit_kzalloc(test, sizeof(*m), GFP_KERNEL);
	struct ec_coe_emergency e = { .code = 0 };
	struct ec_mbox_hdr h = { .type = 0 };
	struct ec_sim_error err;
	int len;

	KUNIT_ASSERT_NOT_NULL(test, m);
	m->station = STATION(1);
	m->size = 256;

	for (u32 i = 0; i < ARRAY_SIZE(bad); i++) {
		KUNIT_EXPECT_EQ_MSG(test, command(b, bad[i].text, &err), -EINVAL, "%s",
				    bad[i].text);
		KUNIT_EXPECT_TRUE_MSG(test, strstr(err.text, bad[i].want),
				      "\"%s\" says \"%s\"", bad[i].text, err.text);
	}
	KUNIT_EXPECT_EQ(test, command(b, "input a.3 value=1\n", &err), 0);
	KUNIT_EXPECT_EQ(test, command(b, "eeprom a word=12 value=0xBEEF", &err), 0);
	KUNIT_EXPECT_EQ(test, command(b, "fault at=900ms off m", &err), 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), EC_REG_TYPE, 1), 0x11);
	KUNIT_EXPECT_EQ(test, ec_app_channel(a, EC_APP_IN, 2), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(a->esc->eep.data + 24), 0xBEEF);
	app_mbox_sms(b, STATION(1), 256);
	app_al(b, STATION(1), EC_AL_PREOP, 1);
	KUNIT_EXPECT_EQ(test, command(b, "error m code=0x42", &err), 0);
	KUNIT_EXPECT_EQ(test, app_al_status(b, STATION(1)), 0x00420012u);
	KUNIT_EXPECT_EQ(test, command(b, "emergency m code=0x1234", &err), 0);
	len = app_recv(b, m, &h, 10);
	KUNIT_EXPECT_EQ(test, h.type, EC_MBOX_COE);
	KUNIT_ASSERT_EQ(test, len, EC_COE_HDR + 8);
	KUNIT_EXPECT_EQ(test, ec_coe_emergency_decode(m->rx + EC_MBOX_HDR, (size_t)len, &e), 0);
	KUNIT_EXPECT_EQ(test, e.code, 0x1234);
	KUNIT_EXPECT_EQ_MSG(test, app_recv(b, m, &h, 10), -1, "one emergency");
	KUNIT_EXPECT_EQ(test, command(b, "dead a", &err), 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(0), EC_REG_TYPE, 1), ~0ull);
	b->now = 900000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, STATION(1), EC_REG_TYPE, 1), ~0ull);
}

/* A report has place for some of many names, and is one line all the same. */
static void sim_describe_commands_many_slaves(struct kunit *test)
{
	struct bed *b = app_bed(test, "repeat 100 slave terminal io\n");
	struct ec_sim_error err;

	KUNIT_EXPECT_EQ(test, command(b, "off b", &err), -EINVAL);
	KUNIT_EXPECT_STREQ(test, err.text, "unknown slave 'b'; the segment has "
			   "terminal1, terminal2, terminal3, terminal4, terminal5...");
}

/* a line of each slave: where it hangs, and the faults that last */
static void sim_describe_shows_segment(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave a EK1100\nslave o EL2008\nslave m drive\n"
				"branch a 2\nslave x drive swap=yes\nslave y EL1008\n");
	static const struct {
		const char *fault, *want;
		u32 slave;
	} lines[] = {
		{ "on a", "0 a EK1100 at master.0", 0 },
		{ "on a", "2 m drive at o.1", 2 },
		{ "on a", "3 x drive at a.2", 3 },
		{ "cut a.1", "0 a EK1100 at master.0: cut .1", 0 },
		{ "heal o.0", "0 a EK1100 at master.0", 0 },
		{ "off o", "1 o EL2008 at a.1: off", 1 },
		{ "dead m", "2 m drive at o.1: dead", 2 },
		{ "refuse m OP", "2 m drive at o.1: dead, refuse", 2 },
		{ "mailbox m short", "2 m drive at o.1: dead, refuse, mailbox", 2 },
	};
	struct ec_sim_error err;
	char line[160];

	for (u32 i = 0; i < ARRAY_SIZE(lines); i++) {
		KUNIT_EXPECT_EQ(test, command(b, lines[i].fault, &err), 0);
		ec_sim_advance(b->sim, ++b->now);
		ec_sim_show(b->sim, lines[i].slave, line, sizeof(line));
		KUNIT_EXPECT_STREQ(test, line, lines[i].want);
	}
	ec_sim_show(b->sim, 4, line, 8);
	KUNIT_EXPECT_STREQ(test, line, "4 y EL1");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_describe_no_memory),
	KUNIT_CASE(sim_describe_builtin_segments_are_valid),
	KUNIT_CASE(sim_describe_prefixes),
	KUNIT_CASE(sim_describe_errors_are_reported),
	KUNIT_CASE(sim_describe_options),
	KUNIT_CASE(sim_describe_revisions),
	KUNIT_CASE(sim_describe_wiring),
	KUNIT_CASE(sim_describe_wire_of_loop),
	KUNIT_CASE(sim_describe_wires_of_loops),
	KUNIT_CASE(sim_describe_faults),
	KUNIT_CASE(sim_describe_commands),
	KUNIT_CASE(sim_describe_commands_many_slaves),
	KUNIT_CASE(sim_describe_shows_segment),
	KUNIT_CASE(sim_describe_images),
	KUNIT_CASE(sim_describe_from_file),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_describe",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
MODULE_LICENSE("GPL");
