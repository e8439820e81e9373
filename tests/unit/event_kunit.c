// SPDX-License-Identifier: GPL-2.0-only
/* The ring of events, alone, and the texts of events. */
#include "wire_kunit.h"
#include "../../include/uapi/ethercat.h"
#include "../../master/wire/event.h"
#include "../../master/wire/event_ring.h"

#ifndef __KERNEL__
#include <pthread.h>
#include <sched.h>
#endif

static struct ec_event_ring ring;

/* events whose words all follow from their number */
static void put(u64 n)
{
	struct ec_event e;
	unsigned int i;

	while (n--) {
		u32 x = (u32)ec_event_ring_head(&ring);

		e = (struct ec_event){
			.time_ns = x, .wall_ns = ~(u64)x, .kind = EC_EVENT_DEBUG, .slave = (u16)x,
		};
		for (i = 0; i < EC_EVENT_ARGS; i++)
			e.arg[i] = x * 2654435761u + i;
		ec_event_ring_put(&ring, &e);
	}
}

static bool is_whole(const struct ec_event *e)
{
	u32 x = (u32)e->number;
	unsigned int i;

	for (i = 0; i < EC_EVENT_ARGS; i++)
		if (e->arg[i] != x * 2654435761u + i)
			return false;
	return e->kind == EC_EVENT_DEBUG && e->time_ns == x && e->wall_ns == ~(u64)x &&
	       e->slave == (u16)x;
}

static u64 lost_by(const struct ec_event *e)
{
	return e->kind == EC_EVENT_MISSED ? (u64)e->arg[1] << 32 | e->arg[0] : 0;
}

static void event_empty_ring_has_no_event(struct kunit *test)
{
	struct ec_event e = { 0 };
	u64 at = 0;

	memset(&ring, 0, sizeof(ring));
	KUNIT_EXPECT_FALSE(test, ec_event_ring_get(&ring, &at, &e));
	KUNIT_EXPECT_EQ(test, at, 0ull);
	/* one that waits for events to come */
	put(1);
	KUNIT_EXPECT_TRUE(test, ec_event_ring_get(&ring, &at, &e));
	KUNIT_EXPECT_TRUE(test, is_whole(&e));
	KUNIT_EXPECT_FALSE(test, ec_event_ring_get(&ring, &at, &e));
}

static void event_reader_gets_all_across_wraps(struct kunit *test)
{
	struct ec_event e = { 0 };
	u64 at = 0, n = 0;
	unsigned int i;

	memset(&ring, 0, sizeof(ring));
	for (i = 0; i < 7; i++) {
		put(EC_EVENTS_KEPT - i);
		while (ec_event_ring_get(&ring, &at, &e)) {
			KUNIT_ASSERT_EQ(test, e.number, n);
			KUNIT_ASSERT_TRUE(test, is_whole(&e));
			n++;
		}
		KUNIT_EXPECT_EQ(test, n, ec_event_ring_head(&ring));
	}
}

static void event_slow_reader_learns_exact_gap(struct kunit *test)
{
	static const u32 more[] = { 1, 2, EC_EVENTS_KEPT, EC_EVENTS_KEPT + 1, 100000 };
	struct ec_event e = { .time_ns = 7, .wall_ns = 8 };
	u64 at, n;
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(more); i++) {
		memset(&ring, 0, sizeof(ring));
		put(5);
		at = 2;
		put(EC_EVENTS_KEPT - 3 + more[i]);
		e.time_ns = 7;
		KUNIT_ASSERT_TRUE(test, ec_event_ring_get(&ring, &at, &e));
		KUNIT_EXPECT_EQ(test, lost_by(&e), (u64)more[i]);
		KUNIT_EXPECT_EQ_MSG(test, e.number, 2ull, "the first one that is lost");
		KUNIT_EXPECT_EQ_MSG(test, e.time_ns, 7ull, "the caller's time");
		for (n = 0; ec_event_ring_get(&ring, &at, &e); n++)
			KUNIT_ASSERT_TRUE(test, is_whole(&e));
		KUNIT_EXPECT_EQ(test, n, (u64)EC_EVENTS_KEPT);
	}
}

