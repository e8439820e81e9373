// SPDX-License-Identifier: GPL-2.0-only
#include "record_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "record_npy.h"
#include "tool.h"
#include "value.h"

#define BUFFER		65536	/* bytes that are written at once */
#define CELL		32	/* bytes of a number as text, at most, with its comma */

static int new_file(struct record_file *f, const char *path, bool force)
{
	size_t size = strlen(path) + sizeof(".XXXXXX");
	mode_t mask;

	if (!force) {
		f->fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
		if (f->fd < 0 && errno == EEXIST)
			return fail("'%s' exists; use another name, or --force to replace it",
				    path);
		return f->fd < 0 ? fail("cannot write '%s': %s", path, strerror(errno)) : 0;
	}
	/* the old file stays until the new one is complete */
	f->part = malloc(size);
	if (!f->part)
		return fail("out of memory");
	snprintf(f->part, size, "%s.XXXXXX", path);
	mask = umask(0);
	umask(mask);
	f->fd = mkstemp(f->part);
	if (f->fd < 0)
		return fail("cannot write '%s': %s", f->part, strerror(errno));
	/* permissions of a file that is created by its name */
	if (fchmod(f->fd, 0666 & ~mask))
		note("cannot change the permissions of '%s': %s", f->part, strerror(errno));
	return 0;
}

int record_file_open(struct record_file *f, const char *path, bool force,
		     const struct record_column *columns, size_t n)
{
	size_t len = path ? strlen(path) : 0;

	*f = (struct record_file){
		.path = path, .fd = STDOUT_FILENO, .columns = columns, .n = n,
		.npy = len > 4 && !strcmp(path + len - 4, ".npy"),
	};
	/* a row more than is written at once */
	f->room = BUFFER + CELL * (n + RECORD_FIXED);
	f->buf = malloc(f->room);
	if (!f->buf)
		return fail("out of memory");
	if (!path || !new_file(f, path, force))
		return 0;
	free(f->part);
	free(f->buf);
	return 1;
}

/* Whole rows of @n bytes that were written of the buffer */
static size_t whole(const struct record_file *f, size_t n)
{
	if (f->npy)
		return n / record_npy_row(f) * record_npy_row(f);
	while (n && f->buf[n - 1] != '\n')
		n--;
	return n;
}

/* Rows behind the first @n bytes of the buffer, which are whole rows */
static u64 rows_behind(const struct record_file *f, size_t n)
{
	u64 rows = 0;

	if (f->npy)
		return (f->used - n) / record_npy_row(f);
	for (; n < f->used; n++)
		rows += f->buf[n] == '\n';
	return rows;
}

/* After a failure the file ends with the last row that is whole. */
void record_file_flush(struct record_file *f)
{
	size_t done = 0;

	while (!f->err && done < f->used) {
		ssize_t n = write(f->fd, f->buf + done, f->used - done);

		if (n < 0 && errno != EINTR)
			f->err = errno;
		done += n > 0 ? (size_t)n : 0;
	}
	done = whole(f, done);
	f->written += done;
	f->rows -= min(f->rows, rows_behind(f, done));
	f->used = 0;
	if (f->err && f->path && ftruncate(f->fd, (off_t)(f->head + f->written)))
		note("cannot shorten '%s': %s", f->path, strerror(errno));
	if (f->npy && f->head)
		record_npy_count(f);
}

static void add(struct record_file *f, const char *fmt, ...)
	__attribute__((format(printf, 2, 3)));
static void add(struct record_file *f, const char *fmt, ...)
{
	va_list ap;
	int n;

	va_start(ap, fmt);
	n = vsnprintf(f->buf + f->used, f->room - f->used, fmt, ap);
	va_end(ap);
	if (n > 0 && (size_t)n < f->room - f->used)
		f->used += (size_t)n;
}

