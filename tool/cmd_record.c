// SPDX-License-Identifier: GPL-2.0-only
/* Values of a running session in each cycle, into a file. */
#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "current.h"
#include "out.h"
#include "record_file.h"
#include "record_kept.h"
#include "record_when.h"
#include "screen.h"

#define POLL_MS		200	/* then the time limit is checked without a record */
#define STOPPED_S	1.0	/* the cycle has stopped: no record for so long after the end */

/**
 * struct record - a recording while it runs
 * @t: options
 * @d: master
 * @l: all values
 * @values: those that are recorded: first those of the file, then those of the condition only
 * @columns: of the file
 * @n: how many columns
 * @all: how many values
 * @when: condition, NULL: the file begins with the first record
 * @kept: records before it was true
 * @file: result
 * @r: where records come from
 * @info: about them
 * @bits: of the values of a record
 * @triggered: the condition was true
 * @began_ns: when records began, CLOCK_MONOTONIC
 * @zero_ns: time 0 of the file
 * @first_ns: time of the first row
 * @last_ns: time of the last row
 * @before: rows before time 0
 * @lost: records that are missing between rows
 * @gaps: in so many places
 */
struct record {
	const struct tool *t;
	struct dev d;
	struct current l;
	const struct ect_value **values;
	struct record_column *columns;
	size_t n;
	size_t all;
	struct when *when;
	struct record_kept kept;
	struct record_file file;
	struct ect_recording *r;
	struct ect_record_info info;
	u64 *bits;
	bool triggered;
	s64 began_ns;
	s64 zero_ns;
	s64 first_ns;
	s64 last_ns;
	u64 before;
	u64 lost;
	u64 gaps;
};

static void record_free(struct record *x)
{
	when_free(x->when);
	record_kept_free(&x->kept);
	ect_record_free(x->r);
	current_free(&x->l);
	free(x->values);
	free(x->columns);
	free(x->bits);
	dev_close(&x->d);
}

/* The index of a value that is recorded, which may be a new one; columns come before others. */
static size_t take_value(struct record *x, const struct ect_value *v)
{
	size_t i = 0;

	while (i < x->all && x->values[i] != v)
		i++;
	if (i == x->all)
		x->values[x->all++] = v;
	return i;
}

/* A scaled value is a real number. */
static struct ec_type type_of(const struct record *x, const struct ect_value *v)
{
	return current_is_scaled(&x->l, v) ? (struct ec_type){ .bits = 64, .kind = EC_KIND_FLOAT } :
					     current_type(v);
}

static int take_columns(struct record *x, int argc, char **argv)
{
	for (int i = 0; i < argc; i++) {
		size_t fit = 0, omitted = 0;

		for (size_t k = 0; k < x->l.n; k++) {
			const struct ect_value *v = current_at(&x->l, k);

			if (!current_matches(v, argv[i]))
				continue;
			if (v->bits <= 64)
				take_value(x, v);
			omitted += v->bits > 64;
			fit++;
		}
		if (!fit) {
			current_find(&x->d, &x->l, argv[i]);
			return 1;
		}
		if (omitted)
			note("%zu value(s) of '%s' have more than 64 bits and are omitted",
			     omitted, argv[i]);
	}
	if (!x->all)
		return fail("no value with at most 64 bits to record");
	x->n = x->all;
	x->columns = calloc(x->n, sizeof(*x->columns));
	if (!x->columns)
		return fail("out of memory");
	for (size_t i = 0; i < x->n; i++) {
		const struct ect_value *v = x->values[i];
		struct ec_type type = type_of(x, v);

		x->columns[i] = (struct record_column){
			.name = v->name, .unit = current_unit_text(&x->l, v), .kind = type.kind,
			.bits = type.bits, .scaled = current_is_scaled(&x->l, v),
		};
	}
	return 0;
}

/* Values of the condition; when_parse() calls it for each name. */
static int when_value(void *ctx, const char *name, struct when_name *to)
{
	struct record *x = ctx;
	const struct ect_value *v = current_find(&x->d, &x->l, name);

	if (!v)
		return 1;
	if (v->bits > 64)
		return fail("%s has %u bits, more than a condition can compare", name, v->bits);
	to->index = take_value(x, v);
	to->type = type_of(x, v);
	return 0;
}

static s64 clock_ns(clockid_t id)
{
	struct timespec t;

	clock_gettime(id, &t);
	return (s64)t.tv_sec * 1000000000 + t.tv_nsec;
}