static void event_oldest_number_is_of_kept_event(struct kunit *test)
{
	memset(&ring, 0, sizeof(ring));
	KUNIT_EXPECT_EQ(test, ec_event_ring_oldest(&ring), 0ull);
	put(EC_EVENTS_KEPT);
	KUNIT_EXPECT_EQ(test, ec_event_ring_oldest(&ring), 0ull);
	put(1);
	KUNIT_EXPECT_EQ(test, ec_event_ring_oldest(&ring), 1ull);
}

#ifndef __KERNEL__
#define STRESS	3000000

static void *writer(void *arg)
{
	unsigned int *done = arg;
	unsigned int i;

	for (i = 0; i < STRESS; i++) {
		put(1);
		if (!(i % 100000))
			sched_yield();
	}
	__atomic_store_n(done, 1, __ATOMIC_RELEASE);
	return NULL;
}

/* Two of them, one that is often too slow: each event is whole or counted as lost, once. */
static void *reader(void *arg)
{
	unsigned int *done = arg, last = 0;
	struct ec_event e = { 0 };
	u64 at = 0, sum = 0;
	bool more;

	while (!last) {
		last = __atomic_load_n(done, __ATOMIC_ACQUIRE);
		do {
			u64 before = at;

			more = ec_event_ring_get(&ring, &at, &e);
			if (!more)
				break;
			if (e.number != before ||
			    (lost_by(&e) ? at != before + lost_by(&e) : !is_whole(&e)))
				return (void *)1;
			sum += lost_by(&e) ?: 1;
		} while (more);
	}
	return (void *)(uintptr_t)(sum == STRESS ? 0 : 2);
}

static void event_threads_read_whole_events_beside_writer(struct kunit *test)
{
	pthread_t w, r[2];
	unsigned int done = 0, i;
	void *ret;

	memset(&ring, 0, sizeof(ring));
	for (i = 0; i < 2; i++)
		KUNIT_ASSERT_EQ(test, pthread_create(&r[i], NULL, reader, &done), 0);
	KUNIT_ASSERT_EQ(test, pthread_create(&w, NULL, writer, &done), 0);
	pthread_join(w, NULL);
	for (i = 0; i < 2; i++) {
		pthread_join(r[i], &ret);
		KUNIT_EXPECT_EQ(test, (uintptr_t)ret, (uintptr_t)0);
	}
}
#endif

static void event_each_kind_has_text_and_unique_name(struct kunit *test)
{
	char text[200];
	u32 kind, other, n = 0;

	for (kind = 0; kind < 0x100; kind++) {
		struct ec_event e = { .kind = kind, .slave = 3, .arg = { 1, 2, 3, 4, 5, 6 } };
		const struct ec_event_kind *k = ec_event_kind(kind);
		int len = ec_event_text(&e, text, sizeof(text));

		KUNIT_EXPECT_EQ(test, (size_t)len, strlen(text));
		KUNIT_EXPECT_GT_MSG(test, len, 0, "kind 0x%x", kind);
		KUNIT_EXPECT_EQ_MSG(test, !k, !strncmp(text, "unknown event", 13), "kind 0x%x: %s",
				    kind, text);
		KUNIT_EXPECT_NULL_MSG(test, strchr(text, '%'), "%s", text);
		n += !!k;
		for (other = 0; k && other < kind; other++)
			if (ec_event_kind(other))
				KUNIT_EXPECT_STRNEQ(test, ec_event_kind(other)->name, k->name);
	}
	KUNIT_EXPECT_EQ(test, n, 57u);
}

/* A record of any content, a buffer of any size. */
static void event_text_fits_any_buffer_for_any_record(struct kunit *test)
{
	struct ec_event e;
	char text[210];
	u32 kind, size, i;

	for (kind = 0; kind < 0x80; kind++) {
		memset(&e, 0xff, sizeof(e));
		e.kind = kind;
		for (i = 0; i < 2; i++) {
			for (size = 0; size <= 200; size += size < 4 ? 1 : 49) {
				memset(text, 'x', sizeof(text));
				KUNIT_EXPECT_LT(test, ec_event_text(&e, text, size),
						(int)max(size, 1u));
				KUNIT_ASSERT_EQ(test, text[size], 'x');
				KUNIT_ASSERT_TRUE(test, !size || memchr(text, 0, size));
			}
			memset(e.arg, 0x81, sizeof(e.arg));
		}
	}
}

