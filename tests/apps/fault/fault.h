/* SPDX-License-Identifier: GPL-2.0-only */
/* Programs that use /dev/EtherCAT0 wrongly and look what happens. */
#ifndef FAULT_H
#define FAULT_H

#include <stdbool.h>
#include <stddef.h>
#include <uapi/ethercat.h>

#define DEVICE	"/dev/EtherCAT0"

/* no memory there: address 0, a hole, the kernel's half */
#define BAD_POINTERS	3
extern void *const bad_pointers[BAD_POINTERS];

/* bytes of an argument */
struct span {
	unsigned short offset;
	unsigned short size;
};

/**
 * struct cmd - one command of uapi/ethercat.h
 * @name: its name
 * @nr: its number
 * @write: needs a descriptor opened for writing
 * @owner: needs the reservation
 * @raw: needs CAP_NET_RAW
 * @flags: flags it knows
 * @cyclic: called each cycle: no reason text
 * @min: bytes that programs of an earlier version send, 0: the present size
 * @reserved: bytes that must be zero, size 0 ends them
 * @data: offset of a pointer to data, 0: none
 * @size: offset of the number of bytes there
 */
struct cmd {
	const char *name;
	unsigned long nr;
	bool write;
	bool owner;
	bool raw;
	unsigned int flags;
	bool cyclic;
	unsigned int min;
	struct span reserved[2];
	unsigned short data;
	unsigned short size;
};

extern const struct cmd cmds[];
extern const unsigned int n_cmds;

/* open.c */
int open_master(int flags);
int call(int fd, unsigned long nr, void *arg);

/* check.c */
void expect(bool good, const char *fmt, ...) __attribute__((format(printf, 2, 3)));
void expect_errno(int got, int want, const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));

/* generic.c: the same questions to every command */
void check_numbers(void);
void check_sizes(void);
void check_version(void);
void check_pointers(void);
void check_unknown(void);
void check_readonly(void);

/* index.c: arguments that name what is not there */
void check_positions(void);
void check_addresses(void);
void check_values(void);

/* states.c: at the wrong time */
void session(int fd);
void check_states(void);
void check_policy(void);
void check_ioctl_only(void);

/* limits.c: too much */
void check_limits(void);

/* map.c */
void check_mmap(void);

/* pages.c: pages that are not there, while another thread maps */
void check_pages(void);

/* flood.c: what is logged, again and again */
void check_flood(void);

#endif
