// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <stdlib.h>

#include "config_info.h"
#include "domain.h"
#include "out.h"
#include "unit.h"

#define WIRE_NS_PER_BYTE	80	/* at 100 Mbit/s */

static int fmmu(struct dev *d, const struct ect_domain *dom, unsigned int i, const char *in,
		const u8 *data, size_t size)
{
	struct ect_fmmu f = { .struct_size = sizeof(f) };
	int err = ect_domain_fmmu(d->h, dom->index, i, &f);
	char indent[16], name[CONFIG_NAME];
	struct ect_config c = { .struct_size = sizeof(c), .alias = f.alias,
				.position = f.position };
	size_t n;

	if (!err && f.config)
		err = ect_config_read(d->h, f.config - 1, &c);
	if (err)
		return dev_fail(d, err, "Master%u: FMMU %u of domain %u: no data", d->master, i,
				dom->index);
	n = f.offset < size ? min(size - f.offset, (size_t)f.size) : 0;
	snprintf(indent, sizeof(indent), "%s    ", in);
	out_object(NULL);
	out_u("alias", f.alias, "%s  SlaveConfig %s", in, config_name(&c, name, sizeof(name)));
	out_u("relative_position", f.position, NULL);
	out_str("group", c.group_name, NULL);
	out_u("sync_manager", f.sm, ", SM%u", f.sm);
	out_str("direction", f.dir == 1 ? "output" : "input", " (%6s)",
		f.dir == 1 ? "Output" : "Input");
	out_u("logical_address", f.logical, ", LogAddr 0x%08x", f.logical);
	out_u("size_bytes", f.size, ", Size %u\n", f.size);
	out_u("offset_bytes", f.offset, NULL);
	out_hex("data_hex", data + (n ? f.offset : 0), n, indent);
	out_end();
	return 0;
}

/* how the domain is configured to be sent, and how it is laid out */
static void layout(const struct tool *t, const char *in, const struct ect_domain *dom)
{
	static const struct {
		u32 bit;
		const char *key;
		const char *text;
	} options[] = {
		{ ECT_DOMAIN_OVERLAP, "overlap", "overlap" },
		{ ECT_DOMAIN_SEPARATE, "separate", "separate" },
		{ ECT_DOMAIN_OWN_FRAME, "own_frame", "own frame" },
	};
	bool text = t->verbosity > 0;
	const char *sep = ": ";

	if (text)
		out_text("%s  Options", in);
	out_array("options");
	for (unsigned int i = 0; i < ARRAY_SIZE(options); i++) {
		if (!(dom->options & options[i].bit))
			continue;
		out_str("", options[i].key, NULL);
		if (text)
			out_text("%s%s", sep, options[i].text);
		sep = ", ";
	}
	out_end();
	if (text)
		out_text("%s\n", dom->options ? "" : ": none");
	out_u("datagrams", dom->datagram_count, NULL);
	out_u("datagram_bytes", dom->datagram_bytes, NULL);
	if (text && dom->datagram_count)
		out_text("%s  Datagrams: %u, %u bytes, %.2f us of wire time\n", in,
			 dom->datagram_count, dom->datagram_bytes,
			 dom->datagram_bytes * WIRE_NS_PER_BYTE / 1000.0);
}

/* the unit that is judged with it */
static void unit(struct dev *d, const char *in, const struct ect_domain *dom)
{
	struct ect_unit u;

	if (!unit_of_domain(d, dom->index, &u)) {
		out_null("unit", NULL);
		return;
	}
	out_str("unit", u.name, "%s  Unit %s: policy %s", in, u.name, unit_policy(&u));
	if (u.active)
		out_text(", %s, outputs %s%s", unit_run(&u), unit_outputs(&u),
			 u.authority ? "" : ", no authority");
	out_text("\n");
}