static void expect(struct kunit *test, struct ec_event e, const char *want)
{
	char text[200];

	ec_event_text(&e, text, sizeof(text));
	KUNIT_EXPECT_STREQ(test, text, want);
}

#define E(k, s, ...) \
	(struct ec_event){ .kind = EC_EVENT_##k, .slave = s, .arg = { __VA_ARGS__ } }

static void event_texts_name_slave_and_values(struct kunit *test)
{
	expect(test, E(SLAVE_LOST, 5, 4, 1, 0, 2, 0x044c2c52, 20),
	       "behind port 1 of slave 4: slave 5 (0x00000002/0x044c2c52) disconnected, last seen 20 ms ago");
	expect(test, E(RING_OPEN, 0xffff, 3, 1, 4),
	       "ring open between port 1 of slave 3 and slave 4: slaves run on, a second break is not covered; check the cable there");
	expect(test, E(RING_OPEN, 0xffff, EC_EVENT_NONE, EC_EVENT_NONE, EC_EVENT_NONE),
	       "ring open between the main device and the backup device: slaves run on, a second break is not covered; check the cable there");
	expect(test, E(RING_CLOSED, 0xffff, 8), "ring of 8 slave(s) closed");
	expect(test, E(RING_EXCHANGED, 0xffff, 1),
	       "devices of the ring exchanged: the backup device is at port 0 of the first slave, and is the main device now; exchange the cables or the two names");
	expect(test, E(RING_EXCHANGED, 0xffff, 0), "devices of the ring connected as configured");
	expect(test, E(RING_TURNED, 7),
	       "slave 7: connected the wrong way round in the ring, or beside a branch at a wrong port: let port 0 lead towards the main device; until then no application is activated");
	expect(test, E(SLAVE_LOST, 0, EC_EVENT_NONE, 0, 1001, 2, 3, 4),
	       "behind the main device: slave 0 (alias 1001, 0x00000002/0x00000003) disconnected, last seen 4 ms ago");
	expect(test, E(SLAVE_FOUND, 5, 4, 1, 0, 2, 3),
	       "behind port 1 of slave 4: slave 5 (0x00000002/0x00000003) connected");
	expect(test, E(SLAVE_LOST, 1, 0, 2, 0, 2, 3, 20, 7),
	       "behind port 2 of slave 0: 7 slaves disconnected, 1 (0x00000002/0x00000003) to 7, last seen 20 ms ago");
	expect(test, E(SLAVE_FOUND, 1, 0, 2, 0, 2, 3, 7),
	       "behind port 2 of slave 0: 7 slaves connected, 1 (0x00000002/0x00000003) to 7");
	expect(test, E(SLAVE_BACK, 1, 20, 7), "slaves 1 to 7: back in OP, 20 ms after they were last seen");
	expect(test, E(AL_ERROR, 5, 4, 0x1b),
	       "slave 5: AL state SAFEOP with error, AL status code 0x001b (SyncManager watchdog expired: no outputs came in time)");
	expect(test, E(AL_LEFT, 5, 4, 8), "slave 5: AL state OP left without request, now SAFEOP");
	expect(test, E(LINK_DOWN, EC_EVENT_NO_SLAVE, 0), "main link down");
	expect(test, E(WKC, EC_EVENT_NO_SLAVE, 1, 2, 3, 3), "domain 1: working counter 2 of 3, before 3");
	expect(test, E(WKC, EC_EVENT_NO_SLAVE, 1, 2, 3, 3, 9),
	       "domain 1: working counter 2 of 3, before 3; 9 more change(s)");
	expect(test, E(WKC, EC_EVENT_NO_SLAVE, 1, 3, 3, 3, 0, 0, 1),
	       "domain 1: working counter 3 of 3 in sum, not of each datagram, before 3");
	expect(test, E(WKC, EC_EVENT_NO_SLAVE, 1, 4, 3, 3, 0, 0, 1),
	       "domain 1: working counter 4 of 3, before 3: more slaves answer than it has, see 'ethercat why'");
	expect(test, E(MISSED, EC_EVENT_NO_SLAVE, 1, 1),
	       "4294967297 event(s) missed: the reader was too slow");
	expect(test, E(LOCK, EC_EVENT_NO_SLAVE, 2, (u32)-12, (u32)-3),
	       "kernel cycle locked: phase error -12 ns, rate -3 ppb");
	expect(test, E(REF_CLOCK, EC_EVENT_NO_SLAVE, EC_EVENT_NONE, 1),
	       "reference clock lost: clocks run free");
	expect(test, E(REF_CLOCK, EC_EVENT_NO_SLAVE, 3, 1, 1),
	       "reference clock lost: slave 3 substitutes until it returns");
	expect(test, E(ACTIVATED, EC_EVENT_NO_SLAVE, 4711, 1, 24, 2),
	       "session activated: 1 domain(s), 24 bytes, 2 datagram(s) per cycle, process 4711");
	expect(test, E(PORT_KEPT, 5, 2, EC_PORT_NO_REPLY),
	       "slave 5: port 2 stays closed despite its link: no slave replies behind it; connect port 0 (IN) of a slave there, or remove the cable");
	expect(test, E(PORT_KEPT, 5, 2, EC_PORT_LOSSES, 3, 10, 60),
	       "slave 5: port 2 stays closed despite its link: it has lost its link again and again (3 times in 10 s; opened after 1 s of link, then after up to 60 s); check cable and plugs");
	expect(test, E(PORT_KEPT, 5, 2, EC_PORT_SIGN, 0, 0, 0, 2, 0x07d83052, 3),
	       "slave 5: port 2 stays closed despite its link: another alias or identification than the group: 0x00000002/0x07d83052, 3 slaves; connect the right one, or 'ethercat slaves -p 5 --let-in 2'");
	expect(test, E(PORT_KEPT, 5, 2, EC_PORT_BOOT),
	       "slave 5: port 2 stays closed despite its link: a device in BOOT; switch it off and on, or 'ethercat slaves -p 5 --let-in 2'");
	expect(test, E(LINE_ERRORS, 7, 1, 12, 0, 10, 8),
	       "12 CRC errors in 10 s at port 1 of slave 7: cable to slave 8; check that cable, its plugs and shielding");
	expect(test, E(LINE_ERRORS, 0, 0, 12, 3, 11, EC_EVENT_NONE, 0, 1),
	       "12 CRC errors, 3 receiver errors in 11 s at port 0 of slave 0: cable to the main device; check that cable, its plugs and shielding");
	expect(test, E(LINE_ERRORS, 7, 1, 0, 3, 10, EC_EVENT_NONE),
	       "3 receiver errors in 10 s at port 1 of slave 7, where no slave is connected; check that cable, its plugs and shielding");
	expect(test, E(GROUP, 4, 0, EC_CAUSE_NONE, 0, 2),
	       "group 0: connected, 2 slave(s) from slave 4 on");
	expect(test, E(GROUP, EC_EVENT_NO_SLAVE, 1, EC_CAUSE_NO_GROUP, 1, 2),
	       "mandatory group 1: not connected");
	expect(test, E(GROUP, 4, 1, EC_CAUSE_GROUP, 0, 2),
	       "group 1: not started because of slave 4; see 'ethercat why'");
	expect(test, E(REVISION, 5, 2, 3), "slave 5: revision 0x00000003, expected 0x00000002");
}

/* The line of the kernel log has the slave in its prefix, and names that no record has. */
static void event_line_has_names_and_level(struct kunit *test)
{
	static const struct ec_event_more more = {
		.detail = "eth1", .place = "port 2 of slave 0 (EK1100)", .name = "EL2008",
		.last = "EL3062",
	};
	static const struct {
		struct ec_event e;
		const char *text;
		enum ec_event_line level;
		bool of_slave;
	} lines[] = {
		{ E(DEVICE_ON, EC_EVENT_NO_SLAVE, 0), "main device attached: eth1",
		  EC_LINE_INFO, false },
		{ E(AL_LEFT, 5, 4, 8), "AL state OP left without request, now SAFEOP: eth1",
		  EC_LINE_WARN, true },
		{ E(SLAVE_FAILED, 5, 2), "configuration failed: eth1", EC_LINE_WARN, true },
		{ E(SLAVE_BACK, 5, 20, 1), "back in OP, 20 ms after it was last seen",
		  EC_LINE_INFO, true },
		{ E(SLAVE_BACK, 5, 20, 2),
		  "slaves 5 to 6: back in OP, 20 ms after they were last seen",
		  EC_LINE_INFO, false },
		{ E(SLAVE_LOST, 1, 0, 2, 9, 2, 3, 20, 7),
		  "behind port 2 of slave 0 (EK1100): 7 slaves disconnected, 1 (alias 9, EL2008) to 7 (EL3062), last seen 20 ms ago",
		  EC_LINE_WARN, false },
		{ E(SLAVE_FOUND, 1, 0, 2, 0, 2, 3, 1),
		  "behind port 2 of slave 0 (EK1100): slave 1 (EL2008) connected",
		  EC_LINE_INFO, false },
		{ E(LINE_ERRORS, 7, 1, 12, 0, 10, 8),
		  "12 CRC errors in 10 s at port 1 of slave 7 (EL2008): cable to slave 8 (EL3062); check that cable, its plugs and shielding",
		  EC_LINE_WARN, false },
		/* complete, no longer, while the application takes the slaves to PREOP */
		{ E(WKC, EC_EVENT_NO_SLAVE, 1, 3, 2, 3, 0, 0, 0, 1),
		  "domain 1: working counter 3 of 3, before 2", EC_LINE_INFO, false },
		{ E(WKC, EC_EVENT_NO_SLAVE, 1, 2, 3, 3, 0, 0, 1, 0),
		  "domain 1: working counter 2 of 3, before 3", EC_LINE_WARN, false },
		{ E(WKC, EC_EVENT_NO_SLAVE, 1, 2, 3, 3, 0, 1, 1, 0),
		  "domain 1: working counter 2 of 3, before 3", EC_LINE_NONE, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 2, 0x512, 0, 3, 4, 6),
		  "unit 2: outputs zero, slaves to SAFEOP: domain 3 has working counter 4 of 6",
		  EC_LINE_WARN, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 2, 0x122, 0, EC_EVENT_NONE, 0, 0, 5),
		  "unit 2: outputs held: a slave is not in OP; 5 more change(s) before",
		  EC_LINE_WARN, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 1, 0x101, 0, EC_EVENT_NONE),
		  "unit 1: outputs of the application: complete", EC_LINE_INFO, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 1, 0x311, 1),
		  "unit 1: outputs zero: no new outputs within the lease", EC_LINE_WARN, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 1, 0x101, 1),
		  "unit 1: outputs of the application: new outputs", EC_LINE_INFO, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 1, 0x101, 2),
		  "unit 1: outputs of the application: authority given", EC_LINE_INFO, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 1, 0x11, 2),
		  "unit 1: outputs zero: authority taken", EC_LINE_INFO, false },
		{ E(UNIT, EC_EVENT_NO_SLAVE, 1, 0x11, 3),
		  "unit 1: outputs zero: another unit has stopped all", EC_LINE_WARN, false },
		{ E(LOCK, EC_EVENT_NO_SLAVE, 1, 5, 6, 1),
		  "kernel cycle lost lock, seeking: phase error 5 ns, rate +6 ppb",
		  EC_LINE_WARN, false },
		{ E(LOCK, EC_EVENT_NO_SLAVE, 1, 5, 6),
		  "kernel cycle seeking: phase error 5 ns, rate +6 ppb", EC_LINE_NONE, false },
		{ E(SCAN_END, EC_EVENT_NO_SLAVE, 3, 4, 5, 0),
		  "scan complete: 3 slave(s) in 4 us, 5 frames: eth1", EC_LINE_NONE, false },
	};
	char text[200];
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(lines); i++) {
		ec_event_line(&lines[i].e, &more, text, sizeof(text));
		KUNIT_EXPECT_STREQ(test, text, lines[i].text);
		KUNIT_EXPECT_EQ_MSG(test, (u32)ec_event_level(&lines[i].e), (u32)lines[i].level,
				    "%s", text);
		KUNIT_EXPECT_EQ_MSG(test, ec_event_is_of_slave(&lines[i].e), lines[i].of_slave,
				    "%s", text);
	}
	/* the cycle must not print */
	KUNIT_EXPECT_TRUE(test, ec_event_is_later(EC_EVENT_WKC));
	KUNIT_EXPECT_TRUE(test, ec_event_is_later(EC_EVENT_STALL));
	KUNIT_EXPECT_FALSE(test, ec_event_is_later(EC_EVENT_SLAVE_LOST));
}

