// SPDX-License-Identifier: GPL-2.0-only
#include "devices/sim/describe.h"
#include "devices/sim/sim_link.h"
#include "devices/sim/sim_wire.h"
#include "master/carry/posts.h"
#include "master/link/device.h"
#include "segment.h"

static const u8 mac[ETH_ALEN] = { 0x02, 0x00, 0x00, 0xec, 0x00, 0x02 };

static const struct ec_links_ops links_ops = {
	.changed = ec_carry_changed,
};

/**
 * segment_begin() - links that tell nobody at a segment
 * @s: zeroed
 * @text: description of the segment
 *
 * Return: whether they are there; segment_end() must follow then.
 */
bool segment_begin(struct segment *s, const char *text)
{
	struct ec_sim_error err = { 0 };

	ec_base_init(&s->base, 0, 0);
	if (ec_sim_describe(&s->sim, &ec_sim_kernel_ops, text, strlen(text), NULL, &err)) {
		pr_info("alone: # line %u: %s\n", err.line, err.text);
		return CHECK(false);
	}
	s->riders.links = &s->links;
	if (!CHECK_EQ(ec_links_init(&s->links, &s->base, &links_ops, "test0", NULL), 0) ||
	    !CHECK_EQ(ec_carry_init(&s->carry, &s->links, NULL), 0)) {
		ec_sim_free(s->sim);
		return false;
	}
	ec_device_register(&s->links);
	s->device = ec_sim_link_create("test0", mac, s->sim, 0);
	if (!CHECK(!IS_ERR(s->device)))
		s->device = NULL;
	if (s->device && CHECK(ec_links_look(&s->links)))
		return true;
	segment_end(s);
	return false;
}

/**
 * segment_end() - links and segment go away
 * @s: segment; no higher layer uses its links
 */
void segment_end(struct segment *s)
{
	ec_device_unregister(&s->links);
	ec_carry_exit(&s->carry);
	ec_links_exit(&s->links);
	if (s->device)
		ec_sim_link_destroy(s->device);
	else
		ec_sim_free(s->sim);
}

/**
 * segment_fault() - something goes wrong from now on
 * @s: segment
 * @what: without "fault", as in a description
 */
void segment_fault(struct segment *s, const char *what)
{
	struct ec_sim_error err = { 0 };
	struct ec_sim_fault f = { 0 };

	if (ec_sim_command(s->sim, &ec_sim_kernel_ops, what, strlen(what), &f, &err)) {
		pr_info("alone: # %s: %s\n", what, err.text);
		CHECK(false);
		return;
	}
	CHECK_EQ(ec_sim_wire_fault(ec_sim_link_wire(s->device), &f), 0);
}
