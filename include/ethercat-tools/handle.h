/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: opening a master, failures, lists. */
#ifndef ETHERCAT_TOOLS_HANDLE_H
#define ETHERCAT_TOOLS_HANDLE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ECT_STRING	64	/* bytes of a name, with its end */
#define ECT_TEXT	256	/* bytes of a reason, with its end */

#define ECT_NONE16	0xffffU
#define ECT_NONE32	0xffffffffU

/* flags of ect_open() */
#define ECT_OPEN_WRITE	1U	/* for bus traffic and changes; not needed to read states */

struct ect_handle;
struct ect_list;

/* the module of an open master */
struct ect_version {
	uint32_t struct_size;
	uint32_t interface;	/* version of the interface of the module */
	uint64_t features;
	uint32_t masters;	/* how many the module has */
	uint32_t ecrt;		/* ECRT_VERSION_MAGIC of the module */
	char release[ECT_STRING];
};

/**
 * ect_new() - make a handle
 *
 * Context: Any thread.
 * Return: handle without master, to be ended with ect_free(); NULL without memory.
 */
struct ect_handle *ect_new(void);

/**
 * ect_free() - close the master of a handle and free the handle
 * @h: handle, or NULL
 *
 * Context: The thread of the handle.
 */
void ect_free(struct ect_handle *h);

/**
 * ect_open() - open a master
 * @h: handle without master
 * @master: index of the master, from 0
 * @flags: ECT_OPEN_*
 *
 * Context: The thread of the handle.
 * Return: 0, -EBUSY if the handle has a master already, -EPROTO if the module has an interface
 * that this library does not know, or another negative errno of open().
 */
int ect_open(struct ect_handle *h, unsigned int master, unsigned int flags);

/**
 * ect_open_path() - open a master by its device file
 * @h: handle without master
 * @path: device file, instead of /dev/EtherCAT0...
 * @flags: ECT_OPEN_*
 *
 * Context: The thread of the handle.
 * Return: As ect_open().
 */
int ect_open_path(struct ect_handle *h, const char *path, unsigned int flags);

/**
 * ect_close() - close the master of a handle
 * @h: handle; without master nothing happens
 *
 * Context: The thread of the handle.
 */
void ect_close(struct ect_handle *h);

/**
 * ect_fd() - the file descriptor of an open master
 * @h: handle
 *
 * For poll(): after ect_events_begin() it is readable when there are events.
 *
 * Context: The thread of the handle.
 * Return: descriptor, which belongs to the handle; -1 without master.
 */
int ect_fd(const struct ect_handle *h);

/**
 * ect_path() - the device file of the last ect_open()
 * @h: handle
 *
 * Context: The thread of the handle.
 * Return: path; "" without any.
 */
const char *ect_path(const struct ect_handle *h);

/**
 * ect_version() - what the module of an open master is
 * @h: handle with master
 *
 * Context: The thread of the handle.
 * Return: version, valid while the master is open; NULL without master.
 */
const struct ect_version *ect_version(const struct ect_handle *h);

/**
 * ect_interface() - the version of the module's interface that this library has
 *
 * Context: Any.
 * Return: number, as @interface of struct ect_version.
 */
unsigned int ect_interface(void);

/**
 * ect_reason() - why the last function failed, in words
 * @h: handle
 *
 * Cause and remedy, from the master or from this library. The text of the errno that the function
 * returned is not repeated here.
 *
 * Context: The thread of the handle.
 * Return: one line without its end; "" if there is nothing to add. Valid up to the next call.
 */
const char *ect_reason(struct ect_handle *h);

/**
 * ect_error_code() - code of a slave with which the last function failed
 * @h: handle
 *
 * Context: The thread of the handle.
 * Return: SDO abort code, error code of SoE or FoE, or result of EoE; 0: the slave has sent none.
 */
uint32_t ect_error_code(const struct ect_handle *h);

/**
 * ect_list_count() - number of elements
 * @l: list, or NULL
 *
 * Context: Any thread, while no other one frees the list.
 * Return: elements; 0 without list.
 */
size_t ect_list_count(const struct ect_list *l);

/**
 * ect_list_get() - an element
 * @l: list
 * @i: which, from 0
 *
 * Context: Any thread, while no other one frees the list.
 * Return: element, whose structure the function that made the list names; NULL behind the end.
 */
const void *ect_list_get(const struct ect_list *l, size_t i);

/**
 * ect_list_free() - free a list and its elements
 * @l: list, or NULL
 *
 * Context: Any thread; the handle that made the list may be freed already.
 */
void ect_list_free(struct ect_list *l);

#ifdef __cplusplus
}
#endif

#endif
