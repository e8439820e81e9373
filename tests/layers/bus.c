// SPDX-License-Identifier: GPL-2.0-only
/* Slaves are found and read; there is no application, and no monitor that asks for it. */
#include <linux/slab.h>
#include "master/bus/pdo_coe.h"
#include "master/bus/slave.h"
#include "scanned.h"

static const char text[] =
	"segment seed=2\n"
	"slave coupler EK1100\n"
	"slave out EL2008 alias=1001\n"
	"slave axis drive in=8 out=8 vendor=0x1234\n";

static struct scanned *bench_new(void)
{
	struct scanned *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (!CHECK(b))
		return NULL;
	if (scanned_begin(b, text)) {
		if (scanned_scan(b, 3))
			return b;
		scanned_end(b);
	}
	kvfree(b);
	return NULL;
}

static void bench_free(struct scanned *b)
{
	scanned_end(b);
	kvfree(b);
}

static void scan_identifies_slaves_and_brings_them_to_preop(void)
{
	struct scanned *b = bench_new();
	unsigned int i;

	if (!b)
		return;
	for (i = 0; i < 3; i++) {
		CHECK_EQ(b->bus.slaves[i]->al.status, EC_AL_PREOP);
		CHECK_EQ(b->bus.slaves[i]->note.error, EC_SLAVE_OK);
		CHECK_EQ(b->bus.slaves[i]->position, i);
	}
	CHECK_EQ(b->bus.slaves[0]->info.product, 0x044c2c52);
	CHECK_EQ(b->bus.slaves[1]->alias, 1001);
	CHECK_EQ(b->bus.slaves[2]->info.vendor, 0x1234);
	/* in a line: each hangs at port 1 of the one before */
	CHECK_EQ(b->bus.slaves[1]->graph.upstream, 0);
	CHECK(b->bus.slaves[1]->graph.at[0] == b->bus.slaves[0]);
	CHECK(b->bus.slaves[1]->graph.at[1] == b->bus.slaves[2]);
	bench_free(b);
}

static void object_dictionary_has_the_pdos(void)
{
	struct scanned *b = bench_new();
	struct ec_slave *s;

	if (!b)
		return;
	s = b->bus.slaves[2];
	CHECK(ec_slave_pdos_pending(s));
	mutex_lock(&s->lock);
	ec_slave_read_coe_pdos(s);
	mutex_unlock(&s->lock);
	CHECK(!ec_slave_pdos_pending(s));
	CHECK_EQ(ec_pdo_list_bytes(&s->pdos.sm[2]), 8);
	CHECK_EQ(ec_pdo_list_bytes(&s->pdos.sm[3]), 8);
	bench_free(b);
}

/* its worker has no configuration to apply, and no monitor is to be woken */
static void requests_without_higher_layers_do_nothing(void)
{
	struct scanned *b = bench_new();

	if (!b)
		return;
	ec_slave_request(b->bus.slaves[1], EC_AL_OP);
	scanned_wait(b->bus.slaves[1]);
	CHECK(!ec_slave_busy(b->bus.slaves[1]));
	CHECK_EQ(b->bus.slaves[1]->al.status, EC_AL_PREOP);
	ec_bus_rescan(&b->bus);
	CHECK_EQ(b->bus.rescan, true);
	bench_free(b);
}

static void lost_slaves_are_gone_after_a_scan(void)
{
	struct scanned *b = bench_new();
	struct ec_slave *last;
	struct ec_scan_result result = { 0 };

	if (!b)
		return;
	last = ec_bus_slave(&b->bus, 2);
	CHECK_EQ(ec_scan(&b->bus, 3, &result), 0);
	CHECK_EQ(result.changed, false);
	CHECK(ec_bus_slave(&b->bus, 3) == NULL);
	segment_fault(&b->seg, "off axis");
	CHECK_EQ(ec_scan(&b->bus, 2, &result), 0);
	CHECK_EQ(result.changed, true);
	CHECK_EQ(b->bus.n_slaves, 2);
	CHECK_EQ(last->stop.gone, true);
	ec_slave_unref(last);
	bench_free(b);
}

const struct alone_test alone_tests[] = {
	TEST(scan_identifies_slaves_and_brings_them_to_preop),
	TEST(object_dictionary_has_the_pdos),
	TEST(requests_without_higher_layers_do_nothing),
	TEST(lost_slaves_are_gone_after_a_scan),
	{ }
};
