// SPDX-License-Identifier: GPL-2.0-only
/* An application in the kernel that is configured by a compiled bus file. */
#include "kapp.h"
#include "master/boundary/api.h"
#include "tests/unit/compiled_file.h"

static const char pair[] = "segment seed=9\nslave a drive in=8 out=8 mbox=128\n"
			   "slave b io in=16 out=16\nconnect b.1 -> b.1\n";

/* SyncManager of @position with inputs or outputs */
static u8 sm_of(struct bus *b, u32 position, bool out)
{
	struct ec_slave *s = bus_slave(b, position);
	u32 sm;

	for (sm = 0; sm < s->n_sms; sm++)
		if (ec_pdo_list_bytes(&s->pdos.sm[sm]) &&
		    !(s->sms[sm].control & EC_SM_DIR_WRITE) == !out)
			return sm;
	return 0;
}

static void add_slave(struct bus *b, u32 position)
{
	struct ec_slave *s = bus_slave(b, position);

	begin(EC_COMPILED_SLAVE);
	ec_wbuf_le16(&f.w, 0);
	ec_wbuf_le16(&f.w, position);
	U32(s->info.vendor, s->info.product);
	end();
}

static void add_place(u32 slave, u8 sm)
{
	begin(EC_COMPILED_PLACE);
	U32(slave, 0);
	ec_wbuf_le32(&f.w, sm);
	end();
}

static void add_value(const char *name, u32 place, u8 output)
{
	begin(EC_COMPILED_VALUE);
	text(name);
	text("");
	U32(place, 0, 0x600001);
	ec_wbuf_u8(&f.w, 16);
	ec_wbuf_u8(&f.w, 7);
	ec_wbuf_u8(&f.w, output);
	ec_wbuf_u8(&f.w, 0);
	ec_wbuf_le64(&f.w, 1);
	ec_wbuf_le64(&f.w, 10);
	ec_wbuf_le64(&f.w, 0);
	ec_wbuf_le64(&f.w, 1);
	end();
}

/* both slaves, two values of the second one */
static size_t whole(struct bus *b)
{
	start();
	begin(EC_COMPILED_DOMAIN);
	end();
	add_slave(b, 0);
	add_slave(b, 1);
	begin(EC_COMPILED_REST);
	U32(0, 0);
	end();
	add_place(1, sm_of(b, 1, true));
	add_place(1, sm_of(b, 1, false));
	begin(EC_COMPILED_CYCLE);
	ec_wbuf_le64(&f.w, NSEC_PER_MSEC);
	end();
	begin(EC_COMPILED_NAMES);
	bytes("ethercat: 1\n", 12);
	end();
	add_value("b.in", 1, 0);
	add_value("b.out", 0, 1);
	return finish();
}

/* domains and configurations of its session */
static u32 configured(ec_master_t *m)
{
	struct ec_session *s;
	u32 n;

	mutex_lock(&m->sessions.lock);
	s = ec_session_of(&m->sessions, &m->api->file);
	n = s->wanted.n_domains + s->wanted.n_configs;
	mutex_unlock(&m->sessions.lock);
	return n;
}

static void kapi_compiled_runs(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	struct kapp k = { .b = b, .period_ns = NSEC_PER_MSEC };
	ec_value_t in, out;
	ec_loaded_t loaded;
	size_t size = whole(b);

	bus_idle(b);
	k.m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, k.m);
	KUNIT_EXPECT_EQ(test, ecrt_master_loaded(k.m, &loaded), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_master_value(k.m, "b.in", &in), -ENOENT);
	KUNIT_ASSERT_EQ(test, ecrt_master_load_compiled(k.m, f.data, size), 0);
	memset(f.data, 0xa5, size);	/* it is not needed any more */
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(k.m, f.data, size), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_master_loaded(k.m, &loaded), 0);
	KUNIT_EXPECT_EQ(test, loaded.slaves, 2u);
	KUNIT_EXPECT_EQ(test, loaded.values, 2u);
	KUNIT_EXPECT_EQ(test, loaded.cycle_ns, NSEC_PER_MSEC + 0ull);
	KUNIT_EXPECT_EQ(test, ecrt_master_value(k.m, "b.int", &in), -ENOENT);
	KUNIT_EXPECT_EQ(test, ecrt_master_value(k.m, "", &in), -ENOENT);
	KUNIT_ASSERT_EQ(test, ecrt_master_value(k.m, "b.in", &in), 0);
	KUNIT_ASSERT_EQ(test, ecrt_master_value(k.m, "b.out", &out), 0);
	KUNIT_EXPECT_EQ(test, out.output, 1);
	KUNIT_EXPECT_EQ(test, in.scale_den, 10ull);
	KUNIT_EXPECT_STREQ(test, in.unit, "");
	KUNIT_EXPECT_NE(test, in.byte, out.byte);
	/* the process data of the drive are there as well */
	KUNIT_EXPECT_EQ(test, ecrt_domain_size(in.domain), 16u + 2 * 2);
	k.d = in.domain;
	k.sc[1] = in.slave;
	kapp_activate(&k);
	kapp_op(&k);
	EC_WRITE_U16(ecrt_domain_data(out.domain) + out.byte, 1);
	kapp_run(&k, 5);
	KUNIT_EXPECT_EQ(test, EC_READ_U16(ecrt_domain_data(in.domain) + in.byte) & 1, 1);
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(k.m, f.data, whole(b)), -EBUSY);
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k.m), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_value(k.m, "b.in", &in), -ENOENT);
	/* and again */
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(k.m, f.data, whole(b)), 0);
	ecrt_release_master(k.m);
}