static int begin(struct record *x, int argc, char **argv)
{
	int err;

	if (current_read_as(x->t, &x->d, x->t->file, &x->l))
		return 1;
	x->values = calloc(x->l.n + 1, sizeof(*x->values));
	if (!x->values)
		return fail("out of memory");
	if (take_columns(x, argc, argv))
		return 1;
	if (x->t->when && when_parse(x->t->when, when_value, x, &x->when))
		return 1;
	x->bits = calloc(x->all, sizeof(*x->bits));
	if (!x->bits || record_kept_init(&x->kept, x->n))
		return fail("out of memory");
	if (record_file_open(&x->file, x->t->output_file, x->t->force, x->columns, x->n))
		return 1;
	x->info.struct_size = sizeof(x->info);
	err = ect_record_begin(x->d.h, x->values, x->all, &x->r, &x->info);
	/* also when no record ever comes, --time ends it */
	x->began_ns = clock_ns(CLOCK_MONOTONIC);
	if (!err)
		return 0;
	record_file_drop(&x->file);
	return dev_fail(&x->d, err, "Master%u: cannot record", x->d.master);
}

/* Time since 1970 of a time of CLOCK_MONOTONIC, by the current clock of the computer. */
static s64 wall_of(s64 ns)
{
	return clock_ns(CLOCK_REALTIME) - clock_ns(CLOCK_MONOTONIC) + ns;
}

static void add_row(struct record *x, const struct record_row *row)
{
	/* before the first row nothing is missing */
	struct record_row copy = *row;

	if (!x->file.rows) {
		copy.lost = 0;
		x->first_ns = copy.time_ns;
	}
	x->lost += copy.lost;
	x->gaps += copy.lost > 0;
	x->last_ns = copy.time_ns;
	record_file_row(&x->file, &copy);
}

/* From now on rows are written; those that were kept come first. */
static void start(struct record *x, s64 zero_ns)
{
	static char title[128];
	struct record_row row;

	snprintf(title, sizeof(title), "master %u, wc: 2 complete, 1 incomplete, 0 no slave",
		 x->d.master);
	x->triggered = true;
	x->zero_ns = zero_ns;
	record_file_begin(&x->file, zero_ns, wall_of(zero_ns), title);
	while (record_kept_take(&x->kept, zero_ns - (s64)(x->t->before_s * 1e9), &row)) {
		add_row(x, &row);
		x->before++;
	}
}

/* Those before the condition was true come in addition. */
static bool is_full(const struct record *x)
{
	return x->t->count && x->file.rows >= x->t->count + x->before;
}

/* Has the time of the recording ended, by the time of a record or of the clock? */
static bool is_over(const struct record *x, s64 now_ns)
{
	double limit = x->t->time_s;

	if (x->triggered && x->t->after_s >= 0 &&
	    (double)(now_ns - x->zero_ns) > x->t->after_s * 1e9)
		return true;
	return limit > 0 && (double)(now_ns - x->began_ns) >= limit * 1e9;
}

/* A value of the record that was read last */
static u64 bits_of(const struct record *x, size_t i)
{
	u64 bits = ect_record_bits(x->r, i);
	double number;

	if (!current_is_scaled(&x->l, x->values[i]))
		return bits;
	number = current_number(&x->l, x->values[i], bits);
	memcpy(&bits, &number, sizeof(bits));
	return bits;
}

/* Return: 0, 1 the recording is complete. */
static int take_record(struct record *x, const struct ect_record *rec)
{
	struct record_row row = {
		.time_ns = (s64)rec->time_ns, .app_time_ns = rec->app_time_ns,
		.cycle = rec->cycle, .lost = rec->missed, .wc_state = rec->wc_state,
		.bits = x->bits,
	};

	for (size_t i = 0; i < x->all; i++)
		x->bits[i] = bits_of(x, i);
	if (is_over(x, row.time_ns))
		return 1;
	if (!x->triggered && (!x->when || when_true(x->when, x->bits)))
		start(x, row.time_ns);
	if (!x->triggered)
		return record_kept_add(&x->kept, &row, row.time_ns - (s64)(x->t->before_s * 1e9));
	add_row(x, &row);
	return is_full(x);
}

/* Records up to the newest one. Return: 0, 1 the recording is complete, or a negative errno. */
static int take_records(struct record *x)
{
	struct ect_record rec = { .struct_size = sizeof(rec) };
	int ret;

	do {
		ret = ect_record_read(x->r, &rec);
		if (!ret)
			ret = take_record(x, &rec);
	} while (!ret && ect_record_waiting(x->r) && !x->file.err);
	return ret;
}

