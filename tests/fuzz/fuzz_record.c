// SPDX-License-Identifier: GPL-2.0-only
/*
 * Recordings of others: read and drawn, or refused with a text. An input that begins with '?' is a
 * condition instead.
 */
#include "fuzz.h"

#include <stdarg.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "../../tool/plot.h"
#include "../../tool/record_file.h"
#include "../../tool/record_when.h"
#include "../../tool/tool.h"

#define NPY(text)	"\x93NUMPY\1\0\x80\0" text

const struct fuzz_seed fuzz_seeds[] = {
	SEED("# ethercat record: time 0 is 2026-11-30T00:14:29.1Z, master 0\n"
	     "time_s,app_time_ns,cycle,lost,wc,a.b,\"c [mm]\"\n0.1,0,1,0,2,-3,1e3\n"
	     "0.2,0,2,0,2,1,nan\n0.9,0,9,6,1,0,inf\n"),
	SEED("a\r\n1\r\n\"2\"\n"),
	SEED("time_s,a\n1e17,1e300\n100000000000000016,1.0000000000000002e300\n"),
	SEED(NPY("{'descr': [(('seconds since x', 'time_s'), '<f8'), ('lost', '<u2'), ('i', '|i1'), "
		 "], 'fortran_order': False, 'shape': (2,), }           \n\n")
	     "12345678ab12345678cde"),
	SEED("time_s,v\n0,1.7e308\n1,-1.7e308\n-1.7e308,inf\n1.7e308,-1e308\n"),
	SEED("\xef\xbb\xbftime_s,lost,\x9b\n0,0,1\n1,5,2\n2,3,1\n"),
	SEED("?a.b & 8 == 8 && !(c < -1.5) || ~a.b ^ 0x10 | 3 != 1e2"),
	SEED("?a.b + 18446744073709551615 >= c - 7"),
	{ NULL, 0 }
};

static unsigned int failures;

static int say(const char *fmt, va_list ap)
{
	char text[512];

	vsnprintf(text, sizeof(text), fmt, ap);
	failures++;
	return 1;
}

int fail(const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	say(fmt, ap);
	va_end(ap);
	return 1;
}

int usage_error(const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	say(fmt, ap);
	va_end(ap);
	return 1;
}

/* "c" is a real number, all others have 16 bits with a sign */
static int find(void *ctx, const char *name, struct when_name *to)
{
	(void)ctx;
	to->index = strlen(name) % 2;
	to->type = !strcmp(name, "c") ? (struct ec_type){ .bits = 64, .kind = EC_KIND_FLOAT } :
				(struct ec_type){ .bits = 16, .kind = EC_KIND_INT };
	return 0;
}

static void condition(const uint8_t *data, size_t len)
{
	const u64 bits[2] = { 0xfff8, 0x3ff8000000000000ULL };
	char *text = strndup((const char *)data, len);
	struct when *w = NULL;

	MUST(text);
	if (when_parse(text, find, NULL, &w)) {
		MUST(failures == 1);
	} else {
		MUST(!failures);
		when_true(w, bits);
		when_free(w);
	}
	free(text);
}

void note(const char *fmt, ...)
{
	(void)fmt;
}

/* A recording with a long header, on a disk that is full at @limit bytes: whole rows are left. */
static void record(const char *path, rlim_t limit)
{
	static struct record_column columns[4000];
	static u64 bits[ARRAY_SIZE(columns)];
	static char names[ARRAY_SIZE(columns)][40];
	const struct rlimit all = { RLIM_INFINITY, RLIM_INFINITY }, full = { limit, RLIM_INFINITY };
	struct record_row row = { .bits = bits, .wc_state = 2 };
	struct record_file f;
	struct plot_data p;
	int ret;

	for (size_t i = 0; i < ARRAY_SIZE(columns); i++) {
		snprintf(names[i], sizeof(names[i]), "a_slave_%zu.a_value", i);
		columns[i] = (struct record_column){
			.name = names[i], .unit = "", .kind = EC_KIND_UINT, .bits = 8,
		};
	}
	MUST(!record_file_open(&f, path, false, columns, ARRAY_SIZE(columns)));
	MUST(!setrlimit(RLIMIT_FSIZE, &full));
	record_file_begin(&f, 0, 0, "test");
	for (unsigned int i = 0; i < 40; i++)
		record_file_row(&f, &row);
	ret = record_file_close(&f);
	MUST(!setrlimit(RLIMIT_FSIZE, &all));
	MUST(ret == 2);
	failures = 0;
	/* below the header nothing but the comment is left */
	ret = plot_read(path, &p);
	MUST(limit < 80000 ? ret == 1 : !ret && p.n == 4005 && p.rows);
	plot_free(&p);
	unlink(path);
}

static void full_disk(void)
{
	char dir[] = "/tmp/fuzz_record.XXXXXX", path[sizeof(dir) + 8];

	MUST(mkdtemp(dir));
	signal(SIGXFSZ, SIG_IGN);
	snprintf(path, sizeof(path), "%s/a.csv", dir);
	record(path, 50000);
	record(path, 200000);
	rmdir(dir);
}

static void draw(const struct plot_data *p)
{
	const struct plot_column *c[64];
	struct plot_view v;
	size_t n = min_t(size_t, p->n, ARRAY_SIZE(c));
	FILE *to = fopen("/dev/null", "w");

	MUST(to);
	for (size_t i = 0; i < n; i++)
		c[i] = &p->columns[i];
	plot_view(p, &v);
	MUST(!plot_text(to, &v, c, n, 80, failures % 2));
	plot_svg(to, &v, c, n);
	fclose(to);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	static bool again;
	struct plot_data p;

	if (!again)
		full_disk();
	again = true;
	failures = 0;
	if (len && *data == '?') {
		condition(data + 1, len - 1);
		return 0;
	}
	if (plot_read_memory("t", (const char *)data, len, &p))
		MUST(failures == 1);
	else if (p.rows)
		draw(&p);
	plot_free(&p);
	return 0;
}
