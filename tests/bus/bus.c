// SPDX-License-Identifier: GPL-2.0-only
#include <linux/err.h>
#include <linux/kmsg_dump.h>
#include "bus.h"
#include "slow.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"
#include "master/wire/sii.h"
#include "master/boundary/cdev.h"

static const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x51, 0x00 };
static const u8 second_mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x52, 0x00 };

static struct bus *bus_make(struct kunit *test, const char *text, char *device, char *backup)
{
	struct bus *b = kzalloc(sizeof(*b), GFP_KERNEL);
	struct ec_sim_error err = { 0 };
	int ret;

	KUNIT_ASSERT_NOT_NULL(test, b);
	b->test = test;
	text = ec_sim_builtin(text) ?: text;
	test->priv = b;
	ret = ec_sim_describe(&b->sim, &ec_sim_kernel_ops, text, strlen(text), NULL, &err);
	KUNIT_ASSERT_EQ_MSG(test, ret, 0, "line %u: %s", err.line, err.text);
	KUNIT_ASSERT_EQ(test, ec_masters_create(&device, 1, &backup,
						backup && ec_sim_is_ring(b->sim), 0), 0);
	b->m = ec_cdev_master(0);
	ec_file_init(&b->app, b->m, true);
	return b;
}

/**
 * bus_new() - a master waiting for its device, and a segment
 * @test: case; its suite has bus_exit() as .exit
 * @text: description of the segment, or the name of a built-in one; a ring has a backup device
 *
 * Return: bus; the case fails when there is none.
 */
struct bus *bus_new(struct kunit *test, const char *text)
{
	return bus_make(test, text, "bus0", "bus0b");
}

/**
 * bus_new_exchanged() - bus_new() with the names of the two devices of a ring exchanged
 * @test: as there
 * @text: likewise
 *
 * Return: as there.
 */
struct bus *bus_new_exchanged(struct kunit *test, const char *text)
{
	return bus_make(test, text, "bus0b", "bus0");
}

/**
 * bus_new_line() - bus_new() at a ring, without a backup device
 * @test: as there
 * @text: likewise
 *
 * Return: as there.
 */
struct bus *bus_new_line(struct kunit *test, const char *text)
{
	return bus_make(test, text, "bus0", NULL);
}

/**
 * bus_plug_second() - offer the other end of a ring to the master
 * @b: bus
 */
void bus_plug_second(struct bus *b)
{
	KUNIT_ASSERT_EQ(b->test, ec_sim_link_second(b->link, "bus0b", second_mac), 0);
}

/**
 * bus_plug() - offer the segment to the master
 * @b: bus
 */
void bus_plug(struct bus *b)
{
	struct ec_sim_link *l;

	b->t0 = ktime_get_ns();
	l = ec_sim_link_create("bus0", mac, b->sim, 0);
	KUNIT_ASSERT_FALSE(b->test, IS_ERR(l));
	b->link = l;
	if (ec_sim_is_ring(b->sim))
		bus_plug_second(b);
}

/**
 * bus_up() - a scanned bus with all slaves in PREOP
 * @test: case
 * @text: as for bus_new()
 * @slaves: how many there must be
 *
 * Return: bus.
 */
struct bus *bus_up(struct kunit *test, const char *text, u32 slaves)
{
	struct bus *b = bus_new(test, text);

	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, slaves, EC_AL_PREOP, 10000), ~0ull);
	return b;
}

/**
 * bus_down() - take master and segment away
 * @b: bus or NULL
 */
void bus_down(struct bus *b)
{
	if (!b)
		return;
	bus_crowd_leaves(b);
	ec_masters_destroy();
	if (b->slow)
		slow_destroy(b->slow);
	if (b->link)
		ec_sim_link_destroy(b->link);
	else if (b->sim)
		ec_sim_free(b->sim);
	kfree(b);
}

/**
 * bus_exit() - .exit of every suite
 * @test: case
 */
void bus_exit(struct kunit *test)
{
	bus_down(test->priv);
	test->priv = NULL;
}