/* @c changes the valid file; nothing is configured by it */
static void refused(struct kunit *test, ec_master_t *m, size_t size, int err)
{
	ec_value_t v;

	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(m, f.data, size), err);
	KUNIT_EXPECT_EQ(test, configured(m), 0u);
	KUNIT_EXPECT_EQ(test, ecrt_master_value(m, "b.in", &v), -ENOENT);
}

static void kapi_compiled_wrong_changes_nothing(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	size_t size = whole(b), i;
	ec_master_t *m;

	bus_idle(b);
	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	for (i = 0; i < size; i += 7)
		refused(test, m, i, -EBADMSG);
	f.data[size - 3] ^= 4;
	refused(test, m, size, -EBADMSG);
	whole(b);
	f.data[8] = 2;
	refused(test, m, size, -EPROTONOSUPPORT);
	/* the last record is wrong, with a right checksum */
	whole(b);
	add_value("b.in", 0, 0);
	refused(test, m, finish(), -EINVAL);
	whole(b);
	add_value("c", 2, 0);
	refused(test, m, finish(), -EINVAL);
	start();
	for (i = 0; i < 65; i++) {
		begin(EC_COMPILED_DOMAIN);
		end();
	}
	refused(test, m, finish(), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(m, NULL, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(NULL, f.data, size), -EINVAL);
	size = whole(b);
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(m, f.data, size), 0);
	ecrt_release_master(m);
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(m, f.data, size), -EPERM);
}

/* Valid by itself, not with these slaves: the call that fails ends the load. */
static void kapi_compiled_call_fails(struct kunit *test)
{
	struct bus *b = bus_up(test, pair, 2);
	ec_master_t *m;
	ec_value_t v;

	bus_idle(b);
	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	start();
	begin(EC_COMPILED_DOMAIN);
	end();
	add_slave(b, 1);
	add_place(0, 9);
	add_value("b.in", 0, 0);
	KUNIT_EXPECT_LT(test, ecrt_master_load_compiled(m, f.data, finish()), 0);
	KUNIT_EXPECT_EQ(test, ecrt_master_value(m, "b.in", &v), -ENOENT);
	ecrt_release_master(m);
	/* a value that is longer than its slave has data */
	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	whole(b);
	begin(EC_COMPILED_VALUE);
	text("c");
	text("");
	U32(1, 8 * 60000, 0x600001);
	bytes("\1\0\0\0", 4);
	ec_wbuf_le64(&f.w, 1);
	ec_wbuf_le64(&f.w, 1);
	ec_wbuf_le64(&f.w, 1);
	ec_wbuf_le64(&f.w, 1);
	end();
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(m, f.data, finish()), -ERANGE);
	ecrt_release_master(m);
	m = ecrt_request_master(0);
	KUNIT_ASSERT_NOT_NULL(test, m);
	KUNIT_EXPECT_EQ(test, ecrt_master_load_compiled(m, f.data, whole(b)), 0);
	ecrt_release_master(m);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kapi_compiled_runs),
	KUNIT_CASE(kapi_compiled_wrong_changes_nothing),
	KUNIT_CASE(kapi_compiled_call_fails),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_kapi_compiled", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
