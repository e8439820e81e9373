// SPDX-License-Identifier: GPL-2.0-only
#define _GNU_SOURCE
#include "save.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tool.h"

/* A new file beside @path, with the permissions that @path has or would get. */
static FILE *part_file(char *part, const struct stat *old)
{
	mode_t mask = umask(0);
	int fd = mkstemp(part);
	FILE *f;

	umask(mask);
	if (fd < 0)
		return NULL;
	f = fchmod(fd, old ? old->st_mode & 07777 : 0666 & ~mask) ? NULL : fdopen(fd, "wb");
	if (!f) {
		int err = errno;

		close(fd);
		remove(part);
		errno = err;
	}
	return f;
}

/**
 * save_begin() - write a file; its previous content stays until save_end()
 * @s: result
 * @path: name, valid until save_end(); a device, a pipe and a link are written themselves, so is
 *	a file in a folder that takes no other
 *
 * Return: 0, or 1 after printing what failed.
 */
int save_begin(struct save *s, const char *path)
{
	size_t size = strlen(path) + sizeof(".XXXXXX");
	struct stat st;
	bool there = !lstat(path, &st);
	int err = 0;

	*s = (struct save){ .path = path, .part = malloc(size) };
	if (!s->part)
		return fail("out of memory");
	snprintf(s->part, size, "%s.XXXXXX", path);
	if (!there || S_ISREG(st.st_mode)) {
		s->f = part_file(s->part, there ? &st : NULL);
		err = s->f ? 0 : errno;
	}
	if (s->f)
		return 0;
	free(s->part);
	s->part = NULL;
	/* a full disk would leave neither the old content nor the new one */
	if (!err || err == EACCES || err == EPERM || err == EROFS || err == ENAMETOOLONG)
		s->f = fopen(path, "wb");
	else
		errno = err;
	return s->f ? 0 : fail("cannot write '%s': %s", path, strerror(errno));
}

/**
 * save_new() - write a file that must not exist
 * @s: result
 * @path: name, valid until save_end()
 *
 * Return: 0, or 1 after printing what failed.
 */
int save_new(struct save *s, const char *path)
{
	struct stat st;

	if (!lstat(path, &st))
		return fail("'%s' exists; replace it with --force", path);
	if (save_begin(s, path))
		return 1;
	s->fresh = true;
	return 0;
}

/* another one may have made it meanwhile; a file system without that check replaces it */
static int put_in_place(const struct save *s)
{
	if (s->fresh && !renameat2(AT_FDCWD, s->part, AT_FDCWD, s->path, RENAME_NOREPLACE))
		return 0;
	return s->fresh && errno != EINVAL ? -1 : rename(s->part, s->path);
}

/* The file is not wanted: one to be replaced is unchanged. */
void save_cancel(struct save *s)
{
	fclose(s->f);
	if (s->part)
		remove(s->part);
	free(s->part);
}

/**
 * save_end() - the file is whole
 * @s: of save_begin(); its stream is closed
 *
 * Return: 0, or 1 after printing what failed: a file to be replaced is unchanged then.
 */
int save_end(struct save *s)
{
	int err = fflush(s->f) || ferror(s->f) ? errno : 0;

	if (fclose(s->f) && !err)
		err = errno;
	if (s->part && !err && put_in_place(s))
		err = errno;
	if (s->part && err)
		remove(s->part);
	free(s->part);
	return err ? fail("cannot write '%s': %s", s->path, strerror(err)) : 0;
}