/**
 * bus_settled() - no scan and no worker is busy
 * @b: bus
 *
 * Return: true when nothing is going on.
 */
bool bus_settled(struct bus *b)
{
	u32 i;

	if (bus_scan_busy(b) || bus_rescan_due(b))
		return false;
	for (i = 0; i < bus_n_slaves(b); i++)
		if (ec_slave_busy(bus_slave_at(b, i)))
			return false;
	return true;
}

/**
 * bus_plug_scanned() - plug in, and wait until all slaves are found and nothing is going on
 * @b: bus
 * @slaves: how many there are
 * @limit_ms: waits no longer; that so many were found is asserted
 */
void bus_plug_scanned(struct bus *b, u32 slaves, u32 limit_ms)
{
	u64 end;

	bus_plug(b);
	end = b->t0 + (u64)limit_ms * NSEC_PER_MSEC;
	while (ktime_get_ns() < end && !(bus_n_slaves(b) == slaves && bus_settled(b)))
		usleep_range(1000, 1001);
	KUNIT_ASSERT_EQ(b->test, bus_n_slaves(b), slaves);
}

/**
 * bus_idle() - wait until nothing but the monitor has been at work for 100 ms
 * @b: bus
 */
void bus_idle(struct bus *b)
{
	u32 quiet, limit;

	for (quiet = 0, limit = 0; quiet < 100; quiet++, limit++) {
		KUNIT_ASSERT_LT(b->test, limit, 20000);
		if (!bus_settled(b))
			quiet = 0;
		usleep_range(1000, 1001);
	}
}

struct bus_crowd {
	struct completion leave;
	struct completion gone;
	atomic_t there;
	struct bus_guest {
		struct ec_job job;
		struct bus_crowd *crowd;
	} guests[];
};

static void stay(struct ec_job *job)
{
	wait_for_completion(&container_of(job, struct bus_guest, job)->crowd->leave);
}

static void go(struct ec_job *job)
{
	struct bus_crowd *crowd = container_of(job, struct bus_guest, job)->crowd;

	if (atomic_dec_and_test(&crowd->there))
		complete(&crowd->gone);
}

/**
 * bus_crowd() - as if very many slaves waited: no worker of slaves is free
 * @b: bus
 */
