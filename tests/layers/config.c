// SPDX-License-Identifier: GPL-2.0-only
/* Slaves get what is wanted of them. No session wants it, and no worker is started. */
#include "master/carry/xfer.h"
#include "master/mailbox/coe.h"
#include "master/wire/fmmu.h"
#include "plant.h"

static const char text[] =
	"segment seed=4\n"
	"slave coupler EK1100\n"
	"slave axis drive in=8 out=8\n";

#define AXIS	1

struct bench {
	struct plant p;
	struct ec_config *c;
	struct ec_domain *d;
};

static void bench_free(struct bench *b)
{
	plant_end(&b->p);
	kvfree(b);
}

/* both SyncManagers of the drive in a domain */
static bool configure(struct bench *b)
{
	u32 offset[2], bit;
	bool ok;

	mutex_lock(&b->p.lock);
	b->c = plant_config(&b->p, AXIS);
	b->d = ec_domain_create(&b->p.wanted);
	ok = b->c && CHECK(!IS_ERR(b->d)) &&
	     CHECK_EQ(ec_config_reg_entry_pos(b->c, 2, 0, 0, b->d, &offset[0], &bit), 0) &&
	     CHECK_EQ(ec_config_reg_entry_pos(b->c, 3, 0, 0, b->d, &offset[1], &bit), 0) &&
	     CHECK_EQ(offset[0], 0) && CHECK_EQ(offset[1], 8);
	mutex_unlock(&b->p.lock);
	return ok;
}

static struct bench *bench_new(void)
{
	struct bench *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	if (!plant_begin(&b->p, text, 2)) {
		kvfree(b);
		return NULL;
	}
	if (configure(b))
		return b;
	bench_free(b);
	return NULL;
}

static void activate(struct bench *b)
{
	b->c->fmmus[0].logical = b->c->fmmus[0].offset;
	b->c->fmmus[1].logical = b->c->fmmus[1].offset;
	/* what was configured before this is what workers find */
	smp_store_release(&b->p.wanted.active, true);
}

static void slave_gets_its_configuration_before_safeop(void)
{
	struct bench *b = bench_new();
	struct ec_slave *s;
	u8 mode = 6, data[4], fmmu[16];
	size_t size;
	u32 abort;

	if (!b)
		return;
	mutex_lock(&b->p.lock);
	CHECK_EQ(ec_config_sdo_add(b->c, 0x6060, 0, false, &mode, 1), 0);
	mutex_unlock(&b->p.lock);
	activate(b);
	plant_state(&b->p, AXIS, EC_AL_SAFEOP);
	s = b->p.s.bus.slaves[AXIS];
	CHECK_EQ(s->al.status, EC_AL_SAFEOP);
	CHECK_EQ(s->note.error, EC_SLAVE_OK);
	CHECK_EQ(ec_coe_upload(&s->mbox, 0x6060, 0, false, data, sizeof(data), &size, &abort,
			       NULL), 0);
	CHECK_EQ(data[0], 6);
	/* outputs at logical address 0, 8 bytes; inputs behind them */
	CHECK_EQ(ec_xfer_fprd(&b->p.s.seg.links, s->station, EC_REG_FMMU(0), fmmu, 16), 0);
	CHECK_EQ(get_unaligned_le16(fmmu + 4), 8);
	CHECK_EQ(ec_xfer_fprd(&b->p.s.seg.links, s->station, EC_REG_FMMU(1), fmmu, 16), 0);
	CHECK_EQ(get_unaligned_le32(fmmu), 8);
	bench_free(b);
}

static void refused_startup_sdo_is_the_reason(void)
{
	struct bench *b = bench_new();
	char why[EC_UAPI_REASON];
	struct ec_slave *s;
	u8 v = 1;

	if (!b)
		return;
	mutex_lock(&b->p.lock);
	CHECK_EQ(ec_config_sdo_add(b->c, 0x5fff, 0, false, &v, 1), 0);
	mutex_unlock(&b->p.lock);
	activate(b);
	plant_state(&b->p, AXIS, EC_AL_SAFEOP);
	s = b->p.s.bus.slaves[AXIS];
	CHECK_EQ(s->al.status, EC_AL_PREOP);
	CHECK_EQ(s->note.error, EC_SLAVE_CONFIG_FAILED);
	CHECK(strstr(ec_slave_why(s, why, sizeof(why)), "0x5fff"));
	bench_free(b);
}

/* before activation a slave keeps what it has */
static void inactive_configuration_is_not_applied(void)
{
	struct bench *b = bench_new();
	u8 mode = 6, data[4] = { 0 };
	struct ec_slave *s;
	size_t size;
	u32 abort;

	if (!b)
		return;
	mutex_lock(&b->p.lock);
	CHECK_EQ(ec_config_sdo_add(b->c, 0x6060, 0, false, &mode, 1), 0);
	mutex_unlock(&b->p.lock);
	plant_state(&b->p, AXIS, EC_AL_SAFEOP);
	s = b->p.s.bus.slaves[AXIS];
	CHECK(!ec_setup_of(s)->active_config);
	CHECK_EQ(ec_coe_upload(&s->mbox, 0x6060, 0, false, data, sizeof(data), &size, &abort,
			       NULL), 0);
	CHECK_OP(data[0], !=, 6);
	bench_free(b);
}

static void unknown_entries_and_domains_beyond_the_limit_are_refused(void)
{
	struct bench *b = bench_new();
	u32 offset, bit, i;

	if (!b)
		return;
	mutex_lock(&b->p.lock);
	CHECK_EQ(ec_config_reg_entry(b->c, 0x5fff, 1, b->d, &offset, &bit), -ENOENT);
	CHECK_EQ(b->d->size, 16);
	for (i = 1; i < EC_MAX_DOMAINS; i++)
		CHECK(!IS_ERR(ec_domain_create(&b->p.wanted)));
	CHECK_EQ(PTR_ERR(ec_domain_create(&b->p.wanted)), -ENOSPC);
	mutex_unlock(&b->p.lock);
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(slave_gets_its_configuration_before_safeop),
	TEST(refused_startup_sdo_is_the_reason),
	TEST(inactive_configuration_is_not_applied),
	TEST(unknown_entries_and_domains_beyond_the_limit_are_refused),
	{ }
};
