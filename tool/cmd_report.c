// SPDX-License-Identifier: GPL-2.0-only
/* All that is known of a bus, as a page to send to a colleague. */
#include <errno.h>
#include <sys/stat.h>
#include <time.h>

#include "out.h"
#include "report.h"
#include "save.h"

static FILE *page;	/* that each() continues */

static int master(struct report *r)
{
	int err;

	if (facts_read(r->d, &r->facts) || facts_read_more(r->d, &r->facts))
		return 1;
	err = ect_why_quiet(r->d->h, &r->why);
	if (err)
		return dev_fail(r->d, err, "Master%u: cannot read what is known of the bus",
				r->d->master);
	html_text(r->f, "h1", NULL, "EtherCAT Master%u", r->d->master);
	return report_bus(r) || report_state(r) || report_cycle(r) || report_slaves(r) ||
	       report_log(r);
}

static int each(const struct tool *t, struct dev *d)
{
	struct report r = { .f = page, .d = d };
	int ret = master(&r);

	(void)t;
	ect_why_free(r.why);
	facts_free(&r.facts);
	return ret;
}

static void written(FILE *f)
{
	char when[HTML_TIME];

	html_text(f, "p", "note", "Written by 'ethercat report' at %s UTC.",
		  html_time((u64)time(NULL) * 1000000000, when));
}

static int run(struct tool *t, int argc, char **argv)
{
	struct save s;
	int ret;

	(void)argc, (void)argv;
	if (!t->output_file)
		return usage_error("missing option --output-file: the page to write");
	if (t->force ? save_begin(&s, t->output_file) : save_new(&s, t->output_file))
		return 1;
	page = s.f;
	html_begin(page);
	written(page);
	ret = dev_each(t, false, each);
	html_end(page);
	if (ret) {
		save_cancel(&s);
		return ret;
	}
	out_str("file", t->output_file, NULL);
	return save_end(&s);
}

const struct cmd cmd_report = {
	.name = "report",
	.run = run,
	.args = "",
	.opts = "mof",
	.summary = "Write a page with all that is known of a bus",
	.help = "A file of HTML that a browser shows without network: the bus as a picture with states and\n"
		"error counters, faults with their remedies as of 'ethercat why', links, settings, cycle with\n"
		"its histogram, domains, sync units, slaves, clocks, emergencies, log. It contains names and\n"
		"serial numbers of slaves, and the version of the kernel.\n"
		"It reads what the master knows and sends no frame. An existing FILE is replaced with --force\n"
		"only, and only when the page is complete.\n"
		"  ethercat report -o bus.html\n",
	.json = "file",
};