/* RFC 4180, though names have no such characters */
static void add_name(struct record_file *f, const struct record_column *c)
{
	bool quote = strpbrk(c->name, ",\"\n") || *c->unit;

	add(f, quote ? ",\"" : ",");
	for (const char *p = c->name; *p; p++)
		add(f, *p == '"' ? "\"\"" : "%c", *p);
	if (*c->unit)
		add(f, " [%s]", c->unit);
	if (quote)
		add(f, "\"");
}

void record_wall_text(s64 wall_ns, char *buf, size_t size)
{
	time_t s = (time_t)(wall_ns / 1000000000);
	char text[32] = "";
	struct tm tm;

	if (gmtime_r(&s, &tm))
		strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%S", &tm);
	snprintf(buf, size, "%s.%09lldZ", text, (long long)(wall_ns % 1000000000));
}

static void begin_csv(struct record_file *f)
{
	char wall[48];

	record_wall_text(f->wall_ns, wall, sizeof(wall));
	add(f, "# ethercat record: time 0 is %s, %s\n", wall, f->title);
	add(f, "time_s,app_time_ns,cycle,lost,wc");
	for (size_t i = 0; i < f->n; i++) {
		add_name(f, &f->columns[i]);
		if (f->used > BUFFER / 2)
			record_file_flush(f);
	}
	add(f, "\n");
}

void record_file_begin(struct record_file *f, s64 zero_ns, s64 wall_ns, const char *title)
{
	f->zero_ns = zero_ns;
	f->wall_ns = wall_ns;
	f->title = title;
	if (f->npy)
		record_npy_begin(f);
	else
		begin_csv(f);
}

static void add_value(struct record_file *f, const struct record_column *c, u64 bits)
{
	const struct ec_type t = { .bits = (u16)c->bits, .kind = c->kind };
	u8 data[8];

	for (unsigned int i = 0; i < 8; i++)
		data[i] = (u8)(bits >> 8 * i);
	if (c->kind == EC_KIND_FLOAT && c->bits == 32)
		add(f, ",%.9g", value_real(data, 4));
	else if (c->kind == EC_KIND_FLOAT)
		add(f, ",%.17g", value_real(data, 8));
	else if (c->kind == EC_KIND_INT)
		add(f, ",%lld", (long long)value_signed(&t, data, (c->bits + 7) / 8));
	else
		add(f, ",%llu", (unsigned long long)bits);
}

static void row_csv(struct record_file *f, const struct record_row *row)
{
	s64 t = row->time_ns - f->zero_ns;
	u64 ns = (u64)(t < 0 ? -t : t);

	add(f, "%s%llu.%09llu,%llu,%llu,%llu,%llu", t < 0 ? "-" : "",
	    (unsigned long long)(ns / 1000000000), (unsigned long long)(ns % 1000000000),
	    (unsigned long long)row->app_time_ns, (unsigned long long)row->cycle,
	    (unsigned long long)row->lost, (unsigned long long)row->wc_state);
	for (size_t i = 0; i < f->n; i++)
		add_value(f, &f->columns[i], row->bits[i]);
	add(f, "\n");
}

void record_file_row(struct record_file *f, const struct record_row *row)
{
	if (f->err)
		return;
	if (f->npy)
		record_npy_add(f, row);
	else
		row_csv(f, row);
	f->rows++;
	if (f->used >= BUFFER)
		record_file_flush(f);
}

int record_file_close(struct record_file *f)
{
	int err;

	record_file_flush(f);
	err = f->err;
	if (f->path && close(f->fd) && !err)
		err = errno;
	if (f->part && rename(f->part, f->path) && !err)
		err = errno;
	free(f->part);
	free(f->buf);
	if (!err)
		return 0;
	fail("cannot write '%s': %s; it is valid and has %llu bytes", f->path ? f->path : "stdout",
	     strerror(err), (unsigned long long)(f->head + f->written));
	return 2;
}

void record_file_drop(struct record_file *f)
{
	if (f->path) {
		close(f->fd);
		remove(f->part ? f->part : f->path);
	}
	free(f->part);
	free(f->buf);
}
