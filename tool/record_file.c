// SPDX-License-Identifier: GPL-2.0-only
#include "record_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "record_npy.h"
#include "screen.h"
#include "tool.h"
#include "value.h"

#define BUFFER		65536	/* bytes that are written at once */
#define CELL		32	/* bytes of a number as text, at most, with its comma */
#define END_MS		200	/* at the end a program behind a pipe has so long to read */

/* A new file has its rows at once; one that exists stays until the new one is complete. */
static int open_file(struct record_file *f, const char *path, bool force)
{
	f->fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
	if (f->fd >= 0)
		return 0;
	if (errno != EEXIST)
		return fail("cannot write '%s': %s", path, strerror(errno));
	if (!force)
		return fail("'%s' exists; use another name, or --force to replace it", path);
	if (save_begin(&f->old, path))
		return 1;
	f->fd = fileno(f->old.f);
	return 0;
}

static size_t header_bytes(const struct record_file *f)
{
	size_t size = 1024;

	/* a character of a text may become two */
	for (size_t i = 0; i < f->n; i++)
		size += 2 * (strlen(f->columns[i].name) + strlen(f->columns[i].unit)) + CELL;
	return size;
}

int record_file_open(struct record_file *f, const char *path, bool force,
		     const struct record_column *columns, size_t n)
{
	size_t len = path ? strlen(path) : 0;
	struct stat st;

	*f = (struct record_file){
		.path = path, .fd = STDOUT_FILENO, .columns = columns, .n = n,
		.npy = len > 4 && !strcmp(path + len - 4, ".npy"),
	};
	/* a row more than is written at once, or the header */
	f->room = BUFFER + CELL * (n + RECORD_FIXED) + header_bytes(f);
	f->buf = malloc(f->room);
	if (!f->buf)
		return fail("out of memory");
	if (path && open_file(f, path, force)) {
		free(f->buf);
		return 1;
	}
	f->regular = !fstat(f->fd, &st) && S_ISREG(st.st_mode);
	return 0;
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

/* Can some bytes be written? A program that does not read cannot keep this one from ending. */
static bool is_ready(const struct record_file *f)
{
	struct pollfd p = { .fd = f->fd, .events = POLLOUT };
	int n = 0;

	while (!f->regular && n <= 0) {
		n = poll(&p, 1, END_MS);
		if (!n && screen_ended())
			return false;
	}
	return true;
}

/* After a failure the file ends with the last row that is whole. */
void record_file_flush(struct record_file *f)
{
	size_t done = 0;

	while (!f->err && done < f->used) {
		size_t size = f->regular ? f->used - done : min_t(size_t, f->used - done, PIPE_BUF);
		bool ready = is_ready(f);
		ssize_t n = ready ? write(f->fd, f->buf + done, size) : 0;

		if (!ready)
			f->err = ETIMEDOUT;
		if (n < 0 && errno != EINTR)
			f->err = errno;
		done += n > 0 ? (size_t)n : 0;
	}
	done = whole(f, done);
	f->written += done;
	f->rows -= min(f->rows, rows_behind(f, done));
	f->used = 0;
	if (f->err && f->regular && ftruncate(f->fd, (off_t)(f->head + f->written)))
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

static void add_quoted(struct record_file *f, const char *s)
{
	for (; *s; s++)
		add(f, *s == '"' ? "\"\"" : "%c", *s);
}

/* RFC 4180, though names have no such characters */
static void add_name(struct record_file *f, const struct record_column *c)
{
	bool quote = strpbrk(c->name, ",\"\n") || *c->unit;

	add(f, quote ? ",\"" : ",");
	add_quoted(f, c->name);
	if (*c->unit) {
		add(f, " [");
		add_quoted(f, c->unit);
		add(f, "]");
	}
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
	for (size_t i = 0; i < f->n; i++)
		add_name(f, &f->columns[i]);
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
		add(f, c->scaled ? ",%.15g" : ",%.17g", value_real(data, 8));
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

static int put_in_place(struct record_file *f)
{
	if (f->old.f)
		return save_end(&f->old);
	if (!f->path || !close(f->fd))
		return 0;
	return fail("cannot write '%s': %s", f->path, strerror(errno));
}

int record_file_close(struct record_file *f)
{
	const char *path = f->path ? f->path : "stdout";

	record_file_flush(f);
	free(f->buf);
	if (put_in_place(f))
		return 2;
	if (!f->err)
		return 0;
	if (f->regular)
		fail("cannot write '%s': %s; it is valid and has %llu bytes", path,
		     strerror(f->err), (unsigned long long)(f->head + f->written));
	else
		fail("cannot write '%s': %s; the last whole row ends after %llu bytes", path,
		     f->err == ETIMEDOUT ? "its reader does not read" : strerror(f->err),
		     (unsigned long long)(f->head + f->written));
	return 2;
}

void record_file_drop(struct record_file *f)
{
	if (f->old.f) {
		save_cancel(&f->old);
	} else if (f->path) {
		close(f->fd);
		remove(f->path);
	}
	free(f->buf);
}
