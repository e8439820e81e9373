/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-bus: bus files, in YAML or in JSON, which is a part of YAML. */
#ifndef ETHERCAT_BUS_FILE_H
#define ETHERCAT_BUS_FILE_H

#include <stdio.h>

#include "bus.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECB_FILE_MAX	(64U << 20)	/* bytes of a file */
#define ECB_MEMORY_MAX	(256U << 20)	/* bytes of the bus that is made of it */

/**
 * ecb_file_read() - read a bus file
 * @bus: set to the bus, to be freed with ecb_bus_free()
 * @path: file, or "-" for stdin
 * @error: result of a failure
 *
 * Context: Any thread.
 * Return: 0, -EINVAL with @error: what the file says is not valid, or another negative errno with
 * @error.
 */
int ecb_file_read(struct ecb_bus **bus, const char *path, struct ecb_error *error);

/**
 * ecb_file_read_fd() - read a bus file that is open
 * @bus: set to the bus, to be freed with ecb_bus_free()
 * @fd: file, which is read from its position to its end
 * @name: name of the file for messages
 * @error: result of a failure
 *
 * For a caller that checks the owner and the permissions of what it reads.
 *
 * Context: Any thread.
 * Return: As ecb_file_read().
 */
int ecb_file_read_fd(struct ecb_bus **bus, int fd, const char *name, struct ecb_error *error);

/**
 * ecb_file_parse() - read a bus file out of memory
 * @bus: set to the bus
 * @name: name of the file for messages
 * @data: @size bytes
 * @size: bytes, at most %ECB_FILE_MAX
 * @error: result of a failure
 *
 * Context: Any thread.
 * Return: As ecb_file_read().
 */
int ecb_file_parse(struct ecb_bus **bus, const char *name, const void *data, size_t size,
		   struct ecb_error *error);

/**
 * ecb_file_write() - write a bus file
 * @bus: bus
 * @to: where to, YAML
 *
 * What has the value of what is not given is not written.
 *
 * Context: The thread of the bus.
 * Return: 0, or -EIO: not everything could be written.
 */
int ecb_file_write(const struct ecb_bus *bus, FILE *to);

/**
 * ecb_file_schema() - write the JSON Schema of bus files
 * @to: where to
 *
 * Context: Any thread.
 * Return: 0 or -EIO.
 */
int ecb_file_schema(FILE *to);

#ifdef __cplusplus
}
#endif

#endif
