// SPDX-License-Identifier: GPL-2.0-only
/* Datagrams of any command beside the cycle of an application, by requests. */
#include "kapp.h"
#include "req.h"
#include "master/boundary/ioctl.h"

#define N	3
#define RAM	0x0f80	/* registers that the chip does not use */

static const char text[] =
	"segment seed=3 response=50us transition=200us\n"
	"slave a io in=8 out=8\nslave b io in=8 out=8\nslave c io in=8 out=8\n";

static struct kapp *app(struct bus *b, u32 period_us)
{
	struct kapp *k;
	u32 i;

	bus_idle(b);
	k = kapp_new(b, period_us);
	for (i = 0; i < N; i++)
		kapp_map(k, i);
	return k;
}

static ec_datagram_request_t *make(struct kapp *k, size_t size)
{
	ec_datagram_request_t *r = ecrt_master_create_datagram_request(k->m, size);

	KUNIT_ASSERT_NOT_NULL_MSG(k->b->test, r, "%s", bus_api(k->b)->file.reason);
	return r;
}

static ec_request_state_t ended(struct kapp *k, ec_datagram_request_t *r, u32 cycles)
{
	while (ecrt_datagram_request_state(r) == EC_REQUEST_BUSY && cycles--)
		kapp_run(k, 1);
	return ecrt_datagram_request_state(r);
}

/* The working counter; -EIO: the request has failed, %-EBUSY: it has not ended. */
static int sent(struct kapp *k, ec_datagram_request_t *r, ec_datagram_command_t command,
		u32 address, size_t size)
{
	KUNIT_EXPECT_EQ(k->b->test, ecrt_datagram_request_send(r, command, address, size), 0);
	switch (ended(k, r, 1000)) {
	case EC_REQUEST_SUCCESS:
		return ecrt_datagram_request_working_counter(r);
	case EC_REQUEST_BUSY:
		return -EBUSY;
	default:
		return -EIO;
	}
}

static u8 *ram(struct bus *b, u32 position)
{
	return &bus_esc(b, position)->mem[RAM];
}

static void fill(struct bus *b)
{
	u32 i;

	for (i = 0; i < N; i++)
		put_unaligned_le16(0x1001 << i, ram(b, i));
}

static void expect_ram(struct bus *b, u16 first, u16 second, u16 third)
{
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(ram(b, 0)), first);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(ram(b, 1)), second);
	KUNIT_EXPECT_EQ(b->test, get_unaligned_le16(ram(b, 2)), third);
}

/* Every command: working counter, data that return, registers afterwards. */
static void every_command(struct kapp *k, ec_datagram_request_t *r)
{
	u32 one = EC_DATAGRAM_POSITION(1, RAM);
	u32 station = EC_DATAGRAM_STATION(bus_slave(k->b, 1)->station, RAM);
	u32 first = EC_DATAGRAM_STATION(bus_slave(k->b, 0)->station, RAM);
	const struct {
		ec_datagram_command_t command;
		u32 address;
		int wkc;
		u16 data, ram[N];
	} rows[] = {
		{ EC_DATAGRAM_NOP, one, 0, 0xabcd, { 0x1001, 0x2002, 0x4004 } },
		{ EC_DATAGRAM_APRD, one, 1, 0x2002, { 0x1001, 0x2002, 0x4004 } },
		{ EC_DATAGRAM_APWR, one, 1, 0xabcd, { 0x1001, 0xabcd, 0x4004 } },
		{ EC_DATAGRAM_APRW, one, 3, 0x2002, { 0x1001, 0xabcd, 0x4004 } },
		{ EC_DATAGRAM_FPRD, station, 1, 0x2002, { 0x1001, 0x2002, 0x4004 } },
		{ EC_DATAGRAM_FPWR, station, 1, 0xabcd, { 0x1001, 0xabcd, 0x4004 } },
		{ EC_DATAGRAM_FPRW, station, 3, 0x2002, { 0x1001, 0xabcd, 0x4004 } },
		{ EC_DATAGRAM_BRD, EC_DATAGRAM_ALL(RAM), N, 0x7007, { 0x1001, 0x2002, 0x4004 } },
		{ EC_DATAGRAM_BWR, EC_DATAGRAM_ALL(RAM), N, 0xabcd, { 0xabcd, 0xabcd, 0xabcd } },
		{ EC_DATAGRAM_LRD, 0x70000000, 0, 0, { 0x1001, 0x2002, 0x4004 } },
		{ EC_DATAGRAM_LWR, 0x70000000, 0, 0xabcd, { 0x1001, 0x2002, 0x4004 } },
		{ EC_DATAGRAM_LRW, 0x70000000, 0, 0xabcd, { 0x1001, 0x2002, 0x4004 } },
		{ EC_DATAGRAM_ARMW, one, N, 0x2002, { 0xabcd, 0x2002, 0x2002 } },
		{ EC_DATAGRAM_FRMW, first, N, 0x1001, { 0x1001, 0x1001, 0x1001 } },
	};
	u32 i;

	for (i = 0; i < ARRAY_SIZE(rows); i++) {
		fill(k->b);
		put_unaligned_le16(0xabcd, ecrt_datagram_request_data(r));
		KUNIT_EXPECT_EQ_MSG(k->b->test, sent(k, r, rows[i].command, rows[i].address, 2),
				    rows[i].wkc, "command %u", rows[i].command);
		KUNIT_EXPECT_EQ_MSG(k->b->test,
				    get_unaligned_le16(ecrt_datagram_request_data(r)),
				    rows[i].data, "command %u", rows[i].command);
		expect_ram(k->b, rows[i].ram[0], rows[i].ram[1], rows[i].ram[2]);
	}
	KUNIT_EXPECT_EQ(k->b->test, sent(k, r, EC_DATAGRAM_BRW, EC_DATAGRAM_ALL(RAM), 2), 3 * N);
}