void bus_crowd(struct bus *b)
{
	u32 i, n = EC_MAX_WORKERS;

	b->crowd = kvzalloc(struct_size(b->crowd, guests, n), GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(b->test, b->crowd);
	init_completion(&b->crowd->leave);
	init_completion(&b->crowd->gone);
	atomic_set(&b->crowd->there, n);
	for (i = 0; i < n; i++) {
		b->crowd->guests[i].crowd = b->crowd;
		b->crowd->guests[i].job = (struct ec_job){ .run = stay, .end = go };
		ec_workers_queue(bus_workers(b), &b->crowd->guests[i].job);
	}
	msleep(20);
}

/**
 * bus_crowd_leaves() - workers are free again
 * @b: bus
 */
void bus_crowd_leaves(struct bus *b)
{
	if (!b->crowd)
		return;
	complete_all(&b->crowd->leave);
	wait_for_completion(&b->crowd->gone);
	kvfree(b->crowd);
	b->crowd = NULL;
}

static bool all_in(const struct bus *b, u32 slaves, u8 state)
{
	u32 i;

	if (bus_n_slaves(b) != slaves || bus_scan_busy(b))
		return false;
	for (i = 0; i < slaves; i++)
		if (bus_slave_at(b, i)->al.status != state)
			return false;
	return true;
}

/**
 * bus_wait() - wait until the master knows @slaves slaves, all in @state
 * @b: bus
 * @slaves: how many
 * @state: AL state without error
 * @limit_ms: bus time
 *
 * Return: bus time since the device was plugged in, us; ~0 after the limit.
 */
u64 bus_wait(struct bus *b, u32 slaves, u8 state, u32 limit_ms)
{
	u64 end = ktime_get_ns() + (u64)limit_ms * NSEC_PER_MSEC;

	while (!all_in(b, slaves, state)) {
		if (ktime_get_ns() > end)
			return ~0ull;
		usleep_range(100, 101);
	}
	return div_u64(ktime_get_ns() - b->t0, NSEC_PER_USEC);
}

/**
 * bus_wait_al() - wait until the master knows that a slave is in a state
 * @b: bus
 * @position: ring position
 * @al_status: state, with EC_AL_ERROR when that is expected
 * @limit_ms: bus time
 *
 * Return: how long that took, us; ~0 after the limit.
 */
u64 bus_wait_al(struct bus *b, u32 position, u16 al_status, u32 limit_ms)
{
	u64 t0 = ktime_get_ns(), end = t0 + (u64)limit_ms * NSEC_PER_MSEC;

	while (READ_ONCE(bus_slave(b, position)->al.status) != al_status) {
		if (ktime_get_ns() > end)
			return ~0ull;
		usleep_range(20, 21);
	}
	return div_u64(ktime_get_ns() - t0, NSEC_PER_USEC);
}

struct ec_slave *bus_slave(struct bus *b, u32 position)
{
	KUNIT_ASSERT_LT(b->test, position, bus_n_slaves(b));
	return bus_slave_at(b, position);
}

struct ec_esc *bus_esc(struct bus *b, u32 index)
{
	struct ec_esc *esc = ec_sim_slave(b->sim, index);

	KUNIT_ASSERT_NOT_NULL(b->test, esc);
	return esc;
}

struct ec_app *bus_app(struct bus *b, const char *name)
{
	struct ec_app *app = ec_sim_find(b->sim, name);

	KUNIT_ASSERT_NOT_NULL_MSG(b->test, app, "no slave %s", name);
	return app;
}

/**
 * bus_fault() - something goes wrong from now on
 * @b: bus
 * @type: what
 * @slave: index in the segment
 * @port: port
 * @arg: as in struct ec_sim_fault
 * @arg2: likewise
 */
void bus_fault(struct bus *b, enum ec_sim_fault_type type, int slave, int port, u32 arg,
	       u32 arg2)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns(), .type = type, .slave = slave, .port = port,
		.arg = arg, .arg2 = arg2,
	};

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

/**
 * bus_fault_later() - something goes wrong at a cable, or is mended
 * @b: bus
 * @type: what
 * @slave: index in the segment
 * @port: port
 * @after_ns: from now
 */