static int record(struct record *x)
{
	struct pollfd p = { .fd = ect_fd(x->d.h), .events = POLLIN };
	double flushed = now_s();
	int ret = 0;

	screen_catch_end();
	while (!ret && !screen_ended() && !x->file.err) {
		if (poll(&p, 1, POLL_MS) > 0)
			ret = take_records(x);
		else if (is_over(x, clock_ns(CLOCK_MONOTONIC) - (s64)(STOPPED_S * 1e9)))
			ret = 1;
		if (ret == -EINTR)
			ret = 0;
		/* what is in the file stays when this process is killed */
		if (!ret && x->file.rows && (!x->file.path || now_s() - flushed > 1)) {
			record_file_flush(&x->file);
			flushed = now_s();
		}
	}
	if (ret == -ENODATA)
		note("Master%u: the session has ended", x->d.master);
	else if (ret < 0)
		return dev_fail(&x->d, ret, "Master%u: cannot record", x->d.master);
	return 0;
}

static void summary(const struct record *x)
{
	double s = x->file.rows ? (double)(x->last_ns - x->first_ns) / 1e9 : 0;

	if (out_is_json()) {
		out_object(NULL);
		out_u("master", x->d.master, NULL);
		out_str("file", x->file.path, NULL);
		out_u("records", x->file.rows, NULL);
		out_u("values", x->n, NULL);
		out_u("lost", x->lost, NULL);
		out_u("gaps", x->gaps, NULL);
		out_u("ring_records", x->info.kept, NULL);
		out_end();
		return;
	}
	note("Master%u: %llu record(s) of %zu value(s) in %.3f s, %llu lost%s", x->d.master,
	     (unsigned long long)x->file.rows, x->n, s, (unsigned long long)x->lost,
	     x->lost ? ": this program was too slow" : "");
}

static int end(struct record *x, int ret)
{
	int err;

	if (!x->triggered) {
		record_file_drop(&x->file);
		if (ret)
			return ret;
		return x->when ? fail("the condition was never true: nothing is written") :
				 fail("no cycle was sent: nothing is written");
	}
	err = record_file_close(&x->file);
	summary(x);
	return err ? err : ret;
}

static int check_options(const struct tool *t)
{
	if (!t->when && (t->before_s > 0 || t->after_s >= 0))
		return usage_error("--before and --after need --when");
	if (t->json && !t->output_file)
		return usage_error("--json needs --output-file: the values go to stdout");
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct record x = { .t = t };
	int ret;

	if (check_options(t) || dev_open_single(&x.d, t, false))
		return 1;
	ret = begin(&x, argc, argv);
	if (!ret)
		ret = end(&x, record(&x));
	record_free(&x);
	return ret;
}

const struct cmd cmd_record = {
	.name = "record",
	.run = run,
	.args = "<NAME>...",
	.opts = "mofXBYVni",
	.summary = "Record values of the running session in each cycle",
	.help = "Names are those of 'ethercat data --names'; * and ? stand for any characters, quote\n"
		"them for the shell. Without --output-file CSV goes to stdout; a file that ends with\n"
		".npy is a structured array for numpy.load(), any other one is CSV. The first columns\n"
		"are time_s, app_time_ns (application time), cycle (sends since activation), lost\n"
		"(records missing before this one) and wc (working counters: 2 complete, 1 incomplete,\n"
		"0 no slave). Inputs are those received in the cycle, outputs those sent in it.\n"
		"\n"
		"Names, types, units and scaling are those of the bus file of the session, or of --file,\n"
		"also in --when.\n"
		"Ctrl-C ends it with a complete file. --time and --count end it earlier (--count counts no\n"
		"records of --before). With --when the file begins when the condition is true, with its\n"
		"time 0: names, numbers, + - ~ & ^ |\n"
		"== != < <= > >= ! && || and parentheses; & ^ | bind tighter than == and <:\n"
		"ethercat record 'axis1.*' -o a.csv --when 'axis1.status & 8' --before 1 --after 2\n"
		"\n"
		"The master keeps some seconds of records for a program that is stopped or slow; what\n"
		"is older is lost and counted. It works on the session of an application as well, sends no\n"
		"frame, and needs no permission to write. 1: nothing was recorded; 2: the file could not\n"
		"be written to its end, but is valid.\n",
	.json = "master, file, records, values, lost, gaps, ring_records",
	.flags = CMD_ONE_MASTER,
	.min_args = 1,
	.max_args = 1000,
};