static void datagram_request_commands(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct kapp *k = app(b, 1000);
	ec_datagram_request_t *r = make(k, 2 * N);

	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 2), -EINVAL);
	kapp_op(k);
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_state(r), EC_REQUEST_UNUSED);
	every_command(k, r);
	/* the process data of the cycle, which it goes on with */
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_LRD, 0, 2 * N), N);
	k->incomplete = 0;
	kapp_run(k, 10);
	KUNIT_EXPECT_EQ(test, k->incomplete, 0ull);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
	/* nothing of it is kept for a slave that returns */
	KUNIT_EXPECT_EQ(test, bus_config(b, 0)->replay.n, 0u);
	ecrt_release_master(k->m);
}

static void datagram_request_kernel_cycle(struct kunit *test)
{
	struct kapp *k = app(bus_up(test, text, N), 1000);
	ec_datagram_request_t *r = make(k, 4);

	kapp_kernel_cycle(k, (ec_cycle_config_t){ 0 });
	kapp_op(k);
	every_command(k, r);
	ecrt_release_master(k->m);
}

/* No slave is configured: datagrams are the only requests. */
static void datagram_request_alone(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct kapp *k;
	ec_datagram_request_t *r;

	bus_idle(b);
	k = kapp_new(b, 1000);
	r = make(k, 2);
	kapp_activate(k);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, EC_DATAGRAM_ALL(0), 1), N);
	KUNIT_EXPECT_EQ(test, ecrt_master_deactivate(k->m), 0);
	/* freed with the activation */
	k->d = ecrt_master_create_domain(k->m);
	r = make(k, 2);
	kapp_activate(k);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, EC_DATAGRAM_ALL(0), 1), N);
	ecrt_release_master(k->m);
}

static void datagram_request_sizes(struct kunit *test)
{
	struct kapp *k = app(bus_up(test, text, N), 1000);
	ec_datagram_request_t *r;

	KUNIT_EXPECT_NULL(test, ecrt_master_create_datagram_request(k->m, 0));
	KUNIT_EXPECT_NOT_NULL(test, strstr(bus_api(k->b)->file.reason,
					   "a datagram has 1 to 1486 bytes, not 0"));
	KUNIT_EXPECT_NULL(test, ecrt_master_create_datagram_request(k->m, 1487));
	KUNIT_EXPECT_NULL(test, ecrt_master_create_datagram_request(k->m, 1 << 20));
	r = make(k, 1486);
	kapp_op(k);
	KUNIT_EXPECT_NULL(test, ecrt_master_create_datagram_request(k->m, 1));
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 1487), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r, 15, 0, 1), -EINVAL);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, 0, 1486), N);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, 0, 1), N);
	KUNIT_EXPECT_TRUE(test, kapp_all_op(k));
	ecrt_release_master(k->m);
}

/* Several requests do not wait for one another: they go in the same cycle. */
static void datagram_request_side_by_side(struct kunit *test)
{
	struct kapp *k = app(bus_up(test, text, N), 1000);
	ec_datagram_request_t *r[16];
	u32 i, cycles, done = 0;

	for (i = 0; i < ARRAY_SIZE(r); i++)
		r[i] = make(k, 2);
	kapp_op(k);
	for (i = 0; i < ARRAY_SIZE(r); i++)
		KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r[i], EC_DATAGRAM_BRD, 0, 2), 0);
	for (cycles = 0; cycles < 100 && done < ARRAY_SIZE(r); cycles++) {
		kapp_run(k, 1);
		for (done = 0, i = 0; i < ARRAY_SIZE(r); i++)
			done += ecrt_datagram_request_state(r[i]) == EC_REQUEST_SUCCESS;
	}
	KUNIT_EXPECT_EQ(test, done, (u32)ARRAY_SIZE(r));
	KUNIT_EXPECT_LE(test, cycles, 5u);
	bus_figure("datagram requests: %u ended after %u cycles", done, cycles);
	ecrt_release_master(k->m);
}

