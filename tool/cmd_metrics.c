// SPDX-License-Identifier: GPL-2.0-only
/* What is known of the masters, for a program that stores and compares it. */
#include <stdlib.h>

#include "http.h"
#include "metrics.h"
#include "out.h"

#define CONTENT_TYPE	"application/openmetrics-text; version=1.0.0; charset=utf-8"

/* masters read so far: those of a call of dev_each() */
static struct facts *all;
static size_t count;

static int each(const struct tool *t, struct dev *d)
{
	struct facts *more = realloc(all, (count + 1) * sizeof(*more));
	int ret;

	(void)t;
	if (!more)
		return fail("out of memory");
	all = more;
	ret = facts_read(d, &all[count]) || facts_read_more(d, &all[count]);
	if (ret)
		facts_free(&all[count]);
	else
		count++;
	return ret;
}

/* NULL: out of memory */
static char *text_of_all(void)
{
	char *text = NULL;
	size_t n;
	FILE *f = open_memstream(&text, &n);

	if (!f)
		return NULL;
	metrics_write(f, all, count);
	if (fclose(f)) {
		free(text);
		return NULL;
	}
	return text;
}

static int print(struct tool *t)
{
	int ret = dev_each(t, false, each);
	char *text = count || !ret ? text_of_all() : NULL;

	if (text)
		out_str("openmetrics", text, "%s", text);
	else if (!ret)
		ret = fail("out of memory");
	free(text);
	return ret;
}

/* A master that is not readable makes the whole scrape fail: the reason is in the journal. */
static int serve(struct tool *t)
{
	enum http_wish wish = http_request("/metrics");
	char *text;
	int ret;

	if (wish == HTTP_NOTHING)
		return 0;
	ret = dev_each(t, false, each);
	text = ret ? NULL : text_of_all();
	if (text)
		http_reply("200 OK", CONTENT_TYPE, text, wish == HTTP_HEAD);
	else
		http_reply("503 Service Unavailable", "text/plain; charset=utf-8",
			   "the masters cannot be read; see the journal\n", wish == HTTP_HEAD);
	free(text);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	int ret;

	(void)argc, (void)argv;
	if (t->http && t->json)
		return usage_error("--http and --json exclude each other");
	ret = t->http ? serve(t) : print(t);
	while (count)
		facts_free(&all[--count]);
	free(all);
	return ret;
}

const struct cmd cmd_metrics = {
	.name = "metrics",
	.run = run,
	.args = "",
	.opts = "mk",
	.summary = "Print the state of masters and slaves as OpenMetrics",
	.help = "For Prometheus and programs like it: links, frames, cycle and send deviation, working\n"
		"counters, sync units, AL states, clocks, emergencies, error counters of the ports. It reads\n"
		"what the master knows and sends no frame; error counters are as the master has read them\n"
		"last (module parameter line_errors). Label slave is the ring position.\n"
		"--http replies to a request of HTTP on stdin, as ethercat-metrics.socket needs it.\n",
	.json = "openmetrics (the text)",
};
