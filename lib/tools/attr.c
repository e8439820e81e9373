// SPDX-License-Identifier: LGPL-2.1-or-later
#include "attr.h"

#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void attr_path(char *buf, size_t size, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(buf, size, fmt, ap);
	va_end(ap);
}

bool attr_read(const char *dir, const char *name, char *buf, size_t size)
{
	char path[1024];
	ssize_t n;
	int fd;

	*buf = '\0';
	attr_path(path, sizeof(path), "%s/%s", dir, name);
	fd = open(path, O_RDONLY | O_CLOEXEC);
	if (fd < 0)
		return false;
	n = read(fd, buf, size - 1);
	close(fd);
	buf[n > 0 ? n : 0] = '\0';
	buf[strcspn(buf, "\n")] = '\0';
	return n > 0;
}

unsigned long attr_number(const char *dir, const char *name)
{
	char text[32];

	return attr_read(dir, name, text, sizeof(text)) ? strtoul(text, NULL, 0) : 0;
}
