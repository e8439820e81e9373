// SPDX-License-Identifier: GPL-2.0-only
/*
 * A machine that has run for long: half of its memory is free, but in pieces of 32 KiB. The
 * kernel tries hard to find pieces of that size, not larger ones.
 */
#include <linux/gfp.h>
#include <linux/mm.h>
#include "cyc.h"
#include "req.h"
#include "master/boundary/ioctl.h"

#define ORDER	PAGE_ALLOC_COSTLY_ORDER
#define SLAVES	300
#define LARGE	(64 * 1024)

/* first bytes of a block that is held */
struct block {
	struct block *next;
};

static struct block *held, *larger;

static void *block(unsigned int order)
{
	return (void *)__get_free_pages(GFP_KERNEL | __GFP_NORETRY | __GFP_NOWARN, order);
}

/* All blocks are taken, then one of each pair that would make a larger one is given back. */
static void fragment(struct kunit *test)
{
	struct block *b, *next, *keep = NULL;
	void *p;

	while ((b = block(ORDER))) {
		b->next = held;
		held = b;
	}
	for (b = held; b; b = next) {
		next = b->next;
		if (page_to_pfn(virt_to_page(b)) & BIT(ORDER)) {
			free_pages((unsigned long)b, ORDER);
		} else {
			b->next = keep;
			keep = b;
		}
	}
	held = keep;
	/* what was kept back until now, or has become whole since */
	while ((b = block(ORDER + 1))) {
		b->next = larger;
		larger = b;
	}
	/* else this test would show nothing */
	p = kmalloc(LARGE, GFP_KERNEL | __GFP_NORETRY | __GFP_NOWARN);
	KUNIT_EXPECT_NULL(test, p);
	kfree(p);
}

static void defragment(void)
{
	struct block *next;

	for (; held; held = next) {
		next = held->next;
		free_pages((unsigned long)held, ORDER);
	}
	for (; larger; larger = next) {
		next = larger->next;
		free_pages((unsigned long)larger, ORDER + 1);
	}
}

static void leave(struct kunit *test)
{
	bus_exit(test);
	defragment();
}

/* What an application may want in large: process data, startup SDOs, requests. */
static struct cyc *configure(struct bus *b, u32 *request)
{
	struct cyc *c = cyc_new(b, 10000);
	u8 *value = kvzalloc(LARGE, GFP_KERNEL);
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, value);
	cyc_domain(c);
	cyc_map_all(c, 0, SLAVES, 0);
	for (i = 0; i < 8; i++)
		req_add(c, i, EC_REQUEST_SDO, LARGE);
	*request = req_add(c, 0, EC_REQUEST_SDO, LARGE);
	/* too large for the object: only that it can be kept is of interest */
	for (i = 0; i < 4; i++) {
		struct ec_ioc_sc_sdo sdo = {
			.config = 0, .index = 0x2000, .subindex = 1, .size = LARGE,
			.data = (uintptr_t)value,
		};

		KUNIT_EXPECT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_SDO, &sdo), 0);
	}
	kvfree(value);
	return c;
}

static void memory_fragmented(struct kunit *test)
{
	char text[96];
	struct bus *b;
	struct cyc *c;
	u32 request, op, i;

	fragment(test);
	snprintf(text, sizeof(text), "segment seed=3\nrepeat %u slave d drive in=100 out=100\n",
		 SLAVES);
	b = bus_up(test, text, SLAVES);
	bus_idle(b);
	c = configure(b, &request);
	cyc_activate(c);
	for (i = 0; i < 1000; i++) {
		cyc_run(c, 1);
		for (op = 0; op < SLAVES && bus_slave(b, op)->al.status == EC_AL_OP; op++)
			;
		if (op == SLAVES)
			break;
	}
	/* but for the one whose startup SDOs are refused */
	for (i = 1; i < SLAVES; i++)
		KUNIT_EXPECT_EQ_MSG(test, bus_slave(b, i)->al.status, EC_AL_OP, "slave %u", i);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_EQ(test, req_do(c, 1, 0x1018, 1, EC_REQUEST_OP_READ, 0), 0);
	cyc_release(c);
	bus_idle(b);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(memory_fragmented),
	{ }
};

static struct kunit_suite suite = { .name = "bus_memory", .exit = leave, .test_cases = cases };
kunit_test_suite(suite);