/* Lost, no link, device withdrawn: each ends the request, and it can be used again. */
static void datagram_request_no_link(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct kapp *k = app(b, 1000);
	ec_datagram_request_t *r = make(k, 2);

	kapp_op(k);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, 0, 2), -EIO);
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_working_counter(r), 0);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, 0, 2), N);
	bus_fault(b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	kapp_run(k, 20);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, 0, 2), -EIO);
	bus_fault(b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	kapp_run(k, 100);
	KUNIT_EXPECT_EQ(test, sent(k, r, EC_DATAGRAM_BRD, 0, 2), N);
	/* the driver of the card is removed while one is pending */
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 2), 0);
	kapp_run(k, 1);
	ec_sim_link_destroy(b->link);
	b->link = NULL;
	b->sim = NULL;
	while (ecrt_datagram_request_state(r) == EC_REQUEST_BUSY) {
		ecrt_master_receive(k->m);
		ecrt_master_send(k->m);
		usleep_range(1000, 1100);
	}
	ecrt_release_master(k->m);
}

/* The application stops to cycle, then exits, while requests are pending. */
static void datagram_request_left(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct kapp *k = app(b, 1000);
	ec_datagram_request_t *r = make(k, 1486);
	u32 i;

	kapp_op(k);
	fill(b);
	/* without any send: the monitor ends cyclic bus access */
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 1486), 0);
	kapp_run(k, 1);
	msleep(200);
	KUNIT_EXPECT_EQ(test, ecrt_datagram_request_state(r), EC_REQUEST_SUCCESS);
	/* it cycles again */
	for (i = 0; i < 100 && kapp_exchange(k); i++)
		kapp_wait(k);
	k->next = ktime_get();
	for (i = 0; i < 20; i++) {
		kapp_run(k, 3);
		KUNIT_EXPECT_EQ(test, ecrt_datagram_request_send(r, EC_DATAGRAM_BRD, 0, 1486), 0);
		ecrt_master_receive(k->m);
		ecrt_master_send(k->m);
		udelay(i);
		ecrt_release_master(k->m);
		KUNIT_ASSERT_NE(test, bus_wait(b, N, EC_AL_PREOP, 10000), ~0ull);
		k = app(b, 1000);
		r = make(k, 1486);
		kapp_op(k);
	}
	ecrt_release_master(k->m);
}

/* what the application may write into mapped memory ---------------------------*/

static void datagram_request_hostile(struct kunit *test)
{
	static const struct {
		u8 command, op;
		u32 size, flags;
		int result;
	} rows[] = {
		{ EC_CMD_FRMW + 1, EC_REQUEST_OP_READWRITE, 2, 0, -EINVAL },
		{ 255, EC_REQUEST_OP_READWRITE, 2, 0, -EINVAL },
		{ EC_CMD_BRD, EC_REQUEST_OP_READWRITE, 0, 0, -EINVAL },
		{ EC_CMD_BRD, EC_REQUEST_OP_READWRITE, 5, 0, -EINVAL },
		{ EC_CMD_BRD, EC_REQUEST_OP_READWRITE, ~0u, 0, -EINVAL },
		{ EC_CMD_BRD, EC_REQUEST_OP_READ, 2, 0, -EINVAL },
		{ EC_CMD_BWR, EC_REQUEST_OP_WRITE, 2, 0, -EINVAL },
		{ EC_CMD_BRD, EC_REQUEST_OP_READ_NOW, 2, 0, -EINVAL },
		{ EC_CMD_BRD, 200, 2, 0, -EINVAL },
		{ EC_CMD_BRD, EC_REQUEST_OP_READWRITE, 2, 1, -EOPNOTSUPP },
		{ EC_CMD_BRD, EC_REQUEST_OP_READWRITE, 4, 0, 0 },
	};
	struct bus *b = bus_up(test, text, N);
	struct ec_ioc_datagram_request d = { .size = 4 };
	struct ec_ioc_sc_request kind = { .kind = 6, .size = 4 };
	struct cyc *c;
	u32 i;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_map_all(c, 0, N, cyc_domain(c));
	/* a datagram belongs to no slave */
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_REQUEST, &kind), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DATAGRAM_REQUEST, &d), 0);
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	for (i = 0; i < ARRAY_SIZE(rows); i++) {
		req_rec(c, d.index)->flags = rows[i].flags;
		req_rec(c, d.index)->vendor_id = 0;
		KUNIT_EXPECT_EQ_MSG(test, req_do(c, d.index, 0, rows[i].command, rows[i].op,
						 rows[i].size), rows[i].result, "row %u", i);
	}
	KUNIT_EXPECT_EQ(test, req_rec(c, d.index)->got_type, N);
	KUNIT_EXPECT_EQ(test, req_rec(c, d.index)->got, 4u);
	cyc_release(c);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(datagram_request_commands),
	KUNIT_CASE(datagram_request_kernel_cycle),
	KUNIT_CASE(datagram_request_alone),
	KUNIT_CASE(datagram_request_sizes),
	KUNIT_CASE(datagram_request_side_by_side),
	KUNIT_CASE(datagram_request_no_link),
	KUNIT_CASE(datagram_request_left),
	KUNIT_CASE(datagram_request_hostile),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_datagram_request",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