/* A stale domain is marked in any case. */
static void age(const struct tool *t, const char *in, const struct ect_domain *dom)
{
	bool stale = dom->max_age && dom->age > dom->max_age;

	out_u("age_sends", dom->age, NULL);
	out_u("max_age_sends", dom->max_age, NULL);
	out_bool("stale", stale, NULL);
	if (!stale && (t->verbosity <= 0 || !dom->datagram_count))
		return;
	out_text("%s  Age of process data: %u send(s)", in, dom->age);
	if (dom->max_age)
		out_text(", limit %u", dom->max_age);
	out_text("%s\n", stale ? ": stale" : "");
}

static int show(const struct tool *t, struct dev *d, const struct ect_domain *dom)
{
	/* by wrong working counters of datagrams; an older module does not know that */
	bool cancelled = dom->working_counter == dom->expected &&
			 dom->wc_state == ECT_WC_INCOMPLETE;
	const char *in = d->selected > 1 ? "  " : "";
	u8 *data = NULL;
	size_t size = 0;
	int ret = 0;

	out_object(NULL);
	out_u("index", dom->index, "%sDomain%u", in, dom->index);
	out_u("logical_address", dom->logical, ": LogBaseAddr 0x%08x", dom->logical);
	out_u("size_bytes", dom->size, ", Size %3u", dom->size);
	out_u("working_counter", dom->working_counter, ", WorkingCounter %u",
	      dom->working_counter);
	out_u("expected_working_counter", dom->expected, "/%u%s\n", dom->expected,
	      cancelled ? " in sum, not of each datagram" : "");
	out_str("working_counter_state", !dom->working_counter ? "zero" :
		dom->working_counter != dom->expected || cancelled ? "incomplete" : "complete",
		NULL);
	unit(d, in, dom);
	age(t, in, dom);
	layout(t, in, dom);
	if (t->verbosity > 0) {
		ret = domain_data(d, dom, &data, &size);
		out_array("fmmus");
		for (unsigned int i = 0; i < dom->fmmu_count && !ret; i++)
			ret = fmmu(d, dom, i, in, data, size);
		out_end();
		free(data);
	}
	out_end();
	return ret;
}

static int each(const struct tool *t, struct dev *d)
{
	int ret;

	out_object(NULL);
	out_u("master", d->master, NULL);
	if (d->selected > 1)
		out_text("Master%u\n", d->master);
	out_array("domains");
	ret = domain_each(d, t, show);
	out_end();
	out_end();
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	out_array("masters");
	ret = dev_each(t, false, each);
	out_end();
	return ret;
}

const struct cmd cmd_domains = {
	.name = "domains",
	.run = run,
	.args = "",
	.opts = "mdv",
	.summary = "Show the domains of the application",
	.help = "WorkingCounter: of the last cycle / expected; equal when every slave exchanged its\n"
		"data. Wrong counters of datagrams may cancel each other: then it is equal 'in sum, not\n"
		"of each datagram'. --verbose adds the options of the domain (overlap: inputs at\n"
		"logical addresses of outputs; separate: LRD and LWR; own frame), its datagrams, and the\n"
		"share of each slave configuration. A domain of a sync unit shows it; 'ethercat units' says\n"
		"more. 'ethercat master -v' shows the wire time of a\n"
		"cycle. Age of process data: sends of the domain since the send of the newest received\n"
		"frame; shown with --verbose, and when it exceeds its limit (stale).\n",
	.json = "masters[]: master, domains[]: index, logical_address, size_bytes,\n"
		"working_counter, expected_working_counter, working_counter_state (zero, incomplete,\n"
		"complete: each datagram has its counter), unit (name, or null), age_sends,\n"
		"max_age_sends (0: no limit),\n"
		"stale, options[] (overlap, separate, own_frame),\n"
		"datagrams, datagram_bytes, with --verbose fmmus[]: alias, relative_position,\n"
		"sync_manager, direction, logical_address, size_bytes, offset_bytes, data_hex",
	.flags = CMD_HISTORIC,
};