static void event_texts_name_cause_and_place(struct kunit *test)
{
	expect(test, E(SLAVE_FAILED, 3, 2, 0, EC_CAUSE_SDO, 0x06020000, 0x5f07, 1),
	       "slave 3: configuration failed: startup SDO 0x5f07:01, abort 0x06020000 (object does not exist)");
	expect(test, E(SLAVE_FAILED, 3, 2, 0, EC_CAUSE_SDO, 0, 0x60ff),
	       "slave 3: configuration failed: startup SDO 0x60ff:00, mailbox failed");
	expect(test, E(SLAVE_FAILED, 3, 2, 0x24, EC_CAUSE_REFUSED, 0x24, 0, 0, 0, 4),
	       "slave 3: configuration failed: SAFEOP refused, AL status code 0x0024 (input mapping invalid)");
	expect(test, E(SLAVE_FAILED, 3, 2, 0, EC_CAUSE_SLOW, 0, 0, 0, 0, 4),
	       "slave 3: configuration failed: SAFEOP not reached in time");
	expect(test, E(SLAVE_FAILED, 3, 1, 0, EC_CAUSE_EEPROM),
	       "slave 3: scan failed: EEPROM not readable or invalid");
	/* of an older module */
	expect(test, E(SLAVE_FAILED, 3, 2, 0x1b),
	       "slave 3: configuration failed: AL status code 0x001b (SyncManager watchdog expired: no outputs came in time)");
	expect(test, E(EEPROM, 3, 0, 0x12, 0x34),
	       "slave 3: EEPROM checksum 0x12, expected 0x34; content used anyway");
	expect(test, E(CONFIG, 3, 0, 3, EC_CAUSE_DIFFERENT, 2, 4, 2, 3),
	       "configuration 0:3: slave 3 is 0x00000002/0x00000003, configured is 0x00000002/0x00000004");
	expect(test, E(CONFIG, EC_EVENT_NO_SLAVE, 7, 0, EC_CAUSE_NO_ALIAS, 2, 4),
	       "configuration 7:0: no slave has alias 7");
	expect(test, E(CONFIG, EC_EVENT_NO_SLAVE, 0, 9, EC_CAUSE_NO_SLAVE, 2, 4),
	       "configuration 0:9: no slave (0x00000002/0x00000004) at its position");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(event_empty_ring_has_no_event),
	KUNIT_CASE(event_reader_gets_all_across_wraps),
	KUNIT_CASE(event_slow_reader_learns_exact_gap),
	KUNIT_CASE(event_oldest_number_is_of_kept_event),
#ifndef __KERNEL__
	KUNIT_CASE(event_threads_read_whole_events_beside_writer),
#endif
	KUNIT_CASE(event_each_kind_has_text_and_unique_name),
	KUNIT_CASE(event_text_fits_any_buffer_for_any_record),
	KUNIT_CASE(event_texts_name_slave_and_values),
	KUNIT_CASE(event_texts_name_cause_and_place),
	KUNIT_CASE(event_line_has_names_and_level),
	{}
};

static struct kunit_suite suite = { .name = "event", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
