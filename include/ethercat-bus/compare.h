/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-bus: what differs between two buses. */
#ifndef ETHERCAT_BUS_COMPARE_H
#define ETHERCAT_BUS_COMPARE_H

#include "bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/* struct ecb_difference.kind */
#define ECB_MISSING	0	/* expected and not found */
#define ECB_EXTRA	1	/* found and not expected */
#define ECB_EXCHANGED	2	/* another device in the place of the expected one */
#define ECB_MOVED	3	/* connected to another port */
#define ECB_VALUE_DIFFERS	4
#define ECB_PENDING	5	/* a startup command that no session has executed; no difference */

/* flags of ecb_compare() */
#define ECB_COMPARE_MACHINE	1	/* @found is a machine, which has no names */
#define ECB_COMPARE_SLAVES	2	/* without what an application configures, as PDOs */

/** struct ecb_difference - one difference; its texts are valid during the call */
struct ecb_difference {
	uint32_t kind;		/* ECB_MISSING... */
	uint32_t master;	/* index */
	uint32_t line;		/* of what is expected, 0: none */
	uint32_t found_line;
	const char *slave;	/* name, "": none */
	const char *key;	/* "revision", "pdos 0x1a00 entries 2 bits", or "" */
	const char *expected;	/* "" if nothing is expected */
	const char *found;
	const char *remedy;	/* with %ECB_COMPARE_MACHINE, otherwise "" */
};

typedef void (*ecb_difference_fn)(void *ctx, const struct ecb_difference *d);

/**
 * ecb_compare() - find the differences between two buses
 * @expected: bus, of a file for example
 * @found: bus
 * @flags: ECB_COMPARE_*
 * @fn: called for each difference, and for what is pending
 * @ctx: for @fn
 *
 * Slaves belong together by alias, identification, serial number, or by name between two files;
 * the others by identity in the order of the bus, so that one slave more is one difference. What
 * is connected behind a slave that is extra or missing is not moved by that.
 * With %ECB_COMPARE_MACHINE what @expected does not say, and what @known of a slave does not name,
 * is not compared.
 *
 * Context: The thread of both buses.
 * Return: number of differences without pending ones, or -ENOMEM.
 */
long ecb_compare(const struct ecb_bus *expected, const struct ecb_bus *found, unsigned int flags,
		 ecb_difference_fn fn, void *ctx);

/* a slave that is on both sides */
typedef void (*ecb_pair_fn)(void *ctx, const struct ecb_master *master,
			    const struct ecb_slave *expected, const struct ecb_slave *found);

/**
 * ecb_pairs() - find which slave of one bus is which of another one
 * @expected: bus, of a file for example
 * @found: bus
 * @flags: ECB_COMPARE_*
 * @fn: called for each pair of the same identity, with the master of @expected
 * @ctx: for @fn
 *
 * As ecb_compare() finds them.
 *
 * Context: The thread of both buses.
 * Return: number of pairs, or -ENOMEM.
 */
long ecb_pairs(const struct ecb_bus *expected, const struct ecb_bus *found, unsigned int flags,
	       ecb_pair_fn fn, void *ctx);

#ifdef __cplusplus
}
#endif

#endif
