/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of libethercat-tools share. */
#ifndef EC_LIB_TOOLS_INTERNAL_H
#define EC_LIB_TOOLS_INTERNAL_H

#pragma GCC visibility push(default)
#include "../../include/ethercat-tools.h"
#pragma GCC visibility pop
#include "../../include/uapi/ethercat.h"
#include "../../master/wire/env.h"

/**
 * struct ect_handle - a master and the last failure
 * @fd: device file, -1: closed
 * @path: of it
 * @version: of its module
 * @unasked: the last failure was one of the kernel, whose reason has not been fetched
 * @err: errno of the last failure
 * @code: code of a slave, 0: none
 * @reason: in words
 */
struct ect_handle {
	int fd;
	char path[256];
	struct ect_version version;
	bool unasked;
	int err;
	u32 code;
	char reason[ECT_TEXT];
};

/**
 * struct ect_list - elements in one piece of memory
 * @n: how many
 * @room: elements that fit into the memory
 * @size: bytes of one, a multiple of 8
 * @at: the elements
 */
struct ect_list {
	size_t n;
	size_t room;
	size_t size;
	u8 *at;
};

/* handle.c: a command of the kernel, @arg may be NULL; 0 or -errno */
int ect_command(struct ect_handle *h, unsigned long command, void *arg);
/* the kernel has failed with errno; returns it, negative */
int ect_failed(struct ect_handle *h);
/* a failure of this library: returns @err, which is negative */
int ect_fail(struct ect_handle *h, int err, const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));
/* the code of a slave that belongs to @err; returns @err */
int ect_coded(struct ect_handle *h, int err, u32 code);
int ect_no_memory(struct ect_handle *h);
/* copies up to the struct_size of the caller's @to; @from begins with struct_size as well */
int ect_give(struct ect_handle *h, void *to, void *from, size_t size);

/* master.c, slave.c: into memory of the library */
int ect_get_master(struct ect_handle *h, struct ect_master *to);
int ect_get_cycle(struct ect_handle *h, struct ect_cycle *to);
void ect_convert_cause(struct ect_cause *to, const struct ec_cause *from);

static inline struct ec_ioc_address ect_address(u64 device)
{
	return (struct ec_ioc_address){ .kind = EC_ADDRESS_DEVICE, .device = device };
}

static inline struct ec_ioc_address ect_ring(unsigned int position)
{
	return (struct ec_ioc_address){ .kind = EC_ADDRESS_POSITION, .position = (u16)position };
}

/* reg.c */
int ect_get_errors(struct ect_handle *h, u64 device, struct ect_errors *to);
/* mailbox.c */
void ect_convert_ip(struct ect_ip *to, const struct ec_ip_params *from);

/* list.c */
struct ect_list *ect_list_new(size_t size);
/* a new element of zeros with its struct_size, or NULL; moves the others */
void *ect_list_add(struct ect_list *l);
void *ect_list_at(const struct ect_list *l, size_t i);

#endif
