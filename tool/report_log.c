// SPDX-License-Identifier: GPL-2.0-only
/* What has happened on the bus, the newest last. */
#include <errno.h>

#include "report.h"

static void event(const struct report *r, const struct ect_event *e)
{
	char when[HTML_TIME];

	html_row(r->f);
	html_cell(r->f, "%s", html_time(e->wall_ns, when));
	html_cell(r->f, "%s", e->text);
}

/* events up to number @end; the read waits for none of them, since they have happened */
static int events(const struct report *r, u64 at, u64 end)
{
	while (at < end) {
		const struct ect_event *e;
		struct ect_list *list;
		int err = ect_events_read(r->d->h, &list);
		bool last;

		if (err)
			return dev_fail(r->d, err, "Master%u: cannot read events", r->facts.master);
		for (size_t i = 0; at < end && (e = ect_list_get(list, i)); i++) {
			event(r, e);
			at = e->number + (e->kind == ECT_EVENT_MISSED ? e->missed : 1);
		}
		last = !ect_list_count(list);
		ect_list_free(list);
		if (last)
			break;
	}
	return 0;
}

int report_log(const struct report *r)
{
	u64 first, next;
	int ret, err = ect_events_begin(r->d->h, 0, &first, &next);

	/* an older module has none */
	if (err == -ENOTTY)
		return 0;
	if (err)
		return dev_fail(r->d, err, "Master%u: cannot read events", r->facts.master);
	html_heading(r->f, "Log");
	html_table(r->f, "Time (UTC)|Event");
	ret = events(r, first, next);
	html_table_end(r->f);
	return ret;
}
