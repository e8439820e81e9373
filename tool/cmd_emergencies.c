// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <time.h>

#include "../master/wire/sii.h"
#include "dev.h"
#include "out.h"

struct found {
	bool any;		/* emergencies on this master */
	bool narrowed;		/* by -a or -p */
};

static void entry(u16 position, const struct ect_emergency *e)
{
	const time_t s = (time_t)(e->time_ns / 1000000000);
	char when[32] = "?";
	struct tm tm;

	if (gmtime_r(&s, &tm))
		strftime(when, sizeof(when), "%Y-%m-%d %H:%M:%S", &tm);
	out_object(NULL);
	out_text("%4u  %s.%03u UTC", position, when, (unsigned int)(e->time_ns / 1000000 % 1000));
	out_u("time_ns", e->time_ns, NULL);
	out_u("code", e->code, "  0x%04x", e->code);
	out_u("error_register", e->error_register, "  0x%02x", e->error_register);
	out_text("  %02x %02x %02x %02x %02x", e->data[0], e->data[1], e->data[2], e->data[3],
		 e->data[4]);
	if (out_is_json())
		out_hex("data_hex", e->data, sizeof(e->data), "");
	out_str("text", e->text, "  %s\n", e->text);
	out_end();
}

static bool has_coe(const struct ect_slave *s)
{
	return s->mbox_protocols & EC_SII_PROTO_COE;
}

static int slave(const struct slave_walk *w, const struct tool *t, struct dev *d,
		 const struct ect_slave *s, bool several)
{
	struct found *found = w->ctx;
	struct ect_list *list;
	unsigned int n;
	u32 total;
	int err = ect_emergencies_read(d->h, s->device, &total, &list);

	(void)t, (void)several;
	if (err)
		return dev_fail(d, err, "Master%u slave %u: cannot read the emergencies",
				d->master, s->position);
	n = (unsigned int)ect_list_count(list);
	out_object(NULL);
	out_u("position", s->position, NULL);
	out_u("total", total, NULL);
	if (total > n)
		out_text("%4u  the last %u of %u\n", s->position, n, total);
	out_array("emergencies");
	for (unsigned int k = 0; k < n; k++)
		entry(s->position, ect_list_get(list, k));
	out_end();
	out_end();
	found->any |= n;
	ect_list_free(list);
	return 0;
}

static int end(const struct slave_walk *w, struct dev *d, size_t taken, size_t selected)
{
	struct found *found = w->ctx;

	(void)d, (void)taken;
	if (!found->any && (selected || !found->narrowed))
		out_text("None.\n");
	found->any = false;
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct found found = { .narrowed = !list_all(&t->aliases) || !list_all(&t->positions) };
	const struct slave_walk w = {
		.title = true, .takes = has_coe, .slave = slave, .end = end, .ctx = &found,
	};

	(void)argc, (void)argv;
	return dev_each_slave(t, &w);
}

const struct cmd cmd_emergencies = {
	.name = "emergencies",
	.run = run,
	.args = "",
	.opts = "map",
	.summary = "Show the last CoE emergencies of slaves",
	.help = "The master fetches them in PREOP and above, and keeps the last 16 of each slave. Columns:\n"
		"position, time at which the master has fetched it, error code, error register,\n"
		"manufacturer's data, text of the code. Code 0x0000: the error is over.\n",
	.json = "masters[]: master, slaves[]: position, total, emergencies[]: time_ns (since 1970),\n"
		"code, error_register, data_hex, text",
};