void bus_fault_later(struct bus *b, enum ec_sim_fault_type type, int slave, int port,
		     u32 after_ns)
{
	struct ec_sim_fault f = {
		.at_ns = ktime_get_ns() + after_ns, .type = type, .slave = slave, .port = port,
	};

	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

/**
 * bus_command() - something happens to the segment now
 * @b: bus
 * @text: as a running segment accepts it, see Documentation/simulator.rst
 */
void bus_command(struct bus *b, const char *text)
{
	struct ec_sim_error err;
	struct ec_sim_fault f;

	KUNIT_ASSERT_EQ_MSG(b->test, ec_sim_command(b->sim, &ec_sim_kernel_ops, text, strlen(text),
						    &f, &err), 0, "%s: %s", text, err.text);
	f.at_ns = ktime_get_ns();
	KUNIT_ASSERT_EQ(b->test, ec_sim_add_fault(b->sim, &f), 0);
}

/**
 * bus_expect_graph() - the list and the neighbors are those of the model
 * @b: bus at rest
 * @after: what has happened
 */
void bus_expect_graph(struct bus *b, const char *after)
{
	const struct ec_sim_route *r = &b->sim->route[0];
	u32 i, p;

	KUNIT_ASSERT_EQ_MSG(b->test, bus_n_slaves(b), r->steps, "after %s", after);
	for (i = 0; i < r->steps; i++) {
		const struct ec_slave *s = bus_slave(b, i);
		const struct ec_esc *esc = r->step[i].esc;

		KUNIT_EXPECT_EQ_MSG(b->test, s->station,
				    get_unaligned_le16(esc->mem + EC_REG_STATION),
				    "slave %u after %s", i, after);
		KUNIT_EXPECT_FALSE_MSG(b->test, s->graph.inconsistent, "slave %u after %s", i,
				       after);
		for (p = 0; p < EC_MAX_PORT; p++) {
			s32 peer = esc->port[p].open ? esc->port[p].peer : -1;

			KUNIT_EXPECT_EQ_MSG(b->test, bus_next(s, p), peer < 0 ? EC_UAPI_NONE16 :
					    (u16)b->sim->esc[peer]->route_pos[0],
					    "slave %u port %u after %s", i, p, after);
		}
	}
}

/**
 * bus_fill_eeprom() - let an EEPROM be used up to its end
 * @b: bus, not plugged in yet
 * @index: of the slave in the segment
 * @bytes: where the end mark shall end
 *
 * A category of the vendor fills the room, as in real devices with texts and
 * pictures.
 */
void bus_fill_eeprom(struct bus *b, u32 index, size_t bytes)
{
	struct ec_esc_eeprom *e = &bus_esc(b, index)->eep;
	size_t used = ec_sii_used(e->data, e->len);

	KUNIT_ASSERT_NE(b->test, used, 0ul);
	KUNIT_ASSERT_LE(b->test, used + 4, bytes);
	KUNIT_ASSERT_LE(b->test, bytes, e->len);
	/* the end mark is the last word in use */
	put_unaligned_le16(0x0900, e->data + used - 2);
	put_unaligned_le16((bytes - used - 4) / 2, e->data + used);
	memset(e->data + used + 2, 0x5a, bytes - used - 4);
	put_unaligned_le16(0xffff, e->data + bytes - 2);
	KUNIT_ASSERT_EQ(b->test, ec_sii_used(e->data, e->len), bytes);
}

/**
 * bus_strip_names() - let an EEPROM have no names of PDOs and entries
 * @b: bus, not plugged in yet
 * @index: of the slave in the segment
 */
void bus_strip_names(struct bus *b, u32 index)
{
	struct ec_esc_eeprom *e = &bus_esc(b, index)->eep;
	struct ec_sii_iter it;
	struct ec_sii_cat cat;

	ec_sii_iter_init(&it, e->data, e->len);
	while (ec_sii_iter_next(&it, &cat) == 1) {
		u8 *p = (u8 *)cat.data, *end = p + cat.bytes;

		if (cat.type != EC_SII_CAT_RXPDO && cat.type != EC_SII_CAT_TXPDO)
			continue;
		while (p < end) {
			u32 n = p[2];

			p[5] = 0;
			for (p += 8; n && p < end; n--, p += 8)
				p[3] = 0;
		}
	}
}

/**
 * bus_request() - what "ethercat states" does
 * @b: bus
 * @position: ring position
 * @state: AL state
 */
void bus_request(struct bus *b, u32 position, u8 state)
{
	struct ec_ioc_state s = { .slave.position = position, .state = state };

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_STATE, &s), 0);
}

/* Lines of the log with these words, since it began. */
u32 bus_log_lines(const char *words)
{
	static char line[512];
	struct kmsg_dump_iter iter;
	u32 n = 0;
	size_t len;

	kmsg_dump_rewind(&iter);
	while (kmsg_dump_get_line(&iter, false, line, sizeof(line) - 1, &len)) {
		line[len] = '\0';
		n += strstr(line, words) != NULL;
	}
	return n;
}

/**
 * bus_judge() - compare a value with the goal of a row, and with what is reached today
 * @test: the case
 * @value: of this run
 * @goal: in the row
 * @limit: fails above it
 * @text: of the row
 */
void bus_judge(struct kunit *test, u64 value, u64 goal, u64 limit, const char *text)
{
	bus_row(value, goal, "%s", text);
	KUNIT_EXPECT_LE_MSG(test, value, limit, "%s", text);
}
