// SPDX-License-Identifier: GPL-2.0-only
/* A bus file for an application in the kernel. */
#include <stdlib.h>

#include "../include/ethercat-bus/load.h"
#include "bus_int.h"
#include "out.h"
#include "select.h"

static int save_compiled(const struct tool *t, const uint8_t *image, size_t size)
{
	const char *path = t->output_file;
	struct save s;

	if (bus_save_begin(t, &s, path))
		return 1;
	fwrite(image, 1, size, s.f);
	if (save_end(&s))
		return 1;
	out_str("file", path, "%s: ", path);
	out_u("size", size, "%zu byte(s)\n", size);
	return 0;
}

int bus_compile(const struct tool *t, const char *path, const struct ecb_bus *bus)
{
	struct ecb_load load = { .struct_size = sizeof(load), .bus = bus, .file = path };
	struct ecb_error e;
	uint8_t *image;
	size_t size;
	unsigned int index;
	int ret;

	/* with one master in the file any index will do */
	if (list_single(&t->masters, &index))
		load.index = index;
	else if (bus->master_count > 1)
		return usage_error("%s: %zu masters; select one with --master", path,
				   bus->master_count), 2;
	if (ecb_compile(&load, &image, &size, &e))
		return fail("%s", e.text), 2;
	ret = save_compiled(t, image, size);
	free(image);
	return ret;
}
